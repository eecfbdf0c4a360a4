"""Rounding errors along a motion, as a covariance of (u, u'), and whether they can have decided how an arc ends.

Each arc adds the error of its own arithmetic, and the matrices of ``tangent`` carry the errors of all earlier arcs. They are taken
as independent, so that their squares add up.

On an arc of a slender block a perturbation is a sum of e^t and e^-t, exactly. On one of a full block x'' = q(t) x, where
q = W cos w - sigma a sin w, with the weight W. The covariance is carried with the mean of q over the arc, the first term of the Magnus
series.

An arc of a slender block ends as computed if K+ exceeds its error: no more is to be known, because the equation is linear. Of a full
block the error at the end of the arc must be below the limit LINEAR. For a size d of the error, x'' has terms of its second order of
about alpha^2 d^2. They change the error by a share of about alpha^2 d/2: at LINEAR by a fiftieth for alpha = 0.4. So the error is
that of the linear equation, and all motions within it meet the base with this one. Where overturning is proved, the proof must
hold for each of these motions. So the certificate needs no margin of the full block.

The speed after an impact is linear in that before it, unless the coefficient of restitution is a table over the speed. By how much a
table differs from its tangent, within the error of the speed, is one more error. It is added as an independent one, although it depends on
that of the speed: the sum may be too small by a factor of 1.4, which the number of deviations covers.
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import ROUNDING
from rocking.kernels.arc.extrema_full import lying_angle
from rocking.kernels.arc.full_step import ERROR
from rocking.kernels.block.restitution import bend_within
from rocking.kernels.contract import (
    acceleration,
    forcing_term,
    growth_constant,
    heaviest_ahead,
    never_returns,
    parts_at_base,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.system import Full, Slender, Unsymmetric

# A result counts as certain if it exceeds this number of standard deviations.
DEVIATIONS = 32.0
# Error of u or of u' up to which the equation of a full block may be taken as linear in it.
LINEAR = 0.25


class Covariance(NamedTuple):
    """Symmetric matrix [[uu, uv], [uv, vv]]."""

    uu: float
    uv: float
    vv: float


EXACT = Covariance(0.0, 0.0, 0.0)


@kernel(inline=True)
def widened(c, error):
    """Return the covariance with an independent error of u and of u'."""
    return Covariance(c.uu + error * error, c.uv, c.vv + error * error)


@kernel(inline=True)
def with_error_of_velocity(c, error):
    """Return the covariance with an independent error of u'."""
    return Covariance(c.uu, c.uv, c.vv + error * error)


@kernel(inline=True)
def after_time(c, rate, sinh, cosh):
    """Return the covariance a time t later on the same arc, from sinh and cosh of rate t, where x'' = rate^2 x."""
    uv, vv = c.uv / rate, c.vv / (rate * rate)
    straight, across, product = cosh * cosh, sinh * sinh, sinh * cosh
    mixed = 2.0 * product * uv
    return Covariance(
        straight * c.uu + across * vv + mixed,
        (product * (c.uu + vv) + (straight + across) * uv) * rate,
        (across * c.uu + straight * vv + mixed) * (rate * rate),
    )


@kernel(inline=True)
def after_saltation(c, factor, shear, gain):
    """Return the covariance after an event with the matrix [[factor, 0], [shear, gain]] of ``tangent.event_map``."""
    moved = shear * c.uu + gain * c.uv
    return Covariance(
        factor * factor * c.uu, factor * moved, shear * moved + gain * (shear * c.uv + gain * c.vv)
    )


@kernel(inline=True)
def exceeds(value, variance):
    """Return whether the size of a value is certain to exceed an error with a variance."""
    return value * value > DEVIATIONS * DEVIATIONS * variance


@kernel(inline=True)
def of_growth(c):
    """Return the variance of u + u', which is that of K+."""
    return c.uu + 2.0 * c.uv + c.vv


@kernel
def of_velocity(c):
    """Return the limit of the error of u'."""
    return DEVIATIONS * math.sqrt(max(c.vv, 0.0))


@body(contract.restitution_error, Unsymmetric, inline=True)
@body(contract.restitution_error, Slender, inline=True)
def no_restitution_error(p, arc, coming, error):
    """Provide ``contract.restitution_error``: the coefficient is a constant."""
    return 0.0


@body(contract.restitution_error, Full, inline=True)
def restitution_error(p, arc, coming, error):
    """Provide ``contract.restitution_error``: a table bends e v, at its rows above all.

    An error of u moves the impact in time, and so changes the speed before it by u''/u' times itself.
    """
    if p.block.law.shape[0] == 0 or coming.velocity == 0.0:
        return 0.0
    late = -forcing_term(p, arc.side, coming.drive) / coming.velocity
    at_impact = Covariance(0.0, 0.0, error.vv + late * (2.0 * error.uv + late * error.uu))
    return bend_within(p, arc.side, -coming.velocity, of_velocity(at_impact))


@body(contract.rounding_error, Full)
def rounding_error(p, arc, wait, growth, steps):
    """Provide ``contract.rounding_error``.

    Each step rounds u, u' and their changes, which is taken as independent of other steps. A whole step also adds ERROR at most by
    the end of its series, and a part of one far less. These bounds add up, and the sum counts as DEVIATIONS deviations. Perturbations
    grow by e in a unit of time, so that the steps of a unit count.
    """
    short = min(wait, 1.0)
    count = steps * (short / wait) if wait > 0.0 else 0.0
    return growth * error_of_steps(p, arc, count, short)


@kernel(inline=True)
def error_of_steps(p, arc, count, time):
    """Return an estimate of the rounding error of a number of steps from the start of an arc on, which take a time."""
    push = parts_at_base(p, arc.side, heaviest_ahead(p, arc.drive)) + contract.largest_push(p)
    terms = arc.angle + abs(arc.velocity) + push * time
    return ROUNDING * math.sqrt(1.0 + count) * terms + (ERROR / DEVIATIONS) * count


@body(contract.end_is_sure, Unsymmetric, inline=True)
@body(contract.end_is_sure, Slender, inline=True)
def end_is_sure(p, arc, coming, error, at_event):
    """Provide ``contract.end_is_sure``: K+ exceeds its error."""
    constant, rounded = growth_constant(p, arc)
    return exceeds(constant, of_growth(widened(error, rounded)))


@kernel
def spread_of(c):
    """Return the limit of the errors of u and of u'."""
    return DEVIATIONS * math.sqrt(max(c.uu, c.vv))


@kernel(inline=True)
def turns_further(velocity, back, error):
    """Return whether a motion that passes an angle at a velocity turns further than this angle by more than the error.

    Against an acceleration ``back`` it turns further by v^2/(2 back). The velocity must exceed its own error, too.
    """
    return back <= 0.0 or (
        exceeds(velocity, error.vv) and exceeds(0.5 * velocity * velocity / back, error.uu)
    )


@body(contract.end_is_sure, Full)
def end_of_full_is_sure(p, arc, coming, error, at_event):
    """Provide ``contract.end_is_sure``: the error at the end is small, and there overturning is certain for all motions within it."""
    spread = spread_of(at_event)
    if not spread < LINEAR:
        return False
    if coming.wait < math.inf or never_returns(
        p, arc.side, coming.angle - spread, coming.velocity - spread, coming.drive
    ):
        return True
    back = -acceleration(p, arc.side, coming.angle, coming.drive)
    return coming.angle == lying_angle(p) and turns_further(coming.velocity, back, at_event)
