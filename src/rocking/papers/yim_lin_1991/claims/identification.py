"""Claims on the identification of responses: Poincaré maps, spectra, exponents and dimensions; figures 7 and 8."""

from __future__ import annotations

import math

import numpy as np

import rocking as rk
from rocking.model.text import percent
from rocking.papers.report.claim import Chapter, Finding, small
from rocking.papers.report.workers import shared
from rocking.papers.yim_lin_1991 import cached_surveys, table_exponents
from rocking.papers.yim_lin_1991.cases import CHAOTIC, PERIODIC, QUASI_PERIODIC
from rocking.response.correlation_dimension import CorrelationDimension
from rocking.response.lyapunov import LyapunovSpectrum

CHAPTER = Chapter("Identification of responses")
SUBHARMONIC = PERIODIC[1].system


@shared
def _dimension(system: rk.System, points: int, transient: int = 0) -> CorrelationDimension:
    motion = rk.simulate(system, cycles=transient + points - 1, record="section")
    try:
        return rk.correlation_dimension(motion.section()[transient:])
    except rk.TooShort as short:
        return short.estimate


@shared
def _spectrum(system: rk.System, cycles: int) -> LyapunovSpectrum:
    try:
        return rk.lyapunov(system, cycles=cycles)
    except rk.TooShort as short:
        return short.estimate


@CHAPTER.claim("Fig. 7a")
def figure_7a() -> Finding:
    """The Poincaré map of the one-third subharmonic has three fixed points."""
    points = rk.simulate(SUBHARMONIC, cycles=2_000, record="section").section()[-300:]
    distinct = len(np.unique(points.round(9), axis=0))
    return Finding(distinct == 3, f"{distinct} points, visited in turn over the last 300 of 2,000 cycles")


@CHAPTER.claim(
    "Fig. 7b",
    qualified="three closed curves, visited in turn; they are the intersections of one torus with the section",
    cost=0.7,
)
def figure_7b() -> Finding:
    """The Poincaré map of the quasi-periodic response forms three tori."""
    turns = cached_surveys.torus_turns()
    low, high = _dimension(QUASI_PERIODIC.system, 20_000).interval
    curves = turns.period == 3 and low < 1.0 < high
    return Finding(
        low < 2.0 < high,
        f"period of the islands {turns.period}; dimension of the points {low:.2f} to {high:.2f}",
        shown=curves,
    )


@CHAPTER.claim(
    "Fig. 7c",
    qualified="the response is chaotic, but undamped motions conserve area, so that nothing attracts: it is a chaotic sea "
    "around islands",
)
def figure_7c() -> Finding:
    """The Poincaré map of the chaotic response is a strange attractor."""
    spectrum = _spectrum(CHAOTIC.system, 100_000)
    total = float(spectrum.values.sum())
    return Finding(
        total < -1e-6,
        f"λ₁ + λ₂ = {small(total)} per unit of τ over 10⁵ cycles: areas are conserved",
        shown=abs(total) < 1e-9 and spectrum.values[0] > 0.0,
    )


@CHAPTER.claim(
    "Fig. 8a",
    qualified="the line at a third of the forcing frequency is the strongest, but the line at the forcing frequency is strong too",
    cost=0.2,
)
def figure_8a() -> Finding:
    """The spectral density of the periodic response has a single dominant frequency."""
    motion = rk.simulate(SUBHARMONIC, cycles=8_790)
    density = rk.spectral_density(motion, transient=600)
    strongest = sorted(density.peaks, key=lambda line: -line.amplitude)[:2]
    shares = [0.5 * line.amplitude**2 / density.variance for line in strongest]
    return Finding(
        shares[0] > 0.9,
        f"{strongest[0].name} has {100 * shares[0]:.1f} % of the variance, {strongest[1].name} {100 * shares[1]:.1f} %",
        shown=strongest[0].name == "f/3" and shares[1] > 0.1,
    )


@CHAPTER.claim("Fig. 8b")
def figure_8b() -> Finding:
    """The spectral density of the quasi-periodic response has a finite number of incommensurate frequencies."""
    density = cached_surveys.torus_spectrum()
    unnamed = sum(1 for line in density.peaks if not line.name)
    return Finding(
        unnamed == 0 and len(density.peaks) > 2 and density.line_share > 0.99,
        f"{len(density.peaks)} lines, all combinations of two frequencies, hold {percent(density.line_share)} of the variance",
    )


