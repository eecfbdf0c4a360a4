"""Arrays inside frozen values."""

from __future__ import annotations

from functools import partial
from typing import Any

import attrs
import numpy as np


def read_only(array: np.ndarray) -> np.ndarray:
    """Return an array, which from now on refuses to be written to."""
    array.flags.writeable = False
    return array


class ReadOnlyArrays:
    """A frozen value whose arrays are `read_only` also in its copies and in other processes."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        # NumPy makes an array writeable that it copies or unpickles: only the constructor makes it read-only again
        fields = attrs.fields(type(self))  # type: ignore[arg-type]  # every subclass is an attrs class
        return partial(type(self), **{each.alias: getattr(self, each.name) for each in fields}), ()
