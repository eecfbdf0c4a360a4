"""Arc in balls: the closed form of u = side * angle, Eq. (5) of Yim & Lin (1991), and the proof that it meets nothing on its way.

On one side u'' = u - 1 - side A cos psi, so that

    u = 1 + side beta cos psi + grow e^s + shrink e^-s,  psi = psi0 + frequency s.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from flint import arb

from rocking.proof.balls import Balls, hull, largest

# Number of times that an interval is halved before a proof is given up.
DEPTH = 60
# Number of intervals of one proof.
PIECES = 4000


class Values(NamedTuple):
    """A function and its first three derivatives at a time, as balls."""

    value: arb
    first: arb
    second: arb
    third: arb


Function = Callable[[arb], Values]


class Arc(NamedTuple):
    """Arc from a forcing phase on."""

    p: Balls
    phase: arb
    swing: tuple[arb, arb, arb, arb]  # side * beta, times 1, frequency, its square and its cube
    grow: arb
    shrink: arb

    def at(self, time: arb) -> Values:
        """Return u and its derivatives at a time after the start."""
        sine, cosine = (self.phase + self.p.frequency * time).sin_cos()
        growth = time.exp()
        more, less = self.grow * growth, self.shrink / growth
        even, odd, swing = more + less, more - less, self.swing
        return Values(
            1 + swing[0] * cosine + even,
            odd - swing[1] * sine,
            even - swing[2] * cosine,
            odd + swing[3] * sine,
        )

    def angle(self, time: arb) -> arb:
        """Return u alone, in half the time."""
        growth = time.exp()
        swing = self.swing[0] * (self.phase + self.p.frequency * time).cos()
        return 1 + swing + (self.grow * growth + self.shrink / growth)

    def in_double(self) -> Callable[[float], tuple[float, float]]:
        """Return the function that gives u and u' in double precision."""
        numbers = self.phase, self.p.frequency, self.swing[0], self.swing[1], self.grow, self.shrink
        phase, frequency, swing, faster, grow, shrink = (float(number) for number in numbers)

        def values(time: float) -> tuple[float, float]:
            turned, growth = phase + frequency * time, math.exp(time)
            more, less = grow * growth, shrink / growth
            return 1.0 + swing * math.cos(turned) + more + less, more - less - faster * math.sin(turned)

        return values

    def below_brace(self, time: arb) -> Values:
        """Return the distance from the brace, and its derivatives."""
        u = self.at(time)
        assert self.p.brace_angle is not None
        return Values(self.p.brace_angle - u.value, -u.first, -u.second, -u.third)


def arc_from(p: Balls, side: int, phase: arb, angle: arb, velocity: arb) -> Arc:
    """Return the arc through (u, u') = (angle, velocity) at a forcing phase."""
    sine, cosine = phase.sin_cos()
    swing, rate = side * p.response, p.frequency
    first = swing * rate
    above, faster = angle - 1 - swing * cosine, velocity + first * sine
    swings = swing, first, first * rate, first * rate * rate
    return Arc(p, phase, swings, (above + faster) / 2, (above - faster) / 2)


def stays_positive(function: Function, end: arb, order: int, arrives: bool) -> bool:
    """Return whether it is proved that a function is positive inside (0, end).

    Parameters
    ----------
    function : callable
        Function with its derivatives.
    end : arb
        End of the interval.
    order : int
        Order of the known zero at time 0, with a positive derivative of this order; 0 if the function is positive there.
    arrives : bool
        Whether the function is known to vanish at the end.
    """
    pieces = [(arb(0), end, order, arrives, 0)]
    for _ in range(PIECES):
        if not pieces:
            return True
        low, high, zero, last, depth = pieces.pop()
        if positive_over(function, low, high, function(hull(low, high)), zero, last):
            continue
        if depth >= DEPTH:
            return False
        middle = ((low + high) / 2).mid()
        if not function(middle).value > 0:
            return False
        pieces += [(middle, high, 0, last, depth + 1), (low, middle, zero, False, depth + 1)]
    return False


def positive_over(function: Function, low: arb, high: arb, over: Values, order: int, arrives: bool) -> bool:
    """Return whether one bound proves that a function is positive inside an interval, where its values are ``over``.

    At the ends the function is positive, or it vanishes as ``order`` and ``arrives`` say. It is positive inside if it is so over
    the whole ball. It is so, too, if it is concave. After a zero of an order its derivative of this order may be positive
    throughout, and before a zero its slope negative.
    """
    if over.second < 0:
        return True
    if order and over[order] > 0:
        return True
    if arrives and over.first < 0:
        return True
    if order or arrives:
        return False
    if over.value > 0:
        return True
    middle = ((low + high) / 2).mid()
    half = largest([(high - middle).abs_upper(), (middle - low).abs_upper()])
    at = function(middle)
    return bool(at.value - abs(at.first) * half - over.second.abs_upper() * half * half / 2 > 0)
