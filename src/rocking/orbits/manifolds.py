"""Stable and unstable manifolds on a section: of the saddle orbits Θ = ±1 + β cos ψ, and of any saddle orbit with impacts.

A manifold grows on a section: points are added until neighbours are close (Hobson 1993, J. Comput. Phys. 104, 14).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.motion import march
from rocking.kernels.orbits import manifold as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.orbit import Orbit
from rocking.model.quantity import PHASE
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, quantities
from rocking.model.validation import Refusal, TooManyEvents, instance, whole, within
from rocking.motion.march_loop import monodromy
from rocking.orbits.event_chain import clocked
from rocking.orbits.saddles import check, check_reversible, parameters, response, saddle

if TYPE_CHECKING:
    import xarray as xr

# Largest angle between neighbouring pieces of a curve, rad, if they are longer than this fraction of the spacing.
BEND, SHORT = 0.2, 1e-2
MAX_POINTS = 400_000
# Smallest difference of times, relative to the longest one, above rounding.
FINEST = 1e-13
# Margin around the region of bounded motions.
MARGIN = 0.5


def region(response: float, frequency: float) -> np.ndarray:
    """Return the largest |Θ| and |Θ'| (2,) of all bounded motions without braces, from β and Ω, with a margin."""
    return np.array([1.0 + response, 1.0 + response * (1.0 + frequency)]) + MARGIN


