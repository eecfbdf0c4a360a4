"""Laws of restitution: the scatter from impact to impact, tables in surveys, and the fit to the times of impacts."""

import json
import math
import sys
from pathlib import Path

import attrs
import numpy as np
import pytest
from scipy.special import ellipkinc
from scipy.stats import kstest, truncnorm
from scipy.stats import uniform as rectangular

import rocking as rk
from oracles.restitution import deviation
from rocking.cli.main import run
from rocking.response.fit_restitution import Rocking

HARMONIC = rk.Harmonic(amplitude=2.5, period=1.3)
RESTING = rk.Harmonic(amplitude=1.1, period=6.0)
BUSY = rk.Harmonic(amplitude=6.0, period=0.4)
STILL = rk.PiecewiseLinear([0.0, 0.0], step=0.1)
RECORDS = rk.synthetic_ground_motions(4, seed=1)
ROWS = [(0.3, 0.88), (1.0, 0.8)]
TABLE = rk.Restitution.table([(0.1, 0.95), (0.8, 0.85)])
LEVELS = np.linspace(0.8, 2.0, 5)
SIZES = {"max_cycles": 200}


def scatter(deviation=0.02, shape="normal", seed=0):
    return rk.Restitution.constant(0.5).scattered(deviation, shape, seed).scatter


def system(**more):
    return rk.System(HARMONIC, 0.9, critical_angle=0.25, **more)


def cabinet(law=None):
    return rk.Block(2.0, 0.5, law)


def coefficients(motion):
    """Return the coefficient of restitution of each impact after which the block does not rest."""
    hits = motion.events[motion.events["kind"] == "impact"]
    hits = hits[hits["after"] != 0.0]
    return np.abs(hits["after"] / hits["before"])


@pytest.mark.parametrize("shape", ["normal", "uniform"])
def test_deviations_have_the_stated_distribution(shape):
    moving = rk.System(BUSY, 0.7, critical_angle=0.25, restitution_scatter=scatter(0.05, shape, seed=2))
    motion = rk.simulate(moving, cycles=4000)
    stated = truncnorm(-3.0, 3.0) if shape == "normal" else rectangular(-1.0, 2.0)
    z = (coefficients(motion) - 0.7) / 0.05
    assert z.size > 3000
    assert kstest(z, stated.cdf).pvalue > 0.01
    assert abs(np.corrcoef(z[1:], z[:-1])[0, 1]) < 4.0 / math.sqrt(z.size)
    assert np.abs(z).max() <= (3.0 if shape == "normal" else 1.0) + 1e-9


@pytest.mark.parametrize("shape", ["normal", "uniform"])
def test_deviations_are_those_of_the_stated_function_of_the_rests_and_the_impacts(shape):
    drawn = scatter(0.03, shape, seed=5)
    motion = rk.simulate(rk.System(RESTING, 0.6, critical_angle=0.25, restitution_scatter=drawn), cycles=30)
    rests = impacts = compared = 0
    for event in motion.events:
        if event["kind"] == "rest":
            rests, impacts = rests + 1, 0
        if event["kind"] == "impact" and event["after"] != 0.0:
            z = deviation(drawn.stream(), rests, impacts, even=shape == "uniform")
            assert abs(abs(event["after"] / event["before"]) - (0.6 + 0.03 * z)) < 1e-12
            impacts, compared = impacts + 1, compared + 1
    assert rests > 2
    assert compared > 50


def test_last_digit_of_the_start_does_not_change_the_coefficients():
    moving = rk.System(STILL, 0.9, critical_angle=0.25, restitution_scatter=scatter())
    one, other = (
        coefficients(rk.simulate(moving, rk.State(angle=angle))) for angle in (0.6, np.nextafter(0.6, 1))
    )
    assert np.abs(one[:40] - other[:40]).max() < 1e-12


def test_chattering_that_is_cut_short_gives_the_same_motion():
    block = cabinet(rk.Restitution.constant(0.6).scattered(0.05, seed=3))
    moving = block.system(RECORDS[0].scaled(1.5), model="full")
    whole, brief = (rk.simulate(moving, record=record) for record in ("all", "none"))
    assert brief.impacts < whole.impacts
    assert np.sum(whole.events["kind"] == "rest") > 2
    assert (brief.peak, brief.outcome) == (whole.peak, whole.outcome)


