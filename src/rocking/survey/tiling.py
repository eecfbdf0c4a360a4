"""How a survey is gone through: grids from coarse to fine, cut into tiles, and what that will cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from attrs import frozen

from rocking.survey.spec import SurveySpec

COARSEST = 64
"""A grid with more points than this along an axis has a coarser one before it."""
MAX_IN_A_TILE = 1 << 16
MIN_TILES = 4
"""Along an axis of the finest grid, so that a run stopped in the middle has something to keep."""
MIN_EDGE = 32

Slices = tuple[slice, ...]


@frozen(eq=False)
class Level:
    """A plain grid of the survey.

    Attributes
    ----------
    number : int
        0 is the coarsest.
    axes : dict of str to array
        Its values by name, in the order of the dimensions.
    halved : tuple of bool, or None
        Along which axes every second value, the first among them, is one of the level before; None for the coarsest.
    tile : tuple of int
        Points along each edge of a tile; those at the far ends may be smaller.
    """

    number: int
    axes: dict[str, np.ndarray]
    halved: tuple[bool, ...] | None
    tile: tuple[int, ...]

    @property
    def name(self) -> str:
        """That of its group in a store."""
        return f"level-{self.number}"

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def tile_counts(self) -> tuple[int, ...]:
        """Tiles along each axis."""
        return tuple(-(-points // edge) for points, edge in zip(self.shape, self.tile, strict=True))

    def tiles(self) -> Iterator[Tile]:
        """Its tiles, row by row."""
        yield from map(self.at, np.ndindex(*self.tile_counts))

    def at(self, index: tuple[int, ...]) -> Tile:
        """One of its tiles."""
        spans = zip(index, self.tile, self.shape, strict=True)
        return Tile(self, index, tuple(slice(i * edge, min((i + 1) * edge, n)) for i, edge, n in spans))


@frozen(eq=False)
class Tile:
    """A rectangular part of a level, computed and stored as one."""

    level: Level
    index: tuple[int, ...]
    region: Slices

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis."""
        return tuple(part.stop - part.start for part in self.region)

    def axes(self) -> dict[str, np.ndarray]:
        """The values along its edges, by name."""
        return {n: v[part] for (n, v), part in zip(self.level.axes.items(), self.region, strict=True)}

    def shared(self) -> tuple[Slices, Slices] | None:
        """Where the points of the coarser level lie: (in this tile, in that level); None in the coarsest."""
        if self.level.halved is None:
            return None
        here, there = [], []
        for part, half in zip(self.region, self.level.halved, strict=True):
            step = 2 if half else 1
            first = part.start % step
            here.append(slice(first, None, step))
            there.append(slice((part.start + first) // step, (part.stop + step - 1) // step))
        return tuple(here), tuple(there)

    def own(self, which: np.ndarray) -> np.ndarray:
        """Of some of its points those that no coarser level has."""
        shared = self.shared()
        if shared is None:
            return which
        left = which.copy()
        left[shared[0]] = False
        return left


def levels(asked: SurveySpec) -> list[Level]:
    """The grids of a survey that begins, the coarsest first: each next one has half the spacing along the long axes."""
    grids = [asked.axes]
    halvings: list[tuple[bool, ...]] = []
    while any(values.size > COARSEST for values in grids[0].values()):
        halvings.insert(0, tuple(values.size > COARSEST for values in grids[0].values()))
        grids.insert(0, thinned(grids[0], halvings[0]))
    edges = tile_edges(asked.shape)
    return [
        Level(number, axes, halved, even_edges(axes, edges))
        for number, (axes, halved) in enumerate(zip(grids, (None, *halvings), strict=True))
    ]


def thinned(axes: dict[str, np.ndarray], halved: tuple[bool, ...]) -> dict[str, np.ndarray]:
    """The axes of the level before."""
    pairs = zip(axes.items(), halved, strict=True)
    return {name: values[::2] if half else values for (name, values), half in pairs}


def finest(asked: SurveySpec) -> list[Level]:
    """The one grid of a survey of which nobody sees a part."""
    return [Level(0, asked.axes, None, even_edges(asked.axes, tile_edges(asked.shape)))]


def tile_edges(shape: Sequence[int]) -> tuple[int, ...]:
    """Edges of the tiles of a grid: short axes whole, the others shared out evenly, a tile no larger than it may be."""
    edges, room = [0] * len(shape), MAX_IN_A_TILE
    for left, place in enumerate(sorted(range(len(shape)), key=lambda place: shape[place])):
        most = int(room ** (1 / (len(shape) - left)) + 1e-9)
        edges[place] = min(shape[place], max(-(-shape[place] // MIN_TILES), MIN_EDGE), most)
        room //= edges[place]
    return tuple(edges)


def even_edges(axes: dict[str, np.ndarray], edges: Sequence[int]) -> tuple[int, ...]:
    """Edges no longer than those, such that the tiles are about equal."""
    sizes = (values.size for values in axes.values())
    return tuple(-(-n // -(-n // edge)) for n, edge in zip(sizes, edges, strict=True))
