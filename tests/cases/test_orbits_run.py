"""Simulation of periodic orbits: from their initial state, at any phase, in the user's system; stability at e = 1."""

import math

import attrs
import mpmath
import numpy as np
import pytest

import rocking as rk
from rocking.model.orbit import Stability


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


LONGER = [
    system_of(6.5, 0.4, 0.925, phase=2.5),
    system_of(3.0, 1.0, 0.9, braces=rk.Braces(0.5, 0.8)),
    attrs.evolve(system_of(6.5, 0.4, 0.925), critical_angle=0.1),
]


@pytest.mark.parametrize("system", LONGER)
def test_an_orbit_found_near_a_state_starts_there_in_whichever_cycle(system):
    """The orbit has the same states after that, and returns to its start."""
    orbit = rk.classify(system).orbit
    assert orbit.period > 1
    for cycle in range(orbit.period):
        turned = 2.0 * math.pi * cycle
        guess = orbit.at(system.forcing.phase + turned)
        again = rk.find_orbit(system, rk.State(guess.angle + 1e-7, guess.velocity), orbit.period)
        for later in (0.0, 0.7, 4.0, 9.0):
            phase = system.forcing.phase + later
            assert apart(again.at(phase), orbit.at(phase + turned)) < 1e-10
        assert again.residual < 1e-12
        assert apart(rk.simulate(system, again.start, cycles=orbit.period).final, again.start) < 1e-10


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
    # an even number of phases: the middle of the period is an impact, at which both states are right
    for turned in np.linspace(0.01, 2 * math.pi * orbit.period - 0.01, 30):
        state = orbit.at(forcing.phase + turned)
        expected = motion.at(turned / forcing.frequency)
        np.testing.assert_allclose((state.angle, state.velocity), expected, rtol=0, atol=1e-12)
        assert apart(state, orbit.at(forcing.phase + turned - 2 * math.pi * orbit.period)) < 1e-12


@pytest.mark.parametrize(
    "system, period",
    [(SYSTEM, 2), (SYSTEMS[4], 2), (system_of(15.0, 2.0, 0.925, phase=2.0, braces=rk.Braces(1.0, 0.5)), 2)],
)
def test_states_of_found_orbits_are_those_of_a_run(system, period):
    """A run multiplies rounding by the multiplier."""
    forcing = system.forcing
    orbits = [orbit for orbit in rk.find_orbits(system, period, effort=0.1) if not orbit.superstable]
    assert len(orbits) >= 3
    for orbit in orbits:
        reach = 1e-13 * max(abs(orbit.multipliers[0]), 1.0)
        motion = rk.simulate(system, orbit.start, cycles=orbit.period + 1)
        for turned in np.linspace(0.01, 2 * math.pi * orbit.period - 0.01, 29):
            state = orbit.at(forcing.phase + turned)
            expected = motion.at(turned / forcing.frequency)
            np.testing.assert_allclose((state.angle, state.velocity), expected, rtol=0, atol=reach)


def exact_mode(amplitude, period, restitution, phase):
    """The (1, 1) mode near a phase of impact as a boundary-value problem in forty digits: its (Θ, Θ') at a forcing phase.

    Between impacts Θ = 1 + β cos ψ + a e^(−t) + c e^(t − T/2) on the upper side, with Θ = 0 at both ends.
    """
    with mpmath.workdps(40):
        frequency, half = 2 * mpmath.pi / period, mpmath.mpf(period) / 2
        beta, decay = amplitude / (1 + frequency**2), mpmath.exp(-half)

    def shares(psi):
        first, last = -1 - beta * mpmath.cos(psi), -1 + beta * mpmath.cos(psi)
        return (first - decay * last) / (1 - decay**2), (last - decay * first) / (1 - decay**2)

    def missed(psi):
        (a, c), swing = shares(psi), beta * frequency * mpmath.sin(psi)
        return (c * decay - a - swing) + mpmath.mpf(restitution) * (c - a * decay + swing)

    with mpmath.workdps(40):
        phase = mpmath.findroot(missed, phase)
        a, c = shares(phase)

    def state(psi):
        with mpmath.workdps(40):
            turns, time = divmod((mpmath.mpf(psi) - phase) / frequency, half)
            psi, side = phase + frequency * time, (-1) ** int(turns)
            out, back = a * mpmath.exp(-time), c * mpmath.exp(time - half)
            angle = 1 + beta * mpmath.cos(psi) + out + back
            return float(side * angle), float(side * (back - out - beta * frequency * mpmath.sin(psi)))

    return state


