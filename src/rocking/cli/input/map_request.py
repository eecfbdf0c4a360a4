"""The map that a command asks for: from options and a study file to the map and its files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.option_names import COUNTS, START, SYSTEM, YourInput, option, options, your_input
from rocking.cli.output import files
from rocking.cli.output.files import SUFFIXES, check_apart, check_files
from rocking.cli.output.survey_run import ARGUMENTS, carried_out
from rocking.model import TILES, Block, check_replaceable, instance, refusal

if TYPE_CHECKING:
    import xarray as xr


THEORY = ("curves", "symbols")
PLACES = ("store", "tiles", *SUFFIXES)
OWN = (*COUNTS, "repair")
"""Arguments of `parametric_map` beside the quantities."""


@frozen
class Question:
    """A map to be made: the arguments of `parametric_map`, what is drawn over it, and where it goes."""

    arguments: dict[str, Any]
    drawn: dict[str, Any]  # arguments of its picture
    places: dict[str, Path]  # of its store and its files
    block: Block | None  # of a map in SI, whose pictures have SI axes


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """Return what options and study file request; options take precedence."""
    checks: dict[str, study_file.Check] = {
        **survey_quantities.varying(*SYSTEM, *START),
        **survey_quantities.counts(*COUNTS),
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
    """Names from a text with commas, or a list."""
    parts = entry.split(",") if isinstance(entry, str) else entry
    if not isinstance(parts, list | tuple) or not all(isinstance(part, str) for part in parts):
        raise TypeError(refusal("curves", "be names, in a list or with commas", entry))
    return tuple(part.strip() for part in parts)


def _check_theory(asked: Question) -> None:
    """Reject what cannot be drawn before the map is computed."""
    if not asked.drawn:
        return
    name = next(iter(asked.drawn))
    if "plot" not in asked.places:
        raise YourInput(f"{option(name)} is drawn into a picture: give --plot FILE as well")
    from rocking.plot.parts import legend, theory_curves
    from rocking.survey import question as spec_of

    with your_input(ARGUMENTS | options(*THEORY)):
        spec = spec_of(asked.arguments, 2, "a parametric map")
        legend.check_symbols(asked.drawn.get("symbols"))
        theory_curves.check(asked.drawn.get("curves", ()), spec.axes, spec.fixed)


def files_of(asked: Question) -> dict[str, Path]:
    """The files asked for, of tiles their page; refused where they cannot be written."""
    check_apart({name: asked.places.get(name) for name in PLACES})
    files = check_files({name: asked.places.get(name) for name in SUFFIXES})
    if "tiles" in asked.places:
        with your_input():
            folder = check_replaceable(option("tiles"), asked.places["tiles"], TILES)
        files["tiles"] = folder / TILES.page
    return files


def compute(asked: Question) -> xr.Dataset:
    """The map."""
    from rocking.survey import parametric_map

    return carried_out(parametric_map, asked.arguments | {"store": asked.places.get("store")}, asked.block)


def write_plot(found: xr.Dataset, path: Path, asked: Question) -> None:
    """The map as a picture."""
    from rocking import plot

    plot.save(plot.parametric_map(found, block=asked.block, **asked.drawn), path)


def write_tiles(found: xr.Dataset, path: Path, asked: Question) -> None:
    """The map as image tiles with their page."""
    from rocking import plot

    plot.tiles(found, path.parent, asked.block)


def write_netcdf(found: xr.Dataset, path: Path, asked: Question) -> None:
    """The map as it is, tile by tile; of a block with its axes in SI as well."""
    from rocking.survey import to_netcdf

    to_netcdf(files.with_block(found, asked.block), path)


def write_csv(found: xr.Dataset, path: Path, asked: Question) -> None:
    """A row a point: the axes, then all that was found, flags as words; of a block then what has a unit in SI."""
    from rocking.survey import tables

    block = asked.block
    rows = tables(found)
    files.write_csv(rows if block is None else (files.columns(table, block) for table in rows), path)


WRITERS: dict[str, Callable[[xr.Dataset, Path, Question], None]] = {
    "plot": write_plot,
    "tiles": write_tiles,
    "netcdf": write_netcdf,
    "csv": write_csv,
}
