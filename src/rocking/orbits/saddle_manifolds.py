"""Saddle orbits near Θ = ±1, their stable and unstable manifolds, and the first tangency of these.

A manifold grows on a section: points are added until neighbours are close (Hobson 1993, J. Comput. Phys. 104, 14).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.march import march
from rocking.kernels.orbits import saddle_manifold as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.orbit import OrbitEvent
from rocking.model.quantity import PHASE
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, quantities
from rocking.model.validation import Refusal, TooManyEvents, instance, refuse_if, whole, within
from rocking.motion.march_loop import start_march
from rocking.orbits.parameter import with_value
from rocking.theory import saddle_orbit

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


# Largest distance of a state from the saddle orbit that it belongs to.
ON_IT = 1e-8


def check(system: System) -> None:
    """Raise ValueError for a system without saddle orbits on one side of Θ = 0, or with impacts that cannot be reversed."""
    instance("system", system, System)
    check_reversible(system)
    if response(system) >= 1.0:
        most = 1.0 + system.harmonic.frequency**2
        allowed = f"be below 1 + Ω² = {most:.6g}, where the saddle orbits touch Θ = 0"
        raise Refusal("amplitude", allowed, system.harmonic.amplitude)


def check_reversible(system: System) -> None:
    """Raise ValueError for a system with braces, or with impacts that cannot be reversed in time."""
    _ = system.harmonic  # refuses other base motions, and the full block
    if system.braces is not None:
        raise Refusal("system", "have no braces: impacts on them are not reversed in time", system.braces)
    refuse_if(
        system.restitution == 0.0, "restitution", "be positive, so that impacts can be reversed in time", 0.0
    )


def too_many_impacts(remedy: str) -> TooManyEvents:
    """Return the error for a motion with too many impacts; ``remedy`` is what should be reduced."""
    return TooManyEvents(
        f"more than {march.MAX_EVENTS:,} impacts before one point: the block chatters with little energy loss (reduce {remedy})"
    )


def response(system: System) -> float:
    """Return β = A/(1 + Ω²)."""
    return float(start_march(system, State())[0].forcing.response)


def saddle(system: System, phase: float, side: int) -> tuple[float, float]:
    """Return Θ and Θ' of the saddle orbit on one side at a forcing phase."""
    forcing = system.harmonic
    return saddle_orbit(phase, forcing.amplitude, forcing.period, "upper" if side > 0 else "lower")


def saddle_events(system: System, phase: float, state: State) -> tuple[OrbitEvent, ...]:
    """Return states of a saddle orbit at intervals of one unit of τ, as its events; none if `state` is not on it at `phase`."""
    side = 1 if state.angle > 0.0 else -1
    angle, velocity = saddle(system, phase, side)
    if math.hypot(state.angle - angle, state.velocity - velocity) > ON_IT:
        return ()
    events = []
    for turned in np.linspace(0.0, math.tau, math.ceil(system.harmonic.period) + 1)[:-1].tolist():
        angle, velocity = saddle(system, phase + turned, side)
        events.append(OrbitEvent(turned, angle, velocity, velocity))
    return tuple(events)


def parameters(system: System, phase: float, backward: bool) -> Any:
    """Return the parameters for the kernels, with time measured from a forcing phase; reversed in time if `backward`.

    In reversed time, Θ' and φ are negated and e is replaced by 1/e.
    """
    p = start_march(system, State())[0]
    phase = math.remainder(phase, math.tau)
    p = p._replace(forcing=p.forcing._replace(phase=-phase if backward else phase))
    if backward:
        p = p._replace(block=p.block._replace(restitution=1.0 / p.block.restitution))
    return p


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
    rocking.orbits.saddle_manifolds.manifold_gap : Gap between two manifolds.
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


SAMPLES = 128
# Number of bisections until neighbouring times coincide in double precision.
HALVINGS = 53
# Ends of the amplitude bracket, relative to √(1 + Ω²). The gap is negative at the first and positive at the second.
ENDS = (1e-9, 1.0 - 1e-9)


