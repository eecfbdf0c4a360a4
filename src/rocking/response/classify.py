"""Classification of a response, with its evidence."""

from __future__ import annotations

import math
from concurrent.futures import Future
from contextlib import suppress
from threading import Thread
from typing import Any

from rocking.kernels import batch
from rocking.kernels.classify import verdict_record as kernel
from rocking.model import Kind, Orbit, Outcome, State, System, Verdict, check_periodic, whole
from rocking.motion import Motion, simulate, start_march
from rocking.response.evidence import Case, evidence_of
from rocking.response.proved_verdict import Wanted, check_wanted, with_proof
from rocking.response.transient import transient_of

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
    case = Case(system, max_cycles, max_period, judgement, _to_its_end(system, start, judgement))
    return with_proof(_verdict(start, case), prove)


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


def _verdict(start: State, case: Case) -> Verdict:
    judged, motion = case.judgement, case.motion
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
