"""Branches of periodic orbits of the full block: their slender limit, their special points, and their orbits."""

import numpy as np
import pytest

import rocking as rk

RANGE = (10.0, 30.0)


def branch_of(angle, amplitude=15.0, bounds=RANGE, period=1.0, restitution=0.9, parameter="amplitude"):
    forcing = rk.Harmonic(amplitude=amplitude, period=period)
    system = rk.System(forcing, restitution, critical_angle=angle)
    return rk.continue_orbit(rk.classify(system).orbit, parameter, bounds)


def kinds(branch):
    return [point.kind for point in branch.special]


@pytest.fixture(scope="module")
def branch():
    return branch_of(0.1)


@pytest.mark.long
def test_special_points_reach_those_of_the_slender_block_at_second_order():
    """Symmetry breaking, then period doubling: the distance is proportional to θcr²."""
    exact = branch_of(None)
    errors = [branch_of(angle).special[0].parameter - exact.special[0].parameter for angle in (0.005, 0.01)]
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=2e-3)
    doubled = [branch_of(angle, 24.0, (23.5, 40.0)).special[0].parameter for angle in (None, 0.005, 0.01)]
    assert (doubled[2] - doubled[0]) / (doubled[1] - doubled[0]) == pytest.approx(4.0, rel=2e-3)


def test_symmetry_breaks_where_the_verdicts_say_so(branch):
    assert kinds(branch) == ["symmetry-breaking"]
    breaks = branch.special[0].parameter
    assert branch.special[0].orbit.multipliers[0] == pytest.approx(1.0, abs=1e-6)
    for factor, symmetric in ((0.999, True), (1.001, False)):
        system = rk.System(rk.Harmonic(factor * breaks, period=1.0), 0.9, critical_angle=0.1)
        verdict = rk.classify(system)
        assert (verdict.kind, verdict.period, verdict.symmetric) == ("periodic", 1, symmetric)
    (there,) = branch.at(0.999 * breaks)
    assert there.multipliers[0] == pytest.approx(
        rk.classify(there.system).orbit.multipliers[0], rel=0, abs=1e-8
    )


def test_an_asymmetric_branch_passes_the_symmetry_breaking_to_its_mirror_image(branch):
    born = branch_of(0.1, 26.0, (24.0, 27.0))
    assert not born.symmetric
    assert kinds(born) == ["symmetry-breaking"]
    assert born.special[0].parameter == pytest.approx(branch.special[0].parameter, rel=1e-6)
    pair = born.at(26.0)
    assert len(pair) == 2
    states = [
        rk.simulate(orbit.system, orbit.state, cycles=1, record="section").section()[0] for orbit in pair
    ]
    assert not np.allclose(*states, atol=1e-3)


def test_period_doubles_where_the_verdicts_say_so():
    born = branch_of(0.02, 24.0, (23.5, 40.0))
    doubles = next(point.parameter for point in born.special if point.kind == "period-doubling")
    for factor, period in ((0.995, 1), (1.005, 2)):
        system = rk.System(rk.Harmonic(factor * doubles, period=1.0), 0.9, critical_angle=0.02)
        assert rk.classify(system).period == period


@pytest.mark.long
def test_a_fold_joins_a_stable_and_an_unstable_orbit():
    """Unstable symmetric orbits below, of the slender block, turn at the amplitude at which the mode begins to exist."""
    breaks = rk.theory.symmetry_breaking_amplitude(1.0, 0.9, 1)
    mode = rk.theory.symmetric_modes(0.7 * breaks, 1.0, 0.9, 1)[0]
    slender = rk.continue_orbit(
        rk.find_orbit(mode.system, mode.start, 1), "amplitude", (1e-3 * breaks, 2.0 * breaks)
    )
    (expected,) = (point.parameter for point in slender.special if point.kind == "fold")
    found = []
    for angle in (0.01, 0.02):
        system = rk.System(mode.system.forcing, 0.9, critical_angle=angle)
        branch = rk.continue_orbit(
            rk.find_orbit(system, mode.start, 1), "amplitude", (1e-3 * breaks, 2.0 * breaks)
        )
        (fold,) = (point for point in branch.special if point.kind == "fold")
        assert fold.orbit.multipliers[0] == pytest.approx(1.0, abs=1e-3)
        found.append(fold.parameter)
        lower, upper = branch.at(1.01 * fold.parameter)
        assert {lower.stable, upper.stable} == {True, False}
    assert (found[1] - expected) / (found[0] - expected) == pytest.approx(4.0, rel=0.02)


