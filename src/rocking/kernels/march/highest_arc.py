"""Largest angle of a motion: only the arc that may contain it is searched for its maximum.

The search for an event gives a lower bound of the maximum of an arc, from its samples. An upper bound follows from that. An arc
below the largest angle that was reached before cannot contain the maximum of the motion.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import NONE
from rocking.kernels.forcing.arc import Arc, Next
from rocking.kernels.forcing.contract import peak_with
from rocking.kernels.forcing.finite import largest_before


class Highest(NamedTuple):
    """Largest angle so far, and the arc that may exceed it."""

    peak: float  # of all maxima that were computed
    reached: float  # no more than the largest angle so far
    top: float  # upper bound of the maximum of the arc; 0 if there is none to compute
    arc: Arc
    coming: Next  # event that ends the arc


@njit(**INTERNAL_INLINE)
def from_peak(peak, arc):
    """Return the ``Highest`` before the first arc."""
    return Highest(peak, peak, 0.0, arc, Next(math.inf, NONE, arc.side, 0.0, 0.0, arc.drive, 0.0, 0.0))


@njit(**INTERNAL)
def peak_of(p, highest):
    """Return the largest angle so far."""
    if highest.top <= highest.peak:
        return highest.peak
    return peak_with(p, highest.arc, highest.coming, highest.peak)


@njit(**INTERNAL)
def highest_with(p, highest, arc, coming, extremes):
    """Return the ``Highest`` that includes one more arc, with its extremes."""
    top = largest_before(p, arc, coming, extremes.reached)
    if top <= highest.reached:
        return highest
    if extremes.reached <= highest.reached:
        peak = peak_with(p, arc, coming, highest.peak)
        return Highest(peak, max(peak, highest.reached), highest.top, highest.arc, highest.coming)
    peak = highest.peak if highest.top <= extremes.reached else peak_of(p, highest)
    return Highest(peak, max(peak, extremes.reached), top, arc, coming)
