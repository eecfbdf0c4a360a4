"""Frequency responses: against runs started on them, closed forms and verdicts."""

import math

import numpy as np
import pytest

import rocking as rk
from oracles.modes import symmetric_modes
from rocking.model.progress import Bar
from surveyed import system_with

PERIODS = np.linspace(0.2, 3.0, 29)
OFF = 1e-8


def response(amplitude, restitution, modes=(1, 3)):
    return rk.frequency_response(
        system_with(amplitude=amplitude, restitution=restitution), period=PERIODS, modes=modes, step=0.03
    )


@pytest.fixture(scope="module", params=[(2.0, 0.925), (6.0, 0.8), (1.0, 0.7)], ids=str)
def found(request):
    return response(*request.param)


def clocked(orbit):
    """The orbit's system with its clock at 0 where the orbit's state is."""
    forcing = orbit.system.forcing
    there = rk.Harmonic(amplitude=forcing.amplitude, period=forcing.period, phase=orbit.phase)
    return rk.System(there, orbit.system.restitution)


def distance_after(orbit, angle, velocity, periods):
    """Return the distance from the orbit, after ``periods``, of a run that starts next to it."""
    start = rk.State(orbit.state.angle + angle, orbit.state.velocity + velocity)
    end = rk.simulate(clocked(orbit), start, cycles=periods * orbit.period, record="none")
    if end.overturning is not None:
        return math.inf
    return math.hypot(end.final.angle - orbit.state.angle, end.final.velocity - orbit.state.velocity)


def told_by_runs(branch, is_stable):
    """Return (orbit, larger multiplier) of the stable or unstable points that a run can distinguish.

    Left out are special points, points so near to one that a run would need 20,000 periods, and a last point that
    grazes, because the motions on one side of it differ.
    """
    grazes = {
        0 if special.index == 0 else len(branch) - 1
        for special in branch.special
        if special.kind == "grazing"
    }
    for k in np.flatnonzero(branch.points["stable"] == is_stable):
        orbit = branch.orbit(int(k))
        size = abs(orbit.multipliers[0])
        if k not in grazes and abs(math.log(size)) >= 1e-3:
            yield orbit, size


def test_every_stable_point_is_reached_by_a_run_started_on_it(found):
    reached = 0
    for branch in found.branches:
        for orbit, largest in told_by_runs(branch, True):
            # What is left is a share 10⁻⁶ of the start, times what transients can make of it, and rounding: of a period some
            # 10⁻¹⁴, summed over the 10³ periods that the slowest remembers.
            periods = math.ceil(math.log(1e-6) / math.log(largest)) + 2
            assert distance_after(orbit, OFF, OFF, periods) < 1e-2 * OFF
            reached += 1
    assert reached > 5


def test_every_unstable_point_is_left_by_a_run_started_next_to_it(found):
    left = 0
    for branch in found.branches:
        for orbit, largest in told_by_runs(branch, False):
            periods = math.ceil(math.log(1e4) / math.log(largest))
            away = max(distance_after(orbit, *off, periods) for off in ((OFF, 0.0), (0.0, OFF)))
            assert away > 100 * OFF
            left += 1
    assert left > 30


def test_every_admissible_mode_lies_on_a_branch(found):
    for period in PERIODS[1:-1]:
        for n in found.modes:
            orbits = [
                orbit
                for branch in found.of(n)
                if branch.points["parameter"].min() <= period <= branch.points["parameter"].max()
                for orbit in branch.at(period)
            ]
            speeds = [
                np.abs(rk.simulate(clocked(one), one.state, cycles=n).events["after"][0]) for one in orbits
            ]
            for mode in symmetric_modes(found.system.forcing.amplitude, period, found.system.restitution, n):
                if stays_up(found.system.forcing.amplitude, period, n, mode):
                    assert np.abs(np.array(speeds) - mode.velocity).min() < 1e-9


def stays_up(amplitude, period, n, mode):
    """Return whether a mode stays on its side for half its period, by dense samples of eq. (5)."""
    frequency = 2 * math.pi / period
    beta = amplitude / (1 + frequency**2)
    t = np.linspace(0, n * period / 2, 20_001)[1:-1]
    swing = np.cos(mode.phase + frequency * t) - math.cos(mode.phase) * np.cosh(t)
    swing += frequency * math.sin(mode.phase) * np.sinh(t)
    return bool((mode.velocity * np.sinh(t) - (np.cosh(t) - 1) + beta * swing > 0).all())


def test_peaks_are_those_of_runs_on_the_orbits(found):
    for branch in found.branches:
        for k in range(0, len(branch), 7):
            orbit = branch.orbit(k)
            run = rk.simulate(clocked(orbit), orbit.state, cycles=orbit.period, record="none")
            # what the run itself makes of rounding in one period
            rounding = 1e-15 * max(abs(orbit.multipliers[0]), 1e3)
            assert branch.points["peak"][k] == pytest.approx(run.peak, rel=0, abs=rounding)


def test_unsymmetric_branches_begin_where_the_symmetry_breaks(found):
    breakings = [
        special.parameter
        for branch in found.branches
        if branch.symmetric
        for special in branch.special
        if special.kind == "symmetry-breaking"
    ]
    born = [branch.points["parameter"][0] for branch in found.branches if not branch.symmetric]
    assert born == breakings


def test_a_start_from_rest_is_what_classify_says(found):
    for value, row in zip(found.values, found.rest, strict=True):
        system = system_with(
            amplitude=found.system.forcing.amplitude, period=value, restitution=found.system.restitution
        )
        verdict = rk.classify(system, max_cycles=10_000)
        assert (row["kind"], row["period"], row["peak"]) == (verdict.kind, verdict.period or 0, verdict.peak)
        steady = math.nan if verdict.steady_peak is None else verdict.steady_peak
        np.testing.assert_equal(row["steady_peak"], steady)


