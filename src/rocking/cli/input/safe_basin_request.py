"""Computation of a safe basin from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.input.axis import AMPLITUDES, only_range
from rocking.cli.input.survey_quantities import Question
from rocking.cli.option_names import COUNTS, RANGE_FORM, START, SYSTEM
from rocking.cli.output.files import SUFFIXES
from rocking.cli.output.survey_run import carried_out

if TYPE_CHECKING:
    from rocking.model.survey_results import SafeBasin

# Words in messages of `safe_basin` → words on the command line.
WORDS = {"a pair (low, high)": f"a range, {RANGE_FORM},", "low < high": "START < STOP"}
OWN = ("samples", "seed", *COUNTS)


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """Return the request given by options and study file; options take precedence."""
    checks: dict[str, study_file.Check] = {
        **survey_quantities.varying(*AMPLITUDES),
        **survey_quantities.fixed(*(name for name in SYSTEM if name not in AMPLITUDES)),
        "model": study_file.model,
        **{name: partial(_range, name) for name in START},
        **survey_quantities.counts(*OWN),
        **survey_quantities.paths(*SUFFIXES),
    }
    given = study_file.asked(typed, file, checks)
    places = {name: given.pop(name) for name in SUFFIXES if name in given}
    drawn = {name: given.pop(name) for name in (*START, *OWN) if name in given}
    numbers = survey_quantities.normalised(given)
    survey_quantities.require_axes(given, *AMPLITUDES)
    reach = min(numbers.get("brace_angle", 1.0), 1.0)
    system = {name: numbers[name] for name in SYSTEM if name in numbers}
    return Question({**system, "angle": (-reach, reach), **drawn}, places, survey_quantities.block_of(given))


def _range(name: str, entry: Any) -> Any:
    """Return the ends of a range: START:STOP, a table of start and stop, or a list of two numbers."""
    if isinstance(entry, Mapping):
        return study_file.span(name, entry)
    if not isinstance(entry, str):
        return entry
    try:
        return only_range(entry)
    except typer.BadParameter as error:
        raise ValueError(f"{name} {error.message}") from None


def compute(asked: Question) -> SafeBasin:
    """Compute the safe basin."""
    from rocking.survey.basins import safe_basin

    found: SafeBasin = carried_out(safe_basin, asked.arguments, asked.block, WORDS)
    return found
