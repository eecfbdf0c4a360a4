"""Pseudo-arclength continuation of closed chains of arcs through one parameter or two: predictor, corrector, direction, length."""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import ALLOCATING, INTERNAL
from rocking.kernels.numerics.linear_solve import solve
from rocking.kernels.orbits.event_chain import Chain, Equations, make_equations, with_value
from rocking.kernels.parameters import HarmonicParameters

MAX_CORRECTIONS = 10
CONVERGED = 1e-11
# A point that took no more corrections than this is followed by a longer step.
FEW_CORRECTIONS = 4
GROW, SHRINK = 1.4, 0.5
# The shortest step against the longest.
MIN_STEP = 1e-12
# The cosine of the angle between the directions of two neighbouring points is greater than this.
MIN_COSINE = 0.97
# Steps this short against the longest end on a grazing.
GRAZING_STEP = 1e-3
# A curve that returns to its start has more points than this.
MIN_LOOP = 8


class End(IntEnum):
    """Why a curve ends."""

    GOING = -1  # it does not
    RANGE = 0
    GRAZED = 1
    MERGED = 2
    CLOSED = 3
    MANY = 4  # as many points as were asked for
    LOST = 5


class Workspace(NamedTuple):
    """Working memory for n unknowns, the phases and the parameters of a chain."""

    weights: np.ndarray  # of the square of each unknown in the square of a length
    equations: Equations
    differences: Equations  # at points nearby
    matrix: np.ndarray
    right: np.ndarray
    predicted: np.ndarray  # the point predicted
    corrected: np.ndarray  # the point corrected
    direction: np.ndarray  # the curve's direction there


class Problem(NamedTuple):
    """What does not change along a curve of chains of k events; a point y has k phases, then one or two parameters."""

    p: HarmonicParameters
    chain: Chain
    which: tuple  # the parameters
    limits: tuple  # (lowest, highest) of each
    longest: float  # length of a step
    workspace: Workspace


class Tangent(NamedTuple):
    """A point of a curve and the curve's direction there, of length 1."""

    point: np.ndarray
    direction: np.ndarray


def make_workspace(phases, scales):
    """Return working memory for so many phases, which count as one, and for parameters, each in its own scale."""
    n = phases + len(scales)
    weights = np.full(n, 1.0 / phases)
    weights[phases:] = [1.0 / scale**2 for scale in scales]
    return Workspace(weights, make_equations(n), make_equations(n), np.zeros((n, n)), *np.zeros((4, n)))


@njit(**INTERNAL)
def system_at(problem, y):
    """The system at a point."""
    system, k = problem.p, problem.chain.kinds.shape[0]
    for i in range(len(problem.which)):
        system = with_value(system, problem.which[i], y[k + i])
    return system


@njit(**INTERNAL)
def crossed_limit(problem, y):
    """(index of the unknown, its limit) where a parameter lies outside its range; index -1 where none does."""
    k = problem.chain.kinds.shape[0]
    for i in range(len(problem.limits)):
        low, high = problem.limits[i]
        if not low <= y[k + i] <= high:
            return k + i, (low if y[k + i] < low else high)
    return -1, 0.0


@njit(**INTERNAL)
def within_bounds(problem, y):
    """Whether no parameter lies beyond its range by more than two steps: a limit is found from both of its sides."""
    k = problem.chain.kinds.shape[0]
    for i in range(len(problem.limits)):
        low, high = problem.limits[i]
        beyond = 2.0 * problem.longest * (high - low)
        if not max(low - beyond, 0.5 * low) <= y[k + i] <= high + beyond:
            return False
    return True


@njit(**INTERNAL)
def inner(a, b, weights):
    """The scalar product of two directions."""
    total = 0.0
    for j in range(a.shape[0]):
        total += weights[j] * a[j] * b[j]
    return total


