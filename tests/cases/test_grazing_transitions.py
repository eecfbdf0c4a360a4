"""Transitions at grazings, against marching and a search for all orbits on both sides."""

import math

import attrs
import numpy as np
import pytest

import rocking as rk

RANGE = (0.3, 20.0)
# System, longest period of the search, amplitude of the grazing, and the transition.
CASES = {
    "without braces": (
        rk.System(rk.Harmonic(2.82593463288986, period=0.49508359574607497), 0.799408571252575),
        3,
        9.293357930,
        ("fold", "jump", "periodic"),
    ),
    "braced": (
        rk.System(
            rk.Harmonic(7.990072682569841, period=1.4218208683790865),
            0.7897835206386242,
            rk.Braces(0.6919576445412059, 0.46378537319927376),
        ),
        1,
        10.469126104,
        ("persistence", "local", "chaotic"),
    ),
    "braced, chaos at once and far": (
        rk.System(
            rk.Harmonic(9.512169747803817, period=1.4537763724387962),
            0.6326840560551668,
            rk.Braces(1.145510065958529, 0.315327690175707),
        ),
        1,
        11.204919104,
        ("persistence", "jump", "chaotic"),
    ),
    "period 2": (
        rk.System(
            rk.Harmonic(8.54792734047576, period=2.666953517687347),
            0.47393954796646054,
            rk.Braces(1.0683653693789115, 0.6078326478947386),
        ),
        2,
        8.576411273,
        ("persistence", "local", "chaotic"),
    ),
}


def branches(system, longest, bounds=RANGE):
    """Branches of the orbits that a search finds, and those that bifurcate from them."""
    for orbit in rk.find_orbits(system, longest):
        if orbit.impacts or orbit.brace_hits:
            branch = rk.continue_orbit(orbit, "amplitude", bounds)
            yield branch
            for special in branch.special:
                if special.kind in ("symmetry-breaking", "period-doubling"):
                    yield from rk.switch_branch(special, bounds)


def grazing(system, longest, amplitude):
    """The grazing of a stable orbit at an amplitude, with its branch."""
    return next(
        (branch, special)
        for branch in branches(system, longest)
        for special in branch.special
        if special.kind == "grazing" and special.orbit.stable and abs(special.parameter - amplitude) < 1e-8
    )


@pytest.fixture(scope="module", params=CASES)
def case(request):
    system, longest, amplitude, wanted = CASES[request.param]
    branch, special = grazing(system, longest, amplitude)
    return branch, special, rk.grazing_transition(special), wanted


def at(special, gap):
    """The system at a relative distance beyond the grazing, negative before it, clocked at the section of the orbit."""
    system, orbit = special.orbit.system, special.orbit
    amplitude = special.parameter * (1.0 - gap * special._origin.side)
    forcing = rk.Harmonic(amplitude, period=system.forcing.period, phase=orbit.phase)
    return rk.System(forcing, system.restitution, system.braces)


def points(orbit, phase):
    """Points of an orbit on a section."""
    states = [orbit.at(phase + math.tau * cycle) for cycle in range(orbit.period)]
    return np.array([(state.angle, state.velocity) for state in states])


def apart(section, orbit):
    """Distance of each point of a section from an orbit."""
    here = points(orbit, orbit.phase)
    return np.min([np.hypot(*(section - point).T) for point in here], axis=0)


def test_transition_of_each_system(case):
    _, special, found, (orbits, kind, beyond) = case
    assert (found.orbits, found.kind, str(found.attractor.kind)) == (orbits, kind, beyond)
    assert found.special is special
    assert (np.diff(found.distances) < 0.0).all()
    if beyond == "chaotic":
        assert found.attractor.exponent > 6.0 * found.attractor.exponent_error > 0.0


