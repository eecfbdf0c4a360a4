"""Types of the options, the options that several commands share, and error messages with the names of options."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

import click

from rocking.model.quantity import FRICTION as COEFFICIENT
from rocking.model.quantity import LEFT_QUANTITIES, SYSTEM_QUANTITIES

NORMALISED = ("amplitude", "period", "frequency")
SI = ("height", "width", "acceleration", "acceleration_g", "displacement", "frequency_hz", "period_s")
FORCED = (*NORMALISED, *SI, "restitution")
MASS_CENTRE = ("offset", "centre_height", "radius_of_gyration")
"""Options in SI that place the mass centre of a block, and state its inertia."""
RESTRAINER = ("restrainer_stiffness", "restrainer_prestress", "mass")
STANDING = (*MASS_CENTRE, "wall", *RESTRAINER)
"""The same, the wall against which the block stands, and its restrainer."""
SYSTEM = (*FORCED, "phase", "brace_angle", "brace_restitution", "critical_angle", *MASS_CENTRE)
START = ("angle", "velocity")
SURVEYED = (
    *(name for name in (*SYSTEM, *START) if name not in (*SI, *MASS_CENTRE)),
    *LEFT_QUANTITIES,
)
"""Quantities of a survey, in the order in which they are printed."""
AMPLITUDES = ("amplitude", "acceleration", "acceleration_g", "displacement")
FREQUENCIES = ("period", "frequency", "frequency_hz", "period_s")
AXIS_FORM = "START:STOP:COUNT"
RANGE_FORM = "START:STOP"
DEFAULT_COUNT = 200
MAX_POINTS = 1_000_000
UNQUOTED = "write a number without quotation marks"


class InvalidInput(click.ClickException):
    """Invalid input; the message states the reason in one line."""


def option(name: str) -> str:
    """Return the option name of an argument."""
    return "-n" if name == "n" else "--" + name.replace("_", "-")


def label(parameter: click.Parameter) -> str:
    """Return the name of an option or an argument in messages and on the help page."""
    if isinstance(parameter, click.Option):
        return option(parameter.name)
    return str(parameter.metavar).strip("[].")


@contextmanager
def refusals(names: Mapping[str, str] | None = None) -> Iterator[None]:
    """Convert errors raised in the block to `InvalidInput` with the names of options.

    `names` holds arguments whose names are not those of options.
    """
    try:
        yield
    except (ValueError, TypeError, OSError) as error:
        raise InvalidInput(message(error, names or {})) from error


def message(error: Exception, names: Mapping[str, str]) -> str:
    """Return the message of an error with the names of options and the words of the command line."""
    from rocking.model.validation import Refusal
    from rocking.survey.store_access import StoreError

    if isinstance(error, Refusal):
        context = click.get_current_context()
        own = {str(each.name): label(each) for each in context.command.params}
        for law in ("restitution_factor", "restitution_table"):  # typed instead of the coefficient
            if context.params.get(law) is not None:
                own["restitution"] = option(law)
        error = error.of(own | {"braces": option("brace_angle")} | dict(names))
    own_name = isinstance(error, StoreError) and error.argument
    return f"--{reworded(str(error))}" if own_name else reworded(str(error))


def reworded(text: str) -> str:
    """Return a text of the package in the words of the command line."""
    for python, typed in WORDS.items():
        text = text.replace(python, typed)
    return text


WORDS = {
    "two quantities as arrays": f"two quantities as axes, {AXIS_FORM}",
    "the others are those of the system": "give the others as numbers",
    "be an array if nothing else varies": f"be an axis, {AXIS_FORM}, if nothing else varies",
    "be a pair (low, high)": f"be a range, {RANGE_FORM},",
    "with low < high": "with START < STOP",
    "rk.simulate follows": "rocking record follows",
    "theory.symmetric_modes returns": "rocking modes returns",
    "increase max_cycles": "increase --max-cycles",
    "these tiles with repair": "these tiles with --repair",
    "with store, running it": "with --store, running it",
    "give store, a folder": "give --store, a folder",
}
"""Words of the package that are not those of the command line."""


class Axis(NamedTuple):
    """Evenly spaced values, both ends included."""

    start: float
    stop: float
    points: int


class Range(NamedTuple):
    """Values from one end to the other, in the order typed."""

    start: float
    stop: float


class Value(click.ParamType):
    """Type of an option or an argument, which reads a text of the command line and an entry of a study file."""

    name = "value"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value of a text; other values come from a study file that has been read, or are defaults."""
        if param is None or not isinstance(value, str):
            return value
        with refusals():
            return self.read(label(param), value)

    def read(self, name: str, text: str) -> Any:
        """Return the value of a text; ValueError, with `name` in its message, if there is none."""
        return text

    def entry(self, name: str, entry: Any) -> Any:
        """Return the value of an entry in TOML; TypeError or ValueError, with `name` in its message, if there is none."""
        from rocking.model.validation import instance

        return self.read(name, instance(name, entry, str))


