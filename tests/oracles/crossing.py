"""First event of one arc, proved by branch and bound in ball arithmetic.

The doubles that describe an arc are taken as exact. The time axis is cut adaptively; on each piece Taylor enclosures of
the distance left, of its first and of its second derivative decide: no zero, one zero, one dip, or cut again. Nothing here
uses how the sign of the forcing divides an arc.
"""

import math
from typing import NamedTuple

from flint import arb, ctx

ctx.prec = 320
ROUNDING = arb(2) ** -53
AMBIGUOUS = 8 * ROUNDING  # a dip within this share of its terms may be read either way in double precision
MOST_PIECES = 100_000
RELATIVE = arb(2) ** -170  # half-width of a certified time, as a share of it
ZERO = arb(0)


class Arc(NamedTuple):
    """Start of an arc on one side: angle = |Θ| and velocity = d|Θ|/dτ; brace is infinite where there is none."""

    amplitude: float
    frequency: float
    brace: float
    side: int
    angle: float
    velocity: float
    phase: float


class Event(NamedTuple):
    """A zero (or a dip too shallow to be told from one) of the distance to the base or to a brace.

    velocity is d|Θ|/dτ just before the event. depth is the least distance in units of 2⁻⁵³ times the sum of the
    magnitudes of its terms, infinite where the distance falls through zero far beyond it, nan where it only sinks below
    rounding there, after dips that rounding hides. definite: no rounding can hide the event.
    """

    kind: str
    time: arb
    velocity: arb
    depth: float
    definite: bool


class Distance:
    """w = p eᵗ + q e⁻ᵗ + k + d cos(ψ₀ + Ωt), eq. (5): what is left to the base (w = u) or to a brace (w = Θb − u)."""

    def __init__(self, arc, kind):
        amplitude, frequency, angle, velocity = map(
            arb, (arc.amplitude, arc.frequency, arc.angle, arc.velocity)
        )
        self.kind, self.frequency, self.phase = kind, frequency, arb(arc.phase)
        sine, cosine = self.phase.sin_cos()
        ripple = arc.side * amplitude / (1 + frequency**2)
        growing = angle - 1 - ripple * cosine
        shearing = velocity + ripple * frequency * sine
        self.outward = 1 if kind == "base" else -1
        self.p, self.q = self.outward * (growing + shearing) / 2, self.outward * (growing - shearing) / 2
        self.k = arb(1) if kind == "base" else arb(arc.brace) - 1
        self.d = self.outward * ripple
        self.start_slope = self.outward * velocity
        self.touching = angle == (0 if kind == "base" else arc.brace)
        self._sizes(arc, amplitude, sine, cosine)

    def _sizes(self, arc, amplitude, sine, cosine):
        """Magnitudes of the terms of w in the form that is free of cancellation: constants, cosh, sinh, P and Q."""
        on_brace = self.kind == "brace" and self.touching
        self.constant = arb(arc.brace) if self.kind == "brace" and not self.touching else ZERO
        self.with_cosh = ZERO if on_brace else arb(arc.angle)
        self.with_curvature = abs(arb(arc.brace) - 1) if on_brace else arb(1)
        self.with_sinh = abs(arb(arc.velocity))
        self.with_p, self.with_q = abs(amplitude * cosine), abs(amplitude * sine)
        largest = self.with_cosh + self.with_sinh + self.with_curvature
        self.growth_size = largest + (self.with_p + self.frequency * self.with_q) / (1 + self.frequency**2)

    def at(self, time):
        """w, w', w'', w''' at a time."""
        grow = time.exp()
        sine, cosine = (self.phase + self.frequency * time).sin_cos()
        rising, falling = self.p * grow, self.q / grow
        ripple, slope = self.d * cosine, self.d * self.frequency * sine
        even, odd, square = rising + falling, rising - falling, self.frequency**2
        return even + self.k + ripple, odd - slope, even - square * ripple, odd + square * slope

    def size(self, time):
        """S: the sum of the magnitudes of the terms of w at a time."""
        sinh, cosh = time.sinh_cosh()
        angle = self.frequency * time
        sine, cosine = angle.sin_cos()
        share = 1 / (1 + self.frequency**2)
        p = (cosh - cosine) * share
        q = (self.frequency * sinh - sine) * share
        even = self.constant + self.with_cosh * cosh + self.with_curvature * (cosh - 1)
        return even + self.with_sinh * sinh + self.with_p * p + self.with_q * q

    def rate_size(self, time):
        """The same for w'."""
        sinh, cosh = time.sinh_cosh()
        sine, cosine = (self.frequency * time).sin_cos()
        share = 1 / (1 + self.frequency**2)
        rate = sinh + self.frequency * abs(sine)
        swing = self.frequency * (cosh - cosine)
        forced = self.with_p * rate + self.with_q * swing
        return (self.with_cosh + self.with_curvature) * sinh + self.with_sinh * cosh + forced * share

    def size_bound(self, time):
        """An upper bound of S on [0, time]: P and Q are at most cosh t − 1."""
        sinh, cosh = time.sinh_cosh()
        even = (
            self.constant
            + self.with_cosh * cosh
            + (self.with_curvature + self.with_p + self.with_q) * (cosh - 1)
        )
        return even + self.with_sinh * sinh

    def swell(self, left, right):
        """Enclosure of w on a piece of any length: the slow part, give or take the whole ripple."""
        time = left.union(right)
        return self.p * time.exp() + self.q * (-time).exp() + self.k + arb(0, abs(self.d).upper())

    def enclose(self, left, right):
        """Enclosures of w, w', w'' on a piece: Taylor about its middle, the fourth derivative bounded."""
        middle, half = (left + right) / 2, (right - left) / 2
        w, first, second, third = self.at(middle)
        grow = right.exp()
        fourth = abs(self.p) * grow + abs(self.q) / left.exp() + abs(self.d) * self.frequency**4
        offset, square = arb(0, half), arb(half**2 / 2, half**2 / 2)
        rest = arb(0, (fourth * half**2 / 2).upper())
        return (
            w + offset * first + square * (second / 2) + square * offset * (third / 6) + rest * half**2 / 12,
            first + offset * second + square * (third / 2) + rest * half / 3,
            second + offset * third + rest,
        )

    def depth(self, time):
        """w in units of the rounding of its terms."""
        return self.at(time)[0] / (self.size(time) * ROUNDING)

    def stays(self, time):
        """Proof that w > 0 from a time on, by more than rounding: the growing part wins for good."""
        if not self.p > AMBIGUOUS * self.growth_size:
            return False
        grow = time.exp()
        return self.p * grow > abs(self.q) / grow + abs(self.k) + abs(self.d) + AMBIGUOUS * self.size_bound(
            time
        )

    def knife_edge(self):
        """Whether the growing part is lost in rounding: then double precision cannot tell what comes last."""
        return not abs(self.p) > AMBIGUOUS * self.growth_size

    def zero(self, left, right):
        """The one time in (left, right) where w passes from + to −."""
        return _pinned(lambda time: self.at(time)[:2], left, right)

    def lowest(self, left, right):
        """The one time in (left, right) where w' passes from − to +."""
        return _pinned(lambda time: [-value for value in self.at(time)[1:3]], left, right)


