"""Between an orbit, as users have it, and the closed chain of its events, as the kernels follow it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from attrs import evolve

from rocking.kernels import event_kinds
from rocking.kernels import parameters as numbers
from rocking.kernels.orbits import arclength, branch_point, chain_queries, chain_validation, floquet
from rocking.kernels.orbits import continuation as following
from rocking.kernels.orbits import event_chain as kernel
from rocking.model import NO_BRACES, Orbit, OrbitEvent, State, System, quantities, refusal
from rocking.motion import simulate
from rocking.orbits.parameter import with_value

IMPACT, BRACE = event_kinds.IMPACT, event_kinds.BRACE
Condition = chain_validation.Condition
End = arclength.End
Special = branch_point.Special
NAMES = {
    "amplitude": kernel.AMPLITUDE,
    "frequency": kernel.FREQUENCY,
    "period": kernel.PERIOD,
    "restitution": kernel.RESTITUTION,
    "brace_angle": kernel.BRACE_ANGLE,
    "brace_restitution": kernel.BRACE_RESTITUTION,
}


class Chain(NamedTuple):
    """The events of an orbit; of a symmetric one those of half a period."""

    system: System  # at some value of the parameter followed
    period: int
    mirrored: bool
    kinds: np.ndarray
    side: int
    phases: np.ndarray

    @property
    def turn(self) -> float:
        """Forcing phase between the first event and its repetition."""
        return math.tau * self.period * (0.5 if self.mirrored else 1.0)

    @property
    def fixed(self) -> kernel.Chain:
        """What does not change along a branch, as the kernels take it."""
        return kernel.Chain(self.kinds, self.side, self.turn, self.mirrored)

    def counts(self) -> tuple[int, int]:
        """Impacts and brace hits in a period."""
        times = 2 if self.mirrored else 1
        return times * int((self.kinds == IMPACT).sum()), times * int((self.kinds == BRACE).sum())


class Solved(NamedTuple):
    """An orbit at one value of a parameter."""

    found: bool
    phases: np.ndarray  # and the value, last
    trace: float
    determinant: float
    peak: float


def parameters(system: System) -> Any:
    """A system as the kernels read it, its clock at the phase 0."""
    return numbers.harmonic_parameters(**NO_BRACES | quantities(system) | {"phase": 0.0})


def clocked(system: System, phase: float) -> System:
    """The same system with its clock at 0 when the forcing has a phase."""
    return evolve(system, forcing=evolve(system.forcing, phase=phase))


def chain_of(orbit: Orbit) -> Chain:
    """The events of an orbit; ValueError in one line where it has none, or rests or leans in between."""
    if orbit.superstable:
        raise ValueError(
            refusal(
                "orbit", "neither rest nor lean", orbit.period, "sweep the parameter with classify"
            ).replace("got", "got one that does, of period")
        )
    events = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period).events
    events = events[np.isin(events["kind"], ("impact", "brace"))]
    if not len(events):
        raise ValueError(
            "orbit must have an impact or a brace hit; got one without (it is ±1 + β cos ψ: see THEORY)"
        )
    psi = orbit.phase + orbit.system.forcing.frequency * events["time"]
    kinds = np.where(events["kind"] == "impact", IMPACT, BRACE).astype(np.int64)
    # the side that the block is on after an event
    side = 1 if (events[0]["after"] > 0.0) == (kinds[0] == IMPACT) else -1
    count = len(events) // 2 if orbit.symmetric else len(events)
    return Chain(orbit.system, orbit.period, orbit.symmetric, kinds[:count], side, np.asarray(psi[:count]))


def solved(chain: Chain, parameter: str, value: float, phases: np.ndarray) -> Solved:
    """The orbit at one value of a parameter, by Newton's method from near phases; not found too where it is no motion of the block."""
    k = len(chain.kinds)
    y, alone = np.append(phases[:k], value), np.zeros(k + 1)
    alone[k] = 1.0
    scale = 1e-3 * max(abs(value), 1e-3)
    problem = problem_of(chain, [parameter], [(value - scale, value + scale)], 0.1, [scale])
    table = branch_table(k + 1, 1, 0)
    count, *_ = following.follow(problem, arclength.Tangent(y, alone), table)
    trace, determinant, peak, _ = table.facts[0]
    return Solved(count == 1, table.rows[0], trace, determinant, peak)


def problem_of(
    chain: Chain,
    names: Sequence[str],
    limits: Sequence[tuple[float, float]],
    longest: float,
    scales: Sequence[float],
) -> arclength.Problem:
    """The problem of following a chain through one or two parameters within limits, each measured in its own scale."""
    return arclength.Problem(
        parameters(chain.system),
        chain.fixed,
        tuple(NAMES[name] for name in names),
        tuple(limits),
        longest,
        arclength.make_workspace(len(chain.kinds), scales),
    )


def branch_table(n: int, points: int, specials: int) -> following.BranchTable:
    """Room for so many points and special points of a branch with n unknowns."""
    return following.BranchTable(
        np.empty((points, n)),
        np.empty(points, following.FACTS),
        np.empty((specials, n)),
        np.empty(specials, following.CHANGE),
    )


