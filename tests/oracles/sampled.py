"""Motion under a base acceleration that is linear between samples, by Taylor series of the equation of motion in mpmath.

Nothing is taken from the package. Each step is a power series of u'' = u - 1 - side a(t); an event is bracketed between two
steps, also where u has a minimum between them, and bisected.
"""

import mpmath as mp

DIGITS = 50
TERMS = 40
LONGEST = mp.mpf(1) / 16
# Speed below which a block is taken to rest, if the base does not lift it.
STILL = mp.mpf(10) ** -30


class Base:
    """Base acceleration, 0 before the first sample and after the last."""

    def __init__(self, values, step, scale):
        self.values = [mp.mpf(float(value)) * mp.mpf(scale) for value in values]
        self.step = mp.mpf(float(step))

    def line(self, index):
        """Acceleration at the start of an interval, and its rate."""
        if index >= len(self.values) - 1:
            return mp.mpf(0), mp.mpf(0)
        first, second = self.values[index : index + 2]
        return first, (second - first) / self.step

    def at(self, index, offset):
        start, rate = self.line(index)
        return start + rate * offset


def series(u, v, force, rate):
    """Coefficients of u(x) with u'' = u + force + rate x."""
    c = [u, v]
    for k in range(TERMS):
        c.append((c[k] + (force if k == 0 else rate if k == 1 else 0)) / ((k + 1) * (k + 2)))
    return c


def value(c, x):
    total = mp.mpf(0)
    for one in reversed(c):
        total = total * x + one
    return total


def derivative(c):
    return [k * c[k] for k in range(1, len(c))]


def slope(c, x):
    return value(derivative(c), x)


def root(c, low, high):
    """Zero of a polynomial that is positive at ``low`` and negative at ``high``: Newton's method, safeguarded by bisection."""
    x, d = (low + high) / 2, derivative(c)
    for _ in range(4 * DIGITS):
        w, dw = value(c, x), value(d, x)
        if w > 0:
            low = x
        else:
            high = x
        ahead = x - w / dw if dw else low
        if not low < ahead < high:
            ahead = (low + high) / 2
        if abs(ahead - x) <= abs(ahead) * mp.mpf(10) ** (3 - DIGITS):
            return ahead
        x = ahead
    return x


def first_below(w, c, length):
    """First time in (0, length] at which w(u) falls below 0, or None; ``w`` is +-(u - constant)."""
    sign, constant = w
    c = [sign * (c[0] - constant), *(sign * one for one in c[1:])]
    d, steps = derivative(c), 4

    def height(x):
        return value(c, x)

    def rise(x):
        return value(d, x)

    for k in range(steps):
        low, high = length * k / steps, length * (k + 1) / steps
        if height(high) < 0:
            # just after a start at 0 the function may be 0 or, by rounding, below
            if k == 0 and abs(height(low)) < mp.mpf(10) ** -40:
                peak = root(d, low, high) if rise(low) > 0 else low
                if height(peak) <= 0:
                    return low
                low = peak
            return root(c, low, high)
        if rise(low) < 0 < rise(high):
            bottom = root([-one for one in d], low, high)
            if height(bottom) < 0:
                return root(c, low, bottom)
    return None


def motion(values, step, restitution, *, scale=1.0, angle=0.0, velocity=0.0, brace=None, until=None):
    """Impacts (time, speed before, at the brace), and the outcome, "rest", "overturned" or "end".

    The motion ends when it is certain: after the last sample the energy of a free block decides.
    """
    with mp.workdps(DIGITS):
        return _motion(Base(values, step, scale), mp.mpf(float(restitution)), angle, velocity, brace, until)


def _motion(base, e, angle, velocity, brace, until):
    impacts, index, offset = [], 0, mp.mpf(0)
    last = len(base.values) - 1
    signed = (angle, velocity)
    side = 1 if signed > (0, 0) else -1
    u, v = abs(mp.mpf(float(angle))), side * mp.mpf(float(velocity))
    place, r = (None, None) if brace is None else (mp.mpf(float(brace[0])), mp.mpf(float(brace[1])))
    resting = u == 0 and v == 0
    while True:
        time = index * base.step + offset
        free = index >= last
        if until is not None and time >= until:
            return impacts, "end"
        if resting:
            a = base.at(index, offset)
            if abs(a) > 1:
                side, resting = (-1 if a > 0 else 1), False
                continue
            if free:
                return impacts, "rest"
            start, rate = base.line(index)
            end = start + rate * base.step
            if abs(end) > 1:
                offset = (mp.sign(end) - start) / rate
                side, resting = (-1 if end > 0 else 1), False
            else:
                index, offset = index + 1, mp.mpf(0)
            continue
        if free and place is None:
            energy = v * v + u * (2 - u)  # of the free block; the barrier is 1
            if (u >= 1 and v >= 0) or (v > 0 and energy > 1) or u > 2:
                return impacts, "overturned"
            if e < 1 and e * mp.sqrt(energy) < mp.mpf(10) ** -3:
                return impacts, "rest"
            if e * mp.sqrt(energy) <= 1 and e == 1:
                return impacts, "bounded"
        length = min(base.step - offset, LONGEST) if not free else LONGEST
        start, rate = base.line(index)
        force = -1 - side * (start + rate * offset)
        if u == 0 and v == 0 and force < 0:
            force = mp.mpf(0)
        c = series(u, v, force, -side * rate)
        x, at_brace = first_below((1, 0), c, length), False
        if place is not None:
            x_brace = first_below((-1, place), c, length if x is None else x)
            if x_brace is not None and (x is None or x_brace < x):
                x, at_brace = x_brace, True
        if x is None:
            u, v, offset = value(c, length), slope(c, length), offset + length
            if not free and base.step - offset < mp.mpf(10) ** -40:
                index, offset = index + 1, mp.mpf(0)
            continue
        speed, offset = slope(c, x), offset + x
        impacts.append((index * base.step + offset, abs(speed), at_brace))
        if at_brace:
            u, v = place, -r * speed
        else:
            side, u, v = -side, mp.mpf(0), -e * speed
            if v < STILL:
                v, resting = mp.mpf(0), True
