"""What the commands of surveys that sum up share: their files, and what they print."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs

from rocking.cli.axes import Axis
from rocking.cli.options import ARGUMENTS as SYSTEM_ARGUMENTS
from rocking.cli.options import YourInput, option, your_input
from rocking.cli.outputs import PICTURES
from rocking.cli.summary import Row, aligned, asked_of, finite, physical_of, question_of
from rocking.model import check_writable, replacing

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model import BasinMap, Block, OverturningCurve, Share, UncertaintyExponent

SUFFIXES = {"plot": PICTURES, "netcdf": (".nc",)}
ARGUMENTS = {
    **SYSTEM_ARGUMENTS,
    **{name: name for name in ("samples", "seed", "boundary_runs", "phases", "store", "repair")},
}
MOST_ROWS = 20


def check_files(files: Mapping[str, Path | None]) -> dict[str, Path]:
    """The files asked for; `YourInput` for one that cannot be written."""
    asked = {name: path for name, path in files.items() if path is not None}
    for name, path in asked.items():
        with your_input():
            check_writable(option(name), path, SUFFIXES[name])
    return asked


def require(name: str, given: object) -> None:
    """`YourInput` for an option that is missing."""
    if given is None:
        raise YourInput(f"missing {option(name)}")


def values(typed: Any) -> Any:
    """A number, or the values of an axis."""
    import numpy as np

    return np.linspace(typed.start, typed.stop, typed.points) if isinstance(typed, Axis) else typed


def starts(typed: Any, samples: object) -> Any:
    """The axis of a grid of starts, or the ends of it where starts are drawn at random."""
    return [typed.start, typed.stop] if samples is not None and isinstance(typed, Axis) else values(typed)


def write(found: Any, data: xr.Dataset, picture: str, files: Mapping[str, Path]) -> None:
    """Write a picture and the dataset."""
    if "plot" in files:
        from rocking import plot

        plot.save(getattr(plot, picture)(found), files["plot"])
    if "netcdf" in files:
        with replacing(files["netcdf"]) as temporary:
            data.to_netcdf(temporary, engine="h5netcdf")


def show_basins(found: BasinMap, block: Block | None, files: list[Path], *, as_json: bool) -> None:
    """Print the attractors, their shares and the exponents of the boundaries."""
    if as_json:
        told = basins_record(found, files) | (
            {} if block is None else {"block": physical_of(found.system, block)}
        )
        _print_json(told)
        return
    starts_ = f"{found.fractions[0].of:,} starts"
    count = len(found.attractors)
    title = f"basins, {starts_}: {count} response{'s' * (count != 1)} to be told apart"
    _print(title, [*asked_of(found.system, block), *basin_rows(found)], files)


def basin_rows(found: BasinMap) -> Iterator[Row]:
    """A row an attractor, then the exponents."""
    for each, share in list(zip(found.attractors, found.fractions, strict=True))[:MOST_ROWS]:
        yield (
            each.name,
            str(share),
            f"e.g. from Θ = {each.verdict.start.angle:.6g}, Θ' = {each.verdict.start.velocity:.6g}",
        )
    if len(found.attractors) > MOST_ROWS:
        yield "and others", f"{len(found.attractors) - MOST_ROWS}", ""
    names = {
        "boundary of overturning": found.uncertainty_exponent,
        "all boundaries": found.attractor_exponent,
    }
    for name, exponent in names.items():
        if exponent is not None:
            yield (
                name,
                f"uncertainty exponent {exponent}",
                "below 1: fractal" if exponent.high < 1.0 else "1: smooth",
            )


def basins_record(found: BasinMap, files: list[Path]) -> dict[str, Any]:
    """The same for a program to read."""
    return {
        **question_of(found.system),
        "starts": found.fractions[0].of,
        "attractors": [
            {
                "name": each.name,
                "kind": str(each.kind),
                "fraction": share_record(share),
                "response_period": each.verdict.period,
                "impacts_per_period": each.verdict.impacts_per_period,
                "symmetric": each.verdict.symmetric,
                "start": attrs.asdict(each.verdict.start),
            }
            for each, share in zip(found.attractors, found.fractions, strict=True)
        ],
        "uncertainty_exponent": exponent_record(found.uncertainty_exponent),
        "attractor_exponent": exponent_record(found.attractor_exponent),
        "files": [str(path) for path in files],
    }


def share_record(share: Share) -> dict[str, Any]:
    """A share with its interval."""
    return {
        "value": share.value,
        "low": share.low,
        "high": share.high,
        "count": share.count,
        "of": share.of,
    }


def exponent_record(exponent: UncertaintyExponent | None) -> dict[str, Any] | None:
    """An exponent with its interval."""
    if exponent is None:
        return None
    return {name: getattr(exponent, name) for name in ("value", "low", "high", "misfit")}


def show_overturning(found: OverturningCurve, files: list[Path], *, as_json: bool) -> None:
    """Print the lowest overturning amplitudes."""
    if as_json:
        _print_json(overturning_record(found, files))
        return
    _print(str(found), list(overturning_rows(found)), files)


COLUMNS = ("lowest", "resolution", "survived_up_to", "surviving_above")


def overturning_rows(found: OverturningCurve) -> Iterator[tuple[str, ...]]:
    """A row a value of what varies."""
    data = found.dataset
    over = [str(name) for name in data.lowest.dims]
    yield (*over, "lowest A", "scanned at steps of", "all survive up to", "survive above")
    for index in list(_places(data))[:MOST_ROWS]:
        at = [f"{data[name].values[k]:.6g}" for name, k in zip(over, index, strict=True)]
        low, step, up_to, above = (float(data[name].values[index]) for name in COLUMNS)
        yield (
            *at,
            "none" if math.isnan(low) else f"{low:.6g}",
            _number(step),
            _number(up_to),
            "–" if math.isnan(above) else f"{100 * above:.3g} %",
        )
    left = data.lowest.size - MOST_ROWS
    if left > 0:
        yield (f"and {left} more (--json, --netcdf and --plot have all)", *[""] * (len(over) + 3))


def overturning_record(found: OverturningCurve, files: list[Path]) -> dict[str, Any]:
    """The same for a program to read."""
    data = found.dataset
    over = [str(name) for name in data.lowest.dims]
    amplitudes = data.amplitude.values
    rows = [
        {name: float(data[name].values[k]) for name, k in zip(over, index, strict=True)}
        | {name: float(data[name].values[index]) for name in (*COLUMNS, "lowest_phase", "undetermined")}
        for index in _places(data)
    ]
    fixed = {name: data.attrs[name] for name in ("period", "frequency", "restitution") if name in data.attrs}
    scanned = {"start": float(amplitudes[0]), "stop": float(amplitudes[-1]), "count": int(amplitudes.size)}
    return {
        **fixed,
        "amplitude": scanned,
        "phases": int(data.phase.size),
        "curve": rows,
        "files": [str(path) for path in files],
    }


def _places(data: xr.Dataset) -> Iterator[tuple[int, ...]]:
    import numpy as np

    yield from np.ndindex(*data.lowest.shape)


def _number(number: float) -> str:
    return "–" if math.isnan(number) else f"{number:.6g}"


def _print_json(told: dict[str, Any]) -> None:
    print(json.dumps(finite(told), indent=2, ensure_ascii=False, allow_nan=False))


def _print(title: str, rows: list[Any], files: list[Path]) -> None:
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False, soft_wrap=True)
    console.print(title, style="bold")
    for line in aligned(rows):
        console.print(line)
    for path in files:
        console.print(f"wrote {path}")