def test_motions_stay_on_the_orbit_before_the_grazing_and_leave_it_beyond(case):
    branch, special, found, (_, kind, _) = case
    reach = {}
    for gap in (-1e-4, -1e-5, 1e-4, 1e-5):
        system, start = at(special, gap), special.orbit.state
        if gap < 0.0:  # other motions near the orbit may lie beyond the orbit that it meets
            phase, orbits = special.orbit.phase, branch.at(system.forcing.amplitude)
            own = min(orbits, key=lambda orbit: apart(points(orbit, phase), special.orbit).max())
            start = own.at(phase)
        motion = rk.simulate(system, start, cycles=30_000, record="section")
        reach[gap] = apart(motion.section()[-5_000:], special.orbit).max()
    assert reach[-1e-4] == pytest.approx(10.0 * reach[-1e-5], rel=0.1)
    assert reach[-1e-5] < 1e-3
    assert reach[1e-5] > 10.0 * reach[-1e-5]
    ratio = reach[1e-4] / reach[1e-5]
    # the square root of 10 for an attractor that shrinks, 1 for one that lies elsewhere
    assert ratio == pytest.approx({"local": math.sqrt(10.0), "jump": 1.0}[kind], rel=0.15)
    assert found.farthest[-1] == pytest.approx(reach[1e-5], rel=0.1)


def test_exponent_beyond_is_that_of_another_run(case):
    _, special, found, (_, _, beyond) = case
    spectrum = rk.lyapunov(
        at(special, found.distances[-1]), special.orbit.state, cycles=100_000, transient=5_000
    )
    error = math.hypot(spectrum.errors[0], found.attractor.exponent_error)
    if beyond == "chaotic":
        assert spectrum.values[0] == pytest.approx(found.attractor.exponent, abs=5.0 * error)
    else:
        assert spectrum.values[0] == pytest.approx(found.attractor.exponent, rel=1e-3)


def near(special, gap, reach=0.02):
    """Orbits that a search finds near the grazing orbit, up to its period."""
    found = rk.find_orbits(at(special, gap), special.orbit.period)
    return [
        orbit
        for orbit in found
        if (orbit.impacts or orbit.brace_hits)
        and orbit.period == special.orbit.period
        and apart(points(orbit, special.orbit.phase), special.orbit).max() < reach
    ]


def test_a_search_finds_the_stable_orbit_before_and_no_stable_orbit_beyond(case):
    branch, special, _, (orbits, _, _) = case
    gap = 3e-4
    before, beyond = near(special, -gap), near(special, gap)
    own = [one for one in before if (one.impacts, one.brace_hits) == (branch.impacts, branch.brace_hits)]
    assert own
    assert any(one.stable for one in own)
    assert not any(one.stable for one in beyond)
    assert not any((one.impacts, one.brace_hits) == (branch.impacts, branch.brace_hits) for one in beyond)
    if orbits == "fold":
        assert not beyond


def test_multipliers_of_the_orbit_with_the_contact_grow_without_bound(case):
    branch, special, *_ = case
    ends = special.parameter * 0.99, special.parameter * 1.01
    (other,) = rk.switch_branch(special, ends, step=1e-3, max_points=6)
    apart = np.abs(other.points["parameter"] / special.parameter - 1.0)
    sizes = np.abs(other.points["multipliers"]).max(axis=1)
    assert (np.diff(sizes) < 0.0).all()
    assert sizes[0] > 300.0
    # like the inverse speed of the contact
    np.testing.assert_allclose(sizes * apart, (sizes * apart)[0], rtol=0.3)
    assert other.impacts + other.brace_hits > branch.impacts + branch.brace_hits


def test_dataset_holds_the_evidence(case):
    *_, found, (orbits, kind, _) = case
    data = found.to_xarray()
    np.testing.assert_array_equal(data.amplitude, found.values)
    np.testing.assert_array_equal(data.farthest, found.farthest)
    assert (data.attrs["orbits"], data.attrs["transition"]) == (orbits, kind)
    assert data.exponent.values[-1] == found.attractor.exponent


def test_picture_shows_both_distances_and_the_square_root_of_an_attractor_that_shrinks(case):
    *_, found, (_, kind, _) = case
    ax = rk.plot.grazing_transition(found)
    lines = {line.get_gid(): np.array(line.get_data()) for line in ax.lines}
    np.testing.assert_array_equal(lines["farthest"], [found.distances, found.farthest])
    np.testing.assert_array_equal(lines["nearest"], [found.distances, found.nearest])
    assert ("square-root" in lines) == (kind == "local")
    if kind == "local":
        x, y = lines["square-root"]
        np.testing.assert_allclose(y / y[-1], np.sqrt(x / x[-1]))
        assert np.abs(np.log(y / found.farthest)).max() < 0.6
    assert found._repr_html_().startswith("<figure>")


