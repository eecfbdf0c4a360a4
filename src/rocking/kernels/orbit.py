"""Periodic orbits: fixed points of the map over so many forcing cycles, by Newton's method with the exact Jacobian."""

import math
from typing import NamedTuple

from numba import njit

from .elementary import WITHIN, WRITTEN_IN, size
from .march import DONE, begin, march_on
from .tangent import Tangent, read_tangent

RESIDUAL = 1e-12
# Near a fold Newton's method converges linearly, by halves.
MOST_STEPS = 40
MOST_FAILURES = 1
FARTHEST = 10.0


class Image(NamedTuple):
    """Where a state is after a while."""

    certain: bool  # neither overturned nor with too many events on the way
    angle: float
    velocity: float
    tangent: Tangent
    impacts: int
    brace_hits: int
    peak: float
    waits: tuple[float, float]  # from the image to the first event and on to the next, about


class Found(NamedTuple):
    """A fixed point, or how far one got."""

    converged: bool
    angle: float
    velocity: float
    image: Image
    residual: float
    error: float  # what Newton's method would still move it by
    work: int  # events computed


@njit(**WITHIN)
def image_after(p, angle, velocity, cycles, section_time, section, nothing, columns, want_peak, waits):
    """The image of a state ``cycles`` later; ``section`` as in ``march_on``, ``columns`` (2, 2) or none."""
    progress, _ = begin(p, angle, velocity, waits)
    if columns.shape[0] > 0:
        columns[0, 0], columns[0, 1], columns[1, 0], columns[1, 1] = 1.0, 0.0, 0.0, 1.0
    status, progress, _, _ = march_on(
        p, progress, cycles, section_time, section, nothing.events, columns, nothing.growth, want_peak, False
    )
    arc = progress.arc
    tangent = read_tangent(columns) if columns.shape[0] > 0 else Tangent(0.0, 0.0, 0.0, 0.0)
    return Image(
        status == DONE,
        arc.side * arc.angle,
        arc.side * arc.velocity,
        tangent,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        (progress.wait_before, progress.last_wait),
    )


@njit(**WRITTEN_IN)
def find_fixed_point(p, angle, velocity, cycles, most_work, nothing, columns, waits):
    """Newton's method on the map over ``cycles`` forcing cycles, until the residual is at most RESIDUAL; ``waits`` as for ``begin``."""
    reach = min(p.brace_angle, FARTHEST)
    work, failures, best, steps, converged = 0, 0, math.inf, 0, False
    while True:
        image = image_after(p, angle, velocity, cycles, 0.0, nothing.section, nothing, columns, False, waits)
        waits = image.waits
        work += image.impacts + image.brace_hits
        a, b, c, d = image.tangent
        miss, miss_rate = image.angle - angle, image.velocity - velocity
        residual = max(abs(miss), abs(miss_rate))
        growth = max(1.0, abs(a), abs(b), abs(c), abs(d))
        converged = image.certain and residual <= RESIDUAL * growth
        steps += 1
        failures += not residual < 0.9 * best
        best = min(best, residual)
        # x + (I - J)^-1 (P(x) - x), with J = [[a, c], [b, d]]
        determinant = (1.0 - a) * (1.0 - d) - b * c
        to_angle = ((1.0 - d) * miss + c * miss_rate) / determinant
        to_velocity = (b * miss + (1.0 - a) * miss_rate) / determinant
        error = size(to_angle, to_velocity)
        lost = not image.certain or failures > MOST_FAILURES or work > most_work or not error < math.inf
        if converged or lost or steps > MOST_STEPS:
            break
        angle += to_angle
        velocity += to_velocity
        if not (abs(angle) <= reach and abs(velocity) <= FARTHEST):
            break
    return Found(converged, angle, velocity, image, residual, error, work)


@njit(**WITHIN)
def multipliers(tangent):
    """Both eigenvalues, the larger first: (real, imaginary, real, imaginary)."""
    middle = 0.5 * (tangent.a + tangent.d)
    apart = 0.5 * (tangent.a - tangent.d)
    square = apart * apart + tangent.b * tangent.c
    determinant = tangent.a * tangent.d - tangent.b * tangent.c
    if square < 0.0:
        root = math.sqrt(-square)
        return middle, root, middle, -root
    root = math.sqrt(square)
    large = middle + root if middle >= 0.0 else middle - root
    small = determinant / large if large != 0.0 else 0.0
    return large, 0.0, small, 0.0


@njit(**WITHIN)
def adapted_norm(tangent, radius):
    """(q11, q12, q22) of a norm in which a matrix with spectral radius < ``radius`` shrinks by ``radius`` at least.

    Q = sum over k of N^kT N^k with N = M/radius, by doubling; without eigenvectors, which coincide where the multipliers do.
    """
    q11, q12, q22 = 1.0, 0.0, 1.0
    # the columns of N are (a, b) and (c, d)
    a, b, c, d = tangent.a / radius, tangent.b / radius, tangent.c / radius, tangent.d / radius
    for _ in range(60):
        # Q N, then N^T of it
        t11, t12 = q11 * a + q12 * b, q11 * c + q12 * d
        t21, t22 = q12 * a + q22 * b, q12 * c + q22 * d
        q11, q12, q22 = q11 + a * t11 + b * t21, q12 + a * t12 + b * t22, q22 + c * t12 + d * t22
        a, b, c, d = a * a + c * b, b * a + d * b, a * c + c * d, b * c + d * d
        if max(abs(a), abs(b), abs(c), abs(d)) < 1e-9:
            break
    return q11, q12, q22


@njit(**WITHIN)
def length(norm, x, y):
    """Length of (x, y) in an adapted norm."""
    q11, q12, q22 = norm
    return math.sqrt(q11 * x * x + 2.0 * q12 * x * y + q22 * y * y)
