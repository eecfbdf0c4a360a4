"""Specification of a survey: axes of the varying quantities, values of the others, and the systems or runs at points.

There is one for blocks on a harmonic base, one for blocks under ground motions, and one for blocks under a pulse.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np
from attrs import evolve, field, fields, frozen

from rocking.kernels import system as numbers
from rocking.model.block import INERTIA_RATIOS, RECTANGLE, Block, unit_for
from rocking.model.block_formulas import (
    GRAVITY,
    acceleration_unit_g,
    frequency_parameter,
    housner_restitution,
    with_unit,
)
from rocking.model.forcing import SINES, Pulse
from rocking.model.ground_motion import GroundMotion
from rocking.model.quantity import CRITICAL_ANGLE, LEFT_QUANTITIES, RUN_QUANTITIES, SYSTEM_QUANTITIES
from rocking.model.record_set import Intensity, RecordSet, intensity_of
from rocking.model.restitution import Restitution, Scatter, check_model, check_uniform, scatter_attributes
from rocking.model.restrainer import RestrainedUnits, restrained_units
from rocking.model.system import (
    MODELS,
    NO_BRACES,
    State,
    System,
    check_below_flat,
    check_between,
    check_periodic,
    left_quantities,
    normalisation_for,
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
HOUSNER = Restitution()
Spec = TypeVar("Spec", bound="SurveySpec")
Motions = TypeVar("Motions", bound="MotionSpec")


@frozen(eq=False)
class SurveySpec:
    """Axes of a survey by name, in the order of its dimensions, and the values of the other quantities: base class."""

    comment: ClassVar[str] = ""
    contiguous: ClassVar[bool] = False
    """Flag: the points of a batch are neighbours, because neighbours share some of the work."""

    in_a_tile: ClassVar[int | None] = 1 << 16
    """Largest number of points of a tile, the part of a survey that an interrupted run keeps or loses.

    None: all points, which depend on one another.
    """

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
        return self.in_a_tile is not None

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
    "angle_ratio",
    "frequency_ratio",
    "left_restitution",
)
START = ("angle", "velocity")


class Points(NamedTuple):
    """Systems and initial states of points, as arrays for the kernels."""

    systems: np.ndarray  # (n, 11), SYSTEM, as `kernels.system.parameters_of_row` takes it
    starts: np.ndarray  # (n, 2), START
    law: np.ndarray = numbers.NO_LAW  # (m, 2), rows of the coefficient of restitution over the speed

    @property
    def lossless(self) -> np.ndarray:
        """Mask of the undamped points (e = 1 on both sides)."""
        columns = [SYSTEM.index("restitution"), SYSTEM.index("left_restitution")]
        return np.asarray((self.systems[:, columns] == 1.0).all(axis=1))


@frozen(eq=False)
class HarmonicSpec(SurveySpec):
    """Survey of systems with a harmonic base motion.

    `brace_angle` and `brace_restitution` are absent without braces; either `period` or `frequency` is present.
    """

    comment = (
        "Attributes and coordinates are normalised as in Yim & Lin (1991), Eqs. (1)-(4); "
        "the base acceleration is amplitude cos(frequency time + phase)."
    )

    @property
    def has_tangency(self) -> bool:
        """Flag: A* and A_M have closed forms, as for a slender, symmetric block without braces."""
        others = {"brace_angle", "critical_angle", "angle_ratio"}
        return not others & (self.axes.keys() | self.fixed.keys())

    def inputs(self, values: Values) -> Points:
        """Return the systems and initial states of n points."""
        return points(values, self.fixed)

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, in the order of the dataset attributes."""
        own = {name: self.fixed[name] for name in SYSTEM_QUANTITIES if name in self.fixed}
        return own | table_attributes(rows_in(self.fixed)) | self.stated


TABLE = "restitution_table"
"""Name of the rows of the restitution over the speed, among the quantities that do not vary."""


def rows_in(fixed: Mapping[str, Any]) -> tuple[tuple[float, float], ...]:
    """Return the rows of the restitution over the speed, among quantities that do not vary."""
    return fixed.get(TABLE, ())


def table_attributes(rows: Sequence[tuple[float, float]]) -> dict[str, Any]:
    """Return what a dataset states of a table: one list, speed and coefficient in turn."""
    return {TABLE: [number for row in rows for number in row]} if rows else {}


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
    for name in {"brace_angle", "brace_restitution"} & checked.keys():
        refuse_if("angle_ratio" in fixed, name, "be omitted for an unsymmetric block", Text("an axis"))
    if "restitution" in checked:
        check_uniform(rows_in(fixed), f"an axis of {what}")
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


WORSE = "worse"
POLARITIES = {"+": 1.0, "-": -1.0, "both": np.array([-1.0, 1.0]), WORSE: WORSE}
"""Polarities by their names: as recorded, reversed, both as an axis, and of both runs the one that is worse for the block."""


