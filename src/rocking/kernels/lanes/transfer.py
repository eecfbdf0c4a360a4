"""Transfer of a block into its lane, and back."""

import math

from rocking.kernels.classify.classifier_state import Run
from rocking.kernels.classify.lazy_section import append_lazy_rows
from rocking.kernels.classify.leg import make_room, most_events
from rocking.kernels.classify.quasi_periodicity import Flights
from rocking.kernels.classify.reset import moved_on
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.forcing.arc import shift_clock
from rocking.kernels.forcing.drives import HarmonicDrive
from rocking.kernels.forcing.harmonic.acceleration import forcing_term
from rocking.kernels.forcing.harmonic.solution import arc_with
from rocking.kernels.lanes.state import AT_EVENT, END_LEG, FAILED, NEW_ARC, SLOWEST, set_system
from rocking.kernels.march.initial_state import UNKNOWN
from rocking.kernels.march.march import CROWDED, DONE
from rocking.kernels.march.progress import Progress

LN2 = math.log(2.0)


@njit(**INTERNAL)
def load_block(s, i, p, progress, columns):
    """Load a block into a lane."""
    set_system(s, i, p)
    arc, events = progress.arc, progress.impacts + progress.brace_hits
    s.cycle[i] = progress.cycle
    s.start[i] = arc.start
    s.side[i] = arc.side
    s.angle[i] = arc.angle
    s.velocity[i] = arc.velocity
    s.cosine[i] = arc.drive.cosine
    s.sine[i] = arc.drive.sine
    s.events[i] = events
    s.counted[i] = events
    s.brace_hits[i] = progress.brace_hits
    s.peak[i] = progress.peak
    # The first event of a block that starts away from the base, or slowly, is found by the functions for one block.
    lifts = arc.velocity == 0.0 and forcing_term(p, arc.drive.cosine) > 0.0
    known = p.block.brace_angle < math.inf or (arc.angle == 0.0 and (arc.velocity >= SLOWEST or lifts))
    s.stage[i] = NEW_ARC if known else FAILED
    s.exceeds[i] = 1.0
    set_difference(s, i, columns)


@njit(**INTERNAL_INLINE)
def set_difference(s, i, columns):
    """Set the tangent vector of a lane."""
    s.delta_angle[i] = columns[0, 0]
    s.delta_velocity[i] = columns[0, 1]
    s.doublings[i] = 0.0


@njit(**INTERNAL_INLINE)
def set_leg(s, i, target, logged):
    """Set the end of the leg of a lane, and whether its arcs are logged."""
    s.target[i] = target
    s.log_on[i] = logged


@njit(**INTERNAL_INLINE)
def set_collection(s, i, run):
    """Set the number of events of a lane before its first collected arc; the arcs of damped motions are not collected."""
    s.uncollected[i] = s.events[i] - run.flights.count if run.lossless else math.inf


@njit(**INTERNAL)
def arc_of(s, i, p):
    """Return the present arc of a lane."""
    side, start = int(s.side[i]), s.start[i]
    return arc_with(p, side, start, s.angle[i], s.velocity[i], HarmonicDrive(s.cosine[i], s.sine[i]))


@njit(**INTERNAL_INLINE)
def read_growth(s, i, columns, growth):
    """Add the logarithm of the tangent growth to ``growth``, and write the normalised vector into ``columns``."""
    a, b = s.delta_angle[i], s.delta_velocity[i]
    size = math.hypot(a, b)
    growth[0] += math.log(size) + s.doublings[i] * LN2
    columns[0, 0], columns[0, 1] = a / size, b / size
    set_difference(s, i, columns)


@njit(**INTERNAL_INLINE)
def flights_by_now(s, i, flights, most):
    """Return the number of collected arcs, including those since the lane was last read."""
    return min(flights.count + int(s.events[i]) - int(s.counted[i]), most)


@njit(**INTERNAL)
def progress_of(s, i, p, before, ends, section_time):
    """Return the ``Progress`` of a lane, which was ``before`` when last read; if the leg ``ends``, at its end."""
    arc, cycle, target = arc_of(s, i, p), int(s.cycle[i]), int(s.target[i])
    pending = arc.start <= section_time
    if ends:
        arc, cycle, pending = shift_clock(arc, (target - cycle) * p.forcing.period), target, True
    elif cycle < before.cycle:
        # the present arc began before the lane was last read
        arc, cycle = shift_clock(arc, (before.cycle - cycle) * p.forcing.period), before.cycle
        pending = before.pending
    hits = int(s.brace_hits[i])
    return Progress(
        mode=FLIGHT,
        cycle=cycle,
        arc=arc,
        pending=pending,
        crowd=0,
        impacts=int(s.events[i]) - hits,
        brace_hits=hits,
        peak=s.peak[i],
        no_return=math.inf,
        last_wait=UNKNOWN[1],
        wait_before=s.wait[i] if s.stage[i] == AT_EVENT else UNKNOWN[0],
        strain=-math.inf,
    )


@njit(**INTERNAL)
def unload_block(s, i, request, p, run, workspace, log):
    """Return the run of a lane, with all events since it was last read.

    If the request is END_LEG, the run is at the end of the leg.
    """
    tracker, flights, section_time, count, lossless, measuring = run
    before, written = tracker.progress, int(s.events[i]) - int(s.counted[i])
    if lossless and written > 0:
        collected = flights_by_now(s, i, flights, workspace.flights.shape[0])
        flights = Flights(IMPACT, int(s.cycle[i]), s.start[i], flights.first_cycle, collected)
    after = progress_of(s, i, p, before, request == END_LEG, section_time)
    if s.log_on[i] > 0.0:
        count = make_room(
            workspace.section, count, after.cycle + 1 - before.cycle, workspace.scratch.shape[0]
        )
        count = append_lazy_rows(p, before, log[1:], written, after, section_time, workspace.section, count)
    else:
        count = 0
    s.counted[i] = s.events[i]
    if lossless or measuring:
        read_growth(s, i, workspace.tangent.columns, workspace.tangent.growth)
    return Run(moved_on(tracker, after), flights, section_time, count, lossless, measuring)


@njit(**INTERNAL)
def status_of(s, i, max_cycles):
    """Return the status of the march of a lane: CROWDED after more events than a motion may have."""
    return CROWDED if int(s.events[i]) > most_events(max_cycles) else DONE
