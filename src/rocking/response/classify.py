"""Classification of a response, with its evidence, its rotation number and, on request, its proof."""

from __future__ import annotations

import math
from concurrent.futures import Future
from contextlib import suppress
from threading import Thread
from typing import Any, Literal

import numpy as np
from attrs import evolve, frozen

from rocking.kernels import batch
from rocking.kernels.classify import verdict as kernel
from rocking.model.orbit import Orbit
from rocking.model.system import State, System, check_periodic
from rocking.model.validation import TooManyEvents, refuse_if, whole
from rocking.model.verdict import Kind, Outcome, Verdict
from rocking.motion.march_loop import start_march
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.proof.prove import check_provable, prove
from rocking.response.batch_means import batch_mean
from rocking.response.evidence import Case, evidence_of
from rocking.response.rotation_number import (
    CERTAIN_DIGITS,
    RotationNumber,
    average,
    flights_of,
    rotation_of,
    strikes_of,
)


def transient_of(judged: kernel.Judgement | kernel.ResultArrays) -> Any:
    """Return the cycles after which a response was reached at the latest, as an integer or an array; -1 if unknown.

    A block that never moves has no transient. The decision sequence itself gives the cycle of the checkpoint at which rest was
    proved. If a block overturns, the cycles before that of the proof count.
    """
    # Rest after a motion needs an event, which `work` counts.
    unmoved = np.equal(judged.kind, kernel.REST) & np.equal(judged.work, 0)
    before_proof = np.maximum(np.subtract(judged.cycles, 1), 0)
    moved = np.where(np.equal(judged.kind, kernel.OVERTURNS), before_proof, judged.transient)
    return np.where(unmoved, 0, moved)


# Length of the run of a response whose impacts are counted, and number of cycles discarded before.
CYCLES, TRANSIENT = 20_000, 2_000


@frozen
class MeanImpacts:
    """Mean number of impacts at Θ = 0 per forcing cycle; returned by `mean_impacts`.

    Attributes
    ----------
    value, error : float
        Mean number and its error; NaN if there is none.
    rotation : RotationNumber or None
        Rotation numbers of an undamped motion, with the rotation within its island.
    """

    value: float
    error: float
    rotation: RotationNumber | None = None


UNKNOWN = MeanImpacts(math.nan, math.nan)


def mean_impacts(verdict: Verdict) -> MeanImpacts:
    """Return the mean number of impacts per forcing cycle of a classified response.

    A periodic response has the fraction (impacts per period)/period, and a block at rest has none. The impacts of other
    responses are counted in a run of `simulate`, which rounds differently from `classify`.

    Parameters
    ----------
    verdict : Verdict
        Result of `classify`.

    Returns
    -------
    MeanImpacts
        NaN if the block overturns, if the response is undetermined, or if infinitely many impacts precede rest.

    Examples
    --------
    >>> import rocking as rk
    >>> result = mean_impacts(rk.classify(rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)))
    >>> round(result.value, 6), result.error  # two impacts in three cycles
    (0.666667, 0.0)
    """
    if verdict.kind is Kind.REST:
        return MeanImpacts(0.0, 0.0)
    if verdict.kind is Kind.PERIODIC:
        return _of_orbit(verdict)
    if verdict.kind is Kind.QUASI_PERIODIC:
        return _on_torus(verdict)
    return _counted(verdict) if verdict.kind is Kind.CHAOTIC else UNKNOWN


def _of_orbit(verdict: Verdict) -> MeanImpacts:
    if verdict.period is None or verdict.impacts_per_period is None:
        return UNKNOWN
    return MeanImpacts(verdict.impacts_per_period / verdict.period, 0.0)


def _on_torus(verdict: Verdict) -> MeanImpacts:
    motion = simulate(verdict.system, verdict.start, CYCLES, record="all")
    try:
        strikes = strikes_of(motion)
    except ValueError:
        # This run rounds differently, and it overturns or rests.
        return UNKNOWN
    try:
        rotation = rotation_of(motion, *strikes)
    except ValueError:
        # The rotation within the island is not known. The mean number of impacts does not need it.
        rotation = None
    section = strikes[0]
    if section != "impacts":
        return MeanImpacts(0.0, 0.0, rotation)
    time, digits = average(flights_of(motion, section))
    return MeanImpacts(1.0 / time, 10.0 ** -min(digits, CERTAIN_DIGITS) / time, rotation)


def _counted(verdict: Verdict) -> MeanImpacts:
    """Count the impacts of a chaotic motion. The error is infinite if the run supports none, and there is no mean if the block rests."""
    try:
        motion = simulate(verdict.system, verdict.start, CYCLES + TRANSIENT, record="all")
    except TooManyEvents:
        return UNKNOWN
    events = motion.events[motion.events["cycle"] >= TRANSIENT]
    if motion.outcome is not Outcome.BOUNDED or np.isin(events["kind"], ("rest", "lean")).any():
        return UNKNOWN
    cycles = events["cycle"][events["kind"] == "impact"] - TRANSIENT
    mean = batch_mean(np.bincount(cycles, minlength=CYCLES)[:CYCLES])
    return MeanImpacts(mean.value, mean.error)


