"""Help page of a command: options in groups, each with its default."""

from __future__ import annotations

import click

from rocking.cli.options import NORMALISED, SI, label

GROUPS = dict.fromkeys(NORMALISED, "Normalised input") | dict.fromkeys(SI, "SI input")
UNITS = "θcr is the critical angle of the block, α its frequency parameter."
# Wide enough for `--brace-restitution NUMBER|RANGE`.
MAX_COLUMN = 32
# Characters at which no line breaks, so that names stay whole and a default stands next to its value.
UNBROKEN = {"-": "\u2011", "Default: ": "Default:\u00a0"}


def described(parameter: click.Parameter) -> str:
    """Return the help of a parameter with its default, with separators in large numbers."""
    text, default = parameter.help or "", parameter.default
    if isinstance(default, bool) or not isinstance(default, int | float | str):
        return text
    if isinstance(default, int | float):
        default = f"{default:,}" if default >= 10_000 else f"{default:g}"
    return f"{text} Default: {default}."


def write_options(command: click.Command, context: click.Context, formatter: click.HelpFormatter) -> None:
    """Write the arguments and the options, one section for each group that is not empty."""
    sections: dict[str, list[tuple[str, str]]] = {
        name: [] for name in ("Arguments", *GROUPS.values(), "Options")
    }
    for parameter in command.get_params(context):
        if isinstance(parameter, click.Argument):
            sections["Arguments"].append((label(parameter), described(parameter)))
        elif record := parameter.get_help_record(context):
            sections[GROUPS.get(parameter.name, "Options")].append((record[0], described(parameter)))
    width = max(len(name) for records in sections.values() for name, _ in records)
    first = next((section for section in GROUPS.values() if sections[section]), None)
    for section, records in sections.items():
        if not records:
            continue
        with formatter.section(section):
            if section == first:
                formatter.write_text(UNITS)
            formatter.write_dl(
                [(name.ljust(width), replaced(text, UNBROKEN)) for name, text in records], MAX_COLUMN
            )
    back = {special: plain for plain, special in UNBROKEN.items()}
    formatter.buffer[:] = [replaced(text, back) for text in formatter.buffer]


def replaced(text: str, pairs: dict[str, str]) -> str:
    """Replace each key of `pairs` in a text by its value."""
    for old, new in pairs.items():
        text = text.replace(old, new)
    return text
