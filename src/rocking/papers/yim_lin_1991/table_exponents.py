"""Table of Lyapunov exponents and fractal dimensions: numbers of the paper and computed values with errors.

The numbers of the paper stand in its sections "Response identification" and "Response of undamped systems". They
refer to the periodic, the quasi-periodic and the chaotic response of figures 7 and 8. The exponents are 0, 0 and
0.14, the dimensions 0, 2.0 and 2.3. Units, lengths of the runs and spaces are not given, nor any number for the
braced response of figure 13a.

Difference from the paper: both exponents of a damped periodic response are negative; zero is the exponent along the
flow, which every motion has. Dimensions refer to the section; the dimension in the flow is larger by one. Undamped
motions have no attractor: the chaotic sea fills an area, and its exponent decreases with the length of the run.
"""

from pathlib import Path

import numpy as np
from attrs import asdict, fields, frozen

import rocking as rk
from rocking.model.text import plus_minus
from rocking.papers.report.table_files import write_table
from rocking.papers.report.workers import shared
from rocking.papers.yim_lin_1991.cases import BRACED, CHAOTIC, PERIODIC, QUASI_PERIODIC
from rocking.response.correlation_dimension import CorrelationDimension

# Number and length of runs as in 1991, and their range of phases, which no experiment can resolve.
SEA_STARTS, SEA_CYCLES, SEA_PHASES = 100, 2_000, 1e-7
# Number of runs for the points of the sea, points per run, and cycles after which the runs have diverged.
SEA_RUNS, SEA_POINTS, SEA_PARTED = 40, 5_000, 500
# Smallest radius, in standard deviations, that a section of some thousand points resolves.
COARSE = 0.1


@frozen
class Row:
    """Row of the table, as text: the numbers of the paper, the computed values, and the reason for the difference."""

    response: str
    parameters: str
    paper_exponent: str
    exponent_per_cycle: str
    exponent_per_tau: str
    paper_dimension: str
    section_dimension: str
    flow_dimension: str
    why: str


@frozen
class Dimension:
    """Correlation dimension of a section, and whether the section scales."""

    found: CorrelationDimension
    scales: bool


def rows() -> list[Row]:
    """Compute the rows of the table."""
    return [_periodic(), _quasi_periodic(), _sea(), _braced()]


def write(folder: Path) -> list[Path]:
    """Write the table as CSV and as Markdown."""
    table = [list(asdict(row).values()) for row in rows()]
    return write_table(folder, "exponents", [field.name.replace("_", " ") for field in fields(Row)], table)


def _periodic() -> Row:
    case = PERIODIC[1]
    spectrum = rk.lyapunov(case.system, cycles=100_000)
    return _row(
        f"{case.name}, figures 7a and 8a",
        case.system,
        ("0", "0"),
        _pair(spectrum.per_cycle),
        _pair((spectrum.values, spectrum.errors)),
        _dimension(case.system, 2_000, transient=2_000),
        "both exponents are ln e per impact; 0 is the exponent along the flow. Points have dimension 0 in the section",
    )


def _quasi_periodic() -> Row:
    system = QUASI_PERIODIC.system
    spectrum = rk.lyapunov(system, cycles=400_000)
    return _row(
        "quasi-periodic, figures 7b and 8b",
        system,
        ("0", "2.0"),
        _pair(spectrum.per_cycle),
        _pair((spectrum.values, spectrum.errors)),
        _dimension(system, 20_000),
        "the estimate decreases as the logarithm of the length over the length. Curves have dimension 1 in the section; 2 is "
        "the dimension of the torus in the flow",
    )


def sea_systems(count: int) -> list[rk.System]:
    """Return the chaotic system with ``count`` forcing phases that no experiment can distinguish."""
    forcing, restitution = CHAOTIC.system.harmonic, CHAOTIC.system.restitution
    return [
        rk.System(rk.Harmonic(forcing.amplitude, period=forcing.period, phase=phase), restitution)
        for phase in np.linspace(0.0, SEA_PHASES, count)
    ]


@shared
def sea() -> tuple[float, float]:
    """Return mean and standard deviation of λ₁ of the chaotic sea over runs of the length of 1991, nats per cycle."""
    per_cycle = (
        np.array([_estimate(system) for system in sea_systems(SEA_STARTS)]) * CHAOTIC.system.harmonic.period
    )
    return float(per_cycle.mean()), float(per_cycle.std(ddof=1))


