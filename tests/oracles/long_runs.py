"""Long runs of the package's engine, with their returns, averages and exponents."""

import math

import numpy as np

import rocking as rk
from rocking.kernels.motion import march
from rocking.kernels.motion.march import Recording
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.system import harmonic_parameters

STAGES = (100_000, 1_000_000, 5_000_000)  # cycles run before a recurrence is looked for
WINDOW = 4096
LONGEST = 512
CHAOS_CYCLES = 1_000_000
BATCHES = 50
HALF = 100_000  # cycles of each half whose averages must agree


class Unsettled(Exception):
    """Verdict that this method cannot establish, with the reason."""


def system_of(case, factor=1.0):
    """The system of a case, its amplitude times a factor."""
    braces = None if case["brace"] is None else rk.Braces(angle=case["brace"], restitution=case["r"])
    forcing = rk.Harmonic(amplitude=case["A"] * factor, period=case["T"], phase=case["phi"])
    return rk.System(forcing, case["e"], braces)


def start_of(case):
    return rk.State(case["Theta0"], case["dTheta0"])


def run(system, start, cycles, *, keep=False, place=0.0):
    """Run without peaks and events: status, final state, (impacts, brace impacts) and section at a place in the cycle."""
    p = _numbers(system)
    progress, _ = march.begin_march(p, start.angle, start.velocity)
    rows, done, status = np.empty((cycles if keep else 0, 2)), 0, march.PAUSED
    while status == march.PAUSED:
        recording = Recording(place * p.forcing.period, rows[done:])
        status, progress, taken, _ = march.march(p, progress, cycles, recording)
        done += taken
    if status == march.CROWDED:
        raise Unsettled("too many events in a cycle")
    side, reached = progress.arc.side, progress.arc
    counts = (progress.impacts, progress.brace_hits)
    return status, rk.State(side * reached.angle + 0.0, side * reached.velocity + 0.0), counts, rows[:done]


def _numbers(system):
    forcing, braces = system.forcing, system.braces
    return harmonic_parameters(
        forcing.amplitude,
        forcing.frequency,
        forcing.period,
        forcing.phase,
        system.restitution,
        math.inf if braces is None else braces.angle,
        1.0 if braces is None else braces.restitution,
    )


def returns_after(system, final, tolerance):
    """Smallest lag of a section; of another one where an impact lies at the first, now just before it and now just after."""
    for place in (0.0, 0.381966):
        lag = first_return(run(system, final, WINDOW, keep=True, place=place)[3], tolerance)
        if lag is not None:
            return lag
    return None


def first_return(rows, tolerance):
    """Smallest lag at which every row of a long section, and its first row at its far end, comes back; None if none does."""
    scale = max(1.0, np.abs(rows).max())
    for lag in range(1, LONGEST + 1):
        many = (len(rows) // lag - 1) * lag
        if (
            np.abs(rows[lag:] - rows[:-lag]).max() <= tolerance * scale
            and np.abs(rows[many : many + lag] - rows[:lag]).max() <= tolerance * scale
        ):
            return lag
    return None


def is_lossless(system, final):
    """Return whether no impact dissipates energy."""
    _, _, (impacts, hits), _ = run(system, final, STAGES[0])
    lossy = system.braces is not None and system.braces.restitution < 1
    return not (impacts and system.restitution < 1) and not (hits and lossy)


def halves(system, final):
    for _ in range(2):
        motion = rk.simulate(system, final, cycles=HALF, record="all")
        if motion.outcome != "bounded":
            raise Unsettled(f"{motion.outcome} after more than {STAGES[0]} cycles")
        final = motion.final
        yield motion


def mean_flight(events):
    """Weighted Birkhoff average, weights exp(−1/(x(1−x))), of the times between impacts (else brace hits)."""
    kind = "impact" if np.any(events["kind"] == "impact") else "brace"
    times = events["time"][events["kind"] == kind]
    if len(times) < 1000:
        raise Unsettled("too few events for an average")
    x = (np.arange(len(times) - 1) + 1.0) / len(times)
    weights = np.exp(-1.0 / (x * (1.0 - x)))
    return math.fsum(weights * np.diff(times)) / math.fsum(weights)


def growth_rate(system, start, cycles=CHAOS_CYCLES):
    """Largest exponent per τ over the second half of a run, and its standard error from the means of batches."""
    p = _numbers(system)
    progress, _ = march.begin_march(p, start.angle, start.velocity)
    progress = _onward(p, progress, cycles // 2, np.empty((0, 2)), np.empty(0))
    columns, length, rates = np.eye(2), cycles // 2 // BATCHES, []
    for batch in range(1, BATCHES + 1):
        growth = np.zeros(2)
        progress = _onward(p, progress, cycles // 2 + batch * length, columns, growth)
        rates.append(growth[0] / (length * p.forcing.period))
    if not np.isfinite(rates).all():
        return -math.inf, 0.0
    return float(np.mean(rates)), float(np.std(rates, ddof=1) / math.sqrt(BATCHES))


def _onward(p, progress, cycles, columns, growth):
    status = march.PAUSED
    while status == march.PAUSED:
        state = TangentState(columns, growth)
        status, progress, _, _ = march.march(p, progress, cycles, Recording(), state)
    if status != march.DONE:
        raise Unsettled(f"ends with status {status} after more than {STAGES[0]} cycles")
    return progress
