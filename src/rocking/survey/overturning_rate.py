"""Annual rate of overturning: a fragility under the seismic hazard of a site."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rocking.model.hazard import HazardCurve, OverturningRate
from rocking.model.package import VERSION
from rocking.model.record_results import Fragility
from rocking.model.result import along
from rocking.model.text import formatted
from rocking.model.validation import RecordError, Refusal, instance, members, reals, refuse_if, whole
from rocking.records.text_file import Content, TextFile
from rocking.records.units import UNITS, cells, is_other, unit_of
from rocking.survey.fragility import MAX_REPLICATES, by_record, exceeds
from rocking.survey.fragility_curve import (
    ALL_ABOVE,
    ALL_BELOW,
    DETERMINED,
    SEPARATED,
    Fits,
    accelerated_interval,
    lognormal_fits,
    two_level_weights,
    weighted_counts,
)
from rocking.survey.random_points import MAX_SEED

TITLE = "Annual rate of overturning"
ALLOWED = "be a pair of arrays (levels, annual rates), a mapping of levels to annual rates, or the path of a CSV file"
PER_YEAR = "year-1"
NUMBERS = re.compile(r"\s*[-+.\d]")
NAMES = ("levels", "rates")
SHARP = 1e-6
"""Dispersion that stands for 0, of replicates in which one level separates the runs that exceed from the others."""


def overturning_rate(
    fragility: Fragility,
    hazard: Any,
    *,
    limit: float = math.inf,
    replicates: int = 1000,
    seed: int = 0,
) -> OverturningRate:
    """Estimate the annual rate at which a block overturns at a site, or exceeds a limit of |Θ|, with a 95 % interval.

    The rate is λ = ∫ P(x) |dH(x)|, of the probability P by the lognormal fit and the annual rate H(x) at which the motion at the
    site exceeds the level x. It is exact for H with ln H linear in ln x between the rows of a table.

    Parameters
    ----------
    fragility : Fragility
        Result of `fragility`, with a fit of the limit.
    hazard : pair of arrays, mapping, path, or HazardCurve
        Levels of the intensity measure of the fragility, in its unit, positive, and the annual rates at which they are exceeded,
        positive, the lower for the higher level: ``(levels, rates)``, ``{level: rate}``, or a CSV file with these two columns. The
        rows may have any order; they are sorted by the level. A title of its first column may state the unit of acceleration, such
        as ``PGA (g)``; levels are then converted.
    limit : float
        One of the limits of the fragility. Default: infinite, overturning.
    replicates : int
        Number of bootstrap replicates, in [100, 10⁵]. Default: 1,000.
    seed : int
        Random seed of the bootstrap, in [0, 2³² − 1]. Default: 0.

    Returns
    -------
    OverturningRate
        ``rate``, ``rate_low``, ``rate_high`` and ``probability(years=50)``; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong type or lies outside its range.
    TooShort
        If the runs do not determine the fit of the limit.
    RecordError
        If a file is no table of a hazard, or if its unit is another one than that of the fragility.

    See Also
    --------
    fragility : Probability of overturning over the intensity.

    Notes
    -----
    **Fit.** P = r Φ(ln(x/θ)/β), with the fraction r of the runs that rock. At a level x it is that of the level of the fragility
    that is nearest in ln x. By parts λ = ∫ H dP. On a piece H = c x⁻ᵏ and with r = 1 the integral is
    c θ⁻ᵏ e^{k²β²/2} [Φ(ln(x/θ)/β + kβ)] between the ends of the piece. One piece without ends gives
    λ = H(θ) e^{k²β²/2}.

    **Beyond the table** H continues with the slope of the first and of the last piece. `share_below` and `share_above` are the
    shares of λ from there. `share_untested` is the share from levels at which the fragility has no runs: there the lognormal form
    is an assumption.

    **Fractions.** `fraction_rate` needs no fit. P is the fraction of the runs that exceed, linear in ln x between the levels of the
    fragility. It is 0 below them, and above them it is that of the highest level. So levels with a fraction of 0 should be among
    them, and a fraction near 1. Its interval has no width if no run exceeds.

    **Interval.** Replicates draw records with replacement, and within each drawn record its runs. The interval of λ is the
    bias-corrected and accelerated one (Efron 1987), with tails wider for few records (Hesterberg 2015). A replicate without a
    fit counts with the bounds that its runs give. The interval covers the scatter of the records, and not the uncertainty of the
    hazard: compute the rates of its fractiles, too.

    References
    ----------
    The closed form: Cornell, Jalayer, Hamburger & Foutch, J. Struct. Eng. 128, 526–533 (2002). Efron, J. Am.
    Stat. Assoc. 82, 171–185 (1987). Hesterberg, Am. Stat. 69, 371–386 (2015).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(12, seed=1)
    >>> curves = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9), limits=())
    >>> x = np.geomspace(0.5, 50, 20)
    >>> result = overturning_rate(curves, (x, 0.02 * x**-2.5))
    >>> result.rate_low < result.rate < result.rate_high, result.probability(years=50).value < 1
    (True, True)
    """
    import xarray as xr

    instance("fragility", fragility, Fragility)
    replicates = whole("replicates", replicates, 100, MAX_REPLICATES)
    seed = whole("seed", seed, 0, MAX_SEED)
    fit = fragility.fit(limit)
    data = fragility.dataset
    levels, unit = data.level.values, data.level.attrs.get("units", "1")
    curve = hazard_curve(hazard, unit)
    peak = by_record(data[["peak"]]).peak.values
    # the order of the records is of no importance
    peak = peak[np.lexsort(peak.reshape(len(peak), -1).T)]
    exceeding, rocking = exceeds(peak, fit.limit), peak > 0.0
    weights = two_level_weights(len(peak), peak.shape[1], replicates, np.random.default_rng(seed))
    rocks = rocking.mean(axis=(0, 1))
    edges, parts = rate_parts(curve, levels, rocks, fit.median, fit.dispersion)
    rate = float(parts.sum())
    endless = "begin at levels that hardly overturn the block"
    refuse_if(
        math.isinf(rate),
        "hazard",
        endless,
        float(curve.levels[0]),
        "its line below them gives no finite rate",
    )
    probability = rocks[nearest(levels, np.log(curve.levels))] * fit.probability(curve.levels)
    of_fractions = fraction_weights(curve, levels)
    each = exceeding.mean(axis=1) @ of_fractions
    drawn = weighted_counts(exceeding, weights) @ of_fractions / weights[0].size
    others = (each.sum() - each) / max(len(each) - 1, 1)
    fraction_ends = accelerated_interval(float(each.mean()), (drawn, drawn), others, len(each))
    middles = 0.5 * (edges[:-1] + edges[1:])  # infinite at both ends
    table, tested = (np.log(each[[0, -1]]) for each in (curve.levels, levels))
    shares = [
        parts[where].sum() / rate
        for where in (
            middles < table[0],
            middles > table[1],
            (middles < tested[0]) | (middles > tested[1]),
        )
    ]
    ends = rate_interval(curve, levels, exceeding, rocking, weights, rate)
    rates = {
        "rate": (rate, "annual rate by the lognormal fit"),
        "rate_low": (ends[0], "lower end of its 95 % interval"),
        "rate_high": (ends[1], "upper end of its 95 % interval"),
        "fraction_rate": (each.mean(), "annual rate by the fractions"),
        "fraction_rate_low": (fraction_ends[0], "lower end of its 95 % interval"),
        "fraction_rate_high": (fraction_ends[1], "upper end of its 95 % interval"),
    }
    texts = {
        "share_below": "share of the rate from below the table of the hazard",
        "share_above": "share of the rate from above the table of the hazard",
        "share_untested": "share of the rate from outside the levels of the fragility",
    }
    bounds = np.concatenate(([0.0], curve.levels, [np.inf]))
    place = np.searchsorted(np.log(curve.levels), middles)
    return OverturningRate(
        xr.Dataset(
            along((), {name: (*each, PER_YEAR) for name, each in rates.items()})
            | along(
                (), {name: (share, text) for (name, text), share in zip(texts.items(), shares, strict=True)}
            )
            | along(
                "level",
                {
                    "hazard": (curve.rates, "annual rate of exceedance", PER_YEAR),
                    "probability": (probability, "probability by the lognormal fit"),
                },
            )
            | along(
                "part",
                {
                    "part_low": (bounds[:-1], "lowest level of the part", unit),
                    "part_high": (bounds[1:], "highest level of the part", unit),
                    "part_rate": (
                        np.bincount(place, parts, bounds.size - 1),
                        "annual rate from the levels of the part",
                        PER_YEAR,
                    ),
                },
            ),
            {"level": ("level", curve.levels, data.level.attrs)},
            {
                "title": TITLE,
                "source": f"rocking {VERSION}",
                "intensity": data.attrs["intensity"],
                "limit": fit.limit,
                "median": fit.median,
                "dispersion": fit.dispersion,
                "replicates": replicates,
                "seed": seed,
            },
        ),
        fragility.block,
    )


def rate_parts(
    curve: HazardCurve, levels: np.ndarray, rocking: Any, median: Any, dispersion: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Return ln x between which the rate is a closed form, (m,), and its parts ∫ P |dH| there, (…, m − 1).

    Parameters
    ----------
    curve : HazardCurve
        Hazard.
    levels : array (k,)
        Levels of the fragility.
    rocking : array (…, k)
        Fraction of the runs that rock at each.
    median, dispersion : float or array (…)
        Parameters of the fit.
    """
    from scipy.special import ndtr

    ends = np.log(levels[[0, -1]])
    inner = np.unique(np.concatenate((np.log(curve.levels), between(levels), ends)))
    edges = np.concatenate(([-np.inf], inner, [np.inf]))
    median, dispersion = np.asarray(median, float), np.asarray(dispersion, float)
    product = ndtr((inner - np.log(median)[..., None]) / dispersion[..., None]) * curve.rate(np.exp(inner))
    nothing = np.zeros((*median.shape, 1))
    boundary = -np.diff(np.concatenate((nothing, product, nothing), axis=-1), axis=-1)
    rocks = np.asarray(rocking)[..., nearest(levels, 0.5 * (edges[:-1] + edges[1:]))]
    integrals = curve.lognormal_integrals(median, dispersion, edges)
    return edges, rocks * np.maximum(boundary + integrals, 0.0)


