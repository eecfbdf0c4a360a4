"""Overturning set: levels of ground motions that overturn a block, with the switches located to the last digit."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from attrs import evolve, field, frozen

from rocking.kernels.motion import finite_motion
from rocking.model.block import Block, unit_for
from rocking.model.block_formulas import with_unit
from rocking.model.ground_motion import GroundMotion
from rocking.model.package import VERSION
from rocking.model.record_results import SWITCH_ROW, OverturningSet, intervals_of
from rocking.model.record_set import RecordSet, record_set
from rocking.survey.ending_measures import (
    CERTIFIED,
    METHOD,
    OVERTURNED,
    VARIABLES,
    answers,
    give_sides,
    sampled,
    worse_of,
)
from rocking.survey.engine import Engine
from rocking.survey.incremental_dynamic_analysis import block_spec, of_block, with_polarity
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import UNRESTRAINED, MotionSpec, Values, left_of, ratios_of

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Overturning set of a block under ground motions"

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
STATED = ("intensity", "angle", "polarity", "model", "normalised_by", "records_sha256")
"""Attributes of the survey that the result keeps, if they have a value."""
SWITCH = ("level", "certified_below", "certified_above", "impacts_since_rest")
"""Quantities of the switch between a level of the grid and the level below it; NaN without a switch."""

Run = Callable[[np.ndarray], Arrays]


class Steps(NamedTuple):
    """Steps from a level of the grid to the next, each an array (n,); below the first level is that level itself."""

    spec: SwitchSpec
    record: np.ndarray
    below: np.ndarray
    level: np.ndarray


@frozen(eq=False)
class SwitchSpec(MotionSpec):
    """Survey of the switches between neighbouring levels of a grid, which have no meaning on a coarser grid."""

    block: Block = field(kw_only=True)
    grid: np.ndarray = field(kw_only=True)

    @property
    def refines(self) -> bool:
        """Flag: a result depends on the level below."""
        return False

    def with_axes(self, axes: dict[str, np.ndarray]) -> SwitchSpec:
        """Return the survey over other axes of the same names; shorter ones are parts of the grid."""
        level = axes["level"]
        return evolve(super().with_axes(axes), grid=level if level.size >= self.grid.size else self.grid)

    def inputs(self, values: Values) -> Steps:  # type: ignore[override]
        """Return the steps to n points."""
        level = values["level"]
        below = self.grid[np.maximum(np.searchsorted(self.grid, level) - 1, 0)]
        return Steps(self, self.arguments(values)["record"].astype(int), below, level)


def overturning_set(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "scale",
    angle: float = 0.0,
    polarity: Any = "+",
    model: str = "full",
    normalised_by: str | None = None,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
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
    polarity : {"+", "-", "both", "worse"}
        Direction of the motion: as recorded, reversed, each record twice, or of both runs the one
        that is worse for the block. A symmetric block at rest does not distinguish them. 1, -1 and [-1, 1] are allowed, too.
        Default: "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`. Default: "full".
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration of slender blocks, as for `Block.system`. Default: "tangent".
    store, executor, progress, repair
        As in `parametric_map`. More levels extend a store. It cannot be refined, because switches are sought between neighbours.

    Returns
    -------
    OverturningSet
        Switches, intervals, lowest level and fraction of the range that overturns, for each record.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

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
    chosen, polarity = with_polarity(record_set(records), polarity)
    spec = block_spec(
        chosen,
        block,
        levels,
        intensity,
        angle=angle,
        polarity=polarity,
        model=model,
        normalised_by=normalised_by,
    )
    block = spec.own_units(block)
    steps = spec.extended(SwitchSpec, block=block, grid=spec.axes["level"])
    data = run_survey(steps, MEASURE, store, executor, progress=progress, repair=repair)
    return OverturningSet(_dataset(of_block(data, spec, chosen, block).load(), spec, chosen), chosen, block)


def switches_below(steps: Steps, options: Mapping[str, int], stop: np.ndarray) -> Arrays:
    """Follow blocks at levels, and locate the switch from each level below; CancelledError if `stop` is set."""
    results = MEASURE.blank(steps.level.shape)
    for number in np.unique(steps.record).tolist():
        own = steps.record == number
        run = runs_of(steps.spec, number, stop)
        levels = np.unique([steps.below[own], steps.level[own]])
        grid = run(levels)
        below, above = (np.searchsorted(levels, each[own]) for each in (steps.below, steps.level))
        kept = {name: grid[name][above] for name in KEPT}
        for name, values in {**kept, **locate_switches(run, levels, grid, below, above)}.items():
            results[name][own] = values
    return results


def runs_of(spec: SwitchSpec, number: int, stop: np.ndarray) -> Run:
    """Return the function that follows a block under a motion at n levels; the motion's tables are made once."""
    block, motion = spec.block, spec.motions[number]
    alpha, slenderness, rate = block.frequency_parameter, block.critical_angle, block.rate_unit
    left = left_of(
        {name: np.array([value]) for name, value in spec.fixed.items()}, np.array([block.restitution])
    )
    law, ratios = np.array(spec.law.rows).reshape(-1, 2), ratios_of(spec.fixed) if spec.full else UNRESTRAINED
    p = sampled(
        motion.normalised(1.0, rate),
        full=spec.full,
        left=left,
        law=law,
        scatter=spec.law.scatter,
        restrainer=ratios,
        critical_angle=slenderness,
    )
    restitution = law[:, 1].max() if spec.law.rows else block.restitution
    stream = spec.streams(np.array([number]), np.zeros(1, np.int64))
    unit = with_unit(block, unit_for(block, spec.normalised_by, spec.model)).acceleration(1.0)

    def run(levels: np.ndarray) -> Arrays:
        polarity = spec.fixed["polarity"]
        if spec.worse:
            return worse_of(run_one(levels, polarity), run_one(levels, -polarity))
        return run_one(levels, polarity)

    def run_one(levels: np.ndarray, polarity: float) -> Arrays:
        rows, inputs = (
            np.empty(levels.size, finite_motion.ENDING_ROW),
            np.empty(levels.size, finite_motion.RUN_ROW),
        )
        factors = spec.measure.factor(levels, spec.intensities[number], alpha, slenderness)
        # with the rounding of `GroundMotion.scaled` and `Block.system`, because a switch is located to the last digit
        inputs["scale"] = polarity * (motion.factor * factors) / unit
        inputs["restitution"], inputs["angle"] = restitution, spec.fixed["angle"]
        inputs["critical_angle"] = slenderness
        inputs["speed_unit"], inputs["stream"] = block.angle_unit * rate, stream
        give_sides(inputs, left)
        if not finite_motion.run_batch(p, inputs, False, rows, stop):
            raise CancelledError("the survey was stopped")
        return answers(rows, with_peak=False)

    return run


