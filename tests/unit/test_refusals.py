"""An argument that is no pair, sequence, executor or number raises an error in one line that names it."""

import inspect
import re

import numpy as np
import pytest

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)


@pytest.fixture(scope="module")
def values():
    """An orbit, a special point of its branch, a diagram and a map."""
    orbit = rk.classify(SYSTEM).orbit
    axes = {"amplitude": np.linspace(1.0, 4.0, 3), "period": np.linspace(1.0, 2.0, 3)}
    return {
        "orbit": orbit,
        "special": rk.continue_orbit(orbit, "amplitude", (10, 30)).special[0],
        "diagram": rk.orbit_diagram(SYSTEM, amplitude=[14.0, 15.0], cycles=5, transient=5),
        "map": rk.parametric_map(SYSTEM, **axes, max_cycles=10).dataset,
    }


def curve(values, bounds):
    return rk.bifurcation_curve(values["special"], "amplitude", "period", bounds=bounds)


PAIR = r"bounds must be \(lowest, highest\), the one below the other; got "
PAIRS = "bounds must be two pairs (lowest, highest), of amplitude and of period; got "
CALLS = {
    "no pairs": (lambda v: curve(v, ""), re.escape(PAIRS)),
    "a mapping": (lambda v: curve(v, {}), re.escape(PAIRS)),
    "one pair": (lambda v: curve(v, [(1, 30)]), re.escape(PAIRS)),
    "a number": (lambda v: curve(v, 3), re.escape(PAIRS)),
    "a pair of numbers": (lambda v: curve(v, (1, 30)), PAIR),
    "no bounds": (lambda v: rk.continue_orbit(v["orbit"], "amplitude", bounds=None), PAIR),
    "three bounds": (lambda v: rk.continue_orbit(v["orbit"], "amplitude", bounds=(1, 2, 30)), PAIR),
    "bounds that are a text": (lambda v: rk.continue_orbit(v["orbit"], "amplitude", bounds="ab"), PAIR),
    "no box": (lambda v: rk.find_orbits(SYSTEM, 1, angles=1.5), r"angles must be \(lowest, highest\), .*; got 1\.5$"),
    "half a box": (lambda v: rk.find_orbits(SYSTEM, 1, velocities=[1.5]), r"velocities must be \(lowest, highest\)"),
    "no executor": (lambda v: rk.chaos_share(SYSTEM, samples=5, executor=True), "executor must be an Executor; got True"),
    "no executor of repeatability": (lambda v: rk.repeatability(SYSTEM, executor=3), "executor must be an Executor; got 3"),
    "no branches": (lambda v: rk.plot.orbit_diagram(v["diagram"], branches=None), "branches must be a sequence of Branch; got None"),
    "no curves": (lambda v: rk.plot.parametric_map(v["map"], curves=None), "curves must be a sequence of '.*'; got None"),
    "no period": (lambda v: rk.plot.melnikov(2.0, None, 0.9), "period must be a real number in "),
    "a text for a period": (lambda v: rk.plot.melnikov(2.0, "", 0.9), "period must be a real number in "),
    "a list for a period": (lambda v: rk.plot.melnikov(2.0, [1], 0.9), "period must be a real number in "),
    "an array for an amplitude": (lambda v: rk.plot.melnikov(np.ones(3), 1.0, 0.9), "amplitude must be a real number in "),
    "thresholds by no label": (lambda v: rk.plot.thresholds([1.0, 2.0], curves="x"), "curves must be a dict of amplitudes by label; "),
    "no axes": (lambda v: rk.plot.title(None, "x"), "ax must be an Axes; got None"),
    "no panels": (lambda v: rk.plot.panels(0), r"rows must be a whole number in \[1, 100\]; got 0"),
    "half a panel": (lambda v: rk.plot.panels(1, 1.5), r"columns must be a whole number in \[1, 100\]; got 1\.5"),
    "panels by name": (lambda v: rk.plot.panels("2"), r"rows must be a whole number in \[1, 100\]; got '2'"),
    "flat panels": (lambda v: rk.plot.panels(height=0), r"height must lie in \[0\.1, 100\]; got 0"),
    "one ratio": (lambda v: rk.plot.panels(columns=2, ratios=3), "ratios must be 2 positive numbers, one per column; got 3"),
    "too few ratios": (lambda v: rk.plot.panels(columns=2, ratios=(3,)), "ratios must be 2 positive numbers, one per column"),
    "an array of times": (lambda v: rk.theory.melnikov_integral([0.3], 2.0, 1.0, 0.9), "time must be a finite real number "),
    "progress of responses": (lambda v: rk.response_diagram(SYSTEM, amplitude=[1], progress=5), "progress must be a bool; got"),
    "progress of orbits": (lambda v: rk.orbit_diagram(SYSTEM, amplitude=[1], progress=3), "progress must be a bool; got"),
    "no time": (lambda v: rk.theory.melnikov_integral(float("inf"), 2.0, 1.0, 0.9), "time must be a finite real number "),
}  # fmt: skip


@pytest.mark.parametrize("what", CALLS)
def test_refusal_names_the_argument_in_one_line(values, what):
    call, told = CALLS[what]
    with pytest.raises((TypeError, ValueError), match=f"^{told}") as caught:
        call(values)
    assert len(str(caught.value).splitlines()) == 1


def test_what_is_a_pair_or_a_sequence_is_taken_in_any_form(values):
    orbit = values["orbit"]
    branches = [
        rk.continue_orbit(orbit, "amplitude", bounds)
        for bounds in ((14, 16), [14.0, 16.0], np.array([14, 16]))
    ]
    assert len({str(branch) for branch in branches}) == 1
    assert len(rk.plot.parametric_map(values["map"], curves=iter(["melnikov"])).lines) >= 1
    assert rk.plot.orbit_diagram(values["diagram"], branches=iter(branches)) is not None
    axes = rk.plot.panels(columns=2, ratios=[2, 1])[1]
    assert len(axes) == 2


def test_help_shows_no_table_and_no_argument_that_is_no_attribute():
    assert len(str(inspect.signature(rk.overturning_amplitude))) < 500
    found = rk.find_orbits(SYSTEM, 1, effort=0.01)
    for name in inspect.signature(type(found)).parameters:
        assert hasattr(found, name)
    assert found.orbits == tuple(found)
