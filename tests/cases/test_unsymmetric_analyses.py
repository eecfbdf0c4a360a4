"""Analyses and surveys of unsymmetric blocks: against single motions, finite differences, rigid-body mechanics and a mirror."""

import math
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve

import rocking as rk
from rocking.motion.validity import base_reaction
from rocking.survey.random_points import block_samples

GRAVITY = 9.80665
LEFT = rk.LeftSide(angle_ratio=1.3, frequency_ratio=0.97, restitution=0.91)
SLENDER, FULL = None, 0.3
BLOCK = rk.Block(height=2.0, width=0.5, offset=-0.04)
RECORDS = rk.synthetic_ground_motions(3, seed=5)
LEVELS = np.linspace(1.5, 7.0, 6)
RECORD = Path(__file__).parents[3] / "shared" / "records" / "NGA_no_1063_RRS228.AT2"


def of(critical_angle, amplitude=2.0, period=1.0):
    forcing = rk.Harmonic(amplitude, period=period)
    return rk.System(forcing, 0.88, critical_angle=critical_angle, left=LEFT)


@pytest.mark.parametrize("critical_angle", [SLENDER, FULL])
def test_map_has_the_kinds_of_single_verdicts(critical_angle):
    axes = {"amplitude": np.linspace(0.9, 6.0, 7), "period": np.linspace(0.5, 2.5, 5)}
    data = rk.parametric_map(of(critical_angle), **axes, max_cycles=2000).dataset
    names = data.kind.attrs["flag_meanings"].split()
    for place in np.ndindex(data.kind.shape):
        at = {name: float(data[name][k]) for name, k in zip(data.kind.dims, place, strict=True)}
        verdict = rk.classify(of(critical_angle, **at), max_cycles=2000)
        assert names[int(data.kind.values[place])] == verdict.kind.value
    assert len(np.unique(data.kind)) == 3


@pytest.mark.parametrize(("amplitude", "period"), [(2.0, 1.0), (4.0, 1.5)])
@pytest.mark.parametrize("critical_angle", [SLENDER, FULL])
def test_multipliers_are_those_of_finite_differences(critical_angle, amplitude, period):
    system = of(critical_angle, amplitude, period)
    orbits = [each for each in rk.find_orbits(system, 2, effort=0.2) if each.impacts]
    assert orbits
    for orbit in orbits:
        begun = evolve(system, forcing=evolve(system.forcing, phase=orbit.phase))
        step, columns = 1e-6, []
        for shift in np.eye(2) * step:
            ends = []
            for sign in (1, -1):
                start = rk.State(orbit.state.angle + sign * shift[0], orbit.state.velocity + sign * shift[1])
                final = rk.simulate(begun, start, cycles=orbit.period, record="none").final
                ends.append([final.angle, final.velocity])
            columns.append((np.array(ends[0]) - ends[1]) / (2 * step))
        jacobian = np.array(columns).T
        # the difference has the error step² times third derivatives, and rounding errors over the step
        assert np.trace(jacobian) == pytest.approx(sum(orbit.multipliers).real, abs=1e-7)
        product = (orbit.multipliers[0] * orbit.multipliers[1]).real
        assert np.linalg.det(jacobian) == pytest.approx(product, abs=1e-7)
        assert product == pytest.approx((0.88 * 0.91) ** orbit.impacts, rel=1e-9)
        assert not orbit.symmetric


@pytest.mark.parametrize("critical_angle", [SLENDER, FULL])
def test_sum_of_both_exponents_is_the_mean_loss_at_impacts(critical_angle):
    system = of(critical_angle)
    orbit = rk.classify(system).orbit
    exponents = rk.lyapunov(system, orbit.start, cycles=400)
    loss = orbit.impacts * math.log(0.88 * 0.91) / (orbit.period * system.forcing.period)
    assert sum(exponents.values) == pytest.approx(loss, abs=sum(exponents.errors))
    assert sum(exponents.values) == pytest.approx(loss, rel=0.02)


