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
from rocking.model import Orbit, State
from rocking.motion import simulate
from rocking.orbits.event_chain import (
    BRACE,
    IMPACT,
    Chain,
    Condition,
    Special,
    clocked,
    equations,
    orbit_of,
    problem_of,
)
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.saddle_orbits import response, saddle, saddle_events

# Largest speed of an event that is taken as grazing.
SLOW = 1e-4
SAMPLES = 4096
# Largest relative distance of the grazing from the end of the branch.
NEAR = 1e-3


class Touch(NamedTuple):
    """Orbit without its grazing events, and the condition of contact."""

    chain: Chain
    condition: Condition


class Grazing(NamedTuple):
    """Grazing as stored in a special point."""

    orbit: Orbit  # without the grazing events
    chain: Chain
    row: np.ndarray
    touch: Touch | None  # None if no other event exists, or no contact was found


def grazing_at(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """Return the grazing at which a branch ends, accurate to rounding; if that fails, the last point of the branch."""
    found = _located(chain, parameter, row)
    return found._replace(orbit=evolve(found.orbit, grazes=True))


def _located(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """Return the grazing with its orbit as solved."""
    touch = _touch_of(chain, parameter, row)
    if touch is not None and (solved := _solved(touch, parameter)):
        touch, row = solved
        *_, trace, determinant = equations(touch.chain, parameter, row)
        return Grazing(orbit_of(touch.chain, parameter, row, trace, determinant), touch.chain, row, touch)
    alone = _eventless(chain, parameter, row) if touch is None else None
    if alone is not None:
        return Grazing(alone, chain, np.append(row[:-1], value_of(alone.system, parameter)), None)
    *_, trace, determinant = equations(chain, parameter, row)
    return Grazing(orbit_of(chain, parameter, row, trace, determinant), chain, row, None)


def _touch_of(chain: Chain, parameter: str, row: np.ndarray) -> Touch | None:
    """Return the contact that an orbit has at the end of its branch; None if none is found, or if no event remains."""
    chain = chain._replace(system=with_value(chain.system, parameter, float(row[-1])), phases=row[:-1])
    links = equations(chain, parameter, row)[1]
    arrives, times, k = np.abs(links["arrives"]), links["time"], len(chain.phases)
    slowest = int(arrives.argmin())
    event = (slowest + 1) % k
    if arrives[slowest] > SLOW:
        return _nearest(chain, orbit_of(chain, parameter, row, math.nan, math.nan))
    level, lost = int(chain.kinds[event]), 1
    if level == IMPACT:
        # The block crosses Θ = 0 and returns at once: two impacts with a short arc in between.
        event, lost = (event if times[event] < times[slowest] else slowest), 2
    if k <= lost:
        return None
    chain = _rotated(chain, (event + lost) % k)
    time = (chain.phases[k - lost] - chain.phases[k - lost - 1]) / chain.system.harmonic.frequency
    kept = chain._replace(kinds=chain.kinds[: k - lost].copy(), phases=chain.phases[: k - lost])
    return Touch(kept, Condition(Special.GRAZING, k - lost - 1, level, float(time)))


def _rotated(chain: Chain, by: int) -> Chain:
    """Return the same chain, begun ``by`` events later."""
    side, kinds = chain.side, chain.kinds
    for j in range(by):
        side = -side if kinds[(j + 1) % len(kinds)] == IMPACT else side
    phases = np.concatenate([chain.phases[by:], chain.phases[:by] + chain.turn])
    return chain._replace(side=side, kinds=np.roll(kinds, -by), phases=phases)


def _nearest(chain: Chain, orbit: Orbit) -> Touch | None:
    """Return the turning point of the motion nearest to the base or to a brace."""
    forcing, phases = orbit.system.harmonic, chain.phases
    motion = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period)
    times = np.linspace(0.0, orbit.period * forcing.period, SAMPLES * orbit.period)
    angles = motion.at(times)[0]
    size = np.abs(angles)
    inner, before, after = size[1:-1], size[:-2], size[2:]
    # An impact lies between samples on both sides, and a turning point between samples on one side.
    low = (inner < before) & (inner < after) & (np.diff(np.sign(angles))[1:] == 0.0)
    candidates = [(inner[i], IMPACT, times[i + 1]) for i in np.flatnonzero(low)]
    if orbit.system.braces is not None:
        high = (inner > before) & (inner > after)
        reach = orbit.system.braces.angle
        candidates += [(reach - inner[i], BRACE, times[i + 1]) for i in np.flatnonzero(high)]
    events = motion.events["time"]
    candidates = [
        one for one in candidates if not len(events) or np.abs(events - one[2]).min() > 2.0 * times[1]
    ]
    if not candidates:
        return None
    _, level, time = min(candidates)
    start = phases[0]
    psi = orbit.phase + math.tau * math.ceil((start - orbit.phase) / math.tau) + forcing.frequency * time
    psi = start + (psi - start) % chain.turn
    arc = int(np.searchsorted(phases, psi, side="right")) - 1
    time = float((psi - phases[arc]) / forcing.frequency)
    return Touch(chain, Condition(Special.GRAZING, arc, int(level), time))


def _solved(touch: Touch, parameter: str) -> tuple[Touch, np.ndarray] | None:
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
    longest = _rotated(chain._replace(phases=row[:-1]), int(times.argmax()))
    # half a forcing period away from the contact
    phase = 0.0 if longest.side > 0 else math.pi
    start = State(*saddle(system, phase, longest.side))
    final = simulate(clocked(system, phase), start, cycles=1, record="none").final
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
        residual=math.hypot(final.angle - start.angle, final.velocity - start.velocity),
        simulate=simulate,
        events=saddle_events(system, phase, start),
    )
