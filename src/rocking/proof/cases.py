"""Proof of an orbit of any kind, at the first precision that suffices."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from attrs import evolve
from flint import acb, arb, ctx

from rocking.model import Orbit, Proof, Verdict
from rocking.proof import attraction, periodic, reset, stability, trajectory
from rocking.proof.balls import Balls, Refused, TooLong, above, balls_of, below
from rocking.proof.orbit_chain import chain_of

PRECISIONS = (128, 256, 512, 1024, 2048, 4096)
"""Bits of the numbers: the next one after a refusal."""
ORBIT = PRECISIONS[:4]
"""Bits for an orbit with finitely many events, which needs no long march."""


def proof_of(orbit: Orbit, widths: Mapping[str, float], verdict: Verdict | None) -> Proof:
    """Return the proof of an orbit, and of the initial state of a verdict, if there is one."""
    proof = _proof_of(orbit, widths, verdict)
    if not (proof.proved and widths):
        return proof
    ranges = ", ".join(f"{name} ± {width:g}" for name, width in widths.items())
    return evolve(proof, claim=f"{proof.claim}; for every system with {ranges}")


def _proof_of(orbit: Orbit, widths: Mapping[str, float], verdict: Verdict | None) -> Proof:
    if orbit.superstable:
        proof = _first(orbit, widths, _resting, PRECISIONS)
        return proof if verdict is None or not proof.proved else _started(proof, widths, verdict, None)
    if not (orbit.impacts or orbit.brace_hits):
        return _first(orbit, widths, _without_events, ORBIT)
    proof = _first(orbit, widths, _by_its_events, ORBIT)
    return proof if verdict is None or not proof.stable else _started(proof, widths, verdict, orbit)


def _first(
    orbit: Orbit,
    widths: Mapping[str, float],
    attempt: Callable[[Orbit, Balls], Proof],
    precisions: tuple[int, ...],
) -> Proof:
    """Return the result of the first precision at which an attempt succeeds."""
    reason = ""
    for bits in precisions:
        with ctx.workprec(bits):
            try:
                return attempt(orbit, balls_of(orbit.system, widths))
            except (Refused, ValueError) as refusal:
                reason = str(refusal)
    return Proof(orbit.system, False, reason)


def _by_its_events(orbit: Orbit, p: Balls) -> Proof:
    chain = chain_of(orbit)
    proved = periodic.enclosed(p, chain)
    first, second = stability.multipliers(proved.trace, proved.determinant, chain.mirrored)
    stable = stability.stable(proved.trace, proved.determinant)
    words = {True: "it is stable", False: "it is unstable", None: "its stability is not proved"}[stable]
    phases = tuple(_middle_and_radius(psi) for psi in proved.found.box)
    existence = max(radius for _, radius in phases)
    reach = below(arb(proved.found.uniqueness) - proved.found.existence - existence)
    return Proof(
        orbit.system,
        True,
        f"exactly one {orbit} has event phases within {reach:.2g} rad of these; {words}",
        phases=phases,
        existence=existence,
        uniqueness=reach,
        multipliers=(_disc(first), _disc(second)),
        stable=stable,
        symmetric=chain.mirrored,
        period=orbit.period,
        impacts=orbit.impacts,
        brace_hits=orbit.brace_hits,
        bits=ctx.prec,
    )


def _resting(orbit: Orbit, p: Balls) -> Proof:
    if orbit.state.angle != 0.0:
        raise Refused("sustained contact with a brace is not covered")
    turns = reset.turns_of_reset(p)
    symmetric = turns % 2 == 1
    period = turns if symmetric else turns // 2
    if (symmetric, period) != (orbit.symmetric, orbit.period):
        raise Refused(f"the released block repeats its motion with period {period}")
    middle, radius = _middle_and_radius(trajectory.release(p, 0).phase)
    return Proof(
        orbit.system,
        True,
        f"the {orbit} is the only one with rest at the base, up to its mirror image; it is stable",
        phases=((middle, radius),),
        existence=radius,
        multipliers=((0j, 0.0), (0j, 0.0)),
        stable=True,
        symmetric=symmetric,
        period=period,
        bits=ctx.prec,
    )


def _without_events(orbit: Orbit, p: Balls) -> Proof:
    periodic.moves_between(p)
    growth = (2 * arb.pi() / p.frequency).exp()
    return Proof(
        orbit.system,
        True,
        "Θ = ±1 + β cos ψ is an orbit of period 1 without events; it is unstable",
        existence=0.0,
        multipliers=(_disc(acb(growth)), _disc(acb(1 / growth))),
        stable=False,
        period=1,
        impacts=0,
        brace_hits=0,
        bits=ctx.prec,
    )


def _started(proof: Proof, widths: Mapping[str, float], verdict: Verdict, orbit: Orbit | None) -> Proof:
    """Return the proof with that of the initial state of a verdict; ``orbit`` is None if the orbit rests."""
    reason = ""
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            try:
                reach = _reached(balls_of(verdict.system, widths), verdict, orbit)
            except (Refused, np.linalg.LinAlgError, ZeroDivisionError) as refusal:
                reason = str(refusal)
                if isinstance(refusal, TooLong):
                    break
                continue
        claim = f"{proof.claim}, and the motion from the initial state converges to it"
        return evolve(proof, claim=claim, attracts=reach, starts=True, bits=max(bits, proof.bits))
    claim = f"{proof.claim}. That the initial state leads to it is not proved: {reason}"
    return evolve(proof, claim=claim, starts=False)


def _reached(p: Balls, verdict: Verdict, orbit: Orbit | None) -> float | None:
    """Return the radius of attraction of the orbit that a motion reaches, None if it rests; raise Refused if it may not."""
    state = attraction.initial(p, verdict.system.periodic.phase, verdict.start)
    if orbit is None:
        half_turns = reset.next_release(p, state)
        release = _resting_half_turns(p, verdict)
        if (half_turns - release) % (1 if verdict.symmetric else 2):
            raise Refused("the motion leads to the mirror image of the orbit")
        return None
    goal = attraction.neighbourhood(periodic.enclosed(p, chain_of(orbit)), orbit)
    attraction.follow_to(p, state, goal)
    return goal.reach


def _resting_half_turns(p: Balls, verdict: Verdict) -> int:
    """Return m of the release psi = m pi - arccos(1/A) with which the orbit of a verdict begins."""
    assert verdict.orbit is not None
    number = (arb(verdict.orbit.phase) + (1 / p.amplitude).acos()) / arb.pi()
    return round(float(number.mid()))


def _middle_and_radius(value: arb) -> tuple[float, float]:
    """Return the nearest double of a ball, and a bound of the distance from it."""
    middle = float(value.mid())
    return middle, above(abs(value - middle))


def _disc(value: acb) -> tuple[complex, float]:
    """Return the nearest complex double of a ball, and a bound of the distance from it."""
    middle = complex(float(value.real.mid()), float(value.imag.mid()))
    return middle, above(abs(value - acb(middle.real, middle.imag)))
