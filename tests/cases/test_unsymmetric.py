"""Blocks with unequal sides, slender and full: against two other methods, equal sides, and derivatives of the simulated motion."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import rocking as rk
from oracles import unsymmetric as oracle
from rocking.kernels import batch
from rocking.kernels import system as numbers
from rocking.kernels.classify import verdict
from rocking.kernels.motion import finite_motion, march, observers, tangent
from rocking.motion.march_loop import parameters

GRAVITY = 9.80665
RECORD = Path(__file__).parents[3] / "shared" / "records" / "NGA_no_1063_RRS228.AT2"
BASES = "cosine", "samples", "pulse"
CYCLES = 6
NEVER = np.zeros(1, np.int64)


class Sides(NamedTuple):
    """Critical angle of the right side, ratios of the left one, and both coefficients of restitution."""

    alpha: float
    ratio: float
    rate: float
    first: float
    second: float

    def block(self, *, full):
        left = numbers.LeftSide(self.ratio, self.rate, self.second)
        if full:
            return numbers.full_block(self.first, self.alpha, left=left)
        return numbers.slender_block(self.first, left=left)

    def of_oracle(self, *, full):
        angles = self.alpha, self.alpha * self.ratio
        return oracle.Block(angles, (1.0, self.rate), (self.first, self.second), full)


class Case(NamedTuple):
    """Block, base motion at unit scale, and initial state."""

    sides: Sides
    full: bool
    base: str
    values: tuple[float, ...] | np.ndarray  # amplitude, frequency, phase and duration; or samples
    step: float
    angle: float
    velocity: float

    @property
    def until(self):
        if self.base == "cosine":
            return CYCLES * math.tau / self.values[1]
        return (self.values.size * self.step if self.base == "samples" else self.values[3]) + 25.0

    def parameters(self, scale):
        block = self.sides.block(full=self.full)
        if self.base == "samples":
            tables = numbers.tables_of(self.values, self.step)
            return numbers.sampled_system(block, tables, scale, numbers.CYCLE * self.step)
        amplitude, frequency, phase, duration = self.values
        if self.base == "cosine":
            return numbers.harmonic_system(block, scale * amplitude, frequency, math.tau / frequency, phase)
        return numbers.pulse_system(block, scale * amplitude, frequency, phase, duration, duration)

    def of_oracle(self, scale):
        g = scale * self.sides.alpha
        if self.base == "samples":
            return oracle.Base(self.values * g, self.step, 0.0, 1.0, 0.0, 0.0)
        amplitude, frequency, phase, duration = self.values
        ends = duration if self.base == "pulse" else 1e300
        return oracle.Base(np.empty(0), 1.0, amplitude * g, frequency, phase, ends)

    def run(self, scale):
        """Return whether the block overturned, and the largest angle."""
        p, cycles = self.parameters(scale), CYCLES if self.base == "cosine" else march.OPEN
        watched = march.Recording(0.0, np.empty((0, 4)), np.empty(0, observers.EVENT_ROW), True)
        status, progress, _, _ = march.march(
            p, march.begin_march(p, self.angle, self.velocity)[0], cycles, watched
        )
        if self.base != "cosine":
            end = finite_motion.run_to_end(p, self.angle, self.velocity, math.inf)
            assert (end.status == march.OVERTURNED) == (status == march.OVERTURNED)
            if not self.full:
                assert end.decided
        return status == march.OVERTURNED, progress.peak

    def switch(self):
        """Return two scales close to each other of which only the second overturns the block; None if there are none."""
        levels = np.linspace(0.3, 2.5, 23)
        fallen = [self.run(level)[0] for level in levels]
        if fallen[0] or not any(fallen):
            return None
        place = fallen.index(True)
        low, high = levels[place - 1], levels[place]
        while high - low > 2e-5:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.run(middle)[0] else (middle, high)
        return low, high


def cases(count, seed):
    rng = np.random.default_rng(seed)
    for k in range(count):
        base, full = BASES[k % 3], bool(k // 3 % 2)
        sides = Sides(
            rng.uniform(0.1, 0.35), rng.uniform(0.6, 1.6), rng.uniform(0.93, 1.07), *rng.uniform(0.5, 0.95, 2)
        )
        values, step = rng.uniform((1.2, 1.5, -3.0, 0.5), (4.0, 9.0, 3.0, 4.0)), 0.0
        if base == "samples":
            size, step = int(rng.integers(20, 60)), float(rng.choice([0.05, 0.1, 0.3]))
            values = rng.normal(size=size).cumsum() * 0.3 * np.hanning(size) * rng.uniform(1.0, 5.0)
        else:
            values = tuple(values.tolist())
        start = (0.0, 0.0) if k % 2 else tuple(rng.uniform(-0.4, 0.4, 2).tolist())
        yield Case(sides, full, base, values, step, *start)


def compare(case, scale, methods=(oracle.with_dop853, oracle.with_runge_kutta)):
    """Return whether the block overturned, after a comparison of outcome and peak with other methods."""
    fell, peak = case.run(scale)
    block, base = case.sides.of_oracle(full=case.full), case.of_oracle(scale)
    until = case.until + (20.0 if fell else 0.0)  # overturning is proved before the block lies flat
    for method in methods:
        found = method(block, base, case.angle, case.velocity, until)
        assert found.overturned == fell
        assert fell or found.peak == pytest.approx(peak, rel=0, abs=1e-6)
    return fell


@pytest.mark.long
def test_sixty_motions_agree_with_dop853_and_with_runge_kutta():
    """Twenty of them lie at either side of a switch of the outcome, within 1e-5 of the scale."""
    fallen, compared = 0, 0
    for case in cases(40, 7):
        fallen += compare(case, 1.0)
    assert 5 < fallen < 35
    for case in cases(120, 8):
        scales = case.switch()
        if scales is None:
            continue
        assert not compare(case, scales[0])
        assert compare(case, scales[1])
        compared += 2
        if compared == 20:
            break
    assert compared == 20


@pytest.mark.parametrize("number", range(12))
def test_motion_agrees_with_runge_kutta(number):
    compare(list(cases(12, 9))[number], 1.0, [oracle.with_runge_kutta])


def recorded(p, start, *, cycles):
    """Return all that a march computes: states, events, section, peak, tangent vectors and their growth."""
    columns, section = np.eye(2), np.empty((20, 4))
    events = np.zeros(40_000, observers.EVENT_ROW)
    state = tangent.TangentState(columns, np.zeros(2))
    progress, hit = march.begin_march(p, *start)
    written = march.note_start(events, progress, hit, start[1])
    status, progress, rows, more = march.march(
        p, progress, cycles, march.Recording(0.1, section, events[written:], True), state
    )
    arc = progress.arc
    places = np.array([arc.side, arc.start, arc.angle, arc.velocity, progress.peak, progress.no_return])
    met = events[: written + more].tobytes()
    return status, progress.impacts, places, section[:rows], met, columns, state.growth


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("full", [False, True])
def test_equal_sides_give_the_same_bits(base, full):
    for case in cases(240, 10):
        if case.base != base or case.full != full:
            continue
        e = case.sides.first
        sides = case.sides._replace(ratio=1.0, rate=1.0, second=e)
        one = case._replace(sides=sides).parameters(1.0)
        block = numbers.full_block(e, sides.alpha) if full else numbers.slender_block(e)
        if base == "samples":
            other = numbers.sampled_system(block, one.forcing.tables, 1.0, one.clock.cycle_length)
        elif base == "cosine":
            amplitude, frequency, phase, _ = case.values
            other = numbers.harmonic_system(block, amplitude, frequency, math.tau / frequency, phase)
        else:
            other = numbers.pulse_system(block, *case.values, case.values[3])
        assert full or type(one) is not type(other)
        start, cycles = (case.angle, case.velocity), CYCLES if base == "cosine" else march.OPEN
        for first, second in zip(
            recorded(one, start, cycles=cycles), recorded(other, start, cycles=cycles), strict=True
        ):
            np.testing.assert_array_equal(first, second)
        if base != "cosine":
            ends = [finite_motion.run_to_end(p, *start, math.inf) for p in (one, other)]
            np.testing.assert_array_equal(*ends)


def rectangle(height, width, offset):
    """Return α, p and e of both sides of a uniform rectangle whose mass centre lies off the middle of its base."""
    h, arms, square = (
        height / 2,
        np.array([width / 2 - offset, width / 2 + offset]),
        (height**2 + width**2) / 12,
    )
    radii = h * h + arms**2
    kept = (square + h * h - arms.prod()) / (square + radii[::-1])
    return np.arctan(arms / h), np.sqrt(GRAVITY * np.sqrt(radii) / (square + radii)), kept


# Lowest overturning scale of RRS228, as recorded and reversed, by Runge-Kutta in physical units.
SCALES = {0.05: (0.4935257019, 0.5160387871), 0.02: (0.6510321139, 0.6674635231), 0.0: (0.6609032117, None)}


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize("offset", SCALES)
def test_lowest_overturning_scales_of_a_record(offset):
    motion = rk.read_ground_motion(RECORD)
    (alpha, other), (p, p_other), kept = rectangle(2.0, 0.6, offset)
    left = numbers.LeftSide(other / alpha, p_other / p, kept[1])
    for sign, expected in zip((1.0, -1.0), SCALES[offset], strict=True):
        if expected is None:
            continue
        values = np.ascontiguousarray(sign * motion.acceleration / (GRAVITY * alpha))
        tables = numbers.tables_of(values, motion.step * p)
        block = numbers.full_block(kept[0], alpha, left=left)
        system = numbers.sampled_system(block, tables, 1.0, numbers.CYCLE * motion.step * p)

        def followed(scales, system=system, alpha=alpha, kept=kept, left=left):
            runs, rows = (
                np.zeros(len(scales), kind) for kind in (finite_motion.RUN_ROW, finite_motion.ENDING_ROW)
            )
            runs["scale"], runs["restitution"], runs["critical_angle"] = scales, kept[0], alpha
            runs["angle_ratio"], runs["frequency_ratio"], runs["left_restitution"] = left
            assert finite_motion.run_batch(system, runs, True, rows, NEVER)
            return rows

        levels = np.arange(0.3, 0.8, 0.01)
        place = int(np.argmax(followed(levels)["status"] == march.OVERTURNED))
        low, high = levels[place - 1], levels[place]
        while high - low > 1e-12:
            middle = 0.5 * (low + high)
            fallen = followed([middle])["status"][0] == march.OVERTURNED
            low, high = (low, middle) if fallen else (middle, high)
        assert high == pytest.approx(expected, rel=0, abs=5e-8)
        if offset == 0.05:  # both peaks are on the right side
            peak = followed([0.45])["peak"][0]
            assert peak == pytest.approx(0.3491922 if sign > 0 else 0.0003586, rel=0, abs=1e-7)
        same = oracle.Block((alpha, other), (1.0, p_other / p), tuple(kept.tolist()), True)
        for scale, falls in ((low - 1e-8, False), (high + 1e-8, True)):
            base = oracle.Base(scale * alpha * values, motion.step * p, 0.0, 1.0, 0.0, 0.0)
            assert (
                oracle.with_runge_kutta(same, base, until=values.size * motion.step * p + 20.0).overturned
                == falls
            )


# Amplitude, period and phase; sides; whether the equation is full; start.
PERIODIC = [
    (3.0, 1.3, 0.3, Sides(0.2, 1.3, 0.98, 0.8, 0.85), False),
    (3.0, 1.3, 0.3, Sides(0.2, 1.3, 0.98, 0.8, 0.85), True),
    (5.0, 0.9, 0.3, Sides(0.3, 0.8, 1.03, 0.7, 0.9), False),
    (5.0, 0.9, 0.3, Sides(0.3, 0.8, 1.03, 0.7, 0.9), True),
]


def image(p, start, cycles):
    progress = march.begin_march(p, *start)[0]
    watched = march.Recording(0.0, np.empty((0, 4)), np.empty(0, observers.EVENT_ROW))
    status, progress, _, _ = march.march(p, progress, cycles, watched)
    assert status == march.DONE
    return np.array([progress.arc.side * progress.arc.angle, progress.arc.side * progress.arc.velocity])


@pytest.mark.parametrize("amplitude, period, phase, sides, full", PERIODIC)
def test_multipliers_and_exponents_are_those_of_differences(amplitude, period, phase, sides, full):
    p = numbers.harmonic_system(sides.block(full=full), amplitude, math.tau / period, period, phase)
    start, cycles, step = np.array([0.1, 0.2]), 4, 1e-6
    _, impacts, _, _, _, columns, growth = recorded(p, start, cycles=cycles)
    assert impacts > 3
    plain = np.eye(2)
    progress = march.begin_march(p, *start)[0]
    watched = march.Recording(0.0, np.empty((0, 4)), np.empty(0, observers.EVENT_ROW))
    march.march(p, progress, cycles, watched, tangent.TangentState(plain, np.empty(0)))
    differences = [
        (image(p, start + step * unit, cycles) - image(p, start - step * unit, cycles)) / (2 * step)
        for unit in np.eye(2)
    ]
    np.testing.assert_allclose(plain, differences, rtol=0, atol=1e-7 * np.abs(plain).max())
    # both exponents add up to the logarithm of the area, and the directions are those of the product of the matrices
    assert growth.sum() == pytest.approx(math.log(abs(np.linalg.det(plain))), abs=1e-9)
    assert growth[0] == pytest.approx(math.log(np.hypot(*differences[0])), abs=1e-6)
    np.testing.assert_allclose(np.abs(columns @ columns.T), np.eye(2), atol=1e-12)


@pytest.mark.parametrize("full", [False, True])
def test_verdicts_over_a_grid_agree_with_long_motions(full):
    """An orbit returns to its state; a block overturns or rests as its motion does. Every fifth row has equal sides."""
    rng, rows = np.random.default_rng(4), []
    for k in range(160):
        period, e = rng.uniform(0.5, 3.0), rng.uniform(0.6, 0.95)
        wave = rng.uniform(0.5, 6.0), math.tau / period, period, rng.uniform(-3.0, 3.0)
        left = (
            (1.0, 1.0, e) if k % 5 == 0 else (*rng.uniform((0.7, 0.95), (1.4, 1.05)), rng.uniform(0.6, 0.95))
        )
        rows.append((*wave, e, math.inf, 1.0, rng.uniform(0.1, 0.3) if full else 0.0, *left))
    systems, starts = np.array(rows), np.zeros((len(rows), 2))
    found = batch.classify_batch(systems, starts, 2_000, 16, NEVER)
    anchors = batch.anchors_of(systems, starts, found)
    unequal = numbers.unequal_sides(systems)
    assert {verdict.PERIODIC, verdict.REST, verdict.OVERTURNS} <= set(found.kind[unequal].tolist())
    assert (found.impacts[unequal & (found.kind == verdict.PERIODIC)] == -1).any()  # orbits that rest
    for k, row in enumerate(systems):
        p = numbers.parameters_of_row(row)
        np.testing.assert_array_equal(numbers.row_of(p), row)
        if found.kind[k] == verdict.PERIODIC:
            shifted = numbers.parameters_of_row([*row[:3], row[3] + row[1] * found.section_time[k], *row[4:]])
            state = np.array([found.angle[k], found.velocity[k]])
            back = image(shifted, state, int(found.period[k]))
            np.testing.assert_allclose(back, state, rtol=0, atol=1e-6)
            assert np.isfinite(anchors[k]).all()
            assert not (unequal[k] and found.symmetric[k])
        elif found.kind[k] in (verdict.REST, verdict.OVERTURNS):
            fallen, _, places, *_ = recorded(p, (0.0, 0.0), cycles=2_000)
            assert (fallen == march.OVERTURNED) == (found.kind[k] == verdict.OVERTURNS)
            assert fallen == march.OVERTURNED or places[2] == 0.0


@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("base", ["samples", "pulse"])
def test_batches_end_as_single_motions_do(base, full):
    """The ratio of frequency parameters of a slender block under samples is that of its tables."""
    fallen = 0
    for case in (each for each in cases(60, 11) if each.base == base and each.full == full):
        scales, sides = np.linspace(0.5, 2.0, 7), case.sides
        rows = np.zeros(scales.size, finite_motion.ENDING_ROW)
        kind = finite_motion.RUN_ROW if base == "samples" else finite_motion.PULSE_ROW
        runs = np.zeros(scales.size, kind)
        runs["restitution"], runs["critical_angle"] = sides.first, sides.alpha
        runs["angle_ratio"], runs["frequency_ratio"], runs["left_restitution"] = (
            sides.ratio,
            sides.rate,
            sides.second,
        )
        if base == "samples":
            runs["scale"] = scales
            assert finite_motion.run_batch(case.parameters(1.0), runs, True, rows, NEVER)
        else:
            runs["amplitude"] = scales * case.values[0]
            runs["frequency"], runs["phase"], runs["duration"] = case.values[1:]
            assert finite_motion.run_pulses(case.parameters(1.0), runs, True, rows, NEVER)
        for scale, row in zip(scales, rows, strict=True):
            fell, peak = case._replace(angle=0.0, velocity=0.0).run(scale)
            assert (row["status"] == march.OVERTURNED) == fell
            assert fell or row["peak"] == pytest.approx(peak, rel=0, abs=1e-13)
            assert full or row["decided"]
            fallen += fell
    assert fallen > 5


def test_margin_of_a_slender_block_is_that_of_its_side():
    """After the last sample, with u' = v on a side, K+ = v/(alpha p) - 1 in the units of the side."""
    sides = Sides(0.2, 1.3, 0.9, 0.8, 0.85)
    for velocity, unit in ((0.6, 1.0), (-0.6, sides.ratio * sides.rate)):
        p = numbers.sampled_system(sides.block(full=False), numbers.tables_of(np.zeros(3), 0.1), 1.0, 6.4)
        end = finite_motion.run_to_end(p, 0.0, velocity, 0.2)
        assert end.margin == pytest.approx(0.6 / unit - 1.0, rel=0, abs=1e-14)
        assert end.decided


