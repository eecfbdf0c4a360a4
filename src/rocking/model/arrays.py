"""Read-only arrays of frozen values, also in copies and in other processes."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any

import attrs
import numpy as np

from rocking.model.validation import WrongType


def read_only(array: np.ndarray) -> np.ndarray:
    """Make an array read-only and return it; TypeError for anything else."""
    if not isinstance(array, np.ndarray):
        raise WrongType("an array of a result", "be a NumPy array", array)
    array.flags.writeable = False
    return array


def nan_if_none(values: Iterable[float | None]) -> np.ndarray:
    """Return numbers as an array, NaN where there is none."""
    return np.array([np.nan if value is None else value for value in values], float)


class ReadOnlyArrays:
    """Base class of frozen values whose arrays stay `read_only` in copies and in other processes."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        # A copied or unpickled NumPy array is writeable. Only the constructor makes it read-only again.
        fields = attrs.fields(type(self))  # type: ignore[arg-type]  # every subclass is an attrs class
        return partial(type(self), **{each.alias: getattr(self, each.name) for each in fields}), ()
