"""Arc, its states and its end. The motion of the base gives ``drive`` and ``constants`` their meaning."""

import math
from enum import IntEnum
from typing import Annotated, NamedTuple

from rocking.kernels import contract
from rocking.kernels.base.cosine import HarmonicConstants, HarmonicDrive, Pulse, PulseDrive
from rocking.kernels.base.samples import SampledConstants, SampledDrive, Samples
from rocking.kernels.contract import acceleration, evaluate, turn_from
from rocking.kernels.event_kinds import NONE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential, logarithm
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import Full, Slender, Unsymmetric

Drive = HarmonicDrive | SampledDrive | PulseDrive
Constants = Annotated[
    HarmonicConstants | SampledConstants, (HarmonicConstants, SampledConstants, HarmonicConstants)
]
# After this long an arc restarts from its own state: at e^32 the closed form has used up double precision.
MAX_ARC_TIME = 32.0
ROUNDING = 2.0**-53
# After an extremum the search starts later by this fraction of the time, and by ever more, so that rounding cannot find the same
# extremum again.
PASSED = 2.0**-50


class Found(IntEnum):
    """Result of a search for a zero."""

    CROSSING = 0
    NEVER = 1  # proved: no zero at any later time
    LATER = 2  # no zero up to the limit


CROSSING, NEVER, LATER = (int(found) for found in Found)


class Arc(NamedTuple):
    """Start of an arc: side of the base, time within the cycle, u, u', and the forcing there."""

    side: int
    start: float
    angle: float
    velocity: float
    drive: Drive
    constants: Constants  # of its closed form


class Instant(NamedTuple):
    """State of an arc at one instant, with the forcing and the hyperbolic functions of the time since its start."""

    angle: float
    risen: float  # u - u0, to relative accuracy
    velocity: float
    drive: Drive
    sinh: float
    versinh: float  # cosh t - 1


class Transfer(NamedTuple):
    """Derivatives of (u, u') at one instant of an arc by (u, u') at an earlier one."""

    angle_by_angle: float
    angle_by_velocity: float
    velocity_by_angle: float
    velocity_by_velocity: float


class NoGuess(NamedTuple):
    """Guess of the next event: the search for it needs none."""

    time: float


@body(contract.guess_from, Full)
@body(contract.guess_from, Slender, Pulse, Samples, inline=True)
def no_guess(p, wait):
    """Provide ``contract.guess_from`` for a search that needs no guess."""
    return NoGuess(wait)


@body(contract.place_at_start, Unsymmetric)
@body(contract.place_at_start, Slender, inline=True)
def no_place(p, arc):
    """Provide ``contract.place_at_start`` where an arc has no steps."""
    return 0.0


@body(contract.evaluate_onward, Unsymmetric)
@body(contract.evaluate_onward, Slender, inline=True)
def evaluate_anywhere(p, arc, place, t):
    """Provide ``contract.evaluate_onward`` by a closed form, which is the same from each place."""
    return evaluate(p, arc, t), place


@body(contract.resynchronise, Full)
@body(contract.resynchronise, Slender, Pulse, Samples, inline=True)
def unchanged(p, arc):
    """Provide ``contract.resynchronise`` where the place of an arc has no rounding errors to remove."""
    return arc


class Next(NamedTuple):
    """Coming event of an arc, a rest or a contact with a brace: time until it, kind, and the state at that time."""

    wait: float
    event: int
    side: int
    angle: float
    velocity: float
    drive: Drive
    sinh: float  # of the time until it; 0 from a search that does not need it
    versinh: float


class Extremes(NamedTuple):
    """Extremes of the angle on an arc before its event."""

    dip: float  # least of all minima that were searched; infinity if there is none
    dip_time: float  # time from the start of the arc to there
    late: (
        float  # minimum with the least u e^-t: errors grow with time, so that a later one may be less certain
    )
    late_time: float
    low: float  # lower bound of the angle in strides that may contain a minimum and were not searched; infinity if there is none
    reached: float  # an angle that the arc reaches, or 0; infinite if no event follows


