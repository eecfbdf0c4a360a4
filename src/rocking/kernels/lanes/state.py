"""State of all lanes: many blocks that march in lockstep and without a branch, one block per lane.

``s.velocity[i]`` is the field ``velocity`` of lane i. A field of all lanes is contiguous, so that one
instruction processes several blocks. A pass (``step``) calls functions of (s, i) for every lane; each lane
executes its next stage:

1. ``bracket`` finds the sign interval of the arc that contains the first zero of u;
2. ``root`` guesses the zero, evaluates the arc there and steps to it;
3. ``impact`` begins the next arc.

Between braces ``braced_arc`` and ``braced_event`` do all of this. Rare cases, and those that are not certain
by a wide margin, are left to the functions for one block: the lane makes a request. The march of a lane from
one checkpoint of its classification to the next is its *leg*.
"""

import math

import numpy as np

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.bracket import MARGIN
from rocking.kernels.numerics.simd import SHORT_ANGLE, SHORT_TIME

LANES = 48

FIELDS = (
    # the system; A Omega, Omega**2, beta Omega; the time below which the elementary functions use the
    # short-time form
    "amplitude", "frequency", "phase", "response", "restitution", "period", "per_period",
    "amplitude_rate", "frequency_square", "response_rate", "short_time_limit",
    # time within the cycle at which a convex sign interval begins on either side
    "sign_change_right", "sign_change_left",
    # 1 + beta cos eta and the absolute value of its derivative at the sign changes; lengths of the concave
    # and the convex intervals; e^+-length of a whole forcing period and of half a convex interval, and tanh
    # of the latter, with a margin
    "sign_change_displacement", "sign_change_velocity", "inside", "outside",
    "turn_growth", "turn_decay", "half_growth", "half_decay", "half_tanh",
    # at a quarter of a concave and of a convex interval from its middle: cos eta, |sin eta|, e^+-quarter
    "cosine_in", "sine_in", "grow_in", "decay_in", "cosine_out", "sine_out", "grow_out", "decay_out",
    # the arc: its stage, its start, and c+ and c-
    "stage", "cycle", "start", "side", "velocity", "cosine", "sine", "growing", "shrinking",
    # ``low``: no zero lies before it; ``end``: the next convex interval begins there, e^end = z; whether that
    # contains no zero; whether u may exceed ``peak``
    "low", "end", "z", "per_z", "cleared", "exceeds",
    # the sign interval of the zero: 1 if concave, up to ``end``, -1 if convex, from there on; no zero lies
    # after ``high``
    "concave", "high",
    # the trial time, the number of trials, and the elementary functions of the time
    "time", "tries", "sinh", "versinh", "excess", "higher", "sin_x", "versine", "lag", "deficit",
    # u, u', cos eta and sin eta at the trial time; before that, where the series that predicts the time is
    # expanded; that time, and the offset of the prediction from it
    "angle_there", "rate_there", "cosine_there", "sine_there", "about", "guess_offset",
    # the coming event
    "wait", "speed", "next_cosine", "next_sine", "next_sinh", "next_versinh", "request",
    # the end of the leg; whether its arcs are logged; numbers of events before the leg, of those without a
    # collected arc, and of all; the largest angle
    "target", "log_on", "counted", "uncollected", "events", "peak",
    # a tangent vector in (Theta, Theta'), and the binary exponent of its scale factor
    "delta_angle", "delta_velocity", "doublings",
    # brace angle and restitution; the angle where the arc starts; whether a brace is met next; number of
    # brace impacts
    "brace_angle", "brace_restitution", "angle", "at_brace", "brace_hits",
    # between braces: (u, u', cos eta, sin eta) at the time ``about``, before which nothing is met
    "knot_angle", "knot_rate", "knot_cosine", "knot_sine",
    # at the start of an arc: the first sign change; m = 2 sqrt(c+ c-), ln(c-/c+), and roughly the time before
    # which u must be positive
    "sign_change", "deep", "twice", "late",
    # log of an arc: its row, the squared speed, and whether more must be logged
    "slot", "square", "due",
)  # fmt: skip
LANE_STATE = np.dtype([(name, np.float64, LANES) for name in FIELDS], align=True)

