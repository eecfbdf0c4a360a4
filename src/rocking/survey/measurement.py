"""Computation of one tile as a pure function: results depend on neither the process nor the other points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.survey.spec import SurveySpec
from rocking.survey.tiling import Tile

BATCH = 8192
"""Points per batch: enough to fill the lanes, few enough to occupy all workers until the end."""

Arrays = dict[str, np.ndarray]


@frozen(eq=False)
class Variable:
    """Variable of a survey: one number at each point.

    Attributes
    ----------
    name : str
        Name in the dataset.
    dtype : str
        NumPy type.
    fill : float
        Value of points that are not computed; never a valid result.
    attributes : dict
        `long_name`, `units`, `flag_values`, `flag_meanings` as in the CF conventions.
    """

    name: str
    dtype: str
    fill: float
    attributes: dict[str, Any]


@frozen(eq=False)
class Measurement:
    """Measurement of a survey: the function computed at each point, its variables and options.

    Attributes
    ----------
    title : str
        Title of the dataset.
    function : callable
        (inputs, options, stop) → one array (n,) per variable, by name. A pure function of the inputs of the points,
        defined in a module so that other processes can import it. Returns None if another thread sets `stop[0]`.
    variables : tuple of Variable
        Variables; the last one is written last and so marks a point as complete.
    options : dict
        Integer options of `function` by name. They are attributes of the dataset, and a store accepts no others.
    method : int
        Version of the method.
    shares : str
        Name of the variable with flags whose fractions the progress bar shows.
    batch : int or None
        Points per batch of a measurement whose points take long. Default: `BATCH`.
    """

    title: str
    function: Callable[[Any, Mapping[str, int], np.ndarray], Arrays | None]
    variables: tuple[Variable, ...]
    options: dict[str, int]
    method: int
    shares: str = "kind"
    batch: int | None = None

    def blank(self, shape: tuple[int, ...]) -> Arrays:
        """Return arrays in which no point is computed."""
        return {each.name: np.full(shape, each.fill, each.dtype) for each in self.variables}

    @property
    def marker(self) -> Variable:
        """Variable that marks a point as computed."""
        return self.variables[-1]


@frozen(eq=False)
class Batch:
    """Batch of points of a tile, computed in any process."""

    spec: SurveySpec
    wanted: np.ndarray = field(repr=False)  # indices in the tile, in C order
    function: Callable[[Any, Mapping[str, int], np.ndarray], Arrays | None]
    options: dict[str, int]


def batches(tile: Tile, spec: SurveySpec, requested: np.ndarray, measure: Measurement) -> Iterator[Batch]:
    """Split a tile into batches: strided, for load balance, or of neighbours, where these share some of the work."""
    parts = -(-requested.size // (measure.batch or BATCH))
    split = [requested[part::parts] for part in range(parts)]
    if spec.contiguous:
        split = np.array_split(requested, parts)
    inside = spec.with_axes(tile.axes())
    for part in split:
        yield Batch(inside, part, measure.function, measure.options)


def compute(batch: Batch, stop: np.ndarray) -> Arrays:
    """Return the results at the points of a batch, in their order; CancelledError if `stop` is set."""
    spec = batch.spec
    places = np.unravel_index(batch.wanted, spec.shape)
    values = {name: axis[at] for (name, axis), at in zip(spec.axes.items(), places, strict=True)}
    answers = batch.function(spec.inputs(values), batch.options, stop)
    if answers is None:
        raise CancelledError("the survey was stopped")
    return answers
