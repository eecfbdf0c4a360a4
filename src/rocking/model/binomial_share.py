"""Shares of a whole, known from counts, with their intervals."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.validation import refusal

LEVEL = 0.95
"""How often an interval covers what it is of, about."""


def wilson(count: Any, of: Any) -> tuple[Any, Any]:
    """The 95 % interval of a share of which `count` in `of` independent trials were seen; arrays broadcast.

    Parameters
    ----------
    count, of : int or array
        Successes and trials; (0, 1) without any trial.

    Returns
    -------
    tuple
        (low, high): (p + z²/2n ± z √(p(1 − p)/n + z²/4n²))/(1 + z²/n), the shares that a test of level 5 % does not
        reject.

    References
    ----------
    Wilson, J. Am. Stat. Assoc. 22, 209–212 (1927).

    Examples
    --------
    >>> low, high = wilson(0, 100)
    >>> low, round(high, 4)
    (0.0, 0.037)
    """
    z = NormalDist().inv_cdf(0.5 + 0.5 * LEVEL)
    seen, trials = np.asarray(count, float), np.asarray(of, float)
    whole = trials + z * z
    middle = (seen + 0.5 * z * z) / whole
    half = z / whole * np.sqrt(seen * (trials - seen) / np.maximum(trials, 1.0) + 0.25 * z * z)
    # where all or none were seen the formula's end is exact but for its rounding
    low = np.where(seen == 0.0, 0.0, np.maximum(middle - half, 0.0))
    high = np.where(seen == trials, 1.0, np.minimum(middle + half, 1.0))
    return (low.item(), high.item()) if low.ndim == 0 else (low, high)


@frozen
class Share:
    """A share known from a count, with its interval.

    Attributes
    ----------
    count, of : int
        How many of how many.
    unknown : int
        Of how many of the others it is not known whether they belong to it. The lower end of the interval counts none of
        them, the upper end all of them: they widen it upwards.

    Examples
    --------
    >>> print(Share(567, 3000))
    18.9 % (17.5–20.3 %)
    >>> print(Share(567, 3000, unknown=300))
    18.9 % (17.5–30.5 %)
    >>> print(Share(3000, 3000))
    100 % (99.9–100 %)
    """

    count: int = field(converter=int)
    of: int = field(converter=int)
    unknown: int = field(default=0, converter=int)

    def __attrs_post_init__(self) -> None:
        if min(self.count, self.of, self.unknown) < 0 or self.count + self.unknown > self.of:
            told = (self.count, self.of, self.unknown)
            raise ValueError(
                refusal("count, of and unknown", "be at least 0, and count + unknown at most of", told)
            )

    @property
    def value(self) -> float:
        """count/of; NaN of none."""
        return self.count / self.of if self.of else float("nan")

    @property
    def low(self) -> float:
        """Lower end of its 95 % interval, Wilson's, if nothing that is unknown belongs to it."""
        return wilson(self.count, self.of)[0]

    @property
    def high(self) -> float:
        """Upper end of it, if all that is unknown belongs to it."""
        return wilson(self.count + self.unknown, self.of)[1]

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{_percent(self.value)} % ({_percent(self.low)}–{_percent(self.high)} %)"


def _percent(share: float) -> str:
    """To a tenth of a percent, and finer where a share is nearer to none or to all; 0 and 100 are exact."""
    value = 100.0 * share
    if value in (0.0, 100.0):
        return f"{value:.0f}"
    if value > 99.9:
        return f"{value:.{1 - math.floor(math.log10(100.0 - value))}f}"
    return f"{value:.2g}" if value < 0.1 else f"{value:.1f}"
