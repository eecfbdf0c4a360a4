"""Event-driven march of one block, in constant memory.

Time is an integer cycle and the time within it, so that the forcing phase stays accurate however long the
run. Sections lie inside arcs and do not interrupt them.
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from rocking.kernels.arc.arc import MAX_ARC_TIME, Arc, shift_clock, within_reach
from rocking.kernels.block.impact import after_event
from rocking.kernels.block.rest import side_to_lift
from rocking.kernels.block.scatter import next_place
from rocking.kernels.contract import (
    arc_at,
    at_impact,
    evaluate,
    guess_from,
    has_wall,
    largest_on,
    next_event,
    no_return_time,
    peak_with,
    resynchronise,
    stays_leaning,
)
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAN, NONE, REST
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.motion.observers import EVENT_ROW, EventRows, note, note_event, note_state
from rocking.kernels.motion.tangent import (
    NO_TANGENT,
    TangentState,
    carry,
    carry_arc,
    finish_tangent,
    in_registers,
    read_registers,
    strain_of,
    write_registers,
)
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import SystemParameters


class Progress(NamedTuple):
    """State of a march: mode, clock, arc and the numbers of events so far."""

    mode: int
    cycle: int
    arc: Arc
    pending: bool  # the section of this cycle is still ahead
    crowd: int  # events in this cycle
    impacts: int
    brace_hits: int
    peak: float
    no_return: float  # time within the cycle at which overturning was proved; infinite before
    # Guesses of two times between events: how long the last arc took, and how long the present arc takes from
    # its entry. The second is usually that of the last arc on the same side. 0 if unknown.
    last_wait: float
    wait_before: float
    strain: float  # logarithm of the tangent growth at the last start of rest or brace contact
    place: int  # of the next impact, for its coefficient of restitution (``block.scatter``)


class Recording(NamedTuple):
    """Recording of a march; arrays without rows record nothing."""

    section_time: float = 0.0  # within each cycle
    # (n, 2): states at that time, just after any event there, in order and up to the proof of overturning.
    # (n, 4): with the numbers of impacts and brace impacts so far.
    section: Floats2 = np.empty((0, 2))
    events: EventRows = np.empty(0, EVENT_ROW)  # one row per event
    peak: bool = False
    releases: bool = False  # stop after each lift-off and each departure from a brace


with_clock = replacing(Progress, "cycle", "arc", "pending", "crowd", "no_return")
with_arc = replacing(Progress, "arc")
with_pending = replacing(Progress, "pending")
with_no_return = replacing(Progress, "no_return")
with_peak = replacing(Progress, "peak")
with_strain = replacing(Progress, "strain")
with_waits = replacing(Progress, "last_wait", "wait_before")


class NoRecording(NamedTuple):
    """Empty arrays for disabled recordings, allocated once: an allocation costs as much as half an impact."""

    section: Floats2  # (0, 4)
    events: EventRows  # (0,)
    tangent: TangentState  # (0, 2), (0,)


def no_recording():
    """Allocate the arrays of ``NoRecording``."""
    return NoRecording(np.empty((0, 4)), np.empty(0, EVENT_ROW), TangentState(np.empty((0, 2)), np.empty(0)))


# No guesses of the first two times between events.
UNKNOWN = (0.0, 0.0)


@kernel
def begin(p, angle, velocity, waits, start=0.0):
    """Start a march just after any event at the time ``start`` within its first cycle.

    ``waits`` guesses the time to the first event and the time from there to the second.

    Returns
    -------
    tuple of (Progress, bool)
        The march at its start.
        Whether a brace was hit there.
    """
    side = 1 if angle > 0.0 or (angle == 0.0 and (velocity > 0.0 or has_wall(p))) else -1
    hit = abs(angle) == p.block.brace_angle and side * velocity > 0.0
    u, v = abs(angle), side * velocity
    if hit:
        v = -p.block.brace_restitution * v
    mode = FLIGHT
    arc = arc_at(p, side, 0, start, u, v)
    if u == 0.0 and v == 0.0:
        lifting = side_to_lift(p, arc.start, arc.drive)
        mode = REST if lifting == 0 else FLIGHT
        arc = arc_at(p, side if lifting == 0 else lifting, 0, start, 0.0, 0.0)
    elif u == p.block.brace_angle and v == 0.0 and stays_leaning(p, arc):
        mode = LEAN
    return Progress(
        mode=mode,
        cycle=0,
        arc=arc,
        pending=True,
        crowd=0,
        impacts=0,
        brace_hits=1 if hit else 0,
        peak=u,
        no_return=math.inf,
        last_wait=waits[1],
        wait_before=waits[0],
        strain=-math.inf,
        place=0,
    ), hit


@entry_point
def begin_march(p: SystemParameters, angle: float, velocity: float) -> tuple[Progress, bool]:
    """Begin a march as ``begin`` does, without guesses of the first two waits."""
    return begin(p, angle, velocity, UNKNOWN)


@entry_point
def note_start(events: EventRows, progress: Progress, hit: bool, velocity: float) -> int:
    """Write the first rows of a motion: its first arc, after a brace impact if it starts with one.

    Returns the number of events written. A sustained contact with the brace at the start is a second event.
    """
    if hit:
        return note_event(events, 0, progress, BRACE, velocity)
    return note(events, 0, progress, NONE, velocity)


MAX_EVENTS = 10_000_000
# Compiled code cannot be interrupted, so a march returns after this number of events.
BREATH = 2_000_000
# Cycles of a march that ends when nothing follows.
OPEN = 2**62
# After this number of events (a power of two, less one) the forcing is computed from the clock again.
RESYNCHRONISE = 15


class Status(IntEnum):
    """Reason why a march ended."""

    DONE = 0
    OVERTURNED = 1
    STILL = 2  # permanently at rest or in contact with a brace
    PAUSED = 3  # the event buffer is full, or BREATH events were computed: call again to resume
    CROWDED = 4  # more than MAX_EVENTS events in one cycle
    RELEASED = 5  # the block has just lifted off or left a brace, as requested: call again to resume


DONE, OVERTURNED, STILL, PAUSED, CROWDED, RELEASED = (int(status) for status in Status)


@kernel
def finish(p, reached, coming, cycles, state, want_peak):
    """Return status and progress at the end of a march: tangent vectors, peak and arc are brought there.

    An overturned block is left at the time of the proof, because its angle may overflow later.
    """
    arc, peak = reached.arc, reached.peak
    end = min(reached.no_return, 0.0)
    if cycles == OPEN:
        end = reached.no_return if reached.mode == FLIGHT else arc.start
    t = end - arc.start
    if reached.mode == FLIGHT:
        now = evaluate(p, arc, t)
        if state.columns.shape[0] > 0:
            carry_arc(p, arc, state, t, reached.cycle * p.clock.cycle_length + arc.start)
        finish_tangent(state)
        angle = within_reach(p, now.angle)
        if want_peak:
            peak = max(largest_on(p, arc, t, peak), angle)
        arc = arc_at(p, arc.side, reached.cycle, end, angle, now.velocity)
    else:
        arc = arc_at(p, arc.side, reached.cycle, end, arc.angle, 0.0)
    status = DONE
    if coming.wait == math.inf:
        status = OVERTURNED if reached.mode == FLIGHT else STILL
    return status, with_peak(with_clock(reached, reached.cycle, arc, True, 0, reached.no_return), peak)


@kernel(inline=True)
def prove_no_return(p, progress, coming):
    """Return the progress with the time from which overturning is proved, if the block never comes back."""
    arc, no_return = progress.arc, progress.no_return
    if coming.wait == math.inf and progress.mode == FLIGHT and no_return == math.inf:
        no_return = arc.start + no_return_time(p, arc)
    return with_no_return(progress, no_return)


@kernel(inline=True)
def pass_boundaries(p, progress, wait, cycles, recording, rows):
    """Pass the sections and the ends of cycles before the coming event.

    Returns the progress, the number of section rows written, and whether the march ends there.
    """
    if cycles == OPEN and wait == math.inf:
        return progress, rows, True
    section, section_time = recording.section, recording.section_time
    while progress.arc.start + wait > (section_time if progress.pending else p.clock.cycle_length):
        arc = progress.arc
        if progress.pending:
            progress = with_pending(progress, False)
            if rows < section.shape[0] and section_time <= progress.no_return:
                note_state(p, section[rows], progress, section_time - arc.start)
                rows += 1
            continue
        no_return = progress.no_return - p.clock.cycle_length
        progress = with_clock(
            progress, progress.cycle + 1, shift_clock(arc, p.clock.cycle_length), True, 0, no_return
        )
        if progress.cycle >= cycles or no_return <= 0.0:
            return progress, rows, True
    return progress, rows, False


@kernel(inline=True)
def pass_event(p, progress, coming, horizon, want_peak):
    """Return the progress after the coming event; chattering is cut short if it ends within the ``horizon``.

    ``p`` is the system at this impact.
    """
    arc, impacts, brace_hits = progress.arc, progress.impacts, progress.brace_hits
    peak = progress.peak
    if want_peak and progress.mode == FLIGHT:
        peak = peak_with(p, arc, coming, peak)
    impacts += coming.event == IMPACT
    brace_hits += coming.event == BRACE
    so_far = peak if want_peak else math.inf
    mode, after = after_event(p, arc, arc.start + coming.wait, coming, horizon, so_far)
    return Progress(
        mode=mode,
        cycle=progress.cycle,
        arc=after,
        pending=progress.pending,
        crowd=progress.crowd + 1,
        impacts=impacts,
        brace_hits=brace_hits,
        peak=peak,
        no_return=progress.no_return,
        last_wait=progress.last_wait,
        wait_before=progress.wait_before,
        strain=progress.strain,
        place=next_place(progress.place, coming.event == IMPACT, mode == REST),
    )


@kernel(inline=True)
def resynchronised(p, progress):
    """Return the progress with the forcing of its arc computed from the clock, if that is due."""
    arc = progress.arc
    if (progress.impacts + progress.brace_hits) & RESYNCHRONISE == 0:
        arc = resynchronise(p, arc)
    return with_arc(progress, arc)


@kernel(inline=True)
def unobserved_time(p, progress, coming, cycles, recording):
    """Return the time after the coming event in which nothing is recorded, so that chattering may be cut short.

    Without section and events that is the rest of the march. If the march stops at releases it is
    MAX_ARC_TIME, even if the section then misses states.
    """
    if recording.section.shape[0] == 0 and recording.events.shape[0] == 0 and not recording.releases:
        return (cycles - progress.cycle) * p.clock.cycle_length - (progress.arc.start + coming.wait)
    return MAX_ARC_TIME if recording.releases else 0.0


@entry_point(long=True)
def march_on(
    p: SystemParameters, progress: Progress, cycles: int, recording: Recording, state: TangentState
) -> tuple[int, Progress, int, int]:
    """March to the end of cycle ``cycles``, or to the next pause.

    1. The ``recording`` selects the output. If its ``events`` are full, or after BREATH events, the march returns
       PAUSED; if it stops at releases it returns RELEASED after each. The next call resumes it.
    2. ``state`` carries tangent vectors (``tangent.TangentState``).
    3. At the end the progress starts a new arc at the start of cycle ``cycles``. If the march stops at releases, the present
       arc is continued instead, and counts when it ends. A proof of overturning ends the march with its cycle.

    Returns
    -------
    tuple of (int, Progress, int, int)
        Status and progress.
        Numbers of section rows and of event rows written.
    """
    events, tangent = recording.events, read_registers(state)
    written, rows, computed = 0, 0, 0
    last_guess = guess_from(p, progress.last_wait)
    guess_before = guess_from(p, progress.wait_before)
    while True:
        coming, guess = next_event(p, progress.mode, progress.arc, guess_before)
        progress = prove_no_return(p, progress, coming)
        progress, rows, ended = pass_boundaries(p, progress, coming.wait, cycles, recording, rows)
        full = computed >= BREATH or (events.shape[0] > 0 and written + 2 > events.shape[0])
        status = DONE if ended else PAUSED if full else CROWDED
        if ended or status == PAUSED or progress.crowd >= MAX_EVENTS:
            break
        computed += 1
        before = progress
        # The remainder of an arc that was entered midway predicts nothing about complete arcs.
        whole = before.arc.angle in (0.0, p.block.brace_angle)
        guess_before, last_guess = last_guess, guess if whole else last_guess
        unobserved = unobserved_time(p, before, coming, cycles, recording)
        q = at_impact(p, before.place)
        progress = pass_event(q, before, coming, unobserved, recording.peak)
        if progress.mode != FLIGHT:
            tangent, strain = strain_of(tangent, state)
            progress = with_strain(progress, strain)
        tangent = carry(q, tangent, state, before, coming, progress)
        progress = resynchronised(p, progress)
        if events.shape[0] > 0:
            speed = before.arc.side * coming.velocity
            written = note_event(events, written, progress, coming.event, speed)
        if recording.releases and before.mode != FLIGHT and progress.mode == FLIGHT:
            status = RELEASED
            break
    if in_registers(state):
        write_registers(tangent, state)
    left = guess.time if recording.releases else min(progress.arc.start + coming.wait, MAX_ARC_TIME)
    progress = with_waits(progress, last_guess.time, left if status == DONE else guess_before.time)
    if status == DONE and not (recording.releases and coming.wait < math.inf):
        status, progress = finish(p, progress, coming, cycles, state, recording.peak)
    return status, progress, rows, written


@kernel
def march_through(p, progress, cycles, recording, state):
    """Return status and progress after ``march_on``, called until the march no longer pauses."""
    rows, section = 0, recording.section
    while True:
        part = Recording(recording.section_time, section[rows:], recording.events, recording.peak, False)
        status, progress, taken, _ = march_on(p, progress, cycles, part, state)
        rows += taken
        if status != PAUSED:
            return status, progress


def march(p, progress, cycles, recording, state=NO_TANGENT):
    """March by ``march_on``, by default without tangent vectors."""
    return march_on(p, progress, cycles, recording, state)
