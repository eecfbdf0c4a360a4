"""Periodic orbits as they are run: from their start, at any phase, in the user's own system; and their stability at e = 1."""

import math

import attrs
import numpy as np
import pytest

import rocking as rk


def system_of(amplitude, period, restitution, phase=0.0, braces=None):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)


SYSTEM = system_of(8.0, 1.721328, 0.8)
# The phase lies on the impact of the second: its orbit has an event at its start.
MODE = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
# Of the last two the first rests, the other leans on a brace, between releases.
SYSTEMS = [
    SYSTEM,
    system_of(2.0, 1.0, 0.925, phase=2.5),
    MODE.system,
    system_of(6.5, 0.4, 0.925),
    system_of(2.0, 1.0, 0.9, braces=rk.Braces(0.15, 0.9)),
    system_of(1.05, 3.0, 0.5),
    system_of(27.1556, 2.8054, 0.95, braces=rk.Braces(0.5, 0.3)),
]


def apart(one, other):
    return math.hypot(one.angle - other.angle, one.velocity - other.velocity)


@pytest.mark.parametrize("system", SYSTEMS)
def test_an_orbit_of_a_verdict_runs_from_its_start_and_stays(system):
    orbit = rk.classify(system).orbit
    assert orbit.system == system
    assert orbit.stable
    motion = orbit.motion(cycles=200 * orbit.period)
    assert (motion.system, motion.start) == (system, orbit.start)
    rows = motion.section(system.forcing.phase + 0.7)
    assert np.abs(rows[orbit.period :] - rows[: -orbit.period]).max() < 1e-10
    if orbit.impacts is not None:
        # an impact at the end may be counted or not
        assert abs(orbit.motion(20 * orbit.period, "none").impacts - 20 * orbit.impacts) <= 1


@pytest.mark.parametrize("system", SYSTEMS[:5])
def test_an_orbit_is_found_again_from_its_own_start(system):
    orbit = rk.classify(system).orbit
    again = rk.find_orbit(orbit.system, orbit.start, orbit.period)
    assert again.system == orbit.system
    assert again.period == orbit.period
    assert apart(again.start, orbit.start) < 1e-10
    np.testing.assert_allclose(again.multipliers, orbit.multipliers, rtol=1e-8, atol=1e-12)


def test_found_orbits_belong_to_the_system_that_was_passed_in():
    orbits = rk.find_orbits(SYSTEM, 1)
    assert len(orbits) > 2
    for orbit in orbits:
        assert orbit.system == SYSTEM
        # what one period makes of rounding at the start
        reach = 1e-13 * max(abs(orbit.multipliers[0]), 1.0)
        assert apart(rk.simulate(SYSTEM, orbit.start, cycles=orbit.period).final, orbit.start) < reach
        again = rk.find_orbit(orbit.system, orbit.start, orbit.period)
        assert apart(again.start, orbit.start) < reach
    stable = [orbit for orbit in orbits if orbit.stable]
    assert len(stable) == 2
    for orbit in stable:
        assert rk.simulate(SYSTEM, orbit.start, cycles=1000).outcome is rk.Outcome.BOUNDED


@pytest.mark.parametrize("system", SYSTEMS[:5])
def test_states_at_phases_are_those_of_a_run_from_the_start(system):
    orbit = rk.classify(system).orbit
    forcing = system.forcing
    motion = rk.simulate(system, orbit.start, cycles=orbit.period + 1)
    for turned in np.linspace(0.01, 2 * math.pi * orbit.period - 0.01, 29):
        state = orbit.at(forcing.phase + turned)
        expected = motion.at(turned / forcing.frequency)
        np.testing.assert_allclose((state.angle, state.velocity), expected, rtol=0, atol=1e-12)
        assert apart(state, orbit.at(forcing.phase + turned - 2 * math.pi * orbit.period)) < 1e-12


