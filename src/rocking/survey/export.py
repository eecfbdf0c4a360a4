"""Export of a survey of any size in parts: counts, tables and netCDF."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.block import Block, block_attributes
from rocking.model.files import check_writable, replacing_hdf5
from rocking.model.tables_and_json import Table, in_si, parts, tables_of

if TYPE_CHECKING:
    import xarray as xr


def tables(data: xr.Dataset, block: Block | None = None) -> Iterator[Table]:
    """Yield the principal table of the dataset in parts; with a block in SI units."""
    for part in parts(data):
        yield next(iter(tables_of(part, {}, block).values()))


def to_netcdf(data: xr.Dataset, path: str | os.PathLike[str], block: Block | None = None) -> None:
    """Write a dataset of any size to a netCDF file, completely or not at all; with a block in SI units."""
    target = check_writable("path", path, (".nc",))
    import h5netcdf

    def converted(part: xr.Dataset) -> xr.Dataset:
        return part if block is None else in_si(part, block, {}).assign_attrs(block_attributes(block))

    first = next(iter(data.data_vars.values())).dims[0]
    described = converted(data.isel({first: slice(0, 0)}).load()).variables
    head = converted(data.drop_vars(data.data_vars))
    with replacing_hdf5(target) as opened, h5netcdf.File(opened, "w") as file:
        file.dimensions = {str(name): size for name, size in data.sizes.items()}
        file.attrs.update(_plain(head.attrs))
        for name, variable in data.variables.items():
            made = file.create_variable(str(name), variable.dims, variable.dtype, fillvalue=None)
            made.attrs.update(_plain(described[name].attrs, variable.dtype))
            beside = [
                str(each)
                for each in data.coords
                if each not in data.dims and set(data[each].dims) <= set(variable.dims)
            ]
            if name in data.data_vars and beside:
                made.attrs["coordinates"] = " ".join(beside)
            if name in data.coords:
                made[:] = head[name].values
        begin = 0
        for part in map(converted, parts(data)):
            end = begin + part.sizes[first]
            for name in part.data_vars:
                file[str(name)][begin:end] = part[name].values
            begin = end


def _plain(metadata: dict[Any, Any], dtype: Any = None) -> dict[str, Any]:
    """Convert attributes for netCDF; flags get the type of their variable."""
    return {
        str(name): np.asarray(value, dtype) if isinstance(value, list | np.ndarray) else value
        for name, value in metadata.items()
    }
