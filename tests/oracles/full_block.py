"""Motion of the full block by Gauss-Legendre collocation in mpmath.

Nothing is taken from the package, and no Taylor series is used. A step of 12 stages has order 24. An impact is found by
solving for the length of the step at whose end u = 0.
"""

from functools import cache
from itertools import pairwise

import mpmath as mp
import numpy as np

DIGITS = 40
STAGES = 12
# Steps are so short that a block rarely meets the base twice within one.
LONGEST = mp.mpf(1) / 32
# Speed below which a block is taken to rest, if the base does not lift it.
STILL = mp.mpf(10) ** -16


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


@cache
def scheme():
    """Return the nodes and, for each node and the end, the weights of u'' in u' and in u."""
    near = np.polynomial.legendre.leggauss(STAGES)[0]
    roots = [mp.findroot(lambda x: mp.legendre(STAGES, x), mp.mpf(float(x))) for x in near]
    nodes = [(1 + root) / 2 for root in roots]
    powers = mp.matrix(STAGES, STAGES)
    for i, node in enumerate(nodes):
        for k in range(STAGES):
            powers[k, i] = node**k
    inverse = powers**-1
    rows = []
    for place in [*nodes, mp.mpf(1)]:
        once = [place ** (k + 1) / (k + 1) for k in range(STAGES)]
        twice = [place ** (k + 2) / ((k + 1) * (k + 2)) for k in range(STAGES)]
        rows.append(
            tuple(
                [mp.fsum(inverse[i, k] * moments[k] for k in range(STAGES)) for i in range(STAGES)]
                for moments in (once, twice)
            )
        )
    return nodes, rows


class Block:
    """Block with a critical angle, a base acceleration, a law of restitution and braces.

    ``restitution`` is a number, or rows (speed, coefficient) with linear interpolation.
    """

    def __init__(self, base, restitution, angle, brace=mp.inf, brace_restitution=1):
        rows = restitution if isinstance(restitution, list) else [(0, restitution)]
        self.law = [tuple(map(mp.mpf, row)) for row in rows]
        self.base, self.alpha = base, mp.mpf(angle)
        self.brace, self.r = mp.mpf(brace), mp.mpf(brace_restitution)
        self.level = mp.tan(self.alpha) / self.alpha

    def kept(self, speed):
        """Return the coefficient of restitution at a speed before an impact."""
        for (first, one), (second, other) in pairwise(self.law):
            if speed <= second:
                return one + (other - one) * max(speed - first, 0) / (second - first)
        return self.law[-1][1]

    def force(self, side, u, acceleration):
        w = self.alpha * (1 - u)
        return -mp.sin(w) / self.alpha - side * acceleration * mp.cos(w)

    def step(self, side, time, u, v, h):
        """Return u and u' at the end of a step, and the least and largest u at its nodes."""
        nodes, rows = scheme()
        pushes = [self.base.at(time + h * node) for node in nodes]
        bends, small = [self.force(side, u, push) for push in pushes], mp.mpf(10) ** (4 - DIGITS)
        for _ in range(200):
            places = [
                u + h * v * x + h * h * mp.fdot(row[1], bends)
                for x, row in zip(nodes, rows[:-1], strict=True)
            ]
            fresh = [self.force(side, place, push) for place, push in zip(places, pushes, strict=True)]
            change = max(abs(a - b) for a, b in zip(fresh, bends, strict=True))
            bends = fresh
            if change < small:
                break
        once, twice = rows[-1]
        return (
            u + h * v + h * h * mp.fdot(twice, bends),
            v + h * mp.fdot(once, bends),
            (min(places), max(places)),
        )

    def contact(self, side, time, u, v, low, high, level):
        """Return the length of the step at whose end u reaches 0, or a brace at ``level``, and u' there."""
        h, out = high, -1 if level == 0 else 1
        for _ in range(100):
            angle, speed, ends = self.step(side, time, u, v, h)
            if out * (angle - level) > 0 or out * (ends[out == 1] - level) > 0:
                high = h
            else:
                low = h
            ahead = h - (angle - level) / speed if out * speed > 0 else low
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
            if abs(self.base.at(later)) > self.level >= abs(self.base.at(now)):
                return mp.findroot(
                    lambda x: abs(self.base.at(x)) - self.level, (now, later), solver="anderson", tol=1e-60
                )
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

    def followed(self, end, angle=0.0, velocity=0.0):
        """Return Theta, Theta', the number of impacts and that of brace impacts at a time, from an initial state."""
        end, time, impacts, hits = mp.mpf(end), mp.mpf(0), 0, 0
        theta, rate = mp.mpf(angle), mp.mpf(velocity)
        side = 1 if theta > 0 or (theta == 0 and rate > 0) else -1
        u, v, resting, leaning = abs(theta), side * rate, theta == 0 and rate == 0, False
        if resting and abs(self.base.at(time)) > self.level:
            side, resting = (-1 if self.base.at(time) > 0 else 1), False
        while time < end:
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
            after, speed, (least, largest) = self.step(side, time, u, v, h)
            falls = after < 0 or (least < 0 and u != 0)
            strikes = after > self.brace or (largest > self.brace and u != self.brace)
            if not falls and not strikes:
                time, u, v = time + h, after, speed
                continue
            level = self.brace if strikes else mp.mpf(0)
            low = mp.mpf(0) if u != level else h * mp.mpf(10) ** -25
            h, speed = self.contact(side, time, u, v, low, h, level)
            time, u = time + h, level
            if strikes:
                v, hits = -self.r * speed, hits + 1
                if -v < STILL and self.force(side, level, self.base.at(time)) >= 0:
                    v, leaning = mp.mpf(0), True
                continue
            v, side, impacts = -self.kept(-speed) * speed, -side, impacts + 1
            if v < STILL and abs(self.base.at(time)) <= self.level:
                v, resting = mp.mpf(0), True
        return side * u, side * v, impacts, hits
