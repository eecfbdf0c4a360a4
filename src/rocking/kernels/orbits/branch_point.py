"""Points of a branch of periodic orbits: corrected, certified, and located where a test vanishes along a step."""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.orbits.arclength import correct, predict, system_at
from rocking.kernels.orbits.chain_validation import UNCONDITIONAL, verify_chain
from rocking.kernels.orbits.event_chain import assemble, monodromy

# A root along a step is sought to this share of it.
ROOT_TOLERANCE = 1e-14
MAX_HALVINGS = 200


class Special(IntEnum):
    """What changes at a point of a branch."""

    BOUND = -1  # nothing: the parameter takes a given value
    FOLD = 0
    SYMMETRY_BREAKING = 1
    PERIOD_DOUBLING = 2
    GRAZING = 3


class Point(NamedTuple):
    """What is known of a point beside its phases."""

    corrections: int  # -1 where Newton's method fails
    trace: float
    determinant: float
    valid: bool  # whether the block moves so by itself
    peak: float


@njit(**INTERNAL)
def multiplier_angle(trace, determinant):
    """Where the multipliers stand, as an angle: pi/4 at a fold, -pi/4 at a flip, within pi/2 however large they are."""
    return math.atan(trace / (1.0 + determinant))


@njit(**INTERNAL)
def passes_and_returns(earlier, length_before, start, stop, length):
    """Whether multipliers that go from ``start`` to ``stop`` seem to pass a fold or a flip and come back in between.

    They lie on the parabola through these two and the value ``earlier`` (NaN: none), a length before the first.
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
    """(whether events keep their order, the condition, of which a branch has none): the equations at a point of a branch."""
    q, equations = system_at(problem, y), problem.workspace.equations
    return assemble(q, problem.which[0], problem.chain, y, equations), condition


@njit(**INTERNAL)
def point_at(problem, tangent, length):
    """The point of the branch a length further along a tangent, left in ``workspace.corrected``; not certified."""
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
    """The point a length further, certified: every arc of it is marched."""
    point, workspace = point_at(problem, tangent, length), problem.workspace
    if point.corrections < 0:
        return point
    y, links = workspace.corrected, workspace.equations.links
    own, peak = verify_chain(system_at(problem, y), problem.chain, y, links, UNCONDITIONAL)
    return Point(point.corrections, point.trace, point.determinant, own, peak)


@njit(**INTERNAL)
def special_value(what, trace, determinant):
    """What vanishes at a fold, or at a flip."""
    return 1.0 - trace + determinant if what == Special.FOLD else 1.0 + trace + determinant


@njit(**INTERNAL)
def locate(problem, tangent, length, what, level, at_start, at_end):
    """The length at which a test, or a parameter less ``level``, vanishes between 0 and ``length``; NaN where it is lost.

    By false position with halvings, from the values at both ends.
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
        # Illinois: an end that stays counts half
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
    """The greatest length up to which the points are the block's own motion, by halving."""
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
