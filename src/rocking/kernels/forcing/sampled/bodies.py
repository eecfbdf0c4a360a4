"""Bodies of ``forcing.contract`` and ``forcing.finite`` for a sampled base acceleration."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import FLIGHT, REST
from rocking.kernels.forcing import contract, finite
from rocking.kernels.forcing.arc import NO_EXTREMES, no_guess, unchanged
from rocking.kernels.forcing.sampled import extrema, held, rounding, search, settling, solution
from rocking.kernels.forcing.sampled.parameters import SampledParameters, with_run
from rocking.kernels.forcing.sampled.solution import arc_at_place, place_at
from rocking.kernels.forcing.slender import SLENDER, transfer


@njit(**INTERNAL)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    drive = place_at(p, 0, max(cycle * p.clock.cycle_length + start, 0.0))
    return arc_at_place(p, side, start, angle, velocity, drive)


@njit(**INTERNAL_INLINE)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``: the place of the event is exact."""
    return arc_at_place(p, side, start, angle, velocity, coming.drive)


@njit(**INTERNAL_INLINE)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``."""
    return -1.0 - side * solution.acceleration_at(p, drive)


@njit(**INTERNAL)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    coming, _ = next_event_and_extremes(p, mode, arc)
    return coming, guess


@njit(**INTERNAL)
def next_event_and_extremes(p, mode, arc):
    """Provide ``finite.next_event_and_extremes``."""
    if mode == FLIGHT:
        return search.first_event(p, arc)
    return (held.lift_off(p, arc) if mode == REST else held.departure(p, arc)), NO_EXTREMES


@njit(**INTERNAL)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: from then on the bound of ``search.never_returns`` is positive."""
    tables, scale = p.forcing.tables, p.forcing.scale
    turned, knot = arc.side * scale, tables.knots[min(arc.drive.index, solution.last_index(p))]
    least = turned * (knot.lowest if turned > 0.0 else knot.highest)
    m = 2.0 * (1.0 + least - 0.25 * tables.step * tables.step * abs(scale) * tables.largest)
    grow, b = arc.constants.grow, abs(arc.constants.shrink)
    if not grow > 0.0:
        return 0.0
    root = math.sqrt(m * m + 4.0 * grow * b)
    z = 2.0 * b / (m + root) if m > 0.0 else (root - m) / (2.0 * grow)
    return math.log(z) if z > 1.0 else 0.0


@njit(**INTERNAL_INLINE)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return abs(solution.acceleration_at(p, drive))


@njit(**INTERNAL_INLINE)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``: the search for the event does not need the hyperbolic functions."""
    return transfer(p, arc, 0.0, solution.time_between(p, arc.drive, coming.drive))


@njit(**INTERNAL)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities`` by the scale; a sampled forcing has neither phase nor frequency."""
    angle, velocity = solution.means_at(p, arc.drive)
    later_angle, later_velocity = solution.means_at(p, place_at(p, arc.drive.index, arc.drive.offset + t))
    cosh, scale = 1.0 + versinh, p.forcing.scale
    moved = angle * cosh + velocity * sinh - later_angle, angle * sinh + velocity * cosh - later_velocity
    return moved[0] / scale, moved[1] / scale, 0.0, 0.0, 0.0, 0.0


provide(
    SampledParameters,
    {
        **SLENDER,
        contract.arc_at: arc_at,
        contract.arc_renewed: arc_after,
        contract.arc_after: arc_after,
        contract.resynchronise: unchanged,
        contract.evaluate: solution.evaluate,
        contract.forcing_term: forcing_term,
        contract.guess_from: no_guess,
        contract.next_event: next_event,
        contract.no_return_time: no_return_time,
        contract.side_to_lift: held.side_to_lift,
        contract.stays_leaning: held.stays_leaning,
        contract.acceleration_size: acceleration_size,
        contract.acceleration_change_bound: held.change_bound,
        contract.settling: settling.settling,
        contract.peak_with: extrema.peak_with,
        contract.largest_on: extrema.largest_on,
        contract.next_turn: extrema.next_turn,
        contract.sensitivities: sensitivities,
        contract.transfer_to_event: transfer_to_event,
        finite.elapsed_until: rounding.elapsed_until,
        finite.growth_constant: rounding.growth_constant,
        finite.has_ended: rounding.has_ended,
        finite.largest_before: extrema.largest_before,
        finite.next_event_and_extremes: next_event_and_extremes,
        finite.rounding_error: rounding.rounding_error,
        finite.with_run: with_run,
    },
)
