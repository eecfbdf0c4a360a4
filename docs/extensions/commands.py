"""Reference of the commands, made from the definitions of the command line: three directives.

``{command-summary}`` is the table of all commands. ``{shared-options}`` documents the options that several commands have in common.
``{command} simulate`` documents one command: its usage, its own options, links to the shared options, and its examples.
"""

import inspect
import re

from command_options import AXIS, GROUPS, RANGE, REST, commands, group_of, options, shared
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList


def markdown(text):
    """Escape a help text, and set the names of options and values as code; what stands between backticks is code as it is."""
    return "".join(part if part.startswith("`") else plain(part) for part in re.split(r"(`[^`]+`)", text))


def plain(text):
    """Escape a text without code, and set the names of options and values as code."""
    escaped = re.sub(r"([*_<\[\\`|])", r"\\\1", text)
    return re.sub(r"(?<![\w-])(--?[a-z][\w-]*|[A-Z]+(?::[A-Z]+)+)", r"`\1`", escaped)


def entry(signature, text):
    """Return the lines that describe an option."""
    return [f"```{{option}} {signature}", markdown(text), "```", ""]


class Made(Directive):
    """Directive whose content is generated as Markdown."""

    def run(self):
        holder = nodes.container(classes=["options"])
        self.state.nested_parse(StringList(list(self.lines()), source=self.name), self.content_offset, holder)
        return [holder, *self.more()]

    def more(self):
        """Make the nodes after the generated text."""
        return []


class Summary(Made):
    """Table of the commands."""

    def lines(self):
        yield from ("| Command | Purpose |", "|---|---|")
        for name, command in commands().items():
            yield f"| [rocking {name}](#rocking-{name}) | {markdown(first_sentence(command))} |"


class Shared(Made):
    """Options that mean the same in several commands, in groups."""

    def lines(self):
        yield from ("```{program} rocking", "```", "")
        found = {}
        for command in commands():
            for one in options(command):
                if one.meaning in shared():
                    found.setdefault(group_of(one.name), {})[one.meaning] = None
        for title in (*GROUPS, REST):
            if title in found:
                yield from (f"```{{rubric}} {title}", "```", "")
                for meaning in found[title]:
                    yield from entry(*meaning)


class Command(Made):
    """One command: usage, links to the shared options, own options."""

    required_arguments = 1

    def lines(self):
        (name,) = self.arguments
        command = commands()[name]
        yield from (markdown(line) for line in inspect.cleandoc(command.help).splitlines())
        arguments = "".join(f" {one.metavar}" for one in command.params if one.param_type_name == "argument")
        yield from ("", f"Usage: `rocking {name} [OPTIONS]{arguments}`", "")
        common = [one for one in options(name) if one.meaning in shared()]
        axes, ranges = ([one for one in common if one.value.endswith(end)] for end in (AXIS, RANGE))
        groups = [
            (title, [one for one in common if group_of(one.name) == title]) for title in (*GROUPS, REST)
        ]
        for title, members in [
            *groups,
            ("An axis is possible for", axes),
            ("A range is possible for", ranges),
        ]:
            if members:
                yield f"- {title}: {', '.join(map(link, members))}"
        yield from ("", f"```{{program}} rocking {name}", "```", "")
        for one in options(name):
            if one not in common:
                yield from entry(f"{one.typed} {one.value}".strip(), one.text)

    def more(self):
        examples = (commands()[self.arguments[0]].epilog or "").replace("\b", "").strip()
        examples = examples.removeprefix("Examples:").strip()
        return [nodes.literal_block(examples, examples, language="sh", shown=True)] if examples else []


def link(one):
    """Return a link to the entry of a shared option."""
    spelling = one.typed.split(", ")[0]
    return f"{{option}}`{spelling} <rocking {spelling}>`"


def first_sentence(command):
    """Return the first line of a command's help."""
    return inspect.cleandoc(command.help).partition("\n")[0]


def setup(app):
    app.add_directive("command-summary", Summary)
    app.add_directive("shared-options", Shared)
    app.add_directive("command", Command)
