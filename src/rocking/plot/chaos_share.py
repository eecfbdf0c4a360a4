"""How common each kind of response is, over the restitution."""

from __future__ import annotations

from matplotlib.axes import Axes

from rocking.model import ChaosShare, Kind, instance
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import PARAMETERS
from rocking.plot.parts.legend import COLOURS


def chaos_share(found: ChaosShare, ax: Axes | None = None) -> Axes:
    """Draws the share of chaotic responses with its 95 % interval, over the restitution.

    Parameters
    ----------
    found : ChaosShare
        From `rocking.chaos_share`.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is another result, or `ax` no axes.

    See Also
    --------
    rocking.chaos_share : Compute the fractions.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.chaos_share(restitution=[0.5, 0.9], samples=20)
    >>> rk.plot.chaos_share(found).get_xlabel()
    'restitution $e$ (–)'
    """
    instance("found", found, ChaosShare)
    ax = style.own(ax)
    data = found.dataset
    share, low, high = (100 * data[name].values for name in ("chaotic", "chaotic_low", "chaotic_high"))
    ax.errorbar(
        data.restitution.values,
        share,
        yerr=[share - low, high - share],
        color=COLOURS[Kind.CHAOTIC],
        linewidth=style.LINE,
        marker="o",
        markersize=style.MARK,
        capsize=2.5,
        gid="chaotic",
    )
    style.label(ax, PARAMETERS["restitution"], "chaotic responses [%]")
    ax.set_ylim(bottom=0.0)
    return ax
