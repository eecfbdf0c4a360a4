"""Where the block's corners are, for the pictures that show the block itself."""

import numpy as np
from numpy.typing import NDArray


def corners(height: float, width: float, angle: float) -> NDArray:
    """Corners of a block that leans by `angle` (rad, clockwise positive), (4, 2): foot left O', foot right O, top right, top left.

    The origin is the middle of its foot at rest. Positive angles turn it about its right corner O, negative ones about
    the left one O' (eqs. 1a, 1b of Yim and Lin 1991).
    """
    upright = np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])
    pivot = upright[1] if angle >= 0 else upright[0]
    cosine, sine = np.cos(angle), np.sin(angle)
    return pivot + (upright - pivot) @ np.array([[cosine, -sine], [sine, cosine]])
