"""Sensitivity of verdicts: small changes of amplitude, start and restitution that reverse the verdict."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import evolve

from rocking.model.block import Block
from rocking.model.ground_motion import GroundMotion
from rocking.model.progress import Bar
from rocking.model.record_results import Sensitivity
from rocking.model.record_set import RecordSet, record_set
from rocking.model.validation import Refusal, instance, refuse_if, whole
from rocking.survey.ending_measures import OVERTURNED, UNDECIDED, ending
from rocking.survey.fragility_curve import clustered_fractions, two_level_weights
from rocking.survey.incremental_dynamic_analysis import block_spec, of_block
from rocking.survey.random_points import MAX_SEED, fingerprints
from rocking.survey.run_survey import run_survey

if TYPE_CHECKING:
    import xarray as xr

    from rocking.survey.spec import MotionSpec

TITLE = "Sensitivity of the verdicts of a free-standing block under ground motions"
AMPLITUDE, RESTITUTION = 0.01, 0.02
REPLICATES = 1000
CHANGES = 5
NONE = "none"


def sensitivity(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "scale",
    model: str = "slender",
    seed: int = 0,
    executor: Executor | None = None,
    progress: bool = False,
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
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`. With "full", `certified` is not assessed.
        Default: "slender".
    seed : int
        Random seed of the bootstrap of the intervals, in [0, 2³² − 1]. Default: 0.
    executor, progress
        As in `parametric_map`.

    Returns
    -------
    Sensitivity
        `.dataset`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or lies outside its range.

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
    random = np.random.default_rng(whole("seed", seed, 0, MAX_SEED))
    instance("block", block, Block)
    refuse_if(
        not RESTITUTION <= block.restitution <= 1.0 - RESTITUTION,
        "block",
        f"have a restitution in [{RESTITUTION}, {1.0 - RESTITUTION}]",
        block.restitution,
    )
    spec = block_spec(chosen, block, levels, intensity, model=model)
    runs: dict[str, xr.Dataset] = {}
    with Bar(CHANGES + 1, "changes", shown=instance("progress", progress, bool)) as bar:
        for name, changed in _changes(spec, chosen):
            data = run_survey(changed, ending(TITLE, with_peak=False), None, executor)
            runs[name] = of_block(data, changed, chosen, block).transpose("record", "level")
            bar.advance(1)
    return _summed_up(runs, order, random, block)


def _changes(spec: MotionSpec, records: RecordSet) -> Iterator[tuple[str, MotionSpec]]:
    """Yield the survey itself and each change of it, by name."""
    yield NONE, spec
    for sign, factor in (("+", 1.0 + AMPLITUDE), ("−", 1.0 - AMPLITUDE)):
        levels = spec.axes["level"] * factor**spec.measure.power
        yield f"amplitude {sign} 1 %", evolve(spec, axes=spec.axes | {"level": levels})
    yield "start + ½ step", evolve(spec, motions=dict(enumerate(map(_between, records))))
    for sign, change in (("+", RESTITUTION), ("−", -RESTITUTION)):
        fixed = spec.fixed | {"restitution": spec.fixed["restitution"] + change}
        yield f"e {sign} {RESTITUTION}", evolve(spec, fixed=fixed)


def _between(motion: GroundMotion) -> GroundMotion:
    """Return the motion sampled half a step later."""
    values = motion.acceleration
    if values.size < 2:
        raise Refusal("records", "have two samples at least", values.tolist())
    return GroundMotion(0.5 * (values[1:] + values[:-1]), step=motion.step, name=motion.name)


def _summed_up(
    runs: dict[str, xr.Dataset], order: np.ndarray, random: np.random.Generator, block: Block
) -> Sensitivity:
    import xarray as xr

    unchanged, names = runs[NONE], [name for name in runs if name != NONE]
    fell = {name: each.outcome.values == OVERTURNED for name, each in runs.items()}
    differs = np.stack([fell[name] != fell[NONE] for name in names], axis=-1)
    sure = {name: each.certified.values != UNDECIDED for name, each in runs.items()}
    doubtful = np.stack([~(sure[name] & sure[NONE]) for name in names], axis=-1)
    weights = np.broadcast_to(
        two_level_weights(len(order), 1, REPLICATES, random), (REPLICATES, *differs.shape[:2])
    )
    shares = clustered_fractions(differs[order], weights, doubtful[order])
    columns: dict[str, tuple[Any, str]] = {
        "share": (shares.value, "fraction of the runs whose verdict differs"),
        "share_low": (shares.low, "lower end of the 95 % interval"),
        "share_high": (shares.high, "upper end of the 95 % interval"),
        "flipped": (differs.sum(axis=(0, 1)), "number of runs whose verdict differs"),
        "runs": (np.full(len(names), fell[NONE].size), "number of runs"),
        "undecided": (
            doubtful.sum(axis=(0, 1)),
            "number of runs that are not certified, with or without the change",
        ),
    }
    variables: dict[str, Any] = {
        name: ("change", values, {"long_name": text, "units": "1"})
        for name, (values, text) in columns.items()
    }
    over = ("record", "level")
    variables["overturned"] = (over, fell[NONE], {"long_name": "whether the unchanged block overturns"})
    variables["differs"] = ((*over, "change"), differs, {"long_name": "whether the verdict differs"})
    coordinates = {"change": names} | {name: unchanged[name] for name in ("record", "level", "name")}
    kept = {name: value for name, value in unchanged.attrs.items() if name != "with_peak"}
    return Sensitivity(xr.Dataset(variables, coordinates, kept), block)
