"""A pass over all lanes: what is next for each."""

from numba import njit

from . import lane_brace, lane_event, lane_impact, lane_walk, lane_zero
from .branchless import EXACT


@njit(**EXACT)
def strike(s):
    """The impacts of all lanes that have arrived, and the arcs that begin."""
    lane_impact.strike(s)
    lane_impact.begin(s)


@njit(**EXACT)
def advance(s):
    """All lanes onward, to their impacts if those are near enough; whether any wants anything there."""
    lane_walk.stride(s)
    lane_walk.walk(s)
    lane_zero.aim(s)
    lane_zero.guess(s)
    lane_zero.look(s)
    lane_zero.step(s)
    return lane_impact.attend(s)


@njit(**EXACT)
def strike_between(s):
    """``strike`` between braces."""
    lane_event.strike(s)


@njit(**EXACT)
def advance_between(s):
    """``advance`` between braces."""
    lane_brace.aim(s)
    lane_brace.step(s)
    return lane_event.attend(s)
