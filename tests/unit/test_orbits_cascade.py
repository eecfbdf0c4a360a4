"""Cascades of period doublings: Feigenbaum's ratios, periods by marching, and the accumulation by another method."""

import sys

import attrs
import numpy as np
import pytest

import rocking as rk

DAMPED = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), 0.8)
BOUNDS = (10.3, 10.9)


def doubling(system, bounds):
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", bounds)
    return next(special for special in branch.special if special.kind == "period-doubling")


@pytest.fixture(scope="module")
def found():
    return rk.cascade(doubling(DAMPED, BOUNDS), BOUNDS, doublings=8)


def test_ratios_tend_to_feigenbaums_number(found):
    off = np.abs(found.ratios - 4.669201609)
    assert off[-1] < 1e-3
    assert off[-1] < off[0] / 100
    assert found.periods.tolist() == [2**n for n in range(8)]
    assert found.end == "number of period doublings wanted"


def test_ratios_without_losses_tend_to_those_of_area_preserving_maps():
    system = rk.System(rk.Harmonic(amplitude=1.5, period=1.0), 1.0)
    branches = [
        rk.continue_orbit(orbit, "amplitude", (0.2, 30.0))
        for orbit in rk.find_orbits(system, 2)
        if orbit.period == 2 and orbit.stability == "neutral"
    ]
    doublings = [each for branch in branches for each in branch.special if each.kind == "period-doubling"]
    first = min(doublings, key=lambda special: abs(special.parameter - 1.9739))
    found = rk.cascade(first, (0.2, 30.0), doublings=6)
    assert found.ratios[-1] == pytest.approx(8.721097, abs=2e-3)
    guide = next(line for line in rk.plot.cascade(found).lines if line.get_gid() == "universal").get_ydata()
    assert guide[0] / guide[1] == pytest.approx(8.721097)


def test_marching_finds_each_period_between_two_doublings(found):
    for left, right in zip(found.special[:4], found.special[1:5], strict=True):
        (branch,) = rk.switch_branch(left, (left.parameter - 1e-3, right.parameter))
        (orbit,) = branch.at(0.5 * (left.parameter + right.parameter))[:1]
        clocked = rk.Harmonic(orbit.system.forcing.amplitude, period=1.721328, phase=orbit.phase)
        start = rk.State(orbit.state.angle + 1e-7, orbit.state.velocity)
        assert rk.classify(rk.System(clocked, 0.8), start).period == 2 * left.orbit.period


def test_accumulation_is_the_limit_of_the_values(found):
    value, error = found.accumulation
    assert found.values[-1] < value < found.values[-1] + 0.5 * (found.values[-1] - found.values[-2])
    # one more doubling, and the geometric series with Feigenbaum's number
    more = rk.cascade(found.special[0], BOUNDS, doublings=9)
    exact = more.values[-1] + (more.values[-1] - more.values[-2]) / (4.669201609 - 1)
    assert abs(value - exact) <= error
    assert abs(more.accumulation[0] - exact) <= error
    assert error < 1e-8


def test_too_few_doublings_have_no_limit_and_a_branch_may_have_none(found):
    short = rk.cascade(found.special[0], (10.4, 10.7), doublings=6)
    assert len(short.special) == 2
    assert np.isnan(short.accumulation).all()
    assert short.end == "no period doubling on the branch of period 4: end of the range"
    assert "accumulation" not in str(short)
    assert "accumulation at 10.7326113" in str(found)


