"""Stable and unstable manifolds of the saddle orbits near Θ = ±1, grown from their exact eigendirections."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.kernels.march import march
from rocking.kernels.orbits import saddle_manifold as kernel
from rocking.model import (
    MAX_PHASE,
    NotebookPicture,
    ReadOnlyArrays,
    System,
    TooManyEvents,
    read_only,
    whole,
    within,
)
from rocking.orbits.saddle_orbits import check, parameters, response, saddle

if TYPE_CHECKING:
    from numpy.typing import NDArray

MAX_CYCLES = 100
SPACINGS = (1e-5, 1.0)
# Neighbouring pieces of a curve longer than this share of the spacing bend by no more than this angle, rad.
BEND, SHORT = 0.2, 1e-2
FIRST_POINTS = 64
MAX_POINTS = 400_000
# Times of leaving nearer than this, in periods, are one to rounding.
FINEST = 1e-13
# Around all that is bounded.
MARGIN = 0.5


@frozen(eq=False)
class Manifold(ReadOnlyArrays):
    """One manifold of one saddle orbit, on the section.

    Attributes
    ----------
    stable : bool
        Whether motions on it end on the saddle orbit; on an unstable one they came from there.
    side : int
        1 for the saddle orbit near Θ = 1, −1 for that near Θ = −1.
    points : ndarray, shape (n, 2)
        (Θ, Θ') in order along the curve, which begins with its straight outer half and passes through the saddle; a row of
        NaN separates what lies apart, where the curve leaves the picture for motions that never return.
    times : ndarray, shape (n,)
        How long before (unstable) or after (stable) the motion there is ½(1 − β)√2 from the saddle orbit, τ: a cycle
        carries a point to the one a forcing period on. −∞ at the saddle, NaN on the outer half and between pieces.
    resolved : bool
        Whether neighbours are nowhere farther apart than asked for; if not, the curve grew beyond 400,000 points.
    """

    stable: bool
    side: int
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    times: NDArray[np.float64] = field(repr=False, converter=read_only)
    resolved: bool

    @property
    def length(self) -> float:
        """Of all pieces together, in the plane of Θ and Θ'."""
        return float(np.nansum(np.hypot(*np.diff(self.points, axis=0).T)))


@frozen(eq=False)
class SaddleManifolds(ReadOnlyArrays, NotebookPicture):
    """The manifolds of both saddle orbits on a section; made by `saddle_manifolds`.

    Attributes
    ----------
    system : System
        Whose they are.
    phase : float
        Forcing phase ψ of the section, rad.
    cycles : int
        Forcing cycles over which they were grown.
    saddles : ndarray, shape (2, 2)
        (Θ, Θ') of the saddles near Θ = 1 and Θ = −1.
    unstable, stable : tuple of two Manifold
        Of the saddle near Θ = 1, and of that near Θ = −1.
    """

    system: System
    phase: float
    cycles: int
    saddles: NDArray[np.float64] = field(repr=False, converter=read_only)
    unstable: tuple[Manifold, ...] = field(repr=False)
    stable: tuple[Manifold, ...] = field(repr=False)

    def __str__(self) -> str:
        curves = (*self.unstable, *self.stable)
        lengths = [sum(one.length for one in pair) for pair in (self.unstable, self.stable)]
        rough = sum(not one.resolved for one in curves)
        gaps = f"; {rough} of 4 not resolved (take fewer cycles)" if rough else ""
        return (
            f"manifolds of the saddles at ψ = {self.phase:.4g}, {self.cycles} cycles long: unstable length {lengths[0]:.4g}, "
            f"stable {lengths[1]:.4g}, {sum(len(one.points) for one in curves):,} points{gaps}"
        )


def saddle_manifolds(
    system: System, phase: float | None = None, cycles: int = 4, spacing: float = 0.02
) -> SaddleManifolds:
    """Grow the stable and unstable manifolds of the saddle orbits Θ = ±1 + β cos ψ (eq. 17 of Yim & Lin 1991, exact for A > 0).

    Between two impacts motions near a saddle obey a linear equation, so that until they first touch the base its
    manifolds are straight lines on every section; from there the engine carries them on, the stable ones backward in
    time: with Θ' and φ negated and e replaced by 1/e the equations of motion are the same. Points are added until
    neighbours are near each other and the curve bends by no more than 0.2 rad between them (Hobson 1993, J. Comput. Phys. 104, 14).

    Parameters
    ----------
    system : System
        Without braces; β = A/(1 + Ω²) < 1, so that the saddle orbits keep to their sides, and e > 0, so that impacts can be
        reversed.
    phase : float, optional
        Forcing phase of the section, rad; by default the forcing's own.
    cycles : int
        Over how many forcing cycles the curves are grown, 1 to 100; their length grows exponentially.
    spacing : float
        Largest distance of neighbours, in [1e-5, 1].

    Returns
    -------
    SaddleManifolds

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range, and for a system without such saddle orbits.
    TooManyEvents
        More than 10⁷ impacts on the way to one point.

    See Also
    --------
    manifold_gap : Gap between two manifolds.
    tangency_amplitude : Amplitude of the first tangency.
    rocking.plot.manifolds : Plot the manifolds.

    Notes
    -----
    Not guaranteed: that a fold of the curve is seen that lies between two neighbours both near each other, or both beyond the
    picture |Θ| < 3/2 + β, |Θ'| < 3/2 + β(1 + Ω), in which every bounded motion without braces lies. Where the block comes to rest
    an unstable manifold ends in the point (0, 0).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
    >>> manifolds = rk.saddle_manifolds(system, cycles=3)
    >>> manifolds.saddles.round(4).tolist()  # ±1 + β
    [[1.0988, 0.0], [-0.9012, 0.0]]
    >>> all(one.resolved for one in (*manifolds.unstable, *manifolds.stable))
    True
    """
    check(system)
    phase = system.forcing.phase if phase is None else within("phase", phase, -MAX_PHASE, MAX_PHASE)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
    spacing = within("spacing", spacing, *SPACINGS)
    unstable, stable = (
        tuple(_manifold(system, phase, cycles, spacing, side, backward) for side in (1, -1))
        for backward in (False, True)
    )
    return SaddleManifolds(
        system=system,
        phase=phase,
        cycles=cycles,
        saddles=np.array([saddle(system, phase, side) for side in (1, -1)]),
        unstable=unstable,
        stable=stable,
    )


def _manifold(
    system: System, phase: float, cycles: int, spacing: float, side: int, backward: bool
) -> Manifold:
    beta, frequency = response(system), system.forcing.frequency
    box = np.array([1.0 + beta, 1.0 + beta * (1.0 + frequency)]) + MARGIN
    p = parameters(system, phase, backward)
    times, points, resolved = _grown(p, side, cycles, spacing, box)
    centre = np.array(saddle(system, -phase if backward else phase, side))
    end = centre + side * (2.0 * box.max())
    rows = _within(points, box)
    # An impact at the section's own instant tears the curve: Θ' jumps there to e Θ'.
    torn = np.concatenate([[False], np.hypot(*np.diff(points, axis=0).T) > spacing])
    apart = np.flatnonzero((np.diff(rows) > 1) | torn[rows[1:]]) + 1
    whole = np.insert(points[rows], apart, math.nan, axis=0)
    curve = np.concatenate([[end, centre], whole])
    moments = np.concatenate([[math.nan, -math.inf], np.insert(times[rows], apart, math.nan)])
    if backward:
        curve[:, 1] *= -1.0
    return Manifold(stable=backward, side=side, points=curve, times=moments, resolved=resolved)


def _within(points: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Rows inside the box, and those beside them."""
    inside = (np.abs(points) <= box).all(axis=1)
    near = inside.copy()
    near[1:] |= inside[:-1]
    near[:-1] |= inside[1:]
    return np.flatnonzero(near & np.isfinite(points).all(axis=1))


def _grown(
    p: Any, side: int, cycles: int, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray, bool]:
    """(times, points, whether it is resolved) of the inner half of a manifold, points added until neighbours are near."""
    times = np.linspace(0.0, cycles * p.period, FIRST_POINTS * cycles + 1)
    points = _images(p, side, times)
    while True:
        wide = _too_wide(points, spacing, box)
        wide &= np.diff(times) > FINEST * cycles * p.period
        if not wide.any():
            return times, points, True
        if len(times) + wide.sum() > MAX_POINTS:
            return times, points, False
        new = 0.5 * (times[:-1] + times[1:])[wide]
        where = np.flatnonzero(wide) + 1
        points = np.insert(points, where, _images(p, side, new), axis=0)
        times = np.insert(times, where, new)


def _images(p: Any, side: int, times: np.ndarray) -> np.ndarray:
    out = np.empty((len(times), 2))
    if not kernel.images(p, side, times, out):
        raise TooManyEvents(
            f"more than {march.MAX_EVENTS:,} impacts on the way to one point: the block chatters almost without loss "
            "(take a smaller restitution, or fewer cycles)"
        )
    return out


def _too_wide(points: np.ndarray, spacing: float, box: np.ndarray) -> np.ndarray:
    """Which pieces between neighbours are to be halved: too long, too bent, or from beyond one end of the picture to another."""
    with np.errstate(invalid="ignore", over="ignore"):
        steps = np.diff(points, axis=0)
        lengths = np.hypot(*steps.T)
        inside = (np.abs(points) <= box).all(axis=1)
        seen = inside[:-1] | inside[1:] | (np.sign(points[:-1, 0]) != np.sign(points[1:, 0]))
        wide = seen & ~(lengths <= spacing)
        cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
        dot = (steps[:-1] * steps[1:]).sum(axis=1)
        bent = (np.abs(np.arctan2(cross, dot)) > BEND) & inside[1:-1]
        long = lengths > SHORT * spacing
        wide[:-1] |= bent & long[:-1] & seen[:-1]
        wide[1:] |= bent & long[1:] & seen[1:]
    return wide
