"""A block on its shaking base, normalised, and a state of it: Yim & Lin 1991, eqs. (2) and (4)."""

from __future__ import annotations

import math
from collections.abc import Mapping

from attrs import field, frozen

from rocking.model.forcing import FREQUENCIES, MAX_AMPLITUDE, MAX_PHASE, PERIODS, Harmonic
from rocking.model.validation import finite, instance, refusal, within

BRACE_ANGLES = (1e-3, 1e3)
NO_BRACES = {"brace_angle": math.inf, "brace_restitution": 1.0}
"""The quantities of braces, where there are none."""
MAX_STATE = 1e9
MAX_START = 1e3
RANGES = {
    "amplitude": (0.0, MAX_AMPLITUDE),
    "velocity": (-MAX_START, MAX_START),
    "restitution": (0.0, 1.0),
    "brace_angle": BRACE_ANGLES,
    "brace_restitution": (0.0, 1.0),
    "phase": (-MAX_PHASE, MAX_PHASE),
    "angle": (-MAX_START, MAX_START),
    "frequency": FREQUENCIES,
    "period": PERIODS,
}
"""Ranges of the quantities of a system and a start. Of two axes the first in this order is a picture's upward one."""


def _restitution(value: float) -> float:
    return within("restitution", value, 0, 1)


def _brace_angle(value: float) -> float:
    return within("angle", value, *BRACE_ANGLES)


def _angle(value: float) -> float:
    return finite("angle", value, MAX_STATE)


def _velocity(value: float) -> float:
    return finite("velocity", value, MAX_STATE)


def _forcing(value: Harmonic) -> Harmonic:
    return instance("forcing", value, Harmonic)


@frozen
class Braces:
    """A brace on either side, which the block hits at |Θ| = Θb and leaves with Θ' → −r Θ'.

    Parameters
    ----------
    angle : float
        Θb, in units of the critical angle, in [0.001, 1000].
    restitution : float
        r, in [0, 1].

    Raises
    ------
    TypeError, ValueError
        In one line, for a value that is no real number or lies outside its range.

    Examples
    --------
    >>> Braces(angle=1.0)
    Braces(angle=1.0, restitution=1.0)
    """

    angle: float = field(converter=_brace_angle)
    restitution: float = field(default=1.0, converter=_restitution)


def _braces(value: Braces | None) -> Braces | None:
    return None if value is None else instance("braces", value, Braces)


@frozen
class System:
    """A slender block on a shaking base: Θ'' − Θ = −A cos(Ωτ + φ) ∓ 1 (Yim & Lin 1991, eq. 4), Θ' → eΘ' at Θ = 0 (eq. 2).

    Parameters
    ----------
    forcing : Harmonic
        The base's acceleration, eq. (3).
    restitution : float
        e, velocity just after over velocity just before an impact at Θ = 0, in [0, 1].
    braces : Braces, optional
        Braces on either side; none by default.

    Raises
    ------
    TypeError, ValueError
        In one line, for a value of the wrong type or outside its range.

    Examples
    --------
    >>> System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    System(forcing=Harmonic(amplitude=2.0, period=1.0, phase=0.0), restitution=0.925, braces=None)
    """

    forcing: Harmonic = field(converter=_forcing)
    restitution: float = field(converter=_restitution)
    braces: Braces | None = field(default=None, converter=_braces)


def quantities(system: System) -> dict[str, float]:
    """Return the quantities of a system by name; those of braces only where it has braces.

    Examples
    --------
    >>> list(quantities(System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925, braces=Braces(1.5))))
    ['amplitude', 'period', 'frequency', 'phase', 'restitution', 'brace_angle', 'brace_restitution']
    """
    forcing, braces = system.forcing, system.braces
    found = {
        "amplitude": forcing.amplitude,
        "period": forcing.period,
        "frequency": forcing.frequency,
        "phase": forcing.phase,
        "restitution": system.restitution,
    }
    if braces is not None:
        found |= {"brace_angle": braces.angle, "brace_restitution": braces.restitution}
    return found


def system_of(given: Mapping[str, float]) -> System:
    """Return the system of these quantities, its forcing given by the period; one without braces where their angle is infinite.

    Examples
    --------
    >>> system_of({"amplitude": 2.0, "period": 1.0, "phase": 0.0, "restitution": 0.925} | NO_BRACES)
    System(forcing=Harmonic(amplitude=2.0, period=1.0, phase=0.0), restitution=0.925, braces=None)
    """
    forcing = Harmonic(given["amplitude"], period=given["period"], phase=given["phase"])
    braced = given["brace_angle"] < math.inf
    return System(
        forcing,
        given["restitution"],
        Braces(given["brace_angle"], given["brace_restitution"]) if braced else None,
    )


@frozen
class State:
    """An angle and a velocity of the block, normalised; at rest by default.

    Parameters
    ----------
    angle : float
        Θ = θ/θcr, of size up to 1e9; that of a start lies in [-1000, 1000].
    velocity : float
        Θ' = dΘ/dτ, likewise; that of a start lies in [-1000, 1000].

    Raises
    ------
    TypeError, ValueError
        In one line, for a value that is no real number or lies outside its range.

    Examples
    --------
    >>> State(velocity=0.15)
    State(angle=0.0, velocity=0.15)
    """

    angle: float = field(default=0.0, converter=_angle)
    velocity: float = field(default=0.0, converter=_velocity)


def check_start(system: System, start: State | None) -> State:
    """Return the start of a motion, at rest by default.

    Raises
    ------
    TypeError
        If `system` is no System or `start` is no State.
    ValueError
        If the start is far off or beyond a brace.
    """
    instance("system", system, System)
    start = State() if start is None else instance("start", start, State)
    within("angle", start.angle, -MAX_START, MAX_START)
    within("velocity", start.velocity, -MAX_START, MAX_START)
    if system.braces is not None:
        check_between(start.angle, system.braces.angle)
    return start


def check_between(angle: float, reach: float) -> None:
    """Raise ValueError for an angle beyond braces at ±`reach`."""
    if abs(angle) > reach:
        raise ValueError(refusal("angle", f"lie between the braces, in [{-reach:.6g}, {reach:.6g}]", angle))
