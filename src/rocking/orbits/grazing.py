"""Grazings: the arc of an orbit that just touches the base or a brace, and the grazing orbit, accurate to rounding.

A grazing impact makes the equations of the orbit singular: its multipliers grow without bound. The orbit is therefore
solved without this impact. The condition is that an arc has its turning point at the base or brace. All quantities are then
smooth functions of the parameter.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from attrs import evolve

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.model.orbit import Orbit
from rocking.model.system import State
from rocking.motion.simulate import simulate
from rocking.orbits.event_chain import (
    BRACE,
    IMPACT,
    Chain,
    Condition,
    Special,
    equations,
    orbit_at,
    problem_of,
    residual_of,
    sides_of,
)
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.saddles import response, saddle, saddle_events

# Largest speed of an event that may be grazing.
SLOW = 1e-2
# Samples of an arc, between which its turning points lie.
SAMPLES = 1001
# Largest distance from the base or a brace of a turning point that may be the contact.
CLOSE = 1e-2
# An arc shorter than this leaves base or brace and returns to it, without another turning point.
SHORT = 1e-3
# Largest relative distance of the grazing from the end of the branch.
NEAR = 1e-3
# Largest last correction of the time of a turning point, at which the height does not change to rounding.
TURNED = 1e-9
MAX_CORRECTIONS = 20
# Largest distance from the base or a brace of a turning point that touches, and largest speed of an event that does.
TOUCHING, TOUCHING_SPEED = 1e-11, 1e-5


class GrazingContact(NamedTuple):
    """Orbit without its grazing events, and the condition of contact."""

    chain: Chain
    condition: Condition


class Grazing(NamedTuple):
    """Grazing as stored in a special point."""

    orbit: Orbit  # without the grazing events
    chain: Chain
    row: np.ndarray
    touch: GrazingContact | None  # None if no other event exists, or no contact was found


def grazing_at(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """Return the grazing at which a branch ends, accurate to rounding; if that fails, the last point of the branch."""
    result = _solve_grazing(chain, parameter, row)
    return result._replace(orbit=evolve(result.orbit, grazes=True))


def _solve_grazing(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """Return the grazing with its orbit as solved: of all possible contacts, the one nearest to the end of the branch."""
    chain = chain._replace(system=with_value(chain.system, parameter, float(row[-1])), phases=row[:-1])
    links = equations(chain, parameter, row)[1]
    touches = (
        _solved(touch, parameter) for touch in (*slow_event(chain, links), *near_contacts(chain, links))
    )
    solved = [each for each in touches if each is not None]
    if solved:
        touch, place = min(solved, key=lambda each: abs(each[1][-1] - row[-1]))
        return Grazing(orbit_at(touch.chain, parameter, place), touch.chain, place, touch)
    alone = _eventless(chain, parameter, row) if len(chain.kinds) <= 2 else None
    if alone is not None:
        return Grazing(alone, chain, np.append(row[:-1], value_of(alone.system, parameter)), None)
    return Grazing(orbit_at(chain, parameter, row), chain, row, None)


def slow_event(chain: Chain, links: np.ndarray) -> list[GrazingContact]:
    """Return the contact at the slowest event of an orbit; none if it is not slow, or if no event remains without it."""
    arrives, times, k = np.abs(links["arrives"]), links["time"], len(chain.phases)
    slowest = int(arrives.argmin())
    event = (slowest + 1) % k
    level, lost = int(chain.kinds[event]), 1
    if level == IMPACT:
        # The block crosses Θ = 0 and returns at once: two impacts with a short arc in between.
        event, lost = (event if times[event] < times[slowest] else slowest), 2
    if arrives[slowest] > SLOW or k <= lost:
        return []
    chain = rotated(chain, (event + lost) % k)
    time = (chain.phases[k - lost] - chain.phases[k - lost - 1]) / chain.system.harmonic.frequency
    kept = chain._replace(kinds=chain.kinds[: k - lost].copy(), phases=chain.phases[: k - lost])
    return [GrazingContact(kept, Condition(Special.GRAZING, k - lost - 1, level, float(time)))]


def rotated(chain: Chain, by: int) -> Chain:
    """Return the same chain, begun ``by`` events later."""
    side, kinds = chain.side, chain.kinds
    for j in range(by):
        side = -side if kinds[(j + 1) % len(kinds)] == IMPACT else side
    phases = np.concatenate([chain.phases[by:], chain.phases[:by] + chain.turn])
    return chain._replace(side=side, kinds=np.roll(kinds, -by), phases=phases)


def near_contacts(chain: Chain, links: np.ndarray) -> list[GrazingContact]:
    """Return the turning points of the arcs that are close to the base or to a brace, the closest first.

    The arcs are those of the chain. In a simulation, rounding decides if the contact is an event.
    """
    rows = []
    for arc, side in enumerate(sides_of(chain)):
        if links["time"][arc] < SHORT:
            continue
        times = np.linspace(0.0, links["time"][arc], SAMPLES)
        height = _heights(chain, arc, side, links["leaves"][arc], times)
        for level in (IMPACT,) if chain.system.braces is None else (IMPACT, BRACE):
            turns, gaps = _turns(chain, height, level)
            rows += [(gap, level, arc, times[turn]) for turn, gap in zip(turns, gaps, strict=True)]
    return [
        GrazingContact(chain, Condition(Special.GRAZING, arc, int(level), float(time)))
        for gap, level, arc, time in sorted(rows)
        if gap <= CLOSE
    ]


def _turns(chain: Chain, height: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the turning points of sampled heights towards the base or a brace, and their distances from it."""
    braces = chain.system.braces
    # above the base or, downwards, beneath the brace
    above = height if level == IMPACT or braces is None else braces.angle - height
    rise = np.diff(above)
    turns = np.flatnonzero((rise[:-1] < 0.0) & (rise[1:] >= 0.0)) + 1
    return turns, np.abs(above[turns])