def test_coefficients_are_cut_off_at_one_and_the_block_still_comes_to_rest():
    moving = rk.System(STILL, 0.98, critical_angle=0.25, restitution_scatter=scatter(0.05))
    motion = rk.simulate(moving, rk.State(angle=0.5))
    kept = coefficients(motion)
    assert motion.outcome is rk.Outcome.AT_REST
    assert np.abs(kept[:200] - 1.0).min() < 1e-12
    assert kept[:200].max() < 1.0 + 1e-12


def test_chattering_that_may_lose_nothing_is_not_cut_short():
    impacts = []
    for spread in (0.01, 0.04):  # e is at most 0.93 + 3 s
        moving = rk.System(STILL, 0.93, critical_angle=0.25, restitution_scatter=scatter(spread))
        impacts.append(rk.simulate(moving, rk.State(angle=0.5), record="none").impacts)
    assert impacts[0] < 100
    assert impacts[1] > 300


def test_runs_of_a_survey_are_those_of_simulate_and_differ_with_record_and_seed_but_not_with_the_level():
    peaks = []
    for seed in (1, 2):
        spread = 0.03 if seed == 1 else 0.08  # with the larger one some impacts have e = 1
        block = cabinet(TABLE.scattered(spread, seed=seed))
        found = rk.incremental_dynamic_analysis(RECORDS, block, LEVELS, model="full").dataset.peak.values
        peaks.append(found)
        for row, motion in zip(found, RECORDS, strict=True):
            alone = [rk.simulate(block.system(motion.scaled(s), model="full"), record="none") for s in LEVELS]
            expected = [math.inf if each.overturning else each.peak for each in alone]
            assert row.tolist() == pytest.approx(expected, rel=1e-9)  # scales may differ in the last digit
    standing = np.isfinite(peaks[0]) & np.isfinite(peaks[1]) & (peaks[0] > 0.05)
    assert (peaks[0] != peaks[1])[standing].all()
    streams = [
        cabinet(TABLE.scattered(0.03)).system(each, model="full").restitution_scatter.run for each in RECORDS
    ]
    scaled = [
        cabinet(TABLE.scattered(0.03)).system(each.scaled(2.0), model="full").restitution_scatter.run
        for each in RECORDS
    ]
    assert streams == scaled
    assert len(set(streams)) == len(RECORDS)


def test_samples_of_a_record_have_deviations_of_their_own():
    block = cabinet(rk.Restitution.housner().scattered(0.04, seed=1))
    levels = np.linspace(3.0, 4.5, 7)
    found = rk.fragility(RECORDS, block, levels, samples=3, replicates=100, model="full").dataset.peak
    rocked = np.isfinite(found.values).all(axis=1) & (found.values > 0.02).all(axis=1)
    assert rocked.sum() > 3
    assert all(len(set(row)) == 3 for row in np.moveaxis(found.values, 1, -1)[rocked].tolist())
    plain = rk.fragility(RECORDS, block, levels, replicates=100, model="full").dataset.peak.values
    assert np.array_equal(plain.reshape(len(RECORDS), -1), found.values[:, 0])


def test_unsymmetric_block_with_scatter_has_the_runs_of_simulate():
    block = rk.Block(2.0, 0.6, rk.Restitution.housner(0.98).scattered(0.02, seed=2), offset=0.05)
    found = rk.incremental_dynamic_analysis(RECORDS, block, LEVELS, model="full").dataset.peak.values
    for row, motion in zip(found, RECORDS, strict=True):
        alone = [rk.simulate(block.system(motion.scaled(s), model="full"), record="none") for s in LEVELS]
        expected = [math.inf if each.overturning else each.peak for each in alone]
        assert row.tolist() == pytest.approx(expected, rel=1e-9)
    plain = rk.Block(2.0, 0.6, rk.Restitution.housner(0.98), offset=0.05)
    without = rk.incremental_dynamic_analysis(RECORDS, plain, LEVELS, model="full").dataset.peak.values
    assert (found != without).any()


def test_pulses_with_scatter_and_table_are_those_of_simulate():
    for kind in ("one-sine", "ricker"):
        law = {"restitution_table": ROWS, "restitution_scatter": scatter(seed=4)}
        one = rk.System(rk.Pulse(kind, amplitude=1.0, duration=1.0), 0.9, critical_angle=0.25, **law)
        found = rk.overturning_spectrum(one, amplitude=[2.0, 3.0, 6.0], frequency=[2.0, 4.0]).dataset.peak
        for amplitude in (2.0, 3.0, 6.0):
            pulse = rk.Pulse(kind, amplitude=amplitude, duration=math.tau / 4.0)
            motion = rk.simulate(attrs.evolve(one, forcing=pulse), record="none")
            here = float(found.sel(amplitude=amplitude, frequency=4.0))
            assert here == pytest.approx(math.inf if motion.overturning else motion.peak, rel=1e-12)


