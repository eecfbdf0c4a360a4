"""First event of one arc under a sampled base acceleration, proved in ball arithmetic, and arcs for which it is hard to find.

On a segment u'' - u is linear, so that u'' changes its sign once at most. Its zero and those of u' divide the segment into
parts on which u is monotone. All signs are those of balls, so that an uncertain one is an error.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from flint import arb, ctx

ctx.prec = 320
ROUNDING = 2.0**-53
# A dip within this number of roundings of its terms may be read either way in double precision.
AMBIGUOUS = 16
# Relative step of Newton's method after which the next one would be below NARROW.
CLOSE = arb(2) ** -80
NARROW = arb(2) ** -140
# Time in which a free block at the unstable balance to rounding falls to either side.
FREE = arb(45)


class Arc(NamedTuple):
    """Samples and step of the base; side, place (sample and time after it), u and u' at the start; braces or infinity."""

    values: np.ndarray
    step: float
    side: int
    index: int
    offset: float
    angle: float
    velocity: float
    brace: float = math.inf


class Event(NamedTuple):
    """Zero of the distance to the base or to a brace, or a dip that rounding hides: kind, time after the start."""

    kind: str
    time: arb
    definite: bool


class Piece(NamedTuple):
    """u, u', u'' - u and its rate at the start of a segment, the time since the start of the arc, and the length."""

    u: arb
    v: arb
    force: arb
    rate: arb
    begun: arb
    length: arb

    def at(self, x):
        """Return u, u', u'' and u''' a time x after the start of the segment."""
        sinh, cosh = x.sinh_cosh()
        second = self.u + self.force
        u = self.u + self.v * sinh + second * (cosh - 1) + self.rate * (sinh - x)
        v = self.v + second * sinh + (self.v + self.rate) * (cosh - 1)
        return u, v, u + self.force + self.rate * x, v + self.rate


def sign(ball):
    """Return the sign of a ball, which must be certain."""
    if ball > 0:
        return 1
    if ball < 0:
        return -1
    if ball == 0:
        return 0
    raise ArithmeticError(f"{ball.str(10)} has no certain sign")


def pieces(arc):
    """Yield the segments of an arc, the last one free."""
    step, side = arb(arc.step), arc.side
    u, v, offset, begun = arb(arc.angle), arb(arc.velocity), arb(arc.offset), arb(0)
    sinh, cosh = step.sinh_cosh()
    for index in range(arc.index, len(arc.values) - 1):
        first, second = arb(float(arc.values[index])), arb(float(arc.values[index + 1]))
        rate = (first - second) * side / step
        force = -1 - side * first + rate * offset
        piece = Piece(u, v, force, rate, begun, step - offset)
        yield piece
        if offset == 0:
            bent = u + force
            u, v = (
                u + v * sinh + bent * (cosh - 1) + rate * (sinh - step),
                v + bent * sinh + (v + rate) * (cosh - 1),
            )
        else:
            u, v, _, _ = piece.at(piece.length)
        begun, offset = begun + piece.length, arb(0)
    yield Piece(u, v, arb(-1), arb(0), begun, FREE)


def sign_change(piece, order, left, right):
    """Return an enclosure of the zero of a monotone derivative between two times, as a list; empty if there is none."""
    before, after = (piece.at(x)[order] for x in (left, right))
    if sign(before) * sign(after) >= 0:
        return []
    low, high, x = left.mid(), right.mid(), ((left + right) / 2).mid()
    for _ in range(600):
        if not low < x < high:
            x = ((low + high) / 2).mid()
        found = piece.at(x)
        if found[order].mid() * before > 0:
            low = x
        else:
            high = x
        ahead = (x - found[order] / found[order + 1]).mid()
        if abs(ahead - x) <= CLOSE * abs(ahead):
            wide = 4 * NARROW * abs(ahead)
            ends = [sign(piece.at(ahead + off)[order]) for off in (-wide, wide)]
            assert ends == [sign(before), sign(after)]
            return [arb(ahead, wide)]
        x = ahead
    raise ArithmeticError("no zero found")


def monotone_parts(piece):
    """Return the times that divide a segment into parts on which u is monotone, and u, u', u'' at its end."""
    end = piece.at(piece.length)
    ends = [piece.u + piece.force, end[2]], [piece.v, end[1]]
    if all(sign(left) * sign(right) > 0 for left, right in ends):
        return [arb(0), piece.length], end
    bends = [arb(0), *sign_change(piece, 2, arb(0), piece.length), piece.length]
    turns = [turn for left, right in pairwise(bends) for turn in sign_change(piece, 1, left, right)]
    return [arb(0), *turns, piece.length], end


