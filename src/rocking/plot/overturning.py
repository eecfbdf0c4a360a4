"""Overturning from rest: the lowest amplitude, and at how many phases the block overturns above it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model import Block, OverturningCurve, instance, refusal
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter


def overturning(found: OverturningCurve, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Draws the lowest overturning amplitude over what varies, and behind it the share of phases at which the block overturns.

    Parameters
    ----------
    found : OverturningCurve
        From `overturning_amplitude`; one quantity varies, or none, then the share is drawn over the amplitude.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives SI axes and a title; otherwise the axes are normalised.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `found` is another result or two quantities vary, or `ax` is no axes.

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
        raise ValueError(
            refusal("found", "vary over one quantity to be drawn", over, "select one value first")
        )
    ax = style.own(ax, height=3.3)
    style.block_title(ax, block)
    level, y_label = parameter("amplitude", block)
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
        style.label(ax, y_label, "phases at which it overturns [%]")
        # a line at 0 or at 100 is seen as well
        ax.set_ylim(-4.0, 104.0)
        return ax
    (name,) = data.lowest.dims
    turn, x_label = parameter(str(name), block)
    across = turn(data[name].values)
    shares = 100 * data.overturning_share.transpose("amplitude", name).values
    image = ax.pcolormesh(
        across,
        amplitudes,
        shares,
        cmap="Greys",
        vmin=0,
        vmax=100,
        shading="nearest",
        rasterized=True,
        gid="share",
    )
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label("phases at which it overturns [%]", fontsize=style.SMALL, color=style.INK)
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
    """A* where it is seen; the axes stay those of what was scanned."""
    above = ax.get_ylim()
    if (tangency > above[0]).any():
        dashes = (0, (5, 2))
        ax.plot(
            across,
            tangency,
            color=style.MOTION,
            linewidth=style.LINE,
            linestyle=dashes,
            label="exact tangency $A^*$",
        )
        ax.set_ylim(above)
