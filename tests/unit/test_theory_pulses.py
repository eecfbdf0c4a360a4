"""Overturning amplitudes of pulses in closed form, against 40 digits and against the engine by bisection."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk

RATES = [0.5, 1.0, 2.0, 3.0, 5.0, 12.0]


def overturns(kind, amplitude, duration, restitution=0.9):
    system = rk.System(rk.Pulse(kind, amplitude=amplitude, duration=duration), restitution)
    motion = rk.simulate(system, record="none")
    return motion.outcome is rk.Outcome.OVERTURNED


def bisected(falls, low, high):
    """Return the amplitude between one that does not overturn the block and one that does, to 1e-13 of it."""
    assert (falls(low), falls(high)) == (False, True)
    while abs(high - low) > 1e-13 * abs(high):
        middle = (low + high) / 2
        low, high = (low, middle) if falls(middle) else (middle, high)
    return high


def solved(condition):
    """Return 1/sin ψ at the root of a condition in (0, π/2), to 40 digits."""
    with mp.workdps(40):
        low, high = mp.mpf("1e-3"), mp.pi / 2
        return 1 / mp.sin(mp.findroot(condition, (low, high), solver="anderson", tol=1e-60))


def exact(kind, rate):
    """Threshold without an impact, from its equation."""
    with mp.workdps(40):
        w = mp.mpf(rate)
        if kind == "rectangular":
            return 1 / (1 - mp.exp(-mp.mpf(math.pi / rate)))
        if kind == "half-sine":
            w = mp.pi / mp.mpf(math.pi / rate)
            return solved(lambda psi: w * mp.sin(psi) - mp.cos(psi) - mp.exp(-(mp.pi - psi) / w))
        w = 2 * mp.pi / mp.mpf(math.tau / rate)
        if kind == "one-sine":
            return solved(lambda psi: w * mp.sin(psi) - mp.cos(psi) + mp.exp(-(2 * mp.pi - psi) / w))
        return (1 + w**2) / (1 - mp.exp(-2 * mp.pi / w))


FORMULAS = {
    "rectangular": (rk.theory.rectangular_pulse_amplitude, math.pi),
    "half-sine": (rk.theory.half_sine_pulse_amplitude, math.pi),
    "one-sine": (rk.theory.one_sine_pulse_amplitude, math.tau),
    "one-cosine": (rk.theory.one_cosine_pulse_amplitude, math.tau),
}


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("kind", FORMULAS)
def test_threshold_is_that_of_forty_digits(kind, rate):
    """To 8 roundings: the condition has a slope of the order of Ω, and its terms are of the order of 1."""
    formula, turn = FORMULAS[kind]
    assert formula(turn / rate) == pytest.approx(float(exact(kind, rate)), rel=2e-15, abs=0)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("kind", ["rectangular", "half-sine"])
def test_a_push_in_one_direction_overturns_from_the_threshold_on(kind, rate):
    formula, turn = FORMULAS[kind]
    edge = formula(turn / rate)
    found = bisected(lambda amplitude: overturns(kind, amplitude, turn / rate), 1.0, 2 * edge)
    assert found == pytest.approx(edge, rel=1e-10, abs=0)


TRIANGLES = {
    "falling": (rk.theory.falling_triangle_pulse_amplitude, [1.0, 0.0]),
    "isosceles": (rk.theory.triangle_pulse_amplitude, [0.0, 1.0, 0.0]),
}


@pytest.mark.parametrize("duration", [0.1, 0.5, 1.0, 2.0, 4.0, 12.0])
@pytest.mark.parametrize("kind", TRIANGLES)
@pytest.mark.parametrize("e", [0.5, 0.9, 1.0])
def test_a_triangle_overturns_from_the_threshold_on(kind, duration, e):
    formula, values = TRIANGLES[kind]
    edge = formula(duration)

    def falls(amplitude):
        base = rk.PiecewiseLinear(np.array(values) * amplitude, step=duration / (len(values) - 1))
        return rk.simulate(rk.System(base, e), record="none").outcome is rk.Outcome.OVERTURNED

    assert bisected(falls, 1.0, 2 * edge) == pytest.approx(edge, rel=1e-10, abs=0)
    for amplitude in np.linspace(1.0, edge, 40, endpoint=False):
        assert not falls(amplitude)


@pytest.mark.parametrize("kind", TRIANGLES)
def test_a_triangle_of_samples_overturns_a_block_in_si(kind):
    """A slender block of α = 2.7/s under a record of the pulse with many samples."""
    block, (formula, values) = rk.Block(2.0, 0.5), TRIANGLES[kind]
    seconds = 0.4
    edge = formula(seconds * block.frequency_parameter) * 9.80665 * math.tan(block.critical_angle)
    samples = np.interp(np.linspace(0.0, 1.0, 201), np.linspace(0.0, 1.0, len(values)), values)

    def falls(amplitude):
        ground = rk.GroundMotion(samples * amplitude, step=seconds / 200)
        return (
            rk.simulate(block.system(ground, model="slender"), record="none").outcome is rk.Outcome.OVERTURNED
        )

    assert bisected(falls, 0.5 * edge, 2 * edge) == pytest.approx(edge, rel=1e-10, abs=0)


@pytest.mark.parametrize(
    "kind, known",
    [
        ("falling", {0.5: 4.693484498723, 1.0: math.e, 4.0: 1.325242445973}),
        ("isosceles", {0.5: 4.983389430863, 2.0: 1.960323544077}),
    ],
)
def test_triangles_have_their_known_thresholds(kind, known):
    assert TRIANGLES[kind][0](list(known)) == pytest.approx(list(known.values()), rel=1e-12, abs=0)


@pytest.mark.parametrize("duration", [1e-6, 1e-3, 0.3, 0.99, 1.0, 1.01, 7.0, 40.0, 1e3, 1e6])
def test_triangles_have_forty_digits(duration):
    """From the integral e^{t₀} ∫ e⁻ˣ a(x) dx = 1, by its antiderivative in 400 digits, not from the reduced forms."""
    with mp.workdps(400):
        T = mp.mpf(duration)
        falling = 1 / (1 - (1 - mp.exp(-T)) / T)

        def excess(start):
            slope = 1 / start
            rising = -(T / 2 + 1) * mp.exp(-T / 2) + (start + 1) * mp.exp(-start)
            back = mp.exp(-T) + (T / 2 - 1) * mp.exp(-T / 2)
            return mp.exp(start) * slope * (rising + back) - 1

        low, high = T * mp.mpf("1e-9"), T / 2
        for _ in range(400):
            middle = (low + high) / 2
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        isosceles = T / (2 * high)
    assert rk.theory.falling_triangle_pulse_amplitude(duration) == pytest.approx(
        float(falling), rel=2e-15, abs=0
    )
    assert rk.theory.triangle_pulse_amplitude(duration) == pytest.approx(float(isosceles), rel=2e-15, abs=0)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("kind", ["one-sine", "one-cosine"])
def test_a_whole_period_overturns_without_impact_from_the_threshold_on(kind, rate):
    formula, turn = FORMULAS[kind]
    edge = formula(turn / rate)

    def at_once(amplitude):
        pulse = rk.Pulse(kind, amplitude=amplitude, duration=turn / rate)
        motion = rk.simulate(rk.System(pulse, 0.0), record="none")
        return motion.outcome is rk.Outcome.OVERTURNED and motion.impacts == 0

    assert bisected(at_once, 1.0, 2 * edge) == pytest.approx(edge, rel=1e-10, abs=0)


@pytest.mark.parametrize(("rate", "e"), [(5.0, 0.9), (5.5, 0.9), (6.5, 0.9), (5.2, 0.88), (9.0, 0.97)])
def test_both_ends_of_mode_1_are_those_of_the_engine(rate, e):
    duration = math.tau / rate
    low, high = rk.theory.one_sine_impact_amplitudes(duration, e)

    def falls(amplitude):
        return overturns("one-sine", amplitude, duration, e)

    middle = (low + high) / 2
    assert bisected(falls, low - 0.2, middle) == pytest.approx(low, rel=1e-10, abs=0)
    assert bisected(falls, high + 0.05, middle) == pytest.approx(high, rel=1e-10, abs=0)


def test_lower_end_of_mode_1_is_that_of_forty_digits():
    """From the motion's own closed form in 40 digits, not from that of the module."""
    with mp.workdps(40):
        w, e = mp.mpf(5), mp.mpf("0.9")

        def condition(amplitude):
            start, end = mp.asin(1 / amplitude) / w, 2 * mp.pi / w
            # u'' = u − 1 + A sin wτ from rest: u is a convolution of sinh with the right-hand side
            u = mp.quad(lambda x: mp.sinh(end - x) * (amplitude * mp.sin(w * x) - 1), [start, end])
            v = mp.quad(lambda x: mp.cosh(end - x) * (amplitude * mp.sin(w * x) - 1), [start, end])
            return e**2 * (1 + v**2 - (u - 1) ** 2) - 1

        known = mp.findroot(condition, 3.02)
    low, _ = rk.theory.one_sine_impact_amplitudes(math.tau / 5, 0.9)
    assert low == pytest.approx(float(known), rel=1e-14, abs=0)
    assert low == pytest.approx(3.0185998608717963664, rel=1e-14, abs=0)


