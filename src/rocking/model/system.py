"""Block on a shaking base, normalised, and its state: Yim & Lin (1991), Eqs. (2) and (4)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from attrs import evolve, field, frozen

from rocking.model.block_formulas import Dimensions
from rocking.model.forcing import Forcing, Harmonic
from rocking.model.quantity import ANGLE, BRACE_ANGLE, CRITICAL_ANGLE, RESTITUTION, VELOCITY
from rocking.model.validation import (
    REMEDIES,
    Refusal,
    Text,
    WrongType,
    finite,
    instance,
    members,
    one_of,
    pair,
    refuse_if,
    warn_of_value,
    within,
)

if TYPE_CHECKING:
    from rocking.model.block import Block

MODELS = ("slender", "full")
"""Equations of motion: with small angles, or without."""
NO_BRACES = {"brace_angle": math.inf, "brace_restitution": 1.0}
"""Quantities of braces for a system without braces."""
MAX_STATE = 1e300
MAX_USUAL_ANGLE = 2.0
"""Largest |Θ| of a state or brace without a warning: a block that still moves is often somewhat beyond 1."""
FORCINGS = "make one: rk.Harmonic(amplitude=2.0, period=1.0) or rk.PiecewiseLinear([0.0, 2.0, 0.0], step=0.1)"


def _restitution(value: float) -> float:
    return RESTITUTION.checked(value)


def _brace_angle(value: float) -> float:
    return BRACE_ANGLE.checked(value, "angle")


def _angle(value: float) -> float:
    return finite("angle", value, MAX_STATE)


def _velocity(value: float) -> float:
    return finite("velocity", value, MAX_STATE)


def _forcing(value: Forcing) -> Forcing:
    if not isinstance(value, Forcing):
        raise WrongType("forcing", "be a base motion", value, FORCINGS)
    return value


@frozen
class Braces:
    """Two side braces at Θ = ±Θb. An impact on a brace reverses the velocity: Θ' → −r Θ'.

    Parameters
    ----------
    angle : float
        Brace angle Θb, in units of the critical angle, in [0.001, 1000].
    restitution : float
        Coefficient of restitution r of a brace impact, in [0, 1]. Default: 1.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range.

    Warns
    -----
    InputWarning
        If the angle exceeds 2. A block is rarely beyond 1, from where it overturns under its own weight:
        a larger number is probably in degrees.

    Examples
    --------
    >>> Braces(angle=1.0)
    Braces(angle=1.0, restitution=1.0)
    """

    angle: float = field(converter=_brace_angle)
    restitution: float = field(default=1.0, converter=_restitution)

    def __attrs_post_init__(self) -> None:
        if doubt := angle_doubt(self.angle):
            warn_of_value(doubt)


def _braces(value: Braces | None) -> Braces | None:
    return None if value is None else instance("braces", value, Braces)


def _restitution_table(value: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return rows of speed and coefficient of restitution, after checking them."""
    allowed = "be rows (speed, coefficient of restitution), the speeds positive and ascending"
    rows = [pair("restitution_table", row, allowed) for row in members("restitution_table", value, allowed)]
    checked = tuple((within("speed", speed, 0, MAX_STATE), _restitution(kept)) for speed, kept in rows)
    speeds = [0.0, *(speed for speed, _ in checked)]
    refuse_if(not all(one < two for one, two in pairwise(speeds)), "restitution_table", allowed, value)
    return checked


def _critical_angle(value: float | None) -> float | None:
    return None if value is None else CRITICAL_ANGLE.checked(value)


def _block(value: Any) -> Any:
    if not (value is None or isinstance(value, Dimensions)):
        raise WrongType("block", "be a Block", value, REMEDIES["Block"])
    return value


