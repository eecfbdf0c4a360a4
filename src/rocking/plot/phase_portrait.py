"""Phase portrait: velocity against angle, with the jumps at impacts."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.motion.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import Quantities, quantities
from rocking.plot.parts.sample_times import inside, trace, window

STRIKES = {"impact": (style.IMPACT, "o"), "brace": (style.BRACE, "s")}
NAMES = {"impact": "impact", "brace": "brace impact"}
# A ring before, a dot after an impact, in units of their common size: where both coincide, both are visible.
RING, DOT = 1.3, 0.75


def phase_portrait(
    motion: Motion,
    ax: Axes | None = None,
    block: Block | None = None,
    cycles: tuple[float, float] | None = None,
) -> Axes:
    """Plot the phase portrait of a motion, with a stroke at each impact from the velocity before (ring) to after (dot).

    Parameters
    ----------
    motion : Motion
        Motion recorded with ``record="all"``.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, degrees and degrees per second. Default: normalised axes.
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
    start, stop = window(motion, cycles)
    time, angle, velocity = trace(motion, start, stop)
    breaks = 1 + np.flatnonzero((np.diff(time) == 0) & (np.diff(velocity) != 0))
    events = inside(motion.events, start, stop)
    events = events[np.isin(events["kind"], list(STRIKES))]
    shown = quantities(block)
    ax = style.own(ax, height=3.0)
    ax.plot(
        shown.angle(np.insert(angle, breaks, np.nan)),
        shown.velocity(np.insert(velocity, breaks, np.nan)),
        color=style.MOTION,
        linewidth=style.line_width(len(events)),
        marker="o" if not np.ptp(angle) and not np.ptp(velocity) else "none",
        markersize=style.MARK,
        rasterized=len(time) > style.MAX_CORNERS,
        gid="motion",
    )
    for kind, (colour, marker) in STRIKES.items():
        _strikes(ax, shown, events[events["kind"] == kind], kind, colour, marker)
    style.label(ax, shown.angle_label, shown.velocity_label)
    if len(events):
        style.key(ax)
    return ax


def _strikes(ax: Axes, shown: Quantities, hits: NDArray, kind: str, colour: str, marker: str) -> None:
    if not len(hits):
        return
    angle, before, after = (
        shown.angle(hits["angle"]),
        shown.velocity(hits["before"]),
        shown.velocity(hits["after"]),
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
