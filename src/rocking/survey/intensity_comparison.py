"""Which intensity measure explains overturning best for one block: efficiency and sufficiency of each."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking.model.block import Block, block_attributes
from rocking.model.ground_motion import GroundMotion
from rocking.model.intensity_comparison import IntensityComparison
from rocking.model.record_results import FIT, OverturningSet
from rocking.model.record_set import Intensity, RecordSet, intensity_of
from rocking.model.result import along
from rocking.model.validation import Refusal, instance, members, one_of, whole
from rocking.survey.censored_fit import Censored, regression, slope_p_value
from rocking.survey.fragility_curve import log_basic_interval, two_level_weights
from rocking.survey.random_points import MAX_SEED, fingerprints

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Intensity measures of ground motions for the overturning of a block"
MEASURES = (
    *("pga", "pgv", "pgd", "arias", "cav", "sa(0.2)", "sa(0.5)", "sa(1)", "sa(2)"),
    "sa-avg(0.5, 0.75, 1, 1.5, 2)",
)
"""Measures that are compared unless others are given."""
SHAPES: dict[str, Callable[[GroundMotion], float]] = {
    "ln_duration": lambda motion: motion.significant_duration,
    "ln_pgv_to_pga": lambda motion: motion.pgv_to_pga,
}
"""Quantities of each motion that do not depend on its factor, taken by their logarithms."""
NAMES = "be a list of names"
FEWEST, MAX_REPLICATES = 5, 100_000


def compare_intensities(
    overturning: OverturningSet,
    measures: Iterable[str] | None = None,
    *,
    against: Iterable[str] | None = None,
    replicates: int = 1000,
    seed: int = 0,
) -> IntensityComparison:
    """Compare intensity measures by how well they explain the overturning of a block.

    A measure is efficient if the records overturn the block at nearly the same level of it: the dispersion is small, and fewer
    records suffice. It is sufficient if that level does not depend on anything else about the records, such as the magnitude:
    otherwise the fragility is that of the chosen records only.

    Parameters
    ----------
    overturning : OverturningSet
        Levels of any intensity measure that overturn the block under each record. The lowest of them should overturn it under no
        record, and the highest under all. Between them five records at least switch from standing to overturning.
    measures : iterable of str, optional
        Intensity measures, as in `rocking_spectrum`, among them columns of the records, such as a RotD50.
        Default: PGA, PGV, PGD, Arias intensity, CAV, Sa at 0.2, 0.5, 1 and 2 s, and Sa_avg from 0.5 to 2 s.
    against : iterable of str, optional
        Quantities on which the level should not depend: "ln_duration", the logarithm of the significant duration,
        "ln_pgv_to_pga", that of PGV/PGA, and columns of the records. Default: all but the columns among the measures.
        A record whose column is NaN is left out.
    replicates : int
        Number of bootstrap replicates, in [100, 10⁵]. Default: 1,000.
    seed : int
        Random seed of the bootstrap, in [0, 2³² − 1]. Default: 0.

    Returns
    -------
    IntensityComparison
        `.dataset` and `.to_dataframe()`; `print` shows the table.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong type, or if there is no such measure or quantity. Also if fewer than five records switch
        between the levels, or if a record occurs twice, as it does with both polarities.

    See Also
    --------
    overturning_set : The levels that overturn a block.
    fragility : Probability of overturning over the level of one measure.

    Notes
    -----
    **Level of a record.** A record has many switches between standing and overturning levels. The lowest one is no level to
    compare: a finer grid of levels finds narrower intervals below it. In its place stands the one switch that leaves the same
    length of standing levels, on a scale of logarithms. With the intervals (aₖ, bₖ) of overturning factors up to the highest
    factor h it is ln s = ln h − Σ ln(bₖ/aₖ), with one switch the switch itself. A record at factor 1 with the value v has at
    factor s the level sⁿ v, with n = 2 for the Arias intensity and 1 for all others. So one overturning set serves all measures.

    **Efficiency.** The logarithms of the levels are normal, with a mean and a deviation β of maximum likelihood. Where the block
    stands at the highest level, s is a lower bound, and where it overturns at the lowest one, an upper bound. β is corrected by
    √(m/(m − 1)) for m known levels; without bounds it is the standard deviation of the sample. Measures are compared by β/n,
    because a motion times 2 has four times the Arias intensity. Two measures that differ by a constant of the block, such as PGA
    and PGA/(g tan θcr), have the same β.

    **Within a record** the switches have a variance about ln s, w² = Σ(ln²(h/aₖ) − ln²(h/bₖ)) − ln²(h/s). The attribute
    `within_dispersion` is the root of its mean. No measure removes it: the mean of the fractions over all records has, in units
    of the factor, the variance β²/n² + w², and the dispersion of a `fragility` is about the root of it.

    **Intervals.** A replicate draws records with replacement, the same ones for all measures. The intervals are those of
    `fragility`.

    **Sufficiency.** The p-value is that of the t-test of the slope of the logarithm of the level over the quantity. With bounds,
    t is that of the same ratio of likelihoods. A small value says that the measure is not sufficient. Of 20 independent p-values
    one is below 0.05 by chance. A large value from few records says little.

    References
    ----------
    Luco & Cornell, Earthquake Spectra 23, 357–392 (2007): efficiency and sufficiency. Olsen, Econometrica 46, 1211–1215
    (1978): the likelihood with bounds.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(12, seed=1)
    >>> levels = rk.overturning_set(records, rk.Block(2.0, 0.5), np.linspace(0.5, 5, 46))
    >>> print(rk.compare_intensities(levels, ["pga", "pgv"]))
    overturning under 12 records; the most efficient measure first:
    measure  median      dispersion of the factor  smallest in  p: ln_duration  p: ln_pgv_to_pga
    PGA      5.207 m/s²  0.145 (0.113–0.255)       77.9 %       0.74            0.42
    PGV      0.6279 m/s  0.165 (0.138–0.254)       22.1 %       0.077           0.079
    within a record the factor has a dispersion of 0.123, which no measure removes
    """
    records = instance("overturning", overturning, OverturningSet).records
    fingerprints(records)
    seed = whole("seed", seed, 0, MAX_SEED)
    replicates = whole("replicates", replicates, 100, MAX_REPLICATES)
    names = MEASURES if measures is None else members("measures", measures, NAMES)
    if not names:
        raise Refusal("measures", "name one measure at least", names)
    kinds = [intensity_of(name, records) for name in names]
    switches = _switches(overturning)
    factors = switches.factors
    count = int(factors.seen.sum())
    if count < FEWEST:
        allowed = f"hold levels between which {FEWEST} records at least switch from standing to overturning"
        raise Refusal("overturning", allowed, count, "give more levels or records")
    quantities = _quantities(records, against, names)
    weights = two_level_weights(len(records), 1, replicates, np.random.default_rng(seed))[..., 0]
    rows = [_efficiency(factors, *each, overturning.block, weights) for each in kinds]
    deviations = np.array([row.replicates for row in rows])
    first = deviations[:, ~np.isnan(deviations).any(axis=0)].argmin(axis=0)
    smallest = np.bincount(first, minlength=len(rows)) / max(first.size, 1)
    order = np.argsort([row.deviation for row in rows], kind="stable")
    data = _measures([rows[place] for place in order], smallest[order], quantities)
    return IntensityComparison(_with_records(data, overturning, switches), overturning.block)


class Switches(NamedTuple):
    """One switch for each record in place of all those between standing and overturning levels."""

    factors: Censored
    """Logarithm of the factor of the record."""
    within: np.ndarray
    """Standard deviation of the logarithms of the factors of the switches about it."""


def _switches(overturning: OverturningSet) -> Switches:
    """Return the switch of each record with the same length of standing levels below it, on a scale of logarithms."""
    block, records = overturning.block, overturning.records
    measure, values = intensity_of(overturning.dataset.attrs["intensity"], records)

    def logarithms(levels: np.ndarray, number: int) -> np.ndarray:
        alpha, slenderness = block.frequency_parameter, block.critical_angle
        return np.asarray(np.log(measure.factor(levels, values[number], alpha, slenderness)))

    rows = []
    for number in range(len(records)):
        top = logarithms(overturning.levels[-1], number)
        distances = top - logarithms(overturning.intervals(number), number)
        length = -np.diff(distances, axis=1).sum()
        square = -np.diff(distances**2, axis=1).sum()
        rows.append((top - length, math.sqrt(max(square - length**2, 0.0))))
    places, within = np.array(rows).T
    above = ~overturning.overturned[:, -1]
    below = overturning.overturned[:, 0]
    return Switches(Censored(places, above, below), within)


def _quantities(records: RecordSet, against: Any, measures: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the quantities on which levels should not depend, by name."""
    choices = (*SHAPES, *records.columns)
    if twice := [name for name in records.columns if name in SHAPES]:
        raise Refusal(
            "against", "name either a quantity of each motion or a column", twice[0], "rename the column"
        )
    chosen = (
        [name for name in choices if name not in measures]
        if against is None
        else members("against", against, NAMES)
    )
    with np.errstate(divide="ignore"):
        return {
            one_of("against", name, choices): np.log([SHAPES[name](motion) for motion in records])
            if name in SHAPES
            else records.columns[name]
            for name in chosen
        }


