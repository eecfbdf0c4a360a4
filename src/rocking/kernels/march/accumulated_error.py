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
def transformed(c, a, b, d, e):
    """Return M C M^T for M = [[a, b], [d, e]]."""
    left_u, left_v = a * c.uu + b * c.uv, a * c.uv + b * c.vv
    right_u, right_v = d * c.uu + e * c.uv, d * c.uv + e * c.vv
    return Covariance(left_u * a + left_v * b, left_u * d + left_v * e, right_u * d + right_v * e)


@njit(**INTERNAL_INLINE)
def widened(c, error):
    """Return the covariance with an independent error of u and of u'."""
    return Covariance(c.uu + error * error, c.uv, c.vv + error * error)


@njit(**INTERNAL_INLINE)
def after_time(c, sinh, versinh):
    """Return the covariance a time later on the same arc."""
    cosh = 1.0 + versinh
    return transformed(c, cosh, sinh, sinh, cosh)


@njit(**INTERNAL_INLINE)
def after_saltation(c, factor, shear, gain):
    """Return the covariance after an event with the matrix [[factor, 0], [shear, gain]] of ``tangent.event_map``."""
    return transformed(c, factor, 0.0, shear, gain)


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
