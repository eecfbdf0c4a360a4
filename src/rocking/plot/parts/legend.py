"""Colours, marks and hatches of the types of response, the same in all figures and in the explorer.

Readers with protanopia or deuteranopia can distinguish the colours (the tests simulate both). Odd periods have a dark
colour if the response is symmetric and a lighter tint, with a hollow mark, if it is asymmetric. Responses of even period
are always asymmetric and green.
"""

from __future__ import annotations

import colorsys

import numpy as np
from attrs import frozen
from matplotlib.colors import to_rgb

from rocking.model import Kind, one_of
from rocking.plot.parts import style

# Colours of Okabe and Ito for bounded motions; dark grey for rest, light grey for overturning.
COLOURS = {
    Kind.REST: "#4A4A4A",
    Kind.PERIODIC: style.MOTION,
    Kind.QUASI_PERIODIC: style.BRACE,
    Kind.CHAOTIC: style.IMPACT,
    Kind.OVERTURNED: style.FALLEN,
    Kind.UNDETERMINED: "#F0E442",
}
PALER = 0.5
ONE_ASYMMETRIC = "#8CC2FD"
THREE, THREE_ASYMMETRIC = "#3F0A6B", "#8D5DF9"
ODD, ODD_ASYMMETRIC = "#5F3A12", "#F5E3B8"
EVEN = "#81D361"


@frozen
class Look:
    """Appearance of a category of a map: a type of response, with the period and symmetry of a periodic response."""

    name: str
    colour: str
    marker: str
    hatch: str | None = None
    hollow: bool = False


LOOKS = (
    Look("rest", COLOURS[Kind.REST], "_"),
    Look("period 1", COLOURS[Kind.PERIODIC], "o"),
    Look("period 1, asymmetric", ONE_ASYMMETRIC, "o", hollow=True),
    Look("period 3", THREE, "^"),
    Look("period 3, asymmetric", THREE_ASYMMETRIC, "^", hollow=True),
    Look("period 5, 7, …", ODD, "p"),
    Look("5, 7, …, asymmetric", ODD_ASYMMETRIC, "p", hollow=True),
    Look("even period", EVEN, "s"),
    Look("quasi-periodic", COLOURS[Kind.QUASI_PERIODIC], "D"),
    Look("chaotic", COLOURS[Kind.CHAOTIC], "+"),
    Look("overturned", COLOURS[Kind.OVERTURNED], "x"),
    Look("undetermined", COLOURS[Kind.UNDETERMINED], "*", style.INK),
)
"""Categories of a map, in the order of the codes that `looks` returns."""
NONE = 255
"""Code of a point that is not yet computed."""
_OF_KIND = np.array([0, 1, 8, 9, 10, 11], np.uint8)  # in the order of `Kind`


def check_symbols(symbols: str | None) -> None:
    """Raise TypeError or ValueError for an unknown set of symbols."""
    if symbols is not None:
        one_of("symbols", symbols, ("kinds", *PAPER))


def paler(colour: str, times: int) -> tuple[float, float, float]:
    """Return a paler shade of a colour, for a further member of its class."""
    hue, light, saturation = colorsys.rgb_to_hls(*to_rgb(colour))
    return colorsys.hls_to_rgb(hue, 1.0 - (1.0 - light) * PALER**times, saturation)


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
