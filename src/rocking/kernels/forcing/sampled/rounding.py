"""Rounding errors of an arc under a sampled base acceleration."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import error_of_arc
from rocking.kernels.forcing.sampled.search import FIRST
from rocking.kernels.forcing.sampled.segment import ROUNDING
from rocking.kernels.forcing.sampled.solution import last_index, time_between


@njit(**INTERNAL)
def table_size(p, index):
    """Return the largest |P| from a sample on, at the scale of the system."""
    if index >= last_index(p):
        return 0.0
    knot = p.forcing.tables.knots[index]
    return abs(p.forcing.scale) * max(knot.highest, -knot.lowest)


@njit(**INTERNAL)
def growth_constant(p, arc):
    """Provide ``finite.growth_constant``."""
    terms = 1.0 + arc.angle + abs(arc.velocity)
    terms += table_size(p, arc.drive.index) * (2.0 + p.forcing.tables.error)
    return arc.constants.grow, ROUNDING * terms


@njit(**INTERNAL_INLINE)
def has_ended(p, drive):
    """Provide ``finite.has_ended``."""
    return drive.index >= last_index(p)


@njit(**INTERNAL_INLINE)
def elapsed_until(p, arc, drive):
    """Provide ``finite.elapsed_until``."""
    return time_between(p, arc.drive, drive)


@njit(**INTERNAL)
def rounding_error(p, arc, wait, growth):
    """Provide ``finite.rounding_error``.

    The first intervals are computed from the state at the start. Later u + u' and u - u' go from sample to sample, and each step
    adds its own error.
    """
    step, force = p.forcing.tables.step, 1.0 + abs(p.forcing.scale) * p.forcing.tables.largest
    if wait <= FIRST * step:
        return error_of_arc(arc, wait, growth, force)
    short = min(wait, 1.0)
    terms = arc.angle + abs(arc.velocity) + force * short
    return ROUNDING * math.sqrt(1.0 + short / step) * growth * terms
