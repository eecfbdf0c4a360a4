"""Evidence of a verdict in words: one sentence for each criterion of the compiled decision sequence."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import ROUND_UP, Context, Decimal

from attrs import field, frozen

from rocking.kernels.classify import cascade, exponent, periodicity, resets, torus
from rocking.kernels.classify import verdict as kernel
from rocking.kernels.orbits import return_map
from rocking.model.system import System
from rocking.model.text import counted, plus_minus
from rocking.model.verdict import Criterion, Evidence
from rocking.motion.motion import Motion

MAX_GROWTH = f"{math.exp(resets.MAX_STRAIN):.0e}".replace("e+0", "e")

OTHERWISE = "the motion before is so sensitive that different rounding leads to a different end"


@frozen
class Case:
    """Classified response: system and limits, result of the decision sequence, and the motion to its end if that is proved."""

    system: System
    max_cycles: int
    max_period: int
    judgement: kernel.Judgement
    motion: Motion | None


@frozen
class Statement:
    """Finding, and level of its evidence with the number of cycles or a remedy."""

    what: str
    remark: str
    tolerances: dict[str, float] = field(factory=dict)


def evidence_of(case: Case) -> Evidence:
    """Return the evidence in words."""
    criterion = Criterion(case.judgement.ground)
    statement = STATEMENTS[criterion](case)
    return Evidence(
        criterion.level,
        f"{statement.what}. Evidence: {statement.remark}.",
        statement.tolerances,
        case.judgement.cycles,
    )


def _no_return(case: Case) -> Statement:
    overturning = None if case.motion is None else case.motion.overturning
    undone = "the growing part of the motion cannot be reversed"
    if overturning is None:
        return Statement(
            f"overturning is certain, because {undone}", f"exact, within {spent(case)}; {OTHERWISE}"
        )
    when = f"after {counted(overturning.impacts, 'impact')}" if overturning.impacts else "without an impact"
    return Statement(
        f"overturning is certain from τ = {overturning.time:.6g}, {when}, because {undone}",
        f"exact, within {spent(case)}",
    )


def _still_for_ever(case: Case) -> Statement:
    if case.motion is None:
        return Statement(
            "the block remains at rest or in contact with a brace",
            f"exact, within {spent(case)}; {OTHERWISE}",
        )
    amplitude, angle, braces = case.system.periodic.amplitude, case.motion.final.angle, case.system.braces
    if angle != 0.0 and braces is not None:
        # f = −1 − σA cos ψ stays above −Θb
        what = (
            f"the block remains in contact with the brace at Θ = {angle:.6g}, because A = {amplitude:.6g} ≤ Θb − 1 = "
            f"{braces.angle - 1.0:.6g} cannot pull it off"
        )
    else:
        what = f"the block remains at rest, because A = {amplitude:.6g} ≤ {case.system.lift_off:.6g} cannot lift it off"
    moved = case.motion.impacts + case.motion.brace_hits > 0
    return Statement(what, f"exact, within {spent(case)}" if moved else "exact, from the initial state on")


def _reset(case: Case) -> Statement:
    judged = case.judgement
    which = "release from a brace" if judged.angle else "lift-off from rest"
    interval = counted(judged.period, "half cycle") if judged.symmetric else counted(judged.period, "cycle")
    what = (
        f"superstable {_periodic(judged)}: every {which} has the same state{', on alternating sides' * judged.symmetric}; "
        f"successive ones are {interval} of the forcing apart, and perturbations grew less than {MAX_GROWTH}-fold in between"
    )
    return Statement(what, f"verified, {_when(case)}", {"growth": float(MAX_GROWTH)})


def _orbit(case: Case) -> Statement:
    judged = case.judgement
    if judged.distance <= periodicity.ROUNDING:
        reached = f"the motion lies on the orbit to within {periodicity.ROUNDING:.0e}"
    else:
        share = "less than 1" if judged.excess < 0.01 else f"{100.0 * judged.excess:.0f}"
        reached = (
            f"the motion is so close (distance {judged.distance:.2g} one period earlier) that it cannot turn away to second order "
            f"(test at {share} % of its limit)"
        )
    what = (
        f"stable {_periodic(judged)}: Newton residual |P(x) − x| ≤ {at_most(judged.residual)}, largest Floquet multiplier "
        f"{_below_one(math.hypot(judged.real, judged.imaginary))} in modulus; {reached}"
    )
    tolerances = {
        "residual": return_map.RESIDUAL,
        "approach": periodicity.NONLINEAR,
        "distance": periodicity.ROUNDING,
        "second order": 1.0,
    }
    return Statement(what, f"verified, {_when(case)}", tolerances)


def _neutral_orbit(case: Case) -> Statement:
    what = (
        f"neutrally stable {_periodic(case.judgement)}: no event dissipates energy; the motion returns to within "
        f"{cascade.UNMOVED:.0e} of an earlier state, and its averages over both halves of the run agree to "
        f"{torus.ENOUGH_DIGITS:.0f} digits or more; nearby motions stay near but need not converge"
    )
    tolerances = {
        "residual": return_map.RESIDUAL,
        "distance": cascade.UNMOVED,
        "digits": torus.ENOUGH_DIGITS,
    }
    return Statement(what, f"verified, {_when(case)}", tolerances)


def _torus(case: Case) -> Statement:
    what = (
        f"motion on an invariant torus: no event dissipates energy; averages over both halves of the run agree to "
        f"{torus.ENOUGH_DIGITS:.0f} digits or more for the times between impacts and to "
        f"{math.floor(case.judgement.digits)} for the squared speeds; nearby trajectories diverge no faster than linearly; and "
        f"the motion does not return to within {cascade.UNMOVED:.0e} in {case.max_period} cycles"
    )
    tolerances = {
        "flight digits": torus.ENOUGH_DIGITS,
        "speed digits": torus.CHAOTIC_DIGITS,
        "log shear": torus.SHEAR,
        f"log shear below {torus.SHEARED_FLIGHTS} flights": torus.SMALL_SHEAR,
    }
    remark = f"statistical, over {spent(case)}; a motion that stays near a torus for long may leave it later"
    return Statement(what, remark, tolerances)


def _exponent(case: Case) -> Statement:
    judged = case.judgement
    what = (
        f"largest Lyapunov exponent {plus_minus(judged.exponent, judged.error)} per τ, "
        f"{judged.exponent / judged.error:.0f} standard errors above zero"
    )
    remark = f"statistical, over {spent(case)}; a longer run may show that the chaos is transient"
    return Statement(what, remark, {"standard errors": exponent.CLEARLY})


def _little_growth(case: Case) -> Statement:
    grown = case.judgement.exponent * _measured_time(case)
    what = (
        f"{_seems_chaotic(case)}, but over the second half of the run perturbations grew only by a factor of e^{grown:.3g}, "
        "as they also do while a motion leaves an unstable orbit"
    )
    return Statement(what, _longer(case), {"log growth": exponent.FAR})


def _correlated(case: Case) -> Statement:
    what = (
        f"{_seems_chaotic(case)}, but the {exponent.BATCHES} batches behind this error are correlated: merging them in fours "
        f"increases its variance more than {exponent.MAX_CORRELATION:.0f}-fold"
    )
    return Statement(what, _longer(case), {"correlation": exponent.MAX_CORRELATION})


def _lingering(case: Case) -> Statement:
    what = (
        f"{_seems_chaotic(case)}, but in its last cycles the motion stays within {cascade.NEAR:.0e} of an unstable "
        "orbit"
    )
    return Statement(what, f"{_longer(case)} or change the initial state", {"distance": cascade.NEAR})


def _unresolved_reset(case: Case) -> Statement:
    what = (
        f"the block repeatedly comes to rest or into sustained contact with a brace, but perturbations grow more than "
        f"{MAX_GROWTH}-fold between two releases, so that its period cannot be resolved in double precision"
    )
    return Statement(
        what, f"none, after {spent(case)}; a longer run does not help, try slightly different parameters"
    )


def _unwatched(case: Case) -> Statement:
    needed = exponent.CHAOS_NEEDS if case.system.braces is None else exponent.CHAOS_NEEDS_WITH_BRACES
    return Statement(
        f"{_no_orbit(case)}, and {spent(case)} are too few to call the response chaotic",
        f"none, after {spent(case)}; increase max_cycles to {needed:,} or more",
    )


def _indistinct(case: Case) -> Statement:
    judged, longer = case.judgement, _longer(case)
    if not 0.0 < judged.error < math.inf:
        return Statement(
            f"{_no_orbit(case)}, and the largest Lyapunov exponent has no reliable error estimate", longer
        )
    result = f"{_no_orbit(case)}, and the largest Lyapunov exponent, {plus_minus(judged.exponent, judged.error)} per τ, is"
    if judged.exponent < -exponent.CLEARLY * judged.error:
        longer = f"none, after {spent(case)}; increase max_period above {case.max_period} or max_cycles above {case.max_cycles:,}"
        return Statement(f"{result} negative", longer)
    return Statement(f"{result} less than {exponent.CLEARLY:.0f} standard errors above zero", longer)


def _between(case: Case) -> Statement:
    what = (
        f"no event dissipates energy, and averages over both halves of the run agree to {case.judgement.digits:.1f} digits: more "
        f"than in chaotic motion (below {torus.CHAOTIC_DIGITS:.0f}), but not all conditions for a torus are met"
    )
    return Statement(what, _longer(case))


def _crowded(case: Case) -> Statement:
    what = f"more than {cascade.MAX_EVENTS_A_CYCLE} impacts per cycle (chattering with little energy loss); simulation stopped"
    return Statement(
        what,
        f"none, after {spent(case)}; increase the initial speed or reduce the coefficient of restitution",
    )


def _standing(case: Case) -> Statement:
    what = (
        f"the motion remains on an unstable orbit; it returns to within {cascade.UNMOVED:.0e} of an earlier state, "
        f"and perturbations grow at a rate of {case.judgement.exponent:.4g} per τ"
    )
    return Statement(what, f"none, after {spent(case)}; change the initial state slightly")


STATEMENTS: dict[Criterion, Callable[[Case], Statement]] = {
    Criterion.NO_RETURN: _no_return,
    Criterion.STILL_FOR_EVER: _still_for_ever,
    Criterion.RESET: _reset,
    Criterion.ORBIT: _orbit,
    Criterion.NEUTRAL_ORBIT: _neutral_orbit,
    Criterion.TORUS: _torus,
    Criterion.EXPONENT: _exponent,
    Criterion.UNRESOLVED_RESET: _unresolved_reset,
    Criterion.UNWATCHED: _unwatched,
    Criterion.INDISTINCT: _indistinct,
    Criterion.BETWEEN: _between,
    Criterion.CROWDED: _crowded,
    Criterion.STANDING: _standing,
    Criterion.LITTLE_GROWTH: _little_growth,
    Criterion.CORRELATED: _correlated,
    Criterion.LINGERING: _lingering,
}


def spent(case: Case) -> str:
    """Number of simulated cycles, as text."""
    return counted(case.judgement.cycles, "cycle")


def _longer(case: Case) -> str:
    """Level and remedy if a longer run may decide."""
    return f"none, after {spent(case)}; increase max_cycles above {case.max_cycles:,}"


def _measured_time(case: Case) -> float:
    """Time, in τ, over which the exponent is measured: the batches of the second half of the run."""
    batch = case.max_cycles // (2 * exponent.BATCHES)
    return exponent.BATCHES * batch * case.system.periodic.period


def _seems_chaotic(case: Case) -> str:
    judged = case.judgement
    return (
        f"{_no_orbit(case)}, and the largest Lyapunov exponent, {plus_minus(judged.exponent, judged.error)} per τ, is "
        f"{judged.exponent / judged.error:.0f} standard errors above zero"
    )


def _when(case: Case) -> str:
    """Time at which the evidence was found, in cycles, as text."""
    return f"after {spent(case)}" if case.judgement.cycles else "within the first cycle"


def at_most(size: float) -> str:
    """Format a magnitude, rounded up to one digit."""
    return f"{Context(prec=1, rounding=ROUND_UP).create_decimal(Decimal(size)):.0e}" if size else "0"


def _below_one(size: float) -> str:
    """Format a magnitude below 1 to three digits, or to as many as distinguish it from 1."""
    return next(text for digits in (3, 6, 9, 17) if (text := f"{size:.{digits}g}") != "1" or digits == 17)


def _periodic(judged: kernel.Judgement) -> str:
    parts = [f"orbit of period {judged.period}", "symmetric" if judged.symmetric else "asymmetric"]
    for number, what in ((judged.impacts, "impact"), (judged.brace_hits, "brace impact")):
        if number < 0:
            parts.append(f"infinitely many {what}s")
        elif number or what == "impact":
            parts.append(counted(number, what))
    return ", ".join(parts)


def _no_orbit(case: Case) -> str:
    return f"no orbit of period up to {case.max_period} was reached"
