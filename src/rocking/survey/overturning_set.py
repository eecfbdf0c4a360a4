"""Overturning set: levels of ground motions that overturn a block, with the switches located to the last digit."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import CancelledError, Executor
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking.kernels.march import ending as ends
from rocking.kernels.march import finite_runs as kernel
from rocking.model.block import Block
from rocking.model.ground_motion import GroundMotion
from rocking.model.package import VERSION
from rocking.model.progress import Bar
from rocking.model.quantity import ANGLE, LEVEL
from rocking.model.record_results import SWITCH_ROW, OverturningSet, intervals_of
from rocking.model.record_set import Intensity, RecordSet, intensity_of, record_set
from rocking.model.system import MODELS
from rocking.model.validation import instance, one_of
from rocking.survey.ending_measures import CERTIFIED, OVERTURNED, VARIABLES, answers, sampled
from rocking.survey.incremental_dynamic_analysis import with_names
from rocking.survey.measurement import Arrays
from rocking.survey.run_survey import count_when_done, engine
from rocking.survey.spec import axis, check_one_block, checked_polarity

if TYPE_CHECKING:
    import xarray as xr

KEPT = ("outcome", "certified", "impacts_since_rest")
"""Variables over the levels of the grid."""
COLUMNS = {
    "record": "number of the record, from 0",
    "level": "first level on the far side of the switch",
    "overturns_above": "whether the block overturns at that level",
    "impacts_since_rest": "impacts since the block last rested, on the overturning side",
    "certified": "whether no rounding error can have changed the outcomes on both sides",
    "certified_below": "closest level below that was found certified",
    "certified_above": "closest level above that was found certified",
}

Runs = Callable[[np.ndarray], Arrays]


class Scan(NamedTuple):
    """Runs of one record at the levels of the grid, and its switches."""

    grid: Arrays
    switches: np.ndarray


class Work(NamedTuple):
    """Work of one record: the motion, the intensity measure and its value for the motion, the block and the start."""

    motion: GroundMotion
    measure: Intensity
    value: float
    block: Block
    angle: float
    polarity: float
    full: bool


def overturning_set(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "scale",
    angle: float = 0.0,
    polarity: float = 1.0,
    model: str = "slender",
    executor: Executor | None = None,
    progress: bool = False,
) -> OverturningSet:
    """Find the levels at which ground motions overturn a block, not only the lowest.

    Overturning is not monotone: a stronger motion can spare a block that a weaker one overturns. "The" overturning acceleration
    does not exist. Every interval of overturning or of standing levels that is wider than the distance of two neighbouring
    `levels` is found. Narrower ones may be missed, an even number of switches between two levels always.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions.
    block : Block
        Block.
    levels : array (n,)
        Ascending levels of the intensity measure, two at least, in [1e-9, 1e6]: the grid.
    intensity : str
        Intensity measure of the levels, as in `rocking_spectrum`. Default: "scale", the factor of the record.
    angle : float
        Initial angle Θ in units of θcr. Default: 0, at rest.
    polarity : float
        1, or -1 for the opposite direction of the motion. Default: 1.
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`. With "full", rounding errors are not assessed, so that no switch is
        certified. Default: "slender".
    executor, progress
        As in `parametric_map`.

    Returns
    -------
    OverturningSet
        Switches, intervals, lowest level and fraction of the range that overturns, for each record.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or lies outside its range.

    See Also
    --------
    rocking_spectrum : Outcomes of many blocks at given levels.
    overturning_spectrum : Outcomes under one pulse.
    rocking.plot.overturning_set : Plot the intervals.

    Notes
    -----
    Each run is exact and ends by proof, as in `simulate`. Bisection locates each switch to two adjacent doubles. Rounding decides
    the outcomes next to a switch. `certified_below` and `certified_above` of a switch enclose what rounding cannot change.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> cabinet = rk.Block(height=2.0, width=0.5)
    >>> result = rk.overturning_set(rk.example_ground_motion(), cabinet, np.linspace(1, 1.5, 101), intensity="pga-g")
    >>> result.intervals().shape[1], bool(result.lowest[0] > 1)
    (2, True)
    """
    chosen = record_set(records)
    check_one_block(block, levels, angle)
    levels = axis("levels", levels, LEVEL.range)
    angle = ANGLE.checked(angle)
    polarity = float(checked_polarity(polarity, one=True))
    measure, values = intensity_of(intensity, chosen)
    if executor is not None:
        instance("executor", executor, Executor)
    full = one_of("model", model, MODELS) == "full"
    work = [
        Work(motion, measure, value, block, angle, polarity, full)
        for motion, value in zip(chosen, values.tolist(), strict=True)
    ]
    progress = instance("progress", progress, bool)
    with engine(executor) as (pool, stop), Bar(len(work), "records", shown=progress) as bar:
        futures = [pool.submit(scan, each, levels, stop) for each in work]
        for future in futures:
            count_when_done(bar, future, 1)
        try:
            scans = [future.result() for future in futures]
        finally:
            for future in futures:
                future.cancel()
    options = {"intensity": intensity, "angle": angle, "polarity": polarity, "model": model}
    return OverturningSet(_dataset(scans, levels, measure, chosen, options), chosen, block)


def scan(work: Work, levels: np.ndarray, stop: np.ndarray) -> Scan:
    """Follow one record at all levels, and locate its switches; CancelledError if `stop` is set."""
    run = runs_of(work, stop)
    grid = run(levels)
    return Scan({name: grid[name] for name in KEPT}, locate_switches(run, levels, grid))


def runs_of(work: Work, stop: np.ndarray) -> Runs:
    """Return the function that follows a block under a motion at given levels; the motion's tables are made once."""
    block, motion = work.block, work.motion
    alpha, slenderness = block.frequency_parameter, block.critical_angle
    base = motion.normalised(1.0, alpha)
    p = sampled(base, full=work.full)
    lift_off = block.acceleration(1.0)

    def run(levels: np.ndarray) -> Arrays:
        rows, inputs = np.empty(levels.size, ends.ENDING_ROW), np.empty(levels.size, kernel.RUN_ROW)
        factors = work.measure.factor(levels, work.value, alpha, slenderness)
        # with the rounding of `GroundMotion.scaled` and `Block.system`, because a switch is located to the last digit
        inputs["scale"] = work.polarity * (motion.factor * factors) / lift_off
        inputs["restitution"], inputs["angle"] = block.restitution, work.angle
        inputs["critical_angle"] = slenderness
        if not kernel.run_batch(p, inputs, False, rows, stop):
            raise CancelledError("the survey was stopped")
        return answers(rows, with_peak=False, assessed=not work.full)

    return run


def locate_switches(run: Runs, levels: np.ndarray, grid: Arrays) -> np.ndarray:
    """Locate a switch between any two neighbouring levels with different outcomes, all at the same time, by bisection."""
    fell = grid["outcome"] == OVERTURNED
    places = np.flatnonzero(fell[1:] != fell[:-1])
    low, high, above = levels[places], levels[places + 1], fell[places + 1]
    mode = np.where(above, grid["impacts_since_rest"][places + 1], grid["impacts_since_rest"][places])
    sure = grid["certified"] == CERTIFIED
    below_sure = np.where(sure[places], low, np.nan)
    above_sure = np.where(sure[places + 1], high, np.nan)
    while True:
        middle = low + 0.5 * (high - low)
        wide = np.flatnonzero((middle > low) & (middle < high))
        if wide.size == 0:
            break
        tried = run(middle[wide])
        overturned, certain = tried["outcome"] == OVERTURNED, tried["certified"] == CERTIFIED
        upper = overturned == above[wide]
        high[wide[upper]], low[wide[~upper]] = middle[wide[upper]], middle[wide[~upper]]
        above_sure[wide[upper & certain]] = middle[wide[upper & certain]]
        below_sure[wide[~upper & certain]] = middle[wide[~upper & certain]]
        mode[wide[overturned]] = tried["impacts_since_rest"][overturned]
    values = np.empty(places.size, SWITCH_ROW)
    values["record"] = 0
    values["level"], values["overturns_above"], values["impacts_since_rest"] = high, above, mode
    values["certified_below"], values["certified_above"] = below_sure, above_sure
    values["certified"] = np.isfinite(below_sure) & np.isfinite(above_sure)
    return values


def _dataset(
    scans: list[Scan], levels: np.ndarray, measure: Intensity, records: RecordSet, options: dict[str, Any]
) -> xr.Dataset:
    """Return the dataset of the result."""
    import xarray as xr

    for number, each in enumerate(scans):
        each.switches["record"] = number
    switches = np.concatenate([each.switches for each in scans])
    unit = {"units": measure.unit or "1"}
    bounds = float(levels[0]), float(levels[-1])
    intervals = [
        intervals_of(each.grid["outcome"][0] == OVERTURNED, each.switches, *bounds) for each in scans
    ]
    lowest = np.array([each[0, 0] if each.size else np.nan for each in intervals])
    share = np.array([np.diff(each, axis=1).sum() for each in intervals]) / (bounds[1] - bounds[0])
    variables: dict[str, Any] = {
        each.name: (("record", "level"), np.stack([one.grid[each.name] for one in scans]), each.attributes)
        for each in VARIABLES
        if each.name in KEPT
    }
    variables["lowest"] = "record", lowest, {"long_name": "lowest overturning level"} | unit
    variables["share"] = "record", share, {"long_name": "fraction of the range that overturns", "units": "1"}
    for name, long_name in COLUMNS.items():
        of_level = unit if name in ("level", "certified_below", "certified_above") else {}
        variables[f"switch_{name}"] = "switch", switches[name], {"long_name": long_name} | of_level
    pga = np.array([motion.pga for motion in records])
    level = "level", levels, {"long_name": measure.long_name, "symbol": measure.symbol} | unit
    attributes = {
        "Conventions": "CF-1.11",
        "title": "Overturning set of a block under ground motions",
        "source": f"rocking {VERSION}",
        **options,
        "records_sha256": records.digest,
    }
    named = with_names(xr.Dataset(variables, {"level": level}, attributes), records)
    return named.assign_coords(
        pga=("record", pga, {"long_name": "peak ground acceleration", "units": "m/s²"})
    )
