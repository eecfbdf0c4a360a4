"""Workspace of all lanes, allocated once and used for many batches."""

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from rocking.kernels.classify.workspace import NoRecording, Workspace, make_workspace
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.lanes.state import LANE_STATE, LANES, LOG_ROWS
from rocking.kernels.march.event_rows import EVENT_ROW
from rocking.kernels.march.tangent import TangentState


@intrinsic
def prefetch_for_write(typingctx, address):
    """Prefetch the cache line at an address for writing. The processor ignores invalid addresses."""

    def generate(context, builder, signature, arguments):
        pointer, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch.p0i8", fnty=kind)
        # for writing, with high temporal locality, in the data cache
        builder.call(function, [builder.inttoptr(arguments[0], pointer), number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(types.intp), generate


class LaneWorkspace(NamedTuple):
    """Workspace of all lanes: arrays that each lane keeps from leg to leg, and shared ones."""

    state: np.ndarray  # (1,), LANE_STATE
    log: np.ndarray  # (lanes, n), EVENT_ROW: the arcs since the last read
    section: np.ndarray
    scratch: np.ndarray
    events: np.ndarray
    flights: np.ndarray
    weights: np.ndarray
    batches: np.ndarray
    tangent: TangentState
    trial: np.ndarray
    nothing: NoRecording


def make_lane_workspace(max_cycles, max_period):
    """Allocate the workspace of all lanes, as ``make_workspace`` does for one block.

    The state starts at a cache line.
    """
    one, room = make_workspace(max_cycles, max_period), np.zeros(LANE_STATE.itemsize + 64, np.uint8)
    first = -room.ctypes.data % 64
    section, flights, batches, columns, growth = (
        np.zeros((LANES, *part.shape)) for part in (one.section, one.flights, one.batches, *one.tangent)
    )
    return LaneWorkspace(
        room[first : first + LANE_STATE.itemsize].view(LANE_STATE),
        np.zeros((LANES, LOG_ROWS), EVENT_ROW),
        section,
        one.scratch,
        one.events,
        flights,
        one.weights,
        batches,
        TangentState(columns, growth),
        one.trial,
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