NO_EXTREMES = Extremes(math.inf, 0.0, math.inf, 0.0, math.inf, 0.0)
with_low, with_reached = replacing(Extremes, "low"), replacing(Extremes, "reached")


@kernel
def with_dip(e, dip, time):
    """Return the extremes with a minimum at a time after the start of the arc."""
    least, when = (dip, time) if dip < e.dip else (e.dip, e.dip_time)
    counts = dip < e.late * exponential(time - e.late_time)
    late, later = (dip, time) if counts else (e.late, e.late_time)
    return Extremes(least, when, late, later, e.low, e.reached)


class Stretch(NamedTuple):
    """Growth of perturbations along an arc up to its event."""

    rate: float  # they grow as exp(rate t), about
    steps: float  # of the computation; a part of one counts with its eighth power, which exceeds its part of the error


UNIT_RATE = Stretch(1.0, 0.0)


@kernel(inline=True)
def shift_clock(arc, time):
    """Return the arc relative to a clock that is set to 0 at ``time``."""
    return Arc(arc.side, arc.start - time, arc.angle, arc.velocity, arc.drive, arc.constants)


@kernel(inline=True)
def within_reach(p, angle):
    """Clip an angle to the range between base and brace, which rounding may exceed near an event."""
    return min(max(angle, 0.0), p.block.brace_angle)


@kernel(inline=True)
def error_of_arc(arc, t, growth, force):
    """Return an estimate of the rounding error of (u, u') a time t into an arc that is computed from its own state.

    ``growth`` is e^t. The sum of its terms: |v| sinh t, (u + force) (cosh t - 1) and u, where the forcing term never exceeds ``force``.
    """
    short = min(t, 1.0)
    return ROUNDING * growth * ((abs(arc.velocity) + (arc.angle + force) * short) * short + arc.angle)


@kernel
def growth_time(m, grow, shrink):
    """Return the time from which m + grow e^t - |shrink| e^-t is positive, where grow is."""
    b = abs(shrink)
    root = math.sqrt(m * m + 4.0 * grow * b)
    z = 2.0 * b / (m + root) if m > 0.0 else (root - m) / (2.0 * grow)
    return logarithm(z) if z > 1.0 else 0.0


@kernel(inline=True)
def nothing_more(side, drive):
    """Return that no event follows."""
    return Next(math.inf, NONE, side, 0.0, 0.0, drive, 0.0, 0.0)


@kernel
def first_turn_sign(p, arc):
    """Return the sign of u' just after the start of an arc; positive if both u' and u'' vanish (lift-off)."""
    if arc.velocity != 0.0:
        return math.copysign(1.0, arc.velocity)
    return -1.0 if acceleration(p, arc.side, arc.angle, arc.drive) < 0.0 else 1.0


@kernel
def next_turn(p, arc, sign, t, until):
    """Find the next extremum of the angle after t, where sign u' falls through zero.

    Returns
    -------
    tuple of (int, float, Instant)
        Result, as in ``Found``, with its time and the state there.
    """
    start, passed = t, PASSED * (1.0 + t)
    while start < until:
        found, then, now = turn_from(p, arc, sign, start, until)
        if found != CROSSING or then > t:
            return found, then, now
        start, passed = start + passed, 2.0 * passed
    return LATER, until, evaluate(p, arc, until)


@kernel
def arc_peak(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles on the arc up to ``until``."""
    now = evaluate(p, arc, until)
    peak = max(peak, within_reach(p, now.angle))
    t = 0.0
    sign = first_turn_sign(p, arc)
    while True:
        found, t, now = next_turn(p, arc, sign, t, until)
        if found != CROSSING:
            return peak
        peak = max(peak, within_reach(p, now.angle))
        sign = -sign
