"""Orbits found, compared with random initial states, closed forms, a larger search and extended precision."""

import math

import mpmath
import numpy as np
import pytest
from attrs import evolve

import rocking as rk
from oracles.modes import symmetric_modes

SYSTEM = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)


@pytest.fixture(scope="module")
def orbits():
    return rk.find_orbits(SYSTEM, 7)


def impacts_of(orbit):
    """Return the forcing phase mod 2π and the speed just after every impact in a period."""
    forcing = rk.Harmonic(
        amplitude=orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=orbit.phase
    )
    there = rk.System(forcing, orbit.system.restitution)
    events = rk.simulate(there, orbit.state, cycles=orbit.period).events
    return (orbit.phase + forcing.frequency * events["time"]) % (2 * math.pi), events["after"]


def section_of(orbit, phase=1.0):
    """All its states at one phase of the forcing."""
    forcing = rk.Harmonic(
        amplitude=orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=orbit.phase
    )
    motion = rk.simulate(rk.System(forcing, orbit.system.restitution), orbit.state, cycles=orbit.period + 1)
    first = (phase - orbit.phase) % (2 * math.pi) / forcing.frequency
    return np.column_stack(motion.at(first + forcing.period * np.arange(orbit.period)))


def distances(orbits, orbit):
    """Return the least distance of each orbit of the same period from an orbit."""
    here = section_of(orbit)
    return [
        np.hypot(*(section_of(other)[:, None] - here[0]).T).min()
        for other in orbits
        if other.period == orbit.period
    ]


@pytest.mark.long
def test_every_attractor_that_random_starts_reach_is_in_the_list(orbits, thin):
    random, reached = np.random.default_rng(1991), {}
    for _ in range(10_000):
        verdict = rk.classify(SYSTEM, rk.State(random.uniform(-1.2, 1.2), random.uniform(-1.5, 1.5)))
        if verdict.kind == "periodic" and verdict.period <= 7:
            key = verdict.period, verdict.impacts_per_period, verdict.symmetric
            reached.setdefault(key, []).append(verdict.orbit)
    assert len(reached) >= 4
    for found in reached.values():
        for orbit in thin(found, 5):
            assert min(distances(orbits, orbit)) <= 1e-8


@pytest.mark.parametrize("n", [1, 3, 5, 7])
def test_every_admissible_symmetric_mode_is_in_the_list(orbits, n):
    expected = [mode for mode in symmetric_modes(5.5, 0.5, 0.925, n) if is_admissible(mode, n)]
    found = [orbit for orbit in orbits if orbit.symmetric and orbit.period == n and orbit.impacts == 2]
    speeds = sorted(abs(impacts_of(orbit)[1][0]) for orbit in found)
    assert speeds == pytest.approx(sorted(mode.velocity for mode in expected), abs=1e-10)
    if n in (5, 7):  # the lower ones, unstable
        assert speeds[0] == pytest.approx({5: 0.11621, 7: 0.26891}[n], abs=5e-6)


def is_admissible(mode, n):
    """Return whether the block stays on its side for half a period, by dense samples of eq. (5)."""
    frequency = 2 * math.pi / 0.5
    beta = 5.5 / (1 + frequency**2)
    t = np.linspace(0, n * 0.25, 100_001)[1:-1]
    swing = np.cos(mode.phase + frequency * t) - math.cos(mode.phase) * np.cosh(t)
    swing += frequency * math.sin(mode.phase) * np.sinh(t)
    return bool((mode.velocity * np.sinh(t) - (np.cosh(t) - 1) + beta * swing > 0).all())


def test_what_is_printed_says_that_completeness_is_not_guaranteed(orbits):
    assert str(orbits).endswith(" guesses; completeness is not guaranteed")


def test_other_starts_and_twice_the_effort_find_nothing_new(orbits):
    again = rk.find_orbits(SYSTEM, 7, effort=2.0, seed=20_000)
    assert orbits.settled
    assert again.settled
    assert len(again) == len(orbits)
    for orbit in again:
        assert min(distances(orbits, orbit)) <= 1e-8


def test_the_saddles_that_never_meet_the_base_are_in_the_list(orbits):
    beta = 5.5 / (1 + (4 * math.pi) ** 2)
    saddles = [orbit for orbit in orbits if orbit.impacts == 0]
    centres = sorted(orbit.state.angle - beta * math.cos(orbit.phase) for orbit in saddles)
    assert centres == pytest.approx([-1.0, 1.0], abs=1e-12)
    assert all(orbit.multipliers[0] == pytest.approx(math.exp(0.5), abs=1e-12) for orbit in saddles)


