"""Units of the base acceleration of slender blocks: g θcr and g tan θcr, in systems, results, surveys, figures and messages."""

import math
import warnings

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.cli.reports_motion import motion_validity
from rocking.cli.requests import Request
from rocking.model.block_formulas import GRAVITY
from rocking.model.record_set import RecordSet
from rocking.motion.validity import by_other_equation
from rocking.survey.ending_measures import BlockEndings, ending
from rocking.survey.incremental_dynamic_analysis import block_spec
from rocking.survey.store_layout import fingerprint

BLOCK = rk.Block(height=2.0, width=0.6)
UNITS = {"angle": GRAVITY * math.atan(0.3), "tangent": GRAVITY * 0.3}
"""Acceleration in m/s² that is 1 if it is normalised, from height and width."""
RECORD = rk.example_ground_motion().scaled(pga=5.5)
PULSE = rk.Pulse("one-sine", amplitude=6.0, duration=0.7)
LINES = rk.Pulse("triangular", amplitude=-6.0, duration=0.7)
BASES = {"record": RECORD, "sine": PULSE, "lines": LINES}
EITHER = pytest.mark.parametrize("by", UNITS)


def system(base, by, **how):
    return BLOCK.system(base, model="slender", normalised_by=by, **how)


@EITHER
@pytest.mark.parametrize("name", BASES)
def test_base_acceleration_comes_back_in_si_and_in_the_unit_of_the_system(name, by):
    base, motion = BASES[name], rk.simulate(system(BASES[name], by))
    assert motion.system.normalised_by == by
    for given in ({}, {"block": BLOCK}, {"block": attrs.evolve(BLOCK, normalised_by="tangent")}):
        data = motion.to_xarray(**given)
        if name == "record":
            expected = np.interp(data.time, base.times, base.acceleration, right=0.0)
        else:
            expected = base.acceleration(data.time.values)
        np.testing.assert_allclose(data.base_acceleration, expected, rtol=1e-9, atol=1e-7)
        assert data.attrs.get("normalised_by", "angle") == by
    plain = motion.to_xarray(units="normalised")
    np.testing.assert_allclose(
        plain.base_acceleration * UNITS[by], data.base_acceleration, rtol=1e-9, atol=1e-7
    )
    assert ("g tan theta_cr" in plain.attrs["comment"]) == (by == "tangent")
    assert "theta_cr" not in data.attrs["comment"]
    if name != "record":
        peaks = motion.to_dict(), motion.to_dict(units="normalised")
        assert peaks[0]["acceleration_m_per_s2"] == pytest.approx(base.amplitude, rel=1e-12)
        assert peaks[1]["amplitude"] == pytest.approx(base.amplitude / UNITS[by], rel=1e-12)


@EITHER
def test_block_lifts_off_beyond_the_unit_of_its_acceleration(by):
    moves = [
        rk.simulate(system(rk.Pulse("rectangular", amplitude=share * UNITS[by], duration=0.1), by)).peak > 0
        for share in (1 - 1e-9, 1 + 1e-9)
    ]
    assert moves == [False, True]


def test_slender_block_is_normalised_by_the_tangent_by_default():
    bare = BLOCK.system(RECORD, model="slender")
    assert bare.forcing == system(RECORD, "tangent").forcing != system(RECORD, "angle").forcing
    assert BLOCK.system(RECORD, model="full").normalised_by == "angle"


@pytest.mark.parametrize("name", BASES)
def test_motion_by_the_other_equation_is_that_of_its_own_system(name):
    full = rk.simulate(BLOCK.system(BASES[name], model="full"))
    for by in UNITS:
        outcome, peak = by_other_equation(rk.simulate(system(BASES[name], by)), BLOCK)
        assert outcome == full.outcome
        assert peak == pytest.approx(math.inf if outcome == "overturned" else full.peak, rel=1e-6)
    slender = rk.simulate(system(BASES[name], "tangent"))
    outcome, peak = by_other_equation(full, BLOCK)
    assert outcome == slender.outcome
    assert peak == pytest.approx(math.inf if outcome == "overturned" else slender.peak, rel=1e-6)


def test_system_of_a_block_that_becomes_full_or_harmonic_is_normalised_by_the_angle():
    made = system(RECORD, "tangent")
    assert attrs.evolve(made, critical_angle=BLOCK.critical_angle).normalised_by == "angle"
    assert attrs.evolve(made, forcing=rk.Harmonic(2.0, period=1.0)).normalised_by == "angle"
    assert attrs.evolve(made, restitution=0.5).normalised_by == "tangent"
    again = made.block.system(acceleration=3.0, frequency_hz=1.0)
    assert again.forcing.amplitude == pytest.approx(3.0 / UNITS["angle"], rel=1e-14)
    assert made.block == BLOCK
    assert rk.System(rk.Harmonic(2.0, period=1.0), 0.9).normalised_by == "angle"