def _heights(chain: Chain, arc: int, side: int, speed: float, times: np.ndarray) -> np.ndarray:
    """Return |Θ| on an arc that starts with a speed away from Θ = 0: the saddle orbit of its side, and exponentials."""
    phase, swing = chain.phases[arc], side * response(chain.system)
    even, odd = _exponentials(chain, arc, swing, speed)
    forced = 1.0 + swing * np.cos(phase + chain.system.harmonic.frequency * times)
    return np.asarray(forced + even * np.cosh(times) + odd * np.sinh(times))


def _exponentials(chain: Chain, arc: int, swing: float, speed: float) -> tuple[float, float]:
    """Return the coefficients of cosh and sinh on an arc."""
    frequency, phase, braces = chain.system.harmonic.frequency, chain.phases[arc], chain.system.braces
    start = 0.0 if braces is None or chain.kinds[arc] == IMPACT else braces.angle
    return start - 1.0 - swing * math.cos(phase), speed + swing * frequency * math.sin(phase)


def clearance(chain: Chain, parameter: str, row: np.ndarray, contact: Condition) -> float:
    """Return the distance of a turning point of an arc from the base or the brace; negative beyond it, NaN if there is none."""
    return turning_point(chain, parameter, row, contact)[0]


def turning_point(chain: Chain, parameter: str, row: np.ndarray, contact: Condition) -> tuple[float, float]:
    """Return the distance of a turning point of an arc from the base or the brace, and its time; NaN if there is none.

    The turning point is found by Newton's method from the time of the contact.
    """
    links, arc = equations(chain, parameter, np.append(chain.phases, row[-1]))[1], contact.arc
    side, speed, end = sides_of(chain)[arc], links["leaves"][arc], links["time"][arc]
    frequency, phase, swing = (
        chain.system.harmonic.frequency,
        chain.phases[arc],
        side * response(chain.system),
    )
    even, odd = _exponentials(chain, arc, swing, speed)
    time = contact.time
    for _ in range(MAX_CORRECTIONS):
        forced = phase + frequency * time
        slope = even * math.sinh(time) + odd * math.cosh(time) - swing * frequency * math.sin(forced)
        bend = even * math.cosh(time) + odd * math.sinh(time) - swing * frequency**2 * math.cos(forced)
        step = -slope / bend
        time += step
        if not 0.0 < time < end:
            return math.nan, time
        if abs(step) <= TURNED:
            break
    (height,) = _heights(chain, arc, side, speed, np.array([time]))
    braces = chain.system.braces
    return float(height if contact.level == IMPACT or braces is None else braces.angle - height), time


def turning_time(chain: Chain, parameter: str, row: np.ndarray, condition: Condition) -> float:
    """Return the time from the start of an arc to its turning point that is nearest to the level of the contact.

    If there is no turning point, return the known time of the condition.
    """
    at_value = np.append(chain.phases, row[-1])
    links, sides = equations(chain, parameter, at_value)[1], sides_of(chain)
    arc = condition.arc
    times = np.linspace(0.0, links["time"][arc], SAMPLES)
    height = _heights(chain, arc, sides[arc], links["leaves"][arc], times)
    turns, gaps = _turns(chain, height, condition.level)
    close = times[turns[gaps <= CLOSE]].tolist()
    if len(close) > 1:
        # samples do not decide which of two turning points is nearer
        exact = [abs(clearance(chain, parameter, row, condition._replace(time=time))) for time in close]
        return float(min(zip(exact, close, strict=True))[1])
    return float(times[turns[gaps.argmin()]] if len(turns) else condition.time)


