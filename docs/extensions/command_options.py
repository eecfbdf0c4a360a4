"""Options of the commands, from the definitions of the command line: which several commands share, and which are their own."""

from functools import cache
from typing import NamedTuple

import typer

from rocking.cli import option_names
from rocking.cli.app import app

GROUPS = {
    "Normalised input": option_names.NORMALISED,
    "SI input": option_names.SI,
    "Impacts, phase and braces": ("restitution", "phase", "brace_angle", "brace_restitution"),
    "Initial state": option_names.START,
}
REST = "Runs and files"
AXIS = "|AXIS"  # end of the placeholder of a value that may be an axis
RANGE = "|RANGE"  # end of that of a value that may be a range


class Option(NamedTuple):
    """Option or argument of a command, as `--help` describes it."""

    name: str
    typed: str
    value: str
    text: str

    @property
    def signature(self):
        """Spelling with the placeholder of its value, without the axis or the range that some commands allow."""
        return f"{self.typed} {self.value.removesuffix(AXIS).removesuffix(RANGE)}".strip()

    @property
    def meaning(self):
        """Signature and text, which are equal in all commands that share the option."""
        return self.signature, self.text


@cache
def commands():
    """Map the name of each command to its definition."""
    return dict(typer.main.get_command(app).commands)


@cache
def options(command):
    """List the options of a command in the order of `--help`; an argument is one of them."""
    return [
        Option(
            one.name,
            one.metavar if one.param_type_name == "argument" else ", ".join(one.opts),
            "" if one.param_type_name == "argument" else one.metavar or "",
            described(one),
        )
        for one in commands()[command].params
    ]


def described(parameter):
    """Return the help of a parameter with its default."""
    text, default = " ".join(parameter.help.split()), parameter.default
    if default is None or default is False or "Default" in text:
        return text
    return f"{text} Default: {f'{default:,}'.removesuffix('.0') if isinstance(default, int | float) else default}."


@cache
def shared():
    """Map the meaning of each option that several commands share to those commands.

    If a spelling has two meanings, the more frequent one is shared.
    """
    users = {}
    for command in commands():
        for one in options(command):
            users.setdefault(one.meaning, []).append(command)
    most = {}
    for meaning, names in users.items():
        spelling = meaning[0].partition(" ")[0]
        if len(names) > len(most.get(spelling, (meaning, [""]))[1]):
            most[spelling] = (meaning, names)
    return dict(most.values())


def group_of(name):
    """Return the title of the group of an option."""
    return next((title for title, names in GROUPS.items() if name in names), REST)
