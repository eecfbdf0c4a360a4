"""Motions that lose nothing: the flights from impact to impact, on whose section the motion is analytic."""

import math
from typing import NamedTuple

from numba import njit

from .averages import digits_of_agreement
from .elementary import WITHIN, WRITTEN_IN
from .events import BRACE, IMPACT, NONE
from .march import PAUSED, march_on

FEWEST_FLIGHTS = 192
FEWEST_CYCLES = 128
ENOUGH_DIGITS = 9.0
CHAOTIC_DIGITS = 6.0
# From so many flights on a torus gains a digit with each doubling at least; motion that sticks to one for long does not.
LONG = 2048
# Shear lets differences grow like the length times a factor, at most e to this; seen: e^3.
SHEAR = 5.0


class Flights(NamedTuple):
    """What is being collected: flights between impacts or, where there are none, between brace hits."""

    event: int
    cycle: int  # of the last event
    time: float
    first_cycle: int
    count: int


@njit(**WITHIN)
def no_flights():
    """Before the first event."""
    return Flights(NONE, 0, 0.0, 0, 0)


@njit(**WITHIN)
def collect(p, flights, rows, events, values):
    """Add recorded events: ``values`` (2, n) takes how long each flight lasted, and the square of the speed it ended with."""
    event, cycle, time, first_cycle, count = flights
    for k in range(rows):
        row = events[k]
        if row[2] != IMPACT and (row[2] != BRACE or event == IMPACT):
            continue
        if row[2] != event:
            event, count, first_cycle = int(row[2]), 0, int(row[0])
        elif count < values.shape[1]:
            values[0, count] = (row[0] - cycle) * p.period + (row[1] - time)
            values[1, count] = row[6] * row[6]
            count += 1
        cycle, time = int(row[0]), row[1]
    return Flights(event, cycle, time, first_cycle, count)


@njit(**WRITTEN_IN)
def follow_flights(p, progress, flights, target, most_events, section_time, section, desk):
    """(status, progress, flights) at the end of cycle ``target``."""
    rows = 0
    while True:
        status, progress, taken, written = march_on(
            p,
            progress,
            target,
            section_time,
            section[rows:],
            desk.events,
            desk.columns,
            desk.growth,
            True,
            False,
        )
        rows += taken
        flights = collect(p, flights, written, desk.events, desk.flights)
        if status != PAUSED or progress.impacts + progress.brace_hits > most_events:
            return status, progress, flights


@njit(**WITHIN)
def agreement(flights, values, growth):
    """(digits to which the averages over both halves agree, whether all is as on a torus).

    The flight times must agree to ENOUGH_DIGITS. Inside an island they are locked to the forcing, and their
    average converges even in a thin chaotic layer. So the average of the squared speeds must converge too, to
    CHAOTIC_DIGITS and ever more, and differences must have grown (``growth``, a logarithm) no more than like the
    length. The digits are the speeds', 0 where there is too little to tell.
    """
    count, cycles = flights.count, flights.cycle - flights.first_cycle
    if count < FEWEST_FLIGHTS or cycles < FEWEST_CYCLES:
        return 0.0, False
    digits = digits_of_agreement(values[1, :count])
    times = digits_of_agreement(values[0, :count])
    needed = min(max(CHAOTIC_DIGITS + math.log2(count / LONG), CHAOTIC_DIGITS), ENOUGH_DIGITS)
    slow = growth <= math.log(max(count, cycles)) + SHEAR
    return digits, digits >= needed and times >= ENOUGH_DIGITS and slow
