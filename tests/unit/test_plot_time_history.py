"""The time history passes where the motion passes, corners and extremes included."""

import numpy as np
import pytest

import rocking as rk
from drawn import points

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
    ax = rk.plot.time_history(rk.simulate(block.system(ground)), block=block)
    below, when, base = panel(ax)
    assert below.get_ylabel() == "acceleration\nof base (m/s²)"
    assert np.abs(base).max() == pytest.approx(6.0)
    assert when[-1] == pytest.approx(ground.duration)
    levels = {line.get_ydata()[0] for line in below.lines if line.get_gid() == "lift-off from rest"}
    assert levels == {block.acceleration(1.0), -block.acceleration(1.0)}


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
