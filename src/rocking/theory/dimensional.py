"""The paper's own variables: eqs (12)-(16) of Yim & Lin (1991) for a block in radians and seconds.

Angles θ = Θ θcr, times t = τ/α, velocities θ' = Θ' α θcr. What follows from the normalised forms is stated here in the paper's
quantities and computed by them. Forces and energies are per moment of inertia Io: rad/s².
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.model import Block, instance, reals
from rocking.theory.arguments import plain
from rocking.theory.melnikov import CRITICAL_ENERGY, damping, energy, heteroclinic_orbit


def physical_acceleration(block: Block, radians: Any, base_acceleration: Any) -> Any:
    """θ'' between impacts: −(MgR/Io)(±θcr − θ) − (MR/Io) a_g, eqs (1) and (12); broadcasts.

    Parameters
    ----------
    block : Block
        Gives MgR/Io = α² and θcr.
    radians : float or array
        θ in rad; its sign is the corner's.
    base_acceleration : float or array
        a_g in m/s².

    Returns
    -------
    float or ndarray
        rad/s².

    Raises
    ------
    TypeError
        For arguments of another kind.

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
    angle = np.asarray(instance("block", block, Block).angle(radians=radians))
    amplitude = block.amplitude(reals("base_acceleration", base_acceleration))
    normalised = angle - np.sign(angle) - np.asarray(amplitude)
    return plain(_per_inertia(block) * normalised)


def physical_damping(block: Block, radians: Any, radians_per_second: Any, width: float) -> Any:
    """F/Io of eq. (13), −½ θ'|θ'| (1 − e²) δ(θ/θcr)/θcr, the delta function spread over |θ/θcr| < `width`; in rad/s², broadcasts.

    The restitution is the block's. Along an orbit through θ = 0 its integral over θ is the energy an impact takes away, −½(1 − e²)θ'².

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
    angle = instance("block", block, Block).angle(radians=radians)
    force = damping(angle, block.velocity(radians_per_second), block.restitution, width)
    return _per_inertia(block) * force


def physical_energy(block: Block, radians: Any, radians_per_second: Any) -> Any:
    """H/Io of eq. (15), θ'²/2 − (MgR/2Io) θ² + (MgR/Io) θcr |θ|, in rad²/s²; broadcasts.

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
    angle = instance("block", block, Block).angle(radians=radians)
    return _per_inertia(block) * block.critical_angle * energy(angle, block.velocity(radians_per_second))


def physical_critical_energy(block: Block) -> float:
    """MgRθcr²/2Io, in rad²/s²: with more a block is not held back by its weight, with less it is, if |θ| < θcr.

    See Also
    --------
    physical_energy : Energy of a state.

    Examples
    --------
    >>> import rocking as rk
    >>> round(rk.theory.physical_critical_energy(rk.Block(2.0, 0.5)), 4)
    0.2141
    """
    return CRITICAL_ENERGY * _per_inertia(instance("block", block, Block)) * block.critical_angle


def physical_heteroclinic_orbit(block: Block, seconds: Any, orbit: str = "upper") -> tuple[Any, Any]:
    """θ in rad and θ' in rad/s on the orbit between −θcr and θcr: eq. (16).

    For t ≥ 0 (θcr − e^−p, α e^−p) with p = αt − ln θcr; for t ≤ 0 (e^p − θcr, α e^p) with p = αt + ln θcr; the lower one negated.

    Parameters
    ----------
    block : Block
        Gives α and θcr.
    seconds : float or array
        t, 0 at θ = 0.
    orbit : str
        "upper" or "lower".

    Raises
    ------
    TypeError, ValueError
        In one line.

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
    angle, velocity = heteroclinic_orbit(instance("block", block, Block).time(seconds), orbit)
    return block.radians(angle), block.radians_per_second(velocity)


def _per_inertia(block: Block) -> float:
    """(MgR/Io) θcr: what a normalised acceleration of 1 is in rad/s²."""
    return block.frequency_parameter**2 * block.critical_angle
