"""Points of codimension two: coefficients of the return map by differences, searches and motions on both sides, and folds nearby."""

import math
from collections import Counter

import numpy as np
import pytest

import rocking as rk
from rocking.motion.march_loop import monodromy

PLANE = "period", "amplitude"
DAMPED = rk.System(rk.Harmonic(2.43, period=2.46), 0.18)
BRACED = rk.System(rk.Harmonic(1.19, period=4.2), 0.68, rk.Braces(0.37, 0.81))
DOUBLED = rk.System(rk.Harmonic(1.4, period=3.23), 0.56)
# System, period, type of curve, range of the amplitude of the branch, impacts, ranges of the curve.
CASES = {
    "damped": (DAMPED, 1, "period-doubling", (0.3, 20.0), 2, ((1.2, 6.0), (0.5, 10.0))),
    "braced": (BRACED, 1, "symmetry-breaking", (0.9, 3.0), 2, ((1.2, 6.0), (0.5, 10.0))),
    "period 2": (DOUBLED, 2, "period-doubling", (1.3, 1.6), 6, ((2.5, 4.5), (1.0, 2.5))),
}
DEGENERATE = "degenerate-period-doubling", "degenerate-symmetry-breaking"


def branches(system, period, bounds, step=0.01):
    for orbit in rk.find_orbits(system, period):
        if orbit.period == period and (orbit.impacts or orbit.brace_hits):
            yield rk.continue_orbit(orbit, "amplitude", bounds, step)


def curves_of(system, period, kind, bounds, impacts, plane):
    found = {}
    for branch in branches(system, period, bounds):
        for special in branch.special:
            if (special.kind, special.orbit.impacts) == (kind, impacts):
                found[round(special.parameter, 6)] = special
    return [rk.bifurcation_curve(special, *PLANE, plane) for special in found.values()]


@pytest.fixture(
    scope="module",
    params=[pytest.param(each, marks=() if each == "damped" else pytest.mark.long) for each in CASES],
)
def case(request):
    system, *rest = CASES[request.param]
    curves = curves_of(system, *rest)
    return system, [curve for curve in curves if any(one.kind in DEGENERATE for one in curve.special)]


def at(system, period, amplitude, phase=0.0):
    forcing = rk.Harmonic(float(amplitude), period=float(period), phase=phase)
    return rk.System(forcing, system.restitution, system.braces)


def special_at(system, curve, index):
    """The special point of a branch over the amplitude at a point of the curve, found from a search beside it."""
    period, amplitude = curve.points[index]
    for off in (1e-3, -1e-3, 1e-2, -1e-2):
        near = at(system, period, amplitude * (1.0 + off))
        for branch in branches(near, curve.period, (amplitude * 0.97, amplitude * 1.03), 0.005):
            for special in branch.special:
                same = abs(special.parameter - amplitude) < 1e-9 * amplitude
                if same and (special.kind, special.orbit.impacts) == (curve.kind, curve.impacts):
                    return special
    raise AssertionError


def beside(curve, point):
    """Indices of points of the curve on both sides of a point of codimension two, before the next one."""
    others = [one.index for one in curve.special if one is not point]
    return [
        index
        for index in (point.index - 6, point.index - 3, point.index + 2, point.index + 5)
        if 0 < index < len(curve)
        and not any(min(index, point.index) <= one <= max(index, point.index) for one in others)
    ]


@pytest.fixture(scope="module")
def sides(case):
    """Special points on both sides of each degenerate point, with the coefficient there."""
    system, curves = case
    return system, [
        (curve.coefficients[index], special_at(system, curve, index))
        for curve in curves
        for point in curve.special
        if point.kind in DEGENERATE
        for index in beside(curve, point)
    ]


def critical(special):
    """Jacobian of the map at a period doubling, its critical vectors, and Jacobians beside the orbit by their distance."""
    orbit = special.orbit
    here = np.array([orbit.state.angle, orbit.state.velocity])
    system = at(orbit.system, orbit.system.forcing.period, orbit.system.forcing.amplitude, orbit.phase)

    def jacobian(state):
        return monodromy(system, rk.State(*map(float, state)), orbit.period)

    values, vectors = np.linalg.eig(jacobian(here))
    q = np.real(vectors[:, np.abs(values + 1.0).argmin()])
    values, vectors = np.linalg.eig(jacobian(here).T)
    p = np.real(vectors[:, np.abs(values + 1.0).argmin()])
    return jacobian, here, q, p / (p @ q)


