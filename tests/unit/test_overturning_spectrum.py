"""Overturning spectra of pulses: single runs, closed forms, and the order of modes that others printed."""

import math
from concurrent.futures import ProcessPoolExecutor

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from rocking.model.forcing import KINDS

OVERTURNED, STANDS = 2, 1
RNG = np.random.default_rng(20)


def pulsed(kind, restitution):
    return rk.System(rk.Pulse(kind, amplitude=1.0, duration=1.0), restitution)


def duration_of(kind, frequency):
    return (math.pi if kind == "half-sine" else math.tau) / frequency


def at(found, **place):
    """Return outcome and mode at a point."""
    one = found.sel(place, method="nearest")
    return int(one.outcome), int(one.impacts_since_rest)


@pytest.mark.parametrize("kind", KINDS)
def test_random_points_are_those_of_single_runs(kind):
    amplitude, frequency = np.sort(RNG.uniform(0.8, 9.0, 12)), np.sort(RNG.uniform(0.3, 8.0, 12))
    found = rk.overturning_spectrum(
        pulsed(kind, 1.0), amplitude=amplitude, frequency=frequency, restitution=[0.85, 0.92]
    ).dataset
    assert found.outcome.dims == ("amplitude", "frequency", "restitution")
    differ, undecided, overturned = [], 0, 0
    for a, w, e in np.ndindex(found.outcome.shape):
        pulse = rk.Pulse(kind, amplitude=amplitude[a], duration=duration_of(kind, frequency[w]))
        run = rk.simulate(rk.System(pulse, found.restitution.values[e]))
        one = found.isel(amplitude=a, frequency=w, restitution=e)
        if not (one.certified and run.certified):
            undecided += 1
            continue
        falls = run.outcome == "overturned"
        overturned += falls
        same = (int(one.outcome) == OVERTURNED) == falls
        same &= float(one.peak) == (math.inf if falls else pytest.approx(run.peak, abs=1e-9))
        if falls:
            same &= int(one.impacts_since_rest) <= run.impacts
        if not same:
            differ.append((amplitude[a], frequency[w], e))
    assert differ == []
    assert undecided == 0
    assert 20 < overturned < 280


def test_order_of_the_modes_is_the_printed_one():
    """Zhang & Makris (2001), Figs 7 and 8, W = 5, e = 0.9: stands, one impact, stands, no impact.

    They integrated numerically, so that 3.01, which they found to overturn, lies below the exact threshold 3.0186.
    """
    printed = [3.00, 3.02, 6.31, 6.33, 7.16, 7.18]
    found = rk.overturning_spectrum(pulsed("one-sine", 0.9), amplitude=printed, frequency=[4.0, 5.0]).dataset
    told = [at(found, amplitude=each, frequency=5.0) for each in printed]
    assert [outcome for outcome, _ in told] == [STANDS, OVERTURNED, OVERTURNED, STANDS, STANDS, OVERTURNED]
    assert [mode for outcome, mode in told if outcome == OVERTURNED] == [1, 1, 0]
    assert found.certified.values.all()


def test_overturning_after_one_impact_ends_at_the_printed_frequency():
    """Zhang & Makris (2001) print 6.59."""
    found = rk.overturning_spectrum(
        pulsed("one-sine", 0.9), amplitude=np.linspace(5, 10, 2001), frequency=[6.58, 6.60]
    ).dataset
    after_one = (found.outcome == OVERTURNED) & (found.impacts_since_rest == 1)
    assert after_one.any("amplitude").values.tolist() == [True, False]


@pytest.mark.parametrize("frequency", [1.0, 2.5, 5.0, 7.0])
def test_one_sine_overturns_without_impact_above_its_condition(frequency):
    """Zhang & Makris (2001), eq. (47)."""
    with mp.workdps(30):
        psi = mp.findroot(
            lambda x: frequency * mp.sin(x) - mp.cos(x) + mp.exp(-(2 * mp.pi - x) / frequency),
            (1e-4, mp.atan(1 / mp.mpf(frequency))),
            solver="anderson",
        )
        edge = float(1 / mp.sin(psi))
    found = rk.overturning_spectrum(
        pulsed("one-sine", 0.9), amplitude=[edge - 1e-9, edge + 1e-9], frequency=[frequency, 2 * frequency]
    ).dataset
    one = found.isel(frequency=0)
    without_impact = (one.outcome == OVERTURNED) & (one.impacts_since_rest == 0)
    assert without_impact.values.tolist() == [False, True]


def test_rectangular_pulse_overturns_where_its_closed_form_says():
    """A > 1/(1 − exp(−T)); only a block without an impact overturns, because the base then stays at rest."""
    amplitude, frequency = np.linspace(0.9, 6.0, 80), np.linspace(0.5, 12.0, 70)
    found = rk.overturning_spectrum(
        pulsed("rectangular", 0.9), amplitude=amplitude, frequency=frequency
    ).dataset
    edge = -1 / np.expm1(-math.tau / frequency)
    wanted = amplitude[:, None] > edge[None, :]
    assert ((found.outcome == OVERTURNED).values == wanted).all()
    assert found.impacts_since_rest.values[wanted].tolist() == [0] * int(wanted.sum())
    still = np.isnan(found.margin.values)
    assert (still == (amplitude <= 1.0)[:, None]).all()


def test_store_and_executor_give_the_same_dataset(tmp_path):
    plane = {"amplitude": np.linspace(1, 8, 30), "frequency": np.linspace(1, 7, 30)}
    triangular, rectangular = (pulsed(kind, 0.9) for kind in ("triangular", "rectangular"))
    plain = rk.overturning_spectrum(triangular, **plane).dataset
    assert plain.attrs["pulse"] == "triangular"
    assert plain.attrs["restitution"] == 0.9
    with ProcessPoolExecutor(2) as pool:
        assert rk.overturning_spectrum(triangular, **plane, executor=pool).dataset.identical(plain)
    kept = rk.overturning_spectrum(triangular, **plane, store=tmp_path / "store").dataset
    assert all((kept[name].values == plain[name].values).all() for name in ("outcome", "peak", "impacts"))
    with pytest.raises(ValueError, match="pulse|store"):
        rk.overturning_spectrum(rectangular, **plane, store=tmp_path / "store")
