"""Estimate of the cost of a survey, before it starts."""

from __future__ import annotations

import math
import time
from concurrent.futures import CancelledError
from contextlib import suppress
from threading import Timer

import numpy as np
from attrs import frozen

from rocking.model.text import counted
from rocking.survey.measurement import Batch, Measurement, compute
from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import Level

PILOTS = 512
"""Points of the sample. They are computed together, as in the survey: alone, a point takes many times as long."""
MAX_SECONDS = 0.5
"""Time limit of the estimate itself, s."""
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
    at_least : bool
        Whether the sample was stopped at its time limit. Then `seconds` is a lower bound.
    """

    points: int
    tiles: int
    done: int
    seconds: float
    at_least: bool = False

    def describe(self, workers: int | None) -> str:
        """Return the cost in one line, for a number of workers; None if their number is unknown."""
        what = f"{self.points:,} points in {self.tiles:,} tiles"
        if self.done:
            what += f", {self.done:,} of them computed before"
        about = "more than" if self.at_least else "about"
        on = "one core" if workers is None else counted(workers, "core")
        return f"{what}, {about} {duration(self.seconds / (workers or 1))} on {on}"


def cost(asked: SurveySpec, measure: Measurement, levels: list[Level], there: int) -> Cost:
    """Estimate the cost of a survey, of which `there` points exist, from a sample of its points."""
    tiles = sum(math.prod(level.tile_counts) for level in levels)
    # multiples of the golden section, rounded to integers, spread the sample evenly over the points
    stride = round(GOLDEN * asked.points)
    places = (np.arange(min(PILOTS, asked.points), dtype=object) * stride % asked.points).astype(np.int64)
    stop = np.zeros(1, np.int64)
    compute(Batch(asked, places[:1], measure.judge, measure.options), stop)  # opens the compiled kernels
    limit = Timer(MAX_SECONDS, stop.fill, (1,))
    limit.start()
    begun = time.perf_counter()
    with suppress(CancelledError):
        compute(Batch(asked, places, measure.judge, measure.options), stop)
    limit.cancel()
    each = (time.perf_counter() - begun) / places.size
    return Cost(asked.points, tiles, there, each * (asked.points - there), bool(stop[0]))


def duration(seconds: float) -> str:
    """Return a time with two digits and its unit."""
    for size, unit in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= 10.0 else f"{seconds:.1g} s"