@CHAPTER.claim("Fig. 8c", cost=1.3)
def figure_8c() -> Finding:
    """The spectral density of the chaotic response is a broad band."""
    # One run in forty stays near an island so long that its lines hold half of the variance.
    systems = table_exponents.sea_systems(9)
    shares = [rk.spectral_density(rk.simulate(system, cycles=8_192)).line_share for system in systems]
    return Finding(
        bool(np.median(shares) < 0.5),
        f"lines hold {100 * np.median(shares):.0f} % of the variance, the band the rest (median of {len(shares)} runs with "
        f"phases within {table_exponents.SEA_PHASES:g}); the largest value is {100 * max(shares):.0f} %",
    )


@CHAPTER.claim(
    "Response identification",
    qualified="0 is the exponent along the flow, which every motion has; both exponents of the section are negative, here "
    "ln e per impact",
)
def exponent_periodic() -> Finding:
    """The Lyapunov exponent of the periodic response is 0."""
    spectrum = _spectrum(SUBHARMONIC, 20_000)
    expected = math.log(0.925) * 2.0 / 3.0
    per_cycle, error = (float(pair[0]) for pair in spectrum.per_cycle)
    return Finding(
        abs(per_cycle) < 1e-3,
        f"λ₁ = λ₂ = {per_cycle:.6f} per cycle; ln e times 2 impacts in 3 cycles is {expected:.6f}",
        shown=abs(per_cycle - expected) < 2.0 * error,
    )


@CHAPTER.claim("Response identification")
def exponent_quasi_periodic() -> Finding:
    """The Lyapunov exponent of the quasi-periodic response is 0."""
    spectrum = _spectrum(QUASI_PERIODIC.system, 200_000)
    value = float(spectrum.per_cycle[0][0])
    return Finding(
        abs(value) < 1e-3,
        f"λ₁ = {small(value)} per cycle over 2·10⁵ cycles, decreasing as ln n/n: shear, no exponential divergence",
    )


@CHAPTER.claim("Response identification")
def exponent_chaotic() -> Finding:
    """The Lyapunov exponent of the chaotic response is 0.14 (unit, length of run and initial state not given)."""
    mean, spread = table_exponents.sea()
    return Finding(
        abs(mean - 0.14) < spread,
        f"{mean:.3f} nats per cycle over {table_exponents.SEA_CYCLES:,} cycles, single runs ± {spread:.3f}; it decreases with the "
        "length of the run",
    )


@CHAPTER.claim("Response identification")
def dimension_periodic() -> Finding:
    """The dimension of the periodic response is 0."""
    found = _dimension(SUBHARMONIC, 2_000, transient=2_000)
    return Finding(found.isolated == 3, f"section: 0 ({found.isolated} isolated points)")


@CHAPTER.claim(
    "Response identification",
    qualified="2 is the dimension of the torus in the flow; in the section, to which the 0 of the periodic response refers, it is 1",
)
def dimension_quasi_periodic() -> Finding:
    """The dimension of the quasi-periodic response is 2.0."""
    low, high = _dimension(QUASI_PERIODIC.system, 20_000).interval
    return Finding(
        low < 2.0 < high,
        f"section {low:.2f} to {high:.2f}, flow {low + 1:.2f} to {high + 1:.2f}",
        shown=low < 1.0 < high,
    )


@CHAPTER.claim(
    "Response identification",
    error="a chaotic sea fills an area: 2 in the section, 3 in the flow; a small number of points gives 2.3 at large radii",
)
def dimension_chaotic() -> Finding:
    """The dimension of the chaotic response is 2.3, not an integer."""
    found = table_exponents.sea_dimension().found
    fine = found.slopes[found.radii[:-1] < 0.03]
    slope = float(fine[: max(len(fine) // 2, 1)].mean()) if len(fine) else math.nan
    coarse = float(found.slopes[found.radii[:-1] >= table_exponents.COARSE].mean())
    return Finding(
        abs(slope + 1.0 - 2.3) < 0.1,
        f"local slopes in the section: {coarse:.2f} at radii above {table_exponents.COARSE} standard deviations, {slope:.2f} at the "
        f"smallest radii; in the flow {coarse + 1:.2f} and {slope + 1:.2f}",
        shown=slope > 1.6,
    )
