"""The phase portrait shows jumps as vertical lines, arcs as curves, and nothing else."""

import numpy as np
import pytest

import rocking as rk
from drawn import artist, legend, points

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
BRACED = rk.System(
    rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0, restitution=0.8)
)


def strokes(ax, kind):
    return np.array(artist(ax, f"{kind} strokes").get_segments())


def test_strokes_at_the_base_take_the_velocity_from_before_to_e_times_it():
    motion = rk.simulate(SYSTEM, cycles=40)
    ax = rk.plot.phase_portrait(motion)
    drawn = strokes(ax, "impact")
    assert len(drawn) == motion.impacts
    assert not drawn[:, :, 0].any()
    np.testing.assert_allclose(drawn[:, 1, 1], 0.925 * drawn[:, 0, 1], rtol=1e-14)


def test_strokes_at_the_braces_turn_the_velocity_back_by_r():
    motion = rk.simulate(BRACED, cycles=40)
    drawn = strokes(rk.plot.phase_portrait(motion), "brace")
    assert len(drawn) == motion.brace_hits > 20
    assert set(np.abs(drawn[:, :, 0]).ravel()) == {1.0}
    np.testing.assert_allclose(drawn[:, 1, 1], -0.8 * drawn[:, 0, 1], rtol=1e-14)


@pytest.mark.parametrize("kind", ["impact", "brace"])
def test_marks_sit_at_both_ends_of_the_strokes(kind):
    ax = rk.plot.phase_portrait(rk.simulate(BRACED, cycles=40))
    ends = strokes(ax, kind)
    np.testing.assert_array_equal(points(ax, f"{kind} before"), ends[:, 0])
    np.testing.assert_array_equal(points(ax, f"{kind} after"), ends[:, 1])


def test_curve_never_crosses_a_jump():
    motion = rk.simulate(BRACED, cycles=40)
    curve = points(rk.plot.phase_portrait(motion), "motion")
    steps = np.abs(np.diff(curve[:, 1]))
    jumps = np.abs(motion.events["after"] - motion.events["before"])
    # |Θ''| ≤ 1 + A + |Θ| = 17, and two neighbours are at most 1/64 apart
    assert np.nanmax(steps) <= 17 / 64
    assert jumps.max() > 10 * np.nanmax(steps)
    assert np.isnan(curve[:, 0]).sum() == np.count_nonzero(jumps)


def test_curve_ends_and_begins_at_the_marks():
    motion = rk.simulate(SYSTEM, cycles=20)
    ax = rk.plot.phase_portrait(motion)
    curve = points(ax, "motion")
    gaps = np.flatnonzero(np.isnan(curve[:, 0]))
    np.testing.assert_array_equal(curve[gaps - 1], points(ax, "impact before"))
    np.testing.assert_array_equal(curve[gaps + 1], points(ax, "impact after"))


def test_without_loss_before_and_after_coincide_and_the_curve_is_whole():
    lossless = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    ax = rk.plot.phase_portrait(rk.simulate(lossless, cycles=60))
    np.testing.assert_array_equal(points(ax, "impact before"), points(ax, "impact after"))
    assert not np.isnan(points(ax, "motion")).any()


def test_window_leaves_out_the_impacts_outside_it():
    motion = rk.simulate(SYSTEM, cycles=40)
    inside = (motion.events["time"] >= 30) & (motion.events["time"] <= 40)
    drawn = strokes(rk.plot.phase_portrait(motion, cycles=(30, 40)), "impact")
    np.testing.assert_array_equal(drawn[:, 0, 1], motion.events["before"][inside])


def test_key_names_the_kinds_of_impact_that_occur():
    def names(system):
        return legend(rk.plot.phase_portrait(rk.simulate(system, cycles=20)))

    assert names(SYSTEM) == ["before impact", "after impact"]
    assert names(BRACED) == ["before impact", "after impact", "before brace impact", "after brace impact"]


def test_marks_of_the_key_can_be_read_however_many_impacts_there_are():
    def sizes(cycles):
        ax = rk.plot.phase_portrait(rk.simulate(SYSTEM, cycles=cycles))
        (mark,) = (line for line in ax.lines if line.get_gid() == "impact before")
        return mark.get_markersize(), {handle.get_markersize() for handle in ax.get_legend().legend_handles}

    (many, key), (few, other) = sizes(5000), sizes(5)
    assert many < 0.25 * few
    assert key == other == {4.0}


@pytest.mark.parametrize(("start", "braces"), [(0.0, None), (2.0, rk.Braces(angle=2.0, restitution=0.0))])
def test_block_that_never_moves_is_a_dot_without_a_key(start, braces):
    still = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9, braces=braces)
    ax = rk.plot.phase_portrait(rk.simulate(still, rk.State(angle=start), cycles=5))
    assert {tuple(point) for point in points(ax, "motion")} == {(start, 0.0)}
    assert [line.get_marker() for line in ax.lines] == ["o"]
    assert ax.get_legend() is None


def test_block_that_moves_is_a_line_without_dots():
    ax = rk.plot.phase_portrait(rk.simulate(SYSTEM, cycles=5))
    assert ax.lines[0].get_marker() == "none"
