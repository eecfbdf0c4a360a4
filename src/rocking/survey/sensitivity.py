"""Sensitivity of verdicts: small changes of amplitude, start and restitution that reverse the verdict."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking.model.block import Block
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_results import Sensitivity
from rocking.model.record_set import RecordSet, record_set
from rocking.model.restitution import check_uniform
from rocking.model.validation import Refusal, instance, refuse_if
from rocking.survey.ending_measures import OVERTURNED, UNDECIDED, ending
from rocking.survey.engine import Engine
from rocking.survey.fragility_curve import clustered_fractions, two_level_weights
from rocking.survey.incremental_dynamic_analysis import block_spec, of_block
from rocking.survey.random_points import fingerprints, generator
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import MotionSpec, Runs, Values

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Sensitivity of the verdicts of a free-standing block under ground motions"
AMPLITUDE, RESTITUTION = 0.01, 0.02
REPLICATES = 1000
CHANGES = ("amplitude + 1 %", "amplitude − 1 %", "start + ½ step", f"e + {RESTITUTION}", f"e − {RESTITUTION}")
"""Names of the changes, which have the numbers 1 to 5; 0 is no change."""
FACTORS = (1.0, 1.0 + AMPLITUDE, 1.0 - AMPLITUDE, 1.0, 1.0, 1.0)
RISES = np.array([0.0, 0.0, 0.0, 0.0, RESTITUTION, -RESTITUTION])
"""Factor of the amplitude, and change of the restitution, of each number."""
LATER = 3
"""Number of the change of the start."""


def sensitivity(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "scale",
    polarity: Any = "+",
    model: str = "full",
    normalised_by: str | None = None,
    seed: int = 0,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> Sensitivity:
    """Estimate the fraction of verdicts that change if the amplitude, the start or the restitution changes slightly.

    A verdict is whether the block overturns. Every run is repeated with five changes:

    - the amplitude times 1.01 and 0.99;
    - sampling half a step later: the samples are (a_k + a_{k+1})/2 with the same step, which also cuts the peaks;
    - e + 0.02 and e − 0.02.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions of two samples or more. None may be a copy of another.
    block : Block
        Block, with a restitution in [0.02, 0.98].
    levels : array (n,)
        Levels of the intensity measure, ascending, two at least.
    intensity : str
        Intensity measure of the levels, as in `rocking_spectrum`. Default: "scale", the factor of each record.
    polarity : {"+", "-", "both", "worse"}
        Direction of the motions, as in `rocking_spectrum`; with "both" each record has two runs. Default: "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`.
        Default: "full".
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration of slender blocks, as for `Block.system`. Default: "tangent".
    seed : int
        Random seed of the bootstrap of the intervals, in [0, 2³² − 1]. Default: 0.
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    Sensitivity
        `.dataset`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`, or if a record has less than two samples.

    See Also
    --------
    fragility : Probability of overturning over the level.
    repeatability : Outcomes under uncertain inputs, on a harmonic base motion.

    Notes
    -----
    The factor of a motion is that of the unchanged record. The intervals at 95 % are clustered by record, as in `fragility`.
    A pair of runs of which one is undecided in double precision may or may not differ: the interval covers both.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> result = rk.sensitivity(rk.synthetic_ground_motions(8, seed=1), rk.Block(2.0, 0.5), np.linspace(1, 3, 5))
    >>> result.dataset.change.values.tolist()
    ['amplitude + 1 %', 'amplitude − 1 %', 'start + ½ step', 'e + 0.02', 'e − 0.02']
    """
    chosen = record_set(records)
    order = np.argsort(fingerprints(chosen))
    random = generator(seed)
    check_uniform(instance("block", block, Block).law.rows, "a sensitivity, which changes it")
    for restitution in (block.restitution, block.left_restitution):
        refuse_if(
            not RESTITUTION <= restitution <= 1.0 - RESTITUTION,
            "block",
            f"have a restitution in [{RESTITUTION}, {1.0 - RESTITUTION}]",
            restitution,
        )
    for motion in chosen:
        if motion.acceleration.size < 2:
            raise Refusal("records", "have two samples at least", motion.acceleration.tolist())
    how = {"polarity": polarity, "model": model, "normalised_by": normalised_by}
    unchanged = block_spec(chosen, block, levels, intensity, **how)
    # runs of one record and change are neighbours, which share tables
    spec = unchanged.extended(ChangedMotionSpec, {"change": np.arange(1.0 + len(CHANGES))})
    measure = ending(TITLE, with_peak=False)
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair)
    block = spec.own_units(block)
    return _summed_up(of_block(data, spec, chosen, block).load(), order, random, block)


class ChangedMotionSpec(MotionSpec):
    """Survey of ground motions with a further axis `change`, the number of a small change of a run."""

    numbers: ClassVar[dict[str, str]] = MotionSpec.numbers | {"change": "number of the change; 0: none"}

    def inputs(self, values: Values) -> Runs:
        """Return the runs at n points; the motions of a later start have negative numbers."""
        varied = dict(values)
        change = varied.pop("change").astype(int)
        varied["level"] = varied["level"] * np.array([each**self.measure.power for each in FACTORS])[change]
        for name in ("restitution", "left_restitution"):
            if name in self.fixed:
                varied[name] = self.fixed[name] + RISES[change]
        runs = super().inputs(varied)
        later = change == LATER
        moved = {~number: _between(self.motions[number]) for number in np.unique(runs.record[later]).tolist()}
        return runs._replace(
            motions={**runs.motions, **moved}, record=np.where(later, ~runs.record, runs.record)
        )


def _between(motion: GroundMotion) -> GroundMotion:
    """Return the motion sampled half a step later."""
    values = motion.acceleration
    return GroundMotion(0.5 * (values[1:] + values[:-1]), step=motion.step, name=motion.name)


def _summed_up(runs: xr.Dataset, order: np.ndarray, random: np.random.Generator, block: Block) -> Sensitivity:
    import xarray as xr

    over = ("record", *(("polarity",) * ("polarity" in runs.dims)), "level")
    runs = runs.transpose(*over, "change")
    fell, sure = runs.outcome.values == OVERTURNED, runs.certified.values != UNDECIDED
    unchanged = fell[..., 0]
    differs = fell[..., 1:] != fell[..., :1]
    doubtful = ~(sure[..., 1:] & sure[..., :1])
    weights = np.broadcast_to(
        two_level_weights(len(order), 1, REPLICATES, random),
        (REPLICATES, len(order), unchanged.size // len(order)),
    )
    each = (len(order), -1, len(CHANGES))
    shares = clustered_fractions(
        differs[order].reshape(each), weights, np.broadcast_to(doubtful, differs.shape)[order].reshape(each)
    )
    columns: dict[str, tuple[Any, str]] = {
        **shares.columns("share", "fraction of the runs whose verdict differs"),
        "flipped": (differs.reshape(-1, len(CHANGES)).sum(axis=0), "number of runs whose verdict differs"),
        "runs": (np.full(len(CHANGES), unchanged.size), "number of runs"),
        "undecided": (
            doubtful.reshape(-1, len(CHANGES)).sum(axis=0),
            "number of runs that are not certified, with or without the change",
        ),
    }
    variables: dict[str, Any] = {
        name: ("change", values, {"long_name": text, "units": "1"})
        for name, (values, text) in columns.items()
    }
    variables["overturned"] = (over, unchanged, {"long_name": "whether the unchanged block overturns"})
    variables["differs"] = ((*over, "change"), differs, {"long_name": "whether the verdict differs"})
    coordinates = {"change": list(CHANGES)} | {name: runs[name] for name in (*over, "name")}
    kept = {name: value for name, value in runs.attrs.items() if name != "with_peak"}
    return Sensitivity(xr.Dataset(variables, coordinates, kept), block)
