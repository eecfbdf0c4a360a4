"""Grazings: which arc of an orbit just touches the base or a brace, and the orbit at which it does, to rounding.

An impact that grazes makes the orbit's equations singular: its multipliers grow without bound. So the orbit is solved without
it. The condition is then that an arc turns just where it touches, and every quantity is a smooth function of the parameter.
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

# An event this slow is the one that grazes.
SLOW = 1e-4
SAMPLES = 4096
# The grazing lies this near to where the branch was seen to end, relatively.
NEAR = 1e-3


class Touch(NamedTuple):
    """An orbit without the events that graze, and where it touches instead."""

    chain: Chain
    condition: Condition


class Grazing(NamedTuple):
    """A grazing as a special point has it."""

    orbit: Orbit  # without the events that graze
    chain: Chain
    row: np.ndarray
    touch: Touch | None  # None where no event is left, or none was found


def grazing_at(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """The grazing at which a branch ends, located to rounding; where that fails, as near as the branch was followed."""
    found = _located(chain, parameter, row)
    return found._replace(orbit=evolve(found.orbit, grazes=True))


def _located(chain: Chain, parameter: str, row: np.ndarray) -> Grazing:
    """Return the grazing with the orbit as it was solved."""
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
    """What an orbit all but touches at the end of its branch; None where nothing is found, or where no event is left."""
    chain = chain._replace(system=with_value(chain.system, parameter, float(row[-1])), phases=row[:-1])
    links = equations(chain, parameter, row)[1]
    arrives, times, k = np.abs(links["arrives"]), links["time"], len(chain.phases)
    slowest = int(arrives.argmin())
    event = (slowest + 1) % k
    if arrives[slowest] > SLOW:
        return _nearest(chain, orbit_of(chain, parameter, row, math.nan, math.nan))
    level, lost = int(chain.kinds[event]), 1
    if level == IMPACT:
        # it falls through and comes back at once: two impacts with a short arc between them
        event, lost = (event if times[event] < times[slowest] else slowest), 2
    if k <= lost:
        return None
    chain = _rotated(chain, (event + lost) % k)
    time = (chain.phases[k - lost] - chain.phases[k - lost - 1]) / chain.system.forcing.frequency
    kept = chain._replace(kinds=chain.kinds[: k - lost].copy(), phases=chain.phases[: k - lost])
    return Touch(kept, Condition(Special.GRAZING, k - lost - 1, level, float(time)))


def _rotated(chain: Chain, by: int) -> Chain:
    """The same chain begun ``by`` events later."""
    side, kinds = chain.side, chain.kinds
    for j in range(by):
        side = -side if kinds[(j + 1) % len(kinds)] == IMPACT else side
    phases = np.concatenate([chain.phases[by:], chain.phases[:by] + chain.turn])
    return chain._replace(side=side, kinds=np.roll(kinds, -by), phases=phases)


def _nearest(chain: Chain, orbit: Orbit) -> Touch | None:
    """Where the motion turns nearest to the base or to a brace."""
    forcing, phases = orbit.system.forcing, chain.phases
    motion = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period)
    times = np.linspace(0.0, orbit.period * forcing.period, SAMPLES * orbit.period)
    angles = motion.at(times)[0]
    size = np.abs(angles)
    inner, before, after = size[1:-1], size[:-2], size[2:]
    # An impact has neighbours on both sides; a turn lies between samples of one side.
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
    """The orbit that just touches, and its phases and the value of the parameter; None where Newton's method fails.

    It is the first point of a curve of grazings, begun across a second parameter, which therefore keeps its value.
    """
    chain, k = touch.chain, len(touch.chain.phases)
    kept = "amplitude" if parameter in ("period", "frequency") else "frequency"
    here = [value_of(chain.system, name) for name in (kept, parameter)]
    limits = [(value * (1.0 - NEAR), value * (1.0 + NEAR)) for value in here]
    out, direction = np.empty((1, k + 2)), np.zeros(k + 2)
    direction[k] = 1.0
    problem = problem_of(chain, (kept, parameter), limits, 0.1, here)
    start = arclength.Tangent(np.append(chain.phases, here), direction)
    count, _ = kernel.follow_curve(problem, start, touch.condition, out)
    if count == 0 or not abs(out[0, -1] - here[1]) <= NEAR * abs(here[1]):
        return None
    row = np.append(out[0, :k], out[0, -1])
    system = with_value(chain.system, parameter, float(row[-1]))
    return touch._replace(chain=chain._replace(system=system, phases=row[:-1])), row


def _eventless(chain: Chain, parameter: str, row: np.ndarray) -> Orbit | None:
    """The orbit Θ = ±1 + β cos ψ that just touches the base (β = 1) or a brace, near the end of a branch; None for none."""
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
    # half a forcing period away from the touch
    phase = 0.0 if longest.side > 0 else math.pi
    start = State(*saddle(system, phase, longest.side))
    final = simulate(clocked(system, phase), start, cycles=1, record="none").final
    grown = math.exp(system.forcing.period)
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
