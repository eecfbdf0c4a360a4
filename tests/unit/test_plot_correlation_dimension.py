"""Figure of a dimension: counts, local slopes and the scaling region."""

import numpy as np
import pytest

import rocking as rk
from drawn import artist


@pytest.fixture(scope="module")
def square():
    return rk.correlation_dimension(np.random.default_rng(1).random((6_000, 2)))


def slopes_axis(ax):
    (right,) = (other for other in ax.figure.axes if other is not ax)
    return right


def test_line_is_the_correlation_sum_on_logarithmic_axes(square):
    ax = rk.plot.correlation_dimension(square)
    line = artist(ax, "correlation-sum")
    np.testing.assert_array_equal(line.get_xdata(), square.radii)
    np.testing.assert_array_equal(line.get_ydata(), square.sums)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")


def test_marks_are_the_local_slopes_between_the_radii(square):
    right = slopes_axis(rk.plot.correlation_dimension(square))
    (marks,) = (line for line in right.lines if len(line.get_xdata()) == len(square.slopes))
    np.testing.assert_array_equal(marks.get_ydata(), square.slopes)
    assert (marks.get_xdata() > square.radii[:-1]).all()
    assert (marks.get_xdata() < square.radii[1:]).all()


def test_scaling_region_and_interval_are_marked(square):
    ax = rk.plot.correlation_dimension(square)
    region = artist(ax, "scaling-region").get_extents().transformed(ax.transData.inverted())
    assert (region.x0, region.x1) == pytest.approx(square.scaling_region, rel=1e-9)
    band = artist(slopes_axis(ax), "interval").get_paths()[0].vertices
    assert (band[:, 1].min(), band[:, 1].max()) == pytest.approx(square.interval, rel=1e-9)
    assert ax.get_title(loc="right").startswith(f"dimension {square.value:.2f}, in [")


def test_radii_have_ticks_that_can_be_read(square):
    ax = rk.plot.correlation_dimension(square)
    ax.figure.canvas.draw()
    low, high = ax.get_xlim()
    shown = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert 2 <= len(shown) <= 6
    assert "standard deviation" in ax.get_xlabel()


def test_axes_given_is_drawn_into(square):
    _, (left, _) = rk.plot.panels(columns=2)
    assert rk.plot.correlation_dimension(square, left) is left
