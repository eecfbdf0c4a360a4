"""Zeros of a function along a curve of points: two within a step, against all zeros of a known function."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from rocking.orbits import curves
from rocking.orbits.curves import find_brackets, locate_zero
from rocking.orbits.normal_form import Reduced

SEED = 5


def line(places):
    """Points of a straight line in place of those of a curve; each point of the space is on it."""
    rows = np.stack([places, 0.0 * places, 0.0 * places], axis=1)
    found = SimpleNamespace(chain=SimpleNamespace(kinds=[0]), rows=rows, corrected=lambda near, _: near)
    found.rotated = lambda: found
    return found


def shown(places):
    """The same points, whose first coordinate is also that of both parameters."""
    found = line(places)
    found.rows[:, 1:] = places[:, None]
    return found


def of(function):
    """Test function over the first coordinate."""
    return curves.Test("any", lambda _, at: Reduced(function(at[:, 0]), np.ones((len(at), 1))))


def pairs(gap, shift, step):
    """Points, and the zeros of cos(x) - cos(gap / 2) between them: pairs with this distance."""
    places = np.arange(-2.0, 15.0, step) + shift
    zeros = np.sort([math.tau * k + side * 0.5 * gap for k in range(3) for side in (-1.0, 1.0)])
    return places, zeros, of(lambda x: np.cos(x) - math.cos(0.5 * gap))


@pytest.mark.parametrize("step", [0.1, 0.4, 0.8])
@pytest.mark.parametrize("gap", [0.3, 0.05, 0.002])
def test_each_zero_is_in_one_bracket_wherever_the_points_lie(step, gap):
    random = np.random.default_rng(SEED)
    together = 0
    for shift in random.uniform(0.0, step, 40):
        places, zeros, test = pairs(gap, shift, step)
        found = list(find_brackets(line(places), test))
        ends = [
            places[part.place]
            + np.array([part.low, part.high]) * (places[part.place + 1] - places[part.place])
            for part in found
        ]
        assert [int(((low < zeros) & (zeros < high)).sum()) for low, high in ends] == [1] * len(zeros)
        together += len({part.place for part in found}) < len(found)
        for part, zero in zip(found, zeros, strict=True):
            row, _ = locate_zero(line(places), test, part)
            assert row[0] == pytest.approx(zero, abs=1e-11)
    assert (together > 0) == (gap < step)


def test_a_step_with_one_zero_is_not_divided():
    places = np.linspace(0.0, 1.0, 8)
    for zero in np.random.default_rng(SEED).uniform(0.0, 1.0, 50):
        (part,) = find_brackets(line(places), of(lambda x, zero=zero: (x - zero) * (1.0 + 0.3 * x)))
        assert (part.low, part.high) == (0.0, 1.0)


def test_three_zeros_within_one_step():
    places = np.linspace(-2.0, 2.0, 7)
    zeros = np.array([-0.2, 0.01, 0.25])
    found = list(find_brackets(line(places), of(lambda x: (x - zeros[0]) * (x - zeros[1]) * (x - zeros[2]))))
    assert len(found) == 3


def test_a_pole_is_no_zero():
    places = np.linspace(0.0, 1.0, 8)
    test = of(lambda x: 1.0 / (x - 0.4))
    assert all(locate_zero(line(places), test, part) is None for part in find_brackets(line(places), test))


def test_error_of_a_zero_covers_the_rounding_of_the_test_function():
    """A function that rounds to 1e-12 has zeros anywhere within that distance; two searches may find the same one by chance."""
    random = np.random.default_rng(SEED)
    places = np.linspace(0.0, 1.0, 3)
    for zero in random.uniform(0.05, 0.95, 60):
        test = of(lambda x, zero=zero: 3.0 * (x - zero) + 3e-12 * np.sin(1e13 * x))
        (part,) = find_brackets(shown(places), test)
        row, (error, _) = locate_zero(shown(places), test, part)
        assert abs(row[0] - zero) < error < 2e-11
