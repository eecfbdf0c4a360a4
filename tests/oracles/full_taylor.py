"""Motion of a block under samples by Taylor series in balls of python-flint, with 50 digits: full or slender, free or against a wall.

The base may also move vertically, which multiplies the weight of the block. A full block may have a restrainer on its centre line with the
ratios kappa of its stiffness and rho of its force: theta'' = -[sin w + a cos w + kappa sin theta + rho sin(alpha) cos(theta/2)] for
theta > 0. A full block overturns where it reaches a right angle.

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


def series(alpha, side, u, v, push, rate, weight=1, lift=0, kappa=0, rho=0):
    """Return the Taylor coefficients of u from an instant on, where the base acceleration is push + rate t in units of g alpha.

    The weight of the block is weight + lift t, relative to that on a base at rest.
    """
    w = alpha * (1 - u)
    size = side * alpha
    now, change = size * push, size * rate
    waves = [w, -alpha * v]
    sines, cosines = [w.sin()], [w.cos()]
    slopes = [flint.arb(0), waves[1]]  # j w_j
    half = alpha * u / 2
    ups, downs = [half.cos()], [half.sin()]  # cos and sin of theta/2
    for k in range(ORDER - 1):
        if k:
            up = sum((slopes[j] * downs[k - j] for j in range(1, k + 1)), flint.arb(0)) / (2 * k)
            downs.append(-sum((slopes[j] * ups[k - j] for j in range(1, k + 1)), flint.arb(0)) / (2 * k))
            ups.append(up)
            sines.append(sum((slopes[j] * cosines[k - j] for j in range(1, k + 1)), flint.arb(0)) / k)
            cosines.append(-sum((slopes[j] * sines[k - j] for j in range(1, k + 1)), flint.arb(0)) / k)
        later = (weight - kappa * alpha.cos()) * sines[k] + (now + kappa * alpha.sin()) * cosines[k]
        later += rho * alpha.sin() * ups[k]
        later += change * cosines[k - 1] + lift * sines[k - 1] if k else 0
        waves.append(later / ((k + 1) * (k + 2)))
        slopes.append(waves[-1] * (k + 2))
    return [u, v, *(-wave / alpha for wave in waves[2:])]


def slender_series(side, u, v, push, rate, weight=1, lift=0):
    """Return the same for the slender block, u'' = weight (u - 1) - side a."""
    c = [u, v, (weight * (u - 1) - side * push) / 2, (weight * v + lift * (u - 1) - side * rate) / 6]
    for k in range(4, ORDER + 1):
        c.append((weight * c[k - 2] + lift * c[k - 3]) / (k * (k - 1)))
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
    ``vertical`` holds samples of the upward acceleration in units of g, and ``ratios`` kappa and rho of a restrainer.
    """

    def __init__(self, values, step, scale, restitution, angle, wall=False, vertical=None, ratios=(0.0, 0.0)):
        with flint.ctx.workdps(DIGITS):
            lifts = np.zeros(len(values)) if vertical is None else vertical
            self.weights = [1 + flint.arb(float(one)) for one in lifts]
            self.values = [flint.arb(float(one)) * flint.arb(float(scale)) for one in values]
            self.step, self.e = flint.arb(float(step)), flint.arb(float(restitution))
            self.alpha = flint.arb(float(angle))
            self.kappa, self.rho = map(flint.arb, ratios)
            self.restrained = any(ratios)
            self.level = (1 + self.rho) * (self.alpha.tan() / self.alpha) if angle else flint.arb(1)
            self.slender, self.wall = angle == 0, wall

    def lift_off(self, index, offset):
        """Return interval, time in it and side of the next lift-off; None if there is none."""
        sides = (1,) if self.wall else (1, -1)
        for k in range(index, len(self.values) - 1):
            begun = offset if k == index else flint.arb(0)
            for side in sides:
                start, end = self.excess(side, k), self.excess(side, k + 1)
                rate = (end - start) / self.step
                if start + rate * begun > 0:
                    return k, begun, side
                if end > 0:
                    return k, middle(-start / rate), side
                if not end <= 0:
                    raise Undecided
        return None

    def excess(self, side, k):
        """Return by how much the push to a side exceeds the level of lift-off at a sample."""
        return -side * self.values[k] - self.level * self.weights[k]

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
            lift = (self.weights[k + 1] - self.weights[k]) / self.step
            forces = push, rate, self.weights[k] + lift * t, lift
            if self.slender:
                c = slender_series(side, u, v, *forces)
            else:
                c = series(alpha, side, u, v, *forces, self.kappa, self.rho)
            zero = first_zero(c, h)
            if zero is None:
                stride = self.step - t if at_end else flint.arb(h)
                if not self.slender and self.lies_flat(c, stride):
                    return True
                u, v = map(middle, value(c, stride))
                k, t = (k + 1, flint.arb(0)) if at_end else (k, middle(t + stride))
                if self.slender and u > 1e6:
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

    def lies_flat(self, c, h):
        """Return whether the block reaches a right angle within a step, at its end or where it turns."""
        low, high = flint.arb(0), h
        if value(c, low)[1] > 0 > value(c, high)[1]:
            for _ in range(150):
                centre = middle((low + high) / 2)
                low, high = (centre, high) if value(c, centre)[1] > 0 else (low, centre)
        return bool(self.alpha * value(c, high)[0] > flint.arb.pi() / 2)

    def energy(self, theta):
        """Return the energy of a restrained block at an angle, over that at the base."""
        alpha, turned = self.alpha, (self.alpha - theta).cos() - self.alpha.cos()
        return turned + self.kappa * (1 - theta.cos()) + 2 * self.rho * alpha.sin() * (theta / 2).sin()

    def torque(self, theta):
        """Return the derivative of the energy."""
        alpha, half = self.alpha, (theta / 2).cos()
        return (alpha - theta).sin() + self.kappa * theta.sin() + self.rho * alpha.sin() * half

    def restrained_falls(self, u, v):
        """Return the result of ``falls_freely`` for a restrained block, whose energy is greatest at its balance or where it lies flat."""
        low, high = flint.arb(0), flint.arb.pi() / 2
        if self.torque(high) < 0:
            for _ in range(150):
                centre = middle((low + high) / 2)
                low, high = (centre, high) if self.torque(centre) > 0 else (low, centre)
        theta, top = self.alpha * u, self.energy(high)
        energy = (self.alpha * v) ** 2 / 2 + self.energy(theta)
        if (theta <= high and v > 0 and energy > top) or (theta > high and (v >= 0 or energy < top)):
            return True
        return bool(self.e**2 * energy > top)

    def falls_freely(self, u, v):
        """Return whether the block overturns after the base motion: by its energy, on this side or after the next impact."""
        alpha = self.alpha
        if self.restrained:
            return self.restrained_falls(u, v)
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
