"""Requests of surveys that scale ground motions to levels of an intensity measure, for one block."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input import record_source, study_file, survey_quantities
from rocking.cli.input.axis import Axis
from rocking.cli.input.record_request import ARGUMENTS as RECORD_ARGUMENTS
from rocking.cli.input.record_request import block_of
from rocking.cli.option_names import AXIS_FORM, YourInput, option, options
from rocking.cli.output.files import SUFFIXES

if TYPE_CHECKING:
    import numpy as np

    from rocking.model.record_set import RecordSet

BLOCK = ("height", "width", "restitution", "inertia_ratio")


OF_BASELINE = ("pgv", "pgd", "pgv_ratio")
"""Options of levels that a wrong baseline changes most."""


@frozen
class Question:
    """Request of a survey: its arguments, their names in messages, records with warnings, and output paths."""

    arguments: dict[str, Any]
    typed: dict[str, str]
    sources: list[Path]
    doubts: list[str]
    places: dict[str, Path]

    @property
    def records(self) -> RecordSet:
        """Ground motions of the request."""
        records: RecordSet = self.arguments["records"]
        return records


def values(
    typed: Mapping[str, Any], file: Path | None, checks: Mapping[str, study_file.Check]
) -> dict[str, Any]:
    """Return the values given by options and study file; options take precedence. `checks` are those of one command."""
    block = study_file.numbers(*(name for name in BLOCK if name in typed))
    paths = survey_quantities.paths(*(name for name in SUFFIXES if name in typed))
    return study_file.asked(typed, file, block | record_source.checks() | dict(checks) | paths)


def question(
    given: Mapping[str, Any], sources: list[Path], measure: str, levels: str, own: tuple[str, ...]
) -> Question:
    """Return the request of given values; YourInput if invalid.

    `measure` is the option of the levels, `levels` the argument of the function for them. `own` names further arguments.
    """
    block = block_of(given)
    records, doubts = record_source.record_set(
        sources, **{name: given[name] for name in record_source.READING if name in given}
    )
    arguments = {
        "records": records,
        "block": block,
        levels: given[measure],
        "intensity": measure.replace("_", "-"),
        **{name: given[name] for name in (*own, "model") if name in given},
    }
    names = RECORD_ARGUMENTS | options(*own) | {"records": "SOURCE", levels: option(measure)}
    places = {name: given[name] for name in SUFFIXES if name in given}
    if measure in OF_BASELINE:
        doubts += record_source.drift_doubts(records)
    return Question(arguments, names, sources, doubts, places)


def measured(
    typed: Mapping[str, Any], file: Path | None, checks: Mapping[str, study_file.Check]
) -> tuple[dict[str, Any], str]:
    """Return the values given to a command with all options of levels, and the option that is given; YourInput if invalid."""
    measures = tuple(record_source.LEVELS)
    given = values(
        typed, file, {name: partial(study_file.quantity, name) for name in measures} | dict(checks)
    )
    there = [name for name in measures if name in given]
    if len(there) != 1:
        got = " and ".join(map(option, there)) or "none"
        raise YourInput(f"give exactly one of {', '.join(map(option, measures))}; got {got}")
    return given, there[0]


def of_any_measure(
    typed: Mapping[str, Any], file: Path | None, levels: str, own: tuple[str, ...]
) -> Question:
    """Return the request of a command with all options of levels and further numbers `own`; YourInput if invalid."""
    given, measure = measured(typed, file, study_file.numbers(*own))
    given[measure] = ascending(measure, given[measure])
    return question(given, typed["sources"], measure, levels, own)


def ascending(name: str, levels: Any) -> np.ndarray:
    """Return levels as an array, those of an axis in ascending order; YourInput if they are no axis and no list."""
    import numpy as np

    if isinstance(levels, Axis):
        low, high = sorted((levels.start, levels.stop))
        return np.linspace(low, high, levels.points)
    if np.ndim(levels) == 0:
        found = "nothing" if levels is None else f"{levels:g}"
        raise YourInput(f"{option(name)} must be an axis, {AXIS_FORM}; got {found} (example: 0.1:1.5:15)")
    return np.asarray(levels)
