"""Colours of outcomes, of types of response and of lines: in all figures, in the explorer and in the reports.

No other file states a colour of these. An outcome or a type has the same colour everywhere, and no other meaning has that
colour. Only the scale of angles, `ANGLES`, begins with the colour of blocks that stand. Lines of data have the colours of
`SERIES`. Readers with protanopia or deuteranopia can distinguish the colours; the tests simulate both. The outcomes differ in
lightness, for print in grey, and marks or hatches support the colours.
"""

from __future__ import annotations

import numpy as np
from attrs import frozen
from matplotlib.colors import to_hex, to_rgb

from rocking.model.verdict import Kind, Verdict

REST = ("#4A4A4A",)
"""At rest, and not set in motion."""
PERIOD_1 = ("#0072B2", "#0041AF", "#519BD3")
PERIOD_1_ASYMMETRIC = ("#8CC2FD", "#6996F5", "#0025C1")
PERIOD_3 = ("#3F0A6B", "#44325D", "#25003E")
PERIOD_3_ASYMMETRIC = ("#8D5DF9", "#3D12F0", "#000089")
ODD_PERIOD = ("#5F3A12", "#6A5D44", "#ECE6D3")
ODD_PERIOD_ASYMMETRIC = ("#F5E3B8", "#956A38", "#F9FF7C")
EVEN_PERIOD = ("#81D361", "#6EB469", "#D3FF9B")
QUASI_PERIODIC = ("#009E73", "#1E3C23", "#001F19")
CHAOTIC = ("#D55E00", "#914600", "#FF8F44")
"""Shades of a type: the first one, then those of other attractors of the same type."""
OVERTURNED = ("#CCCCCC",)
UNDETERMINED = ("#F0E442",)
"""Not determined by the run, or undecided by rounding; always with a hatch or an edge."""

STANDS = "#C5DEFF"
"""Rocked without overturning; the type of response is not known."""
OVERTURNED_AFTER = ("#B789B1", "#8F5A87", "#270027")
"""Overturned after no impact, after one, and after two or more."""
UNCERTAIN = "#FF849C"
"""Inexact inputs lead to several outcomes."""
NOT_COMPUTED = "#FFFFFF"
ANGLES = (STANDS, "#738CA5", "#295273", "#00213A")
"""Largest angle of a block that stands, from 0 to the critical angle: the corners of a continuous scale."""

SERIES = ("#20466B", "#F28C00", "#008C94", "#E8274A", "#5C7C41", "#9D90FF", "#A34107", "#262626")
"""Lines and marks of data that belong together by their order alone."""
MOTION, IMPACT, BRACE = SERIES[:3]
FOLD, SYMMETRY_BREAKING, PERIOD_DOUBLING = SERIES[3], SERIES[1], SERIES[2]

INK = "#262626"
GUIDE = "#9A9A9A"
TABLE = "#CFCFCF"
BLOCK = "#E8C07D"
DARK_MOTION = "#8FB4DB"
"""Motion on a dark page."""
SELECTED = "#D81B60"
"""Selected point of a map in the explorer."""

PALER = 0.8


@frozen
class Look:
    """Appearance of a category of a map: a type of response, with the period and symmetry of a periodic response."""

    name: str
    shades: tuple[str, ...]
    marker: str
    hatch: str | None = None
    hollow: bool = False

    @property
    def colour(self) -> str:
        """Colour of the category."""
        return self.shades[0]

    def shade(self, number: int) -> str:
        """Return the colour of one of several attractors of the category, numbered from 0; those after the shades are paler."""
        times, place = divmod(number, len(self.shades))
        red, green, blue = (1.0 - (1.0 - part) * PALER**times for part in to_rgb(self.shades[place]))
        return to_hex((red, green, blue)).upper()


LOOKS = (
    Look("rest", REST, "_"),
    Look("period 1", PERIOD_1, "o"),
    Look("period 1, asymmetric", PERIOD_1_ASYMMETRIC, "o", hollow=True),
    Look("period 3", PERIOD_3, "^"),
    Look("period 3, asymmetric", PERIOD_3_ASYMMETRIC, "^", hollow=True),
    Look("period 5, 7, …", ODD_PERIOD, "p"),
    Look("5, 7, …, asymmetric", ODD_PERIOD_ASYMMETRIC, "p", hollow=True),
    Look("even period", EVEN_PERIOD, "s"),
    Look("quasi-periodic", QUASI_PERIODIC, "D"),
    Look("chaotic", CHAOTIC, "+"),
    Look("overturned", OVERTURNED, "x"),
    Look("undetermined", UNDETERMINED, "*", INK),
)
"""Categories of a map, in the order of the codes that `looks` returns."""
NONE = 255
"""Code of a point that is not yet computed."""
_OF_KIND = np.array([0, 1, 8, 9, 10, 11], np.uint8)  # in the order of `Kind`
COLOURS = {kind: LOOKS[number].colour for kind, number in zip(Kind, _OF_KIND, strict=True)}
"""Colours of the types of response; that of period 1 for periodic responses of any period."""


def looks(kind: np.ndarray, period: np.ndarray, symmetric: np.ndarray) -> np.ndarray:
    """Return the indices in `LOOKS` of the points of a map; `NONE` where `kind` holds its fill value.

    `kind`, `period` and `symmetric` are the variables `kind`, `response_period` and `symmetric` of the map.
    """
    values = np.full(kind.shape, NONE, np.uint8)
    there = kind < len(_OF_KIND)
    values[there] = _OF_KIND[kind[there]]
    periodic = kind == Kind.PERIODIC.code
    odd = np.select([period == 1, period == 3], [1, 3], 5) + (symmetric != 1)
    values[periodic] = np.where(period % 2 == 0, 7, odd)[periodic]
    return values


def look_of(verdict: Verdict) -> Look:
    """Return the category of a verdict."""
    return look_at(verdict.kind, verdict.period or 0, bool(verdict.symmetric))


def look_at(kind: Kind, period: int, symmetric: bool) -> Look:
    """Return the category of a type, with the period and symmetry of a periodic response."""
    return LOOKS[int(looks(*(np.array([value]) for value in (kind.code, period, symmetric)))[0])]
