"""March of a classification from one checkpoint to the next (one leg)."""

import numpy as np

from rocking.kernels.classify.classifier_state import Run
from rocking.kernels.classify.lazy_section import append_lazy_rows
from rocking.kernels.classify.quasi_periodicity import collect, section_needed
from rocking.kernels.classify.reset import follow, moved_on
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.march.march import DONE, PAUSED, RELEASED, march_on
from rocking.kernels.march.progress import Recording
from rocking.kernels.march.tangent import TangentState

# A motion with a larger average number of events per cycle is not classified to its end.
MAX_EVENTS_A_CYCLE = 200
FREE_EVENTS = 1_000_000


@njit(**INTERNAL_INLINE)
def most_events(max_cycles):
    """Return the maximum number of events of a motion; the classification of one with more is abandoned."""
    return MAX_EVENTS_A_CYCLE * max_cycles + FREE_EVENTS


@njit(**INTERNAL)
def make_room(section, count, coming, most_rows):
    """Return the number of section rows that stay when ``coming`` more follow.

    If these do not fit, the last rows move to the front.
    """
    if coming <= most_rows and count + coming <= section.shape[0]:
        return count
    kept = max(min(count, most_rows - coming), 0)
    if kept < count:
        for k in range(kept):
            for column in range(section.shape[1]):
                section[k, column] = section[count - kept + k, column]
    return kept


@njit(**INTERNAL_INLINE)
def follow_flights(p, run, target, most, workspace, wanted):
    """March an undamped motion to the end of cycle ``target`` and collect its arcs between impacts.

    Rows of the section are added only if they are ``wanted``.

    Returns
    -------
    tuple of (int, Run)
        Status and run.
    """
    tracker, flights, section_time, count, lossless, measuring = run
    progress, events = tracker.progress, workspace.events
    recording = Recording(section_time, workspace.nothing.section, events, True, True)
    while True:
        before = progress
        status, progress, _, written = march_on(p, before, target, recording, workspace.tangent)
        flights = collect(p, flights, written, events, workspace.flights)
        if wanted:
            count = append_lazy_rows(
                p, before, events, written, progress, section_time, workspace.section, count
            )
        on = status in (PAUSED, RELEASED)
        if not on or progress.impacts + progress.brace_hits > most:
            return status, Run(moved_on(tracker, progress), flights, section_time, count, lossless, measuring)


@njit(**INTERNAL_INLINE)
def march_leg(p, run, max_cycles, target, workspace):
    """March a motion to the end of cycle ``target``, with its last states.

    Returns
    -------
    tuple of (int, Run)
        Status and run.
    """
    most = most_events(max_cycles)
    tracker, flights, section_time, count, lossless, measuring = run
    cycle, rows, nothing = tracker.progress.cycle, workspace.scratch.shape[0], workspace.nothing
    count = make_room(workspace.section, count, target - cycle, rows)
    if lossless:
        wanted = section_needed(workspace.tangent.growth[0], target, max_cycles, rows)
        kept = Run(tracker, flights, section_time, count if wanted else 0, lossless, measuring)
        return follow_flights(p, kept, target, most, workspace, wanted)
    growth = workspace.tangent.growth if measuring else nothing.tangent.growth
    tangent = TangentState(workspace.tangent.columns, growth)
    # the section of the present cycle may have passed
    coming = target - cycle - (not tracker.progress.pending)
    total, status = count + min(coming, rows), np.int64(DONE)
    while status == DONE and cycle < target:
        # Only the last states of a long leg are kept.
        until = target if target - cycle <= rows else target - rows
        part = workspace.section[count:total] if until == target else nothing.section
        status, tracker = follow(p, tracker, until, most, section_time, part, tangent, nothing)
        cycle = tracker.progress.cycle
    return status, Run(tracker, flights, section_time, total, lossless, measuring)