def coefficient_of_map(special, h):
    """Cubic coefficient of the return map (Kuznetsov 2004, ch. 5.4), from its Jacobian by central differences."""
    jacobian, here, q, p = critical(special)
    middle, more, less = jacobian(here), jacobian(here + h * q), jacobian(here - h * q)
    slope, bend = (more - less) / (2.0 * h), (more + less - 2.0 * middle) / h**2
    curved = np.linalg.solve(middle - np.eye(2), slope @ q)
    return p @ (bend @ q) / 6.0 - 0.5 * p @ (slope @ curved)


def test_coefficient_is_that_of_the_return_map(sides):
    """The amplitudes differ by a factor, which an orbit of twice the period shows."""
    _, found = sides
    checked = 0
    for coefficient, special in found:
        if special.kind != "period-doubling":
            continue
        (born,) = rk.switch_branch(special, (0.9 * special.parameter, 1.1 * special.parameter), 1e-3, 2)
        orbit, turn = born.orbit(len(born) - 1), math.tau * special.orbit.period
        # of all cycles that in which the Jacobian was taken
        phases = [special.orbit.phase + math.tau * cycle for cycle in range(special.orbit.period)]
        states = [(orbit.at(phase), orbit.at(phase + turn)) for phase in phases]
        here = special.orbit.state
        first, second = min(
            states, key=lambda pair: math.hypot(pair[0].angle - here.angle, pair[0].velocity - here.velocity)
        )
        change = math.hypot(first.angle - second.angle, first.velocity - second.velocity)
        start = orbit.phase
        turns = np.sort(
            [(start + one.turned) % (2 * math.tau * special.orbit.period) for one in orbit._events]
        )
        half = len(turns) // 2
        shifts = turns[half:] - turns[:half] - turn
        factor = change / math.sqrt(np.mean(shifts**2))
        steps = np.array([coefficient_of_map(special, h) for h in np.geomspace(1e-3, 1e-6, 13)])
        spread = np.abs(np.diff(steps)) / np.abs(steps[1:])
        best = int(spread.argmin())
        if spread[best] > 0.01:
            continue  # an event meets the section, or differences do not converge
        assert coefficient == pytest.approx(steps[best] * factor**2, rel=0.03)
        checked += 1
    assert checked or all(special.kind != "period-doubling" for _, special in found)


def test_coefficient_predicts_the_size_of_the_new_orbits(sides):
    """The mean square of the changes of the phases is that at which the reduced equation vanishes."""
    _, found = sides
    for coefficient, special in found:
        ends = 0.9 * special.parameter, 1.1 * special.parameter
        born = rk.switch_branch(special, ends, 1e-2, 2)[0]
        orbit = born.orbit(len(born) - 1)
        turns = np.sort([one.turned for one in orbit._events])
        half = len(turns) // 2
        size = math.sqrt(np.mean((turns[half:] - turns[:half] - math.pi * orbit.period) ** 2)) / 2.0
        base = original(special, float(born.points["parameter"][-1]))
        squares = [
            one.real if special.kind == "symmetry-breaking" else (one * one).real for one in base.multipliers
        ]
        test, kept = np.prod([1.0 - square for square in squares]), np.prod(squares)
        assert coefficient == pytest.approx(-test / size**2 / (2.0 * (1.0 - kept)), rel=0.05)


def doubled(special, amplitude):
    """Orbits that a search finds of those that bifurcate at a special point."""
    orbit = special.orbit
    times = 2 if special.kind == "period-doubling" else 1
    system = at(orbit.system, orbit.system.forcing.period, amplitude)
    return [
        one
        for one in rk.find_orbits(system, times * orbit.period)
        if (one.period, one.impacts) == (times * orbit.period, times * (orbit.impacts))
        and one.brace_hits == times * orbit.brace_hits
        and not one.symmetric
    ]


def distance(one, other):
    """Distance of the states of two orbits, at the phase of the second, in the cycle in which it is least."""
    here = other.state
    states = [one.at(other.phase + math.tau * cycle) for cycle in range(one.period)]
    return min(math.hypot(state.angle - here.angle, state.velocity - here.velocity) for state in states)


def original(special, amplitude):
    """The orbit of the branch of a special point, at another amplitude."""
    orbit = special.orbit
    near = at(orbit.system, orbit.system.forcing.period, amplitude, orbit.phase)
    return rk.find_orbit(near, orbit.state, orbit.period)


