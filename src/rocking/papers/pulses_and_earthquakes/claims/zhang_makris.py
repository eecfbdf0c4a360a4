"""Rows on Zhang & Makris (2001): the two modes of overturning under one sine, p = 2.14 1/s, slenderness 0.25, e = 0.9."""

from __future__ import annotations

import math
from functools import partial

from scipy.optimize import brentq, minimize_scalar

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.judging import INTEGRATION, THIRD_DIGIT, outside
from rocking.papers.report.claim import Chapter, Finding, small

CHAPTER = Chapter("Zhang & Makris (2001)")
E, FREQUENCY = 0.9, 5.0
PARAMETER, SLENDERNESS = 2.14, 0.25
FAST = 15.7 / PARAMETER
"""Ω of the pulse of 15.7 rad/s."""
FREQUENCY_DIGIT = 0.01
"""One unit of the last printed digit of the frequency at which mode 1 ends."""
IMPACT_DIGIT = 0.05
"""Half a unit of the last printed digit of the frequency up to which the impact falls into the pulse."""
THIRD = f"{INTEGRATION} one unit of the third digit"


def _pair(no: float, yes: float, stands: float, overturns: float) -> Finding:
    found = thresholds.threshold("one-sine", FREQUENCY, E, no, yes)
    apart = outside(found, stands, overturns)
    return Finding(
        apart == 0.0,
        f"threshold {found:.6f}; {'between' if apart == 0.0 else f'{small(apart)} beyond'} the printed numbers",
        shown=apart <= THIRD_DIGIT,
    )


@CHAPTER.claim("Figs. 7, 8", qualified=THIRD)
def mode_1_begins() -> Finding:
    """Slender block, one sine with Ω = 5: A = 3.00 stands, 3.01 overturns."""
    return _pair(2.9, 3.2, 3.00, 3.01)


@CHAPTER.claim("Figs. 7, 8", qualified=THIRD)
def mode_1_ends() -> Finding:
    """Slender block, one sine with Ω = 5: A = 6.32 overturns, 6.33 stands."""
    return _pair(6.5, 6.2, 6.33, 6.32)


@CHAPTER.claim("Figs. 7, 8", qualified=THIRD)
def mode_2_begins() -> Finding:
    """Slender block, one sine with Ω = 5: A = 7.17 stands, 7.18 overturns."""
    return _pair(7.0, 7.3, 7.17, 7.18)


@CHAPTER.claim("Figs. 7, 8")
def order() -> Finding:
    """As A grows the block stands, overturns after an impact, stands, and overturns without an impact."""
    said = []
    for amplitude in (2.9, 4.5, 6.7, 7.5):
        motion = thresholds.run("one-sine", amplitude, FREQUENCY, E)
        fallen = motion.outcome is rk.Outcome.OVERTURNED
        said.append((amplitude, fallen, motion.impacts if fallen else -1))
    return Finding(
        [fallen[1:] for fallen in said] == [(False, -1), (True, 1), (False, -1), (True, 0)],
        "; ".join(
            f"A = {amplitude:g} {f'overturns, impacts: {impacts}' if fallen else 'stands'}"
            for amplitude, fallen, impacts in said
        ),
    )


@CHAPTER.claim("Eq. (47)")
def mode_2() -> Finding:
    """Overturning without an impact: Ω sin ψ − cos ψ = −exp(−(2π − ψ)/Ω), A = 1/sin ψ."""
    worst = 0.0
    for rate in (1.0, 3.0, 5.0, 8.0):
        edge = rk.theory.one_sine_pulse_amplitude(math.tau / rate)
        found = thresholds.bisected(partial(thresholds.at_once, "one-sine", rate), 1.0, 2 * edge)
        worst = max(worst, abs(found / edge - 1))
    return Finding(
        worst < 1e-10,
        f"{rk.theory.one_sine_pulse_amplitude(math.tau / 5):.12f} at Ω = 5; simulated thresholds at Ω = 1, 3, 5, 8 are equal to "
        f"within {small(worst)}",
    )


