"""Motion under a sampled base acceleration in 60 digits, by the closed form of u'' = u + f + rate x on each segment.

Nothing is taken from the package. On a segment u'' changes its sign at most once, so that u' is monotone on either part.
With the zeros of u' the segment divides into parts on which u is monotone, so that no event is missed.
"""

from itertools import pairwise
from typing import NamedTuple

import gmpy2
from gmpy2 import mpfr

BITS = 200
# Relative step of Newton's method after which the next one would change no bit that matters.
CONVERGED = mpfr(2) ** -110
# Speed below which a block is taken to rest, if the base does not lift it.
STILL = mpfr("1e-18")
# Speed below which no impact after the end of the base motion is recorded.
SLOW = mpfr("1e-6")
# Times up to this one are short enough for power series.
SHORT = mpfr(0.03)
PRECISION = gmpy2.exp2(-BITS)
# Longest time in one piece after the last sample.
LONGEST = mpfr(4)


class Impact(NamedTuple):
    """Impact at the base or at a brace: time, speed before it, and K+ of the arc after it (None at a brace)."""

    time: mpfr
    speed: mpfr
    at_brace: bool
    growth: mpfr | None


class Run(NamedTuple):
    """Motion: "rest", "overturned", "bounded", "leaning" or "end", its impacts, and K+ of all arcs from the base."""

    outcome: str
    impacts: list
    growths: list


class Piece(NamedTuple):
    """u and u' at the start of a segment, and u'' - u = force + rate x."""

    u: mpfr
    v: mpfr
    force: mpfr
    rate: mpfr


def hyperbolic(x):
    """Return sinh x, cosh x - 1 and sinh x - x without cancellation."""
    if x > SHORT:
        half = gmpy2.sinh(x / 2)
        sinh = gmpy2.sinh(x)
        return sinh, 2 * half * half, sinh - x
    square, k = x * x, 3
    even = square / 2
    odd = even * x / 3
    versinh, excess, least = even, odd, even * PRECISION
    while even > least:
        even = odd * x / (k + 1)
        odd = even * x / (k + 2)
        versinh += even
        excess += odd
        k += 2
    return x + excess, versinh, excess


def advance(piece, functions):
    """Return u and u' from the ``hyperbolic`` functions of a time."""
    u, v, force, rate = piece
    sinh, versinh, excess = functions
    second = u + force
    return u + (v * sinh + (second * versinh + rate * excess)), v + (second * sinh + (v + rate) * versinh)


def derivatives(piece, x):
    """Return u, u', u'' and u''' after a time x."""
    u, v = advance(piece, hyperbolic(x))
    return u, v, u + piece.force + piece.rate * x, v + piece.rate


def zero(function, low, high, x):
    """Return the zero of a monotone function in [low, high]: Newton's method from x, safeguarded by bisection.

    ``function`` returns its value, which is positive at ``low`` and negative at ``high``, and its derivative.
    """
    for _ in range(4 * BITS):
        value, slope = function(x)
        if value > 0:
            low = x
        else:
            high = x
        ahead = x - value / slope if slope else low
        if not low < ahead <= high:
            ahead = (low + high) / 2
        if abs(ahead - x) <= CONVERGED * abs(ahead):
            return ahead
        x = ahead
    raise ArithmeticError(f"no zero between {low} and {high}")


def sign_change(piece, order, left, right):
    """Return the zero of a derivative between two times if it changes its sign there, as a list."""
    before, after = (derivatives(piece, x)[order] for x in (left, right))
    if not before * after < 0:
        return []
    sign = gmpy2.sign(before)

    def function(x):
        found = derivatives(piece, x)
        return sign * found[order], sign * found[order + 1]

    slope = derivatives(piece, left)[order + 1]
    guess = left - before / slope if slope * before < 0 else right
    return [zero(function, left, right, min(guess, (left + right) / 2))]


