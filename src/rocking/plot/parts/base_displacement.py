"""Displacement of the base in an animation."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.forcing import Forcing, Harmonic, PiecewiseLinear, Pulse


def base_displacement(forcing: Forcing, block: Block, times: NDArray) -> tuple[NDArray, float, float | None]:
    """Return the displacement of the base under a block at times τ, in m, its largest size, and its drift.

    A harmonic base moves about the origin. Any other one moves from rest, and may not return: its displacement at the
    end is the drift.
    """
    if isinstance(forcing, Harmonic):
        stretch = block.acceleration(1.0) / (math.tau * block.hertz(forcing.frequency)) ** 2
        return -stretch * forcing.acceleration(times), forcing.amplitude * stretch, None
    if not isinstance(forcing, (PiecewiseLinear, Pulse)):
        raise TypeError(f"the displacement of a base moved by {type(forcing).__name__} is not known")
    stretch = block.acceleration(1.0) / block.frequency_parameter**2
    moved = stretch * forcing.displacement(times)
    return moved, float(np.abs(moved).max()), float(stretch * forcing.displacement(forcing.span))