def constant_in(rows):
    return [(speed, 0.9) for speed, _ in rows]


OF_SYSTEM = {
    "parametric_map": {"amplitude": np.linspace(1.0, 6.0, 6), "period": np.linspace(0.5, 2.0, 6), **SIZES},
    "basin_map": {
        "angle": np.linspace(-0.8, 0.8, 5),
        "velocity": np.linspace(-0.8, 0.8, 5),
        "boundary_runs": 0,
    },
    "safe_basin": {"amplitude": [1.0, 3.0], "samples": 40},
    "chaos_share": {"samples": 40, **SIZES},
    "overturning_amplitude": {
        "amplitude": np.linspace(1.0, 6.0, 6),
        "period": [1.0, 1.5],
        "phases": 2,
        "max_cycles": 50,
    },
    "orbit_diagram": {"amplitude": [2.0, 3.0], "cycles": 4, "transient": 50},
    "response_diagram": {"amplitude": [2.0, 3.0], **SIZES},
}


@pytest.mark.parametrize("name", OF_SYSTEM)
def test_table_of_equal_coefficients_gives_every_survey_of_a_system_the_result_of_the_number(name):
    survey, arguments = getattr(rk, name), OF_SYSTEM[name]
    plain = survey(system(), **arguments).to_xarray()
    tabled = survey(system(restitution_table=constant_in(ROWS)), **arguments).to_xarray()
    for variable in plain.variables:
        np.testing.assert_array_equal(tabled[variable].values, plain[variable].values)


def test_map_with_a_table_is_that_of_classify():
    tabled = system(restitution_table=ROWS)
    found = rk.parametric_map(tabled, **OF_SYSTEM["parametric_map"]).dataset
    assert found.attrs["restitution_table"] == [number for row in ROWS for number in row]
    plain = rk.parametric_map(system(), **OF_SYSTEM["parametric_map"]).dataset
    assert (found.peak.values != plain.peak.values).any()
    for amplitude in found.amplitude.values.tolist():
        for period in found.period.values.tolist():
            one = attrs.evolve(tabled, forcing=rk.Harmonic(amplitude, period=period))
            here = found.sel(amplitude=amplitude, period=period)
            assert rk.classify(one, **SIZES).peak == pytest.approx(float(here.peak), rel=1e-12)


OF_BLOCK = {
    "incremental_dynamic_analysis": {},
    "overturning_set": {},
    "fragility": {"replicates": 100, "intensity": "scale"},
    "rocking_spectrum": {"size": [0.8, 1.2]},
}


@pytest.mark.parametrize("name", OF_BLOCK)
def test_table_of_equal_coefficients_gives_every_survey_of_a_block_the_result_of_the_number(name):
    survey, more = getattr(rk, name), OF_BLOCK[name] | {"model": "full"}
    plain = survey(RECORDS, cabinet(0.9), LEVELS, **more).to_xarray()
    tabled = survey(
        RECORDS, cabinet(rk.Restitution.table([(0.1, 0.9), (0.5, 0.9)])), LEVELS, **more
    ).to_xarray()
    for variable in plain.variables:
        np.testing.assert_array_equal(tabled[variable].values, plain[variable].values)
    changed = survey(RECORDS, cabinet(TABLE), LEVELS, **more).to_xarray()
    assert any(
        not np.array_equal(changed[each], plain[each]) for each in ("peak", "switch_level") if each in plain
    )


def test_overturning_set_with_table_and_scatter_is_that_of_simulate_on_both_sides_of_a_switch():
    block = cabinet(TABLE.scattered(0.02, seed=2))
    found = rk.overturning_set(RECORDS, block, np.linspace(1.0, 3.0, 21), model="full")
    switch = found.switches[0]
    motion = RECORDS[int(switch["record"])]
    levels = float(switch["level"]), math.nextafter(float(switch["level"]), 0.0)
    motions = [
        rk.simulate(block.system(motion.scaled(level), model="full"), record="none") for level in levels
    ]
    fell = [each.overturning is not None for each in motions]
    assert fell == [bool(switch["overturns_above"]), not switch["overturns_above"]]


