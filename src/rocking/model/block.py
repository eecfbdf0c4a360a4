"""Block in SI units, and conversion to and from normalised quantities: Yim & Lin (1991), Eqs. (1)–(4)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.block_formulas import (
    GRAVITY,
    Dimensions,
    frequency_in_hertz,
    frequency_parameter,
    housner_restitution,
)
from rocking.model.forcing import BaseMotion, Forcing, Harmonic
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.quantity import AMPLITUDE, FREQUENCY, RESTITUTION, SIZES
from rocking.model.system import Braces, System, critical_angle_for
from rocking.model.validation import (
    MAX_REAL,
    Refusal,
    Text,
    WrongType,
    exactly_one,
    explained,
    instance,
    reals,
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


def checked_restitution(value: float | None) -> float | None:
    """Return the coefficient of restitution, after checking."""
    return None if value is None else RESTITUTION.checked(value)


def checked_inertia_ratio(value: float) -> float:
    """Return the inertia ratio, after checking."""
    return within("inertia_ratio", value, *INERTIA_RATIOS)


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
    restitution : float, optional
        Coefficient of restitution e of Eq. (2), in [0, 1]. Default: Housner's value,
        e = 1 − 2 sin²θcr/`inertia_ratio`, which conserves the angular momentum about the corner of the impact.
    inertia_ratio : float
        Io/(MR²), normalised moment of inertia about a corner, in [1, 10]. Default: 4/3, a uniform rectangle.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range, or if Housner's coefficient of restitution is negative (a squat block) and
        `restitution` is not given.

    Warns
    -----
    InputWarning
        If the height is below 0.01 m, or if height or width exceed 100 m. Even models, bridges and towers lie between.

    Notes
    -----
    Any proportions are allowed, but the equations are those of a slender block, sin θ ≈ θ. `Motion.validity` reports
    how far a motion leaves the range of this approximation.

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
    """

    height: float = field(converter=checked_height)
    width: float = field(converter=checked_width)
    _restitution: float | None = field(default=None, converter=checked_restitution)
    inertia_ratio: float = field(default=RECTANGLE, converter=checked_inertia_ratio)

    def __attrs_post_init__(self) -> None:
        for doubt in size_warnings(self.height, self.width):
            warn_of_value(doubt)
        if self.has_housner_restitution and self.restitution < 0:
            housner = f"{self.restitution:.3g} by Housner's formula for a block {self.height:g} m high and {self.width:g} m wide"
            remedy = "are {height} and {width} swapped? If not, give {restitution}"
            raise Refusal("restitution", "lie in [0, 1]", Text(housner), remedy)

    @property
    def size(self) -> str:
        """Height and width as text, such as "2 m × 0.5 m"."""
        return f"{self.height:g} m × {self.width:g} m"

    @property
    def radius(self) -> float:
        """Distance R from a corner to the centre of mass, in metres."""
        return math.hypot(self.height, self.width) / 2

    @property
    def critical_angle(self) -> float:
        """Critical angle θcr = arctan(B/H) in radians, beyond which the block overturns under its own weight."""
        return math.atan2(self.width, self.height)

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter α = √(MgR/Io) in 1/s. Normalised time is τ = αt."""
        return frequency_parameter(self.radius, self.inertia_ratio)

    @property
    def housner_restitution(self) -> float:
        """Housner's (1963) coefficient of restitution, 1 − 2 sin²θcr/(Io/MR²); 1 − (3/2) sin²θcr for a uniform rectangle."""
        return housner_restitution(self.critical_angle, self.inertia_ratio)

    @property
    def has_housner_restitution(self) -> bool:
        """True if `restitution` was not given, so that Housner's value applies."""
        return self._restitution is None

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of Eq. (2): the given value, or Housner's."""
        return self.housner_restitution if self._restitution is None else self._restitution

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
        model: str = "slender",
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
        model : {"slender", "full"}
            Equation of motion: that of small angles, or the full one. Default: "slender".

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
        """
        harmonic = {
            "acceleration": acceleration,
            "acceleration_g": acceleration_g,
            "displacement": displacement,
            "frequency_hz": frequency_hz,
            "period_s": period_s,
        }
        angle = critical_angle_for(model, self.critical_angle, self.width)
        if base is None:
            return self._made(self._harmonic(**harmonic, phase=phase), braces, angle)
        values = [name for name, value in harmonic.items() if value is not None] + ["phase"] * (phase != 0.0)
        if values:
            raise WrongType(values[0], "be omitted with {base}")
        if isinstance(base, GroundMotion) and base.vertical:
            warn_of_value(vertical_sentence([base.component]))
        scales = self.acceleration(1.0), self.frequency_parameter
        return self._made(instance("base", base, BaseMotion).normalised(*scales), braces, angle)

    def _made(self, forcing: Forcing, braces: Braces | None, critical_angle: float | None) -> System:
        """Return the system of the block, which it knows."""
        return System(forcing, self.restitution, braces, critical_angle, block=self)

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
            "displacement": (displacement, (frequency * self.frequency_parameter) ** 2, "m"),
        }[values]
        largest = self.acceleration(AMPLITUDE.range[1]) / per_unit
        amplitude = self.amplitude(within(values, size, 0, largest, unit) * per_unit)  # type: ignore[arg-type]
        return Harmonic(min(amplitude, AMPLITUDE.range[1]), frequency=frequency, phase=phase)

    def _forcing_frequency(self, frequency_hz: float | None, period_s: float | None) -> float:
        """Return Ω from the given one of the two; the ends of the range survive the rounding of the conversion."""
        low, high = (self.hertz(frequency) for frequency in FREQUENCY.range)
        hertz = frequency_in_hertz(frequency_hz, period_s, low, high)
        return min(max(self.frequency(hertz), FREQUENCY.range[0]), FREQUENCY.range[1])

    def acceleration(self, amplitude: Any) -> Any:
        """Base acceleration a_x = A g θcr in m/s², from a normalised amplitude A."""
        return reals("amplitude", amplitude) * (GRAVITY * self.critical_angle)

    def amplitude(self, acceleration: Any) -> Any:
        """Normalised amplitude A = a_x/(g θcr), from an acceleration in m/s²."""
        return reals("acceleration", acceleration) / (GRAVITY * self.critical_angle)

    def seconds(self, time: Any) -> Any:
        """Time t = τ/α in seconds, from a normalised time or period."""
        return reals("time", time) / self.frequency_parameter

    def time(self, seconds: Any) -> Any:
        """Normalised time τ = αt, from a time or period in seconds."""
        return reals("seconds", seconds) * self.frequency_parameter

    def hertz(self, frequency: Any) -> Any:
        """Frequency Ωα/2π in Hz, from a normalised angular frequency Ω."""
        return reals("frequency", frequency) * (self.frequency_parameter / math.tau)

    def frequency(self, hertz: Any) -> Any:
        """Normalised angular frequency Ω = ω/α, from a frequency in Hz."""
        return reals("hertz", hertz) / (self.frequency_parameter / math.tau)

    def radians(self, angle: Any) -> Any:
        """Angle θ = Θ θcr in radians, from a normalised angle Θ."""
        return reals("angle", angle) * self.critical_angle

    def degrees(self, angle: Any) -> Any:
        """Angle θ = Θ θcr in degrees, from a normalised angle Θ."""
        return self.radians(angle) * (180.0 / math.pi)

    def radians_per_second(self, velocity: Any) -> Any:
        """Angular velocity dθ/dt = Θ' θcr α in rad/s, from a normalised velocity Θ'."""
        return reals("velocity", velocity) * (self.critical_angle * self.frequency_parameter)

    def velocity(self, radians_per_second: Any) -> Any:
        """Normalised velocity Θ', from an angular velocity in rad/s."""
        return reals("radians_per_second", radians_per_second) / (
            self.critical_angle * self.frequency_parameter
        )

    def top_displacement(self, angle: Any) -> Any:
        """Displacement H sin θ along the base of the top corner above the pivot, in metres, from a normalised angle."""
        return self.height * np.sin(reals("angle", angle, MAX_REAL) * self.critical_angle)

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
            return reals(values, radians) / self.critical_angle
        if values == "degrees":
            return np.radians(reals(values, degrees)) / self.critical_angle
        sine = reals(values, top_displacement) / self.height
        if np.any(np.abs(sine) > 1):
            allowed = f"lie in [-{self.height:g}, {self.height:g}] m, the height"
            raise Refusal(values, allowed, top_displacement)
        return np.arcsin(sine) / self.critical_angle

    def __repr__(self) -> str:
        origin = "by Housner's formula" if self.has_housner_restitution else "as chosen"
        inertia = "" if self.inertia_ratio == RECTANGLE else f", inertia_ratio={self.inertia_ratio:g}"
        return (
            f"Block(height={self.height} m, width={self.width} m, "
            f"restitution={self.restitution:.6g} {origin}{inertia})"
        )


def block_attributes(block: Block) -> dict[str, float]:
    """Return the dimensions of a block as attributes of a file."""
    return {
        "block_height_m": block.height,
        "block_width_m": block.width,
        "block_inertia_ratio": block.inertia_ratio,
        "block_critical_angle_rad": block.critical_angle,
        "block_frequency_parameter_per_s": block.frequency_parameter,
    }
