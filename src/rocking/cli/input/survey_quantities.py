"""Quantities of a survey from options or a study file: checks and normalisation."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input.axis import VARIES, Axis
from rocking.cli.input.options import question
from rocking.cli.input.study_file import Check, number, quantity
from rocking.cli.option_names import AXIS_FORM, QUANTITIES, SI, YourInput, option
from rocking.model.block import Block
from rocking.model.system import quantities
from rocking.model.validation import instance, reals, refusal, whole

if TYPE_CHECKING:
    import numpy as np


@frozen
class Question:
    """Request of a survey: arguments of its function, output paths, and with SI input the block."""

    arguments: dict[str, Any]
    places: dict[str, Path]
    block: Block | None


def normalised(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return normalised numbers and arrays of quantities given as numbers, axes and lists."""
    import numpy as np

    varied = {name: each for name, each in given.items() if isinstance(each, Axis)}
    lists = {name: each for name, each in given.items() if np.ndim(each) > 0 and name not in varied}
    if any(name in SI for name in lists):
        raise YourInput(
            f"{option(next(iter(lists)))} with SI input must be a number or {AXIS_FORM}; got a list"
        )
    if "displacement" in given and ("frequency_hz" in varied or "period_s" in varied):
        raise YourInput(
            "--displacement with an axis of the frequency varies amplitude and frequency: use --acceleration instead"
        )
    # Valid ranges are intervals, so that two valid ends imply valid values between them.
    ends = []
    for end in ("start", "stop"):
        at = {name: getattr(each, end) if isinstance(each, Axis) else each for name, each in given.items()}
        at |= {name: each[0 if end == "start" else -1] for name, each in lists.items()}
        ends.append(_numbers(at))
    first, last = ends
    points = {VARIES.get(name, name): span.points for name, span in varied.items()}
    asked = {
        name: ascending(Axis(first[name], last[name], points[name])) if name in points else first[name]
        for name in QUANTITIES
        if name in first
    }
    return asked | lists


def _numbers(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the quantities of a system and an initial state by their names in `parametric_map`."""
    system, start, _ = question(given)
    numbers = quantities(system) | {"angle": start.angle, "velocity": start.velocity}
    del numbers["period" if "frequency" in given or "frequency_hz" in given else "frequency"]
    return numbers


def block_of(given: Mapping[str, Any]) -> Block | None:
    """Return the block of SI input, else None; a varying restitution is replaced by its first value."""
    from rocking.model.block import Block

    if "height" not in given:
        return None
    for name in ("height", "width"):
        if isinstance(given[name], Axis | list):
            raise YourInput(f"{option(name)} must be one number, in m: a survey has a single block")
    restitution = given.get("restitution")
    first = restitution.start if isinstance(restitution, Axis) else restitution
    return Block(given["height"], given["width"], first[0] if isinstance(first, list) else first)


def require_axes(given: Mapping[str, Any], *names: str) -> None:
    """Raise YourInput for a quantity that is a number, but must be an axis."""
    for name in names:
        if isinstance(given.get(name), int | float):
            raise YourInput(f"{option(name)} must be an axis, {AXIS_FORM}; got {given[name]:g}")


def values(asked: Any) -> Any:
    """Return a number or a list unchanged, an axis as its values in ascending order."""
    return ascending(asked) if isinstance(asked, Axis) else asked


def ascending(axis: Axis) -> np.ndarray:
    """Return the values of an axis in ascending order."""
    import numpy as np

    low, high = sorted((axis.start, axis.stop))
    return np.linspace(low, high, axis.points)


def varying(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are numbers, axes or lists."""
    return {name: partial(quantity, name) if name in SI else partial(_in_range, name) for name in names}


def fixed(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are numbers."""
    return {name: partial(_number, name) for name in names}


def counts(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are whole numbers between limits."""
    from rocking.response.classify import MAX_CYCLES, MAX_PERIOD
    from rocking.survey.overturning_amplitude import MAX_PHASES
    from rocking.survey.random_points import MAX_SAMPLES, MAX_SEED

    limits = {
        "samples": (1, MAX_SAMPLES),
        "seed": (0, MAX_SEED),
        "phases": (1, MAX_PHASES),
        "max_cycles": (1, MAX_CYCLES),
        "max_period": (1, MAX_PERIOD),
        "boundary_runs": (0, MAX_SAMPLES),
    }
    return {name: partial(whole, name, low=limits[name][0], high=limits[name][1]) for name in names}


def path_checks(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are paths, and of `repair`, which belongs to a store."""
    return paths(*names) | {"repair": partial(instance, "repair", kind=bool)}


def paths(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are paths."""
    return {name: partial(_path, name) for name in names}


def _in_range(name: str, entry: Any) -> Any:
    from rocking.survey.spec import check_quantity

    read = quantity(name, entry)
    for each in read[:2] if isinstance(read, Axis) else (read,):
        check_quantity(name, each)
    return read


def _number(name: str, entry: Any) -> Any:
    from rocking.survey.spec import check_quantity

    number(name, entry)
    return reals(name, entry) if name in SI else check_quantity(name, entry)


def _path(name: str, entry: Any) -> Path:
    if not isinstance(entry, str):
        raise TypeError(refusal(name, "be a path", entry))
    return Path(entry)
