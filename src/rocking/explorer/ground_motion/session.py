"""Session of the page of ground motions: its view, its requests, and the figures that each request recomputes."""

from __future__ import annotations

import json
import logging
from functools import partial
from typing import Any

import attrs
import numpy as np
from bokeh.document import Document
from bokeh.events import Tap

from rocking.explorer.field_readers import Refused, written
from rocking.explorer.ground_motion.ground import Ground, ground_of, open_file, read_file
from rocking.explorer.ground_motion.renderer import GroundRenderer
from rocking.explorer.ground_motion.view import (
    DEFAULT,
    SCALES,
    GroundView,
    address,
    at_point,
    changed,
    from_address,
)
from rocking.explorer.page_channel import STRANGE, Link, message
from rocking.explorer.worker_pools import Workers

LOST = "the link shows a file, which is not part of the link: choose the file again"


class GroundSession:
    """Bokeh document with its current view, and the file that it shows."""

    def __init__(self, document: Document, workers: Workers) -> None:
        self.link = Link(name="link")
        self.renderer = GroundRenderer(document, self.link, workers)
        self.shown, self.opened = DEFAULT, False
        self.file: tuple[str, bytes] | None = None
        self.pending: GroundView | None = None  # view of the file, until it is read
        self.channels: tuple[Ground, ...] = ()
        in_turn = self.renderer.in_turn
        hear, receive = in_turn(self.hear), in_turn(self.receive)
        self.link.on_change("asked", lambda _name, _before, text: hear(text))
        self.link.on_change("file", lambda _name, _before, given: receive(given))
        self.renderer.map.on_event(Tap, in_turn(self._tapped))
        self.renderer.attach()
        document.on_session_destroyed(lambda _context: self.renderer.jobs.end_all())

    def hear(self, text: str) -> None:
        """Carry out a request of the page. An invalid request returns one sentence per field and leaves the view unchanged."""
        try:
            request = message(text)
            new, refused = self._requested(request["what"], request["fields"])
        except Refused as refusal:
            self.link.send("refused", {"fields": refusal.fields})
            return
        self.link.send("refused", {"fields": refused})
        if new is not None:
            self.show(new, push=request.get("push") == "yes")

    def _requested(self, what: str, typed: dict[str, str]) -> tuple[GroundView | None, dict[str, str]]:
        """Return the requested view, None if it follows later, and an error message for each invalid parameter of a link."""
        if what == "open":
            new, refused = from_address(typed.get("address", ""))
            if new.source == "file" and not self._has_read(new):
                return attrs.evolve(new, source=DEFAULT.source), refused | {"file": LOST}
            return new, refused
        if what == "fields":
            if {"units", "step"} & typed.keys() and self.file is not None:
                self._start_reading(changed(self.pending or self.shown, typed | {"source": "file"}))
                return None, {}
            new = changed(self.shown, typed)
            if new.source == "file" and not self.channels:
                raise Refused({"file": "choose a file"})
            return new, {}
        if what == "save":
            self.renderer.jobs.start("save", partial(self.renderer.save_map, self.shown))
            return None, {}
        raise Refused({"page": STRANGE})

    def _has_read(self, new: GroundView) -> bool:
        return bool(self.channels) and (new.units, new.step) == (self.shown.units, self.shown.step)

    # files

    def receive(self, given: Any) -> None:
        """Read a file that the page sends; its bytes stay in this session until the next file."""
        if given is None:
            return
        self.link.file = None  # type: ignore[assignment]  # the type hint of the property lacks values
        try:
            self.file = open_file(given)
        except ValueError as error:
            self.link.send("refused", {"fields": {"file": str(error)}})
            return
        self._start_reading(attrs.evolve(self.shown, source="file", units="", step=None, channel=1))

    def _start_reading(self, new: GroundView) -> None:
        self.pending = new
        self.renderer.jobs.start("read", partial(self._read, new))

    async def _read(self, new: GroundView, stop: np.ndarray) -> None:
        """Read the file for a view, and show it; an error keeps the view."""
        assert self.file is not None
        try:
            channels = await self.renderer.workers.read(partial(read_file, *self.file, new))
        except (ValueError, OSError) as error:
            await self.renderer.act(partial(self._refuse_file, str(error)))
        except Exception:
            logging.getLogger(__name__).exception("a file could not be read")
            await self.renderer.act(partial(self._refuse_file, "the file could not be read"))
        else:
            new = attrs.evolve(new, channel=min(new.channel, len(channels)))
            ground = ground_of(new, channels)
            await self.renderer.workers.read(partial(ground.words, new.scale))  # long for many samples
            await self.renderer.act(partial(self._accept, new, channels, ground))

    def _refuse_file(self, sentence: str) -> None:
        self.link.send("refused", {"fields": {"file": sentence}})

    def _accept(self, new: GroundView, channels: tuple[Ground, ...], ground: Ground) -> None:
        self.channels, self.pending = channels, None
        self.link.send("refused", {"fields": {}})
        self.show(new, push=True, ground=ground)

    # the view

    def _tapped(self, event: Tap) -> None:
        if not isinstance(event.x, float | int) or not isinstance(event.y, float | int):
            return  # not a number, so not a message of this page
        fields = at_point(self.shown, event.x, event.y)
        self.hear(json.dumps({"what": "fields", "fields": fields, "push": "yes"}))

    def show(self, new: GroundView, *, push: bool, ground: Ground | None = None) -> None:
        """Change the view and recompute the figures that differ; `ground` is the base motion of a file just read."""
        old, first = self.shown, not self.opened
        self.shown, self.opened = new, True
        renderer, jobs = self.renderer, self.renderer.jobs
        shaken = first or ground is not None or (old.shaking, old.scale) != (new.shaking, new.scale)
        if ground is not None:
            renderer.ground = ground
        elif first or old.shaking != new.shaking:
            renderer.ground = ground_of(new, self.channels)
        shaken = shaken or old.model != new.model
        mapped = shaken or (old.sizes, old.angles) != (new.sizes, new.angles)
        moved = shaken or (old.height, old.width) != (new.height, new.width)
        changes = {"push": push, "renewed": ["map"] if mapped else [], "moved": moved}
        self.link.send("shown", self._told(renderer.ground) | changes)
        renderer.mark(new)
        if mapped:
            jobs.start("map", partial(renderer.refine_map, new))
        if moved:
            jobs.start("motion", partial(renderer.draw_motion, new))

    def _told(self, ground: Ground) -> dict[str, Any]:
        new = self.shown
        return {
            "address": address(new),
            "fields": {each.name: written(getattr(new, each.name)) for each in attrs.fields(GroundView)},
            "sizes": [new.sizes.low, new.sizes.high],
            "angles": [new.angles.low, new.angles.high],
            "scales": SCALES,
            "ground": ground.words(new.scale),
            "channels": [each.name for each in self.channels],
            "block": {"height": new.height, "width": new.width, "critical": new.block.critical_angle},
        }
