"""Blocks on floors, and the directions of shaking that overturn them: recorded motions, with the values of another program.

That program looked for the lowest overturning scale on a coarse grid. So its value is an end of an interval; narrower intervals may
lie below.
"""

from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from oracles import full_taylor

RECORDS = Path(__file__).parents[3] / "shared" / "records"
RINALDI, EL_CENTRO, WAIAU = (
    RECORDS / name
    for name in (
        "NGA_no_1063_RRS228.AT2",
        "RSN6_IMPVALL.I_I-ELC180-hor1.AT2",
        "20161113_110259_WTMC_20.V2A",
    )
)
BLOCK = rk.Block(2.0, 0.6)
pytestmark = pytest.mark.skipif(
    not all(each.exists() for each in (RINALDI, EL_CENTRO, WAIAU)), reason="file absent"
)


def ends(path, floor, levels):
    """Return the lower ends of the intervals of scales that overturn the block."""
    ground = rk.read_ground_motion(path)
    base = ground.floor(*floor) if floor else ground
    return rk.overturning_set(base, BLOCK, levels, intensity="scale").intervals()


@pytest.mark.parametrize(
    ("path", "floor", "low", "expected"),
    [
        (RINALDI, None, 0.56, 0.661),
        (RINALDI, (0.2, 0.05), 0.56, 0.583),
        (EL_CENTRO, None, 2.25, 2.312),
        (EL_CENTRO, (0.2, 0.05), 1.85, 1.94),
        (EL_CENTRO, (2.5, 0.2), 3.35, 3.405),
    ],
)
def test_lowest_overturning_scale_on_the_ground_and_on_a_floor(path, floor, low, expected):
    intervals = ends(path, floor, np.arange(low, expected + 0.006, 0.002))
    assert intervals[0, 0] == pytest.approx(expected, abs=6e-4)


@pytest.mark.parametrize(
    ("path", "low", "expected", "below"),
    [
        (RINALDI, 0.55, 0.5875, [[0.555712, 0.555812], [0.563111, 0.563157], [0.567959, 0.568075]]),
        (EL_CENTRO, 1.44, 1.4611, [[1.446749, 1.447000], [1.448650, 1.449155], [1.453783, 1.456752]]),
    ],
)
def test_narrow_intervals_lie_below_the_scale_that_a_coarse_grid_finds_on_a_floor_of_half_a_second(
    path, low, expected, below
):
    intervals = ends(path, (0.5, 0.05), np.arange(low, expected + 1e-3, 5e-5))
    np.testing.assert_allclose(intervals[: len(below)], below, rtol=0, atol=1e-6)
    assert np.abs(intervals[:, 0] - expected).min() < 1e-4
    floor = rk.read_ground_motion(path).floor(0.5)
    for first, last in below:
        motion = rk.simulate(BLOCK.system(floor.scaled((first + last) / 2)))
        assert motion.outcome is rk.Outcome.OVERTURNED
        assert motion.certified


@pytest.mark.long
@pytest.mark.parametrize(
    ("path", "scales"),
    [
        (RINALDI, {0.5557: False, 0.55576: True, 0.55582: False, 0.56313: True, 0.568: True, 0.58: False}),
        (EL_CENTRO, {1.4467: False, 1.44687: True, 1.44701: False, 1.4489: True, 1.455: True}),
    ],
)
def test_narrow_intervals_are_those_of_fifty_digits(path, scales):
    base = BLOCK.system(rk.read_ground_motion(path).floor(0.5)).forcing
    for scale, overturns in scales.items():
        values = base.values * base.scale * scale
        exact = full_taylor.Block(values, base.step, 1.0, BLOCK.restitution, BLOCK.critical_angle)
        assert exact.overturns() == overturns


def test_isolated_block_overturns_in_intervals_that_a_grid_of_a_hundredth_misses():
    intervals = ends(RINALDI, (2.5, 0.2), np.arange(1.095, 1.12, 1e-4))
    lows, highs = intervals.T
    for value in (1.1025, 1.1110, 1.1144):
        assert np.abs(lows - value).min() < 1e-4
    for value in (1.1068, 1.1130):
        assert np.abs(highs - value).min() < 1e-4
    assert lows[0] == pytest.approx(1.1025, abs=1e-4)


DIRECTIONS = np.radians(np.arange(0, 180, 10))


def test_overturning_directions_of_two_components():
    first, second, _ = rk.read_ground_motions(WAIAU)
    turned = rk.RecordSet([first, second]).rotated(DIRECTIONS)
    analysis = rk.incremental_dynamic_analysis(turned, BLOCK, [0.8, 1.0, 1.5], intensity="scale")
    overturned = np.isinf(analysis.dataset.peak.transpose("record", "level").values)
    assert overturned.sum(axis=0).tolist() == [6, 8, 16]
    # Component 2, at 90°, overturns the block at 0.8 but not at 1, and component 1 at 1 but not at 0.8.
    assert overturned[0, :2].tolist() == [False, True]
    assert overturned[9, :2].tolist() == [True, False]
    np.testing.assert_allclose(turned[9].acceleration, second.acceleration, atol=1e-14)
