"""Plot of the power spectral density of a motion with its named lines."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from rocking.model.block import Block
from rocking.model.validation import instance, whole, within
from rocking.plot import style
from rocking.plot.axes import units_of
from rocking.response.spectrum import Peak, SpectralDensity

if TYPE_CHECKING:
    import xarray as xr


class Line(NamedTuple):
    """Line of a spectrum, of one record and one slenderness, whose number counts from 0."""

    name: str
    slenderness_number: int
    slenderness: str
    peak: np.ndarray
    overturned: np.ndarray
    certified: np.ndarray


def overturned_runs(data: xr.Dataset) -> Any:
    """Return which runs overturned, as an array with the dimensions of the spectrum."""
    meanings = data.outcome.attrs["flag_meanings"].split()
    return data.outcome == meanings.index("overturned")


def value(data: xr.Dataset, name: str) -> Any:
    """Return a quantity of the survey, whether it varies or not."""
    return data[name].values if name in data.coords else data.attrs[name]


def lines_of(data: xr.Dataset, name: str, unit: str) -> Iterator[Line]:
    """Yield the lines, the slendernesses of each record.

    `name` is the quantity of the horizontal axis, "size" or "slenderness". `unit` is that of the angle, "critical" or "degrees".
    """
    degrees = np.degrees(np.asarray(value(data, "slenderness"), float))
    fell = overturned_runs(data)
    peaks = data.peak * (np.degrees(data["slenderness"]) if "slenderness" in data.peak.dims else degrees)
    heights = data.peak if unit == "critical" else peaks
    records = range(data.sizes["record"]) if "record" in data.dims else [None]
    angles = range(data.sizes["slenderness"]) if name == "size" and "slenderness" in data.dims else [None]
    for record in records:
        for angle in angles:
            at = {key: k for key, k in (("record", record), ("slenderness", angle)) if k is not None}
            slenderness = ""
            if name != "slenderness" and (angle is not None or record is None):
                slenderness = rf"$\theta_\mathrm{{cr}}$ = {degrees.flat[angle or 0]:.3g}°"
            parts = ["" if record is None else str(data.name.values[record]), slenderness]
            yield Line(
                ", ".join(filter(None, parts)) or "peak",
                angle or 0,
                slenderness,
                np.where(fell.isel(at), np.nan, heights.isel(at)),
                fell.isel(at).values,
                data.certified.isel(at).values != 0,
            )


DECADES = 10
ROOM_FOR_NAMES = 0.3
# Distance of lines that leaves room for horizontal names, in heights of a name.
HORIZONTAL = 3.0
MAX_NAMES = 100


def spectrum(
    result: SpectralDensity,
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    highest: float = 3.0,
    names: int = 12,
) -> Axes:
    """Plot a power spectral density on a logarithmic scale, with the names of its strongest lines.

    Parameters
    ----------
    result : SpectralDensity
        Result of `rocking.spectral_density`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for hertz and square degrees per hertz. Default: that of the result. None: normalised axes.
    highest : float
        Highest frequency shown, as a multiple of the forcing frequency, in [0.1, 1000]. Default: 3.
    names : int
        Maximum number of named lines, 0 to 100, the strongest first. A line too close to a stronger one has no name.
        Default: 12.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `highest` or `names` lies outside its range.

    See Also
    --------
    rocking.spectral_density : Compute the spectral density.

    Notes
    -----
    At most ten decades below the highest point are shown. Dotted lines mark multiples of the forcing frequency f; f_r is
    the rotation frequency. Lines are named up to `density.highest`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.spectrum(rk.spectral_density(rk.simulate(system, cycles=1200), transient=600))
    >>> [text.get_text() for text in ax.texts]
    ['$f/3$', '$f$', '$5f/3$', '$7f/3$', '$3f$']
    """
    instance("result", result, SpectralDensity)
    highest = within("highest", highest, 0.1, 1000.0)
    names = whole("names", names, 0, MAX_NAMES)
    units = units_of(block)
    ax = style.own(ax, height=2.6)
    last = min(highest * (1 + 1e-9), result.forcing_multiples[-1])
    drawn = result.forcing_multiples <= last
    drawn[0] = False  # the mean is not part of the density
    heights = units.density(result.density[drawn])
    ax.plot(
        units.frequency(result.frequency[drawn]),
        heights,
        color=style.MOTION,
        linewidth=0.8 * style.LINE,
        rasterized=int(drawn.sum()) > style.MAX_CORNERS,
        gid="spectrum",
    )
    forcing = units.frequency(1 / result.system.periodic.period)
    for multiple in range(1, math.floor(last) + 1):
        ax.axvline(multiple * forcing, color=style.GUIDE, linewidth=style.THIN, linestyle=":", zorder=0)
    ax.set_yscale("log")
    style.label(ax, units.frequency_label, units.density_label)
    _scale(ax, heights)
    ax.set_xlim(0.0, last * forcing * 1.02)
    chosen, upright = _apart(result.peaks, names, ax, last / result.system.periodic.period)
    for peak in chosen:
        ax.annotate(
            f"${peak.name}$",
            (units.frequency(peak.frequency), units.density(peak.height)),
            (0, 3),
            textcoords="offset points",
            rotation=90 if upright else 0,
            ha="center",
            va="bottom",
            fontsize=style.SMALL,
            color=style.INK,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.3},
        )
    return ax


def _scale(ax: Axes, heights: np.ndarray) -> None:
    """Show at most ten decades, with room for names above the highest point."""
    top = math.log10(heights.max())
    bottom = max(top - DECADES, math.log10(max(heights.min(), 1e-300)))
    ax.set_ylim(10**bottom, 10 ** (top + ROOM_FOR_NAMES * (top - bottom)))
    ax.yaxis.set_major_locator(LogLocator(numticks=7))
    ax.yaxis.set_minor_locator(NullLocator())


def _apart(peaks: tuple[Peak, ...], most: int, ax: Axes, last: float) -> tuple[list[Peak], bool]:
    """Choose the strongest named peaks whose names are clear of stronger lines, of each other and of the axis.

    Returns
    -------
    tuple of (list of Peak, bool)
        The peaks, and whether their names run upwards, because there is no room for horizontal names.
    """
    root = ax.figure.canvas.figure
    root.draw_without_rendering()  # the width of the axes is known after the layout
    clear = 1.15 * style.SMALL / 72 * root.dpi / ax.get_window_extent().width * last
    units = np.sort([peak.frequency for peak in peaks if peak.frequency <= last])
    gaps = np.diff(units, prepend=-units[0], append=np.inf) if len(units) else np.zeros(1)
    wide = gaps.min() > HORIZONTAL * clear
    chosen: list[Peak] = []
    for rank, peak in enumerate(peaks):
        if len(chosen) == most:
            break
        on_line = any(abs(peak.frequency - other.frequency) < 0.6 * clear for other in peaks[:rank])
        on_name = any(abs(peak.frequency - other.frequency) < clear for other in chosen)
        if peak.name and not on_line and not on_name and clear / 2 <= peak.frequency <= last:
            chosen.append(peak)
    return chosen, not wide
