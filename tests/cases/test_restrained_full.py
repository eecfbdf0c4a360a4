"""Restrained blocks with the full equation: references, other methods in physical units, 50 digits, limits, margins and bounds."""

import itertools
import math
import sys
from functools import partial
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import rocking as rk
from oracles import full_taylor
from oracles import unsymmetric as oracle
from restrained_blocks import GRAVITY, restrained
from rocking.cli.main import run
from rocking.kernels.arc import full_step
from rocking.kernels.block.restrained import restrained_under_samples
from rocking.kernels.contract import arc_at, drive_on_clock, margin_of, never_returns
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion import finite_motion
from rocking.kernels.restrainer import restrainer_of
from rocking.motion.march_loop import parameters, tables_for
from rocking.motion.motion import end_shown
from switches import agrees, certified_near_switches, compare_beside_switches

RECORD = Path(__file__).parents[3] / "shared" / "records" / "NGA_no_1063_RRS228.AT2"
BLOCK = rk.Block(2.0, 0.6)
SCALES = np.geomspace(0.5, 30.0, 40).tolist()


# Scale of the record, and peak in units of the critical angle, by an independent brute force in physical units.
PEAKS = [(0.6, 0.0904518), (0.8, 0.7961044), (1.0, math.inf)]


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize(("scale", "peak"), PEAKS)
def test_peaks_of_a_record(scale, peak):
    block = restrained(BLOCK, 0.05, 0.3)
    ground = rk.read_ground_motion(RECORD).scaled(scale)
    motion = rk.simulate(block.system(ground))
    fell = motion.outcome == "overturned"
    assert fell == math.isinf(peak)
    assert fell or motion.peak == pytest.approx(peak, rel=0, abs=1e-7)
    assert motion.certified
    data = rk.incremental_dynamic_analysis(ground, block, [1.0, 1.1])
    assert data.dataset.peak.values[0, 0] == (math.inf if fell else pytest.approx(motion.peak, rel=1e-12))


class Case:
    """Random restrained block, whose peak, or fall, is of the order of its balance, under a random ground motion."""

    def __init__(self, rng, stiffest=2.0):
        self.kappa = float(rng.uniform(0.0, 0.9) if rng.random() < 0.7 else rng.uniform(0.9, stiffest))
        self.rho, self.e = float(rng.uniform(0.0, 1.0)), float(rng.uniform(0.6, 0.95))
        self.alpha, size = float(rng.uniform(0.05, 0.6)), int(rng.integers(20, 60))
        self.step = float(rng.choice([0.05, 0.1, 0.2]))
        values = rng.normal(size=size).cumsum() * np.hanning(size)
        # in units of g alpha, so that the block lifts off for sure
        self.values = (
            values / np.abs(values).max() * 2.0 * math.tan(self.alpha) / self.alpha * (1.0 + self.rho)
        )

    def system(self, scale=1.0):
        base = rk.PiecewiseLinear(self.values, step=self.step, scale=scale)
        ratios = {"stiffness_ratio": self.kappa, "prestress_ratio": self.rho}
        return rk.System(base, self.e, critical_angle=self.alpha, **ratios)

    def motion(self, scale):
        return rk.simulate(self.system(scale))

    def falls(self, scale):
        p = parameters(self.system(scale))
        return finite_motion.run_to_end(p, 0.0, 0.0, math.inf).status == finite_motion.OVERTURNED

    def compare(self, scale, method):
        """Return whether the block overturned, after a comparison of outcome and peak with another method."""
        own = oracle.Block((self.alpha,) * 2, (1.0, 1.0), (self.e,) * 2, True, kappa=self.kappa, rho=self.rho)
        base = oracle.Base(self.values * scale * self.alpha, self.step, 0.0, 1.0, 0.0, 0.0)
        return agrees(self.motion(scale), method(own, base, until=self.values.size * self.step + 90.0))

    def falls_exactly(self, scale):
        ratios = self.kappa, self.rho
        return full_taylor.Block(self.values, self.step, scale, self.e, self.alpha, ratios=ratios).overturns()


def cases(count, seed):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield Case(rng)