@frozen
class System:
    """Block on a shaking base, normalised: Yim & Lin (1991), Eqs. (2) and (4), or the full equation.

    The equation of motion of a slender block is Θ'' − Θ = −A(τ) ∓ 1, with − for Θ > 0 and + for Θ < 0. For a harmonic base,
    A(τ) = A cos(Ωτ + φ). At an impact, Θ = 0, the velocity changes from Θ' to eΘ'.

    With a critical angle θcr the angle need not be small. On the side σ of Θ, with w = θcr (1 − σΘ),
    Θ'' = −σ sin(w)/θcr − A(τ) cos(w) (Housner 1963). Θ = θ/θcr, and A is in units of g θcr, as for the slender block.

    Parameters
    ----------
    forcing : Harmonic, PiecewiseLinear or Pulse
        Base acceleration; for `Harmonic`, Eq. (3).
    restitution : float
        Coefficient of restitution e, the ratio of the angular velocities just after and just before an impact at Θ = 0,
        in [0, 1].
    braces : Braces, optional
        Side braces. Default: no braces.
    critical_angle : float, optional
        Critical angle θcr of the full equation, rad, in [0.001, 1.2]. Default: None, the slender block, its limit for θcr → 0.
        With it, braces must be below 90°: their angle times θcr below π/2.
    restitution_table : iterable of (float, float)
        Coefficient of restitution over the speed before an impact, for the full equation: rows (Θ', e), ascending. Up to the
        first row e changes linearly from `restitution`. Then it is linear between rows, and constant beyond the last.
        Default: none; e is `restitution` at all speeds.
    block : Block, optional
        Block in SI units of which the system is the normalised form, as `Block.system` sets it. Results are then in SI units by
        default. A system with another `restitution` has the same block with this value; one with another `critical_angle` has no
        block. The block has no effect on equality. Default: none.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If `restitution` or `critical_angle` lies outside its range, or does not go with the other arguments.

    Examples
    --------
    >>> system = System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925, critical_angle=0.25)
    >>> round(system.lift_off, 4)
    1.0214
    """

    forcing: Forcing = field(converter=_forcing)
    restitution: float = field(converter=_restitution)
    braces: Braces | None = field(default=None, converter=_braces)
    critical_angle: float | None = field(default=None, converter=_critical_angle)
    restitution_table: tuple[tuple[float, float], ...] = field(default=(), converter=_restitution_table)
    block: Block | None = field(default=None, converter=_block, kw_only=True, eq=False, repr=False)

    def __attrs_post_init__(self) -> None:
        """Refuse a table for the slender block, and braces that a full block reaches only when it lies flat."""
        if self.block is not None:
            object.__setattr__(self, "block", self._fitting(self.block))
        if self.critical_angle is None:
            allowed = "be omitted for a slender block"
            remedy = "give its {critical_angle}"
            refuse_if(
                bool(self.restitution_table), "restitution_table", allowed, self.restitution_table, remedy
            )
        elif self.braces is not None:
            check_below_flat(self.braces.angle, self.critical_angle)

    def _fitting(self, block: Block) -> Block | None:
        """Return the block with the coefficient of restitution of the system; None if its critical angle is another one."""
        if self.critical_angle not in (None, block.critical_angle):
            return None
        return block if block.restitution == self.restitution else evolve(block, restitution=self.restitution)

    @property
    def restitution_law(self) -> tuple[tuple[float, float], ...]:
        """Rows of the coefficient of restitution from speed 0 on; none if it is constant."""
        return ((0.0, self.restitution), *self.restitution_table) if self.restitution_table else ()

    @property
    def harmonic(self) -> Harmonic:
        """Forcing of a slender block whose base motion is periodic; TypeError for any other system.

        Analyses in closed form, which exist for the slender block alone, take the forcing from here.
        """
        if self.critical_angle is not None:
            rule = "be None for this analysis, which has a closed form for the slender block alone"
            raise WrongType("critical_angle", rule, self.critical_angle)
        return self.periodic

    @property
    def lift_off(self) -> float:
        """Base acceleration above which a block lifts off from rest, in units of g θcr: 1, or tan θcr/θcr for the full equation."""
        return 1.0 if self.critical_angle is None else math.tan(self.critical_angle) / self.critical_angle

    @property
    def periodic(self) -> Harmonic:
        """Forcing of a system whose base motion is periodic; TypeError for any other.

        All analyses of such systems take the forcing from here: classification, exponents, orbits, maps and sections.
        """
        if not isinstance(self.forcing, Harmonic):
            name = type(self.forcing).__name__
            remedy = "rk.simulate tells how its motion ends"
            raise WrongType("system", "have a periodic base motion, rk.Harmonic", Text(name), remedy)
        return self.forcing


def quantities(system: System) -> dict[str, float]:
    """Return the quantities of a system by name; the critical angle and those of braces only if it has them.

    Examples
    --------
    >>> list(quantities(System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925, braces=Braces(1.5))))
    ['amplitude', 'period', 'frequency', 'phase', 'restitution', 'brace_angle', 'brace_restitution']
    """
    braces = system.braces
    rows = {**system.forcing.quantities(), "restitution": system.restitution}
    if system.critical_angle is not None:
        rows["critical_angle"] = system.critical_angle
    if braces is not None:
        rows |= {"brace_angle": braces.angle, "brace_restitution": braces.restitution}
    return rows


