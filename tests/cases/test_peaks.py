"""Largest angles of motions, against samples of the angle around its largest value."""

import numpy as np
import pytest

import rocking as rk

GRID, ZOOM, STEPS = 4001, 21, 9


def highest(motion):
    """Return the largest |angle| of a motion, from samples that become denser around the largest one, and its time."""
    times = np.linspace(0.0, motion.duration, GRID)
    for _ in range(STEPS):
        angles, apart = np.abs(motion.at(times)[0]), times[1] - times[0]
        top = times[np.argmax(angles)]
        times = np.linspace(max(top - apart, 0.0), min(top + apart, motion.duration), ZOOM)
    return angles.max(), top


def rounding(motion, time):
    """Return the rounding error of an angle: terms as large as 1 + A, errors at the start of the arc grow as cosh."""
    starts = np.append(0.0, motion.events["time"])
    since = time - starts[np.searchsorted(starts, time, side="right") - 1]
    return 4.0 * np.finfo(float).eps * (1.0 + motion.system.forcing.amplitude) * np.cosh(since)


def motions(count, seed):
    """Yield systems, initial states and cycles at random, whose motion does not overturn."""
    rng = np.random.default_rng(seed)
    while count > 0:
        amplitude, period, restitution = rng.uniform(1.1, 20.0), rng.uniform(0.2, 3.0), rng.uniform(0.5, 1.0)
        forcing = rk.Harmonic(amplitude, period=period, phase=rng.uniform(0.0, 2.0 * np.pi))
        system = rk.System(forcing, restitution)
        start, cycles = rk.State(rng.uniform(-0.6, 0.6), rng.uniform(-0.5, 0.5)), int(rng.integers(1, 6))
        motion = rk.simulate(system, start, cycles=cycles)
        if motion.outcome != "overturned":
            count -= 1
            yield system, start, cycles, motion


@pytest.mark.parametrize("seed", [1991, 2026])
def test_largest_angle_is_that_of_dense_samples(seed):
    """The samples are values of the closed form, the largest angle is a value of its Taylor series."""
    for system, start, cycles, motion in motions(200, seed):
        found = rk.simulate(system, start, cycles=cycles, record="none").peak
        expected, time = highest(motion)
        assert found == pytest.approx(expected, rel=0, abs=rounding(motion, time)), (system, start, cycles)


def test_largest_angle_does_not_hang_on_what_is_recorded():
    """While the base moves on, a slower arc of a chatter may be higher than all before, up to four times."""
    rng = np.random.default_rng(1)
    for _ in range(400):
        forcing = rk.Harmonic(
            rng.uniform(0.2, 1.0), period=10 ** rng.uniform(-0.3, 1.3), phase=rng.uniform(0, 6)
        )
        system = rk.System(forcing, 1 - 10 ** rng.uniform(-2.5, -0.5))
        start = rk.State(velocity=10 ** rng.uniform(-3, -0.7))
        resolved = rk.simulate(system, start, cycles=30, record="all")
        assert rk.simulate(system, start, cycles=30, record="none").peak == pytest.approx(
            resolved.peak, rel=1e-12
        )
