"""Incremental dynamic analysis and sensitivity: runs as simulated one by one, and fractiles over the records."""

import math
import re

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.model.block_formulas import GRAVITY

BLOCK = rk.Block(2.0, 0.5)
LEVELS = np.linspace(2.0, 8.0, 7)


@pytest.fixture(scope="module")
def records():
    return rk.synthetic_ground_motions(10, seed=1)


@pytest.fixture(scope="module")
def found(records):
    return rk.incremental_dynamic_analysis(records, BLOCK, LEVELS, intensity="pga", model="slender")


def test_peaks_are_those_of_single_simulations(records, found):
    fell = 0
    for number, record in enumerate(records):
        for place, level in enumerate(LEVELS):
            motion = rk.simulate(BLOCK.system(record.scaled(pga=level), model="slender"))
            run = found.dataset.isel(record=number, level=place)
            assert motion.certified
            assert int(run.certified)
            over = motion.outcome == "overturned"
            fell += over
            assert float(run.peak) == pytest.approx(math.inf if over else motion.peak, rel=1e-6, abs=1e-9)
    assert 10 < fell < 60


@pytest.mark.parametrize("angle, polarity", [(0.3, 1.0), (0.0, -1.0)])
def test_start_and_direction_are_those_of_simulate(records, angle, polarity):
    data = rk.incremental_dynamic_analysis(
        records[:4],
        BLOCK,
        [0.5, 1.0],
        angle=angle,
        polarity=polarity,
        model="slender",
    ).dataset
    for number, record in enumerate(records[:4]):
        for place, factor in enumerate((0.5, 1.0)):
            motion = rk.simulate(
                BLOCK.system(record.scaled(factor * polarity), model="slender"), rk.State(angle=angle)
            )
            peak = math.inf if motion.outcome == "overturned" else motion.peak
            assert float(data.peak[number, place]) == pytest.approx(peak, rel=1e-6)


def test_fractiles_are_ranks_over_the_records(found):
    peaks = np.sort(found.dataset.peak.values, axis=0)
    fractiles = found.fractiles((0.16, 0.5, 0.84, 1.0))
    for number, rank in enumerate((2, 5, 9, 10)):
        assert fractiles.values[number].tolist() == peaks[rank - 1].tolist()
    assert np.isinf(fractiles.values[1]).any()
    assert fractiles.fractile.values.tolist() == [0.16, 0.5, 0.84, 1.0]
    assert found.fractiles(0.1).values[0].tolist() == peaks[0].tolist()


def test_fractiles_take_ranks_without_rounding():
    """0.07 · 100 is above 7 in double precision."""
    records = rk.synthetic_ground_motions(100, seed=2, duration=5.0)
    found = rk.incremental_dynamic_analysis(records, BLOCK, [3.0, 4.0], intensity="pga", model="slender")
    assert found.fractiles(0.07).values[0].tolist() == np.sort(found.dataset.peak.values, axis=0)[6].tolist()


def test_scatter_is_half_the_logarithm_of_the_ratio_of_fractiles(found):
    low, high = found.fractiles((0.16, 0.84)).values
    for value, below, above in zip(found.scatter.values, low, high, strict=True):
        if below == 0.0 or math.isinf(below):
            assert math.isnan(value)
        elif math.isinf(above):
            assert math.isinf(value)
        else:
            assert value == pytest.approx(0.5 * (math.log(above) - math.log(below)))
    assert np.isfinite(found.scatter.values).any()
    assert np.isinf(found.scatter.values).any()
    assert np.isnan(found.scatter.values).any()


def test_one_record_is_a_set_of_one():
    found = rk.incremental_dynamic_analysis(rk.example_ground_motion(), BLOCK, [1.0, 10.0], model="slender")
    assert found.dataset.peak.dims == ("record", "level")
    assert found.dataset.name.values.tolist() == ["San Francisco, 1295 Shafter, F, 360°"]
    assert found.fractiles(0.5).values.tolist() == found.dataset.peak.values.tolist()


