"""Rounding errors of an arc under a sampled base acceleration, and the clearance of its minima."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import error_of_arc
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.sampled.search import FIRST
from rocking.kernels.forcing.sampled.segment import ROUNDING, Piece, at, first_zero
from rocking.kernels.forcing.sampled.solution import (
    forcing_on,
    last_index,
    place_at,
    state_at_sample,
    time_between,
)


@njit(**INTERNAL)
def table_size(p, index):
    """Return the largest |P| from a sample on, at the scale of the system, and the factor of its rounding error.

    Each entry adds a rounding error, and the recursion forgets it within a unit of time.
    """
    if index >= last_index(p):
        return 0.0, 0.0
    knot = p.forcing.tables.knots[index]
    return abs(p.forcing.scale) * max(knot.highest, -knot.lowest), 1.0 / math.sqrt(
        min(p.forcing.tables.step, 1.0)
    )


@njit(**INTERNAL)
def growth_constant(p, arc):
    """Provide ``finite.growth_constant``."""
    size, factor = table_size(p, arc.drive.index)
    return arc.constants.grow, ROUNDING * (1.0 + arc.angle + abs(arc.velocity) + size * (2.0 + factor))


@njit(**INTERNAL_INLINE)
def has_ended(p, drive):
    """Provide ``finite.has_ended``."""
    return drive.index >= last_index(p)


@njit(**INTERNAL)
def rounding_error(p, arc, wait):
    """Provide ``finite.rounding_error``.

    A short arc is computed from its own state, so that its terms are small. A long one has the terms of the closed form, with
    the rounding error of K+ amplified by e^t.
    """
    start, growth = arc.drive.index, math.exp(wait)
    end = place_at(p, start, arc.drive.offset + wait)
    if end.index <= start + FIRST or start >= last_index(p):
        return error_of_arc(arc, wait, 1.0 + abs(p.forcing.scale) * p.forcing.tables.largest)
    constant, error = growth_constant(p, arc)
    size, _ = table_size(p, start)
    return error * growth + ROUNDING * (1.0 + size + abs(constant) * growth + abs(arc.constants.shrink))


@njit(**INTERNAL)
def lowest_between(p, arc, wait):
    """Provide ``finite.lowest_between``.

    A minimum lies between two samples where u' changes from falling to rising: there -u' falls through 0.
    """
    last, step = last_index(p), p.forcing.tables.step
    end = place_at(p, arc.drive.index, arc.drive.offset + wait)
    first = SampledDrive(arc.drive.index + 1, 0.0)
    elapsed = time_between(p, arc.drive, first)
    grow, each = math.exp(elapsed), math.exp(step)
    growing, shrinking = arc.constants.grow * grow, arc.constants.shrink / grow
    least, when, u, v = math.inf, 0.0, 0.0, 0.0
    for index in range(first.index, min(end.index, last) + 1):
        before, fell = u, v
        u, v = state_at_sample(p, arc.side, index, growing, shrinking)
        if index > first.index and fell < 0.0 <= v:
            force, rate = forcing_on(p, arc.side, index - 1)
            x, _ = first_zero(Piece(-fell, -(before + force), -rate, 0.0), step)
            lowest, _ = at(Piece(before, fell, force, rate), min(x, step))
            if lowest < least:
                least, when = lowest, elapsed
        elapsed += step
        growing, shrinking = growing * each, shrinking / each
    return least, when
