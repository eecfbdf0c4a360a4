"""Bodies of ``forcing.contract`` for the full block, with either forcing."""

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.forcing import contract
from rocking.kernels.forcing.arc import no_guess, unchanged
from rocking.kernels.forcing.extrema import arc_peak
from rocking.kernels.forcing.full import cosine_base, sampled_base, solution  # noqa: F401 (they provide)
from rocking.kernels.forcing.full.base import acceleration_of, change_within, side_to_lift_at
from rocking.kernels.forcing.full.parameters import FullHarmonicParameters, FullSampledParameters
from rocking.kernels.forcing.full.settling import settling


@njit(**INTERNAL_INLINE)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: u'' at the base."""
    return solution.acceleration(p, side, 0.0, drive)


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
    """Provide ``contract.stays_leaning``: there are no braces."""
    return False


@njit(**INTERNAL)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``."""
    return arc_peak(p, arc, until, peak)


@njit(**INTERNAL)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    return arc_peak(p, arc, coming.wait, peak)


@njit(**INTERNAL_INLINE)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``: tangent vectors are those of the slender block alone."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0


BODIES = {
    contract.arc_at: solution.arc_at,
    contract.arc_renewed: solution.arc_after,
    contract.arc_after: solution.arc_after,
    contract.resynchronise: unchanged,
    contract.evaluate: solution.evaluate,
    contract.acceleration: solution.acceleration,
    contract.forcing_term: forcing_term,
    contract.guess_from: no_guess,
    contract.next_event: solution.next_event,
    contract.no_return_time: solution.no_return_time,
    contract.side_to_lift: side_to_lift,
    contract.stays_leaning: stays_leaning,
    contract.acceleration_size: acceleration_size,
    contract.acceleration_change_bound: change_bound,
    contract.settling: settling,
    contract.peak_with: peak_with,
    contract.largest_on: largest_on,
    contract.next_turn: solution.next_turn,
    contract.sensitivities: sensitivities,
}
provide(FullHarmonicParameters, BODIES)
provide(FullSampledParameters, BODIES)
