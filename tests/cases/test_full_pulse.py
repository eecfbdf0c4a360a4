"""The full block under pieces of a sine or a cosine, against collocation in many digits and numbers that others found."""

import math
from typing import NamedTuple

import mpmath as mp
import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

import rocking as rk
from oracles.full_block import DIGITS, Block, Pulse
from rocking.kernels import contract
from rocking.kernels.arc import full_base
from rocking.motion.march_loop import parameters

ROUNDING = 2.0**-53
FORMS = {"half-sine": (0.5, -math.pi / 2), "one-sine": (1.0, -math.pi / 2), "one-cosine": (1.0, 0.0)}
"""Turns and phase of each pulse."""
ROUNDINGS = 12
"""Roundings that the error of a state may reach, each amplified as much as errors of the inputs are."""
INPUTS = ("amplitude", "duration", "restitution")
CHANGE = 1e-9
"""Relative change of an input from which that amplification is found."""
SURE = 0.1
"""Time after the proof of overturning at which the states of a falling block are compared."""


class Case(NamedTuple):
    """Block under a pulse whose amplitude is in units of that of lift-off, and a time at which the states are compared."""

    kind: str
    level: float
    duration: float
    angle: float
    restitution: float
    time: float = math.inf  # infinite: soon after the proof of overturning
    impacts: tuple[int, int] | None = (
        None  # in the pulse and after it, up to that time; None: too many, with a rest
    )
    start: tuple[float, float] = (0.0, 0.0)

    @property
    def amplitude(self):
        return round(self.level * math.tan(self.angle) / self.angle, 6)

    @property
    def system(self):
        pulse = rk.Pulse(self.kind, amplitude=self.amplitude, duration=self.duration)
        return rk.System(pulse, self.restitution, critical_angle=self.angle)

    def exact(self, time, changed=""):
        """Return angle and velocity of the oracle, and its impacts; one input may be changed."""
        amplitude, duration, restitution = (
            mp.mpf(getattr(self, name)) * (1 + CHANGE * (name == changed)) for name in INPUTS
        )
        turns, phase = FORMS[self.kind]
        frequency = mp.mpf(2 * math.pi * turns / self.duration) * self.duration / duration
        block = Block(Pulse(amplitude, frequency, phase, duration), restitution, self.angle)
        angle, velocity, impacts = block.final(time, *self.start)
        return np.array([angle, velocity]), impacts


FLYING = [
    Case("half-sine", 1.5, 2.0, 0.05, 0.9, 4.0, (0, 1)),
    Case("half-sine", 1.15, 2.5, 0.3, 0.9, 6.0, (0, 8)),
    Case("half-sine", 1.3, 1.0, 0.6, 0.7, 1.9, (0, 3)),
    Case("one-sine", 1.5, 1.5, 0.1, 0.9, 4.0, (1, 1)),
    Case("one-sine", 1.2, 3.0, 0.5, 0.9, 6.0, (1, 1)),
    Case("one-sine", -3.0, 0.8, 0.6, 0.7, 4.0, (0, 6)),
    Case("one-cosine", 2.5, 1.5, 0.4, 0.7, 3.0, (1, 1)),
    Case("one-cosine", 2.0, 2.0, 0.5, 0.9, 5.0, (2, 2), (0.3, -0.2)),
]
FALLING = [
    Case("half-sine", 2.5, 3.0, 0.2, 0.7, impacts=(0, 0)),
    Case("one-sine", 5.0, 1.25, 0.25, 0.9, impacts=(0, 1)),
    Case("one-sine", 9.0, 1.25, 0.25, 0.9, impacts=(0, 0)),
    Case("one-sine", 0.8, 2.0, 0.3, 0.9, impacts=(1, 0), start=(-0.4, 0.1)),
    Case("one-cosine", 1.2, 4.0, 0.2618, 0.9, impacts=(4, 0)),
    Case("one-cosine", 1.6, 4.0, 0.2618, 0.9, impacts=(1, 0)),
    Case("one-cosine", -9.0, 3.0, 0.05, 0.9, impacts=(0, 0)),
]
# They rest before the end of the pulse, and lift off again before it.
RESTING = [
    Case("one-sine", 1.05, 3.0, 0.25, 0.5, 2.3),
    Case("one-cosine", 1.1, 6.0, 0.6, 0.2, 6.1),
    Case("one-cosine", 1.2, 6.0, 0.1, 0.2, 5.0),
]
# By collocation they take ten seconds each.


