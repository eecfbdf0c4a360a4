"""The answers of the cascade: what a response is, on which ground, and the numbers that go with it."""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from .averages import batch_error
from .cycle import REACHED, Cycle, no_cycle
from .desk import BATCHES
from .elementary import WITHIN
from .lossless import CHAOTIC_DIGITS
from .march import OVERTURNED, RELEASED, STILL
from .orbit import Found, multipliers
from .release import largest_angle

CLEARLY = 6.0  # standard errors
CHAOS_NEEDS = 10_000
CHAOS_NEEDS_WITH_BRACES = 100_000


class Kind(IntEnum):
    """What a response is."""

    REST = 0
    PERIODIC = 1
    QUASI_PERIODIC = 2
    CHAOTIC = 3
    OVERTURNED = 4
    UNDETERMINED = 5


REST, PERIODIC, QUASI_PERIODIC, CHAOTIC, OVERTURNS, UNDETERMINED = (int(kind) for kind in Kind)
# The kind of a motion that nothing decides yet.
OPEN = -1


class Ground(IntEnum):
    """Which evidence decided, or why none did."""

    NO_RETURN = 0
    STILL_FOR_EVER = 1
    RESET = 2
    ORBIT = 3
    NEUTRAL_ORBIT = 4
    TORUS = 5
    EXPONENT = 6
    UNRESOLVED_RESET = 7
    UNWATCHED = 8  # too few cycles to call anything chaotic
    INDISTINCT = 9  # the exponent is not clearly positive
    BETWEEN = 10  # averages agree too well for chaos, too badly for a torus
    CROWDED = 11
    STANDING = 12  # on an unstable orbit, to within rounding


(
    NO_RETURN, STILL_FOR_EVER, RESET, ORBIT, NEUTRAL_ORBIT, TORUS, EXPONENT, UNRESOLVED_RESET, UNWATCHED,
    INDISTINCT, BETWEEN, CROWDED, STANDING,
) = (int(ground) for ground in Ground)  # fmt: skip


class Judgement(NamedTuple):
    """What Python is told, flat; counts are -1 and numbers NaN where they do not apply."""

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
    digits: float


@njit(**WITHIN)
def judged(kind, ground, watch, work, exponent, error, transient, cycle, section_time, digits):
    """A judgement as nested numbers: what a kernel hands to Python."""
    progress, peak = watch.progress, largest_angle(watch)
    real, imaginary, other_real, other_imaginary = multipliers(cycle.found.image.tangent)
    if cycle.peak > peak:
        # an orbit approached from below
        peak = cycle.peak
    return (
        kind,
        ground,
        cycle.period,
        cycle.symmetric,
        cycle.found.image.impacts,
        cycle.found.image.brace_hits,
        real,
        imaginary,
        other_real,
        other_imaginary,
        exponent,
        error,
        peak,
        cycle.peak,
        transient,
        progress.cycle,
        work + progress.impacts + progress.brace_hits,
        section_time,
        cycle.found.angle,
        cycle.found.velocity,
        cycle.found.residual,
        cycle.distance,
        digits,
    )


@njit(**WITHIN)
def undecided(watch):
    """No judgement yet."""
    return judged(OPEN, UNWATCHED, watch, 0, math.nan, math.nan, -1, no_cycle(0), 0.0, math.nan)


@njit(**WITHIN)
def ended(status, watch, work):
    """The judgement of a motion whose end is proved, by no return, rest for ever or a release like an earlier one, or too dear."""
    progress, none = watch.progress, no_cycle(work)
    if status == OVERTURNED:
        return judged(
            OVERTURNS, NO_RETURN, watch, work, math.nan, math.nan, progress.cycle, none, 0.0, math.nan
        )
    if status == STILL:
        return judged(REST, STILL_FOR_EVER, watch, work, -math.inf, 0.0, progress.cycle, none, 0.0, math.nan)
    if status == RELEASED and watch.half_periods > 0:
        return released(watch, work)
    ground = UNRESOLVED_RESET if status == RELEASED else CROWDED
    return judged(UNDETERMINED, ground, watch, work, math.nan, math.nan, -1, none, 0.0, math.nan)


@njit(**WITHIN)
def released(watch, work):
    """The judgement of a motion that was released as it was before: superstable, and symmetric after an odd number of half cycles."""
    half_periods, arc = watch.half_periods, watch.progress.arc
    symmetric = half_periods % 2 == 1
    period = half_periods if symmetric else half_periods // 2
    forgets = no_cycle(0).found.image
    release = Found(True, arc.side * arc.angle, 0.0, forgets, 0.0, 0.0, 0)
    orbit = Cycle(REACHED, period, symmetric, release, watch.orbit_peak, 0.0, 0, 0)
    transient = max(watch.progress.cycle - (half_periods + 1) // 2, 0)
    return judged(PERIODIC, RESET, watch, work, -math.inf, 0.0, transient, orbit, arc.start, math.nan)


@njit(**WITHIN)
def periodic(p, ground, watch, work, cycle, section_time):
    """The judgement of a motion on a periodic orbit."""
    real, imaginary, _, _ = multipliers(cycle.found.image.tangent)
    exponent, error = math.log(math.hypot(real, imaginary)) / (cycle.period * p.period), 0.0
    if ground == NEUTRAL_ORBIT:
        # the multipliers' product is 1, and differences were seen to grow no faster than linearly
        exponent, error = 0.0, math.nan
    transient = max(watch.progress.cycle - cycle.period, 0)
    return judged(PERIODIC, ground, watch, work, exponent, error, transient, cycle, section_time, math.nan)


@njit(**WITHIN)
def torus(watch, work, section_time, digits):
    """The judgement of a motion whose averages converge as on a torus."""
    return judged(QUASI_PERIODIC, TORUS, watch, work, 0.0, math.nan, 0, no_cycle(work), section_time, digits)


@njit(**WITHIN)
def unsettled(p, watch, work, max_cycles, measured, lossless, digits, batches, stands):
    """The judgement at the end of the budget: chaotic if the exponent is clearly positive, else undetermined."""
    mean, error = batch_error(batches) if measured == BATCHES else (math.nan, math.nan)
    needed = CHAOS_NEEDS if p.brace_angle == math.inf else CHAOS_NEEDS_WITH_BRACES
    kind, ground = UNDETERMINED, INDISTINCT
    if max_cycles < needed:
        ground = UNWATCHED
    elif lossless and digits >= CHAOTIC_DIGITS:
        ground = BETWEEN
    elif 0.0 < error < math.inf and mean >= CLEARLY * error:
        # Where differences grow and the motion stays, it balances on what repels it.
        kind, ground = (UNDETERMINED, STANDING) if stands else (CHAOTIC, EXPONENT)
    return judged(kind, ground, watch, work, mean, error, -1, no_cycle(work), 0.0, digits)
