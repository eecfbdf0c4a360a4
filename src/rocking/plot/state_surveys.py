"""Plots of surveys over initial states: basins of attraction and safe basins."""

from __future__ import annotations

from collections import Counter

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from rocking.model.block import Block
from rocking.model.survey_results import Attractor, BasinMap, SafeBasin
from rocking.model.text import percent
from rocking.model.validation import instance
from rocking.model.verdict import Kind
from rocking.plot import style
from rocking.plot.axes import parameter
from rocking.plot.maps import MAX_DRAWN
from rocking.plot.palette import Look, look_of

NAMED = 8
"""Maximum number of attractors in the legend; all attractors are drawn."""
MAX_LENGTH = 12
"""Longest name of which two fit in one row."""
LEAST = 1e-4
"""Smallest fraction with a row in the legend."""

HATCH = "////"


def basins(result: BasinMap, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot basins of attraction in the colours of the types of response; attractors of one type have different shades.

    Parameters
    ----------
    result : BasinMap
        Result of `basin_map`, over a grid or of random initial states.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a BasinMap, or an argument has the wrong type.

    See Also
    --------
    safe_basin : Plot the safe fraction over the amplitude.
    rocking.basin_map : Compute basins.

    Notes
    -----
    The legend lists the attractors of at least 0.01 % of the area, up to eight, with their area fractions. From axes of
    more than 2,000 initial states not every one is drawn.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=5.5, period=1.0), restitution=0.8)
    >>> starts = np.linspace(-1, 1, 30)
    >>> ax = rk.plot.basins(rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0))
    >>> len(ax.get_legend().get_patches())
    2
    """
    instance("result", result, BasinMap)
    hues = colours(result.attractors)
    places = result.dataset.attractor
    (turn_across, x_label), (turn_up, y_label) = (parameter(name, block) for name in ("angle", "velocity"))
    ax = style.own(ax, height=4.0)
    if places.ndim == 2:
        steps = {name: slice(None, None, -(-size // MAX_DRAWN)) for name, size in places.sizes.items()}
        drawn = places.isel(steps).transpose("velocity", "angle")
        across, up = turn_across(drawn.angle.values), turn_up(drawn.velocity.values)
        ax.pcolormesh(
            across, up, drawn.values, **style.coded(hues), shading="nearest", rasterized=True, gid="basins"
        )
        for number, each in enumerate(result.attractors):
            if each.kind is Kind.UNDETERMINED:
                where = (drawn.values == number).astype(float)
                ax.contourf(across, up, where, [0.5, 1.5], colors="none", hatches=[HATCH])
    else:
        ax.scatter(
            turn_across(places.angle.values),
            turn_up(places.velocity.values),
            c=places.values,
            **style.coded(hues),
            s=style.point_size(places.size) ** 2,
            linewidths=0,
            rasterized=places.size > style.MAX_MARKS,
            gid="basins",
        )
    style.label(ax, x_label, y_label)
    style.block_title(ax, block)
    _legend(ax, result, hues)
    return ax


def colours(attractors: tuple[Attractor, ...]) -> list[str]:
    """Return the colours of attractors: that of the category, and other shades for more attractors of the same category."""
    hues: list[str] = []
    met: Counter[Look] = Counter()
    for each in attractors:
        look = look_of(each.verdict)
        hues.append(look.shade(met[look]))
        met[look] += 1
    return hues


def _legend(ax: Axes, result: BasinMap, hues: list) -> None:
    all_ = zip(result.attractors, result.fractions, hues, strict=True)
    named = [(each, share, hue) for each, share, hue in all_ if share.value >= LEAST][:NAMED]
    handles = [
        Patch(
            facecolor=hue,
            hatch=HATCH if each.kind is Kind.UNDETERMINED else None,
            edgecolor=style.INK,
            linewidth=style.THIN,
            label=f"{each.name} ({percent(share.value)})",
        )
        for each, share, hue in named
    ]
    style.patches(ax, handles, 1 if max(len(each.name) for each, _, _ in named) > MAX_LENGTH else 2)


def safe_basin(result: SafeBasin, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the fraction of initial states that do not overturn, with its 95 % interval, over the amplitude.

    Parameters
    ----------
    result : SafeBasin
        Result of `rocking.safe_basin`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a SafeBasin, or an argument has the wrong type.

    See Also
    --------
    basins : Plot the basins at one amplitude.
    rocking.safe_basin : Compute the fractions.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.8)
    >>> result = rk.safe_basin(system, amplitude=[3.3, 3.7, 5.5], samples=200)
    >>> rk.plot.safe_basin(result).get_ylabel()
    'safe fraction (%)'
    """
    instance("result", result, SafeBasin)
    level, x_label = parameter("amplitude", block)
    ax = style.own(ax, height=2.9)
    style.block_title(ax, block)
    data = result.dataset
    across = level(data.amplitude.values)
    ax.fill_between(
        across, 100 * data.safe_low, 100 * data.safe_high, color=style.MOTION, alpha=0.3, linewidth=0
    )
    ax.plot(
        across,
        100 * data.safe,
        color=style.MOTION,
        linewidth=style.LINE,
        marker="o",
        markersize=style.point_size(across.size),
        label="safe, 95 % interval",
        clip_on=False,  # points at 100 % lie on the frame
        gid="safe",
    )
    if np.isfinite(result.heteroclinic_amplitude):
        ax.axvline(
            level(result.heteroclinic_amplitude),
            color=style.IMPACT,
            linewidth=style.LINE,
            label="exact tangency $A^*$",
        )
        ax.axvline(
            level(result.melnikov_amplitude),
            color=style.INK,
            linewidth=style.LINE,
            linestyle=(0, (5, 2)),
            label="Melnikov's $A_M$",
        )
    style.label(ax, x_label, "safe fraction (%)")
    ax.set_ylim(bottom=0.0)
    style.key(ax)
    return ax
