"""Reports of a motion: of `rocking simulate`, normalised or in SI, and of `rocking record`, in SI."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.options import InvalidInput, option
from rocking.cli.output import Report, Row, Text
from rocking.cli.reports import (
    FULL,
    SMALL_ANGLES,
    angle_symbol,
    angle_warning,
    equation,
    in_si,
    input_rows,
    origin,
    reach,
    state_in_si,
    time_unit,
    warning_lines,
)
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion
from rocking.model.system import State, System
from rocking.model.tables_and_json import headed
from rocking.model.text import counted, ordinal
from rocking.model.verdict import Outcome, Verdict
from rocking.motion.model_warnings import restrained_warnings
from rocking.motion.motion import has_cycles, margin_speed

if TYPE_CHECKING:
    from rocking.cli.requests import Request
    from rocking.motion.motion import Motion
    from rocking.motion.sliding import Slip
    from rocking.motion.validity import Validity
    from rocking.response.fit_restitution import RestitutionFit

ROWS_AT_ONCE = 100_000
MAX_CYCLES_KEPT = 100_000
"""Longest run whose events are kept; a longer one keeps only the counters, the peak and the final state."""
FIRST = 200
"""Number of initial cycles over which the validity of a non-periodic response is evaluated."""
DIGITS_OF_DIGEST = 12


def run(system: System, start: State, cycles: int | None, files: tuple[str, ...] = ()) -> Motion:
    """Simulate a motion with all its events, so that the summary does not depend on the output `files`.

    Events are dropped for too many cycles, and for too many events if no file needs them. A base motion of finite length
    has no cycles: None.
    """
    from rocking.model.validation import ContactLost, TooManyEvents
    from rocking.motion.simulate import simulate

    if cycles is not None and not cycles <= MAX_CYCLES_KEPT:
        counted = simulate(system, start, cycles=cycles, record="none")
        if counted.cycles > MAX_CYCLES_KEPT:
            return counted
        cycles = counted.cycles  # the block overturned early
    try:
        return simulate(system, start, cycles=cycles)
    except ContactLost as error:
        raise InvalidInput(str(error)) from error
    except TooManyEvents as error:
        if files:
            names = ", ".join(map(option, files))
            shorter = "" if cycles is None else "reduce --cycles, or "
            raise InvalidInput(f"too many events for {names}: {shorter}omit {names}") from error
        return simulate(system, start, cycles=cycles, record="none")


def tables(motion: Motion, request: Request) -> Iterator[dict[str, Any]]:
    """Yield tables (columns by heading) of limited length, so that memory does not grow with the motion.

    There are 100 rows per cycle, or 100 rows of a motion that ends earlier. Under a sampled base acceleration there is a row
    per sample at least. With a block, the units are SI.
    """
    from rocking.motion.motion import end_shown, sample_step

    block = request.block
    step, end = sample_step(motion), end_shown(motion)
    count = 1 + int(end / step * (1 + 1e-12))
    for first in range(0, count, ROWS_AT_ONCE):
        time = np.minimum(np.arange(first, min(first + ROWS_AT_ONCE, count)) * step, end)
        angle, velocity = motion.at(time)
        table = headed({"time": time, "angle": angle, "velocity": velocity}, block)
        if block is not None:
            table["top_displacement [m]"] = block.top_displacement(angle)
        yield table


# Simulation.


def motion_text(motion: Motion, request: Request) -> Text:
    """Return the summary."""
    block = request.block
    friction = request.options.get("friction")
    lines = [*angle_warning(motion.start.angle, block), *validity_lines(motion, block, friction)]
    title = refusal(motion, block, friction) or outcome_text(motion)
    return Text(title, [*input_rows(motion, block), *motion_rows(motion, block)], lines)


def refusal(motion: Motion, block: Block | None, friction: float | None) -> str:
    """Return the sentence on a motion that needs more friction than there is; empty for any other."""
    return "" if friction is None or block is None else assessed(motion, block, friction).refusal


@lru_cache(maxsize=1)
def assessed(motion: Motion, block: Block, friction: float | None) -> Validity:
    """Return the validity report of a motion, which several parts of a report need."""
    return motion.validity(block, friction=friction)


def outcome_text(motion: Motion) -> str:
    """Return the outcome in one line."""
    overturning, doubt = motion.overturning, f" ({motion.doubt})" if motion.doubt else ""
    if overturning is not None:
        if doubt:
            return f"overturned from τ = {overturning.time:.6g}{doubt}"
        cycle = f", in the {ordinal(overturning.cycle + 1)} cycle" if has_cycles(motion) else ""
        return f"overturned (proved at τ = {overturning.time:.6g}{cycle})"
    if motion.outcome == "at-rest":
        return f"at rest permanently{doubt}"
    if not has_cycles(motion):
        return f"bounded up to τ = {motion.duration:.6g}{doubt}"
    return f"bounded over {counted(motion.cycles, 'cycle')} (neither rest nor overturning was proved)"


def motion_rows(motion: Motion, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result."""
    time = "" if block is None else f"{block.seconds(motion.duration):.4g} s"
    cycles = f"{counted(motion.cycles, 'cycle')}, " if has_cycles(motion) else ""
    yield "simulated", f"{cycles}τ = {motion.duration:.6g}", time
    yield "impacts", f"{motion.impacts}{cut_note(motion, 'rest')}", ""
    if motion.system.braces is not None:
        yield "brace impacts", f"{motion.brace_hits}{cut_note(motion, 'sustained contact')}", ""
    if motion.overturning is None:
        yield "largest |Θ|", f"{motion.peak:.6g}", reach(motion.peak, block)
    for name, outcome in other_equation(motion):
        yield name, outcome, ""
    if not math.isnan(motion.margin):
        at = "" if block is None else f" = {block.seconds(motion.margin_time):.4g} s"
        yield margin_name(motion), f"{motion.margin:.6g}", f"at τ = {motion.margin_time:.6g}{at}"
    yield (
        "final state" if motion.overturning is None else f"state when overturning was {word_for(motion)}",
        f"Θ = {motion.final.angle:.6g}, Θ' = {motion.final.velocity:.6g}",
        "" if block is None else state_in_si(motion.final, block),
    )