Wanted = bool | Literal["orbit"]


def check_wanted(requested: Wanted, system: System) -> None:
    """Raise an error unless a proof is not wanted, or can be tried.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    ValueError
        If the block is not slender, or `requested` is neither a boolean nor "orbit".
    """
    known = isinstance(requested, bool) or (isinstance(requested, str) and requested == "orbit")
    refuse_if(not known, "prove", 'be False, True or "orbit"', requested)
    if requested:
        check_provable(system)


def with_proof(verdict: Verdict, requested: Wanted) -> Verdict:
    """Return a verdict with the proof of its orbit, which never changes the type of response.

    Only the proof that the initial state leads to the orbit raises the level of the evidence to "proved".
    """
    if not requested:
        return verdict
    if verdict.orbit is None:
        statement = f"{verdict.evidence.statement} Only a periodic response is proved in ball arithmetic."
        return evolve(verdict, evidence=evolve(verdict.evidence, statement=statement))
    proof = prove(verdict.orbit if requested == "orbit" else verdict)
    statement, level = verdict.evidence.statement, verdict.evidence.level
    if proof.starts:
        statement, level = statement.replace(f"Evidence: {level}", "Evidence: proved"), "proved"
    evidence = evolve(verdict.evidence, level=level, statement=f"{statement} In ball arithmetic, {proof}.")
    return evolve(verdict, evidence=evidence, orbit=evolve(verdict.orbit, proof=proof))


MAX_CYCLES = 100_000_000
MAX_PERIOD = 10_000
# Rest is proved long before the last impact, so the simulation to the end takes longer by this factor.
LONGER = 10
# Relative difference of the largest angles above which two runs are different motions.
SAME_PEAK = 1e-6
# Interval, in seconds, at which the waiting main thread checks for Ctrl-C.
LISTENING = 0.1

KINDS = tuple(Kind)
"""Response types in the order of their codes."""


def classify(
    system: System,
    start: State | None = None,
    max_cycles: int = 100_000,
    max_period: int = 64,
    prove: Wanted = False,
) -> Verdict:
    """Classify the response of a block, with evidence: the first test that succeeds determines the verdict.

    The tests, in this order:

    1. *Overturned* or *rest*: overturning, or permanent rest, is proved.
    2. *Periodic*, superstable: the motion comes to rest, or to sustained contact with a brace, and is released from the same
       state as before.
    3. *Periodic*: Newton's method with the exact Jacobian, started from the closest return, finds an orbit. It counts if it
       is stable and the motion comes nearer. The second-order terms of the return map must be too small to turn it away.
    4. *Quasi-periodic*: no event dissipates energy, weighted Birkhoff averages over the arcs converge, and nearby
       trajectories diverge no faster than linearly. Both hold over the simulated cycles.
    5. *Chaotic*, only after `max_cycles`: the largest Lyapunov exponent lies 6 standard errors above zero, from independent
       batches. Perturbations grew by a factor of e⁴⁰, and the motion does not linger near an unstable orbit.

    There is no default type. If no test succeeds, the response is undetermined, and the evidence states the tests.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0. Default: at rest.
    max_cycles : int
        Maximum number of forcing cycles, in [1, 10⁸]. Most responses are classified within a hundred. A verdict of chaos
        uses all of them, and needs 10⁴ (with braces 10⁵). Default: 100,000.
    max_period : int
        Longest period to search for, in forcing cycles, in [1, 10⁴]. The period of a superstable response may be longer.
        Default: 64.
    prove : bool or "orbit"
        True: prove a periodic orbit in ball arithmetic, and that the motion from `start` converges to it. Then the level of the
        evidence is "proved". "orbit": prove the orbit only, as `verdict.orbit.proof`. Default: False.

    Returns
    -------
    Verdict
        Response type with its evidence, which `print` shows. In `evidence.tolerances`, `residual` is relative to the growth
        of perturbations over one period. `approach` is the largest deviation of a return from the prediction of the
        multipliers, relative to the predicted approach. A hundredth of the distance is also accepted. `second order` is the
        limit of the test that the motion cannot turn away to second order.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range, or if a proof is wanted and the block is not slender.
    ImportError
        If a proof is wanted and python-flint is not installed.

    See Also
    --------
    simulate : Record the motion itself.
    lyapunov : Lyapunov exponents with standard errors.
    parametric_map : Classify every point of a grid.
    rocking.plot.verdict : Plot the response with its verdict.

    Notes
    -----
    Limits:

    - A periodic verdict is a test to second order. Where terms of higher order decide, a motion next to the boundary of two
      basins may pass it and leave. `prove=True` excludes that.
    - A chaotic transient may last longer than any number of cycles, so chaos may end later.
    - An undamped motion that stays near a torus for long may be classified as quasi-periodic.
    - Another initial state may lead to another response.

    `simulate` may follow another chaotic transient of the same system and initial state, and leave it in another cycle. It
    runs without the checkpoints of this function, and therefore rounds differently. So does `parametric_map`.

    References
    ----------
    Das, Saiki, Sander & Yorke, Nonlinearity 30, 4111–4140 (2017).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> verdict = rk.classify(system)
    >>> str(verdict.kind), verdict.period, verdict.impacts_per_period, verdict.symmetric
    ('periodic', 3, 2, True)
    """
    start = check_periodic(system, start)
    max_cycles, max_period = budget(max_cycles, max_period).values()
    check_wanted(prove, system)
    judgement = _judged(system, start, max_cycles, max_period)
    return with_proof(verdict_of(system, start, judgement, max_cycles, max_period), prove)


