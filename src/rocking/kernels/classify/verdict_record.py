"""Verdicts of the decision cascade: response type, criterion and the associated numbers."""

import math
from enum import IntEnum
from typing import NamedTuple

from rocking.kernels.classify.classifier_state import batch_of
from rocking.kernels.classify.periodicity import REACHED, PeriodicityCheck, constant_image, no_cycle
from rocking.kernels.classify.quasi_periodicity import CHAOTIC_DIGITS
from rocking.kernels.classify.reset import largest_angle
from rocking.kernels.classify.workspace import BATCHES
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.march.march import OVERTURNED, RELEASED, STILL
from rocking.kernels.numerics.averages import batch_error
from rocking.kernels.orbits.fixed_point import FixedPoint
from rocking.kernels.orbits.floquet import multipliers

CLEARLY = 6.0  # standard errors
CHAOS_NEEDS = 10_000
CHAOS_NEEDS_WITH_BRACES = 100_000
# Rounding keeps a motion about 2**-53 away from an unstable orbit. While the motion leaves that orbit,
# tangent vectors grow steadily by 2**53 at most, and the exponent of that seems certain. Chaos requires
# growth beyond this logarithm.
FAR = 40.0
# Maximum ratio of the variance of the mean to that of independent batches.
MAX_CORRELATION = 4.0


class Kind(IntEnum):
    """Response type."""

    REST = 0
    PERIODIC = 1
    QUASI_PERIODIC = 2
    CHAOTIC = 3
    OVERTURNED = 4
    UNDETERMINED = 5


REST, PERIODIC, QUASI_PERIODIC, CHAOTIC, OVERTURNS, UNDETERMINED = (int(kind) for kind in Kind)
# Kind of a motion that is not classified yet.
OPEN = -1


class Ground(IntEnum):
    """Criterion that decided, or reason why none did."""

    NO_RETURN = 0
    STILL_FOR_EVER = 1
    RESET = 2
    ORBIT = 3
    NEUTRAL_ORBIT = 4
    TORUS = 5
    EXPONENT = 6
    UNRESOLVED_RESET = 7
    UNWATCHED = 8  # too few cycles for the evidence of chaos
    INDISTINCT = 9  # the exponent is not clearly positive
    BETWEEN = 10  # averages agree too well for chaos, not well enough for a torus
    CROWDED = 11
    STANDING = 12  # on an unstable orbit, to within rounding
    LITTLE_GROWTH = 13  # tangent vectors grew no more than while a motion leaves an unstable orbit
    CORRELATED = 14  # the batches of the exponent depend on each other
    LINGERING = 15  # near an unstable orbit


(
    NO_RETURN, STILL_FOR_EVER, RESET, ORBIT, NEUTRAL_ORBIT, TORUS, EXPONENT, UNRESOLVED_RESET, UNWATCHED,
    INDISTINCT, BETWEEN, CROWDED, STANDING, LITTLE_GROWTH, CORRELATED, LINGERING,
) = (int(ground) for ground in Ground)  # fmt: skip


# On these grounds the exponent of an undetermined motion is reported.
WEIGHED = (INDISTINCT, LITTLE_GROWTH, CORRELATED, LINGERING)


class Judgement(NamedTuple):
    """Flat classification result. Counts are -1 and floats NaN if not applicable."""

    kind: int
    ground: int
    period: int
    symmetric: bool
    impacts: int
    brace_hits: int
    real: float
    imaginary: float
    other_real: float
    other_imaginary: float
    exponent: float
    error: float
    peak: float
    steady_peak: float
    transient: int
    cycles: int
    work: int
    section_time: float
    angle: float
    velocity: float
    residual: float
    distance: float
    excess: float
    digits: float


class Findings(NamedTuple):
    """Findings at the end of the budget about a motion without a verdict."""

    measured: int  # number of batches over which the exponent is measured
    lossless: bool
    digits: float  # to which averages agree
    stands: bool  # on an unstable orbit
    lingers: bool  # the motion stays near an unstable orbit


UNKNOWN_EXPONENT = math.nan, math.nan


