"""Figures of Yim and Lin (1991); the docstring of each is its caption."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.yim_lin_1991 import surveys
from rocking.papers.yim_lin_1991.surveys import BRACED, CHAOTIC, OVERTURNING, PERIODIC, QUASI_PERIODIC, Case

if TYPE_CHECKING:
    import xarray as xr

    from rocking.motion.motion import Motion


@YIM_LIN_1991.figure("1", cost=0.3)
def figure_1() -> Figure:
    """Figure 1: block and base, with dimensions H, B, R, corners O, O', angles θ, θcr and base acceleration.

    The block is drawn at θ = θcr/2. Signs are those of Eqs. (1) to (3): angles are positive clockwise, accelerations to
    the right.
    """
    figure, (ax,) = rk.plot.panels(height=3.6)
    rk.plot.schematic(ax)
    return figure


@YIM_LIN_1991.figure("2", cost=0.5)
def figure_2() -> Figure:
    """Figure 2: time histories of three periodic responses, e = 0.925.

    (a) A = 2, T = 1: (1, 1) mode, symmetric, 2 impacts per cycle. (b) A = 6.5, T = 0.4: (1, 3) mode, symmetric, 2 impacts
    per 3 cycles. (c) A = 5.5, T = 0.5, from Θ' = 0.15 with forcing phase φ = 1.8: period 10, asymmetric, 4 impacts per 10
    cycles. The responses (a) and (b) start from rest with φ = 0. Transients are omitted: (a) shows cycles 200 to 210, (b)
    600 to 624 and (c) 600 to 630. The scale of (c) differs from the scale of (a) and (b).

    Difference from the paper: its caption gives the initial state of (c) as (θ, φ) = (0.15, 1.8). The caption of figure 3
    has (θ̇, φ). Here 0.15 is the initial velocity. An initial angle of 0.15 leads to a symmetric response of period 7.
    The paper calls (c) a (1, 10) mode. It has four impacts, hence two rocking cycles, in ten forcing cycles: a (2, 10)
    mode.
    """
    figure, axes = rk.plot.panels(rows=3, height=2.2)
    for ax, case, height in zip(axes, PERIODIC, (0.1, 0.1, 0.3), strict=True):
        rk.plot.time_history(case.motion(), ax, cycles=case.cycles)
        rk.plot.title(ax, case.name)
        ax.set_ylim(-height, height)
    return figure


@YIM_LIN_1991.figure("3", cost=0.6)
def figure_3() -> Figure:
    """Figure 3: phase portraits of the three periodic responses of figure 2, in the same cycles.

    At each impact the velocity changes at Θ = 0 from the ring to the dot, by the factor e = 0.925 (Eq. (2)). Arrows give
    the direction of motion. The scale of (c) differs from the scale of (a) and (b).
    """
    figure, axes = rk.plot.panels(rows=3, height=2.9)
    limits = ((0.1, 0.8), (0.1, 0.8), (0.3, 1.1))
    arrows = ((0.0, 0.5), (0.0, 1.5), (1.5, 6.5))  # cycles after the first one in the figure
    for ax, case, (width, height), cycles in zip(axes, PERIODIC, limits, arrows, strict=True):
        motion = case.motion()
        rk.plot.phase_portrait(motion, ax, cycles=case.cycles)
        for cycle in cycles:
            _draw_arrow(ax, motion, case.cycles[0] + cycle)
        rk.plot.title(ax, case.name)
        ax.set(xlim=(-width, width), ylim=(-height, height))
    return figure


@YIM_LIN_1991.figure("4", cost=0.4)
def figure_4() -> Figure:
    """Figure 4: overturning from rest, A = 1.75, T = 2, e = 0.95, φ = 0: (a) time history, (b) phase portrait.

    After four impacts, in the sixth cycle, overturning is certain. The motion is shown up to Θ = −1.6. Dotted lines in
    (a) mark the critical angle, arrows in (b) the direction of motion.
    """
    figure = _draw_pair(OVERTURNING, arrows=(0.9, 2.4, 4.2, 5.8), legend=True)
    left, right = figure.axes
    left.set_ylim(-1.6, 1.2)
    right.set(xlim=(-1.6, 1.2), ylim=(-1.7, 1.7))
    return figure


@YIM_LIN_1991.figure("5", cost=0.6)
def figure_5() -> Figure:
    """Figure 5: quasi-periodic response from rest, A = 4, T = 0.4, e = 1: (a) time history, (b) phase portrait.

    The motion, from φ = 0, turns about the three points of a symmetric (1, 3) mode. It has no transient, because an
    undamped motion has none: (a) shows the first 60 cycles, (b) the first 21. Orange marks are impacts, at which the
    velocity does not change because e = 1. The arrow gives the direction of motion.
    """
    return _draw_pair(QUASI_PERIODIC, history=(0, 60), portrait=(0, 21), arrows=(16.93,))


@YIM_LIN_1991.figure("6", cost=0.4, pixels=True)
def figure_6() -> Figure:
    """Figure 6: chaotic response from rest, A = 2, T = 0.4, e = 1, φ = 0: (a) time history, (b) phase portrait.

    (a) shows the first 60 cycles, (b) the first 30. Orange marks are impacts, at which the velocity does not change
    because e = 1. The arrow gives the direction of motion. Nearby trajectories diverge by a factor of 2.7 in some seven
    cycles: the cycles shown do not depend on rounding, cycles after about 250 do.
    """
    return _draw_pair(CHAOTIC, history=(0, 60), portrait=(0, 30), arrows=(5.49,))


@YIM_LIN_1991.figure("7", cost=0.8, pixels=True)
def figure_7() -> Figure:
    """Figure 7: Poincaré maps of (a) the (1, 3) mode, (b) the quasi-periodic and (c) the chaotic response.

    Parameters: (a) A = 6.5, T = 0.4, e = 0.925. (b) A = 4, T = 0.4, e = 1. (c) A = 2, T = 0.4, e = 1. All start from rest
    with φ = 0. The section lies at the forcing phase ψ = 0, just after any event at that instant. (a) shows 12 cycles
    after a transient of 600: three points, four times each. (b) shows 3·10⁴ and (c) 10⁵ cycles from the start, because an
    undamped motion has no transient.

    Difference from the paper: the paper says that (b) forms three tori and (c) a strange attractor. The three closed
    curves, visited in turn, are the intersections of one torus with the section. Undamped motions conserve area, so that
    nothing attracts. Panel (c) is a chaotic sea around islands. The paper gives neither the phase of its sections nor the
    number of points.
    """
    figure, axes = rk.plot.panels(rows=3, height=2.8)
    cycles = ((PERIODIC[1], 600, 612), (QUASI_PERIODIC, 0, 30_000), (CHAOTIC, 0, 100_000))
    for ax, (case, transient, end) in zip(axes, cycles, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=end, record="section")
        rk.plot.section(motion, ax, transient=transient + 1)
        rk.plot.title(ax, case.name)
    return figure


@YIM_LIN_1991.figure("8", cost=3.2)
def figure_8() -> Figure:
    """Figure 8: power spectral densities of the three responses of figure 7.

    Welch averages of exact samples of Θ over 8,192 cycles, in segments of an eighth of that. (a) has 8,190 cycles after a
    transient of 600, so that segments hold whole responses. The spectra are shown up to three times the forcing frequency
    f; dotted lines mark f, 2f and 3f. (a) (1, 3) mode: all lines are odd multiples of f/3, because the response is
    symmetric. (b) Quasi-periodic response: all lines are combinations of f/3 and of the rotation frequency f_r =
    0.17519497 f, which is (1 − 0.4744150886)/3. It is the frequency of the motion about the centre of the island. (c)
    Chaotic response: a broad band, with a line at the forcing frequency.

    Difference from the paper: the paper states a single dominant frequency for (a). The line at f/3 is the strongest, but
    the line at f has three eighths of its variance. The paper gives neither units nor the length of its records.
    """
    figure, axes = rk.plot.panels(rows=3, height=2.7)
    cycles = ((PERIODIC[1], 600, 8_190), (QUASI_PERIODIC, 0, 8_192), (CHAOTIC, 0, 8_192))
    for ax, (case, transient, length) in zip(axes, cycles, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=transient + length)
        rk.plot.spectrum(rk.spectral_density(motion, transient=transient), ax)
        rk.plot.title(ax, case.name)
    lows, highs = zip(*(ax.get_ylim() for ax in axes), strict=True)
    for ax in axes:
        ax.set_ylim(min(lows), max(highs))
    return figure


@YIM_LIN_1991.figure("9", cost=0.3)
def figure_9() -> Figure:
    """Figure 9: heteroclinic orbits of the free, undamped block between its unstable equilibria Θ = ±1, Eq. (17).

    The orbits are drawn from the closed form. Some of the closed orbits inside are shown; arrows give the direction of
    motion. Each heteroclinic orbit takes two formulas because the acceleration jumps at Θ = 0. Angle and velocity are
    continuous, because nothing is dissipated.
    """
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.heteroclinic(ax)
    return figure


@YIM_LIN_1991.figure("10", cost=1.8, pixels=True)
def figure_10() -> Figure:
    """Figure 10: response of a block initially at rest as a function of period and amplitude, e = 1.

    (a) 160 × 160 points, with the fraction of each type of response; each point is simulated for at most 10⁴ cycles. (b)
    The symbols of the paper at 27 × 27 of these points; a dot is a type of response that the paper's legend lacks. The
    paper's axes are not known; here T runs from 0.2 to 3 and A from 0 to 16.

    Difference from the paper: the paper takes this map as evidence that no stable periodic response exists. The
    quasi-periodic motions lie on islands around periodic ones that are neutrally stable, as in figure 5. Four fifths of
    the map overturn, and a few per cent are chaotic. Both types, quasi-periodic and chaotic, refer to the cycles
    simulated. Undetermined motions stay near the edges of islands for longer than that.
    """
    return _draw_map(surveys.undamped(), "10")


@YIM_LIN_1991.figure("11", cost=1.3, pixels=True)
def figure_11() -> Figure:
    """Figure 11: response of a block from rest over period and amplitude, e = 0.925, with stability boundaries.

    (a) 400 × 400 points, with the fraction of each type of response; types below 0.01 % are not listed. (b) The symbols
    of the paper at 29 × 29 of these points; a dot is a response that the paper's legend lacks. The curves are closed
    forms. The (1, 1) and the (1, 3) mode are stable up to A_SB; Melnikov's function has zeros above A_M. A curve is
    dotted where the closed-form mode is inadmissible: it would pass through Θ = 0 within the half-cycle. The paper's axes
    are not known; here T runs from 0.2 to 3 and A from 0 to 16.

    Difference from the paper: the paper takes the curve of the (1, 3) mode as its upper bound throughout. Where the curve
    is dotted, below T = 0.8 or so, the mode ends at a smaller amplitude, in a grazing impact. Beyond the curve of the (1,
    1) mode most points overturn; nearly all others have period 1 and are asymmetric. A_M is not a lower bound for chaos:
    most of the map lies above it, and almost none of that is chaotic (see figure 12).
    """
    return _draw_map(surveys.damped(), "11", ("symmetry-breaking-1", "symmetry-breaking-3", "melnikov"))


@YIM_LIN_1991.figure("12", cost=0.3)
def figure_12() -> Figure:
    """Figure 12: stability bound A_SB of the (1, 1) mode and Melnikov's amplitude A_M, e = 0.8 and 0.9.

    The (1, 1) mode is stable below A_SB, where its symmetry breaks. Melnikov's function has zeros above A_M (Eq. (22)).
    Both are closed forms; colour distinguishes the amplitudes, the dash the coefficient of restitution. The paper's axes
    are not known; here T runs from 0.2 to 3 and A from 0 to 16.

    Difference from the paper: the paper takes A_M as a lower bound for chaotic responses. It regards chaos as likely
    between the curves, in a region that grows with e. A_M is the first-order approximation of the amplitude A* at which
    the manifolds of the saddle orbits touch. It lies below A* for slow forcing and above it for fast forcing.
    Intersecting manifolds make the boundary of overturning fractal; they do not make bounded motions chaotic.
    """
    figure, (ax,) = rk.plot.panels(height=3.4)
    curves = {}
    periods = np.linspace(*surveys.PERIODS, 561)
    for e in (0.8, 0.9):
        curves[f"$A_{{SB}}$, $e = {e:g}$"] = rk.theory.symmetry_breaking_amplitude(periods, e, 1)
        curves[f"$A_M$, $e = {e:g}$"] = rk.theory.melnikov_amplitude(periods, e)
    rk.plot.thresholds(periods, curves, ax)
    ax.set(xlim=surveys.PERIODS, ylim=surveys.AMPLITUDES)
    # A_M has the same colour as in the figure of the exact threshold, A_SB a colour of its own
    for line in (*ax.lines, *ax.get_legend().legend_handles):
        if "SB" in str(line.get_label()):
            line.set_color(rk.plot.palette.SERIES[2])
    return figure


@YIM_LIN_1991.figure("13a", cost=0.4, pixels=True)
def figure_13a() -> Figure:
    """Figure 13a: Poincaré map of the chaotic response between braces, A = 15, T = 2, e = 0.925, from rest.

    The braces stand at the critical angle, Θb = 1, and are perfectly elastic, r = 1. The section lies at the forcing
    phase ψ = 0, just after any event at that instant. The map shows 10⁵ cycles after a transient of 1,000. The motion
    starts with φ = 0. The paper gives neither the phase of its section nor the number of its points.
    """
    motion = rk.simulate(BRACED, cycles=1_000 + 100_000 - 1, record="section")
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.section(motion, ax, transient=1_000)
    return figure


@YIM_LIN_1991.figure("13b", cost=4.3, pixels=True)
def figure_13b() -> Figure:
    """Figure 13b: response of a block initially at rest between braces over period and amplitude, e = 0.925, r = 1.

    The braces stand at the critical angle, Θb = 1. (a) 50 × 50 points, with the fraction of each type of response. (b)
    The symbols of the paper at 25 × 25 of these points; a dot is a response that the paper's legend lacks. The paper's
    axes are not known; here T runs from 0.2 to 3 and A from 0 to 16. Points are simulated for up to 10⁵ cycles, because
    motions between braces count as chaotic only then. Most motions that appear chaotic for a thousand cycles become
    periodic later.

    Difference from the paper: the paper's legend has no symbol for asymmetric responses of odd period, which fill much of
    the map. Here they have the symbol of their period. Chaos does not dominate where brace impacts are frequent: chaotic
    points are few even there.
    """
    return _draw_map(surveys.braced(), "13b")


def _draw_pair(
    case: Case,
    history: tuple[int, int] | None = None,
    portrait: tuple[int, int] | None = None,
    arrows: Sequence[float] = (),
    legend: bool = False,
) -> Figure:
    """Draw the time history and the phase portrait of a case over some cycles; None is the whole motion.

    Arrows stand in the portrait at the cycles of `arrows`. At e = 1 a legend of the impacts has one mark for both of its rows.
    """
    motion = case.motion()
    figure, (left, right) = rk.plot.panels(columns=2, height=3.0, ratios=(3, 2))
    rk.plot.time_history(motion, left, cycles=history)
    rk.plot.phase_portrait(motion, right, cycles=portrait)
    for cycle in arrows:
        _draw_arrow(right, motion, cycle)
    if not legend:
        right.get_legend().remove()
    rk.plot.title(left, "time history")
    rk.plot.title(right, "phase portrait")
    return figure


def _draw_arrow(ax: Axes, motion: Motion, cycle: float) -> None:
    """Draw an arrow in the direction of motion on a phase portrait, at a number of cycles from the start."""
    period = motion.system.harmonic.period
    tail, head = (motion.at((cycle + step) * period) for step in (-0.005, 0.005))
    arrow = {
        "arrowstyle": "-|>",
        "color": rk.plot.palette.MOTION,
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": 11,
    }
    ax.annotate("", head, tail, arrowprops=arrow)


def _draw_map(survey: xr.Dataset, symbols: str, curves: Sequence[str] = ()) -> Figure:
    """Draw a map over period and amplitude in colour and in symbols."""
    figure, (left, right) = rk.plot.panels(columns=2, height=4.4)
    rk.plot.parametric_map(survey, left, curves=curves)
    rk.plot.parametric_map(survey, right, curves=curves, symbols=symbols)
    rk.plot.title(left, f"{survey.period.size} × {survey.amplitude.size} points")
    rk.plot.title(right, "symbols of the paper")
    return figure
