"""Search for one periodic orbit near a guess."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve

from rocking.kernels.classify import cascade as memory
from rocking.kernels.classify import periodicity
from rocking.kernels.orbits import return_map as kernel
from rocking.model.orbit import Orbit, OrbitEvent
from rocking.model.system import State, System, check_periodic
from rocking.model.validation import NoOrbit, Refusal, instance, whole
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import monodromy, start_march
from rocking.motion.simulate import simulate
from rocking.orbits.event_chain import (
    IMPACT,
    Chain,
    chain_of,
    clocked,
    multipliers_of,
    orbit_of,
    quiet_phase,
    residual_of,
    solved,
)
from rocking.orbits.saddles import saddle_events

MAX_PERIOD = 1000
# Largest distance of two identical states of an orbit.
SAME = 1e-8
# Events of rest on the base, and of sustained contact with a brace.
RESTING, LEANING = ("rest", "lift-off"), ("lean", "leave")


def find_orbit(system: System, guess: State, period: int) -> Orbit:
    """Find a periodic orbit near a guess, stable or unstable, by Newton's method with the exact Jacobian.

    The map over `period` cycles is solved on the section at the forcing phase farthest from all events of the guess. The
    result is solved again as a closed chain of arcs, to rounding.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    guess : State
        Approximate state (Θ, Θ') at τ = 0.
    period : int
        Number of forcing cycles, in [1, 1000].

    Returns
    -------
    Orbit
        Orbit with its least period, a divisor of `period`.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range, or if the guess overturns within `period + 1` cycles.
    NoOrbit
        If Newton's method does not converge. The exception, a ValueError, has the last `state` and its `residual`.

    See Also
    --------
    find_orbits : Search for all orbits up to a period.
    continue_orbit : Follow an orbit through a parameter.
    classify : Find the stable orbit that a motion approaches.

    Notes
    -----
    The orbit is not necessarily the one nearest to the guess. Its `start` is the state, of those at τ = 0 and after whole
    cycles, that is nearest to the guess.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> orbit = rk.find_orbit(system, rk.State(angle=0.18, velocity=-0.1), 1)
    >>> print(orbit)
    symmetric orbit of period 1 with 2 impacts
    >>> round(abs(orbit.multipliers[0]), 6)  # e², because they are complex
    0.855625
    """
    check_periodic(system, instance("guess", guess, State))
    period = whole("period", period, 1, MAX_PERIOD)
    motion = simulate(system, guess, cycles=period + 1)
    if motion.outcome is Outcome.OVERTURNED:
        raise Refusal(
            "guess", f"not overturn within {period + 1} cycles", guess, "use a guess nearer to the orbit"
        )
    frequency, own = system.periodic.frequency, system.periodic.phase
    phase = quiet_phase(own + frequency * motion.events["time"]) if len(motion.events) else own
    wait = ((phase - own) % math.tau) / frequency
    angle, velocity = (float(value) for value in motion.at(wait))
    out = newton_from_starts(clocked(system, phase), period, False, np.array([[angle, velocity]]))[0]
    reached = State(float(out[1]), float(out[2]))
    orbit = orbit_from(system, phase, reached, period) if out[0] else None
    if orbit is None:
        raise NoOrbit(
            f"no orbit of period {period} was found from {guess}: Newton's method ends at {reached}, "
            f"with a residual of {out[3]:.3g} (use a nearer guess, or another period)",
            phase,
            reached,
            float(out[3]),
        )
    return _start_near(orbit, guess)


def _start_near(orbit: Orbit, guess: State) -> Orbit:
    """Return the orbit that starts in the cycle whose start is nearest to the guess.

    Newton's method ends in the cycle after the guess, and the closed chain begins after its first event.
    """
    first = (orbit.system.periodic.phase - orbit.phase) % math.tau
    starts = [orbit._after(first + math.tau * cycle) for cycle in range(orbit.period)]
    distances = [math.hypot(one.angle - guess.angle, one.velocity - guess.velocity) for one in starts]
    cycles = distances.index(min(distances))
    if not cycles:
        return orbit
    turned, whole, state = math.tau * cycles, math.tau * orbit.period, orbit._after(math.tau * cycles)
    return evolve(
        orbit,
        state=state,
        residual=residual_of(orbit.system, orbit.phase, state, orbit.period),
        events=tuple(evolve(one, turned=(one.turned - turned) % whole) for one in orbit._events),
    )


def mirrored_half(chain: Chain) -> Chain | None:
    """Return the events of half a period if the other half is its mirror image, or None.

    A simulation may leave an unstable orbit too soon to show the symmetry.
    """
    count = len(chain.kinds) // 2
    if (
        chain.mirrored
        or chain.period % 2 == 0
        or not np.array_equal(chain.kinds[:count], chain.kinds[count:])
    ):
        return None
    later = chain.phases[count:] - chain.phases[:count]
    if (chain.kinds[:count] == IMPACT).sum() % 2 == 0 or np.abs(later - 0.5 * chain.turn).max() > SAME:
        return None
    return chain._replace(mirrored=True, kinds=chain.kinds[:count].copy(), phases=chain.phases[:count].copy())


def _with_multipliers(orbit: Orbit) -> Orbit:
    """Return an orbit with its multipliers and events, from the motion over one period.

    Used for the full block and the unsymmetric one, and where an impact takes all speed: the equations of such a chain have no solution.
    """
    begun = clocked(orbit.system, orbit.phase)
    derivative = monodromy(begun, orbit.state, orbit.period)
    determinant = float(np.linalg.det(derivative))
    if not orbit.system.restitution_table:  # no cancellation
        determinant = orbit.system.restitution ** (2 * (orbit.impacts or 0))
        if orbit.system.left is not None:  # impacts of both directions alternate
            determinant = (orbit.system.restitution * orbit.system.left.restitution) ** (orbit.impacts or 0)
        if orbit.system.braces is not None:
            determinant *= orbit.system.braces.restitution ** (2 * (orbit.brace_hits or 0))
    events, frequency = simulate(begun, orbit.state, cycles=orbit.period).events, begun.periodic.frequency
    return evolve(
        orbit,
        multipliers=multipliers_of(derivative.trace(), determinant, mirrored=False),
        events=tuple(
            OrbitEvent(
                frequency * float(one["time"]), float(one["angle"]), float(one["before"]), float(one["after"])
            )
            for one in events
        ),
    )


def newton_from_starts(system: System, period: int, mirrored: bool, starts: np.ndarray) -> np.ndarray:
    """Run Newton's method from many initial states, on the map over a period, or over half a period and mirrored.

    Returns
    -------
    ndarray, shape (starts, 4)
        Found (1 or 0), Θ, Θ' and residual for each initial state.
    """
    p, _ = start_march(system, State())
    out = np.empty((len(starts), 4))
    workspace = memory.make_workspace(1, 1)
    kernel.newton_from_starts(p, period, mirrored, starts, workspace.nothing, workspace.trial, out)
    return out


def orbit_from(system: System, phase: float, state: State, period: int) -> Orbit | None:
    """Return the orbit through a state at a forcing phase that repeats after `period` cycles, or None.

    Its least period, symmetry and events are determined. None: a motion from this state overturns within one period, so
    that the orbit is too unstable for double precision.
    """
    motion = simulate(clocked(system, phase), state, cycles=period)
    if motion.outcome is Outcome.OVERTURNED:
        return None
    rows = motion.section()
    halves = np.column_stack(motion.at((np.arange(period) + 0.5) * system.periodic.period))
    least, symmetric = periodicity.repetition(rows, halves, state.angle, state.velocity, period, SAME)
    symmetric = symmetric and system.left is None
    events = motion.events[motion.events["time"] <= least * system.periodic.period]
    rested, leaned = (bool(np.isin(events["kind"], kinds).any()) for kinds in (RESTING, LEANING))
    impacts, brace_hits = (int((events["kind"] == kind).sum()) for kind in ("impact", "brace"))
    grown = math.exp(least * system.periodic.period)
    orbit = Orbit(
        system=system,
        state=state,
        phase=phase % math.tau,
        period=least,
        symmetric=symmetric,
        impacts=None if rested and system.restitution > 0.0 else impacts,
        brace_hits=None if leaned and system.braces and system.braces.restitution > 0.0 else brace_hits,
        multipliers=(0j, 0j) if rested or leaned else (complex(grown), complex(1.0 / grown)),
        residual=float(np.hypot(*(rows[least] - rows[0]))),
        simulate=simulate,
    )
    if orbit.superstable:
        return orbit
    if not system.has_chains:
        return _with_multipliers(orbit)
    if impacts + brace_hits == 0:
        return evolve(orbit, events=saddle_events(system, orbit.phase, orbit.state))
    chain = chain_of(orbit)
    result = solved(chain, "amplitude", system.periodic.amplitude, chain.phases)
    half = mirrored_half(chain._replace(phases=result.phases[:-1])) if result.found else None
    if half is not None:
        chain, result = half, solved(half, "amplitude", system.periodic.amplitude, half.phases)
    if not result.found:
        return _with_multipliers(orbit) if orbit.residual <= SAME else None
    return orbit_of(chain, "amplitude", result.phases, result.trace, result.determinant)
