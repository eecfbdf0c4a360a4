"""Levels and tiles of a survey: grids from coarse to fine, divided into tiles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from attrs import frozen

from rocking.survey.spec import SurveySpec

COARSEST = 64
"""Largest number of points along an axis of the coarsest grid."""
MIN_TILES = 4
"""Minimum number of tiles along an axis of the finest grid, so that an interrupted run keeps some of them."""
MIN_EDGE = 32

Slices = tuple[slice, ...]


@frozen(eq=False)
class Level:
    """Level of a survey: a rectangular grid.

    Attributes
    ----------
    number : int
        Index of the level; 0 is the coarsest.
    axes : dict of str to array
        Axis values by name, in the order of the dimensions.
    halved : tuple of bool, or None
        For each axis, whether values 0, 2, 4, … are those of the previous level. None for the coarsest level.
    tile : tuple of int
        Number of points along each edge of a tile. Tiles at the upper ends may be smaller.
    """

    number: int
    axes: dict[str, np.ndarray]
    halved: tuple[bool, ...] | None
    tile: tuple[int, ...]

    @property
    def name(self) -> str:
        """Name of the group of the level in a store."""
        return f"level-{self.number}"

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def tile_counts(self) -> tuple[int, ...]:
        """Number of tiles along each axis."""
        return tuple(-(-points // edge) for points, edge in zip(self.shape, self.tile, strict=True))

    def tiles(self) -> Iterator[Tile]:
        """Yield the tiles, row by row."""
        yield from map(self.at, np.ndindex(*self.tile_counts))

    def at(self, index: tuple[int, ...]) -> Tile:
        """Return the tile with an index."""
        spans = zip(index, self.tile, self.shape, strict=True)
        return Tile(self, index, tuple(slice(i * edge, min((i + 1) * edge, n)) for i, edge, n in spans))


@frozen(eq=False)
class Tile:
    """Rectangular part of a level, computed and stored as a unit."""

    level: Level
    index: tuple[int, ...]
    region: Slices

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis."""
        return tuple(part.stop - part.start for part in self.region)

    def axes(self) -> dict[str, np.ndarray]:
        """Return the axis values of the tile, by name."""
        return {n: v[part] for (n, v), part in zip(self.level.axes.items(), self.region, strict=True)}

    def shared(self) -> tuple[Slices, Slices] | None:
        """Return the slices of the points shared with the coarser level; None for the coarsest level.

        Returns
        -------
        tuple of (tuple of slice, tuple of slice), or None
            Slices in this tile and in the coarser level.
        """
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
        """Return the mask `which` without the points shared with the coarser level."""
        shared = self.shared()
        if shared is None:
            return which
        left = which.copy()
        left[shared[0]] = False
        return left


def levels(spec: SurveySpec) -> list[Level]:
    """Return the levels of a new survey, the coarsest first; each level halves the spacing along the long axes, if the survey refines."""
    grids = [spec.axes]
    halvings: list[tuple[bool, ...]] = []
    while spec.refines and any(values.size > COARSEST for values in grids[0].values()):
        halvings.insert(0, tuple(values.size > COARSEST for values in grids[0].values()))
        grids.insert(0, thinned(grids[0], halvings[0]))
    edges = tile_edges(spec.shape, spec.in_a_tile)
    return [
        Level(number, axes, halved, even_edges(axes, edges))
        for number, (axes, halved) in enumerate(zip(grids, (None, *halvings), strict=True))
    ]


def thinned(axes: dict[str, np.ndarray], halved: tuple[bool, ...]) -> dict[str, np.ndarray]:
    """Return the axes of the previous level."""
    pairs = zip(axes.items(), halved, strict=True)
    return {name: values[::2] if half else values for (name, values), half in pairs}


def finest(spec: SurveySpec) -> list[Level]:
    """Return the finest level alone, for a survey in memory, which needs no coarser one."""
    return [Level(0, spec.axes, None, even_edges(spec.axes, tile_edges(spec.shape, spec.in_a_tile)))]


def tile_edges(shape: Sequence[int], largest: int | None) -> tuple[int, ...]:
    """Return the edges of tiles of at most `largest` points: short axes are undivided, the others divided evenly; None: one tile."""
    if largest is None:
        return tuple(shape)
    edges, room = [0] * len(shape), largest
    for left, place in enumerate(sorted(range(len(shape)), key=lambda place: shape[place])):
        most = int(room ** (1 / (len(shape) - left)) + 1e-9)
        edges[place] = min(shape[place], max(-(-shape[place] // MIN_TILES), MIN_EDGE), most)
        room //= edges[place]
    return tuple(edges)


def even_edges(axes: dict[str, np.ndarray], edges: Sequence[int]) -> tuple[int, ...]:
    """Return edges no longer than `edges` that give tiles of about equal size."""
    sizes = (values.size for values in axes.values())
    return tuple(-(-n // -(-n // edge)) for n, edge in zip(sizes, edges, strict=True))
