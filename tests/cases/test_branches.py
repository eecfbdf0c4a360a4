"""Branches of periodic orbits against closed forms, published cases and each other."""

import math
import re
import runpy
from pathlib import Path

import attrs
import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import rocking as rk
from oracles.modes import existence_amplitude, symmetric_modes, symmetry_breaking_amplitude

FEIGENBAUM = 4.669201609
EXAMPLE = Path(__file__).parents[2] / "examples" / "doubling_cascade.py"


def system_of(amplitude, period, restitution, braces=None):
    return rk.System(rk.Harmonic(amplitude=amplitude, period=period), restitution, braces)


def mode_orbit(amplitude, period, restitution, n, braces=None):
    """The upper symmetric mode, found from its closed form: on the section at its impact's phase, so not quite from there."""
    mode = symmetric_modes(amplitude, period, restitution, n)[0]
    forcing = rk.Harmonic(amplitude=amplitude, period=period, phase=mode.phase)
    return rk.find_orbit(rk.System(forcing, restitution, braces), rk.State(0.0, mode.velocity), n)


def special(branch, kind):
    return [point for point in branch.special if point.kind == kind]


CASES = [(period, restitution) for period in (1.0, 1.5, 2.0) for restitution in (0.8, 0.9, 0.925)]


@pytest.mark.parametrize("period, restitution", CASES)
def test_the_symmetric_mode_breaks_its_symmetry_where_the_closed_form_says(period, restitution):
    expected = symmetry_breaking_amplitude(period, restitution, 1)
    orbit = mode_orbit(0.7 * expected, period, restitution, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (0.3 * expected, 1.5 * expected))
    found = special(branch, "symmetry-breaking")
    assert [point.parameter for point in found] == pytest.approx([expected], abs=1e-8)
    assert branch.ends == ("end of the range", "end of the range")


def test_the_section_of_an_orbit_is_as_far_from_its_impacts_as_can_be():
    """The two impacts of a symmetric orbit are half a cycle apart: a quarter of a cycle, although a chain stores one."""
    orbit = rk.continue_orbit(mode_orbit(2.0, 1.0, 0.8, 1), "amplitude", (1.5, 2.5)).orbit(50)
    forcing = rk.Harmonic(orbit.system.forcing.amplitude, period=1.0, phase=orbit.phase)
    impacts = rk.simulate(rk.System(forcing, 0.8), orbit.state, cycles=2).events["time"]
    np.testing.assert_allclose(impacts, [0.25, 0.75, 1.25, 1.75], rtol=0, atol=1e-9)


def test_what_is_printed_of_a_branch_says_where_it_is_stable():
    """Up to the closed form's symmetry breaking; the pair that is born there, up to its period doubling."""
    breaking = symmetry_breaking_amplitude(1.721328, 0.8, 1)
    branch = rk.continue_orbit(mode_orbit(7.0, 1.721328, 0.8, 1), "amplitude", (5.0, 9.0))
    assert f" points, stable from 5 to {breaking:.6g}: " in str(branch)
    born = rk.switch_branch(special(branch, "symmetry-breaking")[0], (5.0, 11.0))[0]
    first = born.points["parameter"][np.flatnonzero(born.points["stable"])[0]]
    doubling = special(born, "period-doubling")[0].parameter
    assert f" points, stable from {first:.6g} to {doubling:.6g}: " in str(born)
    # the same branch to both sides of where it is born: it comes back along its mirror image
    whole = rk.continue_orbit(born.at(8.0)[0], "amplitude", (5.0, 9.0))
    low, high = re.search(r" points, stable from (\S+) to (\S+): ", str(whole)).groups()
    assert float(low) == pytest.approx(breaking, rel=1e-4)
    assert float(high) == 9.0
    beyond = rk.continue_orbit(mode_orbit(8.0, 1.721328, 0.8, 1), "amplitude", (7.5, 9.0))
    assert " points, nowhere stable: " in str(beyond)


