"""Points of a branch of periodic orbits: corrected, validated, and located at a zero of a test function."""

import math
from enum import IntEnum
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.orbits.arclength import correct, predict, system_at
from rocking.kernels.orbits.chain_validation import UNCONDITIONAL, verify_chain
from rocking.kernels.orbits.event_chain import assemble, monodromy

# Relative accuracy of a root along a step.
ROOT_TOLERANCE = 1e-14
MAX_HALVINGS = 200


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


@njit(**INTERNAL)
def multiplier_angle(trace, determinant):
    """Return an angle that measures the multipliers: pi/4 at a fold, -pi/4 at a flip, always within pi/2."""
    return math.atan(trace / (1.0 + determinant))


@njit(**INTERNAL)
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


@njit(**INTERNAL)
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


@njit(**INTERNAL)
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


@njit(**INTERNAL)
def validated_point_at(problem, tangent, length):
    """Return the point of the branch a length further along a tangent, validated: every arc of it is marched."""
    point, workspace = point_at(problem, tangent, length), problem.workspace
    if point.corrections < 0:
        return point
    y, links = workspace.corrected, workspace.equations.links
    own, peak = verify_chain(system_at(problem, y), problem.chain, y, links, UNCONDITIONAL)
    return Point(point.corrections, point.trace, point.determinant, own, peak)


@njit(**INTERNAL)
def special_value(what, trace, determinant):
    """Return the test function of a fold or of a flip, which vanishes there."""
    return 1.0 - trace + determinant if what == Special.FOLD else 1.0 + trace + determinant


@njit(**INTERNAL)
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


@njit(**INTERNAL)
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
