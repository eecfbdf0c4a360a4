"""Block on a shaking base, normalised, and its state: Yim & Lin (1991), Eqs. (2) and (4)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from attrs import astuple, evolve, field, frozen

from rocking.model.block_formulas import NORMALISATIONS, Dimensions, with_unit
from rocking.model.forcing import Forcing, Harmonic, PiecewiseLinear
from rocking.model.quantity import (
    ANGLE,
    ANGLE_RATIO,
    BRACE_ANGLE,
    CRITICAL_ANGLE,
    FREQUENCY_RATIO,
    LEFT_QUANTITIES,
    PRESTRESS_RATIO,
    RESTITUTION,
    STIFFNESS_RATIO,
    VELOCITY,
)
from rocking.model.restitution import Restitution, Scatter, check_certain, check_scatter, checked_rows
from rocking.model.validation import (
    REMEDIES,
    Refusal,
    Text,
    WrongType,
    finite,
    instance,
    one_of,
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
RESTRAINED = "be omitted for a restrained block"
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


def _angle_ratio(value: float) -> float:
    return ANGLE_RATIO.checked(value)


def _frequency_ratio(value: float) -> float:
    return FREQUENCY_RATIO.checked(value)


@frozen
class LeftSide:
    """Side Θ < 0 of an unsymmetric block, in units of the side Θ > 0, with which `System` describes all other quantities.

    Parameters
    ----------
    angle_ratio : float
        Critical angle of the left side over that of the right one, θcr₂/θcr₁, in [0.01, 100].
    frequency_ratio : float
        Frequency parameter of the left side over that of the right one, α₂/α₁, in [0.1, 10].
    restitution : float
        Coefficient of restitution e₂₁ of an impact that ends the motion on the left side, in [0, 1].

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range.

    See Also
    --------
    Block : Its `left` follows from the offset of the mass centre.

    Examples
    --------
    >>> LeftSide(angle_ratio=1.4, frequency_ratio=0.99, restitution=0.9)
    LeftSide(angle_ratio=1.4, frequency_ratio=0.99, restitution=0.9)
    """

    angle_ratio: float = field(converter=_angle_ratio)
    frequency_ratio: float = field(converter=_frequency_ratio)
    restitution: float = field(converter=_restitution)


@frozen
class Wall:
    """Wall on the side Θ < 0: the block turns to Θ > 0 only. An impact at Θ = 0 reverses the velocity: Θ' → −e_w Θ'.

    Parameters
    ----------
    restitution : float
        Coefficient of restitution e_w of an impact at Θ = 0, in [0, 1]. Measurements gave 0.3 to 0.5 (Sorrentino et al. 2011).

    Raises
    ------
    TypeError
        If the value is not a real number.
    ValueError
        If the value lies outside its range.

    See Also
    --------
    Block : Takes a wall, with which surveys of ground motions follow it.
    Block.system : Takes a wall for one motion.

    Notes
    -----
    A block at rest lifts off where −A exceeds its level, and never to the other side. So the direction of the base motion matters.
    After infinitely many impacts in a finite time, or after one with e_w = 0, the block rests against the wall. It lifts off again
    as soon as the base acceleration allows. Impacts at Θ = 0 count as `impacts`. Friction at the wall is neglected.

    References
    ----------
    Sorrentino, AlShawa & Decanini, Bull. Earthquake Eng. 9, 1617–1642 (2011).

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.6)
    >>> ground = rk.example_ground_motion().scaled(pga=6.0)
    >>> motion = rk.simulate(block.system(ground, wall=Wall(restitution=0.5)))
    >>> bool((motion.at(motion.to_xarray(units="normalised").time.values)[0] >= 0).all())
    True
    """

    restitution: float = field(converter=_restitution)

    @property
    def angle_ratio(self) -> float:
        """Critical angle of the left side over that of the right one: infinite, so that the block never lifts off to it."""
        return math.inf

    @property
    def frequency_ratio(self) -> float:
        """Frequency parameter of the left side, which has no motion, over that of the right one: 1."""
        return 1.0


Side = LeftSide | Wall
"""What is on the side Θ < 0 of a block whose sides differ."""


def _left(value: Side | None) -> Side | None:
    return value if value is None or isinstance(value, Wall) else instance("left", value, LeftSide)


def _braces(value: Braces | None) -> Braces | None:
    return None if value is None else instance("braces", value, Braces)


def _restitution_table(value: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    return checked_rows("restitution_table", value)


def _vertical(value: PiecewiseLinear | None) -> PiecewiseLinear | None:
    return None if value is None else instance("vertical", value, PiecewiseLinear)


def _stiffness_ratio(value: float) -> float:
    return STIFFNESS_RATIO.checked(value)


def _prestress_ratio(value: float) -> float:
    return PRESTRESS_RATIO.checked(value)


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

    An unsymmetric block has a `left` side with q = θcr₂/θcr₁ and r = α₂/α₁. All units are those of the right side, Θ > 0. On the
    left side, Θ'' = r²[Θ + q − A(τ)] for a slender block, and Θ'' = r²[sin(w)/θcr − A(τ) cos(w)] with w = θcr (q + Θ) for the full
    equation. The impact that ends the motion on a side has the coefficient of restitution of that side.

    With a restrainer (`Block.restrained`) and θ = θcr Θ, Θ'' = −σ[sin(w) + κ sin|θ| + ρ sin(θcr) cos(θ/2)]/θcr − A(τ) cos(w). The
    block at rest lifts off where |A| exceeds 1 + ρ times the level without it.

    On a base with a `vertical` acceleration a_v, the terms without A are multiplied by 1 + a_v: Θ'' = (1 + a_v)(Θ ∓ 1) − A(τ), and
    sin(w) becomes (1 + a_v) sin(w). The block at rest lifts off where |A| exceeds (1 + a_v) times the level without a_v.

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
    restitution_scatter : Scatter, optional
        Scatter of the coefficient of restitution from impact to impact, for the full equation, such as
        ``rk.Restitution.constant(0.9).scattered(0.02).scatter``. Default: none.
    block : Block, optional
        Block in SI units of which the system is the normalised form, as `Block.system` sets it. Results are then in SI units by
        default. A system with another coefficient of restitution has the same block with this value; one with another
        `critical_angle`, or with other ratios of its `left` side, has no block. The block has no effect on equality. Default: none.
    left : LeftSide or Wall, optional
        Left side of an unsymmetric block, or a wall there, whose coefficient of restitution is then that of the system. Default:
        none, a symmetric block. One that equals the right side counts as none.
    vertical : PiecewiseLinear, optional
        Vertical acceleration a_v of the base in units of g, positive upwards, with the step and the number of samples of `forcing`. It
        multiplies the weight of the block by 1 + a_v. Default: none.
    stiffness_ratio, prestress_ratio : float
        Ratios κ in [0, 1000] and ρ in [0, 1e6] of a restrainer for the full equation, under a base motion that ends. Default: 0.

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
    restitution_scatter: Scatter | None = field(default=None, converter=check_scatter, kw_only=True)
    block: Block | None = field(default=None, converter=_block, kw_only=True, eq=False, repr=False)
    left: Side | None = field(default=None, converter=_left, kw_only=True)
    vertical: PiecewiseLinear | None = field(default=None, converter=_vertical, kw_only=True)
    stiffness_ratio: float = field(default=0.0, converter=_stiffness_ratio, kw_only=True)
    prestress_ratio: float = field(default=0.0, converter=_prestress_ratio, kw_only=True)

    def __attrs_post_init__(self) -> None:
        """Refuse a table for the slender block, and braces that a full block reaches only when it lies flat."""
        self._check_left()
        if self.vertical is not None:
            self._check_vertical(self.vertical)
        if self.is_restrained:
            self._check_restrainer()
        if self.block is not None:
            if self.braces is not None:
                given = Text(f"braces at {self.braces.angle:g} θcr")
                refuse_if(self.block.restrainer is not None, "braces", RESTRAINED, given)
            object.__setattr__(self, "block", self._fitting(self.block))
        if self.critical_angle is None:
            allowed = "be omitted for a slender block"
            remedy = "give its {critical_angle}"
            refuse_if(
                bool(self.restitution_table), "restitution_table", allowed, self.restitution_table, remedy
            )
            scatter = self.restitution_scatter
            refuse_if(scatter is not None, "restitution_scatter", allowed, Text(str(scatter)), remedy)
        elif self.braces is not None:
            check_below_flat(self.braces.angle, self.critical_angle)

    def _check_left(self) -> None:
        """Drop a left side that equals the right one; refuse one whose critical angle the full equation does not take."""
        if self.left == LeftSide(1.0, 1.0, self.restitution):
            object.__setattr__(self, "left", None)
        if self.left is None:
            return
        if self.wall is not None:
            self._check_wall(self.wall)
            return
        allowed, got = "be omitted with braces", Text("both")
        refuse_if(self.braces is not None, "left", allowed, got, "braces are for a symmetric block")
        refuse_if(
            bool(self.restitution_table),
            "left",
            "be omitted with {restitution_table}",
            got,
            "a table is for a symmetric block",
        )
        if self.critical_angle is not None:
            low, high = (each / self.critical_angle for each in CRITICAL_ANGLE.range)
            within("angle_ratio", self.left.angle_ratio, low, high)

    def _check_vertical(self, vertical: PiecewiseLinear) -> None:
        """Refuse what does not go with a vertical acceleration: any base motion but samples at the same times, braces, a restrainer."""
        base, got = self.forcing, Text("both")
        allowed = "be omitted unless {forcing} is rk.PiecewiseLinear"
        if not isinstance(base, PiecewiseLinear):
            raise Refusal("vertical", allowed, Text(f"{{forcing}} {base}"))
        allowed = f"have {base.values.size} samples with a step of {base.step:g}, as {{forcing}}"
        apart = (vertical.values.size, vertical.step) != (base.values.size, base.step)
        refuse_if(apart, "vertical", allowed, vertical)
        refuse_if(self.braces is not None, "braces", "be omitted with {vertical}", got)
        restrained = self.block is not None and self.block.restrainer is not None
        refuse_if(restrained, "vertical", RESTRAINED, vertical)

    def _check_restrainer(self) -> None:
        """Refuse what does not go with a restrainer: small angles, a harmonic base, braces, a left side, vertical motion."""
        name = "stiffness_ratio" if self.stiffness_ratio else "prestress_ratio"
        value = self.stiffness_ratio or self.prestress_ratio
        remedy = "give its {critical_angle}, or rk.Block.restrained"
        refuse_if(self.critical_angle is None, name, "be 0 for a slender block", value, remedy)
        refuse_if(isinstance(self.forcing, Harmonic), name, "be 0 on a harmonic base", value)
        for other, given in (("braces", self.braces), ("left", self.left), ("vertical", self.vertical)):
            refuse_if(given is not None, other, RESTRAINED, Text(str(given)))

    @property
    def is_restrained(self) -> bool:
        """Flag: the full equation has the terms of a restrainer."""
        return self.stiffness_ratio > 0.0 or self.prestress_ratio > 0.0

    def _check_wall(self, wall: Wall) -> None:
        """Refuse what is not for a block against a wall: braces, and another restitution than that of the wall."""
        for name, value in (
            ("braces", self.braces),
            ("restitution_table", self.restitution_table or None),
            ("restitution_scatter", self.restitution_scatter),
        ):
            refuse_if(value is not None, name, "be omitted for a block against a wall", Text("both"))
        allowed = f"be that of the wall, {wall.restitution:g}"
        refuse_if(self.restitution != wall.restitution, "restitution", allowed, self.restitution)

    @property
    def wall(self) -> Wall | None:
        """Wall against which the block stands."""
        return self.left if isinstance(self.left, Wall) else None

    def _fitting(self, block: Block) -> Block | None:
        """Return the block with the restitution and the unit of acceleration of the system.

        None if its critical angles or the ratio of its frequencies are other ones.
        """
        if self.wall != block.wall:
            block = evolve(block, wall=self.wall)
        own, other = self.left, block.left
        ratios = [
            (1.0, 1.0) if each is None else (each.angle_ratio, each.frequency_ratio) for each in (own, other)
        ]
        if self.critical_angle not in (None, block.critical_angle) or ratios[0] != ratios[1]:
            return None
        slender = self.critical_angle is None
        restrainer = (0.0, 0.0) if slender else (block.stiffness_ratio, block.prestress_ratio)
        if restrainer != (self.stiffness_ratio, self.prestress_ratio):
            return None
        if not slender:
            block = with_unit(block, "angle")
        elif isinstance(self.forcing, Harmonic):
            block = with_unit(block, "angle" if block.restrainer is None else "balance")
        left = self.restitution if own is None else own.restitution
        scatter = None if self.restitution_scatter is None else evolve(self.restitution_scatter, run=0)
        unit = float(block.radians_per_second(1.0))
        law = block.law.normalised_rows(unit), block.law.scatter
        stated = self.restitution, left, self.restitution_table, scatter
        if (block.restitution, block.left_restitution, *law) == stated:
            return block
        rows = tuple((speed * unit, kept) for speed, kept in self.restitution_law)
        restitution = Restitution(value=None if rows else self.restitution, rows=rows, scatter=scatter)
        return evolve(block, restitution=restitution, left_restitution=None if own is None else left)

    @property
    def has_chains(self) -> bool:
        """Flag: its orbits are chains of events with equations in closed form, as for a slender, symmetric block."""
        return self.critical_angle is None and self.left is None

    @property
    def lossless(self) -> bool:
        """Flag: an impact on the base loses no energy, on either side."""
        return (
            self.restitution == 1.0
            and self.restitution_scatter is None
            and (self.left is None or self.left.restitution == 1.0)
        )

    @property
    def normalised_by(self) -> str:
        """Unit of the base acceleration, as `Block.system` chose it: "angle", g θcr, "tangent", g tan θcr, or "balance", (1 + ρ)g θcr.

        The last is that of a slender restrained block, for which "tangent" stands for (1 + ρ)g tan θcr.
        """
        return "angle" if self.block is None else self.block.normalised_by

    @property
    def restitution_law(self) -> tuple[tuple[float, float], ...]:
        """Rows of the coefficient of restitution from speed 0 on; none if it is constant."""
        return ((0.0, self.restitution), *self.restitution_table) if self.restitution_table else ()

    @property
    def harmonic(self) -> Harmonic:
        """Forcing of a slender block whose base motion is periodic; TypeError for any other system.

        Analyses in closed form, which exist for the slender block alone, take the forcing from here.
        """
        check_no_wall(self)
        if self.critical_angle is not None:
            rule = "be None for this analysis, which has a closed form for the slender block alone"
            raise WrongType("critical_angle", rule, self.critical_angle)
        check_symmetric(self, "this analysis, which has a closed form for it alone")
        return self.periodic

    @property
    def lift_off(self) -> float:
        """Base acceleration above which a block lifts off from rest, in units of g θcr: 1, or (1 + ρ) tan θcr/θcr for the full equation.

        For an unsymmetric block it is that of the side on which it lifts off first.
        """
        return min(self.lift_offs)

    @property
    def lift_offs(self) -> tuple[float, float]:
        """Values of −A and of A above which a block lifts off from rest, to Θ > 0 and to Θ < 0, in units of g θcr."""
        ratios = (1.0, 1.0 if self.left is None else self.left.angle_ratio)
        if self.critical_angle is None:
            return ratios
        if self.wall is not None:
            return math.tan(self.critical_angle) / self.critical_angle, math.inf
        force = 1.0 + self.prestress_ratio
        right, left = (
            force * (math.tan(ratio * self.critical_angle) / self.critical_angle) for ratio in ratios
        )
        return right, left

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
    """Return the quantities of a system by name; those of the full equation, braces, a restrainer and the left side only if it has them.

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
    if system.is_restrained:
        rows |= {"stiffness_ratio": system.stiffness_ratio, "prestress_ratio": system.prestress_ratio}
    return rows | left_quantities(system.left)


