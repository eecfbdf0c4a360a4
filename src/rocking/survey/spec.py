"""Specification of a survey: axes of the varying quantities, values of the others, and the systems or runs at points.

There is one for blocks on a harmonic base, one for blocks under ground motions, and one for blocks under a pulse.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np
from attrs import evolve, field, fields, frozen

from rocking.kernels.forcing import parameters as numbers
from rocking.model.block import INERTIA_RATIOS, RECTANGLE, Block
from rocking.model.block_formulas import GRAVITY, frequency_parameter, housner_restitution
from rocking.model.forcing import SINES, Pulse
from rocking.model.ground_motion import GroundMotion
from rocking.model.quantity import CRITICAL_ANGLE, RUN_QUANTITIES, SYSTEM_QUANTITIES
from rocking.model.record_set import Intensity, RecordSet, intensity_of
from rocking.model.system import (
    MODELS,
    NO_BRACES,
    State,
    System,
    check_below_flat,
    check_between,
    check_constant_restitution,
    check_periodic,
    quantities,
)
from rocking.model.text import formatted
from rocking.model.validation import (
    Incomplete,
    Refusal,
    Text,
    WrongType,
    exactly_one,
    instance,
    number,
    one_of,
    reals,
    refuse_if,
    within,
)

Values = Mapping[str, np.ndarray]
Spec = TypeVar("Spec", bound="SurveySpec")
Motions = TypeVar("Motions", bound="MotionSpec")


@frozen(eq=False)
class SurveySpec:
    """Axes of a survey by name, in the order of its dimensions, and the values of the other quantities: base class."""

    comment: ClassVar[str] = ""
    contiguous: ClassVar[bool] = False
    """Flag: the points of a batch are neighbours, because neighbours share some of the work."""

    in_a_tile: ClassVar[int] = 1 << 16
    """Largest number of points of a tile, the part of a survey that an interrupted run keeps or loses."""

    numbers: ClassVar[dict[str, str]] = {}
    """Descriptions of the axes that are numbers of something, by name."""

    axes: dict[str, np.ndarray]
    fixed: dict[str, float] = field(factory=dict)
    stated: dict[str, Any] = field(factory=dict, kw_only=True)
    """Further values that the results depend on, by name."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def points(self) -> int:
        """Total number of points."""
        return math.prod(self.shape)

    @property
    def refines(self) -> bool:
        """Flag: a result does not depend on the spacing, so that a store has coarser levels and can be refined."""
        return True

    def with_axes(self: Spec, axes: dict[str, np.ndarray]) -> Spec:
        """Return the survey over other axes of the same names, such as those of a tile."""
        return evolve(self, axes=axes)

    @property
    def full(self) -> bool:
        """Flag: the blocks follow the full equation of motion."""
        return "critical_angle" in self.axes or "critical_angle" in self.fixed

    def inputs(self, values: Values) -> Any:
        """Return the inputs of a measurement at n points, from the values (n,) of the varying quantities."""
        raise NotImplementedError

    def arguments(self, values: Values) -> dict[str, np.ndarray]:
        """Return the values (n,) of all quantities at n points."""
        count = next(iter(values.values())).size
        return {name: np.full(count, value) for name, value in self.fixed.items()} | dict(values)

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, in the order of the dataset attributes."""
        raise NotImplementedError

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        return {"long_name": self.numbers[name]} if name in self.numbers else coordinate(name)


def axis(name: str, values: Any, span: tuple[float, float]) -> np.ndarray:
    """Check an axis: two or more finite numbers in range, ascending; raises TypeError or ValueError."""
    low, high = span
    allowed = f"hold two numbers or more in [{low:.6g}, {high:.6g}], ascending"
    try:
        array = np.asarray(reals(name, values))
    except TypeError:
        raise WrongType(name, allowed, values) from None
    if array.ndim != 1 or array.size < 2:
        got = "an empty array" if array.size == 0 else f"an array of shape {array.shape}"
        remedy = "a quantity that does not vary is no axis" if array.size == 1 else ""
        raise Refusal(name, allowed, Text(got), remedy)
    inside = (array >= low) & (array <= high)
    if not inside.all():
        where = int(np.argmin(inside))
        raise Refusal(name, allowed, Text(f"{formatted(array[where])} at index {where}"))
    rising = np.diff(array) > 0
    if not rising.all():
        where = int(np.argmin(rising))
        got = f"{formatted(array[where])} before {formatted(array[where + 1])} at index {where + 1}"
        raise Refusal(name, allowed, Text(got))
    return array + 0.0  # no negative zeros


def number_or_axis(name: str, value: Any, span: tuple[float, float]) -> float | np.ndarray:
    """Check a number or an axis of one quantity, in a range; raises TypeError or ValueError."""
    if is_axis(value):
        return axis(name, value, span)
    if isinstance(value, str):
        low, high = span
        remedy = "an axis is an array, such as np.linspace(start, stop, count)"
        raise WrongType(name, f"be a real number in [{low:.6g}, {high:.6g}] or an array", value, remedy)
    return within(name, value, *span)


def is_axis(value: Any) -> bool:
    """Return whether a value is a sequence or an array, not a number."""
    return (isinstance(value, Sequence) and not isinstance(value, str | bytes)) or getattr(
        value, "ndim", 0
    ) > 0


SYSTEM = (
    "amplitude",
    "frequency",
    "period",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
)
START = ("angle", "velocity")


class Points(NamedTuple):
    """Systems and initial states of points, as arrays for the kernels."""

    systems: np.ndarray  # (n, 8), SYSTEM, as `kernels.forcing.parameters.parameters_of_row` takes it
    starts: np.ndarray  # (n, 2), START

    @property
    def lossless(self) -> np.ndarray:
        """Mask of the undamped points (e = 1)."""
        return np.asarray(self.systems[:, SYSTEM.index("restitution")] == 1.0)


@frozen(eq=False)
class HarmonicSpec(SurveySpec):
    """Survey of systems with a harmonic base motion.

    `brace_angle` and `brace_restitution` are absent without braces; either `period` or `frequency` is present.
    """

    comment = (
        "Attributes and coordinates are normalised as in Yim & Lin (1991), Eqs. (1)-(4); "
        "the base acceleration is amplitude cos(frequency time + phase)."
    )

    def inputs(self, values: Values) -> Points:
        """Return the systems and initial states of n points."""
        return points(values, self.fixed)

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, in the order of the dataset attributes."""
        return {name: self.fixed[name] for name in SYSTEM_QUANTITIES if name in self.fixed} | self.stated