def test_picture_of_a_jump_shows_a_horizontal_line_in_the_middle_of_a_decade():
    system, longest, amplitude, _ = CASES["without braces"]
    found = rk.grazing_transition(grazing(system, longest, amplitude)[1])
    ax = rk.plot.grazing_transition(found)
    low, high = np.log10(ax.get_ylim())
    assert high - low == pytest.approx(1.0)
    assert np.abs(np.log10(found.farthest) - 0.5 * (low + high)).max() < 0.01


def test_picture_refuses_other_results():
    with pytest.raises(TypeError, match="^result must be a GrazingTransition; got 3"):
        rk.plot.grazing_transition(3)


def test_summary_names_the_attractor():
    system, longest, amplitude, _ = CASES["without braces"]
    _, special = grazing(system, longest, amplitude)
    assert str(rk.grazing_transition(special)) == (
        "grazing at amplitude 9.29335793: two orbits meet, as at a fold; beyond: the motion jumps to a stable orbit of period 1, "
        "0.17 away"
    )


def test_a_jump_to_either_of_two_mirror_images_is_a_jump():
    braces = rk.Braces(angle=0.3, restitution=0.7)
    system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), 0.8, braces)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.5, 15.0))
    found = rk.grazing_transition(branch.special[-1])
    angles = {round(verdict.orbit.at(0.0).angle, 1) for verdict in found.verdicts}
    assert len(angles) == 2
    assert np.ptp(found.farthest) < 2e-3
    assert (found.orbits, found.kind) == ("fold", "jump")


def test_an_unstable_orbit_is_named_and_one_without_events_has_no_other_branch():
    system = rk.System(rk.Harmonic(amplitude=2.2, period=2.0), restitution=0.91)
    found = branches(system, 1, (0.5, 15.0))
    special = next(one for branch in found for one in branch.special if one.kind == "grazing")
    found = rk.grazing_transition(special)
    assert rk.switch_branch(special, (0.5, 15.0)) == ()
    assert (found.orbits, found.kind) == ("none", "unstable orbit")
    assert str(found.attractor.kind) == "overturned"
    assert np.isinf(found.farthest).all()
    assert np.isnan(found.order).all()
    assert str(found).endswith("beyond: motions leave the unstable orbit, here to overturning")
    assert found._repr_html_() is None
    with pytest.raises(ValueError, match="^result must hold a motion that does not overturn"):
        rk.plot.grazing_transition(found)


def test_a_motion_that_overturns_jumps():
    """No stable orbit is known whose grazing ends in overturning: verdicts of another system take the place."""
    system = rk.System(rk.Harmonic(amplitude=2.2, period=2.0), restitution=0.91)
    special = next(
        one for branch in branches(system, 1, (0.5, 15.0)) for one in branch.special if one.kind == "grazing"
    )
    wide, longest, amplitude, _ = CASES["without braces"]
    stable = grazing(wide, longest, amplitude)[1]
    found = attrs.evolve(rk.grazing_transition(special), special=stable)
    assert found.kind == "jump"
    assert str(found).endswith("the motion jumps to overturning")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"distances": [1e-3, 1e-4]}, "distances must be at least 4 different numbers"),
        ({"distances": [1e-3, 1e-4, 1e-5, 0.0]}, "distances must be at least 4 different numbers"),
        ({"max_cycles": 0}, "max_cycles must"),
        ({"special": 3}, "special must be a SpecialPoint"),
    ],
)
def test_refusals(change, message):
    system, longest, amplitude, _ = CASES["without braces"]
    _, special = grazing(system, longest, amplitude)
    with pytest.raises((TypeError, ValueError), match=f"^{message}"):
        rk.grazing_transition(**{"special": special} | change)


def test_other_special_points_are_refused():
    system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    with pytest.raises(ValueError, match="^special must be a grazing; got 'symmetry-breaking'"):
        rk.grazing_transition(branch.special[0])
