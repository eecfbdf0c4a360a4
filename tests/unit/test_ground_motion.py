"""Ground motions: peaks, intensity and spectra against independent solutions, baselines, and values that stay as they are."""

import math
import pickle
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

import rocking as rk

G = 9.80665


def noise(samples=60, step=0.05, seed=1, **options):
    return rk.GroundMotion(np.random.default_rng(seed).normal(size=samples), step=step, **options)


@pytest.fixture(scope="module")
def fine():
    """A motion and its integrals on a fine grid, by the trapezoidal rule."""
    motion = noise()
    times = np.linspace(0, motion.duration, 200 * (motion.acceleration.size - 1) + 1)
    a = np.interp(times, motion.times, motion.acceleration)
    v = cumulative_trapezoid(a, times, initial=0)
    return motion, times, a, v, cumulative_trapezoid(v, times, initial=0)


def test_velocity_and_displacement_are_integrals(fine):
    motion, _, _, v, u = fine
    np.testing.assert_allclose(motion.velocity, v[::200], atol=1e-12)
    np.testing.assert_allclose(motion.displacement, u[::200], atol=1e-6)


def test_peaks_are_those_on_a_fine_grid(fine):
    motion, _, a, v, u = fine
    assert motion.pga == pytest.approx(np.abs(a).max(), rel=1e-12)
    assert motion.pgv == pytest.approx(np.abs(v).max(), rel=1e-4)
    assert motion.pgv >= np.abs(v).max() * (1 - 1e-12)
    assert motion.pgd == pytest.approx(np.abs(u[::200]).max(), rel=1e-6)


def test_displacement_is_exact_in_rational_numbers():
    values = [Fraction(k * k % 7 - 3, 2) for k in range(20)]
    step, v, u, found = Fraction(1, 4), Fraction(0), Fraction(0), [(0.0, 0.0)]
    for first, second in pairwise(values):
        u += v * step + (2 * first + second) * step**2 / 6
        v += (first + second) * step / 2
        found.append((float(v), float(u)))
    motion = rk.GroundMotion([float(value) for value in values], step=0.25)
    np.testing.assert_allclose(
        np.transpose([motion.velocity, motion.displacement]), found, rtol=1e-13, atol=1e-13
    )


def test_intensity_and_its_duration(fine):
    motion, times, a, *_ = fine
    energy = cumulative_trapezoid(a**2, times, initial=0)
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * G) * energy[-1], rel=1e-4)
    first, last = np.interp([0.05 * energy[-1], 0.95 * energy[-1]], energy[::200], motion.times)
    assert motion.significant_duration == pytest.approx(last - first, rel=1e-3)


@pytest.mark.parametrize(
    "period, damping", [(0.3, 0.05), (1.0, 0.0), (3.0, 0.9), (0.1, 0.05), (0.02, 0.05), (30.0, 0.02)]
)
def test_spectrum_is_that_of_an_integrated_oscillator(fine, period, damping):
    motion = fine[0]
    frequency = 2 * math.pi / period

    def rates(time, state):
        a = np.interp(time, motion.times, motion.acceleration)
        return [state[1], -a - 2 * damping * frequency * state[1] - frequency**2 * state[0]]

    times = np.linspace(0, motion.duration, 100_000)
    run = solve_ivp(
        rates,
        (0, motion.duration),
        [0, 0],
        t_eval=times,
        rtol=1e-9,
        atol=1e-13,
        max_step=min(period / 20, 0.01),
    )
    expected = frequency**2 * np.abs(run.y[0]).max()
    found = motion.response_spectrum(period, damping)
    assert found == pytest.approx(expected, rel=1e-4)


def test_spectrum_of_a_resonant_sine_is_that_of_the_closed_form():
    """Undamped at resonance, u = (sin ωt − ωt cos ωt) / (2ω²), up to the interpolation of the sine."""
    motion = rk.GroundMotion(np.sin(2 * math.pi * np.arange(0, 10.0005, 0.001)), step=0.001)
    assert motion.response_spectrum(1.0, 0.0) == pytest.approx(10 * math.pi, rel=1e-5)


@pytest.mark.parametrize("period", [2 * math.pi * 0.05 / 0.999999, 2 * math.pi * 0.05 / 1.000001])
def test_both_forms_of_the_exact_step_agree(period):
    motion = noise()
    assert motion.response_spectrum(period) == pytest.approx(
        motion.response_spectrum(2 * math.pi * 0.05), rel=1e-5
    )


def test_spectrum_of_short_and_long_periods():
    motion = noise(2_000, 0.005)
    assert motion.response_spectrum(1e-4) == pytest.approx(motion.pga, rel=0.02)
    assert motion.response_spectrum(1e4, 0.0) * (1e4 / (2 * math.pi)) ** 2 == pytest.approx(
        motion.pgd, rel=1e-3
    )


