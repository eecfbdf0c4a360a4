"""Blocks against a wall, slender and full: against two other methods, balls of 50 digits, closed forms and single motions."""

import math
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import rocking as rk
from oracles import full_taylor
from oracles import unsymmetric as oracle
from switches import agrees, certified_near_switches, check_margins_near_switches, compare_beside_switches

RECORD = Path(__file__).parents[3] / "shared" / "records" / "NGA_no_1063_RRS228.AT2"
BLOCK = rk.Block(2.0, 0.6)
MODELS = "slender", "full"
SCALES = np.linspace(0.3, 4.0, 38).tolist()


class Case(NamedTuple):
    """Critical angle, coefficient of restitution, base motion at unit scale, and start."""

    alpha: float
    e: float
    full: bool
    base: rk.PiecewiseLinear | rk.Pulse
    start: rk.State

    def system(self, scale):
        base = self.base
        if isinstance(base, rk.Pulse):
            base = rk.Pulse(base.kind, amplitude=scale * base.amplitude, duration=base.duration)
        else:
            base = rk.PiecewiseLinear(base.values, step=base.step, scale=scale)
        return rk.System(base, self.e, critical_angle=self.alpha if self.full else None, left=rk.Wall(self.e))

    @property
    def until(self):
        """Time up to which other methods follow the motion; it rests or has overturned by then, unless it is elastic."""
        base = self.base
        return (base.duration if isinstance(base, rk.Pulse) else base.values.size * base.step) + 45.0

    def motion(self, scale):
        return rk.simulate(self.system(scale), self.start, duration=self.until if self.e == 1.0 else None)

    def falls(self, scale):
        return self.motion(scale).outcome == "overturned"

    def of_oracle(self, scale, method):
        """Return the result of another method."""
        g, base = scale * self.alpha, self.base
        if isinstance(base, rk.Pulse):
            turns, phase = base.cosine
            wave = g * base.amplitude, math.tau * turns / base.duration, phase, base.duration
            shaking = oracle.Base(np.empty(0), 1.0, *wave)
        else:
            shaking = oracle.Base(base.values * g, base.step, 0.0, 1.0, 0.0, 0.0)
        block = oracle.Block((self.alpha,) * 2, (1.0, 1.0), (self.e,) * 2, self.full, wall=True)
        return method(block, shaking, self.start.angle, self.start.velocity, self.until)

    def falls_exactly(self, scale):
        base, angle = self.base, self.alpha if self.full else 0.0
        return full_taylor.Block(base.values, base.step, scale, self.e, angle, wall=True).overturns()


