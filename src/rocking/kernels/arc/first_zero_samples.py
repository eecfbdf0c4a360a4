"""Arc on one segment between two samples, where the forcing term f + df x is linear: closed form and first zero.

    u(x) = u + v sinh x + (u + f)(cosh x - 1) + df (sinh x - x).

Every event function w obeys w'' - w = f_w with f_w linear, so that at most one sign change divides the segment. On either part
y = w e^x is concave or convex in z = e^2x, as in ``first_zero_cosine``:

* a concave part that starts with w >= 0 contains one zero if it ends with w < 0, else none;
* a convex part contains one zero if it ends with w < 0;
* else it contains two or none, by the sign of w where w + w' changes its sign.
"""

import math
from typing import NamedTuple

from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import brief_hyperbolic
from rocking.kernels.numerics.taylor import I3, reversion

ITERATIONS = 100
# After this number of steps every second one is a bisection.
MAX_STEPS = 8
ROUNDING = 2.0**-53
# Limit of the square of a step's small parameter: its fourth power, which ``reversion`` neglects, is below rounding.
NEAR = 2.0**-28


class Piece(NamedTuple):
    """Function w on a segment: w and w' at its start, and w'' - w = force + rate x."""

    w: float
    dw: float
    force: float
    rate: float


@kernel(inline=True)
def at(piece, x):
    """Return w and w' a time x after the start of the segment."""
    sinh, versinh, excess = brief_hyperbolic(x)
    return with_hyperbolic(piece, sinh, versinh, excess)


@kernel(inline=True)
def with_hyperbolic(piece, sinh, versinh, excess):
    """Return w and w' from sinh x, cosh x - 1 and sinh x - x."""
    second = piece.w + piece.force
    return (
        piece.w + (piece.dw * sinh + (second * versinh + piece.rate * excess)),
        piece.dw + (second * sinh + (piece.dw + piece.rate) * versinh),
    )


class Approximation(NamedTuple):
    """Approximation x of the only zero of w in [low, high], and w' there; w > 0 just after low and w <= 0 at high."""

    low: float
    high: float
    x: float
    dw: float
    is_last: bool  # whether it is exact to rounding


@kernel(inline=True)
def improved(piece, old, bisect):
    """Return a better approximation, by Newton's method of higher order or, on request, by bisection."""
    w, dw = at(piece, old.x)
    low, high = (old.x, old.high) if w > 0.0 else (old.low, old.x)
    second, third = w + piece.force + piece.rate * old.x, dw + piece.rate
    ahead, is_last = 0.5 * (low + high), False
    if dw < 0.0 and not bisect:
        per = 1.0 / dw
        y = -w * per
        factor = reversion(y, second, third, second, per)
        is_last = y * y * max((second * per) * (second * per), abs(third * per), 1.0) < NEAR
        ahead = old.x + (y * factor if 0.5 < factor < 2.0 else y)
        if not low <= ahead <= high:
            ahead, is_last = 0.5 * (low + high), False
    step = ahead - old.x
    dw += step * (second + step * (0.5 * third + step * (I3 * second)))
    is_last = is_last or abs(step) <= 4.0 * ROUNDING * ahead
    return Approximation(low, high, ahead, dw, is_last)


@kernel
def repeated(piece, zero):
    """Improve an approximation until it is exact to rounding."""
    for k in range(1, ITERATIONS):
        zero = improved(piece, zero, k > MAX_STEPS and k % 2 == 0)
        if zero.is_last:
            break
    return zero.x, zero.dw


@kernel(inline=True)
def refine(piece, low, high, x):
    """Refine the only zero of w in [low, high], from the guess x: w > 0 just after low and w <= 0 at high.

    Returns
    -------
    tuple of (float, float)
        The zero, and w' there.
    """
    # Mostly the first step is the last one.
    zero = improved(piece, Approximation(low, high, x, 0.0, False), False)
    return (zero.x, zero.dw) if zero.is_last else repeated(piece, zero)


