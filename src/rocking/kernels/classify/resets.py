"""Resets: every lift-off, and every departure from a brace, is the same state up to symmetry.

A release is either of the two. It follows rest or sustained contact with a brace. A block with unequal sides has no braces; its
lift-offs to the left take the place of departures from a brace.
"""

import math
from typing import NamedTuple

from rocking.kernels.contract import is_symmetric
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import PAUSED, RELEASED, Progress, Recording, march_on
from rocking.kernels.motion.tangent import Tangent, TangentState, write_tangent
from rocking.kernels.numerics.replace_fields import replacing

# If tangent vectors grow by less between two releases, the later one is certain in double precision.
MAX_STRAIN = math.log(1e8)


class ResetRecord(NamedTuple):
    """Last release of one kind, and the events since."""

    seen: bool
    cycle: int
    time: float
    impacts: int  # from the start to this release
    brace_hits: int  # as for impacts
    otherwise: bool  # whether a release of the other kind followed
    strain: float
    peak: float


class ResetTracker(NamedTuple):
    """Motion in progress, with its releases.

    ``half_periods`` is the number of half forcing cycles between the last two releases of one kind, if they
    prove an orbit. It is negative if tangent vectors grew too much in between, and 0 before. ``impacts`` and
    ``brace_hits`` are counted between these two; -1 if they accumulate. The peak of the progress counts from
    the last release.
    """

    progress: Progress
    base: ResetRecord
    brace: ResetRecord
    half_periods: int
    impacts: int
    brace_hits: int
    orbit_peak: float
    peak: float


from_release = replacing(Progress, "peak", "strain")


@kernel
def new_tracker(progress):
    """Return the tracker of a motion at its start."""
    never = ResetRecord(False, 0, 0.0, 0, 0, False, -math.inf, 0.0)
    return ResetTracker(progress, never, never, 0, -1, -1, 0.0, progress.peak)


@kernel
def moved_on(tracker, progress):
    """Return the tracker of a motion that reached ``progress`` without a release that proves an orbit."""
    return ResetTracker(progress, tracker.base, tracker.brace, 0, -1, -1, 0.0, tracker.peak)


@kernel
def unvisited(tracker):
    """Return the tracker without its releases, because the growth since then is no longer known."""
    fresh = new_tracker(tracker.progress)
    return ResetTracker(tracker.progress, fresh.base, fresh.brace, 0, -1, -1, 0.0, tracker.peak)


@kernel
def largest_angle(tracker):
    """Return the largest angle since the start."""
    return max(tracker.peak, tracker.progress.peak)


@kernel
def released_since(tracker, cycle):
    """Return whether the block was released in ``cycle`` or later."""
    return (tracker.base.seen and tracker.base.cycle >= cycle) or (
        tracker.brace.seen and tracker.brace.cycle >= cycle
    )


@kernel
def after_flight(visit, strain, peak, otherwise):
    """Return a reset record after one more motion that ended in rest or in contact with a brace.

    ``otherwise`` says that a release of the other kind followed it.
    """
    return ResetRecord(
        visit.seen,
        visit.cycle,
        visit.time,
        visit.impacts,
        visit.brace_hits,
        visit.otherwise or otherwise,
        max(visit.strain, strain),
        max(visit.peak, peak),
    )


@kernel
def hits_between(p, progress, visit, lifts):
    """Count the impacts from a recorded release to the present one of the same kind.

    Rest at the base follows infinitely many impacts unless e = 0, contact with a brace infinitely many unless
    r = 0. A release from the base (``lifts``) follows rest, one from a brace follows contact.

    Returns
    -------
    tuple of (int, int)
        Impacts and brace impacts, -1 if there are infinitely many.
    """
    impacts, brace_hits = progress.impacts - visit.impacts, progress.brace_hits - visit.brace_hits
    rested, leaned = lifts or visit.otherwise, visit.otherwise or not lifts
    if not is_symmetric(p):
        rested, leaned = True, False
    if rested and p.block.restitution > 0.0:
        impacts = -1
    if leaned and p.block.brace_restitution > 0.0:
        brace_hits = -1
    return impacts, brace_hits


@kernel
def at_release(p, tracker, progress):
    """Return the tracker at a release, from the base (the arc begins there) or of the other kind."""
    arc = progress.arc
    lifts = arc.angle == 0.0 and (arc.side > 0 or is_symmetric(p))
    base = after_flight(tracker.base, progress.strain, progress.peak, not lifts)
    brace = after_flight(tracker.brace, progress.strain, progress.peak, lifts)
    visit = base if lifts else brace
    half_periods, impacts, brace_hits = 0, -1, -1
    if visit.seen:
        impacts, brace_hits = hits_between(p, progress, visit, lifts)
        cycles = progress.cycle - visit.cycle + (arc.start - visit.time) / p.forcing.period
        half_periods = round(2.0 * cycles)
        if not visit.strain < MAX_STRAIN:
            half_periods = -half_periods
    now = ResetRecord(
        seen=True,
        cycle=progress.cycle,
        time=arc.start,
        impacts=progress.impacts,
        brace_hits=progress.brace_hits,
        otherwise=False,
        strain=-math.inf,
        peak=0.0,
    )
    restarted = from_release(progress, arc.angle, -math.inf)
    peak = max(tracker.peak, progress.peak)
    base, brace = (now, brace) if lifts else (base, now)
    return ResetTracker(restarted, base, brace, half_periods, impacts, brace_hits, visit.peak, peak)


@kernel(inline=True)
def follow(p, tracker, target, most_events, section_time, section, tangent, nothing):
    """March a motion to the end of cycle ``target``, or to the release that decides.

    ``section`` must have a row for every cycle to come, or none. ``tangent`` carries tangent vectors since
    the last release; if its growth is measured, since the start.

    Returns
    -------
    tuple of (int, ResetTracker)
        Status, RELEASED only at the release that decides.
        Tracker.
    """
    rows = 0
    seen = tracker.base.seen or tracker.brace.seen
    tracked = tangent.columns if seen or tangent.growth.shape[0] > 0 else nothing.tangent.columns
    while True:
        recording = Recording(
            section_time, section if rows == 0 else section[rows:], nothing.events, True, True
        )
        state = TangentState(tracked, tangent.growth)
        status, progress, taken, _ = march_on(p, tracker.progress, target, recording, state)
        rows += taken
        if status == RELEASED:
            tracker = at_release(p, tracker, progress)
            if tracker.half_periods != 0:
                return RELEASED, tracker
            tracked = tangent.columns
            begin_tangent(tangent)
            continue
        tracker = moved_on(tracker, progress)
        if status != PAUSED or progress.impacts + progress.brace_hits > most_events:
            return status, tracker


@kernel
def begin_tangent(tangent):
    """Start with tangent vectors of size 1 along both axes."""
    write_tangent(tangent.columns, Tangent(1.0, 0.0, 0.0, 1.0))
    tangent.growth[:] = 0.0
