"""Motion of a block under samples by Taylor series in balls of python-flint, with 50 digits: full or slender, free or against a wall.

Nothing is taken from the package. The first zero of a step is that of its polynomial in doubles, refined with all digits.
"""

import math

import flint
import numpy as np

DIGITS = 50
ORDER = 30
# Longest step: the last term is then below 1e-30.
LONGEST = 0.1
# Speed after an impact below which the block rests, if the base does not lift it.
STILL = 1e-20


class Undecided(Exception):
    """The balls do not decide, or the motion is too long."""


def middle(x):
    """Return a ball without its radius."""
    return flint.arb(x.mid())


def series(alpha, side, u, v, push, rate):
    """Return the Taylor coefficients of u from an instant on, where the base acceleration is push + rate t in units of g alpha."""
    w = alpha * (1 - u)
    size = side * alpha
    now, change = size * push, size * rate
    waves = [w, -alpha * v]
    sines, cosines = [w.sin()], [w.cos()]
    slopes = [flint.arb(0), waves[1]]  # j w_j
    for k in range(ORDER - 1):
        if k:
            sines.append(sum((slopes[j] * cosines[k - j] for j in range(1, k + 1)), flint.arb(0)) / k)
            cosines.append(-sum((slopes[j] * sines[k - j] for j in range(1, k + 1)), flint.arb(0)) / k)
        later = sines[k] + now * cosines[k] + (change * cosines[k - 1] if k else 0)
        waves.append(later / ((k + 1) * (k + 2)))
        slopes.append(waves[-1] * (k + 2))
    return [u, v, *(-wave / alpha for wave in waves[2:])]


def slender_series(side, u, v, push, rate):
    """Return the same for the slender block, u'' = u - 1 - side a."""
    c = [u, v, (u - 1 - side * push) / 2, (v - side * rate) / 6]
    for k in range(4, ORDER + 1):
        c.append(c[k - 2] / (k * (k - 1)))
    return c


def value(c, t):
    """Return the polynomial and its derivative."""
    total, slope = flint.arb(0), flint.arb(0)
    for a in reversed(c):
        slope = slope * t + total
        total = total * t + a
    return total, slope


def first_zero(c, h):
    """Return the first time in (0, h] at which u falls through zero, or None."""
    low = [float(a.mid()) for a in c[:16]]
    while low and low[0] == 0.0:
        low = low[1:]
    scaled = np.array(low) * h ** np.arange(len(low))
    roots = np.roots(scaled[::-1])
    real = sorted(root.real for root in roots if abs(root.imag) < 1e-12 and 0 < root.real <= 1 + 1e-12)
    for guess in real:
        t = flint.arb(guess * h)
        for _ in range(7):
            u, v = value(c, t)
            t = middle(t - u / v)
        if 0 < float(t.mid()) <= h and value(c, t)[1] < 0:
            return t
    return None


class Block:
    """Block with an angle and a coefficient of restitution, under samples times a scale at a step, all doubles.

    The angle of a slender block is 0. Against a wall the block lifts to side 1 only, and an impact turns u' to -e u' on that side.
    """

    def __init__(self, values, step, scale, restitution, angle, wall=False):
        with flint.ctx.workdps(DIGITS):
            self.values = [flint.arb(float(one)) * flint.arb(float(scale)) for one in values]
            self.step, self.e = flint.arb(float(step)), flint.arb(float(restitution))
            self.alpha = flint.arb(float(angle))
            self.level = self.alpha.tan() / self.alpha if angle else flint.arb(1)
            self.slender, self.wall = angle == 0, wall

    def lift_off(self, index, offset):
        """Return interval, time in it and side of the next lift-off; None if there is none."""
        values, last = self.values, len(self.values) - 1
        for k in range(index, last):
            rate = (values[k + 1] - values[k]) / self.step
            start = values[k] + rate * offset if k == index else values[k]
            begun = offset if k == index else flint.arb(0)
            if self.reaches(start) > self.level:
                return k, begun, -1 if start > 0 else 1
            if self.reaches(values[k + 1]) > self.level:
                sign = 1 if values[k + 1] > 0 else -1
                return k, middle((sign * self.level - values[k]) / rate), -sign
            if not self.reaches(values[k + 1]) <= self.level:
                raise Undecided
        return None

    def reaches(self, push):
        """Return what must exceed the level for a lift-off: |a|, or -a against a wall."""
        return -push if self.wall else abs(push)

    def overturns(self, limit=60_000):
        """Return whether the block, at rest at first, overturns."""
        with flint.ctx.workdps(DIGITS):
            return self._overturns(limit)

    def _overturns(self, limit):
        last, alpha, e = len(self.values) - 1, self.alpha, self.e
        found = self.lift_off(0, flint.arb(0))
        if found is None:
            return False
        k, t, side = found
        u, v = flint.arb(0), flint.arb(0)
        for _ in range(limit):
            if k >= last:
                return self.falls_freely(u, v)
            rate = (self.values[k + 1] - self.values[k]) / self.step
            h = min(float((self.step - t).mid()), LONGEST)
            at_end = h >= float((self.step - t).mid())
            push = self.values[k] + rate * t
            c = (
                slender_series(side, u, v, push, rate)
                if self.slender
                else series(alpha, side, u, v, push, rate)
            )
            zero = first_zero(c, h)
            if zero is None:
                stride = self.step - t if at_end else flint.arb(h)
                u, v = map(middle, value(c, stride))
                k, t = (k + 1, flint.arb(0)) if at_end else (k, middle(t + stride))
                if alpha * u > 1.6 or (self.slender and u > 1e6):
                    return True
                continue
            speed = -e * value(c, zero)[1]
            t, u, v = middle(t + zero), flint.arb(0), middle(speed)
            side = side if self.wall else -side
            if float(v.mid()) < STILL:
                found = self.lift_off(k, t)
                if found is None:
                    return False
                k, t, side = found
                v = flint.arb(0)
        raise Undecided

    def falls_freely(self, u, v):
        """Return whether the block overturns after the base motion: by its energy, on this side or after the next impact."""
        alpha = self.alpha
        if self.slender:
            return bool(u - 1 + v > 0) or bool(self.e**2 * (1 + v**2 - (1 - u) ** 2) > 1)
        energy = alpha**2 * v**2 / 2 + (alpha * (1 - u)).cos()
        if (u <= 1 and v > 0 and energy > 1) or (u > 1 and (v >= 0 or energy < 1)):
            return True
        low = alpha.cos()
        return bool(low + self.e**2 * (energy - low) > 1)


def doubles(x):
    """Return a ball as a double."""
    return math.nan if x is None else float(x.mid())