class Number(Value):
    """A number: an int if possible, else a float."""

    name = "NUMBER"

    def read(self, name: str, text: str) -> float:
        """Return the number in a text."""
        from rocking.model.validation import refusal

        number = number_in(text)
        if number is None:
            raise ValueError(refusal(name, "be a number without a unit, such as 0.6", text))
        return number

    def entry(self, name: str, entry: Any) -> float:
        """Return an entry that is a finite number; TOML also has nan and inf."""
        from rocking.model.validation import refusal

        if isinstance(entry, str):
            check_unquoted(name, entry, "be a number")
        if isinstance(entry, bool) or not isinstance(entry, int | float):
            raise TypeError(refusal(name, "be a number", entry))
        if not math.isfinite(entry):
            raise ValueError(refusal(name, "be a finite number", entry))
        return entry


class Interval(Value):
    """An axis or a range; with `numbers` also a number. A study file may then hold a list, with `lists`."""

    form, article, example, limits = "", "", "", ""

    def __init__(self, *, numbers: bool, lists: bool = False) -> None:
        self.numbers, self.lists = numbers, lists
        kind = type(self).__name__.removesuffix("Type")
        self.name = f"NUMBER|{kind.upper()}" if numbers else kind.upper()
        self.short = (
            f"be a number or {self.form}" if numbers else f"be {self.article} {kind.lower()}, {self.form}"
        )
        self.allowed = f"{self.short} with finite START ≠ STOP{self.limits}"

    def parsed(self, text: str) -> Axis | Range:
        """Return the axis or the range in a text; ValueError for anything else."""
        raise NotImplementedError

    def table(self, name: str, table: Mapping[str, Any]) -> Axis | Range:
        """Return the axis or the range in a table of a study file."""
        raise NotImplementedError

    def read(self, name: str, text: str) -> Any:
        """Return the number, the axis or the range in a text."""
        from rocking.model.validation import refusal

        if self.numbers and (number := number_in(text)) is not None:
            return number
        with suppress(ValueError):
            ends = self.parsed(text)
            if math.isfinite(ends.stop - ends.start) and ends.start != ends.stop:
                return ends
        raise ValueError(refusal(name, self.allowed, text, f"example: {self.example}"))

    def entry(self, name: str, entry: Any) -> Any:
        """Return an entry: a text as on the command line, a number, a table or a list."""
        from rocking.model.validation import reals, refusal

        if isinstance(entry, str):
            if self.numbers:
                check_unquoted(name, entry, self.short)
            return self.read(name, entry)
        if isinstance(entry, Mapping):
            return self.table(name, entry)
        if isinstance(entry, list) and self.lists:
            return reals(name, entry)
        if isinstance(entry, bool) or not isinstance(entry, int | float):
            raise TypeError(refusal(name, self.short, entry))
        if not self.numbers:
            raise ValueError(refusal(name, self.allowed, entry, f"example: {self.example}"))
        return NUMBER.entry(name, entry)


