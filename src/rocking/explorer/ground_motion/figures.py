"""Empty Bokeh figures of the page of ground motions."""

from __future__ import annotations

from typing import Any

from bokeh.models import BasicTickFormatter, FixedTicker
from bokeh.models.annotations import Span as Line

from rocking.explorer.bokeh_figures import empty, framed, plane
from rocking.explorer.ground_motion.size_map import PALETTE
from rocking.explorer.ground_motion.view import DEFAULT, SIZES, SLENDERNESS, GroundView
from rocking.plot import style

TICKS = [digit * 10.0**power for power in range(-3, 4) for digit in (1, 2, 5)]
SECONDS = "time t (s)"


def size_map() -> Any:
    """Return the map over size, on a logarithmic axis, and critical angle."""
    made = plane(
        "map",
        "Outcome and largest angle",
        "half diagonal R (m)",
        "critical angle θcr (°)",
        PALETTE,
        x_axis_type="log",
    )
    made.xaxis.ticker = FixedTicker(ticks=TICKS)
    made.xaxis.formatter = BasicTickFormatter()
    place(made, DEFAULT)
    made.x_range.bounds, made.y_range.bounds = SIZES, SLENDERNESS
    return made


def place(made: Any, shown: GroundView) -> None:
    """Set the ranges of the map."""
    for range_, span in ((made.x_range, shown.sizes), (made.y_range, shown.angles)):
        range_.update(start=span.low, end=span.high)


def history() -> Any:
    """Return the time history of the angle, with lines at both critical angles."""
    made = framed("history", "Time history of the block", SECONDS, "angle θ (°)", tools="xpan,xwheel_zoom")
    for name in ("above", "below"):
        made.add_layout(
            Line(name=name, dimension="width", location=0.0, line_color=style.GUIDE, line_dash="dotted")
        )
    made.line(
        "time",
        "angle",
        source=empty("line", "time", "angle"),
        name="line",
        line_color=style.MOTION,
        line_width=1.4,
    )
    return made


def base(above: Any) -> Any:
    """Return the acceleration of the base, under the time history, with the same times."""
    made = framed("base", "Acceleration of the base", SECONDS, "acceleration (g)", tools="xpan,xwheel_zoom")
    made.x_range = above.x_range
    made.line(
        "time",
        "acceleration",
        source=empty("line", "time", "acceleration"),
        name="line",
        line_color=style.MOTION,
        line_width=0.9,
    )
    return made
