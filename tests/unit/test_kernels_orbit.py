"""Periodic orbits in the kernels: limits of returns, Newton's method, multipliers and the adapted norm."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.kernels.classify import cascade, periodicity
from rocking.kernels.classify import section as sections
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import UNKNOWN
from rocking.kernels.motion.tangent import Tangent
from rocking.kernels.orbits import floquet, modes, return_map
from rocking.kernels.system import harmonic_parameters

# Its kernels are compiled once, for most of a minute. The tests of the searches run the same code in the fast tests.
pytestmark = pytest.mark.long

RANDOM = np.random.default_rng(1991)
# The sections here hold states, so that no system is needed to evaluate them.
SYSTEM = harmonic_parameters(2.0, 2.0 * math.pi, 1.0, 0.0, 0.925)


# Kernels have no way in from Python but through a compiled function.
@kernel
def closest_return(section, most_lag):
    return sections.closest_return(section, len(section), most_lag)


@kernel
def approached_by(p, section, most_lag):
    return sections.approached(p, section, len(section), 0.0, most_lag)


def approached(section, most_lag):
    return approached_by(SYSTEM, section, most_lag)


@kernel
def multipliers(a, b, c, d):
    return floquet.multipliers(Tangent(a, b, c, d))


@kernel
def adapted_norm(a, b, c, d, radius):
    return floquet.adapted_norm(Tangent(a, b, c, d), radius)


@kernel
def find_fixed_point(p, angle, velocity, cycles, memory):
    found = return_map.find_fixed_point(
        return_map.ReturnMap(p, cycles, 0.0, 1.0),
        return_map.Guess(angle, velocity, UNKNOWN),
        1 << 40,
        return_map.NEARBY,
        memory.trial,
        memory.nothing,
    )
    image = found.image
    return (
        found.converged, found.angle, found.velocity, found.residual, found.error, found.work, image.tangent, image.impacts,
    )  # fmt: skip


@kernel
def nearest(p, order, angle, velocity):
    found = modes.nearest(p, order, angle, velocity)
    return found.distance, found.angle, found.velocity, found.since, found.half


@kernel
def compare(p, section, row, period, angle, velocity, a, b, c, d, impacts):
    image = return_map.MapImage(True, angle, velocity, Tangent(a, b, c, d), impacts, 0, 0.0, UNKNOWN)
    return periodicity.compare(
        p, section, row, period, return_map.FixedPoint(True, angle, velocity, image, 0.0, 0.0, 0)
    )


def linear_returns(matrix, orbit_rows, off, count):
    """Return rows that approach the points of an orbit in turn; a matrix multiplies the distance in each period."""
    lag = len(orbit_rows)
    rows = np.zeros((count, 4))
    for k in range(count):
        rows[k, :2] = orbit_rows[k % lag] + np.linalg.matrix_power(matrix, k // lag) @ off
    return rows


def spiral(radius, turn):
    return radius * np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])


SKEW = np.array([[1.0, 2.0], [0.3, 1.0]])
THREE = np.array([[0.1, 0.2], [0.3, -0.1], [-0.2, 0.05]])


def test_closest_return_is_that_of_the_last_row():
    rows = RANDOM.random((40, 4))
    apart = np.hypot(*(rows[-1, :2] - rows[:-1, :2]).T)[::-1]
    for most in (5, 20, 100):
        lag, distance = closest_return(rows, most)
        assert lag == 1 + np.argmin(apart[:most])
        assert distance == pytest.approx(apart[:most].min(), rel=1e-15, abs=0)
    assert closest_return(rows[:1], 5) == (0, math.inf)
    assert closest_return(rows[[0, 1, 2, 2]], 5) == (1, 0.0)


@pytest.mark.parametrize(
    "matrix",
    [spiral(0.8, 1.1), np.linalg.inv(SKEW) @ np.diag([0.9, -0.5]) @ SKEW, np.array([[0.7, 1.0], [0.0, 0.7]])],
    ids=["spiral", "real", "defective"],
)
@pytest.mark.parametrize("points", [THREE[:1], THREE], ids=["period 1", "period 3"])
def test_linear_returns_foretell_the_orbit_they_come_to_by_its_least_lag(matrix, points):
    rows = linear_returns(matrix, points, np.array([0.02, -0.01]), 24 * len(points))
    off = np.hypot(*(rows[-1, :2] - points[(len(rows) - 1) % len(points)]))
    lag, angle, velocity = approached(rows, 8)
    assert lag == len(points)
    limit = points[(len(rows) - 1) % len(points)]
    assert math.hypot(angle - limit[0], velocity - limit[1]) < 1e-6 * off + 1e-14


def test_returns_along_one_direction_are_a_geometric_series():
    """Far from a fold one multiplier is spent long before the other; a matrix cannot be had from aligned differences."""
    along = np.array([0.6, 0.8])
    rows = np.zeros((12, 4))
    rows[:, :2] = [THREE[0] + 0.1 * 0.9**k * along for k in range(12)]
    assert approached(rows, 4) == pytest.approx((1, *THREE[0]), abs=1e-13)


def test_what_only_turns_about_a_longer_orbit_approaches_nothing():
    rows = linear_returns(spiral(0.999, 2 * math.pi / 7 + 0.01), THREE[:1], np.array([0.02, 0.0]), 40)
    assert approached(rows, 6)[0] == 0


def test_an_orbit_reached_is_its_own_limit():
    exact = linear_returns(np.zeros((2, 2)), THREE, np.zeros(2), 30)
    assert approached(exact, 8) == (3, *exact[-1, :2])


@pytest.mark.parametrize("scale", [1e-8, 1.0, 1e8])
def test_multipliers_are_the_eigenvalues_the_larger_first(scale):
    for _ in range(200):
        matrix = scale * RANDOM.normal(size=(2, 2))
        (a, c), (b, d) = matrix  # the tangent's columns are (a, b) and (c, d)
        real, imaginary, other, other_imaginary = multipliers(a, b, c, d)
        known = sorted(np.linalg.eigvals(matrix), key=lambda value: (-abs(value), -value.imag))
        assert complex(real, imaginary) == pytest.approx(known[0], rel=1e-9, abs=1e-13 * scale)
        assert complex(other, other_imaginary) == pytest.approx(known[1], rel=1e-9, abs=1e-13 * scale)


def test_multipliers_far_apart_keep_the_digits_of_the_small_one():
    assert multipliers(0.5, 1.0, 0.0, 1e-14) == pytest.approx((0.5, 0.0, 1e-14, 0.0), rel=1e-12, abs=0)
    assert multipliers(0.0, 0.0, 0.0, 0.0) == (0.0, 0.0, 0.0, 0.0)
    assert multipliers(2.0, 0.0, 1.0, 2.0) == (2.0, 0.0, 2.0, 0.0)


def test_in_the_adapted_norm_every_vector_shrinks_at_least_as_fast_as_asked():
    cases = [RANDOM.normal(size=(2, 2)) for _ in range(100)]
    cases += [np.array([[1.0, 1e3], [0.0, 1.0]]), np.array([[1.0, 1e3], [0.0, 1.0 - 1e-9]]), spiral(1.0, 3.0)]
    for case in cases:
        matrix = case * 0.9 / np.abs(np.linalg.eigvals(case)).max()
        (a, c), (b, d) = matrix
        q11, q12, q22 = adapted_norm(a, b, c, d, 0.95)
        norm = np.array([[q11, q12], [q12, q22]])
        for x in (RANDOM.normal(size=2) for _ in range(20)):
            image = matrix @ x
            assert image @ norm @ image <= 0.95**2 * (x @ norm @ x) * (1 + 1e-9)


def mode_1_1(amplitude, period, e):
    """Return (parameters, state, half-cycle trace) of the stable mode (1, 1) a quarter cycle after an impact, eqs. (5), (8)-(10)."""
    omega = 2 * math.pi / period
    h, beta = math.pi / omega, amplitude / (1 + omega**2)
    t, sinh, cosh = math.tanh(h / 2), math.sinh(h), math.cosh(h)
    less, more = (1 - e) / (2 * e), (1 + e) / (2 * e)
    square, half = (omega * t * less) ** 2 + more**2, t * more
    speed = (half + math.sqrt(half**2 - square * (t**2 - (omega * beta) ** 2))) / square
    phase = math.atan2((t - speed * more) / omega, -t * speed * less)
    trace = -2 * e * cosh + e * (1 + e) * sinh / speed - sinh * t * (1 - e) ** 2 * (1 + omega**2) / 2
    s, now = period / 4, phase + math.pi / 2
    angle = (
        speed * math.sinh(s) - math.cosh(s) + 1
        + beta * (math.cos(now) - math.cos(phase) * math.cosh(s) + omega * math.sin(phase) * math.sinh(s))
    )  # fmt: skip
    velocity = (
        speed * math.cosh(s) - math.sinh(s)
        + beta * (-omega * math.sin(now) - math.cos(phase) * math.sinh(s) + omega * math.sin(phase) * math.cosh(s))
    )  # fmt: skip
    return harmonic_parameters(amplitude, omega, period, now, e), (angle, velocity), trace


@pytest.mark.parametrize(
    ("amplitude", "period", "e"), [(2.0, 1.0, 0.925), (10.0, 1.0, 0.8), (5.0, 2.0, 0.9), (2.0, 1.0, 1.0)]
)
def test_newtons_method_finds_the_mode_of_the_closed_form_with_its_multipliers(amplitude, period, e):
    p, (angle, velocity), trace = mode_1_1(amplitude, period, e)
    converged, *state, residual, error, work, tangent, impacts = find_fixed_point(
        p, angle + 3e-3, velocity - 2e-3, 1, cascade.make_workspace(100, 8)
    )
    a, b, c, d = tangent
    assert converged
    assert impacts == 2
    assert work % 2 == 0
    assert 0 < work <= 20
    # two half cycles, each negated: eigenvalues squared
    assert a + d == pytest.approx(trace**2 - 2 * e**2, abs=1e-9 * max(1, abs(a), abs(c)))
    assert a * d - b * c == pytest.approx(e**4, abs=1e-10 * max(1, abs(a), abs(c)) ** 2)
    assert residual <= 1e-12 * max(1, abs(a), abs(b), abs(c), abs(d))
    assert math.dist(state, (angle, velocity)) < 1e-11 + 10 * error


@pytest.mark.parametrize(
    ("amplitude", "period", "e"), [(2.0, 1.0, 0.925), (10.0, 1.0, 0.8), (5.0, 2.0, 0.9), (2.0, 1.0, 1.0)]
)
@pytest.mark.parametrize("mirrored", [False, True])
def test_the_state_of_a_mode_is_that_of_the_closed_form_on_either_side(amplitude, period, e, mirrored):
    p, state, _ = mode_1_1(amplitude, period, e)
    if mirrored:
        turned = p.forcing._replace(phase=p.forcing.phase + math.pi)
        p, state = p._replace(forcing=turned), (-state[0], -state[1])
    off = np.array([3e-3, -4e-3])
    distance, angle, velocity, since, half = nearest(p, 1, *(np.array(state) + off))
    assert distance == pytest.approx(5e-3, rel=1e-9)
    assert (angle, velocity) == pytest.approx(state, rel=1e-12, abs=1e-14)
    assert half == pytest.approx(period / 2, rel=1e-15, abs=0)
    assert since == pytest.approx(period / 4 + (half if mirrored else 0.0) % half, rel=1e-9)


@pytest.mark.parametrize("phase", [0.0, 2.0, -1.0, 5.5])
def test_of_the_three_states_of_a_mode_the_nearest_is_told(phase):
    """The orbit's own states are marched from one of them: fixed points of three cycles, two impacts round."""
    system = rk.System(rk.Harmonic(6.5, period=0.4, phase=phase), 0.925)
    p = harmonic_parameters(6.5, 2 * math.pi / 0.4, 0.4, phase, 0.925)
    _, *state, _, _ = nearest(p, 3, 0.0, 0.0)
    converged, *found, residual, _, _, _, impacts = find_fixed_point(
        p, *state, 3, cascade.make_workspace(100, 8)
    )
    assert converged
    assert found == state
    assert residual < 1e-14
    assert impacts == 2
    states = rk.simulate(system, rk.State(*state), cycles=2, record="section").section()
    assert len(np.unique(states.round(6), axis=0)) == 3
    for other in states:
        for off in RANDOM.normal(scale=0.02, size=(4, 2)):
            wanted = other + off
            away = np.hypot(*(states - wanted).T)
            distance, angle, velocity, _, _ = nearest(p, 3, *wanted)
            assert distance == pytest.approx(away.min(), rel=1e-9)
            assert (angle, velocity) == pytest.approx(tuple(states[away.argmin()]), abs=1e-12)