class AxisType(Interval):
    """An axis, START:STOP:COUNT; COUNT is optional."""

    form, article, example = AXIS_FORM, "an", "1:3:60"
    limits = f" and a whole COUNT in [2, {MAX_POINTS}]"

    def parsed(self, text: str) -> Axis:
        """Return the axis in a text."""
        start, stop, count = (text if text.count(":") == 2 else f"{text}:{DEFAULT_COUNT}").split(":")
        axis = Axis(float(start), float(stop), int(count))
        if not 2 <= axis.points <= MAX_POINTS:
            raise ValueError
        return axis

    def table(self, name: str, table: Mapping[str, Any]) -> Axis:
        """Return the axis in a table of start, stop and optionally count."""
        from rocking.model.validation import whole

        if not {"start", "stop"} <= table.keys() <= {"start", "stop", "count"}:
            raise ValueError(
                f"{name} must be a number, {AXIS_FORM}, or a table of start, stop and optionally count; "
                f"got {', '.join(table) or 'an empty table'}"
            )
        count = whole(f"count of {name}", table.get("count", DEFAULT_COUNT), 2, MAX_POINTS)
        return Axis(*ends_of(name, table), count)


class RangeType(Interval):
    """A range, START:STOP."""

    form, article, example = RANGE_FORM, "a", "1:3"

    def parsed(self, text: str) -> Range:
        """Return the range in a text."""
        start, stop = text.split(":")
        return Range(float(start), float(stop))

    def table(self, name: str, table: Mapping[str, Any]) -> Range:
        """Return the range in a table of start and stop."""
        if table.keys() != {"start", "stop"}:
            raise ValueError(
                f"{name} must be {RANGE_FORM}, or a table of start and stop; got {', '.join(table) or 'an empty table'}"
            )
        return Range(*ends_of(name, table))


class Names(Value):
    """Names, separated by commas; in a study file also a list."""

    def read(self, name: str, text: str) -> tuple[str, ...]:
        """Return the names in a text."""
        return tuple(part.strip() for part in text.split(","))

    def entry(self, name: str, entry: Any) -> tuple[str, ...]:
        """Return the names in a text or a list."""
        from rocking.model.validation import refusal

        parts = entry.split(",") if isinstance(entry, str) else entry
        if not isinstance(parts, list) or not all(isinstance(part, str) for part in parts):
            allowed = "be names in a list, or in one text separated by commas"
            raise TypeError(refusal(name, allowed, entry))
        return tuple(part.strip() for part in parts)


class TableType(Value):
    """Table of the coefficient of restitution: pairs, or a file with two columns; in a study file also a list of pairs."""

    def read(self, name: str, text: str) -> list[list[float]]:
        """Return the rows in a text, or in the file that it names."""
        from rocking.model.validation import refusal

        pairs = text.split(",") if ":" in text else []
        if not pairs:
            pairs = [line for line in lines_of(name, Path(text)) if not line.startswith("#")]
        rows = [[number_in(part) for part in re.split(r"[:,;\s]+", pair.strip())] for pair in pairs]
        if not all(len(row) == 2 and None not in row for row in rows):
            allowed = "be pairs SPEED:E, separated by commas, or a file with two columns, speed and e"
            raise ValueError(refusal(name, allowed, text, "example: 0.1:0.95,0.8:0.9"))
        return rows  # type: ignore[return-value]

    def entry(self, name: str, entry: Any) -> Any:
        """Return the rows of a list, or of a text."""
        return entry if isinstance(entry, list) else super().entry(name, entry)


class ScatterType(Value):
    """Scatter of the coefficient of restitution: S, S:SHAPE or S:SHAPE:SEED."""

    def read(self, name: str, text: str) -> tuple[float, str, int]:
        """Return deviation, shape and seed in a text."""
        from rocking.model.validation import refusal

        parts = text.split(":")
        numbers = number_in(parts[0]), number_in(parts[2]) if len(parts) == 3 else 0
        if len(parts) > 3 or None in numbers:
            allowed = "be S, S:SHAPE or S:SHAPE:SEED, with numbers S and SEED"
            raise ValueError(refusal(name, allowed, text, "example: 0.02:normal:1"))
        return numbers[0], parts[1] if len(parts) > 1 else "normal", numbers[1]  # type: ignore[return-value]

    def entry(self, name: str, entry: Any) -> Any:
        """Return deviation, shape and seed of a number or a text."""
        return self.read(name, str(entry)) if isinstance(entry, int | float) else super().entry(name, entry)


