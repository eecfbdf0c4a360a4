"""A response and what it is, at a glance: for `rocking classify --plot`, and in a notebook."""

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

from rocking.model import Block, Kind, Orbit, Outcome, State, TooManyEvents, Verdict, instance
from rocking.motion import simulate
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.plot.parts.legend import COLOURS
from rocking.plot.parts.sample_times import settled
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.section import section
from rocking.plot.time_history import time_history

ENDS = (Kind.OVERTURNED, Kind.REST)
# Cycles in the time history, of a periodic one at least a period, and points in the section.
SHOWN = 20
DECAY_SHOWN = 200
POINTS = 5_000
# A longer run is not run again only to be drawn where it ended.
LATEST = 100_000
LETTERS = 122
# Width of the band in the kind's colour, as a share of the figure's.
BAND = 0.007
# What is left of the transient where the last cycles begin.
LEFT = 1e-4
# Points of the section nearer to each other than this are those of one periodic orbit.
SAME = 1e-3
# So many points of a run that has become periodic repeat themselves at its end.
LAST = 200
OTHERWISE = "this run of it ends otherwise"


def verdict(verdict: Verdict, block: Block | None = None) -> Figure:
    """Draws the last cycles of a response, its phase portrait and its section, under the sentence that says what it is.

    Parameters
    ----------
    verdict : Verdict
        From `classify`.
    block : Block, optional
        Gives SI axes; otherwise they are normalised.

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    TypeError
        If `verdict` is none, or `block` is of another kind.

    See Also
    --------
    overview : Plot a motion.
    rocking.classify : Classify a response.

    Notes
    -----
    A block that overturns or comes to rest is shown until it has, without a section. In the section of a periodic response
    the points on the way lead to the orbit, which is ringed. The band at the left has the colour of the kind.

    The motion is drawn from a run of `simulate`. It may follow another chaotic transient than the run of `classify`, because
    the two round differently. Where the run that is drawn contradicts the verdict, a note above it says so.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> len(rk.plot.verdict(rk.classify(system)).axes)
    3
    """
    instance("verdict", verdict, Verdict)
    figure = Figure(
        figsize=(style.PAGE, 5.2), layout=ConstrainedLayoutEngine(rect=(2 * BAND, 0.0, 1.0 - 2 * BAND, 1.0))
    )
    figure.add_artist(Rectangle((0.0, 0.0), BAND, 1.0, color=COLOURS[verdict.kind], linewidth=0, gid="kind"))
    sentence = textwrap.fill(str(verdict), LETTERS)
    figure.suptitle(sentence, x=3 * BAND, ha="left", fontsize=style.SMALL, color=style.INK)
    if verdict.kind in ENDS:
        figure.set_figheight(3.4)
        axes = figure.subplot_mosaic([["history", "portrait"]], width_ratios=(3, 2))
    else:
        axes = figure.subplot_mosaic([["history", "history"], ["portrait", "section"]], height_ratios=(2, 3))
        _section(verdict, axes["section"], block)
    _motion(verdict, axes["history"], axes["portrait"], block)
    return figure


def _motion(verdict: Verdict, history: Axes, portrait: Axes, block: Block | None) -> None:
    """The time history and the phase portrait of the last cycles, or a word where they hold too many events."""
    first, cycles = _window(verdict)
    try:
        start = _after(verdict, first)
        motion = simulate(verdict.system, start, cycles=cycles)
    except TooManyEvents:
        for ax in (history, portrait):
            ax.set_axis_off()
            ax.text(0.5, 0.5, "too many events to draw", ha="center", fontsize=style.SMALL, color=style.INK)
        return
    period = motion.system.forcing.period
    rests = motion.outcome is Outcome.AT_REST
    window = (0.0, min(settled(motion) / period, motion.cycles)) if rests else None
    time_history(motion, history, block, window)
    phase_portrait(motion, portrait, block, window)
    if verdict.kind in ENDS and motion.outcome is Outcome.BOUNDED:
        style.note(history, OTHERWISE)
    if verdict.period and not _repeats(motion.section()[-verdict.period - 1 :], verdict.period):
        style.note(history, OTHERWISE)
    if first > 0:
        unit = quantities(block).time_unit
        history.set_xlabel(f"time after cycle {first:,} ({unit})", fontsize=style.TEXT, color=style.INK)


