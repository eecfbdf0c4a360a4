"""Channel of a record file, and the error of a file that cannot be read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

TEXTS = "formats: PEER AT2, COSMOS, CSMIP, USC, SMC, K-NET, ESM, GeoNet, text in columns"


class RecordError(ValueError):
    """Record file that cannot be read. The message is one line and names the file and the place.

    Examples
    --------
    >>> import rocking as rk
    >>> str(rk.RecordError("a.at2, line 4: no step"))
    'a.at2, line 4: no step'
    """


class Peak(NamedTuple):
    """Peak acceleration as a header prints it, without its sign, in m/s²."""

    size: float
    rounding: float
    """Half a unit of the last printed digit."""


class Channel(NamedTuple):
    """One channel of a record file, as the file gives it."""

    samples: np.ndarray
    unit: str | None
    """One of `UNITS`; None if the file does not state it."""
    step: float | None
    """Time step in s; None if the file does not state it."""
    format: str
    name: str = ""
    component: str = ""
    peak: Peak | None = None
    named: frozenset[str] = frozenset()
    """Units of acceleration that the header states, also where several leave the unit open."""
    mentioned: frozenset[str] = frozenset()
    """Units of acceleration that other words of the header mention."""
    lacking: str = ""
    """Sentence on the missing line that would state the unit; empty if no line is missing."""
