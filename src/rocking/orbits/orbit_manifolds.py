"""Stable and unstable manifolds of any saddle orbit on a section, grown from the eigenvectors of its return map."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.orbits import saddle_manifold as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.orbit import Orbit
from rocking.model.quantity import PHASE
from rocking.model.result import Result, along, described
from rocking.model.system import State, quantities
from rocking.model.validation import Refusal, instance, within
from rocking.motion.march_loop import monodromy
from rocking.orbits.event_chain import clocked
from rocking.orbits.saddle_manifolds import (
    MAX_POINTS,
    SPACINGS,
    Manifold,
    check_reversible,
    grow,
    manifold_columns,
    parameters,
    pieces,
    region,
    too_many_impacts,
)

if TYPE_CHECKING:
    import xarray as xr

LENGTHS = (1e-3, 1e4)
# Distance from the orbit at which a curve starts. Its curvature there is an error of this size, relative to the distance.
NEAR = 1e-6
# Points of a curve between a distance from the orbit and its image, to begin with.
FIRST_POINTS = 8
# A curve ends if it grows by less than this fraction of the length wanted from one return to the next.
STILL = 1e-9
MAX_RETURNS = 1_000
# Least modulus of the multiplier outside the unit circle: at it a curve becomes as long as 1 within MAX_RETURNS.
SLOWEST = 1.02


@frozen(eq=False)
class OrbitManifolds(ReadOnlyArrays, Result):
    """Manifolds of a saddle orbit on a section; returned by `orbit_manifolds`.

    Attributes
    ----------
    orbit : Orbit
        The saddle orbit.
    phase : float
        Forcing phase ψ of the section, rad.
    wanted : float
        Length that was wanted of each half.
    points : ndarray, shape (period, 2)
        Θ and Θ' of the orbit on the section.
    unstable, stable : tuple of Manifold
        Two halves at each point of the orbit, one after another. `side` is the sign of the change of Θ along the half where it
        leaves the orbit. `times` are counted from a distance of 10⁻⁶.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=8.0, period=2.0), restitution=0.925)
    >>> saddle = next(orbit for orbit in rk.find_orbits(system, 1) if orbit.symmetric)
    >>> manifolds = rk.orbit_manifolds(saddle, length=2.0)
    >>> manifolds.points.shape, len(manifolds.unstable), len(manifolds.stable)
    ((1, 2), 2, 2)
    """

    PLOT = "orbit_manifolds"
    LONG = ("point",)

    orbit: Orbit
    phase: float
    wanted: float
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    unstable: tuple[Manifold, ...] = field(repr=False)
    stable: tuple[Manifold, ...] = field(repr=False)

    @property
    def block(self) -> Any:
        """Block of the system, None if there is none."""
        return self.orbit.system.block

    def _data(self) -> xr.Dataset:
        import xarray as xr

        curves = (*self.unstable, *self.stable)
        # Two halves at each point of the orbit, one after another, first of the unstable manifold.
        starts = np.arange(len(curves)) // 2 % len(self.points)
        orbit = {
            "orbit_angle": (self.points[:, 0], "angle of the orbit"),
            "orbit_velocity": (self.points[:, 1], "angular velocity of the orbit"),
        }
        begins = starts, "number of the point of the orbit where the curve begins"
        variables = {
            **manifold_columns(curves, "from or to a distance of 1e-6 from the orbit"),
            **along("curve", {"curve_orbit_point": begins}),
            **along("orbit_point", orbit),
        }
        attributes = described("Manifolds of a periodic orbit") | {
            **quantities(self.orbit.system),
            "orbit_period": self.orbit.period,
            "section_phase": self.phase,
            "wanted_length": self.wanted,
        }
        return xr.Dataset(variables, attrs=attributes)

    def __str__(self) -> str:
        curves = (*self.unstable, *self.stable)
        lengths = [sum(one.length for one in halves) for halves in (self.unstable, self.stable)]
        rough = sum(not one.resolved for one in curves)
        gaps = f"; {rough} of {len(curves)} halves not resolved (reduce length)" if rough else ""
        short = sum(one.length < self.wanted for one in curves)
        gaps += f"; {short} of {len(curves)} halves end before a length of {self.wanted:.4g}" if short else ""
        return (
            f"manifolds of an orbit of period {self.orbit.period} at ψ = {self.phase:.4g}: unstable length {lengths[0]:.4g}, "
            f"stable length {lengths[1]:.4g}, {sum(len(one.points) for one in curves):,} points{gaps}"
        )


def orbit_manifolds(
    orbit: Orbit, length: float = 10.0, phase: float | None = None, spacing: float = 0.02
) -> OrbitManifolds:
    """Compute the stable and unstable manifolds of a saddle orbit of any period.

    Each half of a manifold starts at a distance of 10⁻⁶ along an eigenvector of the return map over a response period. It is
    the image of its first piece, which reaches from a point to the image of this point. Stable manifolds are followed backward
    in time. Stable manifolds bound basins of attraction. A crisis is a contact of both kinds of manifold.

    Parameters
    ----------
    orbit : Orbit
        Saddle orbit with impacts, of a slender block without braces: one real multiplier outside the unit circle, one inside.
    length : float
        Length over which each half is followed, at least, in the plane of Θ and Θ', in [1e-3, 1e4]. The last return may add much
        more. Default: 10.
    phase : float, optional
        Forcing phase ψ of the section, rad. Default: that of the orbit, `orbit.phase`.
    spacing : float
        Largest distance of neighbouring points, in [1e-5, 1]. Default: 0.02.

    Returns
    -------
    OrbitManifolds
        Points of the orbit, and two halves of each manifold at each of them.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or the block is not slender.
    ValueError
        If an argument lies outside its range, or if the orbit is no saddle orbit. If the system has braces, or e = 0, so that
        impacts cannot be reversed.
    TooManyEvents
        If there are more than 10⁷ impacts before one point.

    See Also
    --------
    find_orbits : Search for orbits, also unstable ones.
    saddle_manifolds : Compute the manifolds of the saddle orbits without impacts.
    basin_map : Map the basins of attraction.
    rocking.plot.orbit_manifolds : Plot the manifolds.

    Notes
    -----
    A half ends earlier where it approaches an attractor, or where its last piece leaves the region of bounded motions.
    Limits: a fold of the curve is not detected if it lies between two neighbours that are close to each other.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=8.0, period=2.0), restitution=0.925)
    >>> saddle = next(orbit for orbit in rk.find_orbits(system, 1) if orbit.symmetric)
    >>> manifolds = rk.orbit_manifolds(saddle, length=2.0)
    >>> all(one.resolved for one in (*manifolds.unstable, *manifolds.stable))
    True
    """
    instance("orbit", orbit, Orbit)
    check_reversible(orbit.system)
    moduli = sorted(abs(value) for value in orbit.multipliers)
    if orbit.superstable or not moduli[0] < 1.0 < moduli[1] or not orbit.impacts:
        raise Refusal("orbit", "be a saddle orbit with impacts", f"{orbit.stability} {orbit}")
    if moduli[1] < SLOWEST:
        allowed = f"have a multiplier of at least {SLOWEST} in modulus, so that its manifolds grow in reasonable time"
        raise Refusal("orbit", allowed, moduli[1])
    length, spacing = within("length", length, *LENGTHS), within("spacing", spacing, *SPACINGS)
    phase = orbit.phase if phase is None else PHASE.checked(phase)
    points = np.array(
        [[(state := orbit.at(phase + math.tau * k)).angle, state.velocity] for k in range(orbit.period)]
    )
    unstable, stable = (
        tuple(
            _half(orbit, phase, point, side, backward, length, spacing)
            for point in points
            for side in (1, -1)
        )
        for backward in (False, True)
    )
    return OrbitManifolds(orbit, phase, length, points, unstable, stable)


def _half(
    orbit: Orbit, phase: float, point: np.ndarray, side: int, backward: bool, length: float, spacing: float
) -> Manifold:
    """Return one half of a manifold at a point of the orbit."""
    forcing = orbit.system.harmonic
    response = forcing.amplitude / (1.0 + forcing.frequency**2)
    box = region(response, forcing.frequency)
    factor, vector, cycles = _eigenvector(orbit, phase, point, backward)
    if backward:
        point, vector = point * (1.0, -1.0), vector * (1.0, -1.0)
    vector = vector * math.copysign(1.0, side * vector[0])
    p = parameters(orbit.system, phase, backward)
    images = partial(_images, p, point, NEAR * vector, factor, cycles)
    times, curve, resolved = _followed(images, length, spacing, box)
    times, curve = pieces(times, curve, spacing, box)
    if backward:
        curve = curve * (1.0, -1.0)
        point = point * (1.0, -1.0)
    return Manifold(
        stable=backward,
        side=side,
        points=np.concatenate([point[None], curve]),
        times=np.concatenate([[-math.inf], times * cycles * forcing.period]),
        resolved=resolved,
    )


def _followed(
    images: Callable[[np.ndarray], np.ndarray], length: float, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Follow a curve from one return to the next until it is long enough, or grows no more.

    Returns
    -------
    tuple of (ndarray, ndarray, bool)
        Times in returns; points; True if the curve is resolved.
    """
    times, points, covered, resolved = np.zeros(1), images(np.zeros(1)), 0.0, True
    for number in range(MAX_RETURNS):
        first = np.linspace(number, number + 1, FIRST_POINTS + 1)
        more, new, resolved = grow(images, first, spacing, box)
        times, points = np.concatenate([times, more[1:]]), np.concatenate([points, new[1:]])
        inside = (np.abs(new) <= box).all(axis=1)
        steps = np.hypot(*np.diff(new, axis=0).T)
        grew = float(steps[inside[:-1] & inside[1:]].sum())
        covered += grew
        begun = covered > 1e3 * NEAR
        if covered >= length or not resolved or len(times) > MAX_POINTS or (begun and grew <= STILL * length):
            break
    return times, points, resolved


