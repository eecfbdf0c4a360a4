"""A branch of periodic orbits followed through a parameter: pseudo-arclength steps, and the points where something changes."""

import math

import numpy as np
from numba import njit

from rocking.kernels.compile_options import ALLOCATING, ALLOCATING_ENTRY, INTERNAL
from rocking.kernels.orbits.arclength import along, norm, turn_direction
from rocking.kernels.orbits.branch_point import (  # fmt: skip
    CALM,
    CLOSE,
    CLOSED,
    EASY,
    FAR,
    FOLD,
    GOING,
    GRAZED,
    GRAZING,
    GROW,
    LOOP,
    LOST,
    MANY,
    MERGED,
    MIN_STEP,
    PARAMETER,
    PERIOD_DOUBLING,
    RANGE,
    SHORTER,
    SHRINK,
    SLOWEST,
    STRAIGHT,
    SYMMETRY_BREAKING,
    TINY,
    Point,
    Step,
    last_valid_length,
    locate,
    multiplier_angle,
    passes_and_returns,
    step_to,
    test_value,
    validated_point_at,
)
from rocking.kernels.orbits.event_chain import Chain


@njit(**INTERNAL)
def repeats_sooner(chain, y):
    """Whether an orbit repeats itself, or its mirror image, after half its chain."""
    k = chain.kinds.shape[0]
    if k % 2 == 1:
        return False
    half = k // 2
    for j in range(half):
        if chain.kinds[j] != chain.kinds[j + half]:
            return False
        if abs(y[j + half] - y[j] - 0.5 * chain.turn) > SHORTER:
            return False
    return True


@njit(**INTERNAL)
def kind_of(what, chain, mirrored, y):
    """The kind of a special point: at a flip or a fold of an orbit more symmetrical there, that of where it came from."""
    if what == PERIOD_DOUBLING:
        return (SYMMETRY_BREAKING if mirrored else PERIOD_DOUBLING), False
    if not repeats_sooner(chain, y):
        return FOLD, False
    half_turns = round(chain.turn / (2.0 * math.pi))
    return (PERIOD_DOUBLING if half_turns % 2 == 0 else SYMMETRY_BREAKING), True


@njit(**INTERNAL)
def keep_point(workspace, k, row, point, peak, out, facts):
    """Write a point: its phases and parameter, then (trace, determinant, peak, speed of the first event)."""
    for j in range(k + 1):
        out[row, j] = workspace.trial[j]
    facts[row, 0], facts[row, 1], facts[row, 2] = point.trace, point.determinant, peak
    facts[row, 3] = workspace.links[0, 0]


@njit(**INTERNAL)
def slowest_arrival(workspace, k):
    """The least speed at which an event of the orbit last solved is reached."""
    slowest = math.inf
    for j in range(k):
        slowest = min(slowest, abs(workspace.links[j, 1]))
    return slowest


@njit(**INTERNAL)
def is_calm(earlier, before, point, length, longest):
    """Whether the multipliers change little in a step, so that none passes a special point unseen."""
    start = multiplier_angle(before.trace, before.determinant)
    stop = multiplier_angle(point.trace, point.determinant)
    if min(start, stop) > FAR or max(start, stop) < -FAR:
        return True
    if not abs(stop - start) <= CALM:
        return False
    first = multiplier_angle(earlier.point.trace, earlier.point.determinant)
    return length <= CLOSE * longest or not passes_and_returns(first, earlier.length, start, stop, length)


@njit(**ALLOCATING)
def next_step(
    p, which, chain, y, direction, ahead, length, longest, limits, bounds, before, earlier, workspace
):
    """The next point, left in ``workspace.trial``, and the direction there, ``ahead``: with shorter steps where the branch bends.

    Steps are shorter too where the multipliers change fast; ``earlier`` is the step before. At a grazing and at the end of
    the range the step ends on it. Its length is 0 where the last point lies on the grazing, to rounding.
    """
    k = chain.kinds.shape[0]
    while True:
        own, point, peak = validated_point_at(p, which, chain, y, direction, length, bounds, workspace)
        ahead[:] = direction
        near = point.found and turn_direction(ahead, workspace)
        near = near and along(ahead, direction, np.zeros(k + 1), workspace.weights) > STRAIGHT
        near = near and (length <= TINY * longest or is_calm(earlier, before, point, length, longest))
        if near and (own or length <= CLOSE * longest):
            break
        length *= SHRINK
        if length < MIN_STEP * longest:
            _, point, peak = validated_point_at(p, which, chain, y, direction, 0.0, bounds, workspace)
            return Step(GRAZED if slowest_arrival(workspace, k) < SLOWEST else LOST, 0.0, point, peak)
    end, within = GOING, length
    if not own:
        within = last_valid_length(p, which, chain, y, direction, length, bounds, workspace)
        end = GRAZED
        _, point, peak = validated_point_at(p, which, chain, y, direction, within, bounds, workspace)
    value = workspace.trial[k]
    if not limits[0] <= value <= limits[1]:
        level = limits[0] if value < limits[0] else limits[1]
        start = y[k] - level
        if start != 0.0:
            within = locate(
                p,
                which,
                chain,
                y,
                direction,
                within,
                bounds,
                PARAMETER,
                level,
                start,
                value - level,
                workspace,
            )
        else:
            within = 0.0
        if math.isnan(within):
            return Step(LOST, 0.0, before, peak)
        _, point, peak = validated_point_at(p, which, chain, y, direction, within, bounds, workspace)
        workspace.trial[k] = level
        end = RANGE
    return Step(end, within, point, peak)


