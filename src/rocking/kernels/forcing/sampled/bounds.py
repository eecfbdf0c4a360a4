"""Bounds of an arc under a sampled base acceleration: where it certainly has no event, no minimum, or no return."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit

# Relative safety margin of bounds over rounding.
MARGIN = 1e-12


@njit(**INTERNAL_INLINE)
def largest_push(p):
    """Return F, a bound of |f|, with the margin over rounding of the bound that it serves."""
    return (1.0 + abs(p.forcing.scale) * p.forcing.tables.largest) * (1.0 + MARGIN)


@njit(**INTERNAL_INLINE)
def rises_throughout(piece, length):
    """Return whether u' > 0 on a part of a segment: |u''| <= u + |f|, and u stays below the bound that this gives.

    With q = length^2/2 that bound is (u + u' length + |f| q)/(1 - q), where u' >= 0 at the start.
    """
    force = max(abs(piece.force), abs(piece.force + piece.rate * length))
    half = 0.5 * length * length
    largest = force + piece.w + piece.dw * length  # times 1 - q
    return piece.dw > 0.0 and half < 0.5 and piece.dw * (1.0 - half) > length * largest * (1.0 + MARGIN)


@njit(**INTERNAL_INLINE)
def reach_over(passage, before, here, force):
    """Return the bound on how far u leaves its chord, from u at both ends."""
    return passage.bend * (max(abs(before), abs(here)) + force)


@njit(**INTERNAL_INLINE)
def is_clear(p, before, here, reach):
    """Return whether there is no event between two samples by the bound ``reach``, from u at both ends."""
    return min(before, here) > reach and p.block.brace_angle - max(before, here) > reach


@njit(**INTERNAL_INLINE)
def is_monotone(speeds, time, push):
    """Return whether u' certainly keeps its sign over a time, from its values at both ends and a bound of |u''|."""
    return speeds[0] * speeds[1] > 0.0 and max(abs(speeds[0]), abs(speeds[1])) > time * push * (1.0 + MARGIN)


@njit(**INTERNAL_INLINE)
def never_returns(p, side, index, total, difference):
    """Return whether u certainly stays positive from a sample on, from u + u' and u - u' there.

    u >= 1 + least P - (h^2/4) max|a| + (K+ e^t - |K-| e^-t)/2, because P leaves its chord by h^2/8 max|P''| <= h^2/4 max|a|.
    A quarter of K+ e^t must suffice, so that u keeps a distance from 0 that grows with its rounding error.
    """
    tables, scale = p.forcing.tables, p.forcing.scale
    turned, knot = side * scale, tables.knots[index]
    growing = total - 1.0 - turned * (knot.mean + knot.rate)
    shrinking = difference - 1.0 - turned * (knot.mean - knot.rate)
    least = turned * (knot.lowest if turned > 0.0 else knot.highest)
    bend = 0.25 * tables.step * tables.step * abs(scale) * tables.largest
    return growing > 0.0 and 2.0 * (1.0 + least - bend) + 0.25 * growing - abs(shrinking) > MARGIN * (
        growing + abs(shrinking)
    )
