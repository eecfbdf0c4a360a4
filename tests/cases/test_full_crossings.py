"""Motions of the full block in which the first terms of a step hardly say how it goes on, against collocation in 40 digits."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles.full_block import DIGITS, Block, Cosine, Samples

LIFT_OFF = math.tan(0.25) / 0.25


def check(system, base, start, until, tolerance=1e-11):
    """Compare the state at a time, and the number of impacts up to it."""
    braces = (math.inf, 1.0) if system.braces is None else (system.braces.angle, system.braces.restitution)
    motion = rk.simulate(system, rk.State(*start), **until)
    with mp.workdps(DIGITS):
        exact = Block(base, system.restitution, system.critical_angle, *braces)
        angle, velocity, impacts = exact.final(motion.duration, *start)
    found = motion.final
    assert motion.impacts == impacts
    assert abs(found.angle - float(angle)) <= tolerance
    assert abs(found.velocity - float(velocity)) <= tolerance * 10


def test_block_that_hardly_touches_the_base_and_is_then_pushed_away():
    alpha, amplitude, frequency = 0.030175358438490354, 12.552193821114768, 0.5585650639006059
    phase = math.atan2(0.9966946710551469, -0.08123873885205585)
    forcing = rk.Harmonic(amplitude, frequency=frequency, phase=phase)
    system = rk.System(forcing, 0.9, critical_angle=alpha)
    motion = rk.simulate(system, rk.State(3.6153543363910777e-14, -3.738417935760316e-08), cycles=1)
    with mp.workdps(DIGITS):
        base = Cosine(amplitude, 2 * mp.pi / mp.mpf(frequency), phase)
        angle, *_ = Block(base, 0.9, alpha).final(0.4, 3.6153543363910777e-14, -3.738417935760316e-08)
    assert abs(float(motion.at(0.4)[0]) - float(angle)) < 1e-12
    assert not (motion.events["time"] <= 0.4).any()


@pytest.mark.parametrize("above", [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3])
def test_lift_off_shortly_before_a_sample_after_which_the_base_accelerates_more(above):
    values = np.array([0.0, (1.0 + above) * LIFT_OFF, 3.0 * LIFT_OFF, 3.0 * LIFT_OFF, 0.0])
    system = rk.System(rk.PiecewiseLinear(values, step=0.3), 0.9, critical_angle=0.25)
    check(system, Samples(values, 0.3), (0.0, 0.0), {"duration": 1.1})


@pytest.mark.parametrize("angle", [0.0, 1e-30, 1e-22, 1e-18, 1e-15])
def test_start_a_little_above_the_base_that_rises(angle):
    forcing = rk.Harmonic(0.5, period=1.0)
    motion = rk.simulate(rk.System(forcing, 0.9, critical_angle=0.3), rk.State(angle, 0.01), cycles=1)
    with mp.workdps(DIGITS):
        exact = Block(Cosine(0.5, 1.0, 0.0), 0.9, 0.3)
        before, after = (exact.final(time, angle, 0.01)[2] for time in (0.0136, 0.0138))
    assert (before, after) == (0, 1)
    assert 0.0136 < motion.events["time"][0] < 0.0138


@pytest.mark.parametrize("ulps", range(-3, 4))
def test_impact_at_a_sample_to_rounding(ulps):
    values, step = np.full(60, -6.371363160870768), 0.02315307513566224
    angle = 0.012346463940726958
    for _ in range(abs(ulps)):
        angle = math.nextafter(angle, math.copysign(1.0, ulps))
    system = rk.System(rk.PiecewiseLinear(values, step=step), 0.9, critical_angle=0.6200954996673713)
    check(system, Samples(values, step), (angle, -0.5827199409996022), {"duration": 0.1})


def test_departure_from_a_brace_under_a_steep_acceleration():
    values = np.array([-95.0, 46.0])
    braces = rk.Braces(1.0, restitution=0.5)
    system = rk.System(rk.PiecewiseLinear(values, step=1.0), 0.5, braces, critical_angle=0.2)
    check(system, Samples(values, 1.0), (1.0, 0.0), {"duration": 0.9}, tolerance=1e-9)


@pytest.mark.parametrize("kind", ["triangular", "rectangular", "one-cosine", "half-sine"])
@pytest.mark.parametrize(("height", "width"), [(1.7, 0.85), (1.3, 0.4), (2.9, 0.75)])
def test_base_that_just_reaches_the_limit_of_lift_off_leaves_the_block_at_rest(kind, height, width):
    block, limit = rk.Block(height=height, width=width), 9.80665 * width / height
    for acceleration in (math.nextafter(limit, 0.0), limit, math.nextafter(limit, math.inf)):
        pulse = rk.Pulse(kind, amplitude=acceleration, duration=0.5)
        motion = rk.simulate(block.system(pulse, model="full"))
        assert motion.outcome is rk.Outcome.AT_REST
        assert motion.peak < 1e-9


def test_table_of_restitution_that_reaches_1_at_high_speed_lets_the_block_rest():
    base = rk.PiecewiseLinear([0.0, 3.0, 0.0], step=0.3)
    motion = rk.simulate(rk.System(base, 0.8, critical_angle=0.3, restitution_table=[(1.0, 1.0)]))
    assert motion.outcome is rk.Outcome.AT_REST
    assert motion.impacts > 5


@pytest.mark.parametrize("angle", [1.6, -1.6])
def test_start_at_which_the_block_lies_flat_is_refused(angle):
    system = rk.System(rk.Harmonic(0.0, period=1.0), 0.9, critical_angle=1.0)
    with pytest.raises(ValueError, match=r"angle must lie within ±1\.5708, where the block lies flat"):
        rk.simulate(system, rk.State(angle, 0.0), cycles=1)
