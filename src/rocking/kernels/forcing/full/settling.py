"""Bound on chattering (Zeno) of the full block: proof that it ends in rest, and when.

Near the base the block is accelerated back with press + sigma A cos(alpha), within (1 + alpha |A|) u, and near a brace likewise.
As long as the acceleration lies in [weakest, strongest], an arc returns with at most ``ratio`` times the speed with which it left.
So speeds fall by e * ratio.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.contract import acceleration
from rocking.kernels.forcing.full.base import acceleration_of, change_within
from rocking.kernels.forcing.full.restitution import largest_up_to

# Time that is looked at, relative to that of arcs under the present acceleration.
LONGER = 2.5


@njit(**INTERNAL)
def bounded(speed, e, press, moved, softness, clearance):
    """Return the bound on the time to rest, and on the angle, for accelerations within ``press`` +- ``moved`` and softness * u."""
    weakest, strongest = press - moved, press + moved
    if weakest <= 0.0:
        return math.inf, math.inf
    height = speed * speed / weakest
    softer = softness * height
    if not (softer <= 0.5 * weakest and height <= 0.5 * clearance):
        return math.inf, math.inf
    weakest, strongest = weakest - softer, strongest + softer
    ratio = math.sqrt(strongest / weakest)
    if e * ratio >= 1.0:
        return math.inf, math.inf
    return speed * (1.0 + ratio) / (weakest * (1.0 - e * ratio)), height


@njit(**INTERNAL)
def settling(p, drive, speed):
    """Provide ``contract.settling``."""
    block, swing = p.block, abs(acceleration_of(p, drive))
    e, press = largest_up_to(p, speed), block.press - block.cosine * swing
    if e >= 1.0 or press <= 0.0:
        return math.inf, math.inf
    window = LONGER * 2.0 * speed / (press * (1.0 - e))
    moved = change_within(p, drive, window)
    softness = 1.0 + block.critical_angle * (swing + moved)
    bound, height = bounded(speed, e, press, block.cosine * moved, softness, min(1.0, block.brace_angle))
    return (bound, height) if bound <= window else (math.inf, math.inf)


@njit(**INTERNAL)
def brace_settling_time(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``: as at the base, but on one side."""
    block = p.block
    e, press = block.brace_restitution, acceleration(p, side, block.brace_angle, drive)
    if e >= 1.0 or press <= 0.0:
        return math.inf
    window = LONGER * 2.0 * speed / (press * (1.0 - e))
    moved = change_within(p, drive, window)
    softness = 1.0 + block.critical_angle * (abs(acceleration_of(p, drive)) + moved)
    bound, _ = bounded(speed, e, press, moved, softness, block.brace_angle)
    return bound if bound <= window else math.inf