def test_factor_of_housners_value_holds_for_every_slenderness():
    found = rk.rocking_spectrum(
        RECORDS, size=[1.0, 2.0], slenderness=[0.2, 0.3], restitution=rk.Restitution.housner(0.97), levels=1.5
    ).dataset
    for angle in (0.2, 0.3):
        e = 0.97 * (1.0 - 1.5 * math.sin(angle) ** 2)
        plain = rk.rocking_spectrum(
            RECORDS, size=[1.0, 2.0], slenderness=angle, restitution=e, levels=1.5
        ).dataset
        np.testing.assert_allclose(found.peak.sel(slenderness=angle), plain.peak, rtol=1e-12)


MESSAGES = {
    "constant": (lambda: rk.Restitution.constant(1.1), "restitution must lie in"),
    "factor": (lambda: rk.Restitution.housner(2.0), "factor must lie in"),
    "above one": (
        lambda: rk.Block(2.0, 0.2, rk.Restitution.housner(1.3)),
        "restitution must give a coefficient in [0, 1]; got 1.28 by 1.3",
    ),
    "speed": (lambda: rk.Restitution.table([(-1, 0.9)]), "a speed of rows must lie in [0, 1e+300]; got -1"),
    "coefficient": (
        lambda: rk.Restitution.table([(1, 1.9)]),
        "a coefficient of rows must lie in [0, 1]; got 1.9",
    ),
    "no rows": (lambda: rk.Restitution.table([]), "rows must hold one row"),
    "descending": (lambda: rk.Restitution.table([(1, 0.9), (0.5, 0.9)]), "ascending"),
    "unsymmetric": (
        lambda: rk.Block(2.0, 0.6, TABLE, offset=0.05),
        "restitution must be one number for an unsymmetric block",
    ),
    "deviation": (lambda: rk.Restitution.constant(0.9).scattered(0.0), "deviation must be positive"),
    "shape": (lambda: rk.Restitution.constant(0.9).scattered(0.1, "gamma"), "shape must be one of"),
    "slender table": (
        lambda: cabinet(TABLE).system(RECORDS[0], model="slender"),
        "model must be 'full' for a table",
    ),
    "slender scatter": (
        lambda: rk.incremental_dynamic_analysis(
            RECORDS, cabinet(rk.Restitution.housner().scattered(0.02)), LEVELS, model="slender"
        ),
        "model must be 'full' for a scatter",
    ),
    "slender system": (
        lambda: rk.System(HARMONIC, 0.9, restitution_scatter=scatter()),
        "restitution_scatter must be omitted",
    ),
    "no scatter": (lambda: system(restitution_scatter=0.02), "restitution_scatter must be a Scatter"),
    "axis": (
        lambda: rk.parametric_map(system(restitution_table=ROWS), restitution=[0.8, 0.9], period=[1.0, 2.0]),
        "restitution must be one number for an axis of a parametric map",
    ),
    "axis of pulses": (
        lambda: rk.overturning_spectrum(
            attrs.evolve(
                system(restitution_table=ROWS), forcing=rk.Pulse("one-sine", amplitude=2.0, duration=1.0)
            ),
            amplitude=[1.0, 2.0],
            frequency=[1.0, 2.0],
            restitution=[0.8, 0.9],
        ),
        "restitution must be one number for an axis",
    ),
    "sensitivity": (
        lambda: rk.sensitivity(RECORDS, cabinet(TABLE), LEVELS, model="full"),
        "restitution must be one number for a sensitivity",
    ),
    "spread": (
        lambda: rk.fragility(RECORDS, cabinet(TABLE), LEVELS, restitution_spread=0.02, model="full"),
        "restitution must be one number for restitution_spread",
    ),
    "repeatability": (
        lambda: rk.repeatability(system(restitution_table=ROWS)),
        "restitution must be one number for repeat",
    ),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_law_that_does_not_fit_is_refused_in_one_sentence(case):
    call, part = MESSAGES[case]
    with pytest.raises(ValueError, match=r"must") as caught:
        call()
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)


