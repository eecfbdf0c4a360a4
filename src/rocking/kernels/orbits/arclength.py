"""Steps along a curve of solutions: length, direction and plane of a pseudo-arclength step, in unknowns of unlike kinds."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.numerics.linear_solve import solve


class NewtonWorkspace(NamedTuple):
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


def make_newton_workspace(phases, *scales):
    """Working memory for so many phases, which count as one, and for parameters, each in its own scale."""
    n = phases + len(scales)
    weights = np.append(np.full(phases, 1.0 / phases), [1.0 / scale**2 for scale in scales])
    vectors = (np.zeros(n) for _ in range(5))
    right, misses, aim, trial, kept = vectors
    return NewtonWorkspace(
        weights, np.zeros((n, n)), np.zeros((n, n)), right, misses, np.zeros((n, 7)), aim, trial, kept
    )


@njit(**INTERNAL)
def along(direction, y, origin, weights):
    """How far y lies from ``origin`` along a direction."""
    total = 0.0
    for j in range(direction.shape[0]):
        total += weights[j] * direction[j] * (y[j] - origin[j])
    return total


@njit(**INTERNAL)
def norm(v, weights):
    """Length of a direction."""
    total = 0.0
    for j in range(v.shape[0]):
        total += weights[j] * v[j] * v[j]
    return math.sqrt(total)


@njit(**INTERNAL)
def border(workspace, direction):
    """The equations with the direction as the last row, ready to be solved."""
    n = direction.shape[0]
    for i in range(n - 1):
        for j in range(n):
            workspace.matrix[i, j] = workspace.jacobian[i, j]
    for j in range(n):
        workspace.matrix[n - 1, j] = workspace.weights[j] * direction[j]


@njit(**INTERNAL)
def newton_step(workspace, y, direction):
    """One step of Newton's method, in place, on the equations and on the plane through ``workspace.aim`` across a direction: its size."""
    n = direction.shape[0]
    border(workspace, direction)
    for j in range(n - 1):
        workspace.right[j] = -workspace.misses[j]
    workspace.right[n - 1] = -along(direction, y, workspace.aim, workspace.weights)
    if not solve(workspace.matrix, workspace.right, n):
        return math.inf
    size = 0.0
    for j in range(n):
        y[j] += workspace.right[j]
        # a phase counts in full however many there are
        size = max(size, abs(workspace.right[j]) * min(1.0, math.sqrt(workspace.weights[j] * n)))
    return size


@njit(**INTERNAL)
def turn_direction(direction, workspace):
    """The curve's direction where the equations were last assembled, to the same side as before: in place; False where it has none."""
    n = direction.shape[0]
    border(workspace, direction)
    workspace.right[:] = 0.0
    workspace.right[n - 1] = 1.0
    if not solve(workspace.matrix, workspace.right, n):
        return False
    size = norm(workspace.right, workspace.weights)
    if not 0.0 < size < math.inf:
        return False
    for j in range(n):
        direction[j] = workspace.right[j] / size
    return True
