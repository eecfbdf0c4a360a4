"""An argument that is no pair, sequence, executor or number raises an error in one line that names it."""

import inspect
import math
import re
from functools import partial

import numpy as np
import pytest

import rocking as rk
from rocking.orbits.saddles import manifold_gap

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


MILD = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
FALLING = rk.System(rk.Harmonic(amplitude=7.0, period=1.0), restitution=0.8)
UNDAMPED = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
RECORD = rk.System(rk.PiecewiseLinear([0.0, 1.5, 0.0], step=0.4), restitution=0.9)
theory = rk.theory
EVEN = "no mode with even n is symmetric: half a response later the forcing is unchanged, not reversed"
PERIOD = "period must lie in [0.00628319, 6283.19]; got"
RESTITUTION = "restitution must lie in [0, 1]; got"
PULSES = ("rectangular", "half_sine", "one_sine", "one_cosine")


def followed(*arguments):
    return rk.continue_orbit(rk.find_orbit(MILD, rk.State(0.18, -0.1), 1), *arguments)


def section(phase):
    return followed("amplitude", (1.9, 2.1)).section(phase)


WRONG_VALUES = [
    # closed forms
    (f"n must be an odd whole number in [1, 9999]; got 2 ({EVEN})", lambda: theory.symmetric_modes(2.0, 1.0, 0.9, 2)),
    ("n must be a whole number in [1, 9999]; got 0", lambda: theory.symmetric_modes(2.0, 1.0, 0.9, 0)),
    ("n must be a whole number in [1, 9999]; got 1.5", lambda: theory.symmetric_modes(2.0, 1.0, 0.9, 1.5)),
    ("restitution must lie in (0, 1] for symmetric modes; got 0.0 (an impact that stops the block leaves no mode)",
     lambda: theory.symmetric_modes(2.0, 1.0, 0.0, 1)),
    (f"{RESTITUTION} 1.1", lambda: theory.symmetric_modes(2.0, 1.0, 1.1, 1)),
    ("amplitude must lie in [0, 1000]; got -2.0", lambda: theory.symmetric_modes(-2.0, 1.0, 0.9, 1)),
    (f"{PERIOD} 0.0", lambda: theory.symmetric_modes(2.0, 0.0, 0.9, 1)),
    (f"{PERIOD} nan", lambda: theory.symmetric_modes(2.0, math.nan, 0.9, 1)),
    *(
        (message, partial(function, *arguments))
        for function in (theory.existence_amplitude, theory.symmetry_breaking_amplitude)
        for message, arguments in (
            (f"n must be an odd whole number in [1, 9999]; got 4 ({EVEN})", (1.0, 0.9, 4)),
            ("n must be an odd whole number in [1, 9999]; got 2.5", (1.0, 0.9, [1, 3, 2.5])),
            (f"{PERIOD} -1.0", ([1.0, -1.0], 0.9, 1)),
            (f"{RESTITUTION} nan", (1.0, [0.5, math.nan], 1)),
        )
    ),
    ("amplitude must lie in [0, 1000]; got -1", lambda: theory.melnikov_function(0, -1, 1, 0.9)),
    ("orbit must be one of 'upper', 'lower'; got 'both'", lambda: theory.melnikov_function(0, 1, 1, 0.9, "both")),
    ("period must lie in …; got 0.0", lambda: theory.melnikov_amplitude([1, 0], 0.9)),
    (f"{RESTITUTION} 1.5", lambda: theory.heteroclinic_amplitude(1, 1.5)),
    ("width must lie in [1e-12, 1]; got 0.0", lambda: theory.damping(0, 1, 0.9, 0.0)),
    (f"{RESTITUTION} 2.0", lambda: theory.melnikov_integral(0, 1, 1, 2.0)),
    ("angle must lie in [0, 1]; got 1.2", lambda: theory.free_quarter_period(1.2)),
    ("impacts must lie in [0, 1e+09]; got -1", lambda: theory.free_peaks(0.5, 0.9, -1)),
    ("restitution must …; got 0.999999999", lambda: theory.free_time_to_rest(0.5, 1 - 1e-9)),
    *(("duration must lie in [1e-06, 1e+06]; got 0", partial(getattr(theory, f"{kind}_pulse_amplitude"), 0)) for kind in PULSES),
    ("duration must lie in [0.001, 100]; got 200", lambda: theory.one_sine_impact_amplitudes(200, 0.9)),
    (f"{RESTITUTION} 1.1", lambda: theory.one_sine_impact_amplitudes(1.0, 1.1)),
    ("amplitude must be below √(1 + Ω²) = 6.36227; got 7.0…", lambda: manifold_gap(FALLING)),
    ("restitution must be below 1; got 1.0 (without dissipation…", lambda: rk.tangency_amplitude(UNDAMPED)),
    # motions and responses
    ("cycles must be omitted…", lambda: rk.simulate(RECORD, cycles=3)),
    ("record must be 'all' or 'none'…", lambda: rk.simulate(RECORD, record="section")),
    ("duration must be given for a base motion of finite length only…", lambda: rk.simulate(MILD, duration=3.0)),
    *(("cycles must be a whole number in [1, 1000000]; got …", partial(rk.rotation_number, UNDAMPED, cycles=wrong))
      for wrong in (0, 1.5, math.nan, 10**7)),
    *(("cycles must be a whole number in [32, 1000000000]; got …", partial(rk.lyapunov, MILD, cycles=wrong))
      for wrong in (0, 1.5)),
    *(("transient must be a whole number in [0, 1000000000]; got …", partial(rk.lyapunov, MILD, transient=wrong))
      for wrong in (-1, math.nan)),
    # orbits
    ("guess must not overturn within 2 cycles; got State…", lambda: rk.find_orbit(MILD, rk.State(3.0, 3.0), 1)),
    *(("period must be a whole number in [1, 1000]; got…", partial(rk.find_orbit, MILD, rk.State(0.1), wrong))
      for wrong in (0, -1, 1.5, 1001)),
    *(("max_period must be a whole number in [1, 64]; got…", partial(rk.find_orbits, MILD, wrong))
      for wrong in (0, -1, 1.5, 1001)),
    ("parameter must be one of 'amplitude', 'frequency', 'period', …", lambda: followed("phase", (0, 1))),
    ("bounds must be (lowest, highest), the one below the other; got…", lambda: followed("amplitude", (3, 1))),
    ("amplitude must lie in [3, 4] to be followed there; got 2.0…", lambda: followed("amplitude", (3, 4))),
    ("bounds of restitution must lie in [0.001, 1]; got 1.2…", lambda: followed("restitution", (0.5, 1.2))),
    ("brace_angle must be used with a braced system (give it braces=…", lambda: followed("brace_angle", (0.5, 1))),
    ("phase must lie in [-1000, 1000]; got 10000.0", lambda: section(1e4)),
    ("phase must lie in [-1000, 1000]; got nan", lambda: section(math.nan)),
]  # fmt: skip
WRONG_TYPES = [
    ("period must be a real number or an array of real numbers; got 'one'", lambda: theory.existence_amplitude("one", 0.9, 1)),
    ("restitution must be a real number in…", lambda: theory.symmetric_modes(2.0, 1.0, None, 1)),
    *(("duration must…", partial(getattr(theory, f"{kind}_pulse_amplitude"), "long")) for kind in PULSES),
    ("system must be a System; got 3 …", lambda: rk.classify(3)),
    ("orbit must be an Orbit; got None (rk.classify returns one only if the response is periodic; …",
     lambda: rk.continue_orbit(None, "amplitude", (1, 2))),
    ("phase must be a real number in [-1000, 1000]; got 'a'", lambda: section("a")),
    ("phase must be a real number in [-1000, 1000]; got [0.0]", lambda: section([0.0])),
]  # fmt: skip


@pytest.mark.parametrize(
    "error, message, call",
    [*((ValueError, *row) for row in WRONG_VALUES), *((TypeError, *row) for row in WRONG_TYPES)],
)
def test_refusal_is_one_line_that_says_what_is_allowed(error, message, call):
    with pytest.raises(error) as refused:
        call()
    told, (start, more, end) = str(refused.value), message.partition("…")
    assert told.startswith(start) and told.endswith(end) if more else told == message
    assert "\n" not in told


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
