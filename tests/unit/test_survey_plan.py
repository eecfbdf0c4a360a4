"""Tilings: every point lies in one tile, and every coarse level is part of the next."""

import math
from itertools import pairwise

import numpy as np
import pytest

from rocking.survey.run_survey import Cost, duration
from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import COARSEST, levels, tile_edges

SHAPES = [(2, 2), (64, 64), (65, 64), (130, 131), (1000, 1000), (7, 100_000), (3, 200, 150), (1_000_000,)]


def asked(shape):
    return SurveySpec({f"axis {k}": np.arange(float(count)) for k, count in enumerate(shape)})


@pytest.mark.parametrize("shape", SHAPES)
def test_every_point_of_a_level_lies_in_one_tile(shape):
    for level in levels(asked(shape)):
        seen = np.zeros(level.shape, np.int8)
        for tile in level.tiles():
            seen[tile.region] += 1
            assert math.prod(tile.shape) <= SurveySpec.in_a_tile
        assert (seen == 1).all()


@pytest.mark.parametrize("shape", SHAPES)
def test_levels_go_from_few_points_to_all_and_share_what_they_say(shape):
    grids = levels(asked(shape))
    assert grids[-1].shape == shape
    assert max(grids[0].shape) <= COARSEST
    for coarse, fine in pairwise(grids):
        places = np.stack(np.meshgrid(*fine.axes.values(), indexing="ij"))
        expected = np.stack(np.meshgrid(*coarse.axes.values(), indexing="ij"))
        copied = 0
        for tile in fine.tiles():
            here, there = tile.shared()
            part = places[(slice(None), *tile.region)]
            assert np.array_equal(part[(slice(None), *here)], expected[(slice(None), *there)])
            copied += part[(0, *here)].size
            assert tile.own(np.ones(tile.shape, bool)).sum() == part[0].size - part[(0, *here)].size
        assert copied == math.prod(coarse.shape)


@pytest.mark.parametrize(
    "shape, edges",
    [
        ((1000, 1000), (250, 250)),
        ((10_000, 10_000), (256, 256)),
        ((3, 200, 150), (3, 50, 38)),
        ((1_000_000,), (65_536,)),
        ((20, 20), (20, 20)),
    ],
)
def test_tiles_are_neither_many_nor_large(shape, edges):
    assert tile_edges(shape, SurveySpec.in_a_tile) == edges


@pytest.mark.parametrize(
    "seconds, told",
    [(0.123, "0.1 s"), (12.3, "12 s"), (119.0, "119 s"), (600.0, "10 minutes"), (1e6, "12 days")],
)
def test_times_are_told_to_what_is_known_of_them(seconds, told):
    assert duration(seconds) == told


def test_cost_is_one_line():
    cost = Cost(1_000_000, 23, 0, 24.0)
    assert cost.describe(2) == "1,000,000 points in 23 tiles, about 12 s on 2 cores"
    assert Cost(1_000_000, 23, 0, 24.0, at_least=True).describe(2).endswith("more than 12 s on 2 cores")
    assert cost.describe(1).endswith("about 24 s on 1 core")
    assert cost.describe(None).endswith("about 24 s on one core")
    assert "1,000,000 points in 23 tiles, 250,000 of them computed before, about" in Cost(
        1_000_000, 23, 250_000, 9.0
    ).describe(2)
