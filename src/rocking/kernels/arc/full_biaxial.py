"""Base that moves in two directions, as the full block needs it.

With the weight W(t) = 1 + V(t), on side sigma, w'' = W(t) sin w + sigma alpha A(t) cos w, where w = alpha (s - u). A bound of |A| that the
step of an arc asks for is used in r^2 (1 + alpha |A|), a bound of alpha |u''| and of its derivative by w. Here both are at most
r^2 (1 + |V| + alpha |A|). So the bodies give |A| + |V|/alpha. With |sin w| <= 1 this holds also for |u''| <= r^2 (max(s, u) + |A|).
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.full_series import biaxial_series, biaxial_transfer, short_biaxial_series
from rocking.kernels.base.biaxial import Biaxial, change_of_weight, weight_at, weight_in
from rocking.kernels.base.samples import interval, last_index
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential_bound
from rocking.kernels.system import Full, Slender, Unsymmetric, side_of


@body(contract.weight_of, Full, inline=True)
@body(contract.weight_of, Slender, inline=True)
@body(contract.weight_of, Unsymmetric, inline=True)
def same_weight(p, drive):
    """Provide ``contract.weight_of`` for a base that moves horizontally."""
    return 1.0


@body(contract.lightest_ahead, Full, inline=True)
def lightest_ahead(p, drive):
    """Provide ``contract.lightest_ahead`` for a base that moves horizontally."""
    return 1.0


@body(contract.heaviest_ahead, Full, inline=True)
def heaviest_ahead(p, drive):
    """Provide ``contract.heaviest_ahead`` for a base that moves horizontally."""
    return 1.0


@body(contract.weight_change_bound, Full, inline=True)
def no_change_of_weight(p, drive, time):
    """Provide ``contract.weight_change_bound`` for a base that moves horizontally."""
    return 0.0


@body(contract.lightest_ahead, Full, Biaxial, inline=True)
def lightest_weight(p, drive):
    """Provide ``contract.lightest_ahead``."""
    return p.forcing.lightest[drive.index] if drive.index < last_index(p) else 1.0


@body(contract.heaviest_ahead, Full, Biaxial, inline=True)
def heaviest_weight(p, drive):
    """Provide ``contract.heaviest_ahead``."""
    return p.forcing.heaviest[drive.index] if drive.index < last_index(p) else 1.0


body(contract.weight_of, Full, Biaxial)(weight_at)
body(contract.weight_change_bound, Full, Biaxial)(change_of_weight)


@kernel(inline=True)
def pushes_at(p, side, drive):
    """Return sigma alpha A and its rate, and the weight and its rate, at a place."""
    size, (start, rate), (weight, lift) = (
        side * p.block.critical_angle,
        interval(p, drive.index),
        weight_in(p, drive.index),
    )
    return size * (start + rate * drive.offset), size * rate, weight + lift * drive.offset, lift


@body(contract.series_from, Full, Biaxial, inline=True)
def series_from(p, side, slope, sine, cosine, drive, short):
    """Provide ``contract.series_from``."""
    push, rate, weight, lift = pushes_at(p, side, drive)
    scale = -1.0 / p.block.critical_angle
    if short:
        return short_biaxial_series(slope, sine, cosine, scale, push, rate, weight, lift)
    return biaxial_series(slope, sine, cosine, scale, push, rate, weight, lift)


@body(contract.transfer_series, Full, Biaxial, inline=True)
def transfer_series(p, side, slope, sine, cosine, drive):
    """Provide ``contract.transfer_series``."""
    push, rate, weight, lift = pushes_at(p, side, drive)
    return biaxial_transfer(slope, sine, cosine, push, rate, weight, lift)


@kernel(inline=True)
def sizes_around(p, drive, time):
    """Return upper bounds of |A| and |V| within a time, on a line as on a circle."""
    (start, rate), (weight, lift) = interval(p, drive.index), weight_in(p, drive.index)
    horizontal = abs(start + rate * drive.offset) + abs(rate) * time
    return horizontal, abs(weight - 1.0 + lift * drive.offset) + abs(lift) * time


@body(contract.largest_within, Full, Biaxial, inline=True)
@body(contract.largest_near, Full, Biaxial, inline=True)
def largest_around(p, drive, time):
    """Provide ``contract.largest_within`` and ``contract.largest_near``: |A| + |V|/alpha."""
    horizontal, vertical = sizes_around(p, drive, time)
    return horizontal + vertical / p.block.critical_angle


@body(contract.acceleration_near, Full, Biaxial, inline=True)
def acceleration_near(p, side, sine, change, drive, radius):
    """Provide ``contract.acceleration_near``, also for a small alpha.

    With |w - w0| = x, |sin w| <= |sin w0| cosh x + sinh x <= (|sin w0| + x) exp x, and |cos w| <= exp x.
    """
    horizontal, vertical = sizes_around(p, drive, radius)
    stiffness = side_of(p.block, side).stiffness
    turning = (1.0 + vertical) * (abs(sine) + stiffness * change)
    return (turning + stiffness * p.block.critical_angle * horizontal) * exponential_bound(change)


@body(contract.brace_settling_time, Full, Biaxial, inline=True)
def brace_settling_time(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``: there are no braces."""
    return math.inf
