"""Further findings: overturning scales of records, rocking spectra, and the error of integration in fixed steps."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.papers.pulses_and_earthquakes import records
from rocking.papers.report.claim import Chapter, Finding

CHAPTER = Chapter("Further results of this report")


@CHAPTER.claim("Overturning scales")
def not_an_interval() -> Finding:
    """A scale factor above one that overturns a block need not overturn it: no record has one overturning acceleration."""
    rows = [records.fallen(records.scales()), *records.fallen(records.synthetic_scales())]
    counts = [records.switches(row) for row in rows]
    return Finding(
        min(counts) > 1,
        f"R = {records.SIZE:g} m, θcr = {records.SLENDERNESS:g}, PGA/(gθcr) from 1 to 6: the recorded motion switches {counts[0]} times "
        f"between standing and overturning among {rows[0].size:,} scales; four synthetic motions {', '.join(map(str, counts[1:]))} "
        f"times among {rows[1].size:,}",
    )


@CHAPTER.claim("Overturning scales")
def fractal() -> Finding:
    """The finer the scales, the more switches between standing and overturning: the set is fractal down to the finest grid used."""
    over = records.fallen(records.scales())
    counts = [records.switches(over[::stride]) for stride in records.STRIDES]
    steps = [(records.RATIOS[1] - records.RATIOS[0]) * stride for stride in records.STRIDES]
    shares = [
        count / (over[::stride].size - 1) for count, stride in zip(counts, records.STRIDES, strict=True)
    ]
    exponent = float(np.polyfit(np.log(steps), np.log(shares), 1)[0])
    certified = rk.Share(int(records.scales().certified.sum()), over.size)
    return Finding(
        all(np.diff(counts) > 0) and exponent < 1.0,
        f"{', '.join(f'{count} at steps of {step:.2g}' for count, step in zip(counts, steps, strict=True))}; the share of neighbours "
        f"that differ shrinks like the step to the power {exponent:.2f}. Certified outcomes: {certified}",
    )


@CHAPTER.claim("Rocking spectra")
def larger_is_not_safer() -> Finding:
    """A larger block may overturn where a smaller one of the same slenderness stands."""
    found = records.spectrum().transpose("slenderness", "size")
    over = records.fallen(found)
    order = np.argsort(found["size"].values)
    larger = [int(np.count_nonzero(np.diff(row[order].astype(int)) == 1)) for row in over]
    listed = ", ".join(
        f"{angle:.0f}°: {count}"
        for angle, count in zip(np.degrees(records.SLENDERNESSES), larger, strict=True)
    )
    return Finding(
        max(larger) > 0,
        f"recorded motion at {records.SPECTRUM_PGA:g} g, 2π/α from {records.PERIODS[0]:g} to {records.PERIODS[-1]:g} s: number of sizes "
        f"that overturn next to a smaller size that stands, by slenderness: {listed}",
    )


@CHAPTER.claim("Integration in fixed steps")
def fixed_steps() -> Finding:
    """The classical Runge–Kutta method gives wrong verdicts, even with twenty steps between two samples of a record."""
    wrong = records.wrong_verdicts()

    def listed(shares: tuple[rk.Share, ...]) -> str:
        return "; ".join(f"{steps}: {share}" for steps, share in zip(records.SUBSTEPS, shares, strict=True))

    return Finding(
        wrong.interpolated[-1].low > 0.0,
        f"R = {records.COARSE_SIZE:g} m, θcr = {records.COARSE_SLENDERNESS:g}, four synthetic motions, steps of 0.02 s: wrong among the "
        f"certified verdicts, by steps between samples, impacts interpolated: {listed(wrong.interpolated)}. Impacts at the end of a "
        f"step: {listed(wrong.at_end)}",
    )
