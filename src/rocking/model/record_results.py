"""Results of surveys under ground motions: fragility, incremental dynamic analysis, overturning sets, sensitivity."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.changed_motion import MAX_FACTOR
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import Intensity, RecordSet, intensity_of
from rocking.model.result import Result, along
from rocking.model.text import counted, percent, percent_with_ends
from rocking.model.validation import Refusal, Text, TooShort, instance, real, reals, refuse_if, whole, within
from rocking.model.verdict import Outcome

if TYPE_CHECKING:
    import xarray as xr


def named_levels(data: xr.Dataset, argument: str = "dataset") -> xr.Dataset:
    """Return a dataset of levels of ground motions; ValueError for one of version 0.1, in which these are named otherwise."""
    import xarray as xr

    instance(argument, data, xr.Dataset)
    wrong = "scale" in (*data.dims, *data.attrs)
    refuse_if(
        wrong,
        argument,
        "name its levels `level`",
        Text("`scale`, their name in version 0.1"),
        "compute it again",
    )
    return data


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
    >>> fit = LognormalFit(1.0, 5.0, 4.4, 5.8, 0.3, 0.2, 0.4, 0.03)
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

        values = np.asarray(reals("levels", levels))
        refuse_if((values < 0.0).any(), "levels", "not be negative", levels)
        with np.errstate(divide="ignore"):  # the probability at 0 is 0
            return ndtr(np.log(values / self.median) / self.dispersion)

    def __str__(self) -> str:
        return self.described()


FIT = {
    "median": "level that half of the rocking runs exceed",
    "median_low": "lower end of the 95 % interval of the median",
    "median_high": "upper end of the 95 % interval of the median",
    "dispersion": "standard deviation of the logarithm of the level",
    "dispersion_low": "lower end of the 95 % interval of the dispersion",
    "dispersion_high": "upper end of the 95 % interval of the dispersion",
    "misfit": "largest distance between a fraction and the fit",
    "problem": "reason why there is no fit",
}
"""Descriptions of the variables of the fits."""


def _with_ends(value: float, low: float, high: float, unit: str = "") -> str:
    upper = "∞" if math.isinf(high) else f"{high:.3g}"
    return f"{value:.3g}{' ' * bool(unit)}{unit} ({low:.3g}–{upper})"


@frozen(eq=False)
class Fragility(Result):
    """Probability that a block exceeds limits, over the intensity of the ground motion; returned by `fragility`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `limit` (|Θ|; infinite: overturning) and `level` (of the intensity measure):

        - `fraction` with the ends `fraction_low` and `fraction_high` of its 95 % interval;
        - `effective_records`, the number of independent records behind the interval;
        - `fit` with the ends `fit_low` and `fit_high` of its band, NaN if there is no fit.

        Variable over `level`: `rocking`, the fraction of the runs that rock. Variables of the runs, over `record`,
        `sample` (of an uncertain block) and `level`: `peak`, `outcome` and `certified`.
    block : Block
        Nominal block.
    fits : tuple of LognormalFit
        Fit of each limit.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(8, seed=1)
    >>> result = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 17), limits=())
    >>> result.dataset.fraction.dims, result.fit().limit
    (('limit', 'level'), inf)
    """

    PLOT = "fragility"
    LONG = ("record_level", "record_sample_level", "record_polarity_level", "record_polarity_sample_level")

    dataset: xr.Dataset = field(repr=False, converter=named_levels)
    block: Block
    fits: tuple[LognormalFit, ...] = field(repr=False)

    def _data(self) -> xr.Dataset:
        """Return the dataset with the curves first, and the fits over `limit`."""
        curves = [name for name, each in self.dataset.data_vars.items() if "limit" in each.dims]
        columns = {name: ([getattr(fit, name) for fit in self.fits], text) for name, text in FIT.items()}
        data = (
            self.dataset[curves].assign(along("limit", columns)).merge(self.dataset, combine_attrs="override")
        )
        return data.assign_attrs(unit=data.level.attrs["units"], undecided=int((data.certified == 0).sum()))

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
        requested = real("limit", limit)
        for fit in self.fits:
            if fit.limit == requested:
                if fit.problem:
                    raise TooShort(f"no fit for {limit_name(fit.limit)}: {fit.problem}", fit)
                return fit
        allowed = f"be one of {', '.join(f'{fit.limit:g}' for fit in self.fits)}"
        raise Refusal("limit", allowed, limit)

    def __str__(self) -> str:
        data = self.dataset
        unit = data.level.attrs.get("units", "1")
        last = self.fits[-1].described("" if unit == "1" else unit)
        return f"{limit_name(self.fits[-1].limit)} over {data.level.attrs['symbol']}: {last}; {runs_of(data)}"


def limit_name(limit: float) -> str:
    """Return the event of exceeding a limit of |Θ| in words."""
    return "overturning" if math.isinf(limit) else f"|Θ| > {limit:g}"


FEW = 10
"""Number of records below which a report warns."""


def few_records(count: int) -> Iterator[str]:
    """Yield a warning if the records are too few for intervals."""
    if count < FEW:
        yield f"{counted(count, 'record')} can hardly say how much records differ: use {FEW} or more"


def runs_of(data: Any) -> str:
    """Return the numbers of records, samples, levels and runs of a dataset in words."""
    parts = [counted(data.sizes.get("record", 1), "record")]
    if "polarity" in data.sizes:
        parts.append("both polarities")
    if "sample" in data.sizes:
        parts.append(f"{counted(data.sizes['sample'], 'block')} per record")
    parts.append(counted(data.sizes["level"], "level"))
    undecided = int((data.certified == 0).sum())
    doubt = f", {undecided:,} undecided" if undecided else ""
    return f"{', '.join(parts)}, {counted(data.peak.size, 'run')}{doubt}"


FRACTILES = (0.16, 0.5, 0.84)
ROUNDING = 1e-9


@frozen(eq=False)
class IncrementalDynamicAnalysis(Result):
    """Peak of a block over the intensity of each ground motion; returned by `incremental_dynamic_analysis`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `record` and `level` (of the intensity measure): `peak`, the largest |Θ|, infinite where the
        block overturns; `outcome`; `certified`, 0 where rounding may have changed the outcome; `margin` and `impacts`.
    block : Block
        Block.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(5, seed=1)
    >>> result = rk.incremental_dynamic_analysis(records, rk.Block(2.0, 0.5), [1.0, 2.0, 4.0])
    >>> result.fractiles().sizes["fractile"], bool(result.fractiles([0.5]).isel(level=-1).item() == float("inf"))
    (3, True)
    """

    PLOT = "incremental_dynamic_analysis"
    LONG = ("record_level",)

    dataset: xr.Dataset = field(repr=False, converter=named_levels)
    block: Block

    def _summary(self) -> xr.Dataset:
        """Return the dataset with the fractiles, and the fraction of the records that overturn, at each level."""
        fractile = {"long_name": "fraction of the records that do not exceed the fractile", "units": "1"}
        columns = {"overturned": (self.overturned, "fraction of the records that overturn the block")}
        data = self.fractiles().rename("peak_fractile").to_dataset()
        data.fractile.attrs |= fractile
        data = data.assign(along("level", columns))
        return data.merge(self.dataset, combine_attrs="override").assign_attrs(self.dataset.attrs)

    @property
    def overturned(self) -> np.ndarray:
        """Fraction of the records that overturn the block at each level, shape (n_levels,)."""
        return np.isinf(self.dataset.peak.transpose("record", "level").values).mean(axis=0)

    def fractiles(self, of: Any = FRACTILES) -> xr.DataArray:
        """Return fractiles of the peak over the records at each level.

        A fractile is the smallest peak that at least this fraction of the records does not exceed. It is infinite where too
        many records overturn the block.

        Parameters
        ----------
        of : float or array (n,)
            Fractions in (0, 1]. Default: 0.16, 0.5 and 0.84.

        Returns
        -------
        xarray.DataArray
            Peaks |Θ| over `fractile` and `level`.

        Raises
        ------
        TypeError, ValueError
            If a fraction is not a number in (0, 1].
        """
        import xarray as xr

        fractions = checked_fractions("of", of)
        peaks = np.sort(self.dataset.peak.transpose("record", "level").values, axis=0)
        # 0.07 · 100 is 7.000000000000001 in double precision
        places = np.ceil(fractions * len(peaks) - ROUNDING).astype(int) - 1
        attributes = {"long_name": "largest absolute angle in units of theta_cr", "units": "1"}
        return xr.DataArray(
            peaks[places],
            {"fractile": ("fractile", fractions), "level": self.dataset.level},
            ("fractile", "level"),
            "peak",
            attributes,
        )

    @property
    def scatter(self) -> xr.DataArray:
        """Record-to-record scatter at each level: ½ ln(peak at 84 %/peak at 16 %).

        It is infinite where more than 16 % of the records overturn the block, and NaN where the fractile at 16 % is 0 or
        infinite.
        """
        import xarray as xr

        low, high = self.fractiles([0.16, 0.84]).values
        with np.errstate(divide="ignore", invalid="ignore"):
            result = 0.5 * np.log(high / np.where((low > 0.0) & np.isfinite(low), low, np.nan))
        attributes = {"long_name": "record-to-record scatter of ln peak", "units": "1"}
        return xr.DataArray(result, {"level": self.dataset.level}, ("level",), "scatter", attributes)

    def __str__(self) -> str:
        data = self.dataset
        fell = np.isinf(data.peak.values).any(axis=data.peak.get_axis_num("level"))
        first = np.isinf(self.fractiles([0.5]).values[0])
        median = f"no level overturns half of them up to {_level(data, -1)}"
        if first.any():
            median = f"half of them overturn the block at {_level(data, int(first.argmax()))}"
        return f"{int(fell.sum())} of {fell.size} records overturn the block, {median}; {runs_of(data)}"


def checked_fractions(name: str, values: Any) -> np.ndarray:
    """Return fractions in (0, 1] as an array (n,), n >= 1; TypeError or ValueError for anything else."""
    numbers = np.atleast_1d(reals(name, values))
    if numbers.ndim != 1 or not numbers.size or not ((numbers > 0.0) & (numbers <= 1.0)).all():
        raise Refusal(name, "hold fractions in (0, 1]", values)
    return numbers


def _level(data: Any, place: int) -> str:
    unit = data.level.attrs.get("units", "1")
    return f"{data.level.attrs['symbol']} = {float(data.level[place]):.4g}{'' if unit in ('', '1') else ' ' + unit}"


SWITCH_ROW = np.dtype(
    [
        ("record", "i8"),
        ("level", "f8"),
        ("overturns_above", "?"),
        ("impacts_since_rest", "i8"),
        ("certified", "?"),
        ("certified_below", "f8"),
        ("certified_above", "f8"),
    ]
)
"""Row of `OverturningSet.switches`."""


def intervals_of(begins_overturned: bool, switches: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the intervals (n, 2) of overturning levels in [low, high]; the ends overturn, too.

    A level of the ascending `switches` is the first one on its far side.
    """
    starts = switches["level"][switches["overturns_above"]]
    ends = np.nextafter(switches["level"][~switches["overturns_above"]], 0.0)
    if begins_overturned:
        starts = np.concatenate(([low], starts))
    if starts.size > ends.size:
        ends = np.concatenate((ends, [high]))
    return np.stack([starts, ends], axis=1)