RECURRENT = {
    "classify": rk.classify,
    "lyapunov": rk.lyapunov,
    "impact_section": rk.impact_section,
    "rotation_number": rk.rotation_number,
    "find_orbit": lambda each: rk.find_orbit(each, rk.State(0.1, 0.1), 1),
    "find_orbits": lambda each: rk.find_orbits(each, max_period=1),
    "parametric_map": lambda each: rk.parametric_map(each, **OF_SYSTEM["parametric_map"]),
    "repeatability": rk.repeatability,
    "repeatability_map": lambda each: rk.repeatability_map(each, amplitude=[1.0, 2.0], period=[1.0, 2.0]),
    "basin_map": lambda each: rk.basin_map(each, **OF_SYSTEM["basin_map"]),
    "safe_basin": lambda each: rk.safe_basin(each, amplitude=[1.0, 2.0]),
    "chaos_share": lambda each: rk.chaos_share(each, samples=4),
    "overturning_amplitude": lambda each: rk.overturning_amplitude(each, phases=2),
    "orbit_diagram": lambda each: rk.orbit_diagram(each, amplitude=[2.0, 3.0]),
    "response_diagram": lambda each: rk.response_diagram(each, amplitude=[2.0, 3.0]),
}


@pytest.mark.parametrize("name", RECURRENT)
def test_analysis_of_recurrent_motions_refuses_scatter(name):
    with pytest.raises(
        ValueError,
        match=r"^restitution_scatter must be None for an analysis of recurrent motions; got normal",
    ):
        RECURRENT[name](system(restitution_scatter=scatter()))


# The fit.


def half_period(alpha, speed):
    """Return the time of an arc of the full block in units of 1/p, from the pendulum about its unstable balance."""
    least = math.cos(alpha) + 0.5 * (alpha * speed) ** 2  # the cosine of the smallest angle from the balance
    k = math.sqrt(0.5 * (1.0 + least))
    return 2.0 * (ellipkinc(math.pi / 2, k * k) - ellipkinc(math.asin(math.cos(alpha / 2) / k), k * k))


@pytest.mark.parametrize("alpha", [0.05, 0.25, 0.6])
def test_half_period_is_that_of_the_pendulum_about_its_unstable_balance(alpha):
    for speed in (0.05, 0.4, 0.9):
        assert float(Rocking(alpha).half_period(speed)) == pytest.approx(half_period(alpha, speed), rel=1e-9)
    assert float(Rocking(1e-3).half_period(0.7)) == pytest.approx(2.0 * math.atanh(0.7), rel=1e-6)


def released(e, alpha=None, angle=0.6, count=12, rate=2.5):
    """Return the times of the impacts of a block that is released at an angle, by the simulation."""
    moving = rk.System(STILL, e, critical_angle=alpha)
    events = rk.simulate(moving, rk.State(angle=angle)).events
    return events["time"][events["kind"] == "impact"][:count] / rate


KNOWN = {
    "nothing": {},
    "rate": {"frequency_parameter": 2.5},
    "release": {"release": 0.0},
    "release and rate": {"release": 0.0, "frequency_parameter": 2.5},
    "release, angle and rate": {"release": 0.0, "angle": 0.6, "frequency_parameter": 2.5},
    "angle": {"angle": 0.6},
}


@pytest.mark.parametrize("alpha", [None, 0.25])
@pytest.mark.parametrize("known", KNOWN)
def test_exact_times_give_the_exact_coefficient(known, alpha):
    for e in (0.7, 0.9, 0.98):
        fit = rk.fit_restitution(released(e, alpha), critical_angle=alpha, **KNOWN[known])
        assert abs(fit.restitution - e) < 1e-10
        assert abs(fit.angle - 0.6) < 1e-8
        assert abs(fit.frequency_parameter - 2.5) < 1e-8
        kept = fit.dataset.impact_restitution.values
        assert np.nanmax(np.abs(kept - e)) < 1e-8
        assert np.isfinite(kept).sum() >= 10


def test_slender_fit_of_a_stout_block_is_biased_and_that_of_the_full_equation_is_not():
    times = released(0.9, 0.25)
    slender = rk.fit_restitution(times, frequency_parameter=2.5)
    assert 3e-4 < slender.restitution - 0.9 < 8e-4
    block = rk.Block(2.0, 2.0 * math.tan(0.25))
    scaled = times * 2.5 / block.frequency_parameter
    assert abs(rk.fit_restitution(scaled, block).restitution - 0.9) < 1e-10


