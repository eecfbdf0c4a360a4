"""Validity of the model for a block in SI: lines and JSON of the reports."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import attrs

from rocking.cli.output.console import WARNING, Row
from rocking.cli.output.motion_files import MAX_CYCLES_KEPT, run
from rocking.model.block import Block
from rocking.model.text import counted
from rocking.model.verdict import Verdict

if TYPE_CHECKING:
    from rocking.motion.motion import Motion

FIRST = 200
"""Number of initial cycles over which the validity of a non-periodic response is evaluated."""


def lines(motion: Motion, block: Block | None) -> list[str]:
    """Return the lines of the validity report of a motion; none without a block."""
    if block is None:
        return []
    return str(motion.validity(block)).splitlines() if motion.record == "all" else warned([unchecked(motion)])


def unchecked(motion: Motion) -> str:
    """Return the sentence on a motion whose events were not kept."""
    long = motion.cycles > MAX_CYCLES_KEPT
    why = f"more than {MAX_CYCLES_KEPT:,} cycles" if long else "too many events to keep"
    return f"sliding and jumping of the block were not checked: {why}"


def friction_row(motion: Motion, block: Block) -> Iterator[Row]:
    """Yield the row of the friction required, with its time in s, if the events were kept."""
    if motion.record != "all":
        return
    found = motion.validity(block)
    if found.friction is None or found.friction_time is None:
        yield "friction required", "not assessed"
    else:
        least = f"{found.friction:.4g}" if found.friction < math.inf else "none suffices"
        yield (
            "friction required",
            f"{least} ({found.friction_source}, t = {block.seconds(found.friction_time):.4g} s)",
        )


def warned_of(motion: Motion, block: Block) -> list[str]:
    """Return the warnings of the validity report of a motion as lines."""
    return warned(list(motion.validity(block).warnings) if motion.record == "all" else [unchecked(motion)])


def record(motion: Motion, block: Block) -> dict[str, Any] | None:
    """Return the validity report as a JSON object; None if the events were not kept."""
    return attrs.asdict(motion.validity(block)) if motion.record == "all" else None


def validity_motion(verdict: Verdict) -> tuple[str, Motion]:
    """Return a description of the motion over which validity is evaluated, and the motion.

    The motion is one period of the orbit or, without orbit, the first cycles.
    """
    system, orbit = verdict.system, verdict.orbit
    if orbit is None:
        motion = run(system, verdict.start, min(max(verdict.cycles, 1), FIRST), ())
        return f"model validity over the first {counted(motion.cycles, 'cycle')}", motion
    begun = attrs.evolve(system, forcing=attrs.evolve(system.periodic, phase=orbit.phase))
    motion = run(begun, orbit.state, orbit.period, ())
    return "model validity over one response period (τ measured from its start)", motion


def equation(critical_angle: float, *, full: bool, braced: bool = False) -> str:
    """Return the equation of motion in words, that of small angles with its errors for |θ| ≤ θcr, in rad."""
    from rocking.motion.model_warnings import slender_errors

    if full:
        return "full"
    worst = max(slender_errors(critical_angle, critical_angle))
    remedy = "" if braced else " (--model full avoids this)"
    return f"small angles; moments overestimated by up to {100.0 * worst:.1f} %{remedy}"


def equation_line(block: Block, model: str) -> str:
    """Return the equation of motion of a survey of one block, as a line below a table with a row per record."""
    return f"equation of motion: {equation(block.critical_angle, full=model == 'full')}"


def survey_warnings(block: Block, model: str) -> list[str]:
    """Return the warnings about the block of a survey of ground motions."""
    return warnings(block, (), block.restitution, full=model == "full")


def shape_warnings(height: float, critical_angle: float, *, full: bool) -> Iterator[str]:
    """Yield the warnings about blocks of many shapes, up to a height in m and a critical angle in rad."""
    from rocking.motion.model_warnings import height_warnings, proportion_warnings

    yield from height_warnings(height)
    if not full:
        yield from proportion_warnings(critical_angle, critical_angle)


def warnings(block: Block | None, amplitudes: Any, restitutions: Any, *, full: bool = False) -> list[str]:
    """Return the warnings about the block itself, independent of its motion; none without a block."""
    if block is None:
        return []
    import numpy as np

    from rocking.motion.model_warnings import block_warnings

    return list(block_warnings(block, amplitudes, float(np.min(restitutions)), full=full))


def warned(sentences: list[str]) -> list[str]:
    """Return sentences as warning lines below a table."""
    return [f"{WARNING}{sentence}" for sentence in sentences]
