"""Branches of orbits that rest or lean, against marching and against motions on both sides of their special points and ends."""

import math

import numpy as np
import pytest

import rocking as rk

SYSTEMS = {
    "asymmetric": (rk.System(rk.Harmonic(amplitude=1.198, period=5.08), restitution=0.153), "rest"),
    "symmetric": (rk.System(rk.Harmonic(amplitude=1.05, period=4.917), restitution=0.83), "rest"),
    "braced": (
        rk.System(
            rk.Harmonic(amplitude=2.376871884740385, period=4.713572890481674),
            restitution=0.35969059901740746,
            braces=rk.Braces(angle=0.6322640173073172, restitution=0.17697531579491135),
        ),
        "lean",
    ),
    "full": (
        rk.System(rk.Harmonic(amplitude=1.1, period=4.0), restitution=0.3, critical_angle=0.25),
        "rest",
    ),
}


@pytest.fixture(scope="module")
def branches():
    """Branches over the amplitude, from 0.9 to 1.5 times that of the system."""
    return {name: followed(system) for name, (system, _) in SYSTEMS.items()}


def followed(system):
    amplitude = system.forcing.amplitude
    orbit = rk.classify(system).orbit
    assert orbit.superstable
    return rk.continue_orbit(orbit, "amplitude", (0.9 * amplitude, 1.5 * amplitude))


def at_amplitude(system, amplitude):
    forcing = rk.Harmonic(amplitude, period=system.forcing.period, phase=system.forcing.phase)
    return rk.System(forcing, system.restitution, system.braces, critical_angle=system.critical_angle)


def counts_of(system, kind, start, cycles=60):
    """Numbers of events of a kind in each of the last 20 cycles of a motion."""
    events = rk.simulate(system, start, cycles=cycles).events
    found = events["cycle"][events["kind"] == kind]
    return np.bincount(found, minlength=cycles + 1)[cycles - 20 : cycles]


@pytest.mark.parametrize("name", SYSTEMS)
def test_points_are_the_orbits_that_marching_reaches(name, branches):
    system, kind = SYSTEMS[name]
    branch = branches[name]
    assert len(branch) > 4
    for index in np.linspace(1, len(branch) - 2, 7).astype(int):
        orbit = branch.orbit(index)
        assert orbit.superstable
        assert orbit.residual == 0.0
        marched = rk.simulate(at_amplitude(system, branch.points["parameter"][index]), orbit.start, cycles=20)
        assert (marched.events["kind"] == kind).sum() >= 20
        assert branch.points["peak"][index] == pytest.approx(marched.peak, rel=1e-9)
        assert branch.symmetric == orbit.symmetric


@pytest.mark.parametrize("name", SYSTEMS)
def test_rests_and_contacts_end_where_the_branch_ends(name, branches):
    system, kind = SYSTEMS[name]
    branch = branches[name]
    checked = 0
    for end, index, outwards in zip(branch.ends, (0, -1), (-1.0, 1.0), strict=True):
        if "begins or ends" not in end:
            continue
        checked += 1
        limit, start = branch.points["parameter"][index], branch.orbit(index).start
        inside, outside = (
            at_amplitude(system, limit * (1.0 + sign * 1e-7)) for sign in (-outwards, outwards)
        )
        assert (counts_of(inside, kind, start) > 0).all()
        assert (counts_of(outside, kind, start) == 0).all()
    assert checked


@pytest.mark.parametrize(("name", "lift_off"), [("symmetric", 1.0), ("full", math.tan(0.25) / 0.25)])
def test_where_the_block_no_longer_lifts_off_the_acceleration_is_that_of_lift_off(name, lift_off, branches):
    branch = branches[name]
    assert branch.ends[0] == "the block no longer lifts off"
    assert branch.points["parameter"][0] == pytest.approx(lift_off, abs=1e-6)


def least_height(system, start, cycles=4):
    """Least |Θ| at an instant of a motion in which |Θ| has a minimum and the block does not touch the base."""
    motion = rk.simulate(system, start, cycles=cycles)
    times = np.linspace(0.0, motion.duration, 400_001)
    angle = np.abs(motion.at(times)[0])
    inner = (angle[1:-1] < angle[:-2]) & (angle[1:-1] < angle[2:]) & (angle[1:-1] > 0.0)
    near = np.searchsorted(motion.events["time"], times[1:-1])
    quiet = near == np.searchsorted(motion.events["time"], times[2:])
    quiet &= near == np.searchsorted(motion.events["time"], times[:-2])
    return angle[1:-1][inner & quiet].min()


def test_at_a_grazing_the_branch_goes_on_with_an_impact_more(branches):
    system, _ = SYSTEMS["asymmetric"]
    branch = branches["asymmetric"]
    (special,) = branch.special
    assert special.kind == "grazing"
    assert 0 < special.index < len(branch)
    above = [
        least_height(at_amplitude(system, special.parameter * (1.0 + gap)), special.orbit.start)
        for gap in (4e-5, 2e-5, 1e-5)
    ]
    below = [
        slowest_return(at_amplitude(system, special.parameter * (1.0 - gap)), special.orbit.start)
        for gap in (4e-5, 1e-5)
    ]
    # the height vanishes linearly; the speed of the new impact as the root of the distance
    assert above[0] / above[1] == pytest.approx(2.0, rel=0.05)
    assert above[1] / above[2] == pytest.approx(2.0, rel=0.05)
    assert below[0] / below[1] == pytest.approx(2.0, rel=0.05)
    assert below[1] < 1e-4


