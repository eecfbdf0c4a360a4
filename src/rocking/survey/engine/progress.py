"""Progress of a survey: points computed, and fractions of the response types."""

from __future__ import annotations

from concurrent.futures import Future
from typing import Any

import numpy as np

from rocking.model.progress import Bar
from rocking.model.text import percent
from rocking.survey.measurement import Measurement
from rocking.survey.store.export import flags


def count_when_done(bar: Bar, batch: Future[Any], points: int) -> None:
    """Count the points of a batch when it ends."""

    def count(ended: Future[Any]) -> None:
        if not ended.cancelled() and ended.exception() is None:
            bar.advance(points)

    batch.add_done_callback(count)


class Watcher:
    """Report of a survey to its progress bar.

    Points count when their batch ends. The fractions of the response types follow when their tile is kept.
    """

    def __init__(self, bar: Bar, measure: Measurement) -> None:
        self.bar, self.shares = bar, measure.shares
        variable = next(each for each in measure.variables if each.name == measure.shares)
        self.meanings = flags(variable.attributes)
        self.counts = dict.fromkeys(self.meanings, 0)

    def settled(self, found: np.ndarray, *, before: bool) -> None:
        """Count the types of completed points; those of an earlier run count as points, too."""
        values, counts = np.unique(found, return_counts=True)
        for value, count in zip(values.tolist(), counts.tolist(), strict=True):
            self.counts[value] += count
        total = max(sum(self.counts.values()), 1)
        largest = sorted(
            ((count, self.meanings[value]) for value, count in self.counts.items() if count), reverse=True
        )
        self.bar.text = ", ".join(f"{meaning} {percent(count / total)}" for count, meaning in largest)
        if before:
            self.bar.advance(found.size, before=True)
