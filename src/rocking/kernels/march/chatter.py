"""Bounds on chattering (Zeno): proof that it ends in rest or sustained contact, and an upper bound on when."""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.contract import acceleration_change_bound, acceleration_size, forcing_term


@njit(**INTERNAL)
def settling_time(speed, restitution, weakest, strongest, clearance):
    """Return an upper bound on the duration of chattering after an impact that leaves at ``speed``.

    The block is accelerated back with ``weakest`` to ``strongest`` within ``clearance``. Infinite if the
    impacts need not end. The height of an arc stays below h = speed**2/weakest (<= weakest/2), so the
    acceleration, less u, stays above ``weakest - h``. Each arc returns with at most ``ratio`` times the speed
    with which it left. So speeds fall geometrically by restitution*ratio. The duration of an arc is at most
    (1 + ratio)/(weakest - h) times its speed.
    """
    height = speed * speed / weakest
    if not (weakest > 0.0 and height <= 0.5 * min(weakest, clearance)):
        return math.inf
    press = weakest - height
    ratio = math.sqrt(strongest / press)
    fall = restitution * ratio
    if fall >= 1.0:
        return math.inf
    return speed * (1.0 + ratio) / (press * (1.0 - fall))


@njit(**INTERNAL)
def acceleration_to_base(p, drive, speed):
    """Return bounds on the acceleration towards the base after an impact, and the time for which they hold.

    On the two sides of the base the block is accelerated back with 1 +- the base acceleration. The weaker of the two bounds
    both.
    """
    swing = acceleration_size(p, drive)
    window = 5.0 * speed / ((1.0 - swing) * (1.0 - p.block.restitution))
    moved = acceleration_change_bound(p, drive, window)
    return 1.0 - swing - moved, 1.0 - swing + moved, window


@njit(**KERNEL)
def base_settling_time(p, drive, speed):
    """Return an upper bound on the time from an impact to rest (Zeno limit at the base).

    Infinite if rest is not certain. The acceleration towards the base stays positive within the window, so that the window ends
    before lift-off.
    """
    if p.block.restitution >= 1.0 or acceleration_size(p, drive) >= 1.0:
        return math.inf
    weakest, strongest, window = acceleration_to_base(p, drive, speed)
    bound = settling_time(speed, p.block.restitution, weakest, strongest, p.block.brace_angle)
    return bound if bound <= window else math.inf


@njit(**INTERNAL)
def highest_hop(p, drive, speed):
    """Return an upper bound on the angle from an impact to rest, given that ``base_settling_time`` is finite."""
    weakest, _, _ = acceleration_to_base(p, drive, speed)
    return 0.5 * speed * speed / (weakest - speed * speed / weakest)


@njit(**KERNEL)
def brace_settling_time(p, side, drive, speed):
    """Return an upper bound on the time from a brace impact to sustained contact; infinite if that is not certain.

    The acceleration into the brace is brace_angle + f.
    """
    press = p.block.brace_angle + forcing_term(p, side, drive)
    if p.block.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.block.brace_restitution))
    moved = acceleration_change_bound(p, drive, window)
    bound = settling_time(speed, p.block.brace_restitution, press - moved, press + moved, p.block.brace_angle)
    return bound if bound <= window else math.inf
