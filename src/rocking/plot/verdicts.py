"""Plots of a verdict with its evidence, and of the convergence of Lyapunov exponents."""

from __future__ import annotations

import math
import textwrap

import numpy as np
from attrs import evolve
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.orbit import Orbit
from rocking.model.system import State
from rocking.model.text import plus_minus
from rocking.model.validation import TooManyEvents, instance, whole
from rocking.model.verdict import Kind, Outcome, Verdict
from rocking.motion.simulate import simulate
from rocking.plot import figures, style
from rocking.plot.axes import Units, units_of
from rocking.plot.motions import phase_portrait, settled, time_history
from rocking.plot.palette import look_of
from rocking.plot.sections import section
from rocking.response.lyapunov import LyapunovSpectrum

ENDS = (Kind.OVERTURNED, Kind.REST)
# Cycles in the time history (at least one period of a periodic response), and points in the section.
MAX_SHOWN = 20
DECAY_SHOWN = 200
POINTS = 5_000
# Last cycle up to which a run is repeated for drawing.
LATEST = 100_000
LETTERS = 118
# Width of the band in the colour of the type of response, as a fraction of the width of the figure.
BAND = 0.007
# Remaining fraction of the transient at the start of the last cycles.
LEFT = 1e-4
# Points of the section closer to each other than this belong to one periodic orbit.
SAME = 1e-3
# Number of final points of a run that must repeat themselves if the run has become periodic.
LAST = 200
OTHERWISE = "the run shown ends differently"


def verdict(result: Verdict, block: Block | None = None, *, title: bool = True) -> Figure:
    """Plot the last cycles of a response, its phase portrait and its section, below the text of its verdict.

    Parameters
    ----------
    result : Verdict
        Result of `classify`.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.
    title : bool
        Whether the text of the verdict stands above. A notebook shows it below the figure. Default: True.

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    TypeError
        If `result` is not a Verdict, `block` is not a Block, or `title` is not a bool.

    See Also
    --------
    overview : Plot a motion.
    rocking.classify : Classify a response.

    Notes
    -----
    A motion that overturns or comes to rest is shown up to that event, without a section. In the section of a periodic
    response, grey points are the transient and rings the orbit. The band at the left has the colour of the type of response.

    The motion is drawn from a run of `simulate`. This run may follow another chaotic transient than the run of `classify`,
    because the two round differently. If the run contradicts the verdict, a note states it.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> len(rk.plot.verdict(rk.classify(system)).axes)
    3
    """
    instance("result", result, Verdict)
    units_of(block)  # refused before there is a figure
    instance("title", title, bool)
    figure = _figure(result, block)
    if title:
        sentence = textwrap.fill(str(result), LETTERS)
        figure.suptitle(sentence, x=3 * BAND, ha="left", fontsize=style.SMALL, color=style.INK)
    return figure


def _figure(verdict: Verdict, block: Block | None) -> Figure:
    """Return the figure of a verdict without its text."""
    layout = ConstrainedLayoutEngine(rect=(2 * BAND, 0.0, 1.0 - 2 * BAND, 1.0))
    figure = figures.new(style.PAGE, 5.2, layout)
    figure.add_artist(
        Rectangle((0.0, 0.0), BAND, 1.0, color=look_of(verdict).colour, linewidth=0, gid="kind")
    )
    if verdict.kind in ENDS:
        figure.set_figheight(3.4)
        axes = figure.subplot_mosaic([["history", "portrait"]], width_ratios=(3, 2))
    else:
        axes = figure.subplot_mosaic([["history", "history"], ["portrait", "section"]], height_ratios=(2, 3))
        _section(verdict, axes["section"], block)
    _motion(verdict, axes["history"], axes["portrait"], block)
    return figure


