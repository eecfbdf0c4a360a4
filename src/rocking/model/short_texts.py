"""Short texts of values and paths, for messages."""

from __future__ import annotations

import os
import reprlib

import numpy as np

MAX_SHOWN_LENGTH = 60
MAX_SHOWN_PATH = 120
_SHORT = reprlib.Repr()
_SHORT.maxlist = _SHORT.maxtuple = _SHORT.maxset = _SHORT.maxfrozenset = _SHORT.maxdict = MAX_SHOWN_LENGTH
_SHORT.maxarray = _SHORT.maxdeque = MAX_SHOWN_LENGTH
_SHORT.maxstring = _SHORT.maxlong = _SHORT.maxother = 4 * MAX_SHOWN_PATH
"""Texts of values, in bounded time, also of a list that contains itself and of an object whose `repr` fails."""


def shown(value: object) -> str:
    """Return a value as one short line, with NumPy numbers as plain numbers."""
    if isinstance(value, np.generic):
        value = value.item()
    try:
        text = " ".join(_SHORT.repr(value).split())
    except ValueError:  # an int with more digits than Python converts to text
        text = "a number with too many digits"
    return text if len(text) <= MAX_SHOWN_LENGTH else text[: MAX_SHOWN_LENGTH - 1] + "…"


def shown_path(path: str | os.PathLike[str]) -> str:
    """Return a path in quotation marks, without its middle if it is long."""
    return both_ends(repr(os.fspath(path)))


def both_ends(text: str) -> str:
    """Return a text on one line, without its middle if it is long."""
    line, half = " ".join(text.split()), MAX_SHOWN_PATH // 2
    return line if len(line) <= MAX_SHOWN_PATH else f"{line[:half]}…{line[-half:]}"
