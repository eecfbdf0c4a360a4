"""A motion under classification, and what is known of it between two checkpoints."""

from typing import NamedTuple

from numba import njit

from rocking.kernels.classify.periodicity import PeriodicityCheck, no_cycle
from rocking.kernels.classify.quasi_periodicity import MIN_FLIGHTS, Flights, no_flights
from rocking.kernels.classify.reset import ResetTracker, watched
from rocking.kernels.classify.workspace import BATCHES
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.march.march import UNKNOWN, begin

FIRST_CHECKPOINT = 14
FIRST_SECTION = 0.3819660112501051  # of a period


class Run(NamedTuple):
    """A motion under way."""

    watch: ResetTracker
    flights: Flights
    section_time: float  # of the section, within a cycle
    count: int  # rows kept of it
    lossless: bool
    measuring: bool


class ClassifierState(NamedTuple):
    """A motion and what is known of it when it is looked at, between two legs."""

    run: Run
    impacts: int
    brace_hits: int
    checkpoint: int
    batch_end: int
    measured: int  # batches
    grown: float  # before the present batch
    lossy: int  # the last look at which something had been lost
    enough: int  # flights, to compare their averages
    digits: float
    converged: bool
    known: PeriodicityCheck
    known_at: int
    work: int


@njit(**INTERNAL_INLINE)
def batch_of(max_cycles):
    """Over so many cycles the exponent is measured at a time."""
    return max_cycles // (2 * BATCHES)


@njit(**INTERNAL)
def opened(p, angle, velocity, max_cycles):
    """The case of a motion from (angle, velocity)."""
    watch = watched(begin(p, angle, velocity, UNKNOWN)[0])
    run = Run(watch, no_flights(), FIRST_SECTION * p.period, 0, False, False)
    batch = batch_of(max_cycles)
    batch_end = (max_cycles - BATCHES * batch) if batch > 0 else max_cycles + 1
    hits = watch.progress.brace_hits
    return ClassifierState(
        run, 0, hits, FIRST_CHECKPOINT, batch_end, 0, 0.0, 0, MIN_FLIGHTS, 0.0, False, no_cycle(0), 0, 0
    )


@njit(**INTERNAL_INLINE)
def next_look(case, max_cycles):
    """The end of the leg to come."""
    return min(case.checkpoint, case.batch_end, max_cycles)
