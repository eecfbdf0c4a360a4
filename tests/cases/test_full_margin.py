"""Margin of the full block, and its certified outcomes, against single motions by SciPy, the slender block and many digits."""

import math
import warnings
from functools import partial
from itertools import pairwise

import flint
import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk
from oracles import full_block, full_taylor
from oracles.restitution import deviation
from rocking.kernels.block.restitution import bend_within, restitution_at
from rocking.kernels.contract import arc_at, end_is_sure, growth_constant, guess_from, margin_of, next_event
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.finite_motion import ENDING_ROW, RUN_ROW, run_batch, run_to_end
from rocking.kernels.motion.march import OVERTURNED
from rocking.kernels.motion.rounding_errors import DEVIATIONS, LINEAR, Covariance
from rocking.motion.march_loop import parameters
from rocking.motion.motion import end_shown
from rocking.motion.trajectory import lying_time

rng = np.random.default_rng(7)
LEFT = rk.LeftSide(1.35, 0.95, 0.6)
NOISE = np.hanning(60) * np.cumsum(rng.normal(size=60))


def systems():
    """Systems with a time and a side at which a block may leave the base."""
    noise = rk.PiecewiseLinear(NOISE / np.abs(NOISE).max() * 2.0, step=0.1)
    coarse = rk.PiecewiseLinear(NOISE[::5] / np.abs(NOISE).max() * 1.5, step=0.5)
    for base in (noise, coarse):
        for angle in (0.05, 0.2, 0.4):
            for time, side in ((0.3, 1), (1.7, -1), (3.1, 1)):
                yield rk.System(base, 0.9, critical_angle=angle), time, side
        for time, side in ((0.3, -1), (1.7, 1)):
            yield rk.System(base, 0.9, critical_angle=0.3, left=LEFT), time, side


@kernel
def margin_from(p, side, time, speed, in_batch):
    return margin_of(p, arc_at(p, side, 0, time, 0.0, speed), 0.0, in_batch)


def grows(system, time, side, speed):
    """Return whether the motion that leaves the base at a speed, continued smoothly, grows beyond the balance; else it falls back."""
    angle, base, left = system.critical_angle, system.forcing, system.left
    ratio, rate = (1.0, 1.0) if side > 0 or left is None else (left.angle_ratio, left.frequency_ratio)

    def leaves(t, y):
        return (angle * (y[0] - ratio)) ** 2 - 1.2**2

    leaves.terminal = True
    corners = [t for t in base.corners if t > time] if hasattr(base, "corners") else []

    def change(t, y):
        w = angle * (ratio - y[0])
        return [y[1], -(rate**2) * (math.sin(w) / angle + side * base.acceleration(t) * math.cos(w))]

    start, state = time, [0.0, speed]
    for end in [*corners, time + 60.0]:
        found = solve_ivp(change, (start, end), state, rtol=1e-11, atol=1e-13, events=leaves, method="DOP853")
        start, state = end, found.y[:, -1]
        if found.t_events[0].size:
            return state[0] > ratio
    raise AssertionError("neither")


@pytest.mark.parametrize(("system", "time", "side"), list(systems()))
def test_margin_is_the_distance_from_the_speed_between_those_that_fall_to_either_side(system, time, side):
    found = margin_from(parameters(system), side, time, 0.7, False)
    unit = 1.0 if side > 0 or system.left is None else LEFT.angle_ratio * LEFT.frequency_ratio
    between = 0.7 - unit * found
    assert grows(system, time, side, between + 2e-8)
    assert not grows(system, time, side, between - 2e-8)
    in_batch = margin_from(parameters(system), side, time, 0.7, True)
    assert in_batch == pytest.approx(found, abs=5e-4)


@pytest.mark.parametrize("kind", ["half-sine", "one-sine", "one-cosine"])
@pytest.mark.parametrize(("amplitude", "angle"), [(1.6, 0.1), (1.9, 0.2), (2.5, 0.4)])
def test_margin_under_a_pulse_is_that_distance(kind, amplitude, angle):
    pulse = rk.Pulse(kind, amplitude=amplitude, duration=3.0)
    motion = rk.simulate(rk.System(pulse, 0.85, critical_angle=angle))
    time, speed, side = min(departures(motion), key=lambda one: abs(one[0] - motion.margin_time))
    between = speed - motion.margin
    assert grows(motion.system, time, side, between + 2e-8)
    assert not grows(motion.system, time, side, between - 2e-8)


