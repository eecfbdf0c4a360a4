"""Proof of an orbit of any kind, at the first precision that suffices."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

import numpy as np
from attrs import evolve
from flint import acb, arb, ctx

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.model.orbit import Orbit, orbit_in_words
from rocking.model.proof import Proof
from rocking.model.verdict import Verdict
from rocking.proof import attraction, periodic, trajectory
from rocking.proof.arc import Balls, Refused, TooLong, above, balls_of, below
from rocking.proof.periodic import Enclosed, chain_of

PRECISIONS = (128, 256, 512, 1024, 2048, 4096)
"""Bits of the numbers: the next one after a refusal."""
ORBIT = PRECISIONS[:4]
"""Bits for an orbit with finitely many events, which needs no long march."""

LIKE = 1e-6
"""Distance up to which a state in double precision is that of an orbit known in closed form."""

Result = TypeVar("Result")


def proof_of(orbit: Orbit, widths: Mapping[str, float], verdict: Verdict | None) -> Proof:
    """Return the proof of an orbit, and of the initial state of a verdict, if there is one."""
    if orbit.superstable:
        attempt = _resting
    else:
        attempt = _by_its_events if orbit.impacts or orbit.brace_hits else _without_events
    try:
        precisions = PRECISIONS if orbit.superstable else ORBIT
        proof, known = _first(precisions, lambda: attempt(orbit, balls_of(orbit.system, widths)))
    except Refused as refusal:
        return Proof(orbit.system, False, str(refusal))
    if widths:
        ranges = ", ".join(f"{name} ± {width:g}" for name, width in widths.items())
        proof = evolve(proof, claim=f"{proof.claim}; for every system with {ranges}")
    return proof if verdict is None or not proof.stable else _started(proof, widths, verdict, known)


def _first(precisions: Iterable[int], attempt: Callable[[], Result]) -> Result:
    """Return the result of an attempt at the first precision at which it succeeds; raise Refused if there is none."""
    reason = ""
    for bits in precisions:
        with ctx.workprec(bits):
            try:
                return attempt()
            except TooLong:
                raise
            except (Refused, np.linalg.LinAlgError, ZeroDivisionError) as refusal:
                reason = str(refusal)
    raise Refused(reason)


def _by_its_events(orbit: Orbit, p: Balls) -> tuple[Proof, Enclosed | None]:
    chain = chain_of(orbit)
    proved = periodic.enclosed(p, chain)
    first, second = periodic.multipliers(proved.trace, proved.determinant, chain.mirrored)
    stable = periodic.stable(proved.trace, proved.determinant)
    words = {True: "it is stable", False: "it is unstable", None: "its stability is not proved"}[stable]
    phases = tuple(
        (float(middle), above(abs(psi - float(middle))))
        for psi, middle in zip(proved.found.box, proved.found.middle, strict=True)
    )
    existence = max(radius for _, radius in phases)
    reach = min(
        below(proved.found.uniqueness - abs(middle - float(middle))) for middle in proved.found.middle
    )
    if not existence <= reach:
        raise Refused("the range of the phases is wider than that in which there is one orbit only")
    whole = 2 if chain.mirrored else 1
    period = chain.half_turns * whole // 2
    impacts, brace_hits = (whole * chain.kinds.count(kind) for kind in (IMPACT, BRACE))
    one = orbit_in_words(chain.mirrored, period, impacts, brace_hits)
    proof = Proof(
        orbit.system,
        True,
        f"exactly one {one} has event phases within {reach:.2g} rad of these; {words}",
        phases=phases,
        existence=existence,
        uniqueness=reach,
        multipliers=(_disc(first), _disc(second)),
        stable=stable,
        symmetric=chain.mirrored,
        period=period,
        impacts=impacts,
        brace_hits=brace_hits,
        bits=ctx.prec,
    )
    return proof, proved


def _resting(orbit: Orbit, p: Balls) -> tuple[Proof, Enclosed | None]:
    if orbit.state.angle != 0.0:
        raise Refused("sustained contact with a brace is not covered")
    turns_there = (arb(orbit.phase) - trajectory.release(p, 0).phase) / arb.pi()
    if orbit.state.velocity != 0.0 or not abs(turns_there - round(float(turns_there))) < LIKE:
        raise Refused("the orbit does not begin with a release from rest")
    turns = periodic.turns_of_reset(p)
    symmetric = turns % 2 == 1
    period = turns if symmetric else turns // 2
    if (symmetric, period) != (orbit.symmetric, orbit.period):
        raise Refused(f"the released block repeats its motion with period {period}")
    middle, radius = _middle_and_radius(trajectory.release(p, 0).phase)
    proof = Proof(
        orbit.system,
        True,
        f"the {orbit_in_words(symmetric, period, None, None)} is the only one with rest at the base, up to its mirror image; it is stable",
        phases=((middle, radius),),
        existence=radius,
        multipliers=((0j, 0.0), (0j, 0.0)),
        stable=True,
        symmetric=symmetric,
        period=period,
        bits=ctx.prec,
    )
    return proof, None


def _without_events(orbit: Orbit, p: Balls) -> tuple[Proof, Enclosed | None]:
    periodic.moves_between(p)
    sine, cosine = arb(orbit.phase).sin_cos()
    side = 1 if orbit.state.angle > 0 else -1
    away = abs(orbit.state.angle - side - p.response * cosine)
    faster = abs(orbit.state.velocity + p.response * p.frequency * sine)
    if not (away < LIKE and faster < LIKE and orbit.period == 1):
        raise Refused("the orbit without events has another state, or another period")
    growth = (2 * arb.pi() / p.frequency).exp()
    proof = Proof(
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
    return proof, None


def _started(proof: Proof, widths: Mapping[str, float], verdict: Verdict, known: Enclosed | None) -> Proof:
    """Return the proof with that of the initial state of a verdict; the orbit is ``known``, or rests."""
    reach = None
    try:
        if known is None:
            bits = _first(PRECISIONS, lambda: _released_alike(widths, verdict))
        else:
            precisions = [bits for bits in ORBIT if bits >= proof.bits]
            goal = _first(precisions, lambda: _goal(proof, widths, verdict, known))
            bits, reach = _first(PRECISIONS, lambda: _arrived(widths, verdict, goal)), goal.reach
    except Refused as refusal:
        claim = f"{proof.claim}. That the initial state leads to it is not proved: {refusal}"
        return evolve(proof, claim=claim, starts=False)
    claim = f"{proof.claim}, and the motion from the initial state converges to it"
    return evolve(proof, claim=claim, attracts=reach, starts=True, bits=max(bits, proof.bits))


def _goal(
    proof: Proof, widths: Mapping[str, float], verdict: Verdict, known: Enclosed
) -> attraction.Neighbourhood:
    assert verdict.orbit is not None
    orbit = known
    if ctx.prec > proof.bits:
        orbit = periodic.enclosed(balls_of(verdict.system, widths), known.chain)
    return attraction.neighbourhood(orbit, verdict.orbit)


def _arrived(widths: Mapping[str, float], verdict: Verdict, goal: attraction.Neighbourhood) -> int:
    """Return the present precision if it suffices to show that the motion comes to the goal."""
    p = balls_of(verdict.system, widths)
    attraction.follow_to(p, trajectory.initial(p, verdict.system.periodic.phase, verdict.start), goal)
    return ctx.prec


def _released_alike(widths: Mapping[str, float], verdict: Verdict) -> int:
    """Return the present precision if it suffices to show that the motion rests, and is released as the orbit is.

    The mirror image of the orbit is another orbit, unless the orbit is symmetric.
    """
    p = balls_of(verdict.system, widths)
    half_turns = periodic.next_release(p, trajectory.initial(p, verdict.system.periodic.phase, verdict.start))
    assert verdict.orbit is not None
    if (half_turns - _resting_half_turns(p, verdict)) % (1 if verdict.orbit.symmetric else 2):
        raise Refused("the motion leads to the mirror image of the orbit")
    return ctx.prec


def _resting_half_turns(p: Balls, verdict: Verdict) -> int:
    """Return m of the release psi = m pi - arccos(1/A) with which the orbit of a verdict begins."""
    assert verdict.orbit is not None
    number = (arb(verdict.orbit.phase) + (1 / p.amplitude).acos()) / arb.pi()
    return round(float(number))


def _middle_and_radius(value: arb) -> tuple[float, float]:
    """Return the nearest double of a ball, and a bound of the distance from it."""
    middle = float(value)
    return middle, above(abs(value - middle))


def _disc(value: acb) -> tuple[complex, float]:
    """Return the nearest complex double of a ball, and a bound of the distance from it."""
    middle = complex(float(value.real), float(value.imag))
    return middle, above(abs(value - acb(middle.real, middle.imag)))
