"""Map of the ground page: ends of the motions of blocks over size and slenderness, its colours, legend and netCDF file."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from matplotlib.colors import to_hex

from rocking.explorer.fields import Span
from rocking.explorer.refinement import Measure, Picture, Results
from rocking.model.package import VERSION
from rocking.model.text import percent
from rocking.plot import palette, style
from rocking.survey.ending_measures import OVERTURNED, VARIABLES, BlockEndings

POINTS = 201
"""Points along each side of the finest map. A full block under a record takes a third of a millisecond and more."""
SHADES = 48
"""Number of colours of the largest angle of blocks that rock."""
STANDS, OVERTURNS, ROCKS = 0, 1, 2
"""Palette indices: no motion, overturning, and the first shade of rocking."""
STILL, FALLEN = palette.REST[0], palette.OVERTURNED[0]
ANGLES = [to_hex(each) for each in style.ANGLES(np.linspace(0.0, 1.0, SHADES))]
PALETTE = [STILL, FALLEN, *ANGLES]


class Endings(Measure):
    """Measure of the ends of blocks over half the diagonal R in m, spaced logarithmically, and the critical angle in degrees.

    Blocks of one size share the tables of the base motion. The results have the names of `rocking_spectrum`.
    """

    points = POINTS
    types: ClassVar[Mapping[str, type]] = {
        "outcome": np.uint8,
        "certified": np.uint8,
        "peak": np.float32,
        "margin": np.float32,
    }
    by_columns = True

    def __init__(self, sizes: Span, angles: Span, endings: BlockEndings) -> None:
        self.endings = endings
        self.sizes = np.geomspace(sizes.low, sizes.high, POINTS)
        self.angles = np.linspace(angles.low, angles.high, POINTS)

    def fine(self, columns: np.ndarray, rows: np.ndarray, stop: np.ndarray) -> Results | None:
        """Follow blocks to their ends."""
        return self.endings.at(self.sizes[columns], np.radians(self.angles[rows]), stop)


def corner(sizes: Span, angles: Span, side: int) -> dict[str, Any]:
    """Return corner and sides of the image of a grid. Its points lie at the centres of their cells, also at the edges."""
    half = (sizes.high / sizes.low) ** (0.5 / (side - 1))
    left, right = sizes.low / half, sizes.high * half
    high = angles.width / (side - 1)
    return {"x": [left], "y": [angles.low - high / 2], "w": [right - left], "h": [angles.width + high]}


def colours(picture: Picture) -> np.ndarray:
    """Return palette indices, shape (side, side)."""
    outcome, peak = picture.fields["outcome"], picture.fields["peak"]
    shade = np.clip(np.where(np.isfinite(peak), peak, 0.0) * SHADES, 0, SHADES - 1).astype(np.uint8)
    rocks = np.where(peak > 0.0, ROCKS + shade, STANDS)
    return np.where(outcome == OVERTURNED, OVERTURNS, rocks).astype(np.uint8)


def answers(picture: Picture) -> dict[str, np.ndarray]:
    """Return the results of all points for the readout and the table; flat, rows upward."""
    return {name: values.ravel() for name, values in picture.fields.items()}


def shares(picture: Picture) -> tuple[float, float, float]:
    """Return the area fractions of blocks that do not move, that rock and stand, and that overturn."""
    overturns = float(np.mean(picture.fields["outcome"] == OVERTURNED))
    stands = float(np.mean(picture.fields["peak"] == 0.0))
    return stands, 1.0 - stands - overturns, overturns


def legend(picture: Picture) -> dict[str, Any]:
    """Return the legend for the page, with area fractions."""
    stands, rocks, overturns = map(percent, shares(picture))
    undecided = float(np.mean(picture.fields["certified"] == 0))
    return {
        "stands": {"colour": STILL, "share": stands},
        "rocks": {"colours": ANGLES, "share": rocks},
        "overturns": {"colour": FALLEN, "share": overturns},
        "undecided": percent(undecided) if undecided else "",
    }


def netcdf(measure: Endings, picture: Picture, attributes: Mapping[str, Any]) -> bytes:
    """Return the netCDF file of a finished map, with the names and units of `rocking_spectrum`, and the size of each block.

    `attributes` describe the base motion and the view.
    """
    import xarray as xr

    sizes, angles = measure.sizes, np.radians(measure.angles)
    over = ("slenderness", "size")
    described = {each.name: each.attributes for each in VARIABLES}
    data = xr.Dataset(
        {name: (over, values, described[name]) for name, values in picture.fields.items()},
        {
            "size": ("size", sizes, {"long_name": "half diagonal R", "units": "m"}),
            "slenderness": ("slenderness", angles, {"long_name": "critical angle", "units": "rad"}),
            "height": (over, 2 * np.outer(np.cos(angles), sizes), {"units": "m"}),
            "width": (over, 2 * np.outer(np.sin(angles), sizes), {"units": "m"}),
        },
        {
            "Conventions": "CF-1.11",
            "title": "Ends of free-standing blocks under a base motion",
            "source": f"rocking {VERSION}",
            **attributes,
        },
    )
    target = io.BytesIO()
    data.to_netcdf(target, engine="h5netcdf")
    return target.getvalue()