def first_event(piece, length, u, brace):
    """Return time and place ("at the brace") of the first event in a segment that ends with ``u``, or None."""
    second = u + piece.force + piece.rate * length
    if piece.u == 0 and u < 0 < piece.v and piece.force < 0 and second < 0:
        # u is concave, because u'' changes its sign once at most
        x = fall(piece, 1, 0, mpfr(0), length)
        if brace is None or piece.v * x < brace:
            return x, False
    bends = [mpfr(0), *sign_change(piece, 2, mpfr(0), length), length]
    turns = [turn for left, right in pairwise(bends) for turn in sign_change(piece, 1, left, right)]
    for left, right in pairwise([mpfr(0), *turns, length]):
        u = advance(piece, hyperbolic(right))[0]
        if u < 0:
            return fall(piece, 1, 0, left, right), False
        if brace is not None and u > brace:
            return fall(piece, -1, brace, left, right), True
    return None


def fall(piece, sign, level, left, right):
    """Return the time at which sign (u - level) falls through zero, from the parabola through ``left``."""

    def function(x):
        u, v, _, _ = derivatives(piece, x)
        return sign * (u - level), sign * v

    u, v, second, _ = derivatives(piece, left) if left else (piece.u, piece.v, piece.u + piece.force, None)
    height, slope, second = sign * (u - level), sign * v, sign * second
    under = slope * slope - 2 * height * second
    guess = right
    if second < 0:
        guess = left + (slope + gmpy2.sqrt(under)) / -second
    elif slope < 0 < under:
        guess = left + 2 * height / (gmpy2.sqrt(under) - slope)
    return zero(function, left, right, guess if left < guess < right else (left + right) / 2)


class Base:
    """Base acceleration: samples, 0 before the first and after the last, and R = integral of e^(t - x) a(x) over x > t."""

    def __init__(self, values, step, scale):
        self.step, self.last = mpfr(float(step)), len(values) - 1
        self.values = [mpfr(float(value)) * mpfr(float(scale)) for value in values]
        self.rates = [(second - first) / self.step for first, second in pairwise(self.values)]
        self.later = [mpfr(0)]
        for index in reversed(range(self.last)):
            self.later.append(self._after(index, mpfr(0), self.later[-1]))
        self.later.reverse()

    def line(self, index):
        """Return the acceleration at a sample and its rate."""
        return (self.values[index], self.rates[index]) if index < self.last else (mpfr(0), mpfr(0))

    def _after(self, index, offset, later):
        start, rate = self.line(index)
        rest = self.step - offset
        decay = gmpy2.exp(-rest)
        return decay * later + (start + rate * offset) * (1 - decay) + rate * (1 - decay * (1 + rest))

    def integral(self, index, offset):
        """Return R at a place."""
        return mpfr(0) if index >= self.last else self._after(index, offset, self.later[index + 1])


def motion(values, step, restitution, *, scale=1.0, angle=0.0, velocity=0.0, brace=None, until=None):
    """Return the ``Run`` of a block; ``brace`` is (angle, restitution), ``until`` a time."""
    with gmpy2.context(precision=BITS):
        block = Block(Base(values, step, scale), mpfr(float(restitution)), brace)
        until = None if until is None else mpfr(float(until))
        outcome = block.run(mpfr(float(angle)), mpfr(float(velocity)), until)
        return Run(outcome, block.impacts, block.growths)


