"""Quantities of systems, initial states and results: symbol, description, range, unit and SI counterpart, each once.

Surveys, branches, figures, files, the command line and the explorer take them from here. The help of the command line does, too:
this module loads no numerical library.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

MAX_ROUNDING = 4
"""Rounding errors by which a number differs at most that was normalised and converted back."""

Conversion = Callable[[Any, Any], Any]
"""Function of a block and of normalised values that returns values in SI units or in those of a figure."""


class SI(NamedTuple):
    """SI counterpart of a normalised quantity."""

    name: str
    """Name in SI, such as "acceleration"."""
    unit: str
    """Unit in headings of tables."""
    key: str
    """Name with unit, in JSON and datasets."""
    units: str
    """Unit in the notation of the CF conventions."""
    of: Conversion
    label: str = ""
    """Label of an axis of a figure, without its unit."""
    drawn: Conversion | None = None
    """Values in figures and on the screen: angles are in degrees there."""
    drawn_unit: str = ""
    """Unit of these values."""

    @property
    def heading(self) -> str:
        """Heading of a column of a table."""
        return f"{self.name} [{self.unit}]"


class Quantity(NamedTuple):
    """Quantity of a system, an initial state, a survey or a result."""

    name: str
    symbol: str = ""
    text: str = ""
    """Description in datasets, with the unit of a normalised quantity."""
    range: tuple[float, float] = (-math.inf, math.inf)
    unit: str = ""
    """Unit in headings of tables; "" if the quantity is a pure number."""
    units: str = "1"
    """Unit in datasets, in the notation of the CF conventions; "1" if the quantity is normalised."""
    label: str = ""
    """Label of an axis of a figure."""
    help: str = ""
    """Help of an option of the command line."""
    si: SI | None = None
    """None if the quantity is the same in SI, or has no counterpart."""

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of a variable of a dataset."""
        return {"long_name": self.text, "symbol": self.symbol, "units": self.units}

    @property
    def heading(self) -> str:
        """Heading of a column of a table."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    def checked(self, value: Any, argument: str = "", if_below: str = "") -> float:
        """Return a number in the range of the quantity; errors, which name the argument, as in `within`."""
        low, high = self.range
        if type(value) is float and low <= value <= high:
            return value  # most often: continuation makes 60,000 systems in 20 s
        from rocking.model.validation import within

        return within(argument or self.name, value, low, high, if_below=if_below)

    def axis(self, block: Any) -> tuple[Conversion, str]:
        """Return the conversion of values for a figure, and the label of their axis; normalised if `block` is None."""
        import numpy as np

        if block is None or self.si is None or self.si.drawn is None:
            return (lambda _, values: np.asarray(values)), self.label
        return self.si.drawn, f"{self.si.label} ({self.si.drawn_unit})"

    def printed(self, block: Any) -> tuple[str, Callable[[Any], Any], str]:
        """Return the name, the conversion of values and the unit of the quantity in sentences; normalised if `block` is None."""
        if block is None or self.si is None or self.si.drawn is None:
            return self.name, _same, ""
        unit = self.si.drawn_unit
        return self.si.name, partial(self.si.drawn, block), unit if unit.startswith("°") else f" {unit}"


def _same(values: Any) -> Any:
    return values


def _exact(conversion: Conversion) -> Conversion:
    """Return a conversion of a quantity that may have been typed in SI: rounding does not change 3 to 2.9999999999999996.

    A number is replaced by one with 15 digits if both agree to rounding.
    """

    def converted(block: Any, values: Any) -> Any:
        import numpy as np

        physical = np.asarray(conversion(block, values))
        distinct, places = np.unique(physical, return_inverse=True)
        short = np.array([float(f"{each:.15g}") for each in distinct.tolist()])
        with np.errstate(invalid="ignore"):
            same = np.abs(short - distinct) <= MAX_ROUNDING * np.spacing(np.abs(distinct))
        exact = np.where(same, short, distinct)[places].reshape(physical.shape)
        return exact if exact.ndim else float(exact)

    return converted


def _acceleration(block: Any, amplitude: Any) -> Any:
    return block.acceleration(amplitude)


def _hertz(block: Any, frequency: Any) -> Any:
    return block.hertz(frequency)


def _radians(block: Any, angle: Any) -> Any:
    return block.radians(angle)


def _degrees(block: Any, angle: Any) -> Any:
    return block.degrees(angle)


def _radians_per_second(block: Any, velocity: Any) -> Any:
    return block.radians_per_second(velocity)


def _degrees_per_second(block: Any, velocity: Any) -> Any:
    import numpy as np

    return np.degrees(block.radians_per_second(velocity))


def _seconds(block: Any, time: Any) -> Any:
    return block.seconds(time)


def _per_second(block: Any, rate: Any) -> Any:
    return rate * block.rate_unit


ACCELERATION = SI(
    "acceleration",
    "m/s^2",
    "acceleration_m_per_s2",
    "m s-2",
    _exact(_acceleration),
    r"amplitude $a_x$",
    _acceleration,
    "m/s²",
)
SECONDS = SI("period", "s", "period_s", "s", _exact(_seconds), "period", _seconds, "s")
HERTZ = SI("frequency", "Hz", "frequency_hz", "Hz", _exact(_hertz), "frequency", _hertz, "Hz")
RADIANS = SI("angle", "rad", "angle_rad", "rad", _radians, r"initial angle $\theta_0$", _degrees, "°")
RADIANS_PER_SECOND = SI(
    "velocity",
    "rad/s",
    "velocity_rad_per_s",
    "rad s-1",
    _radians_per_second,
    r"initial velocity $\dot\theta_0$",
    _degrees_per_second,
    "°/s",
)

LARGEST_FREQUENCY = 1e3
LARGEST_START = 1e3

AMPLITUDE = Quantity(
    "amplitude",
    "A",
    "amplitude of the base acceleration in units of g theta_cr",
    (0.0, 1e3),
    "g theta_cr",
    label=r"amplitude $A$",
    help="Amplitude A of the base acceleration, in units of g θcr.",
    si=ACCELERATION,
)
VELOCITY = Quantity(
    "velocity",
    "Θ'",
    "initial angular velocity in units of alpha theta_cr",
    (-LARGEST_START, LARGEST_START),
    "alpha theta_cr",
    label=r"initial velocity $\Theta'_0$",
    help="Initial angular velocity Θ', in units of α θcr. Default: 0.",
    si=RADIANS_PER_SECOND,
)
RESTITUTION = Quantity(
    "restitution",
    "e",
    "coefficient of restitution",
    (0.0, 1.0),
    label=r"coefficient of restitution $e$",
    help="Coefficient of restitution e.",
)
CRITICAL_ANGLE = Quantity(
    "critical_angle",
    "θcr",
    "critical angle",
    (1e-3, 1.2),
    "rad",
    "rad",
    r"critical angle $\theta_\mathrm{cr}$ (rad)",
    "Critical angle θcr of the full equation of motion, rad, with normalised input. Default: small angles.",
)
BRACE_ANGLE = Quantity(
    "brace_angle",
    "Θb",
    "angle of the braces in units of theta_cr",
    (1e-3, 1e3),
    "theta_cr",
    label=r"brace angle $\Theta_\mathrm{b}$",
    help="Brace angle Θb, in units of θcr. Default: no braces.",
    si=RADIANS._replace(name="brace_angle", key="brace_angle_rad", label=r"brace angle $\theta_\mathrm{b}$"),
)
BRACE_RESTITUTION = Quantity(
    "brace_restitution",
    "r",
    "coefficient of restitution of the braces",
    (0.0, 1.0),
    label=r"coefficient of restitution of the braces $r$",
    help="Coefficient of restitution r at a brace. Default: 1.",
)
PHASE = Quantity(
    "phase",
    "φ",
    "phase of the base acceleration",
    (-1e3, 1e3),
    "rad",
    "rad",
    r"phase $\varphi$ (rad)",
    "Phase φ of the base acceleration, rad. Default: 0.",
)
ANGLE = Quantity(
    "angle",
    "Θ",
    "initial angle in units of theta_cr",
    (-LARGEST_START, LARGEST_START),
    "theta_cr",
    label=r"initial angle $\Theta_0$",
    help="Initial angle Θ, in units of the critical angle θcr, not in degrees. Default: 0.",
    si=RADIANS,
)
FREQUENCY = Quantity(
    "frequency",
    "Ω",
    "forcing frequency in radians per normalised time",
    (1.0 / LARGEST_FREQUENCY, LARGEST_FREQUENCY),
    "alpha",
    label=r"frequency $\Omega$",
    help="Forcing frequency Ω, in units of α; replaces --period.",
    si=HERTZ,
)
PERIOD = Quantity(
    "period",
    "T",
    "forcing period in normalised time",
    (math.tau / FREQUENCY.range[1], math.tau / FREQUENCY.range[0]),
    "1/alpha",
    label=r"period $T$",
    help="Forcing period T, in units of 1/α.",
    si=SECONDS,
)
ANGLE_RATIO = Quantity(
    "angle_ratio",
    "θcr2/θcr1",
    "critical angle of the left side over that of the right one",
    (0.01, 100.0),
    label=r"ratio of the critical angles $\theta_\mathrm{cr,2}/\theta_\mathrm{cr,1}$",
    help="Critical angle of the left side, Θ < 0, over that of the right one. Default: 1.",
)
FREQUENCY_RATIO = Quantity(
    "frequency_ratio",
    "α2/α1",
    "frequency parameter of the left side over that of the right one",
    (0.1, 10.0),
    label=r"ratio of the frequency parameters $\alpha_2/\alpha_1$",
    help="Frequency parameter of the left side over that of the right one. Default: 1.",
)
LEFT_RESTITUTION = Quantity(
    "left_restitution",
    "e21",
    "coefficient of restitution of impacts that end the motion on the left side",
    (0.0, 1.0),
    label=r"coefficient of restitution of the left side $e_{21}$",
    help="Coefficient of restitution of impacts that end the motion on the left side. Default: that of all impacts.",
)
WALL_RESTITUTION = Quantity(
    "wall_restitution",
    "e_w",
    "coefficient of restitution of impacts against a wall",
    (0.0, 1.0),
    label=r"coefficient of restitution of the wall $e_\mathrm{w}$",
    help="Coefficient of restitution of impacts against a wall on the side θ < 0. Default: no wall.",
)
STIFFNESS_RATIO = Quantity(
    "stiffness_ratio", "κ", "stiffness of the restrainer over that of gravity", (0.0, 1e3)
)
PRESTRESS_RATIO = Quantity(
    "prestress_ratio", "ρ", "force of the restrainer at rest over the weight", (0.0, 1e6)
)
FRICTION = Quantity(
    "friction",
    "μ",
    "coefficient of friction",
    (1e-3, 10.0),
    label=r"coefficient of friction $\mu$",
    help="Coefficient of friction μ between block and base.",
)
LEFT_QUANTITIES = ("angle_ratio", "frequency_ratio", "left_restitution")
"""Names of the quantities of the left side of an unsymmetric block."""
SYSTEM_QUANTITIES = {
    each.name: each
    for each in (
        AMPLITUDE,
        VELOCITY,
        RESTITUTION,
        CRITICAL_ANGLE,
        BRACE_ANGLE,
        BRACE_RESTITUTION,
        PHASE,
        ANGLE,
        FREQUENCY,
        PERIOD,
        ANGLE_RATIO,
        FREQUENCY_RATIO,
        LEFT_RESTITUTION,
    )
}
"""Quantities of a system and an initial state. In a map, the first in this order is the vertical axis."""

SIZES = (1e-3, 1e3)
"""Range of a length of a block, m."""
SIZE = Quantity("size", "R", "distance from a corner to the centre of mass", SIZES, "m", "m")
SLENDERNESS = Quantity("slenderness", "θcr", "critical angle", (1e-4, 1.57), "rad", "rad")
POLARITY = Quantity("polarity", "±", "direction of the ground motion", (-1.0, 1.0))
LEVEL = Quantity("level", "s", "factor of the ground motion", (1e-9, 1e6))
RUN_QUANTITIES = {
    each.name: each
    for each in (
        *(SIZE, SLENDERNESS, RESTITUTION, ANGLE, POLARITY, LEVEL),
        *(ANGLE_RATIO, FREQUENCY_RATIO, LEFT_RESTITUTION, WALL_RESTITUTION),
        *(STIFFNESS_RATIO, PRESTRESS_RATIO),
    )
}
"""Quantities of runs under ground motions, in the order of the dimensions; records come first. The last are of blocks with a left side,
and of restrained ones."""


def _like(si: SI, name: str) -> SI:
    """Return the SI counterpart of a quantity of this name that has the unit of another one."""
    named = name.replace("amplitude", si.name) if "amplitude" in name else name
    named = f"{name}_{si.name}" if si is ACCELERATION and named == name else named
    return si._replace(name=named, key=si.key.replace(si.name, named, 1), label="")


def _turn(block: Any, acceleration: Any) -> Any:
    return acceleration * (block.radians_per_second(1.0) * block.rate_unit)


def _cycles_per_second(block: Any, frequency: Any) -> Any:
    return frequency / block.seconds(1.0)


def _square_radians(block: Any, variance: Any) -> Any:
    return variance * block.radians(1.0) ** 2


def _density(block: Any, density: Any) -> Any:
    return density * (block.radians(1.0) ** 2 * block.seconds(1.0))


TIME = SECONDS._replace(name="time", key="time_s", of=_seconds)
PER_SECOND = SI("exponent", "1/s", "exponent_per_s", "s-1", _per_second)
RESULTS: tuple[tuple[str, SI | None, tuple[str, ...]], ...] = (
    (
        "1/alpha",
        TIME,
        ("time", "event_time", "margin_time", "overturning_time", "duration", "pulse_duration", "step"),
    ),
    ("alpha", PER_SECOND, ("exponent", "exponent_error", "running_exponent", "running_exponent_error")),
    (
        "theta_cr",
        RADIANS,
        (
            *(
                "peak",
                "steady_peak",
                "branch_peak",
                "limit",
                "line_amplitude",
            ),
            *("mean_angle", "mean_angle_error"),
            *(
                "start_angle",
                "basin_start_angle",
                "final_angle",
                "event_angle",
                "orbit_angle",
                "saddle_angle",
            ),
            *("section_angle", "special_section_angle"),
        ),
    ),
    (
        "alpha theta_cr",
        RADIANS_PER_SECOND,
        (
            *(
                "margin",
                "velocity_low",
                "velocity_high",
                "velocity_range",
                "event_before",
                "event_after",
                "event_velocity",
            ),
            *(
                "start_velocity",
                "basin_start_velocity",
                "final_velocity",
                "orbit_velocity",
                "saddle_velocity",
            ),
            *("section_velocity", "special_section_velocity"),
        ),
    ),
    (
        "alpha^2 theta_cr",
        SI("acceleration", "rad/s^2", "acceleration_rad_per_s2", "rad s-2", _turn),
        ("acceleration",),
    ),
    (
        "g theta_cr",
        ACCELERATION._replace(of=_acceleration),
        ("base_acceleration",),
    ),
    (
        "g theta_cr",
        ACCELERATION,
        (
            *("resolution", "survived_up_to", "lowest_overturning_amplitude"),
            *("heteroclinic_amplitude", "melnikov_amplitude"),
        ),
    ),
    ("alpha", HERTZ._replace(of=_cycles_per_second), ("cyclic_frequency", "line_frequency")),
    ("theta_cr^2", SI("variance", "rad^2", "variance_rad2", "rad2", _square_radians), ("variance",)),
    (
        "theta_cr^2/alpha",
        SI("density", "rad^2/Hz", "density_rad2_per_hz", "rad2 Hz-1", _density),
        ("density",),
    ),
    ("rad", None, ("forcing_phase", "lowest_phase", "section_phase", "special_section_phase", "event_phase")),
    ("cycles", None, ("response_period", "orbit_period", "transient")),
)
"""Unit, SI counterpart and names of the quantities of results."""
DESCRIBED = {
    "in units of theta_cr": ("theta_cr", RADIANS),
    "in units of alpha theta_cr": ("alpha theta_cr", RADIANS_PER_SECOND),
    "in normalised time": ("1/alpha", TIME),
}
"""Unit and SI counterpart of a variable of any name by the unit in its description."""


def with_unit(name: str, unit: str, si: SI | None) -> Quantity:
    """Return the quantity of a result that has a unit in tables and an SI counterpart."""
    return Quantity(name, unit=unit, si=si and _like(si, name))


RESULT_QUANTITIES = {name: with_unit(name, unit, si) for unit, si, names in RESULTS for name in names}
"""Quantities of results, as far as they have units in tables."""
LOWEST = Quantity("lowest", unit="g theta_cr", si=_like(ACCELERATION, "lowest"))
"""Lowest amplitude that overturns; in other results a level of the intensity of ground motions."""
for _each in SYSTEM_QUANTITIES.values():
    _names = [f"{_each.name}_{_end}" for _end in ("range", "low", "high")]
    for _place in ("special", "end", "accumulation", "grazing", "branch"):
        _names += [f"{_place}_{_each.name}", f"{_place}_{_each.name}_error"]
    for _name in _names:
        _si = _each.si and _like(_each.si, _name)
        RESULT_QUANTITIES[_name] = Quantity(_name, unit=_each.unit, si=_si)

QUANTITIES = {**SYSTEM_QUANTITIES, **RUN_QUANTITIES, **RESULT_QUANTITIES}
"""All quantities by name."""
IN_SI = {
    each.name: each.si
    for each in (AMPLITUDE, PERIOD, FREQUENCY, ANGLE, VELOCITY, *QUANTITIES.values())
    if each.si is not None
}
"""SI counterparts by the name of the normalised quantity, in the order in which files hold them."""
