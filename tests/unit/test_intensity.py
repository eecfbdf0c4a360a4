"""Intensities of ground motions against independent formulas, and the quantities of a survey: each wrong value is one line."""

import math
import re
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import rocking as rk
from rocking.model.record_set import INTENSITIES, intensity_of, measure_named
from rocking.survey.spec import motion_spec

GRAVITY = 9.80665
WTMC = Path(__file__).parents[3] / "shared" / "records" / "20161113_110259_WTMC_20.V2A"
MOTIONS = [
    rk.GroundMotion([0.0, 3.0, -2.0, 1.0, 0.0], step=0.1, name="a"),
    rk.GroundMotion([0.0, -1.0, 0.5, 0.0], step=0.05, name="b", factor=-2.0),
]
RECORDS = rk.RecordSet(MOTIONS, columns={"magnitude": [6.0, 7.0], "gap": [1.0, np.nan]})
BLOCK = rk.Block(height=2.0, width=0.5)
ALPHA, ANGLE = BLOCK.frequency_parameter, BLOCK.critical_angle
GIVEN = {
    "size": 1.0,
    "slenderness": 0.2,
    "restitution": None,
    "angle": 0.0,
    "polarity": 1.0,
    "level": [1.0, 2.0],
}

VALUES = {
    "scale": lambda motion: motion.factor / motion.factor,
    "pga": lambda motion: np.abs(motion.acceleration).max(),
    "pga-g": lambda motion: np.abs(motion.acceleration).max() / GRAVITY,
    "pgv": lambda motion: fine(motion)[1],
    "pgd": lambda motion: fine(motion)[2],
    "arias": lambda motion: np.pi / (2 * GRAVITY) * fine(motion)[0],
    "cav": lambda motion: fine(motion)[3],
    "sa(0.3)": lambda motion: largest_response(motion, 0.3, 0.05),
    "sa(0.3, 0.2)": lambda motion: largest_response(motion, 0.3, 0.2),
    "sa-avg(0.2, 0.3)": lambda motion: math.sqrt(
        largest_response(motion, 0.2, 0.05) * largest_response(motion, 0.3, 0.05)
    ),
    "pga-ratio": lambda motion: np.abs(motion.acceleration).max() / (GRAVITY * np.tan(ANGLE)),
    "pgv-ratio": lambda motion: ALPHA * fine(motion)[1] / (GRAVITY * np.tan(ANGLE)),
}


def fine(motion, parts=2000):
    """∫a² dt, PGV and the largest |displacement| at the samples, by trapezia on a fine grid."""
    n = motion.acceleration.size
    times = np.linspace(0.0, motion.duration, parts * (n - 1) + 1)
    a = np.interp(times, motion.times, motion.acceleration)
    step = times[1]
    v = np.concatenate(([0.0], np.cumsum((a[1:] + a[:-1]) * step / 2)))
    d = np.concatenate(([0.0], np.cumsum((v[1:] + v[:-1]) * step / 2)))
    square = a * a
    modulus = np.abs(a)
    return (
        np.sum((square[1:] + square[:-1]) * step / 2),
        np.abs(v).max(),
        np.abs(d[::parts]).max(),
        np.sum((modulus[1:] + modulus[:-1]) * step / 2),
    )


def largest_response(motion, period, damping):
    """ω² max|u| on a fine grid, by the matrix exponential of (u, u', a, a') over each of its steps."""
    w, step = 2 * np.pi / period, motion.step / 2000
    a = np.interp(
        step * np.arange(2000 * (motion.acceleration.size - 1) + 1), motion.times, motion.acceleration
    )
    rates = np.zeros((4, 4))
    rates[0, 1], rates[1], rates[2, 3] = 1.0, [-w * w, -2 * damping * w, -1.0, 0.0], 1.0
    advance = expm(rates * step)
    state, largest = np.zeros(2), 0.0
    for first, slope in zip(a[:-1], np.diff(a) / step, strict=True):
        state = (advance @ [*state, first, slope])[:2]
        largest = max(largest, w * w * abs(state[0]))
    return largest


def test_each_measure_has_a_definition_here():
    assert set(INTENSITIES) < set(VALUES)


@pytest.mark.parametrize("name", VALUES)
def test_measure_is_that_of_its_definition(name):
    measure, values = intensity_of(name, RECORDS)
    found = measure.level(1.0, values, ALPHA, ANGLE)
    # Trapezia of a(t)² and v(t) are wrong by (step/parts)²/12 times second derivatives of order 1e3, peaks of Sa by 1e-4.
    tolerance = 1e-4 if name.startswith("sa") else 1e-5
    assert found == pytest.approx([VALUES[name](motion) for motion in MOTIONS], rel=tolerance)


