"""Periodic response: events, symmetry, and one period in many digits."""

import math

import numpy as np

import rocking as rk
from oracles.long_runs import Unsettled
from oracles.motion import simulate

DIGITS = 80


def periodic(case, system, final, period, confirm):
    motion = rk.simulate(system, final, cycles=4 * period, record="all")
    events, length = motion.events, period * case["T"]
    quiet = _quiet_time(events["time"], length)
    counts = [_counts(events, quiet + k * length, length) for k in range(3)]
    resting, leaning = counts[0]["rest"] > 0, counts[0]["lean"] > 0
    accumulating = (resting and case["e"] > 0, leaning and case["r"] > 0)
    compared = [{kind: c[kind] for kind in _comparable(*accumulating)} for c in counts]
    if not compared[0] == compared[1] == compared[2]:
        raise Unsettled("events differ from period to period")
    symmetric = _symmetric(motion, quiet, length) if period % 2 else False
    if confirm:
        _around(case, motion.at(quiet), quiet, period, compared[0])
    return {
        "kind": "periodic",
        "period": period,
        "impacts_per_period": None if accumulating[0] else counts[0]["impact"],
        "brace_hits_per_period": None if accumulating[1] else counts[0]["brace"],
        "symmetric": symmetric,
        "chatter": bool(resting or leaning),
    }


def _comparable(impacts_accumulate, hits_accumulate):
    """The kinds of events that are finite in number."""
    kinds = ["rest", "lift-off", "lean", "leave"]
    return kinds + ["impact"] * (not impacts_accumulate) + ["brace"] * (not hits_accumulate)


def _quiet_time(times, length):
    """The middle of the longest time without an event in the first period."""
    inner = np.unique(times[times < length])
    if len(inner) == 0:
        raise Unsettled("a period without events")
    ends = np.append(inner, inner[0] + length)
    widest = int(np.argmax(np.diff(ends)))
    return float(ends[widest] + ends[widest + 1]) / 2 % length


def _counts(events, begin, length):
    kinds = events["kind"][(events["time"] > begin) & (events["time"] <= begin + length)]
    return {
        kind: int(np.sum(kinds == kind)) for kind in ("impact", "brace", "rest", "lift-off", "lean", "leave")
    }


def _symmetric(motion, quiet, length):
    """Return whether Θ, which is continuous at impacts, changes its sign after half a response period."""
    times = quiet + np.linspace(0, length, 401)
    off = np.abs(motion.at(times + length / 2)[0] + motion.at(times)[0]).max()
    if 1e-9 < off < 1e-6:
        raise Unsettled("all but symmetric")
    return bool(off <= 1e-9)


def _around(case, state, time, period, counts):
    """Once around in many digits from a state of the orbit: the same state, the same events."""
    turned = case["phi"] + 2 * math.pi * (time / case["T"] % 1)
    start = {"phi": turned, "Theta0": float(state[0]), "dTheta0": float(state[1]), "N": period}
    exact = simulate(case | start, DIGITS)
    off = max(abs(float(exact.angle) - state[0]), abs(float(exact.velocity) - state[1]))
    if exact.overturned or off > 1e-10 * max(1.0, exact.growth):
        raise Unsettled(f"does not close in many digits (off by {off:.1e}, growth {exact.growth:.1e})")
    if any(exact.counts[kind] != count for kind, count in counts.items()):
        raise Unsettled("other events in many digits")
