"""Figures of motions: the curves pass where the motion passes, corners, extremes and jumps included."""

import base64
import io
import re

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from drawn import artist, legend, points

# Time history.

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
BRACED = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0))
FALLING = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
FREE = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)
RECORD = rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.9, 0.0], step=0.4)
SHAKEN = rk.System(RECORD, restitution=0.9)
PUSHED = rk.System(rk.PiecewiseLinear([3.0, 3.0], step=2.0), restitution=0.9)
CHATTERING = rk.System(rk.Harmonic(amplitude=1.3, period=3.0), restitution=0.4)


def curve(ax):
    return points(ax, "motion").T


@pytest.mark.parametrize("system", [SYSTEM, BRACED, CHATTERING])
def test_curve_holds_every_event_and_every_extreme(system):
    motion = rk.simulate(system, cycles=30)
    time, angle = curve(rk.plot.time_history(motion))
    drawn = set(zip(time, angle, strict=True))
    assert len(motion.events) > 50
    assert {(event["time"], event["angle"]) for event in motion.events} <= drawn
    assert {turn["time"] for turn in motion.peaks} <= set(time)
    assert np.abs(angle).max() == pytest.approx(motion.peak, rel=1e-13, abs=0)


def test_curve_lies_on_the_motion_and_never_goes_back_in_time():
    motion = rk.simulate(SYSTEM, cycles=30)
    time, angle = curve(rk.plot.time_history(motion))
    np.testing.assert_allclose(angle, motion.at(time)[0], rtol=0, atol=1e-15)
    assert (np.diff(time) >= 0).all()
    assert time[0] == 0
    assert time[-1] == motion.duration


def test_chord_between_neighbours_is_thinner_than_a_line():
    motion = rk.simulate(BRACED, cycles=10)
    time, angle = curve(rk.plot.time_history(motion))
    between = (time[1:] + time[:-1]) / 2
    sagitta = np.abs(motion.at(between)[0] - (angle[1:] + angle[:-1]) / 2)
    # 2 in high, a line of 1 pt covers 1/144 of it
    assert sagitta.max() < np.ptp(angle) / 144 / 4


@pytest.mark.parametrize(
    ("cycles", "window"), [(200, None), (10_000, None), (200, (10, 20)), (200, (18.4, 18.6))]
)
def test_arcs_of_a_decay_are_smooth_wherever_the_window_ends(cycles, window):
    motion = rk.simulate(FREE, rk.State(angle=0.5), cycles=cycles)
    time, angle = curve(rk.plot.time_history(motion, cycles=window))
    between = (time[1:] + time[:-1]) / 2
    sagitta = np.abs(motion.at(between)[0] - (angle[1:] + angle[:-1]) / 2)
    assert sagitta.max() < np.ptp(angle) / 144 / 4


def test_rest_and_leaning_take_no_instants_from_the_grid():
    motion = rk.simulate(FREE, rk.State(angle=0.5), cycles=10_000)
    time, _ = curve(rk.plot.time_history(motion))
    assert np.count_nonzero(time > motion.events["time"][-1]) == 1


@pytest.mark.long
def test_long_motion_keeps_its_shape_and_its_file_stays_small(tmp_path):
    fast = rk.System(rk.Harmonic(amplitude=1000.0, period=0.0063), restitution=0.9)
    motion = rk.simulate(fast, cycles=10_000)
    for draw in (rk.plot.time_history, rk.plot.phase_portrait):
        ax = draw(motion)
        (line,) = (line for line in ax.lines if line.get_gid() == "motion")
        assert 400_000 < len(line.get_xdata()) < 600_000
        assert rk.plot.save(ax, tmp_path / "a.svg").stat().st_size < 500_000


def test_window_is_counted_in_forcing_cycles():
    motion = rk.simulate(BRACED, cycles=30)
    ax = rk.plot.time_history(motion, cycles=(10, 12.5))
    time, _ = curve(ax)
    assert (time[0], time[-1]) == (20.0, 25.0) == tuple(ax.get_xlim())