def _pinned(function, left, right):
    """The one zero of a function (value, slope) that falls from + to − on (left, right), enclosed and proved by signs."""
    time = (left + right) / 2
    while True:
        value, slope = function(time)
        left, right = (time, right) if value > 0 else (left, time)
        newton = (time - value / slope).mid() if not slope.contains(0) else left
        if not (newton > left and newton < right):
            newton = ((left + right) / 2).mid()
        if abs(newton - time) < newton * RELATIVE / 2**20 or right - left < newton * RELATIVE / 2**20:
            break
        time = newton
    margin = newton * RELATIVE
    before, after = newton - margin, newton + margin
    if not (function(before)[0] > 0 and function(after)[0] < 0):
        raise ArithmeticError(f"zero near {newton.str(20)} not certified")
    return arb(newton, margin)


CLEAR, UNDECIDED, SHALLOW = "clear", "undecided", "shallow"


def _inspect(distance, left, right):
    """What [left, right] holds, w(left) > 0 (or the start itself) known: CLEAR, UNDECIDED or an Event.

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
    """(Event, time): a zero known, w falling at left: followed down until it lies beyond rounding, or to the bottom of its dip."""
    while True:
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


def _resurface(distance, left, step):
    """(time, False) once w > 0 again after a dip lost in rounding; (time, True) where it sinks below rounding first."""
    for _ in range(MOST_PIECES):
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
    for _ in range(MOST_PIECES):
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
    """What an arc may meet first: shallow dips in order, then the first definite event ("none": proved never to return)."""
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
