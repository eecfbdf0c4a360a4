"""Vertical elastic restrainer on the centre line of a full block: its numbers, its torque and its energy.

At an angle theta from the base on either side, in rad and in units of time of the block, the base acceleration a in units of g with the
sign that pushes the block back gives theta'' = -G,

    G = sin(alpha - theta) + a cos(alpha - theta) + kappa sin theta + rho sin alpha cos(theta/2).

With w = alpha - theta this is

    w'' = (1 - kappa cos alpha) sin w + (a + kappa sin alpha) cos w + rho sin alpha cos((alpha - w)/2).

Let a >= 0, so that G > 0 at the base. If cos alpha - a sin alpha - kappa <= 0, G > 0 for 0 <= theta < pi/2. Otherwise all parts of
G = (sin alpha + a cos alpha) cos theta - (cos alpha - a sin alpha - kappa) sin theta + rho sin alpha cos(theta/2) fall there. So G
has one zero at most up to where the block lies flat, the unstable balance.
"""

import math
from typing import NamedTuple

from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import RIGHT_ANGLE, cosine_of, sine_of

# Halvings of the interval of a balance: its width is then 2e-15.
HALVINGS = 50


class Restrainer(NamedTuple):
    """Restrainer of a block with the critical angle alpha."""

    stiffness: float  # kappa
    prestress: float  # rho
    weight: float  # 1 - kappa cos alpha
    push: float  # kappa sin alpha
    force: float  # rho sin alpha
    excess: float  # ``contract.excess_push``
    balance: float  # unstable balance without base motion, rad; infinite if there is none up to where the block lies flat
    rate: float  # at which perturbations grow there; 1 if there is none
    cosine: float  # of alpha - balance, by which the base acceleration acts there


@kernel(inline=True)
def torque(alpha, kappa, rho, push, theta):
    """Return G at an angle."""
    w = alpha - theta
    restoring = kappa * sine_of(theta) + rho * sine_of(alpha) * cosine_of(0.5 * theta)
    return sine_of(w) + push * cosine_of(w) + restoring


@kernel
def energy_between(alpha, kappa, rho, push, low, high):
    """Return the integral of G from ``low`` to ``high``, by products: little is lost to rounding where they are close."""
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    lean = alpha - middle
    turned = sine_of(lean) + push * cosine_of(lean) + kappa * sine_of(middle)
    pulled = rho * sine_of(alpha) * cosine_of(0.5 * middle) * sine_of(0.5 * half)
    return 2.0 * sine_of(half) * turned + 4.0 * pulled


@kernel
def balance_within(alpha, kappa, rho, push, halvings):
    """Return an interval of the angle of the unstable balance under a constant push; both ends are RIGHT_ANGLE if there is none below it.

    G >= 0 at its lower end and G <= 0 at its upper one. The first is at most the second, whatever the number of halvings.
    """
    low, high = 0.0, RIGHT_ANGLE
    if torque(alpha, kappa, rho, push, RIGHT_ANGLE) >= 0.0:
        return RIGHT_ANGLE, RIGHT_ANGLE
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        if torque(alpha, kappa, rho, push, middle) >= 0.0:
            low = middle
        else:
            high = middle
    return low, high


@entry_point
def restrainer_of(critical_angle: float, stiffness: float, prestress: float) -> Restrainer:
    """Return the restrainer of a block with a critical angle in rad, and the ratios kappa and rho.

    The bound ``excess``: |sin w|, |cos w| and |cos((alpha - w)/2)| are at most exp|w - w0| in the complex disc around w0, and 1 on the
    line. So |w''| is at most (|1 - kappa cos alpha| + kappa sin alpha + |a| + rho sin alpha) exp|w - w0|. Its derivative by w has
    half the last part.
    """
    alpha = critical_angle
    sine, cosine = sine_of(alpha), cosine_of(alpha)
    weight, push, force = 1.0 - stiffness * cosine, stiffness * sine, prestress * sine
    excess = (max(abs(weight) - 1.0, 0.0) + push + force) / alpha
    low, high = balance_within(alpha, stiffness, prestress, 0.0, HALVINGS)
    balance, rate = 0.5 * (low + high), 1.0
    if low == RIGHT_ANGLE:
        return Restrainer(stiffness, prestress, weight, push, force, excess, math.inf, rate, 1.0)
    w = alpha - balance
    # -dG/dtheta, which is not 0: all parts of G fall
    square = weight * cosine_of(w) - push * sine_of(w) + 0.5 * force * sine_of(0.5 * balance)
    return Restrainer(
        stiffness, prestress, weight, push, force, excess, balance, math.sqrt(square), cosine_of(w)
    )