@pytest.mark.parametrize(("system", "time", "side"), [case for case in systems() if case[0].left is None])
def test_escape_speed_lies_within_its_bracket(system, time, side):
    """2 (r − cos α − a sin α) ≤ (α v_s)² ≤ 2 (r − cos α + a sin α), r² = 1 + a², for |acceleration| ≤ a in g."""
    angle, base = system.critical_angle, system.forcing
    times = np.linspace(time, base.span, 2000)
    largest = angle * max(abs(base.acceleration(float(t))) for t in times) * (1 + 1e-3)
    speed = -margin_from(parameters(system), side, time, 0.0, False)
    r = math.hypot(1.0, largest)
    below, above = (2 * (r - math.cos(angle) + sign * largest * math.sin(angle)) for sign in (-1, 1))
    assert speed <= math.sqrt(above) / angle
    if largest < math.tan(angle):
        assert speed >= math.sqrt(max(below, 0.0)) / angle


@kernel
def slender_constant(p, side, time, speed):
    return growth_constant(p, arc_at(p, side, 0, time, 0.0, speed))[0]


@pytest.mark.parametrize(("time", "side"), [(0.3, 1), (1.7, -1), (3.1, 1)])
def test_margin_tends_to_that_of_the_slender_block_with_the_square_of_the_angle(time, side):
    base = rk.PiecewiseLinear(NOISE / np.abs(NOISE).max() * 1.6, step=0.1)
    slender = slender_constant(parameters(rk.System(base, 0.9)), side, time, 0.7)
    systems = [rk.System(base, 0.9, critical_angle=angle) for angle in (0.08, 0.04, 0.02)]
    errors = [margin_from(parameters(one), side, time, 0.7, False) - slender for one in systems]
    assert abs(errors[-1]) < 1e-3
    assert [one / other for one, other in pairwise(errors)] == pytest.approx([4.0] * 2, rel=0.1)


def test_margin_after_the_base_motion_is_that_of_the_energy():
    base = rk.PiecewiseLinear([0.0, 0.0], step=0.1)
    angle = 0.4
    for speed in (0.3, 0.9, 1.1):
        p = parameters(rk.System(base, 0.9, critical_angle=angle))
        motion = run_to_end(p, 0.0, speed, math.inf)
        exact = speed - 2 * math.sin(angle / 2) / angle
        assert margin_from(p, 1, 0.0, speed, False) == pytest.approx(exact, abs=1e-9)
        if exact > 0:
            assert motion.margin == pytest.approx(exact, abs=1e-9)


def drawn(seed, count):
    """Scales and blocks for many motions."""
    found, random = np.zeros(count, RUN_ROW), np.random.default_rng(seed)
    found["scale"], found["restitution"] = random.uniform(1.02, 5.0, count), random.uniform(0.7, 0.97, count)
    found["critical_angle"] = random.uniform(0.05, 0.4, count)
    return found


def batch(p, runs):
    rows = np.zeros(runs.size, ENDING_ROW)
    assert run_batch(p, runs, False, rows, np.zeros(1, np.int64))
    return rows