@pytest.mark.parametrize("period, error", [(16.0, 1e-12), (20.0, 1e-11), (28.0, 1e-8)])
def test_an_orbit_that_a_run_leaves_within_a_period_has_its_own_states(period, error):
    """Its multipliers are 2·10⁶, 8·10⁷ and 2·10¹¹; the last is left so far that a run from its start overturns.

    Its events are solved to what rounding makes of half a period, e^(T/2), and they bound its states.
    """
    short = rk.theory.symmetric_modes(3.0, 8.0, 0.9, 1)[0]
    branch = rk.continue_orbit(rk.find_orbit(short.system, short.start, 1), "period", (7.9, period + 1.0))
    (orbit,) = branch.at(period)
    (mode,) = [one for one in rk.theory.symmetric_modes(3.0, period, 0.9, 1) if one.admissible]
    exact = exact_mode(3.0, period, 0.9, mode.phase)
    for phase in mode.phase + np.linspace(0.05, 0.05 + 2 * math.pi, 41):
        state = orbit.at(float(phase))
        np.testing.assert_allclose((state.angle, state.velocity), exact(phase), rtol=0, atol=error)


@pytest.mark.parametrize("braces", [None, rk.Braces(3.0, 0.9)])
def test_a_saddle_orbit_without_events_has_its_own_states(braces):
    """Θ = 1 + β cos ψ, with a multiplier of e^18."""
    beta = 0.5 / (1.0 + (2 * math.pi / 18.0) ** 2)
    orbit = rk.find_orbit(system_of(0.5, 18.0, 0.9, braces=braces), rk.State(angle=1.0 + beta), 1)
    assert (orbit.impacts, orbit.brace_hits) == (0, 0)
    for phase in np.linspace(0.0, 6.2, 13):
        assert orbit.at(float(phase)).angle == pytest.approx(1.0 + beta * math.cos(phase), abs=1e-13)


def test_every_found_orbit_was_met_once_at_least_and_its_mirror_image_as_often():
    system = system_of(2.0, 3.0, 0.9)
    orbits = rk.find_orbits(system, 5, effort=0.1)
    assert max(abs(orbit.multipliers[0]) for orbit in orbits) > 1e7
    assert min(orbits.hits) >= 1
    assert sum(not orbit.symmetric for orbit in orbits) >= 10
    for orbit, number in zip(orbits, orbits.hits, strict=True):
        if not orbit.symmetric:
            pairs = zip(orbits, orbits.hits, strict=True)
            assert [other for one, other in pairs if is_mirror_image(one, orbit)] == [number]


def is_mirror_image(other, orbit):
    """Return whether an orbit reaches the mirror image of the other's initial state after a half-odd number of cycles."""
    phase = orbit.system.forcing.phase
    states = (orbit.at(phase + math.pi * (2 * cycle + 1)) for cycle in range(orbit.period))
    return other.period == orbit.period and any(
        apart(other.start, rk.State(-state.angle, -state.velocity)) < 1e-7 for state in states
    )


@pytest.mark.long
def test_orbits_too_unstable_to_follow_are_left_out_and_none_is_listed_twice():
    """A run from the start of one of period 12 overturns before its period is over."""
    system = system_of(8.0, 1.72, 0.8)
    orbits = rk.find_orbits(system, 12, effort=0.2)
    assert min(orbits.hits) >= 1
    for orbit in orbits:
        phases = system.forcing.phase + 2 * math.pi * np.arange(orbit.period)
        states = [orbit.at(float(phase)) for phase in phases]
        same = [one for one in orbits if min(apart(one.start, state) for state in states) < 1e-10]
        assert same == [orbit]


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
    assert mode.stability == orbit.stability == Stability.NEUTRAL
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


def test_a_range_of_one_value_is_written_as_one():
    orbit = rk.classify(rk.System(rk.Harmonic(2.0, period=1.0), 0.95)).orbit
    branch = rk.continue_orbit(orbit, "restitution", (0.9, 1.0))
    assert ", neutral at 1: " in str(branch)


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