def _eigenvector(
    orbit: Orbit, phase: float, point: np.ndarray, backward: bool
) -> tuple[float, np.ndarray, int]:
    """Return the growth of a distance from the orbit per return, its unit vector, and the forcing cycles of a return.

    A return takes two periods if the multiplier is negative, so that no side is changed.
    """
    start = State(*point.tolist())
    values, vectors = np.linalg.eig(monodromy(clocked(orbit.system, phase), start, orbit.period))
    k = int(np.argmin(np.abs(values)) if backward else np.argmax(np.abs(values)))
    value, vector = float(values[k].real), vectors[:, k].real
    growth = 1.0 / abs(value) if backward else abs(value)
    twice = 2 if value < 0.0 else 1
    return growth**twice, vector / np.hypot(*vector), twice * orbit.period


def _images(
    p: Any, point: np.ndarray, step: np.ndarray, factor: float, cycles: int, times: np.ndarray
) -> np.ndarray:
    """Return the points of a curve at times in returns (n,): after whole returns from a point of its first piece."""
    whole = np.floor(times)
    starts = point + factor ** (times - whole)[:, None] * step
    out = np.empty((len(times), 2))
    if not kernel.returns(p, starts, whole.astype(np.int64) * cycles, out):
        raise too_many_impacts("length")
    return out