def margin_name(motion: Motion) -> str:
    """Return the name of the margin with its symbol, that of the slender or the full block."""
    return "margin K₊" if motion.system.critical_angle is None else "margin K"


def word_for(motion: Motion) -> str:
    """Return the word for overturning: certain, or proved for the computed motion alone."""
    return "certain" if motion.certified else "proved"


def cut_note(motion: Motion, end: str) -> str:
    """Return the note on a count of impacts that is incomplete, else an empty text."""
    return "" if motion.record == "all" else f" (without the last ones of chattering before {end})"


def motion_validity(motion: Motion, request: Request) -> dict[str, Any]:
    """Return the motion by the other equation and the validity report as JSON objects; empty without a block."""
    block = request.block
    if block is None:
        return {}
    other = {} if has_cycles(motion) else {"other_equation": other_record(motion, block)}
    friction = request.options.get("friction")
    return {
        "peak_top_displacement_m": float(block.top_displacement(motion.peak)),
        **other,
        "validity": validity_record(motion, block, friction),
        **({"outcome": "slides"} if refusal(motion, block, friction) else {}),
    }


def other_record(motion: Motion, block: Block) -> dict[str, Any] | None:
    """Return the motion by the other equation as a JSON object, without a largest angle if it overturns; None if it does not differ."""
    from rocking.motion.validity import other_motion

    other = other_motion(motion)
    if other is None:
        return None
    peak = None if math.isinf(other.peak) else float(block.radians(other.peak))
    return {"model": other.model, "outcome": str(other.outcome), "peak_rad": peak}


SIMULATE = Report(motion_text, more=motion_validity, rows=tables)


# Validity of the model.


def validity_lines(motion: Motion, block: Block | None, friction: float | None = None) -> list[str]:
    """Return the lines of the validity report of a motion; none without a block."""
    if block is None:
        return []
    return (
        str(assessed(motion, block, friction)).splitlines()
        if is_assessed(motion)
        else warning_lines(unassessed(motion))
    )


