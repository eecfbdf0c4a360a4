"""Overturning curves: results of a plain scan of motions, refined, and no claim beyond it."""

import math

import numpy as np
import pytest

import rocking as rk
from surveyed import system_with

CYCLES = 300


def overturns(amplitude, period, restitution, phase):
    system = rk.System(
        rk.Harmonic(amplitude=float(amplitude), period=float(period), phase=float(phase)), restitution
    )
    return rk.simulate(system, cycles=CYCLES, record="none").outcome == "overturned"


def test_a_curve_is_a_plain_scan_with_its_first_hits_refined():
    # the first hits lie at a fractal edge: some of the amplitudes just below them survive, and some do not
    periods, amplitudes, phases = [1.2, 1.3], np.linspace(1.45, 5.95, 16), [0.0, math.pi / 3, 2 * math.pi / 3]
    found = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        period=periods,
        amplitude=amplitudes,
        phases=3,
        max_cycles=CYCLES,
    ).dataset
    for k, period in enumerate(periods):
        fell = np.array([[overturns(a, period, 0.925, phase) for a in amplitudes] for phase in phases])
        first = int(fell.any(axis=0).argmax())
        assert found.overturning_share.values[k] == pytest.approx(fell.mean(axis=0), abs=0)
        assert found.changes.values[k].tolist() == (fell[:, 1:] != fell[:, :-1]).sum(axis=1).tolist()
        assert found.survived_up_to.values[k] == amplitudes[first - 1]
        assert found.resolution.values[k] == pytest.approx(0.3, abs=1e-12)
        assert found.surviving_above.values[k] == pytest.approx(1 - fell[:, first:].mean(), abs=1e-12)
        lowest, phase = found.lowest.values[k], found.lowest_phase.values[k]
        assert amplitudes[first - 1] < lowest <= amplitudes[first]
        assert overturns(lowest, period, 0.925, phase)
        below = lowest * (1 - np.geomspace(1e-13, 1e-9, 20))
        assert not all(overturns(amplitude, period, 0.925, phase) for amplitude in below)


def test_of_phases_that_overturn_at_the_same_amplitude_the_lowest_counts():
    """Each of these sets of phases holds the one before."""
    system, asked = (
        system_with(period=1.2, restitution=0.925),
        {"amplitude": [1.5, 6.0], "max_cycles": CYCLES},
    )
    lowest = [
        float(rk.overturning_amplitude(system, **asked, phases=count).dataset.lowest)
        for count in (1, 2, 4, 8)
    ]
    assert lowest == sorted(lowest, reverse=True)
    assert lowest[0] > lowest[-1]


def test_overturning_is_not_monotone_in_the_amplitude():
    found = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        amplitude=np.linspace(0, 16, 1601),
        phases=1,
    ).dataset
    # 86 to 92 under changes of the phase by 10⁻¹³: a point or three at the fractal boundary flip, each twice
    assert abs(found.changes.item() - 89) <= 9
    assert 0.5 < found.surviving_above < 1.0


def test_the_other_half_of_the_phases_says_the_same():
    amplitudes = np.linspace(1.5, 6.0, 40)
    # On the fractal boundary the answer hangs on the last digit, and so on how a phase is rounded.
    changes = [0.0] + [sign * 2.0**-k for k in range(42, 53) for sign in (1.0, -1.0)]
    for phase in (0.3, 2.0):
        one, other = (
            [
                {overturns(a * (1.0 + change), 1.3, 0.9, phase + turned) for change in changes}
                for a in amplitudes
            ]
            for turned in (0.0, math.pi)
        )
        assert one == other
        assert one.count({True, False}) <= 1
        assert {True} in one
        assert {False} in one


def test_where_nothing_overturns_there_is_no_amplitude():
    found = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.5),
        period=[0.1, 0.2],
        amplitude=[0.5, 1.5, 2.0],
        phases=2,
    )
    data = found.dataset
    assert np.isnan(data.lowest.values).all()
    assert data.survived_up_to.values.tolist() == [2.0, 2.0]
    assert np.isnan(data.surviving_above.values).all()
    assert str(found).startswith("no overturning from rest at 3 amplitudes")


def test_where_the_first_amplitude_overturns_nothing_is_claimed_below_it():
    data = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=5.0), restitution=0.9), amplitude=[3.0, 4.0], phases=2
    ).dataset
    assert float(data.lowest) == 3.0
    assert math.isnan(data.survived_up_to)


def test_a_curve_over_restitution_and_period_is_that_of_each():
    how = {"amplitude": np.linspace(1.5, 6.0, 16), "phases": 2}
    both = rk.overturning_amplitude(system_with(), period=[1.2, 1.7], restitution=[0.8, 0.9], **how).dataset
    alone = rk.overturning_amplitude(system_with(period=1.7), restitution=[0.8, 0.9], **how).dataset
    assert both.lowest.dims == ("restitution", "period")
    assert both.lowest.values[:, 1].tolist() == alone.lowest.values.tolist()
    assert both.heteroclinic_amplitude.values[1, 0] == rk.theory.heteroclinic_amplitude(1.2, 0.9)
