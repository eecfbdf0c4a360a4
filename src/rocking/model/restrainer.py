"""Vertical elastic restrainer of a block, on its centre line, and the units of a restrained block."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from attrs import field, frozen

from rocking.model.validation import instance, within

LARGEST = 1e15
MASSES = (1e-6, 1e12)
"""Range of the mass of a block, kg."""
STIFFEST = 1e3
"""Largest ratio κ of the stiffness of a restrainer to that of gravity."""


def _stiffness(value: float) -> float:
    return within("stiffness", value, 0.0, LARGEST, unit="N/m")


def _prestress(value: float) -> float:
    return within("prestress", value, 0.0, LARGEST, unit="N")


def _mass(value: float) -> float:
    return within("mass", value, *MASSES, unit="kg")


@frozen
class Restrainer:
    """Vertical elastic restrainer from the middle of the base of a block to the ground, which `Block.restrained` gives a block.

    Parameters
    ----------
    stiffness : float
        Stiffness EA/L in N/m, in [0, 1e15].
    prestress : float
        Force P₀ in N in the block at rest, in [0, 1e15].
    mass : float
        Mass M of the block in kg, in [1e-6, 1e12].

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range.

    Examples
    --------
    >>> Restrainer(stiffness=2e4, prestress=500.0, mass=600.0)
    Restrainer(stiffness=20000.0, prestress=500.0, mass=600.0)
    """

    stiffness: float = field(converter=_stiffness)
    prestress: float = field(converter=_prestress)
    mass: float = field(converter=_mass)


def checked_restrainer(value: Any) -> Restrainer | None:
    """Return a restrainer, after checking its type."""
    return None if value is None else instance("restrainer", value, Restrainer)


class RestrainedUnits(NamedTuple):
    """Units of a restrained block of small angles over those of the free one."""

    angle: float
    rate: float
    acceleration: float


def restrained_units(stiffness_ratio: float, prestress_ratio: float) -> RestrainedUnits:
    """Return the units of small angles for the ratios κ and ρ of a restrainer: (1 + ρ)/(1 − κ), √(1 − κ) and 1 + ρ; 1 without it.

    Examples
    --------
    >>> restrained_units(stiffness_ratio=0.75, prestress_ratio=0.5)
    RestrainedUnits(angle=6.0, rate=0.5, acceleration=1.5)
    """
    kept, force = 1.0 - stiffness_ratio, 1.0 + prestress_ratio
    return RestrainedUnits(force / kept, math.sqrt(kept), force)
