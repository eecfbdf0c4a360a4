"""Verdicts of the decision cascade: response type, criterion and the associated numbers."""

import math
from enum import IntEnum
from typing import Annotated, NamedTuple, get_args

import numpy as np

from rocking.kernels.classify.periodicity import REACHED, PeriodicityCheck, constant_image, no_cycle
from rocking.kernels.classify.resets import largest_angle
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import types_of
from rocking.kernels.motion.march import OVERTURNED, RELEASED, STILL
from rocking.kernels.numerics.elementary import hypotenuse, logarithm
from rocking.kernels.orbits.floquet import multipliers
from rocking.kernels.orbits.return_map import FixedPoint

# Kind of a motion that is not classified yet.
OPEN = -1
UNKNOWN_EXPONENT = math.nan, math.nan


class Kind(IntEnum):
    """Response type."""

    REST = 0
    PERIODIC = 1
    QUASI_PERIODIC = 2
    CHAOTIC = 3
    OVERTURNED = 4
    UNDETERMINED = 5


REST, PERIODIC, QUASI_PERIODIC, CHAOTIC, OVERTURNS, UNDETERMINED = (int(kind) for kind in Kind)


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


# Fields of a verdict: the type of one, and that of its array.
Flag = Annotated[bool, np.uint8]
Byte = Annotated[int, np.uint8]
Count = Annotated[int, np.int32]
Work = Annotated[int, np.int64]
Float = Annotated[float, np.float64]


class Judgement(NamedTuple):
    """Verdict on one motion. Counts are -1 and floats NaN if not applicable."""

    kind: Byte  # ``Kind``
    ground: Byte  # ``Ground``
    period: Count  # 0 if there is none
    symmetric: Flag
    impacts: Count  # -1 if there are infinitely many or there is no orbit
    brace_hits: Count  # as for impacts
    real: Float  # Floquet multipliers of the orbit: real and imaginary part of both
    imaginary: Float
    other_real: Float
    other_imaginary: Float
    exponent: Float  # largest Lyapunov exponent, NaN if not measured
    error: Float  # standard error of the exponent
    peak: Float
    steady_peak: Float
    transient: Count  # -1 if unknown
    cycles: Count
    work: Work  # events computed
    section_time: Float  # of a state of the orbit; then its angle and velocity
    angle: Float
    velocity: Float
    residual: Float
    distance: Float
    excess: Float
    digits: Float


PYTHON_TYPES, DTYPES = zip(
    *((get_args(kind)[0], np.dtype(get_args(kind)[1])) for kind in types_of(Judgement)), strict=True
)


def arrays_of(kind, dtypes):
    """Make the named tuple that has an array (n,) for each field of another."""
    arrays = (Annotated[np.ndarray, dtype, 1] for dtype in dtypes)
    return NamedTuple("Arrays", list(zip(kind._fields, arrays, strict=True)))


class ResultArrays(arrays_of(Judgement, DTYPES)):
    """Verdicts on n points: an array (n,) for each field of ``Judgement``."""

    __slots__ = ()


def empty_results(count):
    """Return result arrays for ``count`` points."""
    return ResultArrays(*(np.zeros(count, dtype) for dtype in DTYPES))


def judgement_of(results, k):
    """Return the verdict on point k."""
    return Judgement(*(kind(values[k]) for kind, values in zip(PYTHON_TYPES, results, strict=True)))


def storing():
    """Make the kernel that writes a verdict on point k into result arrays: one statement for each field."""
    scope = {"__name__": __name__}
    lines = (f"results.{name}[k] = verdict.{name}" for name in Judgement._fields)
    exec("def store(results, k, verdict): " + "; ".join(lines), scope)
    return kernel(scope["store"])


store_result = storing()


@kernel
def pack_verdict(kind, ground, tracker, exponent, transient, check, section_time, digits):
    """Return the ``Judgement`` on a motion; ``exponent`` is a pair with its standard error."""
    progress, peak, found = tracker.progress, largest_angle(tracker), check.found
    if check.peak > peak:
        # an orbit approached from below
        peak = check.peak
    work = check.work + progress.impacts + progress.brace_hits
    orbit = check.period, check.symmetric, found.image.impacts, found.image.brace_hits
    times = transient, progress.cycle, work, section_time
    state = found.angle, found.velocity, found.residual, check.distance, check.excess
    return Judgement(
        kind,
        ground,
        *orbit,
        *multipliers(found.image.tangent),
        *exponent,
        peak,
        check.peak,
        *times,
        *state,
        digits,
    )


@kernel
def undecided(tracker):
    """Return the verdict of a motion that is not classified yet."""
    return pack_verdict(OPEN, UNWATCHED, tracker, UNKNOWN_EXPONENT, -1, no_cycle(0), 0.0, math.nan)


@kernel
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


@kernel
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


@kernel
def periodic(p, ground, tracker, check, section_time):
    """Return the verdict of a motion that has reached a periodic orbit, whose multipliers give its Lyapunov exponent."""
    real, imaginary, _, _ = multipliers(check.found.image.tangent)
    exponent = logarithm(hypotenuse(real, imaginary)) / (check.period * p.forcing.period), 0.0
    if ground == NEUTRAL_ORBIT:
        # the product of the multipliers is 1, and the tangent vectors grew no faster than linearly
        exponent = 0.0, math.nan
    transient = max(tracker.progress.cycle - check.period, 0)
    return pack_verdict(PERIODIC, ground, tracker, exponent, transient, check, section_time, math.nan)


@kernel
def torus(tracker, work, section_time, digits):
    """Return the verdict of a motion whose averages converge as on a torus."""
    none = no_cycle(work)
    return pack_verdict(QUASI_PERIODIC, TORUS, tracker, (0.0, math.nan), 0, none, section_time, digits)
