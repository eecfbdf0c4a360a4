"""Spectral densities, with their lines named."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from rocking.model import Block, instance, whole, within
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.response import Peak, SpectralDensity

DECADES = 10
ROOM_FOR_NAMES = 0.3
MAX_NAMES = 100


def spectrum(
    density: SpectralDensity,
    ax: Axes | None = None,
    block: Block | None = None,
    highest: float = 3.0,
    names: int = 12,
) -> Axes:
    """Draws a spectral density on a logarithmic scale, with its strongest lines named and the forcing's multiples marked.

    Parameters
    ----------
    density : SpectralDensity
        What `rocking.spectral_density` gives.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives hertz and square degrees per hertz; otherwise the axes are normalised.
    highest : float
        Up to which multiple of the forcing frequency, in [0.1, 1000].
    names : int
        How many lines at most are named, the strongest first; one too near to a stronger one is left out.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If an argument is of another kind or outside its range.

    See Also
    --------
    rocking.spectral_density : Compute the spectral density.

    Notes
    -----
    Ten decades below the highest point are shown at most. f is the forcing frequency, f_r the rotation frequency. Beyond
    `density.highest` no lines are sought.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.spectrum(rk.spectral_density(rk.simulate(system, cycles=1200), transient=600))
    >>> [text.get_text() for text in ax.texts]
    ['$f/3$', '$f$', '$5f/3$', '$7f/3$', '$3f$']
    """
    instance("density", density, SpectralDensity)
    highest = within("highest", highest, 0.1, 1000.0)
    names = whole("names", names, 0, MAX_NAMES)
    shown = quantities(block)
    ax = style.own(ax, height=2.6)
    last = min(highest * (1 + 1e-9), density.forcing_multiples[-1])
    drawn = density.forcing_multiples <= last
    drawn[0] = False  # the mean is not part of it
    heights = shown.density(density.density[drawn])
    ax.plot(
        shown.frequency(density.frequency[drawn]),
        heights,
        color=style.MOTION,
        linewidth=0.8 * style.LINE,
        rasterized=int(drawn.sum()) > style.MAX_CORNERS,
        gid="spectrum",
    )
    forcing = shown.frequency(1 / density.system.forcing.period)
    for multiple in range(1, math.floor(last) + 1):
        ax.axvline(multiple * forcing, color=style.GUIDE, linewidth=style.THIN, linestyle=":", zorder=0)
    ax.set_yscale("log")
    style.label(ax, shown.frequency_label, shown.density_label)
    _scale(ax, heights)
    ax.set_xlim(0.0, last * forcing * 1.02)
    for peak in _apart(density.peaks, names, ax, last / density.system.forcing.period):
        ax.annotate(
            f"${peak.name}$",
            (shown.frequency(peak.frequency), shown.density(peak.height)),
            (0, 3),
            textcoords="offset points",
            rotation=90,
            ha="center",
            va="bottom",
            fontsize=style.SMALL,
            color=style.INK,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.3},
        )
    return ax


def _scale(ax: Axes, heights: np.ndarray) -> None:
    """Ten decades at most, and room for names above the highest."""
    top = math.log10(heights.max())
    bottom = max(top - DECADES, math.log10(max(heights.min(), 1e-300)))
    ax.set_ylim(10**bottom, 10 ** (top + ROOM_FOR_NAMES * (top - bottom)))
    ax.yaxis.set_major_locator(LogLocator(numticks=7))
    ax.yaxis.set_minor_locator(NullLocator())


def _apart(peaks: tuple[Peak, ...], most: int, ax: Axes, last: float) -> list[Peak]:
    """The strongest named peaks whose names, written upwards, stand clear of stronger lines, of their names and of the axis."""
    root = ax.figure.canvas.figure
    root.draw_without_rendering()  # only now is it known how wide the axes are
    clear = 1.15 * style.SMALL / 72 * root.dpi / ax.get_window_extent().width * last
    chosen: list[Peak] = []
    for rank, peak in enumerate(peaks):
        if len(chosen) == most:
            break
        on_line = any(abs(peak.frequency - other.frequency) < 0.6 * clear for other in peaks[:rank])
        on_name = any(abs(peak.frequency - other.frequency) < clear for other in chosen)
        if peak.name and not on_line and not on_name and clear / 2 <= peak.frequency <= last:
            chosen.append(peak)
    return chosen