@pytest.mark.long
def test_new_orbits_lie_where_the_sign_of_the_coefficient_says(sides):
    """Brute force: a search finds them on one side, near the orbit, and none so near on the other side."""
    _, found = sides
    signs = Counter()
    for coefficient, special in found:
        ends = 0.9 * special.parameter, 1.1 * special.parameter
        born = rk.switch_branch(special, ends, step=1e-3, max_points=12)[0]
        values = born.points["parameter"]
        gap = values[int(np.abs(values - values[0]).argmax())] - values[0]
        there, opposite = special.parameter + 0.5 * gap, special.parameter - 0.5 * gap
        base, mirror = original(special, there), original(special, opposite)
        near = min(born.at(there), key=lambda orbit: distance(orbit, base))
        reach = 1.5 * distance(near, base)
        assert any(distance(one, near) < 1e-6 for one in doubled(special, there))
        assert not any(distance(one, mirror) < reach for one in doubled(special, opposite))
        assert base.stable != mirror.stable or not special.orbit.stability
        if coefficient > 0.0:
            assert abs(base.multipliers[0]) > 1.0
            assert near.stable == mirror.stable
        else:
            assert not near.stable
            assert abs(base.multipliers[0]) < abs(mirror.multipliers[0])
        signs[coefficient > 0.0] += 1
    assert min(signs[True], signs[False]) > 0


def reached(orbit, cycles=200_000):
    """Largest distance from an orbit of a motion that starts beside it, at the end."""
    system, start = orbit.system, rk.State(orbit.start.angle + 1e-7, orbit.start.velocity)
    motion = rk.simulate(system, start, cycles=cycles, record="section")
    states = [orbit.at(system.forcing.phase + math.tau * cycle) for cycle in range(orbit.period)]
    own = np.array([(state.angle, state.velocity) for state in states])
    return np.linalg.norm(motion.section()[-64:, None] - own, axis=2).min(axis=1).max()


@pytest.mark.long
def test_motions_beyond_a_supercritical_point_stay_near_and_beyond_a_subcritical_one_do_not(sides):
    """The amplitude of a motion is a square root of the distance from a supercritical point, and jumps at a subcritical one."""
    _, found = sides
    kinds = Counter()
    for coefficient, special in found:
        for gap in (5e-5, 2e-4, 1e-3):
            try:
                near, far = (
                    [original(special, special.parameter * (1.0 + sign * size)) for sign in (-1.0, 1.0)]
                    for size in (gap, 4.0 * gap)
                )
            except rk.NoOrbit:
                continue
            if all(sorted(orbit.stable for orbit in pair) == [False, True] for pair in (near, far)):
                # differences of 1e-7 grow enough
                unstable = next(orbit for orbit in near if not orbit.stable)
                if math.log(abs(unstable.multipliers[0])) * 200_000 / unstable.period > 20.0:
                    break
        else:
            continue  # another bifurcation lies as near, or the orbit is unstable on both sides
        stable = next(orbit for orbit in near if orbit.stable)
        assert reached(stable) < 1e-6
        small, large = (reached(next(orbit for orbit in pair if not orbit.stable)) for pair in (near, far))
        assert (large / small > 1.6) == (coefficient > 0.0), (coefficient, special, small, large)
        kinds[coefficient > 0.0] += 1
    assert min(kinds[True], kinds[False]) > 0


def test_folds_of_the_new_orbits_meet_the_curve_at_the_degenerate_point():
    """The distance of the fold is quadratic, so that its root vanishes linearly: extrapolated, and followed to its end."""
    (curve,) = curves_of(*CASES["damped"])
    point = curve.special[0]
    places, roots = [], []
    for index in (point.index + 1, point.index + 2, point.index + 3):
        special = special_at(DAMPED, curve, index)
        born = rk.switch_branch(special, (0.95 * special.parameter, 1.05 * special.parameter), step=2e-3)[0]
        fold = next(one for one in born.special if one.kind == "fold")
        places.append(curve.points[index, 0])
        roots.append(math.sqrt(abs(fold.parameter - special.parameter)))
    found = np.polynomial.Polynomial.fit(roots, places, 2)(0.0)
    assert found == pytest.approx(point.values[0], abs=2e-3)
    folds = rk.bifurcation_curve(fold, *PLANE, ((3.0, 5.0), (1.0, 2.5)))
    # both points are solved on a curve of doublings that begins elsewhere
    assert [one.kind for one in folds.special] == [point.kind, "cusp", point.kind]
    for end, wanted in zip(folds.special[::2], curve.special, strict=True):
        assert np.abs(curve.points[wanted.index] - folds.points[end.index]).max() < 0.1
        for value, error, other in zip(end.values, end.errors, wanted.values, strict=True):
            assert abs(value - other) < 3.0 * error < 1e-12
        assert np.abs(np.array(end.orbit.multipliers) + 1.0).min() < 1e-9


