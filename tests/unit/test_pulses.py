"""Pulses: their conditions of overturning in closed form, numbers that others printed, and their two forms of input."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from rocking.model.forcing import KINDS

RESTITUTION = 0.9
HALF_SINE = {0.5: 1.10941782324, 1: 1.32239659791, 2: 1.80072393056, 3: 2.29387231344, 5: 3.28914677752}
"""Amplitudes at which a half sine overturns, by frequency ratio W: Shi et al. (1996), Makris & Roussos (2000), eq. (27)."""


def outcome(kind, amplitude, duration, restitution=RESTITUTION):
    return rk.simulate(rk.System(rk.Pulse(kind, amplitude=amplitude, duration=duration), restitution))


def overturns_beyond(kind, edge, duration, impacts):
    below, above = (outcome(kind, amplitude, duration) for amplitude in (edge - 1e-10, edge + 1e-10))
    assert (below.outcome, above.outcome) == ("at-rest", "overturned")
    assert above.impacts == impacts
    assert above.certified
    assert below.certified
    assert abs(above.margin) < 1e-8


def amplitude_where(condition, low, high):
    """Amplitude 1/sin psi at which a condition on the phase psi of the lift-off holds."""
    with mp.workdps(40):
        return float(1 / mp.sin(mp.findroot(condition, (low, high), solver="anderson")))


@pytest.mark.parametrize("duration", [0.3, 0.7, 1.0, 2.0, 4.0])
def test_rectangular_pulse(duration):
    """A > 1/(1 − exp(−T)); the same as Housner (1963), eq. (9)."""
    edge = -1 / math.expm1(-duration)
    assert math.cosh(duration) == pytest.approx(1 + 1 / (2 * edge * (edge - 1)))
    overturns_beyond("rectangular", edge, duration, 0)


@pytest.mark.parametrize("ratio", HALF_SINE)
def test_half_sine(ratio):
    edge = amplitude_where(
        lambda psi: ratio * mp.sin(psi) - mp.cos(psi) - mp.exp(-(mp.pi - psi) / ratio), 1e-3, 1.57
    )
    assert edge == pytest.approx(HALF_SINE[ratio], abs=1e-11)
    overturns_beyond("half-sine", edge, math.pi / ratio, 0)


def test_one_sine_without_impact():
    """Zhang & Makris (2001), eq. (47)."""
    edge = amplitude_where(
        lambda psi: 5 * mp.sin(psi) - mp.cos(psi) + mp.exp(-(2 * mp.pi - psi) / 5), 0.05, 0.19
    )
    assert edge == pytest.approx(7.16812879707078524, abs=1e-12)
    overturns_beyond("one-sine", edge, math.tau / 5, 0)


def test_one_sine_with_an_impact_after_its_end():
    """The block leaves the impact with the speed 1; the number is that of 40 digits."""
    overturns_beyond("one-sine", 3.0185998608717963664, math.tau / 5, 1)


@pytest.mark.parametrize(
    ("amplitude", "overturned"),
    [(3.00, False), (3.02, True), (6.31, True), (6.33, False), (7.16, False), (7.18, True)],
)
def test_order_of_the_two_modes_is_the_printed_one(amplitude, overturned):
    """Zhang & Makris (2001), Figs 7 and 8: slender block, W = 5."""
    assert (outcome("one-sine", amplitude, math.tau / 5).outcome == "overturned") == overturned


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_one_cosine_without_impact(ratio):
    """A > (1 + W²)/(1 − exp(−2π/W))."""
    edge = -(1 + ratio**2) / math.expm1(-math.tau / ratio)
    found = outcome("one-cosine", edge + 1e-10, math.tau / ratio)
    assert (found.outcome, found.impacts) == ("overturned", 0)
    assert found.margin == pytest.approx(0.0, abs=1e-9)
    assert outcome("one-cosine", edge - 1e-10, math.tau / ratio).impacts > 0


@pytest.mark.parametrize(
    ("kind", "height", "width", "duration", "printed"),
    [("half-sine", 1.2, 0.4, 0.5, 0.5545), ("one-sine", 3.0, 1.0, 1.0, 0.4514)],
)
def test_least_overturning_accelerations_are_the_printed_ones(kind, height, width, duration, printed):
    """Makris & Roussos (2000), Figs 2 and 9, in units of g, to the last digit printed and the value of g."""
    block = rk.Block(height=height, width=width)
    found = [
        rk.simulate(
            block.system(
                rk.Pulse(kind, amplitude=size * 9.80665, duration=duration),
                model="slender",
                normalised_by="angle",
            )
        ).outcome
        for size in (printed - 1e-3, printed + 1e-3)
    ]
    assert found == ["at-rest", "overturned"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("amplitude", [1.7, -2.6])
def test_motion_is_that_of_its_samples(kind, amplitude):
    """Every form against the engine of straight lines: its samples converge to it with the square of the step."""
    system = rk.System(rk.Pulse(kind, amplitude=amplitude, duration=1.5), 0.85)
    pulse, motion = system.forcing, rk.simulate(system)
    times = np.linspace(0.0, pulse.span, 40_001)
    lines = rk.PiecewiseLinear(pulse.acceleration(times), step=pulse.span / 40_000)
    other = rk.simulate(rk.System(lines, 0.85))
    assert motion.outcome == other.outcome
    assert motion.margin == pytest.approx(other.margin, abs=1e-6)
    shown = np.linspace(0.0, min(motion.duration, other.duration), 200)
    for mine, theirs in zip(motion.at(shown), other.at(shown), strict=True):
        assert mine == pytest.approx(theirs, abs=1e-5)


@pytest.mark.parametrize("kind", ["ricker", "antisymmetric-ricker"])
def test_ricker_pulses_are_sampled_to_the_stated_bound(kind):
    """Against the derivatives of a Gaussian, from far before the samples to far behind them."""
    pulse = rk.Pulse(kind, amplitude=1.0, duration=2.0)
    times = np.linspace(-2.0, pulse.span + 2.0, 300_001)
    x = (times - pulse.span / 2) / pulse.duration
    if kind == "ricker":
        wave = (1 - 2 * (np.pi * x) ** 2) * np.exp(-((np.pi * x) ** 2))
    else:
        z = 2 * np.pi * x / np.sqrt(3)
        wave = (z**3 - 3 * z) * np.exp(-(z**2) / 2)
        wave = wave / np.abs(wave).max()
    assert np.abs(pulse.acceleration(times) - wave).max() < 1e-6


@pytest.mark.parametrize("braces", [rk.Braces(0.4, 0.8), rk.Braces(1.3, 0.7), rk.Braces(0.4)])
@pytest.mark.parametrize("kind", ["one-sine", "one-cosine"])
def test_motion_between_braces_is_that_of_its_samples(kind, braces):
    pulse = rk.Pulse(kind, amplitude=2.4, duration=3.0)
    times = np.linspace(0.0, 3.0, 40_001)
    lines = rk.PiecewiseLinear(pulse.acceleration(times), step=3.0 / 40_000)
    one, other = (rk.simulate(rk.System(each, 0.8, braces), duration=4.0) for each in (pulse, lines))
    shown = np.linspace(0.0, 4.0, 300)
    assert one.brace_hits > 0
    for mine, theirs in zip(one.at(shown), other.at(shown), strict=True):
        assert mine == pytest.approx(theirs, abs=1e-4)


def test_kind_amplitude_and_duration_are_checked():
    with pytest.raises(ValueError, match="kind must be one of 'rectangular'"):
        rk.Pulse("sine", amplitude=1.0, duration=1.0)
    with pytest.raises(ValueError, match="duration"):
        rk.Pulse("one-sine", amplitude=1.0, duration=0.0)
    with pytest.raises(TypeError, match="acceleration must be omitted with base"):
        rk.Block(2.0, 0.5).system(
            rk.Pulse("one-sine", amplitude=1.0, duration=1.0), acceleration=1.0, model="slender"
        )
    for base in (rk.Harmonic(1.0, period=1.0), "file.AT2"):
        with pytest.raises(TypeError, match=r"base must be a BaseMotion; .*rk\.read_ground_motion\(path\)"):
            rk.Block(2.0, 0.5).system(base, model="slender")


@pytest.mark.parametrize("kind", KINDS)
def test_displacement_is_the_acceleration_integrated_twice(kind):
    pulse = rk.Pulse(kind, amplitude=-1.5, duration=0.8)
    times = np.linspace(0.0, 1.3 * pulse.span, 200_001)
    step, acceleration = times[1], pulse.acceleration(times)
    velocity = np.concatenate(([0.0], np.cumsum((acceleration[1:] + acceleration[:-1]) * (step / 2))))
    place = np.concatenate(([0.0], np.cumsum((velocity[1:] + velocity[:-1]) * (step / 2))))
    assert pulse.displacement(times) == pytest.approx(place, abs=2e-5)


def test_a_block_that_fell_long_before_the_end_of_its_pulse_has_a_final_state():
    pulse = rk.Pulse("one-sine", amplitude=14.0, duration=2 * math.pi / 0.3)
    motion = rk.simulate(rk.System(pulse, 0.9), record="none")
    assert motion.outcome == "overturned"
    assert abs(motion.final.angle) > 1e9
