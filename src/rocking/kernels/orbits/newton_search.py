"""Search for periodic orbits from many initial states, by Newton's method on the return map.

The map is over a whole period, or over half a period followed by reflection.
"""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.parameters import PeriodicParameters
from rocking.kernels.forcing.periodic import later
from rocking.kernels.march.initial_state import UNKNOWN
from rocking.kernels.march.no_recording import NoRecording
from rocking.kernels.orbits.fixed_point import ANYWHERE, UNBOUNDED, Guess, ReturnMap, find_fixed_point
from rocking.kernels.signature import Floats2


@njit(**INTERNAL)
def return_map(p, period, mirrored):
    """Return the ``ReturnMap`` over ``period`` cycles, or over half an odd number of them and mirrored.

    The half cycle comes first: the march ends only with a whole one, and p.forcing.period stays that of the forcing.
    """
    if not mirrored:
        return ReturnMap(p, period, 0.0, 1.0)
    half = 0.5 * p.forcing.period
    return ReturnMap(later(p, -half), (period + 1) // 2, half, -1.0)


@entry_point(**KERNEL)
def newton_from_starts(
    p: PeriodicParameters,
    period: int,
    mirrored: bool,
    starts: Floats2,
    nothing: NoRecording,
    columns: Floats2,
    out: Floats2,
) -> int:
    """Search for fixed points of ``return_map`` by Newton's method from every initial state.

    ``out`` (n, 4) takes (found, angle, velocity, residual). Initial states beyond a brace are skipped.
    Returns the number of fixed points found.
    """
    mapping, count = return_map(p, period, mirrored), 0
    for i in range(starts.shape[0]):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = False, starts[i, 0], starts[i, 1], math.inf
        if abs(starts[i, 0]) > p.block.brace_angle:
            continue
        guess = Guess(starts[i, 0], starts[i, 1], UNKNOWN)
        found = find_fixed_point(mapping, guess, UNBOUNDED, ANYWHERE, columns, nothing)
        out[i, 0], out[i, 1] = found.converged, found.angle
        out[i, 2], out[i, 3] = found.velocity, found.residual
        count += found.converged
    return count
