"""Figures of branches, of curves of special points, of frequency responses, and of diagrams over a parameter."""

import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

import rocking as rk
from drawn import legend, points
from rocking.plot.curves import LOOKS as CURVES
from rocking.plot.palette import COLOURS, LOOKS
from surveyed import system_with

# Branches, curves and frequency responses.


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


# Orbit diagram.

CASCADE = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
VALUES = np.linspace(10.4, 11.5, 23)
BOTH = rk.orbit_diagram(CASCADE, amplitude=VALUES, cycles=8)
UP = rk.orbit_diagram(CASCADE, amplitude=VALUES, sweep="up", cycles=8)


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
    ax = rk.plot.orbit_diagram(rk.orbit_diagram(CASCADE, amplitude=[9.0, 9.5], cycles=3))
    assert [line.get_gid() for line in ax.lines] == ["up", "down"]


def test_all_overturned_is_still_a_picture():
    ax = rk.plot.orbit_diagram(rk.orbit_diagram(CASCADE, amplitude=[40.0, 50.0], sweep="rest", cycles=3))
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
    later = rk.orbit_diagram(CASCADE, amplitude=VALUES, sweep="up", cycles=2, section_phase=0.5)
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
    few = rk.orbit_diagram(CASCADE, amplitude=np.linspace(9, 10, 10), sweep="up", cycles=1)
    assert rk.plot.orbit_diagram(few).lines[0].get_markersize() == pytest.approx(3.0)
    many = rk.orbit_diagram(CASCADE, amplitude=np.linspace(10.735, 10.745, 1000), sweep="up", cycles=1000)
    ax = rk.plot.orbit_diagram(many)
    stream = io.BytesIO()
    ax.figure.savefig(stream, format="svg")
    assert len(stream.getvalue()) < 1_000_000
    stream = io.BytesIO()
    ax.figure.savefig(stream, dpi=150)
    red, _, blue = np.asarray(Image.open(stream).convert("RGB"), dtype=int).transpose(2, 0, 1)
    assert 0.02 < (blue - red > 60).mean() < 0.7


# Response diagram.

PLACES = [10.103037, 10.45, 10.5, 10.6, 10.9, 11.0]
TYPES = rk.response_diagram(CASCADE, amplitude=PLACES)


def colour_of(artist):
    return tuple(np.round(np.atleast_2d(artist.get_facecolor())[0][:3], 6))


def bands(figure):
    """Intervals of each category: name to a list of (low, high)."""
    return {
        band.get_gid(): [(path.vertices[:, 0].min(), path.vertices[:, 0].max()) for path in band.get_paths()]
        for band in figure.axes[0].collections
    }


def marks(ax):
    """Values and heights of all marks, by category."""
    return {line.get_gid(): line.get_xydata() for line in ax.lines if line.get_gid() != "zero"}


def test_bands_cover_the_range_once_and_end_half_way():
    drawn = bands(rk.plot.response_diagram(TYPES))
    assert set(drawn) == {"chaotic", "period 1, asymmetric", "even period", "overturned"}
    assert drawn["even period"] == [(pytest.approx(10.475), pytest.approx(10.75))]
    assert drawn["overturned"] == [(pytest.approx(10.75), 11.0)]
    assert sum(high - low for each in drawn.values() for low, high in each) == pytest.approx(11.0 - 10.103037)


def test_colours_are_those_of_the_types():
    figure = rk.plot.response_diagram(TYPES)
    shown = {band.get_gid(): band for band in figure.axes[0].collections}
    for name, kind in (("chaotic", rk.Kind.CHAOTIC), ("overturned", rk.Kind.OVERTURNED)):
        hexed = "#" + "".join(f"{round(255 * part):02X}" for part in colour_of(shown[name]))
        assert hexed == COLOURS[kind]
    named = [text.get_text() for text in figure.axes[2].get_legend().get_texts()]
    assert named == ["period 1, asymmetric", "even period", "chaotic", "overturned"]


def test_marks_lie_at_the_exponents_and_rotation_numbers_with_bars_of_the_errors():
    _, exponents, rotation = rk.plot.response_diagram(TYPES).axes
    for ax, heights in ((exponents, TYPES.exponent), (rotation, TYPES.rotation)):
        points = np.concatenate(list(marks(ax).values()))
        known = np.isfinite(heights)
        np.testing.assert_array_equal(
            points[np.argsort(points[:, 0])], np.column_stack([PLACES, heights])[known]
        )
    (bar,) = (bar for bar in exponents.containers if len(bar[2][0].get_segments()))
    (ends,) = bar[2][0].get_segments()
    error = TYPES.exponent_error[0]
    np.testing.assert_allclose(ends, [[PLACES[0], TYPES.exponent[0] + sign * error] for sign in (-1, 1)])
    (zero,) = (line for line in exponents.lines if line.get_gid() == "zero")
    assert list(zero.get_ydata()) == [0.0, 0.0]


def test_value_without_an_error_is_hollow():
    undamped = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    _, exponents, rotation = rk.plot.response_diagram(
        rk.response_diagram(undamped, amplitude=[3.9, 4.0])
    ).axes
    faces = [
        next(line for line in ax.lines if line.get_gid() == "quasi-periodic").get_markerfacecolor()
        for ax in (exponents, rotation)
    ]
    assert faces == ["white", COLOURS[rk.Kind.QUASI_PERIODIC]]


def test_exponent_of_minus_infinity_is_a_triangle_at_the_bottom():
    system = rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.5)
    ax = rk.plot.response_diagram(rk.response_diagram(system, amplitude=[0.9, 1.05, 1.3])).axes[1]
    (line,) = (line for line in ax.lines if line.get_gid() == "superstable")
    assert list(line.get_xdata()) == [0.9, 1.05]
    assert np.isfinite(ax.get_ylim()).all()


def test_a_diagram_of_overturned_or_single_responses_has_a_picture():
    for values in ([30.0, 31.0], [10.45]):
        figure = rk.plot.response_diagram(rk.response_diagram(CASCADE, amplitude=values))
        figure.canvas.draw()
        assert len(bands(figure)) == 1
