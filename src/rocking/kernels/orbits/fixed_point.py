"""Periodic orbits: fixed points of the map over so many forcing cycles, by Newton's method with the exact Jacobian."""

import math
from typing import NamedTuple

from numba import njit

from rocking.kernels.compile_options import AST_INLINE, INTERNAL
from rocking.kernels.march.march import DONE, begin, march_on
from rocking.kernels.march.tangent import Tangent, read_tangent
from rocking.kernels.numerics.elementary import size

RESIDUAL = 1e-12
# Near a fold Newton's method converges linearly, by halves.
MAX_STEPS = 40
UNBOUNDED = 1 << 62


class Patience(NamedTuple):
    """How far Newton's method is followed."""

    failures: int  # steps in all that do not lower the residual by a tenth
    worse: float  # a step that makes the residual grow by more is halved, as one that overturns the block or leads too far
    halvings: int  # so often
    reach: float  # of the angle, where no brace is nearer, and of the velocity


# From what a motion approaches; from anywhere.
NEARBY = Patience(1, math.inf, 0, 10.0)
ANYWHERE = Patience(MAX_STEPS, 2.0, 4, 1e3)


class MapImage(NamedTuple):
    """Where a state is after a while."""

    certain: bool  # neither overturned nor with too many events on the way
    angle: float
    velocity: float
    tangent: Tangent
    impacts: int
    brace_hits: int
    peak: float
    waits: tuple[float, float]  # from the image to the first event and on to the next, about


class FixedPoint(NamedTuple):
    """A fixed point, or how far one got."""

    converged: bool
    angle: float
    velocity: float
    image: MapImage
    residual: float
    error: float  # what Newton's method would still move it by
    work: int  # events computed


@njit(**INTERNAL)
def image_after(
    p, angle, velocity, cycles, section_time, section, nothing, columns, want_peak, waits, start=0.0
):
    """The image, at the end of cycle ``cycles``, of a state at the time ``start`` within the first.

    ``section`` as in ``march_on``, ``columns`` (2, 2) or none.
    """
    progress, _ = begin(p, angle, velocity, waits, start)
    if columns.shape[0] > 0:
        columns[0, 0], columns[0, 1], columns[1, 0], columns[1, 1] = 1.0, 0.0, 0.0, 1.0
    status, progress, _, _ = march_on(
        p, progress, cycles, section_time, section, nothing.events, columns, nothing.growth, want_peak, False
    )
    arc = progress.arc
    tangent = read_tangent(columns) if columns.shape[0] > 0 else Tangent(0.0, 0.0, 0.0, 0.0)
    return MapImage(
        status == DONE,
        arc.side * arc.angle,
        arc.side * arc.velocity,
        tangent,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        (progress.wait_before, progress.last_wait),
    )


@njit(**AST_INLINE)
def find_fixed_point(p, angle, velocity, cycles, most_work, nothing, columns, waits, patience, start, sign):
    """Newton's method on the map of ``image_after`` times ``sign``, until the residual is at most RESIDUAL; ``waits`` as for ``begin``.

    ``sign`` is -1 where the image is mirrored, else 1. Where none is found, the state is the last one accepted.
    """
    reach = min(p.brace_angle, patience.reach)
    work, failures, steps, halvings, converged, inside = 0, 0, 0, 0, False, True
    residual, best, error, share, to_angle, to_velocity = math.inf, math.inf, math.inf, 1.0, 0.0, 0.0
    at_angle, at_velocity = angle, velocity
    while True:
        accepted = False
        if inside:
            image = image_after(
                p, at_angle, at_velocity, cycles, 0.0, nothing.section, nothing, columns, False, waits, start
            )
            waits = image.waits
            work += image.impacts + image.brace_hits
            miss, miss_rate = sign * image.angle - at_angle, sign * image.velocity - at_velocity
            missed = max(abs(miss), abs(miss_rate))
            accepted = image.certain and missed <= patience.worse * residual
        if accepted:
            angle, velocity, residual = at_angle, at_velocity, missed
            tangent = image.tangent
            a, b, c, d = sign * tangent.a, sign * tangent.b, sign * tangent.c, sign * tangent.d
            converged = residual <= RESIDUAL * max(1.0, abs(a), abs(b), abs(c), abs(d))
            steps += 1
            failures += not residual < 0.9 * best
            best = min(best, residual)
            # x + (I - J)^-1 (P(x) - x), with J = [[a, c], [b, d]]
            determinant = (1.0 - a) * (1.0 - d) - b * c
            to_angle = ((1.0 - d) * miss + c * miss_rate) / determinant
            to_velocity = (b * miss + (1.0 - a) * miss_rate) / determinant
            error = size(to_angle, to_velocity)
            lost = failures > patience.failures or work > most_work or not error < math.inf
            if converged or lost or steps > MAX_STEPS:
                break
            share, halvings = 1.0, 0
        elif halvings == patience.halvings:
            break
        else:
            share, halvings = 0.5 * share, halvings + 1
        at_angle, at_velocity = angle + share * to_angle, velocity + share * to_velocity
        inside = abs(at_angle) <= reach and abs(at_velocity) <= patience.reach
    return FixedPoint(converged, angle, velocity, image, residual, error, work)
