"""Arrays inside frozen values."""

from __future__ import annotations

import numpy as np


def read_only(array: np.ndarray) -> np.ndarray:
    """Return an array, which from now on refuses to be written to."""
    array.flags.writeable = False
    return array
