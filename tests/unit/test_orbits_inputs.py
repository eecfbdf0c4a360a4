"""Orbits that cannot be found or continued raise an error in one line, or end with the reason."""

import pytest

import rocking as rk
import stored_surveys

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)


@pytest.fixture(scope="module")
def orbit():
    return rk.find_orbit(SYSTEM, rk.State(0.18, -0.1), 1)


def test_where_newton_ends_without_an_orbit_it_says_where():
    system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.5)
    with pytest.raises(rk.NoOrbit, match=r"^no orbit of period 1 was found from State") as caught:
        rk.find_orbit(system, rk.State(0.5), 1)
    assert caught.value.residual > 0.0


def test_a_saddle_without_impacts_is_not_followed():
    saddle = next(orbit for orbit in rk.find_orbits(SYSTEM, 1) if orbit.impacts == 0)
    with pytest.raises(ValueError, match=r"^orbit must have an impact or a brace impact"):
        rk.continue_orbit(saddle, "amplitude", (1, 3))


def test_few_points_end_a_branch_with_that_reason(orbit):
    branch = rk.continue_orbit(orbit, "amplitude", (1.5, 3), max_points=3)
    assert branch.ends == ("maximum number of points", "maximum number of points")


def test_few_points_end_what_is_born_and_a_curve_as_well():
    strong = rk.find_orbit(rk.System(rk.Harmonic(20.0, period=1.0), 0.9), rk.State(0.9, -0.1), 1)
    (breaking,) = rk.continue_orbit(strong, "amplitude", (15, 25)).special
    born = rk.switch_branch(breaking, (15, 30), max_points=5)
    assert [len(branch) for branch in born] == [6, 6]
    assert {branch.ends[1] for branch in born} == {"maximum number of points"}
    curve = rk.bifurcation_curve(breaking, "period", "amplitude", ((0.9, 1.1), (15, 30)), max_points=4)
    assert curve.ends == ("maximum number of points", "maximum number of points")


def test_point_of_a_branch_is_named_by_its_index(orbit):
    branch = rk.continue_orbit(orbit, "amplitude", (1.5, 3), max_points=3)
    count = len(branch)
    first, last = (branch.points["parameter"][[0, -1]]).tolist()
    for index, amplitude in {0: first, count - 1: last, -1: last, -count: first}.items():
        assert branch.orbit(index).system.forcing.amplitude == amplitude
    allowed = rf"^index must be a whole number in \[-{count}, {count - 1}\]; got "
    for wrong in (count, -count - 1, 10_000, 0.5):
        with pytest.raises(IndexError, match=allowed + str(wrong)):
            branch.orbit(wrong)
    for wrong in ("a", None, [0]):
        with pytest.raises(TypeError, match=allowed):
            branch.orbit(wrong)


def test_orbits_are_looked_for_from_the_box_that_is_given():
    """From initial states at which overturning is certain no orbit is found."""
    assert len(rk.find_orbits(SYSTEM, 1, angles=(3.0, 4.0), velocities=(3.0, 4.0), effort=0.05)) == 0
    with pytest.raises(
        ValueError, match=r"^velocities must be \(lowest, highest\), the one below the other; got"
    ):
        rk.find_orbits(SYSTEM, 1, velocities=(0.3, -0.3))


@pytest.mark.parametrize("effort", [0.02, 0.1])
def test_search_with_another_effort_is_refused_and_leaves_the_store_as_it_was(tmp_path, effort):
    store = tmp_path / "orbits"
    orbits = rk.find_orbits(SYSTEM, 1, effort=0.05, store=store).to_xarray()
    before = stored_surveys.files(store)
    with pytest.raises(ValueError, match=f"holds a different survey: effort is 0.05 there and {effort} here"):
        rk.find_orbits(SYSTEM, 1, effort=effort, store=store)
    assert stored_surveys.files(store) == before
    assert rk.find_orbits(SYSTEM, 1, effort=0.05, store=store).to_xarray().identical(orbits)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"seed": 1}, "seed is 0 there and 1 here"),
        ({"max_period": 2}, "max_period is 1 there and 2 here"),
        ({"angles": (-0.5, 0.5)}, "angles is not given there"),
        ({"system": rk.System(SYSTEM.periodic, restitution=0.9)}, "restitution is 0.925 there and 0.9 here"),
    ],
)
def test_search_that_differs_does_not_take_the_guesses_of_a_store(tmp_path, changed, said):
    search = {"system": SYSTEM, "max_period": 1, "effort": 0.05, "store": tmp_path / "orbits"}
    rk.find_orbits(**search)
    with pytest.raises(ValueError, match=f"holds a different survey: {said}"):
        rk.find_orbits(**search | changed)


def test_nothing_is_born_at_a_fold(orbit):
    branch = rk.continue_orbit(orbit, "amplitude", (0.01, 3))
    fold = next(point for point in branch.special if point.kind == "fold")
    with pytest.raises(
        ValueError, match=r"^special must be of kind symmetry-breaking, period-doubling or grazing"
    ):
        rk.switch_branch(fold, (0.01, 3))
    with pytest.raises(ValueError, match=r"^second must be another parameter than period"):
        rk.bifurcation_curve(fold, "period", "frequency", ((1, 2), (3, 7)))
    assert str(branch).startswith("branch of symmetric orbits of period 1, amplitude ")


def test_a_block_on_a_base_at_rest_has_no_orbit_with_impacts():
    """Each impact takes energy, so that no motion with impacts repeats itself."""
    system = rk.System(rk.Harmonic(amplitude=0.0, period=1.7), restitution=0.925)
    assert not [orbit for orbit in rk.find_orbits(system, 3) if orbit.impacts]


@pytest.mark.parametrize("name", ["restitution", "brace_restitution"])
def test_an_orbit_that_loses_all_speed_at_an_impact_is_not_followed(name):
    braces = rk.Braces(angle=0.2864545540060415, restitution=0.0)
    braced = rk.System(rk.Harmonic(amplitude=2.5838043644402964, period=1.37517120435794), 0.99, braces)
    system = rk.System(rk.Harmonic(amplitude=8.0, period=2.0), 0.0) if name == "restitution" else braced
    found = [orbit for orbit in rk.find_orbits(system, 1) if not orbit.superstable]
    lost = [orbit for orbit in found if (orbit.impacts if name == "restitution" else orbit.brace_hits)]
    assert len(lost) >= 2
    for orbit in lost:
        with pytest.raises(
            ValueError, match=rf"^orbit must keep some speed at each impact .* one at {name} 0 \(find"
        ):
            rk.continue_orbit(orbit, "amplitude", (1.0, 10.0))
