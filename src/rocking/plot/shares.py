"""Plots of fractions and thresholds over a parameter: chaos, overturning amplitudes, repeatability."""

from __future__ import annotations

import re

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rocking.model.block import Block
from rocking.model.survey_results import ChaosShare, OverturningCurve, Repeatability, RepeatabilityMap
from rocking.model.text import percent
from rocking.model.validation import Refusal, instance
from rocking.model.verdict import Kind
from rocking.plot import palette, style
from rocking.plot.axes import parameter
from rocking.plot.palette import COLOURS, look_at

DECADES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
# The axis reaches beyond its outermost points by this factor; the break lies at this multiple of the place of e = 1.
MARGIN, BREAK = 1.3, 2.0


def chaos_share(result: ChaosShare, ax: Axes | None = None) -> Axes:
    """Plot the fraction of chaotic responses with its 95 % interval over the coefficient of restitution e.

    Parameters
    ----------
    result : ChaosShare
        Result of `rocking.chaos_share`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a ChaosShare, or `ax` is not Axes.

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
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.9)
    >>> result = rk.chaos_share(system, restitution=[0.5, 0.9], samples=20)
    >>> rk.plot.chaos_share(result).get_xlabel()
    '$1 - e$, coefficient of restitution $e$'
    """
    instance("result", result, ChaosShare)
    ax = style.own(ax)
    data = result.dataset
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
    counts = sorted({each.of for each in result.shares})
    style.note(ax, "$n = $ " + "–".join(f"{count:,}" for count in dict.fromkeys((counts[0], counts[-1]))))
    return ax


def _places(restitution: np.ndarray) -> tuple[np.ndarray, float | None]:
    """Return 1 − e, and the place of e = 1, which a logarithmic axis cannot hold; None without e = 1."""
    loss = 1.0 - restitution
    if loss.min() > 0.0:
        return loss, None
    place = 0.25 * loss.min(where=loss > 0.0, initial=1.0)
    return np.where(loss > 0.0, loss, place), float(place)


def overturning(result: OverturningCurve, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the lowest overturning amplitude over one quantity, with the fraction of overturning phases in grey.

    Parameters
    ----------
    result : OverturningCurve
        Result of `overturning_amplitude`. If no quantity varies, the fraction is drawn over the amplitude.
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
        If `result` is not an OverturningCurve, or an argument has the wrong type.
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
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.overturning_amplitude(system, period=[1.5, 2.0], amplitude=np.linspace(1, 4, 31), phases=2)
    >>> rk.plot.overturning(result).get_xlabel().startswith("period $T$")
    True
    """
    instance("result", result, OverturningCurve)
    data = result.dataset
    if data.lowest.ndim > 1:
        over = " and ".join(map(str, data.lowest.dims))
        raise Refusal("result", "vary over one quantity to be drawn", over, "select one value first")
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


MAX_SHOWN = 12
LEAST = 1e-4
"""Smallest fraction with a row in the legend."""


def repeatability(result: Repeatability, ax: Axes | None = None) -> Axes:
    """Plot the fraction of runs with each outcome and its 95 % interval, the largest at the top, up to twelve.

    Parameters
    ----------
    result : Repeatability
        Result of `rocking.repeatability`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a Repeatability, or `ax` is not Axes.

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
    instance("result", result, Repeatability)
    ax = style.own(ax)
    pairs = list(result.responses.items())[:MAX_SHOWN]
    up = np.arange(len(pairs))
    values = np.array([share.value for _, share in pairs])
    ends = np.array([[share.value - share.low, share.high - share.value] for _, share in pairs]).T
    hues = [_colour(name) for name, _ in pairs]
    error = {"elinewidth": style.LINE, "capsize": 2.5, "ecolor": style.GUIDE}
    ax.barh(up, 100 * values, xerr=100 * ends, color=hues, height=0.7, error_kw=error, gid="shares")
    style.label(ax, f"fraction of {result.repeats.of:,} runs (%)", "")
    ax.set_yticks(up, [name for name, _ in pairs])
    ax.invert_yaxis()
    ax.set_xlim(0.0, 100.0)
    style.note(ax, f"inputs vary by up to {100 * result.relative:.3g} %")
    return ax


def _colour(name: str) -> str:
    """Return the colour of a response by its name, such as "period 3, symmetric, 2 impacts" or "overturned"."""
    periodic = re.match(r"period (\d+), (a?)symmetric", name)
    if periodic is None:
        return COLOURS[Kind(name)]
    return look_at(Kind.PERIODIC, int(periodic[1]), not periodic[2]).colour


def repeatability_map(result: RepeatabilityMap, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot a map of certain outcomes, one colour per type of response; uncertain points have a separate colour.

    Parameters
    ----------
    result : RepeatabilityMap
        Result of `rocking.repeatability_map`.
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
        If `result` is not a RepeatabilityMap, `ax` is not Axes, or `block` is not a Block.

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
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.repeatability_map(
    ...     system, amplitude=np.linspace(1, 13, 4), period=np.linspace(0.5, 2, 4), samples=4
    ... )
    >>> rk.plot.repeatability_map(result).get_xlabel().startswith("period $T$")
    True
    """
    instance("result", result, RepeatabilityMap)
    data, count = result.dataset, len(Kind)
    (turn_up, y_label), (turn_across, x_label) = (parameter(str(name), block) for name in data.kind.dims)
    up, across = (data[name].values for name in data.kind.dims)
    ax = style.own(ax, height=3.6)
    style.block_title(ax, block)
    seen, unknown = data.agreeing.values, data.undetermined.values
    values = np.where(unknown > 0.0, Kind.UNDETERMINED.code, data.kind.values)
    # half a run, because fractions are rounded
    values = np.where(seen + unknown < 1.0 - 0.5 / data.attrs["samples"], count, values)
    hues = [*(COLOURS[kind] for kind in Kind), palette.UNCERTAIN]
    ax.pcolormesh(
        turn_across(across),
        turn_up(up),
        values,
        **style.coded(hues),
        shading="nearest",
        rasterized=True,
        gid="map",
    )
    style.label(ax, x_label, y_label)
    names = [*(str(kind) for kind in Kind), "not certain"]
    shares = np.bincount(values.ravel(), minlength=count + 1) / values.size
    handles = [
        Patch(facecolor=hue, edgecolor=style.INK, linewidth=style.THIN, label=f"{name} ({percent(share)})")
        for hue, name, share in zip(hues, names, shares, strict=True)
        if share >= LEAST
    ]
    style.patches(ax, handles)
    return ax
