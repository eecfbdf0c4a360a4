"""Pseudo-arclength continuation of closed event chains in one or two parameters.

This module holds the predictor, the corrector, the direction and the step length.
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2, Integers1
from rocking.kernels.numerics.dense import solve
from rocking.kernels.orbits.chain import Chain, Equations, make_equations, with_value
from rocking.kernels.system import Cosine, Slender

MAX_CORRECTIONS = 10
CONVERGED = 1e-11
# If a point took no more corrections than this, the next step is longer.
FEW_CORRECTIONS = 4
GROW, SHRINK = 1.4, 0.5
# Shortest step, relative to the longest.
MIN_STEP = 1e-12
# Lower bound on the cosine of the angle between the directions at two neighbouring points.
MIN_COSINE = 0.97
# Steps shorter than this, relative to the longest, end at a grazing.
GRAZING_STEP = 1e-3
# Minimum number of points of a closed curve.
MIN_LOOP = 8


class End(IntEnum):
    """Reason why a curve ends."""

    GOING = -1  # the curve continues
    RANGE = 0
    GRAZED = 1
    MERGED = 2
    CLOSED = 3
    MANY = 4  # the requested number of points
    LOST = 5


class Workspace(NamedTuple):
    """Working memory for n unknowns: the phases and the parameters of a chain."""

    weights: Floats1  # weight of the square of each unknown in the squared length
    equations: Equations
    differences: Equations  # at neighbouring points, for finite differences
    matrix: Floats2
    right: Floats1
    predicted: Floats1  # the point predicted
    corrected: Floats1  # the point corrected
    direction: Floats1  # the curve's direction there
    along: Floats1  # the direction at the point before
    first: Floats1  # the direction at the first point


class Problem(NamedTuple):
    """Constant data along a curve of chains of k events; a point y has k phases, then one or two parameters."""

    p: Slender[Cosine]
    chain: Chain
    which: Integers1  # (1,) or (2,), the parameters that vary
    limits: Floats2  # (lowest, highest) of each parameter
    longest: float  # greatest length of a step
    workspace: Workspace


class Tangent(NamedTuple):
    """Point of a curve and the direction of the curve there, of length 1."""

    point: Floats1
    direction: Floats1


def make_workspace(phases, scales):
    """Return working memory for the given number of phases and for parameters with the given scales.

    The weights of all phases together equal that of one parameter of scale 1.
    """
    n = phases + len(scales)
    weights = np.full(n, 1.0 / phases)
    weights[phases:] = [1.0 / scale**2 for scale in scales]
    return Workspace(weights, make_equations(n), make_equations(n), np.zeros((n, n)), *np.zeros((6, n)))


@kernel
def system_at(problem, y):
    """Return the system at a point."""
    system, k = problem.p, problem.chain.kinds.shape[0]
    for i in range(problem.which.shape[0]):
        system = with_value(system, problem.which[i], y[k + i])
    return system


@kernel
def crossed_limit(problem, y):
    """Find a parameter outside its range.

    Returns
    -------
    tuple of (int, float)
        Index of the unknown, -1 if all are inside.
        The limit that it has crossed.
    """
    k = problem.chain.kinds.shape[0]
    for i in range(problem.limits.shape[0]):
        low, high = problem.limits[i, 0], problem.limits[i, 1]
        if not low <= y[k + i] <= high:
            return k + i, (low if y[k + i] < low else high)
    return -1, 0.0


@kernel
def within_bounds(problem, y):
    """Return whether every parameter exceeds its range by two steps at most.

    The margin is needed because a limit is found from both of its sides.
    """
    k = problem.chain.kinds.shape[0]
    for i in range(problem.limits.shape[0]):
        low, high = problem.limits[i, 0], problem.limits[i, 1]
        beyond = 2.0 * problem.longest * (high - low)
        if not max(low - beyond, 0.5 * low) <= y[k + i] <= high + beyond:
            return False
    return True


@kernel
def inner(a, b, weights):
    """Return the scalar product of two directions."""
    total = 0.0
    for j in range(a.shape[0]):
        total += weights[j] * a[j] * b[j]
    return total


@kernel
def border(workspace, direction):
    """Write the equations, with the direction as their last row, into the matrix to be solved."""
    n = direction.shape[0]
    for i in range(n - 1):
        for j in range(n):
            workspace.matrix[i, j] = workspace.equations.jacobian[i, j]
    for j in range(n):
        workspace.matrix[n - 1, j] = workspace.weights[j] * direction[j]


@kernel
def newton_step(workspace, y, direction):
    """Make one Newton step, in place, on the equations and on the plane across ``direction``; return its size.

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
        # a phase has full weight here, however many there are
        size = max(size, abs(right[j]) * min(1.0, math.sqrt(workspace.weights[j] * n)))
    return size


@kernel
def correct(assemble, problem, y, direction, condition):
    """Correct ``y`` by Newton's method, in place, in the plane across ``direction``.

    ``assemble`` (problem, y, condition) writes the equations into the workspace. It returns whether they
    exist at y, and the condition with the time of its touch there.

    Returns
    -------
    tuple of (int, Condition)
        Number of corrections, -1 if the method fails.
        The condition at the corrected point.
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


@kernel
def predict(tangent, length, workspace):
    """Write the point a length further along a tangent into ``workspace.predicted`` and ``workspace.corrected``."""
    for j in range(tangent.point.shape[0]):
        workspace.predicted[j] = tangent.point[j] + length * tangent.direction[j]
        workspace.corrected[j] = workspace.predicted[j]


@kernel
def find_direction(direction, workspace):
    """Write the direction of the curve at the last assembled point into ``workspace.direction``.

    Its sense is that of ``direction``. Returns False if there is no direction.
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


@kernel
def bends_little(direction, workspace):
    """Return whether the direction at the last assembled point is close to ``direction``.

    The new direction is left in ``workspace.direction``.
    """
    return (
        find_direction(direction, workspace)
        and inner(workspace.direction, direction, workspace.weights) > MIN_COSINE
    )


@kernel
def has_closed(start, points, count, problem):
    """Return whether a curve has returned to its start between the last two of its first ``count`` points."""
    if count <= MIN_LOOP:
        return False
    weights = problem.workspace.weights
    before, now = problem.workspace.predicted, problem.workspace.right
    for j in range(now.shape[0]):
        before[j] = points[count - 2, j] - start.point[j]
        now[j] = points[count - 1, j] - start.point[j]
    passes = inner(start.direction, before, weights) < 0.0 <= inner(start.direction, now, weights)
    return passes and math.sqrt(inner(now, now, weights)) < 2.0 * problem.longest


@kernel
def next_length(problem, length, corrections):
    """Return the length of the next step after one that took the given number of corrections."""
    return min(length * (GROW if corrections <= FEW_CORRECTIONS else 1.0), problem.longest)
