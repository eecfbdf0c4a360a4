"""Command-line application: the commands of the table `commands`, from their options to their output."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import click

from rocking.cli import help as help_page
from rocking.cli.commands import COMMANDS, Command
from rocking.cli.options import InvalidInput, refusals, reworded
from rocking.cli.study import study_option, with_keys

SETTINGS = {"help_option_names": ["-h", "--help"], "max_content_width": 120}


class ClickCommand(click.Command):
    """Command of the table."""

    def __init__(self, command: Command) -> None:
        study = [study_option(checked=command.survey)] if command.report else []
        super().__init__(
            command.name,
            SETTINGS,
            callback=click.pass_context(lambda context, **_: run(command, context)),
            params=[*command.options, *study, *command.outputs],
            help=f"{command.about}\n\n{command.details}",
            # The control character keeps the line breaks of the examples below the options.
            epilog=f"\b\nExamples:\n{command.examples.strip()}" if command.examples else None,
            short_help=command.about,
        )

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the arguments and the options in groups."""
        help_page.write_options(self, ctx, formatter)

    def format_arguments(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write nothing: the arguments stand above the options."""


class Application(click.Group):
    """All commands, in the order of the table."""

    def list_commands(self, _: click.Context) -> list[str]:
        """Return the names of the commands."""
        return [command.name for command in COMMANDS]

    def get_command(self, _: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command by name, None if there is none."""
        return next((ClickCommand(command) for command in COMMANDS if command.name == cmd_name), None)


@click.group(
    cls=Application,
    invoke_without_command=True,
    subcommand_metavar="COMMAND [ARGS]...",
    context_settings=SETTINGS,
)
@click.option("--version", is_flag=True, help="Show the version and exit.")
@click.pass_context
def app(context: click.Context, version: bool) -> None:
    """Simulate and analyse free-standing blocks that rock on a moving base.

    Run rocking COMMAND --help for the options and examples of a command.
    """
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        context.exit(2)


def load(path: str) -> Any:
    """Return the object at a path such as "rocking.survey.fragility.fragility"."""
    module, _, name = path.rpartition(".")
    return getattr(import_module(module), name)


def run(command: Command, context: click.Context) -> None:
    """Run a command; messages about options name the study file that gives them."""
    if not command.report:
        load(command.function)(**context.params)
        return
    options = {name: value for name, value in context.params.items() if is_set(value)}
    try:
        compute_and_write(command, options)
    except InvalidInput as error:
        if "study" not in options:
            raise
        typed = [
            name
            for name in options
            if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE
        ]
        raise InvalidInput(with_keys(error.message, options["study"], typed)) from error


def is_set(value: Any) -> bool:
    """Return whether an option is given: not None, no switch that is off, no option that may be repeated without a value."""
    return not (value is None or value is False or (isinstance(value, tuple) and not value))


def compute_and_write(command: Command, options: dict[str, Any]) -> None:
    """Compute the result of a command, write its files and print it. All files are checked before the computation."""
    from rocking.cli import output

    files = output.check_files(command.outputs, options)
    request = load(f"rocking.cli.{command.inputs}")(options)
    with computing(command, request.names):
        result = load(command.function)(
            **request.arguments, **({"progress": True} if command.progress else {})
        )
    report = load(f"rocking.cli.{command.report}")
    store = options.get("store")
    with output.complete(store):
        output.write(report, result, request, files)
    output.show(report, result, request, [*([store] if store else []), *files.values()])


@contextmanager
def computing(command: Command, names: dict[str, str]) -> Iterator[None]:
    """Convert errors to messages with the names of options, and show the progress on stderr.

    An interrupted survey prints how to resume it.
    """
    from rocking.model.progress import Bar

    with refusals(names):
        if not command.progress:
            with Bar(what="computing"):
                yield
            return
        try:
            yield
        except KeyboardInterrupt as error:
            for note in getattr(error, "__notes__", ()):
                print(f"rocking: {reworded(note)}", file=sys.stderr)
            raise
