"""Surveys of ground motions and pulses with the full equation, against single simulations."""

import math

import numpy as np
import pytest

import rocking as rk

RECORDS = rk.synthetic_ground_motions(4, seed=11)
OUTCOMES = tuple(rk.Outcome)


def told(found, name="outcome"):
    """Return the words of a variable with flags."""
    words = found[name].attrs["flag_meanings"].split()
    return np.array(words)[found[name].values]


@pytest.mark.parametrize("restitution", [None, 1.0])
def test_each_point_of_a_spectrum_is_a_simulation(restitution):
    slenderness = [0.1, 0.3, 0.5]
    found = rk.rocking_spectrum(
        RECORDS,
        size=[0.5, 1.0, 2.0],
        slenderness=slenderness,
        levels=[1.0, 2.0, 5.0],
        restitution=restitution,
        model="full",
    ).dataset
    assert found.attrs["model"] == "full"
    if restitution is None:
        assert set(told(found, "certified").ravel()) == {"certified"}
    moved = found.impacts.values + (told(found) == "overturned") > 0
    assert np.isfinite(found.margin.values[moved]).all()
    seen = set()
    for place in np.ndindex(found.outcome.shape):
        one = found.isel(dict(zip(found.outcome.dims, place, strict=True)))
        size, angle = float(one["size"]), float(one.slenderness)
        block = rk.Block(2 * size * math.cos(angle), 2 * size * math.sin(angle), restitution)
        motion = rk.simulate(block.system(RECORDS[int(one.record)].scaled(float(one.level)), model="full"))
        assert OUTCOMES[int(one.outcome)] == motion.outcome
        seen.add(str(motion.outcome))
        if motion.outcome == "overturned":
            assert float(one.peak) == math.inf
        elif restitution is None:
            assert float(one.peak) == pytest.approx(motion.peak, rel=1e-9)
    assert {"overturned", "bounded" if restitution else "at-rest"} <= seen


def test_block_without_losses_overturns_by_its_energy_after_a_pulse():
    """Just below and above the barrier u'^2/2 = (1 - cos θcr)/θcr² at the first impact after the pulse."""
    angle = 0.4
    system = rk.System(rk.Pulse("half-sine", amplitude=0.0, duration=0.1), 1.0, critical_angle=angle)
    barrier = 2.0 * math.sin(angle / 2) / angle
    for factor, outcome in ((1 - 1e-6, "bounded"), (1 + 1e-6, "overturned")):
        # the block comes down from an angle and bounces: the speed of the impact is the square root of the energy
        speed = factor * barrier
        start = 0.3
        fall = (math.cos(angle * (1 - start)) - math.cos(angle)) / angle**2
        down = rk.State(start, -math.sqrt(speed**2 - 2 * fall))
        assert rk.simulate(system, down).outcome == outcome


def test_switches_of_an_overturning_set_are_those_of_simulations():
    block = rk.Block(2.0, 1.0)
    found = rk.overturning_set(RECORDS[:2], block, np.linspace(2.0, 8.0, 40), model="full")
    assert found.switches.size > 3
    sure = found.switches["certified"]
    assert sure.mean() > 0.9
    assert found.undecided.size == np.count_nonzero(~sure)
    assert (found.switches["certified_below"][sure] < found.switches["level"][sure]).all()
    assert (found.switches["level"][sure] < found.switches["certified_above"][sure]).all()
    for switch in found.switches:
        sides = [
            rk.simulate(
                block.system(RECORDS[int(switch["record"])].scaled(switch["level"] * factor), model="full")
            ).outcome
            == "overturned"
            for factor in (1 - 1e-9, 1 + 1e-9)
        ]
        assert sides == [not switch["overturns_above"], bool(switch["overturns_above"])]