def name_of(case):
    return f"{case.kind}-{case.level:g}-{case.angle:g}"


def sampled(cases):
    """Mark all cases but every fifth one as long: each takes seconds in many digits."""
    return [pytest.param(case, marks=[pytest.mark.long] if k % 5 else []) for k, case in enumerate(cases)]


def errors(case, motion, time):
    """Return the errors of the state at a time, those that are allowed, and the impacts of the oracle."""
    with mp.workdps(DIGITS):
        exact, impacts = case.exact(time)
        growths = [max(abs(case.exact(time, name)[0] - exact)) / CHANGE for name in INPUTS]
        found = np.array(
            [abs(mp.mpf(float(one)) - two) for one, two in zip(motion.at(time), exact, strict=True)]
        )
        growth = float(sum(growths))
    return found.astype(float), ROUNDINGS * ROUNDING * (1.0 + growth), impacts


def compare(case):
    """Compare a motion with the oracle; the tolerance of the angle and the velocity follows the conditioning."""
    motion = rk.simulate(case.system, rk.State(*case.start))
    time = motion.overturning.time + SURE if case.time == math.inf else case.time
    found, allowed, impacts = errors(case, motion, time)
    assert max(found) < allowed
    return motion, time, impacts


@pytest.mark.parametrize("case", sampled(FLYING) + sampled(FALLING), ids=name_of)
def test_states_are_those_of_collocation(case):
    motion, time, impacts = compare(case)
    assert (motion.outcome is rk.Outcome.OVERTURNED) == (case.time == math.inf)
    times = motion.events["time"][(motion.events["kind"] == "impact") & (motion.events["time"] < time)]
    inside = int((times < case.duration).sum())
    assert (inside, times.size - inside) == case.impacts
    assert impacts == times.size


@pytest.mark.long
@pytest.mark.parametrize("case", RESTING, ids=name_of)
def test_block_that_rests_before_the_end_lifts_off_again_at_the_same_time(case):
    motion, time, _ = compare(case)
    lifts = motion.events["time"][motion.events["kind"] == "lift-off"]
    assert lifts.max() < case.duration
    kinds = motion.events["kind"][motion.events["time"] < min(time, case.duration)].tolist()
    assert "rest" in kinds
    assert "lift-off" in kinds[kinds.index("rest") :]
    assert motion.at(time)[0] != 0.0


def random_case(seed):
    """Return a block that moves from rest under a random pulse, and is compared while it still rocks, or when it falls."""
    random = np.random.default_rng(seed)
    level, duration, angle = (
        float(np.round(random.uniform(*limits), 6)) for limits in ((1.2, 6.0), (0.4, 4.0), (0.05, 0.6))
    )
    kind, restitution = str(random.choice(list(FORMS))), float(random.choice([0.7, 0.9]))
    case = Case(kind, level * random.choice([-1, 1]), duration, angle, restitution)
    motion = rk.simulate(case.system)
    if motion.outcome is rk.Outcome.OVERTURNED:
        return case
    impacts = motion.events["time"][motion.events["kind"] == "impact"]
    return case._replace(time=float(0.5 * (impacts[3] + impacts[4])))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(60))
def test_states_under_random_pulses_are_those_of_collocation(seed):
    case = random_case(seed)
    motion, time, impacts = compare(case)
    assert impacts == ((motion.events["kind"] == "impact") & (motion.events["time"] < time)).sum()


