"""One system after another: what is left of the motion of each after a transient, and where that motion begins."""

import math

from numba import njit

from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL
from rocking.kernels.march.march import CROWDED, DONE, OVERTURNED, UNKNOWN, begin, march_through
from rocking.kernels.march.progress import Recording
from rocking.kernels.parameters import parameters_from_row


@njit(**INTERNAL)
def march_state(p, angle, velocity, cycles, recording, tangent):
    """(status, Theta, Theta', peak) after whole cycles."""
    status, progress = march_through(p, begin(p, angle, velocity, UNKNOWN)[0], cycles, recording, tangent)
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
    kept, passing = section.shape[1], Recording(0.0, nothing.section, nothing.events, False, False)
    for k in range(systems.shape[0]):
        p = parameters_from_row(systems[k])
        time = ((section_phase - p.phase) % (2.0 * math.pi)) * p.per_frequency % p.period
        first = min(max(angle, -p.brace_angle), p.brace_angle)
        status, u, v = DONE, first, velocity
        if transient > 0:
            status, u, v, _ = march_state(p, first, velocity, transient, passing, nothing.tangent)
        if status not in (OVERTURNED, CROWDED):
            watched = Recording(time, section[k], nothing.events, True, False)
            status, u, v, peaks[k] = march_state(p, u, v, kept, watched, nothing.tangent)
        statuses[k] = status
        if status in (OVERTURNED, CROWDED):
            section[k] = math.nan
            peaks[k] = math.nan
        elif carry:
            angle, velocity = u, v
    return angle, velocity