@frozen(eq=False)
class OverturningSet(Result):
    """Levels of an intensity measure at which ground motions overturn a block; returned by `overturning_set`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `record` and `level`, the levels of the grid: `outcome`, `certified` and `impacts_since_rest`. Over
        `record`: `lowest` and `share`. Over `switch`: the columns of `switches`, with the prefix ``switch_``.
    records : RecordSet
        Ground motions.
    block : Block
        Block.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> push = rk.GroundMotion([1.0, 1.0], step=0.4, name="push")
    >>> print(rk.overturning_set(push, rk.Block(2.0, 0.5), np.linspace(0.1, 2, 20), intensity="pga-g"))
    1 record, 20 levels of PGA from 0.1 to 2 g: 1 switch; 85.2 % of the range overturns; lowest found 0.380873 g.
    Intervals and gaps narrower than 0.1 g may be missed
    """

    PLOT = "overturning_set"
    LONG = ("record_level",)

    dataset: xr.Dataset = field(repr=False, converter=named_levels)
    records: RecordSet
    block: Block

    def _data(self) -> xr.Dataset:
        """Return the dataset with the switches first, the names of their records, and the intervals of each record."""
        data, unit = self.dataset, self.measure.unit or "1"
        names = np.array(self.records.names)[data["switch_record"].values]
        switches = [name for name, each in data.data_vars.items() if "switch" in each.dims]
        intervals = [self.intervals(number) for number in range(len(self.records))]
        low, high = np.concatenate(intervals).T
        columns = {
            "interval_record": (
                np.repeat(np.arange(len(intervals)), [len(each) for each in intervals]),
                "number of the record",
            ),
            "interval_name": (
                np.repeat(self.records.names, [len(each) for each in intervals]),
                "record",
            ),
            "interval_low": (low, "lowest overturning level", unit),
            "interval_high": (high, "highest overturning level", unit),
        }
        first = data[switches].assign(along("switch", {"switch_name": (names, "record")}))
        first = first.assign(along("interval", columns))
        facts = {"unit": unit, "spacing": self.spacing}
        return first.merge(data, combine_attrs="override").assign_attrs(facts)

    def _summary(self) -> xr.Dataset:
        return self._data().assign_attrs(levels=self.levels.tolist())

    @property
    def measure(self) -> Intensity:
        """Intensity measure of the levels."""
        return intensity_of(self.dataset.attrs["intensity"], self.records)[0]

    @property
    def levels(self) -> np.ndarray:
        """Levels of the grid, shape (n_levels,)."""
        return np.asarray(self.dataset["level"].values)

    @property
    def spacing(self) -> float:
        """Largest distance between two neighbouring levels. Intervals and gaps that are narrower may be missed."""
        return float(np.diff(self.levels).max())

    @property
    def overturned(self) -> np.ndarray:
        """Flag at each level of the grid: the block overturns; shape (n_records, n_levels)."""
        return np.asarray(self.dataset["outcome"].values == tuple(Outcome).index(Outcome.OVERTURNED))

    @property
    def outcome(self) -> np.ndarray:
        """Outcome at each level of the grid, as text; shape (n_records, n_levels)."""
        return np.array([str(each) for each in Outcome])[self.dataset["outcome"].values]

    @property
    def switches(self) -> np.ndarray:
        """Switches between standing and overturning, sorted by record and level; structured array (n,).

        - `record`: number of the record, from 0;
        - `level`: first level on the far side; the double below it has the other outcome;
        - `overturns_above`: whether the block overturns at `level`;
        - `impacts_since_rest`: mode of overturning, the impacts since the block last rested;
        - `certified`: whether no rounding error can have changed the outcomes on both sides, so that a switch exists;
        - `certified_below`, `certified_above`: closest levels found to have certified outcomes, NaN if none. A certified
          switch lies between them.
        """
        data = np.empty(self.dataset.sizes["switch"], SWITCH_ROW)
        for name in SWITCH_ROW.names or ():
            data[name] = self.dataset[f"switch_{name}"].values
        return data

    @property
    def undecided(self) -> np.ndarray:
        """Switches that rounding may have made; structured array (n,)."""
        result = self.switches
        return result[~result["certified"]]

    @property
    def lowest(self) -> np.ndarray:
        """Lowest overturning level that was found of each record, NaN if none; shape (n_records,).

        Narrow intervals below it may be missed, see `spacing`. More levels find more of them.
        """
        return np.asarray(self.dataset["lowest"].values)

    @property
    def share(self) -> np.ndarray:
        """Fraction of the range of the levels that overturns, for each record; shape (n_records,)."""
        return np.asarray(self.dataset["share"].values)

    def intervals(self, record: int = 0) -> np.ndarray:
        """Return the intervals of levels at which a record overturns the block.

        Parameters
        ----------
        record : int
            Number of the record, from 0. Default: 0.

        Returns
        -------
        array, shape (n, 2)
            Lowest and highest overturning level of each interval, ascending. They end with the range of the levels.

        Raises
        ------
        TypeError, ValueError
            If there is no such record.

        Examples
        --------
        >>> import rocking as rk
        >>> push = rk.GroundMotion([1.0, 1.0], step=0.4)
        >>> result = rk.overturning_set(push, rk.Block(2.0, 0.5), [2.0, 5.0, 15.0])
        >>> result.intervals().round(6).tolist()
        [[3.735093, 15.0]]
        """
        record = whole("record", record, 0, len(self.records) - 1)
        own = self.switches[self.switches["record"] == record]
        return intervals_of(bool(self.overturned[record, 0]), own, self.levels[0], self.levels[-1])

    def motion(self, record: int, level: float) -> GroundMotion:
        """Return a ground motion scaled to a level, exactly as the survey scales it.

        Parameters
        ----------
        record : int
            Number of the record, from 0.
        level : float
            Level of the intensity measure, in its unit.

        Returns
        -------
        GroundMotion
            Scaled motion, reversed if the polarity is -1. As recorded if the set is of the worse one of both directions.

        Raises
        ------
        TypeError, ValueError
            If there is no such record, or if the level is not positive.

        Examples
        --------
        >>> import rocking as rk
        >>> push = rk.GroundMotion([1.0, 1.0], step=0.4)
        >>> rk.overturning_set(push, rk.Block(2.0, 0.5), [5.0, 15.0], intensity="pga").motion(0, 7.5).pga
        7.5
        """
        record = whole("record", record, 0, len(self.records) - 1)
        level = within("level", level, 1e-300, 1e300)
        measure, values = intensity_of(self.dataset.attrs["intensity"], self.records)
        alpha, slenderness = self.block.frequency_parameter, self.block.critical_angle
        factor = measure.factor(level, float(values[record]), alpha, slenderness)
        refuse_if(factor > MAX_FACTOR, "level", f"scale the record by {MAX_FACTOR:g} at most", level)
        ground = self.records[record].scaled(factor)
        return ground.reversed() if self.dataset.attrs["polarity"] == -1 else ground

    def __str__(self) -> str:
        low, high = self.levels[[0, -1]]
        count = self.dataset.sizes["switch"]
        unit = "" if self.measure.unit in ("1", "") else f" {self.measure.unit}"
        start = (
            f"{counted(len(self.records), 'record')}, {self.levels.size:,} levels of {self.measure.symbol} from {low:.6g} "
            f"to {high:.6g}{unit}: {count:,} switch{'es' * (count != 1)}; "
        )
        if np.isnan(self.lowest).all():
            return f"{start}no level overturns"
        least = np.nanmin(self.lowest)
        return (
            f"{start}{percent(self.share.mean())} of the range overturns; lowest found {least:.6g}{unit}.\n"
            f"Intervals and gaps narrower than {self.spacing:.3g}{unit} may be missed"
        )


