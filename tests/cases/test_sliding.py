"""Slip of a block that does not rock: closed forms, Runge-Kutta steps of order 8 with events, and symmetries. First motions."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import rocking as rk
from rocking.motion.sliding import base_of

GRAVITY = 9.80665
ELCENTRO = Path(__file__).parents[3] / "shared" / "records" / "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"


def noise(seed, count=60):
    """Random ground motion with PGA from 0.3 g to 1.2 g."""
    rng = np.random.default_rng(seed)
    smooth = np.hanning(rng.integers(3, 9))
    values = np.convolve(rng.normal(size=count), smooth, "same") * np.sin(np.linspace(0.2, 3.0, count))
    step = math.exp(rng.uniform(-4.5, -1.5))
    return rk.GroundMotion(values, step=step).scaled(pga=GRAVITY * rng.uniform(0.3, 1.2))


def by_runge_kutta(corners, acceleration, friction):
    """Final slip, largest |slip|, and intervals of sliding, by DOP853 with events between corners of the acceleration (m/s²).

    The first part of a slide, in which the speed is 0 at the start, has no event.
    """
    place = speed = largest = 0.0
    direction, starts, stops = 0, [], []
    limit = friction * GRAVITY
    how = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15}

    def speed_of(_, state):
        return state[1]

    speed_of.terminal = True

    def excess(time):
        return abs(acceleration(time)) - limit

    def steps(time, end, **more):
        forces = lambda t, y: [y[1], -acceleration(t) - limit * direction]  # noqa: E731
        return solve_ivp(forces, (time, end), [place, speed], first_step=(end - time) / 2, **how, **more)

    for start, end in pairwise(corners):
        time = start
        while time < end:
            if direction == 0:
                times = time + (end - time) * np.clip(np.linspace(0, 1, 13), 1e-9, 1 - 1e-9)
                over = [excess(each) > 0 for each in times]
                if not any(over):
                    break
                first = over.index(True)
                time = brentq(excess, times[first - 1], times[first], xtol=1e-15) if first else time
                direction = -int(np.sign(acceleration(times[first])))
                starts.append(time)
                found = steps(time, time + 1e-3 * (end - time))
                time, (place, speed) = found.t[-1], found.y[:, -1]
            speed_of.direction = -direction
            found = steps(time, end, events=speed_of)
            time, (place, speed) = found.t[-1], found.y[:, -1]
            largest = max(largest, abs(place))
            if found.status == 1:
                speed, direction = 0.0, 0
                stops.append(time)
    return place, largest, np.array(list(zip(starts, stops, strict=True))).reshape(-1, 2)


def lines(ground):
    """Acceleration of a ground motion as a function of time, by straight lines between its samples."""
    values, step = [*ground.acceleration.tolist(), 0.0], ground.step

    def acceleration(time):
        place = int(time / step)
        if time >= ground.duration:
            return 0.0
        return values[place] + (values[place + 1] - values[place]) * (time / step - place)

    return acceleration


def compared(ground, corners, acceleration, friction):
    """Compare a slip with that by Runge-Kutta steps; return the number of slides."""
    found = rk.slide(ground, friction)
    last, largest, intervals = by_runge_kutta(corners, acceleration, friction)
    assert len(found.intervals) == len(intervals)
    np.testing.assert_allclose(found.intervals, intervals, rtol=0, atol=1e-7)
    assert found.residual == pytest.approx(last, abs=1e-8)
    assert found.largest == pytest.approx(largest, abs=1e-8)
    return len(intervals)


@pytest.mark.parametrize("first", range(0, 60, 10))
def test_slip_under_random_motions_is_that_of_runge_kutta_steps(first):
    slides = 0
    for seed in range(first, first + 10):
        ground = noise(seed)
        friction = float(np.random.default_rng((seed, 1)).uniform(0.05, 0.95)) * ground.pga / GRAVITY
        rest = ground.duration + 2 * ground.pgv / (friction * GRAVITY) + 1.0
        slides += compared(ground, np.append(ground.times, rest), lines(ground), friction)
    assert slides >= 20


@pytest.mark.parametrize(
    "kind", ["half-sine", "one-sine", "one-cosine", "triangular", "trapezoidal", "rectangular"]
)
def test_slip_under_pulses_is_that_of_runge_kutta_steps(kind):
    rng, slides = np.random.default_rng(3), 0
    for _ in range(5):
        amplitude, duration = rng.choice((-1, 1)) * rng.uniform(1.0, 9.0), rng.uniform(0.1, 1.5)
        pulse = rk.Pulse(kind, amplitude=amplitude, duration=duration)
        friction = rng.uniform(0.1, 0.9) * abs(amplitude) / GRAVITY
        corners = np.append(
            np.linspace(0, duration, 41), duration + 2 * abs(amplitude) * duration / (friction * GRAVITY)
        )

        def acceleration(time, pulse=pulse):
            return float(pulse.acceleration(time)) if time < pulse.duration else 0.0

        slides += compared(pulse, corners, acceleration, friction)
    assert slides >= 5


@pytest.mark.parametrize("kind", ["half-sine", "one-sine", "one-cosine"])
def test_marks_of_a_pulse_are_its_extremes_and_all_crossings_of_the_friction(kind):
    for amplitude in (-5.0, 5.0):
        pulse = rk.Pulse(kind, amplitude=amplitude, duration=1.7)
        base = base_of(pulse, 2.0)
        np.testing.assert_allclose(base.values, pulse.acceleration(base.marks), rtol=0, atol=1e-14)
        times = np.linspace(0, 1.7, 10_001)
        values = pulse.acceleration(times)
        for level in (-2.0, 2.0):
            crossings = np.count_nonzero(np.diff(np.sign(values - level)))
            assert np.count_nonzero(base.values == level) == crossings
        turns = np.count_nonzero(np.diff(np.sign(np.diff(values))))
        assert np.count_nonzero(np.abs(base.values[1:-1]) == 5.0) == turns


@pytest.mark.parametrize(
    ("amplitude", "duration", "friction", "slip"), [(0.6, 0.5, 0.3, 0.73549875), (1.0, 0.2, 0.25, 0.588399)]
)
def test_slip_under_a_rectangular_pulse_is_that_of_the_closed_form(amplitude, duration, friction, slip):
    closed = (amplitude * GRAVITY * duration) ** 2 / (2 * GRAVITY) * (1 / friction - 1 / amplitude)
    assert closed == pytest.approx(slip, rel=1e-12, abs=0)
    for ground in (
        rk.Pulse("rectangular", amplitude=amplitude * GRAVITY, duration=duration),
        rk.GroundMotion([amplitude * GRAVITY] * 2, step=duration),
        rk.GroundMotion([amplitude * GRAVITY] * 201, step=duration / 200),
    ):
        found = rk.slide(ground, friction)
        assert found.largest == pytest.approx(slip, rel=1e-12, abs=0)
        assert found.residual == -found.largest
        assert found.path == found.largest


def test_slip_does_not_depend_on_direction_and_scales_with_the_motion():
    ground = noise(6)
    found = rk.slide(ground, 0.2)
    reversed_ = rk.slide(ground.reversed(), 0.2)
    assert len(found.intervals) > 3
    assert reversed_.residual == -found.residual
    np.testing.assert_array_equal(reversed_.intervals, found.intervals)
    twice = rk.slide(ground.scaled(2.0), 0.4)
    assert twice.largest == pytest.approx(2 * found.largest, rel=1e-12, abs=0)
    np.testing.assert_allclose(twice.intervals, found.intervals, rtol=0, atol=1e-13)
    slower = rk.slide(rk.GroundMotion(ground.acceleration, step=3 * ground.step), 0.2)
    assert slower.largest == pytest.approx(9 * found.largest, rel=1e-11, abs=0)


def test_more_samples_of_the_same_straight_lines_give_the_same_slip():
    ground = noise(11)
    times = np.linspace(0, ground.duration, 7 * (ground.times.size - 1) + 1)
    finer = rk.GroundMotion(np.interp(times, ground.times, ground.acceleration), step=ground.step / 7)
    first, second = rk.slide(ground, 0.1), rk.slide(finer, 0.1)
    np.testing.assert_allclose(first.intervals, second.intervals, rtol=0, atol=1e-11)
    assert first.residual == pytest.approx(second.residual, abs=1e-12)


def test_a_base_acceleration_up_to_the_friction_moves_nothing():
    for values in ([0.0], [2.0], [1.0, -2.0, 2.0, 2.0, -2.0]):
        ground = rk.GroundMotion(np.array(values), step=0.1)
        found = rk.slide(ground, 2.0 / GRAVITY)
        assert (found.largest, found.residual, len(found.intervals), str(found)) == (
            0.0,
            0.0,
            0,
            "does not slide",
        )


def test_path_obeys_the_equation_of_motion():
    found = rk.slide(noise(5), 0.15)
    ground, step = noise(5), 1e-4 * noise(5).step
    times = np.random.default_rng(1).uniform(0, found.intervals[-1, 1] + 0.1, 4_000)
    (before, _), (here, speed), (after, _) = (found.at(times + shift) for shift in (-step, 0.0, step))
    inside = ((found.intervals[:, :1] < times - step) & (times + step < found.intervals[:, 1:])).any(axis=0)
    marks = np.concatenate([ground.times, found.intervals.ravel()])
    clear = np.abs(times[:, None] - marks).min(axis=1) > 2 * step
    acceleration = np.interp(times, ground.times, ground.acceleration, right=0.0)
    expected = np.where(inside, -acceleration - 0.15 * GRAVITY * np.sign(speed), 0.0)
    found_there = (before - 2 * here + after) / step**2
    size = 1e-15 * found.largest / step**2
    np.testing.assert_allclose(found_there[clear], expected[clear], rtol=0, atol=1e-5 + 20 * size)
    assert (speed[~inside & clear] == 0).all()
    assert np.count_nonzero(inside & clear) > 500


def test_history_holds_the_path_at_the_samples_and_at_all_starts_and_stops():
    ground = noise(5)
    found = rk.slide(ground, 0.15)
    data = found.dataset
    slip, speed = found.at(data.time_s.values)
    np.testing.assert_array_equal(data.slip_m.values, slip)
    np.testing.assert_array_equal(data.slip_velocity_m_per_s.values, speed)
    assert set(ground.times) | set(found.intervals.ravel()) <= set(data.time_s.values.tolist())
    assert (
        data.slip_m.values[-1] == found.residual == pytest.approx(data.slide_slip_m.values.sum(), abs=1e-15)
    )
    assert np.abs(data.slip_m.values).max() == found.largest
    assert found.at(-1.0) == (0.0, 0.0)
    assert found.at(1e6)[0] == found.residual


@pytest.mark.skipif(not ELCENTRO.exists(), reason="file absent")
def test_slip_under_el_centro_is_that_of_runge_kutta_steps():
    ground = rk.read_ground_motion(ELCENTRO)
    compared(ground, np.append(ground.times, ground.duration + 1.0), lines(ground), 0.1)


# First motion.


def start_of_rocking(block, acceleration):
    """H/Mg and N/Mg of a rectangle that starts to turn about its edge: two equations of forces and one of moments."""
    half, high = block.width / 2, block.height / 2
    inertia = (block.width**2 + block.height**2) / 12
    # Unknowns: angular acceleration about the edge, H, N, for unit mass; the centre moves by (-high, half) per unit of angle.
    matrix = [[high, 1, 0], [-half, 0, 1], [inertia, -high, half]]
    _, across, up = np.linalg.solve(matrix, [acceleration * GRAVITY, GRAVITY, 0])
    return across / GRAVITY, up / GRAVITY


def test_first_motion_is_that_of_the_equations_of_forces_and_moments():
    rng, seen = np.random.default_rng(1), set()
    for _ in range(1_000):
        block = rk.Block(height=rng.uniform(0.5, 3), width=rng.uniform(0.1, 2.5), restitution=0.5)
        level = block.width / block.height
        friction, acceleration = level * rng.uniform(0.2, 2.5), level * rng.uniform(0.2, 6)
        expected = "rest"
        if friction <= level:
            expected = "slide" if acceleration > friction else "rest"
        elif acceleration > level:
            across, up = start_of_rocking(block, acceleration)
            expected = "rock" if across <= friction * up else "slide-rock"
        assert rk.theory.first_motion(block.critical_angle, friction, -acceleration) == expected
        seen.add(expected)
    assert seen == {"rest", "slide", "rock", "slide-rock"}


@pytest.mark.parametrize(("width", "friction", "onset"), [(0.5, 0.3, 0.45732), (0.6, 0.35, 0.50861)])
def test_onset_of_slide_rock_is_known(width, friction, onset):
    block = rk.Block(height=2.0, width=width)
    found = rk.theory.slide_rock_acceleration(block.critical_angle, friction)
    assert found == pytest.approx(onset, abs=5e-6)
    across, up = start_of_rocking(block, found)
    assert across / up == pytest.approx(friction, rel=1e-13, abs=0)


def test_needed_friction_at_the_start_of_a_motion_is_that_of_the_chart():
    block = rk.Block(height=2.0, width=0.6)
    for friction in (0.32, 0.35, 0.4):
        onset = rk.theory.slide_rock_acceleration(block.critical_angle, friction)
        for share, slides in ((1 - 1e-9, False), (1 + 1e-9, True)):
            pulse = rk.Pulse("rectangular", amplitude=share * onset * GRAVITY, duration=0.05)
            report = rk.simulate(block.system(pulse)).validity(block, friction=friction)
            assert (report.slides_from == 0.0) is slides


def test_onset_of_slide_rock_at_its_limits():
    angle = 0.3
    level = math.tan(angle)
    onset = rk.theory.slide_rock_acceleration
    assert math.isnan(onset(angle, level * (1 - 1e-12)))
    assert onset(angle, level * (1 + 1e-9)) == pytest.approx(level, rel=1e-7, abs=0)
    never = (1 - 0.75 * math.cos(angle) ** 2) / (0.75 * math.sin(angle) * math.cos(angle))
    assert onset(angle, never * (1 - 1e-6)) > 1e5
    assert onset(angle, never * (1 + 1e-6)) == math.inf