@EITHER
def test_surveys_follow_the_runs_of_simulate(by):
    how = {"model": "slender", "normalised_by": by}
    levels = np.array([4.0, 5.5])
    alone = rk.simulate(system(RECORD, by))
    analysis = rk.incremental_dynamic_analysis(RECORD, BLOCK, levels, intensity="pga", **how)
    assert analysis.dataset.peak.values[0, 1] == pytest.approx(alone.peak, rel=1e-6)
    spectrum = rk.rocking_spectrum(RECORD, BLOCK, slenderness=[0.2, BLOCK.critical_angle], **how)
    assert spectrum.dataset.peak.values[1] == pytest.approx(alone.peak, rel=1e-6)
    for result in (analysis, spectrum):
        assert result.dataset.attrs.get("normalised_by", "angle") == by
    stop = np.zeros(1, np.int64)
    for base in (RECORD, PULSE):
        ends = BlockEndings(base, 1.0, "slender", by).at(
            np.full(1, BLOCK.radius), np.full(1, BLOCK.critical_angle), stop
        )
        peak = rk.simulate(system(base, by)).peak
        assert ends["peak"][0] == pytest.approx(math.inf if ends["outcome"][0] == 2 else peak, rel=1e-6)
    # one level of a sample of one block: the nominal block but for its restitution
    curve = rk.fragility(RECORD, BLOCK, [5.5], limits=[0.999 * alone.peak, 1.001 * alone.peak], **how)
    assert curve.dataset.fraction.values[:2, 0].tolist() == [1.0, 0.0]


@EITHER
def test_overturning_set_and_uncertain_blocks_scale_with_the_unit(by):
    """The threshold of a rectangular pulse, A = 1/(1 − exp(−T)), times the unit of each block."""
    duration = BLOCK.seconds(1.0)
    push = rk.GroundMotion([1.0, 1.0], step=duration)
    how = {"model": "slender", "normalised_by": by}
    found = rk.overturning_set(push, BLOCK, np.linspace(2.0, 9.0, 15), intensity="pga", **how)
    assert found.lowest[0] == pytest.approx(UNITS[by] / -math.expm1(-1.0), rel=1e-9)
    assert found.dataset.attrs.get("normalised_by", "angle") == by
    levels = UNITS[by] / -math.expm1(-1.0) * np.array([0.98, 1.02])
    given = {"samples": 4, "restitution_spread": 0.1, "limits": (), **how}
    curve = rk.fragility(push, BLOCK, levels, intensity="pga", **given)
    assert curve.dataset.fraction.values[0].tolist() == [0.0, 1.0]


@EITHER
def test_overturning_spectrum_is_in_si_by_the_unit_of_its_system(by):
    found = rk.overturning_spectrum(system(PULSE, by), amplitude=[1.0, 2.0], frequency=[2.0, 3.0])
    for given in ({}, {"block": BLOCK}):
        assert found.to_xarray(**given).amplitude.values == pytest.approx(UNITS[by] * np.array([1.0, 2.0]))
    heading = next(iter(found.tables(units="normalised")["amplitude_frequency"]))
    unit = {"angle": "g theta_cr", "tangent": "g tan theta_cr"}[by]
    assert heading == f"amplitude [{unit}]"
    assert found.to_xarray(units="normalised").amplitude.attrs["long_name"].endswith(unit)


@EITHER
def test_figure_shows_the_base_acceleration_in_si(by):
    motion = rk.simulate(system(RECORD, by))
    for given in ({}, {"block": BLOCK}):
        below = rk.plot.time_history(motion, **given).figure.axes[1]
        (line,) = (each for each in below.lines if each.get_gid() == "base")
        drawn = np.abs(line.get_ydata()).max()
        assert drawn == pytest.approx(RECORD.pga, rel=1e-9)


@EITHER
def test_reaction_of_a_block_at_rest_is_the_base_acceleration_in_g(by):
    pulse = rk.Pulse("rectangular", amplitude=0.9 * UNITS[by], duration=0.1)
    validity = rk.simulate(system(pulse, by)).validity(BLOCK)
    assert validity.friction == pytest.approx(0.9 * UNITS[by] / GRAVITY, rel=1e-9)


def test_errors_of_moments_are_those_of_the_equation_of_motion():
    """The slender moment u A of the base acceleration against that of the full block, A cos δ, at every angle up to the largest."""
    angles = BLOCK.critical_angle * np.linspace(0.0, 1.0, 2001)
    for by, unit in UNITS.items():
        validity = rk.simulate(system(RECORD, by)).validity(BLOCK)
        below = angles[angles <= validity.angle]
        errors = GRAVITY * BLOCK.critical_angle / unit / np.cos(BLOCK.critical_angle - below) - 1
        assert validity.forcing_error == pytest.approx(np.abs(errors).max(), rel=1e-2)