@pytest.mark.parametrize(
    "alpha, known",
    [
        (None, {"frequency_parameter": 2.5}),
        pytest.param(0.25, {"frequency_parameter": 2.5}, marks=pytest.mark.long),
        pytest.param(0.25, {"frequency_parameter": 2.5, "angle": 0.6}, marks=pytest.mark.long),
        pytest.param(0.25, {}, marks=pytest.mark.long),
    ],
)
def test_intervals_of_the_fit_cover_in_95_percent_of_1000_tests(alpha, known):
    exact, random = released(0.9, alpha, count=10), np.random.default_rng(7)
    true = {"restitution": 0.9, "angle": 0.6, "frequency_parameter": 2.5}
    inside = dict.fromkeys(true.keys() - known.keys(), 0)
    for _ in range(1000):
        fit = rk.fit_restitution(exact + random.normal(0.0, 2e-3, exact.size), critical_angle=alpha, **known)
        for name in inside:
            inside[name] += getattr(fit, f"{name}_low") <= true[name] <= getattr(fit, f"{name}_high")
    assert all(930 <= count <= 970 for count in inside.values())


def test_coefficients_of_the_impacts_give_the_table_over_the_speed():
    block = cabinet(TABLE)
    still = rk.GroundMotion([0.0, 0.0], step=0.01)
    events = rk.simulate(block.system(still, model="full"), rk.State(angle=0.7)).events
    times = block.seconds(events["time"][events["kind"] == "impact"])[:30]
    fit = rk.fit_restitution(times, block, release=0.0)
    data = fit.dataset.dropna("impact")
    speeds = block.radians_per_second(data.impact_speed.values)
    stated = np.interp(speeds, *np.array(TABLE.rows).T)
    assert np.abs(data.impact_restitution.values - stated).max() < 1e-9
    law = fit.law(rows=4)
    assert all(abs(e - np.interp(speed, *np.array(TABLE.rows).T)) < 5e-3 for speed, e in law.rows)


BAD_TIMES = {
    "unordered": (
        [0.0, 1.0, 0.5, 2.0, 2.5],
        {},
        "times must be ascending times in s of the impacts of a free rocking test; got 1 before 0.5",
    ),
    "too few": (
        [0.0, 1.0, 1.8],
        {},
        "times must be of 6 impacts or more, as 4 values are fitted; got 3 impacts",
    ),
    "too few with a release": (
        [1.0, 1.8],
        {"release": 0.0, "frequency_parameter": 2.0},
        "times must be of 4 impacts or more",
    ),
    "growing": (
        np.cumsum([0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1]),
        {},
        "times must be those of a motion that decays; got",
    ),
    "not finite": ([0.0, 1.0, math.nan, 2.0], {}, "times must be ascending times"),
    "late release": (
        [1.0, 1.8, 2.5, 3.0, 3.5, 4.0],
        {"release": 1.5},
        "release must come before the first of times; got 1.5",
    ),
    "large angle": (
        [1.0, 1.8, 2.5, 3.0, 3.5, 4.0],
        {"angle": 1.0},
        "angle must lie between 0 and 1, exclusive; got 1",
    ),
    "model": (
        [1.0, 1.8, 2.5, 3.0, 3.5, 4.0],
        {"model": "full"},
        "model must be 'slender' without a critical angle; got 'full' (give block)",
    ),
    "twice": (
        [1.0, 1.8, 2.5, 3.0, 3.5, 4.0],
        {"block": rk.Block(2.0, 0.5), "frequency_parameter": 2.0},
        "frequency_parameter must be omitted with block",
    ),
    "unequal sides": (
        [1.0, 1.8, 2.5, 3.0, 3.5, 4.0],
        {"block": rk.Block(2.0, 0.5, offset=0.05)},
        "block must be symmetric; got one with offset 0.05 m",
    ),
}


@pytest.mark.parametrize("case", BAD_TIMES)
def test_times_that_cannot_be_fitted_are_refused_in_one_sentence(case):
    times, known, message = BAD_TIMES[case]
    with pytest.raises(ValueError, match=r"must") as caught:
        rk.fit_restitution(times, **known)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


# The command line.


@pytest.fixture
def typed(monkeypatch, tmp_path, capsys):
    """Type a command line in a folder with a file of times and a study file; return message and stdout."""
    monkeypatch.chdir(tmp_path)
    Path("times.txt").write_text("# s\n0.0 0.90, 1.68\n2.36; 2.97\n3.52\n4.02\n", encoding="utf-8")
    Path("words.txt").write_text("0.0\n1.2 s\n", encoding="utf-8")
    Path("law.txt").write_text("# speed, e\n0.1, 0.95\n0.8, 0.88\n", encoding="utf-8")
    study = 'restitution-table = [[0.1, 0.95], [0.8, 0.88]]\nrestitution-scatter = "0.01:uniform:2"\nmodel = "full"\n'
    Path("study.toml").write_text(study, encoding="utf-8")

    def type_line(line):
        monkeypatch.setattr(sys, "argv", ["rocking", *line.split()])
        message = run()[1]
        return message, capsys.readouterr().out

    return type_line


