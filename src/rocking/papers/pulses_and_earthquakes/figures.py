"""Figures of the report on pulses and earthquakes; the docstring of each is its caption."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.catalogue import PULSES_AND_EARTHQUAKES
from rocking.papers.pulses_and_earthquakes import surveys, thresholds

FIRST, SECOND, THIRD = rk.plot.palette.SERIES[:3]
INK = rk.plot.palette.INK


@PULSES_AND_EARTHQUAKES.figure("1", cost=3.0, pixels=True)
def figure_1() -> Figure:
    """Figure 1: one sine pulse: amplitudes that overturn the slender block over the frequency of the pulse, e = 0.9.

    A is the amplitude in units of gθcr, Ω the frequency of the pulse over the frequency parameter of the block. Grey: the
    simulated block overturns, on a grid of 90 × 90 points; light blue: it stands. Dark blue: closed form of mode 2, Zhang & Makris
    (2001), Eq. (47). Above it the block overturns without an impact. Orange: both ends of mode 1, with an impact after the pulse. Dashed:
    the lowest amplitude of the simulation, where the impact falls into the pulse. Black: printed numbers of Zhang & Makris at
    Ω = 5 and at 15.7 rad/s. Rings: the block stands. Dots: it overturns. The dotted line is the printed end
    of mode 1, Ω = 6.59. Teal: 1 + Ω/6, Makris & Roussos (2000).

    Difference from the paper: the printed numbers differ from the exact boundaries in the third digit. The difference is
    too small to be seen here.
    """
    e = 0.9
    frequencies, amplitudes = np.linspace(0.5, 8.0, 90), np.linspace(0.5, 14.0, 90)
    figure, (ax,) = rk.plot.panels(height=3.6)
    ax.pcolormesh(
        frequencies,
        amplitudes,
        [[thresholds.falls("one-sine", a, frequency, e) for frequency in frequencies] for a in amplitudes],
        cmap=ListedColormap([rk.plot.palette.STANDS, rk.plot.palette.OVERTURNED[0]]),
        shading="nearest",
        rasterized=True,
    )
    rates = np.linspace(0.5, 8.0, 400)
    low, high = rk.theory.one_sine_impact_amplitudes(math.tau / rates, e)
    ax.plot(rates, rk.theory.one_sine_pulse_amplitude(math.tau / rates), color=FIRST, lw=1.2, label="mode 2")
    ax.plot(rates, low, color=SECOND, lw=1.2, label="mode 1")
    ax.plot(rates, high, color=SECOND, lw=1.2)
    slow = np.linspace(0.5, 4.79, 90)
    ax.plot(
        slow,
        thresholds.lowest_of("one-sine", slow, e),
        color=SECOND,
        lw=1.0,
        ls="--",
        label="impact in the pulse",
    )
    line = np.linspace(0.5, 3.0, 2)
    ax.plot(line, 1 + line / 6, color=THIRD, lw=1.2, label=r"$1 + \Omega/6$")
    # Numbers of a pair are closer than a mark is wide: the ring surrounds the dot.
    stands = ((5.0, 3.00), (5.0, 6.33), (5.0, 7.17))
    falls = ((5.0, 3.01), (5.0, 6.32), (5.0, 7.18), (15.7 / 2.14, 3.24 / 0.25))
    for points, face, size, name in (
        (stands, "none", 7.0, "printed: stands"),
        (falls, INK, 3.0, "printed: overturns"),
    ):
        ax.plot(*zip(*points, strict=True), "o", ms=size, mfc=face, mec=INK, mew=0.8, label=name)
    ax.axvline(6.59, color=INK, lw=0.8, ls=":")
    ax.set(xlim=(0.5, 8.0), ylim=(0.5, 14.0))
    _finish(ax, r"frequency $\Omega$ of the pulse", "amplitude $A$")
    return figure


@PULSES_AND_EARTHQUAKES.figure("2", cost=0.6)
def figure_2() -> Figure:
    """Figure 2: half sine and rectangular pulse: amplitude that overturns a block at rest.

    (a) Half sine over its frequency Ω = π/T. The exact condition is that of Shi et al. (1996) and Makris & Roussos (2000),
    Eq. (27). Housner (1963), Eq. (12), gives √(1 + Ω²), and Makris & Roussos, Eq. (28), the line 1 + Ω/2 for Ω < 3. Both
    lie above the exact amplitude: a block overturns although they predict that it stands. (b) Rectangular pulse over its
    duration T: A = 1/(1 − e⁻ᵀ), which solves Housner's Eq. (9). Marks: thresholds of the simulation by bisection.
    """
    frequencies = np.array([0.5, 1.0, 2.0, 3.0, 4.0, 5.0])
    durations = np.array([0.3, 0.7, 1.0, 2.0, 3.0, 4.0])
    figure, (left, right) = rk.plot.panels(columns=2, height=3.2)
    rates, line = np.linspace(0.05, 5.2, 300), np.array([0.0, 3.0])
    left.plot(rates, np.sqrt(1 + rates**2), color=SECOND, lw=1.2, label="Housner, Eq. (12)")
    left.plot(rates, rk.theory.half_sine_pulse_amplitude(math.pi / rates), color=FIRST, lw=1.2, label="exact")
    left.plot(line, 1 + line / 2, color=THIRD, lw=1.2, ls="--", label=r"$1 + \Omega/2$")
    lowest = thresholds.lowest_of("half-sine", frequencies, 0.9)
    left.plot(frequencies, lowest, "o", ms=4, color=INK, label="simulated")
    left.set(xlim=(0.0, 5.2), ylim=(0.8, 5.5))
    rk.plot.title(left, "half sine")
    _finish(left, r"frequency $\Omega$ of the pulse", "amplitude $A$")
    times = np.linspace(0.18, 4.2, 300)
    right.plot(
        times,
        rk.theory.rectangular_pulse_amplitude(times),
        color=FIRST,
        lw=1.2,
        label="exact, as Housner, Eq. (9)",
    )
    lowest = thresholds.lowest_of("rectangular", math.pi / durations, 0.9)
    right.plot(durations, lowest, "o", ms=4, color=INK, label="simulated")
    right.set(xlim=(0.0, 4.2), ylim=(0.8, 5.5))
    rk.plot.title(right, "rectangular")
    _finish(right, r"duration $T$ of the pulse ($\tau$)", "amplitude $A$")
    return figure


@PULSES_AND_EARTHQUAKES.figure("3", cost=0.4)
def figure_3() -> Figure:
    """Figure 3: rocking spectrum of a recorded motion, scaled to 0.6 g: largest angle over 2π/α.

    The record is that of San Francisco, 1295 Shafter, in the Loma Prieta earthquake of 1989, which comes with the package.
    Slendernesses θcr of 10, 15 and 20°, with Housner's coefficient of restitution. The largest angle is in units of θcr.
    Bars at the upper edge mark sizes at which the block overturns. Larger blocks are not always safer: between sizes that
    overturn there are sizes that stand. The form of the diagram is that of Makris & Konstantinidis (2003), whose records do
    not come with the package.
    """
    figure, (ax,) = rk.plot.panels(height=3.2)
    spectrum = surveys.spectrum().transpose("slenderness", "size")
    periods = 2 * np.pi / spectrum["frequency_parameter"].values
    rows = zip(
        spectrum.peak.values,
        surveys.fallen(spectrum),
        np.degrees(spectrum["slenderness"].values),
        strict=True,
    )
    for number, ((peak, over, degrees), colour) in enumerate(zip(rows, (FIRST, SECOND, THIRD), strict=True)):
        ax.plot(
            periods,
            np.where(over, np.nan, peak),
            color=colour,
            lw=0.9,
            label=rf"$\theta_{{cr}}$ = {degrees:.0f}°",
        )
        ax.plot(periods[over], np.full(over.sum(), 1.02 + 0.035 * number), "|", ms=4, mew=0.9, color=colour)
    ax.set(xlim=(surveys.PERIODS[0], surveys.PERIODS[-1]), ylim=(0.0, 1.12))
    rk.plot.title(ax, f"PGA {surveys.SPECTRUM_PGA:g} g; bars: overturned")
    _finish(ax, r"$2\pi/\alpha$ (s)", r"largest $|\theta|/\theta_{cr}$", columns=3)
    return figure


@PULSES_AND_EARTHQUAKES.figure("4", cost=0.7, pixels=True)
def figure_4() -> Figure:
    """Figure 4: scales that overturn a block under a recorded motion: not one threshold, but a fractal set.

    R = 1 m, θcr = 0.25, Housner's coefficient of restitution; the record is that of figure 3. (a) Largest angle over
    PGA/(gθcr), 10,001 scales; a bar at the upper edge marks a scale at which the block overturns. (b) Number of switches
    between standing and overturning along the range of (a), over the step between two scales. It grows at all steps, down
    to the smallest one. The dashed line has the slope of a set in which each halving of the step doubles the number.
    """
    figure, (left, right) = rk.plot.panels(columns=2, height=3.0, ratios=(2, 1))
    survey = surveys.scales()
    over = surveys.fallen(survey)
    left.plot(
        surveys.RATIOS[~over], survey.peak.values[~over], ".", ms=1.2, mew=0, color=FIRST, rasterized=True
    )
    left.plot(
        surveys.RATIOS[over],
        np.full(over.sum(), 1.06),
        "|",
        ms=7,
        mew=0.25,
        color=rk.plot.palette.OVERTURNED[0],
        rasterized=True,
    )
    left.set(xlim=(surveys.RATIOS[0], surveys.RATIOS[-1]), ylim=(0.0, 1.12))
    rk.plot.title(left, "bars: overturned")
    _finish(left, r"PGA/($g\,\theta_{cr}$)", r"largest $|\theta|/\theta_{cr}$")
    steps = np.array(surveys.STRIDES) * (surveys.RATIOS[1] - surveys.RATIOS[0])
    counts = [surveys.switches(over[::stride]) for stride in surveys.STRIDES]
    right.loglog(steps, counts, "o-", ms=4, lw=0.9, color=INK)
    right.loglog(steps, counts[-1] * steps[-1] / steps, "--", lw=0.8, color=SECOND)
    rk.plot.title(right, "switches")
    _finish(right, "step of PGA/($g\\,\\theta_{cr}$)", "number of switches")
    return figure


@PULSES_AND_EARTHQUAKES.figure("5", cost=4.7)
def figure_5() -> Figure:
    """Figure 5: wrong verdicts of integration in fixed steps, over the number of steps between two samples of the record.

    Classical Runge–Kutta method of fourth order against the exact motion. The block has R = 1 m and θcr = 0.15. Four
    synthetic motions have samples every 0.02 s, and 150 scales each, PGA/(gθcr) from 1.05 to 4. Only certified verdicts are
    counted. Bars are 95 % intervals. Impacts are placed at the end of a step, as simple programs do, or within it by linear interpolation.
    The end of each run is judged by the exact condition. Twenty times as many steps do not remove the error: the motion is
    chaotic, and small errors grow from impact to impact.
    """
    figure, (ax,) = rk.plot.panels(height=3.0)
    wrong = surveys.wrong_verdicts()
    for shares, colour, name, shift in (
        (wrong.at_end, SECOND, "impact at the step's end", 0.97),
        (wrong.interpolated, FIRST, "impact interpolated", 1.03),
    ):
        middle = np.array([100 * share.value for share in shares])
        ends = np.array([[100 * share.low, 100 * share.high] for share in shares]).T
        ax.errorbar(
            shift * np.array(surveys.SUBSTEPS),
            middle,
            np.abs(ends - middle),
            fmt="o-",
            ms=4,
            lw=0.9,
            capsize=2,
            color=colour,
            label=name,
        )
    ax.set_xscale("log")
    ax.set_xticks(surveys.SUBSTEPS, [str(number) for number in surveys.SUBSTEPS])
    ax.minorticks_off()
    ax.set_ylim(0.0, None)
    _finish(ax, "steps between two samples", "wrong verdicts (%)", columns=1)
    return figure


def _finish(ax: Axes, across: str, up: str, columns: int = 2) -> None:
    """Label both axes, and draw the legend below them."""
    ax.set_xlabel(across, fontsize=9.0, color=INK)
    ax.set_ylabel(up, fontsize=9.0, color=INK)
    ax.tick_params(labelsize=8.0, width=0.6, color=INK, labelcolor=INK)
    for side, spine in ax.spines.items():
        spine.set(visible=side in ("left", "bottom"), linewidth=0.6, edgecolor=INK)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, 0.0),
            borderaxespad=3.8,
            fontsize=8.0,
            labelcolor=INK,
            frameon=False,
            ncols=columns,
            handletextpad=0.6,
            columnspacing=1.2,
        )
