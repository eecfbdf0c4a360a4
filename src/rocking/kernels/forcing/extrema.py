"""Extrema of the angle along an arc, one after another, for every forcing."""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import CROSSING, within_reach
from rocking.kernels.forcing.contract import acceleration, evaluate, next_turn


@njit(**INTERNAL)
def first_turn_sign(p, arc):
    """Return the sign of u' just after the start of an arc; positive if both u' and u'' vanish (lift-off)."""
    if arc.velocity != 0.0:
        return math.copysign(1.0, arc.velocity)
    return -1.0 if acceleration(p, arc.side, arc.angle, arc.drive) < 0.0 else 1.0


@njit(**INTERNAL)
def arc_peak(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles on the arc up to ``until``."""
    now = evaluate(p, arc, until)
    peak = max(peak, within_reach(p, now.angle))
    t = 0.0
    sign = first_turn_sign(p, arc)
    while True:
        found, t, now = next_turn(p, arc, sign, t, until)
        if found != CROSSING:
            return peak
        peak = max(peak, within_reach(p, now.angle))
        sign = -sign