def test_mode_1_ends_between_the_two_known_frequencies():
    """Computed for e = 0.9 with another method: between 6.581 and 6.586."""
    assert np.isfinite(rk.theory.one_sine_impact_amplitudes(math.tau / 6.581, 0.9)).all()
    assert np.isnan(rk.theory.one_sine_impact_amplitudes(math.tau / 6.586, 0.9)).all()


def test_mode_1_has_no_lower_end_where_the_impact_falls_into_the_pulse():
    low, high = rk.theory.one_sine_impact_amplitudes(math.tau / 4.5, 0.9)
    assert math.isnan(low)
    assert high < rk.theory.one_sine_pulse_amplitude(math.tau / 4.5)


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_a_block_that_loses_much_does_not_overturn_after_an_impact(e):
    assert np.isnan(rk.theory.one_sine_impact_amplitudes(math.tau / 5, e)).all()


def test_an_impact_without_loss_leaves_no_gap_between_the_modes():
    _, high = rk.theory.one_sine_impact_amplitudes(math.tau / 5, 1.0)
    assert high == pytest.approx(rk.theory.one_sine_pulse_amplitude(math.tau / 5), rel=1e-14, abs=0)


@pytest.mark.parametrize("kind", FORMULAS)
def test_values_of_an_array_are_those_of_its_numbers(kind):
    formula, _ = FORMULAS[kind]
    durations = np.array([[0.3, 1.0], [2.0, 7.0]])
    np.testing.assert_array_equal(formula(durations), [[formula(each) for each in row] for row in durations])


def test_ranges_of_an_array_are_those_of_its_numbers():
    durations = np.array([0.9, 1.0, 1.2])
    found = rk.theory.one_sine_impact_amplitudes(durations, 0.9)
    singly = [rk.theory.one_sine_impact_amplitudes(each, 0.9) for each in durations]
    np.testing.assert_array_equal(np.transpose(found), singly)