@pytest.mark.parametrize("period, restitution", CASES)
def test_beyond_it_two_mirror_images_are_as_stable_as_a_verdict_says(period, restitution):
    breaking = symmetry_breaking_amplitude(period, restitution, 1)
    orbit = mode_orbit(0.7 * breaking, period, restitution, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (0.5 * breaking, 1.3 * breaking))
    pair = rk.switch_branch(special(branch, "symmetry-breaking")[0], (0.5 * breaking, 1.3 * breaking))
    one, other = pair
    reach = min(branch.points["parameter"].max() for branch in pair)
    for amplitude in np.linspace(breaking, reach, 52)[1:-1]:
        (here,), (there,) = one.at(amplitude), other.at(amplitude)
        np.testing.assert_allclose(section(here, 1.0), -section(there, 1.0 + math.pi), rtol=0, atol=1e-9)
        for orbit in (here, there):
            assert abs(orbit.multipliers[0]) != pytest.approx(1.0, abs=1e-7)
            assert_stable_as_judged(orbit)


def section(orbit, phase):
    """The orbit's state at a forcing phase, within its first cycle."""
    forcing = rk.Harmonic(
        amplitude=orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=orbit.phase
    )
    motion = rk.simulate(rk.System(forcing, orbit.system.restitution), orbit.state, cycles=orbit.period)
    return np.array(motion.at((phase - orbit.phase) % (2 * math.pi) / forcing.frequency))


def assert_stable_as_judged(orbit):
    """Check that a verdict from a state next to the orbit finds the orbit exactly if it is stable."""
    forcing = orbit.system.forcing
    there = rk.System(
        rk.Harmonic(amplitude=forcing.amplitude, period=forcing.period, phase=orbit.phase),
        orbit.system.restitution,
    )
    start = rk.State(orbit.state.angle + 1e-6, orbit.state.velocity)
    verdict = rk.classify(there, start, max_cycles=20_000)
    same = verdict.kind == "periodic" and verdict.period == orbit.period and not verdict.symmetric
    assert same == orbit.stable


def test_the_orbit_of_figure_2c_lives_between_two_grazings():
    forcing = rk.Harmonic(amplitude=5.5, period=0.5, phase=1.8)
    orbit = rk.classify(rk.System(forcing, 0.925), rk.State(velocity=0.15)).orbit
    assert (orbit.period, orbit.impacts) == (10, 4)
    branch = rk.continue_orbit(orbit, "amplitude", (1.0, 20.0))
    assert branch.ends == ("grazing", "grazing")
    assert [point.kind for point in branch.special] in (
        ["grazing", "fold", "period-doubling", "grazing"],
        ["grazing", "period-doubling", "fold", "grazing"],
    )
    fold, doubling = special(branch, "fold")[0].parameter, special(branch, "period-doubling")[0].parameter
    assert fold < 5.5 < doubling
    stable = branch.points["parameter"][branch.points["stable"]]
    assert fold <= stable.min()
    assert stable.max() <= doubling
    # at either end the motion touches: an impact all but without speed, or a turn on the base
    for point in special(branch, "grazing"):
        assert nearest_touch(point.orbit) <= 1e-6


def nearest_touch(orbit):
    """The least of the impact speeds and of the heights at which |Θ| turns in the air."""
    forcing = rk.Harmonic(
        amplitude=orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=orbit.phase
    )
    there = rk.System(forcing, orbit.system.restitution)
    motion = rk.simulate(there, orbit.state, cycles=orbit.period)
    times = np.linspace(0.0, orbit.period * forcing.period, 200_001)
    size = np.abs(motion.at(times)[0])
    turns = (size[1:-1] < size[:-2]) & (size[1:-1] < size[2:])
    away = np.abs(motion.events["time"][:, None] - times[1:-1][turns]).min(axis=0) > 2 * times[1]
    return min(
        np.abs(motion.events["before"]).min(),
        np.where(away, size[1:-1][turns], math.inf).min(initial=math.inf),
    )


def test_doublings_of_the_unsymmetric_orbit_close_in_as_feigenbaum_found():
    orbit = mode_orbit(7.0, 1.721328, 0.8, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (5.0, 9.0))
    breaking = special(branch, "symmetry-breaking")[0]
    assert breaking.parameter == pytest.approx(7.3332, abs=5e-5)
    born, amplitudes, high = rk.switch_branch(breaking, (7.0, 11.0))[0], [], 11.0
    for _ in range(5):
        doubling = special(born, "period-doubling")[0]
        amplitudes.append(doubling.parameter)
        if len(amplitudes) > 1:
            high = amplitudes[-1] + 0.5 * (amplitudes[-1] - amplitudes[-2])
        born = rk.switch_branch(doubling, (amplitudes[-1] - 0.1, high))[0]
    assert born.period == 32
    assert amplitudes[:3] == pytest.approx([10.473, 10.692, 10.725], abs=1e-3)
    gaps = np.diff(amplitudes)
    ratios = gaps[:-1] / gaps[1:]
    errors = np.abs(ratios - FEIGENBAUM)
    assert (np.diff(errors) < 0).all()
    assert errors[-1] < 0.02


