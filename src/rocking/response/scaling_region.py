"""Scaling region of a pair count: range of radii, exponent and its interval."""

from __future__ import annotations

import math

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

Array = NDArray[np.float64]

DECADE = math.log(10.0)
MIN_LENGTH = 0.5 * DECADE
# Limits of the width of the interval. The first that some region of a decade meets is used.
WIDTHS = (0.08, 0.12, 0.2, 0.4)
# Overlapping halves of a region whose slopes are compared.
HALVES = 5
# Each pair is counted from both ends, in two blocks, so the blocks underestimate the variance by a factor of 2.
TWICE = math.sqrt(2.0)


@frozen
class Scaling:
    """Scaling region, with its slope and interval, and the data at every radius.

    Attributes
    ----------
    region : tuple of int
        Indices of the first and last radius.
    found : bool
        True if the region spans a decade within the widest interval allowed.
    slope : float
        Slope of ln C against ln r.
    interval : tuple of float
        Interval of the slope.
    sums, slopes, slope_errors : ndarray
        Correlation sums, local slopes and their standard errors.
    """

    region: tuple[int, int]
    found: bool
    slope: float
    interval: tuple[float, float]
    sums: Array
    slopes: Array
    slope_errors: Array


def scaling_region(radii: Array, counts: Array, pairs: Array) -> Scaling | None:
    """Find the longest range of radii over which ln C has one slope; None for less than half a decade of radii.

    Parameters
    ----------
    radii : ndarray, shape (n,)
        Radii in geometric progression.
    counts, pairs : ndarray, shape (blocks, n)
        Number of pairs within each radius, and number of all pairs, for reference points in blocks.
    """
    if len(radii) < 3 or math.log(radii[-1] / radii[0]) < MIN_LENGTH:
        return None
    x = np.log(radii)
    y = np.log(counts.sum(axis=0) / pairs.sum(axis=0))
    # jackknife: each row omits one block
    fits = _Fits(x, np.vstack([y, np.log((counts.sum(axis=0) - counts) / (pairs.sum(axis=0) - pairs))]))
    first, last, found = _longest(fits)
    low, high = fits.interval(first, last)
    local = [fits.slope(k, k + 1) for k in range(len(x) - 1)]
    return Scaling(
        region=(first, last),
        found=found,
        slope=fits.slope(first, last)[0],
        interval=(max(low, 0.0), high),
        sums=np.exp(y),
        slopes=np.array([pair[0] for pair in local]),
        slope_errors=np.array([pair[1] for pair in local]),
    )


class _Fits:
    """Straight-line fits to any range of the points, in constant time each."""

    def __init__(self, x: Array, rows: Array) -> None:
        self.x = x - x.mean()
        self.sums = [
            np.concatenate([np.zeros((len(rows), 1)), np.cumsum(terms, axis=1)], axis=1)
            for terms in (rows, rows * self.x)
        ]
        self.moments = [np.concatenate([[0.0], np.cumsum(self.x**power)]) for power in (1, 2)]

    def slope(self, first: int, last: int) -> tuple[float, float]:
        """Return the slope over a range, ends included, and its jackknife standard error."""
        count = last - first + 1
        sy, sxy = (terms[:, last + 1] - terms[:, first] for terms in self.sums)
        sx, sxx = (moment[last + 1] - moment[first] for moment in self.moments)
        slopes = (count * sxy - sx * sy) / (count * sxx - sx * sx)
        blocks = len(slopes) - 1
        spread = math.sqrt((blocks - 1) / blocks * ((slopes[1:] - slopes[1:].mean()) ** 2).sum())
        return float(slopes[0]), TWICE * spread

    def interval(self, first: int, last: int) -> tuple[float, float]:
        """Return the interval of the slope of a range.

        It spans the slopes of the whole range and of its halves. On both sides, the margin is the spread of these slopes
        plus two standard errors.
        """
        slope, error = self.slope(first, last)
        half = (last - first) // 2
        starts = first + np.round(np.linspace(0, last - first - half, HALVES)).astype(int)
        slopes = [slope, *(self.slope(start, start + half)[0] for start in starts.tolist())]
        margin = max(slopes) - min(slopes) + 2.0 * error
        return min(slopes) - margin, max(slopes) + margin


def _longest(fits: _Fits) -> tuple[int, int, bool]:
    """Return the longest region of a decade or more within the first possible width.

    Returns
    -------
    tuple of (int, int, bool)
        Indices of the first and last radius; True. If there is none, the region with the narrowest interval; False.
    """
    x = fits.x
    regions = []
    for first in range(len(x)):
        for last in range(int(np.searchsorted(x, x[first] + MIN_LENGTH - 1e-9)), len(x)):
            low, high = fits.interval(first, last)
            regions.append((first, last, float(x[last] - x[first]), high - low))
    for widest in WIDTHS:
        fair = [region for region in regions if region[3] <= widest and region[2] >= DECADE - 1e-9]
        if fair:
            best = max(fair, key=lambda region: (round(region[2], 6), -region[3]))
            return best[0], best[1], True
    best = min(regions, key=lambda region: region[3])
    return best[0], best[1], False
