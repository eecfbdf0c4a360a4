"""First crossing of one step of the full block, proved in ball arithmetic (Moore's interval Taylor series).

Nothing is taken from the package. The step is divided into pieces. Because |w''| <= 1 + alpha |A|, the state on a piece lies in a box
that is known beforehand. The Taylor coefficient of order N, evaluated over this box, encloses the remainder.
"""

import math
from contextlib import contextmanager
from typing import NamedTuple

from flint import arb, arb_poly, arb_series, ctx

ORDER = 24
BITS = 128
LONGEST, TURN = 0.125, 1.0
"""Longest piece, in the time 1/sqrt(1 + alpha A) in which a motion changes, and the largest change of the phase on it."""
NARROWEST = 2.0**-40
"""Part of a piece below which a crossing that is not proved counts as a touch."""
UNIT = arb(0, 1)


class Wave(NamedTuple):
    """Base acceleration A (cosine cos(frequency t) - sine sin(frequency t)), t from the start of a step."""

    amplitude: float
    frequency: float
    cosine: float
    sine: float

    def largest(self, _):
        """Return a bound up to a time."""
        return abs(arb(self.amplitude)) * (arb(self.cosine) ** 2 + arb(self.sine) ** 2).sqrt()

    def series(self):
        """Return the series in t."""
        turn = arb_series([0, arb(self.frequency)])
        return arb(self.amplitude) * (arb(self.cosine) * turn.cos() - arb(self.sine) * turn.sin())

    def later(self, time):
        """Return the base acceleration from a later time on."""
        turn = arb(self.frequency) * time
        cosine = self.cosine * turn.cos() - self.sine * turn.sin()
        return self._replace(cosine=cosine, sine=self.sine * turn.cos() + self.cosine * turn.sin())


class Line(NamedTuple):
    """Base acceleration value + slope t, as between two samples."""

    value: float
    slope: float
    frequency: float = 0.0

    def largest(self, time):
        """Return a bound up to a time."""
        return abs(arb(self.value)) + abs(arb(self.slope)) * time

    def series(self):
        """Return the series in t."""
        return arb_series([arb(self.value), arb(self.slope)])

    def later(self, time):
        """Return the base acceleration from a later time on."""
        return self._replace(value=self.value + arb(self.slope) * time)


class Start(NamedTuple):
    """Start of a step: side, u, u' and the base acceleration from then on."""

    alpha: float
    side: int
    angle: float
    velocity: float
    base: Wave | Line


class Touch(NamedTuple):
    """First fall through 0: an interval, and whether the fall is proved."""

    low: float
    high: float
    proved: bool


@contextmanager
def precision():
    """Compute with BITS binary digits."""
    before = ctx.prec, ctx.cap
    ctx.prec = BITS
    try:
        yield
    finally:
        ctx.prec, ctx.cap = before


def series(start, w, rate, base):
    """Return the coefficients of w up to t^ORDER, from balls of w, w' and of the base acceleration, by Picard's iteration."""
    ctx.cap = ORDER + 1  # a series keeps the number of terms with which it is made
    base = arb(start.side) * arb(start.alpha) * base.series()
    first = found = arb_series([w, rate])
    for iteration in range(1, ORDER // 2 + 1):
        ctx.cap = 2 * iteration + 1  # two orders each
        bend = found.sin() + base * found.cos()
        found = first + bend.integral().integral()
    return [found[k] for k in range(ORDER + 1)]


class Motion:
    """Enclosure of u on a step, by pieces."""

    def __init__(self, start, length):
        rate = math.sqrt(1.0 + start.alpha * float(start.base.largest(length).upper()))
        self.start, self.count = start, math.ceil(length * max(rate / LONGEST, start.base.frequency / TURN))
        self.length, self.piece = length, length / self.count
        with precision():
            self.pieces = self._enclosed()

    def _enclosed(self):
        start, alpha, h = self.start, arb(self.start.alpha), arb(self.piece)
        w, rate = alpha * (1 - arb(start.angle)), -alpha * arb(start.velocity)
        angle, velocity, base, found = arb(start.angle), arb(start.velocity), start.base, []
        for _ in range(self.count):
            push = 1 + alpha * base.largest(h)
            whole = (h / 2) * arb(1, 1)  # 0 to h
            box, speeds = w + rate * whole + UNIT * push * h * h / 2, rate + UNIT * push * h
            exact = series(start, w, rate, base)
            over_all = series(start, box, speeds, base.later(whole))
            # u = 1 - w/alpha, with u and u' at the start as they are given
            rest = [-each / alpha for each in (*exact[2:ORDER], over_all[ORDER])]
            part = arb_poly([angle, velocity, *rest])
            found.append(part)
            # The box holds for u' too: its remainder is ORDER times the same coefficient.
            angle, velocity = part(h), part.derivative()(h)
            w, rate = alpha * (1 - angle), -alpha * velocity
            base = base.later(h)
        return found

    def at(self, time):
        """Return the ball of u at a time."""
        number = min(int(time / self.piece), self.count - 1)
        with precision():
            return self.pieces[number](arb(time) - number * arb(self.piece))

    def first_fall(self, order):
        """Return the first fall through 0 in (0, length], or None; the known zero of an order at the start is divided out."""
        with precision():
            for number, part in enumerate(self.pieces):
                found = first_in(*divided(part, 0 if number else order), 0.0, self.piece, self.piece)
                if found is not None:
                    offset = number * self.piece
                    return Touch(offset + found.low, offset + found.high, found.proved)
        return None


def divided(part, order):
    """Return g = u/t^order and g'. The remainders of u and u' differ, so that of g' is not the derivative of that of g."""
    g = [part[k] for k in range(order, ORDER + 1)]
    slope = [(k - order) * part[k] for k in range(order + 1, ORDER)]
    return arb_poly(g), arb_poly([*slope, ORDER * part[ORDER] - order * part[ORDER]])


def first_in(g, slope, low, high, length):
    """Return the first fall of g > 0 to 0 in [low, high], or None."""
    middle = 0.5 * (low + high)
    part = arb(middle, 0.5 * (high - low) * (1 + 1e-12))
    value = g(part)
    if value > 0:
        return None
    if value < 0:
        return Touch(low, low, True)
    bend = slope(part)
    if bend < 0 or bend > 0:
        first, last = g(arb(low)), g(arb(high))
        if first > 0 and last > 0:
            return None
        if first > 0 and last < 0:
            return narrowed(g, low, high)
    if high - low < NARROWEST * length:
        return Touch(low, high, False)
    found = first_in(g, slope, low, middle, length)
    return first_in(g, slope, middle, high, length) if found is None else found


def narrowed(g, low, high):
    """Return a narrow interval in which a monotone g falls to 0."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        value = g(arb(middle))
        if value > 0:
            low = middle
        elif value < 0:
            high = middle
        else:
            break
    return Touch(low, high, True)
