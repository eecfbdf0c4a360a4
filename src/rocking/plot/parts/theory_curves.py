"""What theory says, as curves over a map."""

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

from rocking.model import MAX_AMPLITUDE, members, one_of, refusal, refuse_if
from rocking.plot.parts import style
from rocking.plot.parts.style import DOTTED
from rocking.theory import (
    existence_amplitude,
    heteroclinic_amplitude,
    melnikov_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)

POINTS = 400
HALO = 2.4


@frozen
class Curve:
    """An amplitude over period and restitution; with n, that of a (1, n) mode, which may not be admissible everywhere."""

    name: str
    amplitude: Callable[..., Any]
    dashes: Any
    n: int | None = None


CURVES = {
    "symmetry-breaking-1": Curve(
        "(1,1) stable to $A_{SB}$", partial(symmetry_breaking_amplitude, n=1), "-", 1
    ),
    "symmetry-breaking-3": Curve(
        "(1,3) stable to $A_{SB}$", partial(symmetry_breaking_amplitude, n=3), (0, (5, 2)), 3
    ),
    "existence-1": Curve("(1,1) from $A_E$", partial(existence_amplitude, n=1), (0, (1, 1)), 1),
    "existence-3": Curve("(1,3) from $A_E$", partial(existence_amplitude, n=3), (0, (3, 1, 1, 1, 1, 1)), 3),
    "melnikov": Curve("zeros from $A_M$", melnikov_amplitude, (0, (6, 2, 1, 2))),
    "heteroclinic": Curve("tangency at $A^*$", heteroclinic_amplitude, (0, (9, 2))),
}


def check(names: Iterable[str], axes: Iterable[str], told: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of curves; TypeError or ValueError for a name that is unknown, and where the map admits no curve.

    `axes` are the names of the map's axes, upward first; `told` are its attributes.
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
    if names and "brace_angle" in told:
        raise ValueError(
            refusal(
                "curves", "lie over a map of a block without braces", f"brace_angle = {told['brace_angle']}"
            )
        )
    return names


def draw(
    ax: Axes, names: Iterable[str], axes: dict[str, np.ndarray], told: dict[str, Any], turns: dict[str, Any]
) -> list[Line2D]:
    """Draw curves that were checked over a map; return the lines of a legend."""
    return [_line(ax, CURVES[name], axes, told, turns) for name in names]


def _line(
    ax: Axes, curve: Curve, axes: dict[str, np.ndarray], told: dict[str, Any], turns: dict[str, Any]
) -> Line2D:
    (_, heights), (across, values) = axes.items()
    places = np.linspace(values[0], values[-1], POINTS)
    given = dict(told) | {across: places}
    period = math.tau / given["frequency"] if "frequency" in given else given["period"]
    period, restitution = np.broadcast_arrays(period, given["restitution"])
    lines = lines_of(curve, period, restitution, heights[0], heights[-1])
    there = "" if np.isfinite(lines).any() else ": not here"
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
    """The amplitudes (n,) between `low` and `high`, NaN elsewhere: where the mode is admissible, and where it is not."""
    amplitudes = np.asarray(curve.amplitude(period, restitution))
    seen = (amplitudes >= low) & (amplitudes <= high)
    # as far as one point beyond what is seen, so that the line meets the frame
    seen[1:] |= seen[:-1].copy()
    seen[:-1] |= seen[1:].copy()
    # a neighbour may have no such amplitude, or one beyond all that may be asked for
    seen &= amplitudes <= MAX_AMPLITUDE
    sure = _admissible(curve, amplitudes, period, restitution, seen)

    def line(part: np.ndarray) -> np.ndarray:
        drawn = part.copy()
        drawn[1:] |= part[:-1] & seen[1:]
        return np.where(drawn, amplitudes, np.nan)

    return line(seen & sure), line(seen & ~sure)


def _admissible(curve: Curve, amplitudes, period, restitution, seen) -> np.ndarray:
    """Where a mode keeps its side for the half cycle, as the closed form takes for granted."""
    sure = np.ones(amplitudes.shape, bool)
    if curve.n is None:
        return sure
    for place in np.flatnonzero(seen):
        # a hair above, so that rounding does not take a mode away where it begins
        above = float(amplitudes[place]) * (1.0 + 1e-12)
        modes = symmetric_modes(above, float(period[place]), float(restitution[place]), curve.n)
        sure[place] = bool(modes) and modes[0].admissible
    return sure