def between(levels: np.ndarray) -> np.ndarray:
    """Return ln x half way between levels."""
    places = np.log(levels)
    return np.asarray(0.5 * (places[:-1] + places[1:]))


def nearest(levels: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the number of the level that is nearest to each ln x."""
    return np.searchsorted(between(levels), places)


def fraction_weights(curve: HazardCurve, levels: np.ndarray) -> np.ndarray:
    """Return weights (k,) by which fractions at levels give the rate Σ wᵢpᵢ, with fractions linear in ln x between levels."""
    steps = np.zeros((levels.size, levels.size))  # rate = steps · (p₁, p₂ − p₁, …)
    jumps = np.concatenate((curve.rate(levels[:1]), curve.mean_rates(levels)))
    np.fill_diagonal(steps, 1.0)
    steps -= np.eye(levels.size, k=-1)
    return np.asarray(jumps @ steps)


def rate_interval(
    curve: HazardCurve,
    levels: np.ndarray,
    exceeding: np.ndarray,
    rocking: np.ndarray,
    weights: np.ndarray,
    rate: float,
) -> tuple[float, float]:
    """Return the ends of the 95 % interval of a rate, by the fits of all replicates and of the runs without each record."""

    def bounds(of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rocks = weighted_counts(rocking, of)
        fits = lognormal_fits(levels, weighted_counts(exceeding, of), rocks)
        return replicate_bounds(curve, levels, fits, rocks / of.sum(axis=(1, 2))[:, None])

    count = len(exceeding)
    one_less = np.broadcast_to(1 - np.eye(count, dtype=int)[..., None], (count, *exceeding.shape[:2]))
    low, high = bounds(one_less)
    with np.errstate(divide="ignore"):
        without = np.log(np.where(low == high, low, np.nan))
    return accelerated_interval(rate, bounds(weights), without, count)


def replicate_bounds(
    curve: HazardCurve, levels: np.ndarray, many: Fits, rocking: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds of the rates of replicates, equal where a replicate has a fit."""
    low, high = np.zeros(len(rocking)), np.full(len(rocking), np.inf)

    def rates(of: np.ndarray, median: np.ndarray, dispersion: np.ndarray) -> np.ndarray:
        return rate_parts(curve, levels, rocking[of], median, dispersion)[1].sum(axis=-1)

    fitted = many.kind == DETERMINED
    low[fitted] = high[fitted] = rates(fitted, many.median[fitted], many.dispersion[fitted])
    # one level separates both kinds of runs: the rate falls as it grows
    for end, kinds, medians in (
        (high, (SEPARATED, ALL_BELOW), many.median_bounds[0]),
        (low, (SEPARATED, ALL_ABOVE), many.median_bounds[1]),
    ):
        for kind in kinds:
            of = many.kind == kind
            end[of] = rates(of, medians[of], np.full(of.sum(), SHARP))
    return low, high


def hazard_curve(hazard: Any, unit: str) -> HazardCurve:
    """Return the hazard that a pair of arrays, a mapping or a CSV file states, with levels in a unit; a curve as it is."""
    if isinstance(hazard, HazardCurve):
        return hazard
    if isinstance(hazard, str | os.PathLike):
        return read_hazard(Path(hazard), unit)
    if isinstance(hazard, Mapping):
        return HazardCurve(*zip(*sorted(hazard.items()), strict=True)) if hazard else HazardCurve([], [])
    columns = members("hazard", hazard, ALLOWED)
    if len(columns) != 2:
        raise Refusal("hazard", ALLOWED, hazard)
    levels, rates = (
        np.atleast_1d(reals(f"hazard {name}", each)) for name, each in zip(NAMES, columns, strict=True)
    )
    if levels.ndim == 1 and levels.shape == rates.shape:
        order = np.argsort(levels, kind="stable")
        levels, rates = levels[order], rates[order]
    return HazardCurve(levels, rates)


def read_hazard(path: Path, unit: str) -> HazardCurve:
    """Read a table of levels, in a unit, and annual rates; `RecordError` that names the file and the line."""
    file = TextFile(Content(path))
    rows: list[tuple[float, float]] = []
    factor = 1.0
    for index, line in enumerate(file.lines):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        texts = [each.strip().replace(",", ".") for each in line.split(";")] if ";" in line else cells(line)
        if not rows and not NUMBERS.match(line):
            factor = _factor(file, index, texts[0], unit) or factor
            continue
        if len(texts) != 2:
            raise file.error(index, f"a level and an annual rate expected; got {formatted(line.strip())}")
        rows.append((file.number(index, texts[0], "a level"), file.number(index, texts[1], "a rate")))
    if not rows:
        raise RecordError(f"{file.name}: no row with a level and an annual rate")
    levels, rates = np.array(sorted(rows)).T
    try:
        return HazardCurve(factor * levels, rates)
    except ValueError as error:
        raise RecordError(f"{file.name}: {error}") from error


def _factor(file: TextFile, line: int, title: str, unit: str) -> float | None:
    """Return the factor by which levels under a title are in a unit, None if it states no unit; an error for another unit."""
    words = [word for word in re.split(r"[\s_()\[\]]+", title) if word]
    stated = [word for word in words[len(words) > 1 :] if unit_of(word) or is_other(word)]
    if not stated or stated[-1] == unit:
        return 1.0 if stated else None
    size = UNITS.get(unit_of(stated[-1]) or "")
    if size is None or unit not in UNITS:
        raise file.error(line, f"the levels are in {stated[-1]}; those of the fragility are in {unit}")
    return size / UNITS[unit]
