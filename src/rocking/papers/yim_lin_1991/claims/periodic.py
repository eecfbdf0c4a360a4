"""Claims on the existence and stability of symmetric (1, n) modes, Eqs. (8) to (10)."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.model.orbit import Mode
from rocking.papers.report.claim import Chapter, Finding, small
from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.cases import PERIODIC

CHAPTER = Chapter("Existence and stability of periodic response")
MODES = (1, 3, 5, 7)
DRAWN = 2_000


def _drawn() -> list[list[Mode]]:
    """Return the (1, n) modes of random systems, e from 0.2 to 1."""
    rng = np.random.default_rng(1991)
    low, high = cached_surveys.PERIODS
    return [
        rk.theory.symmetric_modes(
            rng.uniform(0.0, 16.0), rng.uniform(low, high), rng.uniform(0.2, 0.999), int(rng.choice(MODES))
        )
        for _ in range(DRAWN)
    ]


@CHAPTER.claim("Eq. (8)")
def equation_8() -> Finding:
    """The first half-cycle of a (1, n) mode in closed form; the second by time shift and change of sign."""
    worst, figures = 0.0, []
    for case, n in ((PERIODIC[0], 1), (PERIODIC[1], 3)):
        mode = rk.theory.symmetric_modes(
            case.system.harmonic.amplitude, case.system.harmonic.period, 0.925, n
        )[0]
        hits = rk.simulate(mode.system, mode.start, cycles=20 * n).events
        hits = hits[hits["kind"] == "impact"][:20]
        half = 0.5 * n * mode.period
        off = max(
            np.abs(np.abs(hits["after"]) - mode.velocity).max(),
            np.abs(hits["time"] - half * np.arange(1, len(hits) + 1)).max(),
        )
        worst = max(worst, float(off))
        figures.append(f"(1, {n}): V = {mode.velocity:.10f}")
    return Finding(
        worst < 1e-10,
        f"{', '.join(figures)}; times and speeds of 20 simulated impacts agree with the closed form to {small(worst)}",
    )


@CHAPTER.claim(
    "Existence",
    error="there are two only between the fold and A = t(1 + Ω²)/Ω, t = tanh(nπ/2Ω). Above that amplitude the second solution "
    "would have a negative speed, and only one remains",
    cost=0.2,
)
def pairs() -> Finding:
    """Either there is no solution, or there are two."""
    drawn = _drawn()
    counts = [len(modes) for modes in drawn]
    one = counts.count(1)
    shown = all(
        modes[0].amplitude >= rk.theory.slower_mode_amplitude(modes[0].period, modes[0].n)
        for modes in drawn
        if len(modes) == 1
    )
    of_figures = [
        len(rk.theory.symmetric_modes(*arguments))
        for arguments in ((2.0, 1.0, 0.925, 1), (6.5, 0.4, 0.925, 3), (4.0, 0.4, 1.0, 3))
    ]
    return Finding(
        one == 0,
        f"solutions of {DRAWN:,} random systems: none in {counts.count(0)}, one in {one}, two in {counts.count(2)}; "
        f"of the systems of figures 2a, 2b and 5: {', '.join(map(str, of_figures))}",
        shown=shown and one > 0,
    )


@CHAPTER.claim("Existence", cost=0.2)
def lower_one() -> Finding:
    """One of the two solutions can be stable; the other is always unstable."""
    two = [modes for modes in _drawn() if len(modes) == 2]
    slower = [min(modes, key=lambda mode: mode.velocity) for modes in two]
    stable = sum(mode.stable for mode in slower)
    faster = sum(max(modes, key=lambda mode: mode.velocity).stable for modes in two)
    return Finding(
        stable == 0 and faster > 0,
        f"of {len(two)} pairs the slower mode is stable in {stable}, the faster in {faster}",
    )


def _half_cycle(velocity: float, phase: float, mode: Mode) -> tuple[float, float]:
    """Return the state after the next impact, mirrored, given speed and phase after an impact.

    Returns
    -------
    tuple of (float, float)
        Phase (rad) and speed.
    """
    system = rk.System(
        rk.Harmonic(mode.amplitude, period=mode.period, phase=phase % (2.0 * np.pi)), mode.restitution
    )
    hit = rk.simulate(system, rk.State(velocity=velocity), cycles=2 * mode.n).events[0]
    frequency = 2.0 * np.pi / mode.period
    return phase + frequency * hit["time"] - np.pi * mode.n, abs(hit["after"])


def _matrix(mode: Mode) -> np.ndarray:
    """Return the matrix of Eq. (9), in (phase, speed), by central differences of simulations."""
    step, columns = 1e-6, []
    for shift in ((step, 0.0), (0.0, step)):
        ahead = _half_cycle(mode.velocity + shift[1], mode.phase + shift[0], mode)
        behind = _half_cycle(mode.velocity - shift[1], mode.phase - shift[0], mode)
        columns.append((np.array(ahead) - np.array(behind)) / (2.0 * step))
    return np.column_stack(columns)


@CHAPTER.claim("Eq. (9)")
def equation_9() -> Finding:
    """A matrix maps small variations from impact to impact."""
    worst = 0.0
    for arguments in ((2.0, 1.0, 0.925, 1), (6.5, 0.4, 0.925, 3)):
        mode = rk.theory.symmetric_modes(*arguments)[0]
        eigenvalues = np.linalg.eigvals(_matrix(mode))
        closed = np.array(mode.half_multipliers)
        worst = max(worst, float(np.abs(np.sort_complex(eigenvalues) - np.sort_complex(closed)).max()))
    return Finding(
        worst < 1e-6,
        f"its eigenvalues by finite differences of simulations and in closed form, for figures 2a and 2b, differ by {small(worst)}",
    )


@CHAPTER.claim("Eq. (10)", misprint="the first sum must be the trace, A₁₁ + A₂₂")
def equation_10() -> Finding:
    """Stable where |A₁₁ + A₁₂ ± √((A₁₁ − A₂₂)² + 4A₁₂A₂₁)| < 2C."""
    printed, meant, modes = 0, 0, 0
    for e in (0.5, 0.8, 0.925):
        for amplitude in (2.0, 6.0, 12.0, 25.0):
            for mode in rk.theory.symmetric_modes(amplitude, 1.0, e, 1):
                if not mode.admissible:
                    continue
                (a11, a12), (a21, a22) = _matrix(mode)
                root = np.sqrt(complex((a11 - a22) ** 2 + 4.0 * a12 * a21))
                modes += 1
                printed += mode.stable == (max(abs(a11 + a12 + root), abs(a11 + a12 - root)) < 2.0)
                meant += mode.stable == (max(abs(a11 + a22 + root), abs(a11 + a22 - root)) < 2.0)
    return Finding(
        printed == modes,
        f"the printed criterion is right for {printed} of {modes} modes, the criterion with the trace for {meant}",
        shown=meant == modes and modes > 5,
    )


@CHAPTER.claim("Existence and stability (damped)")
def mode_number() -> Finding:
    """The stability of (1, n) modes decreases with n."""
    rows, falling = [], True
    low, high = cached_surveys.PERIODS
    periods = np.linspace(low, high, 57)
    for e in (0.2, 0.4, 0.6, 0.8, 0.925):
        widths = []
        for n in MODES:
            start = rk.theory.existence_amplitude(periods, e, n)
            end = rk.theory.symmetry_breaking_amplitude(periods, e, n)
            widths.append(float(np.mean(np.clip(end, 0.0, 16.0) - np.clip(start, 0.0, 16.0))) / 16.0)
        falling = falling and widths == sorted(widths, reverse=True)
        rows.append(f"{e:g}: " + ", ".join(f"{100 * width:.2f}" for width in widths))
    return Finding(
        falling,
        f"percentage of the map in which the (1, n) mode is stable, n = {', '.join(map(str, MODES))}; e = {'; '.join(rows)}",
    )