def locate_switches(
    run: Run, levels: np.ndarray, grid: Arrays, below: np.ndarray, above: np.ndarray
) -> Arrays:
    """Locate a switch between any two levels with different outcomes, all at the same time, by bisection.

    `below` and `above` (n,) are places in `levels`. The results are NaN for pairs without a switch.
    """
    fell, sure = grid["outcome"] == OVERTURNED, grid["certified"] == CERTIFIED
    places = np.flatnonzero(fell[below] != fell[above])
    one, other = below[places], above[places]
    low, high, overturns = levels[one], levels[other], fell[other]
    mode = grid["impacts_since_rest"][np.where(overturns, other, one)]
    below_sure, above_sure = np.where(sure[one], low, np.nan), np.where(sure[other], high, np.nan)
    while True:
        middle = low + 0.5 * (high - low)
        wide = np.flatnonzero((middle > low) & (middle < high))
        if wide.size == 0:
            break
        tried = run(middle[wide])
        overturned, certain = tried["outcome"] == OVERTURNED, tried["certified"] == CERTIFIED
        upper = overturned == overturns[wide]
        high[wide[upper]], low[wide[~upper]] = middle[wide[upper]], middle[wide[~upper]]
        above_sure[wide[upper & certain]] = middle[wide[upper & certain]]
        below_sure[wide[~upper & certain]] = middle[wide[~upper & certain]]
        mode[wide[overturned]] = tried["impacts_since_rest"][overturned]
    results = np.full((len(SWITCH), below.size), np.nan)
    results[:, places] = high, below_sure, above_sure, mode
    return {f"switch_{name}": values for name, values in zip(SWITCH, results, strict=True)}


MEASURE = Measurement(
    TITLE,
    switches_below,
    (
        *(Variable(f"switch_{name}", "float64", math.inf, {"long_name": COLUMNS[name]}) for name in SWITCH),
        *(each for each in VARIABLES if each.name in KEPT),
    ),
    {},
    METHOD,
    shares="outcome",
)


def _switches(data: xr.Dataset) -> np.ndarray:
    """Return the switches of all records, in ascending order of their levels."""
    places = np.nonzero(np.isfinite(data.switch_level.values))
    result = np.empty(places[0].size, SWITCH_ROW)
    for name in SWITCH:
        result[name] = data[f"switch_{name}"].values[places]
    result["record"] = places[0]
    result["overturns_above"] = data.outcome.values[places] == OVERTURNED
    result["certified"] = np.isfinite(result["certified_below"]) & np.isfinite(result["certified_above"])
    return result


def _dataset(data: xr.Dataset, spec: MotionSpec, records: RecordSet) -> xr.Dataset:
    """Return the dataset of the result from that of the survey."""
    import xarray as xr

    switches = _switches(data)
    unit = {"units": spec.measure.unit or "1"}
    bounds = float(data.level[0]), float(data.level[-1])
    intervals = [
        intervals_of(begins == OVERTURNED, switches[switches["record"] == number], *bounds)
        for number, begins in enumerate(data.outcome.values[:, 0])
    ]
    lowest = np.array([each[0, 0] if each.size else np.nan for each in intervals])
    share = np.array([np.diff(each, axis=1).sum() for each in intervals]) / (bounds[1] - bounds[0])
    variables: dict[str, Any] = {
        name: (("record", "level"), data[name].values, data[name].attrs) for name in KEPT
    }
    variables["lowest"] = "record", lowest, {"long_name": "lowest overturning level"} | unit
    variables["share"] = "record", share, {"long_name": "fraction of the range that overturns", "units": "1"}
    for name, long_name in COLUMNS.items():
        of_level = unit if name in ("level", "certified_below", "certified_above") else {}
        variables[f"switch_{name}"] = "switch", switches[name], {"long_name": long_name} | of_level
    pga = [motion.pga for motion in records]
    level = "level", data.level.values, spec.coordinate("level") | unit
    attributes = {
        "Conventions": "CF-1.11",
        "title": TITLE,
        "source": f"rocking {VERSION}",
        **{name: data.attrs[name] for name in STATED if name in data.attrs},
        **spec.law.attributes(),
    }
    return xr.Dataset(variables, {"level": level}, attributes).assign_coords(
        record=data.record,
        name=data.name,
        pga=("record", pga, {"long_name": "peak ground acceleration", "units": "m/s²"}),
    )