@pytest.mark.parametrize("parameter", ["amplitude", "angle_ratio", "frequency_ratio", "left_restitution"])
def test_continued_orbits_are_found_again_by_newton(parameter):
    system = of(FULL)
    orbit = next(each for each in rk.find_orbits(system, 1, effort=0.2) if each.impacts)
    here = getattr(LEFT, parameter.removeprefix("left_"), 2.0)
    branch = rk.continue_orbit(orbit, parameter, (0.99 * here, 1.01 * here), step=0.1)
    assert branch.ends == ("end of the range", "end of the range")
    last = branch.orbit(len(branch) - 1)
    again = rk.find_orbit(last.system, last.start, 1)
    assert (again.start.angle, again.start.velocity) == pytest.approx(
        (last.start.angle, last.start.velocity), abs=1e-9
    )


def peak_of(ground, model):
    motion = rk.simulate(BLOCK.system(ground, model=model))
    return math.inf if motion.overturning else motion.peak


@pytest.mark.parametrize("model", ["slender", "full"])
def test_surveys_of_records_have_the_peaks_of_single_motions(model):
    how = {"intensity": "pga", "model": model}
    single = np.array(
        [
            [
                [peak_of(each.scaled(pga=level), model) for level in LEVELS]
                for each in (ground, ground.reversed())
            ]
            for ground in RECORDS
        ]
    )
    assert 0 < np.isinf(single).sum() < single.size
    for number, polarity in enumerate(("+", "-")):
        for survey in (rk.incremental_dynamic_analysis, rk.rocking_spectrum):
            peaks = survey(RECORDS, BLOCK, LEVELS, polarity=polarity, **how).dataset.peak
            np.testing.assert_allclose(peaks, single[:, number], rtol=0, atol=1e-9)
    worse = rk.incremental_dynamic_analysis(RECORDS, BLOCK, LEVELS, polarity="worse", **how).dataset.peak
    np.testing.assert_allclose(worse, single.max(axis=1), rtol=0, atol=1e-9)
    share = rk.fragility(RECORDS, BLOCK, LEVELS, limits=(), replicates=100, polarity="both", **how)
    np.testing.assert_allclose(share.dataset.fraction[0], np.isinf(single).mean(axis=(0, 1)), atol=1e-15)


@pytest.mark.parametrize("model", ["slender", "full"])
def test_mirror_image_under_the_reversed_motion_has_the_mirrored_motion(model):
    mirrored = rk.Block(height=2.0, width=0.5, offset=0.04)
    ground = RECORDS[0].scaled(pga=4.0)
    one = rk.simulate(
        BLOCK.system(ground, model=model, normalised_by="angle" if model == "slender" else None)
    )
    other = rk.simulate(
        mirrored.system(ground.reversed(), model=model, normalised_by="angle" if model == "slender" else None)
    )
    seconds = np.linspace(0.0, 25.0, 600)
    angles = [
        block.radians(motion.at(block.time(seconds))[0])
        for block, motion in ((BLOCK, one), (mirrored, other))
    ]
    np.testing.assert_allclose(*(np.clip(angles, -1.0, 1.0) * [[1.0], [-1.0]]), rtol=0, atol=1e-9)
    assert np.abs(angles[0]).max() > 0.05


@pytest.mark.parametrize("amplitude_g", [0.35, 0.5])
def test_base_reaction_is_the_acceleration_of_the_mass_centre(amplitude_g):
    block = rk.Block(height=2.0, width=0.6, offset=0.05, centre_height=0.9)
    system = block.system(acceleration_g=amplitude_g, period_s=0.8, model="full")
    motion = rk.simulate(system, cycles=10)
    events = block.seconds(motion.events["time"])
    times = np.linspace(0.5, 7.0, 200)
    times = times[np.abs(times[:, None] - events).min(axis=1) > 0.01]
    angle = motion.at(block.time(times))[0]
    times, sides = times[angle != 0.0], np.sign(angle[angle != 0.0])

    def centre(seconds):
        """Place of the mass centre relative to the middle of the base, by a rotation about the corner."""
        turn = block.radians(motion.at(block.time(seconds))[0])
        corner = sides * block.width / 2
        x, y = block.offset - corner, block.centre_height
        return np.array([corner + x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)])

    step = 1e-4
    second = (centre(times + step) - 2 * centre(times) + centre(times - step)) / step**2
    base = GRAVITY * amplitude_g * np.cos(2 * math.pi / 0.8 * times)
    sideways, up = base_reaction(motion, block, block.time(times), sides)
    # the difference has the error step²/12 times the fourth derivative, below 1e4/s⁴, and rounding errors over step²
    np.testing.assert_allclose(sideways, (base + second[0]) / GRAVITY, rtol=0, atol=2e-5)
    np.testing.assert_allclose(up, 1 + second[1] / GRAVITY, rtol=0, atol=2e-5)
    assert {-1.0, 1.0} <= set(sides)


