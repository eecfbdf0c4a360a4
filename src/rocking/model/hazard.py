"""Seismic hazard as a table, its integrals with a lognormal fragility, and the annual rate that follows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from attrs import field, frozen

from rocking.model.arrays import read_only
from rocking.model.block import Block
from rocking.model.record_results import limit_name
from rocking.model.result import Result, along
from rocking.model.text import percent, percent_with_ends
from rocking.model.validation import Refusal, reals, refuse_if, within

if TYPE_CHECKING:
    import xarray as xr

MAX_YEARS = 1e6
NOTABLE = 0.05
"""Share of a rate from beyond a table, or beyond the levels of a fragility, from which `print` states it."""


def _levels(values: Any) -> np.ndarray:
    levels = np.atleast_1d(reals("hazard levels", values))
    allowed = "be two positive numbers or more, ascending"
    if levels.ndim != 1 or levels.size < 2 or not (levels > 0.0).all() or not (np.diff(levels) > 0.0).all():
        raise Refusal("hazard levels", allowed, values)
    return read_only(levels.astype(float))


def _rates(values: Any) -> np.ndarray:
    return read_only(np.atleast_1d(reals("hazard rates", values)).astype(float))


@frozen(eq=False)
class HazardCurve:
    """Annual rate H(x) at which the ground motion at a site exceeds a level x: a power law between the rows of a table.

    ln H is linear in ln x between two rows. Beyond the ends of the table the first and the last of these lines continue.

    Parameters
    ----------
    levels : array (n,)
        Levels of an intensity measure, positive and ascending; two at least.
    rates : array (n,)
        Annual rates at which they are exceeded, positive and descending.

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type, or lies outside its range.

    Examples
    --------
    >>> curve = HazardCurve([0.1, 0.2, 0.4], [1e-2, 2.5e-3, 4e-4])
    >>> curve.slopes.round(3).tolist(), round(float(curve.rate(0.05)), 3)
    ([2.0, 2.644], 0.04)
    """

    levels: np.ndarray = field(converter=_levels)
    rates: np.ndarray = field(converter=_rates)

    def __attrs_post_init__(self) -> None:
        shapes = self.rates.shape == self.levels.shape
        if not shapes or not (self.rates > 0.0).all() or not (np.diff(self.rates) < 0.0).all():
            raise Refusal(
                "hazard rates",
                "be positive and descending, one per level",
                self.rates.tolist(),
                "they are annual rates of exceedance: that of a return period T in years is 1/T",
            )

    @property
    def slopes(self) -> np.ndarray:
        """Slope k = −d ln H/d ln x between two rows, shape (n − 1,)."""
        return np.asarray(-np.diff(np.log(self.rates)) / np.diff(np.log(self.levels)))

    def rate(self, levels: Any) -> Any:
        """Return the annual rates at which levels are exceeded.

        Parameters
        ----------
        levels : float or array
            Levels, positive.

        Returns
        -------
        float or ndarray
            Rates in 1/year, in the shape of `levels`.

        Raises
        ------
        TypeError, ValueError
            If a level is not a real number, or is not positive.
        """
        values = np.asarray(reals("levels", levels))
        refuse_if(not (values > 0.0).all(), "levels", "be positive", levels)
        places = np.log(values)
        anchor, slope = self._line(places)
        with np.errstate(over="ignore"):  # far below the table
            return np.exp(np.log(self.rates)[anchor] - slope * (places - np.log(self.levels)[anchor]))

    def _line(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the row below each ln x, the first one at least, and the slope there."""
        anchor = np.clip(np.searchsorted(np.log(self.levels), places) - 1, 0, self.levels.size - 2)
        return anchor, self.slopes[anchor]

    def mean_rates(self, levels: np.ndarray) -> np.ndarray:
        """Return the means of H over ln x between neighbours of ascending `levels` (m,), shape (m − 1,)."""
        inside = (self.levels > levels[0]) & (self.levels < levels[-1])
        edges = np.union1d(levels, self.levels[inside])
        widths, rates = np.diff(np.log(edges)), self.rate(edges)
        _, slopes = self._line(np.log(edges[:-1]) + 0.5 * widths)
        whole = np.concatenate(([0.0], np.cumsum((rates[:-1] - rates[1:]) / slopes)))
        return np.diff(whole[np.searchsorted(edges, levels)]) / np.diff(np.log(levels))

    def lognormal_integrals(
        self, median: np.ndarray, dispersion: np.ndarray, edges: np.ndarray
    ) -> np.ndarray:
        """Return ∫ H(x) dΦ(ln(x/median)/dispersion) between neighbouring edges, shape (…, m − 1).

        On a piece H = c x⁻ᵏ it is c θ⁻ᵏ e^{k²β²/2} [Φ(z₂) − Φ(z₁)] with z = ln(x/θ)/β + kβ.

        Parameters
        ----------
        median, dispersion : array (…)
            θ and β, positive.
        edges : array (m,)
            ln x, ascending, from −∞ to ∞; those of the rows of the table are among them.
        """
        from scipy.special import log_ndtr

        place, beta = np.log(median)[..., None], dispersion[..., None]
        width = np.diff(edges)
        middle = np.concatenate(([-np.inf], edges[1:-2] + 0.5 * width[1:-1], [np.inf]))
        anchor, slope = self._line(middle)
        height = np.log(self.rates)[anchor] + slope * (np.log(self.levels)[anchor] - place)
        height = height + 0.5 * (slope * beta) ** 2
        low, high = ((each - place) / beta + slope * beta for each in (edges[:-1], edges[1:]))
        # differences of the smaller tail; with ln Φ, factors beyond the range of doubles cancel
        upper = low > 0.0
        first, second = np.where(upper, -high, low), np.where(upper, -low, high)
        with np.errstate(over="ignore"):  # below the table, where the line of a steep piece continues
            return np.asarray(np.exp(height + log_ndtr(second)) - np.exp(height + log_ndtr(first)))