MIRRORED = rk.System(
    rk.Harmonic(2.3086226281641142, period=3.2350318584003417),
    0.8837209091126004,
    rk.Braces(0.5871775574072005, 0.8607171880420696),
)
MERGES = "merges with the branch from which it bifurcates"


@pytest.mark.parametrize("step", [0.003, 0.01, 0.02, 0.04, 0.06, 0.095])
def test_a_curve_of_folds_of_doubled_orbits_ends_where_they_merge_with_any_step(step):
    """With the step 0.02 the kernel passes both points, and follows the same orbits one period later until the loop is closed."""
    (curve,) = curves_of(*CASES["damped"])
    special = special_at(DAMPED, curve, curve.special[0].index + 3)
    born = rk.switch_branch(special, (0.95 * special.parameter, 1.05 * special.parameter), step=2e-3)[0]
    fold = next(one for one in born.special if one.kind == "fold")
    folds = rk.bifurcation_curve(fold, *PLANE, ((3.0, 5.0), (1.0, 2.5)), step)
    assert folds.ends == (MERGES, MERGES)
    assert Counter(one.kind for one in folds.special) == {curve.special[0].kind: 2, "cusp": 1}
    assert [folds.special[0].index, folds.special[-1].index] == [0, len(folds) - 1]
    np.testing.assert_allclose(folds.special[0].values, folds.points[0], atol=0.05)
    np.testing.assert_allclose(folds.special[-1].values, folds.points[-1], atol=0.05)


def test_a_curve_of_folds_ends_where_the_orbits_and_their_mirror_images_meet():
    bounds = 1.2, 3.4
    plane = (2.2645, 4.529), (0.6926, 4.6172)
    found = {
        (special.kind, round(special.parameter, 4)): special
        for branch in branches(MIRRORED, 1, bounds)
        for special in branch.special
    }
    folds = rk.bifurcation_curve(found["fold", 2.2152], *PLANE, plane, 0.02)
    breakings = [
        one
        for (kind, _), special in found.items()
        if kind == "symmetry-breaking" and special.orbit.impacts == folds.impacts
        for one in rk.bifurcation_curve(special, *PLANE, plane, 0.02).special
    ]
    (end,) = (one for one in folds.special if one.kind == "degenerate-symmetry-breaking")
    assert folds.ends[0 if end.index == 0 else 1] == MERGES
    assert end.index in (0, len(folds) - 1)
    off = [
        np.abs(np.subtract(one.values, end.values)) / end.errors for one in breakings if one.kind == end.kind
    ]
    assert min(one.max() for one in off) < 3.0
    assert end.orbit.symmetric


CLOSE = (0.198, 0.08), (0.198, 0.05), (0.1981, 0.05), (0.19813, 0.1), (0.19813, 0.07), (0.19813, 0.02)


@pytest.mark.parametrize("restitution, step", CLOSE)
def test_two_points_within_one_step_are_those_of_small_steps(restitution, step):
    """Both meet at a restitution of 0.19814. With the step 0.002 several points of the curve lie between them."""
    _, _, kind, _, _, plane = CASES["damped"]
    system = rk.System(rk.Harmonic(2.43, period=2.46), restitution)
    special = next(
        one for branch in branches(system, 1, (2.0, 3.0)) for one in branch.special if one.kind == kind
    )
    coarse, fine = (rk.bifurcation_curve(special, *PLANE, plane, each) for each in (step, 0.002))
    first, second = coarse.special
    assert first.index == second.index
    assert (coarse.coefficients > 0.0).all()
    assert len({one.index for one in fine.special}) == 2
    for one, other in zip(coarse.special, fine.special, strict=True):
        for value, again, *errors in zip(one.values, other.values, one.errors, other.errors, strict=True):
            assert abs(value - again) <= sum(errors) < 1e-11