GRAZED_TWICE = {
    "at rest": rk.System(rk.Harmonic(1.154, period=4.43), 0.433),
    "in contact": rk.System(rk.Harmonic(1.8, period=5.6), 0.4, rk.Braces(0.05, 0.3)),
}


@pytest.mark.parametrize("name", GRAZED_TWICE)
def test_at_a_grazing_of_both_halves_the_branch_stays_symmetric(name):
    """Near it the halves differ by the root of a rounding error, which must not count as asymmetric."""
    system = GRAZED_TWICE[name]
    branch = followed(system)
    (special,) = branch.special
    assert (branch.symmetric, special.kind) == (True, "grazing")
    assert 10 < special.index < len(branch) - 10
    assert not any("grazing" in end for end in branch.ends)
    half = 0.5 * branch.period * system.forcing.period
    hits = []
    for gap in (-1e-6, 1e-6):
        beside = at_amplitude(system, special.parameter * (1.0 + gap))
        motion = rk.simulate(beside, special.orbit.start, cycles=6 * branch.period)
        times = np.linspace(0.5, 0.9, 1000) * motion.duration
        halves = np.array(motion.at(times)) + np.array(motion.at(times - half))
        assert np.abs(halves).max() < 1e-6
        since = motion.events[motion.events["time"] > motion.duration - 2.0 * half]
        hits.append(np.count_nonzero(np.isin(since["kind"], ("impact", "brace"))))
    more = abs(hits[1] - hits[0])
    assert more > 0
    assert more % 2 == 0  # the same number in both halves


def slowest_return(system, start):
    """Least speed of an impact that is slower than the next one, between two rests."""
    events = rk.simulate(system, start, cycles=4).events
    kinds, speeds = events["kind"], np.abs(events["after"])
    pairs = (kinds[:-1] == "impact") & (kinds[1:] == "impact")
    return speeds[:-1][pairs & (speeds[:-1] < speeds[1:])].min()


def test_a_branch_answers_like_others(branches):
    branch = branches["symmetric"]
    assert branch.impacts is None
    (orbit,) = branch.at(1.04)
    state = branch.section(0.5)[0, 0]
    assert orbit.system.forcing.amplitude == 1.04
    assert tuple(state) == pytest.approx((branch.orbit(0).at(0.5).angle, branch.orbit(0).at(0.5).velocity))
    dataset = branch.to_xarray()
    assert "impacts_per_period" not in dataset.attrs
    assert (dataset["stability"] == "stable").all()
    assert dataset["multiplier_1_real"].values.max() == 0.0


def test_curves_refuse_a_special_point_of_an_orbit_that_rests(branches):
    (special,) = branches["asymmetric"].special
    with pytest.raises(TypeError, match="special must be that of an orbit without rest"):
        rk.bifurcation_curve(special, "amplitude", "period", ((1.0, 2.0), (4.0, 6.0)))


BRACED_FULL = rk.System(
    rk.Harmonic(1.5727212769923467, period=7.302048535585846, phase=0.552762932163534),
    0.2935808219572348,
    rk.Braces(0.08846253729062294, 0.8025306001866487),
    critical_angle=0.421171178144032,
)
ALL_ENERGY_LOST = rk.System(rk.Harmonic(2.67416733942678, period=2.5087234306445483, phase=3.36), 0.0)
NEAR_LIFT_OFF = rk.System(rk.Harmonic(1.000207443525973, period=1.6442288534396587, phase=0.83), 0.56909889)


@pytest.mark.parametrize(
    ("system", "name", "bounds"),
    [
        (BRACED_FULL, "frequency", (0.4302344, 1.37675)),
        (ALL_ENERGY_LOST, "period", (1.2543617, 4.0139575)),
        (NEAR_LIFT_OFF, "amplitude", (0.4, 1.6)),
    ],
)
def test_ends_and_grazings_do_not_depend_on_the_step(system, name, bounds):
    orbit = rk.classify(system, max_cycles=2000).orbit
    first, *others = (rk.continue_orbit(orbit, name, bounds, step) for step in (0.01, 0.03, 0.0037))
    for branch in (first, *others):
        values = branch.points["parameter"]
        for special in branch.special:
            assert values[special.index - 1] <= special.parameter <= values[special.index]
    for other in others:
        # beyond an end the number of impacts changes ever faster
        assert [end.split(";")[0] for end in other.ends] == [end.split(";")[0] for end in first.ends]
        assert other.points["parameter"][[0, -1]] == pytest.approx(first.points["parameter"][[0, -1]])
        assert [one.parameter for one in other.special] == pytest.approx(
            [one.parameter for one in first.special]
        )


def test_multipliers_of_orbits_that_rest_are_not_drawn(branches):
    with pytest.raises(ValueError, match="quantity must be another one for orbits that rest"):
        rk.plot.branch(branches["symmetric"], quantity="multiplier")


def test_a_resting_orbit_can_be_followed_through_any_parameter():
    system, _ = SYSTEMS["full"]
    branch = rk.continue_orbit(rk.classify(system).orbit, "critical_angle", (0.05, 0.5))
    assert branch.ends == ("end of the range", "end of the range")
    peaks = branch.points["peak"]
    slender = rk.simulate(rk.System(system.forcing, system.restitution), cycles=10).peak
    assert np.all(np.diff(peaks) < 0.0)
    assert peaks[0] == pytest.approx(slender, rel=0.02)
