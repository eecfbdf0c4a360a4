"""Results of a survey in memory, and as an xarray dataset with its parameters, flags, package version and method."""

from __future__ import annotations

import math
import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.package import VERSION
from rocking.model.validation import Statement
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import Level, Tile, finest

if TYPE_CHECKING:
    import xarray as xr


def dataset(spec: SurveySpec, measure: Measurement, arrays: Arrays) -> xr.Dataset:
    """Return the dataset of arrays over all axes, with coordinates and attributes."""
    import xarray as xr

    names = tuple(spec.axes)
    variables = {each.name: (names, arrays[each.name], each.attributes) for each in measure.variables}
    coordinates = {name: (name, values, spec.coordinate(name)) for name, values in spec.axes.items()}
    return xr.Dataset(variables, coordinates, attributes(spec, measure))


def attributes(spec: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """Return the attributes of a survey: the quantities that do not vary, the options and the package version."""
    return {
        "Conventions": "CF-1.11",
        "title": measure.title,
        "source": f"rocking {VERSION}",
        "method": measure.method,
        "comment": spec.comment,
        **spec.described(),
        **measure.options,
    }


SHARE = 0.5
"""Largest fraction of the memory that a survey may take."""
LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Files with the limit of a container in bytes, of versions 2 and 1 of control groups."""


class Memory:
    """Arrays of the complete survey; a single level, because partial results are not accessible."""

    def __init__(self, spec: SurveySpec, measure: Measurement) -> None:
        self.spec, self.measure = spec, measure
        self.levels: list[Level] = finest(spec)
        self.done = 0
        self.arrays = measure.blank(spec.shape)

    def known(self, tile: Tile) -> np.ndarray:
        """Return the mask of the computed points of a tile."""
        return self.arrays[self.measure.marker.name][tile.region] != self.measure.marker.fill

    def read(self, tile: Tile, names: tuple[str, ...] = ()) -> Arrays:
        """Return the results of a tile for the named variables. Default: all variables."""
        return {name: self.arrays[name][tile.region].copy() for name in names or self.arrays}

    def coarser(self, tile: Tile) -> Arrays:
        """Raise LookupError, because there is no previous level."""
        raise LookupError(f"a survey in memory has one level, not {tile.level.number + 1}")

    def write(self, tile: Tile, answers: Arrays) -> None:
        """Keep the results of a tile."""
        for name, values in answers.items():
            self.arrays[name][tile.region] = values

    def dataset(self) -> xr.Dataset:
        """Return the dataset of the survey."""
        return dataset(self.spec, self.measure, self.arrays)


def check_fits(spec: SurveySpec, measure: Measurement) -> None:
    """Raise ValueError for a survey that exceeds the memory."""
    needed = spec.points * sum(np.dtype(each.dtype).itemsize for each in measure.variables)
    if needed > SHARE * memory_size():
        raise Statement(
            f"{spec.points:,} points",
            f"take {needed / 1e9:.3g} GB, too much for the memory that this process may use, {memory_size() / 1e9:.3g} GB",
            remedy="give {store}, a folder for the results",
        )


def memory_size() -> float:
    """Return the memory that this process may use in bytes: that of the machine, or a limit; infinite if unknown."""
    size = math.inf
    with suppress(AttributeError, ValueError, OSError):
        size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    for limit_file in LIMITS:
        with suppress(OSError, ValueError):  # no such file, or no limit
            size = min(size, int(Path(limit_file).read_text()))
    with suppress(ImportError):  # only Unix has this limit
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            size = min(size, limit)
    return size
