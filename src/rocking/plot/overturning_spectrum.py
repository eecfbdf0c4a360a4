"""Overturning spectra: how a block ends under one pulse, and the mode of overturning."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from rocking.model.block import Block
from rocking.model.validation import Refusal, WrongType
from rocking.model.verdict import Outcome
from rocking.plot import palette
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter

if TYPE_CHECKING:
    import xarray as xr

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


def overturning_spectrum(found: xr.Dataset, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the outcomes under one pulse over frequency and amplitude, with the mode of overturning in colour.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `rocking.overturning_spectrum`, for one coefficient of restitution.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not an overturning spectrum, or an argument has the wrong type.
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
    >>> found = rk.overturning_spectrum("one-sine", **axes, restitution=0.9)
    >>> rk.plot.overturning_spectrum(found).get_ylabel()
    'amplitude $A$'
    """
    attributes = getattr(found, "attrs", {})
    if "pulse" not in attributes or any(name not in found for name in VARIABLES):
        raise WrongType("found", "be a dataset of rocking.overturning_spectrum", found)
    if found["outcome"].ndim != 2:
        raise Refusal("found", "have one coefficient of restitution", dict(found.sizes), "select one value")
    turn_across, _ = parameter("frequency", block)
    turn_up, y_label = parameter("amplitude", block)
    ax = style.own(ax, height=3.4)
    style.block_title(ax, block)
    style.note(ax, f"{attributes['pulse']}, e = {_restitution(found):.4g}")
    codes = categories(found.transpose("amplitude", "frequency"))
    ax.pcolormesh(
        turn_across(found["frequency"].values),
        turn_up(found["amplitude"].values),
        codes,
        cmap=ListedColormap([colour for _, colour in LOOKS]),
        norm=BoundaryNorm(np.arange(len(LOOKS) + 1) - 0.5, len(LOOKS)),
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


def _restitution(found: xr.Dataset) -> float:
    return float(found["restitution"] if "restitution" in found.coords else found.attrs["restitution"])


def categories(found: xr.Dataset) -> np.ndarray:
    """Return the codes of `LOOKS`, in the shape of the outcomes."""
    codes = np.where(np.isnan(found["margin"].values), STILL, ROCKS)
    overturned = found["outcome"].values == tuple(Outcome).index(Outcome.OVERTURNED)
    mode = np.clip(found["impacts_since_rest"].values, 0, 2)
    codes = np.where(overturned, OVERTURNS + mode, codes)
    return np.where(found["certified"].values == 0, UNDECIDED, codes)
