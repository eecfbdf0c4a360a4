"""Motion to 40 digits: eq. (5) of Yim & Lin (1991) in mpmath, impacts bracketed on a dense grid and refined by Newton.

Inputs are exact double-precision numbers. It is for initial states in general position only: a grazing dip between two
points of the grid would be missed.
"""

import mpmath as mp
import numpy as np

DIGITS = 60  # the closed form cancels some
POINTS_PER_PERIOD = 2000


def state_at(case, start, until, frequency):
    """Return (angle, velocity) in mpmath at `until`, from `start` at time 0; None if |angle| reaches 3.

    `frequency` is exact: a double-precision number, or 2π over an exact period.
    """
    with mp.workdps(DIGITS):
        amplitude, restitution = mp.mpf(case.amplitude), mp.mpf(case.restitution)
        time, angle, velocity = mp.mpf(0), mp.mpf(start.angle), mp.mpf(start.velocity)
        side = mp.sign(angle)
        while True:
            arc = Arc(amplitude, frequency, side, frequency * time, side * angle, side * velocity)
            length = first_crossing(arc, until - time, 2 * np.pi / float(frequency) / POINTS_PER_PERIOD)
            if length is None:
                height, speed = arc(until - time)
                return (side * height, side * speed) if abs(height) < 3 else None
            time, angle, velocity, side = time + length, mp.mpf(0), restitution * side * arc(length)[1], -side


class Arc:
    """Arc on one side: height u and speed u' at a time after its start, in mpmath or in NumPy."""

    def __init__(self, amplitude, frequency, side, phase, height, speed):
        self.frequency, self.phase, self.push = frequency, phase, side * amplitude / (1 + frequency**2)
        self.even = height - 1 - self.push * mp.cos(phase)
        self.odd = speed + self.push * frequency * mp.sin(phase)

    def __call__(self, t):
        x, sinh, cosh = self.phase + self.frequency * t, mp.sinh(t), mp.cosh(t)
        height = self.even * cosh + self.odd * sinh + 1 + self.push * mp.cos(x)
        return height, self.even * sinh + self.odd * cosh - self.push * self.frequency * mp.sin(x)

    def grid(self, t):
        x = float(mp.fmod(self.phase, 2 * mp.pi)) + float(self.frequency) * t
        return float(self.even) * np.cosh(t) + float(self.odd) * np.sinh(t) + 1 + float(self.push) * np.cos(x)


def first_crossing(arc, longest, spacing):
    """Return the time at which the height first falls through 0, or None."""
    times = np.arange(1, int(min(float(longest), 30.0) / spacing) + 1) * spacing
    below = np.flatnonzero(arc.grid(times) < 0)
    if below.size == 0:
        return None
    t = mp.mpf(times[below[0]])
    for _ in range(100):
        height, speed = arc(t)
        t -= height / speed
        if abs(height) < mp.mpf(10) ** (10 - DIGITS):
            return t if t < longest else None
    raise ArithmeticError("Newton's iteration for an impact did not converge")
