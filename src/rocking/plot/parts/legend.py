"""Marks and hatches of the types of response, with their colours, the same in all figures and in the explorer.

Odd periods have a dark colour if the response is symmetric and a lighter tint, with a hollow mark, if it is asymmetric.
Responses of even period are always asymmetric and green.
"""

from __future__ import annotations

import numpy as np
from attrs import frozen
from matplotlib.colors import to_hex, to_rgb

from rocking.model.validation import one_of
from rocking.model.verdict import Kind, Verdict
from rocking.plot import palette
from rocking.plot.parts import style

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
    Look("rest", palette.REST, "_"),
    Look("period 1", palette.PERIOD_1, "o"),
    Look("period 1, asymmetric", palette.PERIOD_1_ASYMMETRIC, "o", hollow=True),
    Look("period 3", palette.PERIOD_3, "^"),
    Look("period 3, asymmetric", palette.PERIOD_3_ASYMMETRIC, "^", hollow=True),
    Look("period 5, 7, …", palette.ODD_PERIOD, "p"),
    Look("5, 7, …, asymmetric", palette.ODD_PERIOD_ASYMMETRIC, "p", hollow=True),
    Look("even period", palette.EVEN_PERIOD, "s"),
    Look("quasi-periodic", palette.QUASI_PERIODIC, "D"),
    Look("chaotic", palette.CHAOTIC, "+"),
    Look("overturned", palette.OVERTURNED, "x"),
    Look("undetermined", palette.UNDETERMINED, "*", style.INK),
)
"""Categories of a map, in the order of the codes that `looks` returns."""
NONE = 255
"""Code of a point that is not yet computed."""
_OF_KIND = np.array([0, 1, 8, 9, 10, 11], np.uint8)  # in the order of `Kind`
COLOURS = {kind: LOOKS[number].colour for kind, number in zip(Kind, _OF_KIND, strict=True)}
"""Colours of the types of response; that of period 1 for periodic responses of any period."""


def check_symbols(symbols: str | None) -> None:
    """Raise TypeError or ValueError for an unknown set of symbols."""
    if symbols is not None:
        one_of("symbols", symbols, ("kinds", *PAPER))


@frozen
class Symbol:
    """Symbol of the paper, with the categories that it stands for."""

    marker: str
    name: str
    looks: tuple[int, ...]


PAPER = {
    "10": (
        Symbol("o", "quasi-periodic", (8,)),
        Symbol("+", "chaotic", (9,)),
        Symbol("*", "no response", (0,)),
        Symbol("x", "overturning", (10,)),
    ),
    "11": (
        Symbol("o", "harmonic", (1, 2)),
        Symbol("+", "one-third", (3, 4)),
        Symbol("*", "no response", (0,)),
        Symbol("x", "overturning", (10,)),
    ),
    "13b": (
        Symbol("+", "chaotic", (9,)),
        Symbol("*", "harmonic", (1, 2)),
        Symbol(">", "one-third", (3, 4)),
        Symbol("s", "even-order", (7,)),
    ),
}
"""Symbols of the paper's maps, by figure; the paper changes them from figure to figure."""


def looks(kind: np.ndarray, period: np.ndarray, symmetric: np.ndarray) -> np.ndarray:
    """Return the indices in `LOOKS` of the points of a map; `NONE` where `kind` holds its fill value.

    `kind`, `period` and `symmetric` are the variables `kind`, `response_period` and `symmetric` of the map.
    """
    found = np.full(kind.shape, NONE, np.uint8)
    there = kind < len(_OF_KIND)
    found[there] = _OF_KIND[kind[there]]
    periodic = kind == Kind.PERIODIC.code
    odd = np.select([period == 1, period == 3], [1, 3], 5) + (symmetric != 1)
    found[periodic] = np.where(period % 2 == 0, 7, odd)[periodic]
    return found


def look_of(verdict: Verdict) -> Look:
    """Return the category of a verdict."""
    return look_at(verdict.kind, verdict.period or 0, bool(verdict.symmetric))


def look_at(kind: Kind, period: int, symmetric: bool) -> Look:
    """Return the category of a type, with the period and symmetry of a periodic response."""
    return LOOKS[int(looks(*(np.array([value]) for value in (kind.code, period, symmetric)))[0])]
