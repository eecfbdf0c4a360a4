"""What a response is, with its evidence: the compiled cascade, asked and put into words."""

from __future__ import annotations

import math
from concurrent.futures import Future
from contextlib import suppress
from functools import cache
from threading import Thread
from typing import Any

from rocking.kernels import parameters as numbers
from rocking.kernels.classify import decision_cascade, workspace
from rocking.kernels.classify import verdict_record as kernel
from rocking.model import Kind, Orbit, Outcome, State, System, Verdict, check_start, whole
from rocking.motion import Motion, simulate, start_march
from rocking.response.evidence import Case, evidence_of

MAX_CYCLES = 100_000_000
MAX_PERIOD = 10_000
# Rest is certain long before its last impact.
LONGER = 10
# Two runs whose largest angles differ by more are not one motion.
SAME_PEAK = 1e-6
# How often, in seconds, it is looked whether Ctrl-C was pressed where waiting itself does not hear it.
LISTENING = 0.1

KINDS = tuple(Kind)
"""The kinds by their numbers."""


def classify(
    system: System, start: State | None = None, max_cycles: int = 100_000, max_period: int = 64
) -> Verdict:
    """Tell what the response of a block is, and how that is known: the first evidence that suffices decides.

    In this order: that it never returns, or rests for ever, is proved. A motion that comes to rest or leans and is
    released as it was before forgets all else. A periodic orbit is found by Newton's method with the exact Jacobian
    from the closest return, and counts when it is stable and the motion approaches it as its multipliers say.
    Motion that loses nothing is quasi-periodic where weighted Birkhoff averages over its flights converge and
    neighbours part no faster than linearly, over the cycles watched. Chaotic is what has, at the end of the budget and not
    before, a largest exponent 6 standard errors above zero, from independent batches, over which differences grew by e⁴⁰; and
    what does not linger near an unstable orbit. Nothing is a default: what none of this shows is undetermined, and the evidence
    says what was tried.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    start : State, optional
        Θ and Θ' at τ = 0; at rest by default.
    max_cycles : int
        Forcing cycles to follow at most, 1 to 10⁸. Most responses are settled within a hundred; chaotic ones use all, and
        need 10⁴ (with braces 10⁵) to be called so.
    max_period : int
        Longest period looked for, in forcing cycles, 1 to 10⁴; that of a motion released as before shows itself.

    Returns
    -------
    Verdict
        `print` shows its evidence. Its tolerances: the residual is one relative to what differences grow to in a period,
        `approach` is how far, as a share of what is left, a return may be from what the multipliers say (a hundredth of all
        of the distance where that is more, if it comes nearer by three tenths of what they promise).

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range.

    See Also
    --------
    simulate : Record the motion itself.
    lyapunov : Lyapunov exponents with standard errors.
    parametric_map : Classify every point of a grid.
    rocking.plot.verdict : Plot the response with its verdict.

    Notes
    -----
    Not guaranteed: that chaos lasts, for a chaotic transient may be longer than any budget; that a motion without losses that
    sticks to a torus for long is not taken for quasi-periodic; and that an orbit is the only response, for another start may lead
    to another one.

    `simulate` may follow another chaotic transient of the same system and start, and leave it in another cycle. It runs without
    the checkpoints at which this function looks for evidence, and therefore rounds differently. So does `parametric_map`.

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
    start = check_start(system, start)
    max_cycles, max_period = budget(max_cycles, max_period).values()
    judgement = _judged(system, start, max_cycles, max_period)
    return _verdict(
        start, Case(system, max_cycles, max_period, judgement, _to_its_end(system, start, judgement))
    )


def budget(max_cycles: int, max_period: int) -> dict[str, int]:
    """For how many cycles a motion is followed at most, and up to which period an orbit is looked for; by name, checked."""
    return {
        "max_cycles": whole("max_cycles", max_cycles, 1, MAX_CYCLES),
        "max_period": whole("max_period", max_period, 1, MAX_PERIOD),
    }


def _judged(system: System, start: State, max_cycles: int, max_period: int) -> kernel.Judgement:
    """The cascade's answer, from a thread of its own: it holds no lock, and does not hear Ctrl-C; who waits does.

    A thread that is no longer waited for goes on to its end, but keeps no process alive.
    """
    _compile()
    p, _ = start_march(system, start)
    answer: Future[Any] = Future()

    def work() -> None:
        try:
            memory = workspace.make_workspace(max_cycles, max_period)
            answer.set_result(
                decision_cascade.judge_plain(p, start.angle, start.velocity, max_cycles, max_period, memory)
            )
        except BaseException as error:  # noqa: BLE001 (it is raised where it is waited for)
            answer.set_exception(error)

    Thread(target=work, daemon=True).start()
    while True:
        with suppress(TimeoutError):
            return kernel.Judgement(*answer.result(LISTENING))


@cache
def _compile() -> None:
    """Compile the cascade, or load it, before a thread needs it: a process that ends while another thread compiles may crash."""
    still = numbers.harmonic_parameters(0.0, 1.0, math.tau, 0.0, 0.0)
    decision_cascade.judge_plain(still, 0.0, 0.0, 1, 1, workspace.make_workspace(1, 1))


def _to_its_end(system: System, start: State, judgement: kernel.Judgement) -> Motion | None:
    """The motion again, where its end is proved: the cascade does not tell when, nor where the block comes to rest.

    None too where the end came after a transient so chaotic that one rounding otherwise leads to another end, or to
    the same at another time.
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
    periodic = judged.kind == kernel.PERIODIC
    orbit = _orbit(case) if periodic else None
    # of what is undetermined only an exponent that was weighed is told
    measured = judged.kind != kernel.UNDETERMINED or judged.ground in kernel.WEIGHED
    steady, transient = _known(judged.steady_peak), None if judged.transient < 0 else judged.transient
    if judged.kind == kernel.REST and motion is not None:
        steady = abs(motion.final.angle)
        transient = transient if motion.impacts + motion.brace_hits else 0
    if judged.kind == kernel.OVERTURNS:
        transient = max(judged.cycles - 1, 0)
    return Verdict(
        system=case.system,
        start=start,
        kind=KINDS[judged.kind],
        evidence=evidence_of(case),
        exponent=_known(judged.exponent) if measured else None,
        exponent_error=_known(judged.error) if measured else None,
        peak=judged.peak,
        steady_peak=steady,
        transient=transient,
        cycles=judged.cycles,
        impacts=judged.work,
        orbit=orbit,
        **_of(orbit),
    )


def _of(orbit: Orbit | None) -> dict[str, Any]:
    """What a verdict repeats of its orbit, or that there is none."""
    return {
        "period": orbit and orbit.period,
        "impacts_per_period": orbit and orbit.impacts,
        "brace_hits_per_period": orbit and orbit.brace_hits,
        "symmetric": orbit and orbit.symmetric,
        "multipliers": orbit and orbit.multipliers,
    }


def _orbit(case: Case) -> Orbit:
    """The orbit found; where it rests or leans, at a release."""
    judged, forcing = case.judgement, case.system.forcing
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
