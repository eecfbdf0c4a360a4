"""A special point followed through two parameters: the chain's equations and the one condition that makes it special.

The condition is exact; only its derivatives, by which Newton's method converges, are differences.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import ALLOCATING, ALLOCATING_ENTRY, INTERNAL
from rocking.kernels.orbits.arclength import along, newton_step, norm, turn_direction
from rocking.kernels.orbits.branch_point import (
    CLOSED,
    CONVERGED,
    EASY,
    FOLD,
    GOING,
    GRAZED,
    GRAZING,
    GROW,
    LOOP,
    LOST,
    MANY,
    MAX_CORRECTIONS,
    MIN_STEP,
    RANGE,
    SHRINK,
    STRAIGHT,
)
from rocking.kernels.orbits.chain_validation import clearance, verify_chain
from rocking.kernels.orbits.event_chain import Chain, assemble, monodromy, with_value

DIFFERENCE = 1e-6
TIGHT = 1e-3


class Condition(NamedTuple):
    """What makes a point special."""

    kind: int  # FOLD, GRAZING or, for both flips, any other
    touched: int  # the arc that touches, -1 where none does
    level: int  # what it touches: IMPACT for the base, BRACE
    first: int  # the parameters
    second: int


@njit(**INTERNAL)
def with_both(p, condition, y):
    """The system at a point."""
    k = y.shape[0] - 2
    return with_value(with_value(p, condition.first, y[k]), condition.second, y[k + 1])


@njit(**INTERNAL)
def condition_at(p, chain, condition, y, touches, spare, misses, links):
    """(what vanishes, when the arc touches); NaN where the chain breaks."""
    q = with_both(p, condition, y)
    if not assemble(q, condition.first, chain, y, spare, misses, links):
        return math.nan, touches
    if condition.kind == GRAZING:
        return clearance(q, chain, y, links, condition.touched, condition.level, touches)
    trace, determinant = monodromy(q, chain, links)
    return (1.0 - trace + determinant if condition.kind == FOLD else 1.0 + trace + determinant), touches


@njit(**INTERNAL)
def assemble_all(p, chain, condition, y, touches, spare, spent, workspace):
    """The chain's equations and the condition with their derivatives: the condition, and when the arc touches."""
    k = chain.kinds.shape[0]
    n = k + 2
    for j in range(n):
        kept, step = y[j], DIFFERENCE / math.sqrt(workspace.weights[j] * (k if j < k else 1))
        y[j] = kept + step
        more, _ = condition_at(p, chain, condition, y, touches, spare, spent, workspace.links)
        y[j] = kept - step
        less, _ = condition_at(p, chain, condition, y, touches, spare, spent, workspace.links)
        y[j] = kept
        workspace.jacobian[k, j] = (more - less) / (2.0 * step)
    q = with_both(p, condition, y)
    assemble(q, condition.second, chain, y, workspace.jacobian, workspace.misses, workspace.links)
    for i in range(k):
        workspace.jacobian[i, k + 1] = workspace.jacobian[i, k]
    value, touches = condition_at(p, chain, condition, y, touches, spare, spent, workspace.links)
    assemble(q, condition.first, chain, y, workspace.jacobian, workspace.misses, workspace.links)
    workspace.misses[k] = value
    return value, touches


@njit(**INTERNAL)
def correct_both(p, chain, condition, y, direction, bounds, touches, spare, spent, workspace):
    """(corrections, -1 where it fails; when the arc touches): Newton's method, in place, across a direction."""
    k = chain.kinds.shape[0]
    before, converged = math.inf, False
    for corrections in range(MAX_CORRECTIONS):
        within = bounds[0] <= y[k] <= bounds[1] and bounds[2] <= y[k + 1] <= bounds[3]
        if not within:
            break
        value, touches = assemble_all(p, chain, condition, y, touches, spare, spent, workspace)
        if not abs(value) < math.inf:
            break
        if converged:
            return corrections, touches
        size = newton_step(workspace, y, direction)
        if not size < math.inf:
            break
        converged = size <= CONVERGED or (size <= 100.0 * CONVERGED and size >= 0.5 * before)
        before = size
    return -1, touches


