"""The limits of accumulating impacts (Zeno): when rest, or leaning, is certain, and how soon it comes at the latest."""

import math

from numba import njit

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.forcing.harmonic import acceleration_change_bound, forcing_term


@njit(**INTERNAL)
def settling_time(speed, restitution, weakest, strongest, clearance):
    """A bound on how long impacts go on, from one that leaves at ``speed``.

    The block is pressed back with ``weakest`` to ``strongest`` within ``clearance``. Infinite where they need
    not end. A hop's height stays below h = speed**2/weakest (<= weakest/2), so the press, less u, stays
    above ``weakest - h``; each impact returns at most ``ratio`` times the speed it left with, so speeds
    fall geometrically by restitution*ratio, and a hop lasts at most (1 + ratio)/(weakest - h) times its
    speed.
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


@njit(**KERNEL)
def base_settling_time(p, cosine, sine, speed):
    """A bound on the time from an impact to rest (Zeno limit at the base), infinite where not certain.

    On the sides of the base the block is pressed back with 1 +- A cos psi. The weaker of the two bounds both, and
    stays positive within the window, so it ends before lift-off.
    """
    swing = p.amplitude * abs(cosine)
    if p.restitution >= 1.0 or swing >= 1.0:
        return math.inf
    window = 5.0 * speed / ((1.0 - swing) * (1.0 - p.restitution))
    moved = acceleration_change_bound(p, sine, window)
    bound = settling_time(speed, p.restitution, 1.0 - swing - moved, 1.0 - swing + moved, p.brace_angle)
    return bound if bound <= window else math.inf


@njit(**KERNEL)
def brace_settling_time(p, cosine, sine, speed):
    """A bound on the time from a hit to leaning, infinite where it is not certain; the brace is pressed with brace_angle + f."""
    press = p.brace_angle + forcing_term(p, cosine)
    if p.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.brace_restitution))
    moved = acceleration_change_bound(p, sine, window)
    bound = settling_time(speed, p.brace_restitution, press - moved, press + moved, p.brace_angle)
    return bound if bound <= window else math.inf