def test_everything_found_returns_to_where_it_began():
    """Here a search on a map that missed an impact once took a motion for an orbit that ends 0.34 from its start."""
    system = rk.System(
        rk.Harmonic(amplitude=15.69553730289302, period=0.5638456749292959), restitution=0.8369619462158872
    )
    found = rk.find_orbits(system, 5, effort=0.5)
    assert len(found) == 3
    for orbit in found:
        there = rk.System(evolve(system.forcing, phase=orbit.phase), system.restitution)
        final = rk.simulate(there, orbit.state, cycles=orbit.period).final
        assert math.hypot(final.angle - orbit.state.angle, final.velocity - orbit.state.velocity) <= 1e-12


def precise_map(orbit, angle, velocity):
    """The state a period later, in 40 digits, from the orbit's sequence of impacts, by eq. (5) alone."""
    forcing, restitution = orbit.system.forcing, mpmath.mpf(orbit.system.restitution)
    period, amplitude = mpmath.mpf(forcing.period), mpmath.mpf(forcing.amplitude)
    frequency = 2 * mpmath.pi / period
    beta, psi = amplitude / (1 + frequency**2), mpmath.mpf(orbit.phase)
    events = rk.simulate(
        rk.System(
            rk.Harmonic(amplitude=forcing.amplitude, period=forcing.period, phase=orbit.phase),
            orbit.system.restitution,
        ),
        orbit.state,
        cycles=orbit.period,
    ).events
    now = mpmath.mpf(0)
    side = mpmath.sign(angle)
    for time in [*events["time"], None]:
        start, u, v, place = psi + frequency * now, side * angle, side * velocity, side

        def at(t, start=start, u=u, v=v, place=place):
            swing, spin = place * beta * mpmath.cos(start), place * beta * frequency * mpmath.sin(start)
            later = start + frequency * t
            cosh, sinh = mpmath.cosh(t), mpmath.sinh(t)
            where = (u - 1 - swing) * cosh + (v + spin) * sinh + 1 + place * beta * mpmath.cos(later)
            rate = (u - 1 - swing) * sinh + (v + spin) * cosh - place * beta * frequency * mpmath.sin(later)
            return where, rate

        if time is None:
            where, rate = at(orbit.period * period - now)
            return side * where, side * rate
        wait = mpmath.findroot(lambda t, at=at: at(t)[0], mpmath.mpf(float(time)) - now)
        angle, velocity = mpmath.mpf(0), side * at(wait)[1] * restitution
        now += wait
        side = -side
    raise AssertionError


@pytest.mark.parametrize("index", range(9))
def test_multipliers_match_differences_in_forty_digits(orbits, index):
    orbit = orbits[index]
    with mpmath.workdps(40):
        step = mpmath.mpf(10) ** -12
        columns = []
        for a, v in ((step, 0), (0, step)):
            more = precise_map(orbit, orbit.state.angle + a, orbit.state.velocity + v)
            less = precise_map(orbit, orbit.state.angle - a, orbit.state.velocity - v)
            columns.append([(x - y) / (2 * step) for x, y in zip(more, less, strict=True)])
        trace = columns[0][0] + columns[1][1]
        determinant = columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0]
    one, other = orbit.multipliers
    scale = max(1.0, abs(one))
    assert float(trace) == pytest.approx((one + other).real, abs=1e-10 * scale)
    assert float(determinant) == pytest.approx((one * other).real, abs=1e-10 * scale)


def derivative_of(orbit, step=1e-6):
    """Differences of the return map over a period."""
    begun = evolve(orbit.system, forcing=evolve(orbit.system.forcing, phase=orbit.phase))
    columns = []
    for angle, velocity in ((step, 0.0), (0.0, step)):
        ends = [
            rk.simulate(
                begun,
                rk.State(orbit.state.angle + sign * angle, orbit.state.velocity + sign * velocity),
                cycles=orbit.period,
            ).final
            for sign in (1.0, -1.0)
        ]
        columns.append([(ends[0].angle - ends[1].angle), (ends[0].velocity - ends[1].velocity)])
    return np.array(columns).T / (2.0 * step)


@pytest.mark.parametrize(
    "system",
    [
        rk.System(rk.Harmonic(amplitude=8.0, period=2.0), 0.0),
        rk.System(
            rk.Harmonic(amplitude=2.5838043644402964, period=1.37517120435794),
            0.99,
            rk.Braces(angle=0.2864545540060415, restitution=0.0),
        ),
    ],
    ids=["base", "braces"],
)
def test_multipliers_where_an_impact_takes_all_speed(system):
    """After such an impact, a perturbed motion differs only in the phase of the impact, so that one multiplier is 0."""
    lost = [each for each in rk.find_orbits(system, 1) if each.impacts and not each.superstable]
    lost = [each for each in lost if system.restitution == 0.0 or each.brace_hits]
    assert len(lost) >= 2
    for orbit in lost:
        first = np.trace(derivative_of(orbit))
        assert orbit.multipliers == (pytest.approx(first, rel=1e-6), 0.0)
        assert orbit.stable == (abs(first) < 1.0)
    assert system.restitution == 0.0 or any(orbit.stable for orbit in lost)
