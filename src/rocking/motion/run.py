"""Send a system through the compiled march, in breaths, and keep what was asked for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.kernels import march as kernel
from rocking.kernels import parameters as numbers
from rocking.model import System, TooManyEvents

if TYPE_CHECKING:
    from rocking.motion.motion import Motion

MOST_RECORDED = 10_000_000
NOTHING = np.empty((0, 2))


def parameters(system: System) -> numbers.HarmonicParameters:
    """Return a system as the kernels read it."""
    forcing, braces = system.forcing, system.braces
    return numbers.harmonic_parameters(
        forcing.amplitude,
        forcing.frequency,
        forcing.period,
        forcing.phase,
        system.restitution,
        math.inf if braces is None else braces.angle,
        1.0 if braces is None else braces.restitution,
    )


def run(
    p: Any, progress: Any, cycles: int, section_time: float, record: str, *, want_peak: bool
) -> tuple[Any, ...]:
    """March to the end, in breaths: (status, progress, section, event rows)."""
    section = np.empty((cycles + 1 if record == "section" else 0, 2))
    events = np.empty((4096 if record == "all" else 0, 8))
    rows: list[np.ndarray] = []
    status, recorded, done = kernel.PAUSED, 0, 0
    while status == kernel.PAUSED:
        status, progress, taken, written = kernel.march(
            p, progress, cycles, section_time, section[done:], events, NOTHING, NOTHING[:, 0], want_peak
        )
        done += taken
        recorded += written
        rows.append(events[:written].copy())
        if status == kernel.CROWDED or recorded > MOST_RECORDED:
            raise TooManyEvents(_crowded(status))
        if status == kernel.PAUSED and 0 < len(events) < 1_000_000:
            events = np.empty((4 * len(events), 8))
    if record == "section" and section_time == 0.0 and status != kernel.OVERTURNED:
        section[done] = state_of(progress)
        done += 1
    return status, progress, section[:done] + 0.0, rows  # no negative zeros


def _crowded(status: int) -> str:
    if status == kernel.CROWDED:
        return (
            f"more than {kernel.MOST_EVENTS:,} events in one forcing cycle: the block chatters almost without loss "
            "(start it faster, or take a smaller restitution)"
        )
    return f'more than {MOST_RECORDED:,} events to keep (run fewer cycles, or record="section" or "none")'


def section_of(motion: Motion, phase: float) -> np.ndarray:
    """Run a motion again for its section at another forcing phase."""
    forcing = motion.system.forcing
    time = math.fmod(phase - forcing.phase, 2.0 * math.pi) / forcing.frequency
    p = parameters(motion.system)
    progress, _ = kernel.begin_march(p, motion.start.angle, motion.start.velocity)
    return run(p, progress, motion.cycles, time % forcing.period, "section", want_peak=False)[2]


def state_of(progress: Any) -> tuple[float, float]:
    """Θ and Θ' of a block under way."""
    arc = progress.arc
    return arc.side * arc.angle + 0.0, arc.side * arc.velocity + 0.0
