"""Figures as files: written completely or not at all, and with reproducible bytes."""

import os
from collections.abc import Sequence
from pathlib import Path

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking.model.files import check_writable, replacing
from rocking.model.validation import WrongType, within

# Without these matplotlib writes the date and its own version into the file.
METADATA = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}


def save(figure: Figure | Axes, path: str | Path, dpi: float = 200.0) -> Path:
    """Write a figure as PNG, SVG or PDF; the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib Figure or Axes
        Figure to write. For axes, the whole figure that contains them.
    path : str or Path
        Path of the file; the suffix selects the format: .png, .svg or .pdf.
    dpi : float
        Resolution of a PNG, and of rasterised points inside SVG and PDF, in dots per inch, in [10, 2400]. Default: 200.

    Returns
    -------
    Path
        Path of the file, which exists only once it is complete.

    Raises
    ------
    TypeError
        If `figure` is neither a Figure nor Axes, or `path` is not a path.
    ValueError
        If the suffix of `path` is not supported, or `dpi` lies outside its range.
    OSError
        If `path` cannot be written.

    See Also
    --------
    panels : Make a figure.
    animation : Write an animation.

    Notes
    -----
    The figure stays open. A notebook shows it, too.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rk.plot.save(rk.plot.schematic(), f"{folder}/block.svg").name
    'block.svg'
    """
    drawn = figure.figure if isinstance(figure, Axes) else figure
    if not isinstance(drawn, Figure):
        raise WrongType("figure", "be a matplotlib Figure or Axes", figure)
    dpi = within("dpi", dpi, 10.0, 2400.0)
    path = check_path(path, tuple(METADATA))
    suffix = path.suffix.lower()
    # Names inside an SVG are hashed with a salt, by default a random one.
    with replacing(path) as partial, rc_context({"svg.hashsalt": "rocking"}):
        drawn.savefig(partial, format=suffix[1:], dpi=dpi, metadata=METADATA[suffix])
    return path


def check_path(path: str | Path, suffixes: Sequence[str]) -> Path:
    """Return `path` if it can be written and has one of these suffixes; raise before any computation otherwise."""
    if not isinstance(path, str | os.PathLike):
        raise WrongType("path", f"be the name of a file that ends in {', '.join(suffixes)}", path)
    return check_writable("path", path, suffixes)
