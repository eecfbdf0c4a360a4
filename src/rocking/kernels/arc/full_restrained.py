"""Arcs of a restrained full block: series, bounds, and the proof that it never returns.

The equation is that of ``kernels.restrainer``. Against a full block, sin w has a constant factor, the base acceleration that pushes back
has a constant part on either side, and there is a part in half angles. ``contract.excess_push`` bounds all of this. So the bodies of
``largest_within`` and ``largest_near`` give |A| and this excess, and every bound of ``full_step`` and ``extrema_full`` holds: each is
1 + alpha |A|, as in ``full_biaxial``.

**Proof that a block never returns.** From now on let a <= m with m >= 0. If 0 <= theta <= pi/2, cos(alpha - theta) > 0, so that
theta'' >= -G with the constant push m. Let P be the integral of G, which is greatest at the balance b of this push, or at pi/2 if it has
none.

- If theta' > 0, the energy theta'^2/2 + P grows. If it exceeds the greatest P, theta' never becomes 0, and the block comes to lie flat.
- If theta > b, G < 0 from there on. A block with theta' < 0 loses energy. If this is below P(b), the block turns before b, and then
  theta'' > 0 until it lies flat.

So such states lie above a line in the plane of theta and theta' that falls with theta. A block that lies flat stays down.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import with_low
from rocking.kernels.arc.extrema_full import lying_time, may_lie, short_of_flat
from rocking.kernels.arc.full_base import largest_of_samples, near_in_pulse
from rocking.kernels.arc.full_series import (
    restrained_cosine_series,
    restrained_cosine_transfer,
    restrained_series,
    restrained_transfer,
    short_restrained_cosine_series,
    short_restrained_series,
)
from rocking.kernels.base.cosine import Pulse
from rocking.kernels.base.samples import Samples, interval
from rocking.kernels.contract import acceleration_of, largest_ahead, wave_of
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import RIGHT_ANGLE
from rocking.kernels.restrainer import balance_within, energy_between, torque
from rocking.kernels.system import Restrained

# Halvings of the interval of a balance in a proof, which counts its width.
HALVINGS = 30
# Safety margin of an energy over rounding, relative to it and to the parts of the torque.
MARGIN, NOISE = 1e-12, 2.0**-46
# Least square of the cosine of half an angle: beyond pi, which no arc reaches, the series stays finite.
LEAST = 1e-30


@kernel(inline=True)
def half_angle(p, sine, cosine):
    """Return rho sin alpha times cos(theta/2) and sin(theta/2), from sin w and cos w."""
    own = p.block.right
    turned = own.sine * cosine - own.cosine * sine
    half = math.sqrt(max(0.5 + 0.5 * (own.cosine * cosine + own.sine * sine), LEAST))
    return p.restrainer.force * half, p.restrainer.force * (0.5 * turned / half)


@body(contract.excess_push, Restrained, inline=True)
def excess_push(p):
    """Provide ``contract.excess_push``."""
    return p.restrainer.excess


@kernel(inline=True)
def pushes_under_samples(p, side, drive):
    """Return the factor of cos w at a place, and its rate."""
    start, rate = interval(p, drive.index)
    size = side * p.block.critical_angle
    return size * (start + rate * drive.offset) + p.restrainer.push, size * rate


@body(contract.series_from, Restrained, Samples, inline=True)
def series_under_samples(p, side, slope, sine, cosine, drive, short):
    """Provide ``contract.series_from``."""
    scale, (push, rate), (m, n) = (
        -1.0 / p.block.critical_angle,
        pushes_under_samples(p, side, drive),
        half_angle(p, sine, cosine),
    )
    if short:
        return short_restrained_series(slope, sine, cosine, scale, push, rate, p.restrainer.weight, m, n)
    return restrained_series(slope, sine, cosine, scale, push, rate, p.restrainer.weight, m, n)


@body(contract.transfer_series, Restrained, Samples, inline=True)
def transfer_under_samples(p, side, slope, sine, cosine, drive):
    """Provide ``contract.transfer_series``."""
    (push, rate), (m, n) = pushes_under_samples(p, side, drive), half_angle(p, sine, cosine)
    return restrained_transfer(slope, sine, cosine, push, rate, p.restrainer.weight, m, n)


@body(contract.series_from, Restrained, Pulse, inline=True)
def series_in_pulse(p, side, slope, sine, cosine, drive, short):
    """Provide ``contract.series_from``."""
    wave, own, (m, n) = wave_of(p), p.restrainer, half_angle(p, sine, cosine)
    size, scale = side * p.block.critical_angle * wave.amplitude, -1.0 / p.block.critical_angle
    g, h = size * drive.cosine + own.push, size * drive.sine
    if short:
        return short_restrained_cosine_series(
            slope, sine, cosine, scale, g, h, own.push, wave.frequency, own.weight, m, n
        )
    return restrained_cosine_series(
        slope, sine, cosine, scale, g, h, own.push, wave.frequency, own.weight, m, n
    )


@body(contract.transfer_series, Restrained, Pulse, inline=True)
def transfer_in_pulse(p, side, slope, sine, cosine, drive):
    """Provide ``contract.transfer_series``."""
    wave, own, (m, n) = wave_of(p), p.restrainer, half_angle(p, sine, cosine)
    size = side * p.block.critical_angle * wave.amplitude
    g, h = size * drive.cosine + own.push, size * drive.sine
    return restrained_cosine_transfer(slope, sine, cosine, g, h, own.push, wave.frequency, own.weight, m, n)


@body(contract.largest_within, Restrained, Samples, inline=True)
@body(contract.largest_near, Restrained, Samples, inline=True)
def largest_around(p, drive, time):
    """Provide ``contract.largest_within`` and ``contract.largest_near``."""
    return largest_of_samples(p, drive, time) + p.restrainer.excess


@body(contract.largest_within, Restrained, Pulse, inline=True)
def largest_of_pulse(p, drive, time):
    """Provide ``contract.largest_within``."""
    return wave_of(p).amplitude + p.restrainer.excess


@body(contract.largest_near, Restrained, Pulse, inline=True)
def largest_near_pulse(p, drive, radius):
    """Provide ``contract.largest_near``."""
    return near_in_pulse(p, drive, radius) + p.restrainer.excess


@body(contract.stiffness, Restrained, inline=True)
def stiffness(p, side, sine, cosine, drive):
    """Provide ``contract.stiffness``."""
    own, (_, n) = p.restrainer, half_angle(p, sine, cosine)
    push = side * p.block.critical_angle * acceleration_of(p, drive) + own.push
    return own.weight * cosine - push * sine + 0.5 * n


@body(contract.growth_of, Restrained, inline=True)
def growth_of(p, stiffness):
    """Provide ``contract.growth_of``: where the restrainer is stiff perturbations oscillate, within those that grow at this rate."""
    return abs(stiffness)


@body(contract.lightest_ahead, Restrained, inline=True)
def no_lightest(p, drive):
    """Provide ``contract.lightest_ahead``: no proof uses it, so it is 0."""
    return 0.0


@body(contract.flat_time, Restrained, inline=True)
def flat_time(p, side, step, drive):
    """Provide ``contract.flat_time``: the restrainer may raise a block that lies flat, which the ground does not let it."""
    return lying_time(p, step) if may_lie(p, side, step, drive) else math.inf


@body(contract.limits_within, Restrained)
def limits_within(p, arc, step, drive, h, end, extremes):
    """Provide ``contract.limits_within``: by how much the block fails to lie flat, and all minima as if errors were largest there.

    Nothing need separate motions that just lie flat from those that just do not. And errors may grow at another rate than e^t.
    """
    return with_low(extremes, min(extremes.low, extremes.dip, short_of_flat(p, arc, step, drive, h, end)))


@body(contract.never_returns, Restrained)
def never_returns(p, side, angle, velocity, drive):
    """Provide ``contract.never_returns`` by the proof of the module's text."""
    alpha, own = p.block.critical_angle, p.restrainer
    theta, speed = alpha * angle, alpha * velocity
    if theta >= RIGHT_ANGLE:
        return True
    kappa, rho, top = own.stiffness, own.prestress, min(own.balance, RIGHT_ANGLE)
    spare = 0.5 * speed * speed
    # Most blocks are far too slow, whatever the base does.
    if theta < top and (speed <= 0.0 or spare < energy_between(alpha, kappa, rho, 0.0, theta, top)):
        return False
    if theta < 0.0:
        return False
    push = alpha * largest_ahead(p, side, drive)
    low, high = balance_within(alpha, kappa, rho, push, HALVINGS)
    noise = NOISE * (1.0 + push + kappa + rho)
    if speed <= 0.0:
        if theta <= high:
            return False
        return spare * (1.0 + MARGIN) + noise < -energy_between(alpha, kappa, rho, push, high, theta)
    needed = energy_between(alpha, kappa, rho, push, theta, low) if theta < low else 0.0
    if theta < high:
        needed += (high - low) * torque(alpha, kappa, rho, push, low)
    return theta >= high or spare > needed * (1.0 + MARGIN) + noise
