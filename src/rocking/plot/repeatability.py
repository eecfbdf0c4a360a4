"""Repeatability under inexact inputs: fractions of outcomes, and maps of certain outcomes."""

from __future__ import annotations

import re

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from rocking.model.survey_results import Repeatability, RepeatabilityMap
from rocking.model.text import percent
from rocking.model.validation import instance
from rocking.model.verdict import Kind
from rocking.plot import palette
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import PARAMETERS
from rocking.plot.parts.legend import COLOURS, look_at

SHOWN = 12
LEAST = 1e-4
"""Smallest fraction with a row in the legend."""


def repeatability(found: Repeatability, ax: Axes | None = None) -> Axes:
    """Plot the fraction of runs with each outcome and its 95 % interval, the largest at the top, up to twelve.

    Parameters
    ----------
    found : Repeatability
        Result of `rocking.repeatability`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not a Repeatability, or `ax` is not Axes.

    See Also
    --------
    repeatability_map : Plot a map of outcomes.
    rocking.repeatability : Compute the fractions.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    >>> len(rk.plot.repeatability(rk.repeatability(system, samples=100)).patches)
    2
    """
    instance("found", found, Repeatability)
    ax = style.own(ax)
    pairs = list(found.responses.items())[:SHOWN]
    up = np.arange(len(pairs))
    values = np.array([share.value for _, share in pairs])
    ends = np.array([[share.value - share.low, share.high - share.value] for _, share in pairs]).T
    hues = [_colour(name) for name, _ in pairs]
    error = {"elinewidth": style.LINE, "capsize": 2.5, "ecolor": style.GUIDE}
    ax.barh(up, 100 * values, xerr=100 * ends, color=hues, height=0.7, error_kw=error, gid="shares")
    style.label(ax, f"fraction of {found.repeats.of:,} runs (%)", "")
    ax.set_yticks(up, [name for name, _ in pairs])
    ax.invert_yaxis()
    ax.set_xlim(0.0, 100.0)
    style.note(ax, f"inputs vary by up to {100 * found.relative:.3g} %")
    return ax


def _colour(name: str) -> str:
    """Return the colour of a response by its name, such as "period 3, symmetric, 2 impacts" or "overturned"."""
    periodic = re.match(r"period (\d+), (a?)symmetric", name)
    if periodic is None:
        return COLOURS[Kind(name)]
    return look_at(Kind.PERIODIC, int(periodic[1]), not periodic[2]).colour


def repeatability_map(found: RepeatabilityMap, ax: Axes | None = None) -> Axes:
    """Plot a map of certain outcomes, one colour per type of response; uncertain points have a separate colour.

    Parameters
    ----------
    found : RepeatabilityMap
        Result of `rocking.repeatability_map`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not a RepeatabilityMap, or `ax` is not Axes.

    Notes
    -----
    A point is certain if all runs end in one type of response, undetermined if a run of it is undetermined.

    See Also
    --------
    repeatability : Plot the outcomes at one point.
    parametric_map : Plot a map of exact inputs.
    rocking.repeatability_map : Compute a map.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.repeatability_map(
    ...     amplitude=np.linspace(1, 13, 4), period=np.linspace(0.5, 2, 4), restitution=0.925, samples=4
    ... )
    >>> rk.plot.repeatability_map(found).get_xlabel().startswith("period $T$")
    True
    """
    instance("found", found, RepeatabilityMap)
    ax = style.own(ax, height=3.6)
    data, count = found.dataset, len(Kind)
    up, across = (data[name].values for name in data.kind.dims)
    seen, unknown = data.agreeing.values, data.undetermined.values
    values = np.where(unknown > 0.0, Kind.UNDETERMINED.code, data.kind.values)
    # half a run, because fractions are rounded
    values = np.where(seen + unknown < 1.0 - 0.5 / data.attrs["samples"], count, values)
    hues = [*(COLOURS[kind] for kind in Kind), palette.UNCERTAIN]
    ax.pcolormesh(
        across,
        up,
        values,
        cmap=ListedColormap(hues),
        norm=BoundaryNorm(np.arange(count + 2) - 0.5, count + 1),
        shading="nearest",
        rasterized=True,
        gid="map",
    )
    style.label(ax, *(PARAMETERS[str(name)] for name in reversed(data.kind.dims)))
    names = [*(str(kind) for kind in Kind), "not certain"]
    shares = np.bincount(values.ravel(), minlength=count + 1) / values.size
    handles = [
        Patch(facecolor=hue, edgecolor=style.INK, linewidth=style.THIN, label=f"{name} ({percent(share)})")
        for hue, name, share in zip(hues, names, shares, strict=True)
        if share >= LEAST
    ]
    style.patches(ax, handles)
    return ax