@pytest.mark.parametrize("step", [0.02, 0.08])
def test_no_point_is_found_beyond_the_restitution_at_which_two_meet(step):
    _, _, kind, _, _, plane = CASES["damped"]
    system = rk.System(rk.Harmonic(2.43, period=2.46), 0.1982)
    special = next(
        one for branch in branches(system, 1, (2.0, 3.0)) for one in branch.special if one.kind == kind
    )
    assert not rk.bifurcation_curve(special, *PLANE, plane, step).special


def folds_near(system, curve, period, amplitude):
    """Folds of the branches over the amplitude near a point, each once."""
    found = set()
    for branch in branches(
        at(system, period, amplitude), curve.period, (amplitude * 0.995, amplitude * 1.005), 0.002
    ):
        for special in branch.special:
            off = abs(special.parameter / amplitude - 1.0)
            if (special.kind, special.orbit.impacts) == ("fold", curve.impacts) and off < 1e-3:
                found.add(round(special.parameter, 9))
    return found


def test_two_folds_vanish_at_a_cusp():
    """Branches from a search: two folds on one side of the cusp, and none on the other."""
    system = rk.System(rk.Harmonic(1.402, period=3.23), 0.563)
    curve = next(
        one
        for one in curves_of(system, 2, "fold", (1.2, 1.6), 4, ((2.5, 4.5), (1.0, 2.5)))
        if any(point.kind == "cusp" for point in one.special)
    )
    (point,) = (one for one in curve.special if one.kind == "cusp")
    assert curve.coefficients[point.index - 1] * curve.coefficients[point.index] < 0.0
    period, amplitude = point.values
    before, after = (np.diff(curve.points[point.index + k : point.index + k + 2], axis=0)[0] for k in (-2, 0))
    cosine = before @ after / np.linalg.norm(before) / np.linalg.norm(after)
    assert cosine < 0.0
    # the axis of the cusp is almost that of the curve beside it
    slope = after[1] / after[0]
    sense = np.sign(after[0])
    inside, outside = (
        folds_near(system, curve, period + gap * sense, amplitude + gap * sense * slope)
        for gap in (1e-3, -1e-3)
    )
    assert len(inside) == 2
    assert not outside


def test_errors_cover_the_change_by_another_step():
    system, *rest = CASES["damped"]
    special = next(
        one
        for branch in branches(system, 1, (2.0, 3.0))
        for one in branch.special
        if one.kind == "period-doubling"
    )
    coarse, fine = (
        rk.bifurcation_curve(special, *PLANE, rest[-1], step=step).special for step in (0.01, 0.0037)
    )
    assert len(coarse) == len(fine) == 2
    for one, other in zip(coarse, fine, strict=True):
        for value, again, error in zip(one.values, other.values, one.errors, strict=True):
            assert error < 1e-12
            assert abs(value - again) < 3.0 * error


def test_grazing_curves_meet_the_curves_of_bifurcations():
    """A period-doubling curve ends at a grazing, where the multiplier of the grazing orbit is −1."""
    plane = ((2.5, 4.5), (1.0, 2.5))
    (curve,) = curves_of(DOUBLED, 2, "period-doubling", (1.3, 1.6), 2, plane)
    assert curve.ends[0] == "grazing"
    end = curve.special[0]
    assert (end.kind, end.index) == ("period-doubling-grazing", 0)
    grazings = curves_of(DOUBLED, 2, "grazing", (1.3, 1.6), 2, plane)
    met = [one for each in grazings for one in each.special if one.kind == end.kind]
    assert met
    off = [np.abs(np.subtract(one.values, end.values)) / end.errors for one in met]
    assert min(one.max() for one in off) < 3.0
    assert max(end.errors) < 1e-12
    inner = [one for each in grazings for one in each.special if 0 < one.index < len(each) - 1]
    assert {one.kind for one in inner} == {"fold-grazing", "period-doubling-grazing"}
    for one in inner:
        wanted = 1.0 if one.kind == "fold-grazing" else -1.0
        assert np.abs(np.array(one.orbit.multipliers) - wanted).min() < 1e-9


def test_without_losses_the_coefficient_is_infinite_and_has_its_sign():
    system = rk.System(rk.Harmonic(3.0, period=2.0), 1.0)
    mode = rk.theory.symmetric_modes(3.0, 2.0, 1.0, 1)[-1]
    guess = rk.State(0.0, mode.velocity)
    orbit = rk.find_orbit(at(system, 2.0, 3.0, mode.phase), guess, 1)
    branch = rk.continue_orbit(orbit, "amplitude", (1.0, 12.0))
    special = next(one for one in branch.special if one.kind == "symmetry-breaking")
    curve = rk.bifurcation_curve(special, *PLANE, ((1.8, 2.2), (1.0, 20.0)))
    assert np.isinf(curve.coefficients).all()