def cases(count, seed, most=1.0):
    """Yield random blocks under samples and pulses; every tenth is elastic or inelastic."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        e = float(rng.uniform(0.0, most)) if k % 10 else float(k // 10 % 2)
        if k % 3:
            size, step = int(rng.integers(20, 60)), float(rng.choice([0.05, 0.1, 0.3]))
            values = rng.normal(size=size).cumsum() * 0.3 * np.hanning(size) * rng.uniform(1.0, 5.0)
            base = rk.PiecewiseLinear(values, step=step)
        else:
            kind, sign = str(rng.choice(["half-sine", "one-sine", "one-cosine"])), rng.choice([-1.0, 1.0])
            base = rk.Pulse(kind, amplitude=sign * rng.uniform(1.2, 4.0), duration=rng.uniform(0.5, 4.0))
        start = rk.State(*rng.uniform((0.01, -0.4), (0.4, 0.4))) if k % 4 == 0 else rk.State()
        yield Case(float(rng.uniform(0.1, 0.35)), e, bool(k // 3 % 2), base, start)


def compare(case, scale, method):
    """Return whether the block overturned, after a comparison of outcome and peak with another method."""
    return agrees(case.motion(scale), case.of_oracle(scale, method))


@pytest.mark.parametrize("number", range(12))
def test_motion_agrees_with_runge_kutta(number):
    compare(list(cases(12, 9))[number], 1.0, oracle.with_runge_kutta)


@pytest.mark.long
def test_sixty_motions_agree_with_dop853():
    """Twenty of them lie at either side of a switch of the outcome, at 1e-5 of the scale."""
    fallen = sum(compare(case, 1.0, oracle.with_dop853) for case in cases(40, 7))
    assert 5 < fallen < 35
    compare_beside_switches(cases(200, 8), SCALES, 20, partial(compare, method=oracle.with_dop853))


def under_samples(count, seed):
    """Yield blocks under samples, at rest at first, that lose a part of their speed at an impact."""
    for case in cases(100 * count, seed, most=0.9):
        if not isinstance(case.base, rk.Pulse) and case.start == rk.State() and case.e not in (0.0, 1.0):
            yield case


@pytest.mark.parametrize(
    ("count", "powers"),
    [(16, (4, 8, 12, 14)), pytest.param(700, range(3, 15), marks=pytest.mark.long)],
)
def test_no_certified_outcome_next_to_a_switch_is_wrong(count, powers):
    certified_near_switches(under_samples(count, 3), SCALES, count, powers, least=0.6)


def test_margin_has_the_sign_of_the_outcome_and_vanishes_at_a_switch():
    check_margins_near_switches(under_samples(24, 5), SCALES)


# Scale of the record, peak |theta|/theta_cr; an independent brute force in physical units (RK4, dt/20 to dt/100).
PEAKS = [(0.5, 0.0822535), (0.6, 0.2526897), (0.7, 0.4863877), (-0.7, 0.0329470)]


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize(("scale", "peak"), PEAKS)
@pytest.mark.parametrize("e", [0.3, 0.5])
def test_peaks_of_a_record(scale, peak, e):
    motion = rk.simulate(BLOCK.system(rk.read_ground_motion(RECORD).scaled(scale), wall=rk.Wall(e)))
    assert motion.peak == pytest.approx(peak, rel=0, abs=1e-7)
    assert motion.certified


@pytest.mark.parametrize("model", MODELS)
def test_an_elastic_impact_keeps_the_speed_and_an_inelastic_one_ends_in_contact(model):
    ground = rk.example_ground_motion().scaled(pga=8.0)
    for e in (1.0, 0.4, 0.0):
        events = rk.simulate(BLOCK.system(ground, wall=rk.Wall(e), model=model), record="all").events
        hits = events[events["kind"] == "impact"]
        assert hits.size > 2
        assert (hits["before"] < 0).all()
        if e == 0.0:
            np.testing.assert_array_equal(hits["after"], 0.0)
            continue
        flies = hits["after"] != 0.0
        np.testing.assert_allclose(hits["after"][flies], -e * hits["before"][flies], rtol=1e-14)
        assert e < 1.0 or flies.all()


def test_bounces_on_a_base_at_rest_are_those_of_the_closed_form():
    """A slender block that leaves with v returns after 2 artanh v, at the speed v. So the k-th bounce lasts 2 artanh(e^k v)."""
    e, v = 0.6, 0.7
    motion = rk.simulate(
        rk.System(rk.PiecewiseLinear([0.0, 0.0], step=0.5), e, left=rk.Wall(e)), rk.State(0.0, v)
    )
    times = np.cumsum(2.0 * np.arctanh(v * e ** np.arange(200)))
    hits = motion.events[motion.events["kind"] == "impact"]
    assert hits.size > 40
    np.testing.assert_allclose(hits["time"], times[: hits.size], rtol=1e-13)
    assert motion.outcome == "at-rest"
    assert motion.events["time"][-1] == pytest.approx(times[-1], rel=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_the_block_lifts_to_one_side_only(model):
    level = math.tan(BLOCK.critical_angle) * 9.80665
    for sign, moves in ((-1.0, True), (1.0, False)):
        for above in (0.999, 1.001):
            ground = rk.GroundMotion([0.0, sign * above * level, 0.0], step=0.3)
            motion = rk.simulate(BLOCK.system(ground, wall=rk.Wall(0.5), model=model))
            assert (motion.peak > 0) == (moves and above > 1)
            assert moves or motion.outcome == "at-rest"
    ground = rk.example_ground_motion().scaled(pga=7.0)
    angles = rk.simulate(BLOCK.system(ground, wall=rk.Wall(0.5), model=model)).to_xarray().angle
    assert angles.min() == 0.0 < angles.max()


def test_an_offset_counts_by_the_side_that_lifts_alone():
    ground, wall = rk.example_ground_motion().scaled(pga=7.0), rk.Wall(0.5)
    block = rk.Block(2.0, 0.6, offset=0.05)
    other = rk.Block(2.0, 0.5, centre_height=1.0, radius_of_gyration=block.radius_of_gyration)
    peaks = [rk.simulate(each.system(ground, wall=wall)).peak for each in (block, other)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-11)


@pytest.mark.parametrize("model", MODELS)
def test_surveys_give_the_results_of_single_motions(model):
    records, wall = rk.synthetic_ground_motions(3, seed=4), rk.Wall(0.4)
    block, levels = rk.Block(2.0, 0.6, wall=wall), [3.0, 5.0, 7.0, 9.0]
    how = {"intensity": "pga", "model": model}
    peaks = rk.incremental_dynamic_analysis(records, block, levels, **how).dataset.peak.values
    spectrum = rk.rocking_spectrum(records, block, levels, **how).dataset
    fragility = rk.fragility(records, block, levels, replicates=100, **how).dataset
    bands = rk.overturning_set(records, block, np.linspace(3.0, 9.0, 7), **how)
    assert fragility.attrs["wall_restitution"] == spectrum.attrs["wall_restitution"] == 0.4
    np.testing.assert_array_equal(spectrum.peak.values, peaks)
    for number, record in enumerate(records):
        for place, level in enumerate(levels):
            motion = rk.simulate(BLOCK.system(record.scaled(pga=level), wall=wall, model=model))
            fell = motion.outcome == "overturned"
            assert (peaks[number, place] == math.inf) == fell
            assert fell or peaks[number, place] == pytest.approx(motion.peak, rel=1e-12, abs=1e-15)
            assert fell == any(low <= level < high for low, high in bands.intervals(number)) or level == 9.0


def test_a_survey_of_pulses_gives_the_results_of_single_motions():
    system = rk.System(rk.Pulse("one-sine", amplitude=-5.0, duration=1.0), 0.4, left=rk.Wall(0.4))
    data = rk.overturning_spectrum(system, amplitude=[3.0, 6.0], frequency=[3.0, 5.0]).dataset
    for amplitude in (3.0, 6.0):
        for frequency in (3.0, 5.0):
            pulse = rk.Pulse("one-sine", amplitude=amplitude, duration=math.tau / frequency)
            motion = rk.simulate(rk.System(pulse, 0.4, left=rk.Wall(0.4)))
            peak = float(data.peak.sel(amplitude=amplitude, frequency=frequency))
            assert peak == (math.inf if motion.outcome == "overturned" else pytest.approx(motion.peak))


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: BLOCK.system(PULSE, wall=rk.Wall(0.5), braces=rk.Braces(0.5)),
            "braces must be omitted for a bl",
        ),
        (
            lambda: rk.System(PULSE, 0.9, left=rk.Wall(0.5)),
            "restitution must be that of the wall, 0.5; got 0.9",
        ),
        (lambda: rk.simulate(AGAINST, rk.State(-0.1, 0.0)), "start must start at an angle above 0"),
        (lambda: rk.Wall(1.1), "restitution must"),
        (lambda: rk.theory.ishiyama_levels(rk.Block(2.0, 0.6, wall=rk.Wall(0.5))), "block must be symmetric"),
    ],
)
def test_what_does_not_go_with_a_wall_is_refused(make, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        make()
    assert str(caught.value).startswith(sentence)


PULSE = rk.Pulse("one-sine", amplitude=4.0, duration=0.5)
AGAINST = rk.System(rk.PiecewiseLinear([0.0, 2.0, 0.0], step=0.5), 0.5, left=rk.Wall(0.5))


def test_a_block_at_rest_needs_friction_only_where_it_is_pulled_away_from_the_wall():
    for sign, needed in ((-1.0, 0.2), (1.0, 0.0)):
        ground = rk.GroundMotion([0.0, sign * 0.2 * 9.80665, 0.0], step=0.3)
        validity = rk.simulate(BLOCK.system(ground, wall=rk.Wall(0.5))).validity(BLOCK)
        assert validity.friction == pytest.approx(needed, abs=1e-12)
        assert any(
            sentence.startswith("wall: its impacts are not assessed") for sentence in validity.warnings
        )
