"""Overturning sets: switches of closed forms, brute force, 60 digits, and what a grid may miss."""

import math
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import rocking as rk
from oracles.record_runs import Case, exact
from rocking.model.record_results import SWITCH_ROW, intervals_of

BLOCK = rk.Block(height=2.0, width=0.5)
UNIT = BLOCK.acceleration(1.0)
# Shi et al. (1996); Makris & Roussos (2000), eq. (27): amplitude at which a half sine of frequency ratio 2 overturns.
HALF_SINE = 1.80072393056
LEVELS = np.linspace(0.9, 4.0, 63)
WIDTH = LEVELS[1] - LEVELS[0]


def push(duration, samples=(1.0, 1.0)):
    """Samples in m/s² whose normalised duration is given, in multiples of the lift-off of the block."""
    step = BLOCK.seconds(duration) / (len(samples) - 1)
    return rk.GroundMotion(UNIT * np.array(samples), step=step)


def overturns(found, record, level):
    return (
        rk.simulate(found.block.system(found.motion(record, level), model="slender"), record="none").outcome
        == "overturned"
    )


def contains(intervals, level):
    return bool(((intervals[:, 0] <= level) & (level <= intervals[:, 1])).any())


def standing(intervals, low=LEVELS[0], high=LEVELS[-1]):
    """Return the intervals between those that overturn."""
    edges = np.stack([np.append(low, intervals[:, 1]), np.append(intervals[:, 0], high)], axis=1)
    return edges[edges[:, 1] > edges[:, 0]]


