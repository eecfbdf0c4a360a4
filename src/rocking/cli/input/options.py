"""Options shared by several commands, and their conversion to a system, an initial state and a block."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from rocking.cli.option_names import ARGUMENTS, NORMALISED, SI, START, SYSTEM, YourInput, option, your_input

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.system import Braces, State, System


Command = TypeVar("Command", bound=Callable[..., None])


def number(text: str) -> float:
    """Return the number in a text: an int if possible, else a float."""
    if not isinstance(text, str):  # a default
        return text
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    from rocking.model.text import shown

    raise typer.BadParameter(f"must be a number without a unit, such as 0.6; got {shown(text)}")


def number_option(name: str, text: str) -> Any:
    """Declare an option whose value is a number."""
    return typer.Option(name, parser=number, metavar="NUMBER", help=text)


def folder(text: str) -> Path:
    """Return the path of a folder; an empty text, as from an unset shell variable, is invalid."""
    if not text:
        raise typer.BadParameter("must be the path of a folder; got ''")
    return Path(text)


def file_option(name: str, text: str) -> Any:
    """Declare an option whose value is the path of an output file."""
    return typer.Option(name, metavar="FILE", help=text)


Number = float | None

HELP = {
    "amplitude": "Amplitude A of the base acceleration, in units of g θcr.",
    "period": "Forcing period T, in units of 1/α.",
    "frequency": "Forcing frequency Ω, in units of α; replaces --period.",
    "height": "Height of the block, m.",
    "width": "Width of the block, m.",
    "acceleration": "Amplitude of the base acceleration, m/s².",
    "acceleration_g": "Amplitude of the base acceleration, in units of g; replaces --acceleration.",
    "displacement": "Amplitude of the base displacement, m; replaces --acceleration.",
    "frequency_hz": "Forcing frequency, Hz.",
    "period_s": "Forcing period, s; replaces --frequency-hz.",
    "restitution": "Coefficient of restitution e.",
    "phase": "Phase φ of the base acceleration, rad.",
    "brace_angle": "Brace angle Θb, in units of θcr. Default: no braces.",
    "brace_restitution": "Coefficient of restitution r at a brace. Default: 1.",
    "critical_angle": "Critical angle θcr of the full equation of motion, rad, with normalised input. Default: small angles.",
    "angle": "Initial angle Θ, in units of the critical angle θcr, not in degrees.",
    "velocity": "Initial angular velocity Θ', in units of α θcr.",
}
"""Help of the options of a system and an initial state, the same in all commands."""
NORMALISED_TOO = " Required with normalised input. Default with SI input"
ZERO = ("phase", *START)
"""Options whose default is 0."""


def with_options(
    *names: str, declare: Callable[[str, str], Any] = number_option, **usual: float
) -> Callable[[Command], Command]:
    """Return a decorator that adds options before those of a command.

    The command takes them as ``**shared``; the values of all options are in its context. ``declare`` makes an option
    from its name and its help. ``usual`` holds the defaults.
    """
    shared = []
    for name in names:
        text = HELP[name]
        if name == "restitution" and "height" in names:
            normalised = {"period", "critical_angle"} & {*names}
            text += f"{NORMALISED_TOO if normalised else ' Default'}: Housner's value."
        if name in ZERO and name not in usual:
            text = f"{text} Default: 0."
        kind = Annotated[Number, declare(option(name), text)]
        shared.append(Parameter(name, Parameter.KEYWORD_ONLY, default=usual.get(name), annotation=kind))
    return with_parameters(first=shared)


def with_parameters(
    first: Iterable[Parameter] = (), last: Iterable[Parameter] = ()
) -> Callable[[Command], Command]:
    """Return a decorator that adds parameters before and after those of a command, which takes them as ``**shared``."""

    def declared(command: Command) -> Command:
        context, *others = signature(command, eval_str=True).parameters.values()
        own = [
            each.replace(kind=Parameter.KEYWORD_ONLY) for each in others if each.kind != Parameter.VAR_KEYWORD
        ]
        command.__signature__ = Signature([context, *first, *own, *last])  # type: ignore[attr-defined]
        return command

    return declared


Cycles = Annotated[
    int | None,
    number_option("--cycles", "Without --pulse: the number of forcing cycles to simulate. Default: 200."),
]
PulseKind = Annotated[
    str | None,
    typer.Option(
        "--pulse",
        metavar="KIND",
        help="One pulse instead of harmonic motion: rectangular, triangular, trapezoidal, half-sine, one-sine, one-cosine, "
        "ricker or antisymmetric-ricker. Its duration is the period; for a half-sine, half of it.",
    ),
]

Model = Annotated[
    str | None,
    typer.Option(
        "--model",
        metavar="MODEL",
        help="Equation of motion for a block in SI: slender, for small angles, or full. Default: slender.",
    ),
]
Plot = Annotated[
    Path | None,
    file_option(
        "--plot",
        "Plot the time history and phase portrait, for a long run the last 30 cycles (.png .svg .pdf), or write an animation "
        "(.gif .mp4).",
    ),
]
Csv = Annotated[
    Path | None,
    file_option(
        "--csv",
        "Write time, angle and velocity at equal time steps (.csv). An overturning motion ends at |Θ| = 3, "
        "that of a full block when it lies flat.",
    ),
]
Netcdf = Annotated[
    Path | None, file_option("--netcdf", "Write the computed data with units and parameters (.nc).")
]
VerdictPlot = Annotated[
    Path | None,
    file_option(
        "--plot",
        "Plot the last cycles, the phase portrait, the Poincaré section and the verdict (.png .svg .pdf).",
    ),
]
MaxCycles = Annotated[int, number_option("--max-cycles", "Maximum number of forcing cycles.")]
MaxPeriod = Annotated[
    int, number_option("--max-period", "Longest response period sought, in forcing cycles.")
]
Step = Annotated[
    float,
    number_option(
        "--step",
        "Largest step along a branch, in units of the range and of one radian of phase, in [1e-6, 0.1].",
    ),
]
Prove = Annotated[
    bool,
    typer.Option("--prove", help="Prove a periodic response in ball arithmetic; needs the extra `proof`."),
]
ModeCycles = Annotated[int, number_option("-n", "Response period in forcing cycles: 1, 3, 5, ….")]
ModesPlot = Annotated[
    Path | None,
    file_option("--plot", "Plot the velocity and phase of the modes over the amplitude (.png .svg .pdf)."),
]
ModesCsv = Annotated[Path | None, file_option("--csv", "Write one row per mode (.csv).")]
Store = Annotated[
    Path | None,
    typer.Option(
        "--store",
        parser=folder,
        metavar="DIR",
        help="Zarr store, written during the run; repeating the command resumes it.",
    ),
]
Repair = Annotated[bool, typer.Option("--repair", help="Recompute damaged tiles of the store.")]
SurveyCycles = Annotated[
    Number, number_option("--max-cycles", "Maximum number of forcing cycles. Default: 10,000.")
]
SurveyPeriod = Annotated[
    Number,
    number_option("--max-period", "Longest response period sought, in forcing cycles. Default: 64."),
]
SurveyNetcdf = Annotated[
    Path | None, file_option("--netcdf", "Write all results with their description (.nc).")
]
Json = Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")]


IN_SI = {"amplitude": "acceleration", "period": "period_s", "frequency": "frequency_hz"}
DEFAULTS: dict[str, Any] = dict.fromkeys((*SYSTEM, *START)) | dict.fromkeys(ZERO, 0.0)
"""Values of the options that are not given."""
BRACES = {"angle": option("brace_angle"), "restitution": option("brace_restitution")}
NORMALISED_NEEDS = "--amplitude, --period (or --frequency) and --restitution"
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)"


def kinds(given: Mapping[str, Any]) -> tuple[list[str], list[str]]:
    """Return the names of the given normalised options and SI options; YourInput if both kinds are given."""
    normalised, physical = (
        [name for name in kind if given.get(name) is not None] for kind in (NORMALISED, SI)
    )
    if normalised and physical:
        name = normalised[0]
        raise YourInput(
            f"{option(name)} is normalised and {option(physical[0])} is SI: use one of the two (the SI option is {option(IN_SI[name])})"
        )
    return normalised, physical


def question(given: Mapping[str, Any]) -> tuple[System, State, Block | None]:
    """Return the system, the initial state and, with SI input, the block of the options; YourInput if invalid."""
    from rocking.model.block import Block
    from rocking.model.forcing import Harmonic
    from rocking.model.system import MAX_START, MODELS, State, System
    from rocking.model.validation import within

    given = DEFAULTS | dict(given)
    normalised, physical = kinds(given)
    if not normalised and not physical:
        raise YourInput(f"no system is given: give {NORMALISED_NEEDS}, or in SI {SI_NEEDS}")
    if normalised:
        require(given, (("amplitude",), ("period", "frequency"), ("restitution",)), NORMALISED_NEEDS)
    else:
        require(given, (("height",), ("width",), SI[2:5], SI[5:]), SI_NEEDS)
    braced = braces(given)
    with your_input(ARGUMENTS):
        start = State(*(within(name, given[name], -MAX_START, MAX_START) for name in START))
        if normalised:
            if given.get("model") is not None:
                raise YourInput("--model needs a block in SI: give --critical-angle with normalised input")
            forcing = Harmonic(**{name: given[name] for name in (*NORMALISED, "phase")})
            system = System(forcing, given["restitution"], braced, critical_angle=given["critical_angle"])
            block = None
        else:
            if given["critical_angle"] is not None:
                raise YourInput("--critical-angle is normalised: with --height and --width give --model full")
            block = Block(given["height"], given["width"], given["restitution"])
            base = {name: given[name] for name in (*SI[2:], "phase")}
            system = block.system(**base, braces=braced, model=given.get("model") or MODELS[0])
        return system if given.get("pulse") is None else pulsed(system, given), start, block


def pulsed(system: System, given: Mapping[str, Any]) -> System:
    """Return a system with one pulse of the amplitude and the period of its harmonic base motion."""
    from attrs import evolve

    from rocking.model.forcing import Pulse

    for name in ("phase", "displacement"):
        if given[name]:
            raise YourInput(f"{option(name)} belongs to harmonic motion: omit it with --pulse")
    part = 0.5 if given["pulse"] == "half-sine" else 1.0
    wave = system.periodic
    return evolve(
        system, forcing=Pulse(given["pulse"], amplitude=wave.amplitude, duration=part * wave.period)
    )


def braces(given: Mapping[str, Any]) -> Braces | None:
    """Return the braces of the options, if there are any; YourInput if invalid."""
    from rocking.model.system import Braces

    if given["brace_angle"] is None:
        if given["brace_restitution"] is not None:
            raise YourInput("--brace-restitution needs --brace-angle")
        return None
    restitution = 1.0 if given["brace_restitution"] is None else given["brace_restitution"]
    with your_input(BRACES):
        return Braces(given["brace_angle"], restitution)


def require(given: Mapping[str, Any], groups: Iterable[tuple[str, ...]], needs: str) -> None:
    """Raise YourInput if all options of a group are missing; each group needs one of its options."""
    missing = [option(group[0]) for group in groups if all(given.get(name) is None for name in group)]
    if missing:
        lacks = " and ".join(missing)
        raise YourInput(f"missing {lacks}" if lacks == needs else f"missing {lacks}: give {needs}")
