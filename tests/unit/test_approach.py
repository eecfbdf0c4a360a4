"""Test to second order that a motion cannot turn away from an orbit, on maps whose terms are given, iterated to their end."""

import math

import numpy as np
import pytest

from rocking.kernels.classify import approach
from rocking.kernels.classify.periodicity import BENT
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.tangent import Tangent
from rocking.kernels.orbits.return_map import FixedPoint, MapImage

RETURNS = 3_000
FAR = 10.0
REAL, COMPLEX, BALL = range(3)


@kernel
def excess(which, bend, tangent, first, second, x, y):
    """Return the terms over their limit; the multipliers are real, or ``first`` +- i ``second``."""
    if which == REAL:
        return approach.excess_of_real(bend, tangent, first, second, x, y, 0.0)[0]
    if which == COMPLEX:
        return approach.excess_of_complex(bend, tangent, first, second, x, y)
    return approach.excess_in_ball(bend, tangent, max(abs(first), abs(second)), x, y, 0.0)


@kernel
def slow_part_shrinks(section, row, tangent, rho, sigma):
    image = MapImage(True, 0.0, 0.0, tangent, 2, 0, math.nan, (0.0, 0.0))
    return approach.slow_part_shrinks(
        section, row, 1, FixedPoint(True, 0.0, 0.0, image, 0.0, 0.0, 0), rho, sigma
    )


def maps(which, count, seed):
    """Yield multipliers, Jacobian (2, 2), second derivative (2, 2, 2) and a state of quadratic maps in skew coordinates."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        if which == COMPLEX:
            first, second = np.array([math.cos(turn := rng.uniform(0.02, 3)), math.sin(turn)]) * (
                1 - 10 ** rng.uniform(-2, -0.5)
            )
            plain = np.array([[first, -second], [second, first]])
        else:
            first = (1 - 10 ** rng.uniform(-2, -0.5)) * rng.choice([-1, 1], p=[0.2, 0.8])
            second = first * rng.uniform(0.0, 0.9)
            plain = np.diag([first, second])
        basis = rng.normal(size=(2, 2))
        jacobian = basis @ plain @ np.linalg.inv(basis)
        bend = rng.normal(size=(2, 2, 2)) * 10 ** rng.uniform(-1, 1)
        bend = bend + bend.transpose(0, 2, 1)
        state = rng.normal(size=2) * 10 ** rng.uniform(-4, 0)
        # as ``periodicity.compare`` demands: a return deviates little from the linear map, in coordinates of the eigenvectors
        off = np.linalg.solve(basis, 0.5 * (bend @ state @ state))
        if np.hypot(*off) <= BENT * np.hypot(*np.linalg.solve(basis, state)):
            yield first, second, jacobian, bend, state


def converges(jacobian, bend, state):
    """Follow z -> J z + D2P(z, z)/2 to its end."""
    for _ in range(RETURNS):
        state = jacobian @ state + 0.5 * (bend @ state @ state)
        if not 1e-8 < np.hypot(*state) < FAR:
            break
    return bool(np.hypot(*state) <= 1e-8)


def tangent_of(matrix):
    """Return a matrix as the kernels have it, by columns."""
    return Tangent(*(float(value) for value in matrix.T.ravel()))


@pytest.mark.parametrize("which", [REAL, COMPLEX, BALL])
def test_no_state_below_the_limit_leaves_its_fixed_point(which):
    """More than a tenth of the states that converge must be accepted, because a limit of zero accepts none."""
    accepted, converging = 0, 0
    for first, second, jacobian, bend, state in maps(which, 500, 17):
        curvature = approach.Curvature(True, tangent_of(bend[:, :, 0]), tangent_of(bend[:, :, 1]))
        below = excess(which, curvature, tangent_of(jacobian), first, second, *map(float, state)) <= 1.0
        ends = converges(jacobian, bend, state)
        assert ends or not below, (first, second, jacobian, bend, state)
        accepted, converging = accepted + below, converging + ends
    assert accepted > 0.1 * converging > 10


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("start", [0.1, 0.5, 0.8, 0.95, 1.05])
def test_third_order_terms_are_seen_in_the_last_returns(sign, start):
    """u' = ρ u + c u³ has unstable points, or for ρ < 0 an unstable cycle, at u_s. Beyond it, and next to it, nothing shrinks."""
    rho, sigma, cubic = sign * 0.99, sign * 0.3, sign * 4.0
    unstable = math.sqrt((1.0 - abs(rho)) / abs(cubic))
    states = [(start * unstable, 0.0)]
    for _ in range(3):
        u, s = states[-1]
        states.append((rho * u + cubic * u**3, sigma * s))
    section = np.array(states)
    shrinks = slow_part_shrinks(section, 3, Tangent(rho, 0.0, 0.0, sigma), rho, sigma)
    assert shrinks == (start <= 0.8)