def lines_of(name: str, path: Path) -> list[str]:
    """Return the lines of a text file that are not empty; ValueError if it cannot be read."""
    from rocking.model.validation import refusal

    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        raise ValueError(refusal(name, "name a text file that can be read", str(path), reason)) from error
    return [line for line in map(str.strip, text.splitlines()) if line]


class Word(Value):
    """One of the words of a tuple of `rocking.model.system`."""

    def __init__(self, words: str) -> None:
        self.words = words

    def read(self, name: str, text: str) -> str:
        """Return a word."""
        return self.entry(name, text)

    def entry(self, name: str, entry: Any) -> str:
        """Return an entry that is one of the words."""
        from rocking.model import system
        from rocking.model.validation import one_of

        return one_of(name, entry, getattr(system, self.words))


class Polarity(Value):
    """Direction of ground motions."""

    def read(self, name: str, text: str) -> Any:
        """Return the name of a polarity, or its number."""
        number = number_in(text)
        return text if number is None else number

    def entry(self, name: str, entry: Any) -> Any:
        """Return an entry that is a polarity."""
        return entry if isinstance(entry, str) else NUMBER.entry(name, entry)


class Port(Value):
    """Number of a port."""

    def read(self, name: str, text: str) -> int:
        """Return the number of a port."""
        with suppress(ValueError):
            if 0 <= int(text) <= 65_535:
                return int(text)
        raise ValueError(f"{name} must be a whole number in [0, 65535]; got {text}")


class PathType(Value):
    """Path."""

    def read(self, name: str, text: str) -> Path:
        """Return the path in a text."""
        return Path(text)

    def entry(self, name: str, entry: Any) -> Path:
        """Return an entry that is a path."""
        from rocking.model.validation import refusal

        if not isinstance(entry, str):
            raise TypeError(refusal(name, "be a path", entry))
        return self.read(name, entry)


class OutputFile(PathType):
    """Path of an output file, with the endings that it may have."""

    def __init__(self, *suffixes: str) -> None:
        self.suffixes = suffixes


class OutputFolder(PathType):
    """Path of a folder; an empty text, as from a shell variable without a value, is invalid."""

    def read(self, name: str, text: str) -> Path:
        """Return the path in a text."""
        if not text:
            raise ValueError(f"{name} must be the path of a folder; got ''")
        return Path(text)


class RecordFile(PathType):
    """Path of a record; `example` stands for that of the package."""

    def read(self, name: str, text: str) -> Path:
        """Return the path in a text."""
        if not text:
            raise ValueError(f"{name} must be the path of a file; got ''")
        if text == "example":
            from rocking.records.read import FILE

            return FILE
        return Path(text)


def number_in(text: str) -> float | None:
    """Return the number in a text, an int if possible; None if there is none."""
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return None


def check_unquoted(name: str, text: str, allowed: str) -> None:
    """Raise TypeError for a number in quotation marks; `allowed` states what the entry must be."""
    from rocking.model.validation import refusal

    if number_in(text) is not None:
        raise TypeError(refusal(name, allowed, text, UNQUOTED))


def ends_of(name: str, table: Mapping[str, Any]) -> tuple[float, float]:
    """Return the ends of an axis or a range from a table; they are finite and differ, as those of a text."""
    start, stop = (float(NUMBER.entry(f"{part} of {name}", table[part])) for part in ("start", "stop"))
    if start == stop:
        raise ValueError(f"start and stop of {name} must differ; got {start:g} for both")
    return start, stop


NUMBER, TEXT, FILE, FOLDER = Number(), Value(), PathType(), OutputFolder()
AXIS, VALUES = AxisType(numbers=False, lists=True), AxisType(numbers=True, lists=True)
ONE_AXIS, ONE_VALUE = AxisType(numbers=False), AxisType(numbers=True)
RANGE, ONE_RANGE = RangeType(numbers=False, lists=True), RangeType(numbers=True)
PICTURES, FILMS = (".png", ".svg", ".pdf"), (".gif", ".mp4")


def make(name: str, kind: Value, metavar: str, text: str, default: Any = None, **more: Any) -> click.Option:
    """Make an option."""
    return click.Option([option(name)], type=kind, metavar=metavar, help=text, default=default, **more)


def number(name: str, text: str, default: Any = None, **more: Any) -> click.Option:
    """Make an option whose value is a number."""
    return make(name, NUMBER, NUMBER.name, text, default, **more)


