"""Unstable manifolds of the saddle orbit 1 + beta cos psi and its mirror image, inward branches, along exact lines.

For other orbits there are images of any states on the section.

On its side of the base every motion that comes from the saddle orbit is s = (u, u')_saddle - c e^t (1, 1). It
has not touched the base before as long as c e^t < 1 - beta. So the lines need no small distance from the
saddle, and the time spent near it does not magnify rounding.
"""

import math

from rocking.kernels.arc.arc import shift_clock
from rocking.kernels.arc.first_zero_cosine import any_event
from rocking.kernels.base.cosine import particular
from rocking.kernels.block.impact import after_event
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2, Integers1
from rocking.kernels.motion.march import MAX_EVENTS, UNKNOWN, begin
from rocking.kernels.motion.observers import state_at
from rocking.kernels.numerics.elementary import cosine_of, sine_of
from rocking.kernels.system import Cosine, Slender, slender_harmonic, slender_later

# Distance from the saddle orbit, over 1 - beta, at which a motion is started.
NEAR = 0.5


@entry_point
def swings(amplitudes: Floats1, frequencies: Floats1, phases: Floats1, out: Floats2) -> None:
    """Write beta cos psi and its derivative into ``out`` (n, 2): the deviation of a saddle orbit from its corner."""
    for k in range(out.shape[0]):
        frequency = frequencies[k]
        p = slender_harmonic(
            amplitudes[k], frequency, 2.0 * math.pi / frequency, phases[k], 1.0, math.inf, 1.0
        )
        out[k, 0], out[k, 1] = particular(p, cosine_of(phases[k]), sine_of(phases[k]))


@kernel
def leaving(p, side):
    """Return Theta and Theta' of the motion that is NEAR (1 - beta) from the saddle orbit when its clock starts."""
    displacement, forced_velocity = particular(
        p, side * cosine_of(p.forcing.phase), side * sine_of(p.forcing.phase)
    )
    distance = NEAR * (1.0 - p.forcing.response)
    return side * (1.0 + displacement - distance), side * (forced_velocity - distance)


@kernel
def section_after(q, angle, velocity, cycles, wait):
    """Return whether the events were not too many, and (Theta, Theta') after whole cycles and a further time.

    A motion that overturns is followed all the same.
    """
    progress, _ = begin(q, angle, velocity, UNKNOWN)
    mode, arc, crowd = progress.mode, progress.arc, 0
    while True:
        end = cycles * q.forcing.period + wait
        coming = any_event(q, mode, arc)
        at = arc.start + coming.wait
        if at > end:
            break
        crowd += 1
        if crowd > MAX_EVENTS:
            return False, 0.0, 0.0
        mode, arc = after_event(q, arc, at, coming, end - at, math.inf)
        while cycles > 0 and arc.start > q.forcing.period:
            arc, cycles = shift_clock(arc, q.forcing.period), cycles - 1
    angle, velocity = state_at(q, mode, arc, end - arc.start)
    return True, angle, velocity


@entry_point
def images(p: Slender[Cosine], side: int, times: Floats1, out: Floats2) -> bool:
    """Write (Theta, Theta') into ``out`` (n, 2), at the section psi = phase, a time ``times[k]`` after ``leaving``.

    Returns False if a motion has too many events.
    """
    for k in range(times.shape[0]):
        cycles = math.floor(times[k] / p.forcing.period)
        wait = min(max(times[k] - cycles * p.forcing.period, 0.0), p.forcing.period)
        q = slender_later(p, -wait)
        angle, velocity = leaving(q, side)
        followed, out[k, 0], out[k, 1] = section_after(q, angle, velocity, cycles, wait)
        if not followed:
            return False
    return True


@entry_point
def returns(p: Slender[Cosine], starts: Floats2, cycles: Integers1, out: Floats2) -> bool:
    """Write (Theta, Theta') into ``out`` (n, 2), ``cycles[k]`` forcing cycles after the state ``starts[k]`` at the section.

    Returns False if a motion has too many events.
    """
    for k in range(starts.shape[0]):
        followed, out[k, 0], out[k, 1] = section_after(p, starts[k, 0], starts[k, 1], cycles[k], 0.0)
        if not followed:
            return False
    return True


@entry_point
def first_impacts(p: Slender[Cosine], side: int, waits: Floats1, out: Floats2) -> None:
    """Write (psi, speed just before) of the first impact into ``out`` (n, 2).

    Motion k starts ``leaving`` at ``waits[k]``. NaN if its first event is no impact.
    """
    for k in range(waits.shape[0]):
        q = slender_later(p, waits[k])
        angle, velocity = leaving(q, side)
        arc = begin(q, angle, velocity, UNKNOWN)[0].arc
        coming = any_event(q, FLIGHT, arc)
        out[k] = math.nan
        if coming.event == IMPACT:
            out[k, 0] = p.forcing.phase + p.forcing.frequency * (waits[k] + coming.wait)
            out[k, 1] = -coming.velocity
