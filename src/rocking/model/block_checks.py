"""Checks of the arguments of a block."""

from __future__ import annotations

from collections.abc import Iterator

from rocking.model.validation import within

SIZES = (1e-3, 1e3)
LOWEST, LARGEST = 0.01, 100.0
"""Smallest height, and largest height or width, in m, without a warning."""
INERTIA_RATIOS = (1.0, 10.0)
RECTANGLE = 4 / 3


def height(value: float) -> float:
    """Return the height in m, after checking."""
    return within("height", value, *SIZES, unit="m")


def width(value: float) -> float:
    """Return the width in m, after checking."""
    return within("width", value, *SIZES, unit="m")


def restitution(value: float | None) -> float | None:
    """Return the coefficient of restitution, after checking."""
    return None if value is None else within("restitution", value, 0, 1)


def inertia_ratio(value: float) -> float:
    """Return the inertia ratio, after checking."""
    return within("inertia_ratio", value, *INERTIA_RATIOS)


def size_doubts(height: float, width: float) -> Iterator[str]:
    """Yield a sentence for each size in m that is probably in another unit."""
    for name, size, least in (("height", height, LOWEST), ("width", width, 0.0)):
        if not least <= size <= LARGEST:
            yield f"{name} {size:.4g} m is unusual: sizes are in metres"
