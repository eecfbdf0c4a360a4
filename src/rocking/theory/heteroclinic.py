"""The exact tangency that Melnikov's method approximates: saddle orbits, their manifolds where they pass Θ = 0, and A*.

For A > 0 the unstable equilibria become the saddle orbits Θ = ±1 + β cos ψ, β = A/(1+Ω²). Motions that leave the lower one for
good, and those that reach the upper one, have closed forms up to Θ = 0 and from there, so that the distance of the manifolds is one too.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.kernels.orbits import saddle_manifold
from rocking.model import reals
from rocking.theory.arguments import amplitudes, frequencies, plain, restitutions, side_of


def heteroclinic_amplitude(period: Any, restitution: Any) -> Any:
    """A*, at which the unstable manifold of one saddle orbit first touches the stable one of the other: exact.

    Parameters
    ----------
    period, restitution : float or array
        T in [0.00628, 6283] and e in [0, 1]; they broadcast.

    Returns
    -------
    float or ndarray
        A* = (1+Ω²)(1−e)/√((1+e)² + Ω²(1−e)²): the limit of `existence_amplitude` for large n. Above it the boundary between
        overturning and staying is fractal.

    Raises
    ------
    TypeError, ValueError
        In one line, for an argument of another kind or outside its range.

    See Also
    --------
    melnikov_amplitude : The amplitude to first order.
    manifold_gap : The gap that is zero there.
    rocking.tangency_amplitude : The amplitude from computed manifolds.

    Notes
    -----
    `melnikov_amplitude` is its first order in 1 − e at given Ω: A_M/A* = ¼(1+e)²√(1 + Ω²((1−e)/(1+e))²), below 1 for slow
    forcing, above it for fast. It takes the saddle orbits to keep their side, which they do as β < 1; at A* always.

    Examples
    --------
    >>> round(heteroclinic_amplitude(1.0, 0.8), 9), round(heteroclinic_amplitude(2.0, 0.925), 9)
    (3.68781307, 0.42035398)
    """
    omega, e = frequencies(period), restitutions(restitution)
    lost = 1.0 - e
    return plain((1.0 + omega * omega) * lost / np.hypot(1.0 + e, omega * lost))


def saddle_orbit(phase: Any, amplitude: Any, period: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """The unstable periodic motion about a corner, Θ = ±1 + β cos ψ, that the block would have to be balanced on.

    Parameters
    ----------
    phase : float or array
        ψ of the forcing A cos ψ.
    amplitude, period : float or array
        A and T; all of them broadcast.
    orbit : str
        "upper", near Θ = 1, or "lower", near −1.

    Returns
    -------
    tuple
        (Θ, Θ'). It is a motion of the block while it keeps its side: for β < 1.

    Raises
    ------
    TypeError, ValueError
        In one line.

    See Also
    --------
    stable_manifold_velocity : Stable manifold at an impact.
    unstable_manifold_velocity : Unstable manifold at an impact.
    rocking.saddle_manifolds : The manifolds on a section.

    Examples
    --------
    >>> angle, velocity = saddle_orbit(0.0, 2.0, 1.0)
    >>> round(angle, 6), velocity
    (1.04941, 0.0)
    """
    angle, velocity = _swing(phase, amplitude, period)
    return plain(side_of(orbit) + angle), plain(velocity + 0.0)


def unstable_manifold_velocity(phase: Any, amplitude: Any, period: Any) -> Any:
    """V_u = 1 − β(cos ψ + Ω sin ψ): velocity before the impact of the motions that come from the lower saddle orbit; broadcasts.

    Parameters and errors as in `saddle_orbit`; ψ is the phase at the impact.

    See Also
    --------
    stable_manifold_velocity : The velocity on the stable manifold.
    manifold_gap : The gap between both.

    Examples
    --------
    >>> unstable_manifold_velocity(0.3, 0.0, 1.0)
    1.0
    """
    angle, velocity = _swing(phase, amplitude, period)
    return plain(1.0 - (angle - velocity))


def stable_manifold_velocity(phase: Any, amplitude: Any, period: Any) -> Any:
    """V_s = 1 + β(cos ψ − Ω sin ψ): velocity after the impact of the motions that go to the upper saddle orbit; broadcasts.

    A faster block overturns there; a slower one comes back. Parameters and errors as in `saddle_orbit`.

    See Also
    --------
    unstable_manifold_velocity : The velocity on the unstable manifold.
    manifold_gap : The gap between both.

    Examples
    --------
    >>> stable_manifold_velocity(0.3, 0.0, 1.0)
    1.0
    """
    angle, velocity = _swing(phase, amplitude, period)
    return plain(1.0 + (angle + velocity))


def manifold_gap(phase: Any, amplitude: Any, period: Any, restitution: Any) -> Any:
    """e V_u − V_s, signed: by how much the unstable manifold leaves the impact faster than the stable one; broadcasts.

    Negative at every ψ below A*, zero at one for A*. `melnikov_function` at τ₀ = ψ/Ω is its first order in A and 1 − e.

    Parameters
    ----------
    phase, amplitude, period : float or array
        ψ at the impact, A and T.
    restitution : float or array
        e in [0, 1].

    Raises
    ------
    TypeError, ValueError
        In one line.

    See Also
    --------
    heteroclinic_amplitude : Amplitude at which the gap is zero.
    melnikov_function : The gap to first order.
    rocking.manifold_gap : The gap of computed manifolds.

    Examples
    --------
    >>> import numpy as np
    >>> phases = np.linspace(0, 2 * np.pi, 1_000_001)
    >>> largest = manifold_gap(phases, heteroclinic_amplitude(1.0, 0.8), 1.0, 0.8).max()
    >>> bool(abs(largest) < 1e-11)
    True
    """
    angle, velocity = _swing(phase, amplitude, period)
    e = restitutions(restitution)
    lost = 1.0 - e
    return plain(-lost - ((1.0 + e) * angle + lost * velocity))


def _swing(phase: Any, amplitude: Any, period: Any) -> tuple[Any, Any]:
    """(β cos ψ, −βΩ sin ψ): how far a saddle orbit is from ±1, and its velocity."""
    omega = frequencies(period)
    forcing = np.broadcast_arrays(amplitudes(amplitude), omega, reals("phase", phase))
    swing = np.empty((*forcing[0].shape, 2))
    saddle_manifold.swings(
        *(np.ascontiguousarray(each, float).ravel() for each in forcing), swing.reshape(-1, 2)
    )
    return swing[..., 0], swing[..., 1]
