"""The map that a command asks for: from options and a study file to the map and its files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import field, frozen

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.option_names import COUNTS, START, SYSTEM, YourInput, option, options, your_input
from rocking.cli.output import files
from rocking.cli.output.files import SUFFIXES, check_apart, check_files
from rocking.cli.output.survey_run import ARGUMENTS, carried_out
from rocking.model import TILES, check_replaceable, instance, refusal

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model import Block

THEORY = ("curves", "symbols")
PLACES = ("store", "repair", "tiles", *SUFFIXES)


@frozen
class Question:
    """A map to be made: the arguments of `parametric_map`, what is drawn over it, and where it goes."""

    arguments: dict[str, Any]
    drawn: dict[str, Any] = field(factory=dict)  # arguments of its picture
    store: Path | None = None
    repair: bool = False
    plot: Path | None = None
    netcdf: Path | None = None
    csv: Path | None = None
    tiles: Path | None = None
    block: Block | None = None  # of a map in SI, whose pictures have SI axes


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """What options and study file ask for; what is typed wins."""
    given = study_file.asked(typed, file, _checks())
    counts, drawn, places = (
        {name: given.pop(name) for name in names if name in given} for names in (COUNTS, THEORY, PLACES)
    )
    if "curves" in drawn:
        drawn["curves"] = _names(drawn["curves"])
    asked = Question(
        counts | survey_quantities.normalised(given),
        drawn,
        **places,
        block=survey_quantities.block_of(given),
    )
    _check_theory(asked)
    return asked


def _checks() -> dict[str, study_file.Check]:
    """How each entry of a study file is read."""
    from rocking.response import MAX_CYCLES, MAX_PERIOD

    return {
        **survey_quantities.varying(*SYSTEM, *START),
        **survey_quantities.counts({"max_cycles": (1, MAX_CYCLES), "max_period": (1, MAX_PERIOD)}),
        "curves": _names,
        "symbols": lambda entry: instance("symbols", entry, str),
        **survey_quantities.path_checks(*(name for name in PLACES if name != "repair")),
    }


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
    if asked.plot is None:
        raise YourInput(f"{option(name)} is drawn into a picture: give --plot FILE as well")
    from rocking.plot.parts import legend, theory_curves
    from rocking.survey import question as spec_of

    with your_input(ARGUMENTS | options(*THEORY)):
        spec = spec_of(asked.arguments, 2, "a parametric map")
        legend.check_symbols(asked.drawn.get("symbols"))
        theory_curves.check(asked.drawn.get("curves", ()), spec.axes, spec.fixed)


def files_of(asked: Question) -> dict[str, Path]:
    """The files asked for, of tiles their page; refused where they cannot be written."""
    check_apart({name: getattr(asked, name) for name in ("store", "tiles", *SUFFIXES)})
    files = check_files({name: getattr(asked, name) for name in SUFFIXES})
    if asked.tiles is not None:
        with your_input():
            check_replaceable(option("tiles"), asked.tiles, TILES)
        files["tiles"] = asked.tiles / TILES.page
    return files


def compute(asked: Question) -> xr.Dataset:
    """The map."""
    from rocking.survey import parametric_map

    return carried_out(
        parametric_map, asked.arguments | {"store": asked.store, "repair": asked.repair}, asked.block
    )


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
