"""Steps along a curve of solutions: length, direction and plane of a pseudo-arclength step, in unknowns of unlike kinds."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import WITHIN
from rocking.kernels.numerics.linear_solve import solve


class Desk(NamedTuple):
    """Working memory for n unknowns."""

    weights: np.ndarray  # of the square of each unknown in the square of a length
    jacobian: np.ndarray
    matrix: np.ndarray
    right: np.ndarray
    misses: np.ndarray
    links: np.ndarray
    aim: np.ndarray
    trial: np.ndarray
    kept: np.ndarray


def desk(phases, *scales):
    """Working memory for so many phases, which count as one, and for parameters, each in its own scale."""
    n = phases + len(scales)
    weights = np.append(np.full(phases, 1.0 / phases), [1.0 / scale**2 for scale in scales])
    vectors = (np.zeros(n) for _ in range(5))
    right, misses, aim, trial, kept = vectors
    return Desk(
        weights, np.zeros((n, n)), np.zeros((n, n)), right, misses, np.zeros((n, 7)), aim, trial, kept
    )


@njit(**WITHIN)
def along(direction, y, origin, weights):
    """How far y lies from ``origin`` along a direction."""
    total = 0.0
    for j in range(direction.shape[0]):
        total += weights[j] * direction[j] * (y[j] - origin[j])
    return total


@njit(**WITHIN)
def norm(v, weights):
    """Length of a direction."""
    total = 0.0
    for j in range(v.shape[0]):
        total += weights[j] * v[j] * v[j]
    return math.sqrt(total)


@njit(**WITHIN)
def border(desk, direction):
    """The equations with the direction as the last row, ready to be solved."""
    n = direction.shape[0]
    for i in range(n - 1):
        for j in range(n):
            desk.matrix[i, j] = desk.jacobian[i, j]
    for j in range(n):
        desk.matrix[n - 1, j] = desk.weights[j] * direction[j]


@njit(**WITHIN)
def newton_step(desk, y, direction):
    """One step of Newton's method, in place, on the equations and on the plane through ``desk.aim`` across a direction: its size."""
    n = direction.shape[0]
    border(desk, direction)
    for j in range(n - 1):
        desk.right[j] = -desk.misses[j]
    desk.right[n - 1] = -along(direction, y, desk.aim, desk.weights)
    if not solve(desk.matrix, desk.right, n):
        return math.inf
    size = 0.0
    for j in range(n):
        y[j] += desk.right[j]
        # a phase counts in full however many there are
        size = max(size, abs(desk.right[j]) * min(1.0, math.sqrt(desk.weights[j] * n)))
    return size


@njit(**WITHIN)
def turn_direction(direction, desk):
    """The curve's direction where the equations were last assembled, to the same side as before: in place; False where it has none."""
    n = direction.shape[0]
    border(desk, direction)
    desk.right[:] = 0.0
    desk.right[n - 1] = 1.0
    if not solve(desk.matrix, desk.right, n):
        return False
    size = norm(desk.right, desk.weights)
    if not 0.0 < size < math.inf:
        return False
    for j in range(n):
        direction[j] = desk.right[j] / size
    return True
