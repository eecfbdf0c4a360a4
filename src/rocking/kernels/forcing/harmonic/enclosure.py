"""Proofs from the ends of an arc, for one block and for lanes: no event between them, no grazing arrival."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.bracket import MARGIN
from rocking.kernels.numerics.elementary import fma


@njit(**INTERNAL_INLINE)
def grazes(amplitude, start_angle, start_velocity, t, velocity):
    """Return whether an arc arrives after a time t so slowly that rounding decides whether it arrives at all."""
    most = amplitude + 1.0
    return velocity * velocity <= MARGIN * most * fma(t, fma(t, most, abs(start_velocity)), start_angle)


@njit(**INTERNAL_INLINE)
def outweighs(first, last, off):
    """Return whether the inner Bernstein terms of a cubic exceed its error bound everywhere between the ends.

    For every s in (0, 1): first s (1 - s)^2 + last s^2 (1 - s) > off s^2 (1 - s)^2.
    """
    least = min(first, last)
    return (least > 0.0) & (first + last + 2.0 * least > off)


@njit(**INTERNAL_INLINE)
def stays_between(system, t, first, last):
    """Return whether an arc certainly meets neither base nor brace within a time t, from (u, u') at its ends.

    ``system`` is (A, Omega, brace angle).

    Between the ends u lies within t^4 s^2 (1 - s)^2 max|u''''|/24 of the cubic with the same end values and
    slopes. The Bernstein coefficients of this cubic show on which side of base and brace it stays. The fourth
    derivative is u'''' = u - 1 + A (Omega^2 - 1) cos eta. |u - 1| never exceeds the largest of A, 1 and its
    values at the ends, because u'' = u - 1 - A cos eta.
    """
    amplitude, frequency, brace_angle = system
    (angle, velocity), (end, arrival) = first, last
    left, right, square = t * velocity, t * arrival, t * t
    most = max(amplitude, 1.0, max(angle, end) - 1.0)
    most += amplitude * abs(fma(frequency, frequency, -1.0))
    off = (1.0 + MARGIN) / 24.0 * square * square * most + MARGIN * t
    to_brace, end_to_brace = brace_angle - angle, brace_angle - end
    above = outweighs(fma(3.0, angle, left), fma(3.0, end, -right), off)
    below = outweighs(fma(3.0, to_brace, -left), fma(3.0, end_to_brace, right), off)
    return above & below & (end >= 0.0) & (end_to_brace >= 0.0)
