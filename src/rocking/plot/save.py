"""Figures into files: whole or not at all, and the same bytes every time."""

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from rocking.model import check_writable, replacing

# Without these matplotlib writes the date and its own version into the file.
METADATA = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}


def save(figure: Figure, path: str | Path, dpi: float = 200.0) -> Path:
    """Writes a figure as PNG, SVG or PDF; the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib Figure
        ``ax.figure`` of anything drawn here.
    path : str or Path
        Its suffix chooses the format: .png, .svg or .pdf.
    dpi : float
        Dots per inch of a PNG, and of rasterised points inside SVG and PDF.

    Returns
    -------
    Path
        The file, which appears under its name only once it is complete.

    Raises
    ------
    ValueError
        If the suffix is none of these.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rk.plot.save(rk.plot.schematic().figure, f"{folder}/block.svg").name
    'block.svg'
    """
    path = check_writable("path", path, suffixes=tuple(METADATA))
    suffix = path.suffix.lower()
    # Names inside an SVG are hashed with a salt, by default a random one.
    with replacing(path) as partial, rc_context({"svg.hashsalt": "rocking"}):
        figure.savefig(partial, format=suffix[1:], dpi=dpi, metadata=METADATA[suffix])
    return path