def is_assessed(motion: Motion) -> bool:
    """Return whether a motion has a validity report: its events were kept, and the block has no restrainer."""
    block = motion.system.block
    return motion.record == "all" and (block is None or block.restrainer is None)


def unassessed(motion: Motion) -> list[str]:
    """Return the warnings of a motion without a validity report."""
    block = motion.system.block
    if block is None or block.restrainer is None:
        return [unchecked(motion)]
    return [*restrained_warnings(block, motion.peak, motion.system.restitution)]


def unchecked(motion: Motion) -> str:
    """Return the sentence on a motion whose events were not kept."""
    long = motion.cycles > MAX_CYCLES_KEPT
    why = f"more than {MAX_CYCLES_KEPT:,} cycles" if long else "too many events to keep"
    return f"sliding and jumping of the block were not checked: {why}"


def friction_row(motion: Motion, block: Block, friction: float | None) -> Iterator[Row]:
    """Yield the row of the friction required, with its time in s, if the events were kept."""
    if not is_assessed(motion):
        return
    validity = assessed(motion, block, friction)
    if validity.friction is None or validity.friction_time is None:
        yield "friction required", "not assessed"
    else:
        least = f"{validity.friction:.4g}" if validity.friction < math.inf else "none suffices"
        yield (
            "friction required",
            f"{least} ({validity.friction_source}, t = {block.seconds(validity.friction_time):.4g} s)",
        )


def validity_warnings(motion: Motion, block: Block, friction: float | None) -> list[str]:
    """Return the warnings of the validity report of a motion as lines."""
    return warning_lines(
        list(assessed(motion, block, friction).warnings) if is_assessed(motion) else unassessed(motion)
    )


def validity_record(motion: Motion, block: Block, friction: float | None = None) -> dict[str, Any] | None:
    """Return the validity report as a JSON object; None if the events were not kept, or for a restrained block."""
    return attrs.asdict(assessed(motion, block, friction)) if is_assessed(motion) else None


def validity_motion(verdict: Verdict) -> tuple[str, Motion]:
    """Return a description of the motion over which validity is evaluated, and the motion.

    The motion is one period of the orbit or, without orbit, the first cycles.
    """
    system, orbit = verdict.system, verdict.orbit
    if orbit is None:
        motion = run(system, verdict.start, min(max(verdict.cycles, 1), FIRST))
        return f"model validity over the first {counted(motion.cycles, 'cycle')}", motion
    begun = attrs.evolve(system, forcing=attrs.evolve(system.periodic, phase=orbit.phase))
    motion = run(begun, orbit.state, orbit.period)
    return "model validity over one response period (τ measured from its start)", motion


# Ground motion.


def record_text(motion: Motion, request: Request) -> Text:
    """Return the summary, with the warnings of the reader."""
    block, ground = block_of(request), request.records
    friction = request.options.get("friction")
    rows = [
        *of_ground(ground),
        *of_vertical(request.vertical),
        *of_direction(request),
        *of_block(motion, block),
    ]
    rows += record_rows(motion, block, friction)
    lines = warning_lines([*request.warnings, *undecided(motion)])
    lines += [*angle_warning(motion.start.angle, block), *validity_warnings(motion, block, friction)]
    return Text(refusal(motion, block, friction) or record_outcome(motion, block), rows, lines)


def block_of(request: Request) -> Block:
    """Return the block of a request in SI."""
    assert request.block is not None
    return request.block


def record_figure(plot: Any, motion: Motion, request: Request) -> Any:
    """Return the overview of a motion under the name of its record, and the sentence that it is no verdict if the block slides."""
    block = block_of(request)
    slides = refusal(motion, block, request.options.get("friction"))
    vertical = "with vertical motion" * (motion.system.vertical is not None)
    return with_name(plot.overview(motion, block), request.records, vertical, slides)


