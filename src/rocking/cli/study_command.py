"""Class of all commands: its input files are known, and messages about an option name the study file that gives it."""

from __future__ import annotations

from typing import Any

from rocking.cli.command_help import CommandHelp
from rocking.cli.option_names import YourInput, set_inputs


class StudyCommand(CommandHelp):
    """Command whose messages say which of the options that they name are keys of its study file."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; YourInput as raised by it, with the keys of the study file."""
        set_inputs(ctx.params)
        try:
            return super().invoke(ctx)
        except YourInput as error:
            path = ctx.params.get("study")
            if path is None:
                raise
            from rocking.cli.input.study_file import with_keys

            typed = [name for name in ctx.params if ctx.get_parameter_source(name).name == "COMMANDLINE"]
            raise YourInput(with_keys(error.message, path, typed)) from error