def test_samples_of_an_uncertain_block_are_stretched_blocks():
    drawn = block_samples(RECORDS, BLOCK, 4, (0.1, 0.2, 0.0), 0)
    assert drawn.shape == (3, 4, 6)
    for size, slenderness, restitution, *left in drawn.reshape(-1, 6):
        # R, θcr and both ratios give the sides back: tan θcr₂ = b₂/h
        height, right = 2 * size * math.cos(slenderness), size * math.sin(slenderness)
        other = 0.5 * height * math.tan(left[0] * slenderness)
        assert (other - right) / (other + right) == pytest.approx(2 * -0.04 / 0.5, rel=1e-12)
        each = rk.Block(height, right + other, offset=0.5 * (other - right))
        assert [restitution, *left] == pytest.approx(
            [each.restitution, each.left.angle_ratio, each.left.frequency_ratio, each.left_restitution],
            rel=1e-12,
        )


def test_phases_of_an_overturning_amplitude_cover_the_whole_turn():
    found = rk.overturning_amplitude(
        of(FULL), phases=8, amplitude=np.linspace(2.0, 12.0, 21), max_cycles=200
    ).dataset
    np.testing.assert_allclose(found.phase, np.arange(8) * math.pi / 4)

    def falls(amplitude, phase):
        forcing = rk.Harmonic(amplitude, period=1.0, phase=phase)
        return rk.simulate(evolve(of(FULL), forcing=forcing), cycles=200).overturning is not None

    lowest, phase = float(found.lowest), float(found.lowest_phase)
    assert falls(lowest, phase)
    assert not falls((1 - 1e-9) * lowest, phase)
    assert phase >= math.pi  # the half that a symmetric block does not need


BLOCK_OF_REFERENCE = rk.Block(height=2.0, width=0.6, offset=0.05)
# Lowest overturning scale of RRS228, full equation, H 2 m, B 0.6 m, on a grid of 0.01 from 0.3, by Runge-Kutta in physical units.
LOWEST = [
    (0.05, "+", 0.4935257019),
    (0.05, "-", 0.5160387871),
    (0.05, "worse", 0.4935257019),
    (0.02, "+", 0.6510321139),
    (0.0, "+", 0.6609032117),
    (0.0, "-", 0.6609032117),
]


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize(("offset", "polarity", "expected"), LOWEST)
def test_lowest_overturning_scale_is_that_of_the_reference(offset, polarity, expected):
    block = rk.Block(height=2.0, width=0.6, offset=offset)
    grid = 0.3 + 0.01 * np.arange(41)
    result = rk.overturning_set(rk.read_ground_motion(RECORD), block, grid, polarity=polarity, model="full")
    assert float(result.lowest[0]) == pytest.approx(expected, abs=1e-10)


@pytest.mark.skipif(not RECORD.exists(), reason="file absent")
@pytest.mark.parametrize(("scale", "expected"), [(0.45, 0.3491922), (-0.45, 0.0003586)])
def test_peak_is_that_of_the_reference(scale, expected):
    ground = rk.read_ground_motion(RECORD).scaled(scale)
    motion = rk.simulate(BLOCK_OF_REFERENCE.system(ground, model="full"))
    assert motion.peak == pytest.approx(expected, abs=1e-7)