@shared
def sea_dimension() -> Dimension:
    """Estimate the dimension of points of several runs.

    A single run is not representative: of 13 runs of 50,000 cycles, two stayed near islands for long and gave 1.6.
    """
    runs = [
        rk.simulate(system, cycles=SEA_PARTED + SEA_POINTS - 1, record="section").section()[SEA_PARTED:]
        for system in sea_systems(SEA_RUNS)
    ]
    return _dimension_of(np.concatenate(runs))


def _sea() -> Row:
    """Compute the row of the chaotic sea from many short runs, because one long run may stay near an island."""
    system, period = CHAOTIC.system, CHAOTIC.system.harmonic.period
    mean, spread = sea()
    dimension = sea_dimension()
    coarse = dimension.found.slopes[dimension.found.radii[:-1] >= COARSE].mean()
    return _row(
        "chaotic, figures 7c and 8c",
        system,
        ("0.14", "2.3"),
        f"{mean:.2f}, single runs ± {spread:.2f}",
        f"{mean / period:.2f}, single runs ± {spread / period:.2f}",
        dimension,
        f"nats per cycle over {SEA_CYCLES:,} cycles from {SEA_STARTS} phases within {SEA_PHASES:g}; decreases with the length. "
        f"No attractor: the sea fills an area, 2 in the section and 3 in the flow. A small number of points resolves radii above {COARSE} "
        f"standard deviations only; there the slope is {coarse:.1f} in the section and {coarse + 1:.1f} in the flow",
    )


def _braced() -> Row:
    spectrum = rk.lyapunov(BRACED, cycles=200_000, transient=1_000)
    dimension, error = spectrum.kaplan_yorke
    return _row(
        "chaotic between braces, figure 13a",
        BRACED,
        ("not given", "not given"),
        _pair(spectrum.per_cycle),
        _pair((spectrum.values, spectrum.errors)),
        _dimension(BRACED, 50_000, transient=1_000),
        f"a strange attractor: impacts contract area. Kaplan–Yorke dimension in the section: {dimension:.3f} ± {error:.3f}",
    )


def _row(
    response: str,
    system: rk.System,
    paper: tuple[str, str],
    per_cycle: str,
    per_tau: str,
    dimension: Dimension,
    why: str,
) -> Row:
    forcing = system.harmonic
    braces = f", Θb = {system.braces.angle:g}, r = {system.braces.restitution:g}" if system.braces else ""
    (low, high), isolated = dimension.found.interval, dimension.found.isolated
    remark = "" if dimension.scales else ", no uniform slope over a decade of radii"
    return Row(
        response=response,
        parameters=f"A = {forcing.amplitude:g}, T = {forcing.period:g}, e = {system.restitution:g}{braces}",
        paper_exponent=paper[0],
        exponent_per_cycle=per_cycle,
        exponent_per_tau=per_tau,
        paper_dimension=paper[1],
        section_dimension=f"{low:.2f} to {high:.2f}{remark}"
        if isolated is None
        else f"0 ({isolated} points)",
        flow_dimension=f"{low + 1:.2f} to {high + 1:.2f}{remark}" if isolated is None else "1",
        why=why,
    )


def _pair(exponents: tuple[np.ndarray, np.ndarray]) -> str:
    return " and ".join(plus_minus(value, error) for value, error in zip(*exponents, strict=True))


def _estimate(system: rk.System) -> float:
    """Return λ₁ per unit of τ, even if a single run is too short for an error."""
    try:
        return float(rk.lyapunov(system, cycles=SEA_CYCLES, transient=0).values[0])
    except rk.TooShort as short:
        return float(short.estimate.values[0])


def _dimension(system: rk.System, points: int, transient: int = 0) -> Dimension:
    motion = rk.simulate(system, cycles=transient + points - 1, record="section")
    return _dimension_of(motion.section()[transient:])


def _dimension_of(points: np.ndarray) -> Dimension:
    try:
        return Dimension(rk.correlation_dimension(points), scales=True)
    except rk.TooShort as short:
        return Dimension(short.estimate, scales=False)
