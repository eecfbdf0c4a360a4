"""Scan of overturning over amplitudes and phases; bisection refines the lowest overturning amplitude."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import TYPE_CHECKING

import numpy as np
from attrs import frozen

from rocking.kernels.classify import verdict_record as kernel
from rocking.survey.harmonic_spec import HarmonicSpec, points
from rocking.survey.measurement import Measurement
from rocking.survey.sampling.random_points import sampled

if TYPE_CHECKING:
    import xarray as xr

HALVINGS = 40
SETTLED = 1e-12
"""Relative width at which bisection ends."""


@frozen(eq=False)
class Scan:
    """Kinds of response over phase and amplitude (the last two dimensions) in each cell of the dimensions `over`."""

    asked: HarmonicSpec
    measure: Measurement
    over: tuple[str, ...]
    kinds: xr.DataArray

    @property
    def amplitudes(self) -> np.ndarray:
        """Amplitudes A, ascending."""
        return self.kinds.amplitude.values

    @property
    def phases(self) -> np.ndarray:
        """Initial phases φ of the forcing."""
        return self.kinds.phase.values

    @property
    def cells(self) -> np.ndarray:
        """Mask of the runs that overturned, of shape (cells, phases, amplitudes)."""
        fell: np.ndarray = np.asarray(self.kinds.values == kernel.OVERTURNS)
        return fell.reshape(-1, *fell.shape[-2:])

    @property
    def first(self) -> np.ndarray:
        """Index of the lowest amplitude that overturns at any phase of each cell; the number of amplitudes if none."""
        hit: np.ndarray = np.any(self.cells, axis=1)
        return np.where(hit.any(axis=1), hit.argmax(axis=1), self.amplitudes.size)


def refined(scan: Scan, executor: Executor | None) -> tuple[np.ndarray, np.ndarray]:
    """Refine the lowest overturning amplitude of each cell by bisection, at each phase that overturns there.

    Returns
    -------
    tuple of (array (cells,), array (cells,))
        Lowest overturning amplitude and its phase; NaN if no run overturned.
    """
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
    # in descending order, so that the lowest amplitude is written last
    order = np.argsort(-high, kind="stable")
    lowest[rows[order]], phase[rows[order]] = high[order], turned[columns[order]]
    return lowest, phase