def with_name(figure: Any, ground: GroundMotion, *sentences: str) -> Any:
    """Return a figure with the name of its record, the component and the peak above it, and sentences, in lines that fit."""
    title = "\n".join(filter(None, (f"{named(ground)}, PGA {ground.pga / GRAVITY:.3g} g", *sentences)))
    figure.suptitle(title, fontsize="small", wrap=True)
    return figure


def named(ground: GroundMotion) -> str:
    """Return the name of a record with its component."""
    return ", ".join(filter(None, (ground.name, ground.component)))


def record_outcome(motion: Motion, block: Block) -> str:
    """Return the outcome in one line, with its time in s."""
    doubt = f" ({motion.doubt})" if motion.doubt else ""
    if motion.overturning is not None:
        since = ": certain" if motion.certified else ""
        return f"overturned{since} from t = {block.seconds(motion.overturning.time):.4g} s{doubt}"
    if motion.outcome is not Outcome.AT_REST:
        return f"bounded over {block.seconds(motion.duration):.4g} s (neither rest nor overturning was proved){doubt}"
    if motion.record != "all":
        return f"at rest permanently{doubt}"
    if not len(motion.events):
        return f"at rest throughout{doubt}"
    return f"at rest permanently from t = {block.seconds(float(motion.events['time'][-1])):.4g} s{doubt}"


def undecided(motion: Motion) -> Iterator[str]:
    """Yield a warning if rounding may have changed the outcome."""
    if not motion.certified:
        yield "the outcome is undecided in double precision: the rounding error may exceed what decides it"


def of_ground(ground: GroundMotion) -> Iterator[Row]:
    """Yield the rows of the ground motion."""
    yield "motion", named(ground)
    file = ground.file
    yield from of_file(ground)
    count = ground.acceleration.size
    yield "samples", f"{count}, step {ground.step:g} s, {ground.duration:.6g} s"
    treated = "as in the file" if ground.baseline == "none" else f"{ground.baseline} removed"
    yield "baseline", treated
    for each in ground.changes:
        yield "changed", each
    if ground.factor != 1.0:
        yield "scaled by", f"{ground.factor:.6g}"
    yield "PGA", f"{ground.pga:.4g} m/s² = {ground.pga / GRAVITY:.4g} g"
    if file is not None and file.header_pga is not None:
        agrees = "agrees with" if file.pga_agrees else "differs from"
        yield "PGA in the header", f"{file.header_pga:.4g} m/s², {agrees} the samples, {file.pga:.4g} m/s²"
    yield "PGV", f"{ground.pgv:.4g} m/s"
    yield "PGD", f"{ground.pgd:.4g} m, drift {ground.displacement[-1]:.4g} m at the end"
    yield "Arias intensity", f"{ground.arias_intensity:.4g} m/s"
    yield "CAV", f"{ground.cav:.4g} m/s"
    yield "significant duration", f"{ground.significant_duration:.4g} s"
    yield "bracketed duration", f"{ground.bracketed_duration():.4g} s, above 0.05 g"


def of_file(ground: GroundMotion) -> Iterator[Row]:
    """Yield the row of the file of a ground motion, if it is read from one."""
    if (file := ground.file) is not None:
        parts = (file.name, file.format, file.channel, f"SHA-256 {file.sha256[:DIGITS_OF_DIGEST]}…")
        yield "file", ", ".join(filter(None, parts))


def of_vertical(vertical: GroundMotion | None) -> Iterator[Row]:
    """Yield the rows of the vertical component, if there is one."""
    if vertical is None:
        return
    yield "vertical motion", named(vertical)
    yield from of_file(vertical)
    upwards = vertical.acceleration / GRAVITY
    yield "accelerates", f"from {upwards.min():.4g} to {upwards.max():.4g} g, positive upwards"


def of_direction(request: Request) -> Iterator[Row]:
    """Yield the row of the direction that counts, where both were followed."""
    if request.counted:
        told = {"+": "as recorded", "-": "opposite to that recorded"}[request.counted]
        yield "worse direction", f"{request.counted}, {told}"


