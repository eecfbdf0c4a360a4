"""Continuation of a branch of periodic orbits in one parameter, with its special points."""

import math
from enum import IntEnum
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.numerics.dense import copy_into
from rocking.kernels.numerics.elementary import arctangent
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
from rocking.kernels.orbits.chain_check import UNCONDITIONAL, slowest_arrival, verify_chain

# Relative accuracy of a root along a step.
ROOT_TOLERANCE = 1e-14
MAX_HALVINGS = 200


# Maximum change of ``multiplier_angle`` in a step; a fold and a flip are pi/2 apart.
MAX_TURN = 0.3
# An event reached more slowly than this grazes, to rounding: the depth of a touch is proportional to the
# squared speed.
GRAZING_SPEED = 1e-8
# Beyond this, with one sign, the multipliers are far from a fold and from a flip. Near a grazing they grow
# without bound.
FAR_ANGLE = 1.2
# A step shorter than this, relative to the longest, is accepted however much the multipliers change.
MIN_RESOLVED_STEP = 1e-6
# Tolerance of phases half a chain apart: if they differ by half the turn of the chain, the orbit has a
# shorter period.
SAME_PHASE = 1e-5
FACTS = np.dtype([(name, float) for name in ("trace", "determinant", "peak", "velocity")])
CHANGE = np.dtype([("kind", np.int64), ("index", np.int64)])


class Special(IntEnum):
    """Type of a special point of a branch."""

    BOUND = -1  # no bifurcation: the parameter takes a given value
    FOLD = 0
    SYMMETRY_BREAKING = 1
    PERIOD_DOUBLING = 2
    GRAZING = 3


class Point(NamedTuple):
    """Properties of a point of a branch, in addition to its phases."""

    corrections: int  # -1 if Newton's method fails
    trace: float
    determinant: float
    valid: bool  # whether the motion of the block is that of the chain
    peak: float


@kernel
def multiplier_angle(trace, determinant):
    """Return an angle that measures the multipliers: pi/4 at a fold, -pi/4 at a flip, always within pi/2."""
    return arctangent(trace / (1.0 + determinant))


@kernel
def passes_and_returns(earlier, length_before, start, stop, length):
    """Return whether the multipliers seem to pass a fold or a flip and come back between ``start`` and ``stop``.

    They are assumed to lie on the parabola through these two and the value ``earlier`` (NaN: none),
    ``length_before`` in front of the first.
    """
    slope, before = (stop - start) / length, (start - earlier) / length_before
    bend = (slope - before) / (length + length_before)
    # start + rise s + bend s^2 is extreme at s = -rise/(2 bend)
    rise = slope - bend * length
    if not 0.0 < -rise * bend < 2.0 * bend * bend * length:
        return False
    extreme = start - 0.25 * rise * rise / bend
    level = 0.25 * math.pi
    fold = (start > level) == (stop > level) != (extreme > level)
    flip = (start > -level) == (stop > -level) != (extreme > -level)
    return fold or flip


@kernel
def assemble_branch(problem, y, condition):
    """Write the equations at a point of a branch, which has no condition.

    Returns
    -------
    tuple of (bool, Condition)
        Whether the events keep their order.
        The condition, unchanged.
    """
    q, equations = system_at(problem, y), problem.workspace.equations
    return assemble(q, problem.which[0], problem.chain, y, equations), condition


@kernel
def point_at(problem, tangent, length):
    """Return the point of the branch a length further along a tangent, not validated.

    The point is left in ``workspace.corrected``.
    """
    workspace = problem.workspace
    predict(tangent, length, workspace)
    corrections, _ = correct(assemble_branch, problem, workspace.corrected, tangent.direction, UNCONDITIONAL)
    if corrections < 0:
        return Point(-1, 0.0, 0.0, False, 0.0)
    q = system_at(problem, workspace.corrected)
    trace, determinant = monodromy(q, problem.chain, workspace.equations.links)
    return Point(corrections, trace, determinant, False, 0.0)


@kernel
def validated_point_at(problem, tangent, length):
    """Return the point of the branch a length further along a tangent, validated: every arc of it is marched."""
    point, workspace = point_at(problem, tangent, length), problem.workspace
    if point.corrections < 0:
        return point
    y, links = workspace.corrected, workspace.equations.links
    own, peak = verify_chain(system_at(problem, y), problem.chain, y, links, UNCONDITIONAL)
    return Point(point.corrections, point.trace, point.determinant, own, peak)


@kernel
def special_value(what, trace, determinant):
    """Return the test function of a fold or of a flip, which vanishes there."""
    return 1.0 - trace + determinant if what == Special.FOLD else 1.0 + trace + determinant


