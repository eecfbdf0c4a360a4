"""Option `--study` of commands that compute no survey: entries of the file replace the defaults of the options."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

import typer
from typer.models import OptionInfo

from rocking.cli.input import axis, study_file
from rocking.cli.input.options import Command, number
from rocking.cli.option_names import AXIS_FORM, RANGE_FORM

FORMS: dict[Any, str] = {
    axis.number_or_axis: f"a number or {AXIS_FORM}",
    axis.only_axis: f"an axis, {AXIS_FORM}",
    axis.number_or_range: f"a number or {RANGE_FORM}",
    axis.only_range: f"a range, {RANGE_FORM}",
}
"""Allowed form of an entry, by the parser of its option."""
NUMBERS = (axis.number_or_axis, axis.number_or_range)
AXES = (axis.number_or_axis, axis.only_axis)
FILES = ("plot", "animate", "csv", "netcdf", "json")
"""Options of files, before which `--study` is listed."""


def with_study(command: Command) -> Command:
    """Add the option `--study` to a command whose options are declared; the command takes it as ``**shared``.

    Options on the command line take precedence over the entries of the file.
    """
    context, *options = signature(command, eval_str=True).parameters.values()

    def fill(context: typer.Context, study: Path | None) -> Path | None:
        if study is not None:
            checks = {each.name: check for each in options if (check := _check(each)) is not None}
            context.default_map = study_file.read(study, checks)
        return study

    # Options that are typed are read before those that are not, so that the defaults of these are known in time.
    option = typer.Option("--study", metavar="FILE", help=study_file.STUDY, callback=fill)
    own = Parameter("study", Parameter.KEYWORD_ONLY, default=None, annotation=Annotated[Path | None, option])
    place = next(index for index, each in enumerate(options) if each.name in FILES)
    command.__signature__ = Signature([context, *options[:place], own, *options[place:]])  # type: ignore[attr-defined]
    return command


def _check(parameter: Parameter) -> study_file.Check | None:
    """Return the check of the entry for an option; None for an argument, and for `--json`."""
    from rocking.cli.input.survey_quantities import paths
    from rocking.model.validation import instance

    kind, option = get_args(parameter.annotation)[:2]
    name, kinds = parameter.name, get_args(kind) or (kind,)
    if not isinstance(option, OptionInfo) or name == "json":
        return None
    if any(get_origin(each) is list for each in kinds):
        return partial(_numbers, name)
    if option.parser is number:
        return partial(study_file.number, name)
    if name == "model":
        return study_file.model
    if option.parser is not None:
        return partial(_parsed, option.parser, name)
    if Path in kinds:
        return paths(name)[name]
    return partial(instance, name, kind=bool if bool in kinds else str)


def _numbers(name: str, entry: Any) -> list[Any]:
    """Return the numbers of an option that may be repeated: one number, or a list."""
    return [study_file.number(name, each) for each in (entry if isinstance(entry, list) else [entry])]


def _parsed(parser: Callable[[Any], Any], name: str, entry: Any) -> Any:
    """Return a number, an axis or a range as the parser of its option accepts it; an axis or a range may be a table."""
    from rocking.model.validation import refusal

    form = FORMS[parser]
    if isinstance(entry, Mapping):
        entry = (study_file.quantity if parser in AXES else study_file.span)(name, entry)
    elif isinstance(entry, str):
        if parser in NUMBERS:
            study_file.check_unquoted(name, entry, f"be {form}")
    elif isinstance(entry, int | float) and not isinstance(entry, bool):
        entry = study_file.number(name, entry)
    else:
        raise TypeError(refusal(name, f"be {form}", entry))
    try:
        return parser(entry)
    except typer.BadParameter as error:
        raise ValueError(f"{name} {error.message}") from None
