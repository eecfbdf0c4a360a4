"""Search for the first zero of a function on an arc, with the proof that there is none before.

Double precision gives a guess of the time only. Newton's operator in balls then proves the zero and encloses it.
"""

from __future__ import annotations

from typing import NamedTuple

from flint import arb, ctx

from rocking.kernels.event_kinds import BRACE
from rocking.proof.arc import DEPTH, Arc, Function, positive_over
from rocking.proof.balls import Refused, hull

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
        found = self.bracket(low, middle, self.height(middle), order, depth + 1)
        return self.bracket(middle, high, end, 0, depth + 1) if found is None else found

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
                found = middle - here.value / slope
                if around.contains_interior(found):
                    return found
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