@pytest.mark.parametrize(
    ("period", "e", "order"), [(1.0, 0.8, 1), (0.4, 0.925, 3), (0.01, 0.2, 1), (0.3, 0.6, 3)]
)
def test_a_mode_that_repels_is_no_place_to_begin_at(period, e, order):
    """Beyond A_SB it lies between the two asymmetric orbits that attract."""
    breaks = rk.theory.symmetry_breaking_amplitude(period, e, order)
    there = [
        nearest(harmonic_parameters(share * breaks, 2 * math.pi / period, period, 0.3, e), order, 0.0, 0.0)[0]
        for share in (1 - 1e-6, 1 + 1e-6)
    ]
    assert there[0] < math.inf
    assert there[1] == math.inf


def test_there_is_no_mode_of_even_order_below_the_fold_or_without_restitution():
    p = harmonic_parameters(2.0, 2 * math.pi, 1.0, 0.3, 0.925)
    assert nearest(p, 1, 0.0, 0.0)[0] < math.inf
    assert nearest(p, 2, 0.0, 0.0)[0] == math.inf
    assert nearest(p, 0, 0.0, 0.0)[0] == math.inf
    fold = rk.theory.existence_amplitude(1.0, 0.925, 1)
    for amplitude, e, there in ((0.999 * fold, 0.925, False), (1.001 * fold, 0.925, True), (2.0, 0.0, False)):
        p = harmonic_parameters(amplitude, 2 * math.pi, 1.0, 0.3, e)
        assert (nearest(p, 1, 0.0, 0.0)[0] < math.inf) == there


