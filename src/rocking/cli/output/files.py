"""Output files: checked before a computation starts, written completely or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.option_names import INPUTS, QUANTITIES, YourInput, option, your_input
from rocking.model.block import PHYSICAL, SAME_IN_SI, Block, block_attributes
from rocking.model.files import check_writable, replacing, replacing_hdf5, resolve_path
from rocking.model.text import shown_path

if TYPE_CHECKING:
    import xarray as xr


PICTURES = (".png", ".svg", ".pdf")
SUFFIXES = {"plot": PICTURES, "csv": (".csv",), "netcdf": (".nc",)}


def check_files(
    paths: Mapping[str, Path | None],
    suffixes: Mapping[str, tuple[str, ...]] = SUFFIXES,
    folders: Mapping[str, Path | None] | None = None,
) -> dict[str, Path]:
    """Return the requested files by the names of their options.

    YourInput is raised for a file that cannot be written, and for outputs that would overwrite each other or an input. `folders`
    are further outputs.
    """
    _check_apart({**(folders or {}), **paths})
    asked = {name: path for name, path in paths.items() if path is not None}
    for name, path in asked.items():
        if path == Path("-"):
            raise YourInput(
                f"{option(name)} must be the path of a file; got '-' (files are not written to stdout: use --json for the summary)"
            )
        with your_input():
            check_writable(option(name), path, suffixes[name])
    return asked


def _check_apart(paths: Mapping[str, Path | None]) -> None:
    """Raise YourInput for two outputs at one place, one output inside another, or an output in place of an input.

    The place of a link is that of its target.
    """
    taken: dict[Path, str] = {}
    inputs = {Path("/dev/stdout"): "the file to which stdout is redirected", **INPUTS.get()}
    for name, path in paths.items():
        if path is None:
            continue
        with your_input():
            place = resolve_path(option(name), path)
        for there, what in inputs.items():
            if _same(place, there.resolve()):
                raise YourInput(f"{option(name)} must not overwrite {what}; got {shown_path(path)}")
        for there, other in taken.items():
            if _same(place, there):
                raise YourInput(
                    f"{option(other)} and {option(name)} must differ; got {shown_path(path)} for both"
                )
            if place.is_relative_to(there) or there.is_relative_to(place):
                raise YourInput(
                    f"{option(other)} and {option(name)} must not lie inside each other; got {shown_path(path)} for {option(name)}"
                )
        taken[place] = name


def _same(one: Path, other: Path) -> bool:
    """Return whether two absolute paths without symbolic links are one place, also by hard links."""
    return one == other or (one.exists() and other.exists() and one.samefile(other))


def write_csv(tables: Iterable[Mapping[str, Any]], path: Path) -> None:
    """Write tables with the same headings as one CSV file; a table maps headings to arrays."""
    import csv

    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        for number, table in enumerate(tables):
            if number == 0:
                writer.writerow(table)
            writer.writerows(zip(*(column.tolist() for column in table.values()), strict=True))


def columns(table: Mapping[str, Any], block: Block | None) -> dict[str, Any]:
    """Return columns with units in their headings; with a block, its quantities are repeated in SI."""
    known = {name: PHYSICAL[name] for name in table if name in PHYSICAL}
    units = SAME_IN_SI | {name: each.normalised for name, each in known.items()}
    headed = {f"{name} [{units[name]}]" if name in units else name: column for name, column in table.items()}
    if block is None:
        return headed
    return headed | {each.heading: each.turn(block, table[name]) for name, each in known.items()}


def with_fixed(
    table: Mapping[str, Any], varied: Iterable[Any], quantities: Mapping[Any, Any]
) -> dict[str, Any]:
    """Return the columns of the varied quantities, of the fixed ones, then all others, so that each row states its system."""
    import numpy as np

    count = len(next(iter(table.values())))
    first = {str(name): table[str(name)] for name in varied}
    return (
        first
        | {name: np.full(count, quantities[name]) for name in QUANTITIES if name in quantities}
        | dict(table)
    )


def with_block(data: xr.Dataset, block: Block | None) -> xr.Dataset:
    """Return the dataset with additional coordinates in SI and with the block in its attributes."""
    if block is None:
        return data
    beside = {
        each.key: (
            data[name].dims,
            each.turn(block, data[name].values),
            {"long_name": f"{each.name} in SI", "units": each.cf},
        )
        for name, each in PHYSICAL.items()
        if name in data.coords
    }
    return data.assign_coords(beside).assign_attrs(block_attributes(block))


def write_result(
    files: Mapping[str, Path],
    *,
    figure: Callable[[Any], Any],
    data: Callable[[], xr.Dataset],
    tables: Callable[[], Iterable[Mapping[str, Any]]] = tuple,
) -> None:
    """Write the requested files of a result: its figure by `rocking.plot`, its tables and its dataset."""
    if "plot" in files:
        from rocking import plot

        plot.save(figure(plot), files["plot"])
    if "csv" in files:
        write_csv(tables(), files["csv"])
    if "netcdf" in files:
        write_dataset(data(), files["netcdf"])


def write_dataset(data: xr.Dataset, path: Path) -> None:
    """Write a dataset held in memory as netCDF."""
    with replacing_hdf5(path) as file:
        data.to_netcdf(file, engine="h5netcdf")