@pytest.mark.parametrize("duration", [0.3, 0.7, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("polarity", [1, -1])
def test_rectangular_pulse_overturns_above_its_closed_form(duration, polarity):
    """A > 1/(1 − exp(−T)), the same as Housner (1963), eq. (9)."""
    motion = push(duration)
    found = rk.overturning_set(
        motion, BLOCK, np.linspace(0.5, 8.0, 31), polarity=polarity, model="slender", normalised_by="angle"
    )
    edge = -1 / math.expm1(-BLOCK.time(motion.step))
    (switch,) = found.switches
    assert switch["level"] == pytest.approx(edge, rel=1e-10)
    assert switch["overturns_above"]
    assert switch["impacts_since_rest"] == 0
    assert switch["certified"]
    assert switch["certified_below"] < edge < switch["certified_above"]
    assert switch["certified_above"] - switch["certified_below"] < 1e-10
    assert found.intervals().tolist() == [[switch["level"], 8.0]]
    assert found.lowest.tolist() == [switch["level"]]
    assert found.share[0] == pytest.approx((8.0 - edge) / 7.5, rel=1e-9)


def test_sampled_half_sine_approaches_its_threshold_with_the_square_of_the_step():
    errors = []
    for count in (100, 200, 400):
        wave = np.sin(np.pi * np.arange(count + 1) / count)
        found = rk.overturning_set(
            push(math.pi / 2, wave), BLOCK, np.linspace(1.0, 3.0, 5), model="slender", normalised_by="angle"
        )
        errors.append(found.lowest[0] - HALF_SINE)
    assert np.array(errors[:2]) / errors[1:] == pytest.approx(4.0, rel=0.02)
    assert abs(errors[-1]) < 1e-4


@pytest.fixture(scope="module")
def several():
    # factors that round: a switch is right to the last digit only with the rounding of `Block.system`
    records = [
        motion.scaled(1.1 + 0.1 * k) for k, motion in enumerate(rk.synthetic_ground_motions(4, seed=11))
    ]
    blocks = [rk.Block(height, 0.22 * height) for height in (1.0, 2.0, 3.0)]
    return [
        rk.overturning_set(records, block, LEVELS, intensity="pga-ratio", model="slender") for block in blocks
    ]


def test_outcomes_on_both_sides_of_a_switch_differ_between_adjacent_doubles(several):
    count = 0
    for found in several:
        for record, level, above, *_ in found.switches.tolist():
            sides = [overturns(found, record, each) for each in (np.nextafter(level, 0.0), level)]
            assert sides == [not above, above]
            count += 1
    assert count > 50


def test_mode_is_that_of_the_run_on_the_overturning_side(several):
    for found in several:
        for record, level, above, mode, *_ in found.switches.tolist():
            motion = rk.simulate(
                found.block.system(
                    found.motion(record, level if above else np.nextafter(level, 0.0)), model="slender"
                )
            )
            assert motion.outcome == "overturned"
            kinds = motion.events["kind"]
            rests = np.flatnonzero(np.isin(kinds, ("rest", "lift-off")))
            assert (kinds[rests[-1] :] == "impact").sum() == mode


def test_grid_and_intervals_tell_the_same(several):
    for found in several:
        for record in range(4):
            intervals = found.intervals(record)
            assert (intervals[:, 0] <= intervals[:, 1]).all()
            assert (intervals[1:, 0] > intervals[:-1, 1]).all()
            told = [contains(intervals, level) for level in LEVELS]
            assert told == found.overturned[record].tolist()
            assert [text == "overturned" for text in found.outcome[record]] == told
            assert found.lowest[record] == intervals[0, 0]
            assert found.share[record] == pytest.approx(
                np.ptp(intervals, axis=1).sum() / np.ptp(LEVELS), rel=1e-12
            )


def test_random_levels_agree_except_in_intervals_narrower_than_the_grid(several):
    """Overturning is fractal: a share of the levels lies in intervals that the grid misses."""
    rng, differ, undecided, total = np.random.default_rng(5), 0, 0, 0
    for found in several:
        for record in range(4):
            intervals = found.intervals(record)
            own = found.switches["level"][found.switches["record"] == record]
            known = np.sort(np.concatenate((LEVELS, own, np.nextafter(own, 0.0))))
            for level in rng.uniform(LEVELS[0], LEVELS[-1], 60):
                run = rk.simulate(
                    found.block.system(found.motion(record, level), model="slender"), record="none"
                )
                told, overturned = contains(intervals, level), run.outcome == "overturned"
                total += 1
                undecided += not run.certified
                if told == overturned or not run.certified:
                    continue
                differ += 1
                place = np.searchsorted(known, level)
                below, above = known[place - 1], known[place]
                assert above - below <= WIDTH * (1 + 1e-12)
                assert [overturns(found, record, each) for each in (below, above)] == [told, told]
    print(f"{differ} of {total} random levels lie in narrower intervals; {undecided} are undecided")
    assert 0 < differ < 0.1 * total
    assert undecided < 0.01 * total


def compared_with_a_finer_grid(pairs, factor):
    """Return the numbers of wider and narrower intervals of a finer grid; the coarse one must know each wider one."""
    wider = narrower = 0
    fine_levels = np.linspace(LEVELS[0], LEVELS[-1], factor * (LEVELS.size - 1) + 1)
    for motion, block in pairs:
        coarse, fine = (
            rk.overturning_set(motion, block, levels, intensity="pga-ratio", model="slender").intervals()
            for levels in (LEVELS, fine_levels)
        )
        for known, wanted in ((coarse, fine), (standing(coarse), standing(fine))):
            for low, high in wanted.tolist():
                if high - low <= WIDTH:
                    narrower += 1
                    continue
                wider += 1
                assert ((known[:, 0] < high) & (known[:, 1] > low)).any()
    print(f"{wider} intervals wider than {WIDTH:.4g}, all known, and {narrower} narrower ones")
    return wider, narrower


def twenty_pairs():
    blocks = [rk.Block(height, 0.22 * height) for height in (1.0, 2.5)]
    return [(motion, block) for motion in rk.synthetic_ground_motions(10, seed=11) for block in blocks]


def test_a_grid_ten_times_finer_finds_no_further_wide_interval():
    wider, narrower = compared_with_a_finer_grid(twenty_pairs()[::4], 10)
    assert wider > 15
    assert narrower > wider


@pytest.mark.long
def test_a_grid_a_hundred_times_finer_finds_no_further_wide_interval():
    wider, narrower = compared_with_a_finer_grid(twenty_pairs(), 100)
    assert wider > 100
    assert narrower > wider


def test_certified_levels_around_a_switch_are_right_in_60_digits():
    motion = rk.synthetic_ground_motions(1, seed=7, duration=6.0, step=0.02)[0]
    found = rk.overturning_set(
        motion, BLOCK, np.linspace(1.0, 6.0, 201), intensity="pga-ratio", model="slender"
    )
    assert found.switches.size > 3
    for switch in found.switches[:6]:
        assert switch["certified"]
        sides = []
        for level in (switch["certified_below"], switch["certified_above"]):
            base = BLOCK.system(found.motion(0, level), model="slender").forcing
            sides.append(exact(Case(base.values, base.step, base.scale, BLOCK.restitution)).outcome)
        wanted = ["rest", "overturned"] if switch["overturns_above"] else ["overturned", "rest"]
        assert sides == wanted


@pytest.mark.parametrize("intensity", ["scale", "pga", "pga-g", "pgv", "arias", "pga-ratio", "pgv-ratio"])
def test_every_intensity_measure_gives_the_same_switch(intensity):
    motion = push(1.0, [0.0, 1.0, 0.5, 0.0])
    (plain,) = rk.overturning_set(motion, BLOCK, [1.0, 30.0], model="slender").switches["level"]
    measured = rk.overturning_set(motion, BLOCK, [1e-3, 1e4], intensity=intensity, model="slender")
    assert measured.motion(0, measured.switches["level"][0]).factor == pytest.approx(plain, rel=1e-12)


def test_executors_give_the_same_set(several):
    found = several[0]
    for kind in (ThreadPoolExecutor, ProcessPoolExecutor):
        with kind(2) as pool:
            again = rk.overturning_set(
                found.records,
                found.block,
                LEVELS,
                intensity="pga-ratio",
                executor=pool,
                model="slender",
            )
        assert again.dataset.identical(found.dataset)


def test_polarity_and_angle_are_those_of_the_runs(several):
    motion, block = several[0].records[0], several[0].block
    turned = rk.overturning_set(
        motion, block, LEVELS, intensity="pga-ratio", angle=0.3, polarity=-1, model="slender"
    )
    backward = rk.overturning_set(
        motion.reversed(), block, LEVELS, intensity="pga-ratio", angle=0.3, model="slender"
    )
    assert turned.switches.tolist() == backward.switches.tolist()
    assert turned.switches.tolist() != several[0].switches[: turned.switches.size].tolist()
    for _, level, above, *_ in turned.switches.tolist():
        for each, falls in ((np.nextafter(level, 0.0), not above), (level, above)):
            run = rk.simulate(
                block.system(turned.motion(0, each), model="slender"), rk.State(0.3), record="none"
            )
            assert (run.outcome == "overturned") == falls


def test_dataset_is_kept_in_a_file(several, tmp_path):
    import xarray as xr

    for found in (several[0], rk.overturning_set(push(1.0), BLOCK, [0.1, 0.2], model="slender")):
        found.dataset.to_netcdf(tmp_path / "set.nc", engine="h5netcdf")
        with xr.open_dataset(tmp_path / "set.nc", engine="h5netcdf") as read:
            assert dict(read.sizes) == dict(found.dataset.sizes)
            assert read.switch_level.values.tolist() == found.switches["level"].tolist()
            assert read.switch_overturns_above.values.tolist() == found.switches["overturns_above"].tolist()


def test_a_range_without_overturning_has_no_interval():
    found = rk.overturning_set([push(1.0), push(2.0, [1, 0.5])], BLOCK, [0.1, 0.5, 0.9], model="slender")
    assert found.switches.size == 0
    assert found.switches.dtype == SWITCH_ROW
    assert found.intervals(1).shape == (0, 2)
    assert np.isnan(found.lowest).all()
    assert found.share.tolist() == [0.0, 0.0]
    assert str(found) == "2 records, 3 levels of factor from 0.1 to 0.9: 0 switches; no level overturns"


def test_a_range_that_overturns_throughout_is_one_interval():
    found = rk.overturning_set(push(1.0), BLOCK, [2.0, 3.0, 9.0], model="slender")
    assert found.intervals().tolist() == [[2.0, 9.0]]
    assert found.share.tolist() == [1.0]


def test_intervals_end_at_the_last_double_that_overturns():
    switches = np.zeros(3, SWITCH_ROW)
    switches["level"], switches["overturns_above"] = [2.0, 3.0, 4.0], [False, True, False]
    assert intervals_of(True, switches, 1.0, 5.0).tolist() == [
        [1.0, np.nextafter(2.0, 0)],
        [3.0, np.nextafter(4.0, 0)],
    ]
    assert intervals_of(False, switches[1:2], 1.0, 5.0).tolist() == [[3.0, 5.0]]


@pytest.mark.parametrize("record", [-1, 1, 0.5])
def test_records_are_counted_from_0(record):
    found = rk.overturning_set(push(1.0), BLOCK, [1.0, 2.0], model="slender")
    with pytest.raises(ValueError, match="record must be a whole number in"):
        found.intervals(record)
    with pytest.raises(ValueError, match="record must be a whole number in"):
        found.motion(record, 1.0)
