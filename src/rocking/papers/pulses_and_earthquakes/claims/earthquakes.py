"""Rows on Makris & Konstantinidis (2003), and further results on overturning scales, rocking spectra and fixed steps."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

import rocking as rk
from rocking.papers.catalogue import PULSES_AND_EARTHQUAKES
from rocking.papers.pulses_and_earthquakes import surveys, thresholds
from rocking.papers.pulses_and_earthquakes.thresholds import IN_G, outside
from rocking.papers.report.claim import Finding, small

MAKRIS_KONSTANTINIDIS = PULSES_AND_EARTHQUAKES.chapter("Makris & Konstantinidis (2003)")
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


@MAKRIS_KONSTANTINIDIS.claim("Fig. 4")
def figure_4() -> Finding:
    """p = 2 1/s, slenderness 15°, r = 0.81, one cosine of 2 s, full equation: 0.315 g stands, 0.316 g overturns."""
    threshold = _threshold(ANGLE, 0.31, 0.32)
    return Finding(
        outside(threshold, 0.315, 0.316) == 0.0,
        f"threshold {threshold:.10f} g, r = {_restitution(ANGLE) ** 2:.4f} by Housner's formula. Slender block: "
        f"{_threshold(None, 0.30, 0.31):.10f} g",
    )


@MAKRIS_KONSTANTINIDIS.claim(
    "Fig. 4",
    qualified="the peak changes so much with the acceleration that the printed peaks come at accelerations less than 10⁻³ g lower",
)
def figure_4_peaks() -> Finding:
    """Full equation, as before: the next peak is −0.38 of the slenderness at 0.310 g and −0.86 at 0.315 g."""
    peaks = [_peak(value) for value in (0.310, 0.315)]
    lower = [
        value - brentq(lambda other, printed=printed: _peak(other) - printed, value - IN_G, value)
        for value, printed in ((0.310, -0.38), (0.315, -0.86))
    ]
    return Finding(
        all(abs(one - other) <= PEAK_DIGIT for one, other in zip(peaks, (-0.38, -0.86), strict=True)),
        f"{peaks[0]:.4f} at 0.310 g and {peaks[1]:.4f} at 0.315 g; the printed peaks come at accelerations that are "
        f"{small(lower[0])} and {small(lower[1])} g lower",
        explained=min(lower) > 0.0 and max(lower) < IN_G,
    )


@MAKRIS_KONSTANTINIDIS.claim(
    "Public MATLAB script, same block and pulse",
    qualified="the last digits differ, by no more than an integration with a tolerance of 10⁻⁸ explains",
)
def script() -> Finding:
    """Full equation: the critical acceleration is 0.315034034 g."""
    threshold = _threshold(ANGLE, 0.31, 0.32)
    apart = abs(threshold - 0.315034034)
    return Finding(
        apart <= SCRIPT_DIGIT,
        f"{threshold:.10f} g, {small(apart)} g from the printed number",
        explained=apart <= SCRIPT_ERROR,
    )


@MAKRIS_KONSTANTINIDIS.claim("Equivalent damping")
def damping() -> Finding:
    """The damping ratio −0.34 ln r is 3.15, 7.20 and 13.12 % for slendernesses of 10, 15 and 20°."""
    ratios = [_restitution(math.radians(angle)) for angle in (10.0, 15.0, 20.0)]
    percentages = [-0.34 * math.log(e * e) * 100 for e in ratios]
    fema = [40 * (1 - e) for e in ratios]
    return Finding(
        all(
            abs(one - other) <= PERCENT_DIGIT
            for one, other in zip(percentages, (3.15, 7.20, 13.12), strict=True)
        ),
        f"{', '.join(f'{value:.3f}' for value in percentages)} %, with Housner's r. FEMA 356, 0.4(1 − √r): "
        f"{', '.join(f'{value:.2f}' for value in fema)} %",
    )


@MAKRIS_KONSTANTINIDIS.claim("Rocking spectra", untested=surveys.NO_RECORD)
def pacoima() -> Finding:
    """Pacoima Dam, 1.226 g: at a slenderness of 10° all blocks with 2π/p below 4 s (R below 2.98 m) overturn.

    At 20° the block with 2π/p = 2 s stands.
    """
    radius = 3 * thresholds.GRAVITY * 4.0**2 / (16 * math.pi**2)
    return Finding(False, f"2π/p = 4 s: R = {radius:.4f} m", explained=True)


@MAKRIS_KONSTANTINIDIS.claim("Rocking spectra", untested=surveys.NO_RECORD)
def array_5() -> Finding:
    """Array #5, 0.379 g: at 10° blocks with 2π/p below 6.5 s overturn.

    At 20° the largest angle is 0.08 rad at p = π 1/s and 0.015 rad at 2π/p = 7 s.
    """
    lift_off = math.tan(math.radians(20.0))
    return Finding(
        False,
        f"20°: the block leaves the base at {lift_off:.4f} g, less than the peak of 0.379 g",
        explained=True,
    )


FURTHER = PULSES_AND_EARTHQUAKES.chapter("Further results of this report")


@FURTHER.claim("Overturning scales", main=True)
def not_an_interval() -> Finding:
    """A block that overturns at one scale may stand at a larger one: these motions have no single overturning acceleration."""
    rows = [surveys.fallen(surveys.scales()), *surveys.fallen(surveys.synthetic_scales())]
    counts = [surveys.switches(row) for row in rows]
    return Finding(
        min(counts) > 1,
        f"R = {surveys.SIZE:g} m, θcr = {surveys.SLENDERNESS:g}, PGA/(gθcr) from 1 to 6: the recorded motion switches {counts[0]} times "
        f"between standing and overturning among {rows[0].size:,} scales; four synthetic motions {', '.join(map(str, counts[1:]))} "
        f"times among {rows[1].size:,}",
    )


@FURTHER.claim("Overturning scales")
def fractal() -> Finding:
    """The finer the scales, the more switches between standing and overturning: the set is fractal down to the finest grid used."""
    over = surveys.fallen(surveys.scales())
    counts = [surveys.switches(over[::stride]) for stride in surveys.STRIDES]
    steps = [(surveys.RATIOS[1] - surveys.RATIOS[0]) * stride for stride in surveys.STRIDES]
    shares = [
        count / (over[::stride].size - 1) for count, stride in zip(counts, surveys.STRIDES, strict=True)
    ]
    exponent = float(np.polyfit(np.log(steps), np.log(shares), 1)[0])
    certified = rk.Share(int(surveys.scales().certified.sum()), over.size)
    return Finding(
        all(np.diff(counts) > 0) and exponent < 1.0,
        f"{', '.join(f'{count} at steps of {step:.2g}' for count, step in zip(counts, steps, strict=True))}; the share of neighbours "
        f"that differ shrinks like the step to the power {exponent:.2f}. Certified outcomes: {certified}",
    )


@FURTHER.claim("Rocking spectra", main=True)
def larger_is_not_safer() -> Finding:
    """A larger block may overturn where a smaller one of the same slenderness stands."""
    spectrum = surveys.spectrum().transpose("slenderness", "size")
    over = surveys.fallen(spectrum)
    order = np.argsort(spectrum["size"].values)
    larger = [int(np.count_nonzero(np.diff(row[order].astype(int)) == 1)) for row in over]
    listed = ", ".join(
        f"{angle:.0f}°: {count}"
        for angle, count in zip(np.degrees(surveys.SLENDERNESSES), larger, strict=True)
    )
    return Finding(
        max(larger) > 0,
        f"recorded motion at {surveys.SPECTRUM_PGA:g} g, 2π/α from {surveys.PERIODS[0]:g} to {surveys.PERIODS[-1]:g} s: number of sizes "
        f"that overturn next to a smaller size that stands, by slenderness: {listed}",
    )


@FURTHER.claim("Integration in fixed steps", main=True)
def fixed_steps() -> Finding:
    """The classical Runge–Kutta method gives wrong verdicts, even with twenty steps between two samples of a record."""
    wrong = surveys.wrong_verdicts()

    def listed(shares: tuple[rk.Share, ...]) -> str:
        return "; ".join(f"{steps}: {share}" for steps, share in zip(surveys.SUBSTEPS, shares, strict=True))

    return Finding(
        wrong.interpolated[-1].low > 0.0,
        f"R = {surveys.COARSE_SIZE:g} m, θcr = {surveys.COARSE_SLENDERNESS:g}, four synthetic motions, steps of 0.02 s: wrong among the "
        f"certified verdicts, by steps between samples, impacts interpolated: {listed(wrong.interpolated)}. Impacts at the end of a "
        f"step: {listed(wrong.at_end)}",
    )
