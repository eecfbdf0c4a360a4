"""Motion under a base acceleration of finite length, from its start to its end, with its margin.

The states are those of ``march``; no sections and no events are recorded.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, REST
from rocking.kernels.forcing.arc import shift_clock
from rocking.kernels.forcing.contract import settling
from rocking.kernels.forcing.finite import growth_constant, has_ended, next_event_and_extremes, rounding_error
from rocking.kernels.forcing.parameters import FiniteParameters
from rocking.kernels.forcing.pulse.parameters import make_pulse
from rocking.kernels.forcing.sampled.parameters import SampledForcing, SampledParameters
from rocking.kernels.march.accumulated_error import (
    EXACT,
    Covariance,
    after_saltation,
    after_time,
    exceeds,
    of_growth,
    of_velocity,
    widened,
)
from rocking.kernels.march.highest_arc import from_peak, highest_with, peak_of
from rocking.kernels.march.impact_law import SLOW, SLOWEST, after_chattering, after_event
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.march.march import CROWDED, DONE, MAX_EVENTS, OVERTURNED, STILL
from rocking.kernels.march.tangent import event_map
from rocking.kernels.numerics.elementary import hyperbolic
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.parameters import BlockParameters
from rocking.kernels.signature import Integers1


class Ending(NamedTuple):
    """End of a motion, and how close it came to another."""

    status: int
    impacts: int
    since_rest: int  # impacts since the block last rested, or since the start
    brace_hits: int
    peak: float
    margin: float  # K+ of least size over all lift-offs and impacts; NaN if the block never moves
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

# Runs under the same samples: their scale, and the block and its angle at the start.
RUN_ROW = np.dtype([("scale", "f8"), ("restitution", "f8"), ("angle", "f8")], align=True)
Runs = Annotated[np.ndarray, RUN_ROW, 1]

PULSE_ROW = np.dtype(
    [("amplitude", "f8"), ("frequency", "f8"), ("phase", "f8"), ("duration", "f8"), ("restitution", "f8")],
    align=True,
)
Pulses = Annotated[np.ndarray, PULSE_ROW, 1]


class Closeness(NamedTuple):
    """Margin and accumulated rounding error of a motion, up to the present arc."""

    margin: float
    time: float
    decided: bool
    settling: bool  # whether it is certain that the present impacts accumulate to rest
    error: Covariance


with_error = replacing(Closeness, "error")


@njit(**INTERNAL)
def is_decided(p, arc, extremes, error):
    """Return whether K+ of an arc, and its lowest dip, exceed the accumulated rounding error."""
    constant, rounded = growth_constant(p, arc)
    if not exceeds(constant, of_growth(widened(error, rounded))):
        return False
    if extremes.dip == math.inf:
        return True
    sinh, versinh, _, _ = hyperbolic(extremes.dip_time)
    added = rounding_error(p, arc, extremes.dip_time, 1.0 + sinh + versinh)
    return extremes.dip > 0.0 and exceeds(extremes.dip, widened(after_time(error, sinh, versinh), added).uu)


@njit(**INTERNAL)
def settles(p, drive, speed, error, peak):
    """Return whether chattering after an impact that leaves at a speed certainly ends in rest, whatever the rounding errors.

    No angle until then exceeds ``peak``. Rest erases the errors. Until then they grow beyond all speeds, without any effect on
    the outcome.
    """
    fastest = speed + of_velocity(error)
    if not fastest < SLOW:
        return False
    bound, highest = settling(p, drive, fastest)
    return bound < math.inf and highest <= peak


@njit(**INTERNAL_INLINE)
def is_lossless(p, event):
    """Return whether an event takes no energy: an impact at the base, or at a brace."""
    return (p.block.brace_restitution if event == BRACE else p.block.restitution) == 1.0


@njit(**INTERNAL)
def after_arc(p, arc, time, extremes, so_far):
    """Return the closeness after an arc that starts at a time of the motion, with its extremes."""
    constant, _ = growth_constant(p, arc)
    decided = so_far.decided and (so_far.settling or is_decided(p, arc, extremes, so_far.error))
    margin, when = so_far.margin, so_far.time
    if arc.angle == 0.0 and not abs(constant) >= abs(margin):
        margin, when = constant, time
    return Closeness(margin, when, decided, so_far.settling, so_far.error)


@njit(**INTERNAL)
def error_at_event(p, mode, arc, coming, error):
    """Return the accumulated error at the event that ends an arc."""
    if mode != FLIGHT:
        return error
    added = rounding_error(p, arc, coming.wait, 1.0 + coming.sinh + coming.versinh)
    return widened(after_time(error, coming.sinh, coming.versinh), added)


@njit(**INTERNAL)
def resolved(p, arc, coming, cut, peak, error):
    """Return mode and arc after an event, with the accumulated error at it.

    Chattering is ``cut`` short only if rest is certain whatever the rounding errors, and if the angle stays below ``peak``.
    """
    time, speed = arc.start + coming.wait, p.block.restitution * -coming.velocity
    if (
        cut
        and coming.event == IMPACT
        and SLOWEST < speed < SLOW
        and settles(p, coming.drive, speed, error, peak)
    ):
        return after_chattering(p, arc, time, coming)
    return after_event(p, arc, time, coming, 0.0)


@njit(**INTERNAL)
def after_its_event(p, arc, coming, after, so_far, cut):
    """Return the closeness after the event that ends an arc.

    ``after`` is the mode and the arc after the event. ``so_far.error`` is the error just before it.
    A block in flight does not settle if chattering is ``cut`` short.
    """
    mode, ahead = after
    error = after_saltation(so_far.error, *event_map(p, arc, coming, mode, ahead.side))
    begins = so_far.settling
    if mode == FLIGHT and coming.event == IMPACT and not (begins or cut):
        begins = settles(p, ahead.drive, ahead.velocity, error, math.inf)
    return Closeness(so_far.margin, so_far.time, so_far.decided, mode == FLIGHT and begins, error)


@njit(**INTERNAL)
def to_end(p, angle, velocity, until, cut, want_peak):
    """Follow a motion until nothing follows, until a time, or to the first contact without loss after the base motion.

    With ``cut``, chattering is cut short if it does not exceed a peak that is wanted.
    """
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    mode, arc, impacts, brace_hits = progress.mode, progress.arc, 0, int(hit)
    highest = from_peak(progress.peak, arc)
    since_rest, cycle, free = 0, 0, p.block.brace_angle == math.inf
    close, status = Closeness(math.nan, math.nan, True, False, EXACT), CROWDED
    for _ in range(MAX_EVENTS):
        coming, extremes = next_event_and_extremes(p, mode, arc)
        time = cycle * p.clock.cycle_length + arc.start
        if mode == FLIGHT and free:
            close = after_arc(p, arc, time, extremes, close)
        if coming.wait == math.inf or time + coming.wait > until:
            status = DONE if coming.wait < math.inf else OVERTURNED if mode == FLIGHT else STILL
            break
        if want_peak and mode == FLIGHT:
            highest = highest_with(p, highest, arc, coming, extremes)
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        close = with_error(close, error_at_event(p, mode, arc, coming, close.error))
        after = resolved(p, arc, coming, cut, highest.reached if want_peak else math.inf, close.error)
        close = after_its_event(p, arc, coming, after, close, cut)
        mode, arc = after
        since_rest = 0 if mode == REST else since_rest + int(coming.event == IMPACT)
        while arc.start > p.clock.cycle_length:
            cycle, arc = cycle + 1, shift_clock(arc, p.clock.cycle_length)
        if coming.event in (IMPACT, BRACE) and is_lossless(p, coming.event) and has_ended(p, arc.drive):
            spare = abs(arc.velocity) - 1.0  # the energy decides
            decided = close.decided and (not free or exceeds(spare, of_growth(close.error)))
            status = OVERTURNED if free and spare > 0.0 else DONE
            close = Closeness(close.margin, close.time, decided, False, close.error)
            break
    peak = peak_of(p, highest)
    return Ending(status, impacts, since_rest, brace_hits, peak, close.margin, close.time, close.decided)


@entry_point(**KERNEL)
def run_to_end(p: FiniteParameters, angle: float, velocity: float, until: float) -> Ending:
    """Follow a motion by ``to_end``, each impact of a chattering sequence included; entry point for Python."""
    return to_end(p, angle, velocity, until, False, False)


@entry_point(**KERNEL)
def run_batch(p: SampledParameters, runs: Runs, want_peak: bool, rows: Endings, stop: Integers1) -> bool:
    """Follow the motion of each of ``runs`` under the samples of ``p``, and write its row of ``rows``.

    Chattering is cut short, so that its impacts do not count for the margin. Returns True if all were followed, False if
    ``stop[0]`` was set before the end.
    """
    for k in range(runs.shape[0]):
        if stop[0] != 0:
            return False
        run = runs[k]
        block = BlockParameters(run.restitution, p.block.brace_angle, p.block.brace_restitution)
        q = SampledParameters(block, SampledForcing(run.scale, p.forcing.tables), p.clock)
        write_ending(rows, k, to_end(q, run.angle, 0.0, math.inf, True, want_peak))
    return True


@entry_point(**KERNEL)
def run_pulses(pulses: Pulses, want_peak: bool, rows: Endings, stop: Integers1) -> bool:
    """Follow the motion from rest under each of ``pulses`` as ``run_batch`` does."""
    for k in range(pulses.shape[0]):
        if stop[0] != 0:
            return False
        pulse = pulses[k]
        block = BlockParameters(pulse.restitution, math.inf, 1.0)
        p = make_pulse(pulse.amplitude, pulse.frequency, pulse.phase, pulse.duration, pulse.duration, block)
        write_ending(rows, k, to_end(p, 0.0, 0.0, math.inf, True, want_peak))
    return True


@njit(**INTERNAL_INLINE)
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
