"""Vertical motion of the base: reference values, closed forms, a second method, 50 digits, lift-off and refusals."""

import json
import math
import re
import sys
from pathlib import Path
from typing import NamedTuple

import attrs
import flint
import numpy as np
import pytest
from numba import njit

import rocking as rk
from oracles import full_taylor
from oracles import vertical as oracle
from rocking.cli.main import run
from rocking.kernels.arc import full_step
from rocking.kernels.base.samples import SampledDrive
from rocking.motion import march_loop
from rocking.motion.trajectory import side_at
from rocking.motion.validity import base_reaction
from switches import agrees, certified_near_switches, check_margins_near_switches, compare_beside_switches

RECORD = Path(__file__).parents[3] / "shared" / "records" / "20161113_110259_WTMC_20.V2A"
BLOCK = rk.Block(2.0, 0.6)
MODELS = "slender", "full"
SCALES = np.linspace(0.3, 4.0, 38).tolist()
G = 9.80665


# Scale of both components of the record, N28W and Up: peak |theta|/theta_cr without and with the vertical one, and least weight 1 + a_v.
# An independent brute force in physical units (RK4, dt/20 to dt/100).
PEAKS = [
    (0.4, 0.0300715, 0.0121178, 0.569),
    (0.5, 0.1926082, 0.0866705, 0.461),
    (0.6, 0.7784123, 0.6171924, 0.354),
]
needs_record = pytest.mark.skipif(not RECORD.exists(), reason="file absent")


def components(scale):
    """Return the first horizontal and the vertical component of the record, scaled."""
    horizontal, _, up = rk.read_ground_motions(RECORD)
    assert up.vertical
    return horizontal.scaled(scale), up.scaled(scale)


@needs_record
@pytest.mark.parametrize(("scale", "without", "peak", "weight"), PEAKS)
def test_peaks_and_base_reactions_of_a_record(scale, without, peak, weight):
    """The block lifts off where it is lightest. There theta'' > 0 raises the reaction above the weight."""
    ground, up = components(scale)
    assert rk.simulate(BLOCK.system(ground)).peak == pytest.approx(without, rel=0, abs=1e-7)
    motion = rk.simulate(BLOCK.system(ground, vertical=up))
    assert motion.peak == pytest.approx(peak, rel=0, abs=1e-7)
    assert 1 + up.acceleration.min() / G == pytest.approx(weight, rel=0, abs=5e-4)
    assert weight < motion.validity(BLOCK).reaction < weight + 0.05
    assert motion.certified


@needs_record
def test_a_record_that_lifts_the_block_from_its_base_is_refused():
    """The least vertical acceleration, -1.0774 g, is -1 g from the scale 0.9282 on."""
    for model in MODELS:
        for scale in (0.9282, 1.0):
            ground, up = components(scale)
            with pytest.raises(
                rk.ContactLost,
                match=r"^the weight vanishes at t = 49\.[\d.]+ s: the block leaves the base$",
            ):
                rk.simulate(BLOCK.system(ground, vertical=up, model=model))
    up = components(1.0)[1].acceleration / G
    assert -1 / up.min() == pytest.approx(0.9282, abs=5e-5)


class Case(NamedTuple):
    """Critical angle, coefficient of restitution, model, samples in both directions at unit scale, step, start, and left side."""

    alpha: float
    e: float
    full: bool
    push: np.ndarray
    lift: np.ndarray
    step: float
    start: rk.State
    left: rk.LeftSide | rk.Wall | None

    def system(self, scale):
        base = rk.PiecewiseLinear(self.push, step=self.step, scale=scale)
        up = rk.PiecewiseLinear(self.lift, step=self.step)
        angle = self.alpha if self.full else None
        return rk.System(base, self.e, critical_angle=angle, left=self.left, vertical=up)

    def motion(self, scale):
        return rk.simulate(self.system(scale), self.start)

    def falls(self, scale):
        return self.motion(scale).outcome == "overturned"

    def of_oracle(self, scale):
        alpha, rate, e = (self.alpha,) * 2, (1.0, 1.0), (self.e,) * 2
        if isinstance(self.left, rk.LeftSide):
            ratio, left_rate, left_e = attrs.astuple(self.left)
            alpha, rate, e = (self.alpha, ratio * self.alpha), (1.0, left_rate), (self.e, left_e)
        block = oracle.Block(alpha, rate, e, self.full, isinstance(self.left, rk.Wall))
        base = oracle.Base(self.push * (scale * self.alpha), self.lift, self.step)
        return oracle.follow(block, base, self.start.angle, self.start.velocity)

    def falls_exactly(self, scale):
        angle, how = self.alpha if self.full else 0.0, {"wall": self.left is not None, "vertical": self.lift}
        return full_taylor.Block(self.push, self.step, scale, self.e, angle, **how).overturns()


