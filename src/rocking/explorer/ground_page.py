"""Page of ground motions: a record or pulse, blocks of many sizes under it, and the motion of one of them."""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
from bokeh.document import Document

from rocking.explorer import figures, ground_maps
from rocking.explorer.fields import Refused
from rocking.explorer.ground_block import Contents, block_motion, no_motion
from rocking.explorer.ground_maps import Endings
from rocking.explorer.ground_view import (
    DEFAULT,
    SCALES,
    SIZES,
    SLENDERNESS,
    SOURCES,
    UNITS,
    Ground,
    GroundView,
    ground_of,
    open_file,
    read_file,
    vertical_channels,
)
from rocking.explorer.jobs import Workers
from rocking.explorer.page import Page
from rocking.explorer.refinement import Picture, Refinement
from rocking.explorer.session import Job, Session
from rocking.model.forcing import KINDS
from rocking.model.validation import ContactLost, TooManyEvents
from rocking.survey.ending_measures import BlockEndings

EXAMPLE = re.compile(r"for example \w+='?([^',;]+)'?")
"""Example of an argument in the message on a file; the page shows the field of this argument."""
LOST = "the link shows a file, which is not part of the link: choose the file again"
UNFINISHED = "the map is not complete: save it when it is"
SHAKEN = ("shaking", "scale", "equation")


