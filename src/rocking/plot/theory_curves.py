"""Plots of closed forms: modes and their stability, Melnikov's function, heteroclinic orbits, thresholds of overturning."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np
from attrs import frozen
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike, NDArray

from rocking.model.block import Block
from rocking.model.orbit import Mode
from rocking.model.quantity import AMPLITUDE, PERIOD, RESTITUTION
from rocking.model.validation import Refusal, WrongType, members, one_of, reals, refuse_if
from rocking.plot import branch_lines, style
from rocking.plot.axes import parameter, units_of
from rocking.plot.style import DOTTED
from rocking.theory import (
    energy,
    existence_amplitude,
    heteroclinic_amplitude,
    heteroclinic_orbit,
    manifold_gap,
    melnikov_amplitude,
    melnikov_function,
    slower_mode_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)

POINTS = 400
HALO = 2.4


@frozen
class Curve:
    """Amplitude over period and restitution; with `n`, the amplitude of a (1, n) mode, which may be inadmissible."""

    name: str
    amplitude: Callable[..., Any]
    dashes: Any
    n: int | None = None


CURVES = {
    "symmetry-breaking-1": Curve("$A_{SB}$, (1, 1) mode", partial(symmetry_breaking_amplitude, n=1), "-", 1),
    "symmetry-breaking-3": Curve(
        "$A_{SB}$, (1, 3) mode", partial(symmetry_breaking_amplitude, n=3), (0, (5, 2)), 3
    ),
    "existence-1": Curve("$A_E$, (1, 1) mode", partial(existence_amplitude, n=1), (0, (1, 1)), 1),
    "existence-3": Curve("$A_E$, (1, 3) mode", partial(existence_amplitude, n=3), (0, (3, 1, 1, 1, 1, 1)), 3),
    "melnikov": Curve("$A_M$ (Melnikov)", melnikov_amplitude, (0, (6, 2, 1, 2))),
    "heteroclinic": Curve("$A^*$ (exact tangency)", heteroclinic_amplitude, (0, (9, 2))),
}


def check(names: Iterable[str], axes: Iterable[str], attributes: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of curves; raise for an unknown name, or if curves do not apply to the map.

    `axes` are the names of the map's axes, the vertical axis first; `attributes` are those of its dataset.
    """
    if isinstance(names, str):
        names = (names,)
    allowed = f"be a sequence of {', '.join(map(repr, CURVES))}"
    names = tuple(one_of("curves", name, tuple(CURVES)) for name in members("curves", names, allowed))
    upward, across = axes
    refuse_if(
        names and (upward != "amplitude" or across not in ("period", "frequency", "restitution")),
        "curves",
        "lie over a map of the amplitude and the period, frequency or restitution",
        f"{upward} and {across}",
    )
    others = [name for name in ("brace_angle", "critical_angle", "angle_ratio") if name in attributes]
    if names and others:
        got = f"{others[0]} = {attributes[others[0]]:.6g}"
        raise Refusal("curves", "lie over a map of a slender, symmetric block without braces", got)
    return names


def draw(
    ax: Axes,
    names: Iterable[str],
    axes: dict[str, np.ndarray],
    attributes: dict[str, Any],
    turns: dict[str, Any],
) -> list[Line2D]:
    """Draw checked curves over a map and return their legend handles."""
    return [_line(ax, CURVES[name], axes, attributes, turns) for name in names]


def _line(
    ax: Axes, curve: Curve, axes: dict[str, np.ndarray], attributes: dict[str, Any], turns: dict[str, Any]
) -> Line2D:
    (_, heights), (across, values) = axes.items()
    places = np.linspace(values[0], values[-1], POINTS)
    arguments = dict(attributes) | {across: places}
    period = math.tau / arguments["frequency"] if "frequency" in arguments else arguments["period"]
    period, restitution = np.broadcast_arrays(period, arguments["restitution"])
    lines = lines_of(curve, period, restitution, heights[0], heights[-1])
    there = "" if np.isfinite(lines).any() else " (outside)"
    for line, dashes in zip(lines, (curve.dashes, DOTTED), strict=True):
        ax.plot(
            turns[across](places),
            turns["amplitude"](line),
            color=style.INK,
            linestyle=dashes,
            linewidth=style.LINE,
            path_effects=[withStroke(linewidth=HALO, foreground="white")],
            gid=curve.name,
            scalex=False,
            scaley=False,
        )
    return Line2D(
        [], [], color=style.INK, linestyle=curve.dashes, linewidth=style.LINE, label=curve.name + there
    )


