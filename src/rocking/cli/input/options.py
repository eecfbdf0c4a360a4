"""The options that commands share, declared once, and what they mean: a system, normalised or of a block in SI, and a start."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from rocking.cli.option_names import ARGUMENTS, NORMALISED, SI, START, SYSTEM, YourInput, option, your_input

if TYPE_CHECKING:
    from rocking.model import Block, State, System


Command = TypeVar("Command", bound=Callable[..., None])


def number(text: str) -> float:
    """An int or a float, as it is written."""
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    raise typer.BadParameter(f"must be a number alone, such as 0.6; got {text!r}")


def number_option(name: str, text: str) -> Any:
    """An option that is a number."""
    return typer.Option(name, parser=number, metavar="NUMBER", help=text)


def folder(text: str) -> Path:
    """A folder's name, which what is not set is not."""
    if not text:
        raise typer.BadParameter("must be the path of a folder; got ''")
    return Path(text)


def file_option(name: str, text: str) -> Any:
    """An option that is a file to be written."""
    return typer.Option(name, metavar="FILE", help=text)


Number = float | None

HELP = {
    "amplitude": "Normalised: A of the base, in units of g θcr.",
    "period": "Normalised: T of the base, in τ.",
    "frequency": "Normalised: Ω of the base, instead of --period.",
    "height": "SI: of the block, m.",
    "width": "SI: of the block, m.",
    "acceleration": "SI: amplitude of the base, m/s².",
    "acceleration_g": "SI: the same in units of g.",
    "displacement": "SI: or of the base's displacement, m.",
    "frequency_hz": "SI: of the base, Hz.",
    "period_s": "SI: of the base, s, instead of --frequency-hz.",
    "restitution": "e at an impact; in SI Housner's unless given.",
    "phase": "φ of the base's acceleration, rad.",
    "brace_angle": "Θb of side braces, in θcr; no braces unless given.",
    "brace_restitution": "r at a brace; 1 unless given.",
    "angle": "Θ at the start, in units of the critical angle θcr, not in degrees.",
    "velocity": "Θ' at the start, in θcr per τ.",
}
"""What an option of a system or a start says, whoever asks for it."""
ZERO = ("phase", *START)
"""What is 0 unless given, where nothing else is said of it."""


def with_options(
    *names: str, declare: Callable[[str, str], Any] = number_option, **usual: float
) -> Callable[[Command], Command]:
    """Give a command these options before its own; it takes them as ``**shared``, and all are in its context.

    ``declare`` makes an option of its name and what it says; ``usual`` is what one is unless given.
    """
    shared = []
    for name in names:
        text = HELP[name]
        if name in ZERO and name not in usual:
            text = f"{text.removesuffix('.')}; 0 unless given."
        kind = Annotated[Number, declare(option(name), text)]
        shared.append(Parameter(name, Parameter.KEYWORD_ONLY, default=usual.get(name), annotation=kind))

    def declared(command: Command) -> Command:
        context, *others = signature(command, eval_str=True).parameters.values()
        own = [
            each.replace(kind=Parameter.KEYWORD_ONLY) for each in others if each.kind != Parameter.VAR_KEYWORD
        ]
        command.__signature__ = Signature([context, *shared, *own])  # type: ignore[attr-defined]
        return command

    return declared


Cycles = Annotated[int, number_option("--cycles", "Cycles of the base to run.")]

