"""Workspace of all lanes, allocated once and used for many batches."""

from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.classify.workspace import Workspace, make_workspace
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import intrinsic, njit
from rocking.kernels.lanes.state import LANE_STATE, LANES, LOG_ROWS
from rocking.kernels.march.event_rows import EVENT_ROW, EventRows
from rocking.kernels.march.no_recording import NoRecording
from rocking.kernels.march.tangent import TangentState
from rocking.kernels.signature import Bytes1, Floats1, Floats2, Floats3


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
# ``classify.workspace.padded_row_length``.
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


@njit(**INTERNAL)
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
