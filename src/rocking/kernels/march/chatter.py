"""Chattering (Zeno) after an impact: when it certainly ends in rest or sustained contact."""

import math

from rocking.kernels.compile_options import KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing import contract


@njit(**KERNEL)
def base_settling_time(p, drive, speed, peak):
    """Return an upper bound on the time from an impact to rest (Zeno limit at the base).

    Infinite if rest is not certain, or if the angle may exceed ``peak`` until then.
    """
    bound, highest = contract.settling(p, drive, speed)
    return bound if highest <= peak else math.inf


@njit(**KERNEL)
def brace_settling_time(p, side, drive, speed):
    """Return an upper bound on the time from a brace impact to sustained contact; infinite if that is not certain."""
    return contract.brace_settling_time(p, side, drive, speed)