def size(arc, time):
    """Return the sum of the magnitudes of the terms of u: of the closed form in the first intervals, else of u + u' and u - u'."""
    largest, time = 1 + float(np.abs(arc.values).max()), float(time)
    half = math.sinh(time / 2)
    if time < 2 * arc.step:
        return arc.angle * math.cosh(time) + abs(arc.velocity) * math.sinh(time) + largest * 2 * half * half
    return (arc.angle + abs(arc.velocity)) * math.exp(time) + largest * math.expm1(time)


class Fall:
    """Fall of w = sign (u - level) that has not ended: the zero in it, if w is below zero."""

    def __init__(self, kind, sign, level):
        self.kind, self.sign, self.level, self.zero = kind, sign, level, None

    def height(self, u):
        return self.sign * (u - self.level)


def first_events(arc):
    """Return the possible first events of an arc: dips that rounding hides, then the first definite event or "none"."""
    falls = [Fall("base", 1, arb(0))]
    if arc.brace < math.inf:
        falls.append(Fall("brace", -1, arb(arc.brace)))
    events = []
    for piece in pieces(arc):
        times, end = monotone_parts(piece)
        u = piece.u
        for left, right in pairwise(times):
            last = right is times[-1]
            after = end[0] if last else piece.at(right)[0]
            for fall in falls:
                if not fall.height(after) < fall.height(u):
                    continue
                height, time = fall.height(after), piece.begun + right
                hidden = AMBIGUOUS * ROUNDING * size(arc, time)
                if height < 0 and fall.zero is None:
                    fall.zero = piece.begun + zero_between(piece, fall, left, right)
                if height < -hidden:
                    return [*events, Event(fall.kind, fall.zero, True)]
                if not last:
                    if height < hidden:
                        events.append(Event(fall.kind, time, False))
                    fall.zero = None
            u = after
    return [*events, Event("none", arb.pos_inf(), True)]


def lowest_dip(arc, until):
    """Return the least u of all minima before a time, and its time; infinity if there is none."""
    least, when = arb.pos_inf(), arb(0)
    for piece in pieces(arc):
        for turn in monotone_parts(piece)[0][1:-1]:
            u, _, second, _ = piece.at(turn)
            if piece.begun + turn < until and second > 0 and u < least:
                least, when = u, piece.begun + turn
    return least, when


def zero_between(piece, fall, left, right):
    """Return the zero of the height of a fall in a part, by bisection and Newton's method."""
    low, high, x = left.mid(), right.mid(), ((left + right) / 2).mid()
    for _ in range(600):
        u, v, _, _ = piece.at(x)
        height = fall.height(u)
        low, high = (x, high) if height > 0 else (low, x)
        ahead = (x - height / (fall.sign * v)).mid()
        if not low < ahead < high:
            ahead = ((low + high) / 2).mid()
        if abs(ahead - x) <= CLOSE * abs(ahead):
            return ahead
        x = ahead
    raise ArithmeticError("no zero found")


def state_at(arc, index, offset):
    """Return u, u' and the time since the start at a place of an arc."""
    for place, piece in enumerate(pieces(arc), arc.index):
        if place == index:
            x = arb(offset) - (arb(arc.offset) if index == arc.index else 0)
            u, v, _, _ = piece.at(x)
            return u, v, piece.begun + x
    raise IndexError(index)


def _log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _base(rng, samples):
    """Samples of either sign, smooth or not, up to 8 times the level of lift-off."""
    values = rng.normal(size=samples)
    if rng.random() < 0.5:
        values = np.convolve(values, np.ones(5) / 2, "same")
    return values * _log_uniform(rng, 1.0, 8.0) / np.abs(values).max(), _log_uniform(rng, 0.005, 0.5)


def _start(rng):
    """Return sample and time after it, in units of the step: often just before or after a sample."""
    near = float(
        rng.choice([0.0, 10.0 ** rng.uniform(-14, -2), 1.0 - 10.0 ** rng.uniform(-14, -2), rng.random()])
    )
    return int(rng.integers(0, 3)), near


def generic(rng):
    """Starts from the base or above it, with or without braces."""
    values, step = _base(rng, int(rng.integers(4, 40)))
    index, near = _start(rng)
    angle, velocity = 0.0, _log_uniform(rng, 1e-12, 3.0)
    if rng.random() < 0.5:
        angle, velocity = _log_uniform(rng, 1e-9, 1.5), float(rng.normal())
    brace = _log_uniform(rng, 0.01, 2.0) if rng.random() < 0.3 else math.inf
    if angle >= brace:
        angle, velocity = brace, -abs(velocity)
    return Arc(values, step, int(rng.choice([-1, 1])), index, near * step, angle, velocity, brace)


