"""Correlation sum, its local slopes and the scaling region."""

from matplotlib.axes import Axes

from rocking.model.text import counted
from rocking.model.validation import Refusal, instance
from rocking.plot.parts import style
from rocking.response.correlation_dimension import CorrelationDimension


def correlation_dimension(result: CorrelationDimension, ax: Axes | None = None) -> Axes:
    """Plot the correlation sum against the radius, its local slopes on the right axis, and the scaling region.

    Parameters
    ----------
    result : CorrelationDimension
        Result of `correlation_dimension`, not of isolated points, whose pairs do not scale.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a CorrelationDimension, or `ax` is not Axes.
    ValueError
        If `result` describes isolated points.

    See Also
    --------
    section : Plot the points.
    rocking.correlation_dimension : Compute the dimension.

    Notes
    -----
    Bars are standard errors of the slopes. The grey band is the scaling region. The coloured band across it is the interval
    of the dimension.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> points = np.random.default_rng(1).random((6_000, 2))
    >>> ax = rk.plot.correlation_dimension(rk.correlation_dimension(points))
    >>> ax.get_xscale(), ax.get_yscale()
    ('log', 'log')
    """
    instance("result", result, CorrelationDimension)
    if result.isolated:
        raise Refusal("result", "hold pairs that scale", counted(result.isolated, "isolated point"))
    ax = style.own(ax, height=2.8)
    ax.set(xscale="log", yscale="log")
    ax.axvspan(*result.scaling_region, color=style.TABLE, alpha=0.4, linewidth=0, gid="scaling-region")
    ax.plot(
        result.radii,
        result.sums,
        color=style.MOTION,
        linewidth=style.LINE,
        label=r"$C(r)$",
        gid="correlation-sum",
    )
    right = ax.twinx()
    right.errorbar(
        (result.radii[1:] * result.radii[:-1]) ** 0.5,
        result.slopes,
        result.slope_errors,
        color=style.IMPACT,
        linestyle="none",
        marker="o",
        markersize=2.0,
        elinewidth=style.THIN,
        label=r"local slope",
        gid="slopes",
    )
    low, high = result.interval
    right.fill_between(
        result.scaling_region, low, high, color=style.IMPACT, alpha=0.25, linewidth=0, gid="interval"
    )
    right.set_ylim(0.0, 1.25 * max(high, float(result.slopes.max())))
    style.label(ax, r"radius $r$ / standard deviation", r"correlation sum $C(r)$")
    ax.yaxis.label.set_color(style.MOTION)
    style.label(right, "", r"$\mathrm{d} \ln C / \mathrm{d} \ln r$")
    for axis in (ax.xaxis, ax.yaxis):
        style.logarithmic(axis)
    right.spines["right"].set(visible=True)
    right.spines["left"].set(visible=False)
    right.yaxis.label.set_color(style.IMPACT)
    style.note(ax, f"dimension {result.value:.2f}, in [{low:.2f}, {high:.2f}]")
    return ax