@pytest.mark.parametrize("step, period", [(1e-6, 1e4), (1e-6, 10.0), (1e-3, 1e4), (1e-4, 1e3)])
def test_spectrum_of_an_oscillator_that_does_not_notice_a_step(step, period):
    """At periods far above the duration the displacement is that of the ground; its rise in a step is lost in rounding."""
    motion = noise(3_000, step)
    assert motion.response_spectrum(period, 0.0) * (period / (2 * math.pi)) ** 2 == pytest.approx(
        motion.pgd, rel=1e-3
    )


def test_shape_and_type_of_a_spectrum():
    motion = noise()
    assert type(motion.response_spectrum(1)) is float
    assert type(motion.response_spectrum(np.array(1.0))) is float
    assert motion.response_spectrum([[0.5, 1.0, 2.0]]).shape == (1, 3)
    assert motion.response_spectrum([]).shape == (0,)
    assert motion.scaled(-3).response_spectrum(0.7) == pytest.approx(
        3 * motion.response_spectrum(0.7), rel=1e-13
    )


@pytest.mark.parametrize(
    "arguments", [(0.0,), (-1.0,), (math.nan,), (math.inf,), (1.0, 1.0), (1.0, -0.1), ([1.0, 0.0],)]
)
def test_periods_and_damping_have_ranges(arguments):
    with pytest.raises(ValueError, match=r"^(periods|damping) must lie in \["):
        noise().response_spectrum(*arguments)


@pytest.mark.parametrize("baseline, degree", [("mean", 0), ("linear", 1), ("quadratic", 2)])
def test_baseline_is_the_polynomial_of_least_squares(baseline, degree):
    motion = noise(200, 0.01)
    drift = np.polynomial.Polynomial([0.4, -3.0, 2.0][: degree + 1])
    drifted = rk.GroundMotion(motion.acceleration + drift(motion.times), step=0.01, baseline=baseline)
    fit = np.polyfit(motion.times, motion.acceleration, degree)
    np.testing.assert_allclose(
        drifted.acceleration, motion.acceleration - np.polyval(fit, motion.times), atol=1e-12
    )
    assert f"{baseline} baseline removed" in repr(drifted)
    assert drifted.scaled(2.0).acceleration == pytest.approx(2 * drifted.acceleration)
    assert drifted.clipped(0.5, 1.0).acceleration == pytest.approx(drifted.acceleration[50:101])


def test_baseline_of_one_and_two_samples_is_themselves():
    for samples in ([3.0], [3.0, 4.0]):
        motion = rk.GroundMotion(samples, step=0.1, baseline="quadratic")
        np.testing.assert_allclose(motion.acceleration, 0.0, atol=1e-14)


def test_scaled_reversed_and_clipped():
    motion = noise(name="town", component="90°")
    assert motion.scaled(pga=2.0).pga == pytest.approx(2.0, rel=1e-15)
    assert motion.scaled(2.0).scaled(3.0).factor == 6.0
    np.testing.assert_array_equal(motion.reversed().acceleration, -motion.acceleration)
    assert motion.reversed().reversed() == motion
    assert motion.scaled(2.0)._samples is motion._samples
    assert (motion.scaled(2.0).name, motion.reversed().component) == ("town", "90°")
    part = motion.clipped(0.5, 1.0)
    np.testing.assert_array_equal(part.acceleration, motion.acceleration[10:21])
    assert motion.clipped() == motion
    assert motion.clipped(motion.duration).acceleration.size == 1


@pytest.mark.parametrize(
    "wrong, expected",
    [
        (lambda m: m.scaled(), "give exactly one of factor, pga; got none"),
        (lambda m: m.scaled(1.0, pga=1.0), "give exactly one of factor, pga"),
        (lambda m: m.scaled(math.inf), "factor must be a finite real number"),
        (lambda m: m.scaled(pga=-1.0), "pga must lie in"),
        (
            lambda m: rk.GroundMotion([0.0], step=1.0).scaled(pga=1.0),
            "pga must be 0 for a motion whose acceleration is 0 throughout; got ",
        ),
        (lambda m: m.clipped(2.0, 1.0), "end must leave at least one sample after start = 2 s; got 1.0"),
        (lambda m: m.clipped(0.51, 0.52), "end must leave at least one sample"),
        (lambda m: m.clipped(-1.0), "start must lie in"),
        (lambda m: m.clipped(end=1e3), "end must lie in"),
        (lambda m: rk.GroundMotion([], step=1.0), "acceleration must be 1 to 10,000,000 numbers in a row"),
        (
            lambda m: rk.GroundMotion([[1.0]], step=1.0),
            "acceleration must be 1 to 10,000,000 numbers in a row",
        ),
        (lambda m: rk.GroundMotion([1.0, math.nan], step=1.0), "unlike sample 1; got nan"),
        (lambda m: rk.GroundMotion([2e6], step=1.0), "unlike sample 0; got 2000000.0"),
        (lambda m: rk.GroundMotion(["1"], step=1.0), "acceleration must be a real number or an array"),
        (lambda m: rk.GroundMotion([1.0], step=0.0), "step must lie in"),
        (lambda m: rk.GroundMotion([1.0], step=1.0, name=3), "name must be a str; got 3"),
        (
            lambda m: rk.GroundMotion([1.0], step=1.0, baseline="cubic"),
            "baseline must be one of 'none', 'mean'",
        ),
    ],
)
def test_wrong_arguments(wrong, expected):
    with pytest.raises((TypeError, ValueError), match="^.+$") as caught:
        wrong(noise())
    assert expected in str(caught.value)


