"""Sentences of the page: the answers on a block, what rests on an assumption, and the methods."""

from __future__ import annotations

import math
import platform
from collections.abc import Iterator
from functools import partial

import numpy as np

from rocking.assessment.assess import SA_DAMPING, Assessment
from rocking.assessment.shown import number, rate_text, unit_of
from rocking.model.hazard import NOTABLE, OverturningRate
from rocking.model.package import VERSION
from rocking.model.record_results import LognormalFit
from rocking.model.text import counted, percent, percent_with_ends

NO_FRICTION = (
    "The fragility, the overturning levels, the sensitivity and the annual rate do not consider friction."
)
AGAINST_A_WALL = (
    "It stands against a wall on the side θ < 0: an impact there reverses the angular velocity and multiplies it by e_w. Friction at the "
    "wall is neglected."
)
SPREADS = ("height", "width", "restitution")
NO_DIRECTION = "The block is symmetric, so that the direction of the records has no effect."
DIRECTIONS = {
    "+": "The records act in the direction in which they were recorded, and not in the opposite one.",
    "-": "The records act in the direction opposite to that in which they were recorded.",
    "worse": "The records act in both directions, of which the worse one counts.",
}


def answers_of(each: Assessment) -> Iterator[str]:
    """Yield the sentences on one block."""
    data, count = each.dataset, len(each.records)
    others = int(data.other_overturned.sum())
    other = "slender" if data.attrs["model"] == "full" else "full"
    at = each.level_text
    if each.sliding_text:
        yield each.sliding_text
    slide = int(data.slides.sum())
    doubt = f"; under {slide} of the {count} it slides before, so that there is no verdict on these" * bool(
        slide
    )
    yield (
        f"{each.overturned} of {counted(count, 'record')} {at} overturn{'s' * (each.overturned == 1)} the block "
        f"({others} by the {other} model){doubt}. {direction_sentence(each)}"
    )
    level = data.attrs["level"]
    if level is not None:
        fraction = each.fragility.dataset.sel(limit=math.inf, level=level)
        ends = (float(fraction[name]) for name in ("fraction", "fraction_low", "fraction_high"))
        uncertain = f"; {uncertain_text(each)}" * bool(uncertain_text(each))
        yield f"Probability of overturning {at}: {percent_with_ends(*ends)}, with its 95 % interval{uncertain}."
    yield fit_sentence(each.fragility.fits[-1], unit_of(each))
    if each.rate is not None:
        years = each.dataset.attrs["years"]
        rate = (
            f"At the site: annual rate of overturning {rate_text(each.rate)}; probability in {years:g} years "
            f"{each.rate.probability(years)}."
        )
        yield " ".join((rate, *rate_notes(each.rate)))
    yield friction_sentence(each)
    doubtful = int((~data.certified).sum())
    runs = each.fragility.dataset
    undecided = int((runs.certified == 0).sum())
    yield (
        f"Undecided in double precision: {doubtful} of {counted(count, 'record')} {at}, and {undecided:,} of "
        f"{counted(runs.peak.size, 'run')} of the fragility."
    )


def direction_sentence(each: Assessment) -> str:
    """Return the sentence on the direction of the records."""
    return DIRECTIONS[each.dataset.attrs["polarity"]] if each.block.left is not None else NO_DIRECTION


def fit_sentence(fit: LognormalFit, unit: str) -> str:
    """Return the sentence on the median of the overturning level."""
    if fit.problem:
        return f"Median of the overturning level: not determined by these records and levels ({fit.problem})."
    end = partial(number, digits=3)
    return (
        f"Half of the rocking records overturn the block at {end(fit.median)}{unit} ({end(fit.median_low)}–{end(fit.median_high)}"
        f"{unit}); dispersion {end(fit.dispersion)} ({end(fit.dispersion_low)}–{end(fit.dispersion_high)})."
    )


def friction_sentence(each: Assessment) -> str:
    """Return the sentence on the friction that the motions need."""
    data = each.dataset
    known = data.friction.values[~np.isnan(data.friction.values)]
    if not known.size:
        return "The friction that the motions need was not assessed."
    missing = data.friction.size - known.size
    but = f" ({missing} of {data.friction.size} not assessed)" * bool(missing)
    wall = ", apart from the impacts against the wall" * (each.block.wall is not None)
    needed = f"The motions {each.level_text} need a coefficient of friction up to {number(float(known.max()))}{wall}{but}"
    available = data.attrs["friction_available"]
    if available is None:
        return f"{needed}; none is stated, so that sliding is not judged."
    slides = int(data.slides.sum())
    if not slides:
        which = "of these" if missing else f"record {each.level_text}"
        return (
            f"{needed}; {available:g} is available, so that no {which} makes the block slide. {NO_FRICTION}"
        )
    return (
        f"{needed}; {available:g} is available. Under {counted(slides, 'record')} the block slides before it moves as computed: "
        f"no verdict on these. {NO_FRICTION}"
    )


def uncertain_text(each: Assessment) -> str:
    """Return words on what is uncertain in the block of the fragility; empty if nothing is."""
    attributes = each.fragility.dataset.attrs
    names = [name for name in SPREADS if attributes.get(f"{name}_spread")]
    if not names:
        return ""
    spreads = " and ".join(f"{name} (spread {attributes[f'{name}_spread']:g})" for name in names)
    return f"the block is uncertain in it, in its {spreads}, while the rows are those of the block as stated"


def rate_notes(rate: OverturningRate) -> Iterator[str]:
    """Yield sentences on the part of a rate that rests on an assumption."""
    for name, where in (
        ("share_below", "levels below the table of the hazard, where its first slope continues"),
        ("share_above", "levels above the table of the hazard, where its last slope continues"),
        ("share_untested", "levels outside those of the fragility, where the fit is an assumption"),
    ):
        share = float(rate.dataset[name])
        if share > NOTABLE:
            yield f"{percent(share)} of the rate is from {where}."


def methods(each: Assessment) -> Iterator[str]:
    """Yield sentences on versions, methods and the records."""
    data = each.dataset.attrs
    equation = {
        "full": "the full equation of motion, without small angles",
        "slender": "the equation for small angles, with the base acceleration in units of g tan θcr",
    }[data["model"]]
    yield f"Computed with rocking {VERSION} on Python {platform.python_version()} and NumPy {np.__version__}."
    yield (
        f"The block is rigid, stands on a rigid base, and follows {equation}; it neither slides nor bounces. An impact at the base "
        "multiplies the angular velocity by e. Between its samples the acceleration of a record is linear, and 0 after its end. Each "
        "impact is located with a proof; each motion is followed until the block rests for good or overturning is certain."
    )
    yield (
        f"“Certified”: the estimated rounding error cannot change the verdict. Fragility: {data['runs']}; intervals at 95 %, "
        "clustered by record (bootstrap, and Wilson's interval); the fit, by maximum likelihood, is the fraction of the runs that rock "
        "times a lognormal function; seed "
        f"{each.fragility.dataset.attrs['seed']}. Sa is the pseudo-acceleration at {100 * SA_DAMPING:g} % damping."
    )
    yield (
        f"Records: {counted(len(each.records), 'motion')}, SHA-256 of samples, steps and factors {data['records_sha256']}."
    )


def of_the_block(each: Assessment, name: str) -> str:
    """Return the sentences on the digest of a block, its wall, and the direction of the records."""
    attributes = each.dataset.attrs
    wall = f" {AGAINST_A_WALL}" * (each.block.wall is not None)
    return (
        f"{name}: SHA-256 of sizes, inertia and restitution {attributes['block_sha256']}.{wall} "
        f"{direction_sentence(each)}"
    )
