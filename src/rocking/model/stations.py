"""Horizontal components of one station in a set: which belong together, one of them by a rule, and those of any azimuth."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking.model.ground_motion import GroundMotion
from rocking.model.text import counted, listed
from rocking.model.validation import Refusal, Text

RULES = ("first", "larger")
"""Rules by which one component of a station is chosen: the first in the set, or the one with the larger PGA."""


def stations(motions: Sequence[GroundMotion]) -> list[list[int]]:
    """Return the places of the motions of each station, in the order in which the stations occur; a vertical one is alone.

    Components are channels of one file, or motions whose headers have the same name, step and number of samples. Motions
    without a file belong together if they have one name, different components, and the same step and number of samples.
    """
    of_file: dict[str, tuple[Any, ...]] = {}
    result: dict[tuple[Any, ...], list[int]] = {}
    seen: Counter[tuple[Any, ...]] = Counter()
    for place, each in enumerate(motions):
        file = each.file
        name = (each.name if each.component else "") if file is None else file.station
        key: tuple[Any, ...] = (file is None, name, each.step, each.times.size) if name else (place,)
        if each.vertical:
            key = ("vertical", place)
        elif file is not None:
            key = of_file.setdefault(file.sha256, key)
        # A component that occurs again is that of another motion.
        seen[key, each.component] += 1
        result.setdefault((*key, seen[key, each.component]), []).append(place)
    return list(result.values())


def chosen(motions: Sequence[GroundMotion], rule: str) -> list[int]:
    """Return the place of one motion of each station by a rule."""
    places = stations(motions)
    if rule == "first":
        return [group[0] for group in places]
    return [max(group, key=lambda place: motions[place].pga) for group in places]


def turned(first: GroundMotion, second: GroundMotion, angle: float) -> GroundMotion:
    """Return `GroundMotion.rotated`; channels of one file, which begin together, are first clipped to the shorter one."""
    shorter = min(first.duration, second.duration)
    one_file = first.file is not None and second.file is not None and first.file.sha256 == second.file.sha256
    if one_file and first.step == second.step:
        first, second = (
            each if each.duration == shorter else each.clipped(0, shorter) for each in (first, second)
        )
    return first.rotated(second, angle)


def rotated(
    motions: Sequence[GroundMotion], names: Sequence[str], angles: Sequence[float]
) -> tuple[list[GroundMotion], list[list[int]]]:
    """Return the components of each station at some angles in rad, and the places of the two components of each station."""
    pairs = stations(motions)
    for group in pairs:
        if len(group) != 2:
            which = f"{counted(len(group), 'component')}: {listed([names[place] for place in group])}"
            raise Refusal("records", "hold two horizontal components of each station", Text(which))
    result = []
    for first, second in pairs:
        try:
            result += [turned(motions[first], motions[second], angle) for angle in angles]
        except Refusal as error:
            raise error.of({"other": names[second], "this component": names[first]}) from None
    return result, pairs


def shared(
    columns: Mapping[str, np.ndarray], pairs: Sequence[Sequence[int]], times: int
) -> dict[str, np.ndarray]:
    """Return the columns whose values both components of each station share, each value repeated."""
    result = {}
    for name, column in columns.items():
        first, second = column[np.array(pairs)].T
        if ((first == second) | (np.isnan(first) & np.isnan(second))).all():
            result[name] = np.repeat(first, times)
    return result
