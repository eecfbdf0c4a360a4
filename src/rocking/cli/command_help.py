"""Help page of a command: options in groups, each with its default."""

from __future__ import annotations

import re
from typing import Any

from typer.core import TyperCommand

from rocking.cli.option_names import NORMALISED, SI

GROUPS = dict.fromkeys(NORMALISED, "Normalised input") | dict.fromkeys(SI, "SI input")
UNITS = "θcr is the critical angle of the block, α its frequency parameter."
# Wide enough for `--brace-restitution NUMBER|RANGE`.
MAX_COLUMN = 32
DEFAULT = re.compile(r"  \[default: (.+?)(?:\.0)?\]$")
# Characters at which no line breaks, so that names stay whole and a default stands next to its value.
UNBROKEN = {"-": "\u2011", "Default: ": "Default:\u00a0"}


class CommandHelp(TyperCommand):
    """Command whose help lists the options by `GROUPS` and prints each default as "Default: X."."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and the options, one section for each group that is not empty."""
        sections: dict[str, list[tuple[str, str]]] = {
            name: [] for name in ("Arguments", *GROUPS.values(), "Options")
        }
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is None:
                continue
            name, text = record[0], record[1].removesuffix("  [required]")
            other = "Arguments" if parameter.param_type_name == "argument" else "Options"
            section = GROUPS.get(parameter.name, other)
            # Typer appends the Python type to the name of an argument.
            sections[section].append((name.partition(" <")[0], DEFAULT.sub(_default, text)))
        width = max(len(name) for records in sections.values() for name, _ in records)
        first = next((section for section in GROUPS.values() if sections[section]), None)
        for section, records in sections.items():
            if not records:
                continue
            with formatter.section(section):
                if section == first:
                    formatter.write_text(UNITS)
                rows = [(name.ljust(width), _replaced(text, UNBROKEN)) for name, text in records]
                formatter.write_dl(rows, MAX_COLUMN)
        back = {special: plain for plain, special in UNBROKEN.items()}
        formatter.buffer[:] = [_replaced(text, back) for text in formatter.buffer]


def _default(found: re.Match[str]) -> str:
    """Return the default of an option as a sentence, with separators in large numbers."""
    value = found[1]
    return f" Default: {int(value):,}." if value.isdigit() and int(value) >= 10_000 else f" Default: {value}."


def _replaced(text: str, pairs: dict[str, str]) -> str:
    for old, new in pairs.items():
        text = text.replace(old, new)
    return text