@pytest.mark.parametrize(("count", "each"), [(4, 2), pytest.param(40, 20, marks=pytest.mark.long)])
def test_motions_agree_with_dop853(count, each):
    """Of the motions ``each`` lie at either side of a switch of the outcome, at 1e-5 of the scale."""
    fallen = sum(case.compare(1.0, oracle.with_dop853) for case in cases(count, 7))
    compare_beside_switches(
        cases(10 * each, 8), SCALES, each, partial(Case.compare, method=oracle.with_dop853)
    )
    assert 0 < fallen < count


@pytest.mark.parametrize(
    ("count", "powers"),
    [(12, (4, 8, 12, 14)), pytest.param(500, range(3, 15), marks=pytest.mark.long)],
)
def test_no_certified_outcome_next_to_a_switch_is_wrong(count, powers):
    sure = certified_near_switches(cases(20 * count, 3), SCALES, count, powers, least=0.5)
    balances = [restrainer_of(case.alpha, case.kappa, case.rho).balance for case in sure]
    assert math.inf in balances or count < 500


def test_kernel_without_stiffness_and_force_is_that_of_the_free_block():
    rng = np.random.default_rng(4)
    for _ in range(6):
        case = Case(rng)
        base = rk.PiecewiseLinear(case.values, step=case.step, scale=float(rng.uniform(0.5, 3.0)))
        free = parameters(rk.System(base, case.e, critical_angle=case.alpha))
        none = restrained_under_samples(free, restrainer_of(case.alpha, 0.0, 0.0), tables_for(base))
        one, other = (finite_motion.run_to_end(p, 0.0, 0.0, math.inf) for p in (free, none))
        assert (one.status, one.decided) == (other.status, other.decided)
        assert one.peak == pytest.approx(other.peak, rel=1e-12)
        if one.margin_time == other.margin_time:
            assert one.margin == pytest.approx(other.margin, rel=1e-7, abs=1e-7)
        else:  # the search for the margin of a restrained block finds those of more arcs
            assert math.isnan(one.margin) or abs(other.margin) < abs(one.margin)
    ground = rk.example_ground_motion().scaled(pga=4.0)
    tied = BLOCK.restrained(0.0, mass=1.0).system(ground)
    assert tied == BLOCK.system(ground)


def test_difference_from_the_slender_block_falls_with_the_square_of_the_angle():
    """The slender identity, in units of its own: angles (1 + ρ)/(1 − κ), times 1/√(1 − κ), accelerations 1 + ρ."""
    kappa, rho, e = 0.4, 0.3, 0.8
    values = np.array([0.0, 1.9, -2.1, 1.4, -1.0, 0.6, 0.0]) * (1.0 + rho)
    rate = math.sqrt(1.0 - kappa)
    slender = rk.simulate(rk.System(rk.PiecewiseLinear(values / (1.0 + rho), step=0.8 * rate), e))
    exact = slender.peak * (1.0 + rho) / (1.0 - kappa)
    errors = []
    for alpha in (0.08, 0.04, 0.02):
        base = rk.PiecewiseLinear(values, step=0.8)
        system = rk.System(base, e, critical_angle=alpha, stiffness_ratio=kappa, prestress_ratio=rho)
        errors.append(rk.simulate(system).peak - exact)
    assert 0.2 < slender.peak < 1.0
    assert abs(errors[-1]) < 1e-2
    assert [one / other for one, other in itertools.pairwise(errors)] == pytest.approx([4.0] * 2, rel=0.15)


@kernel
def margin_from(p, side, time, speed):
    return margin_of(p, arc_at(p, side, 0, time, 0.0, speed), 0.0, False)


def grows(case, system, time, side, speed):
    """Return whether the motion that leaves the base at a speed, continued smoothly, grows beyond the balance; else it falls back."""
    alpha, base, own = case.alpha, system.forcing, restrainer_of(case.alpha, case.kappa, case.rho)
    balance = own.balance / alpha

    def leaves(t, y):
        return (alpha * (y[0] - balance)) ** 2 - (balance * alpha + 0.1) ** 2

    leaves.terminal = True

    def change(t, y):
        theta = alpha * y[0]
        w = alpha - theta
        tied = case.kappa * math.sin(theta) + case.rho * math.sin(alpha) * math.cos(theta / 2)
        return [y[1], -(math.sin(w) + side * alpha * base.acceleration(t) * math.cos(w) + tied) / alpha]

    start, state = time, [0.0, speed]
    for end in [*(t for t in base.corners if t > time), time + 150.0]:
        found = solve_ivp(change, (start, end), state, rtol=1e-11, atol=1e-13, events=leaves, method="DOP853")
        start, state = end, found.y[:, -1]
        if found.t_events[0].size:
            return state[0] > balance
    raise AssertionError("neither")


