"""Pictures of planes: where they lie, however deep one looks, and the theory's curves over the map."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from attrs import frozen

from rocking.explorer.progressive_map import Picture
from rocking.explorer.view_state import Span, ViewState, closest
from rocking.model import Block
from rocking.plot.parts import theory_curves

DEEP = 1e-6
"""A stretch shorter than this share of its numbers is told as a difference from one of them, lest the browser round."""
CURVE_POINTS = 300
DASHES = {
    "existence-1": "2 3",
    "existence-3": "8 3 2 3 2 3",
    "symmetry-breaking-1": "",
    "symmetry-breaking-3": "10 4",
    "melnikov": "14 4 2 4",
    "heteroclinic": "20 4",
}
DOTTED = "1 3"
"""As in a map of the package."""
NAMES = {
    "existence-1": "(1,1) from A<sub>E</sub>",
    "existence-3": "(1,3) from A<sub>E</sub>",
    "symmetry-breaking-1": "(1,1) to A<sub>SB</sub>",
    "symmetry-breaking-3": "(1,3) to A<sub>SB</sub>",
    "melnikov": "Melnikov A<sub>M</sub>",
    "heteroclinic": "tangency A<sup>*</sup>",
}


def base_of(span: Span) -> float:
    """The number that a stretch is drawn as a difference from: 0 unless it lies deep."""
    middle = 0.5 * (span.low + span.high)
    if span.width > DEEP * abs(middle):
        return 0.0
    return round(middle, 1 - math.floor(math.log10(span.width)))


@frozen
class Corner:
    """The bases of both axes of a plane."""

    across: float
    up: float

    def ranges(self, across: Span, up: Span) -> tuple[float, float, float, float]:
        """Left, right, bottom and top as they are drawn."""
        return (across.low - self.across, across.high - self.across, up.low - self.up, up.high - self.up)


def corner_of(across: Span, up: Span) -> Corner:
    """The bases that these stretches need."""
    return Corner(base_of(across), base_of(up))


def place(made: Any, corner: Corner, across: Span, up: Span, limits: tuple[Span, Span]) -> None:
    """Move the axes, and say how far one may move and zoom."""
    pairs = (made.x_range, across, corner.across), (made.y_range, up, corner.up)
    for (axis, span, base), limit in zip(pairs, limits, strict=True):
        axis.update(
            start=span.low - base,
            end=span.high - base,
            bounds=(limit.low - base, limit.high - base),
            min_interval=closest(span),
        )


def label(made: Any, corner: Corner, names: tuple[str, str]) -> None:
    """Say what the axes are, and which number they count from."""
    for axis, name, base in ((made.below[0], names[0], corner.across), (made.left[0], names[1], corner.up)):
        axis.axis_label = f"{name} − {base!r}" if base else name


def point(corner: Corner, across: float, up: float) -> dict[str, Any]:
    """A place in a plane as a figure draws it."""
    return {"x": [across - corner.across], "y": [up - corner.up]}


def image(picture: Picture, corner: Corner, across: Span, up: Span) -> dict[str, Any]:
    """The picture as a figure draws it: the points at its edges are the middles of their cells."""
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
    """What the page tells of a point, and writes into a table: flat, upward first."""
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
    }


def curves(shown: ViewState, corner: Corner) -> dict[str, Any]:
    """The curves asked for, as far as they are seen, none between braces; dotted where the mode is not admissible."""
    columns: dict[str, Any] = {"xs": [], "ys": [], "dash": []}
    for name in shown.curves if shown.brace_angle is None else ():
        periods, *lines = _curve(name, shown.periods, shown.amplitudes, shown.restitution)
        for line, dash in zip(lines, (DASHES[name], DOTTED), strict=True):
            if np.isfinite(line).any():
                columns["xs"].append(periods - corner.across)
                columns["ys"].append(line - corner.up)
                columns["dash"].append(dash)
    return columns


@lru_cache(64)
def _curve(name: str, across: Span, up: Span, restitution: float) -> tuple[np.ndarray, ...]:
    """Periods, and the amplitudes of a curve over them: where it holds, and where its mode is not admissible."""
    periods = np.linspace(across.low, across.high, CURVE_POINTS)
    return periods, *theory_curves.lines_of(
        theory_curves.CURVES[name], periods, np.full(CURVE_POINTS, restitution), up.low, up.high
    )


def metres(made: Any, corner: Corner, shown: ViewState, block: Block | None) -> None:
    """The axes at the other sides: the same in SI where there is a block."""
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
