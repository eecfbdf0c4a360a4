"""Restrained blocks: against another method in physical units, 50 digits, references and closed forms."""

import math
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from oracles import full_taylor
from oracles import unsymmetric as oracle
from restrained_blocks import GRAVITY, restrained
from switches import agrees, certified_near_switches, compare_beside_switches

RECORD = Path(__file__).parents[3] / "shared" / "records" / "NGA_no_1063_RRS228.AT2"
BLOCK = rk.Block(2.0, 0.4)
SCALES = np.linspace(0.3, 6.0, 39).tolist()


# kappa, rho and scale of the record, with a/(g theta_cr): peak in units of the unstable balance, and of theta_cr. They were
# computed by an independent brute force in physical units.
PEAKS = [
    (0.3, 0.2, 0.5, 0.493025607, 0.845187),
    (0.6, 0.5, 0.5, 0.12418818, 0.465706),
    (0.6, 0.5, 0.9, 0.90186802, 3.382),
]


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize(("kappa", "rho", "scale", "peak", "of_critical"), PEAKS)
def test_peaks_of_a_record(kappa, rho, scale, peak, of_critical):
    block = restrained(BLOCK, kappa, rho)
    ground = rk.read_ground_motion(RECORD).scaled(scale)
    motion = rk.simulate(block.system(ground, model="slender", normalised_by="angle"))
    assert motion.peak == pytest.approx(peak, rel=0, abs=1e-8)
    angle = motion.to_dict()["peak_rad"]
    assert angle / BLOCK.critical_angle == pytest.approx(
        of_critical, rel=0, abs=5e-5 if scale > 0.5 else 1e-6
    )
    assert motion.certified


class Case:
    """Random restrained block under a random ground motion."""

    def __init__(self, rng):
        self.kappa, self.rho = float(rng.uniform(0.0, 0.9)), float(rng.uniform(0.0, 1.0))
        self.block = restrained(
            rk.Block(float(rng.uniform(0.5, 4.0)), 0.15, 0.9).resized(2.0, float(rng.uniform(0.2, 0.6))),
            self.kappa,
            self.rho,
            mass=float(rng.uniform(10.0, 1e4)),
        )
        size, self.step = int(rng.integers(20, 60)), float(rng.choice([0.02, 0.04, 0.1]))
        values = rng.normal(size=size).cumsum() * np.hanning(size) * rng.uniform(0.3, 1.2)
        self.values = values * GRAVITY * math.tan(self.block.critical_angle)

    def motion(self, scale):
        ground = rk.GroundMotion(self.values, step=self.step).scaled(scale)
        return rk.simulate(self.block.system(ground, model="slender", normalised_by="angle"))

    def falls(self, scale):
        return self.motion(scale).outcome == "overturned"

    def by_oracle(self, scale, method):
        """Return the result of another method, from the equation with the terms of the restrainer."""
        alpha = math.atan2(self.block.width, self.block.height)
        rate = math.sqrt(3 * GRAVITY / (4 * math.hypot(self.block.width / 2, self.block.height / 2)))
        e = (self.block.restitution,) * 2
        own = oracle.Block((alpha,) * 2, (1.0, 1.0), e, full=False, kappa=self.kappa, rho=self.rho)
        base = oracle.Base(self.values * scale / GRAVITY, self.step * rate, 0.0, 1.0, 0.0, 0.0)
        return method(
            own, base, until=self.values.size * self.step * rate + 45.0 / math.sqrt(1.0 - self.kappa)
        )

    def compare(self, scale, method):
        """Return whether the block overturned, after a comparison of outcome and peak with another method."""
        motion = self.motion(scale)
        unit = motion.system.block.angle_unit / self.block.critical_angle
        return agrees(motion, self.by_oracle(scale, method), unit)

    def falls_exactly(self, scale):
        system = self.motion(scale).system
        base = system.forcing
        return full_taylor.Block(base.values, base.step, base.scale, system.restitution, 0.0).overturns()


def cases(count, seed):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield Case(rng)


def test_motions_agree_with_runge_kutta():
    fallen = [case.compare(1.0, oracle.with_runge_kutta) for case in cases(12, 9)]
    assert 0 < sum(fallen) < 12