@pytest.mark.parametrize("name", [*VALUES, "magnitude"])
@pytest.mark.parametrize("level", [0.3, 4.0])
def test_factor_scales_each_motion_to_the_level(name, level):
    measure, values = intensity_of(name, RECORDS)
    factors = measure.factor(level, values, ALPHA, ANGLE)
    assert measure.level(factors, values, ALPHA, ANGLE) == pytest.approx(level, rel=1e-14)
    scaled = rk.RecordSet([motion.scaled(factor) for motion, factor in zip(MOTIONS, factors, strict=True)])
    if name not in ("scale", "magnitude"):
        found, new = intensity_of(name, scaled)
        assert found.level(1.0, new, ALPHA, ANGLE) == pytest.approx([level] * 2, rel=1e-12)


@pytest.mark.parametrize(
    ("records", "name", "error", "message"),
    [
        (RECORDS, "pgx", ValueError, "intensity must be one of 'scale', 'pga', "),
        (RECORDS, 3, TypeError, "intensity must be one of 'scale', 'pga', "),
        (
            RECORDS,
            "sa(x)",
            ValueError,
            "intensity must have the form sa(PERIOD) or sa(PERIOD, DAMPING) or sa",
        ),
        (
            RECORDS,
            "sa(1,.1,2)",
            ValueError,
            "intensity must have the form sa(PERIOD) or sa(PERIOD, DAMPING) or ",
        ),
        (
            RECORDS,
            "sa-avg()",
            ValueError,
            "intensity must have the form sa(PERIOD) or sa(PERIOD, DAMPING) or sa",
        ),
        (
            RECORDS,
            "sa(0)",
            ValueError,
            "the period of intensity 'sa(0)' must lie in [0.0001, 10000] s; got 0",
        ),
        (
            RECORDS,
            "sa(nan)",
            ValueError,
            "the period of intensity 'sa(nan)' must lie in [0.0001, 10000] s; got",
        ),
        (
            RECORDS,
            "sa(1,1)",
            ValueError,
            "the damping of intensity 'sa(1, 1)' must lie in [0, 0.99]; got 1.0",
        ),
        (
            RECORDS,
            "gap",
            ValueError,
            "intensity 'gap' must be positive for each record, unlike for 'b'; got nan",
        ),
        (
            rk.RecordSet([MOTIONS[0], rk.GroundMotion([0.0, 0.0], step=0.1)]),
            "pgv",
            ValueError,
            "intensity 'pgv' must be positive for each record, unlike for 'record 2'; got 0.0",
        ),
        (
            rk.RecordSet(MOTIONS[0].scaled(0.0)),
            "pga",
            ValueError,
            "intensity 'pga' must be positive for each record, unlike for 'a'; got 0.0",
        ),
        (
            rk.RecordSet(MOTIONS[0], columns={"magnitude": [-1.0]}),
            "magnitude",
            ValueError,
            "intensity 'magnitude' must be positive for each record, unlike for 'a'; got -1.0",
        ),
        (
            rk.RecordSet(MOTIONS[0], columns={"sa(1)": [0.3]}),
            "sa(1)",
            ValueError,
            "intensity must name either a measure or a column of the records, not both; got 'sa(1)'",
        ),
        (
            rk.RecordSet(MOTIONS[0], columns={"pga": [0.3]}),
            "pga",
            ValueError,
            "intensity must name either a measure or a column of the records, not both; got 'pga' (rename the column)",
        ),
    ],
)
def test_intensity_that_a_record_lacks_is_one_line(records, name, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}") as caught:
        intensity_of(name, records)
    assert "\n" not in str(caught.value)


def test_choices_of_an_intensity_include_the_columns():
    with pytest.raises(ValueError, match=r"'pgv-ratio', 'sa\(PERIOD\)', .*, 'magnitude', 'gap'; got 'x'$"):
        intensity_of("x", RECORDS)


@pytest.mark.parametrize("typed, name", [("sa( .50 )", "sa(0.5)"), ("sa-avg(1,2.0)", "sa-avg(1, 2)")])
def test_spectral_measure_has_one_name(typed, name):
    assert measure_named(typed)[0].name == name


