"""Where the manifolds of the two saddle orbits first touch, from the manifolds as they are grown."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking.kernels.orbits import saddle_manifold as kernel
from rocking.model import System, refusal
from rocking.orbits.parameter import with_value
from rocking.orbits.saddle_orbits import check, parameters

SAMPLES = 128
# Until neighbouring times are one.
HALVINGS = 53
# On the interval of amplitudes at whose ends the gap is known to be negative and positive.
ENDS = (1e-9, 1.0 - 1e-9)


def manifold_gap(system: System) -> float:
    """Give the largest signed gap between two manifolds, grown up to their first impact, where they pass Θ = 0.

    The unstable manifold of one saddle orbit arrives at Θ = 0 with speeds that depend on the forcing phase, and goes on with e times
    these; the stable one of the other leaves it, backward in time, with others. Where the first are the larger ones, motions from the
    one saddle orbit overturn over the other.

    Parameters
    ----------
    system : System
        As in `saddle_manifolds`, and A < √(1 + Ω²), below which either manifold passes Θ = 0 once at every phase.

    Returns
    -------
    float
        The largest difference of the speeds, in units of θcr α: negative where the manifolds do not meet.

    Raises
    ------
    TypeError, ValueError
        In one line, for another system.

    See Also
    --------
    tangency_amplitude : Amplitude at which the gap is zero.
    rocking.theory.manifold_gap : The gap in closed form.

    Examples
    --------
    >>> import rocking as rk
    >>> [round(rk.manifold_gap(rk.System(rk.Harmonic(amplitude=a, period=1.0), restitution=0.8)), 6) for a in (3.0, 4.0)]
    [-0.037302, 0.016931]
    """
    check(system)
    forcing = system.forcing
    most = math.sqrt(1.0 + forcing.frequency**2)
    if forcing.amplitude >= most:
        raise ValueError(refusal("amplitude", f"be below √(1 + Ω²) = {most:.6g}", forcing.amplitude))
    from scipy.optimize import minimize_scalar

    ways = _Passage.of(system, -1, backward=False), _Passage.of(system, 1, backward=True)

    def gap(psi: Any) -> NDArray[np.float64]:
        arriving, leaving = (way.speeds(np.atleast_1d(psi)) for way in ways)
        return system.restitution * arriving - leaving

    phases = np.linspace(0.0, math.tau, SAMPLES, endpoint=False)
    best, step = float(phases[np.argmax(gap(phases))]), float(phases[1])
    found = minimize_scalar(
        lambda psi: -gap(psi)[0], bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-9}
    )
    return float(gap(found.x)[0])


class _Passage(NamedTuple):
    """How a manifold passes Θ = 0: of one that is followed backward in time all phases are negative."""

    p: Any
    side: int
    sign: float
    first: float

    @classmethod
    def of(cls, system: System, side: int, backward: bool) -> _Passage:
        p = parameters(system, 0.0, backward)
        return cls(p, side, -1.0 if backward else 1.0, float(_passages(p, side, np.zeros(1))[0, 0]))

    def speeds(self, phases: NDArray[np.float64]) -> NDArray[np.float64]:
        """Speeds at forcing phases, by bisection on when the motions were near the saddle orbit: the later, the later they pass."""
        target = self.first + np.mod(self.sign * phases - self.first, math.tau)
        low, high = np.zeros(len(phases)), np.full(len(phases), self.p.period)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            early = _passages(self.p, self.side, middle)[:, 0] < target
            low, high = np.where(early, middle, low), np.where(early, high, middle)
        return _passages(self.p, self.side, low)[:, 1]


def _passages(p: Any, side: int, waits: NDArray[np.float64]) -> NDArray[np.float64]:
    """(phase, speed) at Θ = 0 of motions near the saddle orbit at times."""
    met = np.empty((len(waits), 2))
    kernel.first_impacts(p, side, waits, met)
    return met


def tangency_amplitude(system: System) -> float:
    """Find the amplitude at which the manifolds of the two saddle orbits first touch, the zero of `manifold_gap`, bracketed.

    Beyond it the boundary between overturning and staying is fractal. `rocking.theory.heteroclinic_amplitude` has the same in closed
    form, and `rocking.theory.melnikov_amplitude` Melnikov's approximation to it.

    Parameters
    ----------
    system : System
        Its period and restitution count; without braces, e in (0, 1).

    Returns
    -------
    float
        A*, to about 1e-9.

    Raises
    ------
    TypeError, ValueError
        In one line, for another system.

    See Also
    --------
    manifold_gap : The gap that is zero there.
    rocking.theory.heteroclinic_amplitude : The amplitude in closed form.

    Examples
    --------
    >>> import rocking as rk
    >>> round(rk.tangency_amplitude(rk.System(rk.Harmonic(amplitude=1.0, period=1.0), restitution=0.8)), 8)
    3.68781307
    """
    check(with_value(system, "amplitude", 0.0))
    if system.restitution == 1.0:
        raise ValueError(
            refusal("restitution", "be below 1", 1.0, "without losses the manifolds meet for every A > 0")
        )
    from scipy.optimize import brentq

    most = math.sqrt(1.0 + system.forcing.frequency**2)
    low, high = (most * end for end in ENDS)
    return float(
        brentq(lambda value: manifold_gap(with_value(system, "amplitude", value)), low, high, xtol=1e-12)
    )