@pytest.mark.long
def test_sixty_motions_agree_with_dop853():
    """Twenty of them lie at either side of a switch of the outcome, at 1e-5 of the scale."""
    fallen = sum(case.compare(1.0, oracle.with_dop853) for case in cases(40, 7))
    assert 5 < fallen < 35
    compare_beside_switches(cases(60, 8), SCALES, 20, partial(Case.compare, method=oracle.with_dop853))


@pytest.mark.parametrize(
    ("count", "powers"),
    [(12, (4, 8, 12, 14)), pytest.param(500, range(3, 15), marks=pytest.mark.long)],
)
def test_no_certified_outcome_next_to_a_switch_is_wrong(count, powers):
    certified_near_switches(cases(20 * count, 3), SCALES, count, powers, least=0.6)


@pytest.mark.parametrize("normalised_by", ["angle", "tangent"])
def test_lift_off_grows_with_the_force_at_rest(normalised_by):
    block, rho = restrained(BLOCK, 0.4, 0.7), 0.7
    unit = {"angle": BLOCK.critical_angle, "tangent": 0.2}[normalised_by]
    for above, moves in ((0.999, False), (1.001, True)):
        ground = rk.GroundMotion([0.0, above * (1 + rho) * unit * GRAVITY, 0.0], step=0.3)
        system = block.system(ground, model="slender", normalised_by=normalised_by)
        assert (rk.simulate(system).peak > 0) == moves


def test_unstable_balance_is_where_the_moments_are_equal():
    """From just below θu, at rest, the block returns; from just above it falls. In N m: M g R (θcr − θ) + (P₀ + k b θ) b = 0."""
    block = rk.Block(3.0, 0.5).restrained(2.5e4, 800.0, mass=900.0)
    b, weight = 0.25, 900.0 * GRAVITY
    radius, angle = math.hypot(1.5, b), math.atan2(0.5, 3.0)
    # to the first order in θ the arm of the restrainer is b, and b = R sin θcr is R θcr in its prestress, as in the moment of the weight
    lever = radius * angle
    stiffness = 2.5e4 * b * radius * math.sin(angle)
    balance = (weight * lever + 800.0 * lever) / (weight * radius - stiffness)
    still = rk.GroundMotion([0.0, 0.0], step=0.1)
    block = block.system(still, model="slender").block
    assert float(block.radians(1.0)) == pytest.approx(balance, rel=1e-13)
    for part, outcome in ((0.999, "at-rest"), (1.001, "overturned")):
        start = rk.State(float(block.angle(radians=part * balance)))
        motion = rk.simulate(block.system(still, model="slender"), start)
        assert motion.outcome == outcome


def test_a_restrainer_without_stiffness_and_force_changes_no_bit():
    ground = rk.example_ground_motion().scaled(pga=4.0)
    free, tied = (
        rk.simulate(b.system(ground, model="slender")) for b in (BLOCK, BLOCK.restrained(0.0, mass=1.0))
    )
    assert free.system.forcing == tied.system.forcing
    for name in free.events.dtype.names:
        np.testing.assert_array_equal(free.events[name], tied.events[name])


def test_conversions_are_those_of_the_units():
    block = rk.Block(2.0, 0.4, normalised_by="balance")
    block = restrained(block, 0.6, 0.5)
    assert float(block.radians(1.0)) == pytest.approx(3.75 * BLOCK.critical_angle, rel=1e-14)
    assert float(block.seconds(1.0)) == pytest.approx(float(BLOCK.seconds(1.0)) / math.sqrt(0.4), rel=1e-14)
    assert float(block.acceleration(1.0)) == pytest.approx(1.5 * float(BLOCK.acceleration(1.0)), rel=1e-14)
    for there, back in (
        (block.degrees, lambda x: block.angle(degrees=x)),
        (block.radians_per_second, block.velocity),
        (block.seconds, block.time),
        (block.hertz, block.frequency),
        (block.acceleration, block.amplitude),
        (block.top_displacement, lambda x: block.angle(top_displacement=x)),
    ):
        assert float(back(there(0.3))) == pytest.approx(0.3, rel=1e-13)
    system = block.system(displacement=0.1, frequency_hz=1.2)
    assert float(block.acceleration(system.forcing.amplitude)) == pytest.approx(0.1 * (2.4 * math.pi) ** 2)


