"""Exact heteroclinic tangency, which Melnikov's method approximates: saddle orbits, their manifolds at Θ = 0, and A*.

For A > 0 the unstable equilibria become the saddle orbits Θ = ±1 + β cos ψ, β = A/(1+Ω²). Motions from
the lower saddle orbit up to Θ = 0 are known in closed form. So are motions from Θ = 0 to the upper saddle orbit, and the
distance of the manifolds.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.kernels.orbits import saddle_manifold
from rocking.theory.arguments import amplitudes, frequencies, plain, restitutions, side_of, sizes, together


def heteroclinic_amplitude(period: Any, restitution: Any) -> Any:
    """Amplitude A*, at which the unstable manifold of one saddle orbit first touches the stable one of the other; exact.

    Parameters
    ----------
    period, restitution : float or array
        Forcing period T, in [0.00628, 6283], and coefficient of restitution e, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        A* = (1+Ω²)(1−e)/√((1+e)² + Ω²(1−e)²), the limit of `existence_amplitude` for large n. For e > 0 and
        A* < A < √(1+Ω²) the boundary between overturning and bounded motions is fractal; beyond, `horseshoe` checks it.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    melnikov_amplitude : The amplitude to first order.
    manifold_gap : The gap that is zero there.
    rocking.tangency_amplitude : The amplitude from computed manifolds.

    Notes
    -----
    `melnikov_amplitude` is its first order in 1 − e at given Ω: A_M/A* = ¼(1+e)²√(1 + Ω²((1−e)/(1+e))²). This ratio is below 1
    for slow forcing and above 1 for fast forcing. The saddle orbits must not pass through Θ = 0, that is, β < 1; this always
    holds at A*.

    Examples
    --------
    >>> round(heteroclinic_amplitude(1.0, 0.8), 9), round(heteroclinic_amplitude(2.0, 0.925), 9)
    (3.68781307, 0.42035398)
    """
    omega, e = together(period=frequencies(period), restitution=restitutions(restitution))
    lost = 1.0 - e
    return plain((1.0 + omega * omega) * lost / np.hypot(1.0 + e, omega * lost))


def saddle_orbit(phase: Any, amplitude: Any, period: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """Unstable periodic motion near balance on a corner, Θ = ±1 + β cos ψ.

    Parameters
    ----------
    phase : float or array
        Phase ψ of the forcing A cos ψ, rad.
    amplitude, period : float or array
        Amplitude A, in [0, 1000], and forcing period T, in [0.00628, 6283]. The arguments broadcast.
    orbit : str
        "upper", near Θ = 1, or "lower", near Θ = −1. Default: "upper".

    Returns
    -------
    angle, velocity : float or ndarray
        Θ and Θ'. They are a motion of the block if β < 1, so that Θ does not change its sign.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

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
    """Velocity V_u = 1 − β(cos ψ + Ω sin ψ) just before the impact of motions from the lower saddle orbit.

    Parameters
    ----------
    phase, amplitude, period : float or array
        Forcing phase ψ at the impact, rad; A and T as in `saddle_orbit`. The arguments broadcast.

    Returns
    -------
    float or ndarray
        V_u.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

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
    """Velocity V_s = 1 + β(cos ψ − Ω sin ψ) just after the impact of motions that converge to the upper saddle orbit.

    A faster block overturns, and a slower one returns to Θ = 0.

    Parameters
    ----------
    phase, amplitude, period : float or array
        Forcing phase ψ at the impact, rad; A and T as in `saddle_orbit`. The arguments broadcast.

    Returns
    -------
    float or ndarray
        V_s.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

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
    """Signed gap e V_u − V_s between the velocities of the unstable and the stable manifold just after an impact.

    It is negative at every ψ for A < A*, and its maximum over ψ is 0 at A*. `melnikov_function` at τ₀ = ψ/Ω is its first order
    in A and 1 − e.

    Parameters
    ----------
    phase, amplitude, period : float or array
        Forcing phase ψ at the impact, rad; A and T as in `saddle_orbit`.
    restitution : float or array
        Coefficient of restitution e, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        e V_u − V_s.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

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
    angle, velocity, e = together(phase=angle, amplitude=velocity, restitution=restitutions(restitution))
    lost = 1.0 - e
    return plain(-lost - ((1.0 + e) * angle + lost * velocity))


def _swing(phase: Any, amplitude: Any, period: Any) -> tuple[Any, Any]:
    """Return β cos ψ and −βΩ sin ψ: the deviation of a saddle orbit from ±1, and its velocity."""
    forcing = np.broadcast_arrays(
        *together(amplitude=amplitudes(amplitude), period=frequencies(period), phase=sizes("phase", phase))
    )
    swing = np.empty((*forcing[0].shape, 2))
    saddle_manifold.swings(
        *(np.ascontiguousarray(each, float).ravel() for each in forcing), swing.reshape(-1, 2)
    )
    return swing[..., 0], swing[..., 1]
