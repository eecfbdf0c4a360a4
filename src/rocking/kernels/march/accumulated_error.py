"""Rounding errors of a motion, propagated from event to event: covariance of (u, u') at the start of the present arc.

Each arc adds the error of its own arithmetic. The matrices of ``tangent`` carry the errors of all earlier arcs. The errors are
taken as independent, so that their squares add up.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit

# A result counts as certain if it exceeds this number of standard deviations.
DEVIATIONS = 32.0


class Covariance(NamedTuple):
    """Symmetric matrix [[uu, uv], [uv, vv]]."""

    uu: float
    uv: float
    vv: float


EXACT = Covariance(0.0, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def widened(c, error):
    """Return the covariance with an independent error of u and of u'."""
    return Covariance(c.uu + error * error, c.uv, c.vv + error * error)


@njit(**INTERNAL_INLINE)
def after_time(c, sinh, cosh):
    """Return the covariance a time later on the same arc."""
    straight, across, product = cosh * cosh, sinh * sinh, sinh * cosh
    mixed = 2.0 * product * c.uv
    return Covariance(
        straight * c.uu + across * c.vv + mixed,
        product * (c.uu + c.vv) + (straight + across) * c.uv,
        across * c.uu + straight * c.vv + mixed,
    )


@njit(**INTERNAL_INLINE)
def after_saltation(c, factor, shear, gain):
    """Return the covariance after an event with the matrix [[factor, 0], [shear, gain]] of ``tangent.event_map``."""
    moved = shear * c.uu + gain * c.uv
    return Covariance(
        factor * factor * c.uu, factor * moved, shear * moved + gain * (shear * c.uv + gain * c.vv)
    )


@njit(**INTERNAL_INLINE)
def exceeds(value, variance):
    """Return whether the size of a value is certain to exceed an error with a variance."""
    return value * value > DEVIATIONS * DEVIATIONS * variance


@njit(**INTERNAL_INLINE)
def of_growth(c):
    """Return the variance of u + u', which is that of K+."""
    return c.uu + 2.0 * c.uv + c.vv


@njit(**INTERNAL)
def of_velocity(c):
    """Return the limit of the error of u'."""
    return DEVIATIONS * math.sqrt(max(c.vv, 0.0))
