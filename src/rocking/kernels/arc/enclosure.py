"""What is certain of an arc by its ends, for one block and in lanes alike: nothing is met between them; it does not graze."""

from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.numerics.elementary import fma


@njit(**SIMD_INLINE)
def grazes(amplitude, start_angle, start_velocity, t, velocity):
    """Whether an arc arrives after a time t so slowly that the last digits tell whether it arrives at all."""
    most = amplitude + 1.0
    return velocity * velocity <= MARGIN * most * fma(t, fma(t, most, abs(start_velocity)), start_angle)


@njit(**SIMD_INLINE)
def outweighs(first, last, off):
    """Whether first s (1 - s)^2 + last s^2 (1 - s) > off s^2 (1 - s)^2 for every share s of the way."""
    least = min(first, last)
    return (least > 0.0) & (first + last + 2.0 * least > off)


@njit(**SIMD_INLINE)
def stays_between(system, t, first, last):
    """Whether a flight certainly meets neither the base nor a brace within a time t, by (u, u') at its ends.

    Its ``system`` is (A, Omega, brace angle).

    Between them u lies within t^4 s^2 (1 - s)^2 max|u''''|/24 of the cubic with the same ends, whose Bernstein coefficients
    tell on which side of the base and of the brace that stays. u'''' = u - 1 + A (Omega^2 - 1) cos eta; and |u - 1| is nowhere
    larger than A, or 1, or than at the ends, since u'' = u - 1 - A cos eta.
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