# Next stage of a lane. IDLE: no block. BRACKET: search the sign intervals. GUESS: guess the zero in its
# interval. MINIMUM: search the minimum of a convex interval. REFINE: step to the zero. FAILED: a request is
# needed. EXTEND: expand the series further on. From NEW_ARC on an arc begins: of a newly loaded block, or,
# AT_EVENT, after the event and its requests.
IDLE, BRACKET, GUESS, MINIMUM, REFINE, FAILED, EXTEND, NEW_ARC, AT_EVENT = (
    float(stage) for stage in range(9)
)
# Request of a lane: nothing; an update of its peak; a read of its log; a new block; the end of its leg; a
# march of its block alone; a search for the coming event; a test for chattering after a slow event. Only the
# first two leave the block in its lane as it is.
NO_REQUEST, UPDATE_PEAK, FLUSH_LOG, LOAD_NEXT, END_LEG, TO_SCALAR, FIND_EVENT, CHECK_ZENO = (
    float(request) for request in range(8)
)
# A block with an event slower than this is marched alone.
SLOWEST = 1e-6
# Maximum number of arcs between two reads of the log; odd for the reason in
# ``classify.workspace.padded_row_length``.
LOG_ROWS = 385
# The tangent vector is rescaled beyond this size.
LARGE = 2.0**64


@njit(**INTERNAL_INLINE)
def log_is_full(s, i):
    """Return whether the log of a lane must be read before another arc is written; never if no log is kept."""
    return s.log_on[i] * (s.events[i] - s.counted[i]) > LOG_ROWS - 3.0


@njit(**INTERNAL_INLINE)
def set_system(s, i, p):
    """Write the parameters of the system of lane i."""
    s.amplitude[i] = p.forcing.amplitude
    s.frequency[i] = p.forcing.frequency
    s.phase[i] = p.forcing.phase
    s.response[i] = p.forcing.response
    s.restitution[i] = p.block.restitution
    s.period[i] = p.forcing.period
    s.per_period[i] = 1.0 / p.forcing.period
    s.amplitude_rate[i] = p.forcing.amplitude * p.forcing.frequency
    s.frequency_square[i] = p.forcing.frequency * p.forcing.frequency
    s.response_rate[i] = p.forcing.response * p.forcing.frequency
    s.short_time_limit[i] = min(SHORT_TIME, SHORT_ANGLE / p.forcing.frequency)
    s.brace_angle[i] = p.block.brace_angle
    s.brace_restitution[i] = p.block.brace_restitution
    s.sign_change_right[i] = within_a_cycle(p, p.forcing.base_half - p.forcing.phase)
    s.sign_change_left[i] = within_a_cycle(p, p.forcing.base_half - p.forcing.phase - math.pi)
    s.sign_change_displacement[i] = p.forcing.sign_change_displacement
    s.sign_change_velocity[i] = p.forcing.sign_change_velocity
    s.inside[i] = p.forcing.base_inside
    s.outside[i] = p.forcing.base_outside
    s.turn_growth[i] = p.forcing.turn_growth
    s.turn_decay[i] = p.forcing.turn_decay
    growth, cosine = p.forcing.base_outside_growth, 1.0 / p.forcing.amplitude
    s.half_growth[i] = math.sqrt(growth)
    s.half_decay[i] = 1.0 / s.half_growth[i]
    # tanh(x/2) = tanh x/(1 + 1/cosh x)
    s.half_tanh[i] = p.forcing.base_outside_tanh / (1.0 + 2.0 / (growth + 1.0 / growth)) * (1.0 + MARGIN)
    # cos(base_half) = -1/A; the functions of half the angle, and of its supplement
    s.cosine_in[i] = math.sqrt(0.5 - 0.5 * cosine)
    s.sine_in[i] = math.sqrt(0.5 + 0.5 * cosine)
    s.grow_in[i] = math.exp(0.25 * p.forcing.base_inside)
    s.decay_in[i] = 1.0 / s.grow_in[i]
    s.cosine_out[i] = -s.sine_in[i]
    s.sine_out[i] = -s.cosine_in[i]
    s.grow_out[i] = math.sqrt(s.half_growth[i])
    s.decay_out[i] = 1.0 / s.grow_out[i]


@njit(**INTERNAL_INLINE)
def within_a_cycle(p, eta):
    """Return the time within the cycle at which the forcing phase reaches ``eta``."""
    return (eta - 2.0 * math.pi * math.floor(eta / (2.0 * math.pi))) * p.forcing.per_frequency