def of_block(motion: Motion, block: Block) -> Iterator[Row]:
    """Yield the rows of the block and its initial state."""
    yield "block", f"{block.size}, Io/(MR²) = {block.inertia_ratio:.4g}"
    angles = [f"{math.degrees(angle):.4g}°" for angle in block.critical_angles]
    both = block.is_unsymmetric
    sides = f" for θ > 0, {angles[1]} for θ < 0" if both else ""
    yield "critical angle", f"{angles[0]}{sides}"
    full = motion.system.critical_angle is not None
    braced = motion.system.braces is not None
    if block.restrainer is None:
        by = block.normalised_by
        yield (
            "equation of motion",
            equation(*block.critical_angles, full=full, braced=braced, normalised_by=by),
        )
    else:
        yield "equation of motion", FULL if full else SMALL_ANGLES
        balance = f", unstable balance at {float(block.degrees(1.0)):.4g}°" if block.by_balance else ""
        yield "restrainer", f"κ = {block.stiffness_ratio:.4g}, ρ = {block.prestress_ratio:.4g}{balance}"
    yield time_unit(block), f"{block.seconds(1.0):.4g} s"
    weight = "" if motion.system.vertical is None else ", times the weight 1 + a_v"
    yield "lift-off from rest", lift_off_text(motion.system, block) + weight
    left = f" for θ > 0, {block.left_restitution:.6g} for θ < 0" if both else ""
    if block.wall is None:
        yield "restitution", f"e = {block.restitution:.6g}{left}, {origin(block)}"
    else:
        yield "wall", f"on the side θ < 0, e_w = {block.wall.restitution:.6g}"
    braces = motion.system.braces
    if braces is not None:
        yield "braces", f"{block.degrees(braces.angle):.4g}°, r = {braces.restitution:.6g}"
    yield "initial state", state_in_si(motion.start, block)


def lift_off_text(system: System, block: Block) -> str:
    """Return the base accelerations of lift-off; of a block with unequal sides, that of each direction."""
    first, second = system.lift_offs
    right = in_si("amplitude", first, block)
    if block.left is None:
        return f"above {right}"
    if system.wall is not None:
        return f"to θ > 0 below −{right.replace('= ', '= −')}"
    left = in_si("amplitude", second, block)
    return f"to θ > 0 below −{right.replace('= ', '= −')}, to θ < 0 above {left}"


def record_rows(motion: Motion, block: Block, friction: float | None) -> Iterator[Row]:
    """Yield the rows of the result."""
    yield "impacts", counted_impacts(motion)
    if motion.overturning is None:
        side = " of θ > 0" if block.is_unsymmetric else ""
        unit = angle_symbol(block)
        yield "largest |θ|", f"{reach(motion.peak, block)}, {motion.peak:.4g} {unit}{side}"
    yield margin_name(motion), margin_text(motion, block)
    yield from other_equation(motion)
    yield from friction_row(motion, block, friction)


def other_equation(motion: Motion) -> Iterator[Row]:
    """Yield the row of the outcome by the other equation of motion, if it differs."""
    from rocking.motion.validity import compared

    name, outcome = compared(motion)
    if name:
        yield name, outcome


def counted_impacts(motion: Motion) -> str:
    """Return the numbers of impacts and, with braces, of brace impacts."""
    braced = motion.system.braces is not None
    return f"{motion.impacts}" + (f", and {counted(motion.brace_hits, 'brace impact')}" if braced else "")


def margin_text(motion: Motion, block: Block) -> str:
    """Return the margin with its time, in words."""
    if math.isnan(motion.margin):
        if motion.system.braces:
            return "undefined between braces"
        return "none was found" if motion.peak > 0.0 else "undefined for a block that never moves"
    known = abs(margin_speed(motion, block))
    speed = f"{math.degrees(known):.4g}°/s"
    if math.isnan(known):
        speed = f"{abs(motion.margin):.4g} α θcr of its side"
    how = (
        f"had {speed} more than it needed to overturn"
        if motion.margin >= 0
        else f"lacked {speed} to overturn"
    )
    if motion.margin < 0 and motion.outcome is Outcome.OVERTURNED:
        how += ", but overturned later"
    return f"{motion.margin:.4g}: at t = {block.seconds(motion.margin_time):.4g} s the block {how}"


