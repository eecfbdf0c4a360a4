"""Melnikov's method for the rocking block, eqs (11)-(22) of Yim & Lin (1991), with every quantity normalised.

Without forcing and losses the block has the energy H = Θ'²/2 − Θ²/2 + |Θ| (15) and two orbits of energy 1/2 that connect its
unstable equilibria Θ = ±1: the heteroclinic pair (17). Forcing and losses are added to first order: along such an orbit

    M(τ₀) = ∫ Θ'(τ) [−A cos Ω(τ + τ₀) + F(Θ, Θ')] dτ,   F = −½ Θ'|Θ'| (1 − e²) δ(Θ)   (13), (18),

where F, which opposes the velocity, takes away just what an impact does: ∫ F dΘ = −½(1 − e²)Θ'².
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.integrate import quad

from rocking.model import MAX_AMPLITUDE, PERIODS, finite, reals, within
from rocking.theory.arguments import (
    amplitudes,
    between,
    frequencies,
    plain,
    restitutions,
    side_of,
)

CRITICAL_ENERGY = 0.5
WIDTHS = (1e-12, 1.0)
MAX_TIME = 1e9


def energy(angle: Any, velocity: Any) -> Any:
    """H = Θ'²/2 − Θ²/2 + |Θ| of states, constant without forcing and losses: eq. (15); broadcasts.

    The critical value is 1/2. A state with less stays bounded if |Θ| < 1, and only then: at rest at Θ = 1.5 it has 3/8 and falls.

    See Also
    --------
    impact_loss : Energy lost at an impact.
    physical_energy : The energy in rad²/s².

    Examples
    --------
    >>> energy(0.0, 1.0), energy(1.5, 0.0)
    (0.5, 0.375)
    """
    angle, velocity = np.asarray(reals("angle", angle)), np.asarray(reals("velocity", velocity))
    return plain(0.5 * velocity * velocity + np.abs(angle) * (1.0 - 0.5 * np.abs(angle)))


def heteroclinic_orbit(time: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """The orbit between Θ = −1 and Θ = 1 of the free, undamped block: eq. (17).

    Parameters
    ----------
    time : float or array
        τ, 0 at Θ = 0.
    orbit : str
        "upper", from −1 to 1, or "lower", back.

    Returns
    -------
    tuple
        (Θ, Θ') in the shape of `time`: ±(1 − e^−|τ|) on the side of the sign of τ, and e^−|τ|; both negated on the lower one.

    Raises
    ------
    TypeError, ValueError
        In one line.

    See Also
    --------
    physical_heteroclinic_orbit : The orbit in rad and rad/s.
    rocking.plot.heteroclinic : Plot the orbit.

    Examples
    --------
    >>> angle, velocity = heteroclinic_orbit([-1.0, 0.0, 1.0])
    >>> angle.round(3).tolist(), velocity.round(3).tolist()
    ([-0.632, 0.0, 0.632], [0.368, 1.0, 0.368])
    """
    side, time = side_of(orbit), np.asarray(reals("time", time))
    gone = np.abs(time)
    return plain(-side * np.sign(time) * np.expm1(-gone) + 0.0), plain(side * np.exp(-gone))


def damping(angle: Any, velocity: Any, restitution: Any, width: float) -> Any:
    """F of eq. (13), −½ Θ'|Θ'| (1 − e²) δ(Θ), with the delta function spread over |Θ| < `width`; broadcasts.

    The delta function is a triangle of area 1. It opposes the velocity; the paper's −½Θ'²(1 − e²) δ(Θ) would feed the lower orbit.

    Parameters
    ----------
    angle, velocity, restitution : float or array
        Θ, Θ' and e in [0, 1].
    width : float
        In [1e-12, 1]; ∫ F dΘ across it tends to −½(1 − e²)Θ'² as it goes to 0.

    Raises
    ------
    TypeError, ValueError
        In one line.

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
    angle, velocity = np.asarray(reals("angle", angle)), np.asarray(reals("velocity", velocity))
    delta = np.maximum(0.0, 1.0 - np.abs(angle) / width) / width
    return plain(-impact_loss(np.abs(velocity), restitution) * np.sign(velocity) * delta)


def impact_loss(velocity: Any, restitution: Any) -> Any:
    """Energy ½(1 − e²)Θ'² that an impact with velocity Θ' takes away, e in [0, 1]; broadcasts.

    See Also
    --------
    energy : Energy of a state.

    Examples
    --------
    >>> round(impact_loss(1.0, 0.8), 12)
    0.18
    """
    velocity, e = np.asarray(reals("velocity", velocity)), restitutions(restitution)
    return plain(0.5 * (1.0 - e) * (1.0 + e) * velocity * velocity)


def melnikov_function(time: Any, amplitude: Any, period: Any, restitution: Any, orbit: str = "upper") -> Any:
    """M⁺(τ₀) = −2A cos Ωτ₀/(1+Ω²) − (1−e²)/2, or on the lower orbit M⁻(τ₀) = M⁺(τ₀ + T/2): eqs (18)-(20).

    Parameters
    ----------
    time : float or array
        τ₀: the forcing is A cos Ω(τ + τ₀), and the orbit passes Θ = 0 at τ = 0.
    amplitude, period, restitution : float or array
        A, T and e in [0, 1]; all of them broadcast.
    orbit : str
        "upper" (M⁺) or "lower" (M⁻).

    Returns
    -------
    float or ndarray
        The energy gained along the orbit, to first order in A and 1 − e. Zeros: the manifolds cross, to that order.

    Raises
    ------
    TypeError, ValueError
        In one line.

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
    side, time = side_of(orbit), np.asarray(reals("time", time))
    omega, a = frequencies(period), amplitudes(amplitude)
    work = -2.0 * side * a * np.cos(omega * time) / (1.0 + omega * omega)
    return plain(work - impact_loss(1.0, restitution))


def melnikov_integral(
    time: float,
    amplitude: float,
    period: float,
    restitution: float,
    orbit: str = "upper",
    width: float = 1e-6,
) -> float:
    """The same by numerical integration along `heteroclinic_orbit`, the `damping` spread over a `width`: the test of the closed form.

    Parameters
    ----------
    time, amplitude, period, restitution, orbit
        As in `melnikov_function`, numbers only, `time` of size up to 10⁹.
    width : float
        In [1e-12, 1]. The loss is too small by a share of at most about this, since the orbit slows down on either side of Θ = 0.

    Raises
    ------
    TypeError, ValueError
        In one line.

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
    time = finite("time", time, MAX_TIME)
    amplitude = within("amplitude", amplitude, 0.0, MAX_AMPLITUDE)
    omega = math.tau / within("period", period, *PERIODS)
    restitution, width = within("restitution", restitution, 0.0, 1.0), within("width", width, *WIDTHS)

    def speed(tau: float) -> float:
        return heteroclinic_orbit(tau, orbit)[1]

    def loss(tau: float) -> float:
        angle, velocity = heteroclinic_orbit(tau, orbit)
        return velocity * damping(angle, velocity, restitution, width)

    # Fourier integrals over either half, where the orbit is smooth: cos Ω(τ + τ₀) = cos Ωτ₀ cos Ωτ − sin Ωτ₀ sin Ωτ
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
    # the triangle's foot, at |Θ| = width
    foot = -math.log1p(-width) if width < 1.0 else math.inf
    return work + quad(loss, -foot, 0.0)[0] + quad(loss, 0.0, foot)[0]


def melnikov_amplitude(period: Any, restitution: Any) -> Any:
    """A_M = (1 − e²)(1 + Ω²)/4, from which on Melnikov's function has zeros: eq. (22), the paper's "lower bound for chaotic response".

    To first order in A and 1 − e the manifolds of the saddle orbits cross from here on. That is no bound on chaos: `heteroclinic_amplitude`
    is the exact value, above it or below, and crossing manifolds make the boundary of the safe basin fractal, not a motion chaotic.

    Parameters
    ----------
    period, restitution : float or array
        T in [0.00628, 6283] and e in [0, 1]; they broadcast.

    Raises
    ------
    TypeError, ValueError
        In one line.

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
    omega = frequencies(period)
    return plain(
        0.5 * impact_loss(1.0, between("restitution", restitution, 0.0, 1.0)) * (1.0 + omega * omega)
    )