def system_of(values: Mapping[str, float]) -> System:
    """Return the system with these quantities, its forcing made from the period, or without one from the frequency.

    It has no braces if their angle is infinite, and is slender if the critical angle is 0 or missing.

    Examples
    --------
    >>> system_of({"amplitude": 2.0, "period": 1.0, "phase": 0.0, "restitution": 0.925} | NO_BRACES).forcing
    Harmonic(amplitude=2.0, period=1.0, phase=0.0)
    """
    time = "period" if "period" in values else "frequency"
    forcing = Harmonic(values["amplitude"], phase=values["phase"], **{time: values[time]})
    braced = values["brace_angle"] < math.inf
    return System(
        forcing,
        values["restitution"],
        Braces(values["brace_angle"], values["brace_restitution"]) if braced else None,
        values.get("critical_angle", 0.0) or None,
    )


@frozen
class State:
    """State of the block: normalised angle and angular velocity.

    Parameters
    ----------
    angle : float
        Angle Θ = θ/θcr, of magnitude up to 1e300; for an initial state, in [-1000, 1000]. Default: 0.
    velocity : float
        Angular velocity Θ' = dΘ/dτ, of magnitude up to 1e300; for an initial state, in [-1000, 1000]. Default: 0.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range.

    Warns
    -----
    InputWarning
        If |angle| exceeds 2. Beyond 1 a block overturns under its own weight: a larger number is probably in degrees.

    Examples
    --------
    >>> State(velocity=0.15)
    State(angle=0.0, velocity=0.15)
    """

    angle: float = field(default=0.0, converter=_angle)
    velocity: float = field(default=0.0, converter=_velocity)

    def __attrs_post_init__(self) -> None:
        if doubt := angle_doubt(self.angle):
            warn_of_value(doubt)


def angle_doubt(angle: float, remedy: str | None = None) -> str:
    """Return a sentence, with a remedy, on an angle that is probably in degrees; empty for any other."""
    if abs(angle) <= MAX_USUAL_ANGLE:
        return ""
    return (
        f"angle {angle:.6g} is {abs(angle):.6g} times the critical angle, beyond which a block overturns under its own weight: "
        f"{remedy or f'block.angle(degrees={angle:.6g}) converts degrees'}"
    )


def check_constant_restitution(system: System) -> None:
    """Raise ValueError for a table of the coefficient of restitution, which surveys and diagrams do not take."""
    allowed = "be omitted for many systems at once"
    refuse_if(bool(system.restitution_table), "restitution_table", allowed, system.restitution_table)


def critical_angle_for(model: str, angle: float, width: float) -> float | None:
    """Return the critical angle of a block, None for the slender model; ValueError if the full equation does not take it."""
    if one_of("model", model, MODELS) == "slender":
        return None
    low, high = CRITICAL_ANGLE.range
    allowed = f"give a critical angle atan({{width}}/{{height}}) in [{low}, {high}] with the full equation"
    refuse_if(not low <= angle <= high, "width", allowed, width)
    return angle


def check_below_flat(brace_angle: float, critical_angle: float) -> None:
    """Raise ValueError for braces that a full block reaches only when it lies flat."""
    limit = 0.5 * math.pi / critical_angle
    allowed = f"be below {limit:.6g}, where a block with {{critical_angle}} {critical_angle:.6g} lies flat"
    refuse_if(brace_angle >= limit, "brace_angle", allowed, brace_angle)


def check_between(angle: float, reach: float) -> None:
    """Raise ValueError if an angle lies beyond braces at ±`reach`."""
    if abs(angle) > reach:
        raise Refusal("angle", f"lie between the braces, in [{-reach:.6g}, {reach:.6g}]", angle)


def check_start(system: System, start: State | None) -> State:
    """Return the initial state of a motion, by default at rest.

    Raises
    ------
    TypeError
        If `system` is not a System or `start` is not a State.
    ValueError
        If the initial state lies outside [-1000, 1000], beyond a brace, or where a full block lies flat.
    """
    instance("system", system, System)
    start = State() if start is None else instance("start", start, State)
    ANGLE.checked(start.angle)
    VELOCITY.checked(start.velocity)
    if system.braces is not None:
        check_between(start.angle, system.braces.angle)
    if system.critical_angle is not None:
        flat = 0.5 * math.pi / system.critical_angle
        allowed = f"lie within ±{flat:.6g}, where the block lies flat"
        refuse_if(abs(start.angle) >= flat, "angle", allowed, start.angle)
    return start


def check_periodic(system: System, start: State | None) -> State:
    """Return the initial state as `check_start` does, for an analysis that needs a periodic base motion.

    Raises
    ------
    TypeError
        If the base motion is not periodic, or as in `check_start`.
    ValueError
        As in `check_start`.
    """
    instance("system", system, System).periodic  # noqa: B018 (it refuses)
    return check_start(system, start)
