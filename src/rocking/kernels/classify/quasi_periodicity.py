"""Motions that lose nothing: the flights from impact to impact, on whose section the motion is analytic."""

import math
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.solution import arc_from
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.march.event_rows import state_at
from rocking.kernels.numerics.averages import bumps, digits_with

MIN_FLIGHTS = 192
MIN_CYCLES = 128
ENOUGH_DIGITS = 9.0
CHAOTIC_DIGITS = 6.0
# From so many flights on a torus gains a digit with each doubling at least; motion that sticks to one for long does not.
LONG = 2048
# Shear lets differences grow like the length times a factor, at most e to this; seen: e^3.
SHEAR = 5.0
# Near the rim of an island the shear is large, and sticky chaos looks the same. Such motion needs this many flights.
SHEARED_FLIGHTS = 8192
SMALL_SHEAR = 1.0
# More than ``agreeing_digits`` allows of as many flights as are kept (``workspace``).
OUTGROWN = 20.0


# Columns of a section row after those of ``note_state``: the arc on which the state lies, and how long ago that began.
SIDE, ANGLE, VELOCITY, ELAPSED = range(4, 8)


class Flights(NamedTuple):
    """What is being collected: flights between impacts or, where there are none, between brace hits."""

    event: int
    cycle: int  # of the last event
    time: float
    first_cycle: int
    count: int


@njit(**INTERNAL)
def no_flights():
    """Before the first event."""
    return Flights(NONE, 0, 0.0, 0, 0)


@njit(**INTERNAL)
def under_way(progress):
    """Before the event to come, which ends the first flight if an impact began it."""
    arc = progress.arc
    if progress.mode == FLIGHT and arc.angle == 0.0 and arc.velocity > 0.0:
        return Flights(IMPACT, progress.cycle, arc.start, progress.cycle, 0)
    return no_flights()


@njit(**INTERNAL)
def collect(p, flights, rows, events, values):
    """Add recorded events: ``values`` (n, 2) takes how long each flight lasted, and the square of the speed it ended with."""
    event, cycle, time, first_cycle, count = flights
    for k in range(rows):
        now, met = int(events[k].cycle), int(events[k].event)
        if met != IMPACT and (met != BRACE or event == IMPACT):
            continue
        if met != event:
            event, count, first_cycle = met, 0, now
        elif count < values.shape[0]:
            values[count, 0] = (now - cycle) * p.period + (events[k].time - time)
            values[count, 1] = events[k].velocity * events[k].velocity
            count += 1
        cycle, time = now, events[k].time
    return Flights(event, cycle, time, first_cycle, count)


@njit(**INTERNAL)
def append_lazy_rows(p, before, events, written, after, section_time, section, count):
    """How many rows ``section`` (n, 8) has when the instants from ``before`` to ``after`` are added to its ``count``.

    Of each is noted the arc on which it lies, (side, angle, velocity) at its start and how long ago that was: few of
    the states themselves are ever asked for (``evaluate_lazy_rows``).
    """
    mode, arc = before.mode, before.arc
    side, start, angle, velocity, begun = float(arc.side), arc.start, arc.angle, arc.velocity, before.cycle
    impacts, brace_hits, due = before.impacts, before.brace_hits, before.cycle + (not before.pending)
    for k in range(written + 1):
        if k < written:
            cycle, time = int(events[k].cycle), events[k].time
            until = cycle + (section_time < time)
        else:
            cycle, time, until = after.cycle, 0.0, after.cycle + (not after.pending)
        while due < until:
            section[count, 0] = math.nan if mode == FLIGHT else side * angle
            section[count, 1], section[count, 2], section[count, 3] = 0.0, impacts, brace_hits
            section[count, SIDE], section[count, ANGLE], section[count, VELOCITY] = side, angle, velocity
            section[count, ELAPSED] = (due - begun) * p.period + (section_time - start)
            count, due = count + 1, due + 1
        if k < written:
            impacts += events[k].event == IMPACT
            brace_hits += events[k].event == BRACE
            begun, start, mode = cycle, time, int(events[k].mode)
            side, angle, velocity = events[k].side, events[k].angle, events[k].velocity
    return count


@njit(**INTERNAL)
def evaluate_lazy_rows(p, section, first, count, section_time):
    """The states of all rows from ``first`` on that were only sketched."""
    for k in range(max(first, 0), count):
        if math.isnan(section[k, 0]):
            side, elapsed = int(section[k, SIDE]), section[k, ELAPSED]
            start = section_time - elapsed
            arc = arc_from(p, side, start, section[k, ANGLE], section[k, VELOCITY])
            section[k, 0], section[k, 1] = state_at(p, FLIGHT, arc, elapsed)


@njit(**INTERNAL)
def section_needed(growth, target, max_cycles, rows):
    """Whether the states of a leg to ``target`` may be asked for: on a torus, and of every motion the last ones, ``rows`` at most.

    On a torus differences never grow by more than ``agreeing_digits`` would allow at the end.
    """
    return growth <= max(OUTGROWN, math.log(max_cycles) + SHEAR) or target > max_cycles - rows


@njit(**INTERNAL)
def agreeing_digits(flights, values, weights, growth):
    """(digits to which the averages over both halves agree, whether all is as on a torus).

    The flight times must agree to ENOUGH_DIGITS. Inside an island they are locked to the forcing, and their
    average converges even in a thin chaotic layer. So the average of the squared speeds must converge too, to
    CHAOTIC_DIGITS and ever more, and differences must have grown (``growth``, a logarithm) no more than like the
    length times a factor. That must be small unless there are many flights. The digits are the speeds', 0 where there
    is too little to tell or differences have grown by more.
    """
    count, cycles = flights.count, flights.cycle - flights.first_cycle
    shear = SMALL_SHEAR if count < SHEARED_FLIGHTS else SHEAR
    if too_few(flights) or growth > math.log(max(count, cycles)) + shear:
        return 0.0, False
    bumps(count // 2, weights)
    digits = digits_with(values[:count, 1], weights)
    needed = min(max(CHAOTIC_DIGITS + math.log2(count / LONG), CHAOTIC_DIGITS), ENOUGH_DIGITS)
    return digits, digits >= needed and digits_with(values[:count, 0], weights) >= ENOUGH_DIGITS


@njit(**INTERNAL)
def too_few(flights):
    """Whether there are too few flights to tell."""
    return flights.count < MIN_FLIGHTS or flights.cycle - flights.first_cycle < MIN_CYCLES


@njit(**INTERNAL)
def digits_of_speeds(flights, values, weights):
    """The digits of ``agreeing_digits``, however much differences have grown."""
    if too_few(flights):
        return 0.0
    bumps(flights.count // 2, weights)
    return digits_with(values[: flights.count, 1], weights)
