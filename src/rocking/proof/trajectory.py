"""Motion in balls from event to event: each event is proved to be the first one, and each rest is proved.

The state may be a box of states. Its tangent is followed, if wanted, over the whole box.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_mat

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.model.system import State as InitialState
from rocking.proof.arc import Arc, Balls, Refused, Search, arc_from, hull, largest, least, whole
from rocking.proof.chain import law, place

# Longest window of the search for an event, in forcing cycles and in time. No simple part of a cycle: many events lie there.
CYCLES, LONGEST = 0.37, 1.0
# Number of windows in which no event comes, after which the motion is given up.
WINDOWS = 400
# Speed below which chattering is tested.
SLOW = 0.3
# Trials of a window that contains the whole chattering.
TRIALS = 6
# Parts into which it is divided for a bound of the base acceleration.
PARTS = 8


class State(NamedTuple):
    """State at an event, or at a start, in the units of its side."""

    side: int
    phase: arb
    angle: arb
    velocity: arb
    order: int  # of the known zero of u: 0 none, 1 after an impact, 2 pushed away from rest, 3 at the instant of a lift-off
    at_brace: bool  # whether the state lies at a brace, which it leaves


def half_turns_to_release(p: Balls, phase: arb) -> int:
    """Return m of the first release psi = m pi - arccos(1/A) after a phase at which a block rests.

    There |A cos psi| rises through 1. The sign of A cos psi is that of (-1)^m.
    """
    if not p.amplitude > 1:
        raise Refused("the block never lifts off, or may not")
    first = -(1 / p.amplitude).acos()
    return whole(((phase - first) / arb.pi()).floor()) + 1


def release(p: Balls, half_turns: int) -> State:
    """Return the state at the release after a number of half turns: u = u' = u'' = 0, and u''' > 0."""
    phase = half_turns * arb.pi() - (1 / p.amplitude).acos()
    return State(1 if half_turns % 2 else -1, phase, arb(0), arb(0), 3, False)


def initial(p: Balls, phase: float, start: InitialState) -> State:
    """Return the state of a motion at its start: in flight, pushed away from the base, or at its next release from rest."""
    here, angle, velocity = arb(phase), start.angle, start.velocity
    if angle != 0.0 or velocity != 0.0:
        side = 1 if (angle if angle != 0.0 else velocity) > 0 else -1
        own = p.on(side)
        return State(
            side,
            here,
            arb(abs(angle)) / own.angle,
            side * velocity / arb(own.speed),
            int(angle == 0.0),
            False,
        )
    if p.left is not None:
        raise Refused("a start at rest is followed for a block with equal sides only")
    push = p.amplitude * here.cos()
    if abs(push) > 1:
        return State(-1 if push > 0 else 1, here, arb(0), arb(0), 2, False)
    if abs(push) < 1:
        return release(p, half_turns_to_release(p, here))
    raise Refused("whether the block lifts off at once is not decided")


class Flight(NamedTuple):
    """Arc up to its first event."""

    arc: Arc
    time: arb
    event: int
    velocity: arb  # at the event


def flight(p: Balls, state: State) -> Flight:
    """Return the flight from a state to its first event."""
    if not state.order and not state.angle > 0:
        raise Refused("the set of states may reach the base")
    if p.brace_angle is not None and not state.at_brace and not state.angle < p.brace_angle:
        raise Refused("the set of states may reach a brace")
    own = p.on(state.side)
    arc = arc_from(own, state.side, state.phase, state.angle, state.velocity)
    step = min(LONGEST, CYCLES * 6.283 / float(own.frequency))
    searches = [(Search(arc, IMPACT), state.order)]
    if p.brace_angle is not None:
        searches.append((Search(arc, BRACE), int(state.at_brace)))
    for number in range(WINDOWS):
        result = []
        for search, order in searches:
            time = search.first(arb(step * number), arb(step * (number + 1)), 0 if number else order)
            if time is not None:
                result.append((time, search.event))
        if result:
            time, event = min(result, key=lambda one: float(one[0]))
            if any(not time < other for other, name in result if name != event):
                raise Refused("two events may come at the same time")
            return Flight(arc, time, event, arc.at(time).first)
    raise Refused("no event comes for a long time")


def flight_within(p: Balls, state: State, wide: Flight) -> Flight:
    """Return the flight of one state of a set, whose flight is ``wide``.

    The time of its event lies in that of the set, where the rate of every arc lies in the velocity of the set. So the mean value
    theorem encloses the time, from an approximation of it.
    """
    arc, level = arc_from(p, state.side, state.phase, state.angle, state.velocity), place(p, wide.event)
    middle = wide.time.mid()
    here = arc.at(middle)
    nearer = (middle - (here.value - level) / here.first).mid()
    if wide.time.contains(nearer):
        middle = nearer
    time = wide.time.intersection(middle - (arc.at(middle).value - level) / wide.velocity)
    return Flight(arc, time, wide.event, arc.at(time).first)


def after_event(p: Balls, state: State, flown: Flight) -> State:
    """Return the state after the event that ends a flight."""
    own, new = p.on(state.side), p.on(-state.side)
    phase = state.phase + own.frequency * flown.time
    speed = -law(own, flown.event) * flown.velocity
    if flown.event == IMPACT:
        speed *= own.speed / arb(new.speed)
        if not speed > 0:
            raise Refused("the speed after an impact is not proved to be positive")
        return State(-state.side, phase, arb(0), speed, 1, False)
    assert p.brace_angle is not None
    if not speed < 0:
        raise Refused("contact with a brace may last")
    return State(state.side, phase, p.brace_angle, speed, 0, True)


def propagator(time: arb) -> arb_mat:
    """Return the derivative of (u, u') at the end of an arc by that at its start."""
    growth = time.exp()
    sinh, cosh = (growth - 1 / growth) / 2, (growth + 1 / growth) / 2
    return arb_mat([[cosh, sinh], [sinh, cosh]])


def saltation(p: Balls, event: int, side: int, after: State) -> arb_mat:
    """Return the derivative of (u, u') just after an event by that just before it, at a fixed time; ``side`` is that before.

    It is [[-law, 0], [(u''+ + law u''-)/u'-, -law]].
    """
    kept, cosine = law(p, event), after.phase.cos()
    before, later = (after.angle - 1 - one * p.amplitude * cosine for one in (side, after.side))
    shear = -kept * (later + kept * before) / after.velocity
    return arb_mat([[-kept, 0], [shear, -kept]])


def swing_over(p: Balls, start: arb, end: arb) -> tuple[arb, arb]:
    """Return a lower and an upper bound of A cos psi between two forcing phases."""
    cuts = [start + (end - start) * k / PARTS for k in range(PARTS + 1)]
    swings = [p.amplitude * hull(one, other).cos() for one, other in pairwise(cuts)]
    return least(s.lower() for s in swings), largest(s.upper() for s in swings)


def rests(p: Balls, state: State) -> arb | None:
    """Return the forcing phase before which a block that leaves an impact comes to rest for certain; None if this is not proved.

    On a side s, 1 + s A cos psi lies in [d_s, D_s], where d = min d_s > 0. As long as u <= U = v^2/d <= d/2, the block is
    accelerated back with at least d_s - U and at most D_s. So an arc returns with at most sqrt(D_s/(d_s - U)) times its speed,
    after at most 2v/(d - U). Each impact takes the part e of the speed.
    """
    speed, e = state.velocity, p.restitution
    if not (state.order == 1 and speed < SLOW and e < 1):
        return None
    time = 4 * speed / (1 - e)
    for _ in range(TRIALS):
        low, high = swing_over(p, state.phase, state.phase + p.frequency * time)
        sides = [(1 + low, 1 + high), (1 - high, 1 - low)]
        weakest = least(d for d, _ in sides)
        if not weakest > 0:
            return None
        height = speed * speed / weakest
        below = p.brace_angle is None or height < p.brace_angle
        if not (height < weakest / 2 and below):
            return None
        ratio = e * largest((most / (low - height)).sqrt() for low, most in sides)
        if not ratio < 1:
            return None
        needed = 2 * speed / ((weakest - height) * (1 - ratio))
        if needed < time:
            return state.phase + p.frequency * time
        time = needed * 2
    return None