def equations(chain: Chain, parameter: str, row: np.ndarray) -> tuple[np.ndarray, np.ndarray, float, float]:
    """(derivatives, what is known of each arc, trace, determinant) at a point of a branch."""
    k = len(chain.kinds)
    there = kernel.make_equations(k + 1)
    trace, determinant = chain_queries.equations_at(
        parameters(chain.system), NAMES[parameter], chain.fixed, row, there
    )
    return there.jacobian[:k], there.links[:k], trace, determinant


def null_direction(chain: Chain, parameter: str, row: np.ndarray) -> np.ndarray:
    """The direction of the phases, of mean square 1, in which an orbit may move at a special point."""
    jacobian, *_ = equations(chain, parameter, row)
    direction = np.linalg.svd(jacobian[:, :-1])[2][-1]
    return direction / math.sqrt(np.mean(direction**2))


def multipliers_of(trace: float, determinant: float, mirrored: bool) -> tuple[complex, complex]:
    """Floquet multipliers over a period, the larger first, or that above the real axis."""
    trace, determinant = float(trace), float(determinant)
    first, second = floquet.multipliers_plain(
        0.5 * trace, 0.25 * trace * trace - determinant, determinant, mirrored
    )
    return first, second


def orbit_of(chain: Chain, parameter: str, row: np.ndarray, trace: float, determinant: float) -> Orbit:
    """The orbit at a point of a branch: ``row`` holds its phases and the value of the parameter."""
    system = with_value(chain.system, parameter, float(row[-1]))
    phase = quiet_phase(np.append(row[:-1], row[:-1] + math.pi if chain.mirrored else []))
    state = states(chain, parameter, row[None], phase, 1)[0, 0]
    start = State(float(state[0]), float(state[1]))
    final = simulate(clocked(system, phase), start, cycles=chain.period, record="none").final
    impacts, brace_hits = chain.counts()
    return Orbit(
        system=system,
        state=start,
        phase=phase,
        period=chain.period,
        symmetric=chain.mirrored,
        impacts=impacts,
        brace_hits=brace_hits,
        multipliers=multipliers_of(trace, determinant, chain.mirrored),
        residual=math.hypot(final.angle - start.angle, final.velocity - start.velocity),
        simulate=simulate,
        events=_events(chain, parameter, row, phase),
    )


def _events(chain: Chain, parameter: str, row: np.ndarray, phase: float) -> tuple[OrbitEvent, ...]:
    """Return the events of the orbit at a point of a branch, and how long after its state at a phase they come."""
    braces = with_value(chain.system, parameter, float(row[-1])).braces
    # the state is that of the first cycle after the chain's first event, as in `states`
    begins, whole = phase + math.tau * math.ceil((row[0] - phase) / math.tau), math.tau * chain.period
    _, links, trace, _ = equations(chain, parameter, row)
    if math.isnan(trace):
        return ()  # at the end of a branch two events may have changed places
    flips = np.where(chain.kinds == IMPACT, -1, 1)
    sides = chain.side * np.cumprod(np.append(1, flips[1:]))
    before = -flips * sides * _arrivals(chain, parameter, row, int(sides[-1]))
    after = sides * links["leaves"]
    angles = [
        0.0 if kind == IMPACT or braces is None else side * braces.angle
        for kind, side in zip(chain.kinds, sides, strict=True)
    ]
    events = [
        OrbitEvent(float(psi - begins) % whole, float(angle), float(one), float(other))
        for psi, angle, one, other in zip(row[:-1], angles, before, after, strict=True)
    ]
    if chain.mirrored:
        events += [
            OrbitEvent((one.turned + chain.turn) % whole, -one.angle, -one.before, -one.after)
            for one in events
        ]
    return tuple(events)


def _arrivals(chain: Chain, parameter: str, row: np.ndarray, last_side: int) -> np.ndarray:
    """Return the speeds towards the base or away from it at every event's end of the arc before, on the side of that arc.

    Those are the speeds at which the arcs leave backward in time: along a long arc the speed at its start does not give them.
    """
    phases = np.append(-row[0] - chain.turn, -row[-2:0:-1])
    backward = chain._replace(kinds=np.roll(chain.kinds[::-1], 1), side=last_side, phases=phases)
    _, links, *_ = equations(backward, parameter, np.append(phases, row[-1]))
    return np.append(links["leaves"][0], links["leaves"][:0:-1])


def states(chain: Chain, parameter: str, rows: np.ndarray, phase: float, count: int) -> np.ndarray:
    """(Θ, Θ') of orbits at a phase of the forcing, in as many successive cycles: (rows, count, 2)."""
    out = np.empty((len(rows), count, 2))
    chain_queries.states_at(
        parameters(chain.system), NAMES[parameter], chain.fixed, np.ascontiguousarray(rows), phase, out
    )
    return out


def quiet_phase(phases: np.ndarray) -> float:
    """The phase farthest from all events, in [0, 2π): a section there has sides, impacts and derivatives without doubt."""
    around = np.sort(np.mod(phases, math.tau))
    gaps = np.diff(around, append=around[0] + math.tau)
    widest = int(np.argmax(gaps > gaps.max() * (1.0 - 1e-9)))
    return float((around[widest] + 0.5 * gaps[widest]) % math.tau)