@frozen(eq=False)
class Sensitivity(Result):
    """Fraction of verdicts that small changes reverse; returned by `sensitivity`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `change`:

        - `share`: fraction of the runs whose verdict (overturned or not) differs;
        - `share_low`, `share_high`: ends of its 95 % interval;
        - `flipped`, `runs`, `undecided`: numbers of runs.

        Variables over `record` and `level`: `overturned`, the verdict without a change, and, also over `change`, `differs`.
    block : Block
        Block.

    Examples
    --------
    >>> import rocking as rk
    >>> result = rk.sensitivity(rk.synthetic_ground_motions(5, seed=1), rk.Block(2.0, 0.5), [3.0, 4.0], intensity="pga")
    >>> result.dataset.share.dims, int(result.dataset.runs[0])
    (('change',), 10)
    """

    LONG = ("record_level", "record_level_change", "record_polarity_level", "record_polarity_level_change")

    dataset: xr.Dataset = field(repr=False, converter=named_levels)
    block: Block

    def _summary(self) -> xr.Dataset:
        """Return the dataset with the levels, and the number of runs that overturn, as attributes."""
        levels, fell = self.dataset.level, int(self.dataset.overturned.sum())
        return self.dataset.assign_attrs(
            levels=levels.values.tolist(), unit=levels.attrs["units"], overturned=fell
        )

    def __str__(self) -> str:
        data = self.dataset
        parts = [
            f"{name} {percent_with_ends(share, low, high)}"
            for name, share, low, high in zip(
                *(data[name].values.tolist() for name in ("change", "share", "share_low", "share_high")),
                strict=True,
            )
        ]
        records = counted(data.sizes["record"], "record")
        return (
            f"verdicts that change, of {counted(int(data.runs[0]), 'run')} of {records}: {', '.join(parts)}"
        )