def record_more(motion: Motion, request: Request) -> dict[str, Any]:
    """Return the ground motion, the validity report and the warnings as JSON objects."""
    warnings = [*request.warnings, *undecided(motion)]
    direction = {"worse_direction": request.counted} if request.counted else {}
    own = {"ground_motion": facts(request.records) | direction}
    if request.vertical is not None:
        own["vertical_motion"] = facts(request.vertical)
    return {**own, **motion_validity(motion, request), "warnings": warnings}


def facts(ground: GroundMotion) -> dict[str, Any]:
    """Return a ground motion as a JSON object."""
    return {
        "name": ground.name,
        "component": ground.component,
        "file": None if ground.file is None else attrs.asdict(ground.file),
        "pga_agrees": None if ground.file is None else ground.file.pga_agrees,
        "samples": ground.acceleration.size,
        "step_s": ground.step,
        "duration_s": ground.duration,
        "baseline": ground.baseline,
        "changes": list(ground.changes),
        "factor": ground.factor,
        "pga_m_per_s2": ground.pga,
        "pgv_m_per_s": ground.pgv,
        "pgd_m": ground.pgd,
        "drift_m": float(ground.displacement[-1]),
        "arias_intensity_m_per_s": ground.arias_intensity,
        "cav_m_per_s": ground.cav,
        "significant_duration_s": ground.significant_duration,
        "bracketed_duration_s": ground.bracketed_duration(),
    }


RECORD = Report(record_text, figure=record_figure, more=record_more, rows=tables)


# Sliding.


def slide_text(result: Slip, request: Request) -> Text:
    """Return the slip and its intervals."""
    lines = warning_lines(request.warnings)
    return Text(str(result), [*of_ground(request.records), *slide_rows(result)], lines)


def slide_rows(result: Slip) -> Iterator[Row]:
    """Yield the rows of the result."""
    yield "coefficient of friction", f"{result.friction:g}"
    if not len(result.intervals):
        return
    yield "largest slip", f"{result.largest:.4g} m at t = {result.largest_time:.4g} s"
    yield "residual slip", f"{result.residual:.4g} m"
    yield "slip in all", f"{result.path:.4g} m"
    (first, _), (_, last) = result.intervals[[0, -1]]
    yield "slides", f"first from t = {first:.4g} s, rests from t = {last:.4g} s on"


def slide_more(_: Slip, request: Request) -> dict[str, Any]:
    """Return the ground motion and the warnings as JSON objects."""
    return {"ground_motion": facts(request.records), "warnings": list(request.warnings)}


def slide_figure(plot: Any, result: Slip, request: Request) -> Any:
    """Return the slip under the name of its record."""
    ax = plot.slip(result)
    with_name(ax.figure, request.records)
    return ax


SLIDE = Report(slide_text, figure=slide_figure, more=slide_more)


# Fit of the restitution.


def fit_text(fit: RestitutionFit, request: Request) -> Text:
    """Return the fitted values with their intervals."""
    return Text("coefficient of restitution from the times of impacts", fit_rows(fit), [])


def fit_rows(fit: RestitutionFit) -> Iterator[Row]:
    """Yield one row per value."""
    yield "", "value", "95 % interval"
    for name, unit, short in (
        ("restitution", "", "coefficient of restitution"),
        ("frequency_parameter", " 1/s", "frequency parameter"),
        ("angle", " θcr", "largest |θ| before the first impact"),
    ):
        value, low, high = (getattr(fit, f"{name}{end}") for end in ("", "_low", "_high"))
        yield short, f"{value:.5g}{unit}", "given" if low == high else f"{low:.5g} to {high:.5g}"
    yield "impacts", str(fit.dataset.sizes["impact"]), ""
    yield "deviation of the times from the fit", f"{1000.0 * fit.deviation:.3g} ms", ""
    yield "equation of motion", fit.model, ""


FIT_RESTITUTION = Report(fit_text)
