"""Map of the ends of blocks over size and slenderness, computed from coarse to fine."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import AsyncIterator
from functools import partial
from typing import Any

import numpy as np
from attrs import field, frozen
from matplotlib.colors import to_hex

from rocking.explorer.ground_motion.view import INTERVALS
from rocking.explorer.view_state import Span
from rocking.explorer.worker_pools import Workers
from rocking.model.text import percent
from rocking.model.verdict import Outcome
from rocking.plot import palette, style
from rocking.survey.ending_measures import BlockEndings

POINTS = INTERVALS + 1
"""Points along each side of the finest map."""
COARSEST = 8
"""Ratio of the intervals of the finest grid to those of the first."""
PIECE = 0.06
"""Target duration of a batch, s."""
SHOWN_EVERY = 0.5
"""Minimum time between two images of an incomplete grid, s."""
SHADES = 48
"""Number of colours of the largest angle of blocks that rock."""
STANDS, OVERTURNS, ROCKS = 0, 1, 2
"""Palette indices: no motion, overturning, and the first shade of rocking."""
STILL, OVERTURNED = palette.REST[0], palette.OVERTURNED[0]
ANGLES = [to_hex(each) for each in style.ANGLES(np.linspace(0.0, 1.0, SHADES))]
PALETTE = [STILL, OVERTURNED, *ANGLES]
FIELDS = {"outcome": np.uint8, "certified": np.uint8, "peak": np.float32, "margin": np.float32}
"""Stored results of each point, with their types, by the names of `rocking_spectrum`."""
CODE = tuple(Outcome).index(Outcome.OVERTURNED)


@frozen
class SizePlane:
    """Ranges of the map: half the diagonal R in m, spaced logarithmically, and the critical angle in degrees."""

    sizes: Span
    angles: Span

    def sizes_of(self, side: int) -> np.ndarray:
        """Return the sizes of the columns of a grid, in m."""
        return np.geomspace(self.sizes.low, self.sizes.high, side)

    def angles_of(self, side: int) -> np.ndarray:
        """Return the critical angles of the rows of a grid, in degrees."""
        return np.linspace(self.angles.low, self.angles.high, side)

    def corner(self, side: int) -> dict[str, Any]:
        """Return corner and sides of the image of a grid. Its points lie at the centres of their cells, also at the edges."""
        half = (self.sizes.high / self.sizes.low) ** (0.5 / (side - 1))
        left, right = self.sizes.low / half, self.sizes.high * half
        high = self.angles.width / (side - 1)
        return {
            "x": [left],
            "y": [self.angles.low - high / 2],
            "w": [right - left],
            "h": [self.angles.width + high],
        }


@frozen(eq=False)
class SizePicture:
    """Map at one stage: `FIELDS` on a grid, rows upward, and whether this grid and the finest one are complete."""

    fields: dict[str, np.ndarray] = field(repr=False)
    settled: bool
    done: bool

    @property
    def side(self) -> int:
        """Points along each side of the grid."""
        return len(self.fields["outcome"])

    def colours(self) -> np.ndarray:
        """Return palette indices, shape (side, side)."""
        outcome, peak = self.fields["outcome"], self.fields["peak"]
        shade = np.clip(np.where(np.isfinite(peak), peak, 0.0) * SHADES, 0, SHADES - 1).astype(np.uint8)
        rocks = np.where(peak > 0.0, ROCKS + shade, STANDS)
        return np.where(outcome == CODE, OVERTURNS, rocks).astype(np.uint8)

    def shares(self) -> tuple[float, float, float]:
        """Return the area fractions of blocks that do not move, that rock and stand, and that overturn."""
        overturns = float(np.mean(self.fields["outcome"] == CODE))
        stands = float(np.mean(self.fields["peak"] == 0.0))
        return stands, 1.0 - stands - overturns, overturns

    def legend(self) -> dict[str, Any]:
        """Return the legend for the page, with area fractions."""
        stands, rocks, overturns = map(percent, self.shares())
        undecided = float(np.mean(self.fields["certified"] == 0))
        return {
            "stands": {"colour": STILL, "share": stands},
            "rocks": {"colours": ANGLES, "share": rocks},
            "overturns": {"colour": OVERTURNED, "share": overturns},
            "undecided": percent(undecided) if undecided else "",
            "side": self.side,
            "settled": self.settled,
            "done": self.done,
        }

    def answers(self) -> dict[str, np.ndarray]:
        """Return the results of all points for the readout and the table; flat, rows upward."""
        return {name: values.ravel() for name, values in self.fields.items()}


class SizeRefinement:
    """Refinement of the map on the worker threads, by whole columns, until `stop[0]` is set."""

    def __init__(self, plane: SizePlane, endings: BlockEndings, workers: Workers, stop: np.ndarray) -> None:
        self.plane, self.endings, self.workers, self.stop = plane, endings, workers, stop
        self.fields: dict[str, np.ndarray] = {}
        self.side = 0
        self.columns = 1

    def coarse(self) -> SizePicture:
        """Compute the first, coarse map in the calling thread."""
        self._begin((POINTS - 1) // COARSEST + 1)
        self._keep(*self._judge(np.arange(self.side)))
        return self._picture(settled=True)

    async def finer(self) -> AsyncIterator[SizePicture]:
        """Yield successive maps after `coarse`; the last one is complete."""
        while self.side < POINTS:
            self._begin(2 * self.side - 1)
            async for picture in self._settle():
                yield picture

    async def _settle(self) -> AsyncIterator[SizePicture]:
        """Compute the columns of a grid in random order, so that each image shows all parts, and yield images."""
        left = np.random.default_rng(0).permutation(self.side)
        under_way: set[asyncio.Future[tuple[Any, ...]]] = set()
        shown = time.perf_counter()
        while left.size or under_way:
            while left.size and len(under_way) <= self.workers.count:
                piece, left = left[: self.columns], left[self.columns :]
                under_way.add(asyncio.ensure_future(self.workers.later(partial(self._judge, np.sort(piece)))))
            done, under_way = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for future in done:
                self._keep(*future.result())
            if time.perf_counter() - shown > SHOWN_EVERY and (left.size or under_way):
                shown = time.perf_counter()
                yield self._picture(settled=False)
        yield self._picture(settled=True)

    def _judge(self, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Return places and results of all new points of some columns."""
        begun = time.thread_time()
        known = np.zeros((columns.size, self.side), bool)
        if self.side > (POINTS - 1) // COARSEST + 1:
            known[np.ix_(columns % 2 == 0, np.arange(self.side) % 2 == 0)] = True
        places, rows = np.nonzero(~known)
        sizes, angles = self.plane.sizes_of(self.side), np.radians(self.plane.angles_of(self.side))
        found = self.endings.at(sizes[columns[places]], angles[rows], self.stop)
        if found is None:
            raise asyncio.CancelledError
        each = max(time.thread_time() - begun, 1e-6) / columns.size
        self.columns = min(max(math.floor(PIECE / each), 1), self.side // (4 * self.workers.count) + 1)
        return rows, columns[places], found

    def _begin(self, side: int) -> None:
        """Start a grid of `side` × `side` points, filled with the nearest points of the previous grid."""
        self.side = side
        nearest = (np.arange(side) + 1) // 2
        for name, dtype in FIELDS.items():
            before = self.fields.get(name)
            self.fields[name] = (
                np.zeros((side, side), dtype) if before is None else before[np.ix_(nearest, nearest)]
            )

    def _keep(self, rows: np.ndarray, columns: np.ndarray, found: dict[str, np.ndarray]) -> None:
        for name, values in self.fields.items():
            values[rows, columns] = found[name]

    def _picture(self, *, settled: bool) -> SizePicture:
        kept = {name: values.copy() for name, values in self.fields.items()}
        return SizePicture(kept, settled, settled and self.side == POINTS)