def budget(max_cycles: int, max_period: int) -> dict[str, int]:
    """Return the checked maximum number of cycles and longest period, by name."""
    return {
        "max_cycles": whole("max_cycles", max_cycles, 1, MAX_CYCLES),
        "max_period": whole("max_period", max_period, 1, MAX_PERIOD),
    }


def _judged(system: System, start: State, max_cycles: int, max_period: int) -> kernel.Judgement:
    """Run the compiled decision sequence in a daemon thread, so that the main thread remains interruptible.

    Compiled code releases the interpreter lock and does not react to Ctrl-C; the waiting main thread does. After an
    interruption, the thread runs to its end but does not keep the process alive.
    """
    p, _ = start_march(system, start)
    answer: Future[Any] = Future()

    def work() -> None:
        try:
            answer.set_result(batch.classify_one(p, start.angle, start.velocity, max_cycles, max_period))
        except BaseException as error:  # noqa: BLE001 (raised again in the main thread)
            answer.set_exception(error)

    Thread(target=work, daemon=True).start()
    while True:
        with suppress(TimeoutError):
            return answer.result(LISTENING)


def _to_its_end(system: System, start: State, judgement: kernel.Judgement) -> Motion | None:
    """Simulate the motion to its proved end, because the decision sequence gives neither its time nor its place.

    Returns
    -------
    Motion or None
        None if no end is proved. None also if different rounding leads to another end, or to the same end at another time,
        as after a chaotic transient.
    """
    ends = {kernel.NO_RETURN: Outcome.OVERTURNED, kernel.STILL_FOR_EVER: Outcome.AT_REST}
    if judgement.ground not in ends:
        return None
    cycles = max(judgement.cycles, 1)
    if judgement.ground == kernel.STILL_FOR_EVER:
        cycles *= LONGER
    motion = simulate(system, start, cycles=cycles, record="none")
    if motion.outcome is not ends[judgement.ground]:
        return None
    same = math.isclose(motion.peak, judgement.peak, rel_tol=SAME_PEAK)
    if motion.overturning is not None:
        same = same and abs(motion.overturning.cycle + 1 - judgement.cycles) <= 1
    return motion if same else None


def verdict_of(
    system: System, start: State, judged: kernel.Judgement, max_cycles: int, max_period: int
) -> Verdict:
    """Return the verdict on a motion from the judgement on it."""
    motion = _to_its_end(system, start, judged)
    case = Case(system, max_cycles, max_period, judged, motion)
    orbit = _orbit(case) if judged.kind == kernel.PERIODIC else None
    # For an undetermined response, the exponent is reported only if it was tested.
    measured = judged.kind != kernel.UNDETERMINED or judged.ground in kernel.WEIGHED
    steady, transient = _known(judged.steady_peak), int(transient_of(judged))
    if judged.kind == kernel.REST and motion is not None:
        steady = abs(motion.final.angle)
    return Verdict(
        system=case.system,
        start=start,
        kind=KINDS[judged.kind],
        evidence=evidence_of(case),
        exponent=_known(judged.exponent) if measured else None,
        exponent_error=_known(judged.error) if measured else None,
        peak=judged.peak,
        steady_peak=steady,
        transient=None if transient < 0 else transient,
        cycles=judged.cycles,
        impacts=judged.work,
        orbit=orbit,
        **_of(orbit),
    )


def _of(orbit: Orbit | None) -> dict[str, Any]:
    """Return the attributes that a verdict repeats from its orbit; None without an orbit."""
    return {
        "period": orbit and orbit.period,
        "impacts_per_period": orbit and orbit.impacts,
        "brace_hits_per_period": orbit and orbit.brace_hits,
        "symmetric": orbit and orbit.symmetric,
        "multipliers": orbit and orbit.multipliers,
    }


def _orbit(case: Case) -> Orbit:
    """Return the orbit found; a superstable orbit begins at a release."""
    judged, forcing = case.judgement, case.system.periodic
    return Orbit(
        system=case.system,
        state=State(judged.angle + 0.0, judged.velocity + 0.0),
        phase=(forcing.phase + forcing.frequency * judged.section_time) % math.tau,
        period=judged.period,
        symmetric=judged.symmetric,
        impacts=None if judged.impacts < 0 else judged.impacts,
        brace_hits=None if judged.brace_hits < 0 else judged.brace_hits,
        multipliers=(
            complex(judged.real, judged.imaginary),
            complex(judged.other_real, judged.other_imaginary),
        ),
        residual=judged.residual,
        simulate=simulate,
    )


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value
