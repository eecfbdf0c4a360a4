"""Why a response is called what it is called: one sentence for each criterion of the compiled cascade."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import ROUND_UP, Context, Decimal

from attrs import field, frozen

from rocking.kernels.classify import decision_cascade, leg, periodicity, quasi_periodicity, reset, workspace
from rocking.kernels.classify import verdict_record as kernel
from rocking.kernels.orbits import fixed_point
from rocking.model import Criterion, Evidence, System, counted, plus_minus
from rocking.motion import Motion

MAX_GROWTH = f"{math.exp(reset.MAX_STRAIN):.0e}".replace("e+0", "e")

OTHERWISE = "but so sensitive until then that another rounding ends otherwise"


@frozen
class Case:
    """A judged response: what was asked, what the cascade answered, and the motion to its end where that is proved."""

    system: System
    max_cycles: int
    max_period: int
    judgement: kernel.Judgement
    motion: Motion | None


@frozen
class Shown:
    """What was shown, and a way out where it did not suffice."""

    what: str
    remark: str
    tolerances: dict[str, float] = field(factory=dict)


def evidence_of(case: Case) -> Evidence:
    """The evidence in one sentence."""
    criterion = Criterion(case.judgement.ground)
    shown = SHOWN[criterion](case)
    return Evidence(
        criterion.level, f"{shown.what} ({shown.remark})", shown.tolerances, case.judgement.cycles
    )


def _no_return(case: Case) -> Shown:
    overturning = None if case.motion is None else case.motion.overturning
    undone = "the growing part of the motion can no longer be undone"
    if overturning is None:
        return Shown(f"proved after {spent(case)} never to return: {undone}", f"exact; {OTHERWISE}")
    when = f"after {counted(overturning.impacts, 'impact')}" if overturning.impacts else "without an impact"
    return Shown(f"proved {when}, at τ = {overturning.time:.6g}, never to return: {undone}", "exact")


def _still_for_ever(case: Case) -> Shown:
    if case.motion is None:
        return Shown(f"rests or leans for ever after {spent(case)}", f"exact; {OTHERWISE}")
    amplitude, angle, braces = case.system.forcing.amplitude, case.motion.final.angle, case.system.braces
    if angle != 0.0 and braces is not None:
        # f = −1 − σA cos ψ stays above −Θb
        what = f"leans on the brace at Θ = {angle:.6g} for ever: A = {amplitude:.6g} ≤ Θb − 1 = {braces.angle - 1.0:.6g} never pulls it off"
    else:
        what = f"rests for ever: A = {amplitude:.6g} ≤ 1 never lifts it off"
    moved = case.motion.impacts + case.motion.brace_hits > 0
    return Shown(what, f"exact, within {spent(case)}" if moved else "exact")


def _reset(case: Case) -> Shown:
    judged = case.judgement
    which = "release from a brace" if judged.angle else "lift-off from rest"
    apart = counted(judged.period, "half cycle") if judged.symmetric else counted(judged.period, "cycle")
    return Shown(
        f"{_periodic(judged)}: every {which} is the same state{' but for its side' * judged.symmetric}, two of them are "
        f"{apart} of the forcing apart, and differences grew less than {MAX_GROWTH}-fold between them",
        f"verified, {_when(case)}",
        {"growth": float(MAX_GROWTH)},
    )


def _orbit(case: Case) -> Shown:
    judged = case.judgement
    if judged.distance <= periodicity.ROUNDING:
        reached = f"the motion lies on the orbit to within {periodicity.ROUNDING:.0e}"
    else:
        reached = f"the motion, {judged.distance:.2g} away a period before, approaches the orbit as they say"
    return Shown(
        f"{_periodic(judged)}: Newton's method met |P(x) − x| ≤ {at_most(judged.residual)}, both multipliers are inside the "
        f"unit circle (largest {_below_one(math.hypot(judged.real, judged.imaginary))}) and {reached}",
        f"verified, {_when(case)}",
        {
            "residual": fixed_point.RESIDUAL,
            "approach": periodicity.NONLINEAR,
            "distance": periodicity.ROUNDING,
        },
    )


def _neutral_orbit(case: Case) -> Shown:
    return Shown(
        f"{_periodic(case.judgement)}: the motion comes back to within {decision_cascade.UNMOVED:.0e} of where it was, its averages over "
        f"both halves of the run agree to {quasi_periodicity.ENOUGH_DIGITS:.0f} digits or more, and nothing is lost, so that neighbours "
        "stay neighbours and need not approach",
        f"verified, {_when(case)}",
        {
            "residual": fixed_point.RESIDUAL,
            "distance": decision_cascade.UNMOVED,
            "digits": quasi_periodicity.ENOUGH_DIGITS,
        },
    )


def _torus(case: Case) -> Shown:
    return Shown(
        f"nothing is lost; the averages over both halves of the run agree as on a torus, to "
        f"{quasi_periodicity.ENOUGH_DIGITS:.0f} digits or more "
        f"for the flight times and {math.floor(case.judgement.digits)} for the squared speeds; neighbours part no faster than "
        f"linearly; and it does not return to within {decision_cascade.UNMOVED:.0e} in {case.max_period} cycles",
        f"statistical, over {spent(case)}: a motion that stays near a torus for long may leave it later",
        {
            "flight digits": quasi_periodicity.ENOUGH_DIGITS,
            "speed digits": quasi_periodicity.CHAOTIC_DIGITS,
            "log shear": quasi_periodicity.SHEAR,
            f"log shear below {quasi_periodicity.SHEARED_FLIGHTS} flights": quasi_periodicity.SMALL_SHEAR,
        },
    )


def _exponent(case: Case) -> Shown:
    judged = case.judgement
    return Shown(
        f"largest exponent {plus_minus(judged.exponent, judged.error)} per τ, {judged.exponent / judged.error:.0f} standard "
        f"errors above zero, watched for {spent(case)}",
        "statistical: a longer run may find an end to it",
        {"standard errors": kernel.CLEARLY},
    )


def _little_growth(case: Case) -> Shown:
    grown = case.judgement.exponent * _measured_time(case)
    return Shown(
        f"{_seems_chaotic(case)}, but over the second half of the run differences grew by a factor of only e^{grown:.3g}: they "
        "do so too while a motion leaves an unstable orbit",
        _longer(case),
        {"log growth": kernel.FAR},
    )


def _correlated(case: Case) -> Shown:
    return Shown(
        f"{_seems_chaotic(case)}, but the {workspace.BATCHES} batches behind that error depend on each other: joined four to one "
        f"they raise its variance more than {kernel.MAX_CORRELATION:.0f}-fold",
        _longer(case),
        {"correlation": kernel.MAX_CORRELATION},
    )


def _lingering(case: Case) -> Shown:
    return Shown(
        f"{_seems_chaotic(case)}, but in its last cycles the motion stays within {decision_cascade.NEAR:.0e} of an unstable "
        "orbit",
        f"{_longer(case)}, or start elsewhere",
        {"distance": decision_cascade.NEAR},
    )


def _unresolved_reset(case: Case) -> Shown:
    return Shown(
        f"it comes to rest or leans and is released again, but between two releases differences grow more than "
        f"{MAX_GROWTH}-fold: after how many cycles it repeats itself is not known in double precision",
        "no longer run can tell; a slightly different system may",
    )


def _unwatched(case: Case) -> Shown:
    needed = kernel.CHAOS_NEEDS if case.system.braces is None else kernel.CHAOS_NEEDS_WITH_BRACES
    return Shown(f"{_no_orbit(case)}, too few to call it chaotic", f"raise max_cycles to {needed:,} or more")


def _indistinct(case: Case) -> Shown:
    judged, longer = case.judgement, _longer(case)
    if not 0.0 < judged.error < math.inf:
        return Shown(
            f"{_no_orbit(case)}, and its largest exponent has no error that could be trusted", longer
        )
    found = (
        f"{_no_orbit(case)}, and its largest exponent, {plus_minus(judged.exponent, judged.error)} per τ, is"
    )
    if judged.exponent < -kernel.CLEARLY * judged.error:
        longer = f"raise max_period above {case.max_period}, or max_cycles above {case.max_cycles:,}"
        return Shown(f"{found} negative", longer)
    return Shown(f"{found} less than {kernel.CLEARLY:.0f} standard errors above zero", longer)


def _between(case: Case) -> Shown:
    return Shown(
        f"nothing is lost, and the averages over both halves of {spent(case)} agree to {case.judgement.digits:.1f} digits: better "
        f"than on chaotic motion (below {quasi_periodicity.CHAOTIC_DIGITS:.0f}), but not all is as on a torus",
        _longer(case),
    )


def _crowded(case: Case) -> Shown:
    return Shown(
        f"more impacts than are followed, over {leg.MAX_EVENTS_A_CYCLE} a cycle: it chatters almost without loss; given up "
        f"after {spent(case)}",
        "start it faster, or take a smaller restitution",
    )


def _standing(case: Case) -> Shown:
    return Shown(
        f"it comes back to within {decision_cascade.UNMOVED:.0e} of where it was in {spent(case)}, and differences grow by "
        f"{case.judgement.exponent:.4g} per τ: it stands on an unstable orbit",
        "start it a little beside",
    )


SHOWN: dict[Criterion, Callable[[Case], Shown]] = {
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
    """How many cycles were followed."""
    return counted(case.judgement.cycles, "cycle")


def _longer(case: Case) -> str:
    """The remedy where a longer run may decide."""
    return f"raise max_cycles above {case.max_cycles:,}"


def _measured_time(case: Case) -> float:
    """The time, in τ, over which the exponent is measured: the batches of the second half."""
    return workspace.BATCHES * (case.max_cycles // (2 * workspace.BATCHES)) * case.system.forcing.period


def _seems_chaotic(case: Case) -> str:
    judged = case.judgement
    return (
        f"{_no_orbit(case)}, and its largest exponent, {plus_minus(judged.exponent, judged.error)} per τ, is "
        f"{judged.exponent / judged.error:.0f} standard errors above zero"
    )


def _when(case: Case) -> str:
    """When it was shown: what is seen at once is seen before a cycle is over."""
    return f"after {spent(case)}" if case.judgement.cycles else "within the first cycle"


def at_most(size: float) -> str:
    """A size rounded up to one digit."""
    return f"{Context(prec=1, rounding=ROUND_UP).create_decimal(Decimal(size)):.0e}" if size else "0"


def _below_one(size: float) -> str:
    """A size below 1 to three digits, or to as many as tell it from 1."""
    return next(text for digits in (3, 6, 9, 17) if (text := f"{size:.{digits}g}") != "1" or digits == 17)


def _periodic(judged: kernel.Judgement) -> str:
    parts = [f"period {judged.period}", "symmetric" if judged.symmetric else "unsymmetric"]
    for number, what in ((judged.impacts, "impact"), (judged.brace_hits, "brace hit")):
        if number < 0:
            parts.append(f"infinitely many {what}s")
        elif number or what == "impact":
            parts.append(counted(number, what))
    return ", ".join(parts)


def _no_orbit(case: Case) -> str:
    return f"no orbit of period up to {case.max_period} was reached in {spent(case)}"
