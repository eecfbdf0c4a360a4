"""Plots of a motion: time history, phase portrait, and both with the base acceleration."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.forcing import Forcing, Harmonic, PiecewiseLinear, Pulse
from rocking.model.system import System
from rocking.model.validation import Refusal, WrongType, instance, refuse_if, within
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion, end_shown, fallen, has_cycles
from rocking.plot import figures, style
from rocking.plot.axes import Units, balance_symbol, units_of
from rocking.plot.sections import section

SAMPLES_PER_TIME = 64
SAMPLES_PER_PICTURE = 1000
MAX_SAMPLES = 500_000
STILLNESS_SHOWN = 0.15


def window(motion: Motion, cycles: tuple[float, float] | None) -> tuple[float, float]:
    """Return the first and the last instant shown, in τ.

    `cycles` = (first, last) counts from the start; None selects the whole motion. An overturned motion is shown up to
    |Θ| = 3, or until it lies flat with the full equation, beyond the instant at which overturning is certain.
    """
    instance("result", motion, Motion)
    end = end_shown(motion)
    if cycles is None:
        return 0.0, end
    refuse_if(
        not has_cycles(motion),
        "cycles",
        "be omitted for a base motion of finite length, which has no cycles",
        cycles,
    )
    try:
        first, last = cycles
    except (TypeError, ValueError):
        raise WrongType("cycles", "be a pair (first, last)", cycles) from None
    first, last = (within("cycles", each, 0, motion.cycles) for each in (first, last))
    if last <= first:
        raise Refusal("cycles", "be a pair (first, last) with first < last", cycles)
    period = motion.system.periodic.period
    allowed = f"begin before |Θ| = {fallen(motion):g}, in cycle {end / period:.4g}"
    refuse_if(first * period >= end, "cycles", allowed, cycles)
    return first * period, min(last * period, end)


def settled(motion: Motion) -> float:
    """Return a time τ after the last event of a motion that came to rest, late enough to show that it stays there."""
    events = motion.events
    last = float(events["time"][-1]) if len(events) else 0.0
    if last == 0:
        return motion.duration
    forcing = motion.system.forcing
    cycle = forcing.span if has_cycles(motion) and forcing.largest else 0.0
    still = max(STILLNESS_SHOWN * last, cycle)
    return min(last + still, motion.duration)


def trace(motion: Motion, start: float, stop: float) -> tuple[NDArray, NDArray, NDArray]:
    """Sample a motion from `start` to `stop`: a grid, every extreme, and every event before and after it.

    The grid resolves the time scale of the forcing, the unit of τ and the figure. It has no instant at which the block stands
    still. Over a long motion the grid thins out (to 500,000 instants); events and extremes are always complete.

    Returns
    -------
    tuple of (array, array, array)
        Times, angles and velocities, normalised.
    """
    peaks, events = inside(motion.peaks, start, stop), inside(motion.events, start, stop)
    smooth = np.union1d(_grid(motion, start, stop, events["time"]), peaks["time"])
    angle, velocity = motion.at(smooth)
    arrivals = events[events["time"] > start]
    time = np.concatenate([arrivals["time"], smooth, events["time"]])
    # A stable sort keeps, at an event's instant, the state before it in front of the state after it.
    order = np.argsort(time, kind="stable")
    angles = np.concatenate([arrivals["angle"], angle, events["angle"]])
    velocities = np.concatenate([arrivals["before"], velocity, events["after"]])
    return time[order], angles[order], velocities[order]


def _grid(motion: Motion, start: float, stop: float, events: NDArray) -> NDArray:
    """Return both ends, and equal steps inside each arc on which the block moves."""
    ends = np.unique(np.concatenate([[start], events, [stop]]))
    lengths, middles = np.diff(ends), (ends[1:] + ends[:-1]) / 2
    moves = (motion.at(middles)[1] != 0) | (motion.acceleration(middles) != 0)
    finest = min(
        min(motion.system.forcing.time_scale, 1.0) / SAMPLES_PER_TIME, (stop - start) / SAMPLES_PER_PICTURE
    )
    step = max(finest, float(lengths[moves].sum()) / MAX_SAMPLES)
    steps = np.where(moves, np.ceil(lengths / step), 1).astype(int)
    arc = np.repeat(np.arange(len(steps)), steps - 1)
    number = 1 + np.arange(len(arc)) - np.repeat(np.cumsum(steps - 1) - (steps - 1), steps - 1)
    return np.concatenate([[start, stop], ends[arc] + number / steps[arc] * lengths[arc]])


def inside(records: NDArray, start: float, stop: float) -> NDArray:
    """Return the structured `records` whose time lies in [start, stop]."""
    return records[(records["time"] >= start) & (records["time"] <= stop)]


def base_displacement(forcing: Forcing, block: Block, times: NDArray) -> tuple[NDArray, float, float | None]:
    """Return the displacement of the base under a block at times τ, in m, its largest size, and its drift.

    A harmonic base moves about the origin. Any other one moves from rest, and may not return: its displacement at the
    end is the drift.
    """
    if isinstance(forcing, Harmonic):
        stretch = block.acceleration(1.0) / (math.tau * block.hertz(forcing.frequency)) ** 2
        return -stretch * forcing.acceleration(times), forcing.amplitude * stretch, None
    if not isinstance(forcing, (PiecewiseLinear, Pulse)):
        raise TypeError(f"the displacement of a base moved by {type(forcing).__name__} is not known")
    stretch = block.acceleration(1.0) / block.rate_unit**2
    moved = stretch * forcing.displacement(times)
    return moved, float(np.abs(moved).max()), float(stretch * forcing.displacement(forcing.span))


RATIOS = (2, 1)
"""Heights of the panels of angle and base acceleration."""


def time_history(
    result: Motion,
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    cycles: tuple[float, float] | None = None,
) -> Axes:
    r"""Plot the angle of a motion against time, with exact corners at impacts and exact extremes.

    Parameters
    ----------
    result : Motion
        Motion recorded with ``record="all"``.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide. Under a base motion of finite length it has a second
        panel, with the base acceleration.
    block : Block, optional
        Block for SI axes, seconds and degrees. Default: that of the result. None: normalised axes.
    cycles : tuple of float, optional
        First and last forcing cycle shown, counted from the start. Default: the whole motion; if it overturned, up to
        three times the critical angle, or until it lies flat with the full equation. Omit it for a base motion of finite length.

    Returns
    -------
    matplotlib Axes
        Axes of the angle.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `cycles` lies outside the motion or is given for a motion without cycles, or the motion kept no events.

    See Also
    --------
    phase_portrait : Plot velocity against angle.
    overview : Plot both.
    rocking.simulate : Compute a motion.

    Notes
    -----
    Dotted lines mark the critical angle, dashed lines the braces. They are omitted if the motion stays below half of it.
    Dotted lines in the panel of the base acceleration mark the one beyond which a block at rest lifts off.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.time_history(rk.simulate(system, cycles=60), cycles=(50, 60))
    >>> print(ax.get_xlabel())
    time $\tau = \alpha t$
    """
    start, stop = window(result, cycles)
    units_of(block)  # refused before there is a figure
    if ax is not None or has_cycles(result):
        return draw_history(style.own(ax), result, start, stop, block)
    figure = figures.new(style.COLUMN, 3.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=RATIOS)
    return draw_with_base(above, below, result, block)


def draw_with_base(above: Axes, below: Axes, motion: Motion, block: Block | None) -> Axes:
    """Draw the angle of a motion with its outcome, and below it the base acceleration; return the axes of the angle."""
    start, stop = window(motion, None)
    draw_history(above, motion, start, stop, block)
    draw_base(below, motion, start, stop, block)
    above.set_xlabel("")
    above.tick_params(labelbottom=False)
    style.note(above, _outcome(motion))
    above.figure.align_ylabels([above, below])
    return above


def _outcome(motion: Motion) -> str:
    """Return the outcome of a motion in a few words, and where the drawing of a fall ends."""
    if motion.peak == 0.0:
        return "stands still"
    if motion.outcome is not Outcome.OVERTURNED:
        return {Outcome.AT_REST: "comes to rest", Outcome.BOUNDED: "rocks until the end"}[motion.outcome]
    if motion.system.critical_angle is not None:
        return "overturns, lies flat at the end"
    return f"overturns, drawn to {fallen(motion):g} ${balance_symbol(motion.system.block)}$"


def draw_base(ax: Axes, motion: Motion, start: float, stop: float, block: Block | None) -> Axes:
    """Draw the base acceleration from time `start` to `stop`, in τ, and the accelerations that lift a block off if it comes near.

    Under a vertical acceleration a_v of the base in units of g they are 1 + a_v times those without it.
    """
    forcing, units = motion.system.forcing, units_of(block, motion.block)
    time = np.linspace(start, stop, SAMPLES_PER_PICTURE)  # also at a jump, where no sample is
    if isinstance(forcing, PiecewiseLinear):
        samples = forcing.step * np.arange(forcing.values.size)
        time = np.union1d(time, samples[(samples >= start) & (samples <= stop)])
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN)
    if forcing.largest > 0.5:
        # a record begins weakly, a pulse is over at the end
        first, last = (np.abs(forcing.acceleration(part)).max() for part in np.array_split(time, 3)[::2])
        vertical = motion.system.vertical
        _pair(
            ax,
            tuple(units.amplitude(level) for level in motion.system.lift_offs),
            style.GUIDE,
            "dotted",
            "lift-off from rest",
            at_right=last < first,
            weight=None if vertical is None else (units.time(time), 1.0 + vertical.acceleration(time)),
        )
    ax.plot(
        units.time(time),
        units.amplitude(forcing.acceleration(time)),
        color=style.INK,
        linewidth=style.THIN,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="base",
    )
    style.label(ax, units.time_label, units.base_label)
    return ax


def draw_history(ax: Axes, motion: Motion, start: float, stop: float, block: Block | None) -> Axes:
    """Draw the angle from time `start` to `stop`, in τ."""
    time, angle, _ = trace(motion, start, stop)
    units = units_of(block, motion.block)
    _guides(ax, motion.system, units, float(np.abs(angle).max()), at_right=has_cycles(motion))
    ax.plot(
        units.time(time),
        units.angle(angle),
        color=style.MOTION,
        linewidth=style.LINE,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="motion",
    )
    ax.set_xlim(units.time(start), units.time(stop))
    style.label(ax, units.time_label, units.angle_label)
    return ax


def _guides(ax: Axes, system: System, units: Units, largest: float, *, at_right: bool) -> None:
    """Draw the angle 0, and the braces or the critical angle if the motion exceeds half of it; none on the side of a wall."""
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN)
    if system.braces is None:
        left = 1.0 if system.left is None else math.inf if system.wall else system.left.angle_ratio
        restrained = system.block is not None and system.block.by_balance
        name = "unstable balance" if restrained else "critical angle"
        levels, colour, dashes = (left, 1.0), style.GUIDE, "dotted"
    else:
        levels, colour, dashes, name = (system.braces.angle,) * 2, style.BRACE, "dashed", "braces"
    if largest > 0.5 * min(levels):
        _pair(ax, tuple(map(units.angle, levels)), colour, dashes, name, at_right=at_right)


ROOM = 0.12
"""Room beyond the outermost line, for its name, as a share of the range."""


def _pair(
    ax: Axes,
    levels: tuple[float, float],
    colour: str,
    dashes: str,
    name: str,
    *,
    at_right: bool,
    weight: tuple[np.ndarray, np.ndarray] | None = None,
) -> None:
    """Draw lines at minus the first and plus the second level, the finite ones, with a name beyond the last.

    The name is at the left under a record, which begins weakly. With times and a weight at each, the levels are multiplied by it.
    """
    drawn = [level for level in (-levels[0], levels[1]) if math.isfinite(level)]
    ax.margins(y=ROOM)
    above = drawn[-1] > 0.0
    end = drawn[-1]
    for level in drawn:
        how: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": style.LINE, "gid": name}
        if weight is None:
            ax.axhline(level, **how)
        else:
            ax.plot(weight[0], level * weight[1], **how)
            end = float((level * weight[1]).max() if above else (level * weight[1]).min())
    ax.text(
        1.0 if at_right else 0.01,
        end,
        name,
        transform=ax.get_yaxis_transform(),
        ha="right" if at_right else "left",
        va="bottom" if above else "top",
        fontsize=style.SMALL,
        color=style.INK,
    )


STRIKES = {"impact": (style.IMPACT, "o"), "brace": (style.BRACE, "s")}
NAMES = {"impact": "impact", "brace": "brace impact"}
# A ring before, a dot after an impact, in units of their common size: where both coincide, both are visible.
RING, DOT = 1.3, 0.75


def phase_portrait(
    result: Motion,
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    cycles: tuple[float, float] | None = None,
) -> Axes:
    """Plot the phase portrait of a motion, with a stroke at each impact from the velocity before (ring) to after (dot).

    Parameters
    ----------
    result : Motion
        Motion recorded with ``record="all"``.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, degrees and degrees per second. Default: that of the result. None: normalised axes.
    cycles : tuple of float, optional
        First and last forcing cycle shown, counted from the start. Default: the whole motion; if it overturned, up to
        three times the critical angle, or until it lies flat with the full equation.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `cycles` lies outside the motion, or the motion kept no events.

    See Also
    --------
    time_history : Plot the angle against time.
    overview : Plot both.
    rocking.simulate : Compute a motion.

    Notes
    -----
    Base impacts lie at Θ = 0 (round; Eq. (2) of Yim & Lin 1991), brace impacts at ±Θb (square). At e = 1 the dot of an
    impact lies within its ring. Marks shrink as their number grows. A block that never moves is drawn as a dot.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.phase_portrait(rk.simulate(system, cycles=60), cycles=(50, 60))
    >>> [line.get_label() for line in ax.lines if not line.get_label().startswith("_")]
    ['before impact', 'after impact']
    """
    start, stop = window(result, cycles)
    time, angle, velocity = trace(result, start, stop)
    breaks = 1 + np.flatnonzero((np.diff(time) == 0) & (np.diff(velocity) != 0))
    events = inside(result.events, start, stop)
    events = events[np.isin(events["kind"], list(STRIKES))]
    units = units_of(block, result.block)
    ax = style.own(ax, height=3.0)
    ax.plot(
        units.angle(np.insert(angle, breaks, np.nan)),
        units.velocity(np.insert(velocity, breaks, np.nan)),
        color=style.MOTION,
        linewidth=style.line_width(len(events)),
        marker="o" if not np.ptp(angle) and not np.ptp(velocity) else "none",
        markersize=style.MARK,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="motion",
    )
    for kind, (colour, marker) in STRIKES.items():
        _strikes(ax, units, events[events["kind"] == kind], kind, colour, marker)
    style.label(ax, units.angle_label, units.velocity_label)
    if len(events):
        style.key(ax)
    return ax


def _strikes(ax: Axes, units: Units, hits: NDArray, kind: str, colour: str, marker: str) -> None:
    if not len(hits):
        return
    angle, before, after = (
        units.angle(hits["angle"]),
        units.velocity(hits["before"]),
        units.velocity(hits["after"]),
    )
    size, dense = 0.8 * style.point_size(len(hits)), len(hits) > style.MAX_MARKS
    ax.vlines(
        angle, before, after, colors=colour, linewidth=style.LINE, rasterized=dense, gid=f"{kind} strokes"
    )
    for when, velocity, face, scale in (("before", before, "none", RING), ("after", after, colour, DOT)):
        ax.plot(
            angle,
            velocity,
            linestyle="none",
            marker=marker,
            markersize=scale * size,
            markeredgewidth=min(0.8, size / 4),
            markeredgecolor=colour,
            markerfacecolor=face,
            rasterized=dense,
            label=f"{when} {NAMES[kind]}",
            gid=f"{kind} {when}",
            zorder=3,
        )


CYCLES_SHOWN = 30


def overview(result: Motion, block: Block | None = None) -> Figure:
    """Plot the time history and phase portrait of a motion, or its section or final state if only these were recorded.

    A bounded motion is shown by its last 30 cycles. A motion that comes to rest is shown until shortly after its last
    impact. Under a base motion of finite length the whole motion is shown, with the base acceleration below.

    Parameters
    ----------
    result : Motion
        Motion with any setting of ``record``.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    TypeError
        If an argument has the wrong type.

    See Also
    --------
    time_history : Plot the time history alone.
    phase_portrait : Plot the phase portrait alone.
    animation : Animate the motion.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> len(rk.plot.overview(rk.simulate(system, cycles=200)).axes)
    2
    """
    units = units_of(block, instance("result", result, Motion).block)  # refused before there is a figure
    if result.record != "all":
        figure, (ax,) = style.panels(height=3.0)
        kept = (
            result.section() if result.record == "section" else [(result.final.angle, result.final.velocity)]
        )
        forcing = result.system.forcing
        section(kept, ax, block, phase=forcing.phase if isinstance(forcing, Harmonic) else None)
        style.label(ax, units.angle_label, units.velocity_label)
        return figure
    if not has_cycles(result):
        return _with_base(result, block)
    cycles = _cycles(result)
    figure, (left, right) = style.panels(columns=2, height=3.0, ratios=(3, 2))
    time_history(result, left, block, cycles=cycles)
    phase_portrait(result, right, block, cycles=cycles)
    return figure


def _with_base(motion: Motion, block: Block | None) -> Figure:
    """Plot time history, base acceleration and phase portrait."""
    figure = figures.new(style.PAGE, 3.4)
    grid = figure.add_gridspec(2, 2, width_ratios=(3, 2), height_ratios=RATIOS)
    above = figure.add_subplot(grid[0, 0])
    below, right = figure.add_subplot(grid[1, 0], sharex=above), figure.add_subplot(grid[:, 1])
    for letter, ax in zip("abc", (above, below, right), strict=True):
        style.title(ax, f"({letter})")
    style.block_title(above, block, full=motion.system.critical_angle is not None)
    draw_with_base(above, below, motion, block)
    phase_portrait(motion, right, block)
    return figure


def _cycles(motion: Motion) -> tuple[float, float] | None:
    if motion.outcome is Outcome.AT_REST:
        return 0.0, min(settled(motion) / motion.system.periodic.period, motion.cycles)
    if motion.outcome is Outcome.BOUNDED and motion.cycles > CYCLES_SHOWN:
        return motion.cycles - CYCLES_SHOWN, motion.cycles
    return None
