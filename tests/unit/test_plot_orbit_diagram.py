"""Figure of an orbit diagram: all shown, few or many, the given branches, and overturning."""

import io

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from drawn import legend, points

SYSTEM = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
VALUES = np.linspace(10.4, 11.5, 23)
BOTH = rk.orbit_diagram(SYSTEM, amplitude=VALUES, cycles=8)
UP = rk.orbit_diagram(SYSTEM, amplitude=VALUES, sweep="up", cycles=8)


@pytest.fixture(scope="module")
def branch():
    """The asymmetric branch on which the diagram lies: of period 1, unstable from its doubling near 10.4725 on."""
    system = rk.System(rk.Harmonic(amplitude=7.0, period=1.721328), restitution=0.8)
    symmetric = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (5.0, 11.0))
    (breaking,) = (point for point in symmetric.special if point.kind == "symmetry-breaking")
    return max(rk.switch_branch(breaking, (7.0, 10.8)), key=lambda one: one.section()[-1, 0, 0])


@pytest.fixture(scope="module")
def twice(branch):
    """The orbit of period 2 that branches off at that doubling."""
    return rk.switch_branch(doubling_of(branch), (10.4, 10.8))[0]


def doubling_of(branch):
    return next(point for point in branch.special if point.kind == "period-doubling")


@pytest.mark.parametrize("quantity, column", [("angle", 0), ("velocity", 1)])
def test_every_point_is_drawn_and_none_twice(quantity, column):
    shown = points(rk.plot.orbit_diagram(UP, quantity=quantity), "up")
    heights = UP.points[0, :, :, column]
    for value, row in zip(VALUES, heights, strict=True):
        there = shown[shown[:, 0] == value, 1]
        if np.isnan(row).any():
            assert not len(there)
            continue
        finest = 1.01e-4 * np.ptp(heights[np.isfinite(heights)])
        assert np.abs(row[:, None] - there).min(axis=1).max() <= finest
        assert len(there) <= len(row)
    assert (shown[:, 0] == VALUES[0]).sum() == 1  # period 1, eight times the same


def test_peak_has_one_point_a_value():
    shown = points(rk.plot.orbit_diagram(UP, quantity="peak"), "up")
    kept = ~UP.overturned[0]
    np.testing.assert_array_equal(shown, np.column_stack([VALUES[kept], UP.peak[0, kept]]))


def test_bars_lie_under_the_values_that_overturned():
    ax = rk.plot.orbit_diagram(BOTH)
    for row, way in enumerate(BOTH.sweeps):
        ends = points(ax, f"overturned {way}")[:, 0].reshape(-1, 3)[:, :2]
        covered = [bool(((ends[:, 0] <= v) & (v <= ends[:, 1])).any()) for v in VALUES]
        assert covered == BOTH.overturned[row].tolist()
    assert any(covered)
    assert not all(covered)
    low = min(line.get_ydata().min() for line in ax.lines if line.get_gid() in BOTH.sweeps)
    below = ax.transAxes.inverted().transform(ax.transData.transform((10.4, low)))[1]
    assert below > 0.06  # bars reach to .055


def test_nothing_overturned_has_no_bar():
    ax = rk.plot.orbit_diagram(rk.orbit_diagram(SYSTEM, amplitude=[9.0, 9.5], cycles=3))
    assert [line.get_gid() for line in ax.lines] == ["up", "down"]


def test_all_overturned_is_still_a_picture():
    ax = rk.plot.orbit_diagram(rk.orbit_diagram(SYSTEM, amplitude=[40.0, 50.0], sweep="rest", cycles=3))
    assert len(points(ax, "rest")) == 0
    assert len(points(ax, "overturned rest")) == 3


def test_branches_are_solid_where_stable_and_dashed_where_not_and_change_where_they_do(branch, twice):
    ax = rk.plot.orbit_diagram(UP, branches=[branch, twice])
    solid = [line for line in ax.lines if line.get_gid() == "stable branch"]
    dashed = [line for line in ax.lines if line.get_gid() == "unstable branch"]
    assert len(solid) == len(dashed) == 3  # one line a cycle of the period
    assert (solid[0].get_linestyle(), dashed[0].get_linestyle()) == ("-", "--")
    reach = [np.array(line.get_xdata())[np.isfinite(line.get_ydata())] for line in (solid[0], dashed[0])]
    doubling = doubling_of(branch).parameter
    assert reach[0].max() == reach[1].min() == doubling
    shown = branch.points
    stable = shown["parameter"][shown["stable"]]
    assert set(stable) <= set(reach[0])
    assert set(shown["parameter"]) <= set(reach[0]) | set(reach[1])


def test_stable_branches_lie_on_the_points(branch, twice):
    ax = rk.plot.orbit_diagram(UP, branches=[branch, twice])
    lines = [line.get_xydata() for line in ax.lines if line.get_gid() == "stable branch"]
    for value, angles in zip(VALUES[:6], UP.points[0, :6, :, 0], strict=True):
        # what is drawn lies between shown of the branch
        near = [
            np.interp(value, *line[np.isfinite(line[:, 1])].T)
            for line in (lines[1:] if value > 10.48 else lines[:1])
        ]
        assert np.abs(np.array(near)[:, None] - angles).min(axis=0).max() < 2e-4


def test_every_value_is_in_the_picture_though_all_there_overturned():
    low, high = rk.plot.orbit_diagram(UP).get_xlim()
    assert UP.overturned[0, -1]
    assert VALUES[0] - 0.1 < low < VALUES[0] < VALUES[-1] < high < VALUES[-1] + 0.1


def test_branches_that_lead_farther_do_not_widen_the_picture(branch):
    assert branch.points["parameter"].min() < 8.0 < VALUES[0]
    alone = rk.plot.orbit_diagram(UP)
    assert rk.plot.orbit_diagram(UP, branches=[branch]).get_xlim() == alone.get_xlim()


def test_branches_are_taken_at_the_section_of_the_diagram(branch):
    later = rk.orbit_diagram(SYSTEM, amplitude=VALUES, sweep="up", cycles=2, section_phase=0.5)
    ax = rk.plot.orbit_diagram(later, branches=[branch], quantity="velocity")
    line = next(line for line in ax.lines if line.get_gid() == "stable branch")
    expected = branch.section(0.5)[branch.points["stable"], 0, 1]
    assert set(expected) <= set(line.get_ydata())


def test_legend_names_each_once_and_in_order(branch, twice):
    ax = rk.plot.orbit_diagram(BOTH, branches=[branch, twice])
    assert legend(ax) == [
        "swept up",
        "swept down",
        "stable orbits",
        "unstable orbits",
        "overturned, up",
        "overturned, down",
    ]


def test_ten_points_are_seen_and_a_million_stay_small_in_a_vector_file():
    few = rk.orbit_diagram(SYSTEM, amplitude=np.linspace(9, 10, 10), sweep="up", cycles=1)
    assert rk.plot.orbit_diagram(few).lines[0].get_markersize() == pytest.approx(3.0)
    many = rk.orbit_diagram(SYSTEM, amplitude=np.linspace(10.735, 10.745, 1000), sweep="up", cycles=1000)
    ax = rk.plot.orbit_diagram(many)
    stream = io.BytesIO()
    ax.figure.savefig(stream, format="svg")
    assert len(stream.getvalue()) < 1_000_000
    stream = io.BytesIO()
    ax.figure.savefig(stream, dpi=150)
    red, _, blue = np.asarray(Image.open(stream).convert("RGB"), dtype=int).transpose(2, 0, 1)
    assert 0.02 < (blue - red > 60).mean() < 0.7