def checked_polarity(polarity: Any) -> Any:
    """Return a polarity as a number, an axis of both, or `WORSE`; TypeError or ValueError for anything else."""
    allowed = 'be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]'
    if isinstance(polarity, str):
        refuse_if(polarity not in POLARITIES, "polarity", allowed, polarity)
        return POLARITIES[polarity]
    try:
        values = reals("polarity", polarity)
    except TypeError:
        raise WrongType("polarity", allowed, polarity) from None
    both = np.array_equal(values, [-1.0, 1.0])
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
    usual |= {"angle_ratio": 1.0, "frequency_ratio": 1.0}
    constants = usual | dict(fixed)
    rows = rows_in(constants)
    constants.pop(TABLE, None)
    arguments = {name: np.broadcast_to(value, count) for name, value in constants.items()} | dict(values)
    if "frequency" in arguments:
        arguments["period"] = math.tau / arguments["frequency"]
    else:
        arguments["frequency"] = math.tau / arguments["period"]
    arguments["phase"] = _within_a_turn(arguments["phase"])
    law = numbers.NO_LAW
    if rows:
        law = np.array(((0.0, float(arguments["restitution"][0])), *rows))
        arguments["restitution"] = np.full(count, law[:, 1].max())
    arguments.setdefault("left_restitution", arguments["restitution"])
    return Points(
        np.stack([arguments[name] for name in SYSTEM], axis=1),
        np.stack([arguments[name] for name in START], axis=1),
        law,
    )


def _within_a_turn(phases: np.ndarray) -> np.ndarray:
    if np.abs(phases).max(initial=0.0) <= math.pi:
        return phases
    distinct, places = np.unique(phases, return_inverse=True)
    return np.array([numbers.within_a_turn(phase) for phase in distinct.tolist()])[places]


OPTIONAL = ("restitution", *LEFT_QUANTITIES, "wall_restitution", "stiffness_ratio", "prestress_ratio")
"""Quantities of runs that may be omitted."""
SLENDERNESSES = 1e-4, 1.57
"""Range of the critical angle, rad."""


class Left(NamedTuple):
    """Left sides of the blocks at n points, each an array (n,)."""

    angle_ratio: np.ndarray
    frequency_ratio: np.ndarray
    left_restitution: np.ndarray
    unequal: bool  # whether the sides of the blocks differ


def left_of(arguments: Values, restitution: np.ndarray) -> Left:
    """Return the left sides at points; those of symmetric blocks without ratios, and of walls with infinite ones."""
    if "wall_restitution" in arguments:
        return Left(np.full(restitution.size, math.inf), np.ones(restitution.size), restitution, True)
    if "angle_ratio" not in arguments:
        return Left(np.ones(restitution.size), np.ones(restitution.size), restitution, False)
    angle, frequency, left_restitution = (arguments[name] for name in LEFT_QUANTITIES)
    return Left(angle, frequency, left_restitution, True)


class Ratios(NamedTuple):
    """Ratios κ and ρ of the restrainer of full blocks; 0 without it."""

    stiffness: float
    prestress: float


UNRESTRAINED = Ratios(0.0, 0.0)


def ratios_of(fixed: Mapping[str, float]) -> Ratios:
    """Return the ratios among the fixed quantities of a survey."""
    return Ratios(fixed.get("stiffness_ratio", 0.0), fixed.get("prestress_ratio", 0.0))


class Runs(NamedTuple):
    """Runs at n points, each an array (n,), and the motions by their number."""

    motions: Mapping[int, GroundMotion]
    record: np.ndarray
    frequency_parameter: np.ndarray  # α, 1/s
    factor: (
        np.ndarray
    )  # of the motion, in 1/(g θcr) or 1/(g tan θcr): what makes it a normalised base acceleration
    restitution: np.ndarray
    angle: np.ndarray
    slenderness: np.ndarray
    full: bool  # whether the blocks follow the full equation of motion
    worse: bool  # whether a run is the worse one of the motion and its reverse
    left: Left
    law: Restitution
    speed_unit: np.ndarray  # rad/s, of a normalised velocity
    stream: np.ndarray  # number of the sequence of deviations of the restitution
    restrainer: Ratios


