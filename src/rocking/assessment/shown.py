"""Tables of the page: rows of texts, with angles in degrees and lengths in mm, and the forms of their numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from rocking.assessment.assess import COLUMN, Assessment
from rocking.assessment.drawing import millimetres
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.hazard import OverturningRate
from rocking.model.record_results import LognormalFit, limit_name
from rocking.model.text import percent, percent_with_ends
from rocking.theory.design_rules import ishiyama_levels

DIGITS_OF_DIGEST = 16

LONG = 20
"""Number of rows up to which a table is printed on one sheet, and rules are shown for each record."""
MAX_LEVELS = 16
"""Largest number of levels in the table of the fragility, besides the level of the rows."""

NO_SLIDING = "sliding is not considered"

MAX_BANDS = 4
"""Largest number of intervals of a record that the page lists; the tables beside it list all."""


class Shown(NamedTuple):
    """Table of the page: headings and rows of texts, the number of first columns with words, and a caption."""

    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    words: int = 1
    caption: str = ""
    marks: bool = True
    """Whether cells that tell of harm or doubt are marked."""


def number(value: float, digits: int = 3) -> str:
    """Return a number to some digits, an en dash for NaN, and the sign of infinity.

    Examples
    --------
    >>> number(0.12345), number(float("nan")), number(float("-inf")), number(123456.0)
    ('0.123', '–', '−∞', '123,000')
    >>> number(12.0), number(0.6), number(0.0), number(7)
    ('12.0', '0.600', '0', '7.00')
    """
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    rounded = float(f"{value:.{digits}g}")
    if rounded == 0.0:
        return "0"
    text = f"{rounded:,.0f}" if abs(rounded) >= 10 ** (digits - 1) else f"{rounded:#.{digits}g}"
    return text.replace("-", "−")


def short(value: float, decimals: int) -> str:
    """Return a number with some decimals, and with fewer from 10 and from 100 on.

    Examples
    --------
    >>> short(0.0267, 2), short(12.345, 2), short(416.6, 1), short(0.001, 2)
    ('0.03', '12.3', '417', '< 0.01')
    """
    if math.isnan(value):
        return "–"
    least = 10.0**-decimals
    if value == 0.0:
        return "0"
    if 0.0 < value < least:
        return f"< {least:g}"
    return f"{value:,.{max(decimals - (value >= 10) - (value >= 100), 0)}f}"


def as_given(values: Sequence[float]) -> list[str]:
    """Return the numbers of a column with the same number of decimals, two at most; an en dash for NaN.

    Examples
    --------
    >>> as_given([6.1, 6.0, float("nan")]), as_given([12.0, 8.0])
    (['6.1', '6.0', '–'], ['12', '8'])
    """
    known = [value for value in values if not math.isnan(value)]
    decimals = next((count for count in range(2) if all(round(each, count) == each for each in known)), 2)
    return ["–" if math.isnan(value) else f"{value:.{decimals}f}" for value in values]


def scientific(value: float) -> str:
    """Return a small number to three digits, with a power of ten.

    Examples
    --------
    >>> scientific(0.000123), scientific(0.0), scientific(float("inf"))
    ('1.23·10⁻⁴', '0', '∞')
    """
    if value == 0.0 or math.isinf(value):
        return number(value)
    digits, power = f"{value:.2e}".split("e")
    return f"{digits}·10{str(int(power)).translate(RAISED)}"


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def rate_text(rate: OverturningRate) -> str:
    """Return an annual rate with its interval."""
    return f"{scientific(rate.rate)} ({scientific(rate.rate_low)}–{scientific(rate.rate_high)}) per year"


def unit_of(each: Assessment) -> str:
    """Return the unit of the levels with a space before it."""
    unit = each.overturning_set.measure.unit
    return f" {unit}" if unit not in ("", "1") else ""


def symbol_of(each: Assessment, name: str = "") -> str:
    """Return the symbol of the levels, after a word, with the unit in parentheses."""
    unit = unit_of(each).strip()
    return " ".join(filter(None, (name, each.overturning_set.measure.symbol, f"({unit})" if unit else "")))


def block_table(block: Block) -> Shown:
    """Return the properties of a block."""
    both = partial(_both, block.is_unsymmetric)
    degrees = [f"{math.degrees(angle):.2f}°" for angle in block.critical_angles]
    lift = [f"{math.tan(angle):.3f} g" for angle in block.critical_angles]
    e = both([f"{each:.4g}" for each in (block.restitution, block.left_restitution)])
    restitution = (
        ("restitution e", f"{e}, {block.law}") if block.wall is None else ("restitution e_w of the wall", e)
    )
    offset = f", offset {millimetres(block.offset)}" if block.offset else ""
    rows = [
        ("height × width", f"{millimetres(block.height)} × {millimetres(block.width)}"),
        ("mass centre", f"{millimetres(block.centre_height)} above the base{offset}"),
        ("distance R of a corner from it", both([f"{radius:.4g} m" for radius in block.radii])),
        ("critical angle θcr", both(degrees)),
        ("lift-off from rest above", both(lift) + ", away from the wall" * (block.wall is not None)),
        ("frequency parameter p", both([f"{each:.4g} 1/s" for each in block.frequency_parameters])),
        restitution,
        ("Io/(MR²)", f"{block.inertia_ratio:.4g}"),
    ]
    if block.left is None:
        pga, pgv = ishiyama_levels(block)
        rows.append(("Ishiyama's rule", f"PGA > {pga / GRAVITY:.3g} g and PGV > {100 * pgv:.3g} cm/s"))
    return Shown((), rows, 2)


def _both(unequal: bool, texts: Sequence[str]) -> str:
    """Return the value of a block, or those of its two sides."""
    return f"{texts[0]} (right), {texts[1]} (left)" if unequal else texts[0]


def record_table(each: Assessment) -> Shown:
    """Return one row per record."""
    data, block = each.dataset, each.block
    columns = {
        str(name).removeprefix(COLUMN): as_given(each.values.tolist())
        for name, each in data.data_vars.items()
        if str(name).startswith(COLUMN)
    }
    full = data.attrs["model"] == "full"
    heads = (
        "record",
        *columns,
        "PGA (g)",
        "PGV (cm/s)",
        f"Sa({data.attrs['sa_period_s']:g}\N{NO-BREAK SPACE}s) (g)",
        f"{'full' if full else 'slender'} model",
        f"{'slender' if full else 'full'} model",
        "top (mm)",
        "margin (°/s)",
        "friction",
        "certified",
    )
    speed = math.degrees(block.radians_per_second(1.0))
    rows = []
    for place, name in enumerate(data.name.values.tolist()):
        of = data.isel(record=place)
        friction = number(float(of.friction))
        rows.append(
            (
                name,
                *(given[place] for given in columns.values()),
                number(float(of.pga) / GRAVITY),
                number(100 * float(of.pgv)),
                number(float(of.sa) / GRAVITY),
                *(
                    f"slides ({told})" if bool(of.slides) else told
                    for told in (
                        verdict(block, bool(of.overturned), float(of.peak)),
                        verdict(block, bool(of.other_overturned), float(of.other_peak)),
                    )
                ),
                short(1e3 * float(of.top_displacement), 1),
                number(speed * float(of.margin)),
                f"slides: {friction}" if bool(of.slides) else friction,
                "no verdict" if bool(of.slides) else "yes" if bool(of.certified) else "undecided",
            )
        )
    caption = (
        "Model: largest angle |θ|, or “overturns”. Top: largest displacement of the top. Margin: speed that the block lacked (−) or "
        "had beyond what it needed (+) to overturn, where it was closest. Where a block overturns with a negative margin, the closest "
        "decision was an earlier one. Friction: least coefficient without sliding."
    )
    if block.wall is not None:
        caption += " The impacts against the wall are left out of the friction."
    if bool(data.slides.any()):
        caption += (
            " “slides (…)”: the block slides before it moves as computed, so that there is no verdict; in the parentheses, and in the "
            "other columns, what it would do without sliding."
        )
    return Shown(heads, rows, 1, caption)


def verdict(block: Block, overturned: bool, peak: float) -> str:
    """Return what a block does in a word or an angle."""
    if overturned:
        return "overturns"
    if math.isnan(peak):
        return "–"
    return "stands still" if peak == 0.0 else f"{short(float(block.degrees(peak)), 2)}°"


def fragility_table(each: Assessment) -> Shown:
    """Return the probabilities at each level, and the fits."""
    data = each.fragility.dataset
    limits = data.limit.values.tolist()
    count, design = data.sizes["level"], each.dataset.attrs["level"]
    shown = set(np.linspace(0, count - 1, min(count, MAX_LEVELS)).round().astype(int).tolist())
    rows = []
    for place, level in enumerate(data.level.values.tolist()):
        if place not in shown and level != design:
            continue
        of = [data[name].values[:, place].tolist() for name in ("fraction", "fraction_low", "fraction_high")]
        rows.append((f"{level:.4g}", *(percent_with_ends(*ends) for ends in zip(*of, strict=True))))
    rows += [(name, *(fitted(fit, name) for fit in each.fragility.fits)) for name in ("median", "dispersion")]
    heads = [limit_heading(each.block, limit) for limit in limits]
    part = f" {len(rows) - 2} of {count} levels." if len(rows) - 2 < count else ""
    return Shown(
        (symbol_of(each), *heads),
        rows,
        1,
        f"Fractions of the records with 95 % intervals; {NO_SLIDING}.{part}",
    )


def limit_heading(block: Block, limit: float) -> str:
    """Return the event of a limit in words, with the angle in degrees."""
    return limit_name(limit) if math.isinf(limit) else f"|θ| > {number(float(block.degrees(limit)))}°"


def fitted(fit: LognormalFit, name: str) -> str:
    """Return a parameter of a fit with its interval."""
    value, low, high = (getattr(fit, f"{name}{end}") for end in ("", "_low", "_high"))
    return "not determined" if fit.problem else f"{number(value)} ({number(low)}–{number(high)})"


def span(low: float, high: float) -> str:
    """Return both ends of an interval, with as many digits as tell them apart.

    Examples
    --------
    >>> span(0.75, 1.0), span(0.899975, 0.900012)
    ('0.75–1', '0.89998–0.90001')
    """
    digits = next((count for count in range(4, 17) if f"{low:.{count}g}" != f"{high:.{count}g}"), 17)
    return f"{low:.{digits}g}–{high:.{digits}g}"


def band_table(each: Assessment) -> Shown:
    """Return the intervals of overturning levels of each record."""
    bands = each.overturning_set
    rows = []
    for place, name in enumerate(each.records.names):
        found = bands.intervals(place)
        shown = ", ".join(span(low, high) for low, high in found[:MAX_BANDS].tolist())
        rows.append(
            (
                name,
                shown + ", …" * (len(found) > MAX_BANDS) or "none",
                "none" if math.isnan(bands.lowest[place]) else f"{bands.lowest[place]:.4g}",
                percent(float(bands.share[place])),
            )
        )
    narrower = f"Intervals and gaps narrower than {number(bands.spacing)}{unit_of(each)}"
    spacing = f"{narrower} may be missed, and more levels find more of them; {NO_SLIDING}."
    heads = ("record", symbol_of(each, "overturning intervals,"), "lowest found", "share of the range")
    return Shown(heads, rows, 2, spacing)


def sensitivity_table(each: Assessment) -> Shown:
    """Return the share of the verdicts that each small change reverses."""
    assert each.sensitivity is not None
    data = each.sensitivity.dataset
    columns = (
        data[name].values.tolist()
        for name in ("change", "share", "share_low", "share_high", "flipped", "runs")
    )
    rows = [
        (change, percent_with_ends(share, low, high), f"{flipped:,} of {runs:,}")
        for change, share, low, high, flipped, runs in zip(*columns, strict=True)
    ]
    return Shown(
        ("change", "verdicts reversed", "runs"),
        rows,
        1,
        "Verdicts (overturns or stands) of all records and levels that a small change reverses.",
    )


def rate_table(each: Assessment, rate: OverturningRate) -> Shown:
    """Return the hazard, the probability of overturning at its levels, and the part of the rate from each interval of levels."""
    data = rate.dataset
    parts = (data.part_rate.values / rate.rate).tolist()
    low, high = data.part_low.values.tolist(), data.part_high.values.tolist()
    rows = []
    for place, part in enumerate(parts):
        upper = math.isinf(high[place])
        rows.append(
            (
                f"above {low[place]:.4g}" if upper else f"{low[place]:.4g}–{high[place]:.4g}",
                "–" if upper else scientific(float(data.hazard[place])),
                "–" if upper else percent(float(data.probability[place])),
                percent(part),
            )
        )
    heads = (
        symbol_of(each),
        "annual rate of exceedance at the upper end",
        "probability there",
        "share of the rate",
    )
    caption = (
        f"Annual rate of overturning {rate_text(rate)}, by the fit: the fraction of the records that rock times a lognormal function. The "
        f"interval is that of the records; {NO_SLIDING}."
    )
    return Shown(heads, rows, 1, caption)


def rule_table(each: Assessment) -> Shown:
    """Return the largest angles by design rules beside the computed one."""
    data, block = each.dataset, each.block

    def row(place: int, name: str) -> tuple[str, ...]:
        of = data.isel(record=place)
        angles = (float(of[rule]) for rule in ("fema_356", "priestley"))
        told = (
            "no result" if math.isnan(angle) else verdict(block, math.isinf(angle), angle) for angle in angles
        )
        ishiyama = "overturns" if bool(of.ishiyama) else "stands"
        return name, verdict(block, bool(of.overturned), float(of.peak)), *told, ishiyama

    names = data.name.values.tolist()
    fell = (data.overturned, np.isinf(data.fema_356), np.isinf(data.priestley), data.ishiyama)
    rows = [("number that overturn", *(f"{int(each.sum())} of {len(names)}" for each in fell))]
    if len(names) <= LONG:
        rows += [row(*each) for each in enumerate(names)]
    caption = (
        ""
        if len(names) <= LONG
        else "The angle of each record stands in the table of records beside the page."
    )
    computed = "computed, without sliding" if bool(data.slides.any()) else "computed"
    return Shown(("record", computed, "FEMA 356", "Priestley", "Ishiyama"), rows, 1, caption, marks=False)


def record_files(each: Assessment) -> Shown:
    """Return the source of each record."""
    rows = []
    for name, motion in zip(each.records.names, each.records, strict=True):
        file = motion.file
        rows.append(
            (
                name if file is None or name.startswith(file.name) else f"{name} ({file.name})",
                "–" if file is None else ", ".join(filter(None, (file.format, file.channel))),
                "–" if file is None else f"{file.sha256[:DIGITS_OF_DIGEST]}…",
                f"{motion.times.size:,}",
                f"{motion.step:g}",
                f"{motion.duration:.4g}",
                f"{motion.factor:.4g}",
            )
        )
    heads = ("record", "format", "SHA-256 of the file", "samples", "step (s)", "length (s)", "factor")
    return Shown(heads, rows, 3)