class Block:
    """Block at a place of the base motion: side, u, u' and mode."""

    def __init__(self, base, restitution, brace):
        self.base, self.e = base, restitution
        self.brace, self.r = (None, None) if brace is None else (mpfr(float(one)) for one in brace)
        self.index, self.offset, self.mode = 0, mpfr(0), "flight"
        self.impacts, self.growths = [], []
        self.whole = hyperbolic(base.step)

    def run(self, angle, velocity, until):
        """Follow the motion; return its outcome."""
        self.side = 1 if (angle, velocity) > (0, 0) else -1
        self.u, self.v = abs(angle), self.side * velocity
        if self.u == 0 and self.v == 0:
            self.mode = "rest"
        elif self.u == 0:
            self.note_growth()
        outcome = None
        while outcome is None:
            if until is not None and self.time() >= until:
                return "end"
            outcome = getattr(self, self.mode)()
        return outcome

    def time(self):
        return self.index * self.base.step + self.offset

    def next_segment(self):
        self.index, self.offset = self.index + 1, mpfr(0)

    def force(self):
        """Return u'' - u here and its rate."""
        start, rate = self.base.line(self.index)
        return -1 - self.side * (start + rate * self.offset), -self.side * rate

    def note_growth(self):
        """Note K+ of the arc that begins at the base."""
        self.growths.append(self.v - 1 - self.side * self.base.integral(self.index, self.offset))

    def rest(self):
        """Wait at the base until |a| exceeds 1."""
        if self.index >= self.base.last:
            return "rest"
        start, rate = self.base.line(self.index)
        here, end = start + rate * self.offset, self.base.values[self.index + 1]
        if abs(here) > 1 or abs(end) > 1:
            if abs(here) <= 1:
                self.offset, here = (gmpy2.sign(end) - start) / rate, end
            self.side, self.mode = (-1 if here > 0 else 1), "flight"
            self.u = self.v = mpfr(0)
            self.note_growth()
        else:
            self.next_segment()
        return None

    def lean(self):
        """Wait at the brace until u'' < 0 there."""
        if self.index >= self.base.last:
            if self.brace >= 1:
                return "leaning"
            self.mode = "flight"
            return None
        force, rate = self.force()
        press = self.brace + force
        if press < 0 or (press == 0 and rate < 0):
            self.mode = "flight"
        elif press + rate * (self.base.step - self.offset) < 0:
            self.offset -= press / rate
            self.mode = "flight"
        else:
            self.next_segment()
        return None

    def flight(self):
        """Move to the next event or to the next sample."""
        free = self.index >= self.base.last
        if free and self.brace is None:
            return self.free()
        whole = not free and self.offset == 0
        length = LONGEST if free else self.base.step - self.offset
        force, rate = self.force()
        if (self.u == 0 or self.u == self.brace) and self.v == 0 and abs(self.u + force) < STILL:
            force = -self.u
        piece = Piece(self.u, self.v, force, rate)
        u, v = advance(piece, self.whole if whole else hyperbolic(length))
        before, after = self.u + force, u + force + rate * length
        monotone = before * after > 0 and self.v * v > 0
        inside = u > 0 and (self.brace is None or u < self.brace)
        found = None if monotone and inside else first_event(piece, length, u, self.brace)
        if found is not None:
            self.contact(piece, *found)
            return None
        self.u, self.v = u, v
        if free:
            self.offset += length
        else:
            self.next_segment()
        return None

    def contact(self, piece, x, at_brace):
        """Apply the impact law."""
        speed = abs(advance(piece, hyperbolic(x))[1])
        self.offset += x
        if at_brace:
            self.u, self.v = self.brace, -self.r * speed
            if speed * self.r < STILL:
                self.v, self.mode = mpfr(0), "lean"
        else:
            self.side, self.u, self.v = -self.side, mpfr(0), self.e * speed
            if self.v < STILL:
                self.v, self.mode = mpfr(0), "rest"
            else:
                self.note_growth()
        known = not at_brace and self.mode == "flight"
        self.impacts.append(Impact(self.time(), speed, at_brace, self.growths[-1] if known else None))

    def free(self):
        """Return the outcome of the free motion after the last sample: the energy and K+ decide."""
        growth = self.u + self.v - 1
        if growth > 0:
            return "overturned"
        speed = gmpy2.sqrt(self.v * self.v + self.u * (2 - self.u))
        self.offset += gmpy2.log((1 + speed) / -growth)
        while speed > SLOW and len(self.impacts) < 10_000:
            self.impacts.append(Impact(self.time(), speed, False, self.e * speed - 1))
            speed *= self.e
            self.growths.append(speed - 1)
            if speed > 1:
                return "overturned"
            if self.e == 1:
                return "bounded"
            self.offset += 2 * gmpy2.atanh(speed)
        return "rest"