def manifold_gap(system: System) -> float:
    """Return the largest signed gap between two manifolds where they pass Θ = 0, grown to their first impact.

    Motions on the unstable manifold of one saddle orbit arrive at Θ = 0 with a speed that depends on the forcing phase. They
    continue with e times this speed. Motions on the stable manifold of the other saddle orbit leave Θ = 0 with another speed.
    Where the first speed is larger, motions from one saddle orbit overturn past the other.

    Parameters
    ----------
    system : System
        System as in `saddle_manifolds`, with A < √(1 + Ω²). Each manifold then passes Θ = 0 once at every phase.

    Returns
    -------
    float
        Largest difference of the speeds, in units of θcr α; negative if the manifolds do not intersect.

    Raises
    ------
    TypeError
        If `system` is not a System.
    ValueError
        If the system has braces, e = 0 or an amplitude of √(1 + Ω²) or more.

    See Also
    --------
    rocking.tangency_amplitude : Amplitude at which the gap is zero.
    rocking.theory.manifold_gap : The gap in closed form.

    Examples
    --------
    >>> import rocking as rk
    >>> [round(manifold_gap(rk.System(rk.Harmonic(amplitude=a, period=1.0), restitution=0.8)), 6) for a in (3.0, 4.0)]
    [-0.037302, 0.016931]
    """
    check(system)
    forcing = system.harmonic
    most = math.sqrt(1.0 + forcing.frequency**2)
    refuse_if(forcing.amplitude >= most, "amplitude", f"be below √(1 + Ω²) = {most:.6g}", forcing.amplitude)
    from scipy.optimize import minimize_scalar

    ways = _Passage.of(system, -1, backward=False), _Passage.of(system, 1, backward=True)

    def gap(psi: Any) -> NDArray[np.float64]:
        arriving, leaving = (way.speeds(np.atleast_1d(psi)) for way in ways)
        return system.restitution * arriving - leaving

    phases = np.linspace(0.0, math.tau, SAMPLES, endpoint=False)
    best, step = float(phases[np.argmax(gap(phases))]), float(phases[1])
    result = minimize_scalar(
        lambda psi: -gap(psi)[0], bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-9}
    )
    return float(gap(result.x)[0])


class _Passage(NamedTuple):
    """Passage of a manifold through Θ = 0; in reversed time, phases have the opposite sign."""

    p: Any
    side: int
    sign: float
    first: float

    @classmethod
    def of(cls, system: System, side: int, backward: bool) -> _Passage:
        p = parameters(system, 0.0, backward)
        return cls(p, side, -1.0 if backward else 1.0, float(_passages(p, side, np.zeros(1))[0, 0]))

    def speeds(self, phases: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return speeds at forcing phases, by bisection on the time near the saddle orbit: the passage is monotone in it."""
        target = self.first + np.mod(self.sign * phases - self.first, math.tau)
        low, high = np.zeros(len(phases)), np.full(len(phases), self.p.forcing.period)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            early = _passages(self.p, self.side, middle)[:, 0] < target
            low, high = np.where(early, middle, low), np.where(early, high, middle)
        return _passages(self.p, self.side, low)[:, 1]


def _passages(p: Any, side: int, waits: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return phase and speed at Θ = 0 of motions near the saddle orbit at the given times."""
    met = np.empty((len(waits), 2))
    kernel.first_impacts(p, side, waits, met)
    return met


def tangency_amplitude(system: System) -> float:
    """Compute the amplitude at which the manifolds of the two saddle orbits first touch: the zero of `manifold_gap`.

    Beyond this amplitude, up to √(1 + Ω²), the boundary between overturning and bounded motions is fractal if e > 0. `horseshoe`
    proves it, and checks larger amplitudes.
    `rocking.theory.heteroclinic_amplitude` is the same amplitude in closed form, and `rocking.theory.melnikov_amplitude` is
    Melnikov's approximation.

    Parameters
    ----------
    system : System
        System without braces, with e in (0, 1). Its period and coefficient of restitution are used, not its amplitude.

    Returns
    -------
    float
        Amplitude A*, to about 1e-9.

    Raises
    ------
    TypeError
        If `system` is not a System.
    ValueError
        If the system has braces, or if e is 0 or 1.

    See Also
    --------
    rocking.orbits.saddle_manifolds.manifold_gap : The gap that is zero there.
    rocking.theory.heteroclinic_amplitude : The amplitude in closed form.

    Examples
    --------
    >>> import rocking as rk
    >>> round(rk.tangency_amplitude(rk.System(rk.Harmonic(amplitude=1.0, period=1.0), restitution=0.8)), 8)
    3.68781307
    """
    check(with_value(instance("system", system, System), "amplitude", 0.0))
    if system.restitution == 1.0:
        raise Refusal(
            "restitution",
            "be below 1",
            1.0,
            "without dissipation the manifolds intersect for every A > 0",
        )
    from scipy.optimize import brentq

    most = math.sqrt(1.0 + system.harmonic.frequency**2)
    low, high = (most * end for end in ENDS)
    return float(
        brentq(lambda value: manifold_gap(with_value(system, "amplitude", value)), low, high, xtol=1e-12)
    )
