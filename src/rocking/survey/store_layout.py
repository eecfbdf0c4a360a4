"""Layout of a store, and its comparison with a survey that repeats, extends or refines it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from attrs import frozen

from rocking.model.package import VERSION
from rocking.model.text import formatted, formatted_path
from rocking.model.validation import Statement
from rocking.survey.measurement import Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import Level, even_edges, levels, thinned, tile_edges

SAME = 1e-9
"""Tolerance of equal axis values, relative to their spacing: extending an axis changes its rounding."""

FORMAT, READABLE = 3, (2, 3)
"""Version of the file format, and those that can be read. Tiles of format 2 have no digests."""
DEFAULT_DIGITS, ALL_DIGITS = 6, 17
"""Digits of differing numbers in messages: as many as show the difference."""
DIGESTS = {"records_sha256": "ground motions", "values_sha256": "values of the parameter"}
MAX_HALVINGS = 31
MAX_DIFFERENCES = 160
"""Longest text of the differences of two surveys, in characters."""


@frozen(eq=False)
class Layout:
    """Layout of a store: axes of the finest level, axes halved from level to level, and tiles of each level."""

    axes: dict[str, np.ndarray]
    halved: list[tuple[bool, ...]]
    tiles: list[tuple[int, ...]]

    def levels(self) -> list[Level]:
        """Return the levels, the coarsest first."""
        grids = [self.axes]
        for halved in reversed(self.halved):
            grids.insert(0, thinned(grids[0], halved))
        parts = zip(grids, [None, *self.halved], self.tiles, strict=True)
        return [Level(number, *part) for number, part in enumerate(parts)]


def new_layout(spec: SurveySpec) -> Layout:
    """Return the layout of a new store."""
    grids = levels(spec)
    halved = [each.halved for each in grids if each.halved is not None]
    return Layout(spec.axes, halved, [each.tile for each in grids])


def read_layout(stored: Mapping[str, Any]) -> Layout:
    """Return the layout from the metadata of a store; ValueError or TypeError if the metadata are invalid."""
    missing = [name for name in ("axes", "halved", "tiles") if name not in stored]
    if missing:
        raise ValueError(f"{missing[0]} is missing")
    axes = {name: np.array(values, float) for name, values in dict(stored["axes"]).items()}
    halved = [tuple(each) for each in stored["halved"]]
    tiles = [tuple(each) for each in stored["tiles"]]
    for name, values in axes.items():
        if (
            values.ndim != 1
            or values.size < 1
            or not np.isfinite(values).all()
            or (np.diff(values) <= 0).any()
        ):
            raise ValueError(f"{name} is not an axis")
    if (
        list(axes) != stored["over"]
        or len(tiles) != len(halved) + 1
        or any(len(each) != len(axes) for each in (*halved, *tiles))
    ):
        raise ValueError("levels, axes and tiles do not match")
    if not all(type(flag) is bool for each in halved for flag in each):
        raise ValueError("halved must be true or false")
    if not all(type(edge) is int and edge > 0 for each in tiles for edge in each):
        raise ValueError("tiles must have positive whole numbers of points")
    return Layout(axes, halved, tiles)


def described_layout(layout: Layout) -> dict[str, Any]:
    """Return a layout as a JSON object."""
    return {
        "axes": {name: values.tolist() for name, values in layout.axes.items()},
        "halved": [list(each) for each in layout.halved],
        "tiles": [list(each) for each in layout.tiles],
    }


def fingerprint(spec: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """Return the properties that must agree to resume a store, and the version and processor that made it."""
    from rocking.kernels.library.processor import processor_class

    return {
        "survey": measure.title,
        "over": list(spec.axes),
        "fixed": spec.described(),
        "options": dict(measure.options),
        "variables": [each.name for each in measure.variables],
        "method": measure.method,
        "format": FORMAT,
        "made_by": {"version": VERSION, "processor": processor_class()},
    }


def check_described(stored: Any) -> None:
    """Raise TypeError for metadata that `fingerprint` never returns."""
    kinds = {"fixed": dict, "options": dict, "over": list, "variables": list}
    if not isinstance(stored, dict):
        raise TypeError(f"the metadata are {formatted(stored)}")
    for name, kind in kinds.items():
        if not isinstance(stored.get(name, kind()), kind):
            raise TypeError(f"the metadata have {name} = {formatted(stored[name])}")


def check_same(path: str, stored: Mapping[str, Any], mine: Mapping[str, Any]) -> None:
    """Raise ValueError for a store of a different survey; the message lists the differences.

    A store of another method, or of an older format that can be read, is one of the same survey.
    """
    if "scale" in (*stored.get("fixed", {}), *(stored.get("over") or ())):
        holds = f"{formatted_path(path)} holds a survey of version 0.1, which names its levels `scale`"
        raise Statement("{store}", holds, remedy="give another folder")
    ours, theirs = _flat(mine), _flat(stored)
    differences = [
        _difference(name, theirs.get(name), ours.get(name))
        for name in dict.fromkeys((*theirs, *ours))
        if theirs.get(name) != ours.get(name)
    ]
    if differences:
        kept = [
            each
            for count, each in enumerate(differences)
            if len("; ".join(differences[: count + 1])) <= MAX_DIFFERENCES
        ] or differences[:1]
        more = f"; and {len(differences) - len(kept)} more" if len(kept) < len(differences) else ""
        raise Statement(
            "{store}",
            f"{formatted_path(path)} holds a different survey: {'; '.join(kept)}{more}",
            remedy="give another folder, or the same values",
        )


def why_finished(stored: Mapping[str, Any], mine: Mapping[str, Any]) -> str:
    """Return why no results may be added to a store of the same survey; empty if they may."""
    there, here = stored.get("method"), mine["method"]
    if there != here:
        return f"its results are those of method {formatted(there)}, and this version computes with method {here}"
    if stored["format"] != FORMAT:
        return f"its format {stored['format']} does not bind tiles to their survey, as format {FORMAT} does"
    return ""


def joined(path: str, stored: Layout, spec: SurveySpec) -> Layout:
    """Return the layout of a store together with a survey whose axes are equal, longer or finer (by powers of two).

    Raises ValueError for axes that omit or move values of the store.
    """
    most = MAX_HALVINGS if spec.refines else 0
    pairs = [_join(path, name, values, spec.axes[name], most) for name, values in stored.axes.items()]
    axes = {name: values for name, (values, _) in zip(stored.axes, pairs, strict=True)}
    halvings = [times for _, times in pairs]
    more = [tuple(number < times for times in halvings) for number in range(max(halvings))]
    edges = tile_edges([values.size for values in axes.values()], spec.in_a_tile)
    layout = Layout(axes, stored.halved + more, stored.tiles + [edges] * len(more))
    for number in range(len(stored.tiles), len(layout.tiles)):
        layout.tiles[number] = even_edges(layout.levels()[number].axes, edges)
    return layout


def _join(path: str, name: str, there: np.ndarray, here: np.ndarray, most: int) -> tuple[np.ndarray, int]:
    """Return the requested axis values, with equal values exactly as stored, and the number of halvings, at most `most`."""
    for times in range(most + 1):
        step = 2**times
        reach = step * (there.size - 1) + 1
        if reach > here.size:
            break
        nearest = np.diff(there).min() / step if there.size > 1 else 0.0
        if np.abs(here[:reach:step] - there).max() <= SAME * nearest:
            exact = here.copy()
            exact[:reach:step] = there
            return exact, times
    half = " or at half the spacing are" if most else " are"
    raise Statement(
        "{store}",
        f"{formatted_path(path)} holds {there.size} values of {{{name}}} from {there[0]:.6g} to {there[-1]:.6g}; "
        f"the requested {here.size} from {here[0]:.6g} to {here[-1]:.6g} {'omit some of them' if most else 'are others'}",
        remedy=f"give these values; more values beyond the last{half} possible",
    )


def _flat(metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return the compared properties by their names in messages."""
    alone = {name: metadata.get(name) for name in ("survey", "over", "variables", "format")}
    if alone["format"] in READABLE:
        alone["format"] = FORMAT
    return alone | dict(metadata.get("fixed", {})) | dict(metadata.get("options", {}))


def _difference(name: str, there: Any, here: Any) -> str:
    if name == "over":
        return f"the axes are {' and '.join(map(str, there or ()))} there and {' and '.join(here)} here"
    if name in DIGESTS:
        return f"the {DIGESTS[name]} are others"
    if isinstance(there, list) and isinstance(here, list):  # entries of only one of the lists
        there, here = (
            [each for each in there if each not in here],
            [each for each in here if each not in there],
        )
    pairs = (
        (_stated(there, digits), _stated(here, digits)) for digits in range(DEFAULT_DIGITS, ALL_DIGITS + 1)
    )
    one, other = next((pair for pair in pairs if pair[0] != pair[1]), ("one", "another"))
    return f"{{{name}}} is {one} there and {other} here"


def _stated(value: Any, digits: int) -> str:
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    return "not given" if value is None else formatted(value)
