"""Fragility: the probability that a block exceeds limits, over the intensity of the ground motion."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.block import Block
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_results import Fragility
from rocking.model.record_set import RecordSet, record_set
from rocking.model.restitution import check_uniform
from rocking.model.validation import Refusal, instance, reals, refuse_if, whole, within
from rocking.survey.ending_measures import UNDECIDED, ending
from rocking.survey.engine import Engine
from rocking.survey.fragility_curve import Fractions, clustered_fractions, fitted, two_level_weights
from rocking.survey.incremental_dynamic_analysis import block_spec, of_block
from rocking.survey.random_points import MAX_SEED, UncertainMotionSpec, block_samples, fingerprints
from rocking.survey.run_survey import run_survey

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Fragility of a free-standing block under ground motions"
MAX_SPREAD, MAX_BLOCKS, MAX_REPLICATES = 0.5, 10_000, 100_000
MAX_LIMIT = 10.0


def fragility(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "pga",
    limits: Any = (0.1, 0.5),
    samples: int = 1,
    height_spread: float = 0.0,
    width_spread: float = 0.0,
    restitution_spread: float = 0.0,
    polarity: Any = "+",
    model: str = "full",
    normalised_by: str | None = None,
    replicates: int = 1000,
    seed: int = 0,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> Fragility:
    """Estimate the probability that a block exceeds limits of |Θ|, and that it overturns, over the intensity of the motion.

    Each record is scaled to each level. With spreads, each record also has its own samples of the block. Runs of the same
    record are never treated as independent: all intervals are clustered by record.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions, a sample of those that the block may meet. None may be a copy of another.
    block : Block
        Nominal block, initially at rest.
    levels : array (n,)
        Levels of the intensity measure, ascending. With the measure "scale" and the one level [1.0], the fraction is that of
        the records as they are.
    intensity : str
        Intensity measure of the levels, as in `rocking_spectrum`. Default: "pga", in m/s².
    limits : float or array (k,)
        Limits of |Θ| in (0, 10], ascending. Overturning, an infinite limit, always follows; with ``[]`` it is alone.
        Default: 0.1 and 0.5.
    samples : int
        Number of samples per record of an uncertain block, or of one whose restitution is scattered; in [1, 10⁴]. Default: 1.
    height_spread, width_spread : float
        Standard deviations of ln H and ln B, in [0, 0.5]; both are lognormal with the nominal value as median. Default: 0.
    restitution_spread : float
        Half the width of the uniform distribution of e about its nominal value, in [0, 0.5], cut off at 0 and 1. Housner's
        value follows the sample of height and width. Default: 0.
    polarity : {"+", "-", "both", "worse"}
        Direction of the motions, as in `rocking_spectrum`; with "both" each record has two runs. Default: "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`.
        Default: "full".
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration of slender blocks, as for `Block.system`. Default: "tangent".
    replicates : int
        Number of bootstrap replicates, in [100, 10⁵]. Default: 1,000.
    seed : int
        Random seed of samples and bootstrap, in [0, 2³² − 1]. Default: 0.
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    Fragility
        `.dataset`, `.fits` and `.fit(limit)`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`, or if two records have the same samples.

    See Also
    --------
    incremental_dynamic_analysis : The peaks of one block, with their fractiles.
    sensitivity : Verdicts that small changes reverse.
    rocking.plot.fragility : Plot fractions and fits.

    Notes
    -----
    **Samples.** Height, width and restitution of a record's samples form a Latin hypercube (McKay, Beckman & Conover 1979).
    It depends on the seed and on the record only, so that the order of the records is of no importance.

    **Bootstrap.** A replicate draws records with replacement, and within each drawn record its samples with replacement
    (Efron 1979).

    **Fractions.** The bootstrap of 0 of 20 records has no width. So the interval of a fraction p at one level is the union of
    the 95 % percentile interval of the bootstrap and Wilson's (1927). Wilson's number of trials is the effective number of
    records, p(1 − p)n/s². Here s² is the variance between the fractions of the n records. The number is at most n, and n
    where all records agree. Runs that are undecided in double precision widen the interval: its lower end counts none of
    them, its upper end all. With several samples per record these intervals are wider than necessary.

    **Fit.** The probability of exceeding is the fraction of runs that rock at that level, times Φ(ln(level/median)/dispersion).
    Median and dispersion maximise the likelihood of the runs that rock. A finite maximum needs runs that exceed below runs
    that do not (Silvapulle 1981). Otherwise there is no fit, and `Fragility.fit` raises `TooShort`.

    **Parameters of the fit.** Their intervals are basic bootstrap intervals of the logarithm (Davison & Hinkley 1997), with
    tails wider for few records (Hesterberg 2015). A replicate without a fit counts with the bounds that its runs give.
    The band of the fit joins percentiles with the same tails.

    References
    ----------
    Wilson, J. Am. Stat. Assoc. 22, 209–212 (1927). Efron, Ann. Stat. 7, 1–26 (1979). McKay, Beckman & Conover,
    Technometrics 21, 239–245 (1979). Silvapulle, J. R. Stat. Soc. B 43, 310–313 (1981). Davison & Hinkley, Bootstrap Methods
    and their Application, Cambridge (1997). Hesterberg, Am. Stat. 69, 371–386 (2015).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(12, seed=1)
    >>> result = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9), limits=0.5)
    >>> result.dataset.limit.values.tolist(), result.dataset.fraction.shape
    ([0.5, inf], (2, 9))
    >>> fit = result.fit()
    >>> fit.median_low < fit.median < fit.median_high
    True
    """
    chosen = record_set(records)
    marks = fingerprints(chosen)
    thresholds = np.append(_limits(limits), np.inf)
    replicates, seed = (
        whole("replicates", replicates, 100, MAX_REPLICATES),
        whole("seed", seed, 0, MAX_SEED),
    )
    count = whole("samples", samples, 1, MAX_BLOCKS)
    spreads = {
        name: within(name, value, 0.0, MAX_SPREAD)
        for name, value in (
            ("height_spread", height_spread),
            ("width_spread", width_spread),
            ("restitution_spread", restitution_spread),
        )
    }
    law = instance("block", block, Block).law
    refuse_if(
        count > 1 and not any(spreads.values()) and law.scatter is None,
        "samples",
        "be 1 for a certain block",
        count,
        "give {height_spread}, {width_spread} or {restitution_spread}, or a restitution with scatter",
    )
    if restitution_spread:
        check_uniform(law.rows, "{restitution_spread}")
    how = {"polarity": polarity, "model": model, "normalised_by": normalised_by}
    spec = block_spec(chosen, block, levels, intensity, **how, one_level=True)
    if any(spreads.values()) or count > 1:
        spec = spec.extended(
            UncertainMotionSpec,
            {"sample": np.arange(float(count))},
            drawn=block_samples(chosen, block, count, tuple(spreads.values()), seed),  # type: ignore[arg-type]
            stated={**spreads, "samples": count, "seed": seed},
        )
    data = run_survey(spec, ending(TITLE), store, executor, progress=progress, repair=repair)
    runs = of_block(data, spec, chosen, block).assign_attrs(replicates=replicates, seed=seed)
    count *= runs.sizes.get("polarity", 1)
    weights = two_level_weights(len(chosen), count, replicates, np.random.default_rng(seed))
    return _estimated(runs.load(), thresholds, weights, np.argsort(marks), spec.own_units(block))


def _limits(values: Any) -> np.ndarray:
    numbers = np.atleast_1d(reals("limits", values))
    allowed = f"hold numbers in (0, {MAX_LIMIT:g}], ascending"
    if (
        numbers.ndim != 1
        or not ((numbers > 0.0) & (numbers <= MAX_LIMIT)).all()
        or not (np.diff(numbers) > 0.0).all()
    ):
        raise Refusal("limits", allowed, values, "overturning follows by itself")
    return numbers


def by_record(runs: xr.Dataset) -> xr.Dataset:
    """Return runs over record, sample and level: those of both polarities are samples, too."""
    kept = runs if "sample" in runs.dims else runs.expand_dims(sample=[0])
    if "polarity" in kept.dims:
        kept = kept.stack(run=("polarity", "sample"), create_index=False)
        kept = kept.drop_vars(["polarity", "sample"]).rename_dims(run="sample")
    return kept.transpose("record", "sample", "level", ...)


def exceeds(peak: np.ndarray, limit: Any) -> np.ndarray:
    """Return whether peaks exceed a limit; an infinite limit is overturning."""
    return np.where(np.isinf(limit), np.isinf(peak), peak > limit)


def _estimated(
    runs: xr.Dataset, limits: np.ndarray, weights: np.ndarray, order: np.ndarray, block: Block
) -> Fragility:
    """Return fractions, fits and their intervals; the bootstrap takes the records in a given order."""
    kept = by_record(runs).isel(record=order)
    peak, undecided = kept.peak.values, kept.certified.values == UNDECIDED
    exceeding = exceeds(peak[..., None], limits)
    rocking = peak > 0.0
    fractions = clustered_fractions(
        exceeding, weights, np.broadcast_to(undecided[..., None], exceeding.shape)
    )
    levels = runs.level.values
    fits, curves = [], []
    for number, limit in enumerate(limits.tolist()):
        fit, curve = fitted(limit, levels, exceeding[..., number], rocking, weights)
        fits.append(fit)
        curves.append(curve)
    return Fragility(_dataset(runs, limits, fractions, rocking, np.array(curves)), block, tuple(fits))


def _dataset(
    runs: xr.Dataset, limits: np.ndarray, fractions: Fractions, rocking: np.ndarray, curves: np.ndarray
) -> xr.Dataset:
    over = ("limit", "level")
    columns: dict[str, tuple[np.ndarray, str]] = {
        **fractions.columns("fraction", "fraction of the runs that exceed the limit"),
        "effective_records": (fractions.effective, "number of independent records behind the interval"),
    }
    variables: dict[str, Any] = {
        name: (over, values.T, {"long_name": long_name, "units": "1"})
        for name, (values, long_name) in columns.items()
    }
    long_names = (
        "lognormal fit",
        "lower end of the 95 % band of the fit",
        "upper end of the 95 % band of the fit",
    )
    for number, (name, text) in enumerate(zip(("fit", "fit_low", "fit_high"), long_names, strict=True)):
        variables[name] = (over, curves[:, number], {"long_name": text, "units": "1"})
    rocks = {"long_name": "fraction of the runs that rock", "units": "1"}
    variables["rocking"] = ("level", rocking.mean(axis=(0, 1)), rocks)
    limit = {"long_name": "limit of the largest absolute angle in units of theta_cr", "units": "1"}
    return runs.assign(variables).assign_coords(limit=("limit", limits, limit))