def test_a_start_on_an_impact_is_the_state_after_it():
    """The forcing's phase is that of the impact onto the positive side: V of eq. (8), at Θ = 0."""
    for phase in np.nextafter(MODE.phase, [-4.0, MODE.phase, 4.0]):
        system = system_of(2.0, 1.0, 0.925, phase=float(phase))
        orbit = rk.find_orbit(system, MODE.start, 1)
        assert abs(orbit.start.angle) < 1e-14
        assert orbit.start.velocity == pytest.approx(MODE.velocity, rel=1e-12)


def test_orbits_of_branches_run_too():
    orbit = rk.classify(SYSTEM).orbit
    branch = rk.continue_orbit(orbit, "amplitude", (6.0, 9.0))
    for one in (branch.orbit(0), branch.orbit(len(branch) // 2), *branch.at(8.0)):
        final = rk.simulate(one.system, one.start, cycles=one.period).final
        assert apart(final, one.start) < 1e-13 * max(abs(one.multipliers[0]), 1.0)


def undamped(amplitude, period=1.0, n=1):
    mode = rk.theory.symmetric_modes(amplitude, period, 1.0, n)[0]
    return mode, rk.find_orbit(mode.system, mode.start, n)


def test_without_losses_modes_orbits_and_branches_are_neutral_up_to_the_symmetry_breaking():
    mode, orbit = undamped(2.0)
    assert mode.stability == orbit.stability == rk.Stability.NEUTRAL
    assert not mode.stable
    assert not orbit.stable
    branch = rk.continue_orbit(orbit, "amplitude", (1.0, 40.0))
    ends = rk.theory.symmetry_breaking_amplitude(1.0, 1.0, 1)
    points = branch.points
    below = points["parameter"] < ends
    assert below.sum() > 50
    assert (~below).sum() > 10
    assert set(points["stability"][below]) == {"neutral"}
    assert set(points["stability"][~below]) == {"unstable"}
    assert not points["stable"].any()
    assert f" points, neutral from 1 to {ends:.6g}: " in str(branch)
    assert {branch.orbit(i).stability for i in np.flatnonzero(below)[::10]} == {"neutral"}


def test_neutral_is_decided_by_the_trace_however_the_multipliers_are_rounded():
    for amplitude in np.linspace(0.5, 24.0, 20):
        mode, orbit = undamped(float(amplitude))
        assert orbit.stability == mode.stability == "neutral"
        for size in (1.0 - 1e-13, 1.0 + 1e-13):
            off = attrs.evolve(orbit, multipliers=tuple(size * value for value in orbit.multipliers))
            assert off.stability == "neutral"


def test_with_losses_the_three_agree_with_the_multipliers():
    for amplitude in (1.5, 5.0, 15.0, 19.0, 19.2, 25.0):
        for mode in rk.theory.symmetric_modes(amplitude, 1.0, 0.8, 1):
            inside = abs(mode.multipliers[0]) < 1.0
            assert mode.stable == inside
            if mode.admissible:
                orbit = rk.find_orbit(mode.system, mode.start, 1)
                assert (orbit.stability, orbit.stable) == (mode.stability, inside)


def test_the_summary_of_found_orbits_counts_neutral_ones():
    orbits = rk.find_orbits(system_of(2.0, 1.0, 1.0), 1)
    neutral = sum(orbit.stability == "neutral" for orbit in orbits)
    assert neutral > 0
    assert f"0 of them stable, {neutral} neutral," in str(orbits)


def test_pictures_draw_neutral_orbits_in_a_look_of_their_own():
    branch = rk.continue_orbit(undamped(2.0)[1], "amplitude", (1.0, 40.0))
    ax = rk.plot.branch(branch)
    texts = [text.get_text() for text in ax.get_legend().get_texts()]
    assert texts[:2] == ["symmetric, neutral", "symmetric, unstable"]
    looks = {line.get_gid(): line._unscaled_dash_pattern for line in ax.lines if line.get_gid() in texts}
    assert len({str(look) for look in looks.values()}) == 2
    first, *_ = rk.plot.modes(1.0, 1.0).get_legend().get_texts()
    assert first.get_text() == "neutral"