def interval(name: str, kind: Interval, text: str) -> click.Option:
    """Make an option whose value is an axis or a range, or also a number."""
    return make(name, kind, kind.name, text)


def switch(name: str, text: str) -> click.Option:
    """Make an option without a value."""
    return click.Option([option(name)], is_flag=True, help=text)


def output(name: str, text: str, *suffixes: str) -> click.Option:
    """Make the option of an output file."""
    return make(name, OutputFile(*suffixes), "FILE", text)


def plot(text: str) -> click.Option:
    """Make the option of a figure."""
    return output("plot", f"{text} (.png .svg .pdf).", *PICTURES)


def csv(text: str) -> click.Option:
    """Make the option of a table."""
    return output("csv", f"{text} (.csv).", ".csv")


TEXTS = {name: each.help for name, each in SYSTEM_QUANTITIES.items()} | {
    "height": "Height of the block, m.",
    "width": "Width of the block, m.",
    "acceleration": "Amplitude of the base acceleration, m/s².",
    "acceleration_g": "Amplitude of the base acceleration, in units of g; replaces --acceleration.",
    "displacement": "Amplitude of the base displacement, m; replaces --acceleration.",
    "frequency_hz": "Forcing frequency, Hz.",
    "period_s": "Forcing period, s; replaces --frequency-hz.",
    "offset": "Distance of the mass centre from the middle of the base, m, towards the edge about which the block turns for "
    "Θ > 0. Default: 0.",
    "centre_height": "Height of the mass centre above the base, m. Default: half the height.",
    "radius_of_gyration": "Radius of gyration about the mass centre, m. Default: that of a uniform rectangle.",
    "wall": "Coefficient of restitution, in [0, 1], of a wall on the side Θ < 0, against which the block stands. Default: no wall.",
    "restrainer_stiffness": "Stiffness EA/L of a vertical restrainer from the middle of the base, N/m. Default: no restrainer.",
    "restrainer_prestress": "Force of the restrainer in the block at rest, N. Default: 0.",
    "mass": "Mass of a restrained block, kg.",
}
"""Help of the options of a system and an initial state, the same in all commands."""


def quantities(*names: str, kind: Interval | None = None, varied: tuple[str, ...] = ()) -> list[click.Option]:
    """Make the options of quantities: numbers, and for those in `varied` values of a `kind`."""
    normalised = {"period", "critical_angle"} & {*names}
    needed = "Required with normalised input. Default with SI input" if normalised else "Default"
    texts = TEXTS | {"restitution": f"{TEXTS['restitution']} {needed}: Housner's value."}
    return [
        interval(name, kind, texts[name]) if kind and name in varied else number(name, texts[name])
        for name in names
    ]


VARIABLE = tuple(name for name in (*SYSTEM, *START) if name not in ("height", "width", *MASS_CENTRE))
"""Quantities that a survey may vary."""


def max_cycles(default: int) -> click.Option:
    """Make the option of the longest run."""
    return number("max_cycles", "Maximum number of forcing cycles.", default)


def max_period(default: int = 64) -> click.Option:
    """Make the option of the longest response period."""
    return number("max_period", "Longest response period sought, in forcing cycles.", default)


