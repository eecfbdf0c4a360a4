"""Block in SI units, and conversion to and from normalised quantities: Yim & Lin (1991), Eqs. (1)–(4)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.block_formulas import (
    BLOCK_NORMALISATIONS,
    GRAVITY,
    Dimensions,
    acceleration_unit_g,
    frequency_in_hertz,
    frequency_parameter,
    housner_restitution,
    with_unit,
)
from rocking.model.changed_motion import checked_pair
from rocking.model.forcing import BaseMotion, Forcing, Harmonic, PiecewiseLinear
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.quantity import AMPLITUDE, FREQUENCY, LEFT_RESTITUTION, SIZES
from rocking.model.restitution import Restitution, Scatter, check_model, check_uniform, checked_law, law_of
from rocking.model.restrainer import (
    STIFFEST,
    RestrainedUnits,
    Restrainer,
    checked_restrainer,
    restrained_units,
)
from rocking.model.section import SYMMETRIC, section_of
from rocking.model.system import (
    MODELS,
    Braces,
    LeftSide,
    Side,
    System,
    Wall,
    critical_angle_for,
    normalisation_for,
)
from rocking.model.validation import (
    MAX_REAL,
    Refusal,
    Text,
    WrongType,
    exactly_one,
    explained,
    finite,
    instance,
    one_of,
    reals,
    refuse_if,
    warn_of_value,
    within,
)

LOWEST, LARGEST = 0.01, 100.0
"""Smallest height, and largest height or width, in m, without a warning."""
INERTIA_RATIOS = (1.0, 10.0)
RECTANGLE = 4 / 3


def checked_height(value: float) -> float:
    """Return the height in m, after checking."""
    return within("height", value, *SIZES, unit="m")


def checked_width(value: float) -> float:
    """Return the width in m, after checking."""
    return within("width", value, *SIZES, unit="m")


def checked_left_restitution(value: float | None) -> float | None:
    """Return the coefficient of restitution of an impact from the left side, after checking."""
    return None if value is None else LEFT_RESTITUTION.checked(value)


def checked_inertia_ratio(value: float | None) -> float | None:
    """Return the inertia ratio, after checking."""
    return None if value is None else within("inertia_ratio", value, *INERTIA_RATIOS)


def checked_offset(value: float) -> float:
    """Return the distance of the mass centre from the middle of the base in m, a finite number."""
    return finite("offset", value, SIZES[1]) + 0.0


def checked_centre_height(value: float | None) -> float | None:
    """Return the height of the mass centre in m, after checking."""
    return None if value is None else within("centre_height", value, *SIZES, unit="m")


def checked_radius_of_gyration(value: float | None) -> float | None:
    """Return the radius of gyration in m, after checking."""
    return None if value is None else within("radius_of_gyration", value, 0.0, SIZES[1], unit="m")


def _or_rectangle(inertia_ratio: float | None) -> float:
    return RECTANGLE if inertia_ratio is None else inertia_ratio


def checked_wall(value: Wall | None) -> Wall | None:
    """Return a wall, after checking its type."""
    return None if value is None else instance("wall", value, Wall)


def checked_normalisation(value: str) -> str:
    """Return the name of the unit of acceleration, after checking."""
    return one_of("normalised_by", value, BLOCK_NORMALISATIONS)


def checked_vertical(base: Any, vertical: Any) -> GroundMotion:
    """Return a vertical ground motion, after checking that it has the samples of the horizontal one."""
    instance("vertical", vertical, GroundMotion)
    allowed, remedy = "be omitted without a ground motion", "give both components of one record"
    refuse_if(not isinstance(base, GroundMotion), "vertical", allowed, vertical, remedy)
    checked_pair(base, vertical, "vertical", "horizontal component")
    return vertical


def size_warnings(checked_height: float, checked_width: float) -> Iterator[str]:
    """Yield a sentence for each size in m that is probably in another unit."""
    for name, size, least in (("height", checked_height, LOWEST), ("width", checked_width, 0.0)):
        if not least <= size <= LARGEST:
            yield f"{name} {size:.4g} m is unusual: sizes are in metres"


@frozen(repr=False)
class Block(Dimensions):
    """Rigid block that stands on its two bottom corners: Yim & Lin (1991), Eqs. (1) and (2).

    Methods convert between normalised and SI quantities. A method named after a physical unit takes a normalised
    value: `degrees(angle)`, `seconds(time)`. A method named after a normalised quantity takes a physical value:
    `angle(degrees=5)`, `time(seconds)`. All of them take numbers or arrays and keep the shape.

    Parameters
    ----------
    height, width : float
        Height H and width B in metres, in [0.001, 1000].
    restitution : float or Restitution, optional
        Coefficient of restitution e of Eq. (2), in [0, 1], or a law: a table over the speed, a factor, or scatter. Default:
        Housner's value, e = 1 − 2 sin²θcr/`inertia_ratio`, which conserves the angular momentum about the corner of the impact.
    inertia_ratio : float, optional
        Io/(MR²), normalised moment of inertia about a corner, in [1, 10]. Default: that of a uniform rectangle of this height and
        width, 4/3 if the mass centre is its middle. With an `offset` give `radius_of_gyration` instead: the corners differ.
    normalised_by : {"angle", "tangent", "balance"}
        Unit of `acceleration` and `amplitude`: g θcr, or g tan θcr. The block of a system has that of the system. It has no effect
        on equality, nor on what `system` returns. With "balance", or "tangent", a restrained block converts as small angles do:
        by its unstable balance (`restrained`). Default: "angle".
    offset : float
        Distance of the mass centre from the middle of the base, in metres, towards the edge about which the block turns for
        θ > 0. It is smaller than half the width. Default: 0. A positive sample of the base acceleration tips the block towards
        θ < 0.
    centre_height : float, optional
        Height h of the mass centre above the base, in metres, up to the height. Default: half the height.
    radius_of_gyration : float, optional
        Radius of gyration k = √(I/M) about the mass centre, in metres. Default: that of `inertia_ratio`; without it that of a
        uniform rectangle, k² = (H² + B²)/12.
    left_restitution : float, optional
        Coefficient of restitution of an impact that ends the motion on the side θ < 0; `restitution` is then that of the other
        impacts. Default: `restitution`, or the value that conserves the angular momentum about the corner of the impact.
    wall : Wall, optional
        Wall on the side θ < 0. Its coefficient of restitution is then that of all impacts, and the other ones have no effect.
        Default: none.
    restrainer : Restrainer, optional
        Elastic restrainer, as `restrained` sets it. Default: none.

    Raises
    ------
    TypeError
        If a value is not a real number, or if both `inertia_ratio` and `radius_of_gyration` are given.
    ValueError
        If a value lies outside its range, or if the mass centre is not above the base. Also if Housner's coefficient of
        restitution is negative (a squat block) and `restitution` is not given.

    Warns
    -----
    InputWarning
        If the height is below 0.01 m, or if height or width exceed 100 m. Even models, bridges and towers lie between.

    Notes
    -----
    Any proportions are allowed. On a harmonic base the equation is that of a slender block, sin θ ≈ θ, unless `system` is told
    otherwise. `Motion.validity` reports how far a motion leaves the range of this approximation.

    Side 1 is θ > 0, the right one, and side 2 is θ < 0. With the offset d, b₁ = B/2 − d and b₂ = B/2 + d are the distances of
    the edges from the foot of the mass centre. With R_i² = h² + b_i² they give θcr_i = arctan(b_i/h), α_i² = gR_i/(k² + R_i²),
    e₁₂ = (k² + h² − b₁b₂)/(k² + R₂²) for the impact from side 1 to side 2, and e₂₁ with R₁. Properties and conversions are those
    of side 1: angles are in units of θcr₁ and times in units of 1/α₁ on both sides. `left` relates side 2 to side 1.

    References
    ----------
    Housner, Bull. Seismol. Soc. Am. 53, 403–417 (1963).

    Examples
    --------
    >>> block = Block(height=2.0, width=0.5)
    >>> block
    Block(height=2.0 m, width=0.5 m, restitution=0.911765 by Housner's formula)
    >>> block.degrees([0.5, 1.0]).round(3).tolist()
    [7.018, 14.036]
    >>> float(block.angle(degrees=7.018)), block.time(seconds=1.0), block.seconds(2.671)
    (0.50, 2.671, 1.00)
    >>> float(block.top_displacement(0.5)), block.acceleration(1.0), block.amplitude(acceleration=2.4)
    (0.244, 2.402, 1.00)
    >>> block.system(acceleration=3.0, period_s=0.8).forcing.amplitude > 1
    True
    >>> left = Block(height=2.0, width=0.6, offset=0.05).left
    >>> round(left.angle_ratio, 6), round(left.frequency_ratio, 6), round(left.restitution, 6)
    (1.374303, 0.993147, 0.894798)
    """

    height: float = field(converter=checked_height)
    width: float = field(converter=checked_width)
    _restitution: float | Restitution | None = field(default=None, converter=checked_law)
    _inertia_ratio: float | None = field(default=None, converter=checked_inertia_ratio, eq=_or_rectangle)
    normalised_by: str = field(default="angle", converter=checked_normalisation, kw_only=True, eq=False)
    offset: float = field(default=0.0, converter=checked_offset, kw_only=True)
    _centre_height: float | None = field(default=None, converter=checked_centre_height, kw_only=True)
    _radius_of_gyration: float | None = field(
        default=None, converter=checked_radius_of_gyration, kw_only=True
    )
    _left_restitution: float | None = field(default=None, converter=checked_left_restitution, kw_only=True)
    wall: Wall | None = field(default=None, converter=checked_wall, kw_only=True)
    restrainer: Restrainer | None = field(default=None, converter=checked_restrainer, kw_only=True)

    def __attrs_post_init__(self) -> None:
        self._check_mass_centre()
        for doubt in size_warnings(self.height, self.width):
            warn_of_value(doubt)
        if not self.has_equal_sides:  # without its ratios, which may be beyond the range of a system
            check_uniform(self.law.rows, "an unsymmetric block")
        ends = min(self.restitution, self.left_restitution), max(self.restitution, self.left_restitution)
        if not (ends[0] >= 0.0 and ends[1] <= 1.0):
            wrong = ends[0] if ends[0] < 0.0 else ends[1]
            housner = f"{wrong:.3g} by {self.law.origin} for a block {self.height:g} m high and {self.width:g} m wide"
            if wrong > 1.0:  # Housner's value alone is at most 1
                raise Refusal(
                    "restitution", "give a coefficient in [0, 1]", Text(housner), "reduce the factor"
                )
            remedy = "are {height} and {width} swapped, or in another unit? If not, give {restitution}"
            raise Refusal("restitution", "lie in [0, 1]", Text(housner), remedy)
        if self.restrainer is not None:
            self._check_restrained(self.restrainer)

    def _check_restrained(self, restrainer: Restrainer) -> None:
        """Refuse a restrainer of a block whose sides differ, one that is too stiff, and units that it does not have."""
        allowed = "be omitted for a restrained block"
        if self.wall is not None:
            raise Refusal("wall", allowed, Text(f"one with e_w = {self.wall.restitution:g}"))
        refuse_if(self.offset != 0, "offset", allowed, self.offset, "the restrainer is on its centre line")
        refuse_if(not self.has_equal_sides, "left_restitution", allowed, self.left_restitution)
        if self.normalised_by != "angle":
            check_balance(self)
        allowed = f"be at most {STIFFEST * self.stiffness_unit:.6g} N/m, where κ = {STIFFEST:g}"
        refuse_if(self.stiffness_ratio > STIFFEST, "stiffness", allowed, restrainer.stiffness)

    def _check_mass_centre(self) -> None:
        """Refuse a mass centre that is not above the base, and an inertia that is stated twice or that no body has."""
        half = self.width / 2
        allowed = f"lie between {-half:.6g} and {half:.6g} m, so that the mass centre is above the base"
        refuse_if(not -half < self.offset < half, "offset", allowed, self.offset)
        if self._centre_height == self.height / 2:
            object.__setattr__(self, "_centre_height", None)
        allowed = f"be at most the height, {self.height:g} m"
        refuse_if(self.centre_height > self.height, "centre_height", allowed, self.centre_height)
        if self._inertia_ratio is not None and self._radius_of_gyration is not None:
            remedy = "both state the inertia"
            raise WrongType(
                "inertia_ratio", "be omitted with {radius_of_gyration}", self._inertia_ratio, remedy
            )
        if self._inertia_ratio is not None and self.offset != 0:
            remedy = "give {radius_of_gyration}: the corners differ"
            raise WrongType("inertia_ratio", "be omitted with {offset}", self._inertia_ratio, remedy)
        reach = math.sqrt(INERTIA_RATIOS[1] - 1) * min(self.radii)
        allowed = f"be at most {reach:.6g} m, three times the distance of a corner from the mass centre"
        refuse_if(
            self.radius_of_gyration > reach * (1 + 1e-12),
            "radius_of_gyration",
            allowed,
            self.radius_of_gyration,
        )

    @classmethod
    def from_outline(
        cls, outline: Any, restitution: float | None = None, *, left_restitution: float | None = None
    ) -> Block:
        """Return the block whose section is a polygon of uniform density.

        The base reaches from the first to the last of the lowest corners. Mass centre and radius of gyration are those of the
        polygon. An offset below 1e-12 of the width counts as 0, and so does such a difference from the mass centre and the radius of
        gyration of a rectangle.

        Parameters
        ----------
        outline : array_like of float, shape (n, 2)
            Corners (x, y) in metres in the order of the outline, n in [3, 1000]. x points towards the edge about which the block
            turns for θ > 0, and y points up.
        restitution, left_restitution : float, optional
            As for `Block`.

        Returns
        -------
        Block
            Block with the height of the polygon and the width of its base.

        Raises
        ------
        TypeError, ValueError
            If `outline` is no such array, crosses itself, has no area or only one lowest corner, or if the centroid is not above
            the base.

        Examples
        --------
        >>> block = Block.from_outline([(0, 0), (0.6, 0), (0.4, 2.0), (0, 2.0)])
        >>> block.width, round(block.offset, 4), round(block.centre_height, 4)
        (0.6, -0.0467, 0.9333)
        """
        section = section_of(outline)
        usual = math.hypot(section.height, section.width) / math.sqrt(12.0)
        uniform = abs(section.radius_of_gyration - usual) <= SYMMETRIC * usual
        halfway = abs(section.centre_height - section.height / 2) <= SYMMETRIC * section.height
        return cls(
            section.height,
            section.width,
            restitution,
            offset=section.offset,
            centre_height=None if halfway else section.centre_height,
            radius_of_gyration=None if uniform else section.radius_of_gyration,
            left_restitution=left_restitution,
        )

    def resized(self, height: float, width: float) -> Block:
        """Return the block stretched to another height and width in metres, with its mass centre at the same place in it.

        A given coefficient of restitution or inertia ratio stays. A given radius of gyration is in proportion to the diagonal.
        Errors as for the constructor.
        """
        height, width = checked_height(height), checked_width(width)
        centre, gyration = self._centre_height, self._radius_of_gyration
        stretch = math.hypot(height, width) / math.hypot(self.height, self.width)
        return Block(
            height,
            width,
            self._restitution,
            self._inertia_ratio,
            offset=self.offset * (width / self.width),
            centre_height=None if centre is None else centre * (height / self.height),
            radius_of_gyration=None if gyration is None else gyration * stretch,
            left_restitution=self._left_restitution,
            wall=self.wall,
            restrainer=self.restrainer,
            normalised_by=self.normalised_by,
        )

    def restrained(self, stiffness: float, prestress: float = 0.0, *, mass: float) -> Block:
        """Return the block with a vertical elastic restrainer from the middle of its base to the ground.

        Parameters
        ----------
        stiffness : float
            Stiffness EA/L in N/m. κ = (EA/L) b sin θcr/(Mg), with half the width b, is below 1 for a slender block.
        prestress : float
            Force P₀ in N in the block at rest. Default: 0.
        mass : float
            Mass M of the block in kg.

        Returns
        -------
        Block
            Restrained block.

        Raises
        ------
        TypeError
            If a value is not a real number.
        ValueError
            If a value lies outside its range, if κ exceeds 1000, or if the block has an offset, unequal sides or a wall.

        Notes
        -----
        With ρ = P₀/(Mg), the slender block obeys θ'' = α²[(1 − κ)θ ∓ (1 + ρ)θcr − a], with − for θ > 0, + for θ < 0 and the base
        acceleration a in units of g. With Θ = θ(1 − κ)/((1 + ρ)θcr), τ = α√(1 − κ)t and A = a/((1 + ρ)θcr) this is Yim & Lin's
        Eq. (4), and Housner's restitution is unchanged. So everything that holds for the free slender block holds for the restrained
        one, in these units. |Θ| = 1 is the unstable balance. With κ = 1 or more there is none: no base motion of finite length
        overturns the block, and `model="slender"` refuses it.

        With the full equation, `model="full"`, θ'' = −α²[sin w + a cos w + κ sin θ + σρ sin θcr cos(θ/2)] on the side σ of θ, with
        w = σθcr − θ. The restrainer is stretched by 2b sin(|θ|/2). Units are those of the free block.

        The restrained block itself converts in the units of the free one, and the block of a system, `system.block`, in those of
        the system.

        Examples
        --------
        >>> block = Block(height=2.0, width=0.4)
        >>> restrained = block.restrained(stiffness=9e4, prestress=1200.0, mass=600.0)
        >>> round(restrained.stiffness_ratio, 4), round(restrained.prestress_ratio, 4)
        (0.5999, 0.2039)
        >>> from rocking import Pulse
        >>> pulse = Pulse("one-sine", amplitude=3.0, duration=0.5)
        >>> own = restrained.system(pulse, model="slender").block
        >>> round(float(own.degrees(1.0) / block.degrees(1.0)), 4)
        3.0095
        """
        return evolve(self, restrainer=Restrainer(stiffness, prestress, mass))

    @property
    def stiffness_ratio(self) -> float:
        """Ratio κ = (EA/L) b sin θcr/(Mg) of the stiffness of the restrainer to that of gravity; 0 without one."""
        if self.restrainer is None:
            return 0.0
        return self.restrainer.stiffness * self._lever / (self.restrainer.mass * GRAVITY)

    @property
    def stiffness_unit(self) -> float:
        """Stiffness EA/L of the restrainer in N/m with which κ would be 1; infinite without a restrainer."""
        if self.restrainer is None:
            return math.inf
        return self.restrainer.mass * GRAVITY / self._lever

    @property
    def _lever(self) -> float:
        return self.edges[0] * math.sin(self.critical_angle)

    @property
    def prestress_ratio(self) -> float:
        """Ratio ρ = P₀/(Mg) of the force of the restrainer at rest to the weight; 0 without one."""
        return (
            0.0 if self.restrainer is None else self.restrainer.prestress / (self.restrainer.mass * GRAVITY)
        )

    @property
    def by_balance(self) -> bool:
        """Flag: it converts as a slender restrained block does, by the unstable balance of small angles."""
        return self.restrainer is not None and self.normalised_by != "angle"

    @property
    def _units(self) -> RestrainedUnits:
        ratios = (self.stiffness_ratio, self.prestress_ratio) if self.by_balance else (0.0, 0.0)
        return restrained_units(*ratios)

    @property
    def angle_unit(self) -> float:
        """Unit of normalised angles in radians: θcr, in the units of a slender restrained block θcr(1 + ρ)/(1 − κ)."""
        return self.critical_angle * self._units.angle

    @property
    def rate_unit(self) -> float:
        """Inverse of the unit of time in 1/s: α, in the units of a slender restrained block α√(1 − κ)."""
        return self.frequency_parameter * self._units.rate

    @property
    def size(self) -> str:
        """Height and width as text, such as "2 m × 0.5 m", and the offset of the mass centre if there is one."""
        offset = f", offset {self.offset:g} m" if self.offset else ""
        return f"{self.height:g} m × {self.width:g} m{offset}"

    @property
    def centre_height(self) -> float:
        """Height h of the mass centre above the base, in metres."""
        return self.height / 2 if self._centre_height is None else self._centre_height

    @property
    def edges(self) -> tuple[float, float]:
        """Distances b₁ and b₂ of the edges of side 1 and side 2 from the foot of the mass centre, in metres."""
        return self.width / 2 - self.offset, self.width / 2 + self.offset

    @property
    def radii(self) -> tuple[float, float]:
        """Distances R₁ and R₂ of both corners from the mass centre, in metres."""
        first, second = self.edges
        return math.hypot(self.centre_height, first), math.hypot(self.centre_height, second)

    @property
    def critical_angles(self) -> tuple[float, float]:
        """Critical angles of side 1 and side 2, arctan(b₁/h) and arctan(b₂/h), in radians."""
        first, second = self.edges
        return math.atan2(first, self.centre_height), math.atan2(second, self.centre_height)

    @property
    def frequency_parameters(self) -> tuple[float, float]:
        """Frequency parameters of side 1 and side 2, √(gR_i/(k² + R_i²)), in 1/s."""
        second, k = self.radii[1], self.radius_of_gyration
        if self.offset == 0:
            return self.frequency_parameter, self.frequency_parameter
        return self.frequency_parameter, frequency_parameter(second, 1 + (k / second) ** 2)

    @property
    def housner_restitutions(self) -> tuple[float, float]:
        """Coefficients of restitution e₁₂ and e₂₁ that conserve the angular momentum about the corner of the impact."""
        if self.offset == 0:
            symmetric = housner_restitution(self.critical_angle, self.inertia_ratio)
            return symmetric, symmetric
        (first, second), k = self.radii, self.radius_of_gyration
        kept = k**2 + self.centre_height**2 - self.edges[0] * self.edges[1]
        return kept / (k**2 + second**2), kept / (k**2 + first**2)

    @property
    def radius(self) -> float:
        """Distance R from a corner to the centre of mass, in metres; that of side 1."""
        return self.radii[0]

    @property
    def critical_angle(self) -> float:
        """Critical angle θcr = arctan(B/H) in radians, beyond which the block overturns under its own weight; that of side 1."""
        return self.critical_angles[0]

    @property
    def inertia_ratio(self) -> float:
        """Io/(MR²), normalised moment of inertia about a corner; that of side 1."""
        if self._radius_of_gyration is not None:
            return 1 + (self._radius_of_gyration / self.radius) ** 2
        if self._inertia_ratio is not None or (self.offset == 0 and self._centre_height is None):
            return _or_rectangle(self._inertia_ratio)
        return 1 + (self.height**2 + self.width**2) / 12 / self.radius**2

    @property
    def radius_of_gyration(self) -> float:
        """Radius of gyration k about the mass centre, in metres."""
        if self._radius_of_gyration is not None:
            return self._radius_of_gyration
        return self.radius * math.sqrt(self.inertia_ratio - 1)

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter α = √(MgR/Io) in 1/s. Normalised time is τ = αt. That of side 1."""
        return frequency_parameter(self.radius, self.inertia_ratio)

    @property
    def housner_restitution(self) -> float:
        """Housner's (1963) coefficient of restitution, 1 − 2 sin²θcr/(Io/MR²); 1 − (3/2) sin²θcr for a uniform rectangle.

        For an unsymmetric block it is e₁₂, that of an impact from side 1 to side 2.
        """
        return self.housner_restitutions[0]

    @property
    def has_housner_restitution(self) -> bool:
        """True if Housner's value applies, with or without scatter."""
        return self.law.is_housner

    @property
    def law(self) -> Restitution:
        """Law of restitution; of a block against a wall that of the wall, a number."""
        return law_of(self._restitution if self.wall is None else self.wall.restitution)

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of Eq. (2), e₁₂ for an unsymmetric block: the given one, or Housner's; of a table its first."""
        return self.law.coefficient(self.housner_restitution)

    @property
    def left_restitution(self) -> float:
        """Coefficient of restitution e₂₁ of an impact from side 2 to side 1: the given value, `restitution`, or Housner's."""
        if self._left_restitution is not None and self.wall is None:
            return self._left_restitution
        return self.law.coefficient(self.housner_restitutions[1])

    @property
    def has_equal_sides(self) -> bool:
        """Flag: the block is symmetric, and its impacts do not differ by their direction."""
        return self.offset == 0 and self.left_restitution == self.restitution

    @property
    def is_unsymmetric(self) -> bool:
        """Flag: the block turns to both sides, and these differ. A block against a wall turns to one side."""
        return self.wall is None and not self.has_equal_sides

    @property
    def left(self) -> Side | None:
        """Side θ < 0 in units of side 1 if it differs, or the wall there; None for a symmetric block."""
        if self.wall is not None:
            return self.wall
        if self.has_equal_sides:
            return None
        angles, rates = self.critical_angles, self.frequency_parameters
        return LeftSide(angles[1] / angles[0], rates[1] / rates[0], self.left_restitution)

    @explained
    def system(
        self,
        base: BaseMotion | None = None,
        *,
        acceleration: float | None = None,
        acceleration_g: float | None = None,
        displacement: float | None = None,
        frequency_hz: float | None = None,
        period_s: float | None = None,
        phase: float = 0.0,
        braces: Braces | None = None,
        wall: Wall | None = None,
        vertical: GroundMotion | None = None,
        model: str | None = None,
        normalised_by: str | None = None,
    ) -> System:
        """Return the normalised system of this block on a shaking base: Eqs. (3) and (4).

        Parameters
        ----------
        base : GroundMotion or Pulse, optional
            Base motion in SI units. Without it, the base motion is harmonic and the other arguments describe it.
        acceleration, acceleration_g, displacement : float
            Amplitude of the base motion: acceleration a_x in m/s² or in units of g, or displacement d in metres.
            They are related by a_x = ω²d. Give exactly one.
        frequency_hz, period_s : float
            Frequency of the base motion in Hz, or its period in seconds. Give exactly one.
        phase : float
            Phase φ of the base acceleration a_x cos(ωt + φ), in radians, in [-1000, 1000]. Default: 0.
        braces : Braces, optional
            Braces with a normalised angle, such as `Braces(angle=block.angle(degrees=3))`. Default: no braces.
        wall : Wall, optional
            Wall on the side θ < 0, whose coefficient of restitution is that of all impacts. Default: that of the block, if any.
        vertical : GroundMotion, optional
            Vertical acceleration of the ground, positive upwards, with the step and the number of samples of the ground motion
            `base`. Default: the ground moves horizontally.
        model : {"slender", "full"}, optional
            Equation of motion: that of small angles, or the full one. Default: "full" under a ground motion or a pulse, "slender" on
            a harmonic base.
        normalised_by : {"angle", "tangent"}, optional
            Unit of the base acceleration: g θcr of Yim & Lin (1991), or g tan θcr, at which the real block lifts off. "tangent" is
            for the slender block under a ground motion or a pulse, where it is the default. Default otherwise: "angle".

        Returns
        -------
        System
            System with the block's coefficient of restitution. It knows the block, so that its results are in SI units by default.

        Raises
        ------
        TypeError
            If a value is of the wrong type, or if not exactly one of the alternatives is given.
        ValueError
            If a value lies outside its range, which is stated in the unit of the argument.

        Warns
        -----
        InputWarning
            If `base` is a vertical component: the base moves horizontally.

        Examples
        --------
        >>> Block(height=2.0, width=0.5).system(acceleration_g=0.3, frequency_hz=1.2).forcing.amplitude > 1.2
        True

        At g tan θcr the block is about to lift off.

        >>> from rocking import Pulse
        >>> pulse = Pulse("one-sine", amplitude=GRAVITY * 0.5 / 2.0, duration=0.5)
        >>> system = Block(height=2.0, width=0.5).system(pulse, model="slender")
        >>> round(system.forcing.amplitude, 12), system.normalised_by
        (1.0, 'tangent')
        """
        harmonic = {
            "acceleration": acceleration,
            "acceleration_g": acceleration_g,
            "displacement": displacement,
            "frequency_hz": frequency_hz,
            "period_s": period_s,
        }
        if model is None:
            model = "slender" if base is None else "full"
        block = self if wall is None else evolve(self, wall=wall)
        if block.left is not None and braces is not None:
            what, remedy = (
                ("with unequal sides", "or omit {offset}") if block.wall is None else ("against a wall", "")
            )
            got = Text(f"braces at {braces.angle:g}")
            raise WrongType("braces", f"be omitted for a block {what}", got, remedy)
        check_restrained_model(block, model, harmonic=base is None)
        angle = critical_angle_for(model, self.critical_angle, self.width)
        critical_angle_for(model, self.critical_angles[1], self.width)
        check_model(block.law, model)
        own = with_unit(block, unit_for(block, normalised_by, model, finite=base is not None))
        if base is None:
            refuse_if(vertical is not None, "vertical", "be omitted without a ground motion", vertical)
            return own._made(own._harmonic(**harmonic, phase=phase), braces, angle, block.law.scatter)
        values = [name for name, value in harmonic.items() if value is not None] + ["phase"] * (phase != 0.0)
        if values:
            raise WrongType(values[0], "be omitted with {base}")
        if isinstance(base, GroundMotion) and base.vertical:
            warn_of_value(vertical_sentence([base.component]))
        scales = own.acceleration(1.0), own.rate_unit
        forcing = instance("base", base, BaseMotion).normalised(*scales)
        lift = None if vertical is None else checked_vertical(base, vertical).normalised(GRAVITY, scales[1])
        scatter = block.law.scatter
        if scatter is not None and isinstance(base, GroundMotion):
            scatter = evolve(scatter, run=base.number)
        return own._made(forcing, braces, angle, scatter, lift)

    def _made(
        self,
        forcing: Forcing,
        braces: Braces | None,
        critical_angle: float | None,
        scatter: Scatter | None,
        vertical: PiecewiseLinear | None = None,
    ) -> System:
        """Return the system of the block, which it knows."""
        rows = self.law.normalised_rows(float(self.radians_per_second(1.0)))
        more: dict[str, Any] = {
            "restitution_table": rows,
            "restitution_scatter": scatter,
            "vertical": vertical,
        }
        if critical_angle is not None:
            more |= {"stiffness_ratio": self.stiffness_ratio, "prestress_ratio": self.prestress_ratio}
        return System(forcing, self.restitution, braces, critical_angle, left=self.left, block=self, **more)

    def _harmonic(
        self,
        *,
        acceleration: float | None,
        acceleration_g: float | None,
        displacement: float | None,
        frequency_hz: float | None,
        period_s: float | None,
        phase: float,
    ) -> Harmonic:
        values = exactly_one(
            acceleration=acceleration, acceleration_g=acceleration_g, displacement=displacement
        )
        frequency = self._forcing_frequency(frequency_hz, period_s)
        size, per_unit, unit = {
            "acceleration": (acceleration, 1.0, "m/s²"),
            "acceleration_g": (acceleration_g, GRAVITY, "g"),
            "displacement": (displacement, (frequency * self.rate_unit) ** 2, "m"),
        }[values]
        largest = self.acceleration(AMPLITUDE.range[1]) / per_unit
        amplitude = self.amplitude(within(values, size, 0, largest, unit) * per_unit)  # type: ignore[arg-type]
        return Harmonic(min(amplitude, AMPLITUDE.range[1]), frequency=frequency, phase=phase)

    def _forcing_frequency(self, frequency_hz: float | None, period_s: float | None) -> float:
        """Return Ω from the given one of the two; the ends of the range survive the rounding of the conversion."""
        low, high = (self.hertz(frequency) for frequency in FREQUENCY.range)
        hertz = frequency_in_hertz(frequency_hz, period_s, low, high)
        return min(max(self.frequency(hertz), FREQUENCY.range[0]), FREQUENCY.range[1])

    @property
    def acceleration_unit_g(self) -> float:
        """Base acceleration in g that is 1 if it is normalised: θcr, or tan θcr; of a slender restrained block (1 + ρ) times that."""
        return acceleration_unit_g(self.critical_angle, self.normalised_by) * self._units.acceleration

    def acceleration(self, amplitude: Any) -> Any:
        """Base acceleration a_x in m/s², from a normalised amplitude A: A g θcr or A g tan θcr, as `normalised_by` says."""
        return reals("amplitude", amplitude) * (GRAVITY * self.acceleration_unit_g)

    def amplitude(self, acceleration: Any) -> Any:
        """Normalised amplitude A from an acceleration a_x in m/s²: a_x/(g θcr) or a_x/(g tan θcr), as `normalised_by` says."""
        return reals("acceleration", acceleration) / (GRAVITY * self.acceleration_unit_g)

    def seconds(self, time: Any) -> Any:
        """Time t = τ/α in seconds, from a normalised time or period."""
        return reals("time", time) / self.rate_unit

    def time(self, seconds: Any) -> Any:
        """Normalised time τ = αt, from a time or period in seconds."""
        return reals("seconds", seconds) * self.rate_unit

    def hertz(self, frequency: Any) -> Any:
        """Frequency Ωα/2π in Hz, from a normalised angular frequency Ω."""
        return reals("frequency", frequency) * (self.rate_unit / math.tau)

    def frequency(self, hertz: Any) -> Any:
        """Normalised angular frequency Ω = ω/α, from a frequency in Hz."""
        return reals("hertz", hertz) / (self.rate_unit / math.tau)

    def radians(self, angle: Any) -> Any:
        """Angle θ = Θ θcr in radians, from a normalised angle Θ."""
        return reals("angle", angle) * self.angle_unit

    def degrees(self, angle: Any) -> Any:
        """Angle θ = Θ θcr in degrees, from a normalised angle Θ."""
        return self.radians(angle) * (180.0 / math.pi)

    def radians_per_second(self, velocity: Any) -> Any:
        """Angular velocity dθ/dt = Θ' θcr α in rad/s, from a normalised velocity Θ'."""
        return reals("velocity", velocity) * (self.angle_unit * self.rate_unit)

    def velocity(self, radians_per_second: Any) -> Any:
        """Normalised velocity Θ', from an angular velocity in rad/s."""
        return reals("radians_per_second", radians_per_second) / (self.angle_unit * self.rate_unit)

    def top_displacement(self, angle: Any) -> Any:
        """Displacement H sin θ along the base of the top corner above the pivot, in metres, from a normalised angle."""
        return self.height * np.sin(reals("angle", angle, MAX_REAL) * self.angle_unit)

    def angle(self, *, radians: Any = None, degrees: Any = None, top_displacement: Any = None) -> Any:
        """Normalised angle Θ = θ/θcr, from exactly one physical quantity.

        Parameters
        ----------
        radians, degrees : float or array
            Angle θ.
        top_displacement : float or array
            Displacement of the top corner along the base, in metres (|θ| ≤ 90°).

        Returns
        -------
        float or ndarray
            Θ, in the shape of the argument.

        Raises
        ------
        TypeError
            If not exactly one argument is given.
        ValueError
            If `top_displacement` exceeds the height.

        Examples
        --------
        >>> block = Block(height=2.0, width=0.5)
        >>> round(float(block.angle(degrees=block.degrees(0.5))), 12)
        0.5
        """
        values = exactly_one(radians=radians, degrees=degrees, top_displacement=top_displacement)
        if values == "radians":
            return reals(values, radians) / self.angle_unit
        if values == "degrees":
            return np.radians(reals(values, degrees)) / self.angle_unit
        sine = reals(values, top_displacement) / self.height
        if np.any(np.abs(sine) > 1):
            allowed = f"lie in [-{self.height:g}, {self.height:g}] m, the height"
            raise Refusal(values, allowed, top_displacement)
        return np.arcsin(sine) / self.angle_unit

    def __repr__(self) -> str:
        law = self.law
        values = f"restitution={self.restitution:.6g} " + (
            "as chosen" if law.value is not None else f"by {law.origin}"
        )
        values += "" if law.scatter is None else f" with {law.scatter}"
        if self.left_restitution != self.restitution:
            values += f", left_restitution={self.left_restitution:.6g}"
        if self._inertia_ratio not in (None, RECTANGLE):
            values += f", inertia_ratio={self.inertia_ratio:g}"
        for name in ("offset", "centre_height", "radius_of_gyration"):
            given = self.offset or None if name == "offset" else getattr(self, f"_{name}")
            values += "" if given is None else f", {name}={given:.6g} m"
        values += "" if self.wall is None else ", against a wall"
        if self.restrainer is not None:
            values += f", restrained with κ={self.stiffness_ratio:.6g}, ρ={self.prestress_ratio:.6g}"
        return f"Block(height={self.height} m, width={self.width} m, {values})"


def check_balance(block: Block) -> None:
    """Raise ValueError for a restrainer so stiff that a slender block has no unstable balance."""
    if block.restrainer is not None and block.stiffness_ratio >= 1.0:
        allowed = (
            f"be below {block.stiffness_unit:.6g} N/m, from where on a slender block has no unstable balance"
        )
        raise Refusal("stiffness", allowed, block.restrainer.stiffness, "the full {model} takes any")


def check_restrained_model(block: Block, model: str, *, harmonic: bool = False) -> None:
    """Raise ValueError for the full equation of a restrained block on a harmonic base, and for a slender one without a balance."""
    if one_of("model", model, MODELS) == "slender":
        check_balance(block)
    elif harmonic and block.restrainer is not None:
        raise Refusal("model", "be 'slender' for a restrained block on a harmonic base", model)


def unit_for(block: Block, normalised_by: str | None, model: str, *, finite: bool = True) -> str:
    """Return the units of a block for an equation of motion, after checking; those of a slender restrained one are its own."""
    chosen = normalisation_for(normalised_by, model, finite=finite)
    return "balance" if (chosen, model) == ("angle", "slender") and block.restrainer is not None else chosen


def restrainer_quantities(block: Block, model: str) -> dict[str, float]:
    """Return the ratios of a restrained block in a survey, none of a free one; ValueError for a slender one without a balance."""
    check_restrained_model(block, model)
    if block.restrainer is None:
        return {}
    return {"stiffness_ratio": block.stiffness_ratio, "prestress_ratio": block.prestress_ratio}


def symmetric_block(block: Any, name: str = "block") -> Block:
    """Return a block, after checking that it is symmetric; TypeError or ValueError, which names the argument, for anything else."""
    left = instance(name, block, Block).left
    remedy = "the formula holds for equal sides"
    got = "one against a wall" if isinstance(left, Wall) else f"one with {{offset}} {block.offset:g} m"
    refuse_if(left is not None, name, "be symmetric", Text(got), remedy)
    return unrestrained(block, name, "the formula holds without a restrainer")


def unrestrained(block: Block, name: str, reason: str) -> Block:
    """Return a block, after checking that it has no restrainer; ValueError with the reason if it has one."""
    refuse_if(block.restrainer is not None, name, "have no restrainer", Text("one"), reason)
    return block


def block_attributes(block: Block) -> dict[str, Any]:
    """Return the dimensions of a block as attributes of a file, and its unit of acceleration if it is g tan θcr."""
    by = {"normalised_by": "tangent"} if block.normalised_by == "tangent" else {}
    unsymmetric = (
        {}
        if block.offset == 0
        else {
            "block_offset_m": block.offset,
            "block_left_critical_angle_rad": block.critical_angles[1],
            "block_left_frequency_parameter_per_s": block.frequency_parameters[1],
        }
    )
    wall = {} if block.wall is None else {"block_wall_restitution": block.wall.restitution}
    restrainer = (
        {}
        if block.restrainer is None
        else {
            "block_restrainer_stiffness_n_per_m": block.restrainer.stiffness,
            "block_restrainer_prestress_n": block.restrainer.prestress,
            "block_mass_kg": block.restrainer.mass,
        }
    )
    centre = {} if block.centre_height == block.height / 2 else {"block_centre_height_m": block.centre_height}
    return {
        **by,
        "block_height_m": block.height,
        "block_width_m": block.width,
        "block_inertia_ratio": block.inertia_ratio,
        "block_critical_angle_rad": block.critical_angle,
        "block_frequency_parameter_per_s": block.frequency_parameter,
        **unsymmetric,
        **centre,
        **wall,
        **restrainer,
    }
