"""The other branch at a grazing, against a search for all orbits on both sides of it."""

import math

import numpy as np
import pytest

import rocking as rk

RANGE = (0.5, 15.0)
FREE = rk.System(rk.Harmonic(amplitude=2.2, period=2.0), restitution=0.91)
TIGHT = rk.System(
    rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8, braces=rk.Braces(angle=0.3, restitution=0.7)
)
WIDE = rk.System(
    rk.Harmonic(amplitude=3.4, period=2.3), restitution=0.84, braces=rk.Braces(angle=0.3, restitution=0.4)
)
SYSTEMS = TIGHT, WIDE, FREE
GAP, NEAR = 1e-3, 1.5e-3
PERSISTS, MEETS = "grazing: the orbit persists", "grazing: two orbits meet, as at a fold"


def grazings(system, period=2, most=12):
    """Special points of all branches of orbits that a search finds, each once, with its branch."""
    met = {}
    for orbit in rk.find_orbits(system, period).orbits[:most]:
        if orbit.impacts or orbit.brace_hits:
            branch = rk.continue_orbit(orbit, "amplitude", RANGE)
            for special in branch.special:
                if special.kind == "grazing":
                    met[branch.impacts, branch.brace_hits, round(special.parameter, 6)] = branch, special
    return list(met.values())


@pytest.fixture(scope="module")
def crossed():
    """Provide the grazings with their branch and the other one, of three systems."""
    return [
        (branch, special, other)
        for system in SYSTEMS
        for branch, special in grazings(system)
        for other in rk.switch_branch(special, RANGE)
    ]


def distance(orbit, special):
    """Distance of an orbit from the grazing orbit, at the phase of the latter, in the cycle in which it is least."""
    near, phase = special.orbit.state, special.orbit.phase
    states = [orbit.at(phase + math.tau * k) for k in range(orbit.period)]
    return min(math.hypot(one.angle - near.angle, one.velocity - near.velocity) for one in states)


def test_the_other_branch_has_one_contact_more_or_less(crossed):
    assert len({special.orbit.system.forcing.period for _, special, _ in crossed}) == len(SYSTEMS)
    for branch, special, other in crossed:
        repeated = branch.period // other.period
        more = (
            repeated * other.impacts - branch.impacts,
            repeated * other.brace_hits - branch.brace_hits,
        )
        times = 2 if branch.symmetric else 1
        assert (abs(more[0]), abs(more[1])) in ((2 * times, 0), (0, times))
        assert abs(other.points["parameter"][0] - special.parameter) < 0.02
        assert distance(other.orbit(0), special) < 0.1


def test_orbits_of_the_other_branch_are_motions(crossed):
    for _, _, other in crossed:
        # not at the ends, where rounding decides if a contact occurs
        for index in np.linspace(0, len(other) - 1, 5)[1:-1].astype(int):
            orbit = other.orbit(int(index))
            events = [event for event in orbit._events if event.before != 0.0]
            assert orbit.residual < 1e-6 * max(1.0, abs(orbit.multipliers[0]))
            assert len(events) == other.impacts + other.brace_hits
            if orbit.stability == "stable":
                found = rk.find_orbit(orbit.system, orbit.start, orbit.period)
                assert (found.period, found.symmetric) == (other.period, other.symmetric)


def test_both_branches_at_a_fold_lie_on_one_side_and_else_on_both(crossed):
    kinds = set()
    for branch, special, other in crossed:
        # beyond its own bends a branch may lie anywhere, so that the points next to the grazing count
        inner = 1 if special.index <= 1 else len(branch) - 2
        sides = (
            np.sign(points["parameter"][index] - special.parameter)
            for points, index in ((branch.points, inner), (other.points, 0))
        )
        kinds.add(other.ends[0])
        assert other.ends[0] == (MEETS if len(set(sides)) == 1 else PERSISTS)
    assert kinds == {MEETS, PERSISTS}


def beside(special, gap, counts):
    """Return whether a search finds an orbit with these numbers of contacts near the grazing orbit, at another amplitude."""
    system = special.orbit.system
    forcing = rk.Harmonic(special.parameter + gap, period=system.forcing.period)
    found = rk.find_orbits(rk.System(forcing, system.restitution, system.braces), special.orbit.period).orbits
    return any(
        (orbit.impacts, orbit.brace_hits) == counts and distance(orbit, special) < NEAR for orbit in found
    )


def is_met(branch, special, gap):
    """Return whether Newton's method on the return map, from near an orbit of a branch beside a grazing, leads to it."""
    for orbit in branch.at(special.parameter + gap):
        found = rk.find_orbit(orbit.system, orbit.start, orbit.period)
        if (found.impacts, found.brace_hits) == (branch.impacts, branch.brace_hits):
            return True
    return False


def test_the_orbit_that_persists_exists_on_both_sides(crossed):
    checked = 0
    for branch, special, other in crossed:
        if other.ends[0] == PERSISTS:
            side = np.sign(other.points["parameter"][0] - special.parameter)
            counts = (branch.impacts, branch.brace_hits), (other.impacts, other.brace_hits)
            assert not beside(special, GAP * side, counts[0])
            assert not beside(special, -GAP * side, counts[1])
            assert is_met(branch, special, -GAP * side)
            assert is_met(other, special, GAP * side)
            checked += 1
    assert checked


@pytest.mark.long
def test_a_search_finds_no_orbit_beyond_a_grazing_where_two_meet(crossed):
    checked = 0
    for branch, special, other in crossed:
        if other.ends[0] == MEETS:
            beyond = -np.sign(other.points["parameter"][0] - special.parameter)
            for counts in ((branch.impacts, branch.brace_hits), (other.impacts, other.brace_hits)):
                assert not beside(special, GAP * beyond, counts)
            checked += 1
    assert checked