def test_question_keeps_axes_numbers_and_records():
    spec = motion_spec(RECORDS, GIVEN, intensity="pga", model="slender")
    assert {name: values.tolist() for name, values in spec.axes.items()} == {
        "record": [0.0, 1.0],
        "level": [1.0, 2.0],
    }
    assert spec.fixed == {
        "size": 1.0,
        "slenderness": 0.2,
        "angle": 0.0,
        "polarity": 1.0,
        "inertia_ratio": 4 / 3,
    }
    assert spec.digest == RECORDS.digest
    alone = motion_spec(rk.RecordSet(MOTIONS[0]), GIVEN, intensity="pga", model="slender")
    assert list(alone.axes) == ["level"]
    part = spec.with_axes({"record": np.array([1.0]), "level": np.array([2.0])})
    assert part.motions == {1: MOTIONS[1]}


def test_runs_at_points_are_those_of_scaled_motions_and_blocks():
    spec = motion_spec(
        RECORDS, GIVEN | {"polarity": [-1.0, 1.0]}, intensity="arias", model="slender", normalised_by="angle"
    )
    points = np.meshgrid(*spec.axes.values(), indexing="ij")
    values = {name: each.ravel() for name, each in zip(spec.axes, points, strict=True)}
    runs = spec.inputs(values)
    for place, number in enumerate(values["record"].astype(int)):
        motion = MOTIONS[number]
        factor = values["polarity"][place] * np.sqrt(values["level"][place] / motion.arias_intensity)
        assert runs.factor[place] * GRAVITY * 0.2 == pytest.approx(factor, rel=1e-14)
        assert runs.restitution[place] == 1 - 1.5 * np.sin(0.2) ** 2
        assert runs.frequency_parameter[place] == np.sqrt(3 * GRAVITY / 4)


