"""Saddle orbits Θ = ±1 + β cos ψ of a slender block without braces, and the amplitude at which their manifolds first touch."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking.kernels.orbits import manifold as kernel
from rocking.model.orbit import OrbitEvent
from rocking.model.system import State, System
from rocking.model.validation import Refusal, instance, refuse_if
from rocking.motion.march_loop import start_march
from rocking.orbits.parameter import with_value
from rocking.theory import saddle_orbit

if TYPE_CHECKING:
    pass

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
    rocking.orbits.saddles.manifold_gap : The gap that is zero there.
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