def test_margin_is_the_distance_from_the_speed_between_those_that_fall_to_either_side():
    found = 0
    for case in cases(60, 12):
        if restrainer_of(case.alpha, case.kappa, case.rho).balance == math.inf:
            continue
        case.values *= 0.5
        system = case.system()
        p = parameters(system)
        for time, side in ((0.3, 1), (0.45 * case.values.size * case.step, -1)):
            speed = 0.7 - margin_from(p, side, time, 0.7)
            if math.isnan(speed):
                continue
            found += 1
            assert grows(case, system, time, side, speed + 1e-7)
            assert not grows(case, system, time, side, speed - 1e-7)
        if found >= 12:
            break
    assert found >= 12


@kernel
def proved(p, side, time, angle, velocity):
    return never_returns(p, side, angle, velocity, drive_on_clock(p, 0, time))


def least_speed(case, theta, push):
    """Return the least speed in rad with which a block at an angle comes to lie flat against a constant push: by energy, on a grid.

    If it is negative, the block turns before its balance. The integrals are those of the trapezoidal rule.
    """

    def torque(x):
        lean = np.sin(case.alpha - x) + push * np.cos(case.alpha - x)
        return lean + case.kappa * np.sin(x) + case.rho * math.sin(case.alpha) * np.cos(x / 2)

    ahead, back = np.linspace(theta, math.pi / 2, 100_001), np.linspace(0.0, theta, 100_001)
    steps = 0.5 * (torque(ahead)[1:] + torque(ahead)[:-1]) * np.diff(ahead)
    needed = max(float(np.cumsum(steps).max()), 0.0)
    if needed > 0.0:
        return math.sqrt(2.0 * needed)
    falling = back[torque(back) >= 0.0].max(initial=0.0)
    behind = np.linspace(falling, theta, 100_001)
    spare = -float((0.5 * (torque(behind)[1:] + torque(behind)[:-1]) * np.diff(behind)).sum())
    return -math.sqrt(2.0 * max(spare, 0.0))


def test_a_proof_that_a_block_never_returns_is_that_of_the_largest_push():
    """The least speed with a proof is the least one with which the largest push of the samples cannot return the block."""
    rng, signs = np.random.default_rng(2), []
    for case in cases(150, 5):
        case.values *= rng.uniform(0.1, 1.0)
        p, alpha, largest = parameters(case.system()), case.alpha, np.abs(case.values).max()
        high = 30.0 * (1.0 + case.kappa + case.rho)
        low, angle = -high, float(rng.uniform(0.0, 0.99 * math.pi / 2 / alpha))
        assert proved(p, 1, 0.0, angle, high)
        for _ in range(70):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if proved(p, 1, 0.0, angle, middle) else (middle, high)
        exact = least_speed(case, alpha * angle, alpha * largest) / alpha
        assert high == pytest.approx(exact, rel=1e-5, abs=1e-5 / alpha)
        signs.append(exact > 0.0)
    assert 75 < sum(signs) < 145


@kernel
def take(p, side, angle, velocity, time):
    step = full_step.step_from(p, side, angle, velocity, drive_on_clock(p, 0, time))
    return step.length, full_step.state_in(step, step.length)


