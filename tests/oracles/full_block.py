"""Motion of the full block by Gauss-Legendre collocation in mpmath.

Nothing is taken from the package, and no Taylor series is used. A step of 12 stages has order 24. An impact is found by
solving for the length of the step at whose end u = 0.
"""

from functools import cache

import mpmath as mp
import numpy as np

DIGITS = 34
STAGES = 12
LONGEST = mp.mpf(1) / 8
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
    """Block with a critical angle, a base acceleration and a coefficient of restitution."""

    def __init__(self, base, restitution, angle):
        self.base, self.e, self.alpha = base, mp.mpf(restitution), mp.mpf(angle)
        self.level = mp.tan(self.alpha) / self.alpha

    def force(self, side, u, acceleration):
        w = self.alpha * (1 - u)
        return -mp.sin(w) / self.alpha - side * acceleration * mp.cos(w)

    def step(self, side, time, u, v, h):
        """Return u and u' at the end of a step, and the least u at its nodes."""
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
        return u + h * v + h * h * mp.fdot(twice, bends), v + h * mp.fdot(once, bends), min(places)

    def impact(self, side, time, u, v, low, high):
        """Return the length of the step at whose end u falls through 0, and u' there."""
        h = high
        for _ in range(100):
            angle, speed, least = self.step(side, time, u, v, h)
            if angle < 0 or least < 0:
                high = h
            else:
                low = h
            ahead = h - angle / speed if speed < 0 else low
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
            later = min(now + LONGEST / 4, self.base.corner_after(now), end)
            if abs(self.base.at(later)) > self.level >= abs(self.base.at(now)):
                return mp.findroot(
                    lambda x: abs(self.base.at(x)) - self.level, (now, later), solver="anderson", tol=1e-60
                )
            now = later
        return end

    def final(self, end, angle=0.0, velocity=0.0):
        """Return Theta, Theta' and the number of impacts at a time, from an initial state."""
        end, time, impacts = mp.mpf(end), mp.mpf(0), 0
        theta, rate = mp.mpf(angle), mp.mpf(velocity)
        side = 1 if theta > 0 or (theta == 0 and rate > 0) else -1
        u, v, resting = abs(theta), side * rate, theta == 0 and rate == 0
        if resting and abs(self.base.at(time)) > self.level:
            side, resting = (-1 if self.base.at(time) > 0 else 1), False
        while time < end:
            if resting:
                time = self.lift_off(time, end)
                if time >= end:
                    return mp.mpf(0), mp.mpf(0), impacts
                side, resting = (-1 if self.base.at(time + LONGEST / 10**9) > 0 else 1), False
            h = min(LONGEST, self.base.corner_after(time) - time, end - time)
            after, speed, least = self.step(side, time, u, v, h)
            if after >= 0 and (least >= 0 or u == 0):
                time, u, v = time + h, after, speed
                continue
            low = mp.mpf(0) if u > 0 else h * mp.mpf(10) ** -25
            h, speed = self.impact(side, time, u, v, low, h)
            time, u, v, side, impacts = time + h, mp.mpf(0), -self.e * speed, -side, impacts + 1
            if v < STILL and abs(self.base.at(time)) <= self.level:
                u, v, resting = mp.mpf(0), mp.mpf(0), True
        return side * u, side * v, impacts
