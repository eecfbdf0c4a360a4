"""Test of undamped motion for quasi-periodicity, by averages over its arcs from impact to impact.

The map from impact to impact is analytic.
"""

from typing import NamedTuple

from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.averages import bumps, digits_with
from rocking.kernels.numerics.elementary import logarithm, logarithm_2

MIN_FLIGHTS = 192
MIN_CYCLES = 128
ENOUGH_DIGITS = 9.0
CHAOTIC_DIGITS = 6.0
# From this number of arcs on, motion on a torus gains at least one digit per doubling; motion that only stays
# close to a torus for long does not.
LONG = 2048
# Shear makes tangent vectors grow in proportion to the length. The factor is at most e to the power of this.
# Observed factors reach e^3.
SHEAR = 5.0
# Near the boundary of an island the shear is large, and chaotic motion with a long sojourn there has similar
# averages. Such motion needs this number of arcs.
SHEARED_FLIGHTS = 8192
SMALL_SHEAR = 1.0
# More growth than ``agreeing_digits`` allows for the largest number of arcs that is kept (``cascade.Workspace``).
OUTGROWN = 20.0


class Flights(NamedTuple):
    """Record of the collected arcs: between impacts or, if there are none, between brace impacts."""

    event: int
    cycle: int  # of the last event
    time: float
    first_cycle: int
    count: int


@kernel
def no_flights():
    """Return the record before the first event."""
    return Flights(NONE, 0, 0.0, 0, 0)


@kernel
def under_way(progress):
    """Return the record before the coming event, which ends the first arc if an impact began it."""
    arc = progress.arc
    if progress.mode == FLIGHT and arc.angle == 0.0 and arc.velocity > 0.0:
        return Flights(IMPACT, progress.cycle, arc.start, progress.cycle, 0)
    return no_flights()


@kernel
def collect(p, flights, rows, events, values):
    """Add the arcs of recorded events: ``values`` (n, 2) takes their durations and their squared final speeds."""
    event, cycle, time, first_cycle, count = flights
    for k in range(rows):
        now, met = int(events[k].cycle), int(events[k].event)
        if met != IMPACT and (met != BRACE or event == IMPACT):
            continue
        if met != event:
            event, count, first_cycle = met, 0, now
        elif count < values.shape[0]:
            values[count, 0] = (now - cycle) * p.forcing.period + (events[k].time - time)
            values[count, 1] = events[k].velocity * events[k].velocity
            count += 1
        cycle, time = now, events[k].time
    return Flights(event, cycle, time, first_cycle, count)


@kernel
def section_needed(growth, target, max_cycles, rows):
    """Return whether the states of a march to ``target`` may be needed.

    They may be on a torus, and for every motion the last ones, at most ``rows``. On a torus tangent vectors
    never grow by more than ``agreeing_digits`` would allow at the end.
    """
    return growth <= max(OUTGROWN, logarithm(max_cycles) + SHEAR) or target > max_cycles - rows


@kernel
def agreeing_digits(flights, values, weights, growth):
    """Compare the averages over both halves of the arcs.

    The durations of the arcs must agree to ENOUGH_DIGITS. Inside an island they are locked to the forcing,
    and their average converges even in a thin chaotic layer. So the average of the squared speeds must
    converge too, to CHAOTIC_DIGITS and later more. The tangent vectors must have grown (``growth``, a
    logarithm) no more than in proportion to the length. The factor must be small unless there are many arcs.

    Returns
    -------
    tuple of (float, bool)
        Digits of the speeds, 0 if there are too few arcs or the growth is larger.
        Whether the motion converges as on a torus.
    """
    count, cycles = flights.count, flights.cycle - flights.first_cycle
    shear = SMALL_SHEAR if count < SHEARED_FLIGHTS else SHEAR
    if too_few(flights) or growth > logarithm(max(count, cycles)) + shear:
        return 0.0, False
    bumps(count // 2, weights)
    digits = digits_with(values[:count, 1], weights)
    needed = min(max(CHAOTIC_DIGITS + logarithm_2(count / LONG), CHAOTIC_DIGITS), ENOUGH_DIGITS)
    return digits, digits >= needed and digits_with(values[:count, 0], weights) >= ENOUGH_DIGITS


@kernel
def too_few(flights):
    """Return whether there are too few arcs for a comparison."""
    return flights.count < MIN_FLIGHTS or flights.cycle - flights.first_cycle < MIN_CYCLES


@kernel
def digits_of_speeds(flights, values, weights):
    """Return the digits of ``agreeing_digits``, regardless of the growth of the tangent vectors."""
    if too_few(flights):
        return 0.0
    bumps(flights.count // 2, weights)
    return digits_with(values[: flights.count, 1], weights)
