"""A scan over amplitudes and phases, at each of which a block overturns or not; its first hits refined by bisection."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import TYPE_CHECKING

import numpy as np
from attrs import frozen

from rocking.kernels.classify import verdict_record as kernel
from rocking.survey.measurement import Measurement
from rocking.survey.sampling.random_points import sampled
from rocking.survey.spec import SurveySpec, points

if TYPE_CHECKING:
    import xarray as xr

HALVINGS = 40
SETTLED = 1e-12
"""Relative width at which bisection ends."""


@frozen(eq=False)
class Scan:
    """What was found at each amplitude and phase (the last two dimensions) of each cell (those before, `over`)."""

    asked: SurveySpec
    measure: Measurement
    over: tuple[str, ...]
    kinds: xr.DataArray

    @property
    def amplitudes(self) -> np.ndarray:
        """A, ascending."""
        return self.kinds.amplitude.values

    @property
    def phases(self) -> np.ndarray:
        """φ."""
        return self.kinds.phase.values

    @property
    def cells(self) -> np.ndarray:
        """Whether the block overturned: (cells, phases, amplitudes)."""
        fell: np.ndarray = np.asarray(self.kinds.values == kernel.OVERTURNS)
        return fell.reshape(-1, *fell.shape[-2:])

    @property
    def first(self) -> np.ndarray:
        """The place of the first amplitude of each cell that overturns it at any phase; one past the last if none does."""
        hit: np.ndarray = np.any(self.cells, axis=1)
        return np.where(hit.any(axis=1), hit.argmax(axis=1), self.amplitudes.size)


def refined(scan: Scan, executor: Executor | None) -> tuple[np.ndarray, np.ndarray]:
    """(lowest amplitude, its phase) of each cell: the first hit, at each phase that has one, bisected back to a survivor."""
    amplitudes, turned, cells, first = scan.amplitudes, scan.phases, scan.cells, scan.first
    there = np.take_along_axis(cells, first[:, None, None].clip(max=amplitudes.size - 1), axis=2)[..., 0]
    rows, columns = np.nonzero(there & (first < amplitudes.size)[:, None])
    high = amplitudes[first[rows]]
    low = np.where(first[rows] > 0, amplitudes[first[rows] - 1], high)
    places = np.unravel_index(rows, scan.kinds.shape[:-2]) if scan.over else ()
    values = {name: scan.kinds[name].values[k] for name, k in zip(scan.over, places, strict=True)}
    values["phase"] = turned[columns]
    for _ in range(HALVINGS):
        wide = np.flatnonzero(high - low > SETTLED * high)
        if wide.size == 0:
            break
        middle = 0.5 * (low[wide] + high[wide])
        tried = points(
            {name: v[wide] for name, v in values.items()} | {"amplitude": middle}, scan.asked.fixed
        )
        fell = sampled(tried, scan.measure, executor)["kind"] == kernel.OVERTURNS
        high[wide[fell]], low[wide[~fell]] = middle[fell], middle[~fell]
    lowest, phase = np.full(first.size, np.nan), np.full(first.size, np.nan)
    # the last written is the lowest
    order = np.argsort(-high, kind="stable")
    lowest[rows[order]], phase[rows[order]] = high[order], turned[columns[order]]
    return lowest, phase