def test_an_orbit_is_proved_in_balls():
    """Krawczyk's operator encloses the phases of its events; the multipliers are those of its verdict, in double precision."""
    from flint import arb, ctx

    from rocking.proof import arc, chain, periodic

    amplitude, period, e, left = 3.0, 0.8, 0.9, (1.2, 0.97, 0.85)
    row = np.array([[amplitude, math.tau / period, period, 0.0, e, math.inf, 1.0, 0.0, *left]])
    found = batch.classify_batch(row, np.zeros((1, 2)), 5_000, 16, NEVER)
    assert found.kind[0] == verdict.PERIODIC
    assert found.impacts[0] > 0
    phase = row[0, 1] * found.section_time[0]
    p = numbers.parameters_of_row([*row[0, :3], phase, *row[0, 4:]])
    events = np.zeros(100, observers.EVENT_ROW)
    progress = march.begin_march(p, found.angle[0], found.velocity[0])[0]
    watched = march.Recording(0.0, np.empty((0, 4)), events)
    _, _, _, written = march.march(p, progress, int(found.period[0]), watched)
    met = events[:written]
    assert written == found.impacts[0]
    phases = phase + row[0, 1] * (met["cycle"] * period + met["time"])
    guess = chain.Chain(
        tuple(met["event"].astype(int).tolist()),
        int(met["side"][0]),
        2 * int(found.period[0]),
        False,
        tuple(phases.tolist()),
    )
    with ctx.workprec(256):
        frequency, zero = 2 * arb.pi() / arb(period), arb(amplitude)
        base = arc.Balls(zero, frequency, zero / (1 + frequency**2), arb(e), None, arb(1))
        proved = periodic.enclosed(arc.with_left(base, *map(arb, left)), guess)
        pair = periodic.multipliers(proved.trace, proved.determinant, False)
        assert periodic.stable(proved.trace, proved.determinant)
        for psi, double in zip(proved.found.box, phases, strict=True):
            assert float(psi) == pytest.approx(double, rel=0, abs=1e-9)
            assert float(psi.rad()) < 1e-30
        assert float(proved.determinant) == pytest.approx((e * left[2]) ** written, rel=1e-12)
        for one, real, imaginary in zip(
            pair,
            (found.real[0], found.other_real[0]),
            (found.imaginary[0], found.other_imaginary[0]),
            strict=True,
        ):
            assert float(one.real) == pytest.approx(real, rel=0, abs=1e-8)
            assert abs(float(one.imag)) == pytest.approx(abs(imaginary), rel=0, abs=1e-8)
        unequal = arc.with_left(base, arb(1), arb(1), arb(e) * (1 + arb(2) ** -20))
        with pytest.raises(arc.Refused):
            periodic.moves_between(unequal)


