"""Plain marching of undamped motion from impact to impact: lanes compared with one block after another."""

import math
from time import thread_time

import numba
import numpy as np

from benchmarks.clock import quickest_in_turn
from benchmarks.table import Figure
from rocking.kernels.classify.cascade import Run, follow_flights, make_workspace
from rocking.kernels.classify.resets import begin_tangent, new_tracker
from rocking.kernels.classify.torus import under_way
from rocking.kernels.lanes.scalar import find_event, log_arcs, update_peak
from rocking.kernels.lanes.state import (
    FIND_EVENT,
    IDLE,
    LANES,
    LOAD_NEXT,
    NO_REQUEST,
    UPDATE_PEAK,
    load_block,
    make_lane_workspace,
    set_leg,
)
from rocking.kernels.lanes.step import advance, apply_impacts
from rocking.kernels.library.kernel import OPTIONS, kernel
from rocking.kernels.motion.march import MAX_EVENTS, UNKNOWN, begin
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.system import slender_of_row

CYCLES, BEFORE = 3000, 30
BLOCKS = 20 * LANES
TURNS = 7


@kernel
def marched(p, progress, cycles, memory):
    """Return the progress of an undamped block after ``cycles``."""
    begin_tangent(memory.tangent)
    run = Run(new_tracker(progress), under_way(progress), 0.0, 0, True, True)
    return follow_flights(p, run, cycles, MAX_EVENTS, memory, False)[1].tracker.progress


@kernel
def last_impacts(systems, cycles, memory, phases, speeds):
    """Write phase and speed of the last impact of each block within ``cycles`` from rest."""
    for k in range(systems.shape[0]):
        p = slender_of_row(systems[k])
        progress = begin(p, 0.0, 0.0, UNKNOWN)[0]
        after = marched(p, progress, cycles, memory)
        phases[k], speeds[k] = math.atan2(after.arc.drive.sine, after.arc.drive.cosine), after.arc.velocity


@kernel
def alone(systems, speeds, cycles, memory):
    """March the blocks one by one; return the number of impacts."""
    impacts = 0
    for k in range(systems.shape[0]):
        p = slender_of_row(systems[k])
        progress = begin(p, 0.0, speeds[k], UNKNOWN)[0]
        impacts += marched(p, progress, cycles, memory).impacts
    return impacts


@numba.njit(**(OPTIONS | {"_nrt": True}))  # it makes a list
def in_lanes(systems, speeds, cycles, memory):
    """March the blocks in lanes; return the number of impacts. A lane that ends takes the next block."""
    s, queue, blocks, impacts = memory.state[0], 0, LANES, 0.0
    guests = [slender_of_row(systems[0])] * LANES
    for i in range(LANES):
        s.stage[i] = IDLE
        s.request[i] = LOAD_NEXT
    while True:
        for i in range(LANES):
            wants = s.request[i]
            if wants == FIND_EVENT:
                wants = find_event(s, i, guests[i])
            if wants != NO_REQUEST and wants != UPDATE_PEAK:
                impacts += s.events[i] - s.counted[i] if wants != LOAD_NEXT else 0.0
                s.request[i] = NO_REQUEST
                s.stage[i] = IDLE
                blocks -= queue >= systems.shape[0]
                if queue < systems.shape[0]:
                    p = slender_of_row(systems[queue])
                    columns = memory.tangent.columns[i]
                    begin_tangent(TangentState(columns, memory.tangent.growth[i]))
                    load_block(s, i, p, begin(p, 0.0, speeds[queue], UNKNOWN)[0], columns)
                    set_leg(s, i, cycles, False)
                    guests[i], queue = p, queue + 1
            else:
                update_peak(s, i, guests[i])
        if blocks == 0:
            return impacts
        while True:
            apply_impacts(s)
            log_arcs(s, memory.flights, memory.log)
            if advance(s):
                break


def against_one(systems):
    """Time the first BLOCKS of ``systems`` whose motions are long, so that the lanes stay full."""
    systems = systems[:BLOCKS].copy()
    speeds, memory, lanes = np.empty(len(systems)), make_workspace(CYCLES, 1), make_lane_workspace(CYCLES, 1)
    last_impacts(systems, BEFORE, memory, systems[:, 3], speeds)
    for march, room in ((alone, memory), (in_lanes, lanes)):
        march(systems[:1], speeds, 1, room)
    ways = [lambda: alone(systems, speeds, CYCLES, memory), lambda: in_lanes(systems, speeds, CYCLES, lanes)]
    taken = quickest_in_turn(TURNS, ways, thread_time)
    one, together = (1e9 * seconds / impacts for seconds, impacts in taken)
    yield Figure("undamped marching, per impact in lanes", together, "ns", note=f"{one:.3g} ns one by one")
    yield Figure("  compared with one by one", one / together, "×", 5, least=True)