def left_quantities(left: Side | None) -> dict[str, float]:
    """Return the quantities of a left side, or of a wall, by name; none of a symmetric block."""
    if left is None:
        return {}
    if isinstance(left, Wall):
        return {"wall_restitution": left.restitution}
    return dict(zip(LEFT_QUANTITIES, astuple(left), strict=True))


def system_of(values: Mapping[str, float]) -> System:
    """Return the system with these quantities, its forcing made from the period, or without one from the frequency.

    It has no braces if their angle is infinite, is slender if the critical angle is 0 or missing, and symmetric without ratios.

    Examples
    --------
    >>> system_of({"amplitude": 2.0, "period": 1.0, "phase": 0.0, "restitution": 0.925} | NO_BRACES).forcing
    Harmonic(amplitude=2.0, period=1.0, phase=0.0)
    """
    time = "period" if "period" in values else "frequency"
    forcing = Harmonic(values["amplitude"], phase=values["phase"], **{time: values[time]})
    braced = values["brace_angle"] < math.inf
    left = None
    if "angle_ratio" in values:
        left = LeftSide(values["angle_ratio"], values["frequency_ratio"], values["left_restitution"])
    return System(
        forcing,
        values["restitution"],
        Braces(values["brace_angle"], values["brace_restitution"]) if braced else None,
        values.get("critical_angle", 0.0) or None,
        left=left,
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


def check_symmetric(system: System, what: str) -> None:
    """Raise ValueError for an unsymmetric block in an analysis, `what`, that needs the mirror symmetry of the equations."""
    check_no_wall(system)
    allowed = f"be a symmetric block for {what}"
    refuse_if(
        system.left is not None, "system", allowed, Text("one with a {left} side of its own"), UNSYMMETRIC
    )


def check_no_wall(system: System) -> None:
    """Raise ValueError for a block against a wall in an analysis of recurrent motions."""
    allowed = "have no wall for an analysis of recurrent motions"
    remedy = "rk.simulate and surveys of ground motions and pulses take it"
    refuse_if(system.wall is not None, "system", allowed, Text(str(system.wall)), remedy)


UNSYMMETRIC = "rk.classify, rk.find_orbits and surveys need no symmetry"


def critical_angle_for(model: str, angle: float, width: float) -> float | None:
    """Return the critical angle of a block, None for the slender model; ValueError if the full equation does not take it."""
    if one_of("model", model, MODELS) == "slender":
        return None
    low, high = CRITICAL_ANGLE.range
    allowed = f"give a critical angle atan({{width}}/{{height}}) in [{low}, {high}] with the full equation"
    refuse_if(not low <= angle <= high, "width", allowed, width, "the slender {model} takes any angle")
    return angle


def normalisation_for(normalised_by: str | None, model: str, *, finite: bool = True) -> str:
    """Return the unit of the base acceleration of a block in SI, after checking: by default "tangent" where it is allowed.

    It is allowed for the slender block under a base motion of finite length.
    """
    slender = finite and model == "slender"
    if normalised_by is None:
        return "tangent" if slender else "angle"
    where = "with the full equation of motion" if finite else "for a harmonic base motion"
    allowed = f"be 'angle' or omitted {where}"
    chosen = one_of("normalised_by", normalised_by, NORMALISATIONS)
    refuse_if(chosen == "tangent" and not slender, "normalised_by", allowed, chosen)
    return chosen


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
    if system.wall is not None:
        inside = start.angle > 0.0 or (start.angle == 0.0 and start.velocity >= 0.0)
        allowed = "start at an angle above 0, or at 0 with no velocity towards the wall"
        got = Text(f"angle {start.angle:g}, velocity {start.velocity:g}")
        refuse_if(not inside, "start", allowed, got)
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
        As in `check_start`, or for scatter of the restitution, or a wall.
    """
    instance("system", system, System).periodic  # noqa: B018 (it refuses)
    check_certain(system.restitution_scatter)
    check_no_wall(system)
    return check_start(system, start)
