"""Theoretical amplitudes as curves over a map."""

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

from rocking.model.forcing import MAX_AMPLITUDE
from rocking.model.validation import Refusal, members, one_of, refuse_if
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
    if names and "brace_angle" in attributes:
        raise Refusal(
            "curves",
            "lie over a map of a block without braces",
            f"brace_angle = {attributes['brace_angle']}",
        )
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
    given = dict(attributes) | {across: places}
    period = math.tau / given["frequency"] if "frequency" in given else given["period"]
    period, restitution = np.broadcast_arrays(period, given["restitution"])
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
    seen &= amplitudes <= MAX_AMPLITUDE
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
