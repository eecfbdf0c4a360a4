"""Motion of the full block by Gauss-Legendre collocation in mpmath.

Nothing is taken from the package, and no Taylor series is used. A step of 12 stages has order 24. An impact is found by
solving for the length of the step at whose end u = 0. The stages of a step are solved in numbers of python-flint, which takes a
tenth of the time.
"""

from functools import cache
from itertools import pairwise

import flint
import mpmath as mp

DIGITS = 40
STAGES = 12
# Steps are so short that a block rarely meets the base twice within one.
LONGEST = mp.mpf(1) / 32
# Speed below which a block is taken to rest, if the base does not lift it.
STILL = mp.mpf(10) ** -16
# Between two nodes no angle is less than at both of them by more than this.
SHALLOW = mp.mpf(10) ** -3
# Angle in rad beyond which a block is taken to have fallen.
FALLEN = mp.mpf("1.6")


class Cosine:
    """Harmonic base acceleration; it has no corners."""

    def __init__(self, amplitude, period, phase):
        self.amplitude, self.phase = mp.mpf(amplitude), mp.mpf(phase)
        self.frequency = 2 * mp.pi / mp.mpf(period)

    def at(self, time):
        return self.amplitude * mp.cos(self.frequency * time + self.phase)

    def corner_after(self, time):
        return mp.inf


class Pulse:
    """Cosine up to a time, and 0 afterwards. Its value at the end is that of the cosine, so that a lift-off just before is seen."""

    def __init__(self, amplitude, frequency, phase, duration):
        self.amplitude, self.frequency = mp.mpf(amplitude), mp.mpf(frequency)
        self.phase, self.duration = mp.mpf(phase), mp.mpf(duration)

    def at(self, time):
        if time > self.duration:
            return mp.mpf(0)
        return self.amplitude * mp.cos(self.frequency * time + self.phase)

    def corner_after(self, time):
        return self.duration if time < self.duration * (1 - mp.mpf(10) ** -30) else mp.inf


class Samples:
    """Base acceleration that is linear between samples, and 0 after the last."""

    def __init__(self, values, step):
        self.values, self.step = [mp.mpf(float(value)) for value in values], mp.mpf(float(step))

    def at(self, time):
        index = int(mp.floor(time / self.step))
        if index >= len(self.values) - 1:
            return mp.mpf(0)
        first, second = self.values[index : index + 2]
        return first + (second - first) * (time / self.step - index)

    def corner_after(self, time):
        index = int(mp.floor(time / self.step * (1 + mp.mpf(10) ** -30)))
        return (index + 1) * self.step if index < len(self.values) - 1 else mp.inf


def ball(x):
    """Return a number of mpmath as one of python-flint."""
    sign, size, exponent, _ = mp.mpf(x)._mpf_
    return flint.arb(((-1) ** sign * int(size), exponent))


def number(x):
    """Return a number of python-flint as one of mpmath, without its radius."""
    return mp.ldexp(*map(int, x.mid().man_exp()))


@cache
def scheme():
    """Return the nodes and, for each node and the end, the weights of u'' in u' at the end and in u, as matrices."""
    nodes = [(1 + number(flint.arb.legendre_p_root(STAGES, k))) / 2 for k in reversed(range(STAGES))]
    powers = mp.matrix(STAGES, STAGES)
    for i, node in enumerate(nodes):
        for k in range(STAGES):
            powers[k, i] = node**k
    inverse = powers**-1

    def weights(moments):
        return [ball(mp.fsum(inverse[i, k] * moments[k] for k in range(STAGES))) for i in range(STAGES)]

    twice = [
        weights([place ** (k + 2) / ((k + 1) * (k + 2)) for k in range(STAGES)])
        for place in [*nodes, mp.mpf(1)]
    ]
    once = weights([1 / mp.mpf(k + 1) for k in range(STAGES)])
    return nodes, flint.arb_mat([once]), flint.arb_mat(twice)


