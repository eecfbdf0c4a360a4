"""Stable and unstable manifolds of the saddle orbits near Θ = ±1, grown from their exact eigendirections."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.orbits import saddle_manifold as kernel
from rocking.model.forcing import MAX_PHASE
from rocking.model.result import NotebookPicture, ReadOnlyArrays, read_only
from rocking.model.system import System
from rocking.model.validation import whole, within
from rocking.orbits.manifold_growth import grow, pieces, region
from rocking.orbits.saddle_orbits import check, parameters, response, saddle, too_many_impacts

MAX_CYCLES = 100
SPACINGS = (1e-5, 1.0)
FIRST_POINTS = 64


@frozen(eq=False)
class Manifold(ReadOnlyArrays):
    """One manifold of one saddle orbit, on the section.

    Attributes
    ----------
    stable : bool
        True if motions on the manifold converge to the saddle orbit, False if they depart from it.
    side : int
        1 for the saddle orbit near Θ = 1, −1 for that near Θ = −1.
    points : ndarray, shape (n, 2)
        Θ and Θ' in order along the curve. It begins with its straight outer half and passes through the saddle. A row of NaN
        separates pieces where the curve leaves the region of bounded motions.
    times : ndarray, shape (n,)
        Time τ since (unstable) or until (stable) a distance of ½(1 − β)√2 from the saddle orbit. One forcing period later, a
        point is at the point whose time is one period larger. −∞ at the saddle, NaN on the outer half and between pieces.
    resolved : bool
        True if no neighbouring points are farther apart than the spacing. False if this would need more than 400,000 points.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
    >>> unstable = rk.saddle_manifolds(system, cycles=1).unstable[0]
    >>> unstable.side, unstable.stable, unstable.length > 1.0
    (1, False, True)
    """

    stable: bool
    side: int
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    times: NDArray[np.float64] = field(repr=False, converter=read_only)
    resolved: bool

    @property
    def length(self) -> float:
        """Total length of all pieces in the plane of Θ and Θ'."""
        return float(np.nansum(np.hypot(*np.diff(self.points, axis=0).T)))


@frozen(eq=False)
class SaddleManifolds(ReadOnlyArrays, NotebookPicture):
    """Manifolds of both saddle orbits on a section; returned by `saddle_manifolds`.

    Attributes
    ----------
    system : System
        System of the saddle orbits.
    phase : float
        Forcing phase ψ of the section, rad.
    cycles : int
        Number of forcing cycles over which the manifolds were grown.
    saddles : ndarray, shape (2, 2)
        Θ and Θ' of the saddles near Θ = 1 and Θ = −1.
    unstable, stable : tuple of two Manifold
        Manifolds of the saddle near Θ = 1, and of that near Θ = −1.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
    >>> manifolds = rk.saddle_manifolds(system, cycles=1)
    >>> manifolds.saddles.shape, len(manifolds.unstable), len(manifolds.stable)
    ((2, 2), 2, 2)
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
        gaps = f"; {rough} of 4 not resolved (reduce cycles)" if rough else ""
        return (
            f"manifolds of the saddles at ψ = {self.phase:.4g}, grown over {self.cycles} cycles: unstable length "
            f"{lengths[0]:.4g}, stable length {lengths[1]:.4g}, {sum(len(one.points) for one in curves):,} points{gaps}"
        )


def saddle_manifolds(
    system: System, phase: float | None = None, cycles: int = 4, spacing: float = 0.02
) -> SaddleManifolds:
    """Compute the stable and unstable manifolds of the saddle orbits Θ = ±1 + β cos ψ.

    The saddle orbits are those of Yim & Lin (1991), Eq. (17), exact for A > 0. Between impacts, the equation of motion near a
    saddle is linear. Its manifolds are therefore straight lines on every section up to their first contact with the base.
    Beyond, they are continued by simulation, the stable ones backward in time. With Θ' and φ negated and e replaced by 1/e,
    the equations of motion are the same. Points are added until neighbours are closer than the spacing and the curve bends by
    at most 0.2 rad between them (Hobson 1993, J. Comput. Phys. 104, 14).

    Parameters
    ----------
    system : System
        System without braces, with β = A/(1 + Ω²) < 1, so that the saddle orbits do not pass through Θ = 0. e > 0, so that
        impacts can be reversed in time.
    phase : float, optional
        Forcing phase ψ of the section, rad. Default: the phase φ of the forcing.
    cycles : int
        Number of forcing cycles over which the curves are grown, in [1, 100]. Their length grows exponentially. Default: 4.
    spacing : float
        Largest distance of neighbouring points, in [1e-5, 1]. Default: 0.02.

    Returns
    -------
    SaddleManifolds
        Saddles and their four manifolds.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range, or if the system has no such saddle orbits.
    TooManyEvents
        If there are more than 10⁷ impacts before one point.

    See Also
    --------
    manifold_gap : Gap between two manifolds.
    tangency_amplitude : Amplitude of the first tangency.
    rocking.plot.manifolds : Plot the manifolds.

    Notes
    -----
    Limits: a fold of the curve is not detected if it lies between two neighbours that are close to each other. The same holds
    if both neighbours lie outside the region |Θ| < 3/2 + β, |Θ'| < 3/2 + β(1 + Ω), which contains every bounded motion without
    braces. If the block comes to rest, an unstable manifold ends at (0, 0).

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
    phase = system.harmonic.phase if phase is None else within("phase", phase, -MAX_PHASE, MAX_PHASE)
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
    box = region(response(system), system.harmonic.frequency)
    p = parameters(system, phase, backward)
    first = np.linspace(0.0, cycles * p.forcing.period, FIRST_POINTS * cycles + 1)
    times, points, resolved = grow(partial(_images, p, side), first, spacing, box)
    centre = np.array(saddle(system, -phase if backward else phase, side))
    end = centre + side * (2.0 * box.max())
    moments, curve = pieces(times, points, spacing, box)
    curve = np.concatenate([[end, centre], curve])
    moments = np.concatenate([[math.nan, -math.inf], moments])
    if backward:
        curve[:, 1] *= -1.0
    return Manifold(stable=backward, side=side, points=curve, times=moments, resolved=resolved)


def _images(p: Any, side: int, times: np.ndarray) -> np.ndarray:
    out = np.empty((len(times), 2))
    if not kernel.images(p, side, times, out):
        raise too_many_impacts("restitution or cycles")
    return out