def test_normalised_results_name_their_units():
    system = restrained(BLOCK, 0.6, 0.5).system(rk.example_ground_motion(), model="slender")
    motion = rk.simulate(system)
    headings = list(motion.tables(units="normalised")["time"])
    assert headings[:2] == ["time [1/alpha_u]", "angle [theta_u]"]
    assert headings[-1] == "base_acceleration [(1 + rho) g tan theta_cr]"
    assert motion.to_xarray().angle.attrs["units"] == "rad"


def test_surveys_give_the_results_of_single_motions():
    records, levels = rk.synthetic_ground_motions(3, seed=4), [3.0, 6.0, 9.0, 14.0]
    block, how = restrained(BLOCK, 0.5, 0.3), {"intensity": "pga", "model": "slender"}
    data = rk.incremental_dynamic_analysis(records, block, levels, **how)
    peaks, angles = data.dataset.peak.values, data.to_xarray().peak.values
    bands = rk.overturning_set(records, block, np.linspace(3.0, 14.0, 12), **how)
    fragility = rk.fragility(records, block, levels, replicates=100, **how).dataset
    assert fragility.attrs["stiffness_ratio"] == pytest.approx(0.5)
    assert np.isinf(peaks).any()
    for number, record in enumerate(records):
        for place, level in enumerate(levels):
            motion = rk.simulate(block.system(record.scaled(pga=level), model="slender"))
            own = motion.system.block
            fell = motion.outcome == "overturned"
            assert (peaks[number, place] == math.inf) == fell
            assert fell or peaks[number, place] == pytest.approx(motion.peak, rel=1e-12, abs=1e-15)
            assert fell or angles[number, place] == pytest.approx(float(own.radians(motion.peak)), rel=1e-12)
            assert fell == any(low <= level < high for low, high in bands.intervals(number)) or level == 14.0


PULSE = rk.Pulse("one-sine", amplitude=4.0, duration=0.5)
TIED = BLOCK.restrained(3e4, 100.0, mass=500.0)
RECORDS = rk.synthetic_ground_motions(2, seed=3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: BLOCK.restrained(2e5, mass=500.0).system(PULSE, model="slender"),
            "stiffness must be below 125011 N/m, from where on a slender",
        ),
        (lambda: BLOCK.restrained(-1.0, mass=500.0), "stiffness must lie in"),
        (lambda: BLOCK.restrained(1.0, -1.0, mass=500.0), "prestress must lie in"),
        (lambda: BLOCK.restrained(1.0, mass=0.0), "mass must lie in"),
        (lambda: rk.Block(2.0, 0.4, restrainer=3.0), "restrainer must be a Restrainer"),
        (
            lambda: rk.Block(2.0, 0.4, offset=0.1).restrained(1.0, mass=1.0),
            "offset must be omitted for a restr",
        ),
        (
            lambda: rk.Block(2.0, 0.4, wall=rk.Wall(0.5)).restrained(1.0, mass=1.0),
            "wall must be omitted for a restrained block; got one with e_w = 0.5",
        ),
        (
            lambda: rk.Block(2.0, 0.4, left_restitution=0.5).restrained(1.0, mass=1.0),
            "left_restitution must be omitted for a restr",
        ),
        (
            lambda: TIED.system(PULSE, model="slender", braces=rk.Braces(0.5)),
            "braces must be omitted for a restr",
        ),
        (lambda: TIED.system(PULSE, model="slender", wall=rk.Wall(0.5)), "wall must be omitted for a restr"),
        (lambda: rk.rocking_spectrum(RECORDS, TIED, model="slender"), "block must have no restrainer"),
        (
            lambda: rk.fragility(RECORDS, TIED, [1.0, 2.0], model="slender", samples=2, width_spread=0.1),
            "block must have no restrainer",
        ),
        (lambda: rk.assess(RECORDS, TIED, [1.0, 2.0], model="slender"), "block must have no restrainer"),
        (
            lambda: rk.simulate(TIED.system(PULSE, model="slender")).validity(TIED),
            "block must have no restrainer",
        ),
        (lambda: rk.theory.ishiyama_levels(TIED), "block must have no restrainer"),
    ],
)
def test_what_does_not_go_with_a_restrainer_is_refused(make, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        make()
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)
