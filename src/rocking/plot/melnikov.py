"""Melnikov functions, and the heteroclinic orbits along which they are integrated."""

import math

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.forcing import MAX_AMPLITUDE, PERIODS
from rocking.model.validation import within
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.theory import (
    energy,
    heteroclinic_amplitude,
    heteroclinic_orbit,
    manifold_gap,
    melnikov_amplitude,
    melnikov_function,
)

POINTS = 401
# Largest |τ| at which the heteroclinic orbits are drawn.
MAX_TIME = 6.0
INNER = (0.2, 0.4, 0.6, 0.8)


def melnikov(amplitude: float, period: float, restitution: float, ax: Axes | None = None) -> Axes:
    """Plot M⁺ and M⁻ over one forcing period, with the exact gap of the manifolds that M⁺ approximates.

    Parameters
    ----------
    amplitude : float
        Forcing amplitude A.
    period : float
        Forcing period T.
    restitution : float
        Coefficient of restitution e, in [0, 1].
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

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
    thresholds : Plot amplitudes over the period.
    rocking.theory.melnikov_function : Compute the function.
    rocking.theory.manifold_gap : Compute the exact gap.

    Notes
    -----
    Where M⁺ (on the other side M⁻) is positive, the unstable manifold passes beyond the stable one, to first order. The exact
    gap is e V_u − V_s at the impact. The title gives the threshold A_M of M⁺ and the threshold A* of the exact gap.

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.melnikov(4.0, 1.0, 0.8)
    >>> [line.get_label() for line in ax.lines][:3]
    ['$M^+$', '$M^-$', 'exact gap']
    """
    amplitude = within("amplitude", amplitude, 0.0, MAX_AMPLITUDE)
    period, restitution = within("period", period, *PERIODS), within("restitution", restitution, 0.0, 1.0)
    turns = np.linspace(0.0, 1.0, POINTS)
    times = turns * period
    upper = melnikov_function(times, amplitude, period, restitution)
    lower = melnikov_function(times, amplitude, period, restitution, "lower")
    gap = manifold_gap(math.tau * turns, amplitude, period, restitution)
    ax = style.own(ax, height=2.9)
    for values, label, colour, dashes in (
        (upper, "$M^+$", style.MOTION, "-"),
        (lower, "$M^-$", style.IMPACT, (0, (5, 2))),
        (gap, "exact gap", style.INK, (0, (1, 1.5))),
    ):
        ax.plot(turns, values, color=colour, linestyle=dashes, linewidth=style.LINE, label=label)
    ax.axhline(0.0, color=style.GUIDE, linewidth=style.THIN, zorder=0, gid="zero")
    style.label(ax, r"time $\tau_0/T$", r"energy gained $M(\tau_0)$")
    first, exact = melnikov_amplitude(period, restitution), heteroclinic_amplitude(period, restitution)
    style.note(ax, rf"$A = {amplitude:.4g}$: $A_M = {first:.4g}$, $A^* = {exact:.4g}$")
    style.key(ax)
    return ax


def heteroclinic(ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the heteroclinic orbits of the free, undamped block, and some of the closed orbits inside them.

    Parameters
    ----------
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.

    See Also
    --------
    manifolds : Plot the manifolds of a damped, forced block.
    rocking.theory.heteroclinic_orbit : Compute the orbit.

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.heteroclinic()
    >>> ax.lines[0].get_label()
    'heteroclinic orbits'
    """
    shown = quantities(block)
    ax = style.own(ax, height=2.9)
    times = np.linspace(-MAX_TIME, MAX_TIME, POINTS)
    for orbit, label in (("upper", "heteroclinic orbits"), ("lower", None)):
        angle, velocity = heteroclinic_orbit(times, orbit)
        ax.plot(
            shown.angle(angle),
            shown.velocity(velocity),
            color=style.MOTION,
            linewidth=1.4 * style.LINE,
            label=label,
        )
        for time in (-0.9, 0.5):
            _arrow(ax, shown, orbit, time)
    for turn in INNER:
        _closed(ax, shown, turn, "closed orbits" if turn == INNER[0] else None)
    for angle, filled, label in (
        (1.0, False, "unstable equilibria"),
        (-1.0, False, None),
        (0.0, True, "stable equilibrium"),
    ):
        ax.plot(
            shown.angle(angle),
            0.0,
            linestyle="none",
            marker="o",
            markersize=style.MARK,
            color=style.INK,
            markerfacecolor=style.INK if filled else "white",
            label=label,
        )
    style.label(ax, shown.angle_label, shown.velocity_label)
    style.key(ax)
    return ax


def _arrow(ax: Axes, shown, orbit: str, time: float) -> None:
    """Draw an arrow in the direction of motion on an orbit."""
    (tail, head) = (heteroclinic_orbit(time + step, orbit) for step in (-0.02, 0.02))
    ax.annotate(
        "",
        xy=(shown.angle(head[0]), shown.velocity(head[1])),
        xytext=(shown.angle(tail[0]), shown.velocity(tail[1])),
        arrowprops={"arrowstyle": "-|>", "color": style.MOTION, "shrinkA": 0, "shrinkB": 0},
    )


def _closed(ax: Axes, shown, turn: float, label: str | None) -> None:
    """Draw the closed orbit with the turning points ±`turn`, from its energy."""
    angle = turn * np.sin(np.linspace(0.0, math.tau, POINTS))
    left = np.maximum(2.0 * (energy(turn, 0.0) - energy(angle, 0.0)), 0.0)
    ax.plot(
        shown.angle(angle),
        shown.velocity(np.sqrt(left) * np.sign(np.cos(np.linspace(0.0, math.tau, POINTS)))),
        color=style.GUIDE,
        linewidth=style.THIN,
        label=label,
        zorder=1,
    )
