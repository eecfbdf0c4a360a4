"""Chaos among random systems, and responses to perturbed inputs: each run has the result of `classify`."""

from collections import Counter

import numpy as np
import pytest

import rocking as rk
from rocking.model.system import quantities as system_quantities
from rocking.survey.random_points import perturbed as inputs_off
from rocking.survey.random_points import spread
from rocking.survey.spec import SYSTEM, by_period, points
from surveyed import system_with

EDGE = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), 0.95)


def disturbed(system, start, units, off):
    """Return system and initial state changed by the given fractions, equal to those of a survey up to rounding."""
    a, t, _, angle, velocity = 1.0 + off * np.asarray(units)
    forcing = rk.Harmonic(
        amplitude=system.forcing.amplitude * a, period=system.forcing.period * t, phase=system.forcing.phase
    )
    high = min(system.restitution * (1 + off), 1.0)
    low = system.restitution * (1 - off)
    restitution = low + (high - low) * 0.5 * (1 + units[2])
    return rk.System(forcing, restitution, system.braces), rk.State(
        start.angle * angle, start.velocity * velocity
    )


def test_each_run_is_what_classify_says_of_the_disturbed_system():
    start = rk.State(0.05, -0.1)
    found = rk.repeatability(EDGE, start, relative=0.02, samples=80, seed=6)
    drawn = np.random.default_rng(6).uniform(-1, 1, (80, 5))
    kinds = Counter(rk.classify(*disturbed(EDGE, start, units, 0.02), 1000).kind for units in drawn)
    assert {kind: share.count for kind, share in found.kinds.items()} == dict(kinds)
    assert len(kinds) > 1
    assert sum(share.count for share in found.responses.values()) == 80


def test_disturbed_points_are_the_systems_with_the_disturbed_quantities():
    """The kinds of responses alone would not always show a frequency that does not belong to its period."""
    start, units = rk.State(0.05, -0.1), np.random.default_rng(6).uniform(-1, 1, (40, 5))
    quantities = by_period(EDGE) | {"angle": start.angle, "velocity": start.velocity}
    meant = points({name: np.full(40, value) for name, value in quantities.items()}, {})
    systems, starts, _ = inputs_off(meant, units, 0.02)
    for row, begun, unit in zip(systems, starts, units, strict=True):
        system, state = disturbed(EDGE, start, unit, 0.02)
        found = dict(zip(SYSTEM, row.tolist(), strict=True))
        for name, value in system_quantities(system).items():
            assert found[name] == pytest.approx(value, rel=1e-14)
        assert begun.tolist() == pytest.approx([state.angle, state.velocity], rel=1e-14)


def test_what_is_undetermined_is_no_outcome_and_widens_all_others():
    """Between braces, followed for less than it takes to call anything chaotic."""
    system = rk.System(rk.Harmonic(amplitude=9.0, period=2.0), 0.925, rk.Braces(1.0))
    found = rk.repeatability(system, relative=0.2, samples=60, max_cycles=300)
    open_ = found.kinds[rk.Kind.UNDETERMINED]
    assert 0 < open_.count < 60
    assert list(found.kinds)[-1] is rk.Kind.UNDETERMINED
    assert list(found.responses)[-1] == "undetermined"
    assert not found.certain
    assert found.repeats == found.kinds[rk.Kind.PERIODIC]
    for share in list(found.responses.values())[:-1]:
        assert share.unknown == open_.count
        assert share.high == rk.Share(share.count + open_.count, 60).high
        assert share.low == rk.Share(share.count, 60).low
    nothing = rk.repeatability(system, relative=0.0, samples=5, max_cycles=2)
    assert not nothing.certain
    assert nothing.repeats == rk.Share(0, 5, 5)


def test_a_map_of_repeatability_takes_the_undetermined_for_no_outcome():
    """Followed for so short that what is off in the last digit, as it may be here, has not grown to be seen."""
    axes = {"amplitude": np.linspace(6.0, 12.0, 4), "period": np.linspace(1.5, 2.5, 4)}
    system = system_with(restitution=0.925, brace_angle=1.0)
    found = rk.repeatability_map(system, **axes, relative=0.1, samples=5, max_cycles=20)
    divided = unknown = 0
    for index in np.ndindex(4, 4):
        forcing = rk.Harmonic(amplitude=axes["amplitude"][index[0]], period=axes["period"][index[1]])
        meant = rk.System(forcing, 0.925, rk.Braces(1.0))
        counts = Counter(
            rk.classify(*disturbed(meant, rk.State(), units, 0.1), 20).kind for units in spread(5)
        )
        open_ = counts.pop(rk.Kind.UNDETERMINED, 0)
        at = {name: float(found.dataset[name].values[index]) for name in ("agreeing", "undetermined")}
        assert at["agreeing"] == pytest.approx(max(counts.values(), default=0) / 5, abs=1e-7)
        assert at["undetermined"] == pytest.approx(open_ / 5, abs=1e-7)
        divided += len(counts) > 1
        unknown += len(counts) < 2 and open_ > 0
    assert (found.uncertain.count, found.uncertain.unknown) == (divided, unknown)
    assert unknown > 0
    assert found.uncertain.high == rk.Share(divided + unknown, 16).high
    # nothing overturns between braces, whatever else it does
    assert found.overturning_uncertain == rk.Share(0, 16)


