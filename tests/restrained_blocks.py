"""Restrained blocks by the ratios of their restrainers."""

import math

GRAVITY = 9.80665


def restrained(block, kappa, rho, mass=500.0):
    """Return a block with the ratios of a restrainer."""
    lever = block.width / 2 * math.sin(math.atan2(block.width, block.height))
    return block.restrained(kappa * mass * GRAVITY / lever, rho * mass * GRAVITY, mass=mass)
