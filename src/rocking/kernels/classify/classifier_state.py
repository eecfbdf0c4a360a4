"""A motion under classification, and what is known of it between two checkpoints."""

from typing import NamedTuple

from numba import njit

from rocking.kernels.classify.periodicity import PeriodicityCheck, no_cycle
from rocking.kernels.classify.quasi_periodicity import MIN_FLIGHTS, Flights, no_flights
from rocking.kernels.classify.reset import ResetTracker, new_tracker
from rocking.kernels.classify.workspace import BATCHES
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.march.march import UNKNOWN, begin
from rocking.kernels.numerics.replace_fields import replacing

FIRST_CHECKPOINT = 14
# Phase of the first section, in cycles: by chance alone an event lies there.
FIRST_SECTION = 0.3819660112501051


class Run(NamedTuple):
    """A motion under way."""

    tracker: ResetTracker
    flights: Flights
    section_time: float  # of the section, within a cycle
    count: int  # rows kept of it
    lossless: bool
    measuring: bool


class Batches(NamedTuple):
    """Batches over which the exponent is measured."""

    end: int  # the cycle at which the present one ends
    measured: int  # batches
    grown: float  # logarithm of the growth before the present one


class Averages(NamedTuple):
    """Averages over the flights, as they were compared last."""

    enough: int  # flights, to compare them again
    digits: float  # to which they agreed
    converged: bool


class KnownOrbit(NamedTuple):
    """The orbit that was found last, and the cycle at which it was found."""

    check: PeriodicityCheck
    cycle: int


class ClassifierState(NamedTuple):
    """A motion and what is known of it at a checkpoint, between two legs."""

    run: Run
    impacts: int
    brace_hits: int
    checkpoint: int
    batches: Batches
    lossy: int  # the last checkpoint at which something had been lost
    averages: Averages
    known: KnownOrbit
    work: int  # events computed by Newton's method


with_measuring = replacing(Run, "measuring")
with_section = replacing(Run, "section_time", "count")
as_lossy = replacing(Run, "tracker", "flights", "lossless")
as_lossless = replacing(Run, "flights", "lossless")
with_run = replacing(ClassifierState, "run")
with_batches = replacing(ClassifierState, "run", "batches")
with_averages = replacing(ClassifierState, "averages")
with_known = replacing(ClassifierState, "run", "known", "work")
with_losses = replacing(ClassifierState, "run", "lossy")
with_checkpoint = replacing(ClassifierState, "impacts", "brace_hits", "checkpoint")


@njit(**INTERNAL_INLINE)
def batch_of(max_cycles):
    """Return over how many cycles the exponent is measured at a time."""
    return max_cycles // (2 * BATCHES)


@njit(**INTERNAL)
def opened(p, angle, velocity, max_cycles):
    """Return the state of a motion from (angle, velocity) at its start."""
    tracker = new_tracker(begin(p, angle, velocity, UNKNOWN)[0])
    run = Run(tracker, no_flights(), FIRST_SECTION * p.period, 0, False, False)
    batch = batch_of(max_cycles)
    batch_end = (max_cycles - BATCHES * batch) if batch > 0 else max_cycles + 1
    return ClassifierState(
        run=run,
        impacts=0,
        brace_hits=tracker.progress.brace_hits,
        checkpoint=FIRST_CHECKPOINT,
        batches=Batches(batch_end, 0, 0.0),
        lossy=0,
        averages=Averages(MIN_FLIGHTS, 0.0, False),
        known=KnownOrbit(no_cycle(0), 0),
        work=0,
    )


@njit(**INTERNAL_INLINE)
def next_look(case, max_cycles):
    """Return the cycle at which the leg to come ends."""
    return min(case.checkpoint, case.batches.end, max_cycles)
