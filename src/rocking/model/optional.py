"""Optional packages: the extra that installs them, and one message where they are missing."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

EXTRAS = {
    "explorer": (
        "the explorer needs Bokeh, h5netcdf, h5py and Jinja",
        ("bokeh", "h5netcdf", "h5py", "jinja2"),
    ),
    "film": ("MP4 files need imageio-ffmpeg", ("imageio_ffmpeg",)),
    "netcdf": ("netCDF files need h5netcdf and h5py", ("h5netcdf", "h5py")),
    "obspy": ("ObsPy reads more formats", ("obspy",)),
    "proof": ("proofs need python-flint", ("flint",)),
    "report": ("the report needs Jinja and WeasyPrint", ("jinja2", "weasyprint")),
    "store": ("stores need Zarr and numcodecs", ("zarr", "numcodecs")),
}
"""For each extra of pyproject.toml: what needs its packages, and their modules."""
FORMATS = {".mp4": "film", ".nc": "netcdf"}
"""Extras that write files, by the suffix of the file."""


class ExtraMissing(ImportError):
    """A package of an extra is not installed. The message is one sentence with the remedy."""


def missing_extra(extra: str) -> str:
    """Return the message for an extra of which a package is not installed; empty if all are installed.

    Examples
    --------
    >>> missing_extra("netcdf")
    ''
    """
    need, modules = EXTRAS[extra]
    if all(map(_installed, modules)):
        return ""
    return f"{need}: run pip install '.[{extra}]' in a copy of the repository"


def require_extra(extra: str) -> None:
    """Raise ExtraMissing unless all packages of an extra are installed."""
    if message := missing_extra(extra):
        raise ExtraMissing(message)


def require_format(path: Path) -> None:
    """Raise ExtraMissing if a file with this suffix needs an extra that is not installed."""
    if extra := FORMATS.get(path.suffix.lower()):
        require_extra(extra)


def _installed(module: str) -> bool:
    """Return whether a module can be imported; it is not imported."""
    if module in sys.modules:
        return sys.modules[module] is not None
    return find_spec(module) is not None
