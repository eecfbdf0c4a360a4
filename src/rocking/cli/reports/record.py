"""Report of a motion under a recorded ground motion, in SI units, as text or JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.reports import motion as common
from rocking.cli.reports import validity
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion
from rocking.model.text import counted
from rocking.model.verdict import Outcome

if TYPE_CHECKING:
    from rocking.motion.motion import Motion

DIGITS_OF_DIGEST = 12


def show(
    motion: Motion,
    block: Block,
    ground: GroundMotion,
    doubts: Sequence[str],
    files: Sequence[Path],
    *,
    as_json: bool,
) -> None:
    """Print the summary on stdout, with the warnings `doubts` of the reader, and the paths of the files."""
    if as_json:
        print_json(record(motion, block, ground, doubts, files))
        return
    rows = [*of_ground(ground), *of_block(motion, block), *found(motion, block)]
    more = validity.warned([*doubts, *undecided(motion)])
    more += [*common.beyond(motion.start.angle, block), *validity.warned_of(motion, block)]
    print_table(verdict(motion, block), rows, files, more)


def heading(ground: GroundMotion) -> str:
    """Return the name of a record with its component and its peak, for a figure."""
    return f"{named(ground)}, PGA {ground.pga / GRAVITY:.3g} g"


def named(ground: GroundMotion) -> str:
    """Return the name of a record with its component."""
    return ", ".join(filter(None, (ground.name, ground.component)))


def verdict(motion: Motion, block: Block) -> str:
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
    if not motion.certified and motion.system.critical_angle is None:
        yield "the outcome is undecided in double precision: the rounding error may exceed what decides it"


def of_ground(ground: GroundMotion) -> Iterator[Row]:
    """Yield the rows of the ground motion."""
    yield "motion", named(ground)
    file = ground.file
    if file is not None:
        parts = (file.name, file.format, file.channel, f"SHA-256 {file.sha256[:DIGITS_OF_DIGEST]}…")
        yield "file", ", ".join(filter(None, parts))
    count = ground.acceleration.size
    yield "samples", f"{count}, step {ground.step:g} s, {ground.duration:.6g} s"
    treated = "as in the file" if ground.baseline == "none" else f"{ground.baseline} removed"
    yield "baseline", treated
    if ground.factor != 1.0:
        yield "scaled by", f"{ground.factor:.6g}"
    yield "PGA", f"{ground.pga:.4g} m/s² = {ground.pga / GRAVITY:.4g} g"
    if file is not None and file.header_pga is not None:
        agrees = "agrees with" if file.pga_agrees else "differs from"
        yield "PGA in the header", f"{file.header_pga:.4g} m/s², {agrees} the samples, {file.pga:.4g} m/s²"
    yield "PGV", f"{ground.pgv:.4g} m/s"
    yield "PGD", f"{ground.pgd:.4g} m, drift {ground.displacement[-1]:.4g} m at the end"
    yield "Arias intensity", f"{ground.arias_intensity:.4g} m/s"
    yield "significant duration", f"{ground.significant_duration:.4g} s"


def of_block(motion: Motion, block: Block) -> Iterator[Row]:
    """Yield the rows of the block and its initial state."""
    yield "block", f"{block.size}, Io/(MR²) = {block.inertia_ratio:.4g}"
    yield "critical angle", f"{block.degrees(1.0):.4g}°"
    full = motion.system.critical_angle is not None
    braced = motion.system.braces is not None
    yield "equation of motion", validity.equation(block.critical_angle, full=full, braced=braced)
    yield "time unit 1/α", f"{block.seconds(1.0):.4g} s"
    yield "lift-off from rest", f"above {common.in_si('amplitude', motion.system.lift_off, block)}"
    yield "restitution", f"e = {block.restitution:.6g}, {common.origin(block)}"
    braces = motion.system.braces
    if braces is not None:
        yield "braces", f"{block.degrees(braces.angle):.4g}°, r = {braces.restitution:.6g}"
    yield "initial state", common.state_in_si(motion.start, block)


def found(motion: Motion, block: Block) -> Iterator[Row]:
    """Yield the rows of the result."""
    yield "impacts", counted_impacts(motion)
    if motion.overturning is None:
        yield "largest |θ|", f"{common.reach(motion.peak, block)}, {motion.peak:.4g} θcr"
    yield "margin K₊", margin(motion, block)
    yield from validity.friction_row(motion, block)


def counted_impacts(motion: Motion) -> str:
    """Return the numbers of impacts and, with braces, of brace impacts."""
    braced = motion.system.braces is not None
    return f"{motion.impacts}" + (f", and {counted(motion.brace_hits, 'brace impact')}" if braced else "")


def margin(motion: Motion, block: Block) -> str:
    """Return the margin with its time, in words."""
    if math.isnan(motion.margin):
        if motion.system.critical_angle is not None:
            return "undefined for the full equation of motion"
        return "undefined " + ("between braces" if motion.system.braces else "for a block that never moves")
    speed = common.in_si("velocity", abs(motion.margin), block)
    how = (
        f"had {speed} more than it needed to overturn"
        if motion.margin >= 0
        else f"lacked {speed} to overturn"
    )
    if motion.margin < 0 and motion.outcome is Outcome.OVERTURNED:
        how += ", but overturned later"
    return f"{motion.margin:.4g}: at t = {block.seconds(motion.margin_time):.4g} s the block {how}"


def record(
    motion: Motion, block: Block, ground: GroundMotion, doubts: Sequence[str], files: Sequence[Path]
) -> dict[str, Any]:
    """Return the summary as a JSON object."""
    overturning = motion.overturning
    return {
        "outcome": str(motion.outcome),
        "model": "slender" if motion.system.critical_angle is None else "full",
        "certified": motion.certified,
        "overturning_s": None if overturning is None else float(block.seconds(overturning.time)),
        "ground_motion": {
            "name": ground.name,
            "component": ground.component,
            "file": None if ground.file is None else attrs.asdict(ground.file),
            "pga_agrees": None if ground.file is None else ground.file.pga_agrees,
            "samples": ground.acceleration.size,
            "step_s": ground.step,
            "duration_s": ground.duration,
            "baseline": ground.baseline,
            "factor": ground.factor,
            "pga_m_per_s2": ground.pga,
            "pgv_m_per_s": ground.pgv,
            "pgd_m": ground.pgd,
            "drift_m": float(ground.displacement[-1]),
            "arias_intensity_m_per_s": ground.arias_intensity,
            "significant_duration_s": ground.significant_duration,
        },
        "block": common.size_of(block)
        | {"inertia_ratio": block.inertia_ratio, "restitution_is_housners": block.has_housner_restitution},
        **common.question(motion),
        "duration": motion.duration,
        "duration_s": float(block.seconds(motion.duration)),
        "impacts": motion.impacts,
        "brace_hits": motion.brace_hits,
        "impacts_cut_short": motion.record != "all",
        "peak": motion.peak,
        **common.peak_in_si(motion, block),
        "margin": motion.margin,
        "margin_time_s": float(block.seconds(motion.margin_time)),
        "final": attrs.asdict(motion.final),
        "validity": validity.record(motion, block),
        "warnings": [*doubts, *undecided(motion)],
        "files": [str(path) for path in files],
    }
