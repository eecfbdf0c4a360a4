"""One system after another: what is left of the motion of each after a transient, and where that motion begins."""

import math

from numba import njit

from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL
from rocking.kernels.march.march import CROWDED, DONE, OVERTURNED, PAUSED, UNKNOWN, begin, march_on
from rocking.kernels.parameters import make


@njit(**INTERNAL)
def marched(p, angle, velocity, cycles, section_time, section, nothing, want_peak):
    """(status, Theta, Theta', peak) after whole cycles; ``section`` takes the states at ``section_time``."""
    progress, _ = begin(p, angle, velocity, UNKNOWN)
    status, rows = PAUSED, 0
    while status == PAUSED:
        status, progress, taken, _ = march_on(
            p,
            progress,
            cycles,
            section_time,
            section[rows:],
            nothing.events,
            nothing.columns,
            nothing.growth,
            want_peak,
            False,
        )
        rows += taken
    arc = progress.arc
    return status, arc.side * arc.angle + 0.0, arc.side * arc.velocity + 0.0, progress.peak


@njit(**ENTRY_POINT)
def sweep(systems, angle, velocity, carry, transient, section_phase, section, peaks, statuses, nothing):
    """(Theta, Theta') with which the next system would begin, when all of ``systems`` (n, 7) have had their turn.

    1. A row of ``systems`` is what ``make`` takes. Each is run for ``transient`` cycles, and for as many more as
       ``section`` (n, m, 2) has rows for it, which take the states where the forcing's phase is ``section_phase``.
    2. The first begins at (angle, velocity); with ``carry`` each next one where the one before has ended, on the
       near side of its braces, or, if that has overturned, where that began; without, every one at (angle, velocity).
    3. Where a motion overturns or is crowded (``march.Status``, in ``statuses``), section and peak are NaN.
    """
    kept = section.shape[1]
    for k in range(systems.shape[0]):
        row = systems[k]
        p = make(row[0], row[1], row[2], row[3], row[4], row[5], row[6])
        time = ((section_phase - p.phase) % (2.0 * math.pi)) * p.per_frequency % p.period
        first = min(max(angle, -p.brace_angle), p.brace_angle)
        status, u, v = DONE, first, velocity
        if transient > 0:
            status, u, v, _ = marched(p, first, velocity, transient, 0.0, section[k, :0], nothing, False)
        if status not in (OVERTURNED, CROWDED):
            status, u, v, peaks[k] = marched(p, u, v, kept, time, section[k], nothing, True)
        statuses[k] = status
        if status in (OVERTURNED, CROWDED):
            section[k] = math.nan
            peaks[k] = math.nan
        elif carry:
            angle, velocity = u, v
    return angle, velocity