@CHAPTER.claim("Pulse of 15.7 rad/s", qualified=THIRD)
def fast_mode_2() -> Finding:
    """Slender block, p = 2.14 1/s, slenderness 0.25: a sine of 15.7 rad/s overturns at 3.24 g, by mode 2."""
    found = SLENDERNESS * thresholds.threshold(
        "one-sine", FAST, E, 0.9 * 3.24 / SLENDERNESS, 1.1 * 3.24 / SLENDERNESS
    )
    motion = thresholds.run("one-sine", 1.001 * found / SLENDERNESS, FAST, E)
    apart = outside(found, 3.235, 3.245)
    return Finding(
        apart == 0.0 and motion.impacts == 0,
        f"threshold {found:.6f} g, impacts before overturning: {motion.impacts}",
        shown=abs(found - 3.24) <= THIRD_DIGIT and motion.impacts == 0,
    )


@CHAPTER.claim("Pulse of 15.7 rad/s")
def fast_mode_1() -> Finding:
    """Full equation: a sine of 15.7 rad/s overturns at 2.22 g, by mode 1."""
    begins, ends, again = (
        SLENDERNESS
        * thresholds.threshold("one-sine", FAST, E, no / SLENDERNESS, yes / SLENDERNESS, SLENDERNESS)
        for no, yes in ((2.0, 2.4), (3.0, 2.4), (3.0, 3.6))
    )
    motion = thresholds.run("one-sine", 1.001 * begins / SLENDERNESS, FAST, E, SLENDERNESS)
    low, _ = rk.theory.one_sine_impact_amplitudes(math.tau / FAST, E)
    slender = "does not exist" if math.isnan(low) else f"begins at {low * SLENDERNESS:.4f} g"
    return Finding(
        outside(begins, 2.215, 2.225) == 0.0 and motion.impacts == 1,
        f"threshold {begins:.6f} g, impacts before overturning: {motion.impacts}; the block stands from {ends:.4f} g and overturns from "
        f"{again:.4f} g. Slender block: mode 1 {slender} at this frequency",
    )


def _end_of_mode_1() -> float:
    return thresholds.bisected(
        lambda rate: math.isnan(rk.theory.one_sine_impact_amplitudes(math.tau / rate, E)[1]), 5.0, 8.0
    )


@CHAPTER.claim(
    "End of mode 1",
    qualified="the printed number comes from numerical integration, and the exact end is lower by less than one unit of its last digit",
)
def highest_frequency() -> Finding:
    """Slender block, e = 0.9: mode 1 ends at Ω = 6.59."""
    found = _end_of_mode_1()
    lower = 6.59 - found
    return Finding(
        abs(lower) <= FREQUENCY_DIGIT / 2, f"Ω = {found:.5f}", shown=0.0 <= lower <= FREQUENCY_DIGIT
    )


def _least_lacking(frequency: float) -> float:
    """Return what the full block lacks to overturn by mode 1, at the amplitude at which it lacks least; negative if it overturns."""
    return float(
        minimize_scalar(
            lambda amplitude: thresholds.speed_lacking("one-sine", amplitude, frequency, E, SLENDERNESS),
            bounds=(9.0, 11.5),
            method="bounded",
        ).fun
    )


@CHAPTER.claim(
    "End of mode 1",
    qualified="the exact end lies lower. At the printed frequency the block lacks so little speed that an error of integration can "
    "explain the print. The numbers of Figs. 7, 8 have errors of that size",
)
def highest_frequency_full() -> Finding:
    """Full equation, e = 0.9: mode 1 ends at Ω = 7.58."""
    found, lacks = brentq(_least_lacking, 7.4, 7.7), _least_lacking(7.58)
    falls, stands = (thresholds.speed_lacking("one-sine", value, FREQUENCY, E) for value in (3.01, 3.00))
    return Finding(
        abs(found - 7.58) <= FREQUENCY_DIGIT / 2,
        f"slenderness {SLENDERNESS:g}: Ω = {found:.5f}. At Ω = 7.58 the speed after the impact is {100 * lacks:.2f} % too small to "
        f"overturn the block. Slender block, Ω = 5: at A = 3.01, which overturns in the print, it is {100 * falls:.2f} % too small, "
        f"at A = 3.00, which stands, {100 * stands:.2f} %",
        shown=0.0 < falls <= lacks <= stands,
    )


@CHAPTER.claim("Impact in the pulse")
def impact_inside() -> Finding:
    """Slender block, e = 0.9: the impact of mode 1 falls into the pulse up to Ω = 4.8."""
    found = thresholds.bisected(
        lambda rate: not math.isnan(rk.theory.one_sine_impact_amplitudes(math.tau / rate, E)[0]), 4.0, 6.0
    )
    return Finding(abs(found - 4.8) <= IMPACT_DIGIT, f"Ω = {found:.5f}, at the lower end of mode 1")
