"""Rocking spectra: the largest angle over the size or the slenderness of a block, as lines or as a map."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model import counted, one_of, refusal
from rocking.plot.parts import style
from rocking.plot.parts.map_levels import edges

if TYPE_CHECKING:
    import xarray as xr

ACROSS = {
    "size": "distance $R$ of corner and centre of mass (m)",
    "frequency-parameter": r"frequency parameter $\alpha$ (1/s)",
    "period": r"$2\pi/\alpha$ (s)",
}
"""Quantities of the horizontal axis that stand for the size."""
UNITS = {
    "critical": r"largest angle $|\theta|/\theta_\mathrm{cr}$",
    "degrees": r"largest angle $|\theta|$ (°)",
}
SLENDERNESS = r"critical angle $\theta_\mathrm{cr}$ (°)"
LINES = ("record", "size", "slenderness")
COLOURS = (style.MOTION, style.IMPACT, style.BRACE, "#CC79A7", "#56B4E9", "#8A6D00", "#3F0A6B", style.INK)
"""Colours of lines with a name in the legend; more lines have one colour."""
MOST_SLENDERNESSES = 6
"""Most critical angles of which each has lines; more give a map."""
TOP = 0.25
"""Largest part of the axes above the lines, for the marks of overturned blocks."""
ROW = 0.055
LONGEST = 28
"""Longest name of a line in a legend of two columns; TeX counts as its characters."""


class Line(NamedTuple):
    """Line of a spectrum."""

    name: str
    peak: np.ndarray
    overturned: np.ndarray
    certified: np.ndarray


def rocking_spectrum(
    found: xr.Dataset, ax: Axes | None = None, *, across: str = "size", unit: str = "critical"
) -> Axes:
    r"""Plot the largest angle over the size or the slenderness of the block.

    There is one line per record and slenderness, with a cross above the lines where the block overturns, one row per line. Open
    circles mark outcomes that rounding may have changed. Size and more than six slendernesses give a map.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `rocking.rocking_spectrum` over records, size and slenderness. Select one value of other dimensions first.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    across : {"size", "frequency-parameter", "period"}
        Horizontal axis for the size: R in m, α in 1/s, or 2π/α in s. Default: "size".
    unit : {"critical", "degrees"}
        Unit of the angle, the critical angle or the degree. Default: "critical".

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not a rocking spectrum, or an argument has the wrong type.
    ValueError
        If `found` varies over another quantity, or over several records as a map, or if an argument is unknown.

    See Also
    --------
    rocking.rocking_spectrum : Compute the spectrum.
    overview : Plot one of its motions.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> strong = rk.example_ground_motion().scaled(5)
    >>> found = rk.rocking_spectrum(strong, size=np.linspace(0.5, 4, 30), slenderness=[0.15, 0.2])
    >>> rk.plot.rocking_spectrum(found, across="period").get_xlabel()
    '$2\\pi/\\alpha$ (s)'
    """
    across, unit = one_of("across", across, tuple(ACROSS)), one_of("unit", unit, tuple(UNITS))
    _check(found)
    dims = found.peak.dims
    if "slenderness" in dims and "size" in dims and found.sizes["slenderness"] > MOST_SLENDERNESSES:
        return _map(found, ax, across, unit)
    name = "size" if "size" in dims else "slenderness"
    places, x_label = _axis(found, name, across)
    lines = list(_lines(found, name, unit))
    named = len(lines) <= len(COLOURS)
    ax = style.own(ax, height=2.6 + (0.16 * -(-len(lines) // 2) if named else 0.0))
    ends = [line.peak[np.isfinite(line.peak)].max(initial=0.0) for line in lines]
    room = min(TOP, ROW * len(lines))
    top = max(*ends, 1e-9) / (0.97 - room)
    for number, line in enumerate(lines):
        height = top * (1.0 - room * (number + 0.5) / len(lines))
        _draw(ax, places, line, COLOURS[number] if named else style.MOTION, height, many=not named)
    style.label(ax, x_label, UNITS[unit])
    ax.set_ylim(0.0, top)
    _key(ax, lines, named=named)
    return ax


def _check(found: Any) -> None:
    """Raise TypeError or ValueError for a dataset that is no rocking spectrum over its axes."""
    peak = getattr(found, "peak", None)
    if peak is None or not all(hasattr(found, name) for name in ("outcome", "certified")):
        raise TypeError(refusal("found", "be a dataset as rocking_spectrum gives it", found))
    others = [str(name) for name in peak.dims if name not in LINES]
    if others:
        remedy = f"select one value first, such as found.isel({others[0]}=0)"
        allowed = "vary over records, size and slenderness alone"
        raise ValueError(refusal("found", allowed, ", ".join(others), remedy))
    if not {"size", "slenderness"} & set(peak.dims):
        raise ValueError(refusal("found", "vary over size or slenderness", tuple(map(str, peak.dims))))


def _overturned(found: xr.Dataset) -> Any:
    """Return which runs overturned, as an array with the dimensions of the spectrum."""
    meanings = found.outcome.attrs["flag_meanings"].split()
    return found.outcome == meanings.index("overturned")


def _value(found: xr.Dataset, name: str) -> Any:
    """Return a quantity of the survey, whether it varies or not."""
    return found[name].values if name in found.coords else found.attrs[name]


def _axis(found: xr.Dataset, name: str, across: str) -> tuple[np.ndarray, str]:
    """Return the values of the horizontal axis, and its label."""
    if name == "slenderness":
        return np.degrees(found[name].values), SLENDERNESS
    if across == "size":
        return found[name].values, ACROSS[across]
    alpha = found["frequency_parameter"].values
    return (alpha if across == "frequency-parameter" else math.tau / alpha), ACROSS[across]


def _lines(found: xr.Dataset, name: str, unit: str) -> Iterator[Line]:
    """Yield the lines: the slendernesses of each record."""
    degrees = np.degrees(np.asarray(_value(found, "slenderness"), float))
    overturned = _overturned(found)
    peaks = found.peak * (np.degrees(found["slenderness"]) if "slenderness" in found.peak.dims else degrees)
    shown = found.peak if unit == "critical" else peaks
    records = range(found.sizes["record"]) if "record" in found.dims else [None]
    angles = range(found.sizes["slenderness"]) if name == "size" and "slenderness" in found.dims else [None]
    for record in records:
        for angle in angles:
            at = {key: k for key, k in (("record", record), ("slenderness", angle)) if k is not None}
            parts = []
            if record is not None:
                parts.append(str(found.name.values[record]))
            if angle is not None or record is None:
                parts.append(
                    ""
                    if name == "slenderness"
                    else rf"$\theta_\mathrm{{cr}}$ = {degrees.flat[angle or 0]:.3g}°"
                )
            yield Line(
                ", ".join(filter(None, parts)) or "peak",
                np.where(overturned.isel(at), np.nan, shown.isel(at)),
                overturned.isel(at).values,
                found.certified.isel(at).values != 0,
            )


def _draw(ax: Axes, places: np.ndarray, line: Line, colour: str, height: float, *, many: bool) -> None:
    """Draw a line, the marks above it, and the open circles of undecided outcomes."""
    size = style.point_size(max(places.size, 30))
    ax.plot(
        places,
        line.peak,
        color=colour,
        linewidth=style.THIN if many else style.LINE,
        alpha=0.5 if many else 1.0,
        marker=".",
        markersize=0.5 * size if many else size,
        gid="peak",
    )
    ax.plot(
        places[line.overturned],
        np.full(int(line.overturned.sum()), height),
        color=colour,
        linestyle="none",
        marker="x",
        markersize=min(style.MARK, 1.6 * size) * (0.6 if many else 1.0),
        markeredgewidth=style.THIN,
        gid="overturned",
    )
    doubtful = ~line.certified
    ax.plot(
        places[doubtful],
        np.where(line.overturned, height, line.peak)[doubtful],
        linestyle="none",
        marker="o",
        markersize=style.MARK * (0.5 if many else 1.0),
        markeredgecolor=style.INK,
        markerfacecolor="none",
        markeredgewidth=style.THIN,
        gid="undecided",
    )


def _key(ax: Axes, lines: list[Line], *, named: bool) -> None:
    """Draw the legend: the lines if they have names, the crosses and the circles if there are some."""
    names = [line.name for line in lines] if named else [counted(len(lines), "line")]
    width = style.LINE if named else style.THIN
    handles = [
        Line2D([], [], color=colour, linewidth=width, label=name)
        for name, colour in zip(names, COLOURS, strict=False)
    ]
    looks: dict[str, Any] = {"linestyle": "none", "color": style.INK, "markersize": style.MARK}
    if any(line.overturned.any() for line in lines):
        names.append("overturned")
        handles.append(Line2D([], [], marker="x", label=names[-1], **looks))
    if not all(line.certified.all() for line in lines):
        names.append("undecided by rounding")
        handles.append(Line2D([], [], marker="o", markerfacecolor="none", label=names[-1], **looks))
    style.patches(ax, handles, columns=1 if max(map(len, names)) > LONGEST else 2)


def _map(found: xr.Dataset, ax: Axes | None, across: str, unit: str) -> Axes:
    """Draw the largest angle over size and slenderness."""
    if "record" in found.peak.dims:
        remedy = "select one first, such as found.isel(record=0)"
        count = counted(found.sizes["record"], "record")
        raise ValueError(refusal("found", "hold one record to be a map", count, remedy))
    places, x_label = _axis(found, "size", across)
    angles = np.degrees(found["slenderness"].values)
    peak = found.peak.transpose("slenderness", "size").values
    if unit == "degrees":
        peak = peak * angles[:, None]
    overturned = _overturned(found).transpose("slenderness", "size").values
    ax = style.own(ax, height=3.0)
    corners = edges(places), edges(angles)
    ax.pcolormesh(
        *corners,
        np.where(overturned, 1.0, np.nan),
        cmap=ListedColormap([style.FALLEN]),
        rasterized=True,
        gid="overturned",
    )
    image = ax.pcolormesh(
        *corners, np.where(overturned, np.nan, peak), cmap="viridis", vmin=0.0, rasterized=True, gid="peak"
    )
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label(UNITS[unit], fontsize=style.SMALL, color=style.INK)
    bar.ax.tick_params(labelsize=style.SMALL)
    style.label(ax, x_label, SLENDERNESS)
    style.patches(ax, [Patch(facecolor=style.FALLEN, label="overturned")])
    return ax
