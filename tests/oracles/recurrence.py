"""Slow classification of a response: a long run, then a test for recurrence.

Periodic by brute recurrence after 10⁵ cycles and more, and once around again in 80 digits; overturned and at rest in 80
digits; quasi-periodic if averages of two halves agree; chaotic by an exponent far from zero. A verdict that this method
cannot establish raises `Unsettled`.
"""

import math

import numpy as np

import rocking as rk
from oracles.around import DIGITS, periodic
from oracles.long_runs import (
    CHAOS_CYCLES,
    STAGES,
    Unsettled,
    growth_rate,
    halves,
    is_lossless,
    mean_flight,
    returns_after,
    run,
    start_of,
    system_of,
)
from oracles.motion import simulate
from rocking.kernels.motion import march

PATIENCE = 5_000
BESIDE = (1e-8, 3e-9, 1e-9, 1e-10)  # a verdict must hold for a hundredth of the largest
RETURN = 1e-11
LOOSE = 1e-9  # closer than any chaotic return; a motion with rest or contact in between may return no closer, but repeatedly
GLANCE = 200_000
LATEST_PROOF = 3000  # cycles that are followed in many digits
NONE = {
    "period": None,
    "impacts_per_period": None,
    "brace_hits_per_period": None,
    "symmetric": None,
    "chatter": False,
}
ROUTES = {
    "periodic": "recurrence after >=1e5 cycles, and once around in 80 digits",
    "overturned": "80 digits: same impacts, no return (proved growing)",
    "rest": "80 digits come to rest, or lean, for ever",
    "quasi-periodic": "exponent<1e-4 per cycle at 1e6 cycles, mean flight of two halves of 1e5 cycles equal to 1e-10",
    "chaotic": "exponent >10 sigma at 1e6 cycles, no recurrence <1e-9 for lags<=512",
}


def judge(case, *, factor=1.0, confirm=True, chaos_cycles=CHAOS_CYCLES):
    """Kind, period, impacts, brace hits and symmetry of a case; without `confirm` as doubles alone have it."""
    system = system_of(case, factor)
    try:
        status, reached, _, _ = run(system, start_of(case), STAGES[0])
        if status == march.OVERTURNED:
            return _overturned(case, system, confirm)
        if status == march.STILL:
            return _rest(case, confirm)
        return _bounded(case, system, reached, confirm, chaos_cycles)
    except rk.TooManyEvents as error:
        raise Unsettled("too many events") from error


def established(case):
    """A case with its label, established in full and again, in doubles, at amplitudes beside it.

    After a transient chaotic enough a rounding decides between attractors; then so does one of these.
    """
    label = judge(case)
    long = GLANCE if label["kind"] == "chaotic" else CHAOS_CYCLES
    for share in BESIDE:
        for factor in (1 - share, 1 + share):
            beside = judge(case, factor=factor, confirm=False, chaos_cycles=long)
            if any(beside[name] != label[name] for name in ("kind", *NONE)):
                raise Unsettled(f"changes at A(1 +- {share})")
    return case | label | {"robust": True, "route": ROUTES[label["kind"]]}


def _overturned(case, system, confirm):
    motion = rk.simulate(system, start_of(case), cycles=STAGES[0], record="all")
    proved = motion.overturning.cycle
    if confirm:
        if proved > LATEST_PROOF:
            raise Unsettled("overturns too late for many digits")
        exact = simulate(case | {"N": proved + math.ceil(40 / case["T"])}, DIGITS)
        kinds = motion.events["kind"][motion.events["time"] > 0]
        same = ("rest", "lift-off") if exact.counts["rest"] else ("impact", "rest")
        if not exact.overturned or any(exact.counts[kind] != np.sum(kinds == kind) for kind in same):
            raise Unsettled("overturns otherwise in many digits")
        if not exact.growth < 1e35:
            raise Unsettled("overturns after a growth that many digits do not cover")
    return {"kind": "overturned"} | NONE


def _rest(case, confirm):
    """Rest is permanent at the base for A ≤ 1, at a brace for A ≤ Θb − 1."""
    base, brace = case["A"] <= 1, case["brace"] is not None and case["brace"] - 1 >= case["A"]
    for cycles in (30, 300, 3000) if confirm else ():
        counts = simulate(case | {"N": cycles}, DIGITS).counts
        still = case["Theta0"] == case["dTheta0"] == 0
        leans = brace and case["dTheta0"] == 0 and abs(case["Theta0"]) == case["brace"]
        if base and (still or counts["rest"] == 1):
            break
        if brace and (leans or counts["lean"] == 1):
            break
    else:
        if confirm:
            raise Unsettled("does not come to rest in many digits")
    return {"kind": "rest"} | NONE


def _bounded(case, system, final, confirm, chaos_cycles):
    done = STAGES[0]
    for cycles in STAGES:
        if cycles > done:
            status, final, _, _ = run(system, final, cycles - done)
            if status != march.DONE:
                raise Unsettled(f"still or overturned after more than {STAGES[0]} cycles")
            done = cycles
        lag = loose = returns_after(system, final, RETURN)
        if lag is None:
            loose = returns_after(system, final, LOOSE)
        if lag is None and loose is not None and _forgets(system, final, loose):
            lag = loose
        if lag is not None:
            label = periodic(case, system, final, lag, confirm)
            return label | (_patience(case, system, final, lag, cycles) if confirm else {})
        if cycles == STAGES[0] and is_lossless(system, final):
            return _conservative(system, final)
        due = cycles == (CHAOS_CYCLES if chaos_cycles == CHAOS_CYCLES else STAGES[0])
        if due and loose is None and _chaotic(system, start_of(case), chaos_cycles):
            return {"kind": "chaotic"} | NONE
    raise Unsettled("neither recurrent nor chaotic")


def _forgets(system, final, period):
    """Return whether every period contains rest or sustained contact, which erases all perturbations."""
    kinds = rk.simulate(system, final, cycles=3 * period, record="all").events["kind"]
    return np.sum((kinds == "rest") | (kinds == "lean")) >= 2


def _patience(case, system, final, lag, cycles):
    """Return the number of cycles allowed for a response that is reached late: at least a million, as rounding may delay it."""
    rows = run(system, start_of(case), cycles, keep=True)[3]
    orbit = run(system, final, lag, keep=True)[3]
    distance = np.min([np.abs(rows - state).max(axis=1) for state in orbit], axis=0)
    reached = int(np.flatnonzero(distance > 1e-3)[-1]) + 1 if distance.max() > 1e-3 else 0
    enough = 10 ** max(6, math.ceil(math.log10(10 * max(1, reached))))
    return {"max_cycles": enough} if reached > PATIENCE else {}


def _conservative(system, final):
    first, second = (mean_flight(motion.events) for motion in halves(system, final))
    apart = abs(first - second) / first
    exponent, error = growth_rate(system, final)
    if exponent * system.forcing.period < 1e-4 and apart < 1e-10:
        return {"kind": "quasi-periodic"} | NONE
    if exponent > 10 * error and apart > 1e-6 and returns_after(system, final, LOOSE) is None:
        return {"kind": "chaotic"} | NONE
    raise Unsettled(f"lossless, but sticky: halves {apart:.0e} apart, exponent {exponent:.0e} +- {error:.0e}")


def _chaotic(system, start, cycles):
    exponent, error = growth_rate(system, start, cycles)
    return math.isfinite(exponent) and 0 < 10 * error < exponent
