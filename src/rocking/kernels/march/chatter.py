"""Chattering (Zeno) after an impact: when it certainly ends in rest or sustained contact."""

import math

from rocking.kernels.compile_options import KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.contract import acceleration, acceleration_change_bound, settling
from rocking.kernels.forcing.settling import settling_time


@njit(**KERNEL)
def base_settling_time(p, drive, speed):
    """Return an upper bound on the time from an impact to rest (Zeno limit at the base); infinite if rest is not certain."""
    bound, _ = settling(p, drive, speed)
    return bound


@njit(**KERNEL)
def brace_settling_time(p, side, drive, speed):
    """Return an upper bound on the time from a brace impact to sustained contact; infinite if that is not certain."""
    press = acceleration(p, side, p.block.brace_angle, drive)
    if p.block.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.block.brace_restitution))
    moved = acceleration_change_bound(p, drive, window)
    bound = settling_time(speed, p.block.brace_restitution, press - moved, press + moved, p.block.brace_angle)
    return bound if bound <= window else math.inf