@EITHER
def test_store_of_blocks_normalised_by_the_angle_has_the_identity_from_before_there_was_a_choice(by):
    spec = block_spec(RecordSet(RECORD), BLOCK, [1.0, 2.0], "scale", model="slender", normalised_by=by)
    fixed = fingerprint(spec, ending("title"))["fixed"]
    assert ("normalised_by" in fixed) == (by == "tangent")


NONSENSE = {
    "word": (
        lambda: BLOCK.system(RECORD, normalised_by="sine"),
        "normalised_by must be one of 'angle', 'tangent'; got 'sine'",
    ),
    "type": (
        lambda: BLOCK.system(RECORD, normalised_by=1),
        "normalised_by must be one of 'angle', 'tangent'; got 1",
    ),
    "harmonic": (
        lambda: BLOCK.system(acceleration=3.0, frequency_hz=1.0, normalised_by="tangent"),
        "normalised_by must be 'angle' or omitted for a harmonic base motion; got 'tangent'",
    ),
    "full": (
        lambda: BLOCK.system(RECORD, model="full", normalised_by="tangent"),
        "normalised_by must be 'angle' or omitted with the full equation of motion; got 'tangent'",
    ),
    "survey": (
        lambda: rk.fragility(RECORD, BLOCK, [1.0, 2.0], model="full", normalised_by="tangent"),
        "normalised_by must be 'angle' or omitted with the full equation of motion; got 'tangent'",
    ),
    "block": (
        lambda: rk.Block(2.0, 0.5, normalised_by="cosine"),
        "normalised_by must be one of 'angle', 'tangent', 'balance'; got 'cosine'",
    ),
    "model": (
        lambda: BLOCK.system(RECORD, model="thick"),
        "model must be one of 'slender', 'full'; got 'thick'",
    ),
}


@pytest.mark.parametrize("name", NONSENSE)
def test_nonsense_is_refused_in_one_sentence(name):
    call, sentence = NONSENSE[name]
    with pytest.raises(ValueError) as caught:  # noqa: PT011 (the whole text follows)
        call()
    assert str(caught.value).split(" (")[0] == sentence


def test_unusual_block_warns_once():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        block = rk.Block(height=0.005, width=0.001)
        block.system(PULSE, model="slender")
    assert len(caught) == 1


ELSEWHERE = rk.example_ground_motion().scaled(pga=1.22 * GRAVITY)
THINNER = rk.Block(height=2.0, width=0.5)
OTHER = "; full equation: "


def test_report_states_the_other_verdict_only_where_it_differs():
    """The full block stands at 1.22 g, with 0.895 θcr, and the slender one by the angle overturns."""
    full = rk.simulate(THINNER.system(ELSEWHERE))
    by_angle = rk.simulate(THINNER.system(ELSEWHERE, model="slender", normalised_by="angle"))
    assert (full.outcome, by_angle.outcome) == ("at-rest", "overturned")
    peak = f"{THINNER.degrees(full.peak):.4g}°, {full.peak:.4g} θcr"
    assert str(by_angle).endswith(f"{OTHER}stands, largest |θ| {peak}")
    by_tangent = rk.simulate(THINNER.system(ELSEWHERE, model="slender"))
    assert abs(by_tangent.peak - full.peak) < 0.05
    assert "full equation" not in str(by_tangent)
    assert "slender block" not in str(full)
    for motion, other in (
        (full, None),
        (by_angle, {"model": "full", "outcome": "at-rest", "peak_rad": full.peak * THINNER.critical_angle}),
    ):
        request = Request({}, {}, motion.system.block)
        assert motion_validity(motion, request)["other_equation"] == other


@pytest.mark.parametrize("share", [0.04, 0.06])
def test_report_states_the_other_peak_only_where_it_differs_by_more_than_a_twentieth(share, monkeypatch):
    motion = rk.simulate(THINNER.system(ELSEWHERE))
    monkeypatch.setattr(
        "rocking.motion.validity.by_other_equation", lambda *_: (motion.outcome, motion.peak - share)
    )
    assert ("; slender block: also stands, largest |θ| " in str(motion)) == (share > 0.05)


def test_motion_that_was_cut_short_is_compared_over_the_same_time():
    cut = rk.simulate(
        THINNER.system(ELSEWHERE, model="slender", normalised_by="angle"), duration=THINNER.time(9.0)
    )
    assert cut.outcome == "bounded"
    outcome, peak = by_other_equation(cut, THINNER)
    full = rk.simulate(THINNER.system(ELSEWHERE), duration=THINNER.time(9.0))
    assert (outcome, peak) == (full.outcome, pytest.approx(full.peak, rel=1e-9))


def test_system_without_a_comparison_says_nothing():
    thin = rk.Block(height=2.0, width=0.001)  # θcr below what the full equation takes
    assert OTHER not in str(rk.simulate(thin.system(PULSE, model="slender")))
    assert OTHER not in str(rk.simulate(THINNER.system(acceleration=4.0, frequency_hz=1.2), cycles=5))
