"""Results of a survey that are kept in memory."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING

import numpy as np

from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.store.dataset import dataset
from rocking.survey.tiling import Level, Tile, finest

if TYPE_CHECKING:
    import xarray as xr


SHARE = 0.5
"""Of a machine's memory, that a survey may take."""


class Memory:
    """Arrays of the whole survey; only its finest grid, since nobody sees it before it is done."""

    def __init__(self, asked: SurveySpec, measure: Measurement) -> None:
        self.asked, self.measure = asked, measure
        self.levels: list[Level] = finest(asked)
        self.done = 0
        self.arrays = measure.blank(asked.shape)

    def known(self, tile: Tile) -> np.ndarray:
        """Which points of a tile are there."""
        return self.arrays[self.measure.marker.name][tile.region] != self.measure.marker.fill

    def read(self, tile: Tile, names: tuple[str, ...] = ()) -> Arrays:
        """What is there of a tile, of all variables unless some are named."""
        return {name: self.arrays[name][tile.region].copy() for name in names or self.arrays}

    def coarser(self, tile: Tile) -> Arrays:
        """Of the level before, the points that a tile shares: there is none."""
        raise LookupError(f"a survey in memory has one level, not {tile.level.number + 1}")

    def write(self, tile: Tile, answers: Arrays) -> None:
        """Keep a tile."""
        for name, values in answers.items():
            self.arrays[name][tile.region] = values

    def dataset(self) -> xr.Dataset:
        """All of it."""
        return dataset(self.asked, self.measure, self.arrays)


def check_fits(asked: SurveySpec, measure: Measurement) -> None:
    """Refuse a survey that memory does not hold; ValueError with the way out."""
    needed = asked.points * sum(np.dtype(each.dtype).itemsize for each in measure.variables)
    if needed > SHARE * memory_size():
        raise ValueError(
            f"{asked.points:,} points take {needed / 1e9:.3g} GB, too much for this machine's memory of "
            f"{memory_size() / 1e9:.3g} GB (give store, a folder that they are written to)"
        )


def memory_size() -> float:
    """Bytes of this machine's memory; infinite where the system does not tell."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return math.inf
