"""Working memory of the cascade: made once, for one system after another."""

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from .elementary import WITHIN
from .lanes import LANES, ROWS, TRAIL

# Cycles between looks at a motion that loses nothing.
LEG = 128
# The last states are moved to the front once in so many looks.
SPARE = 3
# Over so many equal parts of the second half of the budget the exponent is measured.
BATCHES = 64


class Nothing(NamedTuple):
    """Arrays without rows, for what is not recorded: made once, since to make one costs as much as half an impact."""

    section: np.ndarray  # (0, 4)
    events: np.ndarray  # (0, 8)
    columns: np.ndarray  # (0, 2)
    growth: np.ndarray  # (0,)


class Desk(NamedTuple):
    """Working memory, for one system after another."""

    section: np.ndarray  # (n, 8), the last cycles: ``note_state``, then ``lossless.sketch``
    scratch: np.ndarray  # (n, 4), a trial orbit's; as many of the last cycles are looked at
    events: np.ndarray  # (n, 8)
    flights: np.ndarray  # (n, 2)
    weights: np.ndarray  # (n/4 + 1,)
    batches: np.ndarray
    columns: np.ndarray  # (2, 2)
    trial: np.ndarray  # (2, 2)
    growth: np.ndarray  # (1,)
    nothing: Nothing


def apart(count):
    """So many numbers, or a few more, that of rows of them not all begin on the same line of the fast memory's pages.

    Lanes write into all their rows in turn; where those compete for a few lines each write waits.
    """
    return count + (8 - count) % 512


@intrinsic
def fetch(typingctx, address):
    """Have the line of memory at an address brought near: it is about to be written. An address beyond all arrays does no harm."""

    def generate(context, builder, signature, arguments):
        pointer, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch.p0i8", fnty=kind)
        # to write, to keep as near as can be, not a program
        builder.call(function, [builder.inttoptr(arguments[0], pointer), number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(types.intp), generate


def desk(max_cycles, max_period):
    """Working memory for runs of up to ``max_cycles`` and orbits of up to ``max_period``."""
    rows = max(4 * max_period, LEG) + 1
    flights = apart(min(max(4 * max_cycles, 1024), 1 << 18))
    return Desk(
        np.empty((rows + SPARE * LEG, 8)),
        np.empty((rows, 4)),
        np.empty((512, 8)),
        np.empty((flights, 2)),
        np.empty(flights // 4 + 1),
        np.empty(BATCHES),
        np.empty((2, 2)),
        np.empty((2, 2)),
        np.empty(1),
        Nothing(np.empty((0, 4)), np.empty((0, 8)), np.empty((0, 2)), np.empty(0)),
    )


class Bench(NamedTuple):
    """Working memory: for each lane what its desk must keep from leg to leg."""

    state: np.ndarray
    trail: np.ndarray  # (lanes, n, 8), the arcs since they were last read, as ``notes.note`` has them
    section: np.ndarray
    scratch: np.ndarray
    events: np.ndarray
    flights: np.ndarray
    weights: np.ndarray
    batches: np.ndarray
    columns: np.ndarray
    trial: np.ndarray
    growth: np.ndarray
    nothing: Nothing


def bench(max_cycles, max_period):
    """Working memory as ``desk`` makes it; the state begins where a vector of the machine may."""
    one, room = desk(max_cycles, max_period), np.zeros(ROWS * LANES + 8)
    first = -(room.ctypes.data // 8) % 8
    section, flights, batches, columns, growth = (
        np.zeros((LANES, *part.shape))
        for part in (one.section, one.flights, one.batches, one.columns, one.growth)
    )
    return Bench(
        room[first : first + ROWS * LANES],
        np.zeros((LANES, TRAIL, 8)),
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


@njit(**WITHIN)
def place(bench, lane):
    """The desk of a lane."""
    return Desk(
        bench.section[lane],
        bench.scratch,
        bench.events,
        bench.flights[lane],
        bench.weights,
        bench.batches[lane],
        bench.columns[lane],
        bench.trial,
        bench.growth[lane],
        bench.nothing,
    )
