"""Options of `rocking overturning-set`, and their conversion to records, a block and levels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input import record_request, record_source
from rocking.cli.input.axis import Axis
from rocking.cli.option_names import AXIS_FORM, YourInput, option, options, your_input

if TYPE_CHECKING:
    from rocking.model import OverturningSet

MEASURES = ("scale", "pga", "pga_g", "pgv", "pgd", "arias", "pga_ratio", "pgv_ratio")
"""Options whose value is the axis of the levels."""
READING = ("units", "step", "baseline")


@frozen
class Question:
    """Request of an overturning set: arguments of `overturning_set`, warnings of the reader, and the option of the levels."""

    arguments: dict[str, Any]
    doubts: list[str]
    levels: str


def question(given: Mapping[str, Any]) -> Question:
    """Return the request of the options; YourInput if invalid."""
    name, levels = _levels(given)
    block, _, start = record_request.block_and_start(
        {**given, "velocity": 0.0, "brace_angle": None, "brace_restitution": None}
    )
    records, doubts = record_source.record_set(given["sources"], **{name: given[name] for name in READING})
    arguments = {
        "records": records,
        "block": block,
        "scales": levels,
        "intensity": name.replace("_", "-"),
        "angle": start.angle,
        "polarity": given["polarity"],
    }
    return Question(arguments, doubts, name)


def compute(asked: Question) -> OverturningSet:
    """Compute the overturning set; YourInput if an argument is invalid."""
    from rocking.survey import overturning_set

    with your_input(record_request.ARGUMENTS | options("polarity") | {"scales": option(asked.levels)}):
        return overturning_set(**asked.arguments)


def _levels(given: Mapping[str, Any]) -> tuple[str, Any]:
    """Return the only option with levels, and its levels in ascending order."""
    import numpy as np

    there = [name for name in MEASURES if given[name] is not None]
    if len(there) != 1:
        got = " and ".join(map(option, there)) or "none"
        raise YourInput(f"give exactly one of {', '.join(map(option, MEASURES))}; got {got}")
    (name,) = there
    levels = given[name]
    if not isinstance(levels, Axis):
        raise YourInput(f"{option(name)} must be an axis, {AXIS_FORM}; got {levels}")
    low, high = sorted((levels.start, levels.stop))
    return name, np.linspace(low, high, levels.points)
