"""How kinds of response are drawn, the same in every picture and on the page: colours, marks and hatches.

The colours are told apart by who sees no red or no green (the tests simulate both). Periods are shades of blue, even ones,
which are never symmetric, light green; what is not symmetric though its period is odd is hatched, and its marks are hollow.
"""

from __future__ import annotations

import colorsys

import numpy as np
from attrs import frozen
from matplotlib.colors import to_rgb

from rocking.model import Kind, one_of
from rocking.plot.parts import style

# Those of Okabe and Ito for what goes on moving; greys for what stands and what has fallen.
COLOURS = {
    Kind.REST: style.TABLE,
    Kind.PERIODIC: style.MOTION,
    Kind.QUASI_PERIODIC: style.BRACE,
    Kind.CHAOTIC: style.IMPACT,
    Kind.OVERTURNED: style.INK,
    Kind.UNDETERMINED: "#F0E442",
}
PALER = 0.5
THREE, ODD, EVEN = "#4170FF", "#A7C1FF", "#98ED8F"


@frozen
class Look:
    """How the points of a map are drawn that have a kind, and if they are periodic a period and a symmetry."""

    name: str
    colour: str
    marker: str
    hatch: str | None = None
    hollow: bool = False


LOOKS = (
    Look("rest", COLOURS[Kind.REST], "_"),
    Look("period 1", COLOURS[Kind.PERIODIC], "o"),
    Look("1, unsymmetric", COLOURS[Kind.PERIODIC], "o", "white", hollow=True),
    Look("period 3", THREE, "^"),
    Look("3, unsymmetric", THREE, "^", "white", hollow=True),
    Look("period 5, 7, …", ODD, "p"),
    Look("5, 7, …, unsymmetric", ODD, "p", "white", hollow=True),
    Look("even period", EVEN, "s"),
    Look("quasi-periodic", COLOURS[Kind.QUASI_PERIODIC], "D"),
    Look("chaotic", COLOURS[Kind.CHAOTIC], "+"),
    Look("overturned", COLOURS[Kind.OVERTURNED], "x"),
    Look("undetermined", COLOURS[Kind.UNDETERMINED], "*", style.INK),
)
"""Their places are the numbers that `looks` gives."""
NONE = 255
"""The number of a point that is not yet computed."""
_OF_KIND = np.array([0, 1, 8, 9, 10, 11], np.uint8)  # in the order of `Kind`


def check_symbols(symbols: str | None) -> None:
    """Raise TypeError or ValueError for a set of symbols that is unknown."""
    if symbols is not None:
        one_of("symbols", symbols, ("kinds", *PAPER))


def paler(colour: str, times: int) -> tuple[float, float, float]:
    """Another shade of a colour, for one more of its kind."""
    hue, light, saturation = colorsys.rgb_to_hls(*to_rgb(colour))
    return colorsys.hls_to_rgb(hue, 1.0 - (1.0 - light) * PALER**times, saturation)


@frozen
class Symbol:
    """A symbol of the paper, with the looks that it stands for."""

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
"""The symbols of the paper's maps, by figure: they are not the same in all of them."""


def looks(kind: np.ndarray, period: np.ndarray, symmetric: np.ndarray) -> np.ndarray:
    """The places in `LOOKS` of points of a map, from its `kind`, `response_period` and `symmetric`; `NONE` where `kind` has its fill."""
    found = np.full(kind.shape, NONE, np.uint8)
    there = kind < len(_OF_KIND)
    found[there] = _OF_KIND[kind[there]]
    periodic = kind == Kind.PERIODIC.code
    odd = np.select([period == 1, period == 3], [1, 3], 5) + (symmetric != 1)
    found[periodic] = np.where(period % 2 == 0, 7, odd)[periodic]
    return found