def test_the_period_3_branch_is_born_and_doubles_into_the_chaos_at_10_103():
    orbit = rk.classify(system_of(10.07, 1.721328, 0.8), max_cycles=20_000).orbit
    orbit = orbit if orbit.period == 3 else stable_period_3(10.07)
    branch = rk.continue_orbit(orbit, "amplitude", (9.5, 10.5))
    fold, doubling = special(branch, "fold")[0], special(branch, "period-doubling")[0]
    assert fold.parameter == pytest.approx(10.05, abs=0.01)
    assert doubling.parameter == pytest.approx(10.09, abs=0.01)
    born = rk.switch_branch(doubling, (10.0, 10.103))[0]
    second = special(born, "period-doubling")[0]
    assert doubling.parameter < second.parameter < 10.103


def stable_period_3(amplitude):
    orbits = rk.find_orbits(system_of(amplitude, 1.721328, 0.8), 3)
    return next(orbit for orbit in orbits if orbit.period == 3 and orbit.stable)


@pytest.mark.parametrize("n, period", [(1, 1.0), (3, 1.0)])
def test_curves_of_symmetry_breaking_and_fold_are_the_closed_forms(n, period):
    restitution = 0.9
    breaking = symmetry_breaking_amplitude(period, restitution, n)
    orbit = mode_orbit(0.7 * breaking, period, restitution, n)
    branch = rk.continue_orbit(orbit, "amplitude", (1e-3 * breaking, 2.0 * breaking))
    ranges = ((0.7 * period, 2.0 * period), (1e-3 * breaking, 4.0 * breaking))
    for kind, expected in (("symmetry-breaking", symmetry_breaking_amplitude), ("fold", existence_amplitude)):
        (point,) = special(branch, kind)
        curve = rk.bifurcation_curve(point, "period", "amplitude", ranges)
        assert len(curve) > 30
        assert max(abs(a - expected(t, restitution, n)) for t, a in curve.points) <= 1e-8


def test_stability_changes_just_at_the_index_of_a_special_point():
    """On the way down from where the branch was begun a fold, on the way up the breaking of symmetry."""
    breaking = symmetry_breaking_amplitude(1.0, 0.9, 1)
    orbit = mode_orbit(0.7 * breaking, 1.0, 0.9, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (1e-3 * breaking, 2.0 * breaking))
    changes = 1 + np.flatnonzero(np.diff(branch.points["stable"]))
    found = [point for point in branch.special if point.kind != "grazing"]
    assert sorted(point.kind for point in found) == ["fold", "symmetry-breaking"]
    assert [point.index for point in found] == changes.tolist()


def test_the_symmetric_mode_followed_in_restitution_is_the_closed_form():
    branch = rk.continue_orbit(mode_orbit(2.0, 1.0, 0.925, 1), "restitution", (0.5, 1.0))
    assert branch.points["parameter"].max() == 1.0
    for point in branch.points:
        mode = symmetric_modes(2.0, 1.0, point["parameter"], 1)[0]
        assert point["velocity"] == pytest.approx(mode.velocity, abs=1e-10)
        # the mode's phase is that of an impact onto the positive side; onto the other it is half a turn later
        apart = (point["phase"] - mode.phase + math.pi / 2) % math.pi - math.pi / 2
        assert abs(apart) <= 1e-10


def test_followed_in_the_brace_angle_it_grazes_where_the_brace_is_its_peak():
    free = mode_orbit(2.0, 1.0, 0.925, 1)
    braced = mode_orbit(2.0, 1.0, 0.925, 1, rk.Braces(1.0, 0.9))
    branch = rk.continue_orbit(braced, "brace_angle", (0.05, 2.0))
    assert branch.ends == ("grazing", "end of the range")
    assert special(branch, "grazing")[0].parameter == pytest.approx(peak_of(free), abs=1e-8)


def peak_of(orbit):
    """Return the largest |Θ| of an orbit, by a march from its state."""
    forcing = rk.Harmonic(
        amplitude=orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=orbit.phase
    )
    return rk.simulate(
        rk.System(forcing, orbit.system.restitution), orbit.state, cycles=orbit.period, record="none"
    ).peak


