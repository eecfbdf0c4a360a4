"""Overturning from rest: the lowest amplitude, and the fraction of phases with overturning above it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.survey_results import OverturningCurve
from rocking.model.validation import Refusal, instance
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter


def overturning(found: OverturningCurve, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the lowest overturning amplitude over one quantity, with the fraction of overturning phases in grey.

    Parameters
    ----------
    found : OverturningCurve
        Result of `overturning_amplitude`. If no quantity varies, the fraction is drawn over the amplitude.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not an OverturningCurve, or an argument has the wrong type.
    ValueError
        If two or more quantities vary.

    See Also
    --------
    thresholds : Plot amplitudes over the period.
    rocking.overturning_amplitude : Compute the curve.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.overturning_amplitude(
    ...     period=[1.5, 2.0, 2.5], restitution=0.925, amplitude=np.linspace(1, 4, 31), phases=2
    ... )
    >>> rk.plot.overturning(found).get_xlabel().startswith("period $T$")
    True
    """
    instance("found", found, OverturningCurve)
    data = found.dataset
    if data.lowest.ndim > 1:
        over = " and ".join(map(str, data.lowest.dims))
        raise Refusal("found", "vary over one quantity to be drawn", over, "select one value first")
    level, y_label = parameter("amplitude", block)
    ax = style.own(ax, height=3.3)
    style.block_title(ax, block)
    amplitudes = level(data.amplitude.values)
    if data.lowest.ndim == 0:
        ax.plot(
            amplitudes,
            100 * data.overturning_share.values,
            color=style.INK,
            linewidth=style.LINE,
            drawstyle="steps-post",
            gid="share",
        )
        if np.isfinite(data.lowest):
            ax.axvline(
                float(level(data.lowest)), color=style.IMPACT, linewidth=style.LINE, label="lowest found"
            )
            style.key(ax)
        style.label(ax, y_label, "overturning phases (%)")
        # a line at 0 or at 100 remains visible
        ax.set_ylim(-4.0, 104.0)
        return ax
    (name,) = data.lowest.dims
    turn, x_label = parameter(str(name), block)
    across = turn(data[name].values)
    image = ax.pcolormesh(
        across,
        amplitudes,
        100 * data.overturning_share.transpose("amplitude", name).values,
        cmap="Greys",
        vmin=0,
        vmax=100,
        shading="nearest",
        rasterized=True,
        gid="share",
    )
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label("overturning phases (%)", fontsize=style.SMALL, color=style.INK)
    bar.ax.tick_params(labelsize=style.SMALL)
    ax.plot(
        across,
        level(data.lowest.values),
        color=style.IMPACT,
        linewidth=style.LINE,
        marker="o",
        markersize=style.point_size(across.size),
        label="lowest found",
        gid="lowest",
    )
    _tangency(ax, across, level(data.heteroclinic_amplitude.values))
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax


def _tangency(ax: Axes, across: np.ndarray, tangency: np.ndarray) -> None:
    """Draw A* within the scanned amplitudes; the limits of the axes stay."""
    above = ax.get_ylim()
    if (tangency > above[0]).any():
        ax.plot(
            across,
            tangency,
            color=style.MOTION,
            linewidth=style.LINE,
            linestyle=(0, (5, 2)),
            label="exact tangency $A^*$",
        )
        ax.set_ylim(above)
