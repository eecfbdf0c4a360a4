"""First event of one arc, proved by branch and bound in ball arithmetic.

The numbers that describe an arc are taken as exact. The time axis is divided adaptively. On each interval Taylor
enclosures of the distance, of its first and of its second derivative decide: no zero, one zero, one dip, or divide again.
The method does not use the sign intervals of the forcing.
"""

import math
from typing import NamedTuple

from flint import arb

from oracles.distance import AMBIGUOUS, ZERO, Distance

MAX_PIECES = 100_000


class Event(NamedTuple):
    """Zero, or indistinguishably shallow minimum, of the distance to the base or to a brace.

    velocity is d|Θ|/dτ just before the event. depth is the least distance in units of 2⁻⁵³ times the sum of the
    magnitudes of its terms, infinite where the distance falls through zero far beyond it, nan where it only sinks below
    rounding there, after dips that rounding hides. definite: no rounding can hide the event.
    """

    kind: str
    time: arb
    velocity: arb
    depth: float
    definite: bool


CLEAR, UNDECIDED, SHALLOW = "clear", "undecided", "shallow"


def _inspect(distance, left, right):
    """Classify [left, right] as CLEAR, UNDECIDED or an Event; w(left) > 0, or left is the start.

    SHALLOW: w has its one zero here, but at the right end it is not yet below zero by more than rounding.
    """
    margin = AMBIGUOUS * distance.size_bound(right)
    if distance.frequency * (right - left) > 3:
        return CLEAR if distance.swell(left, right) > margin else UNDECIDED
    w, first, second = distance.enclose(left, right)
    if w > margin or first > 0:
        return CLEAR
    if second > 0:
        if (distance.start_slope if left == 0 else distance.at(left)[1]) >= 0:
            return CLEAR
        if distance.at(right)[1] > 0:
            return _dip(distance, left, right)
        first = arb(-1) if distance.at(right)[1] < 0 else first
    if second < 0 or first < 0:
        last = distance.at(right)[0]
        if last > 0:
            return CLEAR
        if last < -AMBIGUOUS * distance.size(right):
            return _event(distance, distance.zero(left, right), math.inf, True)
        if last < 0:
            return SHALLOW
    return UNDECIDED


def _dip(distance, left, right):
    """A dip of w: clear of zero, through it, or too shallow to tell."""
    lowest = distance.lowest(left, right)
    depth = distance.depth(lowest)
    if depth > 8:
        return CLEAR
    if depth < -8:
        return _event(distance, distance.zero(left, lowest.mid()), depth, True)
    return _event(distance, lowest, depth, False)


def _event(distance, time, depth, definite):
    return Event(distance.kind, time, distance.outward * distance.at(time)[1], float(depth), definite)


def _fall(distance, zero, left, step):
    """Follow w, which falls at left, below its known zero until it exceeds rounding or turns. Returns (Event, time)."""
    for _ in range(MAX_PIECES):
        right = (left + step).mid()
        _, first, second = distance.enclose(left, right)
        if first < 0:
            if distance.at(right)[0] < -AMBIGUOUS * distance.size(right):
                return _event(distance, zero, math.inf, True), right
            left = right
        elif second > 0 and distance.at(left)[1] < 0 and distance.at(right)[1] > 0:
            lowest = distance.lowest(left, right)
            depth = distance.depth(lowest)
            return _event(distance, zero if depth < -8 else lowest, depth, bool(depth < -8)), right
        else:
            step /= 2
    raise ArithmeticError(f"the zero near {zero.str(20)} leads nowhere")


def _resurface(distance, left, step):
    """Return (time, False) if w > 0 again after a dip within rounding, (time, True) if it sinks below rounding first."""
    for _ in range(MAX_PIECES):
        value = distance.at(left)[0]
        if value > 0:
            return left, False
        if value < -AMBIGUOUS * distance.size(left):
            return left, True
        right = (left + step).mid()
        if (
            distance.enclose(left, right)[0] < 2 * AMBIGUOUS * distance.size_bound(right)
            or distance.at(right)[0] > 0
        ):
            left = right
        else:
            step /= 2
    raise ArithmeticError(f"a dip near {left.str(20)} does not end")


def _first_step(arc):
    """Short enough that the start itself, where the distance may vanish, is left behind in one piece."""
    scale = 1 + arc.amplitude + arc.angle
    return arb(min(0.25, 0.25 / arc.frequency, abs(arc.velocity) / scale if arc.velocity else 0.25))


def _zeros(distance, arc, limit):
    """Events of one distance up to a limit, in order; the last is definite unless none is left."""
    left, step, events, grow = ZERO, _first_step(arc), [], True
    for _ in range(MAX_PIECES):
        right = (left + step).mid()
        found = _inspect(distance, left, right)
        if found == UNDECIDED:
            step, grow = step / 2, False
            continue
        if found == SHALLOW:
            found, right = _fall(distance, distance.zero(left, right), right, step)
        if found != CLEAR:
            events.append(found)
            if found.definite:
                return events
            right, sunk = _resurface(distance, right, step / 4)
            if sunk:
                return [*events, _event(distance, right, math.nan, True)]
        if right > limit or distance.stays(right):
            return events
        if distance.knife_edge() and right > 30:
            return [*events, Event("any", right, arb(0), 0.0, True)]
        left, step, grow = right, step * 2 if grow else step, True
    raise ArithmeticError(f"{arc} cannot be decided near {left.str(20)}")


def first_events(arc):
    """Return the possible first events of an arc: shallow dips in order, then the first definite one ("none": no return)."""
    events = _zeros(Distance(arc, "base"), arc, arb(10) ** 6)
    if math.isfinite(arc.brace):
        limit = events[-1].time if events and events[-1].definite else arb(10) ** 6
        events = sorted(
            events + _zeros(Distance(arc, "brace"), arc, limit), key=lambda event: float(event.time)
        )
    last = next((index for index, event in enumerate(events) if event.definite), None)
    if last is None:
        return [*events, Event("none", arb.pos_inf(), arb.nan(), math.inf, True)]
    return events[: last + 1]


def condition(arc, event):
    """Relative condition numbers of an impact: two lists, of its time and of its speed, with respect to v₀, ψ₀, Ω and A."""
    distance = Distance(arc, "base")
    frequency, ripple, time = distance.frequency, distance.d, event.time
    sinh, cosh = time.sinh_cosh()
    sine0, cosine0 = distance.phase.sin_cos()
    sine, cosine = (distance.phase + frequency * time).sin_cos()
    swing = ripple * (cosine - cosine0 * cosh + frequency * sine0 * sinh)
    swing_rate = ripple * (frequency * sine0 * cosh - cosine0 * sinh - frequency * sine)
    fading = -2 * frequency / (1 + frequency**2)
    partials = (
        (arc.velocity, sinh, cosh),
        (
            arc.phase,
            ripple * (sine0 * cosh + frequency * cosine0 * sinh - sine),
            ripple * (sine0 * sinh + frequency * (cosine0 * cosh - cosine)),
        ),
        (
            arc.frequency,
            fading * swing + ripple * (sine0 * sinh - time * sine),
            fading * swing_rate + ripple * (sine0 * cosh - sine - frequency * time * cosine),
        ),
        (1.0, swing, swing_rate),
    )
    acceleration = distance.at(time)[2]
    of_time, of_speed = [], []
    for value, angle, velocity in partials:
        shift = -angle / event.velocity
        of_time.append(abs(value * float(shift / time)))
        of_speed.append(abs(value * float((velocity + acceleration * shift) / event.velocity)))
    return of_time, of_speed