class GroundSession(Session):
    """Session of the page, and the file that it shows."""

    VIEW = GroundView

    def __init__(self, document: Document, workers: Workers) -> None:
        self.ground = ground_of(DEFAULT, ())
        self.finest: tuple[Endings, Picture] | None = None
        self.file: tuple[str, bytes] | None = None
        self.pending: GroundView | None = None  # view of the file, until it is read
        self.channels: tuple[Ground, ...] = ()
        super().__init__(document, workers)
        receive = self.in_turn(self.receive)
        self.link.on_change("file", lambda _name, _before, value: receive(value))

    # figures and requests

    def figures(self) -> tuple[Any, ...]:
        """Make the figures, of which the map can be clicked."""
        self.map, history = figures.plane_of_blocks(ground_maps.PALETTE), figures.block_history()
        self._place_map(DEFAULT)
        self.map.x_range.bounds, self.map.y_range.bounds = SIZES, SLENDERNESS
        self.select(self.map, self._block_at)
        return self.map, history, figures.base(history)

    def _block_at(self, size: float, degrees: float) -> dict[str, str]:
        return self.view.at_point(size, degrees)

    def answer(self, what: str, typed: dict[str, str]) -> tuple[Any, dict[str, str]]:
        """Return the requested view, None if it follows later; a request of this page is the file of the map."""
        if what == "save":
            self.jobs.start("save", self.save_map, self.view)
            return None, {}
        if what == "fields" and {"units", "step"} & typed.keys() and self.file is not None:
            self._start_reading((self.pending or self.view).changed(typed | {"source": "file"}))
            return None, {}
        new, refused = super().answer(what, typed)
        if new.source == "file" and self._has_read(new):
            try:
                ground_of(new, self.channels)
            except Refused as unfit:
                if what == "fields":
                    raise
                new, refused = attrs.evolve(new, vertical=None), refused | unfit.fields
        if new.source != "file" or self._has_read(new):
            return attrs.evolve(new, reading=self.view.reading), refused
        if what == "fields":
            raise Refused({"file": "choose a file"})
        return attrs.evolve(new, source=DEFAULT.source), refused | {"file": LOST}

    def _has_read(self, new: GroundView) -> bool:
        return bool(self.channels) and (new.units, new.step) == (self.view.units, self.view.step)

    # files

    def receive(self, value: Any) -> None:
        """Read a file that the page sends; its bytes stay in this session until the next file."""
        if value is None:
            return
        self.link.file = None  # type: ignore[assignment]  # the type hint of the property lacks values
        try:
            self.file = open_file(value)
        except ValueError as error:
            self.link.refuse(file=str(error))
            return
        new = attrs.evolve(self.view, source="file", units="", step=None, channel=1, vertical=None)
        self._start_reading(new.begun_from(self.view))

    def _start_reading(self, new: GroundView) -> None:
        self.pending = new
        self.jobs.start("read", self._read, new)

    async def _read(self, new: GroundView, stop: np.ndarray) -> None:
        """Read the file for a view, and show it; an error keeps the view."""
        assert self.file is not None
        try:
            channels = await self.workers.read(read_file, *self.file, new)
        except (ValueError, OSError) as error:
            await self.change(self._refuse_file, EXAMPLE.sub(r"for example \1", str(error)))
        except Exception:
            logging.getLogger(__name__).exception("a file could not be read")
            await self.change(self._refuse_file, "the file could not be read")
        else:
            new = attrs.evolve(new, channel=min(new.channel, len(channels)))
            await self.workers.read(ground_of(new, channels).words, new.scale)  # long for many samples
            await self.change(self._accept, new, channels)

    def _refuse_file(self, sentence: str) -> None:
        self.link.refuse(file=sentence)

    def _accept(self, new: GroundView, channels: tuple[Ground, ...]) -> None:
        self.channels, self.pending = channels, None
        self.link.refuse()
        self.show(attrs.evolve(new, reading=self.view.reading + 1), push=True)

    # the view

    def place(self, changed: Callable[..., bool]) -> None:
        """Take the base motion, set the ranges of the map and mark the selected block."""
        if changed("shaking", "upward"):
            self.ground = ground_of(self.view, self.channels)
        self._place_map(self.view)
        block = self.view.block
        self.link.draw(map={"point": {"x": [block.radius], "y": [math.degrees(block.critical_angle)]}})

    def _place_map(self, view: GroundView) -> None:
        for range_, span in ((self.map.x_range, view.sizes), (self.map.y_range, view.angles)):
            range_.update(start=span.low, end=span.high)

    def description(self) -> dict[str, Any]:
        """Return the ranges of map and slider, what the map leaves out, the base motion and the block."""
        view = self.view
        return {
            "sizes": [view.sizes.low, view.sizes.high],
            "angles": [view.angles.low, view.angles.high],
            "scales": SCALES,
            "left_out": view.left_out,
            "ground": self.ground.words(view.scale),
            "channels": [each.name for each in self.channels],
            "verticals": [*vertical_channels(view, self.channels).items()],
            "block": {
                "height": view.height,
                "width": view.width,
                "critical": view.block.critical_angle,
                "centre": [view.offset, view.block.centre_height] if view.offset else None,
                "wall": view.wall is not None,
                "restrained": view.restrainer is not None,
            },
        }

    # the map

    async def refine_map(self, view: GroundView, stop: np.ndarray) -> None:
        """Compute and draw the map of the horizontal motion, from coarse to fine."""
        self.finest = None
        base = ground_of(attrs.evolve(view, vertical=None), self.channels).base
        endings = await self.workers.soon(BlockEndings, base, view.scale, *view.equation)
        measure = Endings(view.sizes, view.angles, endings)

        def draw(picture: Picture) -> None:
            corner = ground_maps.corner(view.sizes, view.angles, picture.side)
            drawn: dict[str, Any] = {"image": {"image": [ground_maps.colours(picture)], **corner}}
            self.link.draw(map=drawn | ({"answers": ground_maps.answers(picture)} if picture.whole else {}))
            self.link.send("legend", ground_maps.legend(picture))
            self.link.send("progress", picture.progress())
            if picture.done:
                self.finest = measure, picture

        await self.refine(Refinement(measure, self.workers, stop), draw)

    async def save_map(self, view: GroundView, stop: np.ndarray) -> None:
        """Send the finished map as a netCDF file."""
        if self.finest is None:
            await self.change(lambda: self.link.refuse(page=UNFINISHED))
            return
        name = self.ground.words(view.scale)["name"]
        model, normalised_by = view.equation
        described = {"base_motion": name, "level": view.scale, "model": model}
        described |= {"normalised_by": normalised_by} if normalised_by else {}
        described |= {"view": view.address}
        await self.change(
            self.link.save, await self.workers.soon(ground_maps.netcdf, *self.finest, described)
        )

    # one block

    async def draw_motion(self, view: GroundView, stop: np.ndarray) -> None:
        """Draw the motion of the selected block and send its verdict."""
        try:
            drawn, words = await self.workers.soon(block_motion, view, self.ground)
        except (TooManyEvents, ContactLost) as error:
            drawn, words = no_motion(view, self.ground, str(error))
        await self.change(self._draw_motion, drawn, words)

    def _draw_motion(self, drawn: Contents, words: dict[str, Any]) -> None:
        self.link.draw(**drawn)
        self.link.send("verdict", words)

    JOBS = (
        Job("map", refine_map, (*SHAKEN, "sizes", "angles"), ("map",)),
        Job(
            "motion",
            draw_motion,
            (*SHAKEN, "upward", "height", "width", "offset", "wall", "restrainer", "friction"),
            ("verdict",),
        ),
    )


PAGE = Page(
    "ground",
    "rocking explorer: ground motion",
    GroundSession,
    styles=("common.css", "ground.css"),
    variables={"sources": SOURCES, "kinds": KINDS, "units": [unit for unit in UNITS if unit]},
)
