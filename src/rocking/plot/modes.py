"""Symmetric (1, n) modes over the forcing amplitude."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from rocking.model.block import Block
from rocking.model.forcing import MAX_AMPLITUDE, PERIODS
from rocking.model.orbit import Mode
from rocking.model.validation import one_of, within
from rocking.plot.parts import branch_lines, style
from rocking.plot.parts.axis_units import parameter, quantities
from rocking.theory import (
    existence_amplitude,
    slower_mode_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)

POINTS = 400
# Relative distance of the curves from the ends of the modes, where rounding may leave none.
NEAR = 1e-9
# The axis extends to this multiple of the amplitude at which symmetry breaks.
BEYOND = 1.25
DASHES: dict[str, Any] = {
    **{str(name): dashes for name, dashes in branch_lines.DASHES.items()},
    "inadmissible": (0, (1, 1.5)),
}


def modes(
    period: float,
    restitution: float,
    n: int = 1,
    ax: Axes | None = None,
    quantity: str = "velocity",
    amplitude: float | None = None,
    block: Block | None = None,
) -> Axes:
    """Plot speed or phase of the symmetric (1, n) modes over the amplitude: stable solid, unstable dashed.

    Parameters
    ----------
    period : float
        Forcing period T.
    restitution : float
        Coefficient of restitution e, in (0, 1].
    n : int
        Number of forcing cycles per response, odd. Default: 1.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    quantity : str
        "velocity", the velocity V after the impact, or "phase", the forcing phase φ at the impact, in (−π, π]. Default:
        "velocity".
    amplitude : float, optional
        Amplitude A to mark by a line, with a ring on each mode. Default: none.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    thresholds : Plot the limits of the modes over the period.
    rocking.theory.symmetric_modes : Compute the modes.

    Notes
    -----
    Inadmissible modes are dotted. Modes exist from A_E, and the faster mode loses its stability at A_SB. The axis reaches
    1.25 A_SB, at most A = 1000. At e = 1 the faster mode is neutral up to A_SB, and dash-dotted. An impact onto the
    other side is the mirror image: −V, φ + π.

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.modes(1.0, 0.925, amplitude=2.0)
    >>> ax.get_title(loc="right")
    '(1, 1) modes, $T = 1$, $e = 0.925$'
    """
    one_of("quantity", quantity, ("velocity", "phase"))
    marked = 0.0 if amplitude is None else within("amplitude", amplitude, 0.0, MAX_AMPLITUDE)
    period, restitution = within("period", period, *PERIODS), within("restitution", restitution, 0.0, 1.0)
    here = symmetric_modes(marked, period, restitution, n)
    begins = existence_amplitude(period, restitution, n)
    breaks = symmetry_breaking_amplitude(period, restitution, n)
    most = min(max(BEYOND * breaks, 1.1 * marked, 1.1 * begins), MAX_AMPLITUDE)
    least = begins * (1.0 + NEAR) + NEAR
    ends = (most, min(slower_mode_amplitude(period, n) * (1.0 - NEAR), most))
    shown = quantities(block)
    ax = style.own(ax, height=2.9)
    across, x_label = parameter("amplitude", block)

    def up(mode: Mode) -> float:
        return shown.velocity(mode.velocity) if quantity == "velocity" else mode.phase

    for root, colour in ((0, style.MOTION), (1, style.IMPACT)):
        # dense near the fold, where both roots vary as a square root
        places = least + max(ends[root] - least, 0.0) * np.linspace(0.0, 1.0, POINTS) ** 2
        found = (symmetric_modes(float(place), period, restitution, n) for place in places)
        points = [
            (across(mode.amplitude), up(mode), _kind(mode))
            for mode in (each[root] for each in found if len(each) > root)
        ]
        _draw(ax, points, colour, ("faster", "slower")[root], wraps=quantity == "phase")
    if amplitude is not None:
        ax.axvline(
            across(marked),
            color=style.GUIDE,
            linewidth=style.THIN,
            zorder=0,
            label="given amplitude",
            gid="amplitude",
        )
        ax.plot(
            [across(mode.amplitude) for mode in here],
            [up(mode) for mode in here],
            linestyle="none",
            marker="o",
            markersize=style.MARK,
            markerfacecolor="none",
            color=style.INK,
            gid="marked",
        )
    label = shown.speed_label if quantity == "velocity" else r"forcing phase $\varphi$ at the impact (rad)"
    style.label(ax, x_label, label)
    ax.set_xlim(left=0.0)
    forced = f"$T = {period:.6g}$" if block is None else f"$T = {block.seconds(period):.4g}$ s"
    style.note(ax, rf"(1, {n}) modes, {forced}, $e = {restitution:.4g}$")
    _explain(ax)
    return ax


def _kind(mode: Mode) -> str:
    return mode.stability if mode.admissible else "inadmissible"


def _draw(ax: Axes, points: list, colour: str, root: str, *, wraps: bool) -> None:
    """Draw one root with one line per stability; each line ends at the next point, so that no gap remains.

    A phase jumps by 2π where it passes π; there the line is interrupted.
    """
    if not points:
        return
    x, y, kinds = (np.array(column) for column in zip(*points, strict=True))
    if wraps:
        y = np.where(np.abs(np.diff(y, append=y[-1])) > math.pi, np.nan, y)
    for kind, dashes in DASHES.items():
        own = kinds == kind
        drawn = own | np.concatenate(([False], own[:-1]))
        if own.any():
            ax.plot(
                x,
                np.where(drawn, y, np.nan),
                color=colour,
                linestyle=dashes,
                linewidth=1.4 * style.LINE,
                gid=f"{root} {kind}",
            )


def _explain(ax: Axes) -> None:
    """Draw the legend of the lines that occur."""
    there = {line.get_gid() for line in ax.lines}
    for kind, dashes in DASHES.items():
        if any(str(gid).endswith(" " + kind) for gid in there):
            ax.add_line(Line2D([], [], color=style.INK, linestyle=dashes, label=kind))
    for root, colour in (("faster", style.MOTION), ("slower", style.IMPACT)):
        if any(str(gid).startswith(root) for gid in there):
            ax.add_line(Line2D([], [], color=colour, label=root))
    style.key(ax)
