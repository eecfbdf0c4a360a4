"""Rows on Housner (1963), Shi et al. (1996), Makris & Roussos (2000) and Zhang & Makris (2001): blocks under one pulse."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from attrs import evolve
from scipy.optimize import brentq, minimize_scalar

import rocking as rk
from rocking.papers.catalogue import PULSES_AND_EARTHQUAKES
from rocking.papers.pulses_and_earthquakes import surveys, thresholds
from rocking.papers.pulses_and_earthquakes.thresholds import IN_G, THIRD_DIGIT, outside
from rocking.papers.report.claim import Finding, small

HOUSNER = PULSES_AND_EARTHQUAKES.chapter("Housner (1963)")
# Closed forms of free motions against the simulation: some tens of roundings per impact.
ROUNDING = 1e-12
BISECTED = 1e-10
FREQUENCIES = (0.5, 1.0, 2.0, 3.0, 5.0)


@HOUSNER.claim("Eqs. (3)–(6)")
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


@HOUSNER.claim("Eq. (9)")
def rectangular() -> Finding:
    """A rectangular pulse of amplitude A and duration T overturns the block if cosh T ≥ 1 + 1/(2A(A − 1))."""
    worst_form = worst_run = 0.0
    for duration in (0.3, 0.7, 1.0, 2.0, 4.0):
        a = rk.theory.rectangular_pulse_amplitude(duration)
        worst_form = max(worst_form, abs(math.acosh(1 + 1 / (2 * a * (a - 1))) / duration - 1))
        threshold = thresholds.threshold("rectangular", math.pi / duration, 0.9, 1.0, 2 * a)
        worst_run = max(worst_run, abs(threshold / a - 1))
    return Finding(
        worst_form < ROUNDING and worst_run < BISECTED,
        f"T = 0.3, 0.7, 1, 2, 4: A = 1/(1 − exp(−T)) solves the equation to within {small(worst_form)}; the simulation begins to "
        f"overturn there, to within {small(worst_run)}; A = {rk.theory.rectangular_pulse_amplitude(1.0):.6f} at T = 1",
    )


@HOUSNER.claim(
    "Eq. (12)",
    error="its end condition is not that of overturning: blocks overturn at smaller amplitudes, so that the formula is unconservative",
    main=True,
)
def half_sine_by_housner() -> Finding:
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
        explained=all(between) and all(one > other for one, other in zip(printed, exact, strict=True)),
    )


MAKRIS_ROUSSOS = PULSES_AND_EARTHQUAKES.chapter("Shi et al. (1996) and Makris & Roussos (2000)")
LINE = np.linspace(0.25, 3.0, 12)
"""Ω of the straight lines, which are meant for Ω below 3."""
CLOSE_BY = "the exact threshold lies beyond the printed pair by less than"
FIXED_STEPS = f"{CLOSE_BY} 10⁻³ g, an error that integration in fixed steps may have"
CLOSE = 0.05
"""Difference to which a printed straight line counts as close: the papers name none."""
SLENDER = rk.Block(height=3.0, width=1.0)
"""Block of Figs. 9 and 11: b = 0.5 m, h = 1.5 m."""
MODEST = rk.Block(height=1.2, width=0.4)
"""Block of Fig. 2: b = 0.2 m, h = 0.6 m."""
PHASE_DIGIT = 5e-5
"""Half a unit of the last printed digit of φ/π."""


@MAKRIS_ROUSSOS.claim("Eq. (27) of Makris & Roussos; Shi et al.")
def half_sine() -> Finding:
    """A half sine overturns the block at A = 1/sin ψ with Ω sin ψ − cos ψ = exp(−(π − ψ)/Ω)."""
    worst, listed = 0.0, []
    for rate in FREQUENCIES:
        edge = rk.theory.half_sine_pulse_amplitude(math.pi / rate)
        threshold = thresholds.threshold("half-sine", rate, 0.9, 1.0, 2 * edge)
        worst = max(worst, abs(threshold / edge - 1))
        listed.append(f"{rate:g}: {threshold:.8f}")
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
        explained=above > CLOSE,
    )


@MAKRIS_ROUSSOS.claim(
    "Eq. (28)",
    qualified="a straight line of the right size. It lies above the exact threshold, so that it is unconservative",
    cost=0.2,
    main=True,
)
def line_half_sine() -> Finding:
    """Half sine: A ≈ 1 + Ω/2 for Ω < 3."""
    return _line("half-sine", 2)


@MAKRIS_ROUSSOS.claim(
    "Eqs. (41)–(45)",
    qualified="close for slow pulses. The line lies above the exact threshold, so that it is unconservative, most near Ω = 2",
    cost=0.1,
)
def line_one_sine() -> Finding:
    """One sine: A ≈ 1 + Ω/6 for Ω < 3."""
    return _line("one-sine", 6)


@MAKRIS_ROUSSOS.claim(
    "Eqs. (41)–(45)",
    qualified="near Ω = 1.5 the line lies above the exact threshold, so that it is unconservative there",
    cost=0.1,
)
def line_one_cosine() -> Finding:
    """One cosine: A ≈ 1 + Ω/4 for Ω < 3."""
    return _line("one-cosine", 4)


@MAKRIS_ROUSSOS.claim("Eq. (40)")
def phases() -> Finding:
    """Type-Cn pulses: the phase is 0.0697π for n = 1 and 0.0410π for n = 2."""
    # The base accelerates as cos(ωt + φ) for n + ½ cycles less 2φ; its velocity and its displacement vanish at the end.
    fractions = [
        brentq(
            lambda phi, n=n: ((2 * n + 1) * math.pi - 2 * phi) * math.sin(phi) - 2 * math.cos(phi), 0.0, 0.5
        )
        / math.pi
        for n in (1, 2)
    ]
    return Finding(
        all(abs(one - other) < PHASE_DIGIT for one, other in zip(fractions, (0.0697, 0.0410), strict=True)),
        f"{fractions[0]:.6f}π and {fractions[1]:.6f}π, from a base that is at rest in its first place at the end of the pulse",
    )


def _between(threshold: float, stands: float, overturns: float, error: float, unit: str = "") -> Finding:
    """Compare a threshold with two printed numbers; `error` is a difference that the explanation allows."""
    apart = outside(threshold, stands, overturns)
    return Finding(
        apart == 0.0,
        f"threshold {threshold:.6f}{unit}; {'between' if apart == 0.0 else f'{small(apart)}{unit} beyond'} the printed numbers",
        explained=apart <= error,
    )


def _acceleration(
    block: rk.Block, kind: str, duration: float, stands: float, overturns: float, angle: float | None = None
) -> Finding:
    threshold = thresholds.in_g(block, kind, duration, stands - 0.02, overturns + 0.02, angle)
    return _between(threshold, stands, overturns, IN_G, " g")


@MAKRIS_ROUSSOS.claim("Fig. 2", qualified=FIXED_STEPS)
def figure_2() -> Finding:
    """b = 0.2 m, h = 0.6 m, half sine of 0.5 s: 0.5535 g stands, 0.5545 g overturns."""
    return _acceleration(MODEST, "half-sine", 0.5, 0.5535, 0.5545)


@MAKRIS_ROUSSOS.claim("Fig. 9", qualified=FIXED_STEPS)
def figure_9() -> Finding:
    """b = 0.5 m, h = 1.5 m, one sine of 1 s: 0.4513 g stands, 0.4514 g overturns."""
    return _acceleration(SLENDER, "one-sine", 1.0, 0.4513, 0.4514)


@MAKRIS_ROUSSOS.claim("Fig. 11", qualified=FIXED_STEPS)
def figure_11() -> Finding:
    """b = 0.5 m, h = 1.5 m, one cosine of 1 s: 0.6245 g stands, 0.6255 g overturns."""
    full = _acceleration(SLENDER, "one-cosine", 1.0, 0.6245, 0.6255, SLENDER.critical_angle)
    slender = thresholds.in_g(SLENDER, "one-cosine", 1.0, 0.58, 0.63)
    return evolve(full, figures=f"full equation: {full.figures}. Slender block: {slender:.6f} g")


@MAKRIS_ROUSSOS.claim("Recorded motions", untested=surveys.NO_RECORD)
def recorded() -> Finding:
    """b = 0.5 m, h = 1.5 m: Rinaldi 75 % stands, 76 % overturns; Array #5 122 % and 124 %; Lucerne 273 % and 274 %."""
    return Finding(
        False,
        f"the block: e = {SLENDER.restitution:g}, p = {SLENDER.frequency_parameter:.4f} 1/s",
        explained=True,
    )


