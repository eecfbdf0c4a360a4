"""An undamped block from rest in forty digits: test whether the motion leaves its torus, or only its rounded computation.

A torus through the state of rest is tangent to an impact: at the initial phase both angle and velocity are zero. The
motion returns ever closer to that state, and after some 10⁴ impacts rounding may move it through the base.
"""

import math

from flint import arb, ctx

BITS = 140
NEAR = 1e-9  # dips less deep are looked at in all digits
SAMPLES = 24  # a period and a time constant


class Arc:
    """An arc that begins at the base: side, phase and speed; `coarse` evaluates it in doubles, `fine` in all digits."""

    def __init__(self, ripple, frequency, side, phase, speed):
        self.ripple, self.frequency, self.side, self.phase = ripple, frequency, side, phase
        place = 1 + side * ripple * phase.cos()
        rate = -side * ripple * frequency * phase.sin()
        self.grow, self.decay = ((speed - rate - place) / 2).mid(), ((rate - place - speed) / 2).mid()
        self.numbers = tuple(float(each) for each in (side * ripple, frequency, phase, self.grow, self.decay))

    def coarse(self, time):
        """Return (u, u') in double precision."""
        ripple, frequency, phase, grow, decay = self.numbers
        out, psi = math.exp(time), phase + frequency * time
        rising, falling = grow * out, decay / out
        return 1 + ripple * math.cos(
            psi
        ) + rising + falling, rising - falling - ripple * frequency * math.sin(psi)

    def fine(self, time):
        """Return (u, u', u'') in all digits."""
        out, (sine, cosine) = time.exp(), (self.phase + self.frequency * time).sin_cos()
        rising, falling, forced = self.grow * out, self.decay / out, self.side * self.ripple * cosine
        speed = rising - falling - self.side * self.ripple * self.frequency * sine
        return 1 + forced + rising + falling, speed, rising + falling - self.frequency**2 * forced

    def zero(self, guess):
        """The zero of u near a guess."""
        time = arb(guess)
        for _ in range(8):
            angle, speed, _ = self.fine(time)
            step = (angle / speed).mid()
            time = (time - step).mid()
            if abs(step) < arb(2) ** (10 - BITS):
                break
        return time

    def dip(self, guess):
        """Return whether the minimum of u near a guess is below zero, and a guess of the zero before it."""
        time = arb(guess)
        for _ in range(8):
            angle, speed, pull = self.fine(time)
            time = (time - speed / pull).mid()
        angle, _, pull = self.fine(time)
        return angle < 0, float(time) - math.sqrt(max(-2 * float(angle / pull), 0.0))

    def first_zero(self, step):
        """The first zero of u after the start, None where u passes 4 first."""
        before, (_, speed_before) = 0.0, self.coarse(0.0)
        while True:
            after = before + step
            angle, speed = self.coarse(after)
            if angle <= 0.0:
                return self.zero(_bisect(lambda t: -self.coarse(t)[0], before, after))
            if speed_before < 0.0 < speed:
                lowest = _bisect(lambda t: self.coarse(t)[1], before, after)
                if self.coarse(lowest)[0] < NEAR:
                    below, guess = self.dip(lowest)
                    if below:
                        return self.zero(guess)
            if angle > 4.0:
                return None
            before, speed_before = after, speed


def _bisect(function, low, high):
    """Find the zero of a function that rises between two numbers, to double precision."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if function(middle) > 0.0 else (middle, high)
    return high


def squared_speeds(amplitude, period, cycles):
    """Return the squared speeds of all impacts within ``cycles`` from rest at phase 0, and whether it overturned."""
    bits, ctx.prec = ctx.prec, BITS
    try:
        frequency = 2 * arb.pi() / arb(period)
        ripple = (arb(amplitude) / (1 + frequency**2)).mid()
        frequency, time, end = frequency.mid(), 0.0, cycles * period
        arc, step, found = Arc(ripple, frequency, -1, arb(0), arb(0)), min(period, 1.0) / SAMPLES, []
        while True:
            lasting = arc.first_zero(step)
            if lasting is None:
                return found, True
            time += float(lasting)
            if time > end:
                return found, False
            speed = (-arc.fine(lasting)[1]).mid()
            found.append(float(speed) ** 2)
            phase = arc.phase + frequency * lasting
            phase = (phase - 2 * arb.pi() * (phase / (2 * arb.pi())).floor().mid()).mid()
            arc = Arc(ripple, frequency, -arc.side, phase, speed)
    finally:
        ctx.prec = bits
