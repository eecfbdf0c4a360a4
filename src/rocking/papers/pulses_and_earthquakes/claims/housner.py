"""Rows on Housner (1963): free rocking, the rectangular pulse and the half sine."""

from __future__ import annotations

import math

import numpy as np

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.report.claim import Chapter, Finding, small

CHAPTER = Chapter("Housner (1963)")
# Closed forms of free motions against the simulation: some tens of roundings per impact.
ROUNDING = 1e-12
BISECTED = 1e-10
FREQUENCIES = (0.5, 1.0, 2.0, 3.0, 5.0)


@CHAPTER.claim("Eqs. (3)–(6)")
def free_rocking() -> Finding:
    """A block released at the angle φ₀θcr has the period T = (4/p) arcosh(1/(1 − φ₀)).

    Its peak after n impacts is φₙ = 1 − √(1 − rⁿ[1 − (1 − φ₀)²]). Each impact leaves the part r of the kinetic energy.
    """
    worst_time = worst_peak = 0.0
    for angle in (0.05, 0.4, 0.9):
        for e in (0.7, 0.925):
            motion = rk.simulate(
                rk.System(rk.Harmonic(0.0, period=1.0), e), rk.State(angle=angle), cycles=400
            )
            impact = motion.events[motion.events["kind"] == "impact"]["time"][0]
            worst_time = max(worst_time, abs(impact / math.acosh(1 / (1 - angle)) - 1))
            peaks = np.abs(motion.peaks["angle"][:6])
            n = np.arange(1, peaks.size + 1)
            printed = 1 - np.sqrt(1 - e ** (2 * n) * (1 - (1 - angle) ** 2))
            worst_peak = max(worst_peak, float(np.abs(peaks - printed).max()))
    return Finding(
        worst_time < ROUNDING and worst_peak < ROUNDING,
        f"φ₀ = 0.05, 0.4, 0.9 and r = e², e = 0.7, 0.925: quarter periods of the simulation equal to within {small(worst_time)}, "
        f"six peaks to within {small(worst_peak)}",
    )


@CHAPTER.claim("Eq. (9)")
def rectangular() -> Finding:
    """A rectangular pulse of amplitude A and duration T overturns the block if cosh T ≥ 1 + 1/(2A(A − 1))."""
    worst_form = worst_run = 0.0
    for duration in (0.3, 0.7, 1.0, 2.0, 4.0):
        a = rk.theory.rectangular_pulse_amplitude(duration)
        worst_form = max(worst_form, abs(math.acosh(1 + 1 / (2 * a * (a - 1))) / duration - 1))
        found = thresholds.threshold("rectangular", math.pi / duration, 0.9, 1.0, 2 * a)
        worst_run = max(worst_run, abs(found / a - 1))
    return Finding(
        worst_form < ROUNDING and worst_run < BISECTED,
        f"T = 0.3, 0.7, 1, 2, 4: A = 1/(1 − exp(−T)) solves the equation to within {small(worst_form)}; the simulation begins to "
        f"overturn there, to within {small(worst_run)}; A = {rk.theory.rectangular_pulse_amplitude(1.0):.6f} at T = 1",
    )


@CHAPTER.claim(
    "Eq. (12)",
    error="its end condition is not that of overturning: blocks overturn at smaller amplitudes, so that the formula is unconservative",
)
def half_sine() -> Finding:
    """A half sine of frequency Ω overturns the block at A = √(1 + Ω²)."""
    printed = [math.sqrt(1 + rate**2) for rate in FREQUENCIES]
    exact = [rk.theory.half_sine_pulse_amplitude(math.pi / rate) for rate in FREQUENCIES]
    between = [
        thresholds.falls("half-sine", 0.5 * (one + other), rate, 0.9)
        for one, other, rate in zip(printed, exact, FREQUENCIES, strict=True)
    ]
    listed = "; ".join(
        f"{rate:g}: {one:.4f} printed, {other:.4f} exact"
        for rate, one, other in zip(FREQUENCIES, printed, exact, strict=True)
    )
    return Finding(
        max(abs(one - other) for one, other in zip(printed, exact, strict=True)) < 1e-4,
        f"A by Ω = {listed}. Halfway between the two the simulated block overturns in {sum(between)} of {len(between)} cases",
        shown=all(between) and all(one > other for one, other in zip(printed, exact, strict=True)),
    )
