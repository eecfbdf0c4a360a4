"""Turns of a full block: the times at which its velocity changes sign, step by step."""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import CROSSING, LATER
from rocking.kernels.forcing.full.base import drive_later
from rocking.kernels.forcing.full.crossing import first_zero
from rocking.kernels.forcing.full.series import derivative
from rocking.kernels.forcing.full.solution import evaluate
from rocking.kernels.forcing.full.step import state_in, step_from

# After an extremum the search starts later by this fraction of the time, so that rounding cannot find it again.
PASSED = 2.0**-50


@njit(**INTERNAL)
def next_turn(p, arc, sign, t, until):
    """Provide ``contract.next_turn``."""
    start, passed = t, PASSED * (1.0 + t)
    while start < until:
        now = evaluate(p, arc, start)
        angle, velocity, drive, elapsed, found = now.angle, now.velocity, now.drive, start, math.inf
        while elapsed < until and found == math.inf:
            step = step_from(p, arc.side, angle, velocity, drive)
            slope, bend, rest = derivative(step.velocity, step.series, sign)
            if elapsed == start:
                slope = max(slope, 0.0)  # just after an extremum u' may have the other sign to rounding
            found = elapsed + first_zero(slope, bend, rest, min(step.length, until - elapsed))
            rise, velocity = state_in(step, step.length)
            angle, elapsed = angle + rise, elapsed + step.length
            drive = drive_later(p, drive, step.length, step.to_corner)
        if found > until:
            return LATER, until, evaluate(p, arc, until)
        if found > t:
            return CROSSING, found, evaluate(p, arc, found)
        start, passed = start + passed, 2.0 * passed
    return LATER, until, evaluate(p, arc, until)
