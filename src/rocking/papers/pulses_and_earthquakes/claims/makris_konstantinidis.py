"""Rows on Makris & Konstantinidis (2003): the cosine pulse of Fig. 4, damping ratios of codes, and rocking spectra."""

from __future__ import annotations

import math

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.judging import NO_RECORD, SMALL_ANGLE
from rocking.papers.report.claim import Chapter, Finding

CHAPTER = Chapter("Makris & Konstantinidis (2003)")
ANGLE = math.radians(15.0)
DURATION = 4.0
"""p = 2 1/s times 2 s."""
PERCENT_DIGIT = 0.005
"""Half a unit of the last printed digit of a damping ratio in per cent."""


def _restitution(angle: float) -> float:
    return rk.Block(height=1.0, width=math.tan(angle)).restitution


def _threshold() -> float:
    """Return the acceleration in g at which the slender block begins to overturn under the cosine pulse."""
    return thresholds.bisected(
        lambda value: thresholds.falls("one-cosine", value / ANGLE, math.tau / DURATION, _restitution(ANGLE)),
        0.30,
        0.31,
    )


@CHAPTER.claim("Fig. 4", not_judged=SMALL_ANGLE)
def figure_4() -> Finding:
    """p = 2 1/s, slenderness 15°, r = 0.81, one cosine of 2 s, full equation: 0.315 g stands, 0.316 g overturns."""
    return Finding(
        False,
        f"slender block, r = {_restitution(ANGLE) ** 2:.4f} by Housner's formula: {_threshold():.10f} g",
        shown=True,
    )


@CHAPTER.claim("Fig. 4", not_judged=SMALL_ANGLE)
def figure_4_peaks() -> Finding:
    """Full equation, as before: the next peak is −0.38 of the slenderness at 0.310 g and −0.86 at 0.315 g."""
    found = [
        thresholds.run("one-cosine", value / ANGLE, math.tau / DURATION, _restitution(ANGLE)).peak
        for value in (0.300, 0.305)
    ]
    return Finding(
        False,
        f"slender block: largest angle {found[0]:.3f} of the slenderness at 0.300 g, {found[1]:.3f} at 0.305 g",
        shown=True,
    )


@CHAPTER.claim("Public MATLAB script, same block and pulse", not_judged=SMALL_ANGLE)
def script() -> Finding:
    """Full equation: the critical acceleration is 0.315034034 g."""
    return Finding(False, f"slender block: {_threshold():.10f} g", shown=True)


@CHAPTER.claim("Equivalent damping")
def damping() -> Finding:
    """The damping ratio −0.34 ln r is 3.15, 7.20 and 13.12 % for slendernesses of 10, 15 and 20°."""
    ratios = [_restitution(math.radians(angle)) for angle in (10.0, 15.0, 20.0)]
    found = [-0.34 * math.log(e * e) * 100 for e in ratios]
    fema = [40 * (1 - e) for e in ratios]
    return Finding(
        all(abs(one - other) <= PERCENT_DIGIT for one, other in zip(found, (3.15, 7.20, 13.12), strict=True)),
        f"{', '.join(f'{value:.3f}' for value in found)} %, with Housner's r. FEMA 356, 0.4(1 − √r): "
        f"{', '.join(f'{value:.2f}' for value in fema)} %",
    )


@CHAPTER.claim("Rocking spectra", not_judged=NO_RECORD)
def pacoima() -> Finding:
    """Pacoima Dam, 1.226 g: at a slenderness of 10° all blocks with 2π/p below 4 s (R below 2.98 m) overturn.

    At 20° the block with 2π/p = 2 s stands.
    """
    radius = 3 * thresholds.GRAVITY * 4.0**2 / (16 * math.pi**2)
    return Finding(False, f"2π/p = 4 s: R = {radius:.4f} m", shown=True)


@CHAPTER.claim("Rocking spectra", not_judged=NO_RECORD)
def array_5() -> Finding:
    """Array #5, 0.379 g: at 10° blocks with 2π/p below 6.5 s overturn.

    At 20° the largest angle is 0.08 rad at p = π 1/s and 0.015 rad at 2π/p = 7 s.
    """
    lift_off = math.tan(math.radians(20.0))
    return Finding(
        False,
        f"20°: the block leaves the base at {lift_off:.4f} g, less than the peak of 0.379 g",
        shown=True,
    )
