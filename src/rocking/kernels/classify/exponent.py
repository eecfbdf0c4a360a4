"""Lyapunov exponent from batches of the second half of the budget, and the evidence of chaos at its end."""

import math
from typing import NamedTuple

from rocking.kernels.classify.periodicity import no_cycle
from rocking.kernels.classify.resets import begin_tangent, released_since
from rocking.kernels.classify.torus import CHAOTIC_DIGITS
from rocking.kernels.classify.verdict import (
    BETWEEN,
    CHAOTIC,
    CORRELATED,
    EXPONENT,
    INDISTINCT,
    LINGERING,
    LITTLE_GROWTH,
    STANDING,
    UNDETERMINED,
    UNWATCHED,
    pack_verdict,
)
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.tangent import read_tangent, write_registers
from rocking.kernels.numerics.averages import batch_error

# Number of equal parts of the second half of the budget over which the exponent is measured.
BATCHES = 64
CLEARLY = 6.0  # standard errors
CHAOS_NEEDS = 10_000
CHAOS_NEEDS_WITH_BRACES = 100_000
# Rounding keeps a motion about 2**-53 away from an unstable orbit. While the motion leaves that orbit,
# tangent vectors grow steadily by 2**53 at most, and the exponent of that seems certain. Chaos requires
# growth beyond this logarithm.
FAR = 40.0
# Maximum ratio of the variance of the mean to that of independent batches.
MAX_CORRELATION = 4.0


class Batches(NamedTuple):
    """Batches over which the Lyapunov exponent is measured."""

    end: int  # cycle at which the present batch ends
    measured: int  # number of batches measured
    grown: float  # logarithm of the growth before the present one


class Findings(NamedTuple):
    """Findings at the end of the budget about a motion without a verdict."""

    measured: int  # number of batches over which the exponent is measured
    lossless: bool
    digits: float  # to which averages agree
    stands: bool  # on an unstable orbit
    lingers: bool  # the motion stays near an unstable orbit


@kernel(inline=True)
def batch_of(max_cycles):
    """Return the number of cycles of one batch of the Lyapunov exponent."""
    return max_cycles // (2 * BATCHES)


@kernel(inline=True)
def over_batch(p, tracker, target, max_cycles, grown):
    """Return the Lyapunov exponent over the batch that ends at ``target``.

    The tangent vector has ``grown`` by this logarithm in the batch. A release in it erases all perturbations.
    """
    batch = batch_of(max_cycles)
    return (-math.inf if released_since(tracker, target - batch) else grown) / (batch * p.forcing.period)


@kernel
def begin_measuring(tracker, tangent):
    """Measure the growth of the first tangent vector from here on, including its growth since the last release."""
    if tracker.progress.mode == FLIGHT and (tracker.base.seen or tracker.brace.seen):
        tangent.growth[:] = 0.0
        write_registers(read_tangent(tangent.columns), tangent)
    else:
        begin_tangent(tangent)


@kernel
def unsettled(p, tracker, work, max_cycles, batches, findings):
    """Return the verdict at the end of the budget: chaotic if all conditions hold, else undetermined.

    The exponent is clearly positive; over the batches the tangent vectors grew far; the batches are
    independent. The motion neither stays on an unstable orbit nor lingers near one.
    """
    mean, error, correlation = math.nan, math.nan, math.nan
    if findings.measured == BATCHES:
        mean, error, correlation = batch_error(batches)
    needed = CHAOS_NEEDS if p.block.brace_angle == math.inf else CHAOS_NEEDS_WITH_BRACES
    kind, ground = UNDETERMINED, EXPONENT
    if max_cycles < needed:
        ground = UNWATCHED
    elif findings.lossless and findings.digits >= CHAOTIC_DIGITS:
        ground = BETWEEN
    elif not (0.0 < error < math.inf and mean >= CLEARLY * error):
        ground = INDISTINCT
    elif findings.stands:
        ground = STANDING
    elif findings.lingers:
        ground = LINGERING
    elif mean * (batch_of(max_cycles) * p.forcing.period) * BATCHES < FAR:
        ground = LITTLE_GROWTH
    elif correlation > MAX_CORRELATION:
        ground = CORRELATED
    else:
        kind = CHAOTIC
    return pack_verdict(kind, ground, tracker, (mean, error), -1, no_cycle(work), 0.0, findings.digits)