@pytest.mark.parametrize("period", [1, 3])
@pytest.mark.parametrize("turn", [0.0, 1.1])
def test_the_cycle_at_which_an_orbit_is_reached_is_foretold(period, turn):
    """Returns that obey multipliers but for a term of second order: what they are off by halves with the distance."""
    radius = 0.8
    matrix = spiral(radius, turn) if turn else np.diag([radius, 0.1])
    (a, c), (b, d) = matrix
    p = harmonic_parameters(2.0, 2 * math.pi, 1.0, 0.3, 0.925)
    fixed, x, rows = np.array([0.5, 0.7]), np.array([0.3, 0.0]), np.zeros((60 * period, 4))
    for k in range(60):
        rows[k * period : (k + 1) * period, :2] = fixed + x
        rows[k * period : (k + 1) * period, 2] = 2 * k
        x = matrix @ x + 0.5 * np.array([x @ x, 0.0])
    answers = {
        row: compare(p, rows, row, period, *fixed, a, b, c, d, 2)
        for row in range(3 * period, len(rows), period)
    }
    reached = min(row for row, (answer, _, _) in answers.items() if answer == periodicity.REACHED)
    assert reached >= 8 * period
    for row, (answer, _, coming) in answers.items():
        if row < reached:
            assert answer == periodicity.NOT_YET
            assert coming % period == 0
            assert row + coming <= reached + period
            # further away the distance shrinks at a rate different from that of the multipliers
            if row >= reached - 5 * period:
                assert row + coming >= reached - period
        else:
            assert (answer, coming) == (periodicity.REACHED, 0)