@kernel
def locate(problem, tangent, length, what, level, at_start, at_end):
    """Return the length at which a test function, or a parameter less ``level``, vanishes between 0 and ``length``.

    The method is false position with halvings (Illinois), from the values at both ends. NaN if the branch is
    lost.
    """
    a, b, f, g = 0.0, length, at_start, at_end
    middle, last = length, 0
    for _ in range(MAX_HALVINGS):
        middle = b - g * (b - a) / (g - f)
        if not a < middle < b:
            middle = 0.5 * (a + b)
        point = point_at(problem, tangent, middle)
        if point.corrections < 0:
            return math.nan
        value = problem.workspace.corrected[-1] - level
        if what != Special.BOUND:
            value = special_value(what, point.trace, point.determinant)
        if value == 0.0 or b - a <= ROOT_TOLERANCE * length:
            return middle
        # Illinois: the value at an end that stays is halved
        if (value > 0.0) == (g > 0.0):
            b, g = middle, value
            f *= 0.5 if last == 1 else 1.0
            last = 1
        else:
            a, f = middle, value
            g *= 0.5 if last == -1 else 1.0
            last = -1
    return middle


@kernel
def last_valid_length(problem, tangent, length):
    """Return the greatest length up to which the points are motions of the block, by bisection."""
    a, b = 0.0, length
    for _ in range(MAX_HALVINGS):
        if b - a <= ROOT_TOLERANCE * length:
            break
        middle = 0.5 * (a + b)
        if validated_point_at(problem, tangent, middle).valid:
            a = middle
        else:
            b = middle
    return a


Facts = Annotated[np.ndarray, FACTS, 1]
Changes = Annotated[np.ndarray, CHANGE, 1]


class BranchTable(NamedTuple):
    """Arrays for n points and m special points of a branch of chains of k events."""

    rows: Floats2  # (n, k + 1): the phases and the parameter
    facts: Facts  # (n,) of FACTS; the velocity is that after the first event
    specials: Floats2  # (m, k + 1)
    changes: Changes  # (m,) of CHANGE: a ``Special``, and the number of points before


class State(NamedTuple):
    """Progress along a branch."""

    tangent: Tangent
    point: Point  # at the present end of the branch
    earlier: Point  # the point before
    last: float  # length of the step between these two points
    length: float  # length of the step to try next


class Step(NamedTuple):
    """Step along a branch."""

    end: int  # an ``End``
    length: float
    point: Point


@kernel
def repeats_sooner(chain, y):
    """Return whether an orbit, or its mirror image, repeats after half its chain."""
    k = chain.kinds.shape[0]
    if k % 2 == 1:
        return False
    half = k // 2
    for j in range(half):
        apart = y[j + half] - y[j]
        if chain.kinds[j] != chain.kinds[j + half] or abs(apart - 0.5 * chain.turn) > SAME_PHASE:
            return False
    return True


@kernel
def kind_of(what, chain, y):
    """Classify a special point.

    If the orbit is more symmetric there, the branch ends on a branch of such orbits. The kind is then that of
    the point on this other branch.

    Returns
    -------
    tuple of (int, bool)
        The kind, as in ``Special``.
        Whether the orbit is more symmetric there.
    """
    if what == Special.PERIOD_DOUBLING:
        return (Special.SYMMETRY_BREAKING if chain.mirrored else Special.PERIOD_DOUBLING), False
    if not repeats_sooner(chain, y):
        return Special.FOLD, False
    half_turns = round(chain.turn / (2.0 * math.pi))
    return (Special.PERIOD_DOUBLING if half_turns % 2 == 0 else Special.SYMMETRY_BREAKING), True


@kernel
def store_point(table, row, point, workspace):
    """Write the point in ``workspace.corrected``."""
    copy_into(table.rows[row], workspace.corrected)
    facts = table.facts[row]
    facts.trace, facts.determinant, facts.peak = point.trace, point.determinant, point.peak
    facts.velocity = workspace.equations.links[0].leaves


@kernel
def store_special(table, found, y, kind, index):
    """Write a special point if the table has room; return the number of special points."""
    if found == table.changes.shape[0]:
        return found
    copy_into(table.specials[found], y)
    table.changes[found].kind, table.changes[found].index = kind, index
    return found + 1


@kernel
def resolves_multipliers(problem, state, point, length):
    """Return whether the multipliers change little in a step, so that no special point is passed unseen."""
    start = multiplier_angle(state.point.trace, state.point.determinant)
    stop = multiplier_angle(point.trace, point.determinant)
    if min(start, stop) > FAR_ANGLE or max(start, stop) < -FAR_ANGLE:
        return True
    if not abs(stop - start) <= MAX_TURN:
        return False
    first = multiplier_angle(state.earlier.trace, state.earlier.determinant)
    return length <= GRAZING_STEP * problem.longest or not passes_and_returns(
        first, state.last, start, stop, length
    )


