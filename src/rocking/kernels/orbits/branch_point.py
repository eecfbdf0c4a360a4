"""Points of a branch of periodic orbits: corrected, certified, and located where a test vanishes along a step."""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.orbits.arclength import newton_step
from rocking.kernels.orbits.chain_validation import verify_chain
from rocking.kernels.orbits.event_chain import assemble, monodromy, with_value

MAX_CORRECTIONS = 10
EASY = 4
CONVERGED = 1e-11
MIN_STEP = 1e-12
GROW, SHRINK = 1.4, 0.5
# A root along a step is sought to this share of it.
ROOT = 1e-14
MAX_HALVINGS = 200
# Steps this short against the longest end on a grazing.
CLOSE = 1e-3
# An event reached more slowly than this grazes, to rounding: the depth of a touch goes like the square of the speed.
SLOWEST = 1e-8
# A branch that returns to its start has more points than this.
LOOP = 8
# What vanishes at the end of the range.
PARAMETER = -1
# Directions of two neighbouring points differ by no more than this angle.
STRAIGHT = 0.97
# The multipliers turn by no more than this in a step, as ``multiplier_angle`` measures them: a fold and a flip are pi/2 apart.
CALM = 0.3
# Beyond this on one side the multipliers are far from a fold and from a flip. Towards a grazing they grow without bound.
FAR = 1.2
# A step as short as this, against the longest, is taken however the multipliers change in it.
TINY = 1e-6
# Phases half a chain apart that differ by half its turn to this: the orbit repeats itself sooner.
SHORTER = 1e-5


class Special(IntEnum):
    """What changes at a point of a branch."""

    FOLD = 0
    SYMMETRY_BREAKING = 1
    PERIOD_DOUBLING = 2
    GRAZING = 3


FOLD, SYMMETRY_BREAKING, PERIOD_DOUBLING, GRAZING = (int(kind) for kind in Special)


class End(IntEnum):
    """Why a branch ends."""

    RANGE = 0
    GRAZED = 1
    MERGED = 2
    CLOSED = 3
    MANY = 4  # as many points as were asked for
    LOST = 5


RANGE, GRAZED, MERGED, CLOSED, MANY, LOST = (int(end) for end in End)
GOING = -1


class Point(NamedTuple):
    """What is known of a point beside its phases."""

    found: bool
    corrections: int
    fold: float  # 1 - trace + determinant
    flip: float  # 1 + trace + determinant
    trace: float
    determinant: float


class Step(NamedTuple):
    """A step along a branch."""

    end: int  # GOING, or why the branch ends
    length: float
    point: Point
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
def correct(p, which, chain, y, direction, low, high, workspace):
    """Newton's method from ``y``, in place, on the chain's equations and on the plane through ``workspace.aim`` across a direction."""
    k = chain.kinds.shape[0]
    before, converged = math.inf, False
    for corrections in range(MAX_CORRECTIONS):
        if not low <= y[k] <= high:
            break
        q = with_value(p, which, y[k])
        if not assemble(q, which, chain, y, workspace.jacobian, workspace.misses, workspace.links):
            break
        if converged:
            trace, determinant = monodromy(q, chain, workspace.links)
            return Point(
                True, corrections, 1.0 - trace + determinant, 1.0 + trace + determinant, trace, determinant
            )
        size = newton_step(workspace, y, direction)
        if not size < math.inf:
            break
        converged = size <= CONVERGED or (size <= 100.0 * CONVERGED and size >= 0.5 * before)
        before = size
    return Point(False, MAX_CORRECTIONS, 0.0, 0.0, 0.0, 0.0)


@njit(**INTERNAL)
def step_to(p, which, chain, origin, direction, length, bounds, workspace):
    """The point of the branch a length further along a direction, left in ``workspace.trial``."""
    for j in range(direction.shape[0]):
        workspace.aim[j] = origin[j] + length * direction[j]
        workspace.trial[j] = workspace.aim[j]
    return correct(p, which, chain, workspace.trial, direction, bounds[0], bounds[1], workspace)


@njit(**INTERNAL)
def test_value(what, point, y, level):
    """What vanishes at a special point, or at the end of the range."""
    if what == FOLD:
        return point.fold
    if what == PERIOD_DOUBLING:
        return point.flip
    return y[y.shape[0] - 1] - level


@njit(**INTERNAL)
def locate(p, which, chain, origin, direction, length, bounds, what, level, at_start, at_end, workspace):
    """The length at which a test vanishes between 0 and ``length``, by false position with halvings; NaN where it is lost."""
    a, b, f, g = 0.0, length, at_start, at_end
    middle, last = 0.5 * length, 0
    for _ in range(MAX_HALVINGS):
        middle = b - g * (b - a) / (g - f)
        if not a < middle < b:
            middle = 0.5 * (a + b)
        point = step_to(p, which, chain, origin, direction, middle, bounds, workspace)
        if not point.found:
            return math.nan
        value = test_value(what, point, workspace.trial[: origin.shape[0]], level)
        if value == 0.0 or b - a <= ROOT * length:
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
def validated_point_at(p, which, chain, origin, direction, length, bounds, workspace):
    """(whether the point a length further is the block's own motion, the point, its peak)."""
    point = step_to(p, which, chain, origin, direction, length, bounds, workspace)
    if not point.found:
        return False, point, 0.0
    k = chain.kinds.shape[0]
    q = with_value(p, which, workspace.trial[k])
    own, peak = verify_chain(q, chain, workspace.trial, workspace.links, -1, 0.0)
    return own, point, peak


@njit(**INTERNAL)
def last_valid_length(p, which, chain, origin, direction, length, bounds, workspace):
    """The greatest length up to which the points are the block's own motion, by halving."""
    a, b = 0.0, length
    for _ in range(MAX_HALVINGS):
        if b - a <= ROOT * length:
            break
        middle = 0.5 * (a + b)
        if validated_point_at(p, which, chain, origin, direction, middle, bounds, workspace)[0]:
            a = middle
        else:
            b = middle
    return a
