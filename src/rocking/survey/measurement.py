"""One tile, pure: the same points give the same answers, whoever computes them, together with whichever others."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.survey.spec import Points, points
from rocking.survey.tiling import Tile

BATCH = 8192
"""Points computed as one piece of work: enough to keep lanes full, few enough to keep all workers busy to the end."""

Arrays = dict[str, np.ndarray]


@frozen(eq=False)
class Variable:
    """A number that a survey finds at each point.

    Attributes
    ----------
    name : str
        Its name in the dataset.
    dtype : str
        As NumPy has it.
    fill : float
        "Not computed": a value that it never takes.
    attributes : dict
        `long_name`, `units`, `flag_values`, `flag_meanings` as in the CF conventions.
    """

    name: str
    dtype: str
    fill: float
    attributes: dict[str, Any]


@frozen(eq=False)
class Measurement:
    """What a survey finds at each point.

    Attributes
    ----------
    title : str
        What the dataset is called.
    judge : callable
        (points, options, stop) → an array (n,) a variable, by name; of a module, so that another process finds it. A
        pure function of the points; None when another thread set `stop[0]` on the way.
    compile : callable
        Compiles, or loads, what `judge` runs; told whether some points may have to be marched for long.
    variables : tuple of Variable
        The last one is written last: where it is there, all are.
    options : dict
        Whole numbers, by name, that `judge` is given; they are told in the dataset, and a store keeps to them.
    method : int
        Version of what is answered.
    shares : str
        The variable, one with flags, whose shares are told while it runs.
    """

    title: str
    judge: Callable[[Points, Mapping[str, int], np.ndarray], Arrays | None]
    compile: Callable[[bool], None]
    variables: tuple[Variable, ...]
    options: dict[str, int]
    method: int
    shares: str = "kind"

    def blank(self, shape: tuple[int, ...]) -> Arrays:
        """Arrays in which nothing is computed."""
        return {each.name: np.full(shape, each.fill, each.dtype) for each in self.variables}

    @property
    def marker(self) -> Variable:
        """The variable that tells whether a point is computed."""
        return self.variables[-1]


@frozen(eq=False)
class Batch:
    """Points of a tile to be computed as one piece of work, in any process."""

    axes: dict[str, np.ndarray]
    fixed: dict[str, float]
    wanted: np.ndarray = field(repr=False)  # their places in the tile, counted in C order
    judge: Callable[[Points, Mapping[str, int], np.ndarray], Arrays | None]
    options: dict[str, int]


def batches(tile: Tile, fixed: dict[str, float], wanted: np.ndarray, measure: Measurement) -> Iterator[Batch]:
    """The work of a tile, in pieces that each reach all over it: then none is much dearer than the others."""
    parts = -(-wanted.size // BATCH)
    for part in range(parts):
        yield Batch(tile.axes(), fixed, wanted[part::parts], measure.judge, measure.options)


def compute(batch: Batch, stop: np.ndarray) -> Arrays:
    """The answers at the points of a batch, in their order; CancelledError if told to stop."""
    places = np.unravel_index(batch.wanted, tuple(values.size for values in batch.axes.values()))
    values = {name: axis[at] for (name, axis), at in zip(batch.axes.items(), places, strict=True)}
    answers = batch.judge(points(values, batch.fixed), batch.options, stop)
    if answers is None:
        raise CancelledError("told to stop")
    return answers
