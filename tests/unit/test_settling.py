"""Rest is certified only if it occurs: the bound on chattering against the motion followed impact by impact."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.kernels import event_kinds as ev
from rocking.kernels.base.cosine import HarmonicDrive
from rocking.kernels.base.samples import SampledDrive
from rocking.kernels.block.chattering import base_settling_time, brace_settling_within
from rocking.kernels.contract import settling
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion import march
from rocking.kernels.motion.march import Recording
from rocking.kernels.motion.observers import EVENT_ROW
from rocking.kernels.system import harmonic_parameters
from rocking.motion.march_loop import parameters as kernel_parameters

STEADY = HarmonicDrive(1.0, 0.0)


def first_reset(p, speed):
    """Return the time of the first event other than an impact, from the base at this speed, and whether it is rest."""
    progress, _ = march.begin_march(p, 0.0, speed)
    rows = np.empty(20_000, EVENT_ROW)
    _, _, _, written = march.march(p, progress, 1, Recording(events=rows))
    others = rows[:written][rows["event"][:written] != ev.IMPACT]
    return others[0]["time"], others[0]["event"] == ev.RESTS


def test_certified_rest_comes_and_comes_in_time():
    random = np.random.default_rng(1963)
    checked, tightest = 0, 0.0
    for _ in range(3000):
        frequency, amplitude = 10.0 ** random.uniform(-0.5, 1.5), random.uniform(0.0, 3.0)
        phase, restitution = random.uniform(0.0, 2.0 * math.pi), random.uniform(0.05, 0.95)
        speed = 10.0 ** random.uniform(-6, -1)
        period = 2.0 * math.pi / frequency
        p = harmonic_parameters(amplitude, frequency, period, phase, restitution)
        bound = base_settling_time(p, 1, HarmonicDrive(math.cos(phase), math.sin(phase)), speed, math.inf)
        if bound >= period:
            continue
        time, rests = first_reset(p, speed)
        assert rests
        assert time <= bound
        tightest = max(tightest, time / bound)
        checked += 1
    assert checked > 500
    assert tightest > 0.5  # a bound, but no idle one


@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("share", [1e-3, 0.03, 0.1])
def test_bound_without_forcing_is_not_below_the_time_of_all_flights(restitution, share):
    """Against a press d a flight that begins with v lasts 2 artanh v/d: d is 1 at the base, 1/2 at a brace at 1.5."""
    p = harmonic_parameters(0.0, 1.0, 2.0 * math.pi, 0.0, restitution, 1.5, restitution)
    flights = math.fsum(2.0 * math.atanh(share * restitution**k) for k in range(400))
    assert flights <= base_settling_time(p, 1, STEADY, share, math.inf) <= 1.1 * flights
    assert flights <= brace_settling_within(p, 1, STEADY, 0.5 * share) <= 1.1 * flights


@kernel
def settling_from(p, index, offset, speed):
    return settling(p, 1, SampledDrive(index, offset), speed)


def test_certified_rest_under_samples_comes_in_time_and_below_the_bound():
    random = np.random.default_rng(1996)
    checked, tightest, highest = 0, 0.0, 0.0
    for _ in range(3000):
        # weak losses and coarse steps: the block hops for as long as the base acceleration changes
        step, restitution = 10.0 ** random.uniform(-1, 1), 1.0 - 10.0 ** random.uniform(-2, -0.3)
        values, speed = random.uniform(0.5, 1.5) * random.uniform(-1, 1, 8), 10.0 ** random.uniform(-3, -1)
        system = rk.System(rk.PiecewiseLinear(values, step=step), restitution)
        bound, top = settling_from(kernel_parameters(system), 0, 0.0, speed)
        if bound == math.inf:
            continue
        events = rk.simulate(system, rk.State(velocity=speed)).events[1:]
        end = int(np.argmax(events["kind"] != "impact"))
        assert events["kind"][end] == "rest"
        assert events["time"][end] <= bound
        motion = rk.simulate(system, rk.State(velocity=speed), duration=max(float(events["time"][end]), 1e-9))
        assert motion.peak <= top
        tightest, highest = max(tightest, events["time"][end] / bound), max(highest, motion.peak / top)
        checked += 1
    assert checked > 300
    assert tightest > 0.5  # bounds, but no idle ones
    assert highest > 0.5
