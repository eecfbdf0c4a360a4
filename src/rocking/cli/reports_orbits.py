"""Reports of periodic orbits, of a branch, of a frequency response, and of an orbit diagram."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output import Report, Row, Text, aligned
from rocking.cli.reports import (
    MAX_ROWS,
    angle_warning,
    block_warnings,
    in_si,
    reach,
    state_in_si,
    system_rows,
    warning_lines,
)
from rocking.cli.reports_verdict import multipliers_text
from rocking.model.block import Block
from rocking.model.orbit import Orbit
from rocking.model.system import State, System

if TYPE_CHECKING:
    from rocking.cli.requests import Followed, Request
    from rocking.orbits.branch import Branch
    from rocking.orbits.diagrams import OrbitDiagram
    from rocking.orbits.find_orbits import Orbits
    from rocking.orbits.frequency_response import FrequencyResponse

ROUNDING = 1e-12
"""Size of an angle or a velocity below which it is shown as 0."""


# Periodic orbits.


def orbits_text(orbits: Orbits, request: Request) -> Text:
    """Return the orbits, one row for each."""
    block = request.block
    lines = ["", *aligned(list(orbits_rows(orbits, block)))] if len(orbits) else []
    if len(orbits) > MAX_ROWS:
        lines.append(f"and {len(orbits) - MAX_ROWS} more (all of them with --json, --csv or --netcdf)")
    lines += warning_lines(orbit_warnings(orbits.system, block))
    return Text(str(orbits), system_rows(orbits.system, block), lines)


def orbits_rows(orbits: Orbits, block: Block | None) -> Iterator[Row]:
    """Yield the heading and one row per orbit."""
    braced, proofs = orbits.system.braces is not None, any(orbit.proof is not None for orbit in orbits)
    yield (
        "period",
        "symmetric",
        "impacts",
        *(["brace impacts"] if braced else []),
        "stability",
        "Floquet multipliers",
        "state at τ = 0",
        *([] if block is None else ["in SI"]),
        *(["proof"] if proofs else []),
    )
    for orbit in orbits[:MAX_ROWS]:
        start = without_rounding(orbit.start)
        yield (
            f"{orbit.period}",
            "yes" if orbit.symmetric else "no",
            count_or_many(orbit.impacts),
            *([count_or_many(orbit.brace_hits)] if braced else []),
            str(orbit.stability),
            multipliers_text(*orbit.multipliers),
            f"Θ = {start.angle:.6g}, Θ' = {start.velocity:.6g}",
            *([] if block is None else [state_in_si(start, block)]),
            *([proof_text(orbit)] if proofs else []),
        )


def without_rounding(state: State) -> State:
    """Return a state in which numbers of the size of rounding errors are 0."""
    return State(*(value if abs(value) > ROUNDING else 0.0 for value in (state.angle, state.velocity)))


def count_or_many(hits: int | None) -> str:
    """Return a number of impacts as text."""
    return "infinitely many" if hits is None else f"{hits}"


def proof_text(orbit: Orbit) -> str:
    """Return the precision of the proof of an orbit, if there is one."""
    return f"{orbit.proof.bits} bits" if orbit.proof is not None and orbit.proof.proved else "none"


def orbit_warnings(system: System, block: Block | None) -> list[str]:
    """Return the warnings about a block on its orbits; on these it never lifts off from permanent rest."""
    return block_warnings(block, (), system.restitution, full=system.critical_angle is not None)


ORBITS = Report(
    orbits_text,
    warnings=lambda orbits, request: orbit_warnings(orbits.system, request.block),
)


# Branch.


"""Quantities that vary together."""


def branch_text(followed: Followed, request: Request) -> Text:
    """Return the orbit, the special points and the ends of a branch."""
    (orbit, branch), block = followed, request.block
    rows = [*system_rows(orbit.system, block), *branch_rows(branch, orbit, block, request.varied)]
    return Text(str(branch), rows, warning_lines(orbit_warnings(orbit.system, block)))


def branch_rows(branch: Branch, orbit: Orbit, block: Block | None, varied: str) -> Iterator[Row]:
    """Yield the rows of the result."""
    yield "varied", varied, ""
    start = orbit.start
    yield "orbit followed", f"{orbit.stability} {orbit}", ""
    state = f"Θ = {start.angle:.6g}, Θ' = {start.velocity:.6g}"
    yield "its state at τ = 0", state, "" if block is None else state_in_si(start, block)
    for special in branch.special:
        yield special.kind, *place_text(branch.name, special.parameter, block, digits=10)
    for name, value, reason in branch_ends(branch):
        text, physical = place_text(branch.name, value, block)
        yield f"{name} end", f"{text}: {reason}", physical
    peak = float(np.nanmax(branch.points["peak"]))
    yield "largest |Θ|", f"{peak:.6g}", reach(peak, block)


def place_text(name: str, value: float, block: Block | None, digits: int = 6) -> tuple[str, str]:
    """Return a value of the parameter, and the same in SI."""
    return f"{name.replace('_', ' ')} {value:.{digits}g}", in_si(name, value, block)


def branch_ends(branch: Branch) -> Iterator[tuple[str, float, str]]:
    """Yield name, parameter and reason of both ends."""
    values = branch.points["parameter"]
    yield "first", float(values[0]), branch.ends[0]
    yield "last", float(values[-1]), branch.ends[1]


CONTINUE = Report(
    branch_text,
    warnings=lambda followed, request: orbit_warnings(followed.orbit.system, request.block),
    more=lambda followed, request: {"orbit": followed.orbit.to_dict(block=request.block)},
    result=lambda followed: followed.branch,
)


# Frequency response.


def response_text(result: FrequencyResponse, request: Request) -> Text:
    """Return the branches, one row for each."""
    block, amplitude = request.block, result.system.periodic.amplitude
    rows = [
        ("varied", request.varied, in_si(result.parameter, result.values[[0, -1]], block)),
        ("amplitude", f"A = {amplitude:.6g}", in_si("amplitude", amplitude, block)),
        ("restitution", f"e = {result.system.restitution:.6g}", ""),
    ]
    branches = ["", *aligned([*response_rows(result, block)])] if result.branches else []
    return Text(str(result), rows, [*branches, *warning_lines(response_warnings(result, block))])


def response_rows(result: FrequencyResponse, block: Block | None) -> Iterator[Row]:
    """Yield the heading and one row per branch."""
    name = result.parameter
    yield "branch", "orbits", name, "largest |Θ|", f"at {name}", "special points"
    for number, branch in enumerate(result.branches):
        values = branch.points["parameter"]
        low, high = float(values.min()), float(values.max())
        place, peak = largest(branch)
        yield (
            f"{number}",
            f"(1, {branch.period}), {'' if branch.symmetric else 'a'}symmetric",
            f"{low:.6g} to {high:.6g}{beside_si(name, (low, high), block)}",
            f"{peak:.6g}" + ("" if block is None else f" = {reach(peak, block)}"),
            f"{place:.6g}{beside_si(name, place, block)}",
            ", ".join(
                f"{one.kind} at {one.parameter:.6g}{beside_si(name, one.parameter, block)}"
                for one in branch.special
            )
            or "none",
        )


def beside_si(name: str, values: Any, block: Block | None) -> str:
    """Return a value in SI, to follow the normalised one."""
    physical = in_si(name, values, block)
    return f" = {physical}" if physical else ""


def largest(branch: Branch) -> tuple[float, float]:
    """Return the parameter and the value of the largest |Θ| of a branch."""
    point = branch.points[int(np.nanargmax(branch.points["peak"]))]
    return float(point["parameter"]), float(point["peak"])


def response_warnings(result: FrequencyResponse, block: Block | None) -> list[str]:
    """Return the warnings about the block."""
    return block_warnings(block, result.system.periodic.amplitude, result.system.restitution)


FREQUENCY_RESPONSE = Report(
    response_text,
    warnings=lambda result, request: response_warnings(result, request.block),
)


# Orbit diagram.


def diagram_text(diagram: OrbitDiagram, request: Request) -> Text:
    """Return a summary."""
    block = request.block
    fixed = ", ".join(f"{name} {value:.6g}" for name, value in diagram.fixed.items())
    in_units = (in_si(name, value, block) for name, value in diagram.fixed.items())
    rows: list[Row] = [("varied", request.varied, ""), ("fixed", fixed, ", ".join(filter(None, in_units)))]
    if block is not None:
        rows += diagram_in_si(diagram, block)
    for direction, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True):
        known = peaks[~fell]
        if known.size:
            rows.append((f"largest |Θ|, {direction}", f"{known.max():.6g}", reach(float(known.max()), block)))
    lines = [*angle_warning(diagram.start.angle, block), *warning_lines(diagram_warnings(diagram, block))]
    return Text(str(diagram), rows, lines)


def diagram_in_si(diagram: OrbitDiagram, block: Block) -> Iterator[Row]:
    """Yield rows of the varied values, and of those at which the block overturned, in SI."""
    places = {diagram.parameter: diagram.values} | {
        f"overturned, {direction}": diagram.values[fell]
        for direction, fell in zip(diagram.sweeps, diagram.overturned, strict=True)
    }
    for name, values in places.items():
        ends = np.unique(values[[0, -1]]) if values.size else values
        physical = in_si(diagram.parameter, ends, block)
        if values.size and physical:
            yield name, " to ".join(f"{value:.6g}" for value in ends), physical


def diagram_warnings(diagram: OrbitDiagram, block: Block | None) -> list[str]:
    """Return the warnings about the block."""
    quantities = diagram.fixed | {diagram.parameter: diagram.values}
    return block_warnings(
        block, quantities["amplitude"], quantities["restitution"], full="critical_angle" in quantities
    )


ORBIT_DIAGRAM = Report(
    diagram_text,
    warnings=lambda diagram, request: diagram_warnings(diagram, request.block),
)