def test_dataset_holds_coefficients_and_points():
    (curve,) = curves_of(*CASES["damped"])
    data = curve.to_xarray()
    np.testing.assert_array_equal(data.coefficient, curve.coefficients)
    assert data.special_kind.values.tolist() == [one.kind for one in curve.special]
    assert data.special_period.values.tolist() == [one.values[0] for one in curve.special]
    assert data.special_amplitude_error.values.tolist() == [one.errors[1] for one in curve.special]


PLANES = {
    ("period", "amplitude"): ((3.5, 4.5), (0.9, 2.0)),
    ("frequency", "amplitude"): ((1.3, 1.7), (0.9, 2.0)),
    ("brace_angle", "amplitude"): ((0.3, 0.45), (0.9, 2.0)),
    ("brace_restitution", "amplitude"): ((0.7, 0.95), (0.9, 2.0)),
    ("restitution", "amplitude"): ((0.6, 0.75), (0.9, 2.0)),
}


def test_coefficient_does_not_depend_on_the_plane():
    system, period, kind, bounds, impacts, _ = CASES["braced"]
    special = next(
        one
        for branch in branches(system, period, bounds)
        for one in branch.special
        if (one.kind, one.orbit.impacts) == (kind, impacts)
    )
    found = []
    for names, plane in PLANES.items():
        curve = rk.bifurcation_curve(special, *names, plane)
        assert curve.names == names
        start = np.abs(curve.points[:, 1] - special.parameter) < 1e-12
        found.append(curve.coefficients[start].item())
    np.testing.assert_allclose(found, found[0], rtol=1e-9)


def test_point_on_a_curve_of_grazings_far_from_its_start_is_where_the_folds_end():
    """On the way the turning point that touches moves, and another one comes nearer to its first time."""
    system = rk.System(rk.Harmonic(3.0, period=1.0), 0.8)
    orbit = next(each for each in rk.find_orbits(system, 1) if each.symmetric and each.impacts == 2)
    branch = rk.continue_orbit(orbit, "amplitude", (0.05, 10.0))
    plane = "amplitude", "restitution", ((0.05, 10.0), (0.01, 1.0))
    grazing, fold = (
        next(each for each in branch.special if each.kind == kind) for kind in ("grazing", "fold")
    )
    (point,) = rk.bifurcation_curve(grazing, *plane).special
    ends = [each for each in rk.bifurcation_curve(fold, *plane).special if each.kind == "fold-grazing"]
    assert point.kind == "fold-grazing"
    off = [np.abs(np.subtract(point.values, end.values)) / end.errors for end in ends]
    assert min(each.max() for each in off) < 3.0
    assert max(error for end in ends for error in end.errors) < 1e-12


MET = {
    "period 1": rk.System(rk.Harmonic(5.0, period=2.95), 0.3, rk.Braces(0.51, 0.87)),
    "more losses at the base": rk.System(rk.Harmonic(5.3, period=2.33), 0.54, rk.Braces(0.4, 0.9)),
}


@pytest.mark.parametrize("name", MET)
def test_curves_of_grazings_of_two_contacts_end_at_one_point(name):
    """Each is followed with one contact as its condition, so that the end is where the other one touches."""
    system, ends = MET[name], {}
    amplitude, period = system.forcing.amplitude, system.forcing.period
    plane = (0.7 * period, 1.4 * period), (0.3 * amplitude, 2.0 * amplitude)
    for branch in branches(system, 1, (0.5 * amplitude, 1.5 * amplitude)):
        for special in branch.special:
            if special.kind == "grazing" and special._touch is not None:
                curve = rk.bifurcation_curve(special, *PLANE, plane)
                ends |= {
                    (round(special.parameter, 6), one.index): one
                    for one in curve.special
                    if one.kind == "double-grazing"
                }
    met = [
        (one, other)
        for key, one in ends.items()
        for again, other in ends.items()
        if key[0] < again[0]
        and np.abs(np.subtract(one.values, other.values)).max() < 1e-8
        and max(*one.errors, *other.errors) < 1e-12
    ]
    assert met
    for one, other in met:
        errors = np.add(one.errors, other.errors)
        assert (np.abs(np.subtract(one.values, other.values)) < 3.0 * errors).all()