@kernel
def next_step(problem, state):
    """Step to the next point, with shorter steps if the branch bends or the multipliers change fast.

    The point is left in ``workspace.corrected``, the direction there in ``workspace.direction``. At a grazing
    and at the end of the range the step ends exactly there. Its length is 0 if the last point lies on the
    grazing, to rounding.
    """
    workspace, tangent, length, longest = problem.workspace, state.tangent, state.length, problem.longest
    while True:
        point = validated_point_at(problem, tangent, length)
        near = point.corrections >= 0 and bends_little(tangent.direction, workspace)
        near = near and (
            length <= MIN_RESOLVED_STEP * longest or resolves_multipliers(problem, state, point, length)
        )
        if near and (point.valid or length <= GRAZING_STEP * longest):
            break
        length *= SHRINK
        if length < MIN_STEP * longest:
            point = validated_point_at(problem, tangent, 0.0)
            slowest = slowest_arrival(workspace.equations.links, problem.chain.kinds.shape[0])
            return Step(End.GRAZED if slowest < GRAZING_SPEED else End.LOST, 0.0, point)
    end = End.GOING
    if not point.valid:
        end, length = End.GRAZED, last_valid_length(problem, tangent, length)
        point = validated_point_at(problem, tangent, length)
    crossed, limit = crossed_limit(problem, workspace.corrected)
    if crossed >= 0:
        end, length = End.RANGE, length_to_limit(problem, tangent, length, limit)
        if math.isnan(length):
            return Step(End.LOST, 0.0, point)
        point = validated_point_at(problem, tangent, length)
        workspace.corrected[crossed] = limit
    return Step(end, length, point)


@kernel
def length_to_limit(problem, tangent, length, limit):
    """Return the length at which the parameter reaches ``limit``; NaN if the branch is lost.

    The limit lies on the way to ``workspace.corrected``.
    """
    start = tangent.point[-1] - limit
    if start == 0.0:
        return 0.0
    stop = problem.workspace.corrected[-1] - limit
    return locate(problem, tangent, length, Special.BOUND, limit, start, stop)


@kernel
def store_specials(problem, state, step, table, found, count):
    """Write the special points along a step.

    Returns
    -------
    tuple of (int, float)
        Number of special points so far.
        Length at which the branch merges with one of more symmetric orbits, NaN if it does not.
    """
    before, after, y = state.point, step.point, problem.workspace.corrected
    for what in (Special.FOLD, Special.PERIOD_DOUBLING):
        start = special_value(what, before.trace, before.determinant)
        stop = special_value(what, after.trace, after.determinant)
        if (start > 0.0) == (stop > 0.0) or found == table.changes.shape[0]:
            continue
        at = locate(problem, state.tangent, step.length, what, 0.0, start, stop)
        if math.isnan(at):
            continue
        point_at(problem, state.tangent, at)
        kind, merged = kind_of(what, problem.chain, y)
        found = store_special(table, found, y, kind, count)
        if merged:
            return found, at
    return found, math.nan


@entry_point
def follow(problem: Problem, start: Tangent, table: BranchTable) -> tuple[int, int, int]:
    """Follow a branch from the orbit near ``start``, a tangent, in its direction.

    Returns
    -------
    tuple of (int, int, int)
        Numbers of points and of special points.
        Reason for the end, as in ``End``.
    """
    workspace, rows, found = problem.workspace, table.rows, 0
    point = validated_point_at(problem, start, 0.0)
    if not point.valid:
        return 0, found, (End.GRAZED if point.corrections >= 0 else End.LOST)
    store_point(table, 0, point, workspace)
    if rows.shape[0] > 1 and not find_direction(start.direction, workspace):
        return 1, found, End.LOST
    copy_into(workspace.first, workspace.direction)
    copy_into(workspace.along, workspace.direction)
    first = Tangent(rows[0], workspace.first)
    none = Point(-1, math.nan, math.nan, False, math.nan)
    state = State(Tangent(rows[0], workspace.along), point, none, 1.0, 0.1 * problem.longest)
    for count in range(1, rows.shape[0]):
        step = next_step(problem, state)
        if step.length == 0.0:
            if step.end == End.GRAZED:
                found = store_special(table, found, rows[count - 1], Special.GRAZING, count - 1)
            return count, found, step.end
        store_point(table, count, step.point, workspace)
        found, merges = store_specials(problem, state, step, table, found, count)
        if not math.isnan(merges):
            store_point(table, count, validated_point_at(problem, state.tangent, merges), workspace)
            return count + 1, found, End.MERGED
        if step.end == End.GRAZED:
            found = store_special(table, found, rows[count], Special.GRAZING, count)
        if step.end != End.GOING:
            return count + 1, found, step.end
        if has_closed(first, rows, count + 1, problem):
            return count + 1, found, End.CLOSED
        length = next_length(problem, step.length, step.point.corrections)
        copy_into(workspace.along, workspace.direction)
        state = State(Tangent(rows[count], workspace.along), step.point, state.point, step.length, length)
    return rows.shape[0], found, End.MANY