RECORD = "record example --height 2 --width 0.5 --pga-g 1 --json"


def test_laws_of_options_files_and_study_files_are_those_of_python(typed):
    law = rk.Restitution.table([(0.1, 0.95), (0.8, 0.88)]).scattered(0.01, "uniform", 2)
    ground = rk.example_ground_motion().scaled(pga=9.80665)
    peak = rk.simulate(cabinet(law).system(ground, model="full")).peak
    scattered = "--model full --restitution-scatter 0.01:uniform:2"
    for options in (
        "--study study.toml",
        f"--restitution-table law.txt {scattered}",
        f"--restitution-table 0.1:0.95,0.8:0.88 {scattered}",
    ):
        found = json.loads(typed(f"{RECORD} {options}")[1])
        assert found["peak_rad"] == pytest.approx(float(cabinet().radians(peak)), rel=1e-12)
        assert found["restitution_table_rad_per_s"] == [0.1, 0.95, 0.8, 0.88]
        assert (found["restitution_deviation"], found["restitution_shape"], found["restitution_seed"]) == (
            0.01,
            "uniform",
            2,
        )


def test_command_fits_the_times_of_a_file(typed):
    found = json.loads(typed("fit-restitution times.txt --frequency-parameter 2.7 --json")[1])
    fit = rk.fit_restitution([0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02], frequency_parameter=2.7)
    assert found["restitution"] == fit.restitution
    assert found["restitution_low"] == fit.restitution_low
    assert (
        "95 % interval"
        in typed("fit-restitution times.txt --height 2 --width 0.5 --plot fit.png --csv fit.csv")[1]
    )
    assert len(Path("fit.csv").read_text(encoding="utf-8").splitlines()) == 8


LINES = {
    "fit-restitution words.txt": "FILE must hold times in s, and lines with #; got 's'",
    "fit-restitution times.txt --height 2": "missing --width: give --height and --width",
    "fit-restitution times.txt --release 1": "--release must come before the first of FILE; got 1",
    "simulate --amplitude 2 --period 1 --restitution 0.9 --restitution-factor 1.1": "--restitution-factor needs a block in SI",
    f"{RECORD} --restitution-table words.txt": "--restitution-table must be pairs SPEED:E, separated by commas, or a file",
    f"{RECORD} --restitution-factor 1.3": "--restitution-factor must give a coefficient in [0, 1]; got 1.19 by 1.3",
    f"{RECORD} --restitution-table 0.1:1.9": "a coefficient of --restitution-table must lie in [0, 1]; got 1.9",
    f"{RECORD} --restitution-table=-1:0.9": "a speed of --restitution-table must lie in [0, ",
    f"{RECORD} --restitution-scatter 2": "the deviation of --restitution-scatter must lie in [0, 0.5]; got 2",
    f"{RECORD} --offset 0.05 --restitution-table 0.1:0.9": "--restitution-table must be one number for an unsymmetric block",
    f"{RECORD} --offset 0.05 --brace-angle 1": "--brace-angle must be omitted for a block with unequal sides; got braces at 1",
    "sensitivity example --height 2 --width 0.5 --pga-g 1:2:2 --restitution-table 0.1:0.9": "--restitution-table must be one number",
    "map --height 2 --width 0.5 --acceleration 3:4:2 --period-s 0.5:1:2 --restitution-table 0.1:0.9": "--model must be 'full' for a table",
    "map --amplitude 1:2:2 --period 1:2:2 --restitution 0.9 --restitution-factor 0.9": "--restitution-factor needs a block in SI",
    "spectrum example --size 1:2:3 --slenderness-deg 12 --restitution 0.8:0.9:3 --restitution-scatter 0.1 --model full": (
        "--restitution must be a number with --restitution-scatter; got an axis"
    ),
}


@pytest.mark.parametrize("line", LINES)
def test_options_that_do_not_fit_are_refused_in_one_line(line, typed):
    assert LINES[line] in typed(line)[0]