def test_responses_from_rest_of_period_1_lie_on_the_stable_branch():
    found = response(6.0, 0.8, modes=(1,))
    once = found.rest[(found.rest["kind"] == "periodic") & (found.rest["period"] == 1)]
    values = found.values[(found.rest["kind"] == "periodic") & (found.rest["period"] == 1)]
    assert len(once) > 15
    for value, row in zip(values[1:], once[1:], strict=True):
        peaks = [
            rk.simulate(clocked(orbit), orbit.state, cycles=1, record="none").peak
            for branch in found.branches
            if branch.points["parameter"].min() <= value <= branch.points["parameter"].max()
            for orbit in branch.at(value)
            if orbit.stable
        ]
        assert np.abs(np.array(peaks) - row["steady_peak"]).min() < 1e-9


def test_over_the_frequency_it_is_the_same():
    system = system_with(amplitude=6.0, restitution=0.8)
    by_period = rk.frequency_response(system, period=[1.0, 1.5, 2.5], modes=(1,))
    frequency = 2 * math.pi / np.array([1.0, 1.5, 2.5])
    by_frequency = rk.frequency_response(system, frequency=frequency, modes=(1,))
    assert by_frequency.rest["kind"].tolist() == by_period.rest["kind"].tolist()[::-1]
    ours, theirs = (
        [special for branch in one.branches for special in branch.special if special.kind != "grazing"]
        for one in (by_period, by_frequency)
    )
    assert [one.kind for one in ours] == [one.kind for one in theirs]
    np.testing.assert_allclose(
        [one.parameter for one in ours], [2 * math.pi / one.parameter for one in theirs], rtol=1e-9
    )


def test_as_a_dataset_it_has_every_point_and_says_what_was_fixed():
    found = response(6.0, 0.8, modes=(1,))
    data = found.to_xarray()
    assert data.sizes["point"] == sum(map(len, found.branches)) + len(PERIODS)
    rest = data.isel(point=data.branch_number == "from rest")
    assert rest.response.values.tolist() == found.rest["kind"].tolist()
    np.testing.assert_array_equal(rest.period, PERIODS)
    periodic = found.rest["kind"] == "periodic"
    np.testing.assert_array_equal(rest.peak[periodic], found.rest["steady_peak"][periodic])
    np.testing.assert_array_equal(rest.peak[~periodic], found.rest["peak"][~periodic])
    second = data.isel(point=data.branch_number == "1")
    np.testing.assert_array_equal(second.peak, found.branches[1].points["peak"])
    assert not data.branch_symmetric[1]
    assert data.rest_count.sum() == len(PERIODS)
    assert (data.attrs["amplitude"], data.attrs["restitution"], data.attrs["modes"]) == (6.0, 0.8, [1])


def test_where_there_is_no_orbit_it_says_so():
    found = rk.frequency_response(system_with(amplitude=0.05, restitution=0.5), period=[0.5, 1.0])
    assert found.branches == ()
    assert "(1, 1) none found; (1, 3) none found; from rest 2 rest" in str(found)
    assert found.to_xarray().branch_number.values.tolist() == ["from rest"] * 2


def test_progress_counts_every_value_of_every_mode(monkeypatch):
    done = []
    monkeypatch.setattr(Bar, "advance", lambda bar, count: done.append(count))
    rk.frequency_response(system_with(restitution=0.9), period=[1.0, 1.1, 1.2], modes=(1, 3), max_cycles=10)
    assert done == [1] * 6


@pytest.mark.parametrize(
    "change, error, message",
    [
        (dict(period=None), TypeError, "give exactly one of period, frequency; got none"),
        (dict(period=1.0), ValueError, "period must hold 2 different numbers or more; got 1.0"),
        (
            dict(period=[[1.0], [2.0]]),
            ValueError,
            r"period must be an array \(n,\); got an array of shape \(2, 1\)",
        ),
        (dict(progress=3), TypeError, "progress must be a bool; got 3"),
        (dict(period=[1.0, math.nan]), ValueError, r"period must hold finite numbers; got \[1.0, nan\]"),
        (dict(period=[-1.0, 1.0]), ValueError, "period must lie in"),
        (dict(period="T"), TypeError, "period must be a real number or an array of real numbers; got 'T'"),
        (dict(system=system_with(amplitude=0.0, restitution=0.9)), ValueError, "amplitude must be above 0"),
        (dict(system=system_with(brace_angle=0.5)), ValueError, "system must have no braces"),
        (
            dict(system=system_with(critical_angle=0.3)),
            TypeError,
            "critical_angle must be None for this analysis",
        ),
        (
            dict(system=system_with(restitution=1.0)),
            ValueError,
            r"restitution must lie in \[0.001, 1\); got 1.0 \(an undamped motion",
        ),
        (
            dict(system=system_with(restitution=0.0)),
            ValueError,
            r"restitution must lie in \[0.001, 1\]; got 0.0",
        ),
        (
            dict(modes=(1, 2)),
            ValueError,
            "modes must be odd: no symmetric orbit repeats after an even number",
        ),
        (dict(modes=3), TypeError, "modes must be a sequence of odd numbers"),
        (dict(modes=()), TypeError, "modes must be a sequence of odd numbers"),
        (dict(step=1.0), ValueError, "step must lie in"),
        (dict(max_cycles=0), ValueError, "max_cycles must be a whole number in"),
    ],
)
def test_refusals_are_one_line(change, error, message):
    given = {"system": system_with(amplitude=2.0, restitution=0.9), "period": [0.5, 1.0]} | change
    with pytest.raises(error, match=f"^{message}"):
        rk.frequency_response(**given)
