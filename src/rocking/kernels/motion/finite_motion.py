"""Motion under a base acceleration of finite length, from its start to its end: outcome, margin, rounding errors, largest angle.

The states are those of ``march``; no sections and no events are recorded. The rounding errors are propagated from event to event
(``rounding_errors``). Of a slender block only the arc that may contain the largest angle is searched for its maximum. The search for
an event gives a lower bound of the maximum of an arc, from its samples. An upper bound follows from that.

Of a full block the margin takes as long as an arc of many steps (``unstable_balance``). So in a batch the arc of the margin is that
of the least estimate, and only its margin is computed. In a single motion the margin of each arc that may be the least is computed
to a few digits, and that of the least to all; after MOST_MARGINS the estimates decide. An arc need not have a margin if the base
acceleration is large. Then the arcs that have one count, and in a batch the motion is followed once more to find them.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.arc.arc import Arc, Next, shift_clock
from rocking.kernels.block.impact import SLOW, SLOWEST, after_chattering, after_event, side_after_impact
from rocking.kernels.block.rest import rest_is_sure, start_is_sure
from rocking.kernels.block.scatter import next_place
from rocking.kernels.contract import (
    acceleration,
    at_impact,
    elapsed_until,
    end_is_sure,
    escape_speed,
    estimate_error,
    has_ended,
    impacts_per_trial,
    is_scattered,
    is_symmetric,
    largest_before,
    margin_estimate,
    margin_of,
    next_event_and_extremes,
    peak_with,
    restitution_at,
    restitution_error,
    rounding_error,
    settling,
    units_of,
    with_pulse,
    with_run,
)
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE, REST
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Integers1
from rocking.kernels.motion.march import CROWDED, DONE, MAX_EVENTS, OVERTURNED, STILL, UNKNOWN, begin
from rocking.kernels.motion.rounding_errors import (
    DEVIATIONS,
    EXACT,
    Covariance,
    after_saltation,
    after_time,
    exceeds,
    of_growth,
    of_velocity,
    turns_further,
    widened,
    with_error_of_velocity,
)
from rocking.kernels.motion.tangent import event_map
from rocking.kernels.numerics.elementary import rough_hyperbolic
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import AnyPulseParameters, AnySampledParameters, FiniteParameters


class Ending(NamedTuple):
    """End of a motion, and how close it came to another."""

    status: int
    impacts: int
    since_rest: int  # impacts since the block last rested, or since the start
    brace_hits: int
    peak: float
    margin: float  # K+, or K, of least size over the lift-offs and impacts that have one; NaN if none has
    margin_time: float
    decided: bool  # whether no rounding error can have changed the outcome


ENDING_ROW = np.dtype(
    [
        ("status", "i8"),
        ("impacts", "i8"),
        ("since_rest", "i8"),
        ("decided", "i8"),
        ("peak", "f8"),
        ("margin", "f8"),
        ("margin_time", "f8"),
    ],
    align=True,
)
Endings = Annotated[np.ndarray, ENDING_ROW, 1]


@kernel(inline=True)
def write_ending(rows, k, end):
    """Write an ``Ending`` to a row."""
    row = rows[k]
    row.status, row.impacts, row.since_rest, row.decided = (
        end.status,
        end.impacts,
        end.since_rest,
        end.decided,
    )
    row.peak, row.margin, row.margin_time = end.peak, end.margin, end.margin_time


class Highest(NamedTuple):
    """Largest angle so far, and the arc that may exceed it."""

    peak: float  # of all maxima that were computed
    reached: float  # no more than the largest angle so far
    top: float  # upper bound of the maximum of the arc; 0 if there is none to compute
    arc: Arc
    coming: Next  # event that ends the arc


@kernel(inline=True)
def from_peak(peak, arc):
    """Return the ``Highest`` before the first arc."""
    return Highest(peak, peak, 0.0, arc, Next(math.inf, NONE, arc.side, 0.0, 0.0, arc.drive, 0.0, 0.0))


@kernel
def peak_of(p, highest):
    """Return the largest angle so far."""
    if highest.top <= highest.peak:
        return highest.peak
    return peak_with(p, highest.arc, highest.coming, highest.peak)


@kernel
def highest_with(p, highest, arc, coming, extremes):
    """Return the ``Highest`` that includes one more arc, with its extremes."""
    top = largest_before(p, arc, coming, extremes.reached)
    if top <= highest.reached:
        return highest
    if extremes.reached <= highest.reached:
        peak = peak_with(p, arc, coming, highest.peak)
        return Highest(peak, max(peak, highest.reached), highest.top, highest.arc, highest.coming)
    peak = highest.peak if highest.top <= extremes.reached else peak_of(p, highest)
    reached = max(peak, extremes.reached)
    if top <= extremes.reached:
        return Highest(reached, reached, 0.0, arc, coming)
    return Highest(peak, reached, top, arc, coming)


# Margins that are computed in one motion; chattering without much loss has a hundred thousand arcs, each as close as the others.
MOST_MARGINS = 1_000


class Closeness(NamedTuple):
    """Margin and accumulated rounding error of a motion, up to the present arc."""

    margin: float  # infinite before the first one
    time: float
    decided: bool
    settling: bool  # whether it is certain that the present impacts accumulate to rest
    error: Covariance
    margins: int  # number of margins that were computed


with_error, with_decided = replacing(Closeness, "error"), replacing(Closeness, "decided")


@kernel(inline=True)
def error_after(p, arc, time, stretch, error):
    """Return the accumulated error a time after the start of an arc."""
    sinh, cosh = rough_hyperbolic(stretch.rate * time)
    own = rounding_error(p, arc, time, sinh + cosh, stretch.steps)
    return widened(after_time(error, stretch.rate, sinh, cosh), own)


@kernel
def is_no_graze(p, arc, coming, at_event):
    """Return whether a block that meets the base at an event would have sunk below it by more than the accumulated error.

    If u'' < 0 at the contact, the block falls on.
    """
    if coming.event != IMPACT:
        return True
    by, upward = units_of(p, arc.side), acceleration(p, arc.side, coming.angle, coming.drive)
    return turns_further(coming.velocity * by.per_speed, upward * (by.per_speed * by.per_rate), at_event)


@kernel
def is_decided(p, arc, coming, extremes, stretch, error, at_event):
    """Return whether the end of an arc, its minima before its event and its depth exceed the accumulated rounding error.

    The variance of u is a sum of e^2t and e^-2t with weights that are not negative, and a constant. So it is largest at the start
    or at the event, or where it is certain that none follows.
    """
    if not (end_is_sure(p, arc, coming, error, at_event) and is_no_graze(p, arc, coming, at_event)):
        return False
    if extremes.low < math.inf and not (
        extremes.low > 0.0 and exceeds(extremes.low, error.uu) and exceeds(extremes.low, at_event.uu)
    ):
        return False
    if extremes.dip == math.inf:
        return True
    at_dip = error_after(p, arc, extremes.dip_time, stretch, error)
    if not (extremes.dip > 0.0 and exceeds(extremes.dip, at_dip.uu)):
        return False
    if extremes.late_time == extremes.dip_time:
        return True
    later = error_after(p, arc, extremes.late_time, stretch, error)
    return exceeds(extremes.late, later.uu)


@kernel
def settles(p, arc, drive, speed, error, peak):
    """Return whether chattering after an impact that ends an arc and leaves at a speed certainly ends in rest, whatever the errors.

    ``error`` is that after the impact. No angle until then exceeds ``peak``. Rest erases the errors. Until then they grow beyond
    all speeds, without any effect on the outcome.
    """
    side = side_after_impact(p, arc.side)
    fastest = speed + of_velocity(error) * units_of(p, side).speed
    if not fastest < SLOW:
        return False
    bound, highest = settling(p, side, drive, fastest)
    return bound < math.inf and highest <= peak


@kernel(inline=True)
def is_lossless(p, coming):
    """Return whether an event is an impact that takes no energy: at a brace, or at the base, where those of both directions count."""
    if coming.event == BRACE:
        return p.block.brace_restitution == 1.0
    speed = -coming.velocity
    right, left = restitution_at(p, 1, speed)[0], restitution_at(p, -1, speed)[0]
    return coming.event == IMPACT and not is_scattered(p) and right == 1.0 and left == 1.0


@kernel
def after_arc(p, arc, time, coming, extremes, stretch, so_far, at_event, each):
    """Return the closeness after an arc that starts at a time of the motion, with its extremes and the error at its event.

    The margin is an estimate, or computed for ``each`` arc that may have the least, MOST_MARGINS at most. An arc without a margin
    does not count.
    """
    decided = so_far.decided and (
        so_far.settling or is_decided(p, arc, coming, extremes, stretch, so_far.error, at_event)
    )
    margin, when, margins = so_far.margin, so_far.time, so_far.margins
    if arc.angle == 0.0:
        constant = margin_estimate(p, arc, coming, stretch)
        if each and margins < MOST_MARGINS and abs(constant) < abs(margin) + estimate_error(p):
            constant, margins = margin_of(p, arc, constant, True), margins + 1
        if abs(constant) < abs(margin):
            margin, when = constant, time
    return Closeness(margin, when, decided, so_far.settling, so_far.error, margins)


@kernel
def error_at_event(p, mode, arc, coming, stretch, error):
    """Return the accumulated error at the event that ends an arc, or where it is certain that none follows."""
    if mode != FLIGHT:
        return error
    return error_after(p, arc, elapsed_until(p, arc, coming.drive), stretch, error)


@kernel
def error_after_event(p, arc, coming, mode, side, error):
    """Return the accumulated error after the event that ends an arc, for the mode and the side after it, from the error before it."""
    moved = after_saltation(error, *own_map(p, arc, coming, mode, side))
    if not (mode == FLIGHT and coming.event == IMPACT):
        return moved
    return with_error_of_velocity(moved, restitution_error(p, arc, coming, error) / DEVIATIONS)


@kernel
def resolved(p, arc, coming, cut, peak, error):
    """Return mode and arc after an event, with the accumulated error at it.

    Chattering is ``cut`` short only if rest is certain whatever the rounding errors, and if the angle stays below ``peak``.
    """
    before = -coming.velocity
    time, speed = arc.start + coming.wait, restitution_at(p, arc.side, before)[0] * before
    if cut and coming.event == IMPACT and SLOWEST < speed < SLOW:
        rebound = error_after_event(p, arc, coming, FLIGHT, side_after_impact(p, arc.side), error)
        if settles(p, arc, coming.drive, speed, rebound, peak):
            return after_chattering(p, arc, time, coming)
    return after_event(p, arc, time, coming, 0.0, math.inf)


@kernel(inline=True)
def own_map(p, arc, coming, mode_after, side_after):
    """Return the matrix of ``tangent.event_map`` between errors in the units of the sides before and after an event."""
    factor, shear, gain = event_map(p, arc, coming, mode_after, side_after)
    before, after = units_of(p, arc.side), units_of(p, side_after)
    angle, speed = before.angle * after.per_angle, before.speed * after.per_speed
    return factor * angle, shear * (before.angle * after.per_speed), gain * speed


@kernel
def after_its_event(p, arc, coming, after, so_far, cut):
    """Return the closeness after the event that ends an arc.

    ``after`` is the mode and the arc after the event. ``so_far.error`` is the error just before it.
    A block in flight does not settle if chattering is ``cut`` short.
    """
    mode, ahead = after
    error = error_after_event(p, arc, coming, mode, ahead.side, so_far.error)
    begins = so_far.settling
    if mode == FLIGHT and coming.event == IMPACT and not (begins or cut):
        begins = settles(p, arc, ahead.drive, ahead.velocity, error, math.inf)
    remains = mode == FLIGHT and begins
    return Closeness(so_far.margin, so_far.time, so_far.decided, remains, error, so_far.margins)


@kernel
def by_energy(p, arc, close):
    """Return status and closeness after the base motion, where no energy is lost from now on: it decides."""
    spare, free = abs(arc.velocity) - escape_speed(p), p.block.brace_angle == math.inf
    own = spare * units_of(p, arc.side).per_speed
    decided = close.decided and (not free or exceeds(own, of_growth(close.error)))
    status = OVERTURNED if free and spare > 0.0 else DONE
    return status, Closeness(close.margin, close.time, decided, False, close.error, close.margins)


@kernel
def to_end(p, angle, velocity, until, cut, want_peak, each):
    """Return the ``Ending`` of a motion.

    Follow it until nothing follows, until a time, or to the first contact without loss after the base motion. With ``cut``,
    chattering is cut short if it does not exceed a peak that is wanted. The arc of the margin is that of the least estimate, or the
    margin of ``each`` arc that may have the least is computed. Then the margin is NaN only if none is found for any arc, and if the
    search does not settle to all digits, it has a few.
    """
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    mode, arc, impacts, brace_hits = progress.mode, progress.arc, 0, int(hit)
    highest = from_peak(progress.peak, arc)
    since_rest, cycle, free, sides = 0, 0, p.block.brace_angle == math.inf, 1 if is_symmetric(p) else 2
    place = progress.place
    begins_at_rest = angle == 0.0 and velocity == 0.0
    decided = not begins_at_rest or start_is_sure(p, arc)
    close, status = Closeness(math.inf, math.nan, decided, False, EXACT, 0), CROWDED
    closest, per_trial = arc, impacts_per_trial(p)
    for _ in range(MAX_EVENTS):
        wanted = highest.reached if want_peak else math.inf
        coming, extremes, stretch = next_event_and_extremes(p, mode, arc, wanted)
        time = cycle * p.clock.cycle_length + arc.start
        error = error_at_event(p, mode, arc, coming, stretch, close.error)
        if mode == FLIGHT and free and status == CROWDED:
            before = close.time
            close = after_arc(p, arc, time, coming, extremes, stretch, close, error, each)
            closest = arc if close.time != before else closest
        if mode == REST and close.decided:
            close = with_decided(close, rest_is_sure(p, arc, coming))
        if coming.wait == math.inf or time + coming.wait > until:
            status = DONE if coming.wait < math.inf else OVERTURNED if mode == FLIGHT else STILL
            break
        if want_peak and mode == FLIGHT:
            highest = highest_with(p, highest, arc, coming, extremes)
        if (
            status != CROWDED
        ):  # the end is known: without losses all later arcs are as high as the next one on their side
            sides -= 1
            if sides == 0:
                break
            mode, arc = after_event(p, arc, arc.start + coming.wait, coming, 0.0, math.inf)
            continue
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        close = with_error(close, error)
        tried = cut and since_rest % per_trial == per_trial - 1
        q = at_impact(p, place)
        after = resolved(q, arc, coming, tried, highest.reached if want_peak else math.inf, close.error)
        close = after_its_event(q, arc, coming, after, close, cut)
        mode, arc = after
        place = next_place(place, coming.event == IMPACT, mode == REST)
        since_rest = 0 if mode == REST else since_rest + int(coming.event == IMPACT)
        while arc.start > p.clock.cycle_length:
            cycle, arc = cycle + 1, shift_clock(arc, p.clock.cycle_length)
        if is_lossless(p, coming) and has_ended(p, arc.drive):
            status, close = by_energy(p, arc, close)
            if not (want_peak and mode == FLIGHT and status == DONE):
                break
    peak, margin = peak_of(p, highest), close.margin
    if margin < math.inf:
        precise = margin_of(p, closest, margin, cut)
        margin = margin if each and math.isnan(precise) else precise
    else:
        margin = math.nan
    return Ending(status, impacts, since_rest, brace_hits, peak, margin, close.time, close.decided)


@kernel
def to_end_in_batch(p, angle, want_peak):
    """Return the ``Ending`` of a motion that starts without velocity, chattering cut short.

    If the arc of the least estimate has no margin, the motion is followed again, and the margin of each arc is computed.
    """
    each = False
    while True:
        # One place of call, so that LLVM puts ``to_end`` and all that it calls into one function: a seventh less time.
        end = to_end(p, angle, 0.0, math.inf, True, want_peak, each)
        if each or not (math.isnan(end.margin) and not math.isnan(end.margin_time)):
            return end
        each = True


# Left side of the block (``system.LeftSide``); zeros for equal sides, and an infinite first ratio for a wall.
LEFT_COLUMNS = ("angle_ratio", "f8"), ("frequency_ratio", "f8"), ("left_restitution", "f8")
# Runs under the same samples: their scale, and the block and its angle at the start. The last three are those of a full block.
RUN_ROW = np.dtype(
    [
        ("scale", "f8"),
        ("restitution", "f8"),
        ("angle", "f8"),
        ("critical_angle", "f8"),
        *LEFT_COLUMNS,
        ("speed_unit", "f8"),
        ("stream", "i8"),
    ],
    align=True,
)
Runs = Annotated[np.ndarray, RUN_ROW, 1]
PULSE_ROW = np.dtype(
    [
        ("amplitude", "f8"),
        ("frequency", "f8"),
        ("phase", "f8"),
        ("duration", "f8"),
        ("restitution", "f8"),
        ("critical_angle", "f8"),
        *LEFT_COLUMNS,
    ],
    align=True,
)
Pulses = Annotated[np.ndarray, PULSE_ROW, 1]


@entry_point
def run_to_end(p: FiniteParameters, angle: float, velocity: float, until: float) -> Ending:
    """Follow a motion by ``to_end``, each impact of a chattering sequence included; entry point for Python."""
    return to_end(p, angle, velocity, until, False, False, True)


@entry_point(long=True)
def run_batch(p: AnySampledParameters, runs: Runs, want_peak: bool, rows: Endings, stop: Integers1) -> bool:
    """Follow the motion of each of ``runs`` under the samples of ``p``, and write its row of ``rows``.

    Chattering is cut short, so that its impacts do not count for the margin. Returns True if all were followed, False if
    ``stop[0]`` was set before the end.
    """
    for k in range(runs.shape[0]):
        if stop[0] != 0:
            return False
        q = with_run(p, runs[k])
        write_ending(rows, k, to_end_in_batch(q, runs[k].angle, want_peak))
    return True


@entry_point(long=True)
def run_pulses(
    kind: AnyPulseParameters, pulses: Pulses, want_peak: bool, rows: Endings, stop: Integers1
) -> bool:
    """Follow the motion from rest under each of ``pulses`` as ``run_batch`` does; ``kind`` only gives the kind of block."""
    for k in range(pulses.shape[0]):
        if stop[0] != 0:
            return False
        p = with_pulse(kind, pulses[k])
        write_ending(rows, k, to_end_in_batch(p, 0.0, want_peak))
    return True