Plot = Annotated[
    Path | None,
    file_option(
        "--plot",
        "History and phase portrait, of a long run its last 30 cycles (.png .svg .pdf), or film (.gif .mp4).",
    ),
]
Csv = Annotated[
    Path | None, file_option("--csv", "Time, angle and velocity at even steps, a fall up to |Θ| = 3 (.csv).")
]
Netcdf = Annotated[Path | None, file_option("--netcdf", "The same with its description (.nc).")]
VerdictPlot = Annotated[
    Path | None,
    file_option("--plot", "Last cycles, phase portrait and section, with the verdict (.png .svg .pdf)."),
]
MaxCycles = Annotated[int, number_option("--max-cycles", "Cycles of the base to follow at most.")]
MaxPeriod = Annotated[int, number_option("--max-period", "Longest period looked for, in cycles of the base.")]
ModeCycles = Annotated[int, number_option("-n", "Forcing cycles in a response: 1, 3, 5, ….")]
ModesPlot = Annotated[
    Path | None, file_option("--plot", "Speed and phase of the modes over the amplitude (.png .svg .pdf).")
]
Store = Annotated[
    Path | None,
    typer.Option(
        "--store",
        parser=folder,
        metavar="DIR",
        help="Zarr store, written while it runs; the same command goes on with it.",
    ),
]
Repair = Annotated[
    bool, typer.Option("--repair", help="Compute tiles of the store again that are found damaged.")
]
SurveyCycles = Annotated[
    Number, number_option("--max-cycles", "Cycles of the base to follow at most; 10,000 unless given.")
]
SurveyPeriod = Annotated[
    Number,
    number_option("--max-period", "Longest period looked for, in cycles of the base; 64 unless given."),
]
SurveyNetcdf = Annotated[
    Path | None, file_option("--netcdf", "All that was found, with its description (.nc).")
]
Json = Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")]


IN_SI = {"amplitude": "acceleration", "period": "period_s", "frequency": "frequency_hz"}
DEFAULTS: dict[str, Any] = dict.fromkeys((*SYSTEM, *START)) | dict.fromkeys(ZERO, 0.0)
"""What is meant where nothing is said."""
BRACES = {"angle": option("brace_angle"), "restitution": option("brace_restitution")}
NORMALISED_NEEDS = "--amplitude, --period (or --frequency) and --restitution"
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)"


def kinds(given: Mapping[str, Any]) -> tuple[list[str], list[str]]:
    """What is given normalised, and what in SI; refused as `YourInput` where it is both."""
    normalised, physical = (
        [name for name in kind if given.get(name) is not None] for kind in (NORMALISED, SI)
    )
    if normalised and physical:
        name = normalised[0]
        raise YourInput(
            f"{option(name)} is normalised, {option(physical[0])} is SI: give one kind (in SI it is {option(IN_SI[name])})"
        )
    return normalised, physical


def question(given: Mapping[str, Any]) -> tuple[System, State, Block | None]:
    """The system and the start that the options ask for, and the block if they are in SI; refused as `YourInput`."""
    from rocking.model import MAX_START, Block, Harmonic, State, System, within

    given = DEFAULTS | dict(given)
    normalised, physical = kinds(given)
    if not normalised and not physical:
        raise YourInput(f"give {NORMALISED_NEEDS}, or in SI {SI_NEEDS}")
    if normalised:
        require(given, (("amplitude",), ("period", "frequency"), ("restitution",)), NORMALISED_NEEDS)
    else:
        require(given, (("height",), ("width",), SI[2:5], SI[5:]), SI_NEEDS)
    braces = _braces(given)
    with your_input(ARGUMENTS):
        start = State(*(within(name, given[name], -MAX_START, MAX_START) for name in START))
        if normalised:
            forcing = Harmonic(**{name: given[name] for name in (*NORMALISED, "phase")})
            return System(forcing, given["restitution"], braces), start, None
        block = Block(given["height"], given["width"], given["restitution"])
        return block.system(**{name: given[name] for name in (*SI[2:], "phase")}, braces=braces), start, block


def _braces(given: Mapping[str, Any]) -> Any:
    from rocking.model import Braces

    if given["brace_angle"] is None:
        if given["brace_restitution"] is not None:
            raise YourInput("--brace-restitution needs --brace-angle")
        return None
    restitution = 1.0 if given["brace_restitution"] is None else given["brace_restitution"]
    with your_input(BRACES):
        return Braces(given["brace_angle"], restitution)


def require(given: Mapping[str, Any], groups: Iterable[tuple[str, ...]], needs: str) -> None:
    """Refuse as `YourInput` what lacks all of a group of options, one of which is needed."""
    missing = [option(group[0]) for group in groups if all(given.get(name) is None for name in group)]
    if missing:
        raise YourInput(f"missing {' and '.join(missing)}: give {needs}")