def coordinate(name: str) -> dict[str, str]:
    """Return the attributes of a coordinate."""
    return SYSTEM_QUANTITIES[name].attributes


FORCING_TIMES = {"period", "frequency"}


def harmonic_spec(fixed: Mapping[str, float], axes: Mapping[str, Any], count: int, what: str) -> HarmonicSpec:
    """Return the survey over `count` axes; the other ones of `axes` are None, and their values are the `fixed` ones.

    `what` names the survey in messages.

    Raises
    ------
    TypeError
        If an axis has the wrong type, or if the number of axes is not `count`.
    ValueError
        If a value lies outside its range.
    """
    all_vary = len(axes) == count
    checked = {
        name: quantity_axis(name, axes[name], "" if all_vary else _owner(name))
        for name in SYSTEM_QUANTITIES
        if axes.get(name) is not None
    }
    if len(checked) != count:
        remedy = "the others are those of the system" if len(checked) > count else ""
        got = " and ".join(f"{{{name}}}" for name in checked) or "none"
        raise Incomplete(what, _counted(count), Text(got), remedy)
    if checked.keys() >= FORCING_TIMES:
        exactly_one(period=axes["period"], frequency=axes["frequency"])
    replaced = checked.keys() | (FORCING_TIMES if FORCING_TIMES & checked.keys() else set())
    kept = {name: value for name, value in fixed.items() if name not in replaced}
    if "brace_angle" in checked and "brace_restitution" not in checked:
        kept.setdefault("brace_restitution", 1.0)
    elif "brace_restitution" in checked and "brace_angle" not in checked | kept:
        raise WrongType(
            "brace_restitution", "be used with {brace_angle} or a braced system", axes["brace_restitution"]
        )
    spec = HarmonicSpec(checked, kept)
    _check_braces(spec)
    return spec


def system_quantities(system: System) -> dict[str, float]:
    """Return the quantities of a system on a harmonic base; of period and frequency, the one that its forcing was made from."""
    time, value = instance("system", system, System).periodic.given
    return {time: value} | {name: each for name, each in by_period(system).items() if name != "period"}