@pytest.mark.parametrize("kind", FORMS)
def test_slender_block_is_the_limit_at_second_order(kind):
    pulse = rk.Pulse(kind, amplitude=1.4, duration=1.5)
    limit = rk.simulate(rk.System(pulse, 0.9))
    assert limit.outcome is rk.Outcome.AT_REST
    errors = []
    for angle in (0.08, 0.04, 0.02):
        full = rk.simulate(rk.System(pulse, 0.9, critical_angle=angle))
        errors.append(abs(full.at(2.0)[0] - limit.at(2.0)[0]))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("kind", FORMS)
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_lift_off_is_above_the_tangent_of_the_critical_angle(kind, sign):
    for alpha in (0.05, 0.5, 1.1):
        for factor, moves in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
            amplitude = sign * factor * math.tan(alpha) / alpha
            pulse = rk.Pulse(kind, amplitude=amplitude, duration=2.0)
            motion = rk.simulate(rk.System(pulse, 0.5, critical_angle=alpha))
            assert (motion.impacts > 0) == moves
            if moves:  # the base accelerates to one side, the block leans to the other
                flying = motion.events["time"][0] + 1e-6
                assert motion.at(flying)[0] * sign < 0.0


def test_motion_goes_on_from_the_end_of_the_pulse_as_a_free_one():
    pulse = rk.Pulse("one-cosine", amplitude=1.6, duration=1.5)
    motion = rk.simulate(rk.System(pulse, 0.8, critical_angle=0.4))
    state = rk.State(*(float(part) for part in motion.at(1.5)))
    free = rk.simulate(rk.System(rk.Harmonic(0.0, period=1.0), 0.8, critical_angle=0.4), state, cycles=3)
    assert motion.at(4.5) == pytest.approx([free.final.angle, free.final.velocity], abs=1e-14)
    assert abs(motion.at(4.5)[0]) > 1e-3


@pytest.fixture(scope="module")
def kernels():
    """The drive at a time, the drive later, the largest acceleration ahead and the largest change, from a time on."""
    drive_at, drive_later = full_base.pulse_drive, full_base.pulse_later
    largest_ahead, change_within = contract.largest_ahead, contract.acceleration_change_bound

    @njit
    def at(p, time):
        return drive_at(p, time)

    @njit
    def later(p, drive, time, to_corner):
        return drive_later(p, drive, time, to_corner)

    @njit
    def ahead(p, side, time):
        return largest_ahead(p, side, drive_at(p, time))

    @njit
    def change(p, time, window):
        return change_within(p, drive_at(p, time), window)

    return at, later, ahead, change


def test_largest_acceleration_ahead_is_the_least_bound(kernels):
    random = np.random.default_rng(3)
    for kind in FORMS:
        for amplitude in (2.0, -1.5):
            pulse = rk.Pulse(kind, amplitude=amplitude, duration=2.5)
            p = parameters(rk.System(pulse, 0.9, critical_angle=0.3))
            for time in (0.0, *random.uniform(0.0, 2.5, 60).tolist(), 2.5, 3.0):
                ahead = pulse.acceleration(np.linspace(time, 2.5, 4_001)) if time < 2.5 else np.zeros(1)
                for side in (-1, 1):
                    bound = kernels[2](p, side, time)
                    largest = max((side * ahead).max(), 0.0)
                    assert largest - 1e-14 <= bound <= largest + 1e-5


def test_change_within_a_time_includes_the_jump_at_the_end(kernels):
    random, jumps = np.random.default_rng(4), 0
    for kind in FORMS:
        pulse = rk.Pulse(kind, amplitude=2.0, duration=2.5)
        p = parameters(rk.System(pulse, 0.9, critical_angle=0.3))
        for time, window in random.uniform(0.0, (3.0, 0.5), (100, 2)).tolist():
            values = pulse.acceleration(time + np.linspace(0.0, window, 401))
            bound = kernels[3](p, time, window)
            assert bound >= np.abs(values - values[0]).max() - 1e-14
            assert bound == 0.0 or time < 2.5
            jumps += kind == "one-cosine" and 2.45 < time < 2.5 < time + window
    assert jumps > 0