@pytest.mark.parametrize("full", [False, True])
def test_a_block_lifts_at_the_level_of_each_side(full):
    """Under a ramp from 0 to -+1.2 it lifts to the right at A = -tan(alpha)/alpha, to the left at that of the other side."""
    for ratio in (0.7, 1.1):
        sides, events = Sides(0.2, ratio, 1.03, 0.8, 0.85), np.zeros(20, observers.EVENT_ROW)
        for side, angle in ((1, sides.alpha), (-1, sides.alpha * ratio)):
            level = (math.tan(angle) if full else angle) / sides.alpha
            tables = numbers.tables_of(np.array([0.0, -1.2 * side]), 1.0)
            p = numbers.sampled_system(sides.block(full=full), tables, 1.0, 6.4)
            watched = march.Recording(0.0, np.empty((0, 4)), events)
            march.march(p, march.begin_march(p, 0.0, 0.0)[0], march.OPEN, watched)
            assert events["side"][0] == side
            assert events["time"][0] == pytest.approx(level / 1.2, rel=1e-14)


def test_states_after_a_pulse_start_at_its_end_although_rounding_puts_the_event_before_it():
    pulse = rk.Pulse("one-sine", amplitude=2.0748876302120816, duration=0.9609045650820724)
    motion = rk.simulate(rk.System(pulse, 0.86, left=rk.LeftSide(1.37, 0.993, 0.89)))
    assert np.abs(motion.peaks["angle"]).max() == pytest.approx(motion.peak, rel=1e-12)


def test_tables_of_the_left_side_are_made_once_for_all_runs_under_a_record():
    """Making them takes half as long as a run."""
    ground, block = rk.example_ground_motion(), rk.Block(2.0, 0.5, offset=0.02)
    first, second = (parameters(block.system(ground.scaled(pga=pga), model="slender")) for pga in (3.0, 4.0))
    assert first.left.forcing.tables is second.left.forcing.tables
    assert first.left.forcing.tables.step == first.forcing.tables.step * block.left.frequency_ratio