def test_overturning_amplitude_over_the_critical_angle_is_that_of_single_angles():
    levels, angles = np.linspace(1.5, 5.0, 15), [0.1, 0.3]
    together = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.9),
        critical_angle=angles,
        amplitude=levels,
        phases=2,
    ).dataset
    assert together.lowest.dims == ("critical_angle",)
    assert np.isnan(together.heteroclinic_amplitude).all()
    for angle, found in zip(angles, together.lowest.values, strict=True):
        alone = rk.overturning_amplitude(
            rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.9, critical_angle=angle),
            amplitude=levels,
            phases=2,
        )
        assert alone.dataset.lowest == found
        system = rk.System(
            rk.Harmonic(found, period=2.0, phase=float(alone.dataset.lowest_phase)), 0.9, critical_angle=angle
        )
        assert rk.simulate(system, cycles=1_000).outcome == "overturned"


def test_fragility_counts_the_runs_of_the_full_block():
    block, levels = rk.Block(2.0, 1.0), np.linspace(3.0, 12.0, 4)
    found = rk.fragility(RECORDS, block, levels, limits=0.3, model="full")
    fell = [
        [
            rk.simulate(block.system(motion.scaled(pga=float(level)), model="full")).outcome == "overturned"
            for level in levels
        ]
        for motion in RECORDS
    ]
    np.testing.assert_array_equal(found.dataset.fraction.values[-1], np.mean(fell, axis=0))
    analysis = rk.incremental_dynamic_analysis(RECORDS, block, levels, intensity="pga", model="full")
    np.testing.assert_array_equal(np.isinf(analysis.dataset.peak.values), fell)


def test_sensitivity_repeats_the_runs_of_the_full_block():
    block, levels = rk.Block(2.0, 1.0), np.linspace(3.0, 9.0, 5)
    found = rk.sensitivity(RECORDS, block, levels, model="full").dataset
    stronger = rk.incremental_dynamic_analysis(RECORDS, block, 1.01 * levels, model="full").dataset
    np.testing.assert_array_equal(
        found.differs.sel(change="amplitude + 1 %").values,
        found.overturned.values != np.isinf(stronger.peak.values),
    )
    assert int(found.undecided.max()) == 0


@pytest.mark.parametrize("kind", ["one-sine", "half-sine", "ricker", "triangular"])
def test_each_point_of_an_overturning_spectrum_is_a_simulation(kind):
    found = rk.overturning_spectrum(
        rk.System(rk.Pulse(kind, amplitude=1.0, duration=1.0), 0.85),
        amplitude=[1.5, 4.0, 8.0],
        frequency=[1.0, 4.0],
        critical_angle=[0.1, 0.4],
    ).dataset
    turns = 0.5 if kind == "half-sine" else 1.0
    for place in np.ndindex(found.outcome.shape):
        one = found.isel(dict(zip(found.outcome.dims, place, strict=True)))
        duration = turns * math.tau / float(one.frequency)
        pulse = rk.Pulse(kind, amplitude=float(one.amplitude), duration=duration)
        motion = rk.simulate(rk.System(pulse, 0.85, critical_angle=float(one.critical_angle)))
        assert OUTCOMES[int(one.outcome)] == motion.outcome
        if motion.outcome != "overturned":
            assert float(one.peak) == pytest.approx(motion.peak, rel=1e-9)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: rk.rocking_spectrum(RECORDS, size=1.0, slenderness=0.2, model="thick"), "model must be"),
        (
            lambda: rk.rocking_spectrum(RECORDS, size=1.0, slenderness=1.3, restitution=0.5, model="full"),
            "slenderness must lie in [0.001, 1.2]",
        ),
        (
            lambda: rk.overturning_set(RECORDS, rk.Block(2.0, 0.5), [1.0, 2.0], model=None),
            "model must be",
        ),
        (
            lambda: rk.overturning_spectrum(
                rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9, critical_angle=2.0),
                amplitude=[1, 2],
                frequency=[1, 2],
            ),
            "critical_angle must lie in",
        ),
    ],
)
def test_wrong_models_are_refused_in_one_line(call, says):
    with pytest.raises((TypeError, ValueError)) as refused:
        call()
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)
