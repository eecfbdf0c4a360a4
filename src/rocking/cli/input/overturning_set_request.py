"""Computation of an overturning set from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import level_request, study_file
from rocking.cli.option_names import YourInput, option, your_input

if TYPE_CHECKING:
    from rocking.model import OverturningSet

MEASURES = ("scale", "pga", "pga_g", "pgv", "pgd", "arias", "pga_ratio", "pgv_ratio")
"""Options whose value is the axis of the levels."""
OWN = ("angle", "polarity")


def question(typed: Mapping[str, Any], file: Path | None) -> level_request.Question:
    """Return the request given by options and study file; options take precedence."""
    checks = {name: partial(study_file.quantity, name) for name in MEASURES}
    given = level_request.values(typed, file, checks | study_file.numbers(*OWN))
    there = [name for name in MEASURES if name in given]
    if len(there) != 1:
        got = " and ".join(map(option, there)) or "none"
        raise YourInput(f"give exactly one of {', '.join(map(option, MEASURES))}; got {got}")
    return level_request.question(given, typed["sources"], there[0], "scales", OWN)


def compute(asked: level_request.Question) -> OverturningSet:
    """Compute the overturning set; YourInput if an argument is invalid."""
    from rocking.survey import overturning_set

    with your_input(asked.typed):
        return overturning_set(**asked.arguments)