@njit(**ALLOCATING)
def note_specials(
    p, which, chain, mirrored, y, direction, step, before, bounds, count, found, specials, changes, workspace
):
    """(special points so far, length of the step at which the branch merges with a more symmetrical one, NaN where it does not)."""
    k = chain.kinds.shape[0]
    for what in (FOLD, PERIOD_DOUBLING):
        start = test_value(what, before, y, 0.0)
        stop = test_value(what, step.point, y, 0.0)
        if (start > 0.0) == (stop > 0.0) or found >= specials.shape[0]:
            continue
        at = locate(p, which, chain, y, direction, step.length, bounds, what, 0.0, start, stop, workspace)
        if math.isnan(at):
            continue
        step_to(p, which, chain, y, direction, at, bounds, workspace)
        kind, merged = kind_of(what, chain, mirrored, workspace.trial)
        specials[found] = workspace.trial[: k + 1]
        changes[found, 0], changes[found, 1] = kind, count
        found += 1
        if merged:
            return found, at
    return found, math.nan


@njit(**ALLOCATING_ENTRY)
def follow(
    p, which, kinds, side, turn, mirrored, y, direction, limits, longest, out, facts, specials, changes, workspace
):  # fmt: skip
    """(points, special points, why it ended): a branch from the orbit ``y`` along ``direction``, both changed in place.

    ``out`` (n, k + 1) takes the phases and the parameter of each point, ``facts`` (n, 4) what else is known of
    it; ``specials`` (m, k + 1) and ``changes`` (m, 2) the special points, their kind and the number of points before.
    """
    chain, k = Chain(kinds, side, turn), kinds.shape[0]
    # beyond the range by a step, to find its end from both sides
    beyond = 2.0 * longest * (limits[1] - limits[0])
    bounds = max(limits[0] - beyond, 0.5 * limits[0]), limits[1] + beyond
    count, found, length, was = 0, 0, 0.1 * longest, 0.0
    own, before, peak = validated_point_at(p, which, chain, y, direction, 0.0, bounds, workspace)
    if not own:
        return count, found, GRAZED if before.found else LOST
    y[:] = workspace.trial
    keep_point(workspace, k, count, before, peak, out, facts)
    count += 1
    if count == out.shape[0] or not turn_direction(direction, workspace):
        return count, found, MANY if count == out.shape[0] else LOST
    first, first_direction, ahead = y.copy(), direction.copy(), direction.copy()
    none = Point(False, 0, math.nan, math.nan, math.nan, math.nan)
    earlier = Step(GOING, 1.0, none, 0.0)
    while count < out.shape[0]:
        step = next_step(
            p, which, chain, y, direction, ahead, length, longest, limits, bounds, before, earlier, workspace
        )
        if step.length == 0.0:
            if step.end == GRAZED and found < specials.shape[0]:
                specials[found] = y
                changes[found, 0], changes[found, 1] = GRAZING, count - 1
                found += 1
            return count, found, step.end
        keep_point(workspace, k, count, step.point, step.peak, out, facts)
        found, merges = note_specials(
            p,
            which,
            chain,
            mirrored,
            y,
            direction,
            step,
            before,
            bounds,
            count,
            found,
            specials,
            changes,
            workspace,
        )
        if not math.isnan(merges):
            _, point, peak = validated_point_at(p, which, chain, y, direction, merges, bounds, workspace)
            keep_point(workspace, k, count, point, peak, out, facts)
            return count + 1, found, MERGED
        if step.end == GRAZED and found < specials.shape[0]:
            specials[found] = out[count]
            changes[found, 0], changes[found, 1] = GRAZING, count
            found += 1
        y[:], before, earlier = out[count], step.point, Step(GOING, step.length, before, 0.0)
        count += 1
        if step.end != GOING:
            return count, found, step.end
        direction[:] = ahead
        now = along(first_direction, y, first, workspace.weights)
        if count > LOOP and was < 0.0 <= now and norm(y - first, workspace.weights) < 2.0 * longest:
            return count, found, CLOSED
        was = now
        length = min(step.length * (GROW if before.corrections <= EASY else 1.0), longest)
    return count, found, MANY