@njit(**INTERNAL)
def border(workspace, direction):
    """The equations with the direction as the last row, ready to be solved."""
    n = direction.shape[0]
    for i in range(n - 1):
        for j in range(n):
            workspace.matrix[i, j] = workspace.equations.jacobian[i, j]
    for j in range(n):
        workspace.matrix[n - 1, j] = workspace.weights[j] * direction[j]


@njit(**INTERNAL)
def newton_step(workspace, y, direction):
    """Make one step of Newton's method, in place, on the equations and on the plane across ``direction``; return its size.

    The plane goes through ``workspace.predicted``.
    """
    n, right = direction.shape[0], workspace.right
    border(workspace, direction)
    for j in range(n):
        right[j] = y[j] - workspace.predicted[j]
    right[n - 1] = -inner(direction, right, workspace.weights)
    for j in range(n - 1):
        right[j] = -workspace.equations.residuals[j]
    if not solve(workspace.matrix, right, n):
        return math.inf
    size = 0.0
    for j in range(n):
        y[j] += right[j]
        # a phase counts in full however many there are
        size = max(size, abs(right[j]) * min(1.0, math.sqrt(workspace.weights[j] * n)))
    return size


@njit(**INTERNAL)
def correct(assemble, problem, y, direction, condition):
    """Correct ``y`` by Newton's method, in place, in the plane across ``direction``: (corrections, condition).

    The number of corrections is -1 where the method fails. ``assemble`` (problem, y, condition) writes the equations into
    the workspace. It returns whether they exist at y, and the condition with the time of its touch there.
    """
    before, converged = math.inf, False
    for corrections in range(MAX_CORRECTIONS):
        if not within_bounds(problem, y):
            break
        valid, condition = assemble(problem, y, condition)
        if not valid:
            break
        if converged:
            return corrections, condition
        size = newton_step(problem.workspace, y, direction)
        if not size < math.inf:
            break
        converged = size <= CONVERGED or (size <= 100.0 * CONVERGED and size >= 0.5 * before)
        before = size
    return -1, condition


@njit(**INTERNAL)
def predict(tangent, length, workspace):
    """Write the point a length further along a tangent into ``workspace.predicted`` and ``workspace.corrected``."""
    for j in range(tangent.point.shape[0]):
        workspace.predicted[j] = tangent.point[j] + length * tangent.direction[j]
        workspace.corrected[j] = workspace.predicted[j]


@njit(**INTERNAL)
def find_direction(direction, workspace):
    """Write the curve's direction at the point last assembled into ``workspace.direction``; False where there is none.

    Of the two senses it has that of ``direction``.
    """
    n, right = direction.shape[0], workspace.right
    border(workspace, direction)
    right[:] = 0.0
    right[n - 1] = 1.0
    if not solve(workspace.matrix, right, n):
        return False
    size = math.sqrt(inner(right, right, workspace.weights))
    for j in range(n):
        workspace.direction[j] = right[j] / size
    return 0.0 < size < math.inf


@njit(**INTERNAL)
def bends_little(direction, workspace):
    """Whether the direction at the point last assembled, left in ``workspace.direction``, is close to ``direction``."""
    return (
        find_direction(direction, workspace)
        and inner(workspace.direction, direction, workspace.weights) > MIN_COSINE
    )


@njit(**ALLOCATING)
def has_closed(start, points, count, problem):
    """Whether a curve has returned to its start between the last two of so many points."""
    if count <= MIN_LOOP:
        return False
    weights = problem.workspace.weights
    before, now = points[count - 2] - start.point, points[count - 1] - start.point
    passes = inner(start.direction, before, weights) < 0.0 <= inner(start.direction, now, weights)
    return passes and math.sqrt(inner(now, now, weights)) < 2.0 * problem.longest


@njit(**INTERNAL)
def next_length(problem, length, corrections):
    """The length of the next step after one that took so many corrections."""
    return min(length * (GROW if corrections <= FEW_CORRECTIONS else 1.0), problem.longest)
