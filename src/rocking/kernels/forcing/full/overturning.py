"""Proof that the full block overturns while it is shaken.

With x = |theta| - alpha, x'' = sin x - sigma a cos x >= r sin(x - beta) for |x| <= pi/2, where beta = arctan(a_m), r^2 = 1 + a_m^2,
and a_m >= sigma a from now on. For q = x' + 2 sqrt(r) sin((x - beta)/2), q' >= sqrt(r) cos((x - beta)/2) q. So q >= 0 remains, and
the block never returns. It also stays down once it lies flat, at |theta| = pi/2.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.full.base import largest_ahead

FLAT = 0.5 * math.pi


@njit(**INTERNAL)
def never_returns(p, side, angle, velocity, drive):
    """Return whether a block certainly never comes back to the base."""
    alpha = p.block.critical_angle
    if alpha * angle >= FLAT:
        return True
    x, slope = alpha * (angle - 1.0), alpha * velocity
    # Most blocks are far too slow, whatever the base does. With beta >= 0, r >= 1 and y = -x, 2 sin(y/2) >= y - y^3/24.
    if x < 0.0 and slope < -x * (1.0 - x * x / 24.0):
        return False
    largest = alpha * largest_ahead(p, side, drive)
    lean = x - math.atan(largest)
    return lean > -math.pi and slope + 2.0 * math.sqrt(math.hypot(1.0, largest)) * math.sin(0.5 * lean) >= 0.0
