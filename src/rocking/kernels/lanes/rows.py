"""Many blocks in lockstep: the march of blocks that fly from event to event, without a branch.

A lane holds one block: row r of lane i lies at ``state[r * LANES + i]``, so that one instruction moves several blocks.
In a pass every lane does what is next for it. It walks along the stretches of its arc to the one in which the first
zero of u lies (``bracket``), guesses it there, evaluates the arc and steps to it (``root``), and the impact
begins the next arc (``impact``); between braces ``braced_arc`` and ``braced_event`` do all that. Whatever is rare, or
not certain by a wide margin, is left to the functions for one block: the lane wants attention.
"""

import math

from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.numerics.simd import SHORT_ANGLE, SHORT_TIME

LANES = 48

(
    # the system; A Omega, Omega**2, beta Omega, 2 beta Omega**2; up to when the elementary functions are those of a short time
    AMPLITUDE, FREQUENCY, PHASE, RESPONSE, RESTITUTION, PERIOD, PER_PERIOD,
    AMPLITUDE_RATE, FREQUENCY_SQUARE, RESPONSE_RATE, CREST_CURVATURE, SHORT_TIME_LIMIT,
    # when, within the cycle, a convex stretch begins on either side
    CUT_RIGHT, CUT_LEFT,
    # 1 + beta cos eta and the size of its rate at the cuts; lengths of the concave and the convex stretches; e^+-length
    # of a whole turn and of half of a convex stretch, the hyperbolic tangent of that, with a margin
    CUT_PLACE, CUT_RATE, INSIDE, OUTSIDE, TURN_GROWTH, TURN_DECAY, HALF_GROWTH, HALF_DECAY, HALF_TANH,
    # of a concave and of a convex stretch a quarter from their middle: cos eta, the size of sin eta, e^+-quarter
    COSINE_IN, SINE_IN, GROW_IN, DECAY_IN, COSINE_OUT, SINE_OUT, GROW_OUT, DECAY_OUT,
    # the arc: where it starts, and c+ and c-
    STAGE, CYCLE, START, SIDE, VELOCITY, COSINE, SINE, GROWING, SHRINKING,
    # no zero lies before LOW; at END, e^END = Z, the next convex stretch begins; whether that holds no zero; whether u
    # may exceed PEAK
    LOW, END, Z, PER_Z, CLEARED, EXCEEDS,
    # the stretch of the zero: 1 where it is concave, to END, -1 where convex, from there on; no zero lies after HIGH
    CONCAVE, HIGH,
    # the time looked at, how often one has been, and what the elementary functions are there
    TIME, TRIES, SINH, VERSINH, EXCESS, HIGHER, SIN_X, VERSINE, LAG, DEFICIT,
    # u, u', cos eta and sin eta there, and before that where the series that guesses the time is about; when that is, and
    # how much later it is entered
    ANGLE_THERE, RATE_THERE, COSINE_THERE, SINE_THERE, ABOUT, GUESS_OFFSET,
    # the event to come
    WAIT, SPEED, NEXT_COSINE, NEXT_SINE, NEXT_SINH, NEXT_VERSINH, REQUEST,
    # the end of the leg; whether its arcs are asked for; the events counted before it began, those of no flight that was
    # collected, all; the largest angle
    TARGET, LOG_ON, COUNTED, UNCOLLECTED, EVENTS, PEAK,
    # a difference in (Theta, Theta'), to be doubled so often
    DELTA_ANGLE, DELTA_VELOCITY, DOUBLINGS,
    # where braces stand and what they give back; the angle where the arc starts; whether a brace is met next; hits by now
    BRACE_ANGLE, BRACE_RESTITUTION, ANGLE, AT_BRACE, BRACE_HITS,
    # between braces: (u, u', cos eta, sin eta) at the time ABOUT, up to which nothing is met
    KNOT_ANGLE, KNOT_RATE, KNOT_COSINE, KNOT_SINE,
    ROWS,
) = range(90)  # fmt: skip

# Where an arc begins, and nothing is looked at yet: the first cut; m = 2 sqrt(c+ c-), ln(c-/c+), and roughly the time up to
# which u must be positive, if there is one.
CUT, DEEP, TWICE, LATE = SINH, VERSINH, EXCESS, HIGHER
# After that, when what ended is noted: where, the square of the speed, whether there is more to note.
SLOT, SQUARE, DUE = SIN_X, VERSINE, LAG