@kernel
def guess(piece, start, high):
    """Return a first guess of the zero in (start, high): nearly that of the cubic if it lies there, else the middle."""
    (t, w, dw), f = start, piece.force + piece.rate * start[0]
    second = w + f
    under = dw * dw - 2.0 * w * second
    x = math.inf
    if under > 0.0:
        root = math.sqrt(under)
        if second < 0.0:
            x = (dw + root) / -second
        elif dw < 0.0:
            x = 2.0 * w / (root - dw)
        # At x the cubic lies w''' x^3/6 above the parabola, whose slope there is -root: two terms of Newton's step.
        third, per = dw + piece.rate, 1.0 / root
        square, bent = x * x, 0.5 * per * third
        more = square * (x * (bent * (1.0 / 3.0)))
        x += more * (1.0 + square * bent + (0.5 * per * (second + x * third)) * more)
    return t + x if 0.0 < x < high - t else 0.5 * (t + high)


@kernel
def below_zero(piece, start, end):
    """Return a time in a convex part at which w <= 0, or infinity if w stays positive.

    ``start`` and ``end`` are (time, w, w') at its ends, where w > 0. (w + w') e^-x only grows. At its zero w e^x is least.
    """
    (left, w, dw), (right, w_right, dw_right) = start, end
    if w + dw >= 0.0 or dw_right - w_right <= 0.0:
        return math.inf
    low, high = left, right
    x = left - (w + dw) * (right - left) / ((dw_right + w_right) - (w + dw))
    for _ in range(ITERATIONS):
        w, dw = at(piece, x)
        if w <= 0.0:
            return x
        slope = w + dw
        if slope < 0.0:
            low = x
        else:
            high = x
        ahead = x - slope / (slope + piece.force + piece.rate * x)
        if not low <= ahead <= high:
            ahead = 0.5 * (low + high)
        # The tangent bounds how much lower the minimum may be.
        if abs(ahead - x) <= 1e-9 * (high - low) + ROUNDING * high and w > abs(slope * (ahead - x)):
            return math.inf
        if ahead == x:
            return math.inf
        x = ahead
    return math.inf


@kernel
def minimum(piece, length, end):
    """Return the minimum of w inside a segment, and its time; infinity if there is none. ``end`` is (w, w') at the end.

    y = w'' obeys y'' = y, so that it changes its sign once at most, and w has one minimum at most.
    """
    second, (w_end, dw_end) = piece.w + piece.force, end
    second_end = w_end + piece.force + piece.rate * length
    begun, dw = 0.0, piece.dw
    rises = dw_end >= -4.0 * ROUNDING * (abs(dw) + abs(second))  # to rounding
    if dw >= 0.0:
        if not (second < 0.0 < second_end and rises):
            return math.inf, 0.0
        if dw > 0.0:
            begun, second = first_zero(Piece(dw, second, piece.rate, 0.0), length, (dw_end, second_end))
            if begun == math.inf:
                return math.inf, 0.0
            dw = 0.0
    elif not (rises or second > 0.0 > second_end):
        return math.inf, 0.0
    x, _ = first_zero(Piece(-dw, -second, -piece.rate, 0.0), length - begun, (-dw_end, -second_end))
    if x == math.inf:
        return (w_end, length) if rises else (math.inf, 0.0)
    w, _ = at(piece, begun + x)
    return w, begun + x


@kernel
def first_zero(piece, length, end):
    """Return the first time in (0, length] at which w falls through zero, and w' there; infinity if there is none.

    w >= 0 at the start. If w = w' = 0 there, w rises first. ``end`` is (w, w') at ``length``.

    Returns
    -------
    tuple of (float, float)
        The time, and w' there.
    """
    left, w, dw = 0.0, piece.w, piece.dw
    cut, last = length, piece.force + piece.rate * length
    if piece.force * last < 0.0:
        cut = min(-piece.force / piece.rate, length)
    at_rest = w == 0.0 and dw == 0.0
    for _ in range(2):
        right = cut if left == 0.0 else length
        w_right, dw_right = end if right == length else at(piece, right)
        convex = piece.force + piece.rate * (0.5 * (left + right)) > 0.0
        low_end = right if w_right < 0.0 else math.inf
        if at_rest:
            low_end = math.inf
        elif convex and w_right >= 0.0:
            low_end = below_zero(piece, (left, w, dw), (right, w_right, dw_right))
        if low_end < math.inf:
            return refine(piece, left, low_end, guess(piece, (left, w, dw), low_end))
        if right == length:
            break
        at_rest = at_rest and not convex
        left, w, dw = right, w_right, dw_right
    return math.inf, 0.0