def fixed_start(start: State | None) -> dict[str, float]:
    """Return angle and velocity of an initial state, by default at rest."""
    start = State() if start is None else instance("start", start, State)
    return {name: SYSTEM_QUANTITIES[name].checked(getattr(start, name)) for name in START}


def _owner(name: str) -> str:
    return "the initial state" if name in START else "the system"


def quantity_axis(name: str, values: Any, owner: str = "") -> np.ndarray:
    """Check an axis of one quantity; `owner` is what has its value if it does not vary, "" if it always varies."""
    low, high = SYSTEM_QUANTITIES[name].range
    if not is_axis(values):
        rule = f"be an axis, an ascending array in [{low:.6g}, {high:.6g}]"
        is_number = owner and number(values) is not None
        remedy = f"a number is that of {owner}" if is_number else "such as np.linspace(start, stop, count)"
        raise WrongType(name, rule, values, remedy)
    return axis(name, values, (low, high))


def check_one_block(block: Block, levels: Any, angle: Any) -> None:
    """Check the arguments of a survey of one block: an array of levels, and one angle; raises TypeError."""
    instance("block", block, Block)
    if is_axis(angle):
        raise WrongType("angle", "be one number", angle)
    if not is_axis(levels):
        remedy = "such as np.linspace(1, 10, 19)"
        raise WrongType("levels", "be an array of levels, ascending", levels, remedy)


def checked_polarity(polarity: Any, *, one: bool = False) -> float | np.ndarray:
    """Check a polarity, one number or both; raises TypeError or ValueError."""
    allowed = "be 1 or -1" if one else "be 1, -1 or [-1, 1]"
    try:
        values = reals("polarity", polarity)
    except TypeError:
        raise WrongType("polarity", allowed, polarity) from None
    both = not one and np.array_equal(values, [-1.0, 1.0])
    if not both and (np.ndim(values) > 0 or abs(values) != 1.0):
        raise Refusal("polarity", allowed, polarity)
    return values


def _counted(count: int) -> str:
    words = {1: "one quantity as an array", 2: "two quantities as arrays"}
    return words.get(count, f"{count} quantities as arrays")


def _check_braces(spec: HarmonicSpec) -> None:
    """Raise ValueError for initial angles beyond the braces, or for braces at which a block lies flat."""
    if "brace_angle" not in spec.axes and "brace_angle" not in spec.fixed:
        return
    if spec.full:
        check_below_flat(max(_values(spec, "brace_angle")), max(_values(spec, "critical_angle")))
    check_between(max(_values(spec, "angle"), key=abs), min(_values(spec, "brace_angle")))


def _values(spec: HarmonicSpec, name: str) -> list[float]:
    return spec.axes[name].tolist() if name in spec.axes else [spec.fixed.get(name, 0.0)]


def points(values: Values, fixed: Mapping[str, float]) -> Points:
    """Return the systems and initial states of n points, with the same rounding as `System` and `State`.

    Each of the `values` has the shape (n,).
    """
    count = next(iter(values.values())).size
    usual = {"phase": 0.0, **NO_BRACES, "critical_angle": 0.0, "angle": 0.0, "velocity": 0.0}
    constants = usual | dict(fixed)
    arguments = {name: np.broadcast_to(value, count) for name, value in constants.items()} | dict(values)
    if "frequency" in arguments:
        arguments["period"] = math.tau / arguments["frequency"]
    else:
        arguments["frequency"] = math.tau / arguments["period"]
    arguments["phase"] = _within_a_turn(arguments["phase"])
    return Points(
        np.stack([arguments[name] for name in SYSTEM], axis=1),
        np.stack([arguments[name] for name in START], axis=1),
    )


def _within_a_turn(phases: np.ndarray) -> np.ndarray:
    if np.abs(phases).max(initial=0.0) <= math.pi:
        return phases
    distinct, places = np.unique(phases, return_inverse=True)
    return np.array([numbers.within_a_turn(phase) for phase in distinct.tolist()])[places]


SLENDERNESSES = 1e-4, 1.57
"""Range of the critical angle, rad."""


