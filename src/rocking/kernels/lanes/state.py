"""The state of many blocks that march in lockstep, one block a lane, without a branch.

``s.velocity[i]`` is the field ``velocity`` of lane i. A field of all lanes is contiguous, so that one instruction
moves several blocks. A pass (``step``) calls one function of (s, i) for every lane, and every lane does its next stage:

1. ``bracket`` walks along the stretches of the arc to the one in which the first zero of u lies;
2. ``root`` guesses the zero, evaluates the arc there and steps to it;
3. ``impact`` begins the next arc.

Between braces ``braced_arc`` and ``braced_event`` do all that. Whatever is rare, or not certain by a wide margin, is left
to the functions for one block: the lane makes a request.
"""

import math

import numpy as np
from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.numerics.simd import SHORT_ANGLE, SHORT_TIME

LANES = 48

FIELDS = (
    # the system; A Omega, Omega**2, beta Omega; up to when the elementary functions are those of a short time
    "amplitude", "frequency", "phase", "response", "restitution", "period", "per_period",
    "amplitude_rate", "frequency_square", "response_rate", "short_time_limit",
    # when, within the cycle, a convex stretch begins on either side
    "sign_change_right", "sign_change_left",
    # 1 + beta cos eta and the size of its rate at the cuts; lengths of the concave and the convex stretches; e^+-length
    # of a whole turn and of half of a convex stretch, the hyperbolic tangent of that, with a margin
    "sign_change_displacement", "sign_change_velocity", "inside", "outside",
    "turn_growth", "turn_decay", "half_growth", "half_decay", "half_tanh",
    # of a concave and of a convex stretch a quarter from their middle: cos eta, the size of sin eta, e^+-quarter
    "cosine_in", "sine_in", "grow_in", "decay_in", "cosine_out", "sine_out", "grow_out", "decay_out",
    # the arc: where it starts, and c+ and c-
    "stage", "cycle", "start", "side", "velocity", "cosine", "sine", "growing", "shrinking",
    # no zero lies before ``low``; at ``end``, e^end = z, the next convex stretch begins; whether that holds no zero; whether
    # u may exceed ``peak``
    "low", "end", "z", "per_z", "cleared", "exceeds",
    # the stretch of the zero: 1 where it is concave, to ``end``, -1 where convex, from there on; no zero lies after ``high``
    "concave", "high",
    # the trial time, how many there were, and the elementary functions of it
    "time", "tries", "sinh", "versinh", "excess", "higher", "sin_x", "versine", "lag", "deficit",
    # u, u', cos eta and sin eta there, and before that where the series that guesses the time is about; when that is, and
    # how much later it is entered
    "angle_there", "rate_there", "cosine_there", "sine_there", "about", "guess_offset",
    # the event to come
    "wait", "speed", "next_cosine", "next_sine", "next_sinh", "next_versinh", "request",
    # the end of the leg; whether its arcs are logged; the events counted before it began, those of no flight that was
    # collected, all; the largest angle
    "target", "log_on", "counted", "uncollected", "events", "peak",
    # a difference in (Theta, Theta'), to be doubled so often
    "delta_angle", "delta_velocity", "doublings",
    # where braces stand and what they give back; the angle where the arc starts; whether a brace is met next; hits by now
    "brace_angle", "brace_restitution", "angle", "at_brace", "brace_hits",
    # between braces: (u, u', cos eta, sin eta) at the time ``about``, up to which nothing is met
    "knot_angle", "knot_rate", "knot_cosine", "knot_sine",
    # where an arc begins: the first cut; m = 2 sqrt(c+ c-), ln(c-/c+), and roughly the time up to which u must be positive
    "sign_change", "deep", "twice", "late",
    # where an arc is logged: into which row, the square of the speed, whether there is more to log
    "slot", "square", "due",
)  # fmt: skip
LANE_STATE = np.dtype([(name, np.float64, LANES) for name in FIELDS], align=True)

# What is next for a lane: nothing; to walk; to guess the zero in its stretch; to look for the bottom of a dip; to step to the
# zero; what none of these can do; to look from further on; an arc, of a block that has just come; the event, once it was
# attended to, and then an arc: from NEW_ARC on an arc begins.
IDLE, BRACKET, GUESS, MINIMUM, REFINE, FAILED, EXTEND, NEW_ARC, AT_EVENT = (
    float(stage) for stage in range(9)
)
# What a lane requests: nothing; that its peak be updated; that its log be read; a block; that its leg be ended; that its block
# be marched alone; that the coming event be found; that it be tested whether what follows a slow event accumulates. Only the
# first two leave its block in the lane as it is.
NO_REQUEST, UPDATE_PEAK, FLUSH_LOG, LOAD_NEXT, END_LEG, TO_SCALAR, FIND_EVENT, CHECK_ZENO = (
    float(request) for request in range(8)
)
# An event slower than this is marched alone.
SLOWEST = 1e-6
# Arcs since the log was last read; odd, as ``classify.workspace.padded_row_length`` would have it.
LOG_ROWS = 385
# Differences are brought back to size 1 from here.
LARGE = 2.0**64


@njit(**SIMD_INLINE)
def log_is_full(s, i):
    """Whether the log of a lane must be read before another arc is written into it; never where none is kept."""
    return s.log_on[i] * (s.events[i] - s.counted[i]) > LOG_ROWS - 3.0


@njit(**SIMD_INLINE)
def set_system(s, i, p):
    """Write what lane i must know of its system."""
    s.amplitude[i] = p.amplitude
    s.frequency[i] = p.frequency
    s.phase[i] = p.phase
    s.response[i] = p.response
    s.restitution[i] = p.restitution
    s.period[i] = p.period
    s.per_period[i] = 1.0 / p.period
    s.amplitude_rate[i] = p.amplitude * p.frequency
    s.frequency_square[i] = p.frequency * p.frequency
    s.response_rate[i] = p.response * p.frequency
    s.short_time_limit[i] = min(SHORT_TIME, SHORT_ANGLE / p.frequency)
    s.brace_angle[i] = p.brace_angle
    s.brace_restitution[i] = p.brace_restitution
    s.sign_change_right[i] = within_a_cycle(p, p.base_half - p.phase)
    s.sign_change_left[i] = within_a_cycle(p, p.base_half - p.phase - math.pi)
    s.sign_change_displacement[i] = p.sign_change_displacement
    s.sign_change_velocity[i] = p.sign_change_velocity
    s.inside[i] = p.base_inside
    s.outside[i] = p.base_outside
    s.turn_growth[i] = p.turn_growth
    s.turn_decay[i] = p.turn_decay
    s.half_growth[i] = math.exp(0.5 * p.base_outside)
    s.half_decay[i] = math.exp(-0.5 * p.base_outside)
    s.half_tanh[i] = math.tanh(0.5 * p.base_outside) * (1.0 + MARGIN)
    s.cosine_in[i] = math.cos(0.5 * p.base_half)
    s.sine_in[i] = math.sin(0.5 * p.base_half)
    s.grow_in[i] = math.exp(0.25 * p.base_inside)
    s.decay_in[i] = math.exp(-0.25 * p.base_inside)
    s.cosine_out[i] = -s.sine_in[i]
    s.sine_out[i] = -s.cosine_in[i]
    s.grow_out[i] = math.exp(0.25 * p.base_outside)
    s.decay_out[i] = math.exp(-0.25 * p.base_outside)


@njit(**SIMD_INLINE)
def within_a_cycle(p, eta):
    """Return the time within the cycle at which the forcing has turned by ``eta``."""
    return (eta - 2.0 * math.pi * math.floor(eta / (2.0 * math.pi))) * p.per_frequency