class Block:
    """Block with a critical angle, a base acceleration, a law of restitution and braces.

    ``restitution`` is a number, or rows (speed, coefficient) with linear interpolation. ``left`` has the ratios of critical angle
    and frequency parameter on the left side, and perhaps the restitution of impacts that end an arc there. ``scatter`` returns what is
    added to the coefficient, from the numbers of rests, and of impacts since the last one.
    """

    def __init__(
        self, base, restitution, angle, brace=mp.inf, brace_restitution=1, left=(1, 1), scatter=None
    ):
        self.left, self.scatter = tuple(map(mp.mpf, left[:2])), scatter
        rows = restitution if isinstance(restitution, list) else [(0, restitution)]
        self.law = [tuple(map(mp.mpf, row)) for row in rows]
        self.left_law = [(mp.mpf(0), mp.mpf(left[2]))] if len(left) > 2 else self.law
        self.base, self.alpha = base, mp.mpf(angle)
        self.brace, self.r = mp.mpf(brace), mp.mpf(brace_restitution)
        self.level = mp.tan(self.alpha) / self.alpha
        self.left_level = mp.tan(self.alpha * self.left[0]) / self.alpha

    def kept(self, side, speed, rests=0, impacts=0):
        """Return the coefficient of restitution of an impact that ends an arc on a side at a speed."""
        e = self.of_law(self.law if side > 0 else self.left_law, speed)
        return e if self.scatter is None else min(max(e + self.scatter(rests, impacts), 0), 1)

    def of_law(self, law, speed):
        """Return the coefficient of restitution at a speed before an impact, without scatter."""
        for (first, one), (second, other) in pairwise(law):
            if speed <= second:
                return one + (other - one) * max(speed - first, 0) / (second - first)
        return law[-1][1]

    def lift(self, time):
        """Return by how much the base acceleration exceeds that of a lift-off to either side; negative if the block stays."""
        push = self.base.at(time)
        return max(-push - self.level, push - self.left_level)

    def side(self, side):
        """Return the ratios of critical angle and frequency parameter of a side."""
        return (mp.mpf(1), mp.mpf(1)) if side > 0 else self.left

    def force(self, side, u, acceleration):
        ratio, rate = self.side(side)
        w = self.alpha * (ratio - u)
        return -(rate**2) * (mp.sin(w) / self.alpha + side * acceleration * mp.cos(w))

    def step(self, side, time, u, v, h):
        """Return u and u' at the end of a step, and u at its nodes."""
        with flint.ctx.workdps(DIGITS):
            return self._step(side, time, u, v, h)

    def _step(self, side, time, u, v, h):
        nodes, once, twice = scheme()
        ratio, rate = self.side(side)
        alpha, lean, stiffness = ball(self.alpha), ball(self.alpha * ratio), ball(rate**2)
        pushes = [ball(side * self.base.at(time + h * node)) for node in nodes]
        straight = [ball(u + h * v * node) for node in [*nodes, 1]]
        square, small = ball(h * h), 10.0 ** (4 - DIGITS)
        places = [ball(u)] * STAGES
        bends = [flint.arb(0)] * STAGES
        for _ in range(200):
            before = bends
            waves = [(lean - alpha * place).sin_cos() for place in places]
            bends = [
                (-stiffness * (sine / alpha + push * cosine)).mid()
                for (sine, cosine), push in zip(waves, pushes, strict=True)
            ]
            column = flint.arb_mat([[bend] for bend in bends])
            risen = (twice * column).entries()
            places = [(line + square * rise).mid() for line, rise in zip(straight, risen, strict=True)]
            end = places.pop()
            if max(abs(float(a - b)) for a, b in zip(bends, before, strict=True)) < small:
                break
        speed = v + h * number((once * column)[0, 0])
        return number(end), speed, [number(place) for place in places]

    def dip(self, side, time, u, v, h, found):
        """Return the length of the step to a minimum of u below 0 within a step that is ``found``; None if there is none."""
        end, speed, inner = found
        places, times = [u, *inner, end], [h * node for node in (0, *scheme()[0], 1)]
        for k, place in enumerate(places):
            falls = v < 0 if k == 0 else places[k - 1] >= place
            rises = speed > 0 if k == len(inner) + 1 else places[k + 1] >= place
            if not (falls and rises and place < SHALLOW):
                continue
            low, high, x = times[max(k - 1, 0)], times[min(k + 1, len(inner) + 1)], times[k]
            for _ in range(100):
                angle, rate, _ = self.step(side, time, u, v, x)
                low, high = (x, high) if rate < 0 else (low, x)
                ahead = x - rate / self.force(side, angle, self.base.at(time + x))
                if not low < ahead < high:
                    ahead = (low + high) / 2
                if abs(ahead - x) < mp.mpf(10) ** -18 * h:
                    break
                x = ahead
            if angle < 0:
                return x
        return None

    def contact(self, side, time, u, v, low, high, level):
        """Return the length of the step at whose end u reaches 0, or a brace at ``level``, and u' there.

        By Newton's method for the distance d from the level, or for d/h if the arc starts there, which finds short arcs at once.
        """
        h, out = high, -1 if level == 0 else 1
        for _ in range(100):
            angle, speed, places = self.step(side, time, u, v, h)
            if max(out * (place - level) for place in (angle, *places)) > 0:
                high = h
            else:
                low = h
            distance = angle - level
            slope = speed - distance / h if u == level else speed
            ahead = h - distance / slope if out * slope > 0 else low
            if not low < ahead < high:
                ahead = (low + high) / 2
            if abs(ahead - h) < mp.mpf(10) ** (8 - DIGITS) * high:
                break
            h = ahead
        return h, self.step(side, time, u, v, h)[1]

    def lift_off(self, time, end):
        """Return the next time at which the base lifts a resting block; ``end`` if none comes before."""
        now = time
        while now < end:
            later = min(now + LONGEST, self.base.corner_after(now), end)
            if self.lift(later) > 0 >= self.lift(now):
                return mp.findroot(self.lift, (now, later), solver="anderson", tol=1e-60)
            now = later
        return end

    def departure(self, side, time, end):
        """Return the next time at which a block leaves its brace; ``end`` if none comes before."""
        now = time
        while now < end:
            later = min(now + LONGEST, self.base.corner_after(now), end)
            if self.force(side, self.brace, self.base.at(later)) < 0:
                pressed = lambda x: self.force(side, self.brace, self.base.at(x))  # noqa: E731
                return mp.findroot(pressed, (now, later), solver="anderson", tol=1e-60)
            now = later
        return end

    def final(self, end, angle=0.0, velocity=0.0):
        """Return Theta, Theta' and the number of impacts at a time, from an initial state."""
        return self.followed(end, angle, velocity)[:3]

    def overturns(self, end):
        """Return whether a block without braces, at rest at first, overturns; the base is at rest from a time on."""
        theta, rate, _, _ = self.followed(end, fallen=FALLEN)
        side = 1 if theta > 0 or (theta == 0 and rate > 0) else -1
        u, v = abs(theta), side * rate
        if self.alpha * u > FALLEN:
            return True
        # The energy tells whether the block falls on this side, or else how fast it meets the base.
        escape = min(r * mp.sqrt(2 - 2 * mp.cos(self.alpha * s)) for s, r in (self.side(1), self.side(-1)))
        while True:
            ratio, frequency = self.side(side)
            energy = (self.alpha * v / frequency) ** 2 / 2 + mp.cos(self.alpha * (ratio - u))
            if (u <= ratio and v > 0 and energy > 1) or (u > ratio and (v >= 0 or energy < 1)):
                return True
            speed = frequency * mp.sqrt(2 * (energy - mp.cos(self.alpha * ratio))) / self.alpha
            assert self.scatter is None or self.alpha * speed < escape  # else the base must rest longer
            if not self.alpha * speed > escape:
                return False
            u, v, side = mp.mpf(0), self.kept(side, speed) * speed, -side

    def followed(self, end, angle=0.0, velocity=0.0, fallen=mp.inf):
        """Return Theta, Theta', the number of impacts and that of brace impacts at a time, from an initial state.

        If the angle exceeds ``fallen`` rad before, the state is that there.
        """
        end, time, impacts, hits, rests, recent = mp.mpf(end), mp.mpf(0), 0, 0, 0, 0
        theta, rate = mp.mpf(angle), mp.mpf(velocity)
        side = 1 if theta > 0 or (theta == 0 and rate > 0) else -1
        u, v, resting, leaning = abs(theta), side * rate, theta == 0 and rate == 0, False
        if resting and self.lift(time) > 0:
            side, resting = (-1 if self.base.at(time) > 0 else 1), False
        while time < end and self.alpha * u <= fallen:
            if resting:
                time = self.lift_off(time, end)
                if time >= end:
                    return mp.mpf(0), mp.mpf(0), impacts, hits
                side, resting = (-1 if self.base.at(time + LONGEST / 10**9) > 0 else 1), False
            if leaning:
                time, leaning = self.departure(side, time, end), False
                if time >= end:
                    return side * self.brace, mp.mpf(0), impacts, hits
            h = min(LONGEST, self.base.corner_after(time) - time, end - time)
            after, speed, places = self.step(side, time, u, v, h)
            largest = max(places)
            bottom = self.dip(side, time, u, v, h, (after, speed, places))
            falls = after < 0 or bottom is not None
            strikes = after > self.brace or (largest > self.brace and u != self.brace)
            if not falls and not strikes:
                time, u, v = time + h, after, speed
                continue
            level = self.brace if strikes else mp.mpf(0)
            low = mp.mpf(0) if u != level else h * mp.mpf(10) ** -25
            h, speed = self.contact(side, time, u, v, low, bottom or h, level)
            time, u = time + h, level
            if strikes:
                v, hits = -self.r * speed, hits + 1
                if -v < STILL and self.force(side, level, self.base.at(time)) >= 0:
                    v, leaning = mp.mpf(0), True
                continue
            v, side = -self.kept(side, -speed, rests, recent) * speed, -side
            impacts, recent = impacts + 1, recent + 1
            if v < STILL and self.lift(time) <= 0:
                v, resting, rests, recent = mp.mpf(0), True, rests + 1, 0
        return side * u, side * v, impacts, hits
