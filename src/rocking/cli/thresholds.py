"""The lowest overturning amplitudes that a command asks for: from options and a study file to what is shown."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli import quantities, studies
from rocking.cli.options import YourInput
from rocking.cli.screen import print_json, print_table
from rocking.cli.surveys import FILES, MOST_ROWS, carried_out

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model import OverturningCurve

ASKED = ("period", "frequency", "restitution", "amplitude")


def question(typed: Mapping[str, Any], file: Path | None) -> dict[str, Any]:
    """What options and study file ask for; what is typed wins."""
    given = studies.asked(typed, file, _checks())
    if "restitution" not in given:
        raise YourInput("missing --restitution")
    return given


def _checks() -> dict[str, studies.Check]:
    """How each entry of a study file is read."""
    from rocking.response import MOST_CYCLES, MOST_PERIOD
    from rocking.survey import MOST_PHASES

    limits = {"phases": (1, MOST_PHASES), "max_cycles": (1, MOST_CYCLES), "max_period": (1, MOST_PERIOD)}
    return {
        **quantities.varying(*ASKED),
        **quantities.counts(limits),
        **quantities.places("store", *FILES),
    }


def compute(given: Mapping[str, Any]) -> OverturningCurve:
    """The curve."""
    from rocking.survey import overturning_amplitude

    asked = {
        name: quantities.values(each) if name in ASKED else each
        for name, each in given.items()
        if name not in FILES
    }
    return carried_out(overturning_amplitude, asked)


def show(found: OverturningCurve, files: list[Path], *, as_json: bool) -> None:
    """Print the lowest overturning amplitudes."""
    if as_json:
        print_json(record(found, files))
        return
    print_table(str(found), rows(found), files)


COLUMNS = ("lowest", "resolution", "survived_up_to", "surviving_above")


def rows(found: OverturningCurve) -> Iterator[tuple[str, ...]]:
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


def record(found: OverturningCurve, files: list[Path]) -> dict[str, Any]:
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