def test_drive_has_no_base_acceleration_from_the_end_on(kernels):
    p = parameters(rk.System(rk.Pulse("one-cosine", amplitude=2.0, duration=0.3), 0.9, critical_angle=0.3))
    at, later = kernels[:2]
    near = at(p, 0.1)
    assert near.cosine != 0.0
    for drive in (later(p, near, 0.3 - 0.1, True), later(p, near, 0.3, False), at(p, 0.3), at(p, 9.0)):
        assert drive[1:] == (0.0, 0.0)
    assert later(p, near, 0.3 - 0.1, True).time == p.forcing.duration
    assert later(p, near, 0.1, False) == pytest.approx(at(p, 0.2), abs=1e-15)


def bisected(falls, low, high):
    """Return the place between two numbers at which the block begins to fall, or ceases to."""
    at_high = falls(high)
    assert falls(low) != at_high
    while high - low > 1e-13 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) == at_high else (middle, high)
    return high


def fallen(kind, amplitude, frequency, angle, restitution):
    """Return whether a pulse with an amplitude in g overturns; the frequency is over that of the block."""
    pulse = rk.Pulse(kind, amplitude=amplitude / angle, duration=math.tau * FORMS[kind][0] / frequency)
    system = rk.System(pulse, restitution, critical_angle=angle)
    return rk.simulate(system, record="none").outcome is rk.Outcome.OVERTURNED


ROUSSOS = math.atan2(0.5, 1.5)
PARAMETER = math.sqrt(3 * 9.81 / (4 * math.hypot(0.5, 1.5)))
FIFTEEN = math.radians(15.0)
HOUSNER = 1 - 1.5 * math.sin(FIFTEEN) ** 2
# (pulse, Omega, critical angle, e, threshold in g that another computation gave, half a unit of its last digit)
THRESHOLDS = [
    # Zhang & Makris (2001): 15.7 rad/s, p = 2.14 1/s
    ("one-sine", 15.7 / 2.14, 0.25, 0.9, 2.223222, 6e-7),
    ("one-sine", 15.7 / 2.14, 0.25, 0.9, 2.6170, 5e-5),
    ("one-sine", 15.7 / 2.14, 0.25, 0.9, 3.4369, 5e-5),
    # the same block, Omega = 5, in units of the critical angle
    ("one-sine", 5.0, 0.25, 0.9, 0.25 * 3.032339, 2e-7),
    ("one-sine", 5.0, 0.25, 0.9, 0.25 * 6.743019, 2e-7),
    ("one-sine", 5.0, 0.25, 0.9, 0.25 * 7.493000, 2e-7),
    # Makris & Roussos (2000), Figs. 9 and 11, with g = 9.81 m/s2
    ("one-sine", math.tau / PARAMETER, ROUSSOS, 0.85, 0.468727, 5e-7),
    ("one-cosine", math.tau / PARAMETER, ROUSSOS, 0.85, 0.625845, 5e-7),
    # Makris & Konstantinidis (2003), Fig. 4: p = 2 1/s, 2 s, Housner's coefficient of restitution
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.3150340182, 5e-11),
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.328168, 5e-7),
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.331450, 5e-7),
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.346045, 5e-7),
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.351088, 5e-7),
    # the same case by a public MATLAB script, whose tolerance is 1e-8
    ("one-cosine", math.pi / 2, FIFTEEN, HOUSNER, 0.315034034, 5e-8),
]


@pytest.mark.parametrize(("kind", "frequency", "angle", "restitution", "known", "error"), THRESHOLDS)
def test_thresholds_are_those_that_others_found(kind, frequency, angle, restitution, known, error):
    found = bisected(
        lambda value: fallen(kind, value, frequency, angle, restitution), 0.998 * known, 1.002 * known
    )
    assert abs(found - known) <= error