def test_error_of_a_step_is_within_its_bound():
    """Against balls of 50 digits, over stiffness and force, also where the block is nearly slender."""
    rng, arb = np.random.default_rng(1), flint.arb
    for kappa, rho, alpha in itertools.product((0.0, 0.5, 3.0, 40.0), (0.0, 0.6, 20.0), (1e-3, 0.1, 0.7)):
        values, step, side = rng.normal(size=2) * 4, 0.4, int(rng.choice([-1, 1]))
        base = rk.PiecewiseLinear(values, step=step)
        p = parameters(rk.System(base, 0.9, critical_angle=alpha, stiffness_ratio=kappa, prestress_ratio=rho))
        angle, velocity = float(rng.uniform(0.0, 1.4)), float(rng.uniform(-1.0, 1.0))
        length, (rise, _) = take(p, side, angle, velocity, 0.0)
        with flint.ctx.workdps(50):
            u, v, h = arb(angle), arb(velocity), arb(length) / 8
            push, rate = arb(float(values[0])), arb(float(values[1] - values[0])) / arb(step)
            for part in range(8):
                forces = push + rate * part * h, rate, 1, 0, arb(kappa), arb(rho)
                u, v = full_taylor.value(full_taylor.series(arb(alpha), side, u, v, *forces), h)
            error = abs(float((u - arb(angle) - arb(rise)).mid()))
        size = 1.0 + np.abs(values).max() + rho + 2.0 * kappa
        assert length > 1e-3
        assert error <= full_step.ERROR + 2**-51 * (abs(rise) + length * size)


@pytest.mark.parametrize(("alpha", "kappa", "rho"), [(0.3, 0.05, 0.3), (0.1, 0.7, 0.5), (0.6, 0.0, 1.5)])
def test_energy_torque_and_balance_are_those_of_the_equation(alpha, kappa, rho):
    def force(theta):
        lean = mpmath.sin(alpha - theta) + kappa * mpmath.sin(theta)
        return lean + rho * mpmath.sin(alpha) * mpmath.cos(theta / 2)

    own = restrainer_of(alpha, kappa, rho)
    assert abs(force(own.balance)) < 1e-14
    assert own.rate == pytest.approx(math.sqrt(-mpmath.diff(force, own.balance)), rel=1e-12)
    barrier = mpmath.quad(force, [0, own.balance])
    lossless = rk.System(
        rk.PiecewiseLinear([0.0, 0.0], step=0.1),
        1.0,
        critical_angle=alpha,
        stiffness_ratio=kappa,
        prestress_ratio=rho,
    )
    for part, outcome in ((1 - 1e-9, "bounded"), (1 + 1e-9, "overturned")):
        speed = part * float(mpmath.sqrt(2 * barrier)) / alpha
        assert rk.simulate(lossless, rk.State(velocity=speed)).outcome == outcome


def test_lift_off_grows_with_the_force_at_rest():
    block = restrained(BLOCK, 0.4, 0.7)
    for above, moves in ((1 - 1e-9, False), (1 + 1e-9, True)):
        ground = rk.GroundMotion([0.0, above * 1.7 * 0.3 * GRAVITY, 0.0], step=0.3)
        system = block.system(ground)
        assert system.lift_off == pytest.approx(1.7 * 0.3 / BLOCK.critical_angle, rel=1e-14)
        assert (rk.simulate(system).peak > 0) == moves


def test_a_stiff_restrainer_returns_the_block_from_any_angle_short_of_a_right_one():
    case = Case(np.random.default_rng(1))
    case.kappa, case.rho, case.alpha = 1.2, 0.4, 0.3
    still = rk.PiecewiseLinear([0.0, 0.0], step=0.1)
    ratios = {"stiffness_ratio": case.kappa, "prestress_ratio": case.rho}
    system = rk.System(still, 0.9, critical_angle=0.3, **ratios)
    flat = math.pi / 2 / 0.3
    assert rk.simulate(system, rk.State((1 - 1e-6) * flat)).outcome == "at-rest"
    grazing = rk.simulate(system, rk.State((1 - 1e-15) * flat))
    assert grazing.outcome == "at-rest"
    assert not grazing.certified
    assert rk.simulate(system, rk.State(0.9 * flat, 3.0)).outcome == "overturned"
    assert math.isnan(rk.simulate(case.system()).margin)