MODEL = make(
    "model",
    Word("MODELS"),
    "MODEL",
    "Equation of motion for a block in SI: full, or slender, for small angles. Default: full under a record or a pulse, slender on "
    "a harmonic base.",
)
NORMALISED_BY = make(
    "normalised_by",
    Word("NORMALISATIONS"),
    "UNIT",
    "Unit of the base acceleration of a slender block in SI under a record or a pulse: tangent, g tan θcr, at which the real "
    "block lifts off, or angle, g θcr. Default: tangent.",
)
PROVE = switch("prove", "Prove a periodic response in ball arithmetic; needs the extra `proof`.")
STEP = number(
    "step",
    "Largest step along a branch, in units of the range and of one radian of phase, in [1e-6, 0.1].",
    0.01,
)
STORE = make("store", FOLDER, "DIR", "Zarr store, written during the run; repeating the command resumes it.")
REPAIR = switch("repair", "Recompute damaged tiles of the store.")
NETCDF = output("netcdf", "Write the computed data with units and parameters (.nc).", ".nc")
SURVEY_NETCDF = output("netcdf", "Write all results with their description (.nc).", ".nc")
JSON = switch("json", "Print the summary as JSON.")
INERTIA_RATIO = number(
    "inertia_ratio",
    "Io/(MR²), the normalised moment of inertia about a corner. Default: 4/3, a uniform rectangle.",
)
FRICTION = number(
    COEFFICIENT.name,
    "Coefficient of friction μ of the base. A motion that needs more is refused: the block slides, from a time that is printed. "
    "Default: unlimited.",
)
POLARITY = make(
    "polarity",
    Polarity(),
    "POLARITY",
    'Direction of the records: "+" as recorded, "-" reversed, "both", or "worse", of both runs the one that is worse for the '
    "block. No effect on a symmetric block at rest. Default: +.",
)
LAW = (
    number("restitution_factor", "Factor of Housner's coefficient of restitution; replaces --restitution."),
    make(
        "restitution_table",
        TableType(),
        "ROWS",
        "Coefficient of restitution over the speed before the impact, rad/s: pairs SPEED:E, separated by commas, or a file with "
        "two columns; replaces --restitution; needs --model full.",
    ),
    make(
        "restitution_scatter",
        ScatterType(),
        "S",
        "Scatter of the coefficient of restitution from impact to impact: S, S:SHAPE or S:SHAPE:SEED. S is the deviation, SHAPE "
        "normal (default) or uniform, SEED a random seed (default: 0). It needs --model full.",
    ),
)
"""Options of the law of restitution of a block in SI."""
RECORD = click.Argument(
    ["file"],
    type=RecordFile(),
    metavar="FILE",
    help="Record file; its format is recognised by the content. `example` is the record that comes with the package.",
)
CHANNEL = number("channel", "Channel of the file, counted from 1.", 1)
READING = (
    make("units", TEXT, "UNIT", "Unit of the samples, if the file does not state it: m/s2, cm/s2, g, …."),
    number(
        "step",
        "Time between two samples, s, if the file does not state it, or prints rounded times; uneven times are resampled.",
    ),
    make(
        "baseline",
        TEXT,
        "KIND",
        "Polynomial that is subtracted from the acceleration: none, mean, linear or quadratic. Default: none.",
    ),
)
"""Options that state how records are read."""
COMPONENT = make(
    "component",
    TEXT,
    "RULE",
    "Horizontal components of each station: all, first, or larger, that of the larger PGA. Default: all.",
)
SOURCES = click.Argument(
    ["sources"],
    type=RecordFile(),
    nargs=-1,
    required=True,
    metavar="SOURCE...",
    help="Record files, a folder of them, or a table (CSV) with a column `file`. `example` is the record that comes with "
    "the package.",
)
LEVELS = {
    "scale": "factor of each record",
    "pga": "peak ground acceleration, m/s²",
    "pga_g": "peak ground acceleration, in units of g",
    "pgv": "peak ground velocity, m/s",
    "pgd": "peak ground displacement, m",
    "arias": "Arias intensity, m/s",
    "cav": "cumulative absolute velocity, m/s",
    "pga_ratio": "peak ground acceleration over g tan θcr",
    "pgv_ratio": "α times the peak ground velocity, over g tan θcr",
    "sa": "pseudo-acceleration at the period of --sa-period, damping 5 %, m/s²",
}
"""Options whose value is the axis of the levels, and the intensity measure of each."""
SA_PERIOD = "sa_period"
"""Option of the period of the measure `sa`."""


def levels(kind: Interval = AXIS) -> list[click.Option]:
    """Make the options of the levels of each intensity measure."""
    period = number(SA_PERIOD, "Natural period of --sa, s.")
    return [*(interval(name, kind, f"Levels: {text}.") for name, text in LEVELS.items()), period]


def scaling(kind: Value, records: str, scale: str) -> list[click.Option]:
    """Make the options `--scale` and `--pga-g` of a command that also takes records as they are."""
    texts = {"scale": scale, "pga_g": f"Peak to which {records} scaled, in units of g; replaces --scale."}
    return [make(name, kind, kind.name, text) for name, text in texts.items()]
