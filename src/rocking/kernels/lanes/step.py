"""Pass over all lanes: every lane executes its next stage. The compiler vectorises each short loop."""

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.lanes.braced_arc import correct_event, predict_event
from rocking.kernels.lanes.braced_event import apply_event, carry_through_event, request_before_event
from rocking.kernels.lanes.bracket import skip_clear_period, walk
from rocking.kernels.lanes.evaluate import evaluate_circular, evaluate_hyperbolic
from rocking.kernels.lanes.impact import (
    apply_impact,
    begin_bracket,
    begin_exponentials,
    begin_walk,
    carry_through_impact,
    request_before_impact,
)
from rocking.kernels.lanes.root import evaluate_trial, guess, initial_guess, step
from rocking.kernels.lanes.state import LANES


@njit(**INTERNAL)
def apply_impacts(s):
    """Apply the impacts of all lanes that have arrived, and begin their next arcs."""
    for i in range(LANES):
        carry_through_impact(s, i)
    for i in range(LANES):
        apply_impact(s, i)
    for i in range(LANES):
        begin_exponentials(s, i)
    for i in range(LANES):
        begin_walk(s, i)
    for i in range(LANES):
        begin_bracket(s, i)


@njit(**INTERNAL)
def advance(s):
    """Advance all lanes, to their impacts if those are near enough; return whether any makes a request."""
    for i in range(LANES):
        skip_clear_period(s, i)
    for i in range(LANES):
        walk(s, i)
    for i in range(LANES):
        initial_guess(s, i)
    for i in range(LANES):
        guess(s, i)
    for i in range(LANES):
        evaluate_hyperbolic(s, i)
    for i in range(LANES):
        evaluate_circular(s, i)
    for i in range(LANES):
        evaluate_trial(s, i)
    for i in range(LANES):
        step(s, i)
    requested = False
    for i in range(LANES):
        requested |= request_before_impact(s, i)
    return requested


@njit(**INTERNAL)
def apply_events(s):
    """Apply the events of all lanes that have arrived, between braces, and begin their next arcs."""
    for i in range(LANES):
        carry_through_event(s, i)
    for i in range(LANES):
        apply_event(s, i)


@njit(**INTERNAL)
def advance_between(s):
    """Advance all lanes between braces; return whether any makes a request."""
    for i in range(LANES):
        predict_event(s, i)
    for i in range(LANES):
        evaluate_hyperbolic(s, i)
    for i in range(LANES):
        evaluate_circular(s, i)
    for i in range(LANES):
        correct_event(s, i)
    requested = False
    for i in range(LANES):
        requested |= request_before_event(s, i)
    return requested
