"""Figures of the closed forms show exactly these forms."""

import math

import numpy as np
import pytest

import rocking as rk
from drawn import legend


def lines(ax):
    return {line.get_gid(): line for line in ax.lines if len(line.get_xdata())}


def drawn(line):
    x, y = (np.asarray(values, float) for values in line.get_data())
    return x[~np.isnan(y)], y[~np.isnan(y)]


def test_modes_are_solid_up_to_where_symmetry_breaks_and_dashed_beyond():
    ax = rk.plot.modes(1.0, 0.8)
    breaks = rk.theory.symmetry_breaking_amplitude(1.0, 0.8, 1)
    begins = rk.theory.existence_amplitude(1.0, 0.8, 1)
    stable, unstable = (drawn(lines(ax)[f"faster {kind}"]) for kind in ("stable", "unstable"))
    assert stable[0][0] == pytest.approx(begins, rel=1e-8)
    assert stable[0][-1] == pytest.approx(breaks, rel=0.01)
    assert unstable[0][0] == pytest.approx(breaks, rel=0.01)
    assert stable[0][-1] == unstable[0][0] or stable[0][-1] > unstable[0][0]
    assert lines(ax)["faster stable"].get_linestyle() == "-"
    assert lines(ax)["faster unstable"].get_linestyle() == "--"
    k = len(stable[0]) // 2
    assert stable[1][k] == rk.theory.symmetric_modes(float(stable[0][k]), 1.0, 0.8, 1)[0].velocity


def test_slower_modes_are_dashed_then_inadmissible_and_end_where_their_speed_is_nothing():
    there = lines(rk.plot.modes(1.0, 0.8))
    assert "slower stable" not in there
    assert drawn(there["slower unstable"])[0][0] == pytest.approx(
        rk.theory.existence_amplitude(1.0, 0.8, 1), rel=1e-8
    )
    x, y = drawn(there["slower inadmissible"])
    omega = 2 * math.pi
    assert x[-1] == pytest.approx(math.tanh(0.25) * (1 + omega**2) / omega, rel=1e-8)
    assert 0 < y[-1] < 1e-8


def test_inadmissible_modes_are_dotted_and_named():
    ax = rk.plot.modes(0.4, 0.925, 3)
    x, _ = drawn(lines(ax)["faster inadmissible"])
    assert x[0] > 9
    assert x[-1] > rk.theory.symmetry_breaking_amplitude(0.4, 0.925, 3)
    texts = legend(ax)
    assert texts == ["stable", "unstable", "inadmissible", "faster", "slower"]


def test_phase_is_that_of_the_modes_and_the_line_is_interrupted_where_it_passes_pi():
    ax = rk.plot.modes(1.0, 0.8, quantity="phase", amplitude=15.0)
    assert lines(ax)["marked"].get_ydata() == [rk.theory.symmetric_modes(15.0, 1.0, 0.8, 1)[0].phase]
    y = lines(ax)["faster stable"].get_ydata()
    assert -math.pi < np.nanmin(y) < -3.0
    assert 3.0 < np.nanmax(y) <= math.pi
    assert np.nanmax(np.abs(np.diff(y))) < 0.5


def test_amplitude_asked_for_is_marked_and_within_the_picture_even_where_there_is_no_mode():
    marked = rk.plot.modes(1.0, 0.8, amplitude=100.0)
    (x,), (y,) = lines(marked)["marked"].get_data()
    assert (x, y) == (100.0, rk.theory.symmetric_modes(100.0, 1.0, 0.8, 1)[0].velocity)
    assert marked.get_xlim()[1] >= 100.0
    empty = rk.plot.modes(1.0, 0.8, amplitude=0.1)
    assert lines(empty)["amplitude"].get_xdata()[0] == 0.1
    assert "faster stable" in lines(empty)
    for ax in (marked, empty):
        assert [each.get_text() for each in ax.get_legend().get_texts()].count("given amplitude") == 1


def test_heading_of_a_block_has_the_period_in_seconds():
    block = rk.Block(2.0, 0.5)
    title = rk.plot.modes(1.0, 0.8, block=block).get_title(loc="right")
    assert f"$T = {block.seconds(1.0):.4g}$ s" in title


def test_melnikov_shows_both_functions_the_gap_and_the_thresholds():
    ax = rk.plot.melnikov(4.0, 1.0, 0.8)
    upper, lower, gap = ax.lines[:3]
    times = upper.get_xdata()
    np.testing.assert_allclose(upper.get_ydata(), rk.theory.melnikov_function(times, 4.0, 1.0, 0.8))
    np.testing.assert_allclose(lower.get_ydata(), rk.theory.melnikov_function(times, 4.0, 1.0, 0.8, "lower"))
    np.testing.assert_allclose(gap.get_ydata(), rk.theory.manifold_gap(2 * np.pi * times, 4.0, 1.0, 0.8))
    assert ax.get_title(loc="right") == "$A = 4$: $A_M = 3.643$, $A^* = 3.688$"


def test_heteroclinic_orbits_end_at_the_critical_angle_and_enclose_the_others():
    ax = rk.plot.heteroclinic()
    pair = ax.lines[:2]
    for line in pair:
        assert np.abs(line.get_xdata()).max() == pytest.approx(1.0, rel=3e-3)
    top = pair[0].get_ydata().max()
    inner = ax.lines[2:6]
    for turn, line in zip((0.2, 0.4, 0.6, 0.8), inner, strict=True):
        assert line.get_xdata().max() == pytest.approx(turn, rel=1e-3)
        assert line.get_ydata().max() == pytest.approx(top * math.sqrt(turn * (2 - turn)), rel=1e-3)


def test_thresholds_are_dotted_where_they_do_not_hold():
    periods = np.linspace(1, 2, 5)
    holds = [True, True, False, False, True]
    ax = rk.plot.thresholds(periods, {"a": periods, "b": (2 * periods, holds)})
    whole, solid, dotted = ax.lines
    assert [line.get_linestyle() for line in ax.lines] == ["-", "-", "--"]
    np.testing.assert_array_equal(drawn(whole)[0], periods)
    np.testing.assert_array_equal(drawn(solid)[0], periods[[0, 1, 2, 4]])
    np.testing.assert_array_equal(drawn(dotted)[0], periods[[2, 3, 4]])
    assert legend(ax) == ["a", "b"]
