"""The map that a command asks for: from options and a study file to what is shown and written."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.axes import FORM, VARIES, Axis
from rocking.cli.options import ARGUMENTS, NORMALISED, SI, YourInput, as_typed, option, your_input
from rocking.cli.options import question as point
from rocking.cli.outputs import PICTURES
from rocking.cli.studies import Check, quantity, read
from rocking.cli.summary import Row, aligned, finite
from rocking.model import check_replaceable, check_writable, refusal, replacing

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model import Block

PAGE = "index.html"
SUFFIXES = {"plot": PICTURES, "netcdf": (".nc",), "csv": (".csv",)}
QUANTITIES = (
    *NORMALISED,
    *SI,
    "restitution",
    "phase",
    "brace_angle",
    "brace_restitution",
    "angle",
    "velocity",
)
TOLD = (
    "amplitude",
    "period",
    "frequency",
    "restitution",
    "phase",
    "brace_angle",
    "brace_restitution",
    "angle",
    "velocity",
)
COUNTS = ("max_cycles", "max_period")
REPEATED = ("store", "repair", "brace_angle", "brace_restitution")
PLACES = ("store", "repair", "tiles", *SUFFIXES)
REFUSED_AS = ARGUMENTS | {name: name for name in REPEATED}


@frozen
class Question:
    """A map to be made: the arguments of `parametric_map`, and where it goes."""

    arguments: dict[str, Any]
    store: Path | None = None
    repair: bool = False
    plot: Path | None = None
    netcdf: Path | None = None
    csv: Path | None = None
    tiles: Path | None = None
    block: Block | None = None  # of a map in SI, whose pictures have SI axes


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """What options and study file ask for; what is typed wins."""
    names = (*QUANTITIES, *COUNTS, *PLACES)
    given = {} if file is None else read(file, _checks())
    given |= {name: typed[name] for name in names if typed[name] not in (None, False)}
    arguments = {name: given.pop(name) for name in COUNTS if name in given}
    places = {name: given.pop(name) for name in PLACES if name in given}
    asked = arguments | quantities(given)
    return Question(asked, **places, block=_block(given))


def _block(given: Mapping[str, Any]) -> Block | None:
    from rocking.model import Block

    return Block(given["height"], given["width"]) if "height" in given else None


def quantities(given: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers and axes, normalised."""
    import numpy as np

    spans = {name: each if isinstance(each, Axis) else None for name, each in given.items()}
    lists = {name: each for name, each in given.items() if np.ndim(each) > 0 and spans[name] is None}
    if any(name in SI for name in lists):
        raise YourInput(f"{next(iter(lists))} in SI must be a number or {FORM}; got a list")
    varied = [name for name, span in spans.items() if span is not None]
    if "displacement" in given and any(name in ("frequency_hz", "period_s") for name in varied):
        raise YourInput(
            "--displacement with an axis of the frequency varies two things: give --acceleration instead"
        )
    # Ranges are intervals: what both ends pass, all between them do.
    ends = []
    for end in ("start", "stop"):
        at = {name: getattr(each, end) if isinstance(each, Axis) else each for name, each in given.items()}
        at |= {name: each[0 if end == "start" else -1] for name, each in lists.items()}
        ends.append(_normalised(at))
    first, last = ends
    asked: dict[str, Any] = {}
    for name in TOLD:
        if name not in first:
            continue
        source = next((each for each in varied if VARIES.get(each, each) == name), None)
        span = None if source is None else spans[source]
        asked[name] = first[name] if span is None else np.linspace(first[name], last[name], span.points)
    return asked | lists


def _normalised(given: Mapping[str, Any]) -> dict[str, Any]:
    """A system and a start as `parametric_map` has them."""
    usual = dict.fromkeys(QUANTITIES) | {"phase": 0.0, "angle": 0.0, "velocity": 0.0}
    system, start, _ = point(usual | dict(given))
    forcing, by_frequency = system.forcing, "frequency" in given or "frequency_hz" in given
    told = {
        "amplitude": forcing.amplitude,
        "frequency" if by_frequency else "period": forcing.frequency if by_frequency else forcing.period,
        "restitution": system.restitution,
        "phase": forcing.phase,
        "angle": start.angle,
        "velocity": start.velocity,
    }
    if system.braces is not None:
        told |= {"brace_angle": system.braces.angle, "brace_restitution": system.braces.restitution}
    return told


def _checks() -> dict[str, Check]:
    """How each entry of a study file is read."""
    from rocking.model import instance, whole
    from rocking.survey import MOST_CYCLES, MOST_PERIOD, check_quantity

    def normalised(name: str) -> Check:
        def check(entry: Any) -> Any:
            read = quantity(name, entry)
            for each in read[:2] if isinstance(read, Axis) else (read,):
                check_quantity(name, each)
            return read

        return check

    return {
        **{name: partial(quantity, name) for name in SI},
        **{name: normalised(name) for name in TOLD},
        "max_cycles": lambda entry: whole("max_cycles", entry, 1, MOST_CYCLES),
        "max_period": lambda entry: whole("max_period", entry, 1, MOST_PERIOD),
        "repair": lambda entry: instance("repair", entry, bool),
        **{name: partial(_path, name) for name in PLACES if name != "repair"},
    }