def touches_again(touch: GrazingContact, parameter: str) -> bool:
    """Return whether a grazing orbit touches at a second instant of its chain, as one does that is traversed twice."""
    chain, own = touch.chain, touch.condition
    row = np.append(chain.phases, value_of(chain.system, parameter))
    links = equations(chain, parameter, row)[1]
    if np.abs(links["arrives"]).min() <= TOUCHING_SPEED:
        return True
    return any(
        abs(clearance(chain, parameter, row, other)) <= TOUCHING
        for _, other in near_contacts(chain, links)
        if (other.arc, other.level) != (own.arc, own.level) or abs(other.time - own.time) > CLOSE
    )


def slope_of_return(chain: Chain, parameter: str, row: np.ndarray, touch: Condition) -> float:
    """Return the derivative of the angle at a touch by the velocity at the touch before, along the orbit."""
    links = equations(chain, parameter, np.append(chain.phases, row[-1]))[1]
    k, angle, velocity = len(chain.kinds), 0.0, 1.0
    spans = [float(links["time"][touch.arc]) - touch.time]
    spans += [float(links["time"][(touch.arc + j) % k]) for j in range(1, k)] + [touch.time]
    for j, span in enumerate(spans):
        if j:
            before, after = (touch.arc + j - 1) % k, (touch.arc + j) % k
            braces = chain.system.braces
            kept = chain.system.restitution
            if chain.kinds[after] == BRACE and braces is not None:
                kept = braces.restitution
            shear = (links["acceleration"][after] + kept * links["push"][before]) / links["arrives"][before]
            angle, velocity = -kept * angle, shear * angle - kept * velocity
        sinh, cosh = math.sinh(span), math.cosh(span)
        angle, velocity = cosh * angle + sinh * velocity, sinh * angle + cosh * velocity
    return float(angle)


def _solved(touch: GrazingContact, parameter: str) -> tuple[GrazingContact, np.ndarray] | None:
    """Return the grazing orbit, with its phases and the value of the parameter; None if Newton's method fails."""
    chain = touch.chain
    row = special_row(
        chain, touch.condition, parameter, np.append(chain.phases, value_of(chain.system, parameter))
    )
    if row is None:
        return None
    system = with_value(chain.system, parameter, float(row[-1]))
    return touch._replace(chain=chain._replace(system=system, phases=row[:-1])), row


def special_row(chain: Chain, condition: Condition, parameter: str, near: np.ndarray) -> np.ndarray | None:
    """Return the phases and the value of the parameter at which a condition holds; None if Newton's method fails.

    It is the first point of a curve of special points that starts along a second parameter, which therefore keeps its value.
    """
    k, chain = len(near) - 1, chain._replace(system=with_value(chain.system, parameter, float(near[-1])))
    kept = "amplitude" if parameter in ("period", "frequency") else "frequency"
    here = [value_of(chain.system, name) for name in (kept, parameter)]
    limits = [(value * (1.0 - NEAR), value * (1.0 + NEAR)) for value in here]
    out, direction = np.empty((1, k + 2)), np.zeros(k + 2)
    direction[k] = 1.0
    problem = problem_of(chain, (kept, parameter), limits, 0.1, here)
    start = arclength.Tangent(np.append(near[:-1], here), direction)
    count, _ = kernel.follow_curve(problem, start, condition, out)
    if count == 0 or not abs(out[0, -1] - here[1]) <= NEAR * abs(here[1]):
        return None
    return np.append(out[0, :k], out[0, -1])


def _eventless(chain: Chain, parameter: str, row: np.ndarray) -> Orbit | None:
    """Return the orbit Θ = ±1 + β cos ψ that touches the base (β = 1) or a brace near the end of a branch, or None."""
    from scipy.optimize import brentq

    def clear(value: float) -> float:
        system = with_value(chain.system, parameter, value)
        braces = system.braces if chain.kinds[0] == BRACE else None
        return (1.0 if braces is None else braces.angle - 1.0) - response(system)

    ends = row[-1] * (1.0 - NEAR), row[-1] * (1.0 + NEAR)
    if clear(ends[0]) * clear(ends[1]) > 0.0:
        return None
    value = float(brentq(clear, *ends, xtol=1e-300, rtol=8.9e-16))
    system = with_value(chain.system, parameter, value)
    times = equations(chain, parameter, row)[1]["time"]
    longest = rotated(chain._replace(phases=row[:-1]), int(times.argmax()))
    # half a forcing period away from the contact
    phase = 0.0 if longest.side > 0 else math.pi
    start = State(*saddle(system, phase, longest.side))
    grown = math.exp(system.harmonic.period)
    return Orbit(
        system=system,
        state=start,
        phase=phase,
        period=1,
        symmetric=False,
        impacts=0,
        brace_hits=0,
        multipliers=(complex(grown), complex(1.0 / grown)),
        residual=residual_of(system, phase, start, 1),
        simulate=simulate,
        events=saddle_events(system, phase, start),
    )
