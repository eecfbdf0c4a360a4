"""Conversion between a public orbit and the closed chain of its events, which the kernels continue."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from attrs import evolve

from rocking.kernels import event_kinds
from rocking.kernels import system as numbers
from rocking.kernels.orbits import arclength, chain_check, floquet
from rocking.kernels.orbits import chain as kernel
from rocking.kernels.orbits import continuation as following
from rocking.model.orbit import Orbit, OrbitEvent
from rocking.model.system import NO_BRACES, State, System, quantities
from rocking.model.validation import Refusal, Text
from rocking.motion.simulate import simulate
from rocking.orbits.parameter import with_value

IMPACT, BRACE = event_kinds.IMPACT, event_kinds.BRACE
Condition = chain_check.Condition
End = arclength.End
Special = following.Special
NAMES = {
    "amplitude": kernel.AMPLITUDE,
    "frequency": kernel.FREQUENCY,
    "period": kernel.PERIOD,
    "restitution": kernel.RESTITUTION,
    "brace_angle": kernel.BRACE_ANGLE,
    "brace_restitution": kernel.BRACE_RESTITUTION,
}


class Chain(NamedTuple):
    """Events of an orbit; of a symmetric one, those of half a period."""

    system: System  # at one value of the continued parameter
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
        """Constants of a branch, for the kernels."""
        return kernel.Chain(self.kinds, self.side, self.turn, self.mirrored)

    def counts(self) -> tuple[int, int]:
        """Return the number of impacts and of brace impacts per period."""
        times = 2 if self.mirrored else 1
        return times * int((self.kinds == IMPACT).sum()), times * int((self.kinds == BRACE).sum())


class Solved(NamedTuple):
    """Orbit at one value of a parameter."""

    found: bool
    phases: np.ndarray  # phases, then the value of the parameter
    trace: float
    determinant: float
    peak: float


def parameters(system: System) -> Any:
    """Return the parameters of a system for the kernels, with time measured from the forcing phase 0."""
    return numbers.harmonic_parameters(**NO_BRACES | quantities(system) | {"phase": 0.0})


def clocked(system: System, phase: float) -> System:
    """Return the system with time measured from the given forcing phase."""
    return evolve(system, forcing=evolve(system.periodic, phase=phase))


def chain_of(orbit: Orbit) -> Chain:
    """Return the chain of events of an orbit.

    Raises
    ------
    ValueError
        If the orbit has no events, rests, or stays in contact with a brace.
    TypeError
        If the block is not slender.
    """
    forcing = orbit.system.harmonic
    if orbit.superstable:
        got = Text(f"one that does, of period {orbit.period}")
        raise Refusal("orbit", "neither rest nor lean", got, "sweep the parameter with classify")
    events = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period).events
    events = events[np.isin(events["kind"], ("impact", "brace"))]
    if not len(events):
        raise Refusal(
            "orbit",
            "have an impact or a brace impact; it has none",
            remedy="it is the saddle orbit ±1 + β cos ψ",
        )
    psi = orbit.phase + forcing.frequency * events["time"]
    kinds = np.where(events["kind"] == "impact", IMPACT, BRACE).astype(np.int64)
    # side of the block after an event
    side = 1 if (events[0]["after"] > 0.0) == (kinds[0] == IMPACT) else -1
    count = len(events) // 2 if orbit.symmetric else len(events)
    return Chain(orbit.system, orbit.period, orbit.symmetric, kinds[:count], side, np.asarray(psi[:count]))


def check_speeds(orbit: Orbit) -> None:
    """Refuse an orbit with an impact that takes all speed: the kernels cannot distinguish it from a grazing."""
    braces, allowed = orbit.system.braces, "keep some speed at each impact to be followed"
    remedy = "find it at a coefficient of restitution of 0.001 or more"
    if orbit.system.restitution == 0.0 and orbit.impacts:
        raise Refusal("orbit", allowed, Text("one at {restitution} 0"), remedy)
    if braces is not None and braces.restitution == 0.0 and orbit.brace_hits:
        raise Refusal("orbit", allowed, Text("one at {brace_restitution} 0"), remedy)


def solved(chain: Chain, parameter: str, value: float, phases: np.ndarray) -> Solved:
    """Solve for the orbit at one value of a parameter, by Newton's method from approximate phases.

    The orbit counts as not found if a simulation deviates from the chain.
    """
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
    """Return the problem of following a chain through one or two parameters within limits, each with its own scale."""
    return arclength.Problem(
        parameters(chain.system),
        chain.fixed,
        np.array([NAMES[name] for name in names]),
        np.array(limits, float),
        longest,
        arclength.make_workspace(len(chain.kinds), scales),
    )


def branch_table(n: int, points: int, specials: int) -> following.BranchTable:
    """Return arrays for the points and special points of a branch with n unknowns."""
    return following.BranchTable(
        np.empty((points, n)),
        np.empty(points, following.FACTS),
        np.empty((specials, n)),
        np.empty(specials, following.CHANGE),
    )


def equations(chain: Chain, parameter: str, row: np.ndarray) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return the equations at a point of a branch.

    Returns
    -------
    tuple of (ndarray, ndarray, float, float)
        Jacobian; data of each arc; trace and determinant of the return map.
    """
    k = len(chain.kinds)
    there = kernel.make_equations(k + 1)
    trace, determinant = kernel.equations_at(
        parameters(chain.system), NAMES[parameter], chain.fixed, row, there
    )
    return there.jacobian[:k], there.links[:k], trace, determinant


