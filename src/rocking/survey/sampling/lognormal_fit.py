"""Lognormal fit of fractions over levels by maximum likelihood, for many sets of counts at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

MAX_STEPS, HALVINGS = 60, 30
CLOSE = 1e-10
"""Last change of both parameters at which an iteration ends."""
ALL_BELOW, ALL_ABOVE, SEPARATED, DECREASING, DETERMINED = range(5)
"""No run exceeds; all runs exceed; those that exceed lie above all others; the fraction falls; a finite maximum exists."""


class Fits(NamedTuple):
    """Fits of n sets of counts, and what the counts say about both parameters; each an array (n,).

    Median and dispersion are NaN unless `kind` is DETERMINED. Bounds are equal to the estimates of a fit that is determined.
    """

    kind: np.ndarray
    median: np.ndarray
    dispersion: np.ndarray
    median_bounds: tuple[np.ndarray, np.ndarray]
    dispersion_bounds: tuple[np.ndarray, np.ndarray]


def lognormal_fits(levels: np.ndarray, exceeding: np.ndarray, rocking: np.ndarray) -> Fits:
    """Fit Φ(ln(level/median)/dispersion) to the numbers of runs that exceed among those that rock.

    Parameters
    ----------
    levels : array (k,)
        Levels, positive and ascending.
    exceeding, rocking : array (n, k)
        Numbers of runs, ``0 <= exceeding <= rocking``.

    Notes
    -----
    The log-likelihood is concave in a and b of Φ(a + b ln level). It has a finite maximum exactly if the levels of runs that
    exceed and of runs that do not overlap: Silvapulle, J. R. Stat. Soc. B 43, 310–313 (1981).
    """
    remaining = rocking - exceeding
    above, below = exceeding > 0, remaining > 0
    last = levels.size - 1
    lowest_above, highest_above = above.argmax(axis=1), last - above[:, ::-1].argmax(axis=1)
    lowest_below, highest_below = below.argmax(axis=1), last - below[:, ::-1].argmax(axis=1)
    kind = np.full(len(exceeding), DETERMINED)
    kind[lowest_below >= highest_above] = DECREASING
    kind[lowest_above >= highest_below] = SEPARATED
    kind[~below.any(axis=1)] = ALL_ABOVE
    kind[~above.any(axis=1)] = ALL_BELOW
    median, dispersion = (np.full(len(exceeding), np.nan) for _ in range(2))
    fitted = kind == DETERMINED
    if fitted.any():
        logarithms = np.log(levels)
        centre, width = logarithms.mean(), logarithms.std()
        a, b = _maximum((logarithms - centre) / width, exceeding[fitted], remaining[fitted])
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            median[fitted], dispersion[fitted] = np.exp(centre - width * a / b), width / b
        # a fraction that hardly grows has its median far outside all numbers
        possible = (b > 0.0) & (median[fitted] > 0.0) & np.isfinite(median[fitted])
        kind[np.flatnonzero(fitted)[~possible]] = DECREASING
    median[kind != DETERMINED] = dispersion[kind != DETERMINED] = np.nan
    # between the levels of the runs on both sides; a separated set has its maximum at a dispersion of 0
    least = np.select([kind == SEPARATED, kind == ALL_BELOW], [levels[highest_below]] * 2, 0.0)
    most = np.select([kind == SEPARATED, kind == ALL_ABOVE], [levels[lowest_above]] * 2, np.inf)
    widest = np.where(kind == SEPARATED, 0.0, np.inf)
    found = kind == DETERMINED
    return Fits(
        kind,
        median,
        dispersion,
        (np.where(found, median, least), np.where(found, median, most)),
        (np.where(found, dispersion, 0.0), np.where(found, dispersion, widest)),
    )


def _maximum(
    places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a and b of the maxima by Newton's method, with steps halved until the likelihood does not fall."""
    found = np.zeros((2, len(exceeding)))
    value = _likelihood(found, places, exceeding, remaining)
    for _ in range(MAX_STEPS):
        step = _newton(found, places, exceeding, remaining)
        length = np.ones(step.shape[1])
        for _ in range(HALVINGS):
            tried = _likelihood(found + length * step, places, exceeding, remaining)
            worse = tried < value - 1e-12 * np.abs(value)
            if not worse.any():
                break
            length[worse] *= 0.5
        found += length * step
        value = tried
        if np.abs(length * step).max() < CLOSE:
            break
    return found[0], found[1]


def _likelihood(
    found: np.ndarray, places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> np.ndarray:
    from scipy.special import log_ndtr

    score = found[0][:, None] + found[1][:, None] * places
    return np.asarray((exceeding * log_ndtr(score) + remaining * log_ndtr(-score)).sum(axis=1))


def _newton(
    found: np.ndarray, places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> np.ndarray:
    """Return the steps of Newton's method (2, n)."""
    from scipy.special import log_ndtr

    score = found[0][:, None] + found[1][:, None] * places
    density = -0.5 * score * score - 0.5 * np.log(2.0 * np.pi)
    up, down = np.exp(density - log_ndtr(score)), np.exp(density - log_ndtr(-score))
    slope = exceeding * up - remaining * down
    bend = exceeding * up * (up + score) + remaining * down * (down - score)
    first = np.array([slope.sum(axis=1), (slope * places).sum(axis=1)])
    whole, mixed, square = (
        bend.sum(axis=1),
        (bend * places).sum(axis=1),
        (bend * places * places).sum(axis=1),
    )
    determinant = whole * square - mixed * mixed
    return np.array([square * first[0] - mixed * first[1], whole * first[1] - mixed * first[0]]) / determinant