def test_without_a_doubling_in_the_usual_range_all_of_the_bounds_are_searched(found, monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.orbits.cascade"], "WIDTH", 1e-6)
    again = rk.cascade(found.special[0], BOUNDS, doublings=4)
    np.testing.assert_allclose(again.values, found.values[:4], rtol=1e-9)


def test_picture_shows_the_distances_beside_the_universal_ratio(found):
    ax = rk.plot.cascade(found)
    lines = {line.get_gid(): line for line in ax.lines}
    assert lines["distances"].get_xdata().tolist() == found.periods[:-1].tolist()
    assert lines["distances"].get_ydata() == pytest.approx(np.diff(found.values))
    guide = lines["universal"].get_ydata()
    assert guide[:-1] / guide[1:] == pytest.approx(np.full(6, 4.669201609))
    assert guide[-1] == lines["distances"].get_ydata()[-1]
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["1", "2", "4", "8", "16", "32", "64"]
    assert found._repr_html_().startswith("<figure>")
    block = rk.Block(2.0, 0.5)
    ax = rk.plot.cascade(found, block=block)
    (distances,) = (line for line in ax.lines if line.get_gid() == "distances")
    assert distances.get_ydata() == pytest.approx(np.diff(block.acceleration(found.values)))
    assert ax.get_ylabel() == "distance in amplitude $a_x$ (m/s²)"


@pytest.mark.parametrize("block", [None, rk.Block(2.0, 0.5)])
@pytest.mark.parametrize("doublings", [3, 4, 7])
def test_each_tick_has_its_number_and_the_legend_lies_below_the_axes(found, block, doublings):
    ax = rk.plot.cascade(rk.cascade(found.special[0], BOUNDS, doublings=doublings), block=block)
    ax.figure.draw_without_rendering()
    low, high = ax.get_ylim()
    ticks = [text for text in ax.get_yticklabels() if low <= text.get_position()[1] <= high]
    assert len(ticks) >= 2
    assert all(text.get_text() for text in ticks)
    legend, axes = ax.get_legend().get_window_extent(), ax.get_window_extent()
    assert axes.x0 < legend.x0
    assert legend.x1 < axes.x1


@pytest.mark.parametrize("name", ["restitution", "brace_restitution"])
def test_the_longest_label_fits_the_figure(name):
    braces = rk.Braces(angle=3.0, restitution=0.5)
    orbit = rk.classify(rk.System(DAMPED.forcing, 0.8, braces)).orbit
    special = rk.continue_orbit(orbit, "restitution", (0.75, 0.82)).special[0]
    found = rk.cascade(special, (0.75, 0.82), doublings=2)
    special = attrs.evolve(special, name=name)
    ax = rk.plot.cascade(attrs.evolve(found, special=(special, *found.special[1:])))
    ax.figure.draw_without_rendering()
    extent = ax.yaxis.label.get_window_extent()
    assert 0.0 <= extent.y0 < extent.y1 <= ax.figure.bbox.y1


def test_a_single_doubling_has_no_picture(found):
    short = rk.cascade(found.special[0], (10.4, 10.6), doublings=6)
    assert len(short.special) == 1
    assert str(short).startswith(
        f"cascade of 1 period doubling over amplitude, at {short.values[0]:.9g}, period 1; end"
    )
    assert short._repr_html_() is None
    assert short.to_xarray()["ratio"].isnull().all()
    with pytest.raises(ValueError, match="result must hold two period doublings or more to be drawn; got 1$"):
        rk.plot.cascade(short)
    with pytest.raises(TypeError, match="result must be a Cascade; got 3"):
        rk.plot.cascade(3)


def test_refusals(found):
    breaking = rk.continue_orbit(
        rk.classify(rk.System(rk.Harmonic(15.0, period=1.0), 0.9)).orbit, "amplitude", (10, 30)
    ).special[0]
    for call, error, message in (
        (
            lambda: rk.cascade(breaking, (10, 30)),
            ValueError,
            "special must be a period doubling; got 'symmetry-br",
        ),
        (lambda: rk.cascade(found, BOUNDS), TypeError, "special must be a SpecialPoint"),
        (lambda: rk.cascade(found.special[0], (11, 12)), ValueError, "bounds must contain the amplitude"),
        (
            lambda: rk.cascade(found.special[0], BOUNDS, doublings=1),
            ValueError,
            "doublings must be a whole number",
        ),
    ):
        with pytest.raises(error, match=message) as raised:
            call()
        assert "\n" not in str(raised.value)
