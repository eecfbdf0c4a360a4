"""Arc in balls: the closed form of u = side * angle, Eq. (5) of Yim & Lin (1991), and the proof that it meets no event before a time.

A ball is a real number with a rigorous bound of its error (F. Johansson, Arb, 2017).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from typing import NamedTuple

from flint import arb, ctx

from rocking.kernels.event_kinds import BRACE
from rocking.model.system import System


class Refused(Exception):
    """A condition of a proof is not shown; the text names it."""


class TooLong(Refused):
    """A motion is followed too long; more digits do not help."""


class Balls(NamedTuple):
    """Parameters of a slender block under a harmonic base motion.

    With unequal sides they are those of the right side, and ``left`` has those of the other one, in its own units. There it moves
    as a slender block: under a base acceleration smaller by the ratio of angles, in times longer by that of frequency parameters.
    """

    amplitude: arb
    frequency: arb
    response: arb  # beta = A/(1 + frequency^2)
    restitution: arb  # of impacts that end an arc on the side
    brace_angle: arb | None
    brace_restitution: arb
    angle: arb | int = 1  # unit of the angles of the side
    rate: arb | int = 1  # ratio of frequency parameters
    left: Balls | None = None  # None for equal sides

    @property
    def speed(self) -> arb | int:
        """Unit of the speeds of the side."""
        return self.angle * self.rate

    def on(self, side: int) -> Balls:
        """Return the parameters of a side."""
        return self.left if side < 0 and self.left is not None else self


def with_left(p: Balls, angle: arb, rate: arb, restitution: arb) -> Balls:
    """Return the parameters of a block with unequal sides, from the ratios and the coefficient of its left side."""
    amplitude, frequency = p.amplitude / angle, p.frequency / rate
    response = amplitude / (1 + frequency * frequency)
    return p._replace(left=Balls(amplitude, frequency, response, restitution, None, arb(1), angle, rate))


def balls_of(system: System, widths: Mapping[str, float]) -> Balls:
    """Return the parameters of a system: the doubles that were given, exactly, or with half-widths by name.

    A frequency follows from its period in balls.
    """
    forcing, braces = system.periodic, system.braces
    name, value = forcing.given

    def number(which: str, middle: float) -> arb:
        return arb(middle, widths.get(which, 0.0))

    amplitude, frequency = number("amplitude", forcing.amplitude), number(name, value)
    if name == "period":
        frequency = 2 * arb.pi() / frequency
    p = Balls(
        amplitude,
        frequency,
        amplitude / (1 + frequency * frequency),
        number("restitution", system.restitution),
        None if braces is None else number("brace_angle", braces.angle),
        arb(1) if braces is None else number("brace_restitution", braces.restitution),
    )
    if (left := system.left) is None:
        return p
    ratios = number("angle_ratio", left.angle_ratio), number("frequency_ratio", left.frequency_ratio)
    return with_left(p, *ratios, number("left_restitution", left.restitution))


def hull(low: arb, high: arb) -> arb:
    """Return a ball that contains all numbers between two balls."""
    return low.union(high)


def largest(values: Iterable[arb]) -> arb:
    """Return a ball that contains the largest of some numbers."""
    return reduce(arb.max, values)


def least(values: Iterable[arb]) -> arb:
    """Return a ball that contains the least of some numbers."""
    return reduce(arb.min, values)


def above(value: arb) -> float:
    """Return a double that is not below any number of a ball."""
    return math.nextafter(float(value.upper()), math.inf)


def below(value: arb) -> float:
    """Return a double that is not above any number of a ball."""
    return math.nextafter(float(value.lower()), -math.inf)


def whole(value: arb) -> int:
    """Return the only whole number in a ball; raise Refused if there is none, or several."""
    number = value.unique_fmpz()
    if number is None:
        raise Refused("the number of half turns of the forcing phase is not decided")
    return int(number)


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


# Steps of Newton's method in double precision, and in balls; trials of an interval around the zero.
STEPS, EXACT, WIDER = 20, 12, 12


class Search(NamedTuple):
    """Search on an arc for an event of a kind: an impact, or a hit on a brace."""

    arc: Arc
    event: int

    @property
    def function(self) -> Function:
        """Distance from the base or the brace, which is positive at first."""
        return self.arc.below_brace if self.event == BRACE else self.arc.at

    def height(self, time: arb) -> arb:
        """Return the value of the function."""
        angle = self.arc.angle(time)
        return (
            angle if self.event != BRACE or self.arc.p.brace_angle is None else self.arc.p.brace_angle - angle
        )

    def first(self, low: arb, high: arb, order: int) -> arb | None:
        """Return the time of the first zero in [low, high]; None if there is none.

        The function is positive at ``low``, or has a zero of an ``order`` there and is positive just after it.
        """
        bracket = self.bracket(low, high, self.height(high), order, 0)
        return None if bracket is None else self.time(*bracket)

    def bracket(self, low: arb, high: arb, end: arb, order: int, depth: int) -> tuple[arb, arb] | None:
        """Return an interval that contains the first zero and no other; the function has the value ``end`` at ``high``."""
        over = self.function(hull(low, high))
        if end > 0 and positive_over(self.function, low, high, over, order, False):
            return None
        if not order and over.first < 0 and end < 0:
            return low, high
        if depth >= DEPTH:
            raise Refused(
                "whether an event comes is not decided: the motion nearly touches the base or a brace"
            )
        middle = ((low + high) / 2).mid()
        result = self.bracket(low, middle, self.height(middle), order, depth + 1)
        return self.bracket(middle, high, end, 0, depth + 1) if result is None else result

    def time(self, low: arb, high: arb) -> arb:
        """Return the time of the only zero in an interval where the function falls.

        For an interval X around m, let N = m - f(m)/f'(X). If N lies inside X, it contains a zero. If m lies in the given interval,
        the function falls over both intervals together, so that this is the zero.
        """
        middle, small = arb(self.guess(float(low), float(high))), 2.0 ** (-ctx.prec // 2)
        for _ in range(EXACT):
            here = self.function(middle)
            if not here.first < 0 or abs(float(here.value)) < small or here.value.contains(0):
                break
            middle = (middle - here.value / here.first).mid()
        if not (low <= middle and middle <= high):
            raise Refused("the time of an event is not enclosed")
        width = 2 * abs(here.value / here.first).upper() + abs(middle) * arb(2) ** (8 - ctx.prec)
        for _ in range(WIDER):
            around = hull(middle - width, middle + width)
            slope = self.function(around).first
            if slope < 0:
                result = middle - here.value / slope
                if around.contains_interior(result):
                    return result
            width *= 4
        raise Refused("the time of an event is not enclosed")

    def guess(self, low: float, high: float) -> float:
        """Return the time of the zero in double precision: Newton's method with bisection."""
        values, brace = self.arc.in_double(), self.arc.p.brace_angle
        level, sign = (0.0, 1.0) if self.event != BRACE or brace is None else (float(brace), -1.0)
        time = 0.5 * (low + high)
        for _ in range(STEPS):
            angle, rate = values(time)
            height, slope = sign * (angle - level), sign * rate
            low, high = (time, high) if height > 0.0 else (low, time)
            ahead = time - height / slope if slope < 0.0 else low
            if not low < ahead < high:
                ahead = 0.5 * (low + high)
            if abs(ahead - time) <= 1e-15 * ahead:
                break
            time = ahead
        return ahead
