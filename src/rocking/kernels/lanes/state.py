"""State of all lanes: many blocks that march in lockstep and without a branch, one block per lane.

``s.velocity[i]`` is the field ``velocity`` of lane i. A field of all lanes is contiguous, so that one
instruction processes several blocks. A pass (``step``) calls functions of (s, i) for every lane; each lane
executes its next stage:

1. ``search.walk`` finds the sign interval of the arc that contains the first zero of u;
2. ``search.guess`` guesses the zero, evaluates the arc there and steps to it;
3. ``step.apply_impacts`` begins the next arc.

Between braces ``search.predict_event`` and ``step.apply_events`` do all of this. Rare cases, and those that are not certain
by a wide margin, are left to the functions for one block: the lane makes a request. The march of a lane from
one checkpoint of its classification to the next is its *leg*.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.arc.arc import shift_clock
from rocking.kernels.arc.fast_search_cosine import MARGIN
from rocking.kernels.arc.slender_cosine import arc_with
from rocking.kernels.base.cosine import HarmonicDrive, harmonic_term
from rocking.kernels.classify.cascade import Run, Workspace, make_room, make_workspace, most_events
from rocking.kernels.classify.resets import moved_on
from rocking.kernels.classify.section import append_lazy_rows
from rocking.kernels.classify.torus import Flights
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.library.kernel import intrinsic, kernel
from rocking.kernels.library.signature import Bytes1, Floats1, Floats2, Floats3
from rocking.kernels.motion.march import CROWDED, DONE, UNKNOWN, NoRecording, Progress
from rocking.kernels.motion.observers import EVENT_ROW, EventRows
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.numerics.elementary import exponential, hypotenuse, logarithm
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
# ``classify.cascade.padded_row_length``.
LOG_ROWS = 385
# The tangent vector is rescaled beyond this size.
LARGE = 2.0**64


@kernel(inline=True)
def log_is_full(s, i):
    """Return whether the log of a lane must be read before another arc is written; never if no log is kept."""
    return s.log_on[i] * (s.events[i] - s.counted[i]) > LOG_ROWS - 3.0


@kernel(inline=True)
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
    s.grow_in[i] = exponential(0.25 * p.forcing.base_inside)
    s.decay_in[i] = 1.0 / s.grow_in[i]
    s.cosine_out[i] = -s.sine_in[i]
    s.sine_out[i] = -s.cosine_in[i]
    s.grow_out[i] = math.sqrt(s.half_growth[i])
    s.decay_out[i] = 1.0 / s.grow_out[i]


@kernel(inline=True)
def within_a_cycle(p, eta):
    """Return the time within the cycle at which the forcing phase reaches ``eta``."""
    return (eta - 2.0 * math.pi * math.floor(eta / (2.0 * math.pi))) * p.forcing.per_frequency


@intrinsic
def prefetch_for_write(typingctx, address):
    """Prefetch the cache line at an address for writing. The processor ignores invalid addresses."""
    from llvmlite import ir
    from numba import types

    def generate(context, builder, signature, arguments):
        pointer, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch.p0i8", fnty=kind)
        # for writing, with high temporal locality, in the data cache
        builder.call(function, [builder.inttoptr(arguments[0], pointer), number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(types.intp), generate


# Room for the work item of a lane: its system and its classification. An odd number of cache lines, for the reason in
# ``classify.cascade.padded_row_length``.
WORK_BYTES = 960
LaneStates = Annotated[np.ndarray, LANE_STATE, 1]
LaneLogs = Annotated[np.ndarray, EVENT_ROW, 2]


@intrinsic
def store_work(typingctx, address, lane, work):
    """Store a work item, or part of it, for a lane at an address: a list of them would be an allocation in compiled code."""
    from numba import types

    def generate(context, builder, signature, arguments):
        place = work_place(context, builder, signature.args[2], arguments)
        builder.store(arguments[2], place)
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, work), generate


@intrinsic
def load_work(typingctx, address, lane, like):
    """Return what ``store_work`` stored for a lane, of the type of ``like``."""
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.load(work_place(context, builder, signature.args[2], arguments))

    return like(types.intp, types.intp, like), generate


def work_place(context, builder, work, arguments):
    """Return the code of the address of the work item of a lane. ValueError: if it is longer than WORK_BYTES."""
    from llvmlite import ir

    kind = context.get_value_type(work)
    size = context.get_abi_sizeof(kind)
    if size > WORK_BYTES:
        raise ValueError(f"a work item has {size} bytes, more than {WORK_BYTES}")
    offset = builder.mul(arguments[1], ir.IntType(64)(WORK_BYTES))
    return builder.inttoptr(builder.add(arguments[0], offset), kind.as_pointer())


class LaneTangents(NamedTuple):
    """Tangent vectors of all lanes: a ``TangentState`` for each."""

    columns: Floats3  # (lanes, 2, 2)
    growth: Floats2  # (lanes, 1)


class LaneWorkspace(NamedTuple):
    """Workspace of all lanes: arrays that each lane keeps from leg to leg, and shared ones."""

    state: LaneStates  # (1,), LANE_STATE
    log: LaneLogs  # (lanes, n), EVENT_ROW: the arcs since the last read
    section: Floats3
    scratch: Floats2
    events: EventRows
    flights: Floats3
    weights: Floats1
    batches: Floats2
    tangent: LaneTangents
    trial: Floats2
    works: Bytes1  # (lanes WORK_BYTES,), by ``store_work``
    parameters: (
        Bytes1  # as ``works``: those of the systems once more, because most requests need nothing else
    )
    nothing: NoRecording


def make_lane_workspace(max_cycles, max_period):
    """Allocate the workspace of all lanes, as ``make_workspace`` does for one block.

    The state starts at a cache line.
    """
    one, room = make_workspace(max_cycles, max_period), np.zeros(LANE_STATE.itemsize + 64, np.uint8)
    first = -room.ctypes.data % 64
    # Not cleared, because a lane reads only what it has written: clearing 30 MB for each tile of a map takes long.
    section, flights, batches, columns, growth = (
        np.empty((LANES, *part.shape)) for part in (one.section, one.flights, one.batches, *one.tangent)
    )
    return LaneWorkspace(
        room[first : first + LANE_STATE.itemsize].view(LANE_STATE),
        np.empty((LANES, LOG_ROWS), EVENT_ROW),
        section,
        one.scratch,
        one.events,
        flights,
        one.weights,
        batches,
        LaneTangents(columns, growth),
        one.trial,
        np.zeros(LANES * WORK_BYTES, np.uint8),
        np.zeros(LANES * WORK_BYTES, np.uint8),
        one.nothing,
    )


@kernel
def lane_workspace(workspace, lane):
    """Return the workspace of one lane."""
    return Workspace(
        workspace.section[lane],
        workspace.scratch,
        workspace.events,
        workspace.flights[lane],
        workspace.weights,
        workspace.batches[lane],
        TangentState(workspace.tangent.columns[lane], workspace.tangent.growth[lane]),
        workspace.trial,
        workspace.nothing,
    )


LN2 = math.log(2.0)


@kernel(inline=True)
def load_block(s, i, p, progress, columns):
    """Load a block into a lane."""
    set_system(s, i, p)
    arc, events = progress.arc, progress.impacts + progress.brace_hits
    s.cycle[i] = progress.cycle
    s.start[i] = arc.start
    s.side[i] = arc.side
    s.angle[i] = arc.angle
    s.velocity[i] = arc.velocity
    s.cosine[i] = arc.drive.cosine
    s.sine[i] = arc.drive.sine
    s.events[i] = events
    s.counted[i] = events
    s.brace_hits[i] = progress.brace_hits
    s.peak[i] = progress.peak
    # The first event of a block that starts away from the base, or slowly, is found by the functions for one block.
    lifts = arc.velocity == 0.0 and harmonic_term(p, arc.drive.cosine) > 0.0
    known = p.block.brace_angle < math.inf or (arc.angle == 0.0 and (arc.velocity >= SLOWEST or lifts))
    s.stage[i] = NEW_ARC if known else FAILED
    s.exceeds[i] = 1.0
    set_difference(s, i, columns)


@kernel(inline=True)
def set_difference(s, i, columns):
    """Set the tangent vector of a lane."""
    s.delta_angle[i] = columns[0, 0]
    s.delta_velocity[i] = columns[0, 1]
    s.doublings[i] = 0.0


@kernel(inline=True)
def set_leg(s, i, target, logged):
    """Set the end of the leg of a lane, and whether its arcs are logged."""
    s.target[i] = target
    s.log_on[i] = logged


@kernel(inline=True)
def set_collection(s, i, run):
    """Set the number of events of a lane before its first collected arc; the arcs of damped motions are not collected."""
    s.uncollected[i] = s.events[i] - run.flights.count if run.lossless else math.inf


@kernel
def arc_of(s, i, p):
    """Return the present arc of a lane."""
    side, start = int(s.side[i]), s.start[i]
    return arc_with(p, side, start, s.angle[i], s.velocity[i], HarmonicDrive(s.cosine[i], s.sine[i]))


@kernel(inline=True)
def read_growth(s, i, columns, growth):
    """Add the logarithm of the tangent growth to ``growth``, and write the normalised vector into ``columns``."""
    a, b = s.delta_angle[i], s.delta_velocity[i]
    size = hypotenuse(a, b)
    growth[0] += logarithm(size) + s.doublings[i] * LN2
    columns[0, 0], columns[0, 1] = a / size, b / size
    set_difference(s, i, columns)


@kernel(inline=True)
def flights_by_now(s, i, flights, most):
    """Return the number of collected arcs, including those since the lane was last read."""
    return min(flights.count + int(s.events[i]) - int(s.counted[i]), most)


@kernel
def progress_of(s, i, p, before, ends, section_time):
    """Return the ``Progress`` of a lane, which was ``before`` when last read; if the leg ``ends``, at its end."""
    arc, cycle, target = arc_of(s, i, p), int(s.cycle[i]), int(s.target[i])
    pending = arc.start <= section_time
    if ends:
        arc, cycle, pending = shift_clock(arc, (target - cycle) * p.forcing.period), target, True
    elif cycle < before.cycle:
        # the present arc began before the lane was last read
        arc, cycle = shift_clock(arc, (before.cycle - cycle) * p.forcing.period), before.cycle
        pending = before.pending
    hits = int(s.brace_hits[i])
    return Progress(
        mode=FLIGHT,
        cycle=cycle,
        arc=arc,
        pending=pending,
        crowd=0,
        impacts=int(s.events[i]) - hits,
        brace_hits=hits,
        peak=s.peak[i],
        no_return=math.inf,
        last_wait=UNKNOWN[1],
        wait_before=s.wait[i] if s.stage[i] == AT_EVENT else UNKNOWN[0],
        strain=-math.inf,
        place=0,
    )


@kernel
def unload_block(s, i, request, p, run, workspace, log):
    """Return the run of a lane, with all events since it was last read.

    If the request is END_LEG, the run is at the end of the leg.
    """
    tracker, flights, section_time, count, lossless, measuring = run
    before, written = tracker.progress, int(s.events[i]) - int(s.counted[i])
    if lossless and written > 0:
        collected = flights_by_now(s, i, flights, workspace.flights.shape[0])
        flights = Flights(IMPACT, int(s.cycle[i]), s.start[i], flights.first_cycle, collected)
    after = progress_of(s, i, p, before, request == END_LEG, section_time)
    if s.log_on[i] > 0.0:
        count = make_room(
            workspace.section, count, after.cycle + 1 - before.cycle, workspace.scratch.shape[0]
        )
        count = append_lazy_rows(p, before, log[1:], written, after, section_time, workspace.section, count)
    else:
        count = 0
    s.counted[i] = s.events[i]
    if lossless or measuring:
        read_growth(s, i, workspace.tangent.columns, workspace.tangent.growth)
    return Run(moved_on(tracker, after), flights, section_time, count, lossless, measuring)


@kernel
def status_of(s, i, max_cycles):
    """Return the status of the march of a lane: CROWDED after more events than a motion may have."""
    return CROWDED if int(s.events[i]) > most_events(max_cycles) else DONE
