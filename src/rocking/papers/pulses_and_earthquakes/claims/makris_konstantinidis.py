"""Rows on Makris & Konstantinidis (2003): the cosine pulse of Fig. 4, damping ratios of codes, and rocking spectra."""

from __future__ import annotations

import math

from scipy.optimize import brentq

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.judging import IN_G, NO_RECORD, outside
from rocking.papers.report.claim import Chapter, Finding, small

CHAPTER = Chapter("Makris & Konstantinidis (2003)")
ANGLE = math.radians(15.0)
DURATION = 4.0
"""p = 2 1/s times 2 s."""
PEAK_DIGIT = 0.005
"""Half a unit of the last printed digit of a peak."""
SCRIPT_DIGIT = 5e-10
"""Half a unit of the last printed digit of the script, in g."""
SCRIPT_ERROR = 5e-8
"""Difference in g that a tolerance of 10⁻⁸ explains."""
PERCENT_DIGIT = 0.005
"""Half a unit of the last printed digit of a damping ratio in per cent."""


def _restitution(angle: float) -> float:
    return rk.Block(height=1.0, width=math.tan(angle)).restitution


def _threshold(angle: float | None, stands: float, overturns: float) -> float:
    """Return the acceleration in g at which the block begins to overturn under the cosine pulse; with an angle, the full block."""
    no, yes = stands / ANGLE, overturns / ANGLE
    restitution = _restitution(ANGLE)
    return ANGLE * thresholds.threshold("one-cosine", math.tau / DURATION, restitution, no, yes, angle)


def _peak(acceleration: float) -> float:
    """Return the largest peak of the full block, either side, over its slenderness."""
    frequency, restitution = math.tau / DURATION, _restitution(ANGLE)
    system = thresholds.system("one-cosine", acceleration / ANGLE, frequency, restitution, ANGLE)
    return float(max(rk.simulate(system).peaks["angle"], key=abs))


@CHAPTER.claim("Fig. 4")
def figure_4() -> Finding:
    """p = 2 1/s, slenderness 15°, r = 0.81, one cosine of 2 s, full equation: 0.315 g stands, 0.316 g overturns."""
    found = _threshold(ANGLE, 0.31, 0.32)
    return Finding(
        outside(found, 0.315, 0.316) == 0.0,
        f"threshold {found:.10f} g, r = {_restitution(ANGLE) ** 2:.4f} by Housner's formula. Slender block: "
        f"{_threshold(None, 0.30, 0.31):.10f} g",
    )


@CHAPTER.claim(
    "Fig. 4",
    qualified="the peak changes so much with the acceleration that the printed peaks come at accelerations less than 10⁻³ g lower",
)
def figure_4_peaks() -> Finding:
    """Full equation, as before: the next peak is −0.38 of the slenderness at 0.310 g and −0.86 at 0.315 g."""
    found = [_peak(value) for value in (0.310, 0.315)]
    lower = [
        value - brentq(lambda other, printed=printed: _peak(other) - printed, value - IN_G, value)
        for value, printed in ((0.310, -0.38), (0.315, -0.86))
    ]
    return Finding(
        all(abs(one - other) <= PEAK_DIGIT for one, other in zip(found, (-0.38, -0.86), strict=True)),
        f"{found[0]:.4f} at 0.310 g and {found[1]:.4f} at 0.315 g; the printed peaks come at accelerations that are "
        f"{small(lower[0])} and {small(lower[1])} g lower",
        shown=min(lower) > 0.0 and max(lower) < IN_G,
    )


@CHAPTER.claim(
    "Public MATLAB script, same block and pulse",
    qualified="the last digits differ, by no more than an integration with a tolerance of 10⁻⁸ explains",
)
def script() -> Finding:
    """Full equation: the critical acceleration is 0.315034034 g."""
    found = _threshold(ANGLE, 0.31, 0.32)
    apart = abs(found - 0.315034034)
    return Finding(
        apart <= SCRIPT_DIGIT,
        f"{found:.10f} g, {small(apart)} g from the printed number",
        shown=apart <= SCRIPT_ERROR,
    )


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
