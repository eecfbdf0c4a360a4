"""Rest is certified only where it comes: the bound on accumulating impacts against the motion followed impact by impact."""

import math

import numpy as np

from rocking.kernels import events as ev
from rocking.kernels import march as kernel
from rocking.kernels import parameters
from rocking.kernels.settling import base_settling_time

NOTHING = np.empty((0, 2))


def first_reset(p, speed):
    """(time, whether it is rest) of the first event that is no impact, from the base at this speed."""
    progress, _ = kernel.begin_march(p, 0.0, speed)
    rows = np.empty((20_000, 8))
    _, _, _, written = kernel.march(p, progress, 1, 0.0, NOTHING, rows, NOTHING, NOTHING[:, 0], False)
    others = rows[:written][rows[:written, 2] != ev.IMPACT]
    return others[0, 1], others[0, 2] == ev.RESTS


def test_certified_rest_comes_and_comes_in_time():
    random = np.random.default_rng(1963)
    checked, tightest = 0, 0.0
    for _ in range(3000):
        frequency, amplitude = 10.0 ** random.uniform(-0.5, 1.5), random.uniform(0.0, 3.0)
        phase, restitution = random.uniform(0.0, 2.0 * math.pi), random.uniform(0.05, 0.95)
        speed = 10.0 ** random.uniform(-6, -1)
        period = 2.0 * math.pi / frequency
        p = parameters.harmonic_parameters(amplitude, frequency, period, phase, restitution)
        bound = base_settling_time(p, math.cos(phase), math.sin(phase), speed)
        if bound >= period:
            continue
        time, rests = first_reset(p, speed)
        assert rests
        assert time <= bound
        tightest = max(tightest, time / bound)
        checked += 1
    assert checked > 500
    assert tightest > 0.5  # a bound, but no idle one