def test_the_first_point_of_a_branch_is_the_special_point_it_is_born_at():
    orbit = mode_orbit(7.0, 1.721328, 0.8, 1)
    breaking = special(rk.continue_orbit(orbit, "amplitude", (5.0, 9.0)), "symmetry-breaking")[0]
    first = rk.switch_branch(breaking, (5.0, 9.0))[0].points[0]
    (mode, *_) = symmetric_modes(breaking.parameter, 1.721328, 0.8, 1)
    assert first["velocity"] == pytest.approx(mode.velocity, rel=1e-10)
    assert first["peak"] == pytest.approx(peak_of(breaking.orbit), rel=1e-12, abs=0)
    assert first["multipliers"][0] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("phase", [0.0, 1.0, None])
def test_a_section_is_where_runs_are_and_goes_on_without_a_jump(phase):
    """Also where an event passes the section: of the doubled branch the first one does, unless a phase is given."""
    orbit = mode_orbit(7.0, 1.721328, 0.8, 1)
    breaking = special(rk.continue_orbit(orbit, "amplitude", (5.0, 11.0)), "symmetry-breaking")[0]
    born = rk.switch_branch(breaking, (7.0, 11.0))[0]
    twice = rk.switch_branch(special(born, "period-doubling")[0], (10.0, 11.5))[0]
    phase = float(np.median(twice.points["phase"])) if phase is None else phase
    for branch in (born, twice):
        states = branch.section(phase)
        assert states.shape == (len(branch), branch.period, 2)
        for k in range(0, len(branch), 10):
            run = [run_to(branch.orbit(k), phase, cycle) for cycle in range(branch.period)]
            first = int(np.hypot(*(np.array(run) - states[k, 0]).T).argmin())
            # what a run makes of rounding on its way
            tolerance = 1e-13 * max(abs(branch.points["multipliers"][k, 0]), 1e2)
            np.testing.assert_allclose(np.roll(run, -first, axis=0), states[k], rtol=0, atol=tolerance)
        jumps = np.abs(np.diff(states[:, :, 0], axis=0)).max()
        assert jumps < 0.1


def run_to(orbit, phase, cycle):
    """The state of a run on an orbit when the forcing has a phase, in one of its cycles."""
    forcing = orbit.system.forcing
    there = rk.Harmonic(amplitude=forcing.amplitude, period=forcing.period, phase=orbit.phase)
    motion = rk.simulate(rk.System(there, orbit.system.restitution), orbit.state, cycles=orbit.period)
    wait = (phase - orbit.phase) % (2 * math.pi) / forcing.frequency
    return motion.at(wait + cycle * forcing.period)


def test_a_branch_that_closes_on_itself_ends_where_it_began():
    """Between braces, over the restitution: an isola, on which every orbit has another one beside it."""
    orbit = isolated_orbit()
    branch = rk.continue_orbit(orbit, "restitution", (0.3, 1.0))
    assert branch.ends == ("closed loop", "closed loop")
    folds = special(branch, "fold")
    assert len(folds) % 2 == 0
    low, high = (end([fold.parameter for fold in folds]) for end in (min, max))
    # The orbits between the last point and the first are not in the list; at other values there are two, or four, …
    first, last = branch.section()[[0, -1]]
    assert np.abs(first - last).max() < 0.05
    gap = sorted(branch.points["parameter"][[0, -1]])
    inside = [value for value in np.linspace(low, high, 22)[1:-1] if not gap[0] <= value <= gap[1]]
    for value in inside:
        assert len(branch.at(value)) % 2 == 0
        assert len(branch.at(value)) > 0


def test_special_points_of_a_closed_branch_lie_where_their_tests_change_sign():
    """1 - trace + determinant at a fold, 1 + trace + determinant at a doubling; between them the orbits are stable."""
    branch = rk.continue_orbit(isolated_orbit(), "restitution", (0.3, 1.0))
    multipliers = branch.points["multipliers"]
    trace, determinant = multipliers.sum(axis=1).real, multipliers.prod(axis=1).real
    tests = {"fold": 1.0 - trace + determinant, "period-doubling": 1.0 + trace + determinant}
    for kind, test in tests.items():
        changes = 1 + np.flatnonzero(np.diff(test > 0.0))
        assert len(changes) > 0
        assert [point.index for point in special(branch, kind)] == changes.tolist()
    found = np.reshape([point.parameter for point in branch.special], (-1, 2))
    # three of the four ranges are narrower than the last of six digits
    ranges = ["from 0.886161 to 0.886162", *(f"at {pair[0]:.6g}" for pair in found[1:])]
    assert f" points, stable {' and '.join(ranges)}: " in str(branch)


