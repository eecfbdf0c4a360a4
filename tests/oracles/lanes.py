"""March in lanes only, up to a given cycle; uncertain events are left to the functions for one block."""

import math

import numpy as np

from rocking.kernels.arc.arc import shift_clock
from rocking.kernels.arc.slender_cosine import arc_from
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.lanes.scalar import find_event, leg_done
from rocking.kernels.lanes.search import step
from rocking.kernels.lanes.state import (
    AT_EVENT,
    FAILED,
    FIND_EVENT,
    IDLE,
    LANE_STATE,
    LANES,
    REFINE,
    arc_of,
    load_block,
    set_leg,
    set_system,
)
from rocking.kernels.lanes.step import advance, advance_between, apply_events, apply_impacts
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import Progress
from rocking.kernels.motion.observers import state_at

EYE = np.eye(2)
FIRST = ["wait", "speed", "next_cosine", "next_sine", "next_sinh", "next_versinh", "at_brace"]


@kernel
def sit_down(s, i, p, side, start, velocity, columns, cycles, angle=0.0):
    """A block in lane i that leaves the base, or flies already."""
    arc = arc_from(p, side, start, angle, velocity)
    progress = Progress(FLIGHT, 0, arc, True, 0, 0, 0, 0.0, math.inf, 1.0, 0.0, -math.inf, 0)
    load_block(s, i, p, progress, columns)
    set_leg(s, i, cycles, False)


@kernel
def strike_all(s, braced):
    """The events of all lanes that have arrived."""
    if braced:
        apply_events(s)
    else:
        apply_impacts(s)


@kernel
def advance_all(s, braced):
    """All lanes onward."""
    return advance_between(s) if braced else advance(s)


@kernel
def to_the_end(s, p, events):
    """March all lanes, of one system, to their targets; ``events`` (lanes, n, 4) takes (cycle, time, side, velocity) after each event."""
    moving, braced = LANES, p.block.brace_angle < math.inf
    strike_all(s, braced)
    while moving > 0:
        advance_all(s, braced)
        moving = 0
        for i in range(LANES):
            wants = s.request[i]
            if wants == FIND_EVENT:
                find_event(s, i, p)
            if s.stage[i] == AT_EVENT and leg_done(s, i):
                s.stage[i] = IDLE
            moving += s.stage[i] != IDLE
        strike_all(s, braced)
        for i in range(LANES):
            k = int(s.events[i]) - 1
            if k >= 0:
                events[i, k, 0], events[i, k, 1] = s.cycle[i], s.start[i]
                events[i, k, 2], events[i, k, 3] = s.side[i], s.velocity[i]


@kernel
def states(s, p, out):
    """Write the states of the blocks at their targets."""
    for i in range(LANES):
        cycles = s.target[i] - s.cycle[i]
        arc = shift_clock(arc_of(s, i, p), cycles * p.forcing.period)
        out[i, 0], out[i, 1] = state_at(p, FLIGHT, arc, -arc.start)


def empty():
    """Lanes without blocks."""
    return np.zeros(1, LANE_STATE)[0]


def first_events(systems, starts):
    """Find the first event of each arc in lanes: its row (wait, speed, cos, sin, sinh, cosh - 1, at a brace) and its certainty.

    ``starts`` are (side, start, velocity) or, between braces, where all systems have some, (side, start, velocity, angle).
    """
    found, certain = np.empty((len(systems), len(FIRST))), np.zeros(len(systems), bool)
    for first in range(0, len(systems), LANES):
        s, here = empty(), range(first, min(first + LANES, len(systems)))
        for i, k in enumerate(here):
            sit_down(s, i, systems[k], *starts[k][:3], EYE, 10**9, *starts[k][3:])
        strike_and_pass(s, systems[0].block.brace_angle < math.inf)
        for i, k in enumerate(here):
            found[k], certain[k] = [s[name][i] for name in FIRST], s["stage"][i] == AT_EVENT
    return found, certain


@kernel
def step_from(s, p, instants):
    """A lane of the system for each (u, u', cos eta, sin eta), at the time 0 of its arc, and one step of each."""
    for i in range(len(instants)):
        set_system(s, i, p)
        s.stage[i] = REFINE
        s.angle_there[i] = instants[i, 0]
        s.rate_there[i] = instants[i, 1]
        s.cosine_there[i] = instants[i, 2]
        s.sine_there[i] = instants[i, 3]
    for i in range(LANES):
        step(s, i)


def steps_to_zero(p, instants):
    """Return (wait, speed) of each zero after one step from (u, u', cos eta, sin eta), and whether it is reached."""
    found, arrived = np.empty((len(instants), 2)), np.zeros(len(instants), bool)
    for first in range(0, len(instants), LANES):
        s, part = empty(), instants[first : first + LANES]
        step_from(s, p, part)
        here, stage = slice(first, first + len(part)), s["stage"][: len(part)]
        found[here] = np.column_stack((s["wait"], s["speed"]))[: len(part)]
        arrived[here] = stage == AT_EVENT
    return found, arrived


def may_exceed(systems, starts, peaks):
    """Return whether lanes search the maximum of these first arcs, given the largest angles so far."""
    answers = np.empty(len(systems))
    for first in range(0, len(systems), LANES):
        s, here = empty(), range(first, min(first + LANES, len(systems)))
        for i, k in enumerate(here):
            sit_down(s, i, systems[k], *starts[k], EYE, 10**9)
            s["peak"][i] = peaks[k]
        strike_now(s)
        answers[here] = s["exceeds"][: len(here)]
    return answers > 0.0


@kernel
def strike_now(s):
    """``apply_impacts`` for Python."""
    apply_impacts(s)


@kernel
def strike_and_pass(s, braced):
    """From the start of an arc as far as lanes go without attention."""
    strike_all(s, braced)
    while True:
        advance_all(s, braced)
        under_way = 0
        for i in range(LANES):
            stage = s.stage[i]
            under_way += stage != AT_EVENT and stage != FAILED and stage != IDLE
        if under_way == 0:
            break