def grow(
    images: Callable[[np.ndarray], np.ndarray], times: np.ndarray, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Grow a curve from its points at ``times``; ``images`` returns its points (n, 2) at any times (n,).

    Returns
    -------
    tuple of (ndarray, ndarray, bool)
        Times; points; True if the curve is resolved.
    """
    points = images(times)
    while True:
        wide = _too_wide(points, spacing, box)
        wide &= np.diff(times) > FINEST * times[-1]
        if not wide.any():
            return times, points, True
        if len(times) + wide.sum() > MAX_POINTS:
            return times, points, False
        new = 0.5 * (times[:-1] + times[1:])[wide]
        where = np.flatnonzero(wide) + 1
        points = np.insert(points, where, images(new), axis=0)
        times = np.insert(times, where, new)


def pieces(
    times: np.ndarray, points: np.ndarray, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return times and points of a curve within the region, with a row of NaN between its pieces."""
    # An impact at the phase of the section makes the curve discontinuous: Θ' jumps to e Θ'.
    with np.errstate(invalid="ignore", over="ignore"):
        torn = np.concatenate([[False], ~(np.hypot(*np.diff(points, axis=0).T) <= spacing)])
    rows = _within(points, torn, box)
    breaks = np.flatnonzero((np.diff(rows) > 1) | torn[rows[1:]]) + 1
    return np.insert(times[rows], breaks, math.nan), np.insert(points[rows], breaks, math.nan, axis=0)


def _within(points: np.ndarray, torn: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the indices of the points inside the box, and of the neighbours from which they are not ``torn``."""
    inside = (np.abs(points) <= box).all(axis=1)
    near = inside.copy()
    near[1:] |= inside[:-1] & ~torn[1:]
    near[:-1] |= inside[1:] & ~torn[1:]
    return np.flatnonzero(near & np.isfinite(points).all(axis=1))


def _too_wide(points: np.ndarray, spacing: float, box: np.ndarray) -> np.ndarray:
    """Return which pieces between neighbours must be halved: too long, too bent, or across the region of bounded motions."""
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


def too_many_impacts(remedy: str) -> TooManyEvents:
    """Return the error for a motion with too many impacts; ``remedy`` is what should be reduced."""
    return TooManyEvents(
        f"more than {march.MAX_EVENTS:,} impacts before one point: the block chatters with little energy loss (reduce {remedy})"
    )


SPACINGS = (1e-5, 1.0)


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


def manifold_columns(curves: Sequence[Manifold], since: str) -> dict[str, Any]:
    """Return the points of manifolds along `point`, and their properties along `curve`."""
    points = np.concatenate([one.points for one in curves])
    numbers = np.repeat(np.arange(len(curves)), [len(one.points) for one in curves])
    of_points = {
        "angle": (points[:, 0], "angle"),
        "velocity": (points[:, 1], "angular velocity"),
        "time": (np.concatenate([one.times for one in curves]), f"time {since}"),
        "curve_number": (numbers, "number of the curve"),
    }
    of_curves = {
        "curve_stable": ([one.stable for one in curves], "whether the curve is stable"),
        "curve_side": ([one.side for one in curves], "sign of the side to which the curve belongs"),
        "curve_resolved": ([one.resolved for one in curves], "whether the curve is resolved"),
    }
    return along("point", of_points) | along("curve", of_curves)


def lengths_in_words(unstable: Sequence[Manifold], stable: Sequence[Manifold]) -> str:
    """Return the total lengths of both kinds of manifold, and their number of points, as text."""
    lengths = [sum(one.length for one in curves) for curves in (unstable, stable)]
    points = sum(len(one.points) for one in (*unstable, *stable))
    return f"unstable length {lengths[0]:.4g}, stable length {lengths[1]:.4g}, {points:,} points"


def manifold_of(
    side: int,
    backward: bool,
    first: tuple[np.ndarray, np.ndarray],
    grown: tuple[np.ndarray, np.ndarray],
    resolved: bool,
) -> Manifold:
    """Return a manifold that begins with given times and points, before those that grew; Θ' is negated in reversed time."""
    times, points = (np.concatenate(parts) for parts in zip(first, grown, strict=True))
    return Manifold(
        stable=backward,
        side=side,
        points=points * (1.0, -1.0 if backward else 1.0),
        times=times,
        resolved=resolved,
    )


@frozen(eq=False)
class SaddleManifolds(ReadOnlyArrays, Result):
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

    PLOT = "manifolds"
    LONG = ("point",)

    system: System
    phase: float
    cycles: int
    saddles: NDArray[np.float64] = field(repr=False, converter=read_only)
    unstable: tuple[Manifold, ...] = field(repr=False)
    stable: tuple[Manifold, ...] = field(repr=False)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        saddles = {
            "saddle_angle": (self.saddles[:, 0], "angle of the saddle orbit"),
            "saddle_velocity": (self.saddles[:, 1], "angular velocity of the saddle orbit"),
        }
        curves = manifold_columns(
            (*self.unstable, *self.stable), "from or to a small distance from the saddle orbit"
        )
        variables = curves | along("saddle", saddles)
        attributes = described("Manifolds of the saddle orbits") | {
            **quantities(self.system),
            "section_phase": self.phase,
            "cycles": self.cycles,
        }
        return xr.Dataset(variables, attrs=attributes)

    def __str__(self) -> str:
        rough = sum(not one.resolved for one in (*self.unstable, *self.stable))
        gaps = f"; {rough} of 4 not resolved (reduce cycles)" if rough else ""
        lengths = lengths_in_words(self.unstable, self.stable)
        return f"manifolds of the saddles at ψ = {self.phase:.4g}, grown over {self.cycles} cycles: {lengths}{gaps}"


MAX_CYCLES = 100
# Points of a curve per forcing cycle, to begin with.
PER_CYCLE = 64


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
    rocking.orbits.saddles.manifold_gap : Gap between two manifolds.
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
    phase = system.harmonic.phase if phase is None else PHASE.checked(phase)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
    spacing = within("spacing", spacing, *SPACINGS)
    unstable, stable = (
        tuple(_of_saddle(system, phase, cycles, spacing, side, backward) for side in (1, -1))
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


def _of_saddle(
    system: System, phase: float, cycles: int, spacing: float, side: int, backward: bool
) -> Manifold:
    """Return one manifold of the saddle orbit on one side."""
    box = region(response(system), system.harmonic.frequency)
    p = parameters(system, phase, backward)
    first = np.linspace(0.0, cycles * p.forcing.period, PER_CYCLE * cycles + 1)
    times, points, resolved = grow(partial(_from_saddle, p, side), first, spacing, box)
    centre = np.array(saddle(system, -phase if backward else phase, side))
    straight = np.array([math.nan, -math.inf]), np.array([centre + side * (2.0 * box.max()), centre])
    return manifold_of(side, backward, straight, pieces(times, points, spacing, box), resolved)


def _from_saddle(p: Any, side: int, times: np.ndarray) -> np.ndarray:
    """Return the points of a curve at times since a distance from the saddle orbit, in τ (n,)."""
    out = np.empty((len(times), 2))
    if not kernel.images(p, side, times, out):
        raise too_many_impacts("restitution or cycles")
    return out


LENGTHS = (1e-3, 1e4)
# Distance from the orbit at which a curve starts. Its curvature there is an error of this size, relative to the distance.
NEAR = 1e-6
# Points of a curve between a distance from the orbit and its image, to begin with.
PER_RETURN = 8
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
        rough = sum(not one.resolved for one in curves)
        gaps = f"; {rough} of {len(curves)} halves not resolved (reduce length)" if rough else ""
        short = sum(one.length < self.wanted for one in curves)
        gaps += f"; {short} of {len(curves)} halves end before a length of {self.wanted:.4g}" if short else ""
        lengths = lengths_in_words(self.unstable, self.stable)
        return f"manifolds of an orbit of period {self.orbit.period} at ψ = {self.phase:.4g}: {lengths}{gaps}"


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
    images = partial(_from_orbit, p, point, NEAR * vector, factor, cycles)
    returns, curve, resolved = _followed(images, length, spacing, box)
    returns, curve = pieces(returns, curve, spacing, box)
    start, times = (np.array([-math.inf]), point[None]), returns * cycles * forcing.period
    return manifold_of(side, backward, start, (times, curve), resolved)


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
        first = np.linspace(number, number + 1, PER_RETURN + 1)
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


def _from_orbit(
    p: Any, point: np.ndarray, step: np.ndarray, factor: float, cycles: int, times: np.ndarray
) -> np.ndarray:
    """Return the points of a curve at times in returns (n,): after whole returns from a point of its first piece."""
    whole = np.floor(times)
    starts = point + factor ** (times - whole)[:, None] * step
    out = np.empty((len(times), 2))
    if not kernel.returns(p, starts, whole.astype(np.int64) * cycles, out):
        raise too_many_impacts("length")
    return out
