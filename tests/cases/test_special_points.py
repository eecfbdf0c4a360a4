"""Special points of branches: none is lost at the default step, and grazings are located to rounding."""

import math
import pickle

import numpy as np
import pytest

import rocking as rk
from rocking.kernels.orbits import continuation as kernel

FEIGENBAUM = 4.669201609
TUTORIAL = (1.721328, 0.8)
DEPTH = 6
SEED = 33


def special(branch, kind):
    return [point for point in branch.special if point.kind == kind]


def symmetry_breaking(period, restitution, step=0.01):
    breaks = rk.theory.symmetry_breaking_amplitude(period, restitution, 1)
    mode = rk.theory.symmetric_modes(0.97 * breaks, period, restitution, 1)[0]
    orbit = rk.find_orbit(mode.system, mode.start, 1)
    return special(
        rk.continue_orbit(orbit, "amplitude", (0.9 * breaks, 1.1 * breaks), step), "symmetry-breaking"
    )[0]


def cascade(period, restitution, step=0.01):
    """The first doublings of the asymmetric orbit, as far as they are found."""
    point, found = symmetry_breaking(period, restitution, step), []
    bounds = 0.9 * point.parameter, 2.0 * point.parameter
    while len(found) < DEPTH:
        doublings = special(rk.switch_branch(point, bounds, step)[0], "period-doubling")
        if not doublings:
            break
        point = doublings[0]
        found.append(point.parameter)
    return found


def drawn():
    random = np.random.default_rng(SEED)
    return [(random.uniform(1.2, 2.2), random.uniform(0.7, 0.9)) for _ in range(14)]


@pytest.mark.parametrize("period, restitution", [TUTORIAL, *drawn()])
def test_a_cascade_loses_no_doubling_at_the_default_step(period, restitution):
    """Each gap is the last one over Feigenbaum's number, up to a small part: a doubling that is passed over would square it."""
    found = cascade(period, restitution)
    assert len(found) == DEPTH
    gaps = np.diff(found)
    assert gaps[-2] / gaps[-1] == pytest.approx(FEIGENBAUM, rel=0.01)


def test_the_doubling_of_the_period_32_branch_is_where_a_fine_step_has_it():
    assert cascade(*TUTORIAL)[-1] == pytest.approx(10.7325297897, abs=5e-11)
    assert cascade(*TUTORIAL, step=0.003)[-1] == pytest.approx(10.7325297897, abs=5e-11)


@pytest.mark.parametrize("off", [1e-7, 1e-5, 1e-3, -1e-7, -1e-5, -1e-3])
def test_a_special_point_in_the_first_step_is_found_once(off):
    breaking = symmetry_breaking(*TUTORIAL)
    born = rk.switch_branch(breaking, (7.0, 12.0))[0]
    doubling = special(born, "period-doubling")[0]
    (orbit,) = born.at(doubling.parameter + off)
    again = special(rk.continue_orbit(orbit, "amplitude", (10.0, 11.0)), "period-doubling")
    assert [point.parameter for point in again] == pytest.approx([doubling.parameter], abs=1e-11)
    assert again[0].orbit.multipliers[0] == pytest.approx(-1.0, abs=1e-9)


def test_a_branch_begun_at_a_special_point_has_it_once():
    doubling = special(rk.switch_branch(symmetry_breaking(*TUTORIAL), (7.0, 12.0))[0], "period-doubling")[0]
    again = special(rk.continue_orbit(doubling.orbit, "amplitude", (10.0, 11.0)), "period-doubling")
    assert [point.parameter for point in again] == pytest.approx([doubling.parameter], abs=1e-11)


def test_a_passage_and_return_within_a_step_is_seen_from_three_points():
    """Against the parabola through them, sampled."""
    random = np.random.default_rng(SEED)
    seen = 0
    for _ in range(3000):
        before, length = random.uniform(0.1, 2.0, 2)
        bend, rise, start = random.normal(size=3) * (2.0, 2.0, 1.0)
        values = start + rise * (s := np.linspace(0.0, length, 2001)) + bend * s**2
        beyond = [values > level for level in (-0.25 * math.pi, 0.25 * math.pi)]
        expected = any(one[0] == one[-1] and (one != one[0]).any() for one in beyond)
        earlier = start - rise * before + bend * before**2
        told = kernel.passes_and_returns.py_func(earlier, before, values[0], values[-1], length)
        # where the extreme all but touches a level the samples may miss it
        if abs(abs(start - 0.25 * rise**2 / bend) - 0.25 * math.pi) > 1e-3:
            assert told == expected
            seen += expected
    assert seen > 100


