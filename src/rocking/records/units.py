"""Units of acceleration, and their spellings in files and arguments."""

from __future__ import annotations

import re

from rocking.model import GRAVITY, refusal

UNITS = {"m/s²": 1.0, "cm/s²": 0.01, "mm/s²": 0.001, "g": GRAVITY, "g/10": GRAVITY / 10}
"""Size of each unit of acceleration, in m/s²."""
SPELLINGS = {
    "m/s2": "m/s²",
    "ms-2": "m/s²",
    "cm/s2": "cm/s²",
    "cms-2": "cm/s²",
    "gal": "cm/s²",
    "gals": "cm/s²",
    "mm/s2": "mm/s²",
    "mms-2": "mm/s²",
    "g": "g",
    "g/10": "g/10",
}
"""Spellings of the units, in lower case and after `_plain`."""
CHOICES = "be one of 'm/s²', 'cm/s²', 'mm/s²', 'g', 'gal'"


def _plain(text: str) -> str:
    """Return a spelling without blanks, powers and long seconds: CM/SEC/SEC → cm/s2."""
    text = re.sub(r"[\s^*]", "", text.lower()).rstrip(".").replace("²", "2").replace("−", "-")
    return text.replace("sec", "s").replace("cms/", "cm/").replace("/s/s", "/s2")


def unit_of(text: str) -> str | None:
    """Return the unit of acceleration that a text names; None if it is unknown.

    Examples
    --------
    >>> unit_of("CM/SEC/SEC"), unit_of("Gal"), unit_of("m/s**2"), unit_of("cm/s")
    ('cm/s²', 'cm/s²', 'm/s²', None)
    """
    return SPELLINGS.get(_plain(text))


def given_unit(units: str) -> str:
    """Return the unit that the argument `units` names; TypeError or ValueError for anything else."""
    if not isinstance(units, str):
        raise TypeError(refusal("units", CHOICES, units))
    found = unit_of(units)
    if found is None:
        raise ValueError(refusal("units", CHOICES, units))
    return found
