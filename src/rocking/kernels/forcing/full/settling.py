"""Bound on chattering (Zeno) of the full block: proof that it ends in rest, and when.

Near the base the block is accelerated back with press + sigma A cos(alpha), within (1 + alpha |A|) u. As long as the acceleration lies
in [weakest, strongest] on either side, an arc returns with at most ``ratio`` times the speed with which it left. So speeds fall by
e * ratio.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.full.base import acceleration_of, change_within

# Time that is looked at, relative to that of arcs under the present acceleration.
LONGER = 2.5


@njit(**INTERNAL)
def settling(p, drive, speed):
    """Provide ``contract.settling``."""
    block, swing = p.block, abs(acceleration_of(p, drive))
    e, present = block.restitution, block.press - block.cosine * swing
    if e >= 1.0 or present <= 0.0:
        return math.inf, math.inf
    window = LONGER * 2.0 * speed / (present * (1.0 - e))
    moved = change_within(p, drive, window)
    weakest, strongest = present - block.cosine * moved, present + block.cosine * moved
    if weakest <= 0.0:
        return math.inf, math.inf
    height = speed * speed / weakest
    softer = (1.0 + block.critical_angle * (swing + moved)) * height
    if not (softer <= 0.5 * weakest and height <= 0.5):
        return math.inf, math.inf
    weakest, strongest = weakest - softer, strongest + softer
    ratio = math.sqrt(strongest / weakest)
    if e * ratio >= 1.0:
        return math.inf, math.inf
    bound = speed * (1.0 + ratio) / (weakest * (1.0 - e * ratio))
    return (bound, height) if bound <= window else (math.inf, math.inf)
