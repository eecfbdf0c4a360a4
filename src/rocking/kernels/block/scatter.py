"""Scatter of the coefficient of restitution from impact to impact, for the full block: e(v) + s z, within [0, 1].

The deviation z of an impact is a function of integers alone: the stream of the run, the number of rests so far, and the number of
impacts since the last one. So it does not depend on rounding, on the order of runs, nor on whether chattering is cut short. The
integers are mixed by the output function of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
"""

from rocking.kernels import contract
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import Full, FullBlock, Restrained, Scatter

# Largest |z| of the normal distribution, which is truncated there.
TRUNCATION = 3.0
# Attempts at a deviation of the normal distribution. One in 2.4 succeeds; that all fail has the probability 1e-15.
ATTEMPTS = 64
# Constants of SplitMix64, as signed integers.
GAMMA = 0x9E3779B97F4A7C15 - 2**64
FIRST = 0xBF58476D1CE4E5B9 - 2**64
SECOND = 0x94D049BB133111EB - 2**64
# A place is the number of rests so far times 2**32, plus the number of impacts since the last rest.
RESTS = 32
UNIT = 2.0**-53

with_offset = replacing(Scatter, "offset")
with_scatter = replacing(FullBlock, "scatter")
with_block, with_restrained_block = replacing(Full, "block"), replacing(Restrained, "block")


@kernel(inline=True)
def shifted(n, places):
    """Return an integer of 64 bits shifted right, with zeros from the left."""
    return (n >> places) & ((1 << (64 - places)) - 1)


@kernel(inline=True)
def mixed(n):
    """Return the output function of SplitMix64, a permutation of the integers of 64 bits."""
    n = (n ^ shifted(n, 30)) * FIRST
    n = (n ^ shifted(n, 27)) * SECOND
    return n ^ shifted(n, 31)


@kernel(inline=True)
def uniform(key, k):
    """Return the k-th number of a key, uniform in (0, 1)."""
    return (shifted(mixed(key + GAMMA * k), 11) + 0.5) * UNIT


@kernel(seldom=True)
def deviation_at(stream, place, even):
    """Return z at a place of a stream: uniform in (-1, 1) if ``even``, or standard normal, truncated at +-TRUNCATION.

    The normal one is found by rejection (von Neumann 1951).
    """
    key = mixed(mixed(stream) + GAMMA * (place + 1))
    if even:
        return 2.0 * uniform(key, 1) - 1.0
    for k in range(ATTEMPTS):
        z = TRUNCATION * (2.0 * uniform(key, 2 * k + 1) - 1.0)
        if uniform(key, 2 * k + 2) < exponential(-0.5 * z * z):
            return z
    return 0.0


@kernel(inline=True)
def block_at(block, place):
    """Return a full block with the offset of the coming impact."""
    scatter = block.scatter
    offset = 0.0
    if scatter.deviation > 0.0:
        offset = scatter.deviation * deviation_at(scatter.stream, place, scatter.uniform)
    return with_scatter(block, with_offset(scatter, offset))


@body(contract.at_impact, Full, inline=True)
def at_impact(p, place):
    """Provide ``contract.at_impact``."""
    return with_block(p, block_at(p.block, place))


@body(contract.at_impact, Restrained, inline=True)
def restrained_at_impact(p, place):
    """Provide ``contract.at_impact``."""
    return with_restrained_block(p, block_at(p.block, place))


@body(contract.is_scattered, Full, inline=True)
def is_scattered(p):
    """Provide ``contract.is_scattered``."""
    return p.block.scatter.deviation > 0.0


@kernel(inline=True)
def next_place(place, hits, rests):
    """Return the place of the next impact after an event, which is an impact if ``hits``, and after which the block may rest."""
    if rests:
        return ((place >> RESTS) + 1) << RESTS
    return place + hits


@kernel(inline=True)
def largest_offset(p):
    """Return the largest offset of the coefficient of restitution."""
    scatter = p.block.scatter
    return scatter.deviation * (1.0 if scatter.uniform else TRUNCATION)
