"""Evaluation of a measurement at points that do not lie on a grid, and random numbers."""

from __future__ import annotations

from concurrent.futures import CancelledError, Executor
from typing import Any

import numpy as np

from rocking.model.progress import Bar
from rocking.model.system import RANGES
from rocking.model.validation import Refusal, Text, WrongType, instance, reals, whole
from rocking.survey.engine.progress import count_when_done
from rocking.survey.engine.tile_loop import engine
from rocking.survey.harmonic_spec import Points
from rocking.survey.measurement import Arrays, Measurement

AT_ONCE = 2048
"""Points per batch."""
MAX_SAMPLES = 10_000_000
MAX_SEED = 2**32 - 1


def sampled(
    points: Points, measure: Measurement, executor: Executor | None = None, shown_as: str = ""
) -> Arrays:
    """Return the results of a measurement at points, in their order; with a progress bar if they are ``shown_as`` something."""
    if executor is not None:
        instance("executor", executor, Executor)
    total = len(points.systems)
    with engine(executor) as (pool, stop), Bar(total, shown_as, shown=bool(shown_as)) as bar:
        futures = []
        try:
            for first in range(0, total, AT_ONCE):
                part = Points(*(array[first : first + AT_ONCE] for array in points))
                futures.append(pool.submit(measure.judge, part, measure.options, stop))
                count_when_done(bar, futures[-1], len(part.systems))
            answers = [result for future in futures if (result := future.result()) is not None]
        finally:
            for future in futures:
                future.cancel()
    if len(answers) < len(futures):
        raise CancelledError("the survey was stopped")
    return {name: np.concatenate([each[name] for each in answers]) for name in answers[0]}


def generator(seed: int) -> np.random.Generator:
    """Return a random number generator; equal seeds give equal numbers."""
    return np.random.default_rng(whole("seed", seed, 0, MAX_SEED))


def span(name: str, values: Any, widest: tuple[float, float] | None = None) -> tuple[float, float]:
    """Check a range (low, high) of random numbers: low < high, both within the range of the quantity."""
    low, high = widest or RANGES[name]
    allowed = f"be a pair (low, high) in [{low:.6g}, {high:.6g}] with low < high"
    try:
        pair = np.asarray(reals(name, values))
    except TypeError:
        raise WrongType(name, allowed, values) from None
    if pair.shape != (2,):
        raise Refusal(name, allowed, Text(_kind_of(pair)))
    if not low <= pair[0] < pair[1] <= high:
        raise Refusal(name, allowed, tuple(pair.tolist()))
    return float(pair[0]), float(pair[1])


def _kind_of(array: np.ndarray) -> str:
    return f"the number {array.item():.6g}" if array.ndim == 0 else f"an array of shape {array.shape}"
