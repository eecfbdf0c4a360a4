"""Free rocking in closed form, against many digits and the engine."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk

ANGLES = [1e-12, 1e-6, 0.01, 0.3, 0.75, 0.99, 0.999999]


@pytest.mark.parametrize("angle", ANGLES)
def test_quarter_period_and_speed_in_many_digits(angle):
    with mp.workdps(40):
        exact = mp.acosh(1 / (1 - mp.mpf(angle)))
        assert rk.theory.free_quarter_period(angle) == pytest.approx(float(exact), rel=4e-15, abs=0)
        speed = mp.sqrt(1 - (1 - mp.mpf(angle)) ** 2)
        assert rk.theory.free_impact_speed(angle) == pytest.approx(float(speed), rel=4e-16, abs=0)


def test_quarter_periods_of_an_array_are_those_of_its_numbers():
    np.testing.assert_array_equal(
        rk.theory.free_quarter_period(ANGLES), [rk.theory.free_quarter_period(angle) for angle in ANGLES]
    )
    assert rk.theory.free_quarter_period(1.0) == math.inf


@pytest.mark.parametrize("angle", [0.05, 0.6, 0.99])
@pytest.mark.parametrize("e", [0.3, 0.8, 0.95])
def test_a_released_block_strikes_turns_and_rests_when_and_where_it_should(angle, e):
    motion = rk.simulate(rk.System(rk.Harmonic(0.0, period=1.0), e), rk.State(angle=angle), cycles=400)
    impacts = motion.events[motion.events["kind"] == "impact"]
    assert impacts["time"][0] == pytest.approx(rk.theory.free_quarter_period(angle), rel=1e-12, abs=0)
    assert abs(impacts["before"][0]) == pytest.approx(rk.theory.free_impact_speed(angle), rel=1e-12, abs=0)
    peaks = np.abs(motion.peaks["angle"])[:19]
    peaks = peaks[peaks > 1e-9]
    np.testing.assert_allclose(
        peaks, rk.theory.free_peaks(angle, e, np.arange(1, len(peaks) + 1)), rtol=1e-12
    )
    rest = motion.events[motion.events["kind"] == "rest"]["time"][0]
    assert rest == pytest.approx(rk.theory.free_time_to_rest(angle, e), rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("angle", "e"), [(0.5, 0.8), (1e-9, 0.99), (4.9e-7, 0.99), (0.999, 0.05), (0.5, 0.9999)]
)
def test_time_to_rest_is_the_sum_of_all_flights(angle, e):
    with mp.workdps(30):
        speed = mp.sqrt(1 - (1 - mp.mpf(angle)) ** 2)
        # the double sum the other way round: artanh in powers, each a geometric series
        ratio = mp.mpf(e)
        powers = mp.nsum(
            lambda j: speed ** (2 * j + 1) / (2 * j + 1) * ratio ** (2 * j + 1) / (1 - ratio ** (2 * j + 1)),
            [0, mp.inf],
        )
        exact = mp.atanh(speed) + 2 * powers
    assert rk.theory.free_time_to_rest(angle, e) == pytest.approx(float(exact), rel=1e-14, abs=0)


def test_time_to_rest_at_the_ends_of_its_range():
    assert rk.theory.free_time_to_rest(0.0, 0.9) == 0.0
    assert rk.theory.free_time_to_rest(0.5, 0.0) == rk.theory.free_quarter_period(0.5)
    assert rk.theory.free_time_to_rest(0.5, 1.0) == rk.theory.free_time_to_rest(1.0, 0.5) == math.inf