REFUSED = {
    "no size": ({"size": None}, {}, TypeError, "size must be a real number in [0.001, 1000]; got None"),
    "size 0": ({"size": 0.0}, {}, ValueError, "size must lie in [0.001, 1000]; got 0.0"),
    "text": (
        {"size": "1:2:3"},
        {},
        TypeError,
        "size must be a real number in [0.001, 1000] or an array; got '1:2:3' (an",
    ),
    "no slenderness": (
        {"slenderness": None},
        {},
        TypeError,
        "slenderness must be a real number in [0.0001, 1.57]; got None",
    ),
    "squat": (
        {"slenderness": 1.0},
        {},
        ValueError,
        "slenderness must be a critical angle in rad for which Housner's restitution is not negative; got 1.0 (or",
    ),
    "squat at the end": (
        {"slenderness": [0.2, 1.2]},
        {},
        ValueError,
        "slenderness must be a critical angle in rad for",
    ),
    "polarity 0.5": (
        {"polarity": 0.5},
        {},
        ValueError,
        'polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got 0.5',
    ),
    "polarity 2": (
        {"polarity": 2},
        {},
        ValueError,
        'polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got 2',
    ),
    "no polarity": (
        {"polarity": None},
        {},
        TypeError,
        'polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got None',
    ),
    "polarity 0": (
        {"polarity": [-1.0, 0.0, 1.0]},
        {},
        ValueError,
        'polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got [-1.0, 0.0, 1.0]',
    ),
    "scale 0": ({"level": 0.0}, {}, ValueError, "levels must lie in [1e-09, 1e+06]; got 0.0"),
    "negative scale": (
        {"level": [-1.0, 1.0]},
        {},
        ValueError,
        "levels must hold two numbers or more in [1e-09, 1e+06], asc",
    ),
    "descending": (
        {"level": [2.0, 1.0]},
        {},
        ValueError,
        "levels must hold two numbers or more in [1e-09, 1e+06], asc",
    ),
    "restitution": ({"restitution": 1.1}, {}, ValueError, "restitution must lie in [0, 1]; got 1.1"),
    "inertia": ({}, {"inertia_ratio": 0.5}, ValueError, "inertia_ratio must lie in "),
    "intensity": (
        {},
        {"intensity": "gap"},
        ValueError,
        "intensity 'gap' must be positive for each record, unlike for 'b'",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_quantity_that_no_survey_can_have_is_refused_in_one_line(case):
    change, more, error, message = REFUSED[case]
    with pytest.raises(error, match=f"^{re.escape(message)}") as caught:
        motion_spec(RECORDS, GIVEN | change, **({"intensity": "scale"} | more), model="slender")
    assert "\n" not in str(caught.value)


def test_squat_block_with_a_restitution_of_its_own_is_a_block():
    assert (
        motion_spec(
            RECORDS, GIVEN | {"slenderness": 1.2, "restitution": 0.3}, intensity="scale", model="slender"
        ).fixed["restitution"]
        == 0.3
    )


def noise(seed, samples=60, step=0.05):
    return rk.GroundMotion(np.random.default_rng(seed).normal(size=samples), step=step)


def test_cav_is_exact_in_rational_numbers():
    values = [Fraction(k * k % 11 - 5, 2) for k in range(30)]
    step, total = Fraction(1, 8), Fraction(0)
    for first, second in pairwise(values):
        if first * second < 0:  # two triangles on both sides of the zero
            zero = first / (first - second)
            total += (abs(first) * zero + abs(second) * (1 - zero)) * step / 2
        else:
            total += abs(first + second) * step / 2
    motion = rk.GroundMotion([float(value) for value in values], step=0.125)
    assert motion.cav == pytest.approx(float(total), rel=1e-14)
    assert motion.scaled(-3.0).cav == pytest.approx(3.0 * motion.cav, rel=1e-14)


def test_cav_is_at_least_the_velocity_and_equal_for_one_push():
    push = rk.GroundMotion([0.0, 2.0, 0.5, 0.0], step=0.1)
    assert push.cav == pytest.approx(push.pgv, rel=1e-14)
    assert noise(3).cav > noise(3).pgv


@pytest.mark.parametrize("threshold", [0.05, 0.7, 1.5, 2.0])
def test_bracketed_duration_is_that_on_a_fine_grid(threshold):
    motion = noise(2)
    times = np.linspace(0, motion.duration, 1_000_000)
    strong = times[np.abs(np.interp(times, motion.times, motion.acceleration)) >= threshold]
    expected = strong[-1] - strong[0] if strong.size else 0.0
    assert motion.bracketed_duration(threshold) == pytest.approx(expected, abs=2 * times[1])


def test_bracketed_duration_of_simple_motions():
    triangle = rk.GroundMotion([0.0, 1.0, 0.0], step=1.0)
    assert triangle.bracketed_duration(0.25) == pytest.approx(1.5)
    assert triangle.bracketed_duration(1.0) == 0.0
    assert triangle.bracketed_duration(2.0) == 0.0
    assert triangle.bracketed_duration() == pytest.approx(2 * (1 - 0.05 * GRAVITY))
    assert rk.GroundMotion([2.0, -2.0], step=1.0).bracketed_duration(1.0) == 1.0
    assert rk.GroundMotion([0.0], step=1.0).bracketed_duration() == 0.0


@pytest.mark.parametrize("threshold", [0.0, -1.0, math.nan, math.inf, "g", None])
def test_threshold_has_a_range(threshold):
    with pytest.raises(ValueError, match=r"^threshold must "):
        noise(1).bracketed_duration(threshold)


def test_ratio_of_peaks():
    assert noise(4).pgv_to_pga == noise(4).pgv / noise(4).pga
    assert math.isnan(rk.GroundMotion([0.0, 0.0], step=0.1).pgv_to_pga)


def integrated(motions, period, damping):
    """ω² u of each motion at many times, by a general solver of differential equations."""
    w = 2 * math.pi / period
    rows = []
    for motion in motions:

        def rates(time, state, motion=motion):
            a = np.interp(time, motion.times, motion.acceleration)
            return [state[1], -a - 2 * damping * w * state[1] - w * w * state[0]]

        run = solve_ivp(
            rates,
            (0, motion.duration),
            [0, 0],
            t_eval=np.linspace(0, motion.duration, 5_000),
            rtol=1e-9,
            atol=1e-13,
            max_step=motion.step / 4,
        )
        rows.append(w * w * run.y[0])
    return np.array(rows)


@pytest.mark.parametrize("period, damping", [(0.3, 0.05), (1.0, 0.2), (2.5, 0.0)])
def test_rotated_spectra_are_percentiles_of_integrated_oscillators(period, damping):
    pair = noise(5), noise(6)
    x, y = integrated(pair, period, damping)
    turned = [
        np.abs(x * math.cos(angle) + y * math.sin(angle)).max()
        for angle in (math.radians(degree) for degree in range(180))
    ]
    ordered = sorted(turned)
    for percentile, expected in ((0, ordered[0]), (50, (ordered[89] + ordered[90]) / 2), (100, ordered[-1])):
        found = pair[0].rotated_spectrum(pair[1], period, damping, percentile=percentile)
        assert found == pytest.approx(expected, rel=1e-4)


def test_rotated_oscillator_is_that_of_the_rotated_motion():
    """The oscillator is linear: each of the 180 numbers is an ordinary spectrum, so RotD100 is their maximum."""
    first, second = noise(7, 200), noise(8, 200)
    turned = [
        rk.GroundMotion(
            math.cos(angle) * first.acceleration + math.sin(angle) * second.acceleration, step=first.step
        ).response_spectrum(0.7)
        for angle in np.radians(np.arange(180))
    ]
    assert first.rotated_spectrum(second, 0.7, percentile=100) == pytest.approx(max(turned), rel=1e-12)
    assert first.rotated_spectrum(second, 0.7) == pytest.approx(np.median(turned), rel=1e-12)


def test_rotated_spectra_of_simple_pairs():
    motion, still = noise(9), rk.GroundMotion(np.zeros(60), step=0.05)
    periods = np.array([[0.2, 0.5], [1.0, 2.0]])
    alone = motion.response_spectrum(periods)
    # of the 180 numbers |cos φ|, the mean of the two in the middle
    half = np.median(np.abs(np.cos(np.radians(np.arange(180)))))
    np.testing.assert_allclose(motion.rotated_spectrum(still, periods, percentile=100), alone, rtol=1e-12)
    np.testing.assert_allclose(motion.rotated_spectrum(still, periods), half * alone, rtol=1e-12)
    np.testing.assert_allclose(
        motion.rotated_spectrum(motion, periods, percentile=100), math.sqrt(2) * alone, rtol=1e-12
    )
    assert type(motion.rotated_spectrum(still, 1.0)) is float
    other = noise(10)
    np.testing.assert_allclose(
        motion.rotated_spectrum(other, 0.5),
        other.rotated_spectrum(motion, 0.5),
        rtol=1e-12,  # the same line, turned
    )


@pytest.mark.parametrize(
    "other, options, message",
    [
        (
            noise(1, 50),
            {},
            "other must have 60 samples with a step of 0.05 s, as the first component; got 50 s",
        ),
        (
            noise(1, step=0.1),
            {},
            "other must have 60 samples with a step of 0.05 s, as the first component; ",
        ),
        (noise(1).acceleration, {}, "other must be a GroundMotion"),
        (noise(1), {"percentile": 101}, r"percentile must lie in \[0, 100\]"),
        (noise(1), {"percentile": math.nan}, r"percentile must lie in \[0, 100\]"),
        (noise(1), {"damping": 1.0}, "damping must lie in"),
        (noise(1), {"periods": [1.0, 0.0]}, "periods must lie in"),
    ],
)
def test_pair_that_has_no_rotated_spectrum_is_refused(other, options, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        noise(1).rotated_spectrum(other, **({"periods": 1.0} | options))


def test_average_spectrum_is_the_geometric_mean():
    motion, periods = noise(11), [0.3, 0.6, 1.2, 2.4]
    product = math.prod(float(motion.response_spectrum(period, 0.1)) for period in periods)
    assert motion.average_spectrum(periods, 0.1) == pytest.approx(product**0.25, rel=1e-12)
    assert type(motion.average_spectrum(0.3)) is float
    assert rk.GroundMotion([0.0, 0.0], step=0.1).average_spectrum([1.0, 2.0]) == 0.0
    with pytest.raises(ValueError, match="^periods must hold one period at least"):
        motion.average_spectrum([])


@pytest.mark.skipif(not WTMC.exists(), reason="file absent")
def test_rotated_spectrum_of_a_recorded_pair_lies_between_those_of_its_components():
    pair = [each for each in rk.read_ground_motions(WTMC) if not each.vertical]
    periods = np.array([0.2, 0.5, 1.0, 2.0])
    of_each = np.array([each.response_spectrum(periods) for each in pair])
    most, median, least = (
        pair[0].rotated_spectrum(pair[1], periods, percentile=percentile) for percentile in (100, 50, 0)
    )
    assert (most >= of_each.max(axis=0) * (1 - 1e-12)).all()
    assert (least <= of_each.min(axis=0) * (1 + 1e-12)).all()
    # RotD100/RotD50 lies between 1, of a circle, and √2, of a line
    assert ((most / median > 1.0) & (most / median < math.sqrt(2))).all()
