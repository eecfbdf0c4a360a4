"""Options of the commands, from the definitions of the command line: which several commands share, and which are their own."""

from functools import cache
from typing import NamedTuple

from rocking.cli import options as shared_options
from rocking.cli.app import app
from rocking.cli.help import described

GROUPS = {
    "Normalised input": shared_options.NORMALISED,
    "SI input": shared_options.SI,
    "Impacts, phase and braces": ("restitution", "phase", "brace_angle", "brace_restitution"),
    "Initial state": shared_options.START,
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
    return {name: app.get_command(None, name) for name in app.list_commands(None)}


@cache
def options(command):
    """List the options of a command in the order of `--help`; an argument is one of them."""
    return [
        Option(
            one.name,
            shared_options.label(one) if one.param_type_name == "argument" else ", ".join(one.opts),
            "" if one.param_type_name == "argument" else one.metavar or "",
            described(one),
        )
        for one in commands()[command].params
    ]


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
