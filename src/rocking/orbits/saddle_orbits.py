"""Saddle orbits near Θ = ±1 of a block without braces, and parameters of its motion forward and backward in time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.kernels.march import march
from rocking.model.orbit import OrbitEvent
from rocking.model.system import State, System
from rocking.model.validation import Refusal, TooManyEvents, instance, refuse_if
from rocking.motion.march_loop import start_march
from rocking.theory import saddle_orbit

# Largest distance of a state from the saddle orbit that it belongs to.
ON_IT = 1e-8


def check(system: System) -> None:
    """Raise ValueError for a system without saddle orbits on one side of Θ = 0, or with impacts that cannot be reversed."""
    instance("system", system, System)
    check_reversible(system)
    if response(system) >= 1.0:
        most = 1.0 + system.harmonic.frequency**2
        allowed = f"be below 1 + Ω² = {most:.6g}, where the saddle orbits touch Θ = 0"
        raise Refusal("amplitude", allowed, system.harmonic.amplitude)


def check_reversible(system: System) -> None:
    """Raise ValueError for a system with braces, or with impacts that cannot be reversed in time."""
    _ = system.harmonic  # refuses other base motions, and the full block
    if system.braces is not None:
        raise Refusal("system", "have no braces: impacts on them are not reversed in time", system.braces)
    refuse_if(
        system.restitution == 0.0, "restitution", "be positive, so that impacts can be reversed in time", 0.0
    )


def too_many_impacts(remedy: str) -> TooManyEvents:
    """Return the error for a motion with too many impacts; ``remedy`` is what should be reduced."""
    return TooManyEvents(
        f"more than {march.MAX_EVENTS:,} impacts before one point: the block chatters with little energy loss (reduce {remedy})"
    )


def response(system: System) -> float:
    """Return β = A/(1 + Ω²)."""
    return float(start_march(system, State())[0].forcing.response)


def saddle(system: System, phase: float, side: int) -> tuple[float, float]:
    """Return Θ and Θ' of the saddle orbit on one side at a forcing phase."""
    forcing = system.harmonic
    return saddle_orbit(phase, forcing.amplitude, forcing.period, "upper" if side > 0 else "lower")


def saddle_events(system: System, phase: float, state: State) -> tuple[OrbitEvent, ...]:
    """Return states of a saddle orbit at intervals of one unit of τ, as its events; none if `state` is not on it at `phase`."""
    side = 1 if state.angle > 0.0 else -1
    angle, velocity = saddle(system, phase, side)
    if math.hypot(state.angle - angle, state.velocity - velocity) > ON_IT:
        return ()
    events = []
    for turned in np.linspace(0.0, math.tau, math.ceil(system.harmonic.period) + 1)[:-1].tolist():
        angle, velocity = saddle(system, phase + turned, side)
        events.append(OrbitEvent(turned, angle, velocity, velocity))
    return tuple(events)


def parameters(system: System, phase: float, backward: bool) -> Any:
    """Return the parameters for the kernels, with time measured from a forcing phase; reversed in time if `backward`.

    In reversed time, Θ' and φ are negated and e is replaced by 1/e.
    """
    p = start_march(system, State())[0]
    phase = math.remainder(phase, math.tau)
    p = p._replace(forcing=p.forcing._replace(phase=-phase if backward else phase))
    if backward:
        p = p._replace(block=p.block._replace(restitution=1.0 / p.block.restitution))
    return p
