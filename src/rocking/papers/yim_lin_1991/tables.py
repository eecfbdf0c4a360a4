"""Table of Lyapunov exponents and fractal dimensions: numbers of the paper and computed values with errors.

The numbers of the paper stand in its sections "Response identification" and "Response of undamped systems". They
refer to the periodic, the quasi-periodic and the chaotic response of figures 7 and 8. The exponents are 0, 0 and
0.14, the dimensions 0, 2.0 and 2.3. Units, lengths of the runs and spaces are not given, nor any number for the
braced response of figure 13a.

Difference from the paper: both exponents of a damped periodic response are negative; zero is the exponent along the
flow, which every motion has. Dimensions refer to the section; the dimension in the flow is larger by one. Undamped
motions have no attractor: the chaotic sea fills an area, and its exponent decreases with the length of the run.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import rocking as rk
from rocking.model.text import plus_minus
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.page import write_table
from rocking.papers.yim_lin_1991 import surveys
from rocking.papers.yim_lin_1991.surveys import (
    BRACED,
    CHAOTIC,
    PERIODIC,
    QUASI_PERIODIC,
    Dimension,
    dimension,
)

if TYPE_CHECKING:
    from rocking.response.lyapunov import LyapunovSpectrum

HEADER = (
    "response", "parameters", "paper exponent", "exponent per cycle", "exponent per tau", "paper dimension", "section dimension",
    "flow dimension", "why",
)  # fmt: skip


@YIM_LIN_1991.table("exponents", cost=6.5)
def exponents(folder: Path) -> list[Path]:
    """Write the table as CSV and as Markdown."""
    rows = [_periodic(), _quasi_periodic(), _sea(), _braced()]
    return write_table(folder, "exponents", HEADER, rows)


def _periodic() -> list[str]:
    case = PERIODIC[1]
    spectrum = rk.lyapunov(case.system, cycles=100_000)
    return _row(
        f"{case.name}, figures 7a and 8a",
        case.system,
        ("0", "0"),
        _exponents(spectrum),
        dimension(case.system, 2_000, transient=2_000),
        "both exponents are ln e per impact; 0 is the exponent along the flow. Points have dimension 0 in the section",
    )


def _quasi_periodic() -> list[str]:
    system = QUASI_PERIODIC.system
    spectrum = rk.lyapunov(system, cycles=400_000)
    return _row(
        "quasi-periodic, figures 7b and 8b",
        system,
        ("0", "2.0"),
        _exponents(spectrum),
        dimension(system, 20_000),
        "the estimate decreases as the logarithm of the length over the length. Curves have dimension 1 in the section; 2 is "
        "the dimension of the torus in the flow",
    )


def _sea() -> list[str]:
    """Compute the row of the chaotic sea from many short runs, because one long run may stay near an island."""
    system, period = CHAOTIC.system, CHAOTIC.system.harmonic.period
    mean, spread = surveys.sea()
    section = surveys.sea_dimension()
    coarse = section.estimate.slopes[section.estimate.radii[:-1] >= surveys.COARSE].mean()
    return _row(
        "chaotic, figures 7c and 8c",
        system,
        ("0.14", "2.3"),
        [f"{mean / unit:.2f}, single runs ± {spread / unit:.2f}" for unit in (1.0, period)],
        section,
        f"nats per cycle over {surveys.SEA_CYCLES:,} cycles from {surveys.SEA_STARTS} phases within {surveys.SEA_PHASES:g}; decreases "
        "with the length. No attractor: the sea fills an area, 2 in the section and 3 in the flow. A small number of points resolves "
        f"radii above {surveys.COARSE} standard deviations only; there the slope is {coarse:.1f} in the section and {coarse + 1:.1f} in "
        "the flow",
    )


def _braced() -> list[str]:
    spectrum = rk.lyapunov(BRACED, cycles=200_000, transient=1_000)
    kaplan_yorke, error = spectrum.kaplan_yorke
    return _row(
        "chaotic between braces, figure 13a",
        BRACED,
        ("not given", "not given"),
        _exponents(spectrum),
        dimension(BRACED, 50_000, transient=1_000),
        f"a strange attractor: impacts contract area. Kaplan–Yorke dimension in the section: {kaplan_yorke:.3f} ± {error:.3f}",
    )


def _row(
    response: str,
    system: rk.System,
    paper: tuple[str, str],
    exponents: list[str],
    section: Dimension,
    why: str,
) -> list[str]:
    """Return a row as text: the numbers of the paper, the computed values, and the reason for the difference."""
    forcing = system.harmonic
    braces = f", Θb = {system.braces.angle:g}, r = {system.braces.restitution:g}" if system.braces else ""
    (low, high), isolated = section.estimate.interval, section.estimate.isolated
    remark = "" if section.scales else ", no uniform slope over a decade of radii"
    section_dimension, flow_dimension = (
        [f"{low + flow:.2f} to {high + flow:.2f}{remark}" for flow in (0, 1)]
        if isolated is None
        else [f"0 ({isolated} points)", "1"]
    )
    return [
        response,
        f"A = {forcing.amplitude:g}, T = {forcing.period:g}, e = {system.restitution:g}{braces}",
        paper[0],
        *exponents,
        paper[1],
        section_dimension,
        flow_dimension,
        why,
    ]


def _exponents(spectrum: LyapunovSpectrum) -> list[str]:
    """Return both exponents with their errors as text, per cycle and per unit of τ."""
    return [
        " and ".join(plus_minus(value, error) for value, error in zip(*exponents, strict=True))
        for exponents in (spectrum.per_cycle, (spectrum.values, spectrum.errors))
    ]