def null_direction(chain: Chain, parameter: str, row: np.ndarray) -> np.ndarray:
    """Return the direction of the phases, of mean square 1, in which an orbit may move at a special point."""
    jacobian, *_ = equations(chain, parameter, row)
    direction = np.linalg.svd(jacobian[:, :-1])[2][-1]
    return direction / math.sqrt(np.mean(direction**2))


def multipliers_of(trace: float, determinant: float, mirrored: bool) -> tuple[complex, complex]:
    """Return the Floquet multipliers over one period, the larger first, or the one above the real axis."""
    trace, determinant = float(trace), float(determinant)
    first, second = floquet.complex_multipliers(
        0.5 * trace, 0.25 * trace * trace - determinant, determinant, mirrored
    )
    return first, second


def residual_of(system: System, phase: float, start: State, period: int) -> float:
    """Return the distance between a state at a forcing phase and the state `period` cycles later."""
    final = simulate(clocked(system, phase), start, cycles=period, record="none").final
    return math.hypot(final.angle - start.angle, final.velocity - start.velocity)


def orbit_at(chain: Chain, parameter: str, row: np.ndarray) -> Orbit:
    """Return the orbit at a point of a branch, with its multipliers from the equations there."""
    *_, trace, determinant = equations(chain, parameter, row)
    return orbit_of(chain, parameter, row, trace, determinant)


def orbit_of(chain: Chain, parameter: str, row: np.ndarray, trace: float, determinant: float) -> Orbit:
    """Return the orbit at a point of a branch; ``row`` contains its phases and the value of the parameter."""
    system = with_value(chain.system, parameter, float(row[-1]))
    phase = quiet_phase(np.append(row[:-1], row[:-1] + math.pi if chain.mirrored else []))
    state = states(chain, parameter, row[None], phase, 1)[0, 0]
    start = State(float(state[0]), float(state[1]))
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
        residual=residual_of(system, phase, start, chain.period),
        simulate=simulate,
        events=_events(chain, parameter, row, phase),
    )


def _events(chain: Chain, parameter: str, row: np.ndarray, phase: float) -> tuple[OrbitEvent, ...]:
    """Return the events of the orbit at a point of a branch, each with its forcing phase after the state at `phase`."""
    braces = with_value(chain.system, parameter, float(row[-1])).braces
    # The state is that of the first cycle after the first event of the chain, as in `states`.
    begins, whole = phase + math.tau * math.ceil((row[0] - phase) / math.tau), math.tau * chain.period
    _, links, trace, _ = equations(chain, parameter, row)
    if math.isnan(trace):
        return ()  # at the end of a branch two events may have changed places
    flips, sides = np.where(chain.kinds == IMPACT, -1, 1), sides_of(chain)
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


def sides_of(chain: Chain) -> np.ndarray:
    """Return the side of the block after each event."""
    flips = np.where(chain.kinds == IMPACT, -1, 1)
    return np.asarray(chain.side * np.cumprod(np.append(1, flips[1:])))


def _arrivals(chain: Chain, parameter: str, row: np.ndarray, last_side: int) -> np.ndarray:
    """Return the speed just before each event, towards the base or away from it, on the side of the arc before.

    These are the initial speeds of the arcs in reversed time. On a long arc, the speed at its start does not determine the
    speed at its end accurately.
    """
    phases = np.append(-row[0] - chain.turn, -row[-2:0:-1])
    backward = chain._replace(kinds=np.roll(chain.kinds[::-1], 1), side=last_side, phases=phases)
    _, links, *_ = equations(backward, parameter, np.append(phases, row[-1]))
    return np.append(links["leaves"][0], links["leaves"][:0:-1])


def states(chain: Chain, parameter: str, rows: np.ndarray, phase: float, count: int) -> np.ndarray:
    """Return Θ and Θ' of orbits at a forcing phase in successive cycles, shape (rows, count, 2)."""
    out = np.empty((len(rows), count, 2))
    kernel.states_at(
        parameters(chain.system), NAMES[parameter], chain.fixed, np.ascontiguousarray(rows), phase, out
    )
    return out


def quiet_phase(phases: np.ndarray) -> float:
    """Return the phase in [0, 2π) farthest from all events, where sides, impacts and derivatives are unambiguous."""
    around = np.sort(np.mod(phases, math.tau))
    gaps = np.diff(around, append=around[0] + math.tau)
    widest = int(np.argmax(gaps > gaps.max() * (1.0 - 1e-9)))
    return float((around[widest] + 0.5 * gaps[widest]) % math.tau)
