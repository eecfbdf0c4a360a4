"""The angle against time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model import Block, System
from rocking.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import Quantities, quantities
from rocking.plot.parts.sample_times import trace, window


def time_history(
    motion: Motion,
    ax: Axes | None = None,
    block: Block | None = None,
    cycles: tuple[float, float] | None = None,
) -> Axes:
    r"""Draws the angle of a motion against time; its corners at impacts and its extremes are exact.

    Parameters
    ----------
    motion : Motion
        Recorded with ``record="all"``.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives SI axes, seconds and degrees; otherwise the axes are normalised.
    cycles : tuple of float, optional
        First and last forcing cycle shown, counted from the start. The whole motion if not given; if it overturned,
        on past the proof until three times the critical angle.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `cycles` does not lie within the motion, the motion kept no events, or an argument is of another kind.

    See Also
    --------
    phase_portrait : Plot velocity against angle.
    overview : Plot both.
    rocking.simulate : Compute a motion.

    Notes
    -----
    Dotted lines are the critical angle, dashed lines the braces; they are left out where the motion stays far below.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.time_history(rk.simulate(system, cycles=60), cycles=(50, 60))
    >>> print(ax.get_xlabel())
    time $\tau = \alpha t$ (–)
    """
    start, stop = window(motion, cycles)
    return draw_history(style.own(ax), motion, start, stop, block)


def draw_history(ax: Axes, motion: Motion, start: float, stop: float, block: Block | None) -> Axes:
    """Draws the angle from time `start` to `stop`, in τ."""
    time, angle, _ = trace(motion, start, stop)
    shown = quantities(block)
    _guides(ax, motion.system, shown, float(np.abs(angle).max()))
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


def _guides(ax: Axes, system: System, shown: Quantities, largest: float) -> None:
    """The angle 0, and the braces or else the critical angle, where the motion comes at least half as far."""
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN)
    if system.braces is None:
        level, colour, dashes, name = 1.0, style.GUIDE, "dotted", "critical angle"
    else:
        level, colour, dashes, name = system.braces.angle, style.BRACE, "dashed", "braces"
    if largest > 0.5 * level:
        for side in (-1.0, 1.0):
            ax.axhline(
                shown.angle(side * level), color=colour, linestyle=dashes, linewidth=style.LINE, gid=name
            )
