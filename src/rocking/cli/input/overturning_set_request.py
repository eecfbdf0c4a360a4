"""Computation of an overturning set from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import level_request
from rocking.cli.option_names import computing

if TYPE_CHECKING:
    from rocking.model.record_results import OverturningSet

OWN = ("angle", "polarity")


def question(typed: Mapping[str, Any], file: Path | None) -> level_request.Question:
    """Return the request given by options and study file; options take precedence."""
    return level_request.of_any_measure(typed, file, "scales", OWN)


def compute(asked: level_request.Question) -> OverturningSet:
    """Compute the overturning set; YourInput if an argument is invalid."""
    from rocking.survey.overturning_set import overturning_set

    with computing(asked.typed):
        return overturning_set(**asked.arguments)
