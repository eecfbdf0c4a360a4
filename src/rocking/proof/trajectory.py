"""Motion in balls from event to event: each event is proved to be the first one, and each rest is proved.

The state may be a box of states. Its tangent is followed, if wanted, over the whole box.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_mat, ctx

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.proof.arc import DEPTH, Arc, Function, arc_from, piece_is_positive
from rocking.proof.balls import Balls, Refused, hull, largest, least, whole
from rocking.proof.chain import law

# Longest window of the search for an event, in forcing cycles and in time. No simple part of a cycle: many events lie there.
CYCLES, LONGEST = 0.37, 1.0
# Number of windows in which no event comes, after which the motion is given up.
WINDOWS = 400
# Steps of Newton's method for the time of an event, and of widening the interval around it.
STEPS, WIDER = 40, 12
# Speed below which chattering is tested.
SLOW = 0.3
# Trials of a window that contains the whole chattering.
TRIALS = 6
# Parts into which it is divided for a bound of the base acceleration.
PARTS = 8


class State(NamedTuple):
    """State at an event, or at a start."""

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


def first_zero(function: Function, low: arb, high: arb, order: int, depth: int = 0) -> tuple[arb, arb] | None:
    """Return an interval that contains the first zero in [low, high] and no other; None if there is none.

    The function is positive at ``low``, or has a zero of an ``order`` there and is positive just after it.
    """
    if piece_is_positive_to(function, low, high, order):
        return None
    if not order and function(hull(low, high)).first < 0 and function(high).value < 0:
        return low, high
    if depth >= DEPTH:
        raise Refused("whether an event comes is not decided: the motion nearly touches the base or a brace")
    middle = ((low + high) / 2).mid()
    found = first_zero(function, low, middle, order, depth + 1)
    return first_zero(function, middle, high, 0, depth + 1) if found is None else found


def piece_is_positive_to(function: Function, low: arb, high: arb, order: int) -> bool:
    """Return whether one bound proves that a function is positive up to ``high``, this end included."""
    return bool(function(high).value > 0) and piece_is_positive(function, low, high, order, False)


def time_of_zero(function: Function, low: arb, high: arb) -> arb:
    """Return the time of the only zero in an interval where the function falls.

    Newton's method gives a guess. The zero lies between two times at which the function has opposite signs, and in the image of
    Newton's operator.
    """
    time = ((low + high) / 2).mid()
    here = function(time)
    for _ in range(STEPS):
        if here.value > 0:
            low = time
        elif here.value < 0:
            high = time
        else:
            break
        ahead = (time - here.value / here.first).mid() if here.first < 0 else low
        time = ahead if low < ahead < high else ((low + high) / 2).mid()
        here = function(time)
    width = (abs(here.value) / -here.first).abs_upper() * 2 + abs(time) * arb(2) ** (8 - ctx.prec)
    for _ in range(WIDER):
        first, last = (time - width).mid(), (time + width).mid()
        if function(first).value > 0 and function(last).value < 0:
            around = hull(first, last)
            return around.intersection(time - here.value / function(around).first)
        width *= 4
    raise Refused("the time of an event is not enclosed")


class Flight(NamedTuple):
    """Arc up to its first event, or up to the end of the time."""

    arc: Arc
    time: arb
    event: int | None
    velocity: arb  # at the event


def flight(p: Balls, state: State, limit: arb) -> Flight:
    """Return the flight from a state to its first event, or to the time ``limit`` if none comes before."""
    if not state.order and not state.angle > 0:
        raise Refused("the set of states may reach the base")
    if p.brace_angle is not None and not state.at_brace and not state.angle < p.brace_angle:
        raise Refused("the set of states may reach a brace")
    arc = arc_from(p, state.side, state.phase, state.angle, state.velocity)
    step = min(LONGEST, CYCLES * 6.283 / float(p.frequency.mid()))
    functions = [(IMPACT, arc.at, state.order)]
    if p.brace_angle is not None:
        functions.append((BRACE, arc.below_brace, int(state.at_brace)))
    low = arb(0)
    for number in range(WINDOWS):
        high = arb(step * (number + 1))
        last = not high < limit
        high = limit if last else high
        found = []
        for event, function, order in functions:
            bracket = first_zero(function, low, high, order if number == 0 else 0)
            if bracket is not None:
                found.append((time_of_zero(function, *bracket), event))
        if found:
            time, event = min(found, key=lambda one: float(one[0].mid()))
            if any(not time < other for other, name in found if name != event):
                raise Refused("two events may come at the same time")
            return Flight(arc, time, event, arc.at(time).first)
        if last:
            return Flight(arc, limit, None, arc.at(limit).first)
        low = high
    raise Refused("no event comes for a long time")


def after_event(p: Balls, state: State, flown: Flight) -> State:
    """Return the state after the event that ends a flight."""
    phase = state.phase + p.frequency * flown.time
    assert flown.event is not None
    speed = -law(p, flown.event) * flown.velocity
    if flown.event == IMPACT:
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


def jump(p: Balls, state: State, flown: Flight, after: State) -> arb_mat:
    """Return the derivative of the state after an event by that at the start of the flight: arc, then saltation."""
    assert flown.event is not None
    kept, cosine = law(p, flown.event), after.phase.cos()
    before, later = (after.angle - 1 - side * p.amplitude * cosine for side in (state.side, after.side))
    shear = (later + kept * before) / flown.velocity
    return arb_mat([[-kept, 0], [shear, -kept]]) * propagator(flown.time)


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
