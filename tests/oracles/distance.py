"""Distance of an arc from the base or from a brace, and enclosures of it, in ball arithmetic."""

from typing import NamedTuple

from flint import arb, ctx

ctx.prec = 320
ROUNDING = arb(2) ** -53
AMBIGUOUS = 8 * ROUNDING  # a dip within this share of its terms may be read either way in double precision
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
        """Bound the sum of the magnitudes of the terms of w'."""
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
        wave = self.with_p * 2 + self.with_q * (1 + self.frequency * time)
        terms = self.growth_size * grow + self.constant + self.with_cosh + wave / (1 + self.frequency**2)
        return self.p * grow > abs(self.q) / grow + abs(self.k) + abs(self.d) + AMBIGUOUS * terms

    def knife_edge(self):
        """Return whether the growing part is lost in rounding. Then double precision cannot decide the last event."""
        return not abs(self.p) > AMBIGUOUS * self.growth_size

    def zero(self, left, right):
        """The one time in (left, right) where w passes from + to −."""
        return pinned(lambda time: self.at(time)[:2], left, right)

    def lowest(self, left, right):
        """The one time in (left, right) where w' passes from − to +."""
        return pinned(lambda time: [-value for value in self.at(time)[1:3]], left, right)


def pinned(function, left, right):
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