class Efficiency(NamedTuple):
    """Lognormal fit of the overturning levels of one measure."""

    measure: Intensity
    levels: Censored
    """Logarithms of the levels."""
    median: float
    median_ends: tuple[float, float]
    deviation: float
    """Standard deviation of the logarithm of the factor at a level."""
    deviation_ends: tuple[float, float]
    replicates: np.ndarray
    """Deviations of the replicates, NaN where the known levels determine none."""


def _efficiency(
    factors: Censored, measure: Intensity, values: np.ndarray, block: Block, weights: np.ndarray
) -> Efficiency:
    """Fit the overturning levels of a measure, with intervals."""
    count, known = factors.values.size, int(factors.seen.sum())
    level = measure.level(np.exp(factors.values), values, block.frequency_parameter, block.critical_angle)
    levels = factors._replace(values=np.log(level))
    ones, correction = np.ones((count, 1)), math.sqrt(known / (known - 1)) / measure.power
    one, many = (regression(levels, ones, each) for each in (ones.T, weights))
    median, deviation = math.exp(one.coefficients[0, 0]), correction * float(one.deviation[0])
    medians, deviations = np.exp(many.coefficients[:, 0]), correction * many.deviation
    lost = np.isnan(deviations)
    median_ends, deviation_ends = (
        log_basic_interval(estimate, (np.where(lost, 0.0, each), np.where(lost, np.inf, each)), count)
        for estimate, each in ((median, medians), (deviation, deviations))
    )
    return Efficiency(measure, levels, median, median_ends, deviation, deviation_ends, deviations)


