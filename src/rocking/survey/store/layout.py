"""What a store holds, and whether what is asked is the same, goes further, or lies closer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from attrs import frozen

from rocking.model import VERSION, shown
from rocking.survey.measurement import Measurement
from rocking.survey.spec import SurveySpec, described
from rocking.survey.tiling import Level, even_edges, levels, thinned, tile_edges

SAME = 1e-9
"""Axis values closer than this share of their distance from the next are the same: an axis made longer rounds otherwise."""

FORMAT = 2
"""Of the files: raised when what is written is no longer what a store made before says of its arrays."""
DEFAULT_DIGITS, ALL_DIGITS = 6, 17
"""Of numbers that differ as many are told as tell them apart."""


@frozen(eq=False)
class Layout:
    """The grids of a store: the finest one's axes, along which axes each but the first halves the one before, their tiles."""

    axes: dict[str, np.ndarray]
    halved: list[tuple[bool, ...]]
    tiles: list[tuple[int, ...]]

    def levels(self) -> list[Level]:
        """Its grids, the coarsest first."""
        grids = [self.axes]
        for halved in reversed(self.halved):
            grids.insert(0, thinned(grids[0], halved))
        parts = zip(grids, [None, *self.halved], self.tiles, strict=True)
        return [Level(number, *part) for number, part in enumerate(parts)]


def new_layout(asked: SurveySpec) -> Layout:
    """The layout of a store that begins."""
    grids = levels(asked)
    halved = [each.halved for each in grids if each.halved is not None]
    return Layout(asked.axes, halved, [each.tile for each in grids])


def read_layout(stored: Mapping[str, Any]) -> Layout:
    """A layout as a store describes it; ValueError or TypeError where no `described_layout` says that."""
    missing = [name for name in ("axes", "halved", "tiles") if name not in stored]
    if missing:
        raise ValueError(f"it does not say {missing[0]}")
    axes = {name: np.array(values, float) for name, values in dict(stored["axes"]).items()}
    halved = [tuple(each) for each in stored["halved"]]
    tiles = [tuple(each) for each in stored["tiles"]]
    for name, values in axes.items():
        if (
            values.ndim != 1
            or values.size < 2
            or not np.isfinite(values).all()
            or (np.diff(values) <= 0).any()
        ):
            raise ValueError(f"{name} is no axis")
    if (
        list(axes) != stored["over"]
        or len(tiles) != len(halved) + 1
        or any(len(each) != len(axes) for each in (*halved, *tiles))
    ):
        raise ValueError("its levels, axes and tiles do not go together")
    if not all(type(flag) is bool for each in halved for flag in each):
        raise ValueError("what is halved must be true or false")
    if not all(type(edge) is int and edge > 0 for each in tiles for edge in each):
        raise ValueError("tiles must have whole numbers of points")
    return Layout(axes, halved, tiles)


def described_layout(layout: Layout) -> dict[str, Any]:
    """A layout as JSON has it."""
    return {
        "axes": {name: values.tolist() for name, values in layout.axes.items()},
        "halved": [list(each) for each in layout.halved],
        "tiles": [list(each) for each in layout.tiles],
    }


def fingerprint(asked: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """What must be the same for a store to be gone on with, and who made it."""
    import llvmlite.binding as llvm

    return {
        "survey": measure.title,
        "over": list(asked.axes),
        "fixed": described(asked),
        "options": dict(measure.options),
        "variables": [each.name for each in measure.variables],
        "method": measure.method,
        "format": FORMAT,
        "made_by": {"version": VERSION, "processor": llvm.get_host_cpu_name()},
    }


def check_described(stored: Any) -> None:
    """Refuse what `fingerprint` never says, whatever the survey; TypeError."""
    kinds = {"fixed": dict, "options": dict, "over": list, "variables": list}
    if not isinstance(stored, dict):
        raise TypeError(f"it says {shown(stored)}")
    for name, kind in kinds.items():
        if not isinstance(stored.get(name, kind()), kind):
            raise TypeError(f"it says {name} = {shown(stored[name])}")


def check_same(path: str, stored: Mapping[str, Any], mine: Mapping[str, Any]) -> None:
    """Refuse a store that was made otherwise; ValueError that says what differs."""
    ours, theirs = _flat(mine), _flat(stored)
    differences = [
        _difference(name, theirs.get(name), ours.get(name))
        for name in dict.fromkeys((*theirs, *ours))
        if theirs.get(name) != ours.get(name)
    ]
    if differences:
        raise ValueError(
            f"store {path!r} holds another survey: {'; '.join(differences)} (give another folder, or ask for the same)"
        )


def joined(path: str, stored: Layout, asked: SurveySpec) -> Layout:
    """What a store holds together with what is asked: the same axes, longer ones, or ones of half the spacing (or a quarter, …).

    Raises ValueError for axes that leave out or move what is there.
    """
    pairs = [_join(path, name, values, asked.axes[name]) for name, values in stored.axes.items()]
    axes = {name: values for name, (values, _) in zip(stored.axes, pairs, strict=True)}
    halvings = [times for _, times in pairs]
    more = [tuple(number < times for times in halvings) for number in range(max(halvings))]
    edges = tile_edges([values.size for values in axes.values()])
    layout = Layout(axes, stored.halved + more, stored.tiles + [edges] * len(more))
    for number in range(len(stored.tiles), len(layout.tiles)):
        layout.tiles[number] = even_edges(layout.levels()[number].axes, edges)
    return layout


def _join(path: str, name: str, there: np.ndarray, here: np.ndarray) -> tuple[np.ndarray, int]:
    """The values asked for, exactly as stored where they are the same; how often the spacing is halved."""
    for times in range(32):
        step = 2**times
        reach = step * (there.size - 1) + 1
        if reach > here.size:
            break
        nearest = np.diff(there).min() / step
        if np.abs(here[:reach:step] - there).max() <= SAME * nearest:
            exact = here.copy()
            exact[:reach:step] = there
            return exact, times
    raise ValueError(
        f"store {path!r} holds {there.size} values of {name} from {there[0]:.6g} to {there[-1]:.6g}, and {here.size} from "
        f"{here[0]:.6g} to {here[-1]:.6g} leave some of them out: ask for these, for more beyond the last, or for half the "
        "spacing, these among them"
    )


def _flat(told: Mapping[str, Any]) -> dict[str, Any]:
    """What is compared, by the name that it is told by."""
    alone = {name: told.get(name) for name in ("survey", "over", "variables", "method", "format")}
    return alone | dict(told.get("fixed", {})) | dict(told.get("options", {}))


def _difference(name: str, there: Any, here: Any) -> str:
    if name == "over":
        return f"it varies {' and '.join(map(str, there or ()))} there, {' and '.join(here)} here"
    if isinstance(there, list) and isinstance(here, list):  # what only one of them has
        there, here = (
            [each for each in there if each not in here],
            [each for each in here if each not in there],
        )
    pairs = ((_told(there, digits), _told(here, digits)) for digits in range(DEFAULT_DIGITS, ALL_DIGITS + 1))
    one, other = next((pair for pair in pairs if pair[0] != pair[1]), ("one", "another"))
    return f"{name} is {one} there and {other} here"


def _told(value: Any, digits: int) -> str:
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    return "not given" if value is None else shown(value)