def test_of_a_motion_that_comes_no_nearer_nothing_is_foretold():
    p, rows = harmonic_parameters(2.0, 2 * math.pi, 1.0, 0.3, 0.925), np.zeros((20, 4))
    rows[:, :2] = [(0.5 + 0.2 * 0.9999**k, 0.7) for k in range(20)]
    rows[:, 2] = 2 * np.arange(20)
    answer, distance, coming = compare(p, rows, 19, 1, 0.5, 0.7, 0.8, 0.0, 0.0, 0.1, 2)
    assert (answer, coming) == (periodicity.NOT_YET, 0)
    assert distance == pytest.approx(0.2 * 0.9999**18, rel=1e-12)


def test_newtons_method_gives_up_where_the_block_overturns():
    p = harmonic_parameters(1.75, math.pi, 2.0, 0.0, 0.95)
    assert not find_fixed_point(p, 0.9, 0.5, 3, cascade.make_workspace(100, 8))[0]


@pytest.mark.parametrize("mirrored", [False, True])
def test_multipliers_by_trace_and_determinant_are_the_eigenvalues(mirrored):
    """Against numpy's, of the matrix or of its square; the larger first, of conjugate ones that above the real axis."""
    random = np.random.default_rng(8)
    pairs = 0
    for _ in range(300):
        matrix = random.normal(size=(2, 2))
        half, determinant = 0.5 * float(np.trace(matrix)), float(np.linalg.det(matrix))
        found = floquet.complex_multipliers(half, half * half - determinant, determinant, mirrored)
        expected = np.linalg.eigvals(matrix @ matrix if mirrored else matrix)
        order = (lambda value: -value.imag) if np.iscomplexobj(expected) else (lambda value: -abs(value))
        assert found == pytest.approx(
            sorted(expected, key=order), abs=1e-12 * (1.0 + abs(expected).max()) ** 2
        )
        # no negative zeros
        assert np.iscomplexobj(expected) or "-0j" not in f"{found}"
        pairs += np.iscomplexobj(expected)
    assert 50 < pairs < 250