def test_a_motion_is_a_frozen_value():
    motion = noise(name="town")
    again = pickle.loads(pickle.dumps(motion.scaled(2.0)))
    assert again == motion.scaled(2.0) != motion
    assert hash(again) == hash(motion.scaled(2.0))
    assert noise(seed=2, name="town") != motion
    for array in (motion.acceleration, again.acceleration, motion.scaled(2.0).acceleration):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    with pytest.raises(AttributeError):
        motion.step = 1.0
    given = np.ones(3)
    kept = rk.GroundMotion(given, step=1.0)
    given[0] = 5.0
    assert kept.pga == 1.0


def test_repr_names_motion_component_and_peak():
    assert repr(noise(3, 0.1, name="town", component="90°")).startswith(
        "GroundMotion(town, 90°, 3 samples, step 0.1 s, PGA "
    )
    assert repr(rk.GroundMotion([1.0], step=2.0)) == "GroundMotion(1 samples, step 2 s, PGA 1 m/s²)"


@pytest.mark.parametrize(
    "samples",
    [[0.0], [2.0], [0.0] * 1_000, [0.0] * 500 + [2.0] + [0.0] * 499],
    ids=["0", "1", "rest", "spike"],
)
def test_degenerate_motions(samples):
    motion = rk.GroundMotion(samples, step=0.01)
    moving = len(samples) > 1 and any(samples)
    assert motion.pga == max(samples)
    assert motion.pgv == pytest.approx(0.02 * moving)
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * G) * moving * 4 * 0.02 / 3)
    assert motion.significant_duration == pytest.approx(0.9 * 0.02 * moving, abs=1e-12)
    assert (motion.response_spectrum(1.0) > 0) == moving
    assert motion.pgd == pytest.approx(moving * 0.02 * (motion.duration - 5.0), rel=1e-3)


@pytest.mark.timeout(60)
@pytest.mark.long
def test_ten_million_samples_are_quick():
    a = np.random.default_rng(1).normal(size=10_000_000)
    motion = rk.GroundMotion(a, step=0.01, baseline="mean")
    assert motion.pga == pytest.approx(np.abs(a - a.mean()).max())
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * G) * 2 / 3 * 1e5, rel=0.01)
    assert motion.response_spectrum(1.0) > 0
    assert motion.scaled(2.0).pgv > 0


SHAKEN = rk.synthetic_ground_motions(1, seed=3, duration=59.99)[0].acceleration
PLACES = np.linspace(-1.0, 1.0, SHAKEN.size)


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        (0.0 * PLACES, ""),
        (0.05 + 0.0 * PLACES, "no baseline is removed and the velocity at the end is 100 % of the PGV"),
        (0.5 * PLACES, "no baseline is removed and the mean velocity is 91 % of its root mean square"),
        (0.02 * PLACES, "no baseline is removed and PGA PGD/PGV² is 1"),
    ],
)
def test_motion_drifts_if_the_ground_does_not_come_to_rest_or_moves_too_far(wrong, reason):
    motion = rk.GroundMotion(SHAKEN + wrong, step=0.01)
    assert reason in motion.drift_doubt
    assert bool(motion.drift_doubt) == bool(motion.scaled(-3.0).drift_doubt) == bool(reason)
    assert motion.drift_doubt.endswith(
        "use a corrected record, or for example baseline='linear'" * bool(reason)
    )
    assert rk.GroundMotion(SHAKEN + wrong, step=0.01, baseline="linear").drift_doubt == ""


def test_drift_that_a_baseline_leaves_needs_a_higher_degree_or_a_corrected_record():
    # The zero of the instrument shifts four times.
    wrong = SHAKEN + 0.1 * (np.abs(PLACES) < 0.1) - 0.1 * (np.abs(PLACES - 0.5) < 0.1)
    for baseline, remedy in (
        ("linear", "for example baseline='quadratic'"),
        ("quadratic", "use a corrected record"),
    ):
        doubt = rk.GroundMotion(wrong, step=0.01, baseline=baseline).drift_doubt
        assert f"a {baseline} baseline is removed" in doubt
        assert doubt.endswith(remedy)
    assert not rk.GroundMotion([0.0, 0.0], step=0.01).drift_doubt