def lines_of(
    curve: Curve, period: np.ndarray, restitution: np.ndarray, low: float, high: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the amplitudes between `low` and `high`, split by the admissibility of the mode.

    Returns
    -------
    tuple of (array, array)
        Amplitudes of shape (n,) with an admissible and with an inadmissible mode; NaN elsewhere.
    """
    amplitudes = np.asarray(curve.amplitude(period, restitution))
    seen = (amplitudes >= low) & (amplitudes <= high)
    # one point beyond the visible range, so that the line meets the frame
    seen[1:] |= seen[:-1].copy()
    seen[:-1] |= seen[1:].copy()
    # a neighbouring point may have no such amplitude, or one above the allowed maximum
    seen &= amplitudes <= AMPLITUDE.range[1]
    sure = _admissible(curve, amplitudes, period, restitution, seen)

    def line(part: np.ndarray) -> np.ndarray:
        drawn = part.copy()
        drawn[1:] |= part[:-1] & seen[1:]
        return np.where(drawn, amplitudes, np.nan)

    return line(seen & sure), line(seen & ~sure)


def _admissible(curve: Curve, amplitudes, period, restitution, seen) -> np.ndarray:
    """Return whether the mode is admissible at each point: Θ keeps its sign within the half-cycle, as assumed."""
    sure = np.ones(amplitudes.shape, bool)
    if curve.n is None:
        return sure
    for place in np.flatnonzero(seen):
        # slightly above, because rounding may remove a mode exactly at its onset
        above = float(amplitudes[place]) * (1.0 + 1e-12)
        modes = symmetric_modes(above, float(period[place]), float(restitution[place]), curve.n)
        sure[place] = bool(modes) and modes[0].admissible
    return sure


# Two colours by three dashes: curves in pairs, such as two thresholds at three coefficients of restitution.
LINES = tuple(
    (colour, dashes)
    for dashes in ("-", (0, (5, 2)), (0, (6, 2, 1, 2)))
    for colour in (style.MOTION, style.IMPACT)
)


def thresholds(
    periods: ArrayLike,
    curves: Mapping[str, ArrayLike | tuple[ArrayLike, ArrayLike]],
    ax: Axes | None = None,
    block: Block | None = None,
) -> Axes:
    """Plot threshold amplitudes over the forcing period.

    Parameters
    ----------
    periods : array
        Forcing periods T, increasing.
    curves : dict
        One to six curves by label. A curve is the amplitude A at each period, NaN where it does not exist. A pair of
        amplitudes and booleans is dotted where the boolean is False. Curves 1 and 2, 3 and 4, 5 and 6 share a dash. Odd
        and even curves have one colour each.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, s and m/s². Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `curves` is not a dict, or an argument has the wrong type.
    ValueError
        If there is no curve or more than six, or a curve and the periods differ in length.

    See Also
    --------
    parametric_map : Plot theoretical curves over a map.
    rocking.theory.melnikov_amplitude : Compute A_M.
    rocking.theory.symmetry_breaking_amplitude : Compute A_SB.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> periods = np.linspace(0.2, 3.0, 100)
    >>> breaking = rk.theory.symmetry_breaking_amplitude(periods, 0.9, 1)
    >>> ax = rk.plot.thresholds(periods, {"(1, 1) mode stable below": breaking})
    >>> len(ax.lines)
    1
    """
    (turn_across, x_label), (turn_up, y_label) = (parameter(name, block) for name in ("period", "amplitude"))
    across = np.asarray(reals("periods", periods))
    if not isinstance(curves, Mapping):
        raise WrongType("curves", "be a dict of amplitudes by label", curves)
    refuse_if(not 1 <= len(curves) <= len(LINES), "curves", f"hold 1 to {len(LINES)} of them", len(curves))
    checked = {name: _curve(name, curve, across) for name, curve in curves.items()}
    ax = style.own(ax, height=2.9)
    for (name, (values, holds)), (colour, dashes) in zip(checked.items(), LINES, strict=False):
        up = turn_up(values)
        for part, how, label in ((holds, dashes, name), (~holds, style.DOTTED, None)):
            if part.any():
                # one point more, so that no gap remains where the dots begin
                drawn = part | np.concatenate(([False], part[:-1]))
                line = np.where(drawn, up, np.nan)
                ax.plot(
                    turn_across(across), line, color=colour, linestyle=how, label=label, linewidth=style.LINE
                )
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax


def _curve(name: str, curve: Any, across: NDArray) -> tuple[NDArray, NDArray]:
    """Return the amplitudes of a curve, and where they are valid; raise if they do not fit the periods."""
    amplitudes, holds = curve if isinstance(curve, tuple) else (curve, np.ones(across.shape, bool))
    values, holds = np.asarray(reals("curves", amplitudes)), np.asarray(holds, bool)
    if not across.ndim == values.ndim == holds.ndim == 1 or not len(across) == len(values) == len(holds):
        raise Refusal("curves", f"have one amplitude per period, {across.size}", f"{name}: {values.size}")
    return values, holds


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
    block: Block | None = None,
    *,
    quantity: str = "velocity",
    amplitude: float | None = None,
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
    block : Block, optional
        Block for SI axes. Default: normalised axes.
    quantity : str
        "velocity", the velocity V after the impact, or "phase", the forcing phase φ at the impact, in (−π, π]. Default:
        "velocity".
    amplitude : float, optional
        Amplitude A to mark by a line, with a ring on each mode. Default: none.

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
    marked = 0.0 if amplitude is None else AMPLITUDE.checked(amplitude)
    period, restitution = PERIOD.checked(period), RESTITUTION.checked(restitution)
    here = symmetric_modes(marked, period, restitution, n)
    begins = existence_amplitude(period, restitution, n)
    breaks = symmetry_breaking_amplitude(period, restitution, n)
    most = min(max(BEYOND * breaks, 1.1 * marked, 1.1 * begins), AMPLITUDE.range[1])
    least = begins * (1.0 + NEAR) + NEAR
    ends = (most, min(slower_mode_amplitude(period, n) * (1.0 - NEAR), most))
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    across, x_label = parameter("amplitude", block)

    def up(mode: Mode) -> float:
        return units.velocity(mode.velocity) if quantity == "velocity" else mode.phase

    for root, colour in ((0, style.MOTION), (1, style.IMPACT)):
        # dense near the fold, where both roots vary as a square root
        places = least + max(ends[root] - least, 0.0) * np.linspace(0.0, 1.0, POINTS) ** 2
        result = (symmetric_modes(float(place), period, restitution, n) for place in places)
        points = [
            (across(mode.amplitude), up(mode), _kind(mode))
            for mode in (each[root] for each in result if len(each) > root)
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
    label = units.speed_label if quantity == "velocity" else r"forcing phase $\varphi$ at the impact (rad)"
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


TIMES_OF_A_CURVE = 401
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
    amplitude = AMPLITUDE.checked(amplitude)
    period, restitution = PERIOD.checked(period), RESTITUTION.checked(restitution)
    turns = np.linspace(0.0, 1.0, TIMES_OF_A_CURVE)
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
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    times = np.linspace(-MAX_TIME, MAX_TIME, TIMES_OF_A_CURVE)
    for orbit, label in (("upper", "heteroclinic orbits"), ("lower", None)):
        angle, velocity = heteroclinic_orbit(times, orbit)
        ax.plot(
            units.angle(angle),
            units.velocity(velocity),
            color=style.MOTION,
            linewidth=1.4 * style.LINE,
            label=label,
        )
        for time in (-0.9, 0.5):
            _arrow(ax, units, orbit, time)
    for turn in INNER:
        _closed(ax, units, turn, "closed orbits" if turn == INNER[0] else None)
    for angle, filled, label in (
        (1.0, False, "unstable equilibria"),
        (-1.0, False, None),
        (0.0, True, "stable equilibrium"),
    ):
        ax.plot(
            units.angle(angle),
            0.0,
            linestyle="none",
            marker="o",
            markersize=style.MARK,
            color=style.INK,
            markerfacecolor=style.INK if filled else "white",
            label=label,
        )
    style.label(ax, units.angle_label, units.velocity_label)
    style.key(ax)
    return ax


def _arrow(ax: Axes, units, orbit: str, time: float) -> None:
    """Draw an arrow in the direction of motion on an orbit."""
    (tail, head) = (heteroclinic_orbit(time + step, orbit) for step in (-0.02, 0.02))
    ax.annotate(
        "",
        xy=(units.angle(head[0]), units.velocity(head[1])),
        xytext=(units.angle(tail[0]), units.velocity(tail[1])),
        arrowprops={"arrowstyle": "-|>", "color": style.MOTION, "shrinkA": 0, "shrinkB": 0},
    )


def _closed(ax: Axes, units, turn: float, label: str | None) -> None:
    """Draw the closed orbit with the turning points ±`turn`, from its energy."""
    angle = turn * np.sin(np.linspace(0.0, math.tau, TIMES_OF_A_CURVE))
    left = np.maximum(2.0 * (energy(turn, 0.0) - energy(angle, 0.0)), 0.0)
    ax.plot(
        units.angle(angle),
        units.velocity(np.sqrt(left) * np.sign(np.cos(np.linspace(0.0, math.tau, TIMES_OF_A_CURVE)))),
        color=style.GUIDE,
        linewidth=style.THIN,
        label=label,
        zorder=1,
    )
