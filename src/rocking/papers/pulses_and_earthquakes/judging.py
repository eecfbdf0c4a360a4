"""Reasons and tolerances that several rows share."""

from __future__ import annotations

NO_RECORD = "needs a record that does not come with the package"
BEYOND = "the exact threshold lies beyond the printed pair by less than"
INTEGRATION = f"the printed numbers come from numerical integration, and {BEYOND}"
THIRD_DIGIT = 0.01
"""One unit of the last digit of Zhang & Makris (2001), whose numbers have three digits."""
IN_G = 1e-3
"""Smallest difference between two accelerations that Makris & Roussos (2000) print, in g, except in Fig. 9."""


def outside(value: float, one: float, other: float) -> float:
    """Return the distance of a value from the interval between two numbers; 0 inside."""
    low, high = sorted((one, other))
    return max(low - value, value - high, 0.0)
