"""Reports of surveys of systems: maps, basins, safe basins, overturning amplitudes and overturning spectra."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.options import SURVEYED
from rocking.cli.output import Report, Row, Text, of_dataset
from rocking.cli.reports import (
    MAX_ROWS,
    angle_warning,
    block_warnings,
    in_si,
    law_text,
    system_rows,
    undecided,
    warning_lines,
)
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.quantity import IN_SI, LEFT_QUANTITIES
from rocking.model.survey_results import BasinMap, OverturningCurve, SafeBasin
from rocking.model.system import System
from rocking.model.tables_and_json import counts
from rocking.model.text import counted, percent
from rocking.model.verdict import Criterion, Outcome

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.requests import Request

DRAWN = ("curves", "symbols")
"""Options of the figure of a map."""


def values(data: xr.Dataset, name: str) -> np.ndarray:
    """Return the values of a quantity that varies or is fixed, as an array."""
    return np.atleast_1d(data[name].values if name in data.coords else data.attrs[name])


def data_warnings(data: xr.Dataset, block: Block | None) -> list[str]:
    """Return the warnings about the block of a survey."""
    full = "critical_angle" in (*data.coords, *data.attrs)
    return block_warnings(block, values(data, "amplitude"), values(data, "restitution"), full=full)


def survey_more(data: xr.Dataset, request: Request) -> dict[str, Any]:
    """Return the warnings about the block of a survey as an entry of JSON; none without a block."""
    return {} if request.block is None else {"warnings": data_warnings(data, request.block)}


# Map.


def map_text(data: xr.Dataset, request: Request) -> Text:
    """Return the fractions of the response types."""
    block = request.block
    size = " × ".join(f"{data.sizes[name]:,}" for name in data.kind.dims)
    farthest = float(max(values(data, "angle"), key=abs))
    lines = [*angle_warning(farthest, block), *warning_lines(data_warnings(data, block))]
    return Text(f"parametric map, {size} points", [*map_rows(data, block), *response_rows(data)], lines)


def map_rows(data: xr.Dataset, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the quantities."""
    for name in map(str, data.kind.dims):
        first, last = data[name].values[[0, -1]]
        yield name, f"{first:.6g} to {last:.6g}", in_si(name, (first, last), block)
    for name in (*SURVEYED, "max_cycles"):
        if name in data.attrs:
            value = data.attrs[name]
            beside = law_text(block) if name == "restitution" else in_si(name, value, block)
            yield name.replace("_", " "), f"{value:.6g}", beside


def response_rows(data: xr.Dataset) -> Iterator[Row]:
    """Yield the fraction of each response, and of each reason of an undetermined one."""
    kinds, criteria = counts(data, "kind"), counts(data, "evidence")
    total = sum(kinds.values())
    for kind, count in kinds.items():
        if count:
            yield kind, percent(count / total), counted(count, "point")
    for criterion in Criterion:
        count = criteria[str(criterion)]
        if criterion.why and count:
            yield f"  {criterion}", percent(count / total), f"{counted(count, 'point')}: {criterion.why}"


MAP = Report(
    of_dataset(map_text),
    figure=lambda plot, result, request: plot.parametric_map(
        result,
        block=request.block,
        **{name: request.options[name] for name in DRAWN if name in request.options},
    ),
    more=of_dataset(survey_more),
    in_parts=True,
)


# Basins.


def basins_text(basins: BasinMap, request: Request) -> Text:
    """Return the attractors, their area fractions and the uncertainty exponents of the boundaries."""
    starts = f"{basins.fractions[0].of:,} initial states"
    if "sample" in basins.dataset.dims:
        starts += ", random within both ranges"
    title = f"basins of {starts}: {counted(len(basins.attractors), 'attractor')}"
    rows = [*system_rows(basins.system, request.block), *basins_rows(basins)]
    return Text(title, rows, warning_lines(basins_warnings(basins, request.block)))


def basins_warnings(basins: BasinMap, block: Block | None) -> list[str]:
    """Return the warnings about the block."""
    system = basins.system
    full = system.critical_angle is not None
    return block_warnings(block, system.periodic.amplitude, system.restitution, full=full)


def basins_rows(result: BasinMap) -> Iterator[Row]:
    """Yield one row per attractor, then the exponents."""
    for each, share in list(zip(result.attractors, result.fractions, strict=True))[:MAX_ROWS]:
        yield (
            each.name,
            str(share),
            f"e.g. from Θ = {each.verdict.start.angle:.6g}, Θ' = {each.verdict.start.velocity:.6g}",
        )
    if len(result.attractors) > MAX_ROWS:
        yield "other attractors", f"{len(result.attractors) - MAX_ROWS}", ""
    names = {
        "boundary of overturning": result.uncertainty_exponent,
        "all boundaries": result.attractor_exponent,
    }
    for name, exponent in names.items():
        if exponent is not None:
            yield name, f"uncertainty exponent {exponent}", exponent.meaning
    if tangency := tangled_from(result.system):
        yield (
            "theoretical boundary",
            f"fractal above A* = {tangency:.6g}",
            "the manifolds of the saddles intersect",
        )


