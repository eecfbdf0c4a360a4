"""Periodic orbits sought from many starts: Newton's method on the map over a period, or over half of one and mirrored."""

import math

from numba import njit

from .elementary import ENTRY, WITHIN
from .march import UNKNOWN
from .orbit import RESIDUAL, image_after
from .parameters import HarmonicParameters

MOST_STEPS = 30
FARTHEST = 1e3
# A step that makes the miss grow by more than this is halved, so often.
WORSE = 2.0
MOST_HALVINGS = 4


@njit(**WITHIN)
def as_one_cycle(p, cycles):
    """The same system, its cycle counted to last ``cycles`` forcing periods, halves too."""
    return HarmonicParameters(*p[:2], cycles * p.period, *p[3:])


@njit(**WITHIN)
def newton(p, angle, velocity, turned, nothing, columns):
    """(found, angle, velocity, residual): the fixed point of the map over one cycle of ``p`` times ``turned``.

    ``turned`` is -1 where the image is to be mirrored, else 1. A step is halved while it overturns the block or leads much
    farther off.
    """
    best, residual, to_angle, to_velocity, waits = math.inf, math.inf, 0.0, 0.0, UNKNOWN
    for _ in range(MOST_STEPS):
        share = 1.0
        for _ in range(MOST_HALVINGS + 1):
            at_angle, at_velocity = angle + share * to_angle, velocity + share * to_velocity
            if abs(at_angle) <= min(p.brace_angle, FARTHEST) and abs(at_velocity) <= FARTHEST:
                image = image_after(
                    p, at_angle, at_velocity, 1, 0.0, nothing.section, nothing, columns, False, waits
                )
                waits = image.waits
                miss = turned * image.angle - at_angle
                miss_rate = turned * image.velocity - at_velocity
                residual = max(abs(miss), abs(miss_rate))
                if image.certain and residual <= WORSE * best:
                    break
            share *= 0.5
        else:
            return False, angle, velocity, best
        angle, velocity, best = at_angle, at_velocity, residual
        a, b, c, d = (
            turned * image.tangent.a,
            turned * image.tangent.b,
            turned * image.tangent.c,
            turned * image.tangent.d,
        )
        growth = max(1.0, abs(a), abs(b), abs(c), abs(d))
        if residual <= RESIDUAL * growth:
            return True, angle, velocity, residual
        determinant = (1.0 - a) * (1.0 - d) - b * c
        to_angle = ((1.0 - d) * miss + c * miss_rate) / determinant
        to_velocity = (b * miss + (1.0 - a) * miss_rate) / determinant
        if not math.hypot(to_angle, to_velocity) < math.inf:
            return False, angle, velocity, residual
    return False, angle, velocity, residual


@njit(**ENTRY)
def hunt(p, cycles, turned, starts, nothing, columns, out):
    """Newton's method from every start; ``out`` (n, 4) takes (found, angle, velocity, residual). How many were found.

    ``cycles`` forcing periods go into the map; half-integer ones with ``turned`` -1.
    """
    whole = as_one_cycle(p, cycles)
    count = 0
    for i in range(starts.shape[0]):
        found, angle, velocity, residual = newton(whole, starts[i, 0], starts[i, 1], turned, nothing, columns)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = found, angle, velocity, residual
        count += found
    return count