@pytest.mark.parametrize("step", [0.005, 0.01, 0.02])
def test_the_unsymmetric_orbit_ends_where_the_saddle_orbit_touches_the_base(step):
    """Both impacts merge: what is left is Θ = ±(1 + β cos ψ) with β = 1, at A = 1 + Ω²."""
    exact = 1.0 + (2.0 * math.pi / TUTORIAL[0]) ** 2
    pair = rk.switch_branch(symmetry_breaking(*TUTORIAL), (7.0, 20.0), step)
    for branch in pair:
        assert branch.ends[1] == "grazing"
        (point,) = special(branch, "grazing")
        assert point.parameter == pytest.approx(exact, rel=4e-16, abs=0)
        orbit = point.orbit
        assert (orbit.period, orbit.impacts) == (1, 0)
        assert orbit.stability == "unstable"
        side = math.copysign(1.0, orbit.at(math.pi if orbit.state.angle < 0 else 0.0).angle)
        for phase in np.linspace(0.1, 2.0, 7):
            psi = phase if side > 0 else phase + math.pi
            assert orbit.at(psi).angle == pytest.approx(side + math.cos(psi), abs=1e-12)


def test_an_orbit_at_a_grazing_is_not_followed():
    """Rounding decides whether a run meets the grazing impact, and with that impact the orbit is different."""
    pair = rk.switch_branch(symmetry_breaking(*TUTORIAL), (7.0, 20.0))
    mode = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
    braced = rk.System(mode.system.forcing, 0.925, rk.Braces(1.0, 0.9))
    touching = rk.continue_orbit(rk.find_orbit(braced, mode.start, 1), "brace_angle", (0.05, 2.0))
    grazings = [(branch, *special(branch, "grazing")) for branch in (*pair, touching)]
    for branch, point in grazings:
        bounds = 0.5 * point.parameter, 1.5 * point.parameter
        for orbit in (point.orbit, pickle.loads(pickle.dumps(point.orbit))):
            with pytest.raises(
                ValueError, match=r"^orbit must not be that of a grazing, .*branch\.orbit\(index\)"
            ):
                rk.continue_orbit(orbit, branch.name, bounds)
        beside = branch.orbit(point.index - 3 if point.index > 3 else 3)
        assert len(rk.continue_orbit(beside, branch.name, bounds)) > 10


@pytest.mark.parametrize("step", [3e-4, 1e-3, 3e-3, 1e-2, 5e-2])
def test_an_orbit_just_beside_a_special_point_is_followed(step):
    """Its phases are so sensitive to the parameter there that rounding keeps them from settling at a value of it."""
    breaking = symmetry_breaking(*TUTORIAL)
    born = rk.switch_branch(breaking, (7.0, 12.0))[0]
    doubling = special(born, "period-doubling")[0]
    for point in (breaking, doubling):
        beside = rk.switch_branch(point, (7.0, 11.5), step, 4)[0]
        for index in (1, 2):
            orbit = beside.orbit(index)
            own = orbit.system.forcing.amplitude
            branch = rk.continue_orbit(orbit, "amplitude", (7.0, 11.5))
            assert (branch.period, branch.impacts) == (orbit.period, orbit.impacts)
            amplitudes = branch.points["parameter"]
            # from the end of the range past the special point and back along the mirror image, or half a period later
            assert amplitudes[[0, -1]].tolist() == [11.5, 11.5]
            assert amplitudes.min() >= point.parameter - 1e-8
            assert np.abs(amplitudes - own).min() <= 1e-8 * own
            # also where the range ends at the orbit
            assert rk.continue_orbit(orbit, "amplitude", (own, 11.5)).points["parameter"].min() >= own
            assert rk.continue_orbit(orbit, "amplitude", (7.0, own)).points["parameter"].max() <= own
            assert len(rk.continue_orbit(orbit, "restitution", (0.75, 0.85))) > 10


def test_the_orbit_at_a_fold_is_followed_both_ways():
    breaks = rk.theory.symmetry_breaking_amplitude(1.0, 0.9, 1)
    mode = rk.theory.symmetric_modes(0.7 * breaks, 1.0, 0.9, 1)[0]
    orbit = rk.find_orbit(mode.system, mode.start, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (1e-3 * breaks, 2.0 * breaks))
    (fold,) = special(branch, "fold")
    again = rk.continue_orbit(fold.orbit, "amplitude", (1e-3 * breaks, 2.0 * breaks))
    assert again.ends == branch.ends
    for one, other in zip(again.special, branch.special, strict=True):
        assert one.kind == other.kind
        assert one.parameter == pytest.approx(other.parameter, rel=1e-11, abs=0)


def test_an_orbit_where_branches_cross_is_refused_in_one_line():
    """The first orbit of a branch that is born at a special point lies on both branches there."""
    breaking = symmetry_breaking(*TUTORIAL)
    born = rk.switch_branch(breaking, (7.0, 12.0))[0]
    twice = rk.switch_branch(special(born, "period-doubling")[0], (7.0, 11.5))[0]
    for branch in (born, twice):
        with pytest.raises(
            ValueError, match=r"^orbit must .* lie on one branch alone; got .*branch\.orbit\(index\)"
        ):
            rk.continue_orbit(branch.orbit(0), "amplitude", (7.0, 12.0))


