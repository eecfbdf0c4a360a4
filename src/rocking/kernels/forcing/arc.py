"""Arc, its states and its end, for every forcing: ``drive`` and ``constants`` belong to the forcing, and only its room reads them."""

import math
from enum import IntEnum
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.drives import (
    FullHarmonicConstants,
    FullHarmonicDrive,
    FullPulseConstants,
    FullPulseDrive,
    FullSampledConstants,
    FullSampledDrive,
    HarmonicConstants,
    HarmonicDrive,
    PulseConstants,
    PulseDrive,
    SampledConstants,
    SampledDrive,
)
from rocking.kernels.numerics.replace_fields import replacing

Drive = HarmonicDrive | SampledDrive | PulseDrive | FullHarmonicDrive | FullSampledDrive | FullPulseDrive
Constants = (
    HarmonicConstants
    | SampledConstants
    | PulseConstants
    | FullHarmonicConstants
    | FullSampledConstants
    | FullPulseConstants
)

# After this long an arc restarts from its own state: at e^32 the closed form has used up double precision.
MAX_ARC_TIME = 32.0
ROUNDING = 2.0**-53


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


@njit(**INTERNAL_INLINE)
def no_guess(p, wait):
    """Provide ``contract.guess_from`` for a search that needs no guess."""
    return NoGuess(wait)


@njit(**INTERNAL_INLINE)
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
    low: float  # lower bound of the angle in strides that may contain a minimum and were not searched; infinity if there is none
    reached: float  # an angle that the arc reaches, or 0; infinite if no event follows


NO_EXTREMES = Extremes(math.inf, 0.0, math.inf, 0.0)
with_low, with_reached = replacing(Extremes, "low"), replacing(Extremes, "reached")


@njit(**INTERNAL_INLINE)
def shift_clock(arc, time):
    """Return the arc relative to a clock that is set to 0 at ``time``."""
    return Arc(arc.side, arc.start - time, arc.angle, arc.velocity, arc.drive, arc.constants)


@njit(**INTERNAL_INLINE)
def within_reach(p, angle):
    """Clip an angle to the range between base and brace, which rounding may exceed near an event."""
    return min(max(angle, 0.0), p.block.brace_angle)


@njit(**INTERNAL_INLINE)
def error_of_arc(arc, t, growth, force):
    """Return an estimate of the rounding error of (u, u') a time t into an arc that is computed from its own state.

    ``growth`` is e^t. The sum of its terms: |v| sinh t, (u + force) (cosh t - 1) and u, where the forcing term never exceeds ``force``.
    """
    short = min(t, 1.0)
    return ROUNDING * growth * ((abs(arc.velocity) + (arc.angle + force) * short) * short + arc.angle)