class Probability(NamedTuple):
    """Probability, and the ends of its 95 % interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return percent_with_ends(*self)


@frozen(eq=False)
class OverturningRate(Result):
    """Annual rate at which a block overturns at a site, or exceeds a limit; returned by `overturning_rate`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables without dimensions, rates in 1/year:

        - `rate` with the ends `rate_low` and `rate_high` of its 95 % interval, by the lognormal fit;
        - `fraction_rate`, `fraction_rate_low` and `fraction_rate_high`, by the fractions themselves;
        - `share_below`, `share_above`: shares of `rate` from levels below and above the table of the hazard;
        - `share_untested`: share of `rate` from levels below and above those of the fragility.

        Variables over `level`, that of the table: `hazard`, the annual rate of exceedance, and `probability`, that of the fit.
        Variables over `part`, between two rows of the table or beyond its ends: `part_low` and `part_high`, its levels, and
        `part_rate`, its part of `rate`.
    block : Block
        Nominal block of the fragility.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(12, seed=1)
    >>> curves = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9), limits=())
    >>> result = rk.overturning_rate(curves, {1.0: 0.02, 2.0: 0.005, 4.0: 8e-4, 8.0: 8e-5})
    >>> result.rate_low < result.rate < result.rate_high
    True
    """

    dataset: xr.Dataset = field(repr=False)
    block: Block

    def _data(self) -> xr.Dataset:
        """Return the dataset with the probability in 50 years."""
        text = "probability of one event or more in 50 years"
        texts = (text, f"{text}, lower end of its 95 % interval", f"{text}, upper end of its 95 % interval")
        columns = {
            f"probability_50_years{end}": (value, text)
            for end, value, text in zip(("", "_low", "_high"), self.probability(), texts, strict=True)
        }
        return self.dataset.assign(along((), columns))

    def _get(self, name: str) -> float:
        return float(self.dataset[name])

    @property
    def rate(self) -> float:
        """Annual rate λ, by the lognormal fit."""
        return self._get("rate")

    @property
    def rate_low(self) -> float:
        """Lower end of the 95 % interval of the rate."""
        return self._get("rate_low")

    @property
    def rate_high(self) -> float:
        """Upper end of the 95 % interval of the rate; infinite if the records do not bound it."""
        return self._get("rate_high")

    def probability(self, years: float = 50.0) -> Probability:
        """Return the probability 1 − e^{−λt} of at least one such event in a time t, with its 95 % interval.

        Parameters
        ----------
        years : float
            Time t in years, in (0, 10⁶]. Default: 50.

        Returns
        -------
        Probability
            Named tuple `value`, `low`, `high`. The events are taken as those of a Poisson process, and the block is set up
            again after each.

        Raises
        ------
        TypeError, ValueError
            If `years` is not a number in its range.

        Examples
        --------
        >>> import numpy as np
        >>> import rocking as rk
        >>> records = rk.synthetic_ground_motions(12, seed=1)
        >>> curves = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9), limits=())
        >>> result = rk.overturning_rate(curves, {1.0: 0.02, 2.0: 0.005, 4.0: 8e-4, 8.0: 8e-5})
        >>> once, twice = (result.probability(years).value for years in (50, 100))
        >>> abs(twice - (1 - (1 - once) ** 2)) < 1e-15
        True
        """
        time = within("years", years, 1e-9, MAX_YEARS)
        return Probability(
            *(-math.expm1(-rate * time) for rate in (self.rate, self.rate_low, self.rate_high))
        )

    def __str__(self) -> str:
        data = self.dataset
        interval = f"{self.rate_low:.3g}–{'∞' if math.isinf(self.rate_high) else f'{self.rate_high:.3g}'}"
        parts = [
            f"{limit_name(data.attrs['limit'])}: annual rate {self.rate:.3g} ({interval})",
            f"probability in 50 years {self.probability()}",
        ]
        for name, where in (
            ("share_below", "below the table of the hazard"),
            ("share_above", "above the table of the hazard"),
            ("share_untested", "outside the levels of the fragility"),
        ):
            if self._get(name) > NOTABLE:
                parts.append(f"{percent(self._get(name))} of the rate from {where}")
        return "; ".join(parts)