@kernel
def closed_and_marched(p, order, memory):
    """Return the fixed points of a mode by its closed form and by Newton's method, and whether the mode exists."""
    mode = modes.nearest(p, order, 0.0, 0.0)
    guess = return_map.Guess(mode.angle, mode.velocity, (mode.half - mode.since, mode.half))
    mapping = return_map.ReturnMap(p, order, 0.0, 1.0)
    marched = return_map.find_fixed_point(
        mapping, guess, 1 << 40, return_map.NEARBY, memory.trial, memory.nothing
    )
    closed = modes.orbit_of_mode(p, mode)
    return (
        mode.distance < math.inf,
        closed.converged,
        marched.converged and marched.image.impacts == 2,
        (closed.angle - marched.angle, closed.velocity - marched.velocity),
        closed.image.tangent,
        marched.image.tangent,
        closed.residual,
    )


@pytest.mark.parametrize(("order", "true", "false"), [(1, 200, 0), (3, 40, 20), (5, 30, 0)])
def test_mode_is_a_fixed_point_without_a_march_unless_an_impact_comes_earlier(order, true, false):
    """Closed form and march agree on the orbit and its derivative. Where they do not, the search finds an earlier impact."""
    memory, random = cascade.make_workspace(1000, 64), np.random.default_rng(2)
    seen = {True: 0, False: 0}
    for _ in range(1500):
        period = 10.0 ** random.uniform(-0.7, 0.6)
        p = harmonic_parameters(
            random.uniform(1, 20), math.tau / period, period, random.uniform(-3, 3), random.uniform(0.3, 0.99)
        )
        exists, closed, marched, off, tangent, other, residual = closed_and_marched(p, order, memory)
        if not exists:
            continue
        assert closed == marched
        seen[closed] += 1
        if closed:
            size = max(map(abs, other))
            assert max(map(abs, off)) <= 1e-12 * max(1.0, size)
            # the derivative is a product of matrices as large as the growth on an arc
            growth = math.exp(0.5 * order * period)
            assert np.abs(np.subtract(tangent, other)).max() <= 1e-11 * max(size, growth)
            assert residual <= 1e-13 * max(1.0, size)
    assert seen[True] >= true
    assert seen[False] >= false
