"""Figures of one session of the page of ground motions: computed at once for each view, then refined."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import count
from typing import Any

import numpy as np

from rocking.explorer.document_renderer import DocumentRenderer
from rocking.explorer.ground_motion import figures
from rocking.explorer.ground_motion.block_motion import BlockMotion, block_motion, no_motion
from rocking.explorer.ground_motion.ground import Ground, ground_of
from rocking.explorer.ground_motion.map_file import netcdf
from rocking.explorer.ground_motion.size_map import SizePicture, SizePlane, SizeRefinement
from rocking.explorer.ground_motion.view import DEFAULT, GroundView
from rocking.model.validation import TooManyEvents
from rocking.survey.ending_measures import BlockEndings

UNFINISHED = "the map is not complete: save it when it is"


class GroundRenderer(DocumentRenderer):
    """Map, time history and base acceleration of a document, and the jobs that fill them."""

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self.ground: Ground = ground_of(DEFAULT, ())
        self._serial = count()
        self.finest: tuple[SizePlane, SizePicture] | None = None
        self.map, self.history = figures.size_map(), figures.history()

    def attach(self) -> None:
        """Add the figures to the document. Event handlers must be attached before, or the document ignores the events."""
        with self.document.models.freeze():
            for root in (self.map, self.history, figures.base(self.history), self.link):
                self.document.add_root(root)

    async def act(self, change: Callable[[], None]) -> None:
        """Change the document in its event loop, with its lock held."""
        await self._draw(change)

    def mark(self, shown: GroundView) -> None:
        """Set the ranges of the map and mark the selected block."""
        figures.place(self.map, shown)
        block = shown.block
        self.link.draw(map={"point": {"x": [block.radius], "y": [block.degrees(1.0)]}})

    # the map

    async def refine_map(self, shown: GroundView, stop: np.ndarray) -> None:
        """Compute and draw the map, from coarse to fine."""
        self.finest = None
        ground, plane = self.ground, SizePlane(shown.sizes, shown.angles)
        endings = await self.workers.soon(partial(BlockEndings, ground.base, shown.scale, shown.model))
        refinement = SizeRefinement(plane, endings, self.workers, stop)
        picture = await self.workers.soon(refinement.coarse)
        await self._draw(partial(self._draw_map, plane, picture))
        async for finer in refinement.finer():
            await self._draw(partial(self._draw_map, plane, finer))

    def _draw_map(self, plane: SizePlane, picture: SizePicture) -> None:
        drawn: dict[str, Any] = {"image": {"image": [picture.colours()], **plane.corner(picture.side)}}
        if picture.settled:
            drawn["answers"] = picture.answers()
        self.link.draw(map=drawn)
        self.link.send("legend", picture.legend())
        if picture.done:
            self.finest = plane, picture

    async def save_map(self, shown: GroundView, stop: np.ndarray) -> None:
        """Send the finished map as a netCDF file."""
        if self.finest is None:
            await self._draw(partial(self.link.send, "refused", {"fields": {"page": UNFINISHED}}))
            return
        words = self.ground.words(shown.scale)
        data = await self.workers.soon(partial(netcdf, *self.finest, words["name"], shown))
        await self._draw(partial(self._save, data))

    def _save(self, data: bytes) -> None:
        self.link.saved = {"n": next(self._serial), "data": data}  # type: ignore[assignment]  # the type hint lacks values

    # one block

    async def draw_motion(self, shown: GroundView, stop: np.ndarray) -> None:
        """Draw the motion of the selected block and tell its verdict."""
        try:
            found = await self.workers.soon(partial(block_motion, shown, self.ground))
        except TooManyEvents as error:
            found = no_motion(shown, self.ground, str(error))
        await self._draw(partial(self._draw_motion, shown, found))

    def _draw_motion(self, shown: GroundView, found: BlockMotion) -> None:
        critical = shown.block.degrees(1.0)
        self.link.draw(
            history={
                "ranges": found.spans["history"],
                "line": found.angle,
                "above": critical,
                "below": -critical,
            },
            base={"ranges": found.spans["base"], "line": found.base},
        )
        self.link.send("verdict", found.words)
