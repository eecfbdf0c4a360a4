"""Session of one browser page: its view, its requests, and the figures that each request recomputes."""

from __future__ import annotations

import json
from functools import partial
from typing import Any

import attrs
from bokeh.document import Document
from bokeh.events import Tap

from rocking.explorer import plane_axes, presets, texts
from rocking.explorer.field_readers import Refused, written
from rocking.explorer.form_fields import address, changed, from_address, in_metres
from rocking.explorer.page_channel import STRANGE, Link, message
from rocking.explorer.renderer import SessionRenderer
from rocking.explorer.view_state import DEFAULT, Span, ViewState, closest, nearby
from rocking.explorer.worker_pools import Workers

SHAKEN = ("restitution", "phase", "angle", "velocity", "brace_angle", "brace_restitution", "critical_angle")
SYSTEM = ("amplitude", "period", *SHAKEN)


class Session:
    """Bokeh document with its current view."""

    def __init__(self, document: Document, workers: Workers) -> None:
        self.link = Link(name="link")
        self.painter = SessionRenderer(document, self.link, workers)
        self.shown, self.opened = DEFAULT, False
        in_turn = self.painter.in_turn
        hear = in_turn(self.hear)
        self.link.on_change("asked", lambda _name, _before, text: hear(text))
        self.painter.map.on_event(Tap, in_turn(self._tapped_map))
        self.painter.basin.on_event(Tap, in_turn(self._tapped_basin))
        self.painter.diagram.on_event(Tap, in_turn(self._tapped_diagram))
        self.painter.attach()
        document.on_session_destroyed(lambda _context: self.painter.jobs.end_all())

    def hear(self, text: str) -> None:
        """Carry out a request of the page. An invalid request returns one sentence per field and leaves the view unchanged."""
        try:
            asked = message(text)
            new, refused = self._asked(asked["what"], asked["fields"])
        except Refused as refusal:
            self.link.send("refused", {"fields": refusal.fields})
            return
        self.link.send("refused", {"fields": refused})
        self.show(new, push=asked.get("push") == "yes")

    def _asked(self, what: str, typed: dict[str, str]) -> tuple[ViewState, dict[str, str]]:
        """Return the requested view.

        Returns
        -------
        tuple of (ViewState, dict of str)
            New view, and an error message for each invalid parameter of a link.

        Raises
        ------
        Refused
            If the request is unknown or a field is invalid.
        """
        if what == "open":
            return from_address(typed.get("address", ""))
        if what == "fields":
            return changed(self.shown, typed), {}
        if what == "metres":
            return in_metres(self.shown, typed), {}
        if what == "case" and typed.get("name") in presets.BY_NAME:
            return presets.BY_NAME[typed["name"]].shown, {}
        raise Refused({"page": STRANGE})

    def _tapped_map(self, event: Tap) -> None:
        corner = self.painter.corner
        self._choose(
            period=(event.x, corner.across, self.shown.periods),
            amplitude=(event.y, corner.up, self.shown.amplitudes),
        )

    def _tapped_basin(self, event: Tap) -> None:
        corner = self.painter.basin_corner
        self._choose(
            angle=(event.x, corner.across, self.shown.angles),
            velocity=(event.y, corner.up, self.shown.velocities),
        )

    def _tapped_diagram(self, event: Tap) -> None:
        self._choose(**{self.shown.vary: (event.x, 0.0, self.shown.varied)})

    def _choose(self, **taps: tuple[Any, float, Span]) -> None:
        """Select the point of a click, given per field as (coordinate, offset of the axis, range of the axis)."""
        try:
            fields = {
                name: written(nearby(base + float(at), span)) for name, (at, base, span) in taps.items()
            }
        except (TypeError, ValueError):
            return  # not a number, so not a message of this page
        self.hear(json.dumps({"what": "fields", "fields": fields, "push": "yes"}))

    def show(self, new: ViewState, *, push: bool) -> None:
        """Change the view and recompute the figures that differ."""
        old, first = self.shown, not self.opened
        self.shown, self.opened = new, True

        def differs(*names: str) -> bool:
            return first or any(getattr(old, name) != getattr(new, name) for name in names)

        painter, jobs = self.painter, self.painter.jobs
        if differs("periods", "amplitudes", "height", "width", "restitution"):
            painter.place_map(new)
        if differs("angles", "velocities"):
            painter.place_basin(new)
        painter.mark(new)
        mapped = differs("periods", "amplitudes", *SHAKEN)
        moved = differs(*SYSTEM, "first", "cycles", "height", "width")
        started = moved or differs("angles", "velocities")
        computed = {"map": mapped, "section": moved, "basin": started}
        renewed = [name for name, again in computed.items() if again]
        self.link.send("shown", self._told() | {"push": push, "moved": moved, "renewed": renewed})
        if mapped:
            jobs.start("map", partial(painter.refine_map, new))
        if moved:
            for name in ("basin", "section", "judge"):
                jobs.end(name)
            jobs.start("response", partial(painter.respond, new))
        elif started:
            jobs.start("basin", partial(painter.refine_basin, new))
        if differs("vary", "varied", *[name for name in SYSTEM if name != new.vary]):
            jobs.start("diagram", partial(painter.draw_diagram, new))

    def _told(self) -> dict[str, Any]:
        new, painter = self.shown, self.painter
        return {
            "address": address(new),
            "fields": {each.name: written(getattr(new, each.name)) for each in attrs.fields(ViewState)},
            "planes": {
                "map": _plane(painter.corner, new.periods, new.amplitudes),
                "basin": _plane(painter.basin_corner, new.angles, new.velocities),
            },
            "slider": [new.varied.low, new.varied.high, getattr(new, new.vary)],
            "python": texts.python(new),
            "commands": texts.commands(new),
        }


def _plane(corner: plane_axes.Corner, across: Span, up: Span) -> dict[str, Any]:
    """Return offsets and ranges of a map, and whether it is at the zoom limit of double precision."""
    deepest = any(span.width <= closest(span) * 1.01 for span in (across, up))
    return {"base": [corner.across, corner.up], "ranges": list(corner.ranges(across, up)), "deepest": deepest}