def test_a_closed_branch_has_each_special_point_once_wherever_it_starts():
    """Its last step goes beyond its first orbit, and may pass a special point there again. Two of them lie 8e-9 apart."""
    branch = rk.continue_orbit(isolated_orbit(), "restitution", (0.3, 1.0))
    expected = sorted(point.parameter for point in branch.special)
    for point in branch.special:
        again = rk.continue_orbit(branch.orbit(point.index), "restitution", (0.3, 1.0))
        assert again.ends == ("closed loop", "closed loop")
        assert sorted(one.parameter for one in again.special) == pytest.approx(expected, abs=1e-10)


def isolated_orbit():
    """Orbit of period 5 with 12 impacts at A = 15, T = 2, e = .925, braces at 1."""
    forcing = rk.Harmonic(amplitude=15.0, period=2.0, phase=1.9605848019)
    braced = rk.System(forcing, 0.925, rk.Braces(angle=1.0, restitution=1.0))
    return rk.find_orbit(braced, rk.State(-0.5728344694, 4.3332188138), 5)


def test_curves_of_period_doubling_are_where_branches_at_other_periods_double(thin):
    orbit = mode_orbit(7.0, 1.721328, 0.8, 1)
    doubling = doubling_of(orbit)
    curve = rk.bifurcation_curve(doubling, "period", "amplitude", ((1.5, 2.2), (5.0, 15.0)))
    assert curve.kind == "period-doubling"
    for period, amplitude in thin(curve.points, 5):
        breaking = symmetry_breaking_amplitude(period, 0.8, 1)
        there = doubling_of(mode_orbit(0.95 * breaking, period, 0.8, 1))
        assert there.parameter == pytest.approx(amplitude, abs=1e-8)
        # and by the verdicts on both sides of it: of period 1 before, of period 2 after
        for share, cycles in ((0.999, 1), (1.001, 2)):
            forced = rk.System(rk.Harmonic(share * amplitude, period=period, phase=there.orbit.phase), 0.8)
            assert rk.classify(forced, there.orbit.state).period == cycles


def doubling_of(symmetric):
    """Find the period doubling of the asymmetric orbit that branches off from a symmetric one."""
    branch = rk.continue_orbit(symmetric, "amplitude", (3.0, 20.0))
    breaking = special(branch, "symmetry-breaking")[0]
    return special(rk.switch_branch(breaking, (3.0, 20.0))[0], "period-doubling")[0]


def begun_before(orbit, kind):
    """Return the orbit with its initial state between an event of that kind and the event before."""
    forcing, braces = orbit.system.forcing, orbit.system.braces
    clocked = rk.Harmonic(forcing.amplitude, period=forcing.period, phase=orbit.phase)
    motion = rk.simulate(rk.System(clocked, orbit.system.restitution, braces), orbit.state, cycles=2)
    events = motion.events
    k = 1 + int(np.flatnonzero(events["kind"][1:] == kind)[0])
    wait = 0.5 * (events["time"][k - 1] + events["time"][k])
    state = rk.State(*(float(value) for value in motion.at(wait)))
    return attrs.evolve(orbit, state=state, phase=(orbit.phase + forcing.frequency * wait) % math.tau)


def test_a_curve_of_grazing_is_the_same_wherever_its_orbit_is_begun():
    orbit = rk.classify(system_of(2.0, 1.0, 0.925, rk.Braces(0.15, 0.9))).orbit
    curves = []
    for first in ("impact", "brace"):
        branch = rk.continue_orbit(begun_before(orbit, first), "brace_angle", (0.05, 2.0))
        point = special(branch, "grazing")[0]
        curves.append(rk.bifurcation_curve(point, "amplitude", "brace_angle", ((1.5, 2.5), (0.01, 2.0))))
    np.testing.assert_allclose(curves[0].points, curves[1].points, rtol=0, atol=1e-8)


