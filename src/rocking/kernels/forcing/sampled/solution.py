"""Closed form of an arc under a sampled base acceleration a.

On side sigma, u'' - u = -1 - sigma a, so that with the tables P and P'

    u = 1 + sigma P + (K+ e^t + K- e^-t)/2,  u' = sigma P' + (K+ e^t - K- e^-t)/2.

The state u, v at the start gives the constants:

    K+ = u + v - 1 - sigma (P + P'),  K- = u - v - 1 - sigma (P - P').

P + P' is the integral of e^(t - x) a(x) over all later times x. After the last sample a = 0.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import Arc, Instant
from rocking.kernels.forcing.drives import SampledConstants, SampledDrive
from rocking.kernels.forcing.sampled.segment import Piece, at, with_hyperbolic
from rocking.kernels.numerics.elementary import hyperbolic


@njit(**INTERNAL_INLINE)
def last_index(p):
    """Return the index of the interval after the last sample."""
    return p.forcing.tables.knots.shape[0] - 1


@njit(**INTERNAL_INLINE)
def interval(p, index):
    """Return the base acceleration at the start of an interval, and its rate: 0 after the last sample."""
    if index >= last_index(p):
        return 0.0, 0.0
    tables, scale = p.forcing.tables, p.forcing.scale
    return scale * tables.samples[index], scale * tables.intervals[index].rate


@njit(**INTERNAL_INLINE)
def acceleration_at(p, drive):
    """Return the base acceleration at a place."""
    start, rate = interval(p, drive.index)
    return start + rate * drive.offset


@njit(**INTERNAL_INLINE)
def place_at(p, index, offset):
    """Return the place a time ``offset`` >= 0 after a sample."""
    step, last = p.forcing.tables.step, last_index(p)
    if index >= last or offset < step:
        return SampledDrive(index, offset)
    passed = min(math.floor(offset / step), float(last - index))
    return SampledDrive(index + int(passed), max(offset - passed * step, 0.0))


@njit(**INTERNAL_INLINE)
def time_between(p, first, last):
    """Return the time from one place to another."""
    return (last.index - first.index) * p.forcing.tables.step + (last.offset - first.offset)


@njit(**INTERNAL_INLINE)
def forcing_on(p, side, index):
    """Return f = u'' - u at the start of an interval on a side, and its rate."""
    start, rate = interval(p, index)
    return -1.0 - side * start, -side * rate


@njit(**INTERNAL_INLINE)
def piece_from(p, side, drive, angle, velocity):
    """Return u from a place on, as a ``Piece``. A block that starts from rest at the base lifts: its f is not negative."""
    force, rate = forcing_on(p, side, drive.index)
    force += rate * drive.offset
    if angle == 0.0 and velocity == 0.0:
        force = max(force, 0.0)
    return Piece(angle, velocity, force, rate)


@njit(**INTERNAL_INLINE)
def means_at(p, drive):
    """Return P and P' at a place, at the scale of the system."""
    tables, scale = p.forcing.tables, p.forcing.scale
    knot = tables.knots[min(drive.index, last_index(p))]
    if drive.offset == 0.0:
        return scale * knot.mean, scale * knot.rate
    start, rate = interval(p, drive.index)
    return at(Piece(scale * knot.mean, scale * knot.rate, -start, -rate), drive.offset)


@njit(**INTERNAL_INLINE)
def constants_of(p, side, drive, angle, velocity):
    """Return the constants of the arc through (u, u') = (angle, velocity) at a place."""
    mean, rate = means_at(p, drive)
    above = angle - 1.0
    return SampledConstants(
        (above + velocity) - side * (mean + rate), (above - velocity) - side * (mean - rate)
    )


@njit(**INTERNAL)
def arc_at_place(p, side, start, angle, velocity, drive):
    """Return the arc that starts at a place, ``start`` on the clock."""
    return Arc(side, start, angle, velocity, drive, constants_of(p, side, drive, angle, velocity))


@njit(**INTERNAL_INLINE)
def state_at_sample(p, side, index, growing, shrinking):
    """Return u and u' at a sample, from K+ e^t and K- e^-t there."""
    knot, turned = p.forcing.tables.knots[index], side * p.forcing.scale
    return (
        1.0 + (turned * knot.mean + 0.5 * (growing + shrinking)),
        turned * knot.rate + 0.5 * (growing - shrinking),
    )


@njit(**INTERNAL_INLINE)
def along(p, side, passage, row, total, difference):
    """Return u + u' and u - u' at a later sample, from those at a sample, by the ``Passage`` and its row of the tables.

    (u + u')' = (u + u') + f and (u - u')' = -(u - u') - f, where f = -1 - sigma a is linear. Changes are added, so that a factor
    e^h, rounded, does not act as a wrong step.
    """
    turned = side * p.forcing.scale
    return (
        total + (passage.gain * total - (passage.ahead + turned * row.ahead)),
        difference - (passage.loss * difference - (passage.behind + turned * row.behind)),
    )


@njit(**INTERNAL)
def state_in(p, arc, drive, elapsed):
    """Return u and u' of an arc at a place of the interval ``drive.index``, at the time ``elapsed`` since its start."""
    if drive.index == arc.drive.index:
        return at(piece_from(p, arc.side, arc.drive, arc.angle, arc.velocity), elapsed)
    z = math.exp(elapsed - drive.offset)
    angle, velocity = state_at_sample(
        p, arc.side, drive.index, arc.constants.grow * z, arc.constants.shrink / z
    )
    force, rate = forcing_on(p, arc.side, drive.index)
    return at(Piece(angle, velocity, force, rate), drive.offset)


@njit(**INTERNAL)
def evaluate(p, arc, t):
    """Return the ``Instant`` of an arc at a time t >= 0 after its start."""
    drive = place_at(p, arc.drive.index, arc.drive.offset + t)
    angle, velocity = state_in(p, arc, drive, t)
    sinh, versinh, _, _ = hyperbolic(t)
    return Instant(angle, angle - arc.angle, velocity, drive, sinh, versinh)


@njit(**INTERNAL_INLINE)
def across_step(p, piece):
    """Return u and u' one whole step later."""
    tables = p.forcing.tables
    return with_hyperbolic(piece, tables.sinh, tables.versinh, tables.excess)