def test_fall_is_shown_until_the_block_lies_flat():
    """In the computed motion the restrainer raises it again within .01."""
    angle = 0.2632116693400544
    pushes = np.concatenate(
        [np.zeros(33), np.full(4, -195.244921875 * math.tan(angle) / angle), np.zeros(50)]
    )
    base = rk.PiecewiseLinear(pushes, step=0.05)
    system = rk.System(
        base, 0.8, critical_angle=angle, stiffness_ratio=44.551694063811496, prestress_ratio=0.1
    )
    motion = rk.simulate(system)
    end = end_shown(motion)
    assert motion.overturning.time <= end < motion.overturning.time + 0.1
    assert abs(motion.at(end)[0]) == pytest.approx(math.pi / 2 / angle, rel=1e-9)


@pytest.mark.parametrize("kind", ["half-sine", "one-cosine", "triangular"])
def test_spectra_of_pulses_and_single_motions_agree(kind):
    pulse = rk.Pulse(kind, amplitude=3.0, duration=1.0)
    system = rk.System(pulse, 0.85, critical_angle=0.25, stiffness_ratio=0.3, prestress_ratio=0.4)
    data = rk.overturning_spectrum(system, amplitude=[2.0, 4.0, 9.0], frequency=[1.0, 3.0]).dataset
    assert data.attrs["stiffness_ratio"] == 0.3
    turns = 0.5 if kind == "half-sine" else 1.0
    for k, size in enumerate((2.0, 4.0, 9.0)):
        for n, frequency in enumerate((1.0, 3.0)):
            own = rk.Pulse(kind, amplitude=size, duration=turns * math.tau / frequency)
            motion = rk.simulate(
                rk.System(own, 0.85, critical_angle=0.25, stiffness_ratio=0.3, prestress_ratio=0.4)
            )
            peak = data.peak.transpose("amplitude", "frequency").values[k, n]
            fell = motion.outcome == "overturned"
            assert math.isinf(peak) == fell
            assert fell or peak == pytest.approx(motion.peak, rel=1e-11, abs=1e-14)


@pytest.mark.parametrize("polarity", [1.0, "worse"])
def test_surveys_give_the_results_of_single_motions(polarity):
    records, levels = rk.synthetic_ground_motions(3, seed=4), [4.0, 7.0, 10.0, 16.0]
    block, how = restrained(BLOCK, 0.5, 0.3), {"intensity": "pga", "polarity": polarity}
    data = rk.incremental_dynamic_analysis(records, block, levels, **how)
    peaks, angles = data.dataset.peak.values, data.to_xarray().peak.values
    bands = rk.overturning_set(records, block, np.linspace(4.0, 16.0, 13), **how)
    assert rk.fragility(records, block, levels, replicates=100, **how).dataset.attrs[
        "stiffness_ratio"
    ] == pytest.approx(0.5)
    assert np.isinf(peaks).any()
    assert np.isfinite(peaks).any()
    if polarity == "worse":
        return
    for number, record in enumerate(records):
        for place, level in enumerate(levels):
            motion = rk.simulate(block.system(record.scaled(pga=level)))
            fell = motion.outcome == "overturned"
            assert (peaks[number, place] == math.inf) == fell
            assert fell or peaks[number, place] == pytest.approx(motion.peak, rel=1e-12, abs=1e-15)
            assert fell or angles[number, place] == pytest.approx(
                BLOCK.critical_angle * motion.peak, rel=1e-12
            )
            assert fell == any(low <= level < high for low, high in bands.intervals(number)) or level == 16.0


