"""Chattering (Zeno): infinitely many impacts in a finite time. Proof that they end in rest, or in contact with a brace, and when.

There are two lemmas. If the acceleration back to the contact changes little, it lies between two bounds, and the speeds fall
geometrically (``settling_time``; under samples it serves the full block and braces). Under samples the sum of all changes bounds
the speeds of a slender block (``settling_by_variation``).
"""

import math

from rocking.kernels import contract
from rocking.kernels.base.cosine import Cosine, Pulse
from rocking.kernels.base.samples import BLOCK, Samples, acceleration_at, place_at
from rocking.kernels.block.restitution import largest_up_to
from rocking.kernels.contract import (
    acceleration,
    acceleration_change_bound,
    acceleration_of,
    acceleration_size,
    excess_push,
    forcing_term,
    has_wall,
    weight_change_bound,
    weight_of,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.system import Full, Slender, Unsymmetric


@kernel
def settling_time(speed, restitution, accelerations, softening, hardening, clearance):
    """Return upper bounds on the duration of chattering after an impact that leaves at ``speed``, and on the angle until its end.

    At the contact the block is accelerated back with the weakest to the strongest of ``accelerations``. At an angle u from it, that
    is ``softening`` u less, or ``hardening`` u more. The height of an arc stays below h = speed**2/weakest, within half the
    ``clearance``, so that the weakest acceleration loses no more than half. Each arc returns with at most ``ratio`` times the speed
    with which it left. So speeds fall geometrically by restitution*ratio. The duration of an arc is at most (1 + ratio)/weakest
    times its speed. Both bounds are infinite if the impacts need not end.
    """
    weakest, strongest = accelerations
    height = speed * speed / weakest
    softer = softening * height
    if not (weakest > 0.0 and softer <= 0.5 * weakest and height <= 0.5 * clearance):
        return math.inf, math.inf
    weakest, strongest = weakest - softer, strongest + hardening * height
    ratio = math.sqrt(strongest / weakest)
    fall = restitution * ratio
    if fall >= 1.0:
        return math.inf, math.inf
    return speed * (1.0 + ratio) / (weakest * (1.0 - fall)), height


@kernel(inline=True)
def settling_by_change(p, drive, speed, back, rate):
    """Return ``contract.settling`` by the bound on the change of the base acceleration.

    ``back`` is the weaker acceleration back to the base of its two sides, over the square of their frequency parameters, the lower one
    of which is ``rate``. It bounds both, and stays positive within the window, so that the window ends before lift-off.
    """
    if p.block.restitution >= 1.0 or back <= 0.0:
        return math.inf, math.inf
    speed = speed / rate
    window = 5.0 * speed / (back * (1.0 - p.block.restitution))
    moved = acceleration_change_bound(p, drive, window / rate)
    weakest, strongest = back - moved, back + moved
    bound, _ = settling_time(speed, p.block.restitution, (weakest, strongest), 1.0, 0.0, p.block.brace_angle)
    if not bound <= window:
        return math.inf, math.inf
    return bound / rate, 0.5 * speed * speed / (weakest - speed * speed / weakest)


@body(contract.settling, Slender, Cosine, Pulse)
def settling_of_slender(p, side, drive, speed):
    """Provide ``contract.settling``: on the two sides of the base the block is accelerated back with 1 +- the base acceleration."""
    return settling_by_change(p, drive, speed, 1.0 - acceleration_size(p, drive), 1.0)


@body(contract.settling, Unsymmetric, Cosine, Pulse)
def settling_of_unsymmetric(p, side, drive, speed):
    """Provide ``contract.settling``."""
    ratio, rate, _ = p.block.left
    back = -forcing_term(p, side, drive)
    push = back - 1.0 if side > 0 else ratio - back / (rate * rate)
    return settling_by_change(p, drive, speed, min(1.0 + push, ratio - push), min(1.0, rate))


# 2m - h, relative to m; and the limit of x.
HEIGHT = 1.75
FASTEST = math.sqrt(7.0) / 4.0
THIRD = 1.0 / 3.0
# Relative safety margin over rounding.
SETTLING_MARGIN = 1e-9
# Time that is looked at, relative to the bound so far.
LONGER_TIME = 1.25


@kernel
def largest_between(p, first, end):
    """Return the largest |a| of the samples from ``first`` to ``end``, both included, by whole blocks where possible."""
    tables, largest, index = p.forcing.tables, 0.0, first
    while index <= end:
        if index % BLOCK == 0 and index + BLOCK <= end + 1:
            largest, index = max(largest, tables.blocks[index // BLOCK]), index + BLOCK
        else:
            largest, index = max(largest, abs(tables.samples[index])), index + 1
    return abs(p.forcing.scale) * largest


@kernel(inline=True)
def changes_between(p, drive, end):
    """Return the sum of all |changes| of the base acceleration between two places; after the last sample it is 0."""
    tables, scale = p.forcing.tables, p.forcing.scale
    here, there = acceleration_at(p, drive), acceleration_at(p, end)
    first = drive.index + 1
    if end.index < first:
        return abs(there - here)
    changes = abs(scale * tables.samples[first] - here) + abs(there - scale * tables.samples[end.index])
    return changes + abs(scale) * (tables.variation[end.index] - tables.variation[first])


@kernel(inline=True)
def settling_by_variation(p, drive, speed, level, back, rate):
    """Return ``contract.settling`` under samples, with the changes in a time that grows until it suffices.

    While |a| < 1 the block is accelerated back with d - u, where d = 1 +- a >= m = 1 - max|a|.
    The energy E = u'^2/2 + u (d - u/2) of an arc has E' = d' u. As long as u <= h, u <= E/(m - h/2).
    An arc that leaves at speed v then returns with at most v exp(s/(2m - h)), for a sum s of |changes of a|. Take h = m/4.

    Let S be the sum of all changes, and V = exp(S/(7m/4)). The k-th arc from now leaves with at most e^k v V. Let x = v V/m.
    No arc is higher than m (1 - sqrt(1 - x^2)), which is below h if x < sqrt(7)/4. The k-th is not longer than
    2 artanh(e^k x). All together last at most 2 artanh(x)/(1 - e). If this ends within the time for which m and S hold, the
    block rests.

    With unequal sides d = 1 + a or ratio - a, ``back`` is the lower one now, and m is at least back - S, and at least the lower
    ``level``, 1 or ratio, less max|a|. Times are in units of the lower ``rate``: on the other side all is over sooner.

    If g <= 1, exp(g) <= 1 + g + 0.72 g^2. Below the limit of x, artanh(x) <= x + x^3/3 + 0.3 x^5. Both hold at the limit, and
    so below it, because the coefficients of the series are positive.
    """
    e, largest, covered, seen = p.block.restitution, abs(acceleration_at(p, drive)), 0.0, drive.index
    least = max(level - largest, back)
    if e >= 1.0 or least <= 0.0:
        return math.inf, math.inf
    longest, speed = 2.0 * (1.0 + SETTLING_MARGIN) / (1.0 - e) / rate, speed / rate
    x = speed / least
    while least > 0.0 and x < FASTEST:
        q = x * x
        bound = longest * x * (1.0 + q * (THIRD + 0.3 * q))
        if bound <= covered:
            top = least * q / (1.0 + math.sqrt(1.0 - q))
            return (bound, top) if top < p.block.brace_angle else (math.inf, math.inf)
        covered = LONGER_TIME * bound
        end = place_at(p, drive.index, drive.offset + covered)
        changes = changes_between(p, drive, end)
        largest = max(largest, abs(acceleration_at(p, end)))
        if not changes < HEIGHT * max(level - largest, back - changes):
            break
        largest = max(largest, largest_between(p, seen + 1, end.index))
        seen = end.index
        least = max(level - largest, back - changes)
        per = 1.0 / least
        growth = changes * per / HEIGHT
        if growth > 1.0:
            break
        x = speed * per * (1.0 + growth * (1.0 + 0.72 * growth)) * (1.0 + SETTLING_MARGIN)
    return math.inf, math.inf


@body(contract.settling, Slender, Samples)
def settling_of_slender_under_samples(p, side, drive, speed):
    """Provide ``contract.settling``."""
    return settling_by_variation(p, drive, speed, 1.0, -math.inf, 1.0)


@body(contract.settling, Unsymmetric, Samples)
def settling_of_unsymmetric_under_samples(p, side, drive, speed):
    """Provide ``contract.settling``."""
    ratio, rate, _ = p.block.left
    push = acceleration_at(p, drive)
    back = min(1.0 + push, ratio - push)
    return settling_by_variation(p, drive, speed, min(1.0, ratio), back, min(1.0, rate))


# Time that is looked at, relative to that of arcs under the present acceleration.
LONGER = 2.5


@body(contract.settling, Full)
def settling_of_full(p, side, drive, speed):
    """Provide ``contract.settling`` for the full block.

    Near the base it is accelerated back with W press + sigma A cos(alpha), within (W + alpha |A|) u, where W is the weight, and near a
    brace likewise. Of a restrained block ``excess_push`` is added to |A|. The weaker acceleration of both sides, and the larger change,
    bound both. Against a wall there is only the right side.
    """
    block, now, right, left = p.block, acceleration_of(p, drive), p.block.right, p.block.left
    e, swing, cosine = largest_up_to(p, speed), abs(now), max(right.cosine, left.cosine)
    weight = weight_of(p, drive)
    press, most = weight * right.press + right.cosine * now, right.press
    if not has_wall(p):
        press, most = min(press, weight * left.press - left.cosine * now), max(most, left.press)
    if e >= 1.0 or press <= 0.0:
        return math.inf, math.inf
    window = LONGER * 2.0 * speed / (press * (1.0 - e))
    moved, lifted = acceleration_change_bound(p, drive, window), weight_change_bound(p, drive, window)
    softness = max(right.stiffness, left.stiffness) * (
        abs(weight) + lifted + block.critical_angle * (swing + moved + excess_push(p))
    )
    change = cosine * moved + most * lifted
    accelerations = press - change, press + change
    clearance = min(1.0, left.ratio, block.brace_angle)
    bound, height = settling_time(speed, e, accelerations, softness, softness, clearance)
    return (bound, height) if bound <= window else (math.inf, math.inf)


@body(contract.brace_settling_time, Full)
def brace_settling_of_full(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``: as at the base, but on one side."""
    block = p.block
    e, press = block.brace_restitution, acceleration(p, side, block.brace_angle, drive)
    if e >= 1.0 or press <= 0.0:
        return math.inf
    window = LONGER * 2.0 * speed / (press * (1.0 - e))
    moved = acceleration_change_bound(p, drive, window)
    softness = 1.0 + block.critical_angle * (abs(acceleration_of(p, drive)) + moved)
    accelerations = press - moved, press + moved
    bound, _ = settling_time(speed, e, accelerations, softness, softness, block.brace_angle)
    return bound if bound <= window else math.inf


@kernel
def base_settling_time(p, side, drive, speed, peak):
    """Return an upper bound on the time from an impact to rest (Zeno limit at the base).

    Infinite if rest is not certain, or if the angle may exceed ``peak`` until then.
    """
    bound, highest = contract.settling(p, side, drive, speed)
    return bound if highest <= peak else math.inf


@kernel
def brace_settling_within(p, side, drive, speed):
    """Return an upper bound on the time from a brace impact to sustained contact; infinite if that is not certain."""
    return contract.brace_settling_time(p, side, drive, speed)
