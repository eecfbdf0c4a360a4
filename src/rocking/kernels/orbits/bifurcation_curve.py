"""Continuation of a bifurcation point in two parameters: the chain's equations with one further condition.

The condition is exact. Only its derivatives, which Newton's method uses, are finite differences.
"""

import math
from typing import NamedTuple

from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.numerics.dense import copy_into
from rocking.kernels.orbits.arclength import (
    GRAZING_STEP,
    MIN_STEP,
    SHRINK,
    End,
    Problem,
    Tangent,
    bends_little,
    correct,
    crossed_limit,
    find_direction,
    has_closed,
    next_length,
    predict,
    system_at,
)
from rocking.kernels.orbits.chain import assemble, monodromy
from rocking.kernels.orbits.chain_check import Condition, clearance, slowest_arrival, verify_chain
from rocking.kernels.orbits.continuation import Special, special_value

DIFFERENCE = 1e-6
# Speed of an event that is about to vanish, within ``GRAZING_STEP``.
VANISHING_SPEED = 1e-3


class CurveStep(NamedTuple):
    """Step along a curve of special points."""

    end: int  # an ``End``
    length: float
    corrections: int
    condition: Condition  # at its end


@kernel
def condition_at(problem, y, condition, equations):
    """Write the ``equations`` at a point and evaluate the condition.

    Returns
    -------
    tuple of (float, float)
        Value of the condition, NaN if the chain breaks.
        Time at which the arc touches.
    """
    q = system_at(problem, y)
    if not assemble(q, problem.which[0], problem.chain, y, equations):
        return math.nan, condition.time
    if condition.kind == Special.GRAZING:
        return clearance(q, problem.chain, y, equations.links, condition)
    trace, determinant = monodromy(q, problem.chain, equations.links)
    return special_value(condition.kind, trace, determinant), condition.time


@kernel
def assemble_curve(problem, y, condition):
    """Write the chain's equations and the condition, with their derivatives.

    Returns
    -------
    tuple of (bool, Condition)
        Whether the condition has a finite value.
        The condition with its time of touch.
    """
    k, weights = problem.chain.kinds.shape[0], problem.workspace.weights
    equations, nearby = problem.workspace.equations, problem.workspace.differences
    for j in range(k + 2):
        kept, step = y[j], DIFFERENCE / math.sqrt(weights[j] * (k if j < k else 1))
        y[j] = kept + step
        more, _ = condition_at(problem, y, condition, nearby)
        y[j] = kept - step
        less, _ = condition_at(problem, y, condition, nearby)
        y[j] = kept
        equations.jacobian[k, j] = (more - less) / (2.0 * step)
    assemble(system_at(problem, y), problem.which[1], problem.chain, y, equations)
    for i in range(k):
        equations.jacobian[i, k + 1] = equations.jacobian[i, k]
    value, time = condition_at(problem, y, condition, equations)
    equations.residuals[k] = value
    return abs(value) < math.inf, Condition(condition.kind, condition.arc, condition.level, time)


@kernel
def loses_contact(problem, y, condition):
    """Return whether an event of the chain at ``y`` almost vanishes, beyond which the equations do not exist."""
    links = problem.workspace.equations.links
    condition_at(problem, y, condition, problem.workspace.equations)
    return slowest_arrival(links, problem.chain.kinds.shape[0]) <= VANISHING_SPEED


@kernel
def next_point(problem, tangent, length, condition):
    """Step to the next point, with shorter steps if the curve bends.

    The point is left in ``workspace.corrected``, the direction there in ``workspace.direction``.
    """
    y, links = problem.workspace.corrected, problem.workspace.equations.links
    while True:
        predict(tangent, length, problem.workspace)
        corrections, moved = correct(assemble_curve, problem, y, tangent.direction, condition)
        if corrections >= 0 and bends_little(tangent.direction, problem.workspace):
            if verify_chain(system_at(problem, y), problem.chain, y, links, moved)[0]:
                return CurveStep(End.GOING, length, corrections, moved)
            if length <= GRAZING_STEP * problem.longest:
                return CurveStep(End.GRAZED, length, corrections, moved)
        elif length <= GRAZING_STEP * problem.longest and loses_contact(problem, tangent.point, condition):
            return CurveStep(End.GRAZED, length, corrections, condition)
        length *= SHRINK
        if length < MIN_STEP * problem.longest:
            return CurveStep(End.LOST, length, corrections, moved)


@kernel
def converge_to_limit(problem, y, index, limit, condition):
    """Return whether the point of the curve at a limit was found, between ``y`` and ``workspace.corrected``.

    The point is left in ``workspace.corrected``.
    """
    point, predicted = problem.workspace.corrected, problem.workspace.predicted
    across = problem.workspace.along
    share = (limit - y[index]) / (point[index] - y[index])
    for j in range(y.shape[0]):
        across[j] = 1.0 if j == index else 0.0
        point[j] = y[j] + share * (point[j] - y[j])
    copy_into(predicted, point)
    predicted[index] = limit
    return correct(assemble_curve, problem, point, across, condition)[0] >= 0


@entry_point
def follow_curve(problem: Problem, start: Tangent, condition: Condition, points: Floats2) -> tuple[int, int]:
    """Follow a curve of special points from near ``start``, a tangent, in its direction.

    ``points`` (n, k + 2) takes the phases and both parameters.

    Returns
    -------
    tuple of (int, int)
        Number of points.
        Reason for the end, as in ``End``.
    """
    workspace = problem.workspace
    predict(start, 0.0, workspace)
    corrections, condition = correct(assemble_curve, problem, workspace.corrected, start.direction, condition)
    if corrections < 0 or not find_direction(start.direction, workspace):
        return 0, End.LOST
    copy_into(points[0], workspace.corrected)
    copy_into(workspace.first, workspace.direction)
    copy_into(workspace.along, workspace.direction)
    first, tangent = Tangent(points[0], workspace.first), Tangent(points[0], workspace.along)
    length = 0.1 * problem.longest
    for count in range(1, points.shape[0]):
        step = next_point(problem, tangent, length, condition)
        if step.end != End.GOING:
            return count, step.end
        index, limit = crossed_limit(problem, workspace.corrected)
        if index >= 0:
            found = converge_to_limit(problem, tangent.point, index, limit, condition)
            if found:
                copy_into(points[count], workspace.corrected)
            return count + found, End.RANGE
        copy_into(points[count], workspace.corrected)
        condition = step.condition
        if has_closed(first, points, count + 1, problem):
            return count + 1, End.CLOSED
        copy_into(workspace.along, workspace.direction)
        tangent = Tangent(points[count], workspace.along)
        length = next_length(problem, step.length, step.corrections)
    return points.shape[0], End.MANY
