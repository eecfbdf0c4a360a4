"""Computation of the sensitivity of verdicts from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import level_request
from rocking.cli.option_names import computing

if TYPE_CHECKING:
    from rocking.model.record_results import Sensitivity

OWN = ("seed",)


def question(typed: Mapping[str, Any], file: Path | None) -> level_request.Question:
    """Return the request given by options and study file; options take precedence."""
    asked = level_request.of_any_measure(typed, file, "levels", OWN)
    asked.typed["block"] = "the block"
    del asked.typed["restitution"]  # the message on a block names its restitution
    return asked


def compute(asked: level_request.Question) -> Sensitivity:
    """Compute the sensitivity; YourInput if an argument is invalid."""
    from rocking.survey.sensitivity import sensitivity

    with computing(asked.typed):
        return sensitivity(**asked.arguments)