def test_overturning_is_followed_to_three_critical_angles():
    motion = rk.simulate(FALLING, cycles=50)
    time, angle = curve(rk.plot.time_history(motion))
    assert abs(angle[-1]) == pytest.approx(3.0, abs=1e-10)
    assert np.abs(angle[:-1]).max() < 3.0
    assert time[-1] > motion.overturning.time


def test_block_that_starts_past_three_critical_angles_is_shown_for_a_unit_of_time():
    motion = rk.simulate(FALLING, rk.State(angle=3.5), cycles=50)
    time, _ = curve(rk.plot.time_history(motion))
    assert (time[0], time[-1]) == (0.0, 1.0)


def test_slow_base_shows_the_fall_and_not_what_is_beyond_all_numbers(tmp_path):
    """Its cycle of overturning goes on for a thousand units of time, in which e^τ is no float any more."""
    motion = rk.simulate(rk.System(rk.Harmonic(2.0, period=1000.0), 0.9))
    for cycles in (None, (0, 1)):
        _, angle = curve(rk.plot.time_history(motion, cycles=cycles))
        assert np.isfinite(angle).all()
        assert abs(angle[-1]) == pytest.approx(3.0, abs=1e-10)
    with pytest.raises(
        ValueError, match=r"^cycles must begin before \|Θ\| = 3, in cycle 0\.00\d+; got \(0\.5, 1\)$"
    ):
        rk.plot.time_history(motion, cycles=(0.5, 1))
    assert rk.plot.animation(motion, tmp_path / "fall.gif", seconds=0.2).stat().st_size > 0


def test_block_at_rest_is_a_line_at_zero():
    still = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    _, angle = curve(rk.plot.time_history(rk.simulate(still, cycles=5)))
    assert not angle.any()


@pytest.mark.parametrize(
    ("system", "drawn"),
    [(SYSTEM, set()), (FALLING, {("critical angle", 1.0)}), (BRACED, {("braces", 1.0)})],
)
def test_critical_angle_and_braces_are_drawn_where_the_motion_comes_near(system, drawn):
    ax = rk.plot.time_history(rk.simulate(system, cycles=30))
    guides = {(line.get_gid(), abs(line.get_ydata()[0])) for line in ax.lines}
    assert {guide for guide in guides if guide[0] in ("critical angle", "braces")} == drawn


def panel(ax):
    """The curve of the base acceleration, and its axes below those of the angle."""
    above, below = ax.figure.axes
    assert above is ax
    return below, *points(below, "base").T


def test_record_stands_below_the_angle_with_every_sample_on_the_same_time_axis():
    motion = rk.simulate(SHAKEN)
    ax = rk.plot.time_history(motion)
    time, angle = curve(ax)
    below, when, base = panel(ax)
    np.testing.assert_allclose(angle, motion.at(time)[0], rtol=0, atol=1e-15)
    assert set(0.4 * np.arange(5)) <= set(when)
    np.testing.assert_allclose(base, RECORD.acceleration(when), rtol=0, atol=1e-15)
    assert ax.get_xlim() == below.get_xlim() == (0.0, motion.duration)
    assert ax.get_xlabel() == ""
    assert below.get_xlabel() == r"time $\tau = \alpha t$"
    assert below.get_ylabel() == "acceleration\nof base ($g\\theta_\\mathrm{cr}$)"


def test_block_gives_the_base_in_metres_per_square_second():
    block = rk.Block(height=2.0, width=0.5)
    ground = rk.example_ground_motion().scaled(pga=6.0)
    ax = rk.plot.time_history(rk.simulate(block.system(ground, model="slender")), block=block)
    below, when, base = panel(ax)
    assert below.get_ylabel() == "acceleration\nof base (m/s²)"
    assert np.abs(base).max() == pytest.approx(6.0)
    assert when[-1] == pytest.approx(ground.duration)
    levels = {line.get_ydata()[0] for line in below.lines if line.get_gid() == "lift-off from rest"}
    assert sorted(levels) == pytest.approx([-9.80665 * 0.25, 9.80665 * 0.25])  # g tan θcr


