"""Bound on chattering (Zeno) under a sampled base acceleration a: proof that it ends in rest, and when.

While |a| < 1 the block is accelerated back with d - u, where d = 1 +- a >= m = 1 - max|a|.
The energy E = u'^2/2 + u (d - u/2) of an arc has E' = d' u. As long as u <= h, u <= E/(m - h/2).
An arc that leaves at speed v then returns with at most v exp(s/(2m - h)), for a sum s of |changes of a|. Take h = m/4.

Let S be the sum of all changes, and V = exp(S/(7m/4)). The k-th arc from now leaves with at most e^k v V. Let x = v V/m.
No arc is higher than m (1 - sqrt(1 - x^2)), which is below h if x < sqrt(7)/4. The k-th is not longer than 2 artanh(e^k x).
All together last at most 2 artanh(x)/(1 - e). If this ends within the time for which m and S hold, the block rests.

If g <= 1, exp(g) <= 1 + g + 0.72 g^2. Below the limit of x, artanh(x) <= x + x^3/3 + 0.3 x^5. Both hold at the limit, and
so below it, because the coefficients of the series are positive.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.sampled.solution import acceleration_at, place_at
from rocking.kernels.forcing.sampled.tables import BLOCK

# 2m - h, relative to m; and the limit of x.
HEIGHT = 1.75
FASTEST = math.sqrt(7.0) / 4.0
THIRD = 1.0 / 3.0
# Relative safety margin over rounding.
MARGIN = 1e-9
# Time that is looked at, relative to the bound so far.
LONGER = 1.25


@njit(**INTERNAL)
def largest_between(p, first, end):
    """Return the largest |a| of the samples from ``first`` to ``end``, both included, by whole blocks where possible."""
    tables, largest, index = p.forcing.tables, 0.0, first
    while index <= end:
        if index % BLOCK == 0 and index + BLOCK <= end + 1:
            largest, index = max(largest, tables.blocks[index // BLOCK]), index + BLOCK
        else:
            largest, index = max(largest, abs(tables.samples[index])), index + 1
    return abs(p.forcing.scale) * largest


@njit(**INTERNAL_INLINE)
def changes_between(p, drive, end):
    """Return the sum of all |changes| of the base acceleration between two places; after the last sample it is 0."""
    tables, scale = p.forcing.tables, p.forcing.scale
    here, there = acceleration_at(p, drive), acceleration_at(p, end)
    first = drive.index + 1
    if end.index < first:
        return abs(there - here)
    changes = abs(scale * tables.samples[first] - here) + abs(there - scale * tables.samples[end.index])
    return changes + abs(scale) * (tables.variation[end.index] - tables.variation[first])


@njit(**INTERNAL)
def settling(p, drive, speed):
    """Provide ``contract.settling``, with the changes in a time that grows until it suffices."""
    e, largest, covered, seen = p.block.restitution, abs(acceleration_at(p, drive)), 0.0, drive.index
    if e >= 1.0 or largest >= 1.0:
        return math.inf, math.inf
    longest, x = 2.0 * (1.0 + MARGIN) / (1.0 - e), speed / (1.0 - largest)
    while largest < 1.0 and x < FASTEST:
        q = x * x
        bound = longest * x * (1.0 + q * (THIRD + 0.3 * q))
        if bound <= covered:
            top = (1.0 - largest) * q / (1.0 + math.sqrt(1.0 - q))
            return (bound, top) if top < p.block.brace_angle else (math.inf, math.inf)
        covered = LONGER * bound
        end = place_at(p, drive.index, drive.offset + covered)
        changes = changes_between(p, drive, end)
        largest = max(largest, abs(acceleration_at(p, end)))
        if not changes < HEIGHT * (1.0 - largest):
            break
        largest = max(largest, largest_between(p, seen + 1, end.index))
        seen = end.index
        per = 1.0 / (1.0 - largest)
        growth = changes * per / HEIGHT
        if growth > 1.0:
            break
        x = speed * per * (1.0 + growth * (1.0 + 0.72 * growth)) * (1.0 + MARGIN)
    return math.inf, math.inf