def touching(rng, samples=(4, 12)):
    """Arcs computed back from a dip that nearly touches the base: often near a sample, the end of a window or the start.

    The dip is 1e-3 to 1e-17 above or below the base.
    """
    while True:
        values, step = _base(rng, int(rng.integers(*samples)))
        side = int(rng.choice([-1, 1]))
        outward = np.flatnonzero(-1 - side * values > 0)
        outward = outward[(outward > 0) & (outward < len(values) - 1)]
        if not len(outward):
            continue
        end = int(rng.choice(outward))
        depth = float(rng.choice([-1, 1])) * _log_uniform(rng, 1e-17, 1e-3)
        off = float(rng.choice([0.0, 1.0, -1.0])) * step * 10.0 ** rng.uniform(-14, -0.5)
        first = int(rng.integers(max(0, end - 3), end)) if samples[1] < 20 else 0
        arc = _back(values, step, side, (end, off), first, depth)
        if arc is not None:
            return arc


def _back(values, step, side, place, first, depth):
    """Return the arc that starts above the base at a sample and dips to a depth at a place; None if it starts elsewhere."""
    index, off = place
    if off < 0:
        index, off = index - 1, step + off
    # Backwards in time the equation is the same, with the samples in reverse order.
    start, end = float(values[index]), float(values[index + 1])
    rate = (end - start) / step
    u, v = depth, 0.0
    force = -1 - side * (start + rate * off)
    for k in range(index, first - 1, -1):
        x, back = (off if k == index else step), side * (values[k + 1] - values[k]) / step
        if k != index:
            force = -1 - side * values[k + 1]
        sinh, versinh = math.sinh(x), math.cosh(x) - 1
        u, v = (
            u + v * sinh + (u + force) * versinh + back * (sinh - x),
            v + (u + force) * sinh + (v + back) * versinh,
        )
        if u <= 0:
            return None
    if abs(v) > 20:
        return None
    return Arc(values, step, side, first, 0.0, float(u), float(-v))


def long(rng):
    """Touching arcs over several windows of the search, with short steps."""
    return touching(rng, (20, 70))


def coarse(rng):
    """Fast starts under few samples with long steps, which are decided interval by interval."""
    values, _ = _base(rng, int(rng.integers(3, 9)))
    step = rng.uniform(0.4, 3.0)
    index, near = _start(rng)
    angle, velocity = _log_uniform(rng, 1e-3, 1.5), float(3.0 * rng.normal())
    return Arc(
        values, step, int(rng.choice([-1, 1])), min(index, len(values) - 2), near * step, angle, velocity
    )


def grazing_start(rng):
    """Slow starts from the base, just before the forcing term turns outward: the block returns or just does not."""
    while True:
        values, step = _base(rng, 6)
        side, index = int(rng.choice([-1, 1])), int(rng.integers(0, 4))
        start, end = (-1 - side * float(value) for value in values[index : index + 2])
        if not start < 0 < end:
            continue
        rate = (end - start) / step
        lead = step * 10.0 ** rng.uniform(-9, -0.5)
        offset = -start / rate - lead
        if not 0 <= offset < step:
            continue
        pull = -(start + rate * offset)
        velocity = 0.375 * pull * pull / rate
        off = float(rng.choice([-1, 1])) * _log_uniform(rng, 1e-16, 1e-3)
        if velocity > 1e-25:
            return Arc(values, step, side, index, offset, 0.0, float(velocity * (1 + off)))


def grazing_brace(rng):
    """Braces at the height of the first maximum of an arc, 1e-3 to 1e-17 above or below it."""
    while True:
        arc = generic(rng)._replace(brace=math.inf)
        for piece in pieces(arc):
            times, _ = monotone_parts(piece)
            tops = [piece.at(time)[0] for time in times[1:-1] if piece.at(time)[2] < 0]
            if tops and tops[0] > arc.angle and tops[0] > 1e-6:
                off = float(rng.choice([-1, 1])) * _log_uniform(rng, 1e-17, 1e-3)
                return arc._replace(brace=max(float(tops[0] * (1 + arb(off))), arc.angle * (1 + 1e-12)))
            if piece.at(piece.length)[0] < 0:
                break


FAMILIES = {
    family.__name__: family for family in (generic, touching, long, grazing_start, grazing_brace, coarse)
}


def arcs(family, count, seed):
    """Arcs of a family by name; the same seed gives the same arcs."""
    rng = np.random.default_rng([seed, *family.encode()])
    return [FAMILIES[family](rng) for _ in range(count)]