def test_block_against_a_wall_has_one_line_of_the_base_acceleration_that_lifts_it_off():
    block = rk.Block(2.0, 0.5, wall=rk.Wall(0.5))
    motion = rk.simulate(block.system(rk.example_ground_motion().scaled(pga=6.0)))
    figure = rk.plot.overview(motion)
    figure.draw_without_rendering()  # matplotlib warns of a text at infinity
    lines = [line for line in figure.axes[1].lines if line.get_gid() == "lift-off from rest"]
    assert [line.get_ydata()[0] for line in lines] == pytest.approx([-9.80665 * 0.25])
    (name,) = (text for text in figure.axes[1].texts if text.get_text() == "lift-off from rest")
    assert (name.get_position()[1], name.get_va()) == (lines[0].get_ydata()[0], "top")


def test_block_against_a_wall_has_a_critical_angle_on_one_side():
    system = rk.System(rk.Pulse("half-sine", amplitude=-2.0, duration=2.0), 0.5, left=rk.Wall(0.5))
    ax = rk.plot.time_history(rk.simulate(system))
    assert [line.get_ydata()[0] for line in ax.lines if line.get_gid() == "critical angle"] == [1.0]


@pytest.mark.parametrize(("wall", "signs"), [(None, (-1, 1)), (rk.Wall(0.5), (-1,))])
def test_levels_of_lift_off_follow_the_vertical_acceleration(wall, signs):
    block, ground = rk.Block(2.0, 0.6, wall=wall), rk.GroundMotion([0.0, 4.0, -4.0, 0.0], step=0.5)
    up = rk.GroundMotion([0.0, 2.0, -3.0, 0.0], step=0.5)
    ax = rk.plot.time_history(rk.simulate(block.system(ground, vertical=up)), block=block)
    lines = [line.get_xydata() for line in panel(ax)[0].lines if line.get_gid() == "lift-off from rest"]
    ax.figure.draw_without_rendering()  # matplotlib warns of a text at infinity
    for line, sign in zip(lines, signs, strict=True):
        when, level = line.T
        expected = sign * 0.3 * (9.80665 + np.interp(when, up.times, up.acceleration))
        np.testing.assert_allclose(level, expected, rtol=0, atol=1e-12)


def test_pulse_stands_below_the_angle():
    pulse = rk.Pulse("half-sine", amplitude=3.0, duration=2.0)
    _, when, base = panel(rk.plot.time_history(rk.simulate(rk.System(pulse, restitution=0.9))))
    np.testing.assert_allclose(base, pulse.acceleration(when), rtol=0, atol=1e-15)


def test_jump_at_the_end_of_a_record_is_drawn_as_a_jump():
    motion = rk.simulate(rk.System(rk.PiecewiseLinear([1.2, 1.2], step=0.5), restitution=0.9))
    _, when, base = panel(rk.plot.time_history(motion))
    assert base[when <= 0.5] == pytest.approx(1.2)
    assert not base[when > 0.5].any()
    assert np.diff(when)[when[1:] > 0.5][0] < motion.duration / 900


def test_overturning_under_a_record_is_followed_to_three_critical_angles():
    motion = rk.simulate(PUSHED)
    time, angle = curve(rk.plot.time_history(motion))
    assert motion.outcome == "overturned"
    assert abs(angle[-1]) == pytest.approx(3.0, abs=1e-10)
    assert time[-1] > motion.overturning.time


def test_axes_given_show_the_angle_alone():
    _, (_, right) = rk.plot.panels(columns=2)
    assert rk.plot.time_history(rk.simulate(SHAKEN), ax=right) is right
    assert len(right.figure.axes) == 2
    assert right.get_xlabel() == r"time $\tau = \alpha t$"


# Phase portrait: jumps are vertical lines, arcs are curves.

