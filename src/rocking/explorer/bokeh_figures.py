"""The figures of the page, empty: what they are made of, and what the page finds them by."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, LinearAxis, LinearColorMapper, Range1d
from bokeh.models.annotations import Span
from bokeh.models.tickers import BasicTicker
from bokeh.plotting import figure
from matplotlib.colors import to_hex

from rocking.explorer.progressive_map import SHADES
from rocking.plot.parts import legend, style

ACCENT = "#D81B60"
"""Of what is selected; no kind of response has it."""
SHADED = [to_hex(legend.paler(look.colour, shade)) for shade in range(SHADES) for look in legend.LOOKS]
PALETTE = [*SHADED, "#FFFFFF", style.INK, "#00000000"]
"""Colours of a picture of a plane, by its numbers: the shades of the looks, both hatches, nothing."""
FONT = "11px"
AXIS = {
    "axis_label_text_font_style": "normal",
    "axis_label_text_font_size": FONT,
    "major_label_text_font_size": FONT,
    "axis_label_standoff": 4,
    "minor_tick_line_color": None,
}
LEFT = 64
"""Room left of a figure for its numbers and its label: the same for all, so that their frames stand below each other."""
FEW = 3
"""Numbers along an axis that is short."""


def no_image() -> dict[str, Any]:
    """The columns of an image of nothing."""
    return {"image": [np.zeros((2, 2), np.uint8)], "x": [0.0], "y": [0.0], "w": [0.0], "h": [0.0]}


def _empty(name: str, *columns: str) -> ColumnDataSource:
    return ColumnDataSource({column: [] for column in columns}, name=name)


def _figure(name: str, across: str, up: str, tools: str = "", ticks: int = 5, **more: Any) -> Any:
    made = figure(
        name=name,
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


def _plane(name: str, across: str, up: str) -> Any:
    """A picture of two quantities that is zoomed and moved, with the point that is selected."""
    made = _figure(name, across, up, tools="pan,wheel_zoom,tap", active_scroll="wheel_zoom")
    made.yaxis.ticker = BasicTicker(desired_num_ticks=6)
    made.grid.visible = False
    colours = LinearColorMapper(palette=PALETTE, low=-0.5, high=len(PALETTE) - 0.5)
    image = ColumnDataSource(no_image(), name="image")
    drawn = made.image("image", "x", "y", "w", "h", source=image, color_mapper=colours)
    drawn.nonselection_glyph = drawn.selection_glyph = None
    point = _empty("point", "x", "y")
    for size, colour, width in ((15, "white", 4.5), (15, ACCENT, 2.2)):
        made.scatter("x", "y", source=point, size=size, fill_color=None, line_color=colour, line_width=width)
    return made


def plane_of_systems() -> Any:
    """The map over period and amplitude, with the curves of the theory, and axes in SI at its other sides."""
    made = _plane("map", "", "")
    curves = _empty("curves", "xs", "ys", "dash")
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
    """The basin over angle and velocity of the start."""
    return _plane("basin", "angle at the start Θ₀", "velocity at the start Θ′₀")


def history() -> Any:
    """The angle over time."""
    made = _figure("history", "time τ", "angle Θ")
    line = _empty("line", "time", "angle", "velocity")
    made.line("time", "angle", source=line, name="line", line_color=style.MOTION, line_width=1.4)
    return made


def portrait() -> Any:
    """The velocity over the angle, with impacts."""
    made = _figure("portrait", "angle Θ", "velocity Θ′", ticks=FEW)
    line, hits = _empty("line", "angle", "velocity"), _empty("hits", "angle", "velocity", "colour")
    made.line(
        "angle", "velocity", source=line, name="line", line_color=style.MOTION, line_width=1.0, line_alpha=0.8
    )
    made.scatter("angle", "velocity", source=hits, size=4.5, color="colour", line_color=None)
    return made


def section() -> Any:
    """The state once a cycle: single points, or where they are many how dense they lie."""
    made = _figure("section", "angle Θ", "velocity Θ′", ticks=FEW)
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
    points = _empty("points", "angle", "velocity")
    made.scatter(
        "angle", "velocity", source=points, name="dots", size=4.0, color=style.MOTION, line_color=None
    )
    orbit = _empty("orbit", "angle", "velocity")
    made.scatter(
        "angle", "velocity", source=orbit, size=11, fill_color=None, line_color=ACCENT, line_width=1.6
    )
    return made


def spectrum() -> Any:
    """The spectral density over the frequency in units of the forcing's, with the strongest lines named."""
    made = _figure("spectrum", "frequency over that of the base", "density S", y_axis_type="log")
    line, names = _empty("line", "frequency", "density"), _empty("names", "frequency", "density", "name")
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
    """What is left of the motion after a transient, over the amplitude or the period."""
    made = _figure("diagram", "", "angle Θ", tools="tap")
    made.scatter(
        "value",
        "angle",
        source=_empty("points", "value", "angle"),
        name="dots",
        size=1.8,
        color=style.MOTION,
        line_color=None,
        marker="square",
    )
    made.add_layout(Span(name="here", dimension="height", location=0.0, line_color=ACCENT, line_width=1.5))
    return made
