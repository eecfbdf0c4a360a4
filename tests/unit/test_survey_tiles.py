"""Tiles: the result of a point depends on no other point, and the work is that of the points."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.survey import attractors, ending_measures, measurement, verdict_measures
from rocking.survey.attractors import classify_with_anchor
from rocking.survey.measurement import Batch, batches, compute
from rocking.survey.repeatability import agreement
from rocking.survey.spec import HarmonicSpec, motion_spec, pulse_spec
from rocking.survey.tiling import levels
from rocking.survey.verdict_measures import classify_points, response

MEASURE = response(200, 64, "A map")
AXES = {"amplitude": np.linspace(0.0, 16.0, 24), "period": np.linspace(0.2, 3.0, 24)}
NO_STOP = np.zeros(1, np.int64)


def answered(wanted, fixed):
    batch = Batch(HarmonicSpec(AXES, fixed), np.asarray(wanted, np.int32), MEASURE.function, MEASURE.options)
    return compute(batch, NO_STOP)


@pytest.mark.parametrize(
    "fixed", [{"restitution": 0.9}, {"restitution": 1.0}, {"restitution": 0.9, "brace_angle": 1.0}]
)
def test_what_is_said_of_a_point_depends_on_nobody_beside_it(fixed):
    """Results are bit-identical whichever points are classified together, in any order, or each alone."""
    whole = answered(range(24**2), fixed)
    order = np.random.default_rng(2).permutation(24**2)
    for wanted in (order, order[:100], order[-1:], *order[:20, None]):
        part = answered(wanted, fixed)
        for name, values in part.items():
            assert values.tobytes() == whole[name][wanted].tobytes(), name


@pytest.mark.parametrize("points", [50, 100, 199])
def test_the_work_of_a_survey_is_its_points_each_once(points, monkeypatch):
    monkeypatch.setattr(measurement, "BATCH", 500)
    axes = {"amplitude": np.linspace(0.0, 16.0, points), "period": np.linspace(0.2, 3.0, points)}
    asked = HarmonicSpec(axes, {"restitution": 0.9})
    met, pieces, needed = np.zeros((points, points), int), 0, 0
    for level in levels(asked):
        step = (points - 1) // (level.shape[0] - 1)
        for tile in level.tiles():
            wanted = np.flatnonzero(tile.own(np.ones(tile.shape, bool)))
            needed += math.ceil(wanted.size / 500)
            for batch in batches(tile, asked, wanted, MEASURE):
                pieces += 1
                assert batch.wanted.size <= 500
                rows, columns = np.unravel_index(batch.wanted, tile.shape)
                met[(rows + tile.region[0].start) * step, (columns + tile.region[1].start) * step] += 1
    assert (met == 1).all()
    assert pieces == needed


BUDGET = {"max_cycles": 100, "max_period": 8}
NONE = np.empty(0)
FIXED = {"restitution": 0.9}
HARMONIC = HarmonicSpec(AXES, FIXED).inputs({"amplitude": NONE, "period": NONE})
MOTIONS = motion_spec(
    rk.RecordSet(rk.synthetic_ground_motions(1, seed=1)),
    {"size": np.array([1.0, 2.0]), "slenderness": 0.2, "angle": 0.0, "polarity": 1.0, "level": 1.0},
    intensity="scale",
    model="slender",
).inputs({"size": NONE})
EMPTY = {
    "map": (response(100, 8, "A map"), HARMONIC),
    "basins": (attractors.destination(100, 8, "Basins"), HARMONIC),
    "kinds": (verdict_measures.outcome(100, 8, "Kinds"), HARMONIC),
    "ground motions": (ending_measures.ending("Endings"), MOTIONS),
    **{
        name: (
            ending_measures.pulse_ending("Pulses"),
            pulse_spec(
                rk.System(rk.Pulse(name, amplitude=1.0, duration=1.0), 0.9),
                {"amplitude": AXES["amplitude"], "frequency": AXES["period"]},
            ).inputs({"amplitude": NONE, "frequency": NONE}),
        )
        for name in ("one-sine", "triangular")
    },
}


@pytest.mark.parametrize("name", EMPTY)
def test_batch_without_points_has_empty_results(name):
    measure, inputs = EMPTY[name]
    found = measure.function(inputs, measure.options, NO_STOP)
    assert set(found) == {each.name for each in measure.variables}
    assert {values.shape for values in found.values()} == {(0,)}


def test_repeatability_of_no_points_is_empty():
    found = agreement(HARMONIC, BUDGET | {"samples": 2, "relative_millionths": 1}, NO_STOP)
    assert {values.shape for values in found.values()} == {(0,)}


@pytest.mark.parametrize("classified", [classify_points, classify_with_anchor])
def test_no_points_are_classified_without_an_error(classified):
    found = classified({"amplitude": NONE, "period": NONE}, FIXED, 100, 8, NO_STOP)
    assert {values.shape for values in found.values()} == {(0,)}
