"""A branch turns where it meets the branch from which it bifurcates: the point has the kind and the orbit of that branch."""

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.orbits.special_points import distinct

STEPS = (0.05, 0.01, 0.003)


def forced(amplitude, period=2.0, critical_angle=None):
    return rk.System(rk.Harmonic(amplitude, period=period), 0.8, critical_angle=critical_angle)


def bifurcation(kind):
    """The symmetry breaking of the (1, 1) orbit at T = 2, or the first period doubling of the orbits that emerge there."""
    symmetric = rk.continue_orbit(rk.classify(forced(5.0)).orbit, "amplitude", (4.5, 9.0))
    (breaking,) = (point for point in symmetric.special if point.kind == "symmetry-breaking")
    if kind == "symmetry-breaking":
        return breaking
    born = rk.switch_branch(breaking, (4.5, 9.0))[0]
    return next(point for point in born.special if point.kind == "period-doubling")


def distance(orbit, turns):
    """Distance of an orbit from itself some half periods later, mirrored if their number is odd."""
    here, later = orbit.at(1.0), orbit.at(1.0 + turns * np.pi)
    sign = -1.0 if turns % 2 else 1.0
    return np.hypot(here.angle - sign * later.angle, here.velocity - sign * later.velocity)


def near(branch, special):
    return [point for point in branch.special if abs(point.parameter / special.parameter - 1.0) < 1e-4]


@pytest.mark.parametrize("kind, turns", [("symmetry-breaking", 1), ("period-doubling", 2)])
def test_a_branch_names_the_bifurcation_from_which_it_comes_once_from_every_start_and_step(kind, turns):
    special = bifurcation(kind)
    born = rk.switch_branch(special, (4.5, 9.0))[0]
    assert not near(born, special)  # it begins there
    for index in (1, 2, 3, 5, 8, len(born) // 2):
        orbit = born.orbit(index)
        assert distance(orbit, turns) > 1e-3
        for step in STEPS:
            branch = rk.continue_orbit(orbit, "amplitude", (4.5, 9.0), step)
            (found,) = near(branch, special)
            assert found.kind == kind
            assert found.parameter == pytest.approx(special.parameter, rel=1e-11)
            assert (found.orbit.period, found.orbit.symmetric) == (special.orbit.period, kind[0] == "s")
            assert distance(found.orbit, turns) < 1e-12
            values = branch.points["parameter"][[max(found.index - 1, 0), min(found.index, len(branch) - 1)]]
            assert (values >= found.parameter - 1e-7).all()


@pytest.mark.parametrize("kind", ["symmetry-breaking", "period-doubling"])
def test_the_other_branches_and_the_curve_start_there_as_from_the_other_branch(kind):
    special = bifurcation(kind)
    born = rk.switch_branch(special, (4.5, 9.0))[0]
    (found,) = near(rk.continue_orbit(born.orbit(5), "amplitude", (4.5, 9.0)), special)
    again = rk.switch_branch(found, (4.5, 9.0))
    assert len(again) == (2 if kind == "symmetry-breaking" else 1)
    assert {branch.period for branch in again} == {born.period}
    peaks = [max(orbit.motion().peak for orbit in branch.at(born.points["parameter"][5])) for branch in again]
    assert peaks[0] == pytest.approx(born.points["peak"][5], rel=1e-9)
    ranges = ((1.9, 2.1), (4.5, 9.0))
    curves = [rk.bifurcation_curve(point, "period", "amplitude", ranges) for point in (special, found)]
    assert curves[0].kind == curves[1].kind == kind
    assert curves[0].period == curves[1].period == special.orbit.period
    np.testing.assert_allclose(curves[0].points[[0, -1]], curves[1].points[[0, -1]], rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["symmetry-breaking", "period-doubling"])
def test_a_branch_that_comes_back_lists_each_special_point_once(kind):
    """It passes the others again, with mirror images of their orbits or with the same orbits some cycles later."""
    born = rk.switch_branch(bifurcation(kind), (4.5, 9.0))[0]
    whole = rk.continue_orbit(born.orbit(5), "amplitude", (4.5, 9.0))
    there = [point for point in whole.special if near_any(born, point)]
    assert len(born.special) > 0
    assert sorted(point.kind for point in there) == sorted(point.kind for point in born.special)
    for point in born.special:
        assert len(near(whole, point)) == 1
    # the picture shows both passages
    drawn = [point for point in whole._passages if near_any(born, point)]
    assert len(drawn) == 2 * len(born.special)


def near_any(branch, point):
    return bool(near(branch, point))


def test_two_special_points_at_one_value_with_other_orbits_are_both_listed():
    """All events of both orbits are compared."""
    found = rk.continue_orbit(rk.classify(forced(5.0)).orbit, "amplitude", (4.5, 9.0)).special[0]
    moved = found._row.copy()
    moved[0] += 1e-3
    other = attrs.evolve(found, row=moved)
    assert distinct([found, other]) == (found, other)
    assert distinct([found, found]) == (found,)


def test_a_fold_of_asymmetric_orbits_remains_a_fold():
    orbit = rk.classify(
        rk.System(rk.Harmonic(amplitude=5.5, period=0.5, phase=1.8), 0.925), rk.State(velocity=0.15)
    ).orbit
    branch = rk.continue_orbit(orbit, "amplitude", (5.3, 5.6))
    (fold,) = (point for point in branch.special if point.kind == "fold")
    assert not fold.orbit.symmetric
    assert fold.orbit.period == 10


def test_an_orbit_of_the_full_block_of_twice_the_period_turns_at_the_period_doubling():
    orbit = rk.classify(forced(7.52, critical_angle=0.02)).orbit
    assert orbit.period == 2
    (found, *others) = rk.continue_orbit(orbit, "amplitude", (7.4, 7.6)).special
    assert not others
    assert (found.kind, found.orbit.period, found.orbit.symmetric) == ("period-doubling", 1, False)
    assert found.orbit.multipliers[0] == pytest.approx(-1.0, abs=1e-5)


def test_the_full_block_at_a_symmetry_breaking_has_a_symmetric_orbit():
    orbit = rk.classify(forced(6.0, critical_angle=0.02)).orbit
    assert not orbit.symmetric
    (found,) = rk.continue_orbit(orbit, "amplitude", (5.0, 6.2)).special
    assert found.kind == "symmetry-breaking"
    assert found.orbit.symmetric
    assert distance(found.orbit, 1) < 1e-8
