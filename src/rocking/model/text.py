"""Text of counts, measured numbers, values and paths in all printed results and messages."""

from __future__ import annotations

import math
import os
import reprlib
from collections.abc import Sequence

import numpy as np

# Number of significant decimal digits of double precision.
MAX_DECIMALS = 15


def counted(number: int, thing: str) -> str:
    """Format a number with its noun: 1 impact, 2 impacts, 1,000 impacts.

    Examples
    --------
    >>> counted(1, "impact"), counted(1000, "brace impact")
    ('1 impact', '1,000 brace impacts')
    """
    return f"{number:,} {thing}{'s' * (number != 1)}"


def ordinal(number: int) -> str:
    """Format an ordinal number: 1st, 2nd, 3rd, 4th.

    Examples
    --------
    >>> [ordinal(number) for number in (1, 2, 13, 101)]
    ['1st', '2nd', '13th', '101st']
    """
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def plus_minus(value: float, error: float) -> str:
    """Format a number with its error, to the second digit of the error.

    Examples
    --------
    >>> plus_minus(0.53412, 0.00351), plus_minus(0.25, math.inf), plus_minus(-0.0779, 0.0)
    ('0.5341 ± 0.0035', '0.25 (error unknown)', '-0.0779')
    """
    if not math.isfinite(value):
        return "−∞" if value < 0.0 else str(value)
    if math.isinf(error):
        return f"{value:.3g} (error unknown)"
    if error < 10.0**-MAX_DECIMALS:
        return f"{value:.{MAX_DECIMALS}g}"
    places = min(max(1 - math.floor(math.log10(error)), 0), MAX_DECIMALS)
    return f"{value:.{places}f} ± {error:.{places}f}"


def percent(share: float) -> str:
    """Format a fraction in per cent, to three digits or one decimal; only exact values print as 0 % or 100 %.

    Examples
    --------
    >>> [percent(share) for share in (0, 0.00001, 0.00123, 0.4705, 0.99999, 1)]
    ['0 %', '< 0.01 %', '0.12 %', '47.0 %', '> 99.9 %', '100 %']
    """
    if share in (0.0, 1.0):
        return f"{100.0 * share:.0f} %"
    if share < 0.0001:
        return "< 0.01 %"
    if share > 0.999:
        return "> 99.9 %"
    return f"{100.0 * share:.2f} %" if share < 0.01 else f"{100.0 * share:.1f} %"


def percent_with_ends(share: float, low: float, high: float) -> str:
    """Format a fraction and the ends of its interval in per cent.

    Examples
    --------
    >>> percent_with_ends(0.189, 0.175, 0.203), percent_with_ends(0.0, 0.0, 0.00004)
    ('18.9 % (17.5–20.3 %)', '0 % (0–< 0.01 %)')
    """
    return f"{percent(share)} ({percent(low).removesuffix(' %')}–{percent(high)})"


def listed(names: Sequence[str], most: int = 3) -> str:
    """Return names with semicolons, because a name may hold a comma; the first `most` of them.

    Examples
    --------
    >>> listed(["a", "b"]), listed(list("abcd"))
    ('a; b', 'a; b; c; …')
    """
    return "; ".join(names[:most]) + "; …" * (len(names) > most)


MAX_SHOWN_LENGTH = 60
MAX_SHOWN_PATH = 120
_SHORT = reprlib.Repr()
_SHORT.maxlist = _SHORT.maxtuple = _SHORT.maxset = _SHORT.maxfrozenset = _SHORT.maxdict = MAX_SHOWN_LENGTH
_SHORT.maxarray = _SHORT.maxdeque = MAX_SHOWN_LENGTH
_SHORT.maxstring = _SHORT.maxlong = _SHORT.maxother = 4 * MAX_SHOWN_PATH
"""Texts of values, in bounded time, also of a list that contains itself and of an object whose `repr` fails."""


def formatted(value: object) -> str:
    """Return a value as one short line, with NumPy numbers as plain numbers."""
    if isinstance(value, np.generic):
        value = value.item()
    try:
        text = " ".join(_SHORT.repr(value).split())
    except ValueError:  # an int with more digits than Python converts to text
        text = "a number with too many digits"
    return text if len(text) <= MAX_SHOWN_LENGTH else text[: MAX_SHOWN_LENGTH - 1] + "…"


def formatted_path(path: str | os.PathLike[str]) -> str:
    """Return a path in quotation marks, without its middle if it is long."""
    return both_ends(repr(os.fspath(path)))


def both_ends(text: str) -> str:
    """Return a text on one line, without its middle if it is long."""
    line, half = " ".join(text.split()), MAX_SHOWN_PATH // 2
    return line if len(line) <= MAX_SHOWN_PATH else f"{line[:half]}…{line[-half:]}"
