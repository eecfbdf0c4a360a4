"""Estimate of the cost of a survey, before it starts."""

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
"""Approximate time limit of the estimate itself, s."""
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@frozen
class Cost:
    """Cost of a survey: points, tiles and computing time.

    Attributes
    ----------
    points, tiles : int
        Total numbers.
    done : int
        Number of points computed by an earlier run.
    seconds : float
        Estimated time of one core for the remaining points, from a sample of up to 512 points. The estimate is rough if
        a few points are very expensive.
    """

    points: int
    tiles: int
    done: int
    seconds: float

    def describe(self, workers: int | None) -> str:
        """Return the cost in one line, for a number of workers; None if their number is unknown."""
        what = f"{self.points:,} points in {self.tiles:,} tiles"
        if self.done:
            what += f", {self.done:,} of them computed before"
        if workers is None:
            return f"{what}, about {duration(self.seconds)} on one core"
        return f"{what}, about {duration(self.seconds / workers)} on {counted(workers, 'core')}"


def cost(asked: SurveySpec, measure: Measurement, levels: list[Level], there: int) -> Cost:
    """Estimate the cost of a survey, of which `there` points exist, from a sample of its points."""
    tiles = sum(math.prod(level.tile_counts) for level in levels)
    # multiples of the golden section, rounded to integers, spread the sample evenly over the points
    stride = round(GOLDEN * asked.points)
    places = (np.arange(min(PILOTS, asked.points), dtype=object) * stride % asked.points).astype(np.int64)
    begun, done = time.perf_counter(), 0
    while done < places.size and time.perf_counter() - begun < MAX_SECONDS:
        wanted = places[done : done + AT_ONCE]
        compute(Batch(asked, wanted, measure.judge, measure.options), np.zeros(1, np.int64))
        done += wanted.size
    each = (time.perf_counter() - begun) / done
    return Cost(asked.points, tiles, there, each * (asked.points - there))


def duration(seconds: float) -> str:
    """Return a time with two digits and its unit."""
    for size, unit in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= 10.0 else f"{seconds:.1g} s"
