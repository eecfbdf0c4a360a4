"""Marching and nothing else, from impact to impact without loss: many blocks in lanes against one after another."""

import math
from time import thread_time

import numpy as np
from numba import njit

from benchmarks.clock import quickest_in_turn
from benchmarks.table import Figure
from rocking.kernels.classify.quasi_periodicity import follow_flights, under_way
from rocking.kernels.classify.reset import begin_tangent
from rocking.kernels.classify.results import asked
from rocking.kernels.classify.workspace import desk
from rocking.kernels.compile_options import COMPILED, MAKING
from rocking.kernels.lanes.rows import (
    ARRIVED,
    BLOCK,
    CERTAINTY,
    CONTENT,
    COUNTED,
    EVENTS,
    EXCEEDS,
    IDLE,
    LANES,
    PEAK_SEEN,
    STAGE,
    WANTS,
    of,
    put,
)
from rocking.kernels.lanes.step import advance, strike
from rocking.kernels.lanes.transfer import find, note, seat, see_peak, set_leg
from rocking.kernels.lanes.workspace import bench
from rocking.kernels.march.march import MOST_EVENTS, UNKNOWN, begin

CYCLES, BEFORE = 3000, 30
BLOCKS = 20 * LANES
TURNS = 7


@njit(**COMPILED)
def last_impacts(systems, cycles, memory, phases, speeds):
    """Of each block that starts at rest the phase of its last impact within so many cycles, and its speed after that."""
    for k in range(systems.shape[0]):
        p = asked(systems[k])
        progress = begin(p, 0.0, 0.0, UNKNOWN)[0]
        begin_tangent(memory.columns, memory.growth)
        _, after, _, _ = follow_flights(
            p, progress, under_way(progress), cycles, MOST_EVENTS, 0.0, 0, memory, False
        )
        phases[k], speeds[k] = math.atan2(after.arc.sine, after.arc.cosine), after.arc.velocity


@njit(**COMPILED)
def alone(systems, speeds, cycles, memory):
    """How many impacts there were."""
    impacts = 0
    for k in range(systems.shape[0]):
        p = asked(systems[k])
        progress = begin(p, 0.0, speeds[k], UNKNOWN)[0]
        begin_tangent(memory.columns, memory.growth)
        _, after, _, _ = follow_flights(
            p, progress, under_way(progress), cycles, MOST_EVENTS, 0.0, 0, memory, False
        )
        impacts += after.impacts
    return impacts


@njit(**MAKING)
def in_lanes(systems, speeds, cycles, memory):
    """How many impacts there were; a lane that ends, or has to leave, takes the next block."""
    s, queue, blocks, impacts = memory.state, 0, LANES, 0.0
    guests = [asked(systems[0])] * LANES
    for i in range(LANES):
        put(s, i, STAGE, IDLE)
        put(s, i, WANTS, BLOCK)
    while True:
        for i in range(LANES):
            wants = of(s, i, WANTS)
            if wants == CERTAINTY:
                wants = find(s, i, guests[i])
            if wants != CONTENT and wants != PEAK_SEEN:
                impacts += of(s, i, EVENTS) - of(s, i, COUNTED) if wants != BLOCK else 0.0
                put(s, i, WANTS, CONTENT)
                put(s, i, STAGE, IDLE)
                blocks -= queue >= systems.shape[0]
                if queue < systems.shape[0]:
                    p = asked(systems[queue])
                    begin_tangent(memory.columns[i], memory.growth[i])
                    seat(s, i, p, begin(p, 0.0, speeds[queue], UNKNOWN)[0], memory.columns[i], 0)
                    set_leg(s, i, cycles, False)
                    guests[i], queue = p, queue + 1
            elif of(s, i, STAGE) == ARRIVED and of(s, i, EXCEEDS) > 0.0:
                see_peak(s, i, guests[i])
        if blocks == 0:
            return impacts
        while True:
            strike(s)
            note(s, memory.flights, memory.trail, False)
            if advance(s):
                break


def against_one(systems):
    """Of ``systems`` that go on for long so many blocks that the lanes stay full."""
    systems = systems[:BLOCKS].copy()
    speeds, memory, lanes = np.empty(len(systems)), desk(CYCLES, 1), bench(CYCLES, 1)
    last_impacts(systems, BEFORE, memory, systems[:, 3], speeds)
    for march, room in ((alone, memory), (in_lanes, lanes)):
        march(systems[:1], speeds, 1, room)
    ways = [lambda: alone(systems, speeds, CYCLES, memory), lambda: in_lanes(systems, speeds, CYCLES, lanes)]
    taken = quickest_in_turn(TURNS, ways, thread_time)
    one, together = (1e9 * seconds / impacts for seconds, impacts in taken)
    yield Figure("marching without loss, an impact in lanes", together, "ns", note=f"{one:.3g} ns one by one")
    yield Figure("  against one by one", one / together, "×", 5, least=True)
