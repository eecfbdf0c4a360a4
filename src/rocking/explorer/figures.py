"""Empty Bokeh figures of both pages, with the names by which the pages find their parts, and the axes of maps at any zoom."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from attrs import frozen
from bokeh.models import (
    BasicTickFormatter,
    ColumnDataSource,
    FixedTicker,
    LinearColorMapper,
    Range1d,
)
from bokeh.models.annotations import Span as Line
from bokeh.models.annotations import Title
from bokeh.models.tickers import BasicTicker
from bokeh.plotting import figure

from rocking.explorer.fields import Span
from rocking.plot import style
from rocking.plot.palette import SELECTED

FONT = "11px"
AXIS = {
    "axis_label_text_font_style": "normal",
    "axis_label_text_font_size": FONT,
    "major_label_text_font_size": FONT,
    "axis_label_standoff": 4,
    "minor_tick_line_color": None,
}
LEFT = 64
"""Left border of every figure, px, for tick labels and axis label. One width aligns the frames."""
FEW = 3
"""Number of ticks along a short axis."""
TICKS = [digit * 10.0**power for power in range(-3, 4) for digit in (1, 2, 5)]
"""Ticks of a logarithmic axis."""
IMAGE = ("image", "x", "y", "w", "h")
"""Columns of an image."""
DEEP = 1e-6
"""Relative length of a range below which an axis shows differences from an offset, to avoid rounding in the browser."""


# ---- parts of figures


def no_image() -> dict[str, Any]:
    """Return the columns of an empty image."""
    return {"image": [np.zeros((2, 2), np.uint8)], "x": [0.0], "y": [0.0], "w": [0.0], "h": [0.0]}


def empty(name: str, *columns: str) -> ColumnDataSource:
    """Return a source without rows."""
    return ColumnDataSource({column: [] for column in columns}, name=name)


def framed(
    name: str, title: str, across: str = "", up: str = "", tools: str = "", ticks: int = 5, **more: Any
) -> Any:
    """Return an empty figure with the borders and the text sizes of all."""
    made = figure(
        name=name,
        title=Title(  # type: ignore[call-arg]  # its type hints lack the offset
            text=title,
            text_font_size="12px",
            text_font="system-ui, sans-serif",
            standoff=7,
            offset=8 - LEFT,  # flush with the left edge of the figure
        ),
        tools=tools,
        toolbar_location=None,
        sizing_mode="stretch_both",
        x_range=Range1d(start=0.0, end=1.0),
        y_range=Range1d(start=0.0, end=1.0),
        x_axis_label=across,
        y_axis_label=up,
        min_border_left=LEFT,
        min_border_right=10,
        min_border_top=6,
        min_border_bottom=42,
        lod_threshold=None,
        **more,
    )
    for axis in made.axis:
        axis.update(**AXIS)
    made.xaxis.ticker = BasicTicker(desired_num_ticks=ticks)
    return made


def line(made: Any, across: str, up: str, *more: str, width: float, alpha: float = 1.0) -> None:
    """Add the line of a motion; its source has further columns."""
    drawn = {"line_color": style.MOTION, "line_width": width, "line_alpha": alpha}
    made.line(across, up, source=empty("line", across, up, *more), name="line", **drawn)


def ring(made: Any, source: ColumnDataSource, *columns: str, size: float, width: float) -> None:
    """Add rings in the colour of what is selected."""
    look = {"fill_color": None, "line_color": SELECTED, "line_width": width}
    made.scatter(*columns, source=source, size=size, **look)


def image(made: Any, name: str, palette: Sequence[str]) -> Any:
    """Add an image of indices in a palette."""
    colours = LinearColorMapper(palette=list(palette), low=-0.5, high=len(palette) - 0.5)
    return made.image(*IMAGE, source=ColumnDataSource(no_image(), name=name), color_mapper=colours)


def plane(name: str, title: str, palette: Sequence[str], across: str = "", up: str = "", **more: Any) -> Any:
    """Return a map of two quantities with zoom, pan and a mark at the selected point."""
    made = framed(name, title, across, up, tools="pan,wheel_zoom,tap", active_scroll="wheel_zoom", **more)
    made.grid.visible = False
    drawn = image(made, "image", palette)
    drawn.nonselection_glyph = drawn.selection_glyph = None
    point = empty("point", "x", "y")
    made.scatter("x", "y", source=point, size=15, fill_color=None, line_color="white", line_width=4.5)
    ring(made, point, "x", "y", size=15, width=2.2)
    made.yaxis.ticker = BasicTicker(desired_num_ticks=6)
    return made


# ---- figures of the harmonic page


def plane_of_systems(palette: Sequence[str]) -> Any:
    """Return the map over period and amplitude, with theoretical curves."""
    made = plane("map", "Response type", palette)
    curves = empty("curves", "xs", "ys", "dash")
    for colour, width in (("white", 4.0), (style.INK, 1.4)):
        made.multi_line("xs", "ys", source=curves, line_color=colour, line_width=width, line_dash="dash")
    return made


def history() -> Any:
    """Return the time history of the angle."""
    made = framed("history", "Time history")
    line(made, "time", "angle", "velocity", width=1.4)
    return made


def portrait() -> Any:
    """Return the phase portrait, with a mark at each impact."""
    made = framed("portrait", "Phase portrait with impacts", ticks=FEW)
    line(made, "angle", "velocity", width=1.0, alpha=0.8)
    hits = empty("hits", "angle", "velocity", "colour")
    made.scatter("angle", "velocity", source=hits, size=4.5, color="colour", line_color=None)
    return made


def section() -> Any:
    """Return the Poincaré section, once per forcing cycle: single points, or an image of their density."""
    made = framed("section", "Poincaré section", ticks=FEW)
    shades = [f"{style.MOTION}{round(255 * share):02X}" for share in (0.0, *np.linspace(0.35, 1.0, 8))]
    image(made, "dense", shades).name = "dense"
    points = empty("points", "angle", "velocity")
    dots = {"size": 4.0, "color": style.MOTION, "line_color": None}
    made.scatter("angle", "velocity", source=points, name="dots", **dots)
    ring(made, empty("orbit", "angle", "velocity"), "angle", "velocity", size=11, width=1.6)
    return made


def spectrum() -> Any:
    """Return the power spectral density over frequency / forcing frequency, with names at its strongest lines."""
    made = framed("spectrum", "Power spectral density", y_axis_type="log")
    line(made, "frequency", "density", width=1.2)
    words = {
        "text_font_size": FONT,
        "text_font": {"value": "system-ui, sans-serif"},
        "text_align": "center",
        "text_baseline": "bottom",
        "y_offset": -3,
    }
    names = empty("names", "frequency", "density", "name")
    made.text("frequency", "density", "name", source=names, name="words", **words)
    return made


def diagram() -> Any:
    """Return the orbit (bifurcation) diagram over the amplitude or the period."""
    made = framed("diagram", "Orbit (bifurcation) diagram", tools="tap")
    dots = {"size": 1.8, "color": style.MOTION, "line_color": None, "marker": "square"}
    made.scatter("value", "angle", source=empty("points", "value", "angle"), name="dots", **dots)
    made.add_layout(Line(name="here", dimension="height", location=0.0, line_color=SELECTED, line_width=1.5))
    return made


# ---- figures of the ground page


def plane_of_blocks(palette: Sequence[str]) -> Any:
    """Return the map over size, on a logarithmic axis, and critical angle."""
    labels = "half diagonal R (m)", "critical angle θcr (°)"
    made = plane("map", "Outcome and largest angle", palette, *labels, x_axis_type="log")
    made.xaxis.ticker = FixedTicker(ticks=TICKS)
    made.xaxis.formatter = BasicTickFormatter()
    return made


def block_history() -> Any:
    """Return the time history of the angle of a block, with lines at both critical angles."""
    tools = "xpan,xwheel_zoom"
    made = framed("history", "Time history of the block", "time t (s)", "angle θ (°)", tools=tools)
    dotted: dict[str, Any] = {"line_color": style.GUIDE, "line_dash": "dotted"}
    for name in ("above", "below"):
        made.add_layout(Line(name=name, dimension="width", location=0.0, **dotted))
    line(made, "time", "angle", width=1.4)
    return made


def base(above: Any) -> Any:
    """Return the acceleration of the base, under the time history, with the same times."""
    tools = "xpan,xwheel_zoom"
    made = framed("base", "Acceleration of the base", "time t (s)", "acceleration (g)", tools=tools)
    made.x_range = above.x_range
    line(made, "time", "acceleration", width=0.9)
    return made


# ---- axes of a map of two linear scales, at any zoom


def base_of(span: Span) -> float:
    """Return the offset of an axis: 0 unless its range is very short."""
    middle = 0.5 * (span.low + span.high)
    if span.width > DEEP * abs(middle):
        return 0.0
    return round(middle, 1 - math.floor(math.log10(span.width)))


@frozen
class Axes:
    """Ranges of both axes of a map, and their offsets, which the figure does not show."""

    across: Span
    up: Span

    @property
    def base(self) -> tuple[float, float]:
        """Offsets of both axes."""
        return base_of(self.across), base_of(self.up)

    @property
    def ranges(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top, less the offsets."""
        (dx, dy), across, up = self.base, self.across, self.up
        return across.low - dx, across.high - dx, up.low - dy, up.high - dy

    def point(self, across: float, up: float) -> dict[str, Any]:
        """Return the coordinates of a point, less the offsets."""
        dx, dy = self.base
        return {"x": [across - dx], "y": [up - dy]}

    def image(self, colours: np.ndarray) -> dict[str, Any]:
        """Return the columns of an image. Its points lie at the centres of their cells, also at the edges."""
        left, right, bottom, top = self.ranges
        rows, columns = colours.shape
        wide, high = (right - left) / (columns - 1), (top - bottom) / (rows - 1)
        corner = {"x": [left - wide / 2], "y": [bottom - high / 2]}
        return {"image": [colours], **corner, "w": [right - left + wide], "h": [top - bottom + high]}

    def place(
        self, made: Any, names: Sequence[str], limits: Sequence[Span], narrowest: Sequence[float]
    ) -> None:
        """Set ranges and labels of a map, and the limits of pan and zoom; `narrowest` are the shortest ranges of both axes."""
        parts = (made.x_range, made.below[0], self.across), (made.y_range, made.left[0], self.up)
        axes = zip(parts, names, limits, narrowest, self.base, strict=True)
        for (range_, axis, span), name, limit, least, offset in axes:
            range_.update(
                start=span.low - offset,
                end=span.high - offset,
                bounds=(limit.low - offset, limit.high - offset),
                min_interval=least,
            )
            axis.axis_label = f"{name} − {offset!r}" if offset else name
