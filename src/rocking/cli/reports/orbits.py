"""Report of periodic orbits, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.output.console import Row, aligned, print_json, print_table
from rocking.cli.output.files import columns, with_block, write_csv, write_dataset
from rocking.cli.output.survey_run import MAX_ROWS
from rocking.cli.reports.classify import multipliers_shown, proof_record
from rocking.cli.reports.motion import asked_of, physical_of, question_of, state_in_si
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block
from rocking.model.orbit import Orbit
from rocking.model.system import State, System

if TYPE_CHECKING:
    from rocking.orbits.find_orbits import Orbits

ROUNDING = 1e-12
"""Size of an angle or a velocity below which it is shown as 0."""


def write(found: Orbits, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write one row per orbit as CSV, and the dataset with the quantities of the system."""
    if "csv" in files:
        write_csv([_table(found, block)], files["csv"])
    if "netcdf" in files:
        write_dataset(with_block(found.to_xarray(), block), files["netcdf"])


def _table(found: Orbits, block: Block | None) -> dict[str, Any]:
    """Return columns by heading, with the states at τ = 0 in the units of the file."""
    starts = [orbit.start for orbit in found]
    multipliers = np.array([orbit.multipliers for orbit in found], complex).reshape(-1, 2)
    result = {
        "period [cycles]": np.array([orbit.period for orbit in found]),
        "symmetric": np.array([orbit.symmetric for orbit in found]),
        "impacts": _counts([orbit.impacts for orbit in found]),
        "brace_hits": _counts([orbit.brace_hits for orbit in found]),
        "stability": np.array([str(orbit.stability) for orbit in found]),
        **multiplier_columns(multipliers),
        "hits": np.array(found.hits),
    }
    states = {
        "angle": np.array([start.angle for start in starts]),
        "velocity": np.array([start.velocity for start in starts]),
    }
    return result | columns(states, block)


def _counts(counts: Sequence[int | None]) -> np.ndarray:
    """Return a column of numbers of impacts, "inf" for infinitely many."""
    return np.array([math.inf if count is None else count for count in counts], object)


def multiplier_columns(multipliers: np.ndarray) -> dict[str, np.ndarray]:
    """Return Floquet multipliers, shape (n, 2), as columns of real and imaginary parts."""
    return {
        f"multiplier_{number + 1}_{part}": getattr(multipliers[:, number], part)
        for number in (0, 1)
        for part in ("real", "imag")
    }


def show(found: Orbits, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the orbits on stdout, one row per orbit, and the paths of the files."""
    if as_json:
        print_json(record(found, block, files))
        return
    lines = ["", *aligned(list(_rows(found, block)))] if len(found) else []
    if len(found) > MAX_ROWS:
        lines.append(f"and {len(found) - MAX_ROWS} more (all of them with --json, --csv or --netcdf)")
    print_table(
        str(found),
        [*asked_of(found.system, block)],
        files,
        [*lines, *warned(orbit_warnings(found.system, block))],
    )


def _rows(found: Orbits, block: Block | None) -> Iterator[Row]:
    """Yield the heading and one row per orbit."""
    braced, shown = found.system.braces is not None, any(orbit.proof is not None for orbit in found)
    yield (
        "period",
        "symmetric",
        "impacts",
        *(["brace impacts"] if braced else []),
        "stability",
        "Floquet multipliers",
        "state at τ = 0",
        *([] if block is None else ["in SI"]),
        *(["proof"] if shown else []),
    )
    for orbit in found[:MAX_ROWS]:
        start = _without_rounding(orbit.start)
        yield (
            f"{orbit.period}",
            "yes" if orbit.symmetric else "no",
            _count(orbit.impacts),
            *([_count(orbit.brace_hits)] if braced else []),
            str(orbit.stability),
            multipliers_shown(*orbit.multipliers),
            f"Θ = {start.angle:.6g}, Θ' = {start.velocity:.6g}",
            *([] if block is None else [state_in_si(start, block)]),
            *([_proof(orbit)] if shown else []),
        )


def _without_rounding(state: State) -> State:
    """Return a state in which numbers of the size of rounding errors are 0."""
    return State(*(value if abs(value) > ROUNDING else 0.0 for value in (state.angle, state.velocity)))


def _count(hits: int | None) -> str:
    return "infinitely many" if hits is None else f"{hits}"


def _proof(orbit: Orbit) -> str:
    return f"{orbit.proof.bits} bits" if orbit.proof is not None and orbit.proof.proved else "none"


def orbit_warnings(system: System, block: Block | None) -> list[str]:
    """Return the warnings about a block on its orbits; on these it never lifts off from permanent rest."""
    return warnings(block, (), system.restitution, full=system.critical_angle is not None)


def record(found: Orbits, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the orbits as a JSON object."""
    result = {
        **question_of(found.system),
        "max_period": found.max_period,
        "starts": found.starts,
        "settled": found.settled,
        "orbits": [
            orbit_record(orbit)
            | {"hits": hits, "proof": None if orbit.proof is None else proof_record(orbit.proof)}
            for orbit, hits in zip(found, found.hits, strict=True)
        ],
        "files": [str(file) for file in files],
    }
    if block is None:
        return result
    return result | {
        "block": physical_of(found.system, block),
        "warnings": orbit_warnings(found.system, block),
    }


def orbit_record(orbit: Orbit) -> dict[str, Any]:
    """Return an orbit as a JSON object: its state at τ = 0 as start; multipliers are pairs [real, imaginary]."""
    return {
        "period": orbit.period,
        "symmetric": orbit.symmetric,
        "impacts": orbit.impacts,
        "brace_hits": orbit.brace_hits,
        "stability": str(orbit.stability),
        "multipliers": [[value.real, value.imag] for value in orbit.multipliers],
        "start": attrs.asdict(orbit.start),
        "section": {"phase": orbit.phase} | attrs.asdict(orbit.state),
        "residual": orbit.residual,
    }
