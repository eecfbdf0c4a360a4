"""Plot of the fit of the coefficient of restitution to the times of impacts."""

import numpy as np
from matplotlib.axes import Axes

from rocking.model.validation import instance
from rocking.plot import palette, style
from rocking.response.fit_restitution import RestitutionFit


def restitution_fit(result: RestitutionFit, ax: Axes | None = None) -> Axes:
    """Plot the coefficient of restitution of each impact over its speed, with the fitted one and its 95 % interval.

    Parameters
    ----------
    result : RestitutionFit
        Result of `rocking.fit_restitution`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a RestitutionFit, or `ax` is not Axes.

    See Also
    --------
    rocking.fit_restitution : Fit the coefficient.

    Examples
    --------
    >>> import rocking as rk
    >>> times = [0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02]
    >>> rk.plot.restitution_fit(rk.fit_restitution(times, frequency_parameter=2.7)).get_ylabel()
    'coefficient of restitution $e$'
    """
    instance("result", result, RestitutionFit)
    ax = style.own(ax, height=3.7)
    style.block_title(ax, result.block, full=result.model == "full")
    data = result.to_xarray()
    speed, kept = data.impact_speed.values, data.impact_restitution.values
    ax.axhspan(
        result.restitution_low,
        result.restitution_high,
        color=palette.FOLD,
        alpha=0.2,
        linewidth=0.0,
        gid="interval",
    )
    ax.axhline(
        result.restitution,
        color=palette.FOLD,
        linewidth=style.THIN,
        label=str(result).split(" from ")[0],
        gid="fit",
    )
    known = ~np.isnan(kept)
    ax.plot(
        speed[known],
        kept[known],
        linestyle="none",
        marker="o",
        color=style.INK,
        markersize=0.8 * style.MARK,
        gid="impacts",
    )
    unit = "rad/s" if result.block is not None else r"$\alpha\theta_{cr}$"
    ax.set_xlabel(f"speed before the impact ({unit})")
    ax.set_ylabel("coefficient of restitution $e$")
    ax.set_xlim(left=0.0)
    ax.legend()
    return ax
