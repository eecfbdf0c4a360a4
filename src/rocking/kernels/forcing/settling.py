"""Bounds on chattering (Zeno), from a bound on the change of the base acceleration: proof that it ends, and when."""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.contract import acceleration_change_bound, acceleration_size


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
def settling_by_change(p, drive, speed):
    """Provide ``contract.settling`` by the bound on the change of the base acceleration.

    On the two sides of the base the block is accelerated back with 1 +- the base acceleration. The weaker of the two bounds
    both, and stays positive within the window, so that the window ends before lift-off.
    """
    swing = acceleration_size(p, drive)
    if p.block.restitution >= 1.0 or swing >= 1.0:
        return math.inf, math.inf
    window = 5.0 * speed / ((1.0 - swing) * (1.0 - p.block.restitution))
    moved = acceleration_change_bound(p, drive, window)
    weakest, strongest = 1.0 - swing - moved, 1.0 - swing + moved
    bound = settling_time(speed, p.block.restitution, weakest, strongest, p.block.brace_angle)
    if not bound <= window:
        return math.inf, math.inf
    return bound, 0.5 * speed * speed / (weakest - speed * speed / weakest)
