"""Periodic orbits sought from many starts: Newton's method on the map over a period, or over half of one and mirrored."""

import math

from numba import njit

from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL
from rocking.kernels.march.march import UNKNOWN
from rocking.kernels.orbits.fixed_point import ANYWHERE, UNBOUNDED, find_fixed_point
from rocking.kernels.parameters import later


@njit(**INTERNAL)
def return_map(p, period, mirrored):
    """(system, start, cycles, sign) of the map over ``period`` cycles, or over half an odd number of them and mirrored.

    A state at the time ``start`` within the first cycle is marched to the end of cycle ``cycles``; its image is multiplied
    by ``sign``. Half a cycle comes first: the march ends only with a whole one, and p.period stays that of the forcing.
    """
    if not mirrored:
        return p, 0.0, period, 1.0
    half = 0.5 * p.period
    return later(p, -half), half, (period + 1) // 2, -1.0


@njit(**ENTRY_POINT)
def newton_from_starts(p, period, mirrored, starts, nothing, columns, out):
    """Newton's method on ``return_map`` from every start; ``out`` (n, 4) takes (found, angle, velocity, residual).

    Starts beyond a brace lead nowhere. How many were found.
    """
    q, start, cycles, sign = return_map(p, period, mirrored)
    count = 0
    for i in range(starts.shape[0]):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = False, starts[i, 0], starts[i, 1], math.inf
        if abs(starts[i, 0]) > p.brace_angle:
            continue
        found = find_fixed_point(
            q, starts[i, 0], starts[i, 1], cycles, UNBOUNDED, nothing, columns, UNKNOWN, ANYWHERE, start, sign
        )
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = (
            found.converged,
            found.angle,
            found.velocity,
            found.residual,
        )
        count += found.converged
    return count