ZHANG_MAKRIS = PULSES_AND_EARTHQUAKES.chapter("Zhang & Makris (2001)")
E, FREQUENCY = 0.9, 5.0
PARAMETER, SLENDERNESS = 2.14, 0.25
FAST = 15.7 / PARAMETER
"""Ω of the pulse of 15.7 rad/s."""
FREQUENCY_DIGIT = 0.01
"""One unit of the last printed digit of the frequency at which mode 1 ends."""
IMPACT_DIGIT = 0.05
"""Half a unit of the last printed digit of the frequency up to which the impact falls into the pulse."""
THIRD = f"the printed numbers come from numerical integration, and {CLOSE_BY} one unit of the third digit"


def _amplitude(no: float, yes: float, stands: float, overturns: float) -> Finding:
    threshold = thresholds.threshold("one-sine", FREQUENCY, E, no, yes)
    return _between(threshold, stands, overturns, THIRD_DIGIT)


@ZHANG_MAKRIS.claim("Figs. 7, 8", qualified=THIRD)
def mode_1_begins() -> Finding:
    """Slender block, one sine with Ω = 5: A = 3.00 stands, 3.01 overturns."""
    return _amplitude(2.9, 3.2, 3.00, 3.01)


@ZHANG_MAKRIS.claim("Figs. 7, 8", qualified=THIRD)
def mode_1_ends() -> Finding:
    """Slender block, one sine with Ω = 5: A = 6.32 overturns, 6.33 stands."""
    return _amplitude(6.5, 6.2, 6.33, 6.32)


