"""Groups and arrays of a store in the Zarr format 3."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import zarr
from zarr.core.group import GroupMetadata
from zarr.core.metadata import ArrayV3Metadata

from rocking.survey.measurement import Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.store.chunk_files import Files, codecs, encoded
from rocking.survey.store.dataset import attributes
from rocking.survey.tiling import Level


def make_groups(
    files: Files, asked: SurveySpec, measure: Measurement, levels: list[Level], there: dict[str, Any]
) -> list[zarr.Group]:
    """Return one group for each level, with the attributes of the survey; groups that are not ``there`` are created."""
    metadata = _plain(attributes(asked, measure))
    found = _made(files, {level.name: GroupMetadata(metadata) for level in levels}, there)
    for group in found.values():
        if not files.refusal and group.attrs.asdict() != metadata:
            group.attrs.put(metadata)
    return list(found.values())


def make_arrays(
    files: Files,
    asked: SurveySpec,
    measure: Measurement,
    levels: list[Level],
    there: list[dict[str, Any]],
) -> list[dict[str, zarr.Array]]:
    """Return the variables of each level by name; variables and coordinates are created or enlarged as needed.

    ``there`` holds the existing arrays of each level.
    """
    wanted = {
        f"{level.name}/{name}": description
        for level in levels
        for name, description in _descriptions(level, asked, measure).items()
    }
    known = {
        f"{level.name}/{name}": array
        for level, those in zip(levels, there, strict=True)
        for name, array in those.items()
    }
    found = _made(files, wanted, known)
    for level in levels:
        for name, values in level.axes.items():
            array = _sized(found[f"{level.name}/{name}"], values.shape)
            for key, content in _chunks(array, values):
                if files.kept(key) != content:  # missing or damaged: the content is known
                    files.keep(key, content)
    return [
        {each.name: _sized(found[f"{level.name}/{each.name}"], level.shape) for each in measure.variables}
        for level in levels
    ]


def _made(files: Files, wanted: Mapping[str, Any], there: Mapping[str, Any]) -> dict[str, Any]:
    """Return the wanted groups or arrays by path; missing ones are created from their metadata.

    They are created one at a time, because Zarr prints all but the first of several simultaneous errors on stderr.
    """
    found = {path: there.get(path) for path in wanted}
    for path in [path for path, known in found.items() if known is None]:
        found |= zarr.create_hierarchy(store=files, nodes={path: wanted[path]})
    return found


def _descriptions(level: Level, asked: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """Return the metadata of a level: coordinates have a single chunk, variables one chunk per tile."""
    names = list(level.axes)
    along = {
        name: _array(values.shape, values.shape, "float64", math.nan, [name], asked.coordinate(name))
        for name, values in level.axes.items()
    }
    return along | {
        each.name: _array(level.shape, level.tile, each.dtype, each.fill, names, each.attributes)
        for each in measure.variables
    }


def _array(
    shape: Sequence[int],
    chunk: Sequence[int],
    dtype: str,
    fill: float,
    names: list[str],
    metadata: dict[str, Any],
) -> Any:
    return ArrayV3Metadata.from_dict(
        {
            "zarr_format": 3,
            "node_type": "array",
            "shape": list(shape),
            "data_type": dtype,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": list(chunk)}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
            "fill_value": "NaN" if math.isnan(fill) else fill,
            "codecs": codecs(dtype),
            "dimension_names": names,
            "attributes": _plain(metadata),
        }
    )


def _sized(array: zarr.Array, shape: tuple[int, ...]) -> zarr.Array:
    """Return an array, enlarged to a shape as needed."""
    if array.shape != shape:
        array.resize(shape)
    return array


def _chunks(array: zarr.Array, values: np.ndarray) -> Iterator[tuple[str, bytes]]:
    """Yield the key and the content of each file of a coordinate; an extended axis has several files."""
    (edge,) = array.chunks
    for number, first in enumerate(range(0, values.size, edge)):
        yield f"{array.path}/c/{number}", encoded(values[first : first + edge], (edge,), math.nan)


def _plain(metadata: dict[str, Any]) -> dict[str, Any]:
    """Return attributes with lists instead of arrays, for JSON."""
    return {
        name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in metadata.items()
    }
