"""Figures of branches, of curves of special points and of frequency responses."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import rocking as rk
from drawn import legend, points
from rocking.plot.curves import LOOKS as CURVES
from rocking.plot.palette import LOOKS
from surveyed import system_with


@pytest.fixture(scope="module")
def family():
    """A symmetric branch with its fold, grazing and symmetry breaking, the pair born there, and the doubled one."""
    system = rk.System(rk.Harmonic(amplitude=7.0, period=1.721328), restitution=0.8)
    symmetric = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.1, 11.5))
    (breaking,) = (point for point in symmetric.special if point.kind == "symmetry-breaking")
    pair = rk.switch_branch(breaking, (7.0, 11.5))
    (doubling, *_) = (point for point in pair[0].special if point.kind == "period-doubling")
    return [symmetric, *pair, *rk.switch_branch(doubling, (10.0, 11.5))]


@pytest.fixture(scope="module")
def response():
    return rk.frequency_response(
        system_with(amplitude=6.0, restitution=0.8), period=np.linspace(0.2, 3.0, 29)
    )


def test_every_special_point_has_its_marker_on_the_line(family):
    ax = rk.plot.branch(family)
    for kind in ("fold", "symmetry-breaking", "period-doubling", "grazing"):
        expected = [special for one in family for special in one.special if special.kind == kind]
        marks = points(ax, kind)
        assert marks[:, 0].tolist() == [special.parameter for special in expected]
        lines = np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() != "None"])
        for mark in marks:  # as near as the branch's points lie to each other
            assert np.nanmin(np.hypot(*(lines - mark).T)) < 0.02
    names = ["fold", "symmetry breaking", "period doubling", "grazing"]
    assert legend(ax)[-4:] == names


def test_stable_parts_are_solid_unstable_dashed_and_no_point_is_left_out(family):
    ax = rk.plot.branch(family, quantity="angle", phase=1.0)
    for symmetry, branches in (("symmetric", family[:1]), ("asymmetric", family[1:])):
        for word, is_stable in (("stable", True), ("unstable", False)):
            lines = [line for line in ax.lines if line.get_gid() == f"{symmetry}, {word}"]
            assert {line.get_linestyle() for line in lines} == {"-" if is_stable else "--"}
            shown = np.concatenate([line.get_xydata() for line in lines])
            shown = {tuple(point) for point in shown[np.isfinite(shown[:, 1])]}
            for one in branches:
                own = one.points["stable"] == is_stable
                own[0] &= one.symmetric  # where it is born it is neither
                for cycle in range(one.period):
                    heights = one.section(1.0)[own, cycle, 0]
                    assert set(zip(one.points["parameter"][own], heights, strict=True)) <= shown


def test_a_fold_is_where_its_line_turns():
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.8)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.1, 3.0))
    ax = rk.plot.branch(branch)
    (fold,) = (special.parameter for special in branch.special if special.kind == "fold")
    for word in ("stable", "unstable"):
        line = points(ax, f"symmetric, {word}")
        assert line[np.isfinite(line[:, 1]), 0].min() == fold < branch.points["parameter"].min()


def test_curves_have_a_look_a_kind():
    system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.01, 30.0))
    ranges = ((1.0, 2.0), (0.01, 40.0))
    curves = [rk.bifurcation_curve(point, "period", "amplitude", ranges) for point in branch.special]
    ax = rk.plot.bifurcation_curve(curves)
    assert sorted(line.get_gid() for line in ax.lines) == sorted(point.kind for point in branch.special)
    assert len({(line.get_color(), line.get_linestyle()) for line in ax.lines}) == len(curves) == 3
    for curve, line in zip(curves, ax.lines, strict=True):
        np.testing.assert_array_equal(line.get_xydata(), curve.points)


def test_legend_of_two_types_of_curves_lies_within_the_figure():
    system = rk.System(rk.Harmonic(4.0, period=2.0), 0.9)
    found = rk.bifurcation_set(system, 1, grid=3, period=(1.5, 2.5), amplitude=(3.0, 12.0))
    ax = rk.plot.bifurcation_curve(found.curves)
    ax.figure.canvas.draw()
    assert legend(ax) == ["period doubling, period 1", "symmetry breaking, period 1"]
    box, page = ax.get_legend().get_window_extent(), ax.figure.bbox
    assert page.x0 <= box.x0 < box.x1 <= page.x1


def test_types_of_curves_have_no_colour_of_a_map_and_a_white_edge():
    """Each differs from every colour of a map by a tenth of the range of a channel at least."""
    shown = [to_rgb(look.colour) for look in LOOKS]
    for colour, _ in CURVES.values():
        assert min(np.abs(np.subtract(to_rgb(colour), each)).max() for each in shown) > 0.1
    system = rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9)
    ax = rk.plot.bifurcation_set(
        rk.bifurcation_set(system, 1, grid=2, period=(1.9, 2.1), amplitude=(3.0, 8.0))
    )
    for line in (line for line in ax.lines if line.get_gid() != "codimension-2"):
        (edge, _) = line.get_path_effects()
        assert edge._gc["foreground"] == "white"
        assert edge._gc["linewidth"] >= line.get_linewidth() + 2.0


def test_multipliers_of_a_neutral_branch_have_ticks_in_plain_numbers():
    system = rk.System(rk.Harmonic(amplitude=1.5, period=1.0), restitution=1.0)
    orbit = next(orbit for orbit in rk.find_orbits(system, 1) if orbit.stability == "neutral")
    ax = rk.plot.branch(rk.continue_orbit(orbit, "amplitude", (0.2, 3.0)), quantity="multiplier")
    ax.figure.canvas.draw()
    low, high = ax.get_ylim()
    texts = [tick.get_text() for tick in ax.get_yticklabels() if low <= tick.get_position()[1] <= high]
    assert texts == ["0.5", "1", "2"]
    assert not ax.yaxis.get_minorticklabels()


def test_what_a_start_from_rest_does_is_marked_at_every_value(response):
    ax = rk.plot.frequency_response(response)
    rest, values = response.rest, response.values
    marked = []
    for kind in set(rest["kind"]) - {"overturned"}:
        shown = points(ax, f"rest {kind}")
        heights = np.where(np.isnan(rest["steady_peak"]), rest["peak"], rest["steady_peak"])
        np.testing.assert_array_equal(shown, np.column_stack([values, heights])[rest["kind"] == kind])
        marked += shown[:, 0].tolist()
    bars = points(ax, "overturned")
    ends = bars[:, 0].reshape(-1, 3)[:, :2]
    covered = [bool(((ends[:, 0] <= value) & (value <= ends[:, 1])).any()) for value in values]
    assert covered == (rest["kind"] == "overturned").tolist()
    assert any(covered)
    assert len(marked) + sum(covered) == len(values)


def test_every_mode_has_a_colour_and_every_branch_a_line(response):
    ax = rk.plot.frequency_response(response)
    colours = []
    for n in (1, 3):
        lines = [line for line in ax.lines if str(line.get_gid()).startswith(f"(1, {n})")]
        assert len({line.get_color() for line in lines}) == 1
        colours.append(lines[0].get_color())
        shown = np.concatenate([line.get_xydata() for line in lines])
        for branch in response.of(n):
            assert set(branch.points["peak"]) <= set(shown[:, 1])
    assert colours[0] != colours[1]


def test_where_there_is_nothing_to_follow_it_shows_what_a_start_from_rest_does():
    ax = rk.plot.frequency_response(
        rk.frequency_response(system_with(amplitude=0.05, restitution=0.5), period=[0.5, 1.0])
    )
    assert legend(ax) == ["from rest: rest"]
