"""The options that commands share, declared once, and what they mean: a system, normalised or of a block in SI, and a start."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rocking.model import Block, State, System


class YourInput(typer.TyperException):
    """What was typed cannot be done; the message says why in one line."""


def number(text: str) -> float:
    """An int or a float, as it is written."""
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    raise typer.BadParameter(f"must be a number alone, such as 0.6; got {text!r}")


def _number(name: str, text: str) -> Any:
    return typer.Option(name, parser=number, metavar="NUMBER", help=text)


def _file(name: str, text: str) -> Any:
    return typer.Option(name, metavar="FILE", help=text)


Number = float | None

Amplitude = Annotated[Number, _number("--amplitude", "Normalised: A of the base, in units of g θcr.")]
Period = Annotated[Number, _number("--period", "Normalised: T of the base, in τ.")]
Frequency = Annotated[Number, _number("--frequency", "Normalised: Ω of the base, instead of --period.")]

Height = Annotated[Number, _number("--height", "SI: of the block, m.")]
Width = Annotated[Number, _number("--width", "SI: of the block, m.")]
Acceleration = Annotated[Number, _number("--acceleration", "SI: amplitude of the base, m/s².")]
AccelerationG = Annotated[Number, _number("--acceleration-g", "SI: the same in units of g.")]
Displacement = Annotated[Number, _number("--displacement", "SI: or of the base's displacement, m.")]
FrequencyHz = Annotated[Number, _number("--frequency-hz", "SI: of the base, Hz.")]
PeriodS = Annotated[Number, _number("--period-s", "SI: of the base, s, instead of --frequency-hz.")]

Restitution = Annotated[Number, _number("--restitution", "e at an impact; in SI Housner's unless given.")]
Phase = Annotated[Number, _number("--phase", "φ of the base's acceleration, rad.")]
BraceAngle = Annotated[Number, _number("--brace-angle", "Θb of side braces, in θcr; no braces unless given.")]
BraceRestitution = Annotated[Number, _number("--brace-restitution", "r at a brace; 1 unless given.")]
Angle = Annotated[float, _number("--angle", "Θ at the start, in θcr.")]
Velocity = Annotated[float, _number("--velocity", "Θ' at the start, in θcr per τ.")]
Cycles = Annotated[int, _number("--cycles", "Cycles of the base to run.")]

Plot = Annotated[
    Path | None,
    _file(
        "--plot",
        "History and phase portrait, of a long run its last 30 cycles (.png .svg .pdf), or film (.gif .mp4).",
    ),
]
Csv = Annotated[Path | None, _file("--csv", "Time, angle and velocity at even steps.")]
Netcdf = Annotated[Path | None, _file("--netcdf", "The same with its description (.nc).")]
VerdictPlot = Annotated[
    Path | None,
    _file("--plot", "Last cycles, phase portrait and section, with the verdict (.png .svg .pdf)."),
]
MaxCycles = Annotated[int, _number("--max-cycles", "Cycles of the base to follow at most.")]
MaxPeriod = Annotated[int, _number("--max-period", "Longest period looked for, in cycles of the base.")]
ModeCycles = Annotated[
    int, typer.Option("-n", parser=number, metavar="NUMBER", help="Forcing cycles in a response: 1, 3, 5, ….")
]
ModesPlot = Annotated[
    Path | None, _file("--plot", "Speed and phase of the modes over the amplitude (.png .svg .pdf).")
]
Store = Annotated[
    Path | None,
    typer.Option(
        "--store", metavar="DIR", help="Zarr store, written while it runs; the same command goes on with it."
    ),
]
Repair = Annotated[
    bool, typer.Option("--repair", help="Compute tiles of the store again that are found damaged.")
]
SurveyCycles = Annotated[
    Number, _number("--max-cycles", "Cycles of the base to follow at most; 10,000 unless given.")
]
SurveyPeriod = Annotated[
    Number,
    _number("--max-period", "Longest period looked for, in cycles of the base; 64 unless given."),
]
SurveyNetcdf = Annotated[Path | None, _file("--netcdf", "All that was found, with its description (.nc).")]
Json = Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")]

NORMALISED = ("amplitude", "period", "frequency")
SI = ("height", "width", "acceleration", "acceleration_g", "displacement", "frequency_hz", "period_s")
IN_SI = {"amplitude": "acceleration", "period": "period_s", "frequency": "frequency_hz"}
LENGTHS = ("cycles", "max_cycles", "max_period")
ARGUMENTS = {name: name for name in (*NORMALISED, *SI, "restitution", "phase", "angle", "velocity", *LENGTHS)}
UNASKED = {"phase": 0.0, "angle": 0.0, "velocity": 0.0, "brace_angle": None, "brace_restitution": None}
"""What a command that asks for a system without its start leaves out."""
AT_REST = {"angle": 0.0, "velocity": 0.0}
"""The start of a command that asks for many."""
BRACES = {"angle": "brace_angle", "restitution": "brace_restitution"}
NORMALISED_NEEDS = "--amplitude, --period (or --frequency) and --restitution"
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)"


def option(name: str) -> str:
    """How the argument `name` is typed."""
    return "--" + name.replace("_", "-")


@contextmanager
def your_input(typed: Mapping[str, str] | None = None) -> Iterator[None]:
    """Turn a refusal inside the block into one of yours, the arguments in it named by the options in which they are `typed`."""
    try:
        yield
    except (ValueError, TypeError, OSError) as error:
        raise YourInput(as_typed(str(error), typed or {})) from error


def as_typed(text: str, typed: Mapping[str, str]) -> str:
    """The same with arguments named by the options in which they are `typed`."""
    if not typed:
        return text
    words = r"(?<!['\w-])(" + "|".join(typed) + r")(?!['\w])"
    return re.sub(words, lambda found: option(typed[found[0]]), text)


def question(given: Mapping[str, Any]) -> tuple[System, State, Block | None]:
    """The system and the start that the options ask for, and the block if they are in SI; refused as `YourInput`."""
    from rocking.model import LARGEST_START, Block, Harmonic, State, System, within

    normalised = [name for name in NORMALISED if given[name] is not None]
    physical = [name for name in SI if given[name] is not None]
    if normalised and physical:
        name = normalised[0]
        raise YourInput(
            f"{option(name)} is normalised, {option(physical[0])} is SI: give one kind (in SI it is {option(IN_SI[name])})"
        )
    if not normalised and not physical:
        raise YourInput(f"give {NORMALISED_NEEDS}, or in SI {SI_NEEDS}")
    if normalised:
        _require(given, ("amplitude", "restitution"), NORMALISED_NEEDS)
    else:
        _require(given, ("height", "width"), SI_NEEDS)
    braces = _braces(given)
    with your_input(ARGUMENTS):
        state = (within(name, given[name], -LARGEST_START, LARGEST_START) for name in ("angle", "velocity"))
        start = State(*state)
        if normalised:
            forcing = Harmonic(**{name: given[name] for name in (*NORMALISED, "phase")})
            return System(forcing, given["restitution"], braces), start, None
        block = Block(given["height"], given["width"], given["restitution"])
        shaking = {name: given[name] for name in (*SI[2:], "phase")}
        return block.system(**shaking, braces=braces), start, block


def _braces(given: Mapping[str, Any]) -> Any:
    from rocking.model import Braces

    if given["brace_angle"] is None:
        if given["brace_restitution"] is not None:
            raise YourInput("--brace-restitution needs --brace-angle")
        return None
    restitution = 1.0 if given["brace_restitution"] is None else given["brace_restitution"]
    with your_input(BRACES):
        return Braces(given["brace_angle"], restitution)


def _require(given: Mapping[str, Any], names: tuple[str, ...], needs: str) -> None:
    missing = [option(name) for name in names if given[name] is None]
    if missing:
        raise YourInput(f"missing {' and '.join(missing)}: give {needs}")
