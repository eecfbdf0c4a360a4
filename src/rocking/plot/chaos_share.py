"""Fraction of chaotic responses over the coefficient of restitution."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rocking.model.survey_results import ChaosShare
from rocking.model.validation import instance
from rocking.model.verdict import Kind
from rocking.plot.parts import style
from rocking.plot.parts.legend import COLOURS

DECADES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
# The axis reaches beyond its outermost points by this factor; the break lies at this multiple of the place of e = 1.
MARGIN, BREAK = 1.3, 2.0


def chaos_share(found: ChaosShare, ax: Axes | None = None) -> Axes:
    """Plot the fraction of chaotic responses with its 95 % interval over the coefficient of restitution e.

    Parameters
    ----------
    found : ChaosShare
        Result of `rocking.chaos_share`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not a ChaosShare, or `ax` is not Axes.

    Notes
    -----
    The horizontal axis is 1 − e, logarithmic; a dotted line separates e = 1. The note gives the number n of systems per
    point. A hollow mark means no chaotic system among them; its interval is one-sided.

    See Also
    --------
    rocking.chaos_share : Compute the fractions.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.chaos_share(restitution=[0.5, 0.9], samples=20)
    >>> rk.plot.chaos_share(found).get_xlabel()
    '$1 - e$, coefficient of restitution $e$'
    """
    instance("found", found, ChaosShare)
    ax = style.own(ax)
    data = found.dataset
    share, low, high = (100 * data[name].values for name in ("chaotic", "chaotic_low", "chaotic_high"))
    across, conservative = _places(data.restitution.values)
    colour = COLOURS[Kind.CHAOTIC]
    ax.errorbar(
        across,
        share,
        yerr=[share - low, high - share],
        color=colour,
        fmt="none",
        elinewidth=style.LINE,
        capsize=2.5,
        clip_on=False,
        gid="interval",
    )
    for where, face in ((share > 0.0, colour), (share == 0.0, "white")):
        ax.plot(
            across[where],
            share[where],
            linestyle="none",
            marker="o",
            markersize=style.MARK,
            markeredgecolor=colour,
            markerfacecolor=face,
            clip_on=False,
            zorder=3,
            gid="chaotic",
        )
    ax.set_xscale("log")
    style.label(ax, "$1 - e$, coefficient of restitution $e$", "chaotic responses (%)")
    ax.set_ylim(bottom=0.0)
    ax.set_xlim(across.min() / MARGIN, max(across.max(), 1.0) * MARGIN)
    ticks = [place for place in DECADES if across.min() <= place]
    if conservative is not None:
        ticks = [conservative, *(place for place in DECADES if place > BREAK * conservative)]
        ax.axvline(BREAK * conservative, color=style.GUIDE, linewidth=style.THIN, linestyle=":", gid="break")
    ax.xaxis.set_major_locator(FixedLocator(ticks))
    ax.xaxis.set_major_formatter(
        FuncFormatter(lambda place, _: "0" if place == conservative else f"{place:g}")
    )
    ax.xaxis.set_minor_locator(NullLocator())
    counts = sorted({each.of for each in found.shares})
    style.note(ax, "$n = $ " + "–".join(f"{count:,}" for count in dict.fromkeys((counts[0], counts[-1]))))
    return ax


def _places(restitution: np.ndarray) -> tuple[np.ndarray, float | None]:
    """Return 1 − e, and the place of e = 1, which a logarithmic axis cannot hold; None without e = 1."""
    loss = 1.0 - restitution
    if loss.min() > 0.0:
        return loss, None
    place = 0.25 * loss.min(where=loss > 0.0, initial=1.0)
    return np.where(loss > 0.0, loss, place), float(place)
