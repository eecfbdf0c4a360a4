"""The maps of figures 10, 11 and 13b on coarser grids; the expected fractions are those of THEORY's larger grids."""

from types import SimpleNamespace

import numpy as np
import pytest

import rocking as rk
from rocking.model.system import quantities
from rocking.papers.yim_lin_1991 import figures, surveys
from surveyed import system_with

KINDS = {kind: number for number, kind in enumerate(rk.Kind)}


def a_map(count, restitution, *, brace_angle=None, max_cycles=10_000):
    # values between those of the figures' grids
    period, amplitude = (
        low + (np.arange(count) + 0.5) / count * (high - low)
        for low, high in (surveys.PERIODS, surveys.AMPLITUDES)
    )
    return rk.parametric_map(
        system_with(restitution=restitution, brace_angle=brace_angle),
        period=period,
        amplitude=amplitude,
        max_cycles=max_cycles,
    ).dataset


def share(found, kind):
    return float((found.kind == KINDS[kind]).mean())


def over(found, amplitude, *n):
    """An amplitude of theory along the map's periods."""
    return found.period.copy(data=amplitude(found.period.values, 0.925, *n))


@pytest.fixture(scope="module")
def damped():
    return a_map(120, restitution=0.925)


def test_undamped_responses_are_those_of_the_caption_and_none_is_periodic():
    """Quasi-periodic 12.8 %, chaotic 2.6 %, overturned 77.9 %, rest 6.7 % of 3,600 points, to four standard errors."""
    found = a_map(48, restitution=1.0)
    for kind, known in (
        ("quasi-periodic", 0.128),
        ("chaotic", 0.026),
        ("overturned", 0.779),
        ("rest", 0.067),
    ):
        error = np.sqrt(known * (1 - known) * (1 / 48**2 + 1 / 60**2))
        assert share(found, kind) == pytest.approx(known, abs=4 * error)
    assert share(found, "periodic") == 0
    assert share(found, "undetermined") < 0.04


def test_damped_responses_are_periodic_or_none_or_overturn(damped):
    for kind, known in (("rest", 0.065), ("periodic", 0.474), ("overturned", 0.461)):
        assert share(damped, kind) == pytest.approx(known, abs=0.01)
    assert share(damped, "chaotic") + share(damped, "quasi-periodic") < 0.001
    bounded = damped.kind.isin([KINDS["periodic"], KINDS["rest"]])
    above = damped.amplitude > over(damped, rk.theory.melnikov_amplitude)
    # chaos "is given by" A ≥ A_M, says the paper; most of what lies there and stays is periodic
    assert float((above & bounded).sum()) > 0.9 * float((above & ~(damped.kind == KINDS["overturned"])).sum())


def test_period_1_is_symmetric_up_to_the_curve_of_its_mode_and_not_beyond(damped):
    curve = over(damped, rk.theory.symmetry_breaking_amplitude, 1)
    above = (damped.amplitude > curve) & (damped.response_period == 1)
    below = (damped.amplitude < curve) & (damped.response_period == 1)
    assert int(above.sum()) > 300
    assert int(below.sum()) > 3_000
    assert not (damped.symmetric.where(above) == 1).any()
    # another orbit of period 1 may be reached from rest as well
    assert float((damped.symmetric.where(below) == 0).sum()) < 0.02 * float(below.sum())


def test_braced_map_followed_for_less_has_nothing_chaotic_and_what_is_open_is_undetermined():
    found = a_map(20, restitution=0.925, brace_angle=1.0, max_cycles=2_000)
    assert share(found, "chaotic") == 0
    assert 0.01 < share(found, "undetermined") < 0.12
    assert share(found, "overturned") == 0


@pytest.mark.parametrize(
    "figure, fixed",
    [
        (surveys.undamped, {"restitution": 1.0}),
        (surveys.damped, {"restitution": 0.925}),
        (
            surveys.braced,
            {"restitution": 0.925, "brace_angle": 1.0, "brace_restitution": 1.0, "max_cycles": 100_000},
        ),
    ],
)
def test_figures_ask_for_what_their_captions_say(monkeypatch, figure, fixed):
    monkeypatch.setattr(rk, "parametric_map", lambda system, **axes: SimpleNamespace(dataset=(system, axes)))
    system, axes = figure.__wrapped__()
    period, amplitude = axes.pop("period"), axes.pop("amplitude")
    own = {
        name: value for name, value in quantities(system).items() if name not in system.forcing.quantities()
    }
    assert system.forcing.phase == 0.0
    assert own | axes == fixed
    assert min(period.size, amplitude.size) >= 40
    assert (period[0], period[-1], amplitude[0], amplitude[-1]) == (
        *surveys.PERIODS,
        *surveys.AMPLITUDES,
    )


def test_figure_11_is_drawn_with_its_three_curves(monkeypatch):
    drawn = []
    monkeypatch.setattr(surveys, "damped", lambda: a_map(8, restitution=0.925))
    monkeypatch.setattr(rk.plot, "parametric_map", lambda *_, curves, **__: drawn.append(curves))
    figures.figure_11()
    assert drawn == [("symmetry-breaking-1", "symmetry-breaking-3", "melnikov")] * 2
