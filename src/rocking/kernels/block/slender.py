"""Slender block, eq. (1) of Yim & Lin (1991), normalised: eq. (4), u'' = u + f on each side of its base.

f = -1 - sigma A(tau) is ``contract.forcing_term``, with the base acceleration A. So an arc transfers perturbations by cosh t and sinh t.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import Transfer
from rocking.kernels.block.chattering import settling_time
from rocking.kernels.contract import acceleration_change_bound, forcing_term
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import hyperbolic
from rocking.kernels.system import Slender, Unsymmetric


@kernel(inline=True)
def hyperbolic_transfer(sinh, versinh):
    """Return the ``Transfer`` over a time with this hyperbolic sine and cosine less 1."""
    cosh = 1.0 + versinh
    return Transfer(cosh, sinh, sinh, cosh)


@body(contract.restoring_acceleration, Slender, inline=True)
def restoring_acceleration(p, side):
    """Provide ``contract.restoring_acceleration``."""
    return 1.0


@body(contract.escape_speed, Slender, inline=True)
def escape_speed(p):
    """Provide ``contract.escape_speed``: u' = 1 leads to the balance at u = 1."""
    return 1.0


@body(contract.impacts_per_trial, Unsymmetric, inline=True)
@body(contract.impacts_per_trial, Slender, inline=True)
def impacts_per_trial(p):
    """Provide ``contract.impacts_per_trial``.

    A trial costs as much as an impact. Over the ground motions of the benchmark a run takes the least time near this number.
    """
    return 8


@body(contract.change_of_side, Slender, inline=True)
def no_change(p, side, after):
    """Provide ``contract.change_of_side``."""
    return 1.0, 1.0


@body(contract.is_symmetric, Slender, inline=True)
def always_symmetric(p):
    """Provide ``contract.is_symmetric``."""
    return True


@body(contract.has_wall, Slender, inline=True)
def no_wall(p):
    """Provide ``contract.has_wall``."""
    return False


@body(contract.restitution_at, Slender, inline=True)
def restitution_at(p, side, speed):
    """Provide ``contract.restitution_at``: a constant."""
    return p.block.restitution, p.block.restitution


@body(contract.at_impact, Unsymmetric, inline=True)
@body(contract.at_impact, Slender, inline=True)
def at_impact(p, place):
    """Provide ``contract.at_impact``: the same system."""
    return p


@body(contract.is_scattered, Unsymmetric, inline=True)
@body(contract.is_scattered, Slender, inline=True)
def is_scattered(p):
    """Provide ``contract.is_scattered``."""
    return False


@body(contract.acceleration, Slender, inline=True)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``: u'' = u + f, eq. (4)."""
    return angle + forcing_term(p, side, drive)


@body(contract.transfer, Slender, inline=True)
def transfer(p, arc, start, time):
    """Provide ``contract.transfer``."""
    sinh, versinh, _, _ = hyperbolic(time)
    return hyperbolic_transfer(sinh, versinh)


@body(contract.transfer_to_event, Slender, inline=True)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``: the search for the event has the hyperbolic functions."""
    return hyperbolic_transfer(coming.sinh, coming.versinh)


@body(contract.brace_settling_time, Slender, inline=True)
def brace_settling_time(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``."""
    press = acceleration(p, side, p.block.brace_angle, drive)
    if p.block.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.block.brace_restitution))
    moved = acceleration_change_bound(p, drive, window)
    accelerations, e = (press - moved, press + moved), p.block.brace_restitution
    bound, _ = settling_time(speed, e, accelerations, 1.0, 0.0, p.block.brace_angle)
    return bound if bound <= window else math.inf
