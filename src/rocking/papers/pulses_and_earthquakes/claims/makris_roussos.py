"""Rows on Shi et al. (1996) and Makris & Roussos (2000): half sine, one sine, one cosine, and type-Cn pulses."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve
from scipy.optimize import brentq

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.judging import BEYOND, IN_G, NO_RECORD, outside
from rocking.papers.report.claim import Chapter, Finding, small

CHAPTER = Chapter("Shi et al. (1996) and Makris & Roussos (2000)")
FREQUENCIES = (0.5, 1.0, 2.0, 3.0, 5.0)
LINE = np.linspace(0.25, 3.0, 12)
"""Ω of the straight lines, which are meant for Ω below 3."""
CLOSE = 0.05
"""Difference to which a printed straight line counts as close: the papers name none."""
SLENDER = rk.Block(height=3.0, width=1.0)
"""Block of Figs. 9 and 11: b = 0.5 m, h = 1.5 m."""
MODEST = rk.Block(height=1.2, width=0.4)
"""Block of Fig. 2: b = 0.2 m, h = 0.6 m."""
PHASE_DIGIT = 5e-5
"""Half a unit of the last printed digit of φ/π."""


@CHAPTER.claim("Eq. (27) of Makris & Roussos; Shi et al.")
def half_sine() -> Finding:
    """A half sine overturns the block at A = 1/sin ψ with Ω sin ψ − cos ψ = exp(−(π − ψ)/Ω)."""
    worst, listed = 0.0, []
    for rate in FREQUENCIES:
        edge = rk.theory.half_sine_pulse_amplitude(math.pi / rate)
        found = thresholds.threshold("half-sine", rate, 0.9, 1.0, 2 * edge)
        worst = max(worst, abs(found / edge - 1))
        listed.append(f"{rate:g}: {found:.8f}")
    return Finding(
        worst < 1e-10,
        f"simulated thresholds by Ω = {'; '.join(listed)}; the formula is equal to within {small(worst)}",
    )


def _line(kind: str, divisor: float) -> Finding:
    """Compare 1 + Ω/divisor with the lowest amplitude that overturns the block of Fig. 9."""
    exact = thresholds.lowest_of(kind, LINE, SLENDER.restitution)
    relative = (1 + LINE / divisor) / exact - 1
    above, below = float(relative.max()), float(relative.min())
    where = LINE[int(np.abs(relative).argmax())]
    return Finding(
        max(above, -below) < CLOSE,
        f"Ω from {LINE[0]:g} to 3, e = {SLENDER.restitution:g}: the line differs from the lowest overturning amplitude by "
        f"{100 * below:.1f} % to {100 * above:.1f} %, most at Ω = {where:g}",
        shown=above > CLOSE,
    )


@CHAPTER.claim(
    "Eq. (28)",
    qualified="a straight line of the right size. It lies above the exact threshold, so that it is unconservative",
    cost=0.2,
)
def line_half_sine() -> Finding:
    """Half sine: A ≈ 1 + Ω/2 for Ω < 3."""
    return _line("half-sine", 2)


@CHAPTER.claim(
    "Eqs. (41)–(45)",
    qualified="close for slow pulses. Near Ω = 2 the line lies above the exact threshold, so that it is unconservative there",
    cost=0.1,
)
def line_one_sine() -> Finding:
    """One sine: A ≈ 1 + Ω/6 for Ω < 3."""
    return _line("one-sine", 6)


@CHAPTER.claim(
    "Eqs. (41)–(45)",
    qualified="near Ω = 1.5 the line lies above the exact threshold, so that it is unconservative there",
    cost=0.1,
)
def line_one_cosine() -> Finding:
    """One cosine: A ≈ 1 + Ω/4 for Ω < 3."""
    return _line("one-cosine", 4)


@CHAPTER.claim("Eq. (40)")
def phases() -> Finding:
    """Type-Cn pulses: the phase is 0.0697π for n = 1 and 0.0410π for n = 2."""
    # The base accelerates as cos(ωt + φ) for n + ½ cycles less 2φ; its velocity and its displacement vanish at the end.
    found = [
        brentq(
            lambda phi, n=n: ((2 * n + 1) * math.pi - 2 * phi) * math.sin(phi) - 2 * math.cos(phi), 0.0, 0.5
        )
        / math.pi
        for n in (1, 2)
    ]
    return Finding(
        all(abs(one - other) < PHASE_DIGIT for one, other in zip(found, (0.0697, 0.0410), strict=True)),
        f"{found[0]:.6f}π and {found[1]:.6f}π, from a base that is at rest in its first place at the end of the pulse",
    )


def _pair(
    block: rk.Block,
    kind: str,
    duration: float,
    stands: float,
    overturns: float,
    angle: float | None = None,
) -> Finding:
    found = thresholds.in_g(block, kind, duration, stands - 0.02, overturns + 0.02, angle)
    apart = outside(found, stands, overturns)
    return Finding(
        apart == 0.0,
        f"threshold {found:.6f} g; {'between' if apart == 0.0 else f'{small(apart)} g beyond'} the printed numbers",
        shown=apart <= IN_G,
    )


@CHAPTER.claim("Fig. 2", qualified=f"{BEYOND} 10⁻³ g, an error that integration in fixed steps may have")
def figure_2() -> Finding:
    """b = 0.2 m, h = 0.6 m, half sine of 0.5 s: 0.5535 g stands, 0.5545 g overturns."""
    return _pair(MODEST, "half-sine", 0.5, 0.5535, 0.5545)


@CHAPTER.claim("Fig. 9", qualified=f"{BEYOND} 10⁻³ g, an error that integration in fixed steps may have")
def figure_9() -> Finding:
    """b = 0.5 m, h = 1.5 m, one sine of 1 s: 0.4513 g stands, 0.4514 g overturns."""
    return _pair(SLENDER, "one-sine", 1.0, 0.4513, 0.4514)


@CHAPTER.claim("Fig. 11", qualified=f"{BEYOND} 10⁻³ g, an error that integration in fixed steps may have")
def figure_11() -> Finding:
    """b = 0.5 m, h = 1.5 m, one cosine of 1 s: 0.6245 g stands, 0.6255 g overturns."""
    full = _pair(SLENDER, "one-cosine", 1.0, 0.6245, 0.6255, SLENDER.critical_angle)
    slender = thresholds.in_g(SLENDER, "one-cosine", 1.0, 0.58, 0.63)
    return evolve(full, figures=f"full equation: {full.figures}. Slender block: {slender:.6f} g")


@CHAPTER.claim("Recorded motions", not_judged=NO_RECORD)
def recorded() -> Finding:
    """b = 0.5 m, h = 1.5 m: Rinaldi 75 % stands, 76 % overturns; Array #5 122 % and 124 %; Lucerne 273 % and 274 %."""
    return Finding(
        False,
        f"the block: e = {SLENDER.restitution:g}, p = {SLENDER.frequency_parameter:.4f} 1/s",
        shown=True,
    )