def _motion(verdict: Verdict, history: Axes, portrait: Axes, block: Block | None) -> None:
    """Draw the time history and the phase portrait of the last cycles, or a note if they hold too many events."""
    first, cycles = _window(verdict)
    try:
        motion = simulate(verdict.system, _after(verdict, first), cycles=cycles)
    except TooManyEvents:
        for ax in (history, portrait):
            ax.set_axis_off()
            ax.text(0.5, 0.5, "too many events to draw", ha="center", fontsize=style.SMALL, color=style.INK)
        return
    period = motion.system.periodic.period
    rests = motion.outcome is Outcome.AT_REST
    window = (0.0, min(settled(motion) / period, motion.cycles)) if rests else None
    time_history(motion, history, block, cycles=window)
    phase_portrait(motion, portrait, block, cycles=window)
    if verdict.kind in ENDS and motion.outcome is Outcome.BOUNDED:
        style.note(history, OTHERWISE)
    if verdict.period and not _repeats(motion.section()[-verdict.period - 1 :], verdict.period):
        style.note(history, OTHERWISE)
    if first > 0:
        label = rf"time $\tau$ after cycle {first:,}" if block is None else f"time after cycle {first:,} (s)"
        history.set_xlabel(label, fontsize=style.TEXT, color=style.INK)


def _window(verdict: Verdict) -> tuple[int, int]:
    """Return the cycles shown: the end of the motion, or the cycles after the simulated ones.

    Returns
    -------
    tuple of (int, int)
        First cycle, and number of cycles.
    """
    if verdict.kind is Kind.OVERTURNED:
        first = max(verdict.cycles - MAX_SHOWN, 0)
        return first, max(verdict.cycles - first, 1)
    if verdict.kind is Kind.REST:
        first = max(verdict.cycles - DECAY_SHOWN, 0)
        # rest is certain long before the last impact; the motion after the last impact is not drawn
        return first, 10 * (verdict.cycles - first) + MAX_SHOWN
    period = verdict.period or 1
    first = verdict.cycles + (0 if verdict.orbit is None else _settling(verdict.orbit))
    return min(first, LATEST), period * max(1, math.ceil(MAX_SHOWN / period))


def _settling(orbit: Orbit) -> int:
    """Return the number of cycles after which perturbations have shrunk to LEFT of their size; 0 for a neutral orbit."""
    size = abs(orbit.multipliers[0])
    return orbit.period * math.ceil(math.log(LEFT) / math.log(size)) if 0.0 < size < 1.0 - 1e-6 else 0


def _after(verdict: Verdict, cycles: int) -> State:
    if cycles == 0:
        return verdict.start
    return simulate(verdict.system, verdict.start, cycles=cycles, record="none").final


def _repeats(points: NDArray, period: int) -> bool:
    """Return whether all points of a section repeat themselves with a period; False for less than one period."""
    apart = np.hypot(*(points[period:] - points[:-period]).T)
    return apart.size > 0 and bool(apart.max() <= SAME)


