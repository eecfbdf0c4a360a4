"""Free rocking, A = 0, in closed form (Housner 1963), and the block without dissipation: energy and heteroclinic orbits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model.quantity import RESTITUTION
from rocking.model.validation import reals, within
from rocking.theory.arguments import between, plain, restitutions, side_of, sizes, together

CRITICAL_ENERGY = 0.5


def energy(angle: Any, velocity: Any) -> Any:
    """Energy H = Θ'²/2 − Θ²/2 + |Θ|, constant without forcing and dissipation: Eq. (15).

    The critical value is 1/2. A state with less energy remains bounded if and only if |Θ| < 1: a block released at Θ = 1.5 has
    the energy 3/8 and overturns.

    Parameters
    ----------
    angle, velocity : float or array
        Θ and Θ'. The arguments broadcast.

    Returns
    -------
    float or ndarray
        H.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If a size exceeds 1e100, or if the shapes do not broadcast.

    See Also
    --------
    impact_loss : Energy lost at an impact.
    physical_energy : The energy in rad²/s².

    Examples
    --------
    >>> energy(0.0, 1.0), energy(1.5, 0.0)
    (0.5, 0.375)
    """
    angle, velocity = together(angle=sizes("angle", angle), velocity=sizes("velocity", velocity))
    return plain(0.5 * velocity * velocity + np.abs(angle) * (1.0 - 0.5 * np.abs(angle)))


def heteroclinic_orbit(time: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """Heteroclinic orbit between Θ = −1 and Θ = 1 of the free, undamped block: Eq. (17).

    Parameters
    ----------
    time : float or array
        Time τ, 0 at Θ = 0.
    orbit : str
        "upper", from −1 to 1, or "lower", from 1 to −1. Default: "upper".

    Returns
    -------
    angle, velocity : float or ndarray
        Θ = ±(1 − e^−|τ|), with the sign of τ, and Θ' = e^−|τ|, in the shape of `time`. The lower orbit has the opposite signs.

    Raises
    ------
    TypeError
        If `time` is not a real number or an array of real numbers.
    ValueError
        If `orbit` is neither "upper" nor "lower".

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


# Arguments below this are summed by the power series.
SMALL = 1e-3


def free_impact_speed(angle: Any) -> Any:
    """Speed √(1 − (1 − Θ₀)²) of the first impact of a block released at Θ₀.

    Parameters
    ----------
    angle : float or array
        Initial angle Θ₀, in [0, 1]. Beyond 1 the block overturns.

    Returns
    -------
    float or ndarray
        Speed |Θ'|, in the shape of `angle`.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    free_quarter_period : Time of the first impact.
    free_peaks : Angles of the turns after impacts.

    Examples
    --------
    >>> free_impact_speed([0.0, 0.4, 1.0]).tolist()
    [0.0, 0.8, 1.0]
    """
    angle = between("angle", angle, 0.0, 1.0)
    return plain(np.sqrt(angle * (2.0 - angle)))


def free_quarter_period(angle: Any) -> Any:
    """Time arccosh(1/(1 − Θ₀)) to the first impact of a block released at Θ₀.

    It is computed as artanh of the impact speed, which is accurate at small angles.

    Parameters
    ----------
    angle : float or array
        Initial angle Θ₀, in [0, 1].

    Returns
    -------
    float or ndarray
        Time τ, in the shape of `angle`; infinite at Θ₀ = 1, where the block balances on its corner.

    Raises
    ------
    TypeError, ValueError
        As in `free_impact_speed`.

    See Also
    --------
    free_time_to_rest : Total time until rest.
    free_impact_speed : Speed at the first impact.

    Examples
    --------
    >>> round(free_quarter_period(0.5), 12) == round(math.acosh(2.0), 12)
    True
    """
    speed = np.asarray(free_impact_speed(angle))
    left = 1.0 - np.asarray(angle, float)
    with np.errstate(divide="ignore"):
        # ½ ln((1 + v)/(1 − v)) with (1 − v)(1 + v) = (1 − Θ₀)²
        return plain(np.where(speed < 0.5, np.arctanh(np.minimum(speed, 0.5)), np.log((1.0 + speed) / left)))


def free_peaks(angle: Any, restitution: Any, impacts: Any) -> Any:
    """Peak |Θ_k| after k impacts of a block released at Θ₀: 1 − (1 − Θ_k)² = e^2k (1 − (1 − Θ₀)²).

    Parameters
    ----------
    angle, restitution : float or array
        Initial angle Θ₀ and coefficient of restitution e, both in [0, 1].
    impacts : int or array
        Number of impacts k, in [0, 10⁹]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        |Θ_k|.

    Raises
    ------
    TypeError, ValueError
        As in `free_impact_speed`.

    See Also
    --------
    free_time_to_rest : Total time until rest.
    free_impact_speed : Speed at the first impact.

    Examples
    --------
    >>> free_peaks(0.4, 0.75, [0, 1]).round(12).tolist()
    [0.4, 0.2]
    """
    speed = np.asarray(free_impact_speed(angle))
    speed, e, count = together(
        angle=speed, restitution=restitutions(restitution), impacts=between("impacts", impacts, 0, 1e9)
    )
    energy = (speed * e**count) ** 2
    return plain(energy / (1.0 + np.sqrt(1.0 - energy)))


def free_time_to_rest(angle: float, restitution: float) -> float:
    """Time to rest of a block released at Θ₀, at the end of infinitely many impacts; finite for e < 1.

    Parameters
    ----------
    angle : float
        Initial angle Θ₀, in [0, 1].
    restitution : float
        Coefficient of restitution e, in [0, 1 − 1e-6] or 1. The cost grows like 1/(1 − e).

    Returns
    -------
    float
        Time τ = q₀ + 2(q₁ + q₂ + …), with the quarter periods q_k = artanh(e^k v). Infinite at e = 1 (unless Θ₀ = 0) and at
        Θ₀ = 1.

    Raises
    ------
    TypeError
        If an argument is not a real number.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    free_peaks : Angles of the turns after impacts.
    free_quarter_period : Time of the first impact.

    Examples
    --------
    >>> round(free_time_to_rest(0.5, 0.8), 6)
    8.837445
    """
    angle = within("angle", angle, 0.0, 1.0)
    e = RESTITUTION.checked(restitution)
    if e < 1.0:
        within("restitution", e, 0.0, 1.0 - 1e-6)
    if angle == 0.0:
        return 0.0
    if e == 1.0 or angle == 1.0:
        return math.inf
    first = float(free_quarter_period(angle))
    speed = float(free_impact_speed(angle))
    if e == 0.0:
        return first
    terms = max(math.ceil(math.log(SMALL / speed) / math.log(e)), 0)
    flights = 2.0 * float(np.sum(np.arctanh(speed * e ** np.arange(1, terms + 1))))
    # artanh x = x + x³/3 + x⁵/5 + …, each a geometric series over the remaining impacts
    rest = speed * e ** (terms + 1)
    tail = sum(rest**k / (k * -math.expm1(k * math.log(e))) for k in (1, 3, 5))
    return first + flights + 2.0 * tail