def test_one_line_says_how_many_overturn_and_where(found):
    data = found.dataset
    median = np.isinf(np.sort(data.peak.values, axis=0)[4])
    fell = int(np.isinf(data.peak.values).any(axis=1).sum())
    assert str(found) == (
        f"{fell} of 10 records overturn the block, half of them overturn the block at PGA = {LEVELS[median][0]:.4g} m/s²; "
        "10 records, 7 levels, 70 runs"
    )


@pytest.mark.parametrize("of", [0.0, 1.1, [], [[0.5]]])
def test_fractiles_of_no_fraction_are_refused(found, of):
    with pytest.raises(ValueError, match=re.escape("of must hold fractions in (0, 1]")):
        found.fractiles(of)


def overturns(motion, restitution):
    return (
        rk.simulate(rk.Block(2.0, 0.5, restitution).system(motion, model="slender")).outcome == "overturned"
    )


def test_changes_are_those_of_single_simulations(records):
    found = rk.sensitivity(records[:5], BLOCK, LEVELS, intensity="pga", model="slender").dataset
    e = BLOCK.restitution
    for number, record in enumerate(records[:5]):
        for place, level in enumerate(LEVELS):
            motion = record.scaled(pga=level)
            middle = 0.5 * (motion.acceleration[1:] + motion.acceleration[:-1])
            plain = overturns(motion, e)
            changed = (
                overturns(motion.scaled(1.01), e),
                overturns(motion.scaled(0.99), e),
                overturns(rk.GroundMotion(middle, step=motion.step), e),
                overturns(motion, e + 0.02),
                overturns(motion, e - 0.02),
            )
            assert bool(found.overturned[number, place]) == plain
            assert found.differs.values[number, place].tolist() == [each != plain for each in changed]
    assert found.flipped.values.tolist() == found.differs.values.sum(axis=(0, 1)).tolist()
    assert found.flipped.values.max() > 0
    assert found.share.values == pytest.approx(found.flipped.values / 35)
    assert (found.share_low <= found.share).all()
    assert (found.share <= found.share_high).all()
    assert found.runs.values.tolist() == [35] * 5


def test_change_of_an_energy_is_that_of_the_amplitude(records):
    """The Arias intensity grows with the square of the amplitude."""
    arias = [record.arias_intensity for record in records[:1]]
    by_energy = rk.sensitivity(
        records[:1], BLOCK, np.array([1.0, 4.0]) * arias[0], intensity="arias", model="slender"
    )
    by_factor = rk.sensitivity(records[:1], BLOCK, [1.0, 2.0], model="slender")
    assert np.array_equal(by_energy.dataset.differs.values, by_factor.dataset.differs.values)
    assert np.array_equal(by_energy.dataset.overturned.values, by_factor.dataset.overturned.values)


def test_where_nothing_changes_the_interval_is_that_of_all_records(records):
    found = rk.sensitivity(records, BLOCK, [0.1, 0.2], model="slender")
    z2 = 1.959963984540054**2
    assert found.dataset.share_high.values == pytest.approx(z2 / (10 + z2))
    assert str(found).startswith(
        "verdicts that change, of 20 runs of 10 records: amplitude + 1 % 0 % (0–27.8 %), "
    )
    assert "\n" not in str(found)


def test_sensitivity_refuses_what_it_cannot_change(records):
    with pytest.raises(
        ValueError, match=re.escape("block must have a restitution in [0.02, 0.98]; got 0.99")
    ):
        rk.sensitivity(records[:2], rk.Block(2.0, 0.5, 0.99), LEVELS, intensity="pga", model="slender")
    short = rk.GroundMotion([GRAVITY], step=0.1, name="short")
    with pytest.raises(ValueError, match="records must have two samples at least"):
        rk.sensitivity([short], BLOCK, LEVELS, intensity="pga", model="slender")
    with pytest.raises(ValueError, match="records must hold independent motions"):
        rk.sensitivity(
            [records[0], attrs.evolve(records[0], name="copy")],
            BLOCK,
            LEVELS,
            intensity="pga",
            model="slender",
        )
