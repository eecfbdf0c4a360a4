"""The block without forcing and dissipation: its energy and its heteroclinic orbits, Yim & Lin (1991), Eqs. (15)–(17)."""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.model import reals
from rocking.theory.arguments import plain, side_of, sizes, together

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
