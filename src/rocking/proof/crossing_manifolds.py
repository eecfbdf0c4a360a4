"""Transversal crossing of the manifolds of the two saddle orbits at Θ = 0, in closed form: proof of a horseshoe.

The saddle orbits are Θ = ±1 + β cos ψ, with β = A/(1 + Ω²) < 1. At a phase ψ the unstable manifold of the lower one arrives at
Θ = 0 with the speed V_u. The stable manifold of the upper one leaves it with V_s:

    V_u = 1 - β (cos ψ + Ω sin ψ),  V_s = 1 + β (cos ψ - Ω sin ψ).

They cross where e V_u = V_s. The phases of such crossings obey

    β sqrt((1 + e)² + Ω² (1 - e)²) cos(ψ + δ) = -(1 - e),  tan δ = Ω (1 - e)/(1 + e).

Above the exact tangency there are two simple roots, so that the crossing is transversal. At one of them both arcs must stay on
their side of Θ = 0, all the way from and to the saddles. For all t > 0 and both signs s this requires

    1 + s β cos(ψ + s Ω t) > (1 + s β cos ψ) e^-t.

The two saddles are one closed orbit of the system in which mirror images are the same. So the crossing is homoclinic, and the
Smale-Birkhoff theorem applies.
"""

from __future__ import annotations

from collections.abc import Callable

from flint import arb, ctx

from rocking.model import Horseshoe, System
from rocking.proof.arc import Values, stays_positive
from rocking.proof.balls import Balls, Refused, balls_of

PRECISIONS = (128, 256, 512)


def horseshoe_of(system: System) -> Horseshoe:
    """Return the proof by the closed form, at the first precision that suffices."""
    reason = ""
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            try:
                phase = float(crossing(balls_of(system, {})))
            except Refused as refusal:
                reason = str(refusal)
                continue
        claim = (
            "the manifolds of the saddle orbits cross transversally at Θ = 0, "
            f"at the forcing phase {phase:.3g} rad"
        )
        return Horseshoe(system, True, claim, phase)
    return Horseshoe(system, False, reason)


def crossing(p: Balls) -> arb:
    """Return the phase of a transversal crossing whose arcs stay on their side; raise Refused if there is none."""
    if not p.restitution > 0:
        raise Refused("the impact takes all energy, so that the motion cannot be reversed")
    if not p.response < 1:
        raise Refused("the saddle orbits reach Θ = 0, or may reach it")
    gain, loss = 1 + p.restitution, 1 - p.restitution
    size = p.response * (gain**2 + (p.frequency * loss) ** 2).sqrt()
    if not size > loss:
        raise Refused(
            "the manifolds do not cross, or it is not decided: the amplitude is not above that of their tangency"
        )
    shift, opening = (p.frequency * loss / gain).atan(), (-loss / size).acos()
    for root in (opening - shift, -opening - shift):
        if arcs_stay(p, root):
            return root
    raise Refused("the manifolds cross, but their arcs reach Θ = 0 before, or may reach it")


def arcs_stay(p: Balls, phase: arb) -> bool:
    """Return whether both arcs that meet at a phase stay on their side of Θ = 0."""
    longest = ((1 + p.response) / (1 - p.response)).log() + 1
    return all(
        bool(arc(arb(0)).first > 0) and stays_positive(arc, longest, 1, False)
        for arc in (distance(p, phase, -1), distance(p, phase, 1))
    )


def distance(p: Balls, phase: arb, sign: int) -> Callable[[arb], Values]:
    """Return 1 + sign β cos(ψ + sign Ω t) - (1 + sign β cos ψ) e^-t as a function of t, with its derivatives."""
    rate, swing = sign * p.frequency, sign * p.response
    start = 1 + swing * phase.cos()

    def at(time: arb) -> Values:
        sine, cosine = (phase + rate * time).sin_cos()
        decay = start / time.exp()
        return Values(
            1 + swing * cosine - decay,
            decay - swing * rate * sine,
            -decay - swing * rate * rate * cosine,
            decay + swing * rate**3 * sine,
        )

    return at
