"""Scatter of the coefficient of restitution as the page on restitution states it, in integers of any size."""

import math


def splitmix64(number):
    """Return the output function of SplitMix64 in integers of any size (Steele, Lea & Flood 2014)."""
    number = ((number ^ (number >> 30)) * 0xBF58476D1CE4E5B9) % 2**64
    number = ((number ^ (number >> 27)) * 0x94D049BB133111EB) % 2**64
    return number ^ (number >> 31)


def deviation(stream, rests, impacts, *, even):
    """Return z of an impact as the page on restitution states it."""
    gamma = 0x9E3779B97F4A7C15
    key = splitmix64((splitmix64(stream % 2**64) + gamma * (2**32 * rests + impacts + 1)) % 2**64)
    draws = [((splitmix64((key + gamma * k) % 2**64) >> 11) + 0.5) / 2**53 for k in range(1, 129)]
    if even:
        return 2.0 * draws[0] - 1.0
    tried = ((3.0 * (2.0 * one - 1.0), other) for one, other in zip(draws[::2], draws[1::2], strict=True))
    return next(z for z, other in tried if other < math.exp(-0.5 * z * z))
