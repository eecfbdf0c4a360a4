"""Bodies of ``forcing.contract`` for the full block, with any forcing."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.forcing import contract, finite, periodic
from rocking.kernels.forcing.arc import no_guess, unchanged
from rocking.kernels.forcing.full import cosine_base, extrema, pulse_base, sampled_base, solution, turns  # noqa: F401 (they provide)
from rocking.kernels.forcing.full.base import acceleration_of, change_within, side_to_lift_at, stays_at_brace
from rocking.kernels.forcing.full.parameters import (
    FullHarmonicParameters,
    FullPulseParameters,
    FullSampledParameters,
    later,
    with_pulse,
    with_row,
    with_run,
)
from rocking.kernels.forcing.full.restitution import restitution_at
from rocking.kernels.forcing.full.settling import brace_settling_time, settling
from rocking.kernels.forcing.sampled.rounding import has_ended


@njit(**INTERNAL_INLINE)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: u'' at the base."""
    return solution.acceleration(p, side, 0.0, drive)


@njit(**INTERNAL_INLINE)
def restoring_acceleration(p):
    """Provide ``contract.restoring_acceleration``."""
    return p.block.press


@njit(**INTERNAL_INLINE)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return abs(acceleration_of(p, drive))


@njit(**INTERNAL_INLINE)
def change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``."""
    return change_within(p, drive, time)


@njit(**INTERNAL_INLINE)
def side_to_lift(p, start, drive):
    """Provide ``contract.side_to_lift``."""
    return side_to_lift_at(p, start, drive)


@njit(**INTERNAL_INLINE)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``."""
    return stays_at_brace(p, arc)


@njit(**INTERNAL_INLINE)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``: those of the parameters are of the slender block alone."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0


BODIES = {
    contract.arc_at: solution.arc_at,
    contract.arc_renewed: solution.arc_after,
    contract.arc_after: solution.arc_after,
    contract.resynchronise: unchanged,
    contract.evaluate: solution.evaluate,
    contract.acceleration: solution.acceleration,
    contract.forcing_term: forcing_term,
    contract.restoring_acceleration: restoring_acceleration,
    contract.transfer: solution.transfer,
    contract.transfer_to_event: solution.transfer_to_event,
    contract.guess_from: no_guess,
    contract.next_event: solution.next_event,
    contract.no_return_time: solution.no_return_time,
    contract.side_to_lift: side_to_lift,
    contract.stays_leaning: stays_leaning,
    contract.acceleration_size: acceleration_size,
    contract.acceleration_change_bound: change_bound,
    contract.settling: settling,
    contract.brace_settling_time: brace_settling_time,
    contract.restitution_at: restitution_at,
    contract.peak_with: extrema.peak_with,
    contract.largest_on: extrema.largest_on,
    contract.next_turn: turns.next_turn,
    contract.sensitivities: sensitivities,
}
provide(FullHarmonicParameters, {**BODIES, periodic.later: later, periodic.with_row: with_row})
provide(
    FullSampledParameters,
    {**BODIES, finite.has_ended: has_ended, finite.with_run: with_run},
)
provide(
    FullPulseParameters,
    {**BODIES, finite.has_ended: pulse_base.has_ended, finite.with_pulse: with_pulse},
)
