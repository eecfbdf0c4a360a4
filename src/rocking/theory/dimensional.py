"""Equations (12)–(16) of Yim & Lin (1991) in the variables of the paper, for a block in radians and seconds.

Angles are θ = Θ θcr, times t = τ/α and velocities θ' = Θ' α θcr. The functions take quantities of the paper and evaluate the
normalised forms. Forces and energies are per moment of inertia Io.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.model.block import Block, symmetric_block
from rocking.model.validation import reals
from rocking.theory.arguments import plain, sizes, together
from rocking.theory.free_rocking import CRITICAL_ENERGY, energy, heteroclinic_orbit
from rocking.theory.melnikov import damping


def physical_acceleration(block: Block, radians: Any, base_acceleration: Any) -> Any:
    """Angular acceleration θ'' between impacts, −(MgR/Io)(±θcr − θ) − (MR/Io) a_g: Eqs. (1) and (12).

    Parameters
    ----------
    block : Block
        Block, for MgR/Io = α² and θcr.
    radians : float or array
        Angle θ in radians; its sign determines the corner.
    base_acceleration : float or array
        Base acceleration a_g in m/s². The arguments broadcast.

    Returns
    -------
    float or ndarray
        θ'' in rad/s².

    Raises
    ------
    TypeError
        If `block` is not a Block, or another argument is not a real number or an array of real numbers.
    ValueError
        If a size exceeds about 1e100, or if the shapes do not broadcast.

    See Also
    --------
    rocking.simulate : The motion of a block.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(2.0, 0.5)
    >>> round(rk.theory.physical_acceleration(block, 0.1, 0.0), 4)
    -1.0345
    """
    symmetric_block(block)
    radians, base = together(
        radians=sizes("radians", radians), base_acceleration=sizes("base_acceleration", base_acceleration)
    )
    angle = np.asarray(block.angle(radians=radians))
    return plain(_per_inertia(block) * (angle - np.sign(angle) - np.asarray(block.amplitude(base))))


def physical_damping(block: Block, radians: Any, radians_per_second: Any, width: float) -> Any:
    """Damping F/Io, −½ θ'|θ'| (1 − e²) δ(θ/θcr)/θcr, with the delta function spread over |θ/θcr| < `width`: Eq. (13).

    Along an orbit through θ = 0, its integral over θ is the energy dissipated by an impact, −½(1 − e²)θ'².

    Parameters
    ----------
    block : Block
        Block, with its coefficient of restitution e.
    radians : float or array
        Angle θ in radians.
    radians_per_second : float or array
        Angular velocity θ' in rad/s. The arguments broadcast.
    width : float
        Width of the smoothed delta function, in [1e-12, 1].

    Returns
    -------
    float or ndarray
        F/Io in rad/s².

    Raises
    ------
    TypeError
        If `block` is not a Block, or another argument is not a real number or an array of real numbers.
    ValueError
        If `width` lies outside its range.

    See Also
    --------
    damping : The normalised damping.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(2.0, 0.5)
    >>> rk.theory.physical_damping(block, 0.0, 0.3, width=1e-3) < 0
    True
    """
    angle, velocity = _state(block, radians, radians_per_second)
    return _per_inertia(block) * damping(angle, velocity, block.restitution, width)


def physical_energy(block: Block, radians: Any, radians_per_second: Any) -> Any:
    """Energy H/Io, θ'²/2 − (MgR/2Io) θ² + (MgR/Io) θcr |θ|: Eq. (15).

    Parameters
    ----------
    block : Block
        Block, for MgR/Io and θcr.
    radians : float or array
        Angle θ in radians.
    radians_per_second : float or array
        Angular velocity θ' in rad/s. The arguments broadcast.

    Returns
    -------
    float or ndarray
        H/Io in rad²/s².

    Raises
    ------
    TypeError
        If `block` is not a Block, or another argument is not a real number or an array of real numbers.
    ValueError
        If a size exceeds about 1e100, or if the shapes do not broadcast.

    See Also
    --------
    energy : The normalised energy.
    physical_critical_energy : Energy at the critical angle.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(2.0, 0.5)
    >>> at_rest = rk.theory.physical_energy(block, block.critical_angle, 0.0)
    >>> round(at_rest / rk.theory.physical_critical_energy(block), 12)
    1.0
    """
    state = _state(block, radians, radians_per_second)
    return _per_inertia(block) * block.critical_angle * energy(*state)


def physical_critical_energy(block: Block) -> float:
    """Critical energy MgRθcr²/2Io, in rad²/s².

    If |θ| < θcr, an unforced block with less energy remains bounded, and one with more overturns.

    Parameters
    ----------
    block : Block
        Block.

    Returns
    -------
    float
        Critical energy per Io, in rad²/s².

    Raises
    ------
    TypeError
        If `block` is not a Block.

    See Also
    --------
    physical_energy : Energy of a state.

    Examples
    --------
    >>> import rocking as rk
    >>> round(rk.theory.physical_critical_energy(rk.Block(2.0, 0.5)), 4)
    0.2141
    """
    return CRITICAL_ENERGY * _per_inertia(symmetric_block(block)) * block.critical_angle


def physical_heteroclinic_orbit(block: Block, seconds: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """Heteroclinic orbit between −θcr and θcr: θ in rad and θ' in rad/s, Eq. (16).

    For t ≥ 0 it is (θcr − e^−p, α e^−p) with p = αt − ln θcr. For t ≤ 0 it is (e^p − θcr, α e^p) with p = αt + ln θcr. The lower
    orbit has the opposite signs.

    Parameters
    ----------
    block : Block
        Block, for α and θcr.
    seconds : float or array
        Time t in seconds, 0 at θ = 0.
    orbit : str
        "upper" or "lower". Default: "upper".

    Returns
    -------
    radians, radians_per_second : float or ndarray
        θ and θ' in the shape of `seconds`.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If `orbit` is neither "upper" nor "lower".

    See Also
    --------
    heteroclinic_orbit : The normalised orbit.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(2.0, 0.5)
    >>> angle, velocity = rk.theory.physical_heteroclinic_orbit(block, 0.0)
    >>> angle, velocity == block.frequency_parameter * block.critical_angle
    (0.0, True)
    """
    reals("seconds", seconds)
    angle, velocity = heteroclinic_orbit(symmetric_block(block).time(seconds), orbit)
    return block.radians(angle), block.radians_per_second(velocity)


def _state(block: Block, radians: Any, radians_per_second: Any) -> tuple[Any, Any]:
    """Return Θ and Θ' of states in radians and rad/s, after checking them."""
    symmetric_block(block)
    angle, velocity = together(
        radians=sizes("radians", radians), radians_per_second=sizes("radians_per_second", radians_per_second)
    )
    return block.angle(radians=angle), block.velocity(velocity)


def _per_inertia(block: Block) -> float:
    """Return (MgR/Io) θcr, the unit of normalised acceleration in rad/s²."""
    return block.frequency_parameter**2 * block.critical_angle
