"""Admissibility of a symmetric mode: its closed form, eq. (8) of Yim & Lin (1991), must not pass through Theta = 0.

On the positive side, from one impact to the next a time ``length`` = n pi/Omega later,

    u = a e^-t + b e^-(length - t) + 1 + beta cos(phi + Omega t).

Both exponentials decay from their end of the half-cycle, so that no term grows however long it is. The mode
is followed from both ends to the middle, in pieces that each start from this form. So rounding grows by at
most e^PIECE, and no tolerance is needed for the impact at the far end.
"""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.arc import CROSSING
from rocking.kernels.forcing.harmonic.acceleration import particular
from rocking.kernels.forcing.harmonic.extrema import arc_peak
from rocking.kernels.forcing.harmonic.first_zero import base_event_function, first_zero
from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters, at_phase
from rocking.kernels.forcing.harmonic.solution import arc_from
from rocking.kernels.numerics.elementary import direction

PIECE = 4.0


@njit(**INTERNAL)
def first_half(p, speed, near, far, length):
    """Follow a mode from u = 0 with ``speed`` to the middle; ``near`` and ``far`` are a, b above.

    Returns
    -------
    tuple of (bool, float)
        Whether u > 0 up to the middle.
        Largest value of u.
    """
    middle, peak = 0.5 * length, 0.0
    pieces = math.ceil(middle / PIECE)
    step = middle / pieces
    angle, velocity = 0.0, speed
    for k in range(pieces):
        arc = arc_from(p, 1, k * step, angle, velocity)
        found, _, _ = first_zero(p, arc, base_event_function(p), 0.0, step)
        if found == CROSSING:
            return False, peak
        peak = arc_peak(p, arc, step, peak)
        t = (k + 1) * step
        sine, cosine, _, _ = direction(p.forcing.frequency * t + p.forcing.phase)
        displacement, forced_velocity = particular(p, cosine, sine)
        leaving, coming = near * math.exp(-t), far * math.exp(t - length)
        angle, velocity = leaving + coming + 1.0 + displacement, coming - leaving + forced_velocity
        if angle <= 0.0:
            return False, peak
    return True, peak


@entry_point(**KERNEL)
def half_cycle(
    p: HarmonicParameters, speed: float, near: float, far: float, length: float
) -> tuple[bool, float]:
    """Follow a mode that leaves the base with ``speed`` at phase ``p.forcing.phase`` through its half-cycle.

    In reversed time the half-cycle begins at phase pi - phi with the speed before the impact.

    Returns
    -------
    tuple of (bool, float)
        Whether u > 0 inside the half-cycle.
        Largest value of u.
    """
    up, peak = first_half(p, speed, near, far, length)
    if not up:
        return False, peak
    backwards = at_phase(p, math.pi - p.forcing.phase)
    up, other = first_half(backwards, speed / p.block.restitution, far, near, length)
    return up, max(peak, other)
