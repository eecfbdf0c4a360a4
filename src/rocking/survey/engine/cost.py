"""What a survey will cost, told before it starts."""

from __future__ import annotations

import math
import time

import numpy as np
from attrs import frozen

from rocking.model import counted
from rocking.survey.measurement import Batch, Measurement, compute
from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import Level

PILOTS, AT_ONCE = 512, 16
MAX_SECONDS = 0.5
"""Seconds that the estimate itself may take, about."""
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@frozen
class Cost:
    """Points and tiles of a survey, and the time that it will take.

    Attributes
    ----------
    points, tiles : int
        In all.
    done : int
        Points that an earlier run has done.
    seconds : float
        Of one core, for the others, from a few hundred spread over the survey; rough where a few points are very dear.
    """

    points: int
    tiles: int
    done: int
    seconds: float

    def told(self, workers: int | None) -> str:
        """In one line, for so many workers; None where nobody knows how many."""
        what = f"{self.points:,} points in {self.tiles:,} tiles"
        if self.done:
            what += f", {self.done:,} of them done"
        if workers is None:
            return f"{what}, about {duration(self.seconds)} of one core"
        return f"{what}, about {duration(self.seconds / workers)} on {counted(workers, 'core')}"


def cost(asked: SurveySpec, measure: Measurement, levels: list[Level], there: int) -> Cost:
    """The cost of a survey of which so many points are there, from a few of its points."""
    tiles = sum(math.prod(level.tile_counts) for level in levels)
    # multiples of the golden section, as whole numbers prime to the count, are spread evenly over the points
    stride = round(GOLDEN * asked.points)
    places = (np.arange(min(PILOTS, asked.points), dtype=object) * stride % asked.points).astype(np.int64)
    begun, done = time.perf_counter(), 0
    while done < places.size and time.perf_counter() - begun < MAX_SECONDS:
        wanted = places[done : done + AT_ONCE]
        compute(Batch(asked.axes, asked.fixed, wanted, measure.judge, measure.options), np.zeros(1, np.int64))
        done += wanted.size
    each = (time.perf_counter() - begun) / done
    return Cost(asked.points, tiles, there, each * (asked.points - there))


def duration(seconds: float) -> str:
    """A time that nobody reads to more than two digits."""
    for size, unit in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= 10.0 else f"{seconds:.1g} s"
