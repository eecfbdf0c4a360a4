"""State of a classification between two checkpoints."""

from typing import NamedTuple

from rocking.kernels.classify.periodicity import PeriodicityCheck, no_cycle
from rocking.kernels.classify.quasi_periodicity import MIN_FLIGHTS, Flights, no_flights
from rocking.kernels.classify.reset import ResetTracker, new_tracker
from rocking.kernels.classify.workspace import BATCHES
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.numerics.replace_fields import replacing

FIRST_CHECKPOINT = 17
# Phase of the first section, in cycles: by chance alone an event lies there.
FIRST_SECTION = 0.3819660112501051


class Run(NamedTuple):
    """Motion in progress, with the records that its classification needs."""

    tracker: ResetTracker
    flights: Flights
    section_time: float  # of the section, within a cycle
    count: int  # number of section rows kept
    lossless: bool
    measuring: bool


class Batches(NamedTuple):
    """Batches over which the exponent is measured."""

    end: int  # cycle at which the present batch ends
    measured: int  # number of batches measured
    grown: float  # logarithm of the growth before the present one


class Averages(NamedTuple):
    """Averages over the arcs, as last compared."""

    enough: int  # number of arcs at which they are compared again
    digits: float  # to which both halves agreed
    converged: bool


class KnownOrbit(NamedTuple):
    """Periodic orbit found last, and the cycle at which it was found."""

    check: PeriodicityCheck
    cycle: int


class ClassifierState(NamedTuple):
    """Motion and the knowledge of it at a checkpoint, between two marches."""

    run: Run
    impacts: int
    brace_hits: int
    checkpoint: int
    batches: Batches
    lossy: int  # last checkpoint with dissipation since the one before
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
    """Return the number of cycles of one batch of the exponent."""
    return max_cycles // (2 * BATCHES)


@njit(**INTERNAL)
def opened(p, angle, velocity, max_cycles):
    """Return the state of a motion from (angle, velocity) at its start."""
    tracker = new_tracker(begin(p, angle, velocity, UNKNOWN)[0])
    run = Run(tracker, no_flights(), FIRST_SECTION * p.forcing.period, 0, False, False)
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
    """Return the cycle of the next checkpoint, at which the coming march ends."""
    return min(case.checkpoint, case.batches.end, max_cycles)
