"""Closed form of an arc under a sampled base acceleration a.

On side sigma, u'' - u = -1 - sigma a, so that with the tables P and P'

    u = 1 + sigma P + (K+ e^t + K- e^-t)/2,  u' = sigma P' + (K+ e^t - K- e^-t)/2.

The state u, v at the start gives the constants:

    K+ = u + v - 1 - sigma (P + P'),  K- = u - v - 1 - sigma (P - P').

P + P' is the integral of e^(t - x) a(x) over all later times x. After the last sample a = 0.
"""

from rocking.kernels import contract
from rocking.kernels.arc.arc import Arc, Instant
from rocking.kernels.arc.first_zero_samples import ROUNDING, Piece, at, with_hyperbolic
from rocking.kernels.base.biaxial import Biaxial
from rocking.kernels.base.samples import (
    SampledConstants,
    Samples,
    acceleration_at,
    interval,
    last_index,
    place_at,
    time_between,
)
from rocking.kernels.block.slender import transfer
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential, hyperbolic
from rocking.kernels.system import Slender


@kernel(inline=True)
def forcing_on(p, side, index):
    """Return f = u'' - u at the start of an interval on a side, and its rate."""
    start, rate = interval(p, index)
    return -1.0 - side * start, -side * rate


@kernel(inline=True)
def piece_from(p, side, drive, angle, velocity):
    """Return u from a place on, as a ``Piece``. A block that starts from rest at the base lifts: its f is not negative."""
    force, rate = forcing_on(p, side, drive.index)
    force += rate * drive.offset
    if angle == 0.0 and velocity == 0.0:
        force = max(force, 0.0)
    return Piece(angle, velocity, force, rate)


@kernel(inline=True)
def means_at(p, drive):
    """Return P and P' at a place, at the scale of the system."""
    tables, scale = p.forcing.tables, p.forcing.scale
    knot = tables.knots[min(drive.index, last_index(p))]
    if drive.offset == 0.0:
        return scale * knot.mean, scale * knot.rate
    start, rate = interval(p, drive.index)
    return at(Piece(scale * knot.mean, scale * knot.rate, -start, -rate), drive.offset)


@kernel(inline=True)
def constants_of(p, side, drive, angle, velocity):
    """Return the constants of the arc through (u, u') = (angle, velocity) at a place."""
    mean, rate = means_at(p, drive)
    above = angle - 1.0
    return SampledConstants(
        (above + velocity) - side * (mean + rate), (above - velocity) - side * (mean - rate)
    )


@kernel
def arc_at_place(p, side, start, angle, velocity, drive):
    """Return the arc that starts at a place, ``start`` on the clock."""
    return Arc(side, start, angle, velocity, drive, constants_of(p, side, drive, angle, velocity))


@kernel(inline=True)
def state_at_sample(p, side, index, growing, shrinking):
    """Return u and u' at a sample, from K+ e^t and K- e^-t there."""
    knot, turned = p.forcing.tables.knots[index], side * p.forcing.scale
    return (
        1.0 + (turned * knot.mean + 0.5 * (growing + shrinking)),
        turned * knot.rate + 0.5 * (growing - shrinking),
    )


@kernel(inline=True)
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


@kernel
def state_in(p, arc, drive, elapsed):
    """Return u and u' of an arc at a place of the interval ``drive.index``, at the time ``elapsed`` since its start."""
    if drive.index == arc.drive.index:
        return at(piece_from(p, arc.side, arc.drive, arc.angle, arc.velocity), elapsed)
    z = exponential(elapsed - drive.offset)
    angle, velocity = state_at_sample(
        p, arc.side, drive.index, arc.constants.grow * z, arc.constants.shrink / z
    )
    force, rate = forcing_on(p, arc.side, drive.index)
    return at(Piece(angle, velocity, force, rate), drive.offset)


@body(contract.evaluate, Slender, Samples)
def evaluate(p, arc, t):
    """Return the ``Instant`` of an arc at a time t >= 0 after its start."""
    drive = place_at(p, arc.drive.index, arc.drive.offset + t)
    angle, velocity = state_in(p, arc, drive, t)
    sinh, versinh, _, _ = hyperbolic(t)
    return Instant(angle, angle - arc.angle, velocity, drive, sinh, versinh)


@kernel(inline=True)
def across_step(p, piece):
    """Return u and u' one whole step later."""
    tables = p.forcing.tables
    return with_hyperbolic(piece, tables.sinh, tables.versinh, tables.excess)


@kernel
def table_size(p, index):
    """Return the largest |P| from a sample on, at the scale of the system."""
    if index >= last_index(p):
        return 0.0
    knot = p.forcing.tables.knots[index]
    return abs(p.forcing.scale) * max(knot.highest, -knot.lowest)


@body(contract.growth_constant, Slender, Samples)
def growth_constant(p, arc):
    """Provide ``contract.growth_constant``."""
    terms = 1.0 + arc.angle + abs(arc.velocity)
    terms += table_size(p, arc.drive.index) * (2.0 + p.forcing.tables.error)
    return arc.constants.grow, ROUNDING * terms


@body(contract.has_ended, None, Samples, Biaxial, inline=True)
def has_ended(p, drive):
    """Provide ``contract.has_ended``."""
    return drive.index >= last_index(p)


@body(contract.elapsed_until, None, Samples, Biaxial, inline=True)
def elapsed_until(p, arc, drive):
    """Provide ``contract.elapsed_until``."""
    return time_between(p, arc.drive, drive)


@body(contract.arc_at, Slender, Samples)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    drive = place_at(p, 0, max(cycle * p.clock.cycle_length + start, 0.0))
    return arc_at_place(p, side, start, angle, velocity, drive)


@body(contract.arc_renewed, Slender, Samples)
@body(contract.arc_after, Slender, Samples, inline=True)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``: the place of the event is exact."""
    return arc_at_place(p, side, start, angle, velocity, coming.drive)


@body(contract.forcing_term, Slender, Samples, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``."""
    return -1.0 - side * acceleration_at(p, drive)


@body(contract.acceleration_size, None, Samples, inline=True)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return abs(acceleration_at(p, drive))


@body(contract.transfer_to_event, Slender, Samples, inline=True)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``: the search for the event does not need the hyperbolic functions."""
    return transfer(p, arc, 0.0, time_between(p, arc.drive, coming.drive))


@body(contract.sensitivities, Slender, Samples)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities`` by the scale; a sampled forcing has neither phase nor frequency."""
    angle, velocity = means_at(p, arc.drive)
    later_angle, later_velocity = means_at(p, place_at(p, arc.drive.index, arc.drive.offset + t))
    cosh, scale = 1.0 + versinh, p.forcing.scale
    moved = angle * cosh + velocity * sinh - later_angle, angle * sinh + velocity * cosh - later_velocity
    return moved[0] / scale, moved[1] / scale, 0.0, 0.0, 0.0, 0.0