@ZHANG_MAKRIS.claim("Figs. 7, 8", qualified=THIRD)
def mode_2_begins() -> Finding:
    """Slender block, one sine with Ω = 5: A = 7.17 stands, 7.18 overturns."""
    return _amplitude(7.0, 7.3, 7.17, 7.18)


@ZHANG_MAKRIS.claim("Figs. 7, 8", main=True)
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


@ZHANG_MAKRIS.claim("Eq. (47)")
def mode_2() -> Finding:
    """Overturning without an impact: Ω sin ψ − cos ψ = −exp(−(2π − ψ)/Ω), A = 1/sin ψ."""
    worst = 0.0
    for rate in (1.0, 3.0, 5.0, 8.0):
        edge = rk.theory.one_sine_pulse_amplitude(math.tau / rate)
        threshold = thresholds.bisected(partial(thresholds.at_once, "one-sine", rate), 1.0, 2 * edge)
        worst = max(worst, abs(threshold / edge - 1))
    return Finding(
        worst < 1e-10,
        f"{rk.theory.one_sine_pulse_amplitude(math.tau / 5):.12f} at Ω = 5; simulated thresholds at Ω = 1, 3, 5, 8 are equal to "
        f"within {small(worst)}",
    )


@ZHANG_MAKRIS.claim("Pulse of 15.7 rad/s", qualified=THIRD)
def fast_mode_2() -> Finding:
    """Slender block, p = 2.14 1/s, slenderness 0.25: a sine of 15.7 rad/s overturns at 3.24 g, by mode 2."""
    threshold = SLENDERNESS * thresholds.threshold(
        "one-sine", FAST, E, 0.9 * 3.24 / SLENDERNESS, 1.1 * 3.24 / SLENDERNESS
    )
    motion = thresholds.run("one-sine", 1.001 * threshold / SLENDERNESS, FAST, E)
    apart = outside(threshold, 3.235, 3.245)
    return Finding(
        apart == 0.0 and motion.impacts == 0,
        f"threshold {threshold:.6f} g, impacts before overturning: {motion.impacts}",
        explained=abs(threshold - 3.24) <= THIRD_DIGIT and motion.impacts == 0,
    )


@ZHANG_MAKRIS.claim("Pulse of 15.7 rad/s")
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


@ZHANG_MAKRIS.claim(
    "End of mode 1",
    qualified="the printed number comes from numerical integration, and the exact end is lower by less than one unit of its last digit",
)
def highest_frequency() -> Finding:
    """Slender block, e = 0.9: mode 1 ends at Ω = 6.59."""
    end = _end_of_mode_1()
    lower = 6.59 - end
    return Finding(
        abs(lower) <= FREQUENCY_DIGIT / 2, f"Ω = {end:.5f}", explained=0.0 <= lower <= FREQUENCY_DIGIT
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


@ZHANG_MAKRIS.claim(
    "End of mode 1",
    qualified="the exact end lies lower. At the printed frequency the block lacks so little speed that an error of integration can "
    "explain the print. The numbers of Figs. 7, 8 have errors of that size",
)
def highest_frequency_full() -> Finding:
    """Full equation, e = 0.9: mode 1 ends at Ω = 7.58."""
    end, lacks = brentq(_least_lacking, 7.4, 7.7), _least_lacking(7.58)
    falls, stands = (thresholds.speed_lacking("one-sine", value, FREQUENCY, E) for value in (3.01, 3.00))
    return Finding(
        abs(end - 7.58) <= FREQUENCY_DIGIT / 2,
        f"slenderness {SLENDERNESS:g}: Ω = {end:.5f}. At Ω = 7.58 the speed after the impact is {100 * lacks:.2f} % too small to "
        f"overturn the block. Slender block, Ω = 5: at A = 3.01, which overturns in the print, it is {100 * falls:.2f} % too small, "
        f"at A = 3.00, which stands, {100 * stands:.2f} %",
        explained=0.0 < falls <= lacks <= stands,
    )


@ZHANG_MAKRIS.claim("Impact in the pulse")
def impact_inside() -> Finding:
    """Slender block, e = 0.9: the impact of mode 1 falls into the pulse up to Ω = 4.8."""
    end = thresholds.bisected(
        lambda rate: not math.isnan(rk.theory.one_sine_impact_amplitudes(math.tau / rate, E)[0]), 4.0, 6.0
    )
    return Finding(abs(end - 4.8) <= IMPACT_DIGIT, f"Ω = {end:.5f}, at the lower end of mode 1")
