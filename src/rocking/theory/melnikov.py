"""Melnikov's method for the rocking block: Yim & Lin (1991), Eqs. (11)–(22), normalised.

Without forcing and dissipation, the block has the energy H = Θ'²/2 − Θ²/2 + |Θ|, Eq. (15). Two orbits of energy 1/2 connect its
unstable equilibria Θ = ±1: the heteroclinic pair, Eq. (17). Forcing and dissipation are added to first order along such an
orbit, Eqs. (13) and (18):

    M(τ₀) = ∫ Θ'(τ) [−A cos Ω(τ + τ₀) + F(Θ, Θ')] dτ,   F = −½ Θ'|Θ'| (1 − e²) δ(Θ).

F opposes the velocity and dissipates the energy of an impact: ∫ F dΘ = −½(1 − e²)Θ'².
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.kernels.orbits import manifold
from rocking.model.quantity import AMPLITUDE, PERIOD, RESTITUTION
from rocking.model.validation import finite, within
from rocking.theory.arguments import amplitudes, frequencies, plain, restitutions, side_of, sizes, together
from rocking.theory.free_rocking import heteroclinic_orbit


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
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

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
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

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
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

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
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

    See Also
    --------
    heteroclinic_amplitude : Amplitude at which the gap is zero.
    melnikov_function : The gap to first order.
    rocking.orbits.saddles.manifold_gap : The gap of computed manifolds.

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
    manifold.swings(*(np.ascontiguousarray(each, float).ravel() for each in forcing), swing.reshape(-1, 2))
    return swing[..., 0], swing[..., 1]


WIDTHS = (1e-12, 1.0)
MAX_TIME = 1e9


def damping(angle: Any, velocity: Any, restitution: Any, width: float) -> Any:
    """Damping F = −½ Θ'|Θ'| (1 − e²) δ(Θ), with the delta function spread over |Θ| < `width`: Eq. (13).

    The smoothed delta function is a triangle of area 1. F opposes the velocity. The paper's −½Θ'²(1 − e²) δ(Θ) would add energy
    on the lower orbit.

    Parameters
    ----------
    angle, velocity, restitution : float or array
        Θ, Θ' and coefficient of restitution e, in [0, 1]. The arguments broadcast.
    width : float
        Width of the smoothed delta function, in [1e-12, 1]. ∫ F dΘ across it tends to −½(1 − e²)Θ'² for small widths.

    Returns
    -------
    float or ndarray
        F.

    Raises
    ------
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

    See Also
    --------
    melnikov_integral : The integral with this damping.
    physical_damping : The damping in rad/s².

    Examples
    --------
    >>> round(damping(0.0, 1.0, 0.8, width=0.1), 9), damping(0.2, 1.0, 0.8, width=0.1)
    (-1.8, -0.0)
    """
    width = within("width", width, *WIDTHS)
    angle, velocity, restitution = together(
        angle=sizes("angle", angle),
        velocity=sizes("velocity", velocity),
        restitution=restitutions(restitution),
    )
    delta = np.maximum(0.0, 1.0 - np.abs(angle) / width) / width
    return plain(-impact_loss(np.abs(velocity), restitution) * np.sign(velocity) * delta)


def impact_loss(velocity: Any, restitution: Any) -> Any:
    """Energy ½(1 − e²)Θ'² dissipated by an impact with velocity Θ'.

    Parameters
    ----------
    velocity, restitution : float or array
        Θ' and coefficient of restitution e, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        Dissipated energy.

    Raises
    ------
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

    See Also
    --------
    energy : Energy of a state.

    Examples
    --------
    >>> round(impact_loss(1.0, 0.8), 12)
    0.18
    """
    velocity, e = together(velocity=sizes("velocity", velocity), restitution=restitutions(restitution))
    return plain(0.5 * (1.0 - e) * (1.0 + e) * velocity * velocity)


def melnikov_function(time: Any, amplitude: Any, period: Any, restitution: Any, orbit: str = "upper") -> Any:
    """Melnikov's function M⁺(τ₀) = −2A cos Ωτ₀/(1+Ω²) − (1−e²)/2, or M⁻(τ₀) = M⁺(τ₀ + T/2): Eqs. (18)–(20).

    Parameters
    ----------
    time : float or array
        Time τ₀: the forcing is A cos Ω(τ + τ₀), and the orbit passes Θ = 0 at τ = 0.
    amplitude, period, restitution : float or array
        A, in [0, 1000]; T, in [0.00628, 6283]; e, in [0, 1]. The arguments broadcast.
    orbit : str
        "upper" (M⁺) or "lower" (M⁻). Default: "upper".

    Returns
    -------
    float or ndarray
        Energy gained along the orbit, to first order in A and 1 − e. Where it has zeros, the manifolds intersect to this order.

    Raises
    ------
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

    See Also
    --------
    melnikov_integral : The same function by numerical integration.
    melnikov_amplitude : Lowest amplitude with zeros.
    manifold_gap : The exact gap.
    rocking.plot.melnikov : Plot both.

    Examples
    --------
    >>> import rocking as rk
    >>> threshold = rk.theory.melnikov_amplitude(1.0, 0.8)
    >>> abs(rk.theory.melnikov_function(0.5, threshold, 1.0, 0.8)) < 1e-15
    True
    """
    time, a, omega, e = together(
        time=sizes("time", time),
        amplitude=amplitudes(amplitude),
        period=frequencies(period),
        restitution=restitutions(restitution),
    )
    work = -2.0 * side_of(orbit) * a * np.cos(omega * time) / (1.0 + omega * omega)
    return plain(work - impact_loss(1.0, e))


def melnikov_integral(
    time: float,
    amplitude: float,
    period: float,
    restitution: float,
    orbit: str = "upper",
    width: float = 1e-6,
) -> float:
    """Melnikov's function by numerical integration along `heteroclinic_orbit`, a check of the closed form.

    Parameters
    ----------
    time : float
        Time τ₀, of magnitude up to 10⁹.
    amplitude, period, restitution : float
        A, T and e, as in `melnikov_function`.
    orbit : str
        "upper" or "lower". Default: "upper".
    width : float
        Width of the `damping`, in [1e-12, 1]. The velocity is lower on both sides of Θ = 0, so that the dissipation is too small
        by a relative error of about `width` at most. Default: 1e-6.

    Returns
    -------
    float
        M⁺(τ₀) or M⁻(τ₀).

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    melnikov_function : The closed form.
    heteroclinic_orbit : The path of the integral.
    damping : The damping term.

    Examples
    --------
    >>> closed = melnikov_function(0.3, 4.0, 1.0, 0.8)
    >>> abs(melnikov_integral(0.3, 4.0, 1.0, 0.8) - closed) < 1e-6
    True
    """
    from scipy.integrate import quad

    time = finite("time", time, MAX_TIME)
    amplitude = AMPLITUDE.checked(amplitude)
    omega = math.tau / PERIOD.checked(period)
    restitution, width = RESTITUTION.checked(restitution), within("width", width, *WIDTHS)

    def speed(tau: float) -> float:
        return heteroclinic_orbit(tau, orbit)[1]

    def loss(tau: float) -> float:
        angle, velocity = heteroclinic_orbit(tau, orbit)
        return velocity * damping(angle, velocity, restitution, width)

    # Fourier integrals over each half, on which the orbit is smooth: cos Ω(τ + τ₀) = cos Ωτ₀ cos Ωτ − sin Ωτ₀ sin Ωτ
    parts = {
        (weight, way): quad(lambda tau, way=way: speed(way * tau), 0.0, math.inf, weight=weight, wvar=omega)[
            0
        ]
        for weight in ("cos", "sin")
        for way in (1.0, -1.0)
    }
    even = parts["cos", 1.0] + parts["cos", -1.0]
    odd = parts["sin", 1.0] - parts["sin", -1.0]
    work = -amplitude * (math.cos(omega * time) * even - math.sin(omega * time) * odd)
    # foot of the triangle, at |Θ| = width
    foot = -math.log1p(-width) if width < 1.0 else math.inf
    return work + quad(loss, -foot, 0.0)[0] + quad(loss, 0.0, foot)[0]


def melnikov_amplitude(period: Any, restitution: Any) -> Any:
    """Amplitude A_M = (1 − e²)(1 + Ω²)/4, above which Melnikov's function has zeros: Eq. (22).

    The paper calls it a "lower bound for chaotic response". To first order in A and 1 − e, the manifolds of the saddle orbits
    intersect above A_M. It is not a bound for chaos: intersecting manifolds make the boundary of the safe basin fractal, and do
    not make bounded motions chaotic. The exact value, `heteroclinic_amplitude`, may be larger or smaller.

    Parameters
    ----------
    period, restitution : float or array
        Forcing period T, in [0.00628, 6283], and coefficient of restitution e, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        A_M.

    Raises
    ------
    TypeError, ValueError
        As in `heteroclinic_amplitude`.

    See Also
    --------
    heteroclinic_amplitude : The exact amplitude of tangency.
    melnikov_function : The function with the zeros.
    rocking.plot.thresholds : Plot amplitudes over the period.

    Examples
    --------
    >>> round(melnikov_amplitude(1.0, 0.8), 9)
    3.643057584
    """
    omega, e = together(period=frequencies(period), restitution=restitutions(restitution))
    return plain(0.5 * impact_loss(1.0, e) * (1.0 + omega * omega))
