"""Fragility of a block: fractions over the intensity of the ground motion, and their lognormal fits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.formatting import counted
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.validation import TooShort, real, reals, refusal, refuse_if

if TYPE_CHECKING:
    import xarray as xr


@frozen
class LognormalFit:
    """Lognormal fit of one fragility curve, with 95 % bootstrap intervals.

    Attributes
    ----------
    limit : float
        Limit of |Θ|; infinite for overturning.
    median, median_low, median_high : float
        Level that half of the rocking runs exceed, and the ends of its interval; in the unit of the intensity measure.
    dispersion, dispersion_low, dispersion_high : float
        Standard deviation of the logarithm of the level, and the ends of its interval. An end is 0 or infinite if the data
        do not bound it.
    misfit : float
        Largest distance between a fraction and the fit; NaN with fewer than three levels.
    problem : str
        Reason if the data do not determine the fit; all numbers are then NaN. Default: "".

    Examples
    --------
    >>> import rocking as rk
    >>> fit = rk.LognormalFit(1.0, 5.0, 4.4, 5.8, 0.3, 0.2, 0.4, 0.03)
    >>> print(fit)
    median 5 (4.4–5.8), dispersion 0.3 (0.2–0.4), largest misfit 3.0 %
    """

    limit: float
    median: float
    median_low: float
    median_high: float
    dispersion: float
    dispersion_low: float
    dispersion_high: float
    misfit: float
    problem: str = ""

    def described(self, unit: str = "") -> str:
        """Return the fit in one line, the median with a unit."""
        if self.problem:
            return f"no fit: {self.problem}"
        median = _with_ends(self.median, self.median_low, self.median_high, unit)
        dispersion = _with_ends(self.dispersion, self.dispersion_low, self.dispersion_high)
        misfit = "" if math.isnan(self.misfit) else f", largest misfit {100.0 * self.misfit:.1f} %"
        return f"median {median}, dispersion {dispersion}{misfit}"

    def probability(self, levels: Any) -> Any:
        """Return the probability at levels for runs that rock: Φ(ln(level/median)/dispersion).

        Parameters
        ----------
        levels : float or array
            Levels of the intensity measure, not negative.

        Returns
        -------
        float or ndarray
            Probability, in the shape of `levels`.

        Raises
        ------
        TypeError, ValueError
            If a level is not a real number, or is negative.
        """
        from scipy.special import ndtr

        given = np.asarray(reals("levels", levels))
        refuse_if((given < 0.0).any(), "levels", "not be negative", levels)
        with np.errstate(divide="ignore"):  # the probability at 0 is 0
            return ndtr(np.log(given / self.median) / self.dispersion)

    def __str__(self) -> str:
        return self.described()


def _with_ends(value: float, low: float, high: float, unit: str = "") -> str:
    upper = "∞" if math.isinf(high) else f"{high:.3g}"
    return f"{value:.3g}{' ' * bool(unit)}{unit} ({low:.3g}–{upper})"


@frozen(eq=False)
class Fragility(NotebookPicture):
    """Probability that a block exceeds limits, over the intensity of the ground motion; returned by `fragility`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `limit` (|Θ|; infinite: overturning) and `scale` (the level of the intensity measure):

        - `fraction` with the ends `fraction_low` and `fraction_high` of its 95 % interval;
        - `effective_records`, the number of independent records behind the interval;
        - `fit` with the ends `fit_low` and `fit_high` of its band, NaN if there is no fit.

        Variable over `scale`: `rocking`, the fraction of the runs that rock. Variables of the runs, over `record`,
        `sample` (of an uncertain block) and `scale`: `peak`, `outcome` and `certified`.
    block : Block
        Nominal block.
    fits : tuple of LognormalFit
        Fit of each limit.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(8, seed=1)
    >>> found = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 17), limits=())
    >>> found.dataset.fraction.dims, found.fit().limit
    (('limit', 'scale'), inf)
    """

    dataset: xr.Dataset = field(repr=False)
    block: Block
    fits: tuple[LognormalFit, ...] = field(repr=False)

    def fit(self, limit: float = math.inf) -> LognormalFit:
        """Return the fit of a limit.

        Parameters
        ----------
        limit : float
            One of the limits of |Θ|. Default: infinite, overturning.

        Raises
        ------
        TypeError
            If `limit` is not a real number.
        ValueError
            If there is no such limit.
        TooShort
            If the data do not determine the fit.
        """
        wanted = real("limit", limit)
        for fit in self.fits:
            if fit.limit == wanted:
                if fit.problem:
                    raise TooShort(f"no fit for {limit_name(fit.limit)}: {fit.problem}", fit)
                return fit
        allowed = f"be one of {', '.join(f'{fit.limit:g}' for fit in self.fits)}"
        raise ValueError(refusal("limit", allowed, limit))

    def __str__(self) -> str:
        data = self.dataset
        unit = data.scale.attrs.get("units", "1")
        last = self.fits[-1].described("" if unit == "1" else unit)
        return f"{limit_name(self.fits[-1].limit)} over {data.scale.attrs['symbol']}: {last}; {runs_of(data)}"


def limit_name(limit: float) -> str:
    """Return the event of exceeding a limit of |Θ| in words."""
    return "overturning" if math.isinf(limit) else f"|Θ| > {limit:g}"


def runs_of(data: Any) -> str:
    """Return the numbers of records, samples, levels and runs of a dataset in words."""
    parts = [counted(data.sizes.get("record", 1), "record")]
    if "sample" in data.sizes:
        parts.append(f"{counted(data.sizes['sample'], 'block')} per record")
    parts.append(counted(data.sizes["scale"], "level"))
    undecided = int((data.certified == 0).sum())
    doubt = f", {undecided:,} undecided" if undecided else ""
    return f"{', '.join(parts)}, {counted(data.peak.size, 'run')}{doubt}"