class Runs(NamedTuple):
    """Runs at n points, each an array (n,), and the motions by their number."""

    motions: Mapping[int, GroundMotion]
    record: np.ndarray
    frequency_parameter: np.ndarray  # α, 1/s
    factor: np.ndarray  # of the motion, in 1/(g θcr): what makes it a normalised base acceleration
    restitution: np.ndarray
    angle: np.ndarray
    slenderness: np.ndarray
    full: bool  # whether the blocks follow the full equation of motion


@frozen(eq=False)
class MotionSpec(SurveySpec):
    """Survey of blocks under ground motions.

    The axis `record` holds the numbers of the records. Without `restitution`, it is Housner's. `level` is a level of the
    intensity measure.
    """

    comment = "A peak is in units of the critical angle; impacts of chattering sequences do not count."
    contiguous = True
    numbers: ClassVar[dict[str, str]] = {"record": "number of the record, from 0"}

    motions: dict[int, GroundMotion] = field(factory=dict)
    intensities: dict[int, float] = field(factory=dict)
    measure: Intensity = field(kw_only=True)
    digest: str = field(kw_only=True)
    model: str = field(kw_only=True)

    @property
    def full(self) -> bool:
        """Flag: the blocks follow the full equation of motion."""
        return self.model == "full"

    def extended(
        self, kind: type[Motions], further: Mapping[str, np.ndarray] | None = None, **more: Any
    ) -> Motions:
        """Return the survey as one of a subclass, with the fields `more`, and with further axes before the levels."""
        own = {each.name: getattr(self, each.name) for each in fields(MotionSpec)}
        level = {"level": self.axes["level"]} if "level" in self.axes else {}
        others = {name: values for name, values in self.axes.items() if name not in level}
        return kind(**{**own, "axes": {**others, **(further or {}), **level}, **more})

    def with_axes(self: Motions, axes: dict[str, np.ndarray]) -> Motions:
        """Return the survey over other axes of the same names, with the motions of these axes alone."""
        numbers = axes["record"].astype(int).tolist() if "record" in axes else list(self.motions)
        return evolve(
            self,
            axes=axes,
            motions={number: self.motions[number] for number in numbers},
            intensities={number: self.intensities[number] for number in numbers},
        )

    def inputs(self, values: Values) -> Runs:
        """Return the runs at n points."""
        arguments = self.arguments(values)
        record = np.asarray(arguments["record"], dtype=np.int64)
        ratio, slenderness = self.fixed["inertia_ratio"], arguments["slenderness"]
        alpha = _each(frequency_parameter, arguments["size"], ratio)
        restitution = arguments.get("restitution")
        if restitution is None:
            restitution = _each(housner_restitution, slenderness, ratio)
        own = np.array([self.intensities[number] for number in record.tolist()])
        factor = self.measure.factor(arguments["level"], own, alpha, slenderness)
        return Runs(
            self.motions,
            record,
            alpha,
            factor * arguments["polarity"] / (GRAVITY * slenderness),
            restitution,
            arguments["angle"],
            slenderness,
            self.full,
        )

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, and the digest of the records."""
        fixed = {name: self.fixed[name] for name in (*RUN_QUANTITIES, "inertia_ratio") if name in self.fixed}
        own = {"model": self.model, "intensity": self.measure.name, "records_sha256": self.digest}
        return fixed | own | self.stated

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        if name == "level":
            return {
                "long_name": self.measure.long_name,
                "symbol": self.measure.symbol,
                "units": self.measure.unit,
            }
        return super().coordinate(name) if name in self.numbers else RUN_QUANTITIES[name].attributes


def motion_spec(
    records: RecordSet,
    arguments: Mapping[str, Any],
    *,
    intensity: str,
    model: str = "slender",
    inertia_ratio: float = RECTANGLE,
    one_run: bool = False,
) -> MotionSpec:
    """Check the quantities of a survey of ground motions: arrays are axes, and the others are numbers or None.

    With ``one_run``, nothing needs to vary.

    Raises
    ------
    TypeError, ValueError
        If a quantity is missing, of the wrong type or outside its range, or if none varies. Also if a block is too squat for
        Housner's restitution.
    """
    model = one_of("model", model, MODELS)
    spans = {name: each.range for name, each in RUN_QUANTITIES.items()}
    if model == "full":
        spans["slenderness"] = CRITICAL_ANGLE.range
    checked: dict[str, Any] = {
        name: checked_polarity(arguments.get(name))
        if name == "polarity"
        else number_or_axis("levels" if name == "level" else name, arguments.get(name), span)
        for name, span in spans.items()
        if arguments.get(name) is not None or name != "restitution"
    }
    axes = {name: value for name, value in checked.items() if isinstance(value, np.ndarray)}
    fixed = {name: value for name, value in checked.items() if name not in axes}
    fixed["inertia_ratio"] = within("inertia_ratio", inertia_ratio, *INERTIA_RATIOS)
    if "restitution" not in checked:
        squattest = float(np.max(checked["slenderness"]))
        if housner_restitution(squattest, fixed["inertia_ratio"]) < 0.0:
            allowed = "be a critical angle in rad for which Housner's restitution is not negative"
            raise Refusal("slenderness", allowed, squattest, "or give {restitution}")
    measure, values = intensity_of(intensity, records)
    if len(records) > 1 or (one_run and not axes):
        axes = {"record": np.arange(float(len(records)))} | axes
    else:
        fixed["record"] = 0.0
    if not axes:
        allowed = "be an array if nothing else varies and there is one record"
        raise Refusal("size", allowed, checked["size"], "rk.simulate follows one motion")
    return MotionSpec(
        axes,
        fixed,
        dict(enumerate(records)),
        dict(enumerate(values.tolist())),
        measure=measure,
        digest=records.digest,
        model=model,
    )


def _each(formula: Any, values: np.ndarray, inertia_ratio: float) -> np.ndarray:
    """Apply a formula for one block to many, with the rounding of the formula."""
    distinct, places = np.unique(values, return_inverse=True)
    return np.array([formula(value, inertia_ratio) for value in distinct.tolist()])[places]


class Pulses(NamedTuple):
    """Pulses at n points, each an array (n,)."""

    kind: str
    amplitude: np.ndarray
    duration: np.ndarray
    restitution: np.ndarray
    critical_angle: np.ndarray  # rad
    full: bool  # whether the blocks follow the full equation of motion


def turns(kind: str) -> float:
    """Return the periods 2π/Ω in the duration of a pulse: a half for the half-sine, one for the others."""
    return SINES[kind].turns if kind in SINES else 1.0


@frozen(eq=False)
class PulseSpec(SurveySpec):
    """Survey of blocks at rest under one pulse of a kind."""

    comment = "A peak is in units of the critical angle; impacts of chattering sequences do not count."

    kind: str = field(kw_only=True)

    def inputs(self, values: Values) -> Pulses:
        """Return the pulses at n points."""
        arguments = self.arguments(values)
        duration = turns(self.kind) * math.tau / arguments["frequency"]
        angle = arguments["critical_angle"] if self.full else np.zeros(duration.size)
        return Pulses(self.kind, arguments["amplitude"], duration, arguments["restitution"], angle, self.full)

    def described(self) -> dict[str, Any]:
        """Return the kind of the pulse and the quantities that do not vary, by name."""
        return {"pulse": self.kind} | self.fixed | self.stated


def pulse_spec(system: System, axes: Mapping[str, Any]) -> PulseSpec:
    """Return the survey of a block under one pulse over `axes`, of which restitution and critical angle may be None.

    Raises
    ------
    TypeError, ValueError
        If the base motion is no pulse, if there are braces, or if an axis is of the wrong type or outside its range.
    """
    forcing = instance("system", system, System).forcing
    if not isinstance(forcing, Pulse):
        raise WrongType("system", "have a pulse as base motion, rk.Pulse", Text(type(forcing).__name__))
    refuse_if(system.braces is not None, "system", "have no braces for this survey", system)
    check_constant_restitution(system)
    own = {"restitution": system.restitution}
    if system.critical_angle is not None:
        own["critical_angle"] = system.critical_angle
    required = {"amplitude", "frequency"}
    named = [name for name in axes if axes[name] is not None or name in required]
    checked = {
        name: quantity_axis(name, axes[name], "" if name in required else "the system") for name in named
    }
    return PulseSpec(checked, {name: own[name] for name in own if name not in checked}, kind=forcing.kind)


def by_period(system: System) -> dict[str, float]:
    """Return the quantities of a system on a harmonic base: its period but not its frequency."""
    check_periodic(system, None)
    check_constant_restitution(system)
    return {name: value for name, value in quantities(system).items() if name != "frequency"}