@njit(**INTERNAL)
def pack_verdict(kind, ground, tracker, exponent, transient, check, section_time, digits):
    """Return the flat verdict, in the order of ``Judgement``; ``exponent`` is a pair with its standard error."""
    progress, peak, found = tracker.progress, largest_angle(tracker), check.found
    real, imaginary, other_real, other_imaginary = multipliers(found.image.tangent)
    if check.peak > peak:
        # an orbit approached from below
        peak = check.peak
    return (
        kind,
        ground,
        check.period,
        check.symmetric,
        found.image.impacts,
        found.image.brace_hits,
        real,
        imaginary,
        other_real,
        other_imaginary,
        exponent[0],
        exponent[1],
        peak,
        check.peak,
        transient,
        progress.cycle,
        check.work + progress.impacts + progress.brace_hits,
        section_time,
        found.angle,
        found.velocity,
        found.residual,
        check.distance,
        check.excess,
        digits,
    )


@njit(**INTERNAL)
def undecided(tracker):
    """Return the verdict of a motion that is not classified yet."""
    return pack_verdict(OPEN, UNWATCHED, tracker, UNKNOWN_EXPONENT, -1, no_cycle(0), 0.0, math.nan)


@njit(**INTERNAL)
def ended(status, tracker, work):
    """Return the verdict of a run that stopped early: overturned, at rest, periodic by reset, or crowded.

    A crowded run has too many events.
    """
    cycle, none = tracker.progress.cycle, no_cycle(work)
    if status == OVERTURNED:
        return pack_verdict(OVERTURNS, NO_RETURN, tracker, UNKNOWN_EXPONENT, cycle, none, 0.0, math.nan)
    if status == STILL:
        return pack_verdict(REST, STILL_FOR_EVER, tracker, (-math.inf, 0.0), cycle, none, 0.0, math.nan)
    if status == RELEASED and tracker.half_periods > 0:
        return released(tracker, work)
    ground = UNRESOLVED_RESET if status == RELEASED else CROWDED
    return pack_verdict(UNDETERMINED, ground, tracker, UNKNOWN_EXPONENT, -1, none, 0.0, math.nan)


@njit(**INTERNAL)
def released(tracker, work):
    """Return the verdict of a motion that was released from the same state as before: a superstable orbit.

    The orbit is symmetric if the number of half cycles between the releases is odd: then they are half a
    period apart.
    """
    half_periods, arc = tracker.half_periods, tracker.progress.arc
    symmetric = half_periods % 2 == 1
    period, halves = (half_periods, 2) if symmetric else (half_periods // 2, 1)
    impacts = halves * tracker.impacts if tracker.impacts >= 0 else -1
    brace_hits = halves * tracker.brace_hits if tracker.brace_hits >= 0 else -1
    image = constant_image(impacts, brace_hits)
    release = FixedPoint(True, arc.side * arc.angle, 0.0, image, 0.0, 0.0, 0)
    orbit = PeriodicityCheck(REACHED, period, symmetric, release, tracker.orbit_peak, 0.0, math.nan, 0, work)
    transient = max(tracker.progress.cycle - (half_periods + 1) // 2, 0)
    return pack_verdict(PERIODIC, RESET, tracker, (-math.inf, 0.0), transient, orbit, arc.start, math.nan)


@njit(**INTERNAL)
def periodic(p, ground, tracker, check, section_time):
    """Return the verdict of a motion that has reached a periodic orbit."""
    real, imaginary, _, _ = multipliers(check.found.image.tangent)
    exponent = math.log(math.hypot(real, imaginary)) / (check.period * p.forcing.period), 0.0
    if ground == NEUTRAL_ORBIT:
        # the product of the multipliers is 1, and the tangent vectors grew no faster than linearly
        exponent = 0.0, math.nan
    transient = max(tracker.progress.cycle - check.period, 0)
    return pack_verdict(PERIODIC, ground, tracker, exponent, transient, check, section_time, math.nan)


@njit(**INTERNAL)
def torus(tracker, work, section_time, digits):
    """Return the verdict of a motion whose averages converge as on a torus."""
    none = no_cycle(work)
    return pack_verdict(QUASI_PERIODIC, TORUS, tracker, (0.0, math.nan), 0, none, section_time, digits)


@njit(**INTERNAL)
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