def speed_after_impact(frequency, amplitude):
    """Return the speed after the impact that follows a sine, over that which overturns, by Runge-Kutta steps; 0 without one."""
    alpha, end = 0.25, math.tau / frequency

    def rates(time, state):
        w = alpha * (1 - state[0])
        push = amplitude * math.sin(frequency * time) if time < end else 0.0
        return [state[1], -math.sin(w) / alpha + push * math.cos(w)]

    def base(time, state):
        return state[0]

    base.terminal, base.direction = True, -1.0
    lift_off = math.asin(math.tan(alpha) / (alpha * amplitude)) / frequency
    exact = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}
    state = solve_ivp(rates, (lift_off, end), [0.0, 0.0], **exact).y[:, -1]
    found = solve_ivp(rates, (end, end + 20.0), state, events=base, **exact).y_events[0]
    return 0.9 * abs(found[0][1]) * alpha / math.sqrt(2 * (1 - math.cos(alpha))) if len(found) else 0.0


def test_mode_1_ends_where_other_steps_let_it_end():
    """Zhang & Makris print 7.58; with Runge-Kutta steps, too, no amplitude overturns after an impact from 7.515 on."""

    def excess(frequency):
        best = minimize_scalar(
            lambda amplitude: -speed_after_impact(frequency, amplitude), bounds=(9.0, 11.5), method="bounded"
        )
        return -best.fun - 1.0, best.x

    end = brentq(lambda frequency: excess(frequency)[0], 7.4, 7.6, xtol=1e-6)
    amplitude = excess(end)[1]
    found = bisected(lambda frequency: fallen("one-sine", 0.25 * amplitude, frequency, 0.25, 0.9), 7.4, 7.6)
    assert found == pytest.approx(end, abs=5e-6)
    assert end == pytest.approx(7.51496, abs=1e-5)
    for near in np.linspace(9.5, 11.0, 61):
        assert not fallen("one-sine", 0.25 * near, end + 1e-4, 0.25, 0.9)


def test_block_in_si_units_falls_where_the_normalised_one_does():
    block = rk.Block(height=3.0, width=1.0)
    threshold = bisected(
        lambda value: fallen(
            "one-cosine",
            value,
            math.tau / block.frequency_parameter,
            block.critical_angle,
            block.restitution,
        ),
        0.62,
        0.63,
    )
    for factor, outcome in ((1 - 1e-9, rk.Outcome.AT_REST), (1 + 1e-9, rk.Outcome.OVERTURNED)):
        pulse = rk.Pulse("one-cosine", amplitude=factor * threshold * 9.80665, duration=1.0)
        assert rk.simulate(block.system(pulse, model="full")).outcome is outcome


def test_block_that_overturns_for_certain_lies_flat_before_it_comes_back():
    random, during = np.random.default_rng(0), 0
    for _ in range(80):
        kind = str(random.choice(list(FORMS)))
        alpha, level, duration = (
            float(random.uniform(*limits)) for limits in ((0.05, 1.1), (1.0, 8.0), (0.5, 4.0))
        )
        pulse = rk.Pulse(kind, amplitude=level * math.tan(alpha) / alpha, duration=duration)
        motion = rk.simulate(rk.System(pulse, 0.8, critical_angle=alpha))
        if motion.outcome is not rk.Outcome.OVERTURNED:
            continue
        angle = alpha * motion.at(np.linspace(0.0, 20.0, 2_000) + motion.overturning.time)[0]
        flat = np.flatnonzero(np.abs(angle) >= math.pi / 2 - 1e-9)
        assert flat.size
        # at an impact, from which overturning may be certain, the angle is 0
        assert np.unique(np.sign(angle[1 : flat[0]])).size <= 1
        during += motion.overturning.time < duration
    assert during > 15


def test_many_states_of_an_arc_are_those_of_one_at_a_time():
    """Ascending times go on from step to step; a single time starts with the arc. A thousand steps add up rounding errors of time."""
    for kind in ("ricker", "trapezoidal"):
        motion = rk.simulate(rk.System(rk.Pulse(kind, amplitude=2.0, duration=2.7), 0.9, critical_angle=0.25))
        times = np.linspace(0.0, motion.duration, 500)
        together, single = motion.at(times), [motion.at(time) for time in times]
        assert np.abs(together - np.transpose(single)).max() < 5e-12
        shuffled = np.random.default_rng(1).permutation(times.size)
        assert np.abs(np.array(motion.at(times[shuffled])) - np.array(together)[:, shuffled]).max() < 5e-12