@frozen(eq=False)
class MotionSpec(SurveySpec):
    """Survey of blocks under ground motions.

    The axis `record` holds the numbers of the records. Without `restitution`, it is Housner's. `level` is a level of the
    intensity measure.
    """

    contiguous = True
    numbers: ClassVar[dict[str, str]] = {"record": "number of the record, from 0"}

    motions: dict[int, GroundMotion] = field(factory=dict)
    intensities: dict[int, float] = field(factory=dict)
    measure: Intensity = field(kw_only=True)
    digest: str = field(kw_only=True)
    model: str = field(kw_only=True)
    normalised_by: str = field(kw_only=True)
    worse: bool = field(default=False, kw_only=True)
    """Flag: each run is the worse one of the motion and its reverse. The polarity is then 1."""
    law: Restitution = field(kw_only=True)

    @property
    def comment(self) -> str:  # type: ignore[override]
        """Unit of a peak, and what does not count."""
        slender = "stiffness_ratio" in self.fixed and not self.full
        unit = "angle of unstable balance" if slender else "critical angle"
        return f"A peak is in units of the {unit}; impacts of chattering sequences do not count."

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
            restitution = self.law.factor * _each(housner_restitution, slenderness, ratio)
        if self.law.rows:
            restitution = np.full(record.size, max(kept for _, kept in self.law.rows))
        own = np.array([self.intensities[number] for number in record.tolist()])
        factor = self.measure.factor(arguments["level"], own, alpha, slenderness)
        factor = factor * arguments["polarity"] / self.acceleration_units(slenderness)
        alpha, slenderness = alpha * self.units.rate, slenderness * self.units.angle
        return Runs(
            self.motions,
            record,
            alpha,
            factor,
            restitution,
            arguments["angle"],
            slenderness,
            self.full,
            self.worse,
            left_of(arguments, restitution),
            self.law,
            slenderness * alpha,
            self.streams(record, np.zeros_like(record)),
            ratios_of(self.fixed) if self.full else UNRESTRAINED,
        )

    def acceleration_units(self, slenderness: np.ndarray) -> np.ndarray:
        """Return the base accelerations in m/s² that are 1 if they are normalised, for critical angles in rad."""
        own = _each(acceleration_unit_g, slenderness, self.normalised_by)
        return GRAVITY * (own * self.units.acceleration)

    @property
    def units(self) -> RestrainedUnits:
        """Units of the blocks over those of free ones: other ones for slender restrained blocks."""
        return restrained_units(*(UNRESTRAINED if self.full else ratios_of(self.fixed)))

    def own_units(self, block: Block) -> Block:
        """Return a block with the units of the survey if it is restrained."""
        if block.restrainer is None:
            return block
        return with_unit(block, unit_for(block, self.normalised_by, self.model))

    def streams(self, record: np.ndarray, sample: np.ndarray) -> np.ndarray:
        """Return the numbers (n,) of the sequences of deviations: one for each record and sample, at all levels alike."""
        if self.law.scatter is None:
            return np.zeros(record.size, np.int64)
        pairs, places = np.unique(np.stack([record, sample]), axis=1, return_inverse=True)
        runs = {
            number: evolve(self.law.scatter, run=self.motions[number].number)
            for number in set(pairs[0].tolist())
        }
        return np.array([runs[number].stream(own) for number, own in pairs.T.tolist()], np.int64)[
            places.ravel()
        ]

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, and the digest of the records."""
        fixed: dict[str, Any] = {
            name: self.fixed[name] for name in (*RUN_QUANTITIES, "inertia_ratio") if name in self.fixed
        }
        if self.worse:
            fixed["polarity"] = WORSE
        # without the word for "angle", so that such results have the identity that they had before there was a choice
        own = {"model": self.model} | (
            {"normalised_by": "tangent"} if self.normalised_by == "tangent" else {}
        )
        own |= {"intensity": self.measure.name, "records_sha256": self.digest}
        return fixed | self.law.attributes() | own | self.stated

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
    model: str = "full",
    normalised_by: str | None = None,
    inertia_ratio: float = RECTANGLE,
    one_run: bool = False,
    law: Restitution = HOUSNER,
) -> MotionSpec:
    """Check the quantities of a survey of ground motions: arrays are axes, and the others are numbers or None.

    With ``one_run``, nothing needs to vary. The ``law`` gives the restitution if the quantities do not.

    Raises
    ------
    TypeError, ValueError
        If a quantity is missing, of the wrong type or outside its range, or if none varies. Also if a block is too squat for
        Housner's restitution.
    """
    model = one_of("model", model, MODELS)
    normalised_by = normalisation_for(normalised_by, model)
    check_model(law, model)
    spans = {name: each.range for name, each in RUN_QUANTITIES.items()}
    if model == "full":
        spans["slenderness"] = CRITICAL_ANGLE.range
    try:
        checked: dict[str, Any] = {
            name: checked_polarity(arguments.get(name))
            if name == "polarity"
            else number_or_axis("levels" if name == "level" else name, arguments.get(name), span)
            for name, span in spans.items()
            if arguments.get(name) is not None or name not in OPTIONAL
        }
    except Refusal as error:
        if type(error) is not Refusal or (error.argument, model) != ("slenderness", "full"):
            raise
        raise Refusal(
            error.argument, error.allowed, error.value, "the slender {model} takes others"
        ) from None
    if worse := isinstance(checked["polarity"], str):
        checked["polarity"] = 1.0
    axes = {name: value for name, value in checked.items() if isinstance(value, np.ndarray)}
    fixed = {name: value for name, value in checked.items() if name not in axes}
    fixed["inertia_ratio"] = within("inertia_ratio", inertia_ratio, *INERTIA_RATIOS)
    if "restitution" not in checked:
        ends = float(np.max(checked["slenderness"])), float(np.min(checked["slenderness"]))
        for slenderness in ends:
            e = law.coefficient(housner_restitution(slenderness, fixed["inertia_ratio"]))
            which = "Housner's restitution is not negative" if e < 0.0 else f"{law.origin} gives at most 1"
            if not 0.0 <= e <= 1.0:
                allowed = f"be a critical angle in rad for which {which}"
                raise Refusal("slenderness", allowed, slenderness, "or give {restitution}")
        if not law.is_housner and (law.rows or law.value is not None):
            fixed["restitution"] = law.coefficient(1.0)
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
        worse=worse,
        normalised_by=normalised_by,
        law=law,
    )


def _each(formula: Any, values: np.ndarray, other: Any) -> np.ndarray:
    """Apply a formula for one block to many, with the rounding of the formula."""
    distinct, places = np.unique(values, return_inverse=True)
    return np.array([formula(value, other) for value in distinct.tolist()])[places]


class Pulses(NamedTuple):
    """Pulses at n points, each an array (n,), and what all blocks have."""

    kind: str
    amplitude: np.ndarray
    duration: np.ndarray
    restitution: np.ndarray
    critical_angle: np.ndarray  # rad
    full: bool  # whether the blocks follow the full equation of motion
    left: Left
    law: np.ndarray  # (m, 2), rows of the coefficient of restitution over the speed
    scatter: Scatter | None
    restrainer: Ratios


def turns(kind: str) -> float:
    """Return the periods 2π/Ω in the duration of a pulse: a half for the half-sine, one for the others."""
    return SINES[kind].turns if kind in SINES else 1.0


@frozen(eq=False)
class PulseSpec(SurveySpec):
    """Survey of blocks at rest under one pulse of a kind."""

    comment = "A peak is in units of the critical angle; impacts of chattering sequences do not count."

    kind: str = field(kw_only=True)
    table: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)
    scatter: Scatter | None = field(default=None, kw_only=True)

    def inputs(self, values: Values) -> Pulses:
        """Return the pulses at n points."""
        arguments = self.arguments(values)
        duration = turns(self.kind) * math.tau / arguments["frequency"]
        angle = arguments["critical_angle"] if self.full else np.zeros(duration.size)
        restitution, law = arguments["restitution"], numbers.NO_LAW
        if self.table:
            law = np.array(((0.0, self.fixed["restitution"]), *self.table))
            restitution = np.full(duration.size, law[:, 1].max())
        left = left_of(arguments, restitution)
        amplitude = arguments["amplitude"]
        own = self.full, left, law, self.scatter, ratios_of(self.fixed)
        return Pulses(self.kind, amplitude, duration, restitution, angle, *own)

    def described(self) -> dict[str, Any]:
        """Return the kind of the pulse and the quantities that do not vary, by name."""
        own = self.fixed | table_attributes(self.table) | scatter_attributes(self.scatter)
        return {"pulse": self.kind} | own | self.stated


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
    own = {"restitution": system.restitution} | left_quantities(system.left)
    if system.critical_angle is not None:
        own["critical_angle"] = system.critical_angle
    if system.is_restrained:
        own |= {"stiffness_ratio": system.stiffness_ratio, "prestress_ratio": system.prestress_ratio}
    required = {"amplitude", "frequency"}
    named = [name for name in axes if axes[name] is not None or name in required]
    checked = {
        name: quantity_axis(name, axes[name], "" if name in required else "the system") for name in named
    }
    if "restitution" in checked:
        check_uniform(system.restitution_table, "an axis of an overturning spectrum")
        refuse_if(
            system.wall is not None, "restitution", "be omitted for a block against a wall", Text("an axis")
        )
    fixed = {name: own[name] for name in own if name not in checked}
    table, scatter = system.restitution_table, system.restitution_scatter
    return PulseSpec(checked, fixed, kind=forcing.kind, table=table, scatter=scatter)


def by_period(system: System) -> dict[str, float]:
    """Return the quantities of a system on a harmonic base: its period but not its frequency; and the table of its restitution."""
    check_periodic(system, None)
    table: dict[str, Any] = {TABLE: system.restitution_table} if system.restitution_table else {}
    return {name: value for name, value in quantities(system).items() if name != "frequency"} | table
