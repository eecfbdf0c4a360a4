"""Plots of rocking spectra and of overturning spectra."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model.block import Block
from rocking.model.record_results import named_levels
from rocking.model.record_set import measure_named
from rocking.model.survey_results import OverturningSpectrum, RockingSpectrum, check_survey
from rocking.model.text import counted
from rocking.model.validation import Refusal, WrongType, one_of
from rocking.model.verdict import Outcome
from rocking.plot import palette, style
from rocking.plot.axes import parameter
from rocking.plot.maps import edges
from rocking.plot.spectra import Line, lines_of, overturned_runs, value
from rocking.plot.style import shortened

if TYPE_CHECKING:
    import xarray as xr


ACROSS = {
    "size": "half the diagonal, $R$ (m)",
    "frequency-parameter": r"frequency parameter $\alpha$ (1/s)",
    "period": r"$2\pi/\alpha$ (s)",
}
"""Units of the horizontal axis that stand for the size."""
UNITS = {
    "critical": r"largest angle $|\theta|/\theta_\mathrm{cr}$",
    "degrees": r"largest angle $|\theta|$ (°)",
}
SLENDERNESS = r"critical angle $\theta_\mathrm{cr}$ (°)"
LINES = ("record", "size", "slenderness")
COLOURS = palette.SERIES
"""Colours of lines with a name in the legend; more lines have the colour of their slenderness."""
MOST_SLENDERNESSES = 6
"""Most critical angles of which each has lines; more give a map."""
TOP = 0.25
"""Largest part of the axes above the lines, for the marks of overturned blocks."""
ROW = 0.055
LONGEST = 28
"""Longest name of a line in a legend of two columns; TeX counts as its characters."""


def rocking_spectrum(
    result: RockingSpectrum | xr.Dataset,
    ax: Axes | None = None,
    *,
    across: str = "size",
    unit: str = "critical",
) -> Axes:
    r"""Plot the largest angle over the size or the slenderness of the block.

    There is one line per record and slenderness. A strip above the lines has a mark where the block overturns, one row per
    line. Open circles mark outcomes that rounding may have changed. More than eight lines are thin. A thick one then
    shows the median over the records: the smallest peak that at least half of them do not exceed. It ends where more than
    half overturn the block. Size and more than six slendernesses give a map.

    Parameters
    ----------
    result : RockingSpectrum or xarray.Dataset
        Result of `rocking.rocking_spectrum` over records, size and slenderness, or its dataset. Select one value of other dimensions
        first: ``result.dataset.sel(level=1)``.
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
        If `result` is not a rocking spectrum, or an argument has the wrong type.
    ValueError
        If `result` varies over another quantity, or over several records as a map, or if an argument is unknown.

    See Also
    --------
    rocking.rocking_spectrum : Compute the spectrum.
    overview : Plot one of its motions.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> strong = rk.example_ground_motion().scaled(5)
    >>> result = rk.rocking_spectrum(strong, size=np.linspace(0.5, 4, 30), slenderness=[0.15, 0.2])
    >>> rk.plot.rocking_spectrum(result, across="period").get_xlabel()
    '$2\\pi/\\alpha$ (s)'
    """
    across, unit = one_of("across", across, tuple(ACROSS)), one_of("unit", unit, tuple(UNITS))
    data = result.dataset if isinstance(result, RockingSpectrum) else result
    _check(data)
    dims = data.peak.dims
    if "slenderness" in dims and "size" in dims and data.sizes["slenderness"] > MOST_SLENDERNESSES:
        return _map(data, ax, across, unit)
    name = "size" if "size" in dims else "slenderness"
    places, x_label = _axis(data, name, across)
    lines = list(lines_of(data, name, unit))
    named = len(lines) <= len(COLOURS)
    groups = {line.slenderness_number: line.slenderness for line in lines}
    ax = style.own(ax, height=2.6 + 0.16 * -(-len(lines if named else groups) // 2))
    ends = [line.peak[np.isfinite(line.peak)].max(initial=0.0) for line in lines]
    room = min(TOP, ROW * len(lines))
    top = max(*ends, 1e-9) / (0.97 - room)
    for number, line in enumerate(lines):
        height = top * (1.0 - room * (number + 0.5) / len(lines))
        colour = COLOURS[number if named else line.slenderness_number]
        _draw(ax, places, line, colour, height, many=not named)
    if not named:
        for group in groups:
            _draw_median(
                ax, places, [line for line in lines if line.slenderness_number == group], COLOURS[group]
            )
    _head(ax, data)
    style.label(ax, x_label, UNITS[unit])
    ax.set_ylim(0.0, top)
    if any(line.overturned.any() for line in lines):
        _strip(ax, top * (1.0 - room), top)
    _key(ax, lines, None if named else groups)
    return ax


def _head(ax: Axes, data: xr.Dataset) -> None:
    """Write the record or the number of records above the axes, and the slenderness and the level that do not vary."""
    if "record" in data.dims:
        heading = counted(data.sizes["record"], "record")
    else:
        heading = shortened(str(data["name"].values) if "name" in data.coords else data.attrs["record"], 30)
    style.title(ax, heading + f"\n{style.FULL_EQUATION}" * (data.attrs.get("model") == "full"))
    constants = []
    if "slenderness" not in data.dims:
        constants.append(rf"$\theta_\mathrm{{cr}}$ = {np.degrees(float(value(data, 'slenderness'))):.3g}°")
    level = float(value(data, "level")) if "level" in {**data.coords, **data.attrs} else 1.0
    if level != 1.0:
        known = measure_named(data.attrs["intensity"])
        unit = "" if known is None or known[0].unit == "1" else f" {known[0].unit}"
        symbol = data.attrs["intensity"] if known is None else known[0].symbol
        constants.append(f"{symbol} = {level:g}{unit}")
    style.note(ax, ", ".join(constants))


def _strip(ax: Axes, bottom: float, top: float) -> None:
    """Set the strip of the marks of overturned blocks apart from the axis of the angle."""
    ax.axhspan(bottom, top, color=palette.OVERTURNED[0], alpha=0.4, linewidth=0, zorder=0, gid="strip")
    ax.set_yticks([tick for tick in ax.get_yticks() if 0.0 <= tick <= bottom])


def _draw_median(ax: Axes, places: np.ndarray, lines: list[Line], colour: str) -> None:
    """Draw the median over the lines of one slenderness, as far as at most half of the blocks overturn."""
    peaks = np.array([np.where(line.overturned, np.inf, line.peak) for line in lines])
    middle = np.quantile(peaks, 0.5, axis=0, method="inverted_cdf")
    ax.plot(
        places,
        np.where(np.isinf(middle), np.nan, middle),
        color=colour,
        linewidth=1.6 * style.LINE,
        gid="median",
        zorder=3,
    )


def _check(data: Any) -> None:
    """Raise TypeError or ValueError for a dataset that is no rocking spectrum over its axes."""
    import xarray as xr

    if not isinstance(data, xr.Dataset) or not {"peak", "outcome", "certified"} <= set(data.data_vars):
        raise WrongType("result", "be a rocking spectrum, as rocking.rocking_spectrum gives it", data)
    named_levels(data, "result")
    peak = data.peak
    others = [str(name) for name in peak.dims if name not in LINES]
    if others:
        remedy = f"select one value first, such as result.dataset.isel({others[0]}=0)"
        allowed = "vary over records, size and slenderness alone"
        raise Refusal("result", allowed, ", ".join(others), remedy)
    if not {"size", "slenderness"} & set(peak.dims):
        raise Refusal("result", "vary over size or slenderness", tuple(map(str, peak.dims)))


def _axis(data: xr.Dataset, name: str, across: str) -> tuple[np.ndarray, str]:
    """Return the values of the horizontal axis, and its label."""
    if name == "slenderness":
        return np.degrees(data[name].values), SLENDERNESS
    if across == "size":
        return data[name].values, ACROSS[across]
    alpha = data["frequency_parameter"].values
    return (alpha if across == "frequency-parameter" else math.tau / alpha), ACROSS[across]


def _draw(ax: Axes, places: np.ndarray, line: Line, colour: str, height: float, *, many: bool) -> None:
    """Draw a line, the marks above it, and the open circles of undecided outcomes."""
    size = style.point_size(max(places.size, 30))
    ax.plot(
        places,
        line.peak,
        color=colour,
        linewidth=style.THIN if many else style.LINE,
        alpha=0.35 if many else 1.0,
        marker="none" if many else ".",
        markersize=size,
        gid="peak",
    )
    ax.plot(
        places[line.overturned],
        np.full(int(line.overturned.sum()), height),
        color=colour,
        linestyle="none",
        marker="s" if many else "x",
        markersize=1.2 if many else min(style.MARK, 1.6 * size),
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


def _key(ax: Axes, lines: list[Line], groups: dict[int, str] | None) -> None:
    """Draw the legend: the lines, or one record and the median of each group; the crosses and circles that are there."""
    if groups is None:
        names = [line.name for line in lines]
        handles = [
            Line2D([], [], color=colour, linewidth=style.LINE, label=name)
            for name, colour in zip(names, COLOURS, strict=False)
        ]
    else:
        names = ["one record", *(f"median, {name}" if name else "median" for name in groups.values())]
        handles = [Line2D([], [], color=COLOURS[0], alpha=0.35, linewidth=style.THIN, label=names[0])]
        handles += [
            Line2D([], [], color=COLOURS[group], linewidth=1.6 * style.LINE, label=name)
            for group, name in zip(groups, names[1:], strict=True)
        ]
    looks: dict[str, Any] = {"linestyle": "none", "color": style.INK, "markersize": style.MARK}
    if any(line.overturned.any() for line in lines):
        names.append("overturned")
        marks = looks if groups is None else {**looks, "markersize": 2.0}
        handles.append(Line2D([], [], marker="x" if groups is None else "s", label=names[-1], **marks))
    if not all(line.certified.all() for line in lines):
        names.append("undecided by rounding")
        handles.append(Line2D([], [], marker="o", markerfacecolor="none", label=names[-1], **looks))
    style.patches(ax, handles, columns=1 if max(map(len, names)) > LONGEST else 2)


def _map(data: xr.Dataset, ax: Axes | None, across: str, unit: str) -> Axes:
    """Draw the largest angle over size and slenderness."""
    if "record" in data.peak.dims:
        remedy = "select one first, such as result.dataset.isel(record=0)"
        count = counted(data.sizes["record"], "record")
        raise Refusal("result", "hold one record to be a map", count, remedy)
    places, x_label = _axis(data, "size", across)
    angles = np.degrees(data["slenderness"].values)
    peak = data.peak.transpose("slenderness", "size").values
    if unit == "degrees":
        peak = peak * angles[:, None]
    overturned = overturned_runs(data).transpose("slenderness", "size").values
    ax = style.own(ax, height=3.0)
    corners = edges(places), edges(angles)
    still = peak == 0.0
    ends = [(overturned, palette.OVERTURNED[0], "overturned"), (still, palette.REST[0], "no motion")]
    for where, colour, name in ends:
        ax.pcolormesh(
            *corners, np.where(where, 1.0, np.nan), cmap=ListedColormap([colour]), rasterized=True, gid=name
        )
    image = ax.pcolormesh(
        *corners,
        np.where(overturned | still, np.nan, peak),
        cmap=style.ANGLES,
        vmin=0.0,
        rasterized=True,
        gid="peak",
    )
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label(UNITS[unit], fontsize=style.SMALL, color=style.INK)
    bar.ax.tick_params(labelsize=style.SMALL)
    _head(ax, data)
    style.label(ax, x_label, SLENDERNESS)
    style.patches(ax, [Patch(facecolor=colour, label=name) for where, colour, name in ends if where.any()])
    return ax


LOOKS = (
    ("no motion", palette.REST[0]),
    ("stands", palette.STANDS),
    ("falls, no impact", palette.OVERTURNED_AFTER[0]),
    ("falls, 1 impact", palette.OVERTURNED_AFTER[1]),
    ("falls, 2 or more impacts", palette.OVERTURNED_AFTER[2]),
    ("undecided", palette.UNDETERMINED[0]),
)
"""Names and colours of the categories, in the order of the codes that `categories` returns."""
STILL, ROCKS, OVERTURNS, UNDECIDED = 0, 1, 2, 5
VARIABLES = ("outcome", "certified", "margin", "impacts_since_rest")
LABELS = {False: r"frequency of the pulse $\Omega = \omega/\alpha$", True: "frequency of the pulse (Hz)"}


def overturning_spectrum(
    result: OverturningSpectrum | xr.Dataset, ax: Axes | None = None, block: Block | None = None
) -> Axes:
    """Plot the outcomes under one pulse over frequency and amplitude, with the mode of overturning in colour.

    Parameters
    ----------
    result : OverturningSpectrum or xarray.Dataset
        Result of `rocking.overturning_spectrum`, or its dataset, for one coefficient of restitution.
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
        If `result` is not an overturning spectrum, or an argument has the wrong type.
    ValueError
        If the coefficient of restitution varies.

    See Also
    --------
    overturning_set : Plot the levels at which records overturn a block.
    rocking.overturning_spectrum : Compute the spectrum.

    Notes
    -----
    Impacts are counted since the block last rested.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> axes = {"amplitude": np.linspace(1, 10, 40), "frequency": np.linspace(1, 8, 40)}
    >>> system = rk.System(rk.Pulse("one-sine", amplitude=5.0, duration=1.0), restitution=0.9)
    >>> result = rk.overturning_spectrum(system, **axes)
    >>> rk.plot.overturning_spectrum(result).get_ylabel()
    'amplitude $A$'
    """
    data = result.dataset if isinstance(result, OverturningSpectrum) else result
    allowed = "be an overturning spectrum, as rocking.overturning_spectrum gives it"
    attributes = check_survey("result", data, allowed, VARIABLES).attrs
    if "pulse" not in attributes:
        raise WrongType("result", allowed, result)
    if data["outcome"].ndim != 2:
        raise Refusal("result", "have one coefficient of restitution", dict(data.sizes), "select one value")
    turn_across, _ = parameter("frequency", block)
    turn_up, y_label = parameter("amplitude", block)
    ax = style.own(ax, height=3.4)
    style.block_title(ax, block)
    style.note(ax, f"{attributes['pulse']}, e = {_restitution(data):.4g}")
    codes = categories(data.transpose("amplitude", "frequency"))
    ax.pcolormesh(
        turn_across(data["frequency"].values),
        turn_up(data["amplitude"].values),
        codes,
        **style.coded([colour for _, colour in LOOKS]),
        shading="nearest",
        rasterized=True,
        gid="outcomes",
    )
    style.label(ax, LABELS[block is not None], y_label)
    there = np.unique(codes).tolist()
    style.patches(
        ax,
        [Patch(facecolor=LOOKS[k][1], edgecolor=style.INK, linewidth=0.4, label=LOOKS[k][0]) for k in there],
    )
    return ax


def _restitution(data: xr.Dataset) -> float:
    return float(data["restitution"] if "restitution" in data.coords else data.attrs["restitution"])


def categories(data: xr.Dataset) -> np.ndarray:
    """Return the codes of `LOOKS`, in the shape of the outcomes."""
    codes = np.where(np.isnan(data["margin"].values), STILL, ROCKS)
    overturned = data["outcome"].values == tuple(Outcome).index(Outcome.OVERTURNED)
    mode = np.clip(data["impacts_since_rest"].values, 0, 2)
    codes = np.where(overturned, OVERTURNS + mode, codes)
    return np.where(data["certified"].values == 0, UNDECIDED, codes)