STIFF = restrained(BLOCK, 1.5, 0.2)
RATIOS = {"stiffness_ratio": 0.3, "prestress_ratio": 0.2}
SAMPLES = rk.PiecewiseLinear([0.0, 2.0, 0.0], step=0.5)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: STIFF.system(rk.example_ground_motion(), model="slender"),
            "stiffness must be below 56880.2 N/m, from where on a slender block has no unstable balance",
        ),
        (lambda: STIFF.system(acceleration=3.0, period_s=1.0), "stiffness must be below"),
        (
            lambda: rk.Block(2.0, 0.6, normalised_by="balance").restrained(1e6, mass=5.0),
            "stiffness must be b",
        ),
        (lambda: restrained(BLOCK, 1001.0, 0.0), "stiffness must be at most"),
        (
            lambda: STIFF.system(acceleration=3.0, period_s=1.0, model="full"),
            "model must be 'slender' for a restrained block on a harmonic base",
        ),
        (
            lambda: rk.System(rk.Harmonic(2.0, period=1.0), 0.9, critical_angle=0.3, **RATIOS),
            "stiffness_ratio must be 0 on a harmonic base",
        ),
        (lambda: rk.System(SAMPLES, 0.9, **RATIOS), "stiffness_ratio must be 0 for a slender block"),
        (
            lambda: rk.System(SAMPLES, 0.9, prestress_ratio=0.1),
            "prestress_ratio must be 0 for a slender block",
        ),
        (lambda: rk.System(SAMPLES, 0.9, critical_angle=0.3, stiffness_ratio=-1.0), "stiffness_ratio must l"),
        (
            lambda: rk.System(SAMPLES, 0.9, rk.Braces(0.5), critical_angle=0.3, **RATIOS),
            "braces must be omitted for a restrained block",
        ),
        (
            lambda: rk.System(SAMPLES, 0.5, critical_angle=0.3, left=rk.Wall(0.5), **RATIOS),
            "left must be omitted for a restrained block",
        ),
        (
            lambda: rk.System(SAMPLES, 0.5, critical_angle=0.3, vertical=SAMPLES, **RATIOS),
            "vertical must be omitted for a restrained block",
        ),
    ],
)
def test_what_does_not_go_with_a_restrainer_is_refused(make, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        make()
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)


def test_the_block_of_a_system_has_its_units():
    ground, block = rk.example_ground_motion(), restrained(BLOCK, 0.6, 0.5)
    slender, full = block.system(ground, model="slender").block, block.system(ground).block
    assert float(slender.radians(1.0)) == pytest.approx(3.75 * BLOCK.critical_angle, rel=1e-14)
    assert float(slender.acceleration(1.0)) == pytest.approx(1.5 * 0.3 * GRAVITY, rel=1e-14)
    for name in ("radians", "seconds", "acceleration"):
        assert float(getattr(full, name)(1.0)) == float(getattr(BLOCK, name)(1.0))
    assert (slender.by_balance, full.by_balance, block.by_balance) == (True, False, False)


@pytest.mark.parametrize("model", ["slender", "full"])
def test_command_of_a_spectrum_gives_the_outcomes_of_single_motions(model, tmp_path, monkeypatch):
    path, block = tmp_path / "spectrum.nc", restrained(BLOCK, 0.3, 0.2)
    own = block.restrainer
    values = ["--height", 2, "--width", 0.6, "--mass", own.mass, "--restrainer-stiffness", own.stiffness]
    values += ["--restrainer-prestress", own.prestress, "--pulse", "one-sine", "--model", model]
    values += ["--acceleration-g", "0.4:2:5", "--frequency-hz", "0.5:2:3", "--netcdf", path]
    monkeypatch.setattr(sys, "argv", ["rocking", "overturning-spectrum", *map(str, values)])
    assert run() == (0, "")
    with xr.open_dataset(path) as data:
        outcomes = data.outcome.transpose("amplitude", "frequency").values
        np.testing.assert_allclose(data.amplitude.values, GRAVITY * np.linspace(0.4, 2.0, 5), rtol=1e-12)
        np.testing.assert_allclose(data.frequency.values, [0.5, 1.25, 2.0], rtol=1e-12)
    fell = outcomes == list(rk.Outcome).index(rk.Outcome.OVERTURNED)
    assert 0 < fell.sum() < fell.size
    for k, size in enumerate(np.linspace(0.4, 2.0, 5).tolist()):
        for n, frequency in enumerate((0.5, 1.25, 2.0)):
            pulse = rk.Pulse("one-sine", amplitude=size * GRAVITY, duration=1.0 / frequency)
            motion = rk.simulate(block.system(pulse, model=model))
            assert fell[k, n] == (motion.outcome == "overturned")


def test_results_state_the_ratios_of_the_restrainer():
    system = restrained(BLOCK, 0.3, 0.2).system(rk.example_ground_motion().scaled(pga=5.0))
    result = rk.simulate(system).to_dict()
    assert (result["stiffness_ratio"], result["prestress_ratio"]) == pytest.approx((0.3, 0.2), rel=1e-14)
    assert "stiffness_ratio" not in rk.simulate(BLOCK.system(rk.example_ground_motion())).to_dict()
