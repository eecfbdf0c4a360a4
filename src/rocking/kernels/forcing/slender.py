"""Bodies of ``forcing.contract`` that the slender block has for every forcing: its equation is u'' = u + f."""

import math

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing import contract
from rocking.kernels.forcing.arc import Transfer
from rocking.kernels.forcing.contract import acceleration_change_bound, forcing_term
from rocking.kernels.forcing.settling import settling_time
from rocking.kernels.numerics.elementary import hyperbolic


@njit(**INTERNAL_INLINE)
def hyperbolic_transfer(sinh, versinh):
    """Return the ``Transfer`` over a time with this hyperbolic sine and cosine less 1."""
    cosh = 1.0 + versinh
    return Transfer(cosh, sinh, sinh, cosh)


@njit(**INTERNAL_INLINE)
def restoring_acceleration(p):
    """Provide ``contract.restoring_acceleration``."""
    return 1.0


@njit(**INTERNAL_INLINE)
def restitution_at(p, speed):
    """Provide ``contract.restitution_at``: a constant."""
    return p.block.restitution, p.block.restitution


@njit(**INTERNAL_INLINE)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``."""
    return angle + forcing_term(p, side, drive)


@njit(**INTERNAL_INLINE)
def transfer(p, arc, start, time):
    """Provide ``contract.transfer``."""
    sinh, versinh, _, _ = hyperbolic(time)
    return hyperbolic_transfer(sinh, versinh)


@njit(**INTERNAL_INLINE)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``: the search for the event has the hyperbolic functions."""
    return hyperbolic_transfer(coming.sinh, coming.versinh)


@njit(**INTERNAL_INLINE)
def brace_settling_time(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``."""
    press = acceleration(p, side, p.block.brace_angle, drive)
    if p.block.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.block.brace_restitution))
    moved = acceleration_change_bound(p, drive, window)
    bound = settling_time(speed, p.block.brace_restitution, press - moved, press + moved, p.block.brace_angle)
    return bound if bound <= window else math.inf


SLENDER = {
    contract.brace_settling_time: brace_settling_time,
    contract.restitution_at: restitution_at,
    contract.acceleration: acceleration,
    contract.restoring_acceleration: restoring_acceleration,
    contract.transfer: transfer,
    contract.transfer_to_event: transfer_to_event,
}