REBOUNDING = rk.System(
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
    motion = rk.simulate(REBOUNDING, cycles=40)
    drawn = strokes(rk.plot.phase_portrait(motion), "brace")
    assert len(drawn) == motion.brace_hits > 20
    assert set(np.abs(drawn[:, :, 0]).ravel()) == {1.0}
    np.testing.assert_allclose(drawn[:, 1, 1], -0.8 * drawn[:, 0, 1], rtol=1e-14)


@pytest.mark.parametrize("kind", ["impact", "brace"])
def test_marks_sit_at_both_ends_of_the_strokes(kind):
    ax = rk.plot.phase_portrait(rk.simulate(REBOUNDING, cycles=40))
    ends = strokes(ax, kind)
    np.testing.assert_array_equal(points(ax, f"{kind} before"), ends[:, 0])
    np.testing.assert_array_equal(points(ax, f"{kind} after"), ends[:, 1])


def test_curve_never_crosses_a_jump():
    motion = rk.simulate(REBOUNDING, cycles=40)
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
    assert names(REBOUNDING) == ["before impact", "after impact", "before brace impact", "after brace impact"]


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


# Overview: both, in a notebook above the printed line.


@pytest.mark.parametrize("record", ["all", "section", "none"])
@pytest.mark.parametrize("system", [SYSTEM, FALLING])
def test_notebook_shows_a_picture_that_is_not_blank(system, record):
    html = rk.simulate(system, cycles=60, record=record)._repr_html_()
    (encoded,) = re.findall(r'src="data:image/png;base64,([^"]+)"', html)
    image = Image.open(io.BytesIO(base64.b64decode(encoded)))
    assert image.format == "PNG"
    assert np.asarray(image.convert("L")).std() > 10


def test_long_bounded_motion_is_shown_by_its_last_cycles():
    history, _ = rk.plot.overview(rk.simulate(SYSTEM, cycles=200)).axes
    assert history.get_xlim() == (170.0, 200.0)


def test_overturning_is_shown_from_the_start():
    history, _ = rk.plot.overview(rk.simulate(FALLING, cycles=200)).axes
    assert history.get_xlim()[0] == 0.0


def test_block_gives_si_axes():
    figure = rk.plot.overview(rk.simulate(SYSTEM, cycles=20), rk.Block(height=2.0, width=0.5))
    assert [ax.get_xlabel()[-4:] for ax in figure.axes] == [" (s)", " (°)"]


@pytest.mark.parametrize("cycles", [200, 10_000])
def test_decay_is_shown_until_shortly_after_its_last_impact(cycles):
    motion = rk.simulate(FREE, rk.State(angle=0.5), cycles=cycles)
    last = motion.events["time"][-1]
    history, _ = rk.plot.overview(motion).axes
    assert history.get_xlim() == pytest.approx((0.0, 1.15 * last))


def test_rest_under_a_shaken_base_is_shown_for_a_cycle_at_least():
    shaken = rk.System(rk.Harmonic(amplitude=0.3, period=6.0), restitution=0.5)
    motion = rk.simulate(shaken, rk.State(angle=0.1), cycles=50)
    last = motion.events["time"][-1]
    assert motion.outcome == "at-rest"
    history, _ = rk.plot.overview(motion).axes
    assert history.get_xlim() == pytest.approx((0.0, last + 6.0))


def test_block_that_never_rocks_is_shown_whole():
    history, portrait = rk.plot.overview(rk.simulate(FREE, cycles=5)).axes
    assert history.get_xlim() == (0.0, 5.0)
    assert portrait.lines


def test_record_stands_below_the_time_history_beside_the_phase_portrait():
    motion = rk.simulate(SHAKEN)
    above, below, right = rk.plot.overview(motion).axes
    assert [ax.get_title(loc="left") for ax in (above, below, right)] == ["(a)", "(b)", "(c)"]
    assert above.get_xlim() == below.get_xlim() == (0.0, motion.duration)
    assert right.get_xlabel() == r"angle $\Theta = \theta/\theta_\mathrm{cr}$"


@pytest.mark.parametrize("record", ["all", "none"])
def test_notebook_shows_a_motion_under_a_record(record):
    assert "data:image/png;base64," in rk.simulate(SHAKEN, record=record)._repr_html_()


def test_what_holds_a_block_stands_in_the_line_without_a_note():
    """The second line has the note at the right beside it."""
    block = rk.Block(2.0, 0.5, offset=0.05, wall=rk.Wall(0.5))
    figure = rk.plot.overview(rk.simulate(block.system(rk.example_ground_motion())), block)
    assert figure.axes[0].get_title(loc="left").split("\n") == [
        "(a) block 2 m × 0.5 m, at a wall",
        "offset 0.05 m, full equation",
    ]