def _path(name: str, entry: Any) -> Path:
    if not isinstance(entry, str):
        raise TypeError(refusal(name, "be a path", entry))
    return Path(entry)


def check_files(question: Question) -> dict[str, Path]:
    """The files and the folder of tiles asked for; refused where they cannot be written."""
    paths = {name: getattr(question, name) for name in WRITERS}
    asked = {name: path for name, path in paths.items() if path is not None}
    for name, path in asked.items():
        with your_input():
            if name in SUFFIXES:
                check_writable(option(name), path, SUFFIXES[name])
            else:
                check_replaceable(option(name), path, PAGE)
    return asked


def compute(asked: Question) -> xr.Dataset:
    """The map, with a bar where somebody watches; interrupted, it says how to go on."""
    from rocking.survey import parametric_map

    with your_input(REFUSED_AS):
        try:
            return parametric_map(
                **asked.arguments, store=asked.store, repair=asked.repair, progress=sys.stderr.isatty()
            )
        except KeyboardInterrupt as error:
            for note in error.__notes__:
                print(f"rocking: {as_typed(note, REFUSED_AS)}", file=sys.stderr)
            raise


def show(found: xr.Dataset, asked: Question, files: list[Path], *, as_json: bool) -> None:
    """Print what was found on stdout, and where its files are."""
    from rocking.survey import counts

    kinds, grounds = counts(found, "kind"), counts(found, "evidence")
    written = [path for path in (asked.store, *files) if path is not None]
    if as_json:
        told = finite(record(found, kinds, grounds, written))
        print(json.dumps(told, indent=2, ensure_ascii=False, allow_nan=False))
        return
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False, soft_wrap=True)
    size = " × ".join(f"{found.sizes[name]:,}" for name in found.kind.dims)
    console.print(f"parametric map, {size} points", style="bold")
    for line in aligned([*_asked(found), *_found(kinds, grounds)]):
        console.print(line)
    for path in written:
        console.print(f"wrote {path}")


def _asked(found: xr.Dataset) -> Iterator[Row]:
    for name in found.kind.dims:
        values = found[name].values
        yield str(name), f"{values[0]:.6g} to {values[-1]:.6g}", ""
    for name in (*TOLD, "max_cycles"):
        if name in found.attrs:
            yield name.replace("_", " "), f"{found.attrs[name]:.6g}", ""


def _found(kinds: dict[str, int], grounds: dict[str, int]) -> Iterator[Row]:
    from rocking.survey import percent

    total = sum(kinds.values())
    for kind, count in kinds.items():
        if count:
            yield kind, percent(count / total), f"{count:,} points"
    for ground in ("unresolved-reset", "unwatched", "indistinct", "between", "crowded"):
        if grounds[ground]:
            yield f"  {ground}", percent(grounds[ground] / total), f"{grounds[ground]:,} points"


def record(
    found: xr.Dataset, kinds: dict[str, int], grounds: dict[str, int], files: list[Path]
) -> dict[str, Any]:
    """The same for a program to read."""
    axes = {
        str(name): {
            "start": float(found[name][0]),
            "stop": float(found[name][-1]),
            "count": found.sizes[name],
        }
        for name in found.kind.dims
    }
    fixed = {name: found.attrs[name] for name in (*TOLD, *COUNTS) if name in found.attrs}
    return {
        "axes": axes,
        **fixed,
        "points": sum(kinds.values()),
        "kinds": kinds,
        "evidence": grounds,
        "files": [str(path) for path in files],
    }


def write_plot(found: xr.Dataset, path: Path, block: Block | None) -> None:
    """The map as a picture."""
    from rocking import plot

    plot.save(plot.parametric_map(found, block=block), path)


def write_tiles(found: xr.Dataset, path: Path, block: Block | None) -> None:
    """The map as image tiles with their page."""
    from rocking import plot

    plot.tiles(found, path, block)


def write_netcdf(found: xr.Dataset, path: Path, _: Block | None) -> None:
    """The map as it is, tile by tile."""
    from rocking.survey import to_netcdf

    to_netcdf(found, path)


def write_csv(found: xr.Dataset, path: Path, _: Block | None) -> None:
    """A row a point: the axes, then all that was found, flags as words."""
    import csv

    from rocking.survey import tables

    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        for part, table in enumerate(tables(found)):
            if part == 0:
                writer.writerow(table)
            writer.writerows(zip(*(column.tolist() for column in table.values()), strict=True))


WRITERS: dict[str, Callable[[xr.Dataset, Path, Block | None], None]] = {
    "plot": write_plot,
    "tiles": write_tiles,
    "netcdf": write_netcdf,
    "csv": write_csv,
}
