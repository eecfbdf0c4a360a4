"""Reports of surveys of ground motions: rocking spectra, incremental dynamic analyses, fragility, sensitivity, overturning sets."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output import Report, Row, Table, Text, of_dataset
from rocking.cli.reports import (
    MAX_ROWS,
    angle_symbol,
    equation,
    equation_line,
    shape_warnings,
    survey_warnings,
    undecided,
    warning_lines,
)
from rocking.model.hazard import OverturningRate
from rocking.model.record_results import (
    FRACTILES,
    Fragility,
    IncrementalDynamicAnalysis,
    OverturningSet,
    Sensitivity,
    few_records,
    limit_name,
)
from rocking.model.record_set import RecordSet
from rocking.model.tables_and_json import counts
from rocking.model.text import counted, percent, percent_with_ends
from rocking.model.validation import TooShort
from rocking.survey.export import tables
from rocking.survey.overturning_rate import overturning_rate

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.requests import Request


def with_equation(result: Any, rows: Iterable[Row], title: str, sentences: Iterable[str]) -> Text:
    """Return the text of a survey of one block, with the equation of motion and the warnings."""
    lines = [equation_line(result.block, result.dataset.attrs)]
    if not result.block.law.is_plain:
        lines.append(f"restitution: {result.block.law}")
    return Text(title, rows, [*lines, *warning_lines(sentences)])


# Rocking spectrum.


MOST_NAMES = 3


def spectrum_text(data: xr.Dataset, request: Request) -> Text:
    """Return the fractions of the outcomes, with the warnings of the reader."""
    outcomes = counts(data, "outcome")
    total = sum(outcomes.values())
    rows = [*spectrum_rows(data, request.records), *outcome_rows(outcomes, total), *largest_rows(data)]
    title = f"rocking spectrum, {counted(total, 'run')}"
    return Text(title, rows, warning_lines([*request.warnings, *spectrum_warnings(data)]))


def spectrum_warnings(data: xr.Dataset) -> Iterator[str]:
    """Yield the warnings about undecided outcomes, and about the shapes of the blocks."""
    yield from undecided(counts(data, "certified")["undecided"])
    size, slenderness = values(data, "size").max(), values(data, "slenderness")
    height = float(2.0 * size * np.cos(slenderness.min()))
    full, by = data.attrs["model"] == "full", data.attrs.get("normalised_by", "angle")
    yield from shape_warnings(height, *widest_angles(data), full=full, normalised_by=by)


def widest_angles(data: xr.Dataset) -> tuple[float, float]:
    """Return the largest critical angles of the blocks, on each side, in rad."""
    right = float(values(data, "slenderness").max())
    return right, right * data.attrs.get("angle_ratio", 1.0)


def values(data: xr.Dataset, name: str) -> np.ndarray:
    """Return the values of a quantity as an array."""
    return np.atleast_1d(data[name].values if name in data.dims else data.attrs[name])


def spectrum_rows(data: xr.Dataset, records: RecordSet) -> Iterator[Row]:
    """Yield the rows of the records and the quantities."""
    names = (
        ", ".join(records.names)
        if len(records) <= MOST_NAMES
        else f"{records.names[0]}, …, {records.names[-1]}"
    )
    yield "records", f"{len(records)}: {names}"
    if data.attrs["intensity"] == "pga-g":
        yield "scaled to", f"PGA {range_text(values(data, 'level'))} g"
    else:
        pga = np.array([motion.pga for motion in records])
        yield "PGA", f"{range_text(pga)} m/s², times {range_text(values(data, 'level'))}"
    yield "size R", f"{range_text(values(data, 'size'))} m"
    yield "critical angle", both_sides(data, np.degrees(values(data, "slenderness")), "angle_ratio", "°")
    full = data.attrs["model"] == "full"
    by = data.attrs.get("normalised_by", "angle")
    yield "equation of motion", equation(*widest_angles(data), full=full, normalised_by=by)
    named = "restitution" in (*data.dims, *data.attrs)
    factor = f"{data.attrs['restitution_factor']:g} × " if "restitution_factor" in data.attrs else ""
    yield (
        "restitution",
        both_sides(data, values(data, "restitution"), "left_restitution")
        if named
        else f"{factor}Housner's for each slenderness",
    )
    if "wall_restitution" in data.attrs:
        yield "", "of a wall on the side θ < 0"
    if "restitution_table_rad_per_s" in data.attrs:
        yield "", f"table of {len(data.attrs['restitution_table_rad_per_s']) // 2} speeds"
    if "restitution_deviation" in data.attrs:
        deviation, shape, seed = (
            data.attrs[f"restitution_{each}"] for each in ("deviation", "shape", "seed")
        )
        yield "", f"{shape} scatter of {deviation:g} at each impact, seed {seed}"


def both_sides(data: xr.Dataset, right: np.ndarray, of_left: str, unit: str = "") -> str:
    """Return a quantity of blocks; of an unsymmetric one, that of each side, with the attribute of the left side."""
    if of_left not in data.attrs:
        return f"{range_text(right)}{unit}"
    left = data.attrs[of_left] * (right if of_left == "angle_ratio" else 1.0)
    return f"{range_text(right)}{unit} for θ > 0, {range_text(left)}{unit} for θ < 0"


def range_text(numbers: Any) -> str:
    """Return the smallest and the largest number, with their count if there are several."""
    low, high = float(np.min(numbers)), float(np.max(numbers))
    if np.size(numbers) == 1 or low == high:
        return f"{low:.6g}"
    return f"{low:.6g} to {high:.6g} ({np.size(numbers):,})"


def outcome_rows(outcomes: dict[str, int], total: int) -> Iterator[Row]:
    """Yield the fraction of each outcome."""
    for outcome, count in outcomes.items():
        if count:
            yield outcome, f"{percent(count / total)}, {counted(count, 'run')}"


def largest_rows(data: xr.Dataset) -> Iterator[Row]:
    """Yield the rows of the largest angle and of the largest size."""
    summary, side = largest_record(data), " of θ > 0" if "angle_ratio" in data.attrs else ""
    if summary["largest_angle_rad"] is not None:
        yield (
            "largest |θ| of blocks that stand",
            f"{np.degrees(summary['largest_angle_rad']):.4g}°, {summary['largest_angle']:.4g} θcr{side}",
        )
    if summary["largest_overturned_size_m"] is not None:
        yield "largest R that overturns", f"{summary['largest_overturned_size_m']:.6g} m"


def largest_record(data: xr.Dataset) -> dict[str, Any]:
    """Return the largest angles of blocks that stand, and the largest size that overturns; None if there is none."""
    peak = data.peak
    angles = peak * (data["slenderness"] if "slenderness" in data.dims else data.attrs["slenderness"])
    stands = np.isfinite(peak.values)
    fell = None
    if "size" in data.dims and not stands.all():
        over = np.isinf(peak).any([name for name in peak.dims if name != "size"])
        fell = float(data["size"].values[over.values].max())
    return {
        "largest_angle": float(peak.values[stands].max()) if stands.any() else None,
        "largest_angle_rad": float(angles.values[stands].max()) if stands.any() else None,
        "largest_overturned_size_m": fell,
    }


def spectrum_tables(data: xr.Dataset, _: Request) -> Iterator[Table]:
    """Yield the table of the runs, with the largest angle also in rad."""
    for table in tables(data.drop_vars(["pga", "frequency_parameter"], errors="ignore")):
        slenderness = table.get("slenderness [rad]", data.attrs.get("slenderness"))
        yield table | {"peak [rad]": table["peak [theta_cr]"] * slenderness}


def spectrum_more(data: xr.Dataset, request: Request) -> dict[str, Any]:
    """Return further entries of JSON: the records with their files, the largest angles, and the warnings."""
    records = request.records
    return {
        "records": [
            {
                "name": name,
                "pga_m_per_s2": each.pga,
                "sha256": None if each.file is None else each.file.sha256,
            }
            for name, each in zip(records.names, records, strict=True)
        ],
        **largest_record(data),
        "warnings": [*request.warnings, *spectrum_warnings(data)],
    }


SPECTRUM = Report(
    of_dataset(spectrum_text),
    figure=lambda plot, result, _: plot.rocking_spectrum(result),
    more=of_dataset(spectrum_more),
    rows=of_dataset(spectrum_tables),
)


# Incremental dynamic analysis.


def ida_text(result: IncrementalDynamicAnalysis, request: Request) -> Text:
    """Return the fractiles of the largest angle, and the fraction that overturns, at each level."""
    return with_equation(result, ida_rows(result), str(result), ida_warnings(result, request))


def ida_warnings(result: IncrementalDynamicAnalysis, request: Request) -> Iterator[str]:
    """Yield the warnings of the reader, about few records, undecided runs and the block."""
    data = result.dataset
    yield from request.warnings
    yield from few_records(data.sizes["record"])
    yield from undecided(int((data.certified == 0).sum()))
    yield from survey_warnings(result.block, data.attrs)


def ida_rows(result: IncrementalDynamicAnalysis) -> Iterator[Row]:
    """Yield the fractiles at each level; at most so many levels, evenly spread, that the table stays short."""
    fractiles = result.fractiles()
    count = fractiles.sizes["level"]
    shown = range(count) if count <= MAX_ROWS else np.linspace(0, count - 1, MAX_ROWS).round().astype(int)
    names = (f"|θ| of {100 * each:g} % of the records" for each in FRACTILES)
    yield (level_heading(result, "(", ")"), *names, "overturned")
    for place in shown:
        angles = (
            "overturns" if math.isinf(peak) else f"{result.block.degrees(peak):.4g}°"
            for peak in fractiles.values[:, place].tolist()
        )
        yield (
            f"{float(fractiles.level[place]):.4g}",
            *angles,
            percent(float(result.overturned[place])),
        )
    if count > MAX_ROWS:
        yield (f"{MAX_ROWS} of {count} levels (all of them with --json)", "", "", "", "")


IDA = Report(ida_text, warnings=ida_warnings)


# Fragility.


FRAGILITY_COLUMNS = ("fraction", "fraction_low", "fraction_high", "fit", "fit_low", "fit_high")


def fragility_text(result: Fragility, request: Request) -> Text:
    """Return the fits and the probabilities, and the annual rates at a site."""
    rates = [str(each) for each in rates_of(result, request)[0]]
    text = with_equation(result, fragility_rows(result), str(result), fragility_warnings(result, request))
    return text._replace(lines=[*rates, *text.lines])


def rates_of(result: Fragility, request: Request) -> tuple[list[OverturningRate], list[str]]:
    """Return the annual rates of all limits that have a fit, and why the others have none."""
    rates, reasons = [], []
    if request.hazard is not None:
        bootstrap = {name: result.dataset.attrs[name] for name in ("replicates", "seed")}
        for fit in result.fits:
            try:
                rates.append(overturning_rate(result, request.hazard, limit=fit.limit, **bootstrap))
            except TooShort as error:
                reasons.append(str(error))
    return rates, reasons


def fragility_rates(result: Fragility, request: Request) -> dict[str, Any]:
    """Return the annual rates at a site for the JSON."""
    return (
        {} if request.hazard is None else {"rates": [each.to_dict() for each in rates_of(result, request)[0]]}
    )


def fragility_warnings(result: Fragility, request: Request) -> Iterator[str]:
    """Yield the warnings of the reader, about few records, undecided runs and the block."""
    data = result.dataset
    yield from request.warnings
    yield from few_records(data.sizes["record"])
    yield from (f"no annual rate: {reason}" for reason in rates_of(result, request)[1])
    undecided = int((data.certified == 0).sum())
    if undecided:
        yield f"{undecided:,} of {data.peak.size:,} runs are undecided in double precision; the intervals cover both outcomes"
    yield from survey_warnings(result.block, data.attrs)


def level_heading(result: Fragility | IncrementalDynamicAnalysis, *brackets: str) -> str:
    """Return symbol and unit of the levels."""
    attributes = result.dataset.level.attrs
    unit = "" if attributes["units"] in ("", "1") else f" {brackets[0]}{attributes['units']}{brackets[1]}"
    return f"{attributes['symbol']}{unit}"


def fragility_rows(result: Fragility) -> Iterator[Row]:
    """Yield the probabilities of each limit and the fits."""
    data = result.dataset
    limits = data.limit.values.tolist()
    yield (level_heading(result, "(", ")"), *(limit_heading(result, limit) for limit in limits))
    for place, level in enumerate(data.level.values.tolist()):
        yield (
            f"{level:.4g}",
            *(
                percent_with_ends(value, low, high)
                for value, low, high in zip(
                    *(data[name].values[:, place].tolist() for name in FRAGILITY_COLUMNS[:3]), strict=True
                )
            ),
        )
    yield ("median", *(fit_text(fit.median, fit.median_low, fit.median_high) for fit in result.fits))
    yield (
        "dispersion",
        *(fit_text(fit.dispersion, fit.dispersion_low, fit.dispersion_high) for fit in result.fits),
    )


def limit_heading(result: Fragility, limit: float) -> str:
    """Return a limit of the angle as text."""
    return (
        limit_name(limit)
        if math.isinf(limit)
        else f"|θ| > {result.block.degrees(limit):.3g}° = {limit:g} {angle_symbol(result.block)}"
    )


def fit_text(value: float, low: float, high: float) -> str:
    """Return a parameter of a fit with its interval."""
    if math.isnan(value):
        return "–"
    return f"{value:.3g} ({low:.3g}–{'∞' if math.isinf(high) else f'{high:.3g}'})"


FRAGILITY = Report(
    fragility_text,
    warnings=fragility_warnings,
    more=fragility_rates,
)


# Sensitivity.


SENSITIVITY_COLUMNS = ("change", "share", "share_low", "share_high", "flipped", "runs", "undecided")


def sensitivity_text(result: Sensitivity, request: Request) -> Text:
    """Return the fraction of the verdicts that each change reverses."""
    data = result.dataset
    runs, records = counted(data.overturned.size, "run"), counted(data.sizes["record"], "record")
    title = f"verdicts that small changes reverse, of {runs} of {records}"
    return with_equation(result, sensitivity_rows(result), title, sensitivity_warnings(result, request))


def sensitivity_warnings(result: Sensitivity, request: Request) -> Iterator[str]:
    """Yield the warnings of the reader, about few records, undecided runs and the block."""
    data = result.dataset
    yield from request.warnings
    yield from few_records(data.sizes["record"])
    count = int(data.undecided.max())
    if count:
        yield f"{counted(count, 'run')} undecided in double precision; the intervals cover both outcomes"
    yield from survey_warnings(result.block, data.attrs)


def sensitivity_rows(result: Sensitivity) -> Iterator[Row]:
    """Yield one row per change."""
    yield "change", "fraction reversed", "runs"
    for change, share, low, high, flipped, *_ in changes(result):
        yield change, percent_with_ends(share, low, high), f"{flipped:,}"


def changes(result: Sensitivity) -> Iterator[tuple[Any, ...]]:
    """Return the values of each change."""
    return zip(*(result.dataset[name].values.tolist() for name in SENSITIVITY_COLUMNS), strict=True)


SENSITIVITY = Report(
    sensitivity_text,
    warnings=sensitivity_warnings,
)


# Overturning set.


def set_text(result: OverturningSet, request: Request) -> Text:
    """Return the overturning levels of each record."""
    return with_equation(result, set_rows(result), str(result), set_warnings(result, request))


def set_warnings(result: OverturningSet, request: Request) -> Iterator[str]:
    """Yield the warnings of the reader, about undecided switches and the block."""
    yield from request.warnings
    count = result.undecided.size
    if count:
        yield f"{count:,} of {result.switches.size:,} switches are undecided in double precision"
    yield from survey_warnings(result.block, result.dataset.attrs)


def set_rows(result: OverturningSet) -> Iterator[Row]:
    """Yield one row per record."""
    unit = "" if result.measure.unit in ("", "1") else f", {result.measure.unit}"
    yield (
        "record",
        f"lowest found{unit}",
        "intervals",
        "overturning share of the range",
        f"first intervals{unit}",
    )
    for number, name in list(enumerate(result.records.names))[:MAX_ROWS]:
        intervals = result.intervals(number)
        lowest = result.lowest[number]
        first = ", ".join(f"{low:.5g} to {high:.5g}" for low, high in intervals[:3].tolist())
        yield (
            name,
            "none" if math.isnan(lowest) else f"{lowest:.6g}",
            str(len(intervals)),
            percent(float(result.share[number])),
            first + ", …" * (len(intervals) > 3),
        )
    left = len(result.records) - MAX_ROWS
    if left > 0:
        yield (f"and {left} more (all of them with --json, --netcdf or --plot)", "", "", "", "")


OVERTURNING_SET = Report(
    set_text,
    warnings=set_warnings,
)
