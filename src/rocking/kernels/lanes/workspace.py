"""Working memory of all lanes: made once, for one batch after another."""

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from rocking.kernels.classify.workspace import NoRecording, Workspace, make_workspace
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.lanes.rows import LANES, LOG_ROWS, ROWS


@intrinsic
def prefetch_for_write(typingctx, address):
    """Have the line of memory at an address brought near: it is about to be written. An address beyond all arrays does no harm."""

    def generate(context, builder, signature, arguments):
        pointer, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch.p0i8", fnty=kind)
        # to write, to keep as near as can be, not a program
        builder.call(function, [builder.inttoptr(arguments[0], pointer), number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(types.intp), generate


class LaneWorkspace(NamedTuple):
    """Working memory: for each lane what its workspace must keep from leg to leg."""

    state: np.ndarray
    log: np.ndarray  # (lanes, n, 8), the arcs since they were last read, as ``event_rows.note`` has them
    section: np.ndarray
    scratch: np.ndarray
    events: np.ndarray
    flights: np.ndarray
    weights: np.ndarray
    batches: np.ndarray
    columns: np.ndarray
    trial: np.ndarray
    growth: np.ndarray
    nothing: NoRecording


def make_lane_workspace(max_cycles, max_period):
    """Working memory as ``make_workspace`` makes it; the state begins where a vector of the machine may."""
    one, room = make_workspace(max_cycles, max_period), np.zeros(ROWS * LANES + 8)
    first = -(room.ctypes.data // 8) % 8
    section, flights, batches, columns, growth = (
        np.zeros((LANES, *part.shape))
        for part in (one.section, one.flights, one.batches, one.columns, one.growth)
    )
    return LaneWorkspace(
        room[first : first + ROWS * LANES],
        np.zeros((LANES, LOG_ROWS, 8)),
        section,
        one.scratch,
        one.events,
        flights,
        one.weights,
        batches,
        columns,
        one.trial,
        growth,
        one.nothing,
    )


@njit(**INTERNAL)
def lane_workspace(workspace, lane):
    """The workspace of a lane."""
    return Workspace(
        workspace.section[lane],
        workspace.scratch,
        workspace.events,
        workspace.flights[lane],
        workspace.weights,
        workspace.batches[lane],
        workspace.columns[lane],
        workspace.trial,
        workspace.growth[lane],
        workspace.nothing,
    )
