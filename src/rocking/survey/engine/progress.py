"""Progress bar of a survey: rate, remaining time and fractions of the response types."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType

import numpy as np
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Column
from rich.text import Text

from rocking.model import percent
from rocking.survey.engine.cost import Cost
from rocking.survey.measurement import Measurement
from rocking.survey.store.export import flags


class Rate(ProgressColumn):
    """Column with the points per second of this run."""

    def render(self, task: Task) -> Text:
        """Return the rate as text, empty while it is unknown."""
        return Text(f"{task.speed:,.0f}/s" if task.speed else "")


class Bar:
    """Progress bar on stderr, below a line with the estimated cost; a context manager around the run."""

    def __init__(self, cost: Cost, measure: Measurement, workers: int | None) -> None:
        self.cost, self.workers = cost, workers
        variable = next(each for each in measure.variables if each.name == measure.shares)
        self.meanings = flags(variable.attributes)
        self.counts = dict.fromkeys(self.meanings, 0)
        self.settled_points = 0
        fixed = Column(no_wrap=True)
        shares = Column(no_wrap=True, overflow="ellipsis", ratio=1)
        self.bar = Progress(
            BarColumn(12),
            TaskProgressColumn(table_column=fixed),
            Rate(fixed.copy()),
            TimeRemainingColumn(table_column=fixed.copy()),
            TextColumn("{task.fields[shares]}", table_column=shares),
            console=Console(stderr=True, highlight=False),
            expand=True,
        )
        self.before = 0

    def __enter__(self) -> Bar:
        self.bar.console.print(self.cost.describe(self.workers))
        self.task = self.bar.add_task("", total=self.cost.points, shares="")
        self.bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None
    ) -> None:
        self.bar.stop()

    def settled(self, found: np.ndarray, *, before: bool) -> None:
        """Add completed points, given by their values of the variable shown; the rate excludes points of an earlier run."""
        values, counts = np.unique(found, return_counts=True)
        for value, count in zip(values.tolist(), counts.tolist(), strict=True):
            self.counts[value] += count
        self.settled_points += found.size
        if before:
            self.before += found.size
            self.bar.reset(self.task, completed=self.before, total=self.cost.points, start=True)
        self.bar.update(self.task, completed=self.settled_points, shares=self.shares())

    def shares(self) -> str:
        """Return the fractions of the response types so far, in descending order."""
        largest = sorted(
            ((count, self.meanings[value]) for value, count in self.counts.items() if count), reverse=True
        )
        return ", ".join(f"{meaning} {percent(count / self.settled_points)}" for count, meaning in largest)


@contextmanager
def counting(what: str, total: int) -> Iterator[Callable[[int], None]]:
    """Show a bar on stderr for runs that are no grid; the function that it gives adds completed runs."""
    console = Console(stderr=True, highlight=False)
    with Progress(
        BarColumn(12), TaskProgressColumn(), Rate(), TimeRemainingColumn(), TextColumn(what), console=console
    ) as bar:
        task = bar.add_task("", total=total)
        yield lambda runs: bar.update(task, advance=runs)