def test_a_curve_of_grazing_with_a_brace_is_the_peak_without_it(thin):
    """Over the restitution: the brace that the orbit just touches is as far out as the orbit of the block without braces."""
    braced = mode_orbit(2.0, 1.0, 0.925, 1, rk.Braces(1.0, 0.9))
    grazing = special(rk.continue_orbit(braced, "brace_angle", (0.05, 2.0)), "grazing")[0]
    curve = rk.bifurcation_curve(grazing, "amplitude", "brace_angle", ((1.0, 4.0), (0.01, 2.0)))
    assert curve.kind == "grazing"
    assert np.ptp(curve.points[:, 0]) == pytest.approx(3.0, abs=1e-6)
    for amplitude, angle in thin(curve.points, 10):
        assert angle == pytest.approx(peak_of(mode_orbit(amplitude, 1.0, 0.925, 1)), abs=1e-8)


def test_a_curve_of_grazing_with_the_base_is_where_the_slower_mode_comes_back_to_it(thin):
    """Eq. (5) with the speed and the phase of eq. (8) touches Θ = 0 on its way."""
    branch = rk.continue_orbit(mode_orbit(1.0, 1.0, 0.8, 1), "amplitude", (0.01, 3.0))
    grazing = special(branch, "grazing")[0]
    assert grazing.parameter == pytest.approx(comes_back(1.0), abs=1e-8)
    curve = rk.bifurcation_curve(grazing, "period", "amplitude", ((0.7, 2.0), (0.01, 5.0)))
    assert np.ptp(curve.points[:, 0]) == pytest.approx(1.3, abs=1e-6)
    for period, amplitude in thin(curve.points, 10):
        assert amplitude == pytest.approx(comes_back(period), abs=1e-8)


def comes_back(period):
    """Return the amplitude at which the slower (1, 1) mode at e = .8 touches the base."""

    def lowest(amplitude):
        _, mode = symmetric_modes(amplitude, period, 0.8, 1)
        frequency = 2 * math.pi / period
        beta = amplitude / (1 + frequency**2)

        def height(t):
            swing = math.cos(mode.phase + frequency * t) - math.cos(mode.phase) * math.cosh(t)
            swing += frequency * math.sin(mode.phase) * math.sinh(t)
            return mode.velocity * math.sinh(t) - (math.cosh(t) - 1) + beta * swing

        times = np.linspace(0, period / 2, 1001)[1:-1]
        turns = [
            k for k in range(1, 998) if height(times[k]) <= min(height(times[k - 1]), height(times[k + 1]))
        ]
        if not turns:
            return 1.0
        around = times[turns[0] - 1], times[turns[0] + 1]
        return minimize_scalar(height, bounds=around, method="bounded", options={"xatol": 1e-9}).fun

    least, most = existence_amplitude(period, 0.8, 1), no_speed(period)
    return brentq(lowest, least + 0.5 * (most - least), most - 1e-3, xtol=1e-11)


def no_speed(period):
    """Return the amplitude t(1 + Ω²)/Ω at which the speed of the slower (1, 1) mode vanishes."""
    frequency = 2 * math.pi / period
    return math.tanh(math.pi / (2 * frequency)) * (1 + frequency**2) / frequency


def test_the_example_follows_six_doublings_and_prints_their_ratios(capsys):
    example = runpy.run_path(str(EXAMPLE))
    branches, doublings = example["cascade"]()
    assert [branch.period for branch in branches] == [1, 1, 2, 4, 8, 16, 32, 64]
    example["table"](doublings)
    amplitudes = [point.parameter for point in doublings]
    ratios = np.diff(amplitudes)[:-1] / np.diff(amplitudes)[1:]
    assert ratios[-1] == pytest.approx(FEIGENBAUM, abs=1e-3)
    assert f"32 → 64   {amplitudes[-1]:.9f}   {ratios[-1]:.4f}" in capsys.readouterr().out


def test_the_orbit_at_a_grazing_end_is_one_of_those_at_its_value():
    braces = rk.Braces(angle=0.07124858133720009, restitution=1.0)
    system = rk.System(rk.Harmonic(amplitude=3.058737897197251, period=1.601346285674916), 0.97, braces)
    values = []
    for orbit in rk.find_orbits(system, 1):
        if orbit.impacts and not orbit.superstable:
            branch = rk.continue_orbit(orbit, "restitution", (0.388, 1.0), step=0.05, max_points=400)
            for index in (0, -1):
                if branch.ends[index] == "grazing":
                    values.append(branch.points["parameter"][index])
                    assert len(branch.at(float(values[-1]))) >= 1
    assert values