# What is next for a lane: nothing; to walk; to guess the zero in its stretch; to look for the bottom of a dip; to step to the
# zero; what none of these can do; to look from further on; an arc, of a block that has just come; the event, once it was
# attended to, and then an arc: from NEW_ARC on an arc begins.
IDLE, BRACKET, GUESS, MINIMUM, REFINE, FAILED, EXTEND, NEW_ARC, AT_EVENT = (
    float(stage) for stage in range(9)
)
# What a lane wants: nothing; that its peak be looked at; that its log be read; a block; that its leg be ended; that its block
# be marched alone; that the coming event be found; that it be asked whether what follows a slow event accumulates.
NO_REQUEST, UPDATE_PEAK, FLUSH_LOG, LOAD_NEXT, END_LEG, TO_SCALAR, FIND_EVENT, CHECK_ZENO = (
    float(want) for want in range(8)
)
# An event slower than this is marched alone.
SLOWEST = 1e-6
# Arcs since the log was last read; odd, as ``workspace.apart`` would have it.
LOG_ROWS = 385
# Differences are brought back to size 1 from here.
LARGE = 2.0**64


@njit(**SIMD_INLINE)
def load(s, i, row):
    """A number of lane i."""
    return s[row * LANES + i]


@njit(**SIMD_INLINE)
def store(s, i, row, value):
    """Set a number of lane i."""
    s[row * LANES + i] = value


@njit(**SIMD_INLINE)
def trail_is_full(trails, events, counted):
    """Whether a log must be read before another arc is written into it: where none is asked for (``trails`` 0) never."""
    return trails * (events - counted) > LOG_ROWS - 3.0


@njit(**SIMD_INLINE)
def set_system(s, i, p):
    """What lane i must know of its system."""
    store(s, i, AMPLITUDE, p.amplitude)
    store(s, i, FREQUENCY, p.frequency)
    store(s, i, PHASE, p.phase)
    store(s, i, RESPONSE, p.response)
    store(s, i, RESTITUTION, p.restitution)
    store(s, i, PERIOD, p.period)
    store(s, i, PER_PERIOD, 1.0 / p.period)
    store(s, i, AMPLITUDE_RATE, p.amplitude * p.frequency)
    store(s, i, FREQUENCY_SQUARE, p.frequency * p.frequency)
    store(s, i, RESPONSE_RATE, p.response * p.frequency)
    store(s, i, CREST_CURVATURE, 2.0 * p.response * p.frequency * p.frequency)
    store(s, i, SHORT_TIME_LIMIT, min(SHORT_TIME, SHORT_ANGLE / p.frequency))
    store(s, i, BRACE_ANGLE, p.brace_angle)
    store(s, i, BRACE_RESTITUTION, p.brace_restitution)
    cut = p.base_half - p.phase
    for row, eta in ((CUT_RIGHT, cut), (CUT_LEFT, cut - math.pi)):
        store(s, i, row, (eta - 2.0 * math.pi * math.floor(eta / (2.0 * math.pi))) * p.per_frequency)
    store(s, i, CUT_PLACE, p.cut_place)
    store(s, i, CUT_RATE, p.cut_rate)
    store(s, i, INSIDE, p.base_inside)
    store(s, i, OUTSIDE, p.base_outside)
    store(s, i, TURN_GROWTH, p.turn_growth)
    store(s, i, TURN_DECAY, p.turn_decay)
    store(s, i, HALF_GROWTH, math.exp(0.5 * p.base_outside))
    store(s, i, HALF_DECAY, math.exp(-0.5 * p.base_outside))
    store(s, i, HALF_TANH, math.tanh(0.5 * p.base_outside) * (1.0 + MARGIN))
    cosine, sine = math.cos(0.5 * p.base_half), math.sin(0.5 * p.base_half)
    store(s, i, COSINE_IN, cosine)
    store(s, i, SINE_IN, sine)
    store(s, i, GROW_IN, math.exp(0.25 * p.base_inside))
    store(s, i, DECAY_IN, math.exp(-0.25 * p.base_inside))
    store(s, i, COSINE_OUT, -sine)
    store(s, i, SINE_OUT, -cosine)
    store(s, i, GROW_OUT, math.exp(0.25 * p.base_outside))
    store(s, i, DECAY_OUT, math.exp(-0.25 * p.base_outside))
