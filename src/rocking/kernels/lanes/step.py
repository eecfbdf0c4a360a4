"""A pass over all lanes: what is next for each."""

from numba import njit

from rocking.kernels.compile_options import EXACT
from rocking.kernels.lanes import braced_arc, braced_event, bracket, impact, root


@njit(**EXACT)
def strike(s):
    """The impacts of all lanes that have arrived, and the arcs that begin."""
    impact.strike(s)
    impact.begin(s)


@njit(**EXACT)
def advance(s):
    """All lanes onward, to their impacts if those are near enough; whether any wants anything there."""
    bracket.stride(s)
    bracket.walk(s)
    root.aim(s)
    root.guess(s)
    root.look(s)
    root.step(s)
    return impact.attend(s)


@njit(**EXACT)
def strike_between(s):
    """``strike`` between braces."""
    braced_event.strike(s)


@njit(**EXACT)
def advance_between(s):
    """``advance`` between braces."""
    braced_arc.aim(s)
    braced_arc.step(s)
    return braced_event.attend(s)