def test_inputs_that_are_not_off_have_one_outcome():
    found = rk.repeatability(EDGE, relative=0.0, samples=20)
    assert found.certain
    assert list(found.kinds) == [rk.classify(EDGE).kind]
    assert found.repeats.value == 1.0


def test_restitution_is_drawn_evenly_up_to_one_and_never_above():
    system = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), 1.0)
    units = np.random.default_rng(8).uniform(-1, 1, (4000, 5))
    tried = inputs_off(points({"angle": np.zeros(4000)}, by_period(system)), units, 0.2).systems[
        :, SYSTEM.index("restitution")
    ]
    assert 0.8 <= tried.min() < 0.801
    assert 0.999 < tried.max() <= 1.0
    assert tried.mean() == pytest.approx(0.9, abs=4 * 0.2 / (12 * 4000) ** 0.5)


def test_the_paper_s_overturning_case_cannot_be_repeated_to_a_percent():
    found = rk.repeatability(EDGE, samples=1000)
    assert set(found.kinds) == {"overturned", "periodic"}
    # more than one experiment in ten ends otherwise
    assert found.kinds["periodic"].low > 0.1


def test_a_map_of_repeatability_counts_the_runs_at_each_point():
    axes = {"amplitude": np.linspace(3.0, 7.0, 4), "period": np.linspace(0.8, 2.0, 3)}
    found = rk.repeatability_map(
        system_with(restitution=0.925), **axes, relative=0.03, samples=6, max_cycles=500
    )
    uncertain = 0
    for index in np.ndindex(4, 3):
        forcing = rk.Harmonic(amplitude=axes["amplitude"][index[0]], period=axes["period"][index[1]])
        runs = [
            rk.classify(*disturbed(rk.System(forcing, 0.925), rk.State(), units, 0.03), 500).kind
            for units in spread(6)
        ]
        counts = Counter(runs)
        assert found.dataset.agreeing.values[index] == pytest.approx(max(counts.values()) / 6, abs=1e-7)
        assert found.dataset.overturned.values[index] == pytest.approx(counts["overturned"] / 6, abs=1e-7)
        uncertain += len(counts) > 1
    assert found.uncertain.count == uncertain > 0
    assert found.overturning_uncertain.count <= uncertain


def test_samples_at_a_point_are_spread_evenly():
    points = spread(512)
    assert np.abs(points).max() <= 1.0
    # in each of 8 parts of each input there are 64 of them, give or take the discrepancy of the sequence
    counts = np.array([np.histogram(column, 8, (-1, 1))[0] for column in points.T])
    assert np.abs(counts - 64).max() <= 6
    # no more alike than three standard errors of random numbers
    assert np.abs(np.corrcoef(points.T) - np.eye(5)).max() < 3 / np.sqrt(512)


def test_shares_of_chaos_are_counts_of_what_classify_says():
    found = rk.chaos_share(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.3), samples=25, seed=2, max_cycles=10_000
    )
    assert found.dataset.attrs["seed"] == 2
    random = np.random.default_rng(2)
    periods, amplitudes = random.uniform(0.2, 3.0, 25), random.uniform(0.0, 16.0, 25)
    kinds = Counter(
        rk.classify(rk.System(rk.Harmonic(amplitude=a, period=t), 0.3), max_cycles=10_000).kind
        for a, t in zip(amplitudes, periods, strict=True)
    )
    assert found.shares[0].count == kinds["chaotic"] > 0
    told = dict(
        zip(found.dataset.response.values.tolist(), found.dataset.share.values[0].tolist(), strict=True)
    )
    assert told == pytest.approx({kind: kinds.get(kind, 0) / 25 for kind in rk.Kind}, abs=1e-12)


# of 3,000 random (T, A) each were still chaotic at 2·10⁴ cycles or more, by another program
@pytest.mark.long
@pytest.mark.parametrize("restitution, known", [(0.2, 567), (0.5, 135), (0.8, 0)])
def test_the_share_of_chaos_agrees_with_what_is_known_within_both_intervals(restitution, known):
    share = rk.chaos_share(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=restitution), samples=3000
    ).shares[0]
    other = rk.Share(known, 3000)
    assert share.low <= other.high
    assert other.low <= share.high