def test_a_fast_part_does_not_hide_that_the_slow_part_grows():
    """u' = ρ u + a s with s' = σ s: the fast part pushes u inwards at first, and outwards of what remains of it."""
    rho, sigma = 0.999, 0.6
    states = [(1.0, 0.5)]
    for _ in range(3):
        u, s = states[-1]
        states.append((1.002 * u - 0.05 * s, sigma * s))  # it grows by 0.2 % where ρ predicts that it shrinks
    assert not slow_part_shrinks(np.array(states), 3, Tangent(rho, 0.0, 0.0, sigma), rho, sigma)


def test_terms_for_complex_multipliers_are_those_of_the_coordinates_that_remove_them():
    """Computed with complex numbers: u' = λ u + f u² + g u ū + h ū² in the eigenvectors that NumPy finds."""
    for _, _, jacobian, bend, state in maps(COMPLEX, 300, 9):
        values, vectors = np.linalg.eig(jacobian)
        value, (v, w) = values[0], vectors.T
        f, g, h = (np.linalg.solve(vectors, bend @ y @ x)[0] for x, y in ((v, v), (v, w), (w, w)))
        poles = value - value**2, value - abs(value) ** 2, value - np.conj(value) ** 2
        terms = abs(0.5 * f / poles[0]) + abs(g / poles[1]) + abs(0.5 * h / poles[2])
        expected = terms * abs(np.linalg.solve(vectors, state)[0]) / approach.BENDING
        curvature = approach.Curvature(True, tangent_of(bend[:, :, 0]), tangent_of(bend[:, :, 1]))
        found = excess(
            COMPLEX, curvature, tangent_of(jacobian), float(value.real), abs(float(value.imag)), *state
        )
        assert found == pytest.approx(expected, rel=1e-9, abs=0.0)


@kernel
def from_returns(section, tangent):
    image = MapImage(True, 0.0, 0.0, tangent, 2, 0, math.nan, (0.0, 0.0))
    return approach.curvature_of_returns(section, 3, 1, FixedPoint(True, 0.0, 0.0, image, 0.0, 0.0, 0))


def test_three_returns_in_distinct_directions_give_the_second_derivative():
    known = 0
    for _, _, jacobian, bend, state in maps(COMPLEX, 300, 5):
        states = [state]
        for _ in range(3):
            states.append(jacobian @ states[-1] + 0.5 * (bend @ states[-1] @ states[-1]))
        found = from_returns(np.array(states), tangent_of(jacobian))
        if found.known:
            known += 1
            rounding = 1e-14 / np.hypot(*np.transpose(states)).min() / approach.SPREAD**2
            expected = np.array([tangent_of(bend[:, :, 0]), tangent_of(bend[:, :, 1])])
            assert np.array([found.by_angle, found.by_velocity]) == pytest.approx(
                expected, abs=rounding, rel=1e-8
            )
    assert known > 50