def tangled_from(system: System) -> float | None:
    """Return A* if the boundary of overturning is provably fractal, A* < A < √(1 + Ω²), else None."""
    from rocking.theory import heteroclinic_amplitude

    forcing = system.periodic
    if not system.has_chains or system.braces is not None or not 0.0 < system.restitution < 1.0:
        return None
    tangency = float(heteroclinic_amplitude(forcing.period, system.restitution))
    return tangency if tangency < forcing.amplitude < math.hypot(1.0, forcing.frequency) else None


BASINS = Report(
    basins_text,
    warnings=lambda basins, request: basins_warnings(basins, request.block),
)


# Safe basin.


THRESHOLDS = {"heteroclinic": "exact tangency A*", "melnikov": "Melnikov's A_M"}


def safe_text(result: SafeBasin, request: Request) -> Text:
    """Return the safe fraction at each amplitude."""
    block = request.block
    lines = [*tangency_lines(result, block), *warning_lines(data_warnings(result.dataset, block))]
    return Text(str(result), safe_rows(result, block), lines)


def safe_rows(result: SafeBasin, block: Block | None) -> Iterator[Row]:
    """Yield one row per amplitude; with a block, also in SI."""
    in_units = () if block is None else ("m/s²", "g")
    yield ("amplitude A", "safe fraction", "undetermined", *in_units)
    amplitudes = result.dataset.amplitude.values
    places = list(zip(amplitudes, result.shares, result.dataset.undetermined.values, strict=True))
    for amplitude, share, unknown in places[:MAX_ROWS]:
        in_si = () if block is None else accelerations(float(block.acceleration(amplitude)))
        yield (f"{amplitude:.6g}", str(share), percent(float(unknown)), *in_si)
    if len(places) > MAX_ROWS:
        left = f"and {len(places) - MAX_ROWS} more (all of them with --json, --csv, --netcdf or --plot)"
        yield (left, "", "", *[""] * len(in_units))


def accelerations(acceleration: float) -> Row:
    """Return an acceleration in m/s² and in g."""
    return f"{acceleration:.4g}", f"{acceleration / GRAVITY:.4g}"


def tangency_lines(result: SafeBasin, block: Block | None) -> Iterator[str]:
    """Yield the thresholds in SI, if there are any."""
    if block is None or math.isnan(result.heteroclinic_amplitude):
        return
    for name, text in THRESHOLDS.items():
        yield f"{text} = {in_si('amplitude', getattr(result, f'{name}_amplitude'), block)}"


SAFE_BASIN = Report(
    safe_text,
    warnings=lambda result, request: data_warnings(result.dataset, request.block),
)


# Lowest overturning amplitude.


LEVELS = ("lowest", "resolution", "survived_up_to")
"""Variables of the result that are amplitudes."""


COLUMNS = (*LEVELS, "surviving_above")


def overturning_text(result: OverturningCurve, request: Request) -> Text:
    """Return the lowest overturning amplitudes."""
    block = request.block
    title, rows = overturning_title(result, block), overturning_rows(result, block)
    return Text(title, rows, warning_lines(overturning_warnings(result, block)))


def overturning_title(result: OverturningCurve, block: Block | None) -> str:
    """Return the lowest amplitude of all in one line; with a block, in SI first."""
    lowest = result.dataset.lowest
    if block is None:
        return str(result)
    if lowest.isnull().all():
        return f"{result}: {in_si('amplitude', result.dataset.amplitude.values[[0, -1]], block)}"
    where = lowest.isel({} if lowest.ndim == 0 else lowest.argmin(...))
    at = [in_si(str(name), float(where[name]), block) for name in lowest.dims]
    motion = " and ".join([in_si("amplitude", float(where), block), *filter(None, at)])
    return f"a block of {block.size} overturns from rest at {motion}; normalised: {result}"


def overturning_warnings(result: OverturningCurve, block: Block | None) -> list[str]:
    """Return the warnings about the block."""
    data = result.dataset
    lowest = data.lowest.values[data.lowest.notnull().values]
    full = "critical_angle" in (*data.coords, *data.attrs)
    return block_warnings(block, lowest, values(data, "restitution"), full=full)


