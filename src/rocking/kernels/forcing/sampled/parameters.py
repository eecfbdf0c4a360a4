"""Parameters of a system whose base acceleration is given by samples."""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.sampled.tables import Tables
from rocking.kernels.parameters import BlockParameters, Clock

# Default length of a cycle of the clock, in samples: a time within it is accurate however long the record.
CYCLE = 64


class SampledForcing(NamedTuple):
    """Base acceleration: samples times a scale, which may be negative."""

    scale: float
    tables: Tables


class SampledParameters(NamedTuple):
    """Parameters of a block with a sampled base acceleration."""

    block: BlockParameters
    forcing: SampledForcing
    clock: Clock


def sampled_parameters(
    tables: Tables,
    scale: float,
    cycle_length: float,
    restitution: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
) -> SampledParameters:
    """Return the parameters of a system with sampled forcing."""
    block = BlockParameters(float(restitution), float(brace_angle), float(brace_restitution))
    return SampledParameters(block, SampledForcing(float(scale), tables), Clock(float(cycle_length)))


@njit(**INTERNAL)
def with_run(p, run):
    """Provide ``finite.with_run``."""
    block = BlockParameters(run.restitution, p.block.brace_angle, p.block.brace_restitution)
    return SampledParameters(block, SampledForcing(run.scale, p.forcing.tables), p.clock)
