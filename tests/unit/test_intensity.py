"""Intensity measures, and the quantities of a survey of ground motions: each wrong value is one line."""

import math
import re

import numpy as np
import pytest
from scipy.linalg import expm

import rocking as rk
from rocking.model.record_set import INTENSITIES, intensity_of, measure_named
from rocking.survey.spec import motion_spec

GRAVITY = 9.80665
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
