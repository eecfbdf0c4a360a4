"""Motion under a base acceleration of finite length, from its start to its end, with its margin.

The states are those of ``march``; no sections and no events are recorded.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.arc import shift_clock
from rocking.kernels.forcing.contract import guess_from, next_event, peak_with
from rocking.kernels.forcing.finite import growth_constant, has_ended, lowest_between, rounding_error
from rocking.kernels.forcing.parameters import FiniteParameters
from rocking.kernels.march.accumulated_error import (
    EXACT,
    after_saltation,
    after_time,
    of_angle,
    of_growth,
    of_velocity,
    widened,
)
from rocking.kernels.march.chatter import base_settling_time
from rocking.kernels.march.impact_law import SLOW, after_event
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.march.march import CROWDED, DONE, MAX_EVENTS, OVERTURNED, STILL
from rocking.kernels.march.tangent import event_map
from rocking.kernels.numerics.elementary import hyperbolic


class Ending(NamedTuple):
    """End of a motion, and how close it came to another."""

    status: int
    impacts: int
    brace_hits: int
    peak: float
    margin: float  # K+ of least size over all lift-offs and impacts; NaN if the block never moves
    margin_time: float
    decided: bool  # whether no rounding error can have changed the outcome


@njit(**INTERNAL)
def is_decided(p, arc, wait, error):
    """Return whether K+ of an arc, and its minima until ``wait``, exceed the accumulated rounding error."""
    constant, rounded = growth_constant(p, arc)
    if abs(constant) <= of_growth(widened(error, rounded)):
        return False
    lowest, when = lowest_between(p, arc, wait)
    if lowest == math.inf:
        return True
    sinh, versinh, _, _ = hyperbolic(when)
    return lowest > of_angle(widened(after_time(error, sinh, versinh), rounding_error(p, arc, when)))


@njit(**INTERNAL)
def settles(p, arc, error):
    """Return whether an impact certainly begins a chattering sequence that ends in rest, whatever the rounding errors.

    Rest erases them. Until then they grow beyond all speeds, without any effect on the outcome.
    """
    speed = arc.velocity + of_velocity(error)
    return speed < SLOW and base_settling_time(p, arc.drive, speed) < math.inf


@njit(**INTERNAL_INLINE)
def is_lossless(p, event):
    """Return whether an event takes no energy: an impact at the base, or at a brace."""
    return (p.block.brace_restitution if event == BRACE else p.block.restitution) == 1.0


@njit(**INTERNAL)
def to_end(p, angle, velocity, until, horizon, want_peak):
    """Follow a motion until nothing follows, until a time, or to the first contact without loss after the base motion.

    Chattering is cut short if it ends within the ``horizon``.
    """
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    mode, arc, peak, impacts, brace_hits = progress.mode, progress.arc, progress.peak, 0, int(hit)
    margin, margin_time, decided, cycle, error = math.nan, math.nan, True, 0, EXACT
    length, guess, settling = p.clock.cycle_length, guess_from(p, 0.0), False
    status = CROWDED
    for _ in range(MAX_EVENTS):
        coming, _ = next_event(p, mode, arc, guess)
        time = cycle * length + arc.start
        if mode == FLIGHT and p.block.brace_angle == math.inf:
            constant, _ = growth_constant(p, arc)
            decided = decided and (settling or is_decided(p, arc, min(coming.wait, until - time), error))
            if arc.angle == 0.0 and not abs(constant) >= abs(margin):
                margin, margin_time = constant, time
        if coming.wait == math.inf:
            status = OVERTURNED if mode == FLIGHT else STILL
            break
        if time + coming.wait > until:
            status = DONE
            break
        if want_peak and mode == FLIGHT:
            peak = peak_with(p, arc, coming, peak)
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        after_mode, after = after_event(p, arc, arc.start + coming.wait, coming, horizon)
        if mode == FLIGHT:
            error = widened(
                after_time(error, coming.sinh, coming.versinh), rounding_error(p, arc, coming.wait)
            )
        error = after_saltation(error, *event_map(p, arc, coming, after_mode, after.side))
        mode, arc = after_mode, after
        settling = mode == FLIGHT and (settling or (coming.event == IMPACT and settles(p, arc, error)))
        while arc.start > length:
            cycle, arc = cycle + 1, shift_clock(arc, length)
        if coming.event in (IMPACT, BRACE) and is_lossless(p, coming.event) and has_ended(p, arc.drive):
            free = abs(arc.velocity) - 1.0
            brace = p.block.brace_angle < math.inf
            decided = decided and (brace or abs(free) > of_growth(error))
            status = OVERTURNED if free > 0.0 and not brace else DONE
            break
    return Ending(status, impacts, brace_hits, peak, margin, margin_time, decided)


@entry_point(**KERNEL)
def run_to_end(p: FiniteParameters, angle: float, velocity: float, until: float) -> Ending:
    """Follow a motion by ``to_end``, each impact of a chattering sequence included; entry point for Python."""
    return to_end(p, angle, velocity, until, 0.0, False)
