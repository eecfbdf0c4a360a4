"""Bodies of ``forcing.contract`` for the harmonic forcing."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.forcing import contract, periodic
from rocking.kernels.forcing.drives import HarmonicDrive
from rocking.kernels.forcing.harmonic import (
    acceleration,
    extrema,
    first_zero,
    next_event,
    parameters,
    solution,
)
from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters
from rocking.kernels.forcing.settling import settling_by_change
from rocking.kernels.forcing.slender import SLENDER


@njit(**INTERNAL_INLINE)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``: each cycle is the same."""
    return solution.arc_from(p, side, start, angle, velocity)


@njit(**INTERNAL_INLINE)
def arc_renewed(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_renewed``: the clock is more accurate than the event."""
    return solution.arc_from(p, side, start, angle, velocity)


@njit(**INTERNAL_INLINE)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after``: eta turns by pi with the side."""
    turned = side * coming.side
    drive = HarmonicDrive(turned * coming.drive.cosine, turned * coming.drive.sine)
    return solution.arc_with(p, side, start, angle, velocity, drive)


@njit(**INTERNAL_INLINE)
def resynchronise(p, arc):
    """Provide ``contract.resynchronise``."""
    return solution.arc_from(p, arc.side, arc.start, arc.angle, arc.velocity)


@njit(**INTERNAL_INLINE)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: eta contains the side."""
    return acceleration.forcing_term(p, drive.cosine)


@njit(**INTERNAL_INLINE)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return p.forcing.amplitude * abs(drive.cosine)


@njit(**INTERNAL_INLINE)
def acceleration_change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``."""
    return acceleration.acceleration_change_bound(p, drive.sine, time)


@njit(**INTERNAL_INLINE)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``."""
    return acceleration.sensitivities(p, arc.drive.cosine, arc.drive.sine, t, sinh, versinh, excess)


provide(
    HarmonicParameters,
    {
        **SLENDER,
        contract.arc_at: arc_at,
        contract.arc_renewed: arc_renewed,
        contract.arc_after: arc_after,
        contract.resynchronise: resynchronise,
        contract.evaluate: solution.evaluate,
        contract.forcing_term: forcing_term,
        contract.guess_from: solution.propagator_or_none,
        contract.next_event: next_event.next_event,
        contract.no_return_time: first_zero.no_return_time,
        contract.side_to_lift: next_event.side_to_lift,
        contract.stays_leaning: next_event.stays_leaning,
        contract.acceleration_size: acceleration_size,
        contract.acceleration_change_bound: acceleration_change_bound,
        contract.settling: settling_by_change,
        contract.peak_with: extrema.peak_with,
        contract.largest_on: extrema.largest_on,
        contract.next_turn: extrema.next_turn,
        contract.sensitivities: sensitivities,
        periodic.later: parameters.later,
        periodic.with_row: parameters.with_row,
    },
)
