"""Incremental dynamic analysis: each ground motion scaled to each level of an intensity measure."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.block import Block, block_attributes, restrainer_quantities
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_results import IncrementalDynamicAnalysis
from rocking.model.record_set import RecordSet, both_ways, record_set
from rocking.model.system import left_quantities
from rocking.survey.ending_measures import ending
from rocking.survey.engine import Engine
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import (
    MotionSpec,
    check_one_block,
    checked_polarity,
    is_axis,
    motion_spec,
)

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Incremental dynamic analysis of a free-standing block under ground motions"


def incremental_dynamic_analysis(
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
) -> IncrementalDynamicAnalysis:
    """Compute the peak of a block under each ground motion, scaled to each level of an intensity measure.

    The peak is not monotone in the level: a block may stand at a higher level than one that overturns it. So all levels are
    computed, and none is skipped after the first overturning.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions.
    block : Block
        Block.
    levels : array (n,)
        Levels of the intensity measure, ascending, two at least.
    intensity : str
        Intensity measure of the levels, as in `rocking_spectrum`. Default: "scale", the factor of each record.
    angle : float
        Initial angle Θ in units of θcr. Default: 0, at rest.
    polarity : {"+", "-", "both", "worse"}
        Direction of the motion: as recorded, reversed, each record twice, or of both runs the one
        that is worse for the block. A symmetric block at rest does not distinguish them. 1, -1 and [-1, 1] are allowed, too.
        Default: "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`.
        Default: "full".
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration of slender blocks, as for `Block.system`. Default: "tangent".
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    IncrementalDynamicAnalysis
        `.dataset`, `.fractiles()` and `.scatter`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`, or if `angle` is an array.

    See Also
    --------
    fragility : Probability of overturning over the level.
    rocking_spectrum : Blocks of many sizes.
    rocking.plot.incremental_dynamic_analysis : Plot the curves.

    References
    ----------
    Vamvatsikos & Cornell, Earthquake Eng. Struct. Dyn. 31, 491–514 (2002).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(6, seed=1)
    >>> result = rk.incremental_dynamic_analysis(records, rk.Block(2.0, 0.5), np.linspace(0.5, 3, 6))
    >>> result.dataset.peak.dims, result.fractiles().dims
    (('record', 'level'), ('fractile', 'level'))
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
    data = run_survey(spec, ending(TITLE), store, executor, progress=progress, repair=repair)
    return IncrementalDynamicAnalysis(of_block(data, spec, chosen, block), spec.own_units(block))


def block_spec(
    records: RecordSet,
    block: Block,
    levels: Any,
    intensity: str,
    *,
    angle: float = 0.0,
    polarity: Any = 1.0,
    model: str = "full",
    normalised_by: str | None = None,
    one_level: bool = False,
) -> MotionSpec:
    """Return the survey of one block over records and levels; TypeError or ValueError if an argument is invalid.

    With ``one_level``, a single level is allowed. It is not an axis of the survey.
    """
    check_one_block(block, levels, angle)
    if one_level and len(levels) == 1 and not is_axis(only := next(iter(levels))):
        levels = only
    return motion_spec(
        records,
        {
            "size": block.radius,
            "slenderness": block.critical_angle,
            "restitution": block.restitution,
            "angle": angle,
            "polarity": polarity,
            "level": levels,
            **left_quantities(block.left),
            **restrainer_quantities(block, model),
        },
        intensity=intensity,
        inertia_ratio=block.inertia_ratio,
        model=model,
        normalised_by=normalised_by,
        one_run=one_level,
        law=block.law,
    )


def with_polarity(records: RecordSet, polarity: Any) -> tuple[RecordSet, Any]:
    """Return records and a polarity for a survey without an axis of it: both polarities are each record and its reverse."""
    checked = checked_polarity(polarity)
    return (both_ways(records), 1.0) if isinstance(checked, np.ndarray) else (records, checked)


def of_block(data: xr.Dataset, spec: MotionSpec, records: RecordSet, block: Block) -> xr.Dataset:
    """Return a dataset that always has the dimensions `record` and `level`, with the names of the records and the block."""
    if "record" not in data.dims:
        data = data.expand_dims(record=1)
    if "level" not in data.dims:
        level = "level", [data.attrs["level"]], spec.coordinate("level")
        kept = {name: value for name, value in data.attrs.items() if name != "level"}
        data = data.expand_dims(level=1, axis=-1).assign_coords(level=level)
        data.attrs = kept
    return with_names(data, records).assign_attrs(block_attributes(block))


def with_names(data: xr.Dataset, records: RecordSet) -> xr.Dataset:
    """Return a dataset with the numbers of its records as integers, and their names."""
    number = "record", np.arange(len(records)), {"long_name": "number of the record, from 0"}
    return data.assign_coords(record=number, name=("record", list(records.names), {"long_name": "record"}))