def test_each_orbit_of_a_branch_closes(branch):
    for index in (0, len(branch) // 2, len(branch) - 1):
        orbit = branch.orbit(index)
        assert orbit.residual < 1e-10
        assert orbit.system.forcing.amplitude == branch.points["parameter"][index]
        np.testing.assert_allclose(
            np.abs(orbit.multipliers), np.abs(branch.points["multipliers"][index]), rtol=0, atol=1e-7
        )
    section = branch.section(0.7)
    assert section.shape == (len(branch), 1, 2)
    orbit = branch.orbit(3)
    wait = (0.7 - orbit.phase) % (2 * np.pi) / orbit.system.forcing.frequency
    begun = rk.System(
        rk.Harmonic(orbit.system.forcing.amplitude, period=1.0, phase=orbit.phase), 0.9, critical_angle=0.1
    )
    state = rk.simulate(begun, orbit.state, cycles=2).at(wait)
    np.testing.assert_allclose(section[3, 0], np.array(state), rtol=0, atol=1e-9)


def test_a_branch_over_the_critical_angle_ends_at_the_range():
    branch = branch_of(0.1, 2.0, (0.01, 1.2), restitution=0.925, parameter="critical_angle")
    assert branch.ends == ("end of the range", "end of the range")
    assert branch.points["parameter"].min() == 0.01
    assert branch.points["parameter"].max() == 1.2


def test_a_branch_ends_where_an_impact_more_appears():
    exact, full = (
        branch_of(angle, 6.5, (1.0, 12.0), period=0.4, restitution=0.925) for angle in (None, 0.001)
    )
    assert (exact.ends[1], full.ends[1]) == ("grazing", "grazing")
    assert full.points["parameter"].max() == pytest.approx(exact.points["parameter"].max(), rel=1e-4)


def test_a_figure_shows_the_branch(branch):
    ax = rk.plot.branch(branch)
    assert any("symmetry breaking" in text.get_text() for text in ax.get_legend().get_texts())


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda branch: rk.switch_branch(branch.special[0], RANGE),
            "special must be that of a slender, symmetric block",
        ),
        (
            lambda branch: rk.bifurcation_curve(
                branch.special[0], "period", "amplitude", ((0.5, 2.0), (1.0, 40.0))
            ),
            "special must be that of a slender, symmetric block",
        ),
        (
            lambda branch: rk.continue_orbit(branch.orbit(0), "critical_angle", (0.2, 0.4)),
            "critical_angle must lie in",
        ),
        (
            lambda branch: rk.continue_orbit(branch.orbit(0), "brace_angle", (0.5, 1.5)),
            "brace_angle must be used with a braced system",
        ),
        (
            lambda branch: rk.continue_orbit(
                rk.classify(rk.System(rk.Harmonic(0.5, period=1.0), 0.9, critical_angle=0.1)).orbit,
                "amplitude",
                (0.1, 2.0),
            ),
            "orbit must",
        ),
    ],
)
def test_what_cannot_be_followed_is_refused_in_one_line(branch, call, says):
    with pytest.raises((TypeError, ValueError)) as refused:
        call(branch)
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.long
@pytest.mark.parametrize("name", ["amplitude", "brace_angle"])
def test_newtons_method_beyond_a_brace_shortens_the_step(name):
    """The predictor leaves the range between the braces: that was an error of the initial state of a motion."""
    braces = rk.Braces(angle=0.44, restitution=0.87)
    system = rk.System(rk.Harmonic(amplitude=2.38, period=2.28), 0.88, braces, critical_angle=0.38)
    value = 2.38 if name == "amplitude" else 0.44
    orbits = [each for each in rk.find_orbits(system, 1) if each.brace_hits]
    assert orbits
    for orbit in orbits:
        branch = rk.continue_orbit(orbit, name, (0.7 * value, 1.3 * value), step=0.05)
        assert len(branch) > 10
        assert not orbit.stable or branch.ends == ("end of the range", "end of the range")
        for index in (0, len(branch) // 2, len(branch) - 1):
            found = branch.orbit(index)
            assert found.residual < 1e-9
            assert (found.impacts, found.brace_hits) == (branch.impacts, branch.brace_hits)
