"""Fractions estimated from counts, with confidence intervals."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import starmap
from statistics import NormalDist
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.validation import Refusal, whole

LEVEL = 0.95
"""Confidence level of the intervals."""
MAX_COUNT = 10**15


def wilson(count: Any, of: Any) -> tuple[Any, Any]:
    """Return the 95 % confidence interval of a fraction, Wilson's.

    The interval ``(p + z²/2n ± z √(p(1 − p)/n + z²/4n²))/(1 + z²/n)``, with p = `count`/n and n = `of`, contains the
    fractions that a test of level 5 % does not reject.

    Parameters
    ----------
    count, of : int or array
        Numbers of successes and of independent trials. Arrays broadcast.

    Returns
    -------
    low, high : float or ndarray
        Ends of the interval; 0 and 1 without any trial.

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
    # With no success or no failure, one end is exactly 0 or 1. The formula gives it with a rounding error.
    low = np.where(seen == 0.0, 0.0, np.maximum(middle - half, 0.0))
    high = np.where(seen == trials, 1.0, np.minimum(middle + half, 1.0))
    return (low.item(), high.item()) if low.ndim == 0 else (low, high)


def _count(value: Any) -> int:
    return whole("count", value, 0, MAX_COUNT)


def _of(value: Any) -> int:
    return whole("of", value, 0, MAX_COUNT)


def _unknown(value: Any) -> int:
    return whole("unknown", value, 0, MAX_COUNT)


@frozen
class Share:
    """Fraction estimated from a count, with its 95 % confidence interval.

    Attributes
    ----------
    count, of : int
        Number of members and total number.
    unknown : int
        Number of undetermined cases, which may or may not be members. The lower end of the interval counts none of
        them and the upper end counts all of them. Default: 0.
    value, low, high : float
        Fraction `count/of` and the ends of its interval.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a number is negative or not whole, or `count + unknown` exceeds `of`.

    Examples
    --------
    >>> print(Share(567, 3000))
    18.9 % (17.5–20.3 %)
    >>> print(Share(567, 3000, unknown=300))
    18.9 % (17.5–30.5 %)
    >>> print(Share(3000, 3000))
    100 % (99.9–100 %)
    """

    count: int = field(converter=_count)
    of: int = field(converter=_of)
    unknown: int = field(default=0, converter=_unknown)

    def __attrs_post_init__(self) -> None:
        if self.count + self.unknown > self.of:
            raise Refusal("count + unknown", f"be at most of = {self.of}", self.count + self.unknown)

    @property
    def value(self) -> float:
        """Fraction `count/of`; NaN if `of` is 0."""
        return self.count / self.of if self.of else float("nan")

    @property
    def low(self) -> float:
        """Lower end of the 95 % Wilson interval, with no undetermined case counted."""
        return wilson(self.count, self.of)[0]

    @property
    def high(self) -> float:
        """Upper end of the 95 % Wilson interval, with all undetermined cases counted."""
        return wilson(self.count + self.unknown, self.of)[1]

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{_percent(self.value)} % ({_percent(self.low)}–{_percent(self.high)} %)"


def shares_of(count: Any, of: Any, unknown: Any = 0) -> tuple[Share, ...]:
    """Return the fractions of arrays (n,) of counts, total numbers and numbers of undetermined cases, which broadcast."""
    rows = np.broadcast_arrays(np.atleast_1d(count), of, unknown)
    return tuple(starmap(Share, np.stack(rows, axis=1).tolist()))


def interval_variables(
    along: str, shares: Iterable[Share], name: str, meaning: str
) -> dict[str, tuple[str, Any, dict[str, str]]]:
    """Return fractions along a dimension as three variables of a dataset: the fraction and both ends of its interval."""
    texts = {
        "": meaning,
        "_low": f"{meaning}, lower end of its 95 % interval",
        "_high": f"{meaning}, upper end of its 95 % interval",
    }
    columns = np.array([(each.value, each.low, each.high) for each in shares]).T
    return {
        name + end: (along, column, {"long_name": text, "units": "1"})
        for (end, text), column in zip(texts.items(), columns, strict=True)
    }


SHARE_TEXTS = {
    "fraction": "fraction",
    "low": "lower end of its 95 % interval",
    "high": "upper end of its 95 % interval",
    "count": "number of members",
    "of": "total number",
    "unknown": "number of undetermined cases, which may or may not be members",
}


def share_variables(along: str, shares: Iterable[Share]) -> dict[str, tuple[str, Any, dict[str, str]]]:
    """Return fractions with their intervals and counts as variables of a dataset, whose names begin with that of the dimension."""
    rows = [(each.value, each.low, each.high, each.count, each.of, each.unknown) for each in shares]
    return {
        f"{along}_{name}": (along, list(column), {"long_name": text, "units": "1"})
        for (name, text), column in zip(SHARE_TEXTS.items(), zip(*rows, strict=True), strict=True)
    }


def _percent(share: float) -> str:
    """Format a fraction in per cent to one decimal, and finer near 0 and 100; only exact values print as 0 or 100."""
    value = 100.0 * share
    if value in (0.0, 100.0):
        return f"{value:.0f}"
    if value > 99.9:
        return f"{value:.{1 - math.floor(math.log10(100.0 - value))}f}"
    return f"{value:.2g}" if value < 0.1 else f"{value:.1f}"
