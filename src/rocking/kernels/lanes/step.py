"""A pass over all lanes: what is next for each."""

from numba import njit

from rocking.kernels.compile_options import SIMD
from rocking.kernels.lanes import braced_arc, braced_event, bracket, impact, root


@njit(**SIMD)
def strike(s):
    """The impacts of all lanes that have arrived, and the arcs that begin."""
    impact.apply_impacts(s)
    impact.begin(s)


@njit(**SIMD)
def advance(s):
    """All lanes onward, to their impacts if those are near enough; whether any wants anything there."""
    bracket.skip_clear_periods(s)
    bracket.walk(s)
    root.initial_guess(s)
    root.guess(s)
    root.evaluate_trial(s)
    root.step(s)
    return impact.set_requests(s)


@njit(**SIMD)
def strike_between(s):
    """``strike`` between braces."""
    braced_event.apply_events(s)


@njit(**SIMD)
def advance_between(s):
    """``advance`` between braces."""
    braced_arc.predict_event(s)
    braced_arc.correct_event(s)
    return braced_event.set_requests(s)
