"""Options of `rocking overturning-set`, and their conversion to records, a block and levels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rocking.cli.input import record_request
from rocking.cli.input.axis import Axis
from rocking.cli.option_names import AXIS_FORM, YourInput, option, options, your_input

if TYPE_CHECKING:
    from rocking.model import OverturningSet

MEASURES = ("scale", "pga", "pga_g", "pgv", "pgd", "arias", "pga_ratio", "pgv_ratio")
"""Options whose value is the axis of the levels."""
READING = ("channel", "units", "step", "baseline")


def compute(given: Mapping[str, Any]) -> tuple[OverturningSet, list[str]]:
    """Return the overturning set of the options, and the warnings of the reader; YourInput if invalid."""
    from rocking.survey import overturning_set

    name, levels = _levels(given)
    block, _, start = record_request.block_and_start(
        {**given, "velocity": 0.0, "brace_angle": None, "brace_restitution": None}
    )
    records, doubts = _records(given)
    arguments = record_request.ARGUMENTS | options("polarity") | {"scales": option(name)}
    with your_input(arguments):
        found = overturning_set(
            records,
            block,
            levels,
            intensity=name.replace("_", "-"),
            angle=start.angle,
            polarity=given["polarity"],
        )
    return found, doubts


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


def _records(given: Mapping[str, Any]) -> tuple[Any, list[str]]:
    """Return the records of all files, and the warnings of the reader."""
    from rocking.model import RecordSet

    reading = {name: given[name] for name in READING}
    records, doubts = [], []
    for file in given["files"]:
        motion, told = record_request.ground_motion({**reading, "file": file, "scale": None, "pga_g": None})
        records.append(motion)
        doubts += told
    with your_input():
        return RecordSet(records), doubts
