"""Margin and rounding errors of a restrained full block.

**Margin.** It is that of ``motion.unstable_balance``, with the balance b of the restrained block instead of its critical angle. After the
base motion the bounded motion has the energy of the balance: its speed is W(theta) = sqrt(2 (P(b) - P(theta))), with the sign of
b - theta, where P is the integral of the torque. While the base moves, W is approximated by this and by the response to the base
acceleration of the equation that is linear in theta - b. It grows at the rate r with r^2 = -dG/dtheta at b. A block without a balance up
to where it lies flat has no margin. Nor has a motion along which du''/du is not positive.

W'' is d2G/dtheta2/(3 r) at the balance, about rho alpha/(4 r), and that of the free block besides.

**Rounding errors.** A stiff restrainer makes perturbations oscillate. They do not outgrow their origin then, so that the errors of all
steps of an arc count, not of those in a unit of time. The curvature of the equation is at most 1 + kappa + rho times that of the
free block, and so is the part of an error that is not linear.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.full_restrained import half_angle, pushes_under_samples
from rocking.kernels.arc.full_series import brief_divided_1, brief_restrained_series
from rocking.kernels.arc.full_step import lean_of
from rocking.kernels.base.samples import Samples
from rocking.kernels.contract import drive_later, response_ahead, smooth_time
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.motion.rounding_errors import LINEAR, end_of_full_is_sure, error_of_steps, spread_of
from rocking.kernels.motion.unstable_balance import LONGEST, Approach, bend_of
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.restrainer import energy_between, torque
from rocking.kernels.system import Restrained

# Distance from the balance, in rad, below which the derivative of W is that at the balance.
CLOSE = 1e-6


@kernel
def free_velocity(p, angle):
    """Return W without base motion, and -1 times its derivative by u; NaN if there is no balance."""
    alpha, own = p.block.critical_angle, p.restrainer
    if own.balance == math.inf:
        return math.nan, own.rate
    theta = alpha * angle
    square = 2.0 * energy_between(alpha, own.stiffness, own.prestress, 0.0, theta, own.balance)
    speed = math.sqrt(max(square, 0.0))
    if abs(own.balance - theta) < CLOSE or speed == 0.0:
        return own.rate * (own.balance - theta) / alpha, own.rate
    slope = abs(torque(alpha, own.stiffness, own.prestress, 0.0, theta)) / speed
    return math.copysign(speed, own.balance - theta) / alpha, slope


@body(contract.bounded_velocity, Restrained)
def bounded_velocity(p, side, angle, drive):
    """Provide ``contract.bounded_velocity``."""
    speed, slope = free_velocity(p, angle)
    factor = p.balanced.clock.cycle_length / p.clock.cycle_length
    there = contract.drive_in(p.resting, p.balanced, drive, factor)
    return speed + side * response_ahead(p.balanced, there), slope


@body(contract.excess_at_end, Restrained)
def excess_at_end(p, side, angle, velocity):
    """Provide ``contract.excess_at_end``, in closed form."""
    speed, slope = free_velocity(p, angle)
    return velocity - speed, slope


@body(contract.approach_of, Restrained, inline=True)
def approach_of(p):
    """Provide ``contract.approach_of``: far from the balance -W_u, and its effect on the response, are only about the rate there."""
    own = p.restrainer
    return Approach(bend_of(p) * (1.0 + own.prestress) / own.rate, True, 8.0, 40)


@body(contract.estimate_error, Restrained, inline=True)
def estimate_error(p):
    """Provide ``contract.estimate_error``."""
    return 0.3


@body(contract.smooth_step, Restrained, Samples)
def step_between_samples(p, side, angle, velocity, drive):
    """Provide ``contract.smooth_step`` by a series of low order."""
    alpha, corner = p.block.critical_angle, smooth_time(p, drive)
    h = min(corner, LONGEST)
    push, rate = pushes_under_samples(p, side, drive)
    sine, cosine = lean_of(p.block, side, angle)
    m, n = half_angle(p, sine, cosine)
    weight = p.restrainer.weight
    c = brief_restrained_series(-alpha * velocity, sine, cosine, -1.0 / alpha, push, rate, weight, m, n)
    slope, bend = brief_divided_1(angle, velocity, c, h)
    later = drive_later(p, drive, h, h == corner)
    growth = weight * cosine - push * sine + 0.5 * n
    return angle + slope * h, fma(bend, h, slope), growth, h, later


@body(contract.rounding_error, Restrained)
def rounding_error(p, arc, wait, growth, steps):
    """Provide ``contract.rounding_error``: the errors of all steps, each larger by the parts of the restrainer."""
    more = 1.0 + p.restrainer.stiffness + p.restrainer.prestress
    return more * growth * error_of_steps(p, arc, steps, min(wait, 1.0))


@body(contract.end_is_sure, Restrained)
def end_is_sure(p, arc, coming, error, at_event):
    """Provide ``contract.end_is_sure`` with the limits of the module's text."""
    own = p.restrainer
    spread = max(spread_of(error), spread_of(at_event)) * (1.0 + own.stiffness + own.prestress)
    return spread < LINEAR and end_of_full_is_sure(p, arc, coming, error, at_event)
