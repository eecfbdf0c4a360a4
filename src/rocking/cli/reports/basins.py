"""Report of basins of attraction, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from rocking.cli.option_names import START
from rocking.cli.output import survey_run
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.survey_run import MAX_ROWS, share_record
from rocking.cli.reports.motion import asked_of, physical_of, question_of
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block
from rocking.model.survey_results import BasinMap, UncertaintyExponent
from rocking.model.system import System
from rocking.model.text import counted


def write(found: BasinMap, files: Mapping[str, Path], block: Block | None) -> None:
    """Write the plot, one row per initial state as CSV, and the dataset; with a block also in SI."""
    survey_run.write(found, "basins", files, block, lambda: _tables(found))


def _tables(found: BasinMap) -> Iterator[dict[str, np.ndarray]]:
    """Yield columns by name: the initial state, its attractor as a number and by name, and all other variables."""
    from rocking.survey.export import tables

    names = np.array([each.name for each in found.attractors])
    # Random initial states lie along one dimension, and their angles and velocities are no axes.
    data = found.dataset.reset_coords([name for name in START if name not in found.dataset.dims])
    data["attractor"] = data["attractor"].drop_attrs()
    for table in tables(data):
        first = {name: table[name] for name in (*START, "attractor")}
        others = {name: column for name, column in table.items() if name not in (*first, "sample")}
        yield first | {"name": names[first["attractor"]]} | others


def show(found: BasinMap, block: Block | None, files: list[Path], *, as_json: bool) -> None:
    """Print the attractors, their area fractions and the uncertainty exponents of the boundaries."""
    full = found.system.critical_angle is not None
    doubts = warnings(block, found.system.periodic.amplitude, found.system.restitution, full=full)
    if as_json:
        in_units = {} if block is None else {"block": physical_of(found.system, block), "warnings": doubts}
        print_json(record(found, files) | in_units)
        return
    responses = counted(len(found.attractors), "attractor")
    starts = f"{found.fractions[0].of:,} initial states"
    if "sample" in found.dataset.dims:
        starts += ", random within both ranges"
    title = f"basins of {starts}: {responses}"
    print_table(title, [*asked_of(found.system, block), *rows(found)], files, warned(doubts))


def rows(found: BasinMap) -> Iterator[Row]:
    """Yield one row per attractor, then the exponents."""
    for each, share in list(zip(found.attractors, found.fractions, strict=True))[:MAX_ROWS]:
        yield (
            each.name,
            str(share),
            f"e.g. from Θ = {each.verdict.start.angle:.6g}, Θ' = {each.verdict.start.velocity:.6g}",
        )
    if len(found.attractors) > MAX_ROWS:
        yield "other attractors", f"{len(found.attractors) - MAX_ROWS}", ""
    names = {
        "boundary of overturning": found.uncertainty_exponent,
        "all boundaries": found.attractor_exponent,
    }
    for name, exponent in names.items():
        if exponent is not None:
            yield name, f"uncertainty exponent {exponent}", exponent.meaning
    if tangency := tangled_from(found.system):
        yield (
            "theoretical boundary",
            f"fractal above A* = {tangency:.6g}",
            "the manifolds of the saddles intersect",
        )


def tangled_from(system: System) -> float | None:
    """Return A* if the boundary of overturning is provably fractal, A* < A < √(1 + Ω²), else None."""
    from rocking.theory import heteroclinic_amplitude

    forcing = system.periodic
    if system.braces is not None or not 0.0 < system.restitution < 1.0:
        return None
    tangency = float(heteroclinic_amplitude(forcing.period, system.restitution))
    return tangency if tangency < forcing.amplitude < math.hypot(1.0, forcing.frequency) else None


def record(found: BasinMap, files: list[Path]) -> dict[str, Any]:
    """Return the result as a JSON object."""
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


def exponent_record(exponent: UncertaintyExponent | None) -> dict[str, Any] | None:
    """Return an exponent with its interval as a JSON object."""
    if exponent is None:
        return None
    return {name: getattr(exponent, name) for name in ("value", "low", "high", "misfit", "meaning")}