def cases(count, seed):
    """Yield random blocks under random samples, some unsymmetric or against a wall; the weight is between 0.1 and 1.9."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        size, step = int(rng.integers(20, 50)), float(rng.choice([0.05, 0.1, 0.3]))
        push = rng.normal(size=size).cumsum() * 0.3 * np.hanning(size) * rng.uniform(1.0, 5.0)
        lift = np.clip(rng.normal(size=size) * rng.uniform(0.1, 0.5), -0.9, 0.9)
        start = rk.State(*rng.uniform((0.01, -0.4), (0.4, 0.4))) if k % 4 == 0 else rk.State()
        alpha, e = float(rng.uniform(0.1, 0.35)), float(rng.uniform(0.3, 0.95))
        left = (None, None, rk.LeftSide(rng.uniform(0.8, 1.4), rng.uniform(0.9, 1.1), e), rk.Wall(e))[
            k // 2 % 4
        ]
        if isinstance(left, rk.Wall) and start.velocity < 0.0 and start.angle == 0.0:
            start = rk.State()
        yield Case(alpha, e, bool(k % 2), push, lift, step, start, left)


def compare(case, scale):
    """Return whether the block overturned, after a comparison of outcome and peak with the other method."""
    return agrees(case.motion(scale), case.of_oracle(scale))


@pytest.mark.parametrize("number", range(6))
def test_motion_agrees_with_dop853(number):
    compare(list(cases(6, 9))[number], 1.0)


@pytest.mark.long
def test_sixty_motions_agree_with_dop853():
    """Twenty of them lie at either side of a switch of the outcome, at 1e-5 of the scale."""
    fallen = sum(compare(case, 1.0) for case in cases(40, 7))
    assert 5 < fallen < 35
    compare_beside_switches(cases(200, 8), SCALES, 20, compare)


def from_rest(count, seed):
    """Yield blocks with equal sides or a wall, at rest at first."""
    for case in cases(100 * count, seed):
        if case.start == rk.State() and not isinstance(case.left, rk.LeftSide):
            yield case


@pytest.mark.parametrize(
    ("count", "powers"),
    [(16, (4, 8, 12, 14)), pytest.param(400, range(3, 15), marks=pytest.mark.long)],
)
def test_no_certified_outcome_next_to_a_switch_is_wrong(count, powers):
    certified_near_switches(from_rest(count, 3), SCALES, count, powers, least=0.5)


def test_margin_has_the_sign_of_the_outcome_and_vanishes_at_a_switch():
    check_margins_near_switches(from_rest(24, 5), SCALES)


def bounded_speed(case, scale, begun, side, guess):
    """Return the speed at the base of the motion that stays bounded, by series in balls of 50 digits and the secant method."""
    arb, middle = flint.arb, full_taylor.middle
    alpha = arb(case.alpha if case.full else march_loop.SMALL)
    push, weight = (
        [arb(one) * arb(scale) for one in case.push.tolist()],
        [1 + arb(one) for one in case.lift.tolist()],
    )
    step = arb(case.step)

    def excess(speed):
        """Return by how much a speed is too large, after the base motion."""
        place = int(begun / case.step)
        u, v, t = arb(0), speed, arb(begun) - place * step
        for k in range(place, len(push) - 1):
            rate, lift = (push[k + 1] - push[k]) / step, (weight[k + 1] - weight[k]) / step
            parts = math.ceil(float((step - t).mid()) / full_taylor.LONGEST)
            h = (step - t) / parts
            for _ in range(parts):
                c = full_taylor.series(
                    alpha, side, u, v, push[k] + rate * t, rate, weight[k] + lift * t, lift
                )
                (u, v), t = map(middle, full_taylor.value(c, h)), t + h
            t = arb(0)
        return middle(v + (alpha * (u - 1) / 2).sin() * 2 / alpha)

    one, two = arb(guess), arb(guess) + arb("1e-9")
    first, second = excess(one), excess(two)
    while abs(float((two - one).mid())) > 1e-20 and float((second - first).mid()) != 0.0:
        one, two, first = two, middle(two - second * (two - one) / (second - first)), second
        second = excess(two)
    return float(two.mid())


def test_margin_is_that_of_50_digits():
    compared = 0
    for drawn in cases(24, 11):
        case = drawn._replace(left=None)
        motion = case.motion(1.2)
        before = motion.events[motion.events["time"] <= motion.margin_time]
        if (
            math.isnan(motion.margin)
            or not before.size
            or motion.margin_time > (case.push.size - 1) * case.step
        ):
            continue
        side, speed = side_at(motion, motion.margin_time), abs(before["after"][-1])
        exact = speed - bounded_speed(case, 1.2, motion.margin_time, side, speed - motion.margin)
        assert motion.margin == pytest.approx(exact, rel=0, abs=5e-8)
        compared += 1
    assert compared > 18


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("c", [-0.4, 0.3])
def test_a_constant_vertical_acceleration_is_another_gravity(model, c):
    """theta'' = -p^2 [(1 + c) sin w + a cos w]: with the time multiplied by sqrt(1 + c) that is the block under a/(1 + c)."""
    alpha, e, rng = 0.25, 0.9, np.random.default_rng(4)
    push = np.concatenate((rng.normal(size=40).cumsum() * 0.5 * np.hanning(40), np.zeros(400)))
    angle = alpha if model == "full" else None
    outcomes = set()
    for scale in (0.8, 1.5, 2.5, 4.0):
        base = rk.PiecewiseLinear(push, step=0.1, scale=scale)
        up = rk.PiecewiseLinear(np.full(push.size, c), step=0.1)
        motion = rk.simulate(rk.System(base, e, critical_angle=angle, vertical=up))
        other = rk.PiecewiseLinear(push, step=0.1 * math.sqrt(1 + c), scale=scale / (1 + c))
        plain = rk.simulate(rk.System(other, e, critical_angle=angle))
        assert motion.outcome == plain.outcome
        outcomes.add(motion.outcome)
        assert (motion.peak > 0) == (plain.peak > 0)
        if motion.peak > 0:
            assert motion.margin == pytest.approx(plain.margin * math.sqrt(1 + c), rel=0, abs=5e-9)
        if motion.peak > 0 and motion.outcome != "overturned":
            assert motion.peak == pytest.approx(plain.peak, rel=1e-11)
            last = motion.events["time"][-1] * math.sqrt(1 + c)
            assert last == pytest.approx(plain.events["time"][-1], rel=1e-9)
    assert len(outcomes) == 2


@pytest.mark.parametrize("model", MODELS)
def test_without_vertical_acceleration_the_motion_is_that_of_a_horizontal_base(model):
    """The slender block is followed by the full equation with a small angle, and agrees with its closed form."""
    for case in cases(8, 11):
        zero = case._replace(lift=np.zeros(case.lift.size), full=model == "full", left=None)
        system = zero.system(1.2)
        motion, plain = (
            rk.simulate(system, case.start),
            rk.simulate(attrs.evolve(system, vertical=None), case.start),
        )
        assert motion.outcome == plain.outcome
        assert motion.certified == plain.certified
        if motion.outcome != "overturned":
            assert motion.peak == pytest.approx(plain.peak, rel=1e-10)
        if not math.isnan(plain.margin):  # the search with a weight goes further
            assert motion.margin == pytest.approx(plain.margin, rel=0, abs=5e-8)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("left", [None, rk.LeftSide(1.2, 0.99, 0.9), rk.Wall(0.5)])
def test_lift_off_is_where_the_push_exceeds_the_level_times_the_weight(model, left):
    alpha, e = 0.25, 0.5
    angle = alpha if model == "full" else None
    up = rk.PiecewiseLinear([0.2, -0.4, 0.3, 0.3], step=1.0)
    for sign in (1.0, -1.0):
        system = rk.System(
            rk.PiecewiseLinear([0.0, 0.0, 2.0 * sign, 0.0], step=1.0),
            e,
            critical_angle=angle,
            left=left,
            vertical=up,
        )
        right, other = system.lift_offs
        level = right if sign < 0 else other
        motion = rk.simulate(system)
        if level == math.inf:
            assert motion.outcome == "at-rest"
            assert motion.peak == 0
            continue
        # between the second and the third sample 2 s = level (0.6 + 0.7 s)
        first = motion.events[0]
        assert first["kind"] == "lift-off"
        assert first["time"] == pytest.approx(1 + 0.6 * level / (2 - 0.7 * level), rel=1e-12)
        assert np.sign(motion.at(first["time"] + 0.05)[0]) == -sign


def test_base_reaction_is_that_of_the_mass_centre():
    """N/(Mg) = 1 + a_v + y''/g, where y is the height of the mass centre above the base."""
    ground = rk.example_ground_motion().scaled(pga=5.0)
    up = attrs.evolve(ground, component="Up").scaled(0.3).reversed()
    motion = rk.simulate(BLOCK.system(ground, vertical=up))
    radius, angle = math.hypot(1.0, 0.3), BLOCK.critical_angle

    def height(seconds):
        theta = abs(motion.at(BLOCK.time(seconds))[0]) * angle
        return radius * np.cos(angle - theta)

    lows = []
    events = BLOCK.seconds(motion.events["time"])
    times = np.arange(0.5, BLOCK.seconds(motion.duration), 0.0137)
    times = times[np.abs(times[:, None] - events).min(axis=1) > 2e-3]
    step = 1e-4
    second = (height(times + step) - 2 * height(times) + height(times - step)) / step**2
    lows = 1 + np.interp(times, up.times, up.acceleration, right=0.0) / G + second / G
    found = motion.validity(BLOCK).reaction
    assert found <= lows.min() + 1e-5
    assert found == pytest.approx(lows.min(), abs=0.02)


def test_a_block_leaves_a_base_that_accelerates_down_faster_than_gravity():
    ground = rk.GroundMotion([0.0, 1.0, 0.0, 0.0], step=0.5)
    up = rk.GroundMotion([0.0, 0.0, -2 * G, 0.0], step=0.5)
    for model in MODELS:
        for record in ("all", "none"):
            with pytest.raises(
                rk.ContactLost, match=r"^the weight vanishes at t = 0.75 s: the block leaves the base$"
            ):
                rk.simulate(BLOCK.system(ground, vertical=up, model=model), record=record)
    system = attrs.evolve(BLOCK.system(ground, vertical=up), block=None)
    with pytest.raises(rk.ContactLost, match=r"^the weight vanishes at τ = 1.99"):
        rk.simulate(system)


def test_a_block_that_turns_fast_leaves_a_base_that_moves_vertically():
    ground = rk.GroundMotion([0.0, 1.0, 0.0, 0.0], step=0.1)
    block, up = rk.Block(2.0, 1.0), rk.GroundMotion([-0.5 * G, -0.95 * G, 0.0, 0.0], step=0.1)
    system, fast = block.system(ground, vertical=up), rk.State(velocity=0.95)
    with pytest.raises(
        rk.ContactLost, match=r"^the base reaction vanishes at t = 0.\d+ s: the block leaves the base$"
    ) as lost:
        rk.simulate(system, fast)
    begins = float(re.findall(r"t = (\S+) s", str(lost.value))[0])
    motion = rk.simulate(attrs.evolve(system, block=None), fast)
    before, after = (
        float(base_reaction(motion, block, np.array([block.time(t)]), np.array([1.0]))[1][0])
        for t in (begins - 1e-4, begins + 1e-4)
    )
    assert after < 0 < before


SAMPLES = [0.0, 1.0, -1.0, 0.0]
GROUND, UP = (rk.GroundMotion(SAMPLES, step=0.1) for _ in range(2))
BASE = rk.PiecewiseLinear(SAMPLES, step=0.1)
REFUSALS = [
    (
        lambda: BLOCK.system(GROUND, vertical=rk.GroundMotion(SAMPLES, step=0.2)),
        "vertical must have 4 samples with a step of 0.1 s, as the horizontal component; got 4 samples with a step of 0.2 s (take",
    ),
    (
        lambda: BLOCK.system(GROUND, vertical=rk.GroundMotion(SAMPLES[:3], step=0.1)),
        "vertical must have 4 samples with a step of 0.1 s, as the horizontal component; got 3 samples with a step of 0.1 s (take",
    ),
    (
        lambda: BLOCK.system(acceleration=2.0, period_s=1.0, vertical=UP),
        "vertical must be omitted without a ground motion; got GroundMotion(",
    ),
    (
        lambda: BLOCK.system(rk.Pulse("one-sine", amplitude=2.0, duration=1.0), vertical=UP),
        "vertical must be omitted without a ground motion; got GroundMotion(",
    ),
    (lambda: BLOCK.system(GROUND, vertical=BASE), "vertical must be a GroundMotion; got PiecewiseLinear("),
    (
        lambda: BLOCK.system(GROUND, vertical=UP, braces=rk.Braces(0.5)),
        "braces must be omitted with vertical; got both",
    ),
    (
        lambda: BLOCK.restrained(4e4, 900.0, mass=600.0).system(GROUND, vertical=UP, model="slender"),
        "vertical must be omitted for a restrained block; got PiecewiseLinear(",
    ),
    (
        lambda: rk.System(rk.Harmonic(2.0, period=1.0), 0.9, vertical=BASE),
        "vertical must be omitted unless forcing is rk.PiecewiseLinear; got forcing Harmonic(",
    ),
    (
        lambda: rk.System(BASE, 0.9, vertical=rk.PiecewiseLinear(SAMPLES, step=0.2)),
        "vertical must have 4 samples with a step of 0.1, as forcing; got PiecewiseLinear(",
    ),
    (
        lambda: rk.System(BASE, 0.9, vertical=0.5),
        "vertical must be a PiecewiseLinear; got 0.5",
    ),
    (
        lambda: rk.classify(rk.System(BASE, 0.9, vertical=BASE)),
        "system must have a periodic base motion, rk.Harmonic; got PiecewiseLinear",
    ),
]


@pytest.mark.parametrize(("call", "sentence"), REFUSALS)
def test_what_does_not_go_with_vertical_motion_is_refused(call, sentence):
    with pytest.raises((TypeError, ValueError), match="^" + re.escape(sentence)):
        call()


def test_results_state_the_vertical_acceleration():
    up = UP.scaled(2.0)
    motion = rk.simulate(BLOCK.system(GROUND, vertical=up))
    data = motion.to_xarray()
    expected = 1 + np.interp(data.time.values, up.times, up.acceleration, right=0.0) / G
    np.testing.assert_allclose(data.weight.values, expected, rtol=1e-12)
    assert data.attrs["vertical_least_g"] == pytest.approx(-2 / G)
    assert motion.to_dict()["vertical_largest_g"] == pytest.approx(2 / G)


def test_error_of_a_step_is_below_its_bound():
    """Against series of order 30 in balls of 50 digits, from critical angles of 1.2 down to that with which slender blocks are followed."""
    step, state = full_step.step_from, full_step.state_in

    @njit
    def take(p, side, angle, velocity, drive):
        made = step(p, side, angle, velocity, drive)
        return made, state(made, made.length)

    rng, arb = np.random.default_rng(2), flint.arb
    for k in range(40):
        alpha = march_loop.SMALL if k % 4 == 0 else float(rng.uniform(0.05, 1.2))
        base = rk.PiecewiseLinear(rng.normal(size=6) * 2.0, step=0.3)
        up = rk.PiecewiseLinear(rng.uniform(-0.9, 0.9, size=6), step=0.3)
        system = rk.System(base, 0.9, critical_angle=None if k % 4 == 0 else alpha, vertical=up)
        p, place = (
            march_loop.parameters(system),
            SampledDrive(int(rng.integers(5)), float(rng.uniform(0.0, 0.29))),
        )
        side, angle, velocity = (
            int(rng.choice([-1, 1])),
            float(rng.uniform(0.0, 1.2)),
            float(rng.uniform(-1.0, 1.0)),
        )
        made, (rise, _speed) = take(p, side, angle, velocity, place)
        with flint.ctx.workdps(50):
            u, v, h = arb(angle), arb(velocity), arb(made.length) / 4
            rows = [
                [arb(float(one)) for one in each[place.index : place.index + 2]]
                for each in (base.values, up.values)
            ]
            (push, rate), (lift, climb) = ((one, (two - one) / arb(base.step)) for one, two in rows)
            for part in range(4):
                t = arb(place.offset) + part * h
                c = full_taylor.series(
                    arb(alpha), side, u, v, push + rate * t, rate, 1 + lift + climb * t, climb
                )
                u, v = full_taylor.value(c, h)
            error = abs(float((u - arb(angle) - arb(rise)).mid()))
        assert made.length > 1e-3
        assert error <= full_step.ERROR + 2**-51 * (abs(rise) + made.length * (1 + np.abs(base.values).max()))


def test_command_follows_the_vertical_channel_of_a_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    times = np.arange(400) * 0.02
    push, lift = 4.0 * np.sin(6.0 * times), 2.0 * np.cos(9.0 * times[:-5])
    for name, values in (("a.csv", push), ("b.csv", lift)):
        lines = (f"{time},{value}" for time, value in zip(times.tolist(), values.tolist(), strict=False))
        Path(name).write_text("time [s],acceleration [m/s2]\n" + "\n".join(lines))

    def typed(factor, *more):
        line = (
            "record",
            "a.csv",
            "--vertical",
            "b.csv",
            "--height",
            "2",
            "--width",
            "0.6",
            "--scale",
            factor,
        )
        monkeypatch.setattr(sys, "argv", ["rocking", *line, *more])
        return run()

    assert typed("1.5", "--json") == (0, "")
    data = json.loads(capsys.readouterr().out)
    ground = rk.GroundMotion(1.5 * push[:-5], step=0.02)
    motion = rk.simulate(BLOCK.system(ground, vertical=rk.GroundMotion(1.5 * lift, step=0.02)))
    assert data["outcome"] == motion.outcome
    assert data["margin_rad_per_s"] == pytest.approx(float(BLOCK.radians_per_second(motion.margin)), rel=1e-6)
    assert data["vertical_motion"]["file"]["name"] == "b.csv"
    assert any("both end at 7.88 s" in each for each in data["warnings"])
    code, refused = typed("9")
    assert code == 2
    assert refused.startswith("the weight vanishes at t = ")
    code, refused = typed("1.5", "--restrainer-stiffness", "4e4", "--mass", "600")
    assert (code, refused.strip()) == (2, "--vertical must be omitted for a restrained block")
    Path("b.csv").write_text("time [s],acceleration [m/s2]\n0,0\n0.01,1\n0.02,0\n")
    code, refused = typed("1.5")
    assert code == 2
    assert refused.startswith("--vertical needs two components with the same step; got 0.02 s and 0.01 s")