ENDS = {
    "": "standard deviation of the logarithm of the {}",
    "_low": "lower end of the 95 % interval of the dispersion of the {}",
    "_high": "upper end of the 95 % interval of the dispersion of the {}",
}
"""Descriptions of a dispersion and of the ends of its interval."""


def _measures(rows: list[Efficiency], smallest: np.ndarray, quantities: dict[str, np.ndarray]) -> xr.Dataset:
    """Return the dataset of the measures, without the records."""
    import xarray as xr

    median = np.array([(row.median, *row.median_ends) for row in rows])
    factor = np.array([(row.deviation, *row.deviation_ends) for row in rows])
    level = factor * np.array([[row.measure.power] for row in rows])
    columns: dict[str, Any] = {
        "symbol": ([row.measure.symbol for row in rows], "symbol"),
        "unit": ([row.measure.unit or "1" for row in rows], "unit of the level"),
        "median": (median[:, 0], "level at which half of the records overturn the block", ""),
        "median_low": (median[:, 1], FIT["median_low"], ""),
        "median_high": (median[:, 2], FIT["median_high"], ""),
    }
    for name, values, what in (
        ("dispersion", level, "level"),
        ("factor_dispersion", factor, "factor at a level"),
    ):
        for place, (end, text) in enumerate(ENDS.items()):
            columns[name + end] = (values[:, place], text.format(what))
    columns["most_efficient"] = (
        smallest,
        "fraction of the replicates in which this dispersion is the smallest",
    )
    p_values = np.array([[slope_p_value(row.levels, each) for each in quantities.values()] for row in rows])
    capacity = np.exp([row.levels.values for row in rows])
    return xr.Dataset(
        {
            **along("measure", columns),
            "p_value": (
                ("measure", "quantity"),
                p_values.reshape(len(rows), len(quantities)),
                {"long_name": "p-value of the level not depending on the quantity", "units": "1"},
            ),
            "capacity": (
                ("measure", "record"),
                capacity,
                {"long_name": "overturning level of the record, or its bound"},
            ),
        },
        {
            "measure": ("measure", [row.measure.name for row in rows], {"long_name": "intensity measure"}),
            "quantity": ("quantity", list(quantities), {"long_name": "quantity of the records"}),
        },
    )


def _with_records(data: xr.Dataset, overturning: OverturningSet, switches: Switches) -> xr.Dataset:
    """Return the dataset with factors and names of the records, and with what the overturning set states."""
    own, (places, above, below) = overturning.dataset, switches.factors
    bound = np.select([above, below], ["at least", "at most"], "")
    columns: dict[str, Any] = {
        "factor": (np.exp(places), "overturning factor of the record, or its bound"),
        "within": (switches.within, "standard deviation of the logarithms of the switches of the record"),
        "bound": (bound, "whether the block stands at the highest level, or overturns at the lowest one"),
    }
    within = math.sqrt(float((switches.within[switches.factors.seen] ** 2).mean()))
    stated = {name: value for name, value in own.attrs.items() if name != "intensity"}
    stated |= {"title": TITLE, "spacing": overturning.spacing, "within_dispersion": within}
    return (
        data.assign(along("record", columns))
        .assign_coords(record=own.record, name=own.name)
        .assign_attrs(stated | block_attributes(overturning.block))
    )
