"""Time history of the angle."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.forcing import PiecewiseLinear
from rocking.model.system import System
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion, fallen, has_cycles
from rocking.plot.parts import figures, style
from rocking.plot.parts.axis_units import Quantities, quantities
from rocking.plot.parts.sample_times import SAMPLES_PER_PICTURE, trace, window

RATIOS = (2, 1)
"""Heights of the panels of angle and base acceleration."""


def time_history(
    motion: Motion,
    ax: Axes | None = None,
    block: Block | None = None,
    cycles: tuple[float, float] | None = None,
) -> Axes:
    r"""Plot the angle of a motion against time, with exact corners at impacts and exact extremes.

    Parameters
    ----------
    motion : Motion
        Motion recorded with ``record="all"``.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide. Under a base motion of finite length it has a second
        panel, with the base acceleration.
    block : Block, optional
        Block for SI axes, seconds and degrees. Default: normalised axes.
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
    Dotted lines in the panel of the base acceleration mark g θcr, beyond which a block at rest lifts off.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.time_history(rk.simulate(system, cycles=60), cycles=(50, 60))
    >>> print(ax.get_xlabel())
    time $\tau = \alpha t$
    """
    start, stop = window(motion, cycles)
    quantities(block)  # refused before there is a figure
    if ax is not None or has_cycles(motion):
        return draw_history(style.own(ax), motion, start, stop, block)
    figure = figures.new(style.COLUMN, 3.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=RATIOS)
    return draw_with_base(above, below, motion, block)


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
    return rf"overturns, drawn to {fallen(motion):g} $\theta_\mathrm{{cr}}$"


def draw_base(ax: Axes, motion: Motion, start: float, stop: float, block: Block | None) -> Axes:
    """Draw the base acceleration from time `start` to `stop`, in τ, and the accelerations that lift a block off if it comes near."""
    forcing, shown = motion.system.forcing, quantities(block)
    time = np.linspace(start, stop, SAMPLES_PER_PICTURE)  # also at a jump, where no sample is
    if isinstance(forcing, PiecewiseLinear):
        samples = forcing.step * np.arange(forcing.values.size)
        time = np.union1d(time, samples[(samples >= start) & (samples <= stop)])
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN)
    if forcing.largest > 0.5:
        # a record begins weakly, a pulse is over at the end
        first, last = (np.abs(forcing.acceleration(part)).max() for part in np.array_split(time, 3)[::2])
        _pair(
            ax,
            shown.amplitude(motion.system.lift_off),
            style.GUIDE,
            "dotted",
            "lift-off from rest",
            at_right=last < first,
        )
    ax.plot(
        shown.time(time),
        shown.amplitude(forcing.acceleration(time)),
        color=style.INK,
        linewidth=style.THIN,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="base",
    )
    style.label(ax, shown.time_label, shown.base_label)
    return ax


def draw_history(ax: Axes, motion: Motion, start: float, stop: float, block: Block | None) -> Axes:
    """Draw the angle from time `start` to `stop`, in τ."""
    time, angle, _ = trace(motion, start, stop)
    shown = quantities(block)
    _guides(ax, motion.system, shown, float(np.abs(angle).max()), at_right=has_cycles(motion))
    ax.plot(
        shown.time(time),
        shown.angle(angle),
        color=style.MOTION,
        linewidth=style.LINE,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="motion",
    )
    ax.set_xlim(shown.time(start), shown.time(stop))
    style.label(ax, shown.time_label, shown.angle_label)
    return ax


def _guides(ax: Axes, system: System, shown: Quantities, largest: float, *, at_right: bool) -> None:
    """Draw the angle 0, and the braces or the critical angle if the motion exceeds half of it."""
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN)
    if system.braces is None:
        level, colour, dashes, name = 1.0, style.GUIDE, "dotted", "critical angle"
    else:
        level, colour, dashes, name = system.braces.angle, style.BRACE, "dashed", "braces"
    if largest > 0.5 * level:
        _pair(ax, shown.angle(level), colour, dashes, name, at_right=at_right)


def _pair(ax: Axes, level: float, colour: str, dashes: str, name: str, *, at_right: bool) -> None:
    """Draw lines at ± a level, with a name above the upper one: at the left under a record, which begins weakly."""
    for side in (-1.0, 1.0):
        ax.axhline(side * level, color=colour, linestyle=dashes, linewidth=style.LINE, gid=name)
    ax.text(
        1.0 if at_right else 0.01,
        level,
        name,
        transform=ax.get_yaxis_transform(),
        ha="right" if at_right else "left",
        va="bottom",
        fontsize=style.SMALL,
        color=style.INK,
    )
