"""Empty Bokeh figures of the page, with the names by which the page finds their parts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, LinearAxis, LinearColorMapper, Range1d
from bokeh.models.annotations import Span, Title
from bokeh.models.tickers import BasicTicker
from bokeh.plotting import figure

from rocking.explorer.progressive_map import SHADES
from rocking.plot import style
from rocking.plot.palette import SELECTED

SHADED = [look.shade(number) for number in range(SHADES) for look in style.LOOKS]
PALETTE = [*SHADED, style.INK, "#00000000"]
"""Palette of a map, indexed by `Picture.colours`: shades of all categories, stripe of a hatch, transparent."""
FONT = "11px"
AXIS = {
    "axis_label_text_font_style": "normal",
    "axis_label_text_font_size": FONT,
    "major_label_text_font_size": FONT,
    "axis_label_standoff": 4,
    "minor_tick_line_color": None,
}
BASIN_LABELS = "initial angle Θ₀", "initial velocity Θ′₀"
LEFT = 64
"""Left border of every figure, px, for tick labels and axis label. One width aligns the frames."""
FEW = 3
"""Number of ticks along a short axis."""


def no_image() -> dict[str, Any]:
    """Return the columns of an empty image."""
    return {"image": [np.zeros((2, 2), np.uint8)], "x": [0.0], "y": [0.0], "w": [0.0], "h": [0.0]}


def empty(name: str, *columns: str) -> ColumnDataSource:
    """Return a source without rows."""
    return ColumnDataSource({column: [] for column in columns}, name=name)


def framed(name: str, title: str, across: str, up: str, tools: str = "", ticks: int = 5, **more: Any) -> Any:
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


def plane(name: str, title: str, across: str, up: str, palette: Sequence[str] = PALETTE, **more: Any) -> Any:
    """Return a map of two quantities with zoom, pan and a mark at the selected point."""
    made = framed(name, title, across, up, tools="pan,wheel_zoom,tap", active_scroll="wheel_zoom", **more)
    made.grid.visible = False
    colours = LinearColorMapper(palette=list(palette), low=-0.5, high=len(palette) - 0.5)
    image = ColumnDataSource(no_image(), name="image")
    drawn = made.image("image", "x", "y", "w", "h", source=image, color_mapper=colours)
    drawn.nonselection_glyph = drawn.selection_glyph = None
    point = empty("point", "x", "y")
    for size, colour, width in ((15, "white", 4.5), (15, SELECTED, 2.2)):
        made.scatter("x", "y", source=point, size=size, fill_color=None, line_color=colour, line_width=width)
    made.yaxis.ticker = BasicTicker(desired_num_ticks=6)
    return made


def plane_of_systems() -> Any:
    """Return the map over period and amplitude, with theoretical curves, and SI axes above and at the right."""
    made = plane("map", "Response type", "period T", "amplitude A")
    curves = empty("curves", "xs", "ys", "dash")
    for colour, width in (("white", 4.0), (style.INK, 1.4)):
        made.multi_line("xs", "ys", source=curves, line_color=colour, line_width=width, line_dash="dash")
    made.extra_x_ranges["si"], made.extra_y_ranges["si"] = (
        Range1d(start=0.0, end=1.0),
        Range1d(start=0.0, end=1.0),
    )
    above, right = LinearAxis(x_range_name="si", visible=False), LinearAxis(y_range_name="si", visible=False)
    for axis, side in ((above, "above"), (right, "right")):
        axis.update(**AXIS, ticker=BasicTicker(desired_num_ticks=5))
        made.add_layout(axis, side)
    return made


def plane_of_starts() -> Any:
    """Return the basins of attraction over initial angle and velocity."""
    return plane("basin", "Basins of attraction", *BASIN_LABELS)


def history() -> Any:
    """Return the time history of the angle."""
    made = framed("history", "Time history", "time τ", "angle Θ")
    line = empty("line", "time", "angle", "velocity")
    made.line("time", "angle", source=line, name="line", line_color=style.MOTION, line_width=1.4)
    return made


def portrait() -> Any:
    """Return the phase portrait, with a mark at each impact."""
    made = framed("portrait", "Phase portrait with impacts", "angle Θ", "velocity Θ′", ticks=FEW)
    line, hits = empty("line", "angle", "velocity"), empty("hits", "angle", "velocity", "colour")
    made.line(
        "angle", "velocity", source=line, name="line", line_color=style.MOTION, line_width=1.0, line_alpha=0.8
    )
    made.scatter("angle", "velocity", source=hits, size=4.5, color="colour", line_color=None)
    return made


def section() -> Any:
    """Return the Poincaré section, once per forcing cycle: single points, or an image of their density."""
    made = framed("section", "Poincaré section", "angle Θ", "velocity Θ′", ticks=FEW)
    dense = ColumnDataSource(no_image(), name="dense")
    shades = [f"{style.MOTION}{round(255 * share):02X}" for share in (0.0, *np.linspace(0.35, 1.0, 8))]
    made.image(
        "image",
        "x",
        "y",
        "w",
        "h",
        source=dense,
        color_mapper=LinearColorMapper(palette=shades, low=0, high=9),
    )
    points = empty("points", "angle", "velocity")
    made.scatter(
        "angle", "velocity", source=points, name="dots", size=4.0, color=style.MOTION, line_color=None
    )
    orbit = empty("orbit", "angle", "velocity")
    made.scatter(
        "angle",
        "velocity",
        source=orbit,
        size=11,
        fill_color=None,
        line_color=SELECTED,
        line_width=1.6,
    )
    return made


def spectrum() -> Any:
    """Return the power spectral density over frequency / forcing frequency, with names at its strongest lines."""
    made = framed(
        "spectrum",
        "Power spectral density",
        "frequency / forcing frequency",
        "density S (τ)",
        y_axis_type="log",
    )
    line, names = empty("line", "frequency", "density"), empty("names", "frequency", "density", "name")
    made.line("frequency", "density", source=line, name="line", line_color=style.MOTION, line_width=1.2)
    made.text(
        "frequency",
        "density",
        "name",
        source=names,
        name="words",
        text_font_size=FONT,
        text_font={"value": "system-ui, sans-serif"},
        text_align="center",
        text_baseline="bottom",
        y_offset=-3,
    )
    return made


def diagram() -> Any:
    """Return the orbit (bifurcation) diagram over the amplitude or the period."""
    made = framed("diagram", "Orbit (bifurcation) diagram", "", "angle Θ", tools="tap")
    made.scatter(
        "value",
        "angle",
        source=empty("points", "value", "angle"),
        name="dots",
        size=1.8,
        color=style.MOTION,
        line_color=None,
        marker="square",
    )
    made.add_layout(Span(name="here", dimension="height", location=0.0, line_color=SELECTED, line_width=1.5))
    return made