def overturning_rows(result: OverturningCurve, block: Block | None) -> Iterator[Row]:
    """Yield one row per value of the varied quantities; with a block, also in SI."""
    data = result.dataset
    over = [str(name) for name in data.lowest.dims]
    known = [] if block is None else [name for name in over if name in IN_SI]
    heading = (*over, "lowest A", "scan step", "all survive up to", "survive above")
    in_units = () if block is None else ("m/s²", "g", "scan step, m/s²", "up to, m/s²")
    yield (*heading, *(IN_SI[name].unit for name in known), *in_units)
    for index in list(places(data))[:MAX_ROWS]:
        at = {name: data[name].values[k] for name, k in zip(over, index, strict=True)}
        low, step, up_to, above = (float(data[name].values[index]) for name in COLUMNS)
        cells = [
            *(f"{value:.6g}" for value in at.values()),
            "none" if math.isnan(low) else f"{low:.6g}",
            number_text(step),
            number_text(up_to),
            "–" if math.isnan(above) else f"{100 * above:.3g} %",
        ]
        if block is not None:
            cells += [f"{IN_SI[name].of(block, at[name]):.4g}" for name in known]
            levels = [block.acceleration(level) for level in (low, step, up_to)]
            cells += [number_text(level, 4) for level in (levels[0], levels[0] / GRAVITY, *levels[1:])]
        yield tuple(cells)
    left = data.lowest.size - MAX_ROWS
    if left > 0:
        rest = len(heading) + len(known) + len(in_units) - 1
        yield (f"and {left} more (all of them with --json, --csv, --netcdf or --plot)", *[""] * rest)


def places(data: xr.Dataset) -> Iterator[tuple[int, ...]]:
    """Yield the indices of all values."""
    yield from np.ndindex(*data.lowest.shape)


def number_text(number: float, digits: int = 6) -> str:
    """Return a number, or a dash for NaN."""
    return "–" if math.isnan(number) else f"{number:.{digits}g}"


OVERTURNING = Report(
    overturning_text,
    warnings=lambda result, request: overturning_warnings(result, request.block),
)


# Overturning spectrum.


MODES = ("no impact", "1 impact", "2 or more impacts")


def spectrum_text(data: xr.Dataset, request: Request) -> Text:
    """Return the fractions of the outcomes and of the modes of overturning."""
    title = f"overturning spectrum of {data.attrs['pulse']} pulses, {counted(data.outcome.size, 'run')}"
    return Text(
        title, spectrum_rows(data, request.block), warning_lines(spectrum_warnings(data, request.block))
    )


def spectrum_warnings(data: xr.Dataset, block: Block | None) -> list[str]:
    """Return the warnings about the block, and about undecided outcomes."""
    return [*data_warnings(data, block), *undecided(counts(data, "certified")["undecided"])]


def spectrum_rows(data: xr.Dataset, block: Block | None) -> Iterator[Row]:
    """Yield the quantities, the outcomes, the modes and the lowest amplitude that overturns."""
    for name in map(str, data.outcome.dims):
        first, last = data[name].values[[0, -1]]
        yield name, f"{first:.6g} to {last:.6g} ({data.sizes[name]:,})", in_si(name, (first, last), block)
    for name in ("restitution", *LEFT_QUANTITIES, "wall_restitution"):
        if name in data.attrs:
            law = law_text(block) if name == "restitution" else ""
            yield name.replace("_", " "), f"{data.attrs[name]:.6g}", law
    outcomes = counts(data, "outcome")
    total = sum(outcomes.values())
    for outcome, count in outcomes.items():
        if count:
            yield outcome, percent(count / total), counted(count, "run")
    for mode, count in modes(data).items():
        if count:
            yield f"  {mode}", percent(count / total), counted(count, "run")
    lowest = lowest_overturning(data)
    if lowest is not None:
        yield "lowest amplitude that overturns", f"{lowest:.6g}", in_si("amplitude", lowest, block)


def overturned(data: xr.Dataset) -> xr.DataArray:
    """Return the mask of the runs that overturn."""
    return data.outcome == tuple(Outcome).index(Outcome.OVERTURNED)


def modes(data: xr.Dataset) -> dict[str, int]:
    """Return the number of runs that overturn, by the impacts since the block last rested."""
    impacts = np.minimum(data.impacts_since_rest.values[overturned(data).values], len(MODES) - 1)
    return dict(zip(MODES, np.bincount(impacts.astype(int), minlength=len(MODES)).tolist(), strict=True))


def lowest_overturning(data: xr.Dataset) -> float | None:
    """Return the lowest amplitude that overturns a block at any frequency; None if there is none."""
    fell = overturned(data)
    over = data["amplitude"].values[fell.any([name for name in fell.dims if name != "amplitude"]).values]
    return float(over[0]) if over.size else None


def spectrum_more(data: xr.Dataset, request: Request) -> dict[str, Any]:
    """Return further entries of JSON: the modes of overturning, the lowest amplitude that overturns, and the warnings."""
    block, lowest = request.block, lowest_overturning(data)
    si = None if block is None else IN_SI["amplitude"]
    key = "lowest_overturning_amplitude" if si is None else f"lowest_overturning_{si.key}"
    return {
        "modes": modes(data),
        key: lowest if si is None or lowest is None else float(si.of(block, lowest)),
        "warnings": spectrum_warnings(data, block),
    }


OVERTURNING_SPECTRUM = Report(
    of_dataset(spectrum_text),
    figure=lambda plot, result, request: plot.overturning_spectrum(result, block=request.block),
    more=of_dataset(spectrum_more),
)
