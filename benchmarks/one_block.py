"""One block in the compiled kernel: compared with the peers, with 40 digits, and two blocks on two threads."""

from concurrent.futures import ThreadPoolExecutor
from os import getloadavg
from statistics import median

import mpmath as mp
import numpy as np

from benchmarks.cases import CASES, Point, lift_off
from benchmarks.clock import nanoseconds_per_impact, seconds
from benchmarks.peers import Heyoka, scipy_march
from benchmarks.reference import DIGITS, state_at
from benchmarks.table import Figure
from rocking import Harmonic, State, System, simulate
from rocking.kernels.motion import march as kernel
from rocking.kernels.motion.march import Recording
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.system import harmonic_parameters

CYCLES_OF_THE_KERNEL = 60_000
CYCLES_OF_A_THREAD = 200_000
CYCLES_OF_HEYOKA = 2_000
CYCLES_OF_SCIPY = 30
ACCURACY_CYCLES = 20
ACCURACY_STARTS = 41

NANOSECONDS = (43, 48, 99)
OVER_SCIPY = (15_000, 30_000, 7_000)
OVER_HEYOKA = {False: (45, 70, 25), True: (100, 120, 50)}


def march(case, cycles):
    """March one block from rest with its tangent vectors, in the kernel alone; return (impacts, final point)."""
    p = harmonic_parameters(case.amplitude, case.frequency, case.period, 0.0, case.restitution)
    progress, _ = kernel.begin_march(p, 0.0, 0.0)
    while progress.cycle < cycles:
        # The tangent restarts every ``tangent_cycles``, before it overflows or becomes subnormal.
        tangent, until = (
            TangentState(np.eye(2), np.empty(0)),
            min(cycles, progress.cycle + case.tangent_cycles),
        )
        _, progress, _, _ = kernel.march(p, progress, until, Recording(), tangent)
    arc = progress.arc
    return progress.impacts, Point(cycles * case.period, arc.side * arc.angle, arc.side * arc.velocity)


def speed():
    """Time the kernel per impact, and the ratio of the peers' times on the same motion in the same run."""
    for index, case in enumerate(CASES):
        ours = nanoseconds_per_impact(7, march, case, CYCLES_OF_THE_KERNEL)
        yield Figure(case.name, ours, "ns", NANOSECONDS[index], note="per impact, with tangent")
        start = lift_off(case, case.period / 20)
        theirs = nanoseconds_per_impact(3, scipy_march, case, start, CYCLES_OF_SCIPY * case.period)
        yield ratio("SciPy DOP853, rtol 1e-12", theirs, ours, OVER_SCIPY[index])
        for variations in (False, True):
            for lean in (False, True):
                peer = Heyoka(case, variations, lean)
                theirs = nanoseconds_per_impact(5, peer.march, start, CYCLES_OF_HEYOKA * case.period)
                what = "heyoka" + " + variations" * variations + ", leanest callback" * lean
                yield ratio(what, theirs, ours, None if lean else OVER_HEYOKA[variations][index])


def ratio(peer, theirs, ours, goal):
    return Figure(f"  {peer}", theirs / ours, "×", goal, least=True, note=f"{theirs:,.0f} ns")


def accuracy():
    """Median error of the state after 20 cycles from random initial states, against 40 digits: kernel and heyoka.

    Each error refers to the exact input: the kernel takes a period, heyoka a frequency, both in double precision.
    """
    for case in CASES:
        system = System(Harmonic(amplitude=case.amplitude, period=case.period), restitution=case.restitution)
        peer, random = Heyoka(case, lean=True), np.random.default_rng(1991)
        with mp.workdps(DIGITS):
            until, frequency = ACCURACY_CYCLES * mp.mpf(case.period), 2 * mp.pi / mp.mpf(case.period)
        ours, theirs = [], []
        while len(ours) < ACCURACY_STARTS:
            start = Point(0.0, *random.uniform(-0.1, 0.1, 2))
            exact = state_at(case, start, until, frequency)
            if exact is None:
                continue
            state = State(start.angle, start.velocity)
            final = simulate(system, state, cycles=ACCURACY_CYCLES, record="none").final
            ours.append(error(final, exact))
            exact = state_at(case, start, mp.mpf(ACCURACY_CYCLES * case.period), mp.mpf(case.frequency))
            theirs.append(error(peer.march(start, ACCURACY_CYCLES * case.period)[1], exact))
        note = f"median of {ACCURACY_STARTS} starts; goal: heyoka's"
        yield Figure(case.name, median(ours), "", median(theirs), note=note)


def error(point, exact):
    return float(max(abs(point.angle - exact[0]), abs(point.velocity - exact[1])))


def threads():
    """Compare twice the work on two threads with the work on one; both cores must be free."""
    load = f"load average before: {getloadavg()[0]:.1f}"
    with ThreadPoolExecutor(2) as pool:
        for case in CASES:
            alone, _ = seconds(5, march, case, CYCLES_OF_A_THREAD)
            both, _ = seconds(5, twice, pool, case)
            yield Figure(case.name, 2 * alone / both, "×", 1.9, least=True, note=load)


def twice(pool, case):
    return list(pool.map(march, [case] * 2, [CYCLES_OF_A_THREAD] * 2))