def synthetic(seed, step=0.05, count=240):
    """Samples of a synthetic ground motion, the largest of which is 1."""
    (motion,) = rk.synthetic_ground_motions(1, seed=seed, duration=0.02 * (count - 1), rise=1.0, strong=2.0)
    values = motion.acceleration[:: max(1, motion.acceleration.size // count)]
    return rk.PiecewiseLinear(values / np.abs(values).max(), step=step)


def ending(system):
    """Return the ``Ending`` of the motion from rest."""
    return run_to_end(parameters(system), 0.0, 0.0, math.inf)


def shaken(seed, count):
    """Yield systems under synthetic ground motions, with whether the block overturns in a batch."""
    for motion in range(10):
        base = synthetic(10 * seed + motion)
        runs = drawn(10 * seed + motion, count // 10)
        rows = batch(parameters(rk.System(base, 0.9, critical_angle=0.2)), runs)
        for row, run in zip(rows, runs, strict=True):
            scaled = rk.PiecewiseLinear(base.values, step=base.step, scale=float(run["scale"]))
            angle = float(run["critical_angle"])
            yield rk.System(scaled, float(run["restitution"]), critical_angle=angle), row["status"]


def pulsed(seed, count):
    """Yield systems under pulses, with whether the block overturns."""
    random = np.random.default_rng(seed)
    for kind in random.choice(["half-sine", "one-sine", "one-cosine"], count):
        pulse = rk.Pulse(str(kind), amplitude=random.uniform(1.1, 4.0), duration=random.uniform(0.5, 6.0))
        e, angle = random.uniform(0.5, 0.97), random.uniform(0.05, 0.4)
        system = rk.System(pulse, e, critical_angle=angle)
        yield system, ending(system).status


def departures(motion):
    """Return times, speeds and sides with which a block leaves the base."""
    events = motion.events[np.isin(motion.events["kind"], ("impact", "lift-off"))]
    events = events[(events["kind"] == "lift-off") | (events["after"] != 0.0)]
    times, speeds = events["time"].tolist(), events["after"].tolist()
    if motion.peak > 0.0 and "lift-off" not in motion.events["kind"][:1]:  # it lifts off at once
        times, speeds = [0.0, *times], [0.0, *speeds]
    sides = [int(np.sign(v or motion.at(t + 1e-4)[0])) for t, v in zip(times, speeds, strict=True)]
    return list(zip(times, map(abs, speeds), sides, strict=True))


def margins_of(motion, *, in_batch=False):
    """Return the margin of each lift-off and impact."""
    p = parameters(motion.system)
    return np.array([margin_from(p, side, time, speed, in_batch) for time, speed, side in departures(motion)])


@pytest.mark.parametrize("count", [90, pytest.param(10_000, marks=pytest.mark.long)])
@pytest.mark.parametrize("draw", [shaken, pytest.param(pulsed, marks=pytest.mark.long)])
def test_block_overturns_if_the_last_margin_is_positive_and_only_then(draw, count):
    """The margin of the last lift-off or impact tells the outcome."""
    seen = {True: 0, False: 0}
    for system, status in draw(0, count * 2 // 3 if draw is shaken else count // 3):
        left = departures(rk.simulate(system))
        if left:
            time, speed, side = left[-1]
            k = margin_from(parameters(system), side, time, speed, False)
            fell = bool(status == OVERTURNED)
            seen[fell] += 1
            assert (k > 0) == fell
    assert min(seen.values()) > count // 50


def test_arcs_without_a_margin_do_not_hide_those_that_have_one():
    """Under strong motions no single motion stays bounded after some lift-offs and impacts."""
    mixed = 0
    for seed in (5, 6):
        base, runs, random = synthetic(seed), drawn(seed, 60), np.random.default_rng(seed)
        runs["scale"], runs["critical_angle"] = random.uniform(6.0, 12.0, 60), random.uniform(0.2, 0.4, 60)
        rows = batch(parameters(rk.System(base, 0.9, critical_angle=0.2)), runs)
        for run, row in zip(runs, rows, strict=True):
            scaled = rk.PiecewiseLinear(base.values, step=base.step, scale=float(run["scale"]))
            e, angle = float(run["restitution"]), float(run["critical_angle"])
            system = rk.System(scaled, e, critical_angle=angle)
            margins = margins_of(rk.simulate(system), in_batch=True)
            if not np.isnan(margins).all():
                mixed += np.isnan(margins).any()
                assert not math.isnan(row["margin"])
                assert not math.isnan(ending(system).margin)
    assert mixed > 2


def switches(seed, count, powers=range(3, 15), samples=160, most=0.93):
    """Yield systems near switches of the outcome over the scale: samples, step, scale, restitution and angle."""
    random = np.random.default_rng(seed)
    while count > 0:
        base = synthetic(
            int(random.integers(10_000)), step=float(random.choice([0.04, 0.06, 0.1])), count=samples
        )
        angle, e = float(random.uniform(0.05, 0.4)), float(random.uniform(0.5, most))
        p = parameters(rk.System(base, e, critical_angle=angle))
        runs = np.zeros(40, RUN_ROW)
        runs["scale"], runs["restitution"], runs["critical_angle"] = np.linspace(1.1, 5.0, 40), e, angle
        fell = batch(p, runs)["status"] == OVERTURNED
        for k in np.flatnonzero(fell[:-1] != fell[1:])[:3]:
            low, high = float(runs["scale"][k]), float(runs["scale"][k + 1])
            while high - low > 4e-16 * high:
                middle = 0.5 * (low + high)
                if not low < middle < high:
                    break
                one = runs[:1].copy()
                one["scale"] = middle
                if (batch(p, one)["status"][0] == OVERTURNED) == fell[k]:
                    low = middle
                else:
                    high = middle
            for power in powers:
                for sign in (-1, 1):
                    if count > 0:
                        yield base, low * (1 + sign * 10.0**-power), e, angle
                        count -= 1


def certified(base, scale, e, angle):
    """Return whether the outcome of a batch is certified, and whether the block overturns."""
    runs = np.zeros(1, RUN_ROW)
    runs["scale"], runs["restitution"], runs["critical_angle"] = scale, e, angle
    row = batch(parameters(rk.System(base, e, critical_angle=angle)), runs)[0]
    return bool(row["decided"]), bool(row["status"] == OVERTURNED)


@pytest.mark.parametrize(
    "angle, push, start", [(0.6, 4.0, 1.39), (0.6, 2.0, 1.54), (0.4, 4.0, 1.45), (0.25, 6.0, 1.5)]
)
@pytest.mark.parametrize("power", [6, 9, 12, 15])
def test_base_that_could_raise_a_block_from_the_ground_does_not(angle, push, start, power):
    """The block would lie flat for less than a step. It just comes to lie if its energy suffices."""

    def potential(theta):
        return math.cos(theta - angle) + push * math.sin(theta - angle)

    speed = math.sqrt(2.0 * (potential(math.pi / 2) - potential(start)))
    system = rk.System(rk.PiecewiseLinear(np.full(120, push / angle), step=0.05), 0.8, critical_angle=angle)
    for sign in (-1, 1):
        with pytest.warns(rk.InputWarning, match="beyond which a block overturns"):
            state = rk.State(start / angle, (1 + sign * 10.0**-power) * speed / angle)
        motion = rk.simulate(system, state)
        assert power > 9 or motion.certified
        assert power < 15 or not motion.certified
        assert (motion.impacts == 0) == (sign > 0) or not motion.certified


def lies_down(angle, step, pushes, lifts, start):
    """Return whether a block that starts at an angle with a speed lies flat before it comes back to the base, with 50 digits."""
    with flint.ctx.workdps(full_taylor.DIGITS):
        block = full_taylor.Block(pushes, step, 1.0, 0.8, angle, vertical=lifts)
        (u, v), half = map(flint.arb, start), block.step / 2
        for k in range(2 * (len(pushes) - 1)):
            here, t = k // 2, half * (k % 2)
            (push, rate), (weight, lift) = (
                (one[here], (one[here + 1] - one[here]) / block.step) for one in (block.values, block.weights)
            )
            c = full_taylor.series(block.alpha, 1, u, v, push + rate * t, rate, weight + lift * t, lift)
            if block.lies_flat(c, half):
                return True
            u, v = map(full_taylor.middle, full_taylor.value(c, half))
            if u < 0:
                return False
    raise AssertionError("the block neither lies flat nor comes back")


@pytest.mark.parametrize("kind", ["equal sides", "unequal sides", "wall", "vertical"])
def test_certified_blocks_that_just_lie_flat_do(kind):
    rng, ratio, rate, step, size, checked = np.random.default_rng(5), 1.0, 1.0, 0.05, 100, 0
    while checked < 6:
        angle, side = rng.uniform(0.3, 0.7), 1
        how = {"left": rk.Wall(0.8)} if kind == "wall" else {}
        if kind == "unequal sides":
            ratio, rate, side = rng.uniform(0.6, 1.5), rng.uniform(0.7, 1.3), -1
            how = {"left": rk.LeftSide(ratio, rate, 0.8)}
        noise = rng.uniform(-0.3, 0.3, (2, size))
        pushes = rng.uniform(2.0, 4.0) / math.tan(angle * ratio) / angle * (1.0 + noise[0])
        lifts = np.zeros(size)
        if kind == "vertical":
            lifts = noise[1]
            how = {"vertical": rk.PiecewiseLinear(lifts, step=step)}
        system = rk.System(rk.PiecewiseLinear(side * pushes, step=step), 0.8, critical_angle=angle, **how)
        start = (math.pi / 2 - 10.0 ** rng.uniform(-3.0, -0.5)) / angle

        def motion(speed, system=system, side=side, start=start):
            with warnings.catch_warnings(action="ignore", category=rk.InputWarning):
                return rk.simulate(system, rk.State(side * start, side * speed))

        low, high = 0.0, 8.0 / angle
        while low < 0.5 * (low + high) < high:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if motion(middle).impacts else (low, middle)
        for change in (-1e-6, 1e-6, -1e-10, 1e-10, -1e-14, 1e-14):
            speed = (1.0 + change) * low
            found = motion(speed)
            exact = lies_down(
                angle * ratio, step * rate, pushes / ratio, lifts, (start / ratio, speed / ratio / rate)
            )
            assert abs(change) < 1e-9 or (found.impacts == 0) == exact
            assert not found.certified or (found.impacts == 0) == exact
            assert found.certified or abs(change) < 1e-9
            if not found.impacts and lying_time(found) < math.inf:
                assert end_shown(found) == found.overturning.time
                assert found.at(found.overturning.time + 1.0) == (
                    pytest.approx(side * math.pi / 2 / angle, rel=1e-12),
                    0.0,
                )
        checked += 1


@pytest.mark.parametrize(
    ("count", "powers"),
    [(8, (6, 9, 12, 14)), pytest.param(2_000, range(3, 15), marks=pytest.mark.long)],
)
def test_no_certified_outcome_next_to_a_switch_is_wrong(count, powers):
    sure = []
    for base, scale, e, angle in switches(3, count, powers):
        decided, fell = certified(base, scale, e, angle)
        sure.append(decided)
        if decided:
            exact = full_taylor.Block(base.values * base.scale, base.step, scale, e, angle).overturns()
            assert exact == fell
    assert count // 3 < sum(sure) < count


@kernel
def return_with_error(p, side, time, size):
    arc = arc_at(p, side, 0, time, 0.0, 0.1)
    coming, _ = next_event(p, FLIGHT, arc, guess_from(p, 0.0))
    error = Covariance(size * size, 0.0, size * size)
    return coming.event == IMPACT, end_is_sure(p, arc, coming, error, error)


def test_return_is_certain_only_below_the_limit_of_the_error():
    limit = LINEAR / DEVIATIONS
    sizes = {1e-12: True, 0.99 * limit: True, 1.01 * limit: False, math.inf: False, math.nan: False}
    compared = 0
    for system, time, side in systems():
        if system.left is None:
            found = [return_with_error(parameters(system), side, time, size) for size in sizes]
            if found[0][0]:
                assert [sure for _, sure in found] == list(sizes.values())
                compared += 1
    assert compared > 6


@pytest.mark.parametrize("angle", [0.05, 0.2, 0.4])
def test_errors_of_that_limit_grow_as_small_ones(angle):
    """The part of an error that is not linear grows with the square of the critical angle."""
    worst = 0.0
    for seed in range(6):
        system = rk.System(synthetic(seed), 0.9, critical_angle=angle)
        between = 0.7 - margin_from(parameters(system), 1, 0.0, 0.7, False)
        for share in (1e-3, 1e-2, 0.1):
            speed = (1.0 - share) * between
            events = rk.simulate(system, rk.State(0.0, speed)).events
            back = float(events["time"][events["kind"] == "impact"][0]) - 1e-6
            state = partial(flown, system, back)
            small = 1e-4 * share * between
            growth = (state(speed + small) - state(speed)) / small
            larger = LINEAR / np.abs(growth).max()
            off = state(speed + larger) - state(speed) - larger * growth
            worst = max(worst, np.abs(off).max() / LINEAR)
    assert 0.05 < worst / angle**2 < 0.1


def flown(system, time, speed):
    """Return the state of a block that leaves the base at a speed, before its impact."""
    return np.array(rk.simulate(system, rk.State(0.0, speed)).at(time))


@pytest.mark.parametrize(
    ("seed", "count", "powers"),
    [(5, 2, (9,)), *(pytest.param(k, 24, range(3, 15), marks=pytest.mark.long) for k in range(10, 20))],
)
def test_certified_outcomes_next_to_switches_are_those_of_collocation(seed, count, powers):
    """The scales differ from those of the switches by 1e-3 to 1e-14."""
    compared = set()
    for base, scale, e, angle in switches(seed, count, powers, samples=80, most=0.7):
        decided, fell = certified(base, scale, e, angle)
        if decided:
            assert fell == by_collocation(
                rk.System(
                    rk.PiecewiseLinear(base.values, step=base.step, scale=base.scale * scale),
                    e,
                    critical_angle=angle,
                )
            )
            compared.add(fell)
    assert compared == {True, False}


def by_collocation(system):
    """Return whether the block, at rest at first, overturns."""
    base, left, scatter = system.forcing, system.left, system.restitution_scatter
    law = (
        [(0.0, system.restitution), *system.restitution_table]
        if system.restitution_table
        else system.restitution
    )
    sides = (1, 1) if left is None else (left.angle_ratio, left.frequency_ratio, left.restitution)
    with mp.workdps(full_block.DIGITS):
        added = None
        if scatter is not None:
            stream, even = scatter.stream(), scatter.shape == "uniform"
            added = lambda rests, hits: scatter.deviation * mp.mpf(deviation(stream, rests, hits, even=even))  # noqa: E731
        samples = full_block.Samples(base.values * base.scale, base.step)
        block = full_block.Block(samples, law, system.critical_angle, left=sides, scatter=added)
        end = base.step * (base.values.size - 1)
        return block.overturns(end if scatter is None else end + 30.0)


def test_share_of_certified_outcomes_is_large():
    shares = []
    for seed in range(3):
        for angle in (0.1, 0.2, 0.3):
            runs = np.zeros(300, RUN_ROW)
            runs["scale"], runs["critical_angle"] = np.linspace(1.02, 5.0, 300), angle
            runs["restitution"] = 1 - 1.5 * math.sin(angle) ** 2
            shares.append(
                batch(parameters(rk.System(synthetic(seed), 0.9, critical_angle=angle)), runs)[
                    "decided"
                ].mean()
            )
    assert np.mean(shares) >= 0.99


# Blocks whose sides or impacts are not those of one constant.
LAWS = {
    "unequal sides": (0.65, {"left": LEFT}),
    "table": (0.65, {"restitution_table": [(0.2, 0.7), (0.5, 0.55), (1.0, 0.65)]}),
    "scatter": (0.65, {"restitution_scatter": rk.Restitution.constant(0.65).scattered(0.1, seed=3).scatter}),
    "scatter up to 1": (
        0.9,
        {"restitution_scatter": rk.Restitution.constant(0.9).scattered(0.2, "uniform", seed=3).scatter},
    ),
}


def system_at(law, seed, scale):
    base = synthetic(seed, step=0.06, count=80)
    scaled, (e, more) = rk.PiecewiseLinear(base.values, step=base.step, scale=scale), LAWS[law]
    return rk.System(scaled, e, critical_angle=0.3, **more)


def falls(make, scale):
    return ending(make(scale)).status == OVERTURNED


def switch_of(make):
    """Return the last scale before a switch of the outcome."""
    scales = np.linspace(1.2, 4.0, 30).tolist()
    low, high = next(pair for pair in pairwise(scales) if falls(make, pair[0]) != falls(make, pair[1]))
    before = falls(make, low)
    while low < 0.5 * (low + high) < high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if falls(make, middle) == before else (low, middle)
    return low


@pytest.mark.parametrize("seed", [1, *(pytest.param(k, marks=pytest.mark.long) for k in (0, 2, 3, 4, 5))])
@pytest.mark.parametrize(
    "law", [pytest.param(law, marks=[pytest.mark.long] * ("scatter" in law)) for law in LAWS]
)
def test_certificate_and_margin_hold_for_every_law_of_restitution_and_for_unequal_sides(law, seed, request):
    make = partial(system_at, law, seed)
    scale, compared = switch_of(make), set()
    long = request.node.get_closest_marker("long") is not None
    for power in (4, 5, 8, 11, 13) if long else (5,):
        for sign in (-1, 1):
            system = make(scale * (1 + sign * 10.0**-power))
            found = ending(system)
            if found.decided:
                compared.add((power, by_collocation(system)))
                assert (power, found.status == OVERTURNED) in compared
    assert len(compared) >= 2
    assert not ending(make(scale)).decided
    for part in (1.0, 0.9):
        motion = rk.simulate(make(part * scale))
        margins = margins_of(motion)
        assert motion.margin == pytest.approx(min(margins, key=abs), abs=1e-8)
        assert (margins[-1] > 0) == (motion.outcome == "overturned")


def test_outcome_is_undecided_if_the_restitution_jumps_at_the_speed_of_an_impact():
    """The speed is known to about 1e-16. Where a table rises from 0.5 to 0.95 within 1e-14 of it, the speed after it is not."""
    base = synthetic(3, step=0.06, count=80)

    def system(scale, speed):
        table = [(speed, 0.5), (speed * (1.0 + 1e-14), 0.95)]
        return rk.System(
            rk.PiecewiseLinear(base.values, step=base.step, scale=scale),
            0.5,
            critical_angle=0.3,
            restitution_table=table,
        )

    found = 0
    for scale in np.linspace(1.5, 4.0, 80).tolist():
        events = rk.simulate(system(scale, 10.0)).events
        hits = events[events["kind"] == "impact"]
        if not hits.size:
            continue
        speed = abs(float(hits["before"][0]))
        below, above = (ending(system(scale, speed * (1.0 + change))) for change in (-1e-6, 1e-6))
        if below.status == above.status or not (below.decided and above.decided):
            continue
        found += 1
        for places in range(-3, 4):
            assert not ending(system(scale, speed * (1.0 + places * 2.0**-52))).decided
    assert found > 3


@kernel
def after(p, speed, reach):
    """Return the speed after an impact, its derivative and its bend."""
    e, gain = restitution_at(p, 1, speed)
    return e * speed, gain, bend_within(p, 1, speed, reach)


def test_bend_of_the_restitution_bounds_what_the_speed_after_an_impact_departs_from_its_tangent():
    random, close = np.random.default_rng(2), 0
    for _ in range(100):
        speeds, kept = np.sort(random.uniform(0.1, 2.0, 4)), random.uniform(0.0, 1.0, 4)
        system = rk.System(
            rk.PiecewiseLinear([0.0, 0.0], step=0.1),
            0.6,
            critical_angle=0.3,
            restitution_table=list(zip(speeds.tolist(), kept.tolist(), strict=True)),
        )
        p = parameters(system)
        offset = float(random.choice([0.0, -0.4, 0.5]))
        p = p._replace(block=p.block._replace(scatter=p.block.scatter._replace(offset=offset)))
        speed, reach = random.uniform(0.05, 2.5), 10.0 ** random.uniform(-6.0, 0.0)
        v, gain, bound = after(p, speed, reach)
        others = np.linspace(max(speed - reach, 0.0), speed + reach, 101)
        departed = max(abs(after(p, one, 0.0)[0] - v - gain * (one - speed)) for one in others.tolist())
        assert departed <= bound + 1e-15
        close += bound < 4.0 * departed
    assert close > 30


@pytest.mark.parametrize(
    "kind", ["rectangular", "triangular", "half-sine", "one-sine", "one-cosine", "ricker"]
)
def test_outcome_under_a_pulse_is_certified_unless_it_is_close(kind):
    """Long free steps contain no minimum of the angle that is not looked at."""
    level = math.tan(0.25) / 0.25
    for amplitude in (1.05, 1.5, 2.5, 4.0, 6.0):
        for duration in (0.5, 2.0):
            for restitution in (0.0, 0.9):
                pulse = rk.Pulse(kind, amplitude=amplitude * level, duration=duration)
                motion = rk.simulate(rk.System(pulse, restitution, critical_angle=0.25))
                assert motion.certified or abs(motion.margin) < 1e-6, (amplitude, duration, restitution)