def _section(verdict: Verdict, ax: Axes, block: Block | None) -> None:
    orbit, phase = verdict.orbit, verdict.system.periodic.phase
    try:
        if orbit is None:
            late = _after(verdict, min(verdict.cycles, LATEST))
            motion = simulate(verdict.system, late, cycles=POINTS, record="section")
            section(motion.section(), ax, block, phase=phase)
            last = motion.section()[-LAST:]
            if verdict.kind is Kind.CHAOTIC and any(_repeats(last, n) for n in range(1, LAST // 2)):
                style.title(ax, OTHERWISE)
            return
        cycles = min(verdict.cycles, LATEST) + 2 * orbit.period
        motion = simulate(verdict.system, verdict.start, cycles=cycles, record="section")
    except TooManyEvents:
        ax.set_axis_off()
        return
    # a superstable orbit has the phase of a release, at which the block rests; a quarter period later it moves
    phase = (orbit.phase + 0.5 * math.pi) % math.tau if orbit.superstable else orbit.phase
    points = motion.section(phase)
    section(points[: -orbit.period], ax, block, phase=phase)
    _ring(ax, _on(orbit, points), block, look_of(verdict).colour)


def _on(orbit: Orbit, points: NDArray) -> NDArray:
    """Return the points of an orbit; those of a superstable orbit are the last points of the section."""
    if orbit.superstable:
        return points[-orbit.period :]
    system = evolve(orbit.system, forcing=evolve(orbit.system.periodic, phase=orbit.phase))
    return simulate(system, orbit.state, cycles=orbit.period, record="section").section()[:-1]


def _ring(ax: Axes, points: NDArray, block: Block | None, colour: str) -> None:
    ax.lines[-1].set(color=style.GUIDE, label="transient")
    units = units_of(block)
    ax.plot(
        units.angle(points[:, 0]),
        units.velocity(points[:, 1]),
        linestyle="none",
        marker="o",
        markersize=1.6 * style.MARK,
        markerfacecolor="none",
        markeredgecolor=colour,
        label="orbit",
        gid="orbit",
        zorder=3,
    )
    style.key(ax)


def convergence(
    result: LyapunovSpectrum, ax: Axes | None = None, block: Block | None = None, *, exponent: int = 1
) -> Axes:
    """Plot the running average of a Lyapunov exponent against the number of cycles, with its error as a band.

    Parameters
    ----------
    result : LyapunovSpectrum
        Result of `lyapunov`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for exponents per second. Default: exponents per τ.
    exponent : int
        1 for λ₁, 2 for λ₂. Default: 1.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a LyapunovSpectrum, or an argument has the wrong type.
    ValueError
        If `exponent` is neither 1 nor 2.

    See Also
    --------
    rocking.lyapunov : Compute the exponents.

    Notes
    -----
    There is no band where the batches are too few for an error. The dashed line is the final value. A thin line marks
    zero if zero lies within the axes. An exponent of −∞ has no line. The axes then state the value and its cause.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.convergence(rk.lyapunov(system))
    >>> ax.get_xscale(), len(ax.lines)
    ('log', 2)
    """
    instance("result", result, LyapunovSpectrum)
    row = whole("exponent", exponent, 1, 2) - 1
    units = units_of(block)
    final, error = (float(units.frequency(each[row])) for each in (result.values, result.errors))
    ax = style.own(ax)
    ax.set_xscale("log")
    if final == -math.inf:
        _superstable(ax, result.cycles)
    else:
        _running(ax, result, row, units)
    unit = r"per $\tau$" if block is None else "(1/s)"
    style.label(ax, "cycles averaged over", rf"exponent $\lambda_{exponent}$ {unit}")
    style.logarithmic(ax.xaxis)
    style.note(ax, rf"$\lambda_{exponent}$ = {plus_minus(final, error)}".replace("-", "−"))
    return ax


def _superstable(ax: Axes, cycles: int) -> None:
    """State in empty axes that there is no running average, because perturbations vanish."""
    ax.set(xlim=(1, max(cycles, 2)), yticks=[])
    cause = "no line: perturbations vanish while the block\nrests or stays in contact with a brace"
    ax.text(
        0.5, 0.5, cause, transform=ax.transAxes, ha="center", va="center", fontsize=style.SMALL, gid="cause"
    )


def _running(ax: Axes, spectrum: LyapunovSpectrum, row: int, units: Units) -> None:
    """Draw the running average with its error, its final value, and zero if it lies within the axes."""
    history = spectrum.history
    cycles = history["cycles"]
    values, errors = (units.frequency(history[name][:, row]) for name in ("values", "errors"))
    known = np.isfinite(errors)
    ax.fill_between(
        cycles[known],
        (values - errors)[known],
        (values + errors)[known],
        color=style.MOTION,
        alpha=0.3,
        linewidth=0,
        gid="error",
    )
    ax.axhline(
        float(units.frequency(spectrum.values[row])),
        color=style.GUIDE,
        linewidth=style.THIN,
        linestyle="--",
        gid="final",
    )
    ax.plot(cycles, values, color=style.MOTION, linewidth=style.LINE, gid="running")
    low, high = ax.get_ylim()
    if low <= 0.0 <= high:
        ax.axhline(0.0, color=style.INK, linewidth=style.THIN, gid="zero")
