"""Computation of a fragility from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import level_request, study_file
from rocking.cli.option_names import option, your_input

if TYPE_CHECKING:
    from rocking.model.record_results import Fragility

SPREADS = ("height_spread", "width_spread", "restitution_spread")
OWN = ("samples", "replicates", "seed", *SPREADS)


def question(typed: Mapping[str, Any], file: Path | None) -> level_request.Question:
    """Return the request given by options and study file; options take precedence."""
    from rocking.model.validation import reals

    checks: dict[str, study_file.Check] = {
        "limit": partial(reals, "limit"),
        **study_file.numbers(*OWN),
    }
    # without the option, the list of limits is empty
    given, measure = level_request.measured({**typed, "limit": typed["limit"] or None}, file, checks)
    given["limits"] = given.pop("limit", ())
    level = given[measure]
    given[measure] = [level] if isinstance(level, int | float) else level_request.ascending(measure, level)
    asked = level_request.question(given, typed["sources"], measure, "levels", ("limits", *OWN))
    asked.typed["limits"] = option("limit")
    return asked


def compute(asked: level_request.Question) -> Fragility:
    """Compute the fragility; YourInput if an argument is invalid."""
    from rocking.survey.fragility import fragility

    with your_input(asked.typed):
        return fragility(**asked.arguments, progress=True)
