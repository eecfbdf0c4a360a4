"""Axes and contents of the two maps: ranges at any zoom, images, marks and theoretical curves."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from attrs import frozen

from rocking.explorer.progressive_map import Picture
from rocking.explorer.view_state import Span, ViewState, closest
from rocking.model.block import Block
from rocking.plot import theory_curves

DEEP = 1e-6
"""Relative length of a range below which an axis shows differences from an offset, to avoid rounding in the browser."""
CURVE_POINTS = 300
"""Periods at which a theoretical curve is evaluated."""
DASHES = {
    "existence-1": "2 3",
    "existence-3": "8 3 2 3 2 3",
    "symmetry-breaking-1": "",
    "symmetry-breaking-3": "10 4",
    "melnikov": "14 4 2 4",
    "heteroclinic": "20 4",
}
"""Dash patterns of the theoretical curves."""
DOTTED = "1 3"
"""Dash pattern where the mode is not admissible, as in `rocking.plot.parametric_map`."""
NAMES = {
    "existence-1": ("A<sub>E</sub>, (1, 1)", "Amplitude A_E above which the symmetric (1, 1) mode exists"),
    "existence-3": ("A<sub>E</sub>, (1, 3)", "Amplitude A_E above which the symmetric (1, 3) mode exists"),
    "symmetry-breaking-1": (
        "A<sub>SB</sub>, (1, 1)",
        "Amplitude A_SB up to which the symmetric (1, 1) mode is stable; dotted where the mode is not admissible",
    ),
    "symmetry-breaking-3": (
        "A<sub>SB</sub>, (1, 3)",
        "Amplitude A_SB up to which the symmetric (1, 3) mode is stable; dotted where the mode is not admissible",
    ),
    "melnikov": ("A<sub>M</sub> (Melnikov)", "Amplitude A_M above which the Melnikov function has zeros"),
    "heteroclinic": ("A<sup>*</sup> (tangency)", "Amplitude A* of the exact heteroclinic tangency"),
}
"""Labels of the theoretical curves, and their descriptions."""


def base_of(span: Span) -> float:
    """Return the offset of an axis: 0 unless its range is very short."""
    middle = 0.5 * (span.low + span.high)
    if span.width > DEEP * abs(middle):
        return 0.0
    return round(middle, 1 - math.floor(math.log10(span.width)))


@frozen
class Corner:
    """Offsets of both axes of a map."""

    across: float
    up: float

    def ranges(self, across: Span, up: Span) -> tuple[float, float, float, float]:
        """Return left, right, bottom and top, less the offsets."""
        return (across.low - self.across, across.high - self.across, up.low - self.up, up.high - self.up)


def corner_of(across: Span, up: Span) -> Corner:
    """Return the offsets for two ranges."""
    return Corner(base_of(across), base_of(up))


def place(made: Any, corner: Corner, across: Span, up: Span, limits: tuple[Span, Span]) -> None:
    """Set the ranges of the axes, and the limits of pan and zoom."""
    pairs = (made.x_range, across, corner.across), (made.y_range, up, corner.up)
    for (axis, span, base), limit in zip(pairs, limits, strict=True):
        axis.update(
            start=span.low - base,
            end=span.high - base,
            bounds=(limit.low - base, limit.high - base),
            min_interval=closest(span),
        )


def label(made: Any, corner: Corner, names: tuple[str, str]) -> None:
    """Set the labels of the axes, with their offsets."""
    for axis, name, base in ((made.below[0], names[0], corner.across), (made.left[0], names[1], corner.up)):
        axis.axis_label = f"{name} − {base!r}" if base else name


def point(corner: Corner, across: float, up: float) -> dict[str, Any]:
    """Return the coordinates of a point, less the offsets."""
    return {"x": [across - corner.across], "y": [up - corner.up]}


def image(picture: Picture, corner: Corner, across: Span, up: Span) -> dict[str, Any]:
    """Return the columns of the image. Grid points lie at the centres of their cells, also at the edges."""
    left, right, bottom, top = corner.ranges(across, up)
    wide, high = ((end - begin) / (picture.points - 1) for begin, end in ((left, right), (bottom, top)))
    return {
        "image": [picture.colours()],
        "x": [left - wide / 2],
        "y": [bottom - high / 2],
        "w": [right - left + wide],
        "h": [top - bottom + high],
    }


def answers(picture: Picture) -> dict[str, np.ndarray]:
    """Return the results of all points, for the readout and the table; flat, rows upward."""
    kept = picture.fields
    narrow = np.iinfo(np.int16)
    counts = {
        name: np.clip(kept[name], narrow.min, narrow.max).astype(np.int16).ravel()
        for name in ("response_period", "impacts_per_period")
    }
    return counts | {
        "look": picture.look.ravel(),
        "evidence": kept["evidence"].ravel(),
        "exponent": kept["exponent"].astype(np.float32).ravel(),
        "orbit": kept["orbit"].ravel(),
    }


def curves(shown: ViewState, corner: Corner) -> dict[str, Any]:
    """Return the visible part of the selected curves, dotted where the mode is not admissible.

    They hold for a slender block without braces; otherwise there are none.
    """
    columns: dict[str, Any] = {"xs": [], "ys": [], "dash": []}
    hold = shown.brace_angle is None and shown.critical_angle is None
    for name in shown.curves if hold else ():
        periods, *lines = _curve(name, shown.periods, shown.amplitudes, shown.restitution)
        for line, dash in zip(lines, (DASHES[name], DOTTED), strict=True):
            if np.isfinite(line).any():
                columns["xs"].append(periods - corner.across)
                columns["ys"].append(line - corner.up)
                columns["dash"].append(dash)
    return columns


@lru_cache(64)
def _curve(name: str, across: Span, up: Span, restitution: float) -> tuple[np.ndarray, ...]:
    """Return the periods, and the amplitudes of a curve where its mode is admissible and where it is not."""
    periods = np.linspace(across.low, across.high, CURVE_POINTS)
    return periods, *theory_curves.lines_of(
        theory_curves.CURVES[name], periods, np.full(CURVE_POINTS, restitution), up.low, up.high
    )


def metres(made: Any, corner: Corner, shown: ViewState, block: Block | None) -> None:
    """Set the SI axes above and at the right; they are visible only with a block."""
    above, right = made.above[0], made.right[0]
    for axis in (above, right):
        axis.visible = block is not None
    if block is None:
        return
    for axis, ranges, span, base, turn, name in (
        (above, made.extra_x_ranges["si"], shown.periods, corner.across, block.seconds, "period (s)"),
        (
            right,
            made.extra_y_ranges["si"],
            shown.amplitudes,
            corner.up,
            block.acceleration,
            "acceleration (m/s²)",
        ),
    ):
        factor = turn(1.0)
        ranges.update(start=(span.low - base) * factor, end=(span.high - base) * factor)
        axis.axis_label = f"{name} − {base * factor:.9g}" if base else name
