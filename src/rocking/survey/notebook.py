"""Display of maps in notebooks, although maps are plain xarray datasets."""

from __future__ import annotations

import sys
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING

from rocking.model import result
from rocking.model.text import percent
from rocking.survey.export import counts

if TYPE_CHECKING:
    import xarray as xr


def register() -> None:
    """Register the display of maps if IPython runs; other datasets keep their display."""
    notebook = sys.modules.get("IPython")
    shell = notebook.get_ipython() if notebook is not None else None
    if shell is not None:
        shell.display_formatter.formatters["text/html"].for_type_by_name(
            "xarray.core.dataset", "Dataset", html
        )


def html(found: xr.Dataset) -> str:
    """Return the HTML of a dataset; a map begins with its plot and a summary."""
    shown = found._repr_html_()
    if (
        getattr(found, "kind", None) is None
        or found["kind"].ndim != 2
        or "flag_meanings" not in found["kind"].attrs
    ):
        return shown
    return result.html(partial(import_module("rocking.plot").parametric_map, found), line(found)) + shown


def line(found: xr.Dataset) -> str:
    """Return a map in one line: its size and the fractions of the response types.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> line(rk.parametric_map(amplitude=[0.5, 2.0], period=np.linspace(0.8, 1.2, 5), restitution=0.9))
    'map of 2 × 5 points: rest 50.0 %, periodic 50.0 %'
    """
    size = " × ".join(f"{count:,}" for count in found["kind"].shape)
    there = {kind: count for kind, count in counts(found, "kind").items() if count}
    total = sum(there.values())
    shares = ", ".join(f"{kind} {percent(count / total)}" for kind, count in there.items())
    return f"map of {size} points: {shares or 'none computed yet'}"