@njit(**ALLOCATING)
def next_point(
    p, chain, condition, y, direction, turned, length, longest, bounds, touches, spare, spent, workspace
):
    """(GOING or why it ends, length, corrections, when the arc touches); the point is left in ``workspace.trial``."""
    while True:
        workspace.aim[:] = y + length * direction
        workspace.trial[:] = workspace.aim
        corrections, moved = correct_both(
            p, chain, condition, workspace.trial, direction, bounds, touches, spare, spent, workspace
        )
        turned[:] = direction
        near = corrections >= 0 and turn_direction(turned, workspace)
        near = near and along(turned, direction, np.zeros(y.shape[0]), workspace.weights) > STRAIGHT
        if near:
            q = with_both(p, condition, workspace.trial)
            if verify_chain(q, chain, workspace.trial, workspace.links, condition.touched, moved)[0]:
                return GOING, length, corrections, moved
            if length <= TIGHT * longest:
                return GRAZED, length, corrections, moved
        length *= SHRINK
        if length < MIN_STEP * longest:
            return LOST, length, corrections, moved


@njit(**ALLOCATING)
def converge_to_bound(p, chain, condition, y, over, limits, bounds, touches, spare, spent, workspace):
    """Whether the curve's point at the end of a range was found: between ``y`` and ``workspace.trial``, in whose place it is left."""
    index = chain.kinds.shape[0] + over // 2
    across = np.zeros(y.shape[0])
    across[index] = 1.0
    share = (limits[over] - y[index]) / (workspace.trial[index] - y[index])
    workspace.trial[:] = y + share * (workspace.trial - y)
    workspace.aim[:] = workspace.trial
    workspace.aim[index] = limits[over]
    corrections, _ = correct_both(
        p, chain, condition, workspace.trial, across, bounds, touches, spare, spent, workspace
    )
    return corrections >= 0


@njit(**ALLOCATING_ENTRY)
def follow_curve(
    p, kinds, side, turn, condition, touches, y, direction, limits, longest, out, workspace, spare, spent
):  # fmt: skip
    """(points, why it ended): a curve of special points from ``y`` along ``direction``, both changed in place.

    ``out`` (n, k + 2) takes the phases and both parameters; ``limits`` their ranges. ``spare`` and ``spent`` are
    as large as the Jacobian and a vector.
    """
    chain = Chain(kinds, side, turn)
    first_beyond, second_beyond = (
        2.0 * longest * (limits[1] - limits[0]),
        2.0 * longest * (limits[3] - limits[2]),
    )
    bounds = (
        max(limits[0] - first_beyond, 0.5 * limits[0]),
        limits[1] + first_beyond,
        max(limits[2] - second_beyond, 0.5 * limits[2]),
        limits[3] + second_beyond,
    )
    workspace.aim[:] = y
    corrections, touches = correct_both(
        p, chain, condition, y, direction, bounds, touches, spare, spent, workspace
    )
    if corrections < 0 or not turn_direction(direction, workspace):
        return 0, LOST
    out[0] = y
    count, length, was = 1, 0.1 * longest, 0.0
    first, first_direction, turned = y.copy(), direction.copy(), direction.copy()
    while count < out.shape[0]:
        end, length, corrections, moved = next_point(
            p,
            chain,
            condition,
            y,
            direction,
            turned,
            length,
            longest,
            bounds,
            touches,
            spare,
            spent,
            workspace,
        )
        if end != GOING:
            return count, end
        over = beyond(workspace.trial, limits)
        if over >= 0:
            if converge_to_bound(
                p, chain, condition, y, over, limits, bounds, touches, spare, spent, workspace
            ):
                out[count] = workspace.trial
                count += 1
            return count, RANGE
        y[:], touches = workspace.trial, moved
        direction[:] = turned
        out[count] = y
        count += 1
        now = along(first_direction, y, first, workspace.weights)
        if count > LOOP and was < 0.0 <= now and norm(y - first, workspace.weights) < 2.0 * longest:
            return count, CLOSED
        was = now
        length = min(length * (GROW if corrections <= EASY else 1.0), longest)
    return count, MANY


@njit(**INTERNAL)
def beyond(y, limits):
    """Which end of which range a point lies beyond: its place in ``limits``, -1 for none."""
    k = y.shape[0] - 2
    for i in range(2):
        if y[k + i] < limits[2 * i]:
            return 2 * i
        if y[k + i] > limits[2 * i + 1]:
            return 2 * i + 1
    return -1
