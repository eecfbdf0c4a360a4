"""Reports of periodic orbits, of a branch, of a frequency response, and of an orbit diagram."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.output import Report, Row, Text, aligned, columns, with_block, with_fixed
from rocking.cli.reports import (
    MAX_ROWS,
    angle_warning,
    block_warnings,
    in_si,
    multiplier_columns,
    reach,
    state_in_si,
    survey_in_si,
    system_in_si,
    system_record,
    system_rows,
    warning_lines,
    with_warnings,
)
from rocking.cli.reports_verdict import multipliers_text, proof_record
from rocking.model.block import Block
from rocking.model.orbit import Orbit
from rocking.model.quantity import IN_SI
from rocking.model.system import State, System, quantities

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.inputs import Followed, Request
    from rocking.orbits.branch import Branch, SpecialPoint
    from rocking.orbits.find_orbits import Orbits
    from rocking.orbits.frequency_response import FrequencyResponse
    from rocking.orbits.orbit_diagram import OrbitDiagram

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


def orbits_tables(orbits: Orbits, request: Request) -> Iterator[dict[str, Any]]:
    """Yield columns by heading, with the states at τ = 0 in the units of the file."""
    starts = [orbit.start for orbit in orbits]
    multipliers = np.array([orbit.multipliers for orbit in orbits], complex).reshape(-1, 2)
    table = {
        "period [cycles]": np.array([orbit.period for orbit in orbits]),
        "symmetric": np.array([orbit.symmetric for orbit in orbits]),
        "impacts": counts_column([orbit.impacts for orbit in orbits]),
        "brace_hits": counts_column([orbit.brace_hits for orbit in orbits]),
        "stability": np.array([str(orbit.stability) for orbit in orbits]),
        **multiplier_columns(multipliers),
        "hits": np.array(orbits.hits),
    }
    states = {
        "angle": np.array([start.angle for start in starts]),
        "velocity": np.array([start.velocity for start in starts]),
    }
    yield table | columns(states, request.block)


def counts_column(counts: Sequence[int | None]) -> np.ndarray:
    """Return a column of numbers of impacts, "inf" for infinitely many."""
    return np.array([math.inf if count is None else count for count in counts], object)


def orbits_record(orbits: Orbits, _: Request) -> dict[str, Any]:
    """Return the orbits as a JSON object."""
    return {
        **system_record(orbits.system),
        "max_period": orbits.max_period,
        "starts": orbits.starts,
        "settled": orbits.settled,
        "orbits": [
            orbit_record(orbit)
            | {"hits": hits, "proof": None if orbit.proof is None else proof_record(orbit.proof)}
            for orbit, hits in zip(orbits, orbits.hits, strict=True)
        ],
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


def orbits_in_si(orbits: Orbits, request: Request) -> dict[str, Any]:
    """Return the block and the warnings as a JSON object; empty without a block."""
    system, block = orbits.system, request.block
    return {} if block is None else with_warnings(system_in_si(system, block), orbit_warnings(system, block))


ORBITS = Report(
    orbits_text,
    orbits_record,
    tables=orbits_tables,
    data=lambda orbits, request: with_block(orbits.to_xarray(), request.block),
    more=orbits_in_si,
)


# Branch.


SAME_QUANTITY = {"period": "frequency", "frequency": "period"}
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


def branch_tables(followed: Followed, request: Request) -> Iterator[dict[str, Any]]:
    """Yield the points of a branch as columns by heading, with a block also in SI."""
    orbit, branch = followed
    points, fixed = branch.points, fixed_quantities(branch, orbit)
    table = {branch.name: points["parameter"]}
    # `phase` is that of the first event of a point.
    table |= {"forcing_phase": np.full(len(points), fixed.pop("phase"))}
    table |= {name: points[name] for name in ("phase", "velocity", "peak", "stability")}
    table |= multiplier_columns(points["multipliers"])
    yield columns(with_fixed(table, [branch.name], fixed), request.block)


def fixed_quantities(branch: Branch, orbit: Orbit) -> dict[str, float]:
    """Return the quantities of the system that do not vary along a branch."""
    varied = (branch.name, SAME_QUANTITY.get(branch.name))
    return {name: value for name, value in quantities(orbit.system).items() if name not in varied}


def branch_data(followed: Followed, request: Request) -> xr.Dataset:
    """Return the dataset of a branch; with a block, its parameter has a coordinate in SI."""
    orbit, branch = followed
    data = branch.to_xarray().assign_attrs(fixed_quantities(branch, orbit))
    if request.block is not None:
        data = data.assign_coords({branch.name: data["parameter"]})
    return with_block(data, request.block)


def branch_record(followed: Followed, request: Request) -> dict[str, Any]:
    """Return the branch as a JSON object: the orbit followed, special points and ends."""
    (orbit, branch), block = followed, request.block
    return {
        "parameter": branch.name,
        **system_record(orbit.system),
        "orbit": orbit_record(orbit),
        "points": len(branch),
        "stable_points": int(branch.points["stable"].sum()),
        "special": [special_record(special, block) for special in branch.special],
        "ends": [
            {"reason": reason} | value_record(branch.name, value, block)
            for _, value, reason in branch_ends(branch)
        ],
        "peak": float(np.nanmax(branch.points["peak"])),
    }


def branch_in_si(followed: Followed, request: Request) -> dict[str, Any]:
    """Return the block, the largest angle and the warnings as a JSON object; empty without a block."""
    (orbit, branch), block = followed, request.block
    if block is None:
        return {}
    peak = {"peak_deg": float(block.degrees(float(np.nanmax(branch.points["peak"]))))}
    return with_warnings(system_in_si(orbit.system, block) | peak, orbit_warnings(orbit.system, block))


def special_record(special: SpecialPoint, block: Block | None) -> dict[str, Any]:
    """Return a special point as a JSON object."""
    return (
        {"kind": special.kind}
        | value_record(special.name, special.parameter, block)
        | {"orbit": orbit_record(special.orbit)}
    )


def value_record(name: str, value: float, block: Block | None) -> dict[str, float]:
    """Return a value of a parameter by name as a JSON object, with a block also in SI."""
    if block is None or name not in IN_SI:
        return {name: value}
    return {name: value, IN_SI[name].key: float(IN_SI[name].of(block, value))}


CONTINUE = Report(
    branch_text,
    branch_record,
    figure=lambda plot, followed, request: plot.branch(followed.branch, block=request.block),
    tables=branch_tables,
    data=branch_data,
    more=branch_in_si,
)


# Frequency response.


def response_text(result: FrequencyResponse, request: Request) -> Text:
    """Return the branches, one row for each."""
    block = request.block
    rows = [
        ("varied", request.varied, in_si(result.parameter, result.values[[0, -1]], block)),
        ("amplitude", f"A = {result.amplitude:.6g}", in_si("amplitude", result.amplitude, block)),
        ("restitution", f"e = {result.restitution:.6g}", ""),
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
    return block_warnings(block, result.amplitude, result.restitution)


def response_tables(result: FrequencyResponse, request: Request) -> Iterator[dict[str, Any]]:
    """Yield one table (columns by heading) per branch, and one of the responses from rest; cells that do not apply are empty."""
    fixed = result.to_xarray().attrs
    for table in response_columns(result):
        yield columns(with_fixed(table, ["branch", result.parameter], fixed), request.block)


def response_columns(result: FrequencyResponse) -> Iterator[dict[str, Any]]:
    """Yield the columns that vary, for each branch and for the responses from rest."""
    for number, branch in enumerate(result.branches):
        count = len(branch)
        yield {
            "branch": np.full(count, str(number)),
            "orbit_period": np.full(count, branch.period),
            "symmetric": np.full(count, str(branch.symmetric)),
            result.parameter: branch.points["parameter"],
            "stability": branch.points["stability"],
            "response": np.full(count, ""),
            "peak": branch.points["peak"],
        }
    rest, count = result.rest, len(result.values)
    yield {
        "branch": np.full(count, "from rest"),
        "orbit_period": rest["period"],
        "symmetric": np.full(count, ""),
        result.parameter: result.values,
        "stability": np.full(count, ""),
        "response": rest["kind"],
        "peak": steady_peaks(result),
    }


def steady_peaks(result: FrequencyResponse) -> np.ndarray:
    """Return the largest |Θ| of each response from rest: of the steady response or, without one, from the initial state on."""
    rest = result.rest
    return np.where(np.isnan(rest["steady_peak"]), rest["peak"], rest["steady_peak"])


def response_record(result: FrequencyResponse, request: Request) -> dict[str, Any]:
    """Return the frequency response as a JSON object."""
    return {
        "parameter": result.parameter,
        "first": float(result.values[0]),
        "last": float(result.values[-1]),
        "count": len(result.values),
        "amplitude": result.amplitude,
        "restitution": result.restitution,
        "modes": list(result.modes),
        "branches": [response_branch(branch, request.block) for branch in result.branches],
        "from_rest": dict(Counter(result.rest["kind"].tolist())),
    }


def response_in_si(result: FrequencyResponse, request: Request) -> dict[str, Any]:
    """Return the block and the warnings as a JSON object; empty without a block."""
    block = request.block
    if block is None:
        return {}
    return with_warnings(survey_in_si(result.to_xarray(), block), response_warnings(result, block))


def response_branch(branch: Branch, block: Block | None) -> dict[str, Any]:
    """Return a branch as a JSON object."""
    place, peak = largest(branch)
    return {
        "orbit_period": branch.period,
        "symmetric": branch.symmetric,
        "points": len(branch),
        "stable_points": int(branch.points["stable"].sum()),
        "peak": peak,
        **({} if block is None else {"peak_deg": float(block.degrees(peak))}),
        "peak_at": value_record(branch.name, place, block),
        "special": [
            {"kind": one.kind} | value_record(one.name, one.parameter, block) for one in branch.special
        ],
        "ends": list(branch.ends),
    }


FREQUENCY_RESPONSE = Report(
    response_text,
    response_record,
    figure=lambda plot, result, request: plot.frequency_response(result, block=request.block),
    tables=response_tables,
    data=lambda result, request: with_block(result.to_xarray(), request.block),
    more=response_in_si,
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


def diagram_tables(diagram: OrbitDiagram, request: Request) -> Iterator[dict[str, Any]]:
    """Yield one table (columns by heading) per sweep and parameter value."""
    fixed = diagram.to_xarray().attrs
    for direction, overturned, points in zip(diagram.sweeps, diagram.overturned, diagram.points, strict=True):
        for value, fell, rows in zip(diagram.values, overturned, points, strict=True):
            count = 1 if fell else len(rows)
            first = {
                "sweep": np.full(count, direction),
                diagram.parameter: np.full(count, value),
                "cycle": np.array(["overturned"]) if fell else np.arange(count),
            }
            table = first | {"angle": rows[:count, 0], "velocity": rows[:count, 1]}
            table = columns(with_fixed(table, first, fixed), request.block)
            yield {name: np.array([""]) if is_empty(column) else column for name, column in table.items()}


def is_empty(column: np.ndarray) -> bool:
    """Return whether a column holds no numbers, because the block overturned."""
    return column.dtype.kind == "f" and bool(np.isnan(column).all())


def diagram_record(diagram: OrbitDiagram, request: Request) -> dict[str, Any]:
    """Return the result as a JSON object."""
    return {
        "parameter": diagram.parameter,
        "first": float(diagram.values[0]),
        "last": float(diagram.values[-1]),
        "count": len(diagram.values),
        **diagram.fixed,
        "start": attrs.asdict(diagram.start),
        "section_phase": diagram.section_phase,
        "transient": diagram.transient,
        "cycles": diagram.cycles,
        "sweeps": [
            sweep_record(diagram, direction, fell, peaks, request.block)
            for direction, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True)
        ],
    }


def sweep_record(
    diagram: OrbitDiagram, direction: str, fell: np.ndarray, peaks: np.ndarray, block: Block | None
) -> dict[str, Any]:
    """Return a sweep as a JSON object; with a block, also in SI."""
    peak = float(peaks[~fell].max()) if not fell.all() else None
    values = diagram.values[fell]
    entries = {
        "way": direction,
        "overturned": int(fell.sum()),
        "overturned_at": values.tolist(),
        "peak": peak,
    }
    if block is None:
        return entries
    if diagram.parameter in IN_SI:
        varied = IN_SI[diagram.parameter]
        entries[f"overturned_at_{varied.key}"] = varied.of(block, values.tolist()).tolist()
    return entries | {"peak_deg": None if peak is None else float(block.degrees(peak))}


def diagram_more(diagram: OrbitDiagram, request: Request) -> dict[str, Any]:
    """Return the block and the warnings as a JSON object; empty without a block."""
    block = request.block
    if block is None:
        return {}
    return with_warnings(survey_in_si(diagram.to_xarray(), block), diagram_warnings(diagram, block))


ORBIT_DIAGRAM = Report(
    diagram_text,
    diagram_record,
    figure=lambda plot, diagram, request: plot.orbit_diagram(diagram, block=request.block),
    tables=diagram_tables,
    data=lambda diagram, request: with_block(diagram.to_xarray(), request.block),
    more=diagram_more,
)