def test_the_grazing_of_the_period_8_branch_does_not_depend_on_the_step():
    found = []
    for step in (0.002, 0.004, 0.007, 0.01):
        branch = rk.switch_branch(symmetry_breaking(*TUTORIAL, step), (7.0, 20.0), step)[0]
        for _ in range(3):
            branch = rk.switch_branch(special(branch, "period-doubling")[0], (9.0, 12.0 + step), step)[0]
        assert branch.period == 8
        (point,) = special(branch, "grazing")
        found.append(point.parameter)
    assert np.ptp(found) <= 1e-13 * found[0]
    assert found[0] == pytest.approx(11.86655712, abs=1e-7)
    # the orbit there lacks two impacts, and touches the base instead: Θ turns within half a sample of Θ = 0, where |Θ''| < 13
    assert point.orbit.impacts == branch.impacts - 2
    angles = np.array([point.orbit.at(phase).angle for phase in np.linspace(0.0, 16.0 * math.pi, 4001)])
    before, size, after = angles[:-2], np.abs(angles[1:-1]), angles[2:]
    turns = (size < np.abs(before)) & (size < np.abs(after)) & (np.sign(before) == np.sign(after))
    half = 0.5 * 8 * TUTORIAL[0] / 4000
    assert size[turns].min() < 0.5 * 13.0 * half**2


def test_a_branch_ends_at_its_grazing_wherever_it_is_begun():
    """Very near a grazing the multipliers are beyond 10⁸, and no step is short enough: the branch ends there, complete.

    Rounding decides if a step ends at the symmetry breaking at A = 7.333. There the branch ends, or passes to its mirror images.
    """
    found = []
    for amplitude in (7.758823529411765, 8.818181818181818, *np.linspace(7.45, 10.4, 13)):
        system = rk.System(rk.Harmonic(amplitude, period=1.721328), 0.8)
        branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (5.0, 14.5))
        assert set(branch.ends) <= {"grazing", "merges with the branch from which it bifurcates"}
        assert "grazing" in branch.ends
        found += [point.parameter for point in special(branch, "grazing")]
    assert len(found) >= 15
    assert np.ptp(found) <= 1e-13 * found[0]


def test_a_grazing_with_a_brace_is_where_the_brace_is_the_peak():
    """The peak is that of the symmetric mode without braces, known in closed form."""
    mode = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
    braced = rk.System(mode.system.forcing, 0.925, rk.Braces(1.0, 0.9))
    branch = rk.continue_orbit(rk.find_orbit(braced, mode.start, 1), "brace_angle", (0.05, 2.0))
    (point,) = special(branch, "grazing")
    assert point.parameter == pytest.approx(mode.peak, rel=1e-14, abs=0)
    assert (point.orbit.impacts, point.orbit.brace_hits) == (2, 0)


POLES = {
    "symmetric orbits": (
        rk.System(
            rk.Harmonic(5.720492618362348, period=3.2635994374026063),
            0.8003231557876358,
            rk.Braces(0.387610706342514, 0.41471287669423473),
        ),
        3.2800350048,
    ),
    "orbits of period 2": (
        rk.System(
            rk.Harmonic(7.7215087506518225, period=2.1420431409603435),
            0.4124806202155763,
            rk.Braces(0.9973199240440456, 0.9797096297532304),
        ),
        2.4283996611,
    ),
    "symmetric and asymmetric orbits": (
        rk.System(
            rk.Harmonic(7.34208063131507, period=2.0177839757003833),
            0.7064122296209181,
            rk.Braces(1.0685469903925413, 0.680604113737062),
        ),
        2.4135306136,
    ),
    "many orbits": (
        rk.System(
            rk.Harmonic(2.6925376987403005, period=3.191929219930584),
            0.7645061076090323,
            rk.Braces(1.1139358213333044, 0.7565524779740835),
        ),
        3.0420666580,
    ),
}


@pytest.mark.parametrize("name", POLES)
def test_no_bifurcation_is_named_at_a_grazing_where_the_multipliers_are_infinite(name):
    """The trace changes its sign through infinity in the last step: a pole of both test functions."""
    system, grazing = POLES[name]
    period = system.forcing.period
    met = 0
    for orbit in rk.find_orbits(system, 2, effort=0.1):
        if orbit.impacts or orbit.brace_hits:
            branch = rk.continue_orbit(orbit, "period", (0.3 * period, 2.0 * period))
            for point in branch.special:
                sizes = np.abs(point.orbit.multipliers)
                if point.kind == "grazing":
                    met += abs(point.parameter - grazing) < 1e-8
                else:
                    # one multiplier is 1 or -1, and the other one is their product
                    assert np.abs(sizes - 1.0).min() < 1e-3, (str(branch), point.kind)
    assert met