def _window(verdict: Verdict) -> tuple[int, int]:
    """(first cycle shown, how many): the end where there is one, else what comes after the cycles followed."""
    if verdict.kind is Kind.OVERTURNED:
        first = max(verdict.cycles - SHOWN, 0)
        return first, max(verdict.cycles - first, 1)
    if verdict.kind is Kind.REST:
        first = max(verdict.cycles - DECAY_SHOWN, 0)
        # rest is certain long before its last impact; what follows that is not drawn
        return first, 10 * (verdict.cycles - first) + SHOWN
    period = verdict.period or 1
    first = verdict.cycles + (0 if verdict.orbit is None else _settling(verdict.orbit))
    return min(first, LATEST), period * max(1, math.ceil(SHOWN / period))


def _settling(orbit: Orbit) -> int:
    """Cycles until its multipliers have made differences LEFT times as large; a neutral orbit has none."""
    size = abs(orbit.multipliers[0])
    return orbit.period * math.ceil(math.log(LEFT) / math.log(size)) if 0.0 < size < 1.0 - 1e-6 else 0


def _after(verdict: Verdict, cycles: int) -> State:
    if cycles == 0:
        return verdict.start
    return simulate(verdict.system, verdict.start, cycles=cycles, record="none").final


def _repeats(points: NDArray, period: int) -> bool:
    """Whether all points of a section repeat themselves with a period, of which there is one at least."""
    apart = np.hypot(*(points[period:] - points[:-period]).T)
    return apart.size > 0 and bool(apart.max() <= SAME)


def _section(verdict: Verdict, ax: Axes, block: Block | None) -> None:
    orbit, phase = verdict.orbit, verdict.system.forcing.phase
    try:
        if orbit is None:
            late = _after(verdict, min(verdict.cycles, LATEST))
            motion = simulate(verdict.system, late, cycles=POINTS, record="section")
            section(motion.section(), ax, block, phase)
            last = motion.section()[-LAST:]
            if verdict.kind is Kind.CHAOTIC and any(_repeats(last, n) for n in range(1, LAST // 2)):
                style.title(ax, OTHERWISE)
            return
        cycles = min(verdict.cycles, LATEST) + 2 * orbit.period
        motion = simulate(verdict.system, verdict.start, cycles=cycles, record="section")
    except TooManyEvents:
        ax.set_axis_off()
        return
    # where it forgets, the orbit's own phase is that of a release, at which there is nothing to see
    phase = (orbit.phase + 0.5 * math.pi) % math.tau if orbit.superstable else orbit.phase
    points = motion.section(phase)
    section(points[: -orbit.period], ax, block, phase)
    _ring(ax, _on(orbit, points), block, verdict.kind)


def _on(orbit: Orbit, points: NDArray) -> NDArray:
    """The points of an orbit: from itself, or, where it forgets, the last ones, which lie on it."""
    if orbit.superstable:
        return points[-orbit.period :]
    system = evolve(orbit.system, forcing=evolve(orbit.system.forcing, phase=orbit.phase))
    return simulate(system, orbit.state, cycles=orbit.period, record="section").section()[:-1]


def _ring(ax: Axes, points: NDArray, block: Block | None, kind: Kind) -> None:
    ax.lines[-1].set(color=style.GUIDE, label="on the way")
    shown = quantities(block)
    ax.plot(
        shown.angle(points[:, 0]),
        shown.velocity(points[:, 1]),
        linestyle="none",
        marker="o",
        markersize=1.6 * style.MARK,
        markerfacecolor="none",
        markeredgecolor=COLOURS[kind],
        label="orbit",
        gid="orbit",
        zorder=3,
    )
    style.key(ax)
