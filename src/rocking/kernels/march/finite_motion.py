"""Motion of a slender block under a base acceleration of finite length, from its start to its end, with its margin.

The states are those of ``march``; no sections and no events are recorded.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, REST
from rocking.kernels.forcing import finite
from rocking.kernels.forcing.arc import shift_clock
from rocking.kernels.forcing.contract import restitution_at, settling
from rocking.kernels.forcing.finite import (
    elapsed_until,
    growth_constant,
    has_ended,
    next_event_and_extremes,
    rounding_error,
)
from rocking.kernels.forcing.pulse.parameters import PulseParameters
from rocking.kernels.forcing.sampled.parameters import SampledParameters
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
from rocking.kernels.march.ending import Ending
from rocking.kernels.march.highest_arc import from_peak, highest_with, peak_of
from rocking.kernels.march.impact_law import SLOW, SLOWEST, after_chattering, after_event
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.march.march import CROWDED, DONE, MAX_EVENTS, OVERTURNED, STILL
from rocking.kernels.march.tangent import event_map
from rocking.kernels.numerics.elementary import rough_hyperbolic
from rocking.kernels.numerics.replace_fields import replacing

# Number of impacts from one trial to prove that chattering ends in rest to the next: a trial costs as much as an impact. Over the
# ground motions of the benchmark a run takes the least time near this number.
TRIED = 8


class Closeness(NamedTuple):
    """Margin and accumulated rounding error of a motion, up to the present arc."""

    margin: float
    time: float
    decided: bool
    settling: bool  # whether it is certain that the present impacts accumulate to rest
    error: Covariance


with_error = replacing(Closeness, "error")


@njit(**INTERNAL_INLINE)
def error_after(p, arc, time, error):
    """Return the accumulated error a time after the start of an arc."""
    sinh, cosh = rough_hyperbolic(time)
    return widened(after_time(error, sinh, cosh), rounding_error(p, arc, time, sinh + cosh))


@njit(**INTERNAL)
def is_decided(p, arc, extremes, error, at_event):
    """Return whether K+ of an arc, and its minima before its event, exceed the accumulated rounding error.

    The variance of u is a sum of e^2t and e^-2t with weights that are not negative, and a constant. So it is largest at the start
    or at the event, or where it is certain that none follows.
    """
    constant, rounded = growth_constant(p, arc)
    if not exceeds(constant, of_growth(widened(error, rounded))):
        return False
    if extremes.low < math.inf and not (
        exceeds(extremes.low, error.uu) and exceeds(extremes.low, at_event.uu)
    ):
        return False
    if extremes.dip == math.inf:
        return True
    return extremes.dip > 0.0 and exceeds(extremes.dip, error_after(p, arc, extremes.dip_time, error).uu)


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
def is_lossless(p, coming):
    """Return whether an event is an impact, at the base or at a brace, that takes no energy."""
    if coming.event == BRACE:
        return p.block.brace_restitution == 1.0
    return coming.event == IMPACT and restitution_at(p, -coming.velocity)[0] == 1.0


@njit(**INTERNAL)
def after_arc(p, arc, time, extremes, so_far, at_event):
    """Return the closeness after an arc that starts at a time of the motion, with its extremes and the error at its event."""
    constant, _ = growth_constant(p, arc)
    decided = so_far.decided and (so_far.settling or is_decided(p, arc, extremes, so_far.error, at_event))
    margin, when = so_far.margin, so_far.time
    if arc.angle == 0.0 and not abs(constant) >= abs(margin):
        margin, when = constant, time
    return Closeness(margin, when, decided, so_far.settling, so_far.error)


@njit(**INTERNAL)
def error_at_event(p, mode, arc, coming, error):
    """Return the accumulated error at the event that ends an arc, or where it is certain that none follows."""
    return error_after(p, arc, elapsed_until(p, arc, coming.drive), error) if mode == FLIGHT else error


@njit(**INTERNAL)
def resolved(p, arc, coming, cut, peak, error):
    """Return mode and arc after an event, with the accumulated error at it.

    Chattering is ``cut`` short only if rest is certain whatever the rounding errors, and if the angle stays below ``peak``.
    """
    before = -coming.velocity
    time, speed = arc.start + coming.wait, restitution_at(p, before)[0] * before
    if (
        cut
        and coming.event == IMPACT
        and SLOWEST < speed < SLOW
        and settles(p, coming.drive, speed, error, peak)
    ):
        return after_chattering(p, arc, time, coming)
    return after_event(p, arc, time, coming, 0.0, math.inf)


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
def by_energy(p, arc, close):
    """Return status and closeness after the base motion, where no energy is lost from now on: it decides."""
    spare, free = abs(arc.velocity) - 1.0, p.block.brace_angle == math.inf
    decided = close.decided and (not free or exceeds(spare, of_growth(close.error)))
    status = OVERTURNED if free and spare > 0.0 else DONE
    return status, Closeness(close.margin, close.time, decided, False, close.error)


@njit(**INTERNAL)
def to_end(p, angle, velocity, until, cut, want_peak):
    """Provide ``finite.to_end``."""
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    mode, arc, impacts, brace_hits = progress.mode, progress.arc, 0, int(hit)
    highest = from_peak(progress.peak, arc)
    since_rest, cycle, free = 0, 0, p.block.brace_angle == math.inf
    close, status = Closeness(math.nan, math.nan, True, False, EXACT), CROWDED
    for _ in range(MAX_EVENTS):
        coming, extremes = next_event_and_extremes(p, mode, arc)
        time = cycle * p.clock.cycle_length + arc.start
        error = error_at_event(p, mode, arc, coming, close.error)
        if mode == FLIGHT and free and status == CROWDED:
            close = after_arc(p, arc, time, extremes, close, error)
        if coming.wait == math.inf or time + coming.wait > until:
            status = DONE if coming.wait < math.inf else OVERTURNED if mode == FLIGHT else STILL
            break
        if want_peak and mode == FLIGHT:
            highest = highest_with(p, highest, arc, coming, extremes)
        if status != CROWDED:  # the end is known: without losses all later arcs are as high as this one
            break
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        close = with_error(close, error)
        tried = cut and since_rest % TRIED == TRIED - 1
        after = resolved(p, arc, coming, tried, highest.reached if want_peak else math.inf, close.error)
        close = after_its_event(p, arc, coming, after, close, cut)
        mode, arc = after
        since_rest = 0 if mode == REST else since_rest + int(coming.event == IMPACT)
        while arc.start > p.clock.cycle_length:
            cycle, arc = cycle + 1, shift_clock(arc, p.clock.cycle_length)
        if is_lossless(p, coming) and has_ended(p, arc.drive):
            status, close = by_energy(p, arc, close)
            if not (want_peak and mode == FLIGHT and status == DONE):
                break
    peak = peak_of(p, highest)
    return Ending(status, impacts, since_rest, brace_hits, peak, close.margin, close.time, close.decided)


for kind in (SampledParameters, PulseParameters):
    provide(kind, {finite.to_end: to_end})
