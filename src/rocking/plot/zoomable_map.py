"""Zoomable maps of any size: a pyramid of image tiles, and a page that pans and zooms them without a server."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from rocking.model.block import Block
from rocking.model.files import TILES, replacing_folder
from rocking.model.package import VERSION
from rocking.model.survey_results import ParametricMap
from rocking.model.text import percent
from rocking.plot import palette, style
from rocking.plot.axes import parameter
from rocking.plot.maps import Responses
from rocking.plot.palette import LOOKS, NONE

if TYPE_CHECKING:
    import xarray as xr

EDGE = 256
"""Dots along an edge of a tile."""
LEAST = 1e-4
"""Smallest fraction with a row in the legend."""
HATCHED = {"dark": [number for number, look in enumerate(LOOKS) if look.hatch == style.INK]}
"""Categories with stripes, by the names of the images of their masks."""


def tiles(
    result: ParametricMap | xr.Dataset | str | os.PathLike[str] | Sequence[xr.Dataset],
    folder: str | os.PathLike[str],
    block: Block | None = None,
) -> Path:
    """Write a map as image tiles, one dot per point, and a page that pans and zooms them in a browser.

    Parameters
    ----------
    result : ParametricMap, xarray.Dataset, path, or sequence of xarray.Dataset
        Map as in `parametric_map`; it need not fit in memory.
    folder : path
        New or empty folder, or a folder written by this function, which is then replaced completely.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    Path
        Path of the page, `index.html`, in the folder. The page works from the disk, without a server.

    Raises
    ------
    TypeError
        If `result` is not a map over two axes.
    ValueError
        If the folder holds other files, or `result` is not a store.
    ImportError
        If `result` is a path, and the extra ``store`` is not installed.
    OSError
        If the folder cannot be written.

    See Also
    --------
    parametric_map : Plot the map as one figure.
    rocking.parametric_map : Compute a map.

    Notes
    -----
    Each dot is a point. The coarser images hold every second, fourth, … point, without blending, so that rare points may
    appear only after zooming in. Colours and hatches are those of `parametric_map`. Images are named
    `tiles/LEVEL/ROW-COLUMN.png`; level 0 is one tile, and rows count from the top. Images with hatches have a mask.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.parametric_map(system, amplitude=np.linspace(0, 16, 20), period=np.linspace(0.2, 3, 20))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = rk.plot.tiles(result, f"{folder}/map")
    ...     sorted(path.name for path in page.parent.iterdir())
    ['index.html', 'tiles']
    """
    read = Responses(result)
    with replacing_folder("folder", folder, TILES) as partial:
        pyramid = Pyramid(partial / "tiles", read.up.size, read.across.size)
        counts = np.zeros(NONE + 1, np.int64)
        for codes in _from_the_top(read):
            counts += np.bincount(codes.ravel(), minlength=NONE + 1)
            pyramid.add(codes)
        pyramid.finish()
        (partial / TILES.page).write_text(_page(read, counts, pyramid, block), encoding="utf-8")
    return Path(folder) / TILES.page


def _from_the_top(read: Responses) -> Iterator[np.ndarray]:
    """Yield the rows of tiles in the order of an image, the largest value at the top."""
    for top in range(read.up.size, 0, -EDGE):
        yield read.rows(max(top - EDGE, 0), top)[::-1]


class Pyramid:
    """Images of all levels, written as rows arrive from the top; each level holds at most one row of tiles in memory."""

    def __init__(self, folder: Path, rows: int, columns: int) -> None:
        self.folder = folder
        self.deepest = max(-(-max(rows, columns) // EDGE) - 1, 0).bit_length()
        self.waiting: list[list[np.ndarray]] = [[] for _ in range(self.deepest + 1)]
        self.taken = [0] * (self.deepest + 1)
        self.written = [0] * (self.deepest + 1)
        self.hatched: dict[str, list[str]] = {colour: [] for colour in HATCHED}
        self.palette = [round(255 * part) for look in LOOKS for part in to_rgb(look.colour)]

    def add(self, codes: np.ndarray) -> None:
        """Add rows of the deepest level."""
        self._add(self.deepest, codes)

    def finish(self) -> None:
        """Write the remaining rows of each level."""
        for level in range(self.deepest, -1, -1):
            if self.waiting[level]:
                self._write(level, np.concatenate(self.waiting[level]))

    def _add(self, level: int, codes: np.ndarray) -> None:
        if level > 0 and len(codes):
            self._add(level - 1, codes[self.taken[level] % 2 :: 2, ::2])
        self.taken[level] += len(codes)
        self.waiting[level].append(codes)
        rows = np.concatenate(self.waiting[level])
        while len(rows) >= EDGE:
            self._write(level, rows[:EDGE])
            rows = rows[EDGE:]
        self.waiting[level] = [rows] if len(rows) else []

    def _write(self, level: int, rows: np.ndarray) -> None:
        folder = self.folder / str(level)
        folder.mkdir(parents=True, exist_ok=True)
        for column in range(-(-rows.shape[1] // EDGE)):
            part = np.ascontiguousarray(rows[:, column * EDGE : (column + 1) * EDGE])
            name = f"{level}/{self.written[level]}-{column}"
            self._image(name, part, self.palette, transparency=NONE)
            for colour, numbers in HATCHED.items():
                mask = np.isin(part, numbers)
                if mask.any():
                    self.hatched[colour].append(name)
                    self._image(f"{name}-{colour}", mask.astype(np.uint8), [0, 0, 0], transparency=0)
        self.written[level] += 1

    def _image(self, name: str, values: np.ndarray, palette: list[int], transparency: int) -> None:
        image = Image.fromarray(values)
        image.putpalette(palette + [255] * (3 * 256 - len(palette)))
        image.save(self.folder / f"{name}.png", transparency=transparency, optimize=True)


def _page(read: Responses, counts: np.ndarray, pyramid: Pyramid, block: Block | None) -> str:
    """Return the page, with its style and script inside."""
    (turn_up, up), (turn_across, across) = (parameter(name, block) for name in read.names)
    shares = counts / counts.sum()
    legend = [
        _legend_row(look.name, look.colour, look.hatch, share)
        for look, share in zip(LOOKS, shares[: len(LOOKS)], strict=True)
        if share >= LEAST
    ]
    if counts[NONE]:
        legend.append(_legend_row("not computed", palette.NOT_COMPUTED, None, shares[NONE]))
    fixed = {} if block is None else {"block": block.size}
    fixed |= {name: f"{read.attributes[name]:.6g}" for name in FIXED if name in read.attributes}
    view = {
        "edge": EDGE,
        "deepest": pyramid.deepest,
        "hatched": pyramid.hatched,
        "across": {"values": _told(turn_across(read.across)), "name": _plain(across)},
        "up": {"values": _told(turn_up(read.up)), "name": _plain(up)},
    }
    values = {
        "version": VERSION,
        "up": escape(_plain(up)),
        "across": escape(_plain(across)),
        "legend": "\n".join(legend),
        "fixed": "\n".join(
            f"    <dt>{name.replace('_', ' ')}</dt><dd>{escape(value)}</dd>" for name, value in fixed.items()
        ),
        "points": f"{read.up.size:,} × {read.across.size:,}",
        "view": json.dumps(view).replace("<", "\\u003c"),  # no text ends the element of the script
    }
    template = files("rocking.plot").joinpath("zoomable_map.html").read_text(encoding="utf-8")
    return re.sub(r"{{ (\w+) }}", lambda result: values[result[1]], template)


def _legend_row(name: str, colour: str, hatch: str | None, share: float) -> str:
    """Return a row of the legend as HTML."""
    stripes = f"repeating-linear-gradient(135deg, {hatch} 0 2px, transparent 2px 6px), " if hatch else ""
    swatch = f'<i style="background: {stripes}{colour}"></i>'
    return f"    <li>{swatch}<span>{escape(name)}</span><span>{percent(share)}</span></li>"


FIXED = (
    "amplitude", "period", "frequency", "restitution", "phase", "angle", "velocity", "brace_angle", "brace_restitution", "max_cycles",
)  # fmt: skip
TEX = {r"\tau": "τ", r"\Omega": "Ω", r"\varphi": "φ", r"\Theta": "Θ", r"\theta": "θ", r"\dot": "", r"\mathrm": "", "_0": "₀",
       "_x": "ₓ", "_{b}": "b", "$": ""}  # fmt: skip


def _plain(label: str) -> str:
    """Return a label of an axis without TeX."""
    for tex, sign in TEX.items():
        label = label.replace(tex, sign)
    return label.strip()


def _told(values: Any) -> list[float]:
    """Return values to nine digits, which keeps the page small."""
    return [float(f"{value:.9g}") for value in np.asarray(values).tolist()]
