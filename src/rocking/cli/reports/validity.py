"""Whether the model applies to the block of an answer in SI: as `simulate` says it, and as the others do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import attrs

from rocking.cli.output.console import WARNING
from rocking.cli.output.motion_files import MAX_CYCLES_KEPT, run
from rocking.model import Block, Verdict, counted

if TYPE_CHECKING:
    from rocking.motion import Motion

FIRST = 200
"""Cycles from the start over which a response is judged that is not periodic."""


def lines(motion: Motion, block: Block | None) -> list[str]:
    """How far a motion keeps to the model, in a few lines; nothing for a normalised system."""
    if block is None:
        return []
    if motion.record != "all":
        long = motion.cycles > MAX_CYCLES_KEPT
        why = f"more than {MAX_CYCLES_KEPT:,} cycles" if long else "more events than are kept"
        return [f"{WARNING}whether the block slides or jumps is not judged: {why}"]
    return str(motion.validity(block)).splitlines()


def record(motion: Motion, block: Block) -> dict[str, Any] | None:
    """The same for a program to read."""
    return attrs.asdict(motion.validity(block)) if motion.record == "all" else None


def validity_motion(verdict: Verdict) -> tuple[str, Motion]:
    """The motion by which a response is judged, and what it is: a period of its orbit, else how it begins."""
    system, orbit = verdict.system, verdict.orbit
    if orbit is None:
        motion = run(system, verdict.start, min(max(verdict.cycles, 1), FIRST), ())
        return f"the model is judged over the first {counted(motion.cycles, 'cycle')}", motion
    begun = attrs.evolve(system, forcing=attrs.evolve(system.forcing, phase=orbit.phase))
    motion = run(begun, orbit.state, orbit.period, ())
    return "the model is judged over a period of the response, τ from its beginning", motion


def warnings(block: Block | None, amplitudes: Any, restitutions: Any) -> list[str]:
    """What concerns the block itself, whatever its motions; nothing for a normalised system."""
    if block is None:
        return []
    import numpy as np

    from rocking.motion import block_warnings

    return list(block_warnings(block, amplitudes, float(np.min(restitutions))))


def warned(sentences: list[str]) -> list[str]:
    """The same as lines under a table."""
    return [f"{WARNING}{sentence}" for sentence in sentences]
