"""Computation of a parametric map from options and a study file, and its output files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.option_names import COUNTS, START, SYSTEM, YourInput, option, options, your_input
from rocking.cli.output import files
from rocking.cli.output.files import SUFFIXES, check_files
from rocking.cli.output.survey_run import ARGUMENTS, carried_out
from rocking.model.block import Block
from rocking.model.files import TILES, check_replaceable
from rocking.model.validation import instance, refusal

if TYPE_CHECKING:
    import xarray as xr


THEORY = ("curves", "symbols")
PLACES = ("store", "tiles", *SUFFIXES)
OWN = (*COUNTS, "repair")
"""Arguments of `parametric_map` other than quantities."""


@frozen
class Question:
    """Request of a map: arguments of `parametric_map`, overlays of its plot, and output paths."""

    arguments: dict[str, Any]
    drawn: dict[str, Any]  # arguments of the plot
    places: dict[str, Path]  # store and output files
    block: Block | None  # with SI input: plots then have SI axes


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """Return the request given by options and study file; options take precedence."""
    checks: dict[str, study_file.Check] = {
        **survey_quantities.varying(*SYSTEM, *START),
        **survey_quantities.counts(*COUNTS),
        "model": study_file.model,
        "curves": _names,
        "symbols": partial(instance, "symbols", kind=str),
        **survey_quantities.path_checks("store", "tiles", *SUFFIXES),
    }
    given = study_file.asked(typed, file, checks)
    own, drawn, places = (
        {name: given.pop(name) for name in names if name in given} for names in (OWN, THEORY, PLACES)
    )
    if "curves" in drawn:
        drawn["curves"] = _names(drawn["curves"])
    arguments = own | survey_quantities.normalised(given)
    asked = Question(arguments, drawn, places, survey_quantities.block_of(given))
    _check_theory(asked)
    return asked


def _names(entry: Any) -> tuple[str, ...]:
    """Return names from a list, or from a text that separates them by commas."""
    parts = entry.split(",") if isinstance(entry, str) else entry
    if not isinstance(parts, list | tuple) or not all(isinstance(part, str) for part in parts):
        raise TypeError(refusal("curves", "be names in a list, or in one text separated by commas", entry))
    return tuple(part.strip() for part in parts)


def _check_theory(asked: Question) -> None:
    """Raise YourInput for overlays that cannot be drawn, before the map is computed."""
    if not asked.drawn:
        return
    name = next(iter(asked.drawn))
    if "plot" not in asked.places:
        raise YourInput(f"{option(name)} needs a plot: give --plot FILE as well")
    from rocking.plot import style, theory_curves
    from rocking.survey.spec import question as spec_of

    with your_input(ARGUMENTS | options(*THEORY)):
        spec = spec_of(asked.arguments, 2, "a parametric map")
        style.check_symbols(asked.drawn.get("symbols"))
        theory_curves.check(asked.drawn.get("curves", ()), spec.axes, spec.fixed)


def files_of(asked: Question) -> dict[str, Path]:
    """Return the requested output files, for tiles the page; YourInput if a file cannot be written."""
    folders = {name: asked.places.get(name) for name in ("store", "tiles")}
    files = check_files({name: asked.places.get(name) for name in SUFFIXES}, folders=folders)
    if "tiles" in asked.places:
        with your_input():
            folder = check_replaceable(option("tiles"), asked.places["tiles"], TILES)
        files["tiles"] = folder / TILES.page
    return files


def compute(asked: Question) -> xr.Dataset:
    """Compute the map."""
    from rocking.survey.parametric_map import parametric_map

    return carried_out(parametric_map, asked.arguments | {"store": asked.places.get("store")}, asked.block)


def write_plot(found: xr.Dataset, path: Path, asked: Question) -> None:
    """Write the plot of the map."""
    from rocking import plot

    plot.save(plot.parametric_map(found, block=asked.block, **asked.drawn), path)


def write_tiles(found: xr.Dataset, path: Path, asked: Question) -> None:
    """Write the map as image tiles with a page."""
    from rocking import plot

    plot.tiles(found, path.parent, asked.block)


def write_netcdf(found: xr.Dataset, path: Path, asked: Question) -> None:
    """Write the map as netCDF, in parts; with SI input also its axes in SI."""
    from rocking.survey.export import to_netcdf

    to_netcdf(files.with_block(found, asked.block), path)


def write_csv(found: xr.Dataset, path: Path, asked: Question) -> None:
    """Write one row per point as CSV: its system and all variables, flags as words; with a block also in SI."""
    from rocking.survey.export import tables

    rows = (files.with_fixed(table, found.kind.dims, found.attrs) for table in tables(found))
    files.write_csv((files.columns(row, asked.block) for row in rows), path)


WRITERS: dict[str, Callable[[xr.Dataset, Path, Question], None]] = {
    "plot": write_plot,
    "tiles": write_tiles,
    "netcdf": write_netcdf,
    "csv": write_csv,
}
