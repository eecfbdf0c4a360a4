"""Assessment of a block under a set of records: all results that a report on it needs, with one call."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block, block_attributes, unrestrained
from rocking.model.forcing import BaseMotion
from rocking.model.ground_motion import GroundMotion
from rocking.model.hazard import MAX_YEARS, OverturningRate
from rocking.model.package import VERSION
from rocking.model.progress import Bar
from rocking.model.record_results import Fragility, OverturningSet, Sensitivity, few_records, runs_of
from rocking.model.record_set import RecordSet, intensity_of, record_set
from rocking.model.result import Result, along
from rocking.model.system import MODELS
from rocking.model.tables_and_json import json_text
from rocking.model.text import counted
from rocking.model.validation import (
    Refusal,
    TooManyEvents,
    TooShort,
    instance,
    one_of,
    reals,
    refuse_if,
    within,
)
from rocking.model.verdict import Outcome
from rocking.motion.model_warnings import block_warnings
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.motion.validity import by_other_equation
from rocking.survey.fragility import fragility
from rocking.survey.overturning_rate import hazard_curve, overturning_rate
from rocking.survey.overturning_set import overturning_set
from rocking.survey.sensitivity import sensitivity
from rocking.theory.design_rules import DAMPINGS, design_angle, ishiyama_levels

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Assessment of a free-standing block under ground motions"
MAX_FRICTION = 10.0
LARGE_FACTOR = 10
"""Factor of a record from which the page names it."""
SA_PERIODS, SA_DAMPING = (0.01, 10.0), 0.05
SURVEYS, ROWS_PER_SURVEY = 3, 0.2
"""Surveys of an assessment, and the cost of one per record, in that of a row."""
UNCERTAIN = ("samples", "height_spread", "width_spread", "restitution_spread")
"""Arguments of `fragility` for an uncertain block."""
COLUMN = "column_"
"""Prefix of the variables that hold the columns of the records."""
ROW = {
    "factor": "factor of the record",
    "pga": ("peak ground acceleration", "m/s²"),
    "pgv": ("peak ground velocity", "m/s"),
    "sa": ("pseudo-acceleration at the period of the attribute sa_period_s and 5 % damping", "m/s²"),
    "outcome": "end of the motion",
    "overturned": "whether the block overturns",
    "certified": "whether no rounding error can have changed the outcome",
    "peak": "largest absolute angle in units of theta_cr; infinite if the block overturns",
    "top_displacement": ("largest displacement of the top of the block; NaN if it overturns", "m"),
    "margin": "margin of the closest lift-off or impact in units of alpha theta_cr; NaN if there is none, as of a block at rest",
    "friction": "smallest coefficient of friction without sliding, of both directions if both count; NaN if it was not assessed",
    "slides": "whether the friction does not suffice",
    "other_overturned": "whether the block overturns by the other equation of motion",
    "other_peak": "largest absolute angle by the other equation in units of theta_cr; NaN if there is none",
    **{
        rule: f"largest absolute angle by the design rule of {name} in units of theta_cr; NaN if it has no result"
        for rule, name in zip(("fema_356", "priestley"), ("FEMA 356", "Priestley"), strict=True)
    },
    "ishiyama": "whether PGA and PGV exceed the levels of Ishiyama's rule; False for a block with unequal sides or against a wall",
}
"""Variables over `record`: description, and unit if it is in SI."""


@frozen(eq=False)
class Assessment(Result):
    """Assessment of one block under a set of records; returned by `assess`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `record`: the intensities `pga`, `pgv` and `sa`, the columns of the records with the prefix ``column_``, and
        what the block does. These are `outcome`, `overturned`, `certified`, `peak`, `top_displacement`, `margin` and `friction`;
        `other_overturned` and `other_peak` by the other equation of motion; `fema_356`, `priestley` and `ishiyama` by design rules.
    block : Block
        Block.
    records : RecordSet
        Ground motions as they are.
    fragility : Fragility
        Probability of overturning over the levels.
    overturning_set : OverturningSet
        Levels at which each record overturns the block.
    sensitivity : Sensitivity or None
        Verdicts that small changes reverse. None if the block or the records do not admit the changes; `notes` says why.
    rate : OverturningRate or None
        Annual rate of overturning. None without a hazard, or if the records do not determine a fit; `notes` then says so.
    name : str
        Name of the block.
    notes : tuple of str
        Sentences on what a reader must know.

    Notes
    -----
    `to_dict` holds the name, the attributes and the rows of the records. It also holds `fragility`, `overturning_set`, `sensitivity`,
    `rate` and `notes`.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(5, seed=1)
    >>> result = rk.assess(records, rk.Block(2.0, 0.5), [2.0, 4.0, 6.0], intensity="pga", level=4.0)
    >>> result.to_dataframe().columns[:4].tolist()
    ['record', 'name', 'factor', 'pga [m/s²]']
    """

    dataset: xr.Dataset = field(repr=False)
    block: Block
    records: RecordSet = field(repr=False)
    fragility: Fragility = field(repr=False)
    overturning_set: OverturningSet = field(repr=False)
    sensitivity: Sensitivity | None = field(repr=False)
    rate: OverturningRate | None = field(repr=False)
    name: str = ""
    notes: tuple[str, ...] = ()

    def to_dict(self, *, units: str | None = None, block: Any = None) -> dict[str, Any]:  # noqa: D102
        # The docstring is that of `Result.to_dict`.
        parts: dict[str, Result | None] = {
            "fragility": self.fragility,
            "overturning_set": self.overturning_set,
            "sensitivity": self.sensitivity,
            "rate": self.rate,
        }
        own = Result.to_dict(self, units=units, block=block)
        return {"name": self.name} | own | {
            name: part and part.to_dict(units=units, block=block) for name, part in parts.items()
        } | {"notes": list(self.notes)}  # fmt: skip

    @property
    def overturned(self) -> int:
        """Number of the records, at the level of the rows, that overturn the block."""
        return int(self.dataset.overturned.sum())

    @property
    def level_text(self) -> str:
        """Level of the rows in words, such as "at PGA = 0.4 g" or "as recorded"."""
        level, measure = self.dataset.attrs["level"], self.overturning_set.measure
        if level is None:
            return "as recorded"
        return f"at {measure.symbol} = {level:g} {'' if measure.unit == '1' else measure.unit}".rstrip()

    @property
    def sliding_text(self) -> str:
        """Sentence on a block that slides and never rocks, because its friction is at most tan θcr; empty for any other block."""
        friction = self.dataset.attrs["friction_available"]
        sides = self.block.critical_angles if self.block.wall is None else (self.block.critical_angle,)
        least = math.tan(min(sides))
        if friction is None or friction > least:
            return ""
        return (
            f"With this friction, {friction:g}, the block slides and does not rock, because tan θcr = {least:.3g} is not less: there is "
            "no verdict, and all that follows is for a block that does not slide."
        )

    def __str__(self) -> str:
        name = f"{self.name}: " * bool(self.name)
        if self.sliding_text:
            name += f"{self.sliding_text} "
        slide = int(self.dataset.slides.sum())
        fell = f"{self.overturned} of {counted(len(self.records), 'record')} {self.level_text} overturn the block"
        doubt = f", {slide} of all make it slide before: no verdict on these" * bool(slide)
        return f"{name}{fell}{doubt}; {self.fragility}"


def assess(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block,
    levels: Any,
    *,
    intensity: str = "pga-g",
    level: float | None = None,
    limits: Any = (),
    friction: float | None = None,
    hazard: Any = None,
    years: float = 50.0,
    sa_period: float = 1.0,
    polarity: Any = None,
    model: str = "full",
    seed: int = 0,
    name: str = "",
    uncertain: Mapping[str, Any] | None = None,
    progress: bool = False,
) -> Assessment:
    """Compute all that a report on a block under a set of records needs.

    Each record, as it is or scaled to one level, is followed by both equations of motion. Over all levels follow the fragility, the
    overturning set and the sensitivity of the verdicts.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions, one horizontal component of each earthquake.
    block : Block
        Block, initially at rest.
    levels : array (n,)
        Levels of the intensity measure, ascending, two at least.
    intensity : str
        Intensity measure of the levels, as in `rocking_spectrum`. Default: "pga-g", in g.
    level : float, optional
        Level to which the records are scaled for the rows, which is added to `levels`. Default: the records as they are.
    limits : float or array (k,)
        Limits of |Θ| of the fragility besides overturning, in units of θcr. Default: none.
    friction : float, optional
        Coefficient of friction at the base, in [0, 10]. A motion that needs more is marked in `slides`: it is no verdict on the block.
        Default: not known.
    hazard : pair of arrays, mapping, or path, optional
        Annual rates of exceedance of the levels at the site, as in `overturning_rate`. Default: not known.
    years : float
        Time in years for the probability of overturning, in (0, 10⁶]. Default: 50.
    sa_period : float
        Period in s of the pseudo-acceleration of each record, at 5 % damping, in [0.01, 10]. Default: 1.
    polarity : {"+", "-", "worse"}, optional
        Direction of the records, as in `rocking_spectrum`. Default: "worse" for a block with unequal sides or against a wall, else
        "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`; the rows state both. Default: "full".
    seed : int
        Random seed of the intervals, as in `fragility`. Default: 0.
    name : str
        Name of the block on the page. Default: "".
    uncertain : mapping, optional
        Arguments of `fragility` for an uncertain block: `samples`, `height_spread`, `width_spread`, `restitution_spread`.
        Default: none.
    progress : bool
        Show the progress on stderr. Default: False.

    Returns
    -------
    Assessment
        `.dataset`, `.fragility`, `.overturning_set` and `.sensitivity`; `print` shows one sentence.

    Raises
    ------
    TypeError, ValueError
        As in `fragility`, `overturning_set` and `overturning_rate`, or if a value is of the wrong type or lies outside its range.

    See Also
    --------
    fragility : Probability of overturning over the level.
    overturning_set : Levels that overturn the block.
    overturning_rate : Annual rate of overturning.
    sensitivity : Verdicts that small changes reverse.

    Notes
    -----
    The friction is the largest |H|/N of a motion up to its end, or up to the instant from which overturning is certain, as in
    `Motion.validity`; with both directions it is that of the one that needs more. The fragility, the overturning set, the
    sensitivity and the rate do not consider friction. The design rules are those of `theory.design_angle` and
    `theory.ishiyama_levels`. They take symmetric blocks only. Against a wall
    the friction of the impacts is not assessed.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(5, seed=1)
    >>> result = rk.assess(records, rk.Block(2.0, 0.5), [0.2, 0.4, 0.6], level=0.4)
    >>> result.overturned, result.dataset.certified.values.all().item()
    (0, True)
    """
    chosen = record_set(records)
    unrestrained(
        instance("block", block, Block), "block", "an assessment needs the base reactions of a free block"
    )
    instance("name", name, str)
    instance("progress", progress, bool)
    one_of("model", model, MODELS)
    of_fragility = _checked_uncertain(uncertain)
    measure, _ = intensity_of(intensity, chosen)
    grid = np.atleast_1d(reals("levels", levels))
    refuse_if(grid.size == 0, "levels", "hold two levels at least", levels)
    if level is not None:
        grid = with_level(grid, level)
    if friction is not None:
        friction = checked_friction(friction)
    period, years = checked_period(sa_period), checked_years(years)
    if hazard is not None:
        hazard_curve(hazard, measure.unit)
    if polarity is None:
        polarity = "+" if block.left is None else "worse"
    refuse_if(
        not isinstance(polarity, str) or polarity not in ("+", "-", "worse"),
        "polarity",
        'be "+", "-" or "worse"',
        polarity,
    )
    how = {"intensity": intensity, "polarity": polarity, "model": model}
    of_block = block_warnings(
        block, (), block.restitution, left_restitution=block.left_restitution, full=model == "full"
    )
    scaled = scaling_note(
        chosen.names, _factors(chosen, intensity, float(grid.max() if level is None else level), block)
    )
    notes = [*few_records(len(chosen)), *scaled, *of_block]
    part = ROWS_PER_SURVEY * len(chosen)
    with Bar(SURVEYS * part + len(chosen), "assessing", shown=progress) as bar:
        curves = fragility(chosen, block, grid, limits=limits, seed=seed, **how, **of_fragility)
        bar.advance(part)
        bands = overturning_set(chosen, block, grid, **how)
        bar.advance(part)
        try:
            changed = sensitivity(chosen, block, grid, seed=seed, **how)
        except Refusal as error:
            changed = None
            notes.append(f"the sensitivity to small changes was not computed: {error}")
        bar.advance(part)
        rate = None
        if hazard is not None:
            try:
                rate = overturning_rate(curves, hazard, seed=seed)
            except TooShort as error:
                notes.append(f"the annual rate was not computed: {error}")
        rows = []
        for motion in _scaled(chosen, bands, level, block):
            rows.append(_row(motion, block, polarity, model, friction, period))
            bar.advance(1)
    data = _dataset(rows, chosen, block, curves).assign_attrs(
        level=level,
        intensity=intensity,
        unit=measure.unit or "1",
        sa_period_s=period,
        years=years,
        friction_available=friction,
        model=model,
        polarity=polarity,
    )
    return Assessment(data, block, chosen, curves, bands, changed, rate, name, tuple(notes))


def _checked_uncertain(uncertain: Mapping[str, Any] | None) -> Mapping[str, Any]:
    """Return the arguments of `fragility` for an uncertain block. Their names are checked here, their values by `fragility`."""
    given: Mapping[str, Any] = {} if uncertain is None else instance("uncertain", uncertain, Mapping)
    allowed = f"hold only {', '.join(UNCERTAIN)}"
    refuse_if(any(key not in UNCERTAIN for key in given), "uncertain", allowed, given)
    return given


def with_level(levels: np.ndarray, level: float) -> np.ndarray:
    """Return levels with the level of the rows among them; Refusal for one outside their range."""
    allowed = f"lie within the levels, {levels.min():g} to {levels.max():g}"
    inside = levels.min() <= within("level", level, 0.0, 1e300) <= levels.max()
    refuse_if(not inside, "level", allowed, level)
    return np.union1d(levels, [level])


def checked_friction(friction: float) -> float:
    """Return a coefficient of friction as a float; Refusal outside [0, 10]."""
    return within("friction", friction, 0.0, MAX_FRICTION)


def checked_period(period: float) -> float:
    """Return the period of a pseudo-acceleration as a float; Refusal outside [0.01, 10] s."""
    return within("sa_period", period, *SA_PERIODS, "s")


def checked_years(years: float) -> float:
    """Return a time in years as a float; Refusal outside its range."""
    return within("years", years, 1e-9, MAX_YEARS)


def block_digest(block: Block) -> str:
    """Return the SHA-256 digest of what determines the motion of a block: sizes, inertia and restitution.

    Examples
    --------
    >>> block_digest(Block(2.0, 0.5)) == block_digest(Block(2, 0.5)) != block_digest(Block(2.0, 0.6))
    True
    """
    sides = {"restitution": block.restitution, "left_restitution": block.left_restitution}
    return sha256(json_text(block_attributes(block) | sides | block.law.attributes()).encode()).hexdigest()


def _scaled(
    records: RecordSet, bands: OverturningSet, level: float | None, block: Block
) -> list[GroundMotion]:
    """Return the records as they are, or scaled to a level as the survey scales them."""
    if level is None:
        return list(records)
    factors = _factors(records, bands.dataset.attrs["intensity"], level, block)
    return [motion.scaled(factor) for motion, factor in zip(records, factors, strict=True)]


def _factors(records: RecordSet, intensity: Any, level: float, block: Block) -> list[float]:
    """Return the factors that scale the records to a level."""
    measure, values = intensity_of(intensity, records)
    alpha, slenderness = block.frequency_parameter, block.critical_angle
    return [measure.factor(level, float(value), alpha, slenderness) for value in values]


def scaling_note(names: Sequence[str], factors: Sequence[float]) -> Iterator[str]:
    """Yield a sentence on records that are scaled by large factors, if there are some.

    Examples
    --------
    >>> print(*scaling_note(["a.AT2", "b.AT2"], [2.0, 30.0]))
    1 of 2 records is scaled by more than 10 (b.AT2 by 30): so strong a motion need not look like a weak one that is scaled
    """
    large = [factor for factor in factors if factor > LARGE_FACTOR]
    if large:
        name = names[factors.index(max(large))]
        verb = "is" if len(large) == 1 else "are"
        yield (
            f"{len(large)} of {counted(len(factors), 'record')} {verb} scaled by more than {LARGE_FACTOR} ({name} by {max(large):.4g}): "
            "so strong a motion need not look like a weak one that is scaled"
        )


def _row(
    ground: GroundMotion, block: Block, polarity: str, model: str, friction: float | None, period: float
) -> dict[str, Any]:
    """Return the values of one record; with "worse" those of the direction that is worse for the block, and the friction of both."""
    directions = {"+": [ground], "-": [ground.reversed()]}.get(polarity, [ground, ground.reversed()])
    motions = [_simulated(block, each, model) for each in directions]
    motion = max(motions, key=_harm)
    fell = motion.outcome is Outcome.OVERTURNED
    needed = _friction(motions, block)
    other_fell, other_peak = _other(motion, block)
    return {
        "factor": ground.factor,
        "pga": ground.pga,
        "pgv": ground.pgv,
        "sa": ground.response_spectrum(period, SA_DAMPING),
        "outcome": str(motion.outcome),
        "overturned": fell,
        "certified": motion.certified,
        "peak": math.inf if fell else motion.peak,
        "top_displacement": math.nan if fell else abs(float(block.top_displacement(motion.peak))),
        "margin": motion.margin,
        "friction": needed,
        "slides": friction is not None and needed > friction,
        "other_overturned": other_fell,
        "other_peak": other_peak,
        **{rule.replace("-", "_"): _by_rule(ground, block, rule) for rule in DAMPINGS},
        "ishiyama": block.left is None and _exceeds(ground, ishiyama_levels(block)),
    }


def _simulated(block: Block, ground: BaseMotion, model: str) -> Motion:
    """Return the motion, without its events if there are too many."""
    system = block.system(ground, model=model)
    try:
        return simulate(system)
    except TooManyEvents:
        return simulate(system, record="none")


def _harm(motion: Motion) -> tuple[bool, float]:
    return motion.outcome is Outcome.OVERTURNED, motion.peak


def _friction(motions: Iterable[Motion], block: Block) -> float:
    """Return the friction that all motions need; NaN if the events of one were not kept, or if there is nothing to assess."""
    needs = []
    for motion in motions:
        if motion.record != "all":
            return math.nan
        needed = motion.validity(block).friction
        if needed is not None:
            needs.append(needed)
    return max(needs, default=math.nan)


def _other(motion: Motion, block: Block) -> tuple[bool, float]:
    """Return whether the block overturns by the other equation, and its peak; NaN if there is none."""
    try:
        outcome, peak = by_other_equation(motion, block)
    except Refusal:
        return False, math.nan
    return outcome is Outcome.OVERTURNED, peak


def _exceeds(ground: GroundMotion, levels: tuple[float, float]) -> bool:
    """Return whether PGA and PGV of a motion exceed both levels."""
    return ground.pga > levels[0] and ground.pgv > levels[1]


def _by_rule(ground: GroundMotion, block: Block, rule: str) -> float:
    """Return the angle by a design rule; NaN if it has none, as for an unsymmetric block."""
    try:
        return design_angle(ground, block, rule)
    except Refusal:
        return math.nan


def _dataset(rows: list[dict[str, Any]], records: RecordSet, block: Block, curves: Fragility) -> xr.Dataset:
    """Return the rows as a dataset over `record`."""
    import xarray as xr

    columns: dict[str, tuple[Any, ...]] = {}
    for name, text in ROW.items():
        described = (text,) if isinstance(text, str) else text
        columns[name] = ([row[name] for row in rows], *described)
    columns |= {
        f"{COLUMN}{name}": (values, f"column {name!r} of the records")
        for name, values in records.columns.items()
    }
    data = xr.Dataset(
        along("record", columns),
        attrs={"Conventions": "CF-1.11", "title": TITLE, "source": f"rocking {VERSION}"},
    )
    names = "record", list(records.names), {"long_name": "record"}
    data = data.assign_coords(record=np.arange(len(records)), name=names)
    return data.assign_attrs(
        records_sha256=records.digest, block_sha256=block_digest(block), runs=runs_of(curves.dataset)
    )
