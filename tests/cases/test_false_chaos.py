"""Motions near bifurcations: motion that slowly leaves a weakly unstable orbit is not chaotic.

The tangent vectors of such a motion grow steadily and slowly, with a tiny standard error. `data/bifurcations.json` holds
symmetry breakings, period doublings and folds of orbits with and without braces, found by continuation. A case is a
parameter point next to one of them and an initial state next to its orbit.
"""

import json
import math
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from oracles.long_runs import growth_rate, returns_after, run
from rocking.kernels import batch
from rocking.kernels.classify import verdict

BIFURCATIONS = json.loads((Path(__file__).resolve().parents[1] / "data" / "bifurcations.json").read_text())
CYCLES = 100_000
CHAOTIC = int(verdict.Kind.CHAOTIC)
# T, e; the first two are those at which false chaos was first met
BREAKINGS = (
    (0.6712983342872487, 0.5302457786278548),
    (1.721328, 0.8),
    (1.0, 0.8),
    (1.5, 0.925),
    (2.0, 0.9),
    (0.67, 0.53),
)
SLOW = rk.System(
    rk.Harmonic(9.22597410002252, period=0.6712983342872487, phase=-2.090073211920801), 0.5302457786278548
)


def beside_breakings():
    """Yield (row of a system, start) just above symmetry breakings, on the symmetric mode and beside it: 252."""
    for period, restitution in BREAKINGS:
        breaking = rk.theory.symmetry_breaking_amplitude(period, restitution, 1)
        for distance in (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6):
            amplitude = breaking * (1 + distance)
            modes = rk.theory.symmetric_modes(amplitude, period, restitution, 1)
            mode = max(modes, key=lambda each: each.velocity)
            for offset in (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2):
                yield row(amplitude, period, mode.phase, restitution), (0.0, mode.velocity + offset)


def beside_bifurcations():
    """Yield (row of a system, start) on both sides of every bifurcation of the table, on the orbit there and beside it: 2,100."""
    for case in BIFURCATIONS:
        phase = math.remainder(case["phi"], math.tau)
        for distance in (1e-3, -1e-3, 1e-4, -1e-4, 1e-5, -1e-5, 1e-6):
            for offset in (0.0, 1e-6, 1e-4, 1e-3, 1e-2):
                amplitude = case["A"] * (1 + distance)
                system = row(amplitude, case["T"], phase, case["e"], case["brace"], case["r"])
                yield system, (case["Theta0"], case["dTheta0"] + offset)


def row(amplitude, period, phase, restitution, brace=None, brace_restitution=None):
    """Return what the kernels take of a system."""
    braces = (math.inf, 1.0) if brace is None else (brace, brace_restitution)
    return (amplitude, math.tau / period, period, phase, restitution, *braces, 0.0)


def verdicts(cases):
    """Return the kinds of many cases, with their systems and starts."""
    systems, starts = (np.array(part) for part in zip(*cases, strict=True))
    return batch.classify_batch(systems, starts, CYCLES, 64, np.zeros(1, np.int64)), systems, starts


def is_chaotic(system, start):
    """Return whether a million cycles show chaos: no recurrence at the end, and an exponent of 10 standard errors."""
    amplitude, _, period, phase, restitution, brace, brace_restitution, _ = (float(each) for each in system)
    braces = None if math.isinf(brace) else rk.Braces(brace, brace_restitution)
    found = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)
    exponent, error = growth_rate(found, rk.State(*start))
    _, final, _, _ = run(found, rk.State(*start), 1_000_000)
    return exponent > 10 * error and returns_after(found, final, 1e-9) is None


def test_a_motion_that_slowly_leaves_a_weakly_unstable_orbit_is_not_chaotic():
    """Neighbours part by e^0.96 in 10⁵ cycles; the motion ends on one of two mirror images after 364,000."""
    start = rk.State(velocity=0.7016686649447939)
    slow = rk.classify(SLOW, start, max_cycles=CYCLES)
    assert slow.kind == "undetermined"
    assert slow.exponent > 20 * slow.exponent_error
    assert "unstable orbit" in str(slow)


@pytest.mark.parametrize(
    "cycles, kind", [(20_000, "undetermined"), (200_000, "undetermined"), (400_000, "periodic")]
)
def test_the_verdict_stays_open_until_the_motion_has_arrived(cycles, kind):
    verdict = rk.classify(SLOW, rk.State(velocity=0.7016686649447939), max_cycles=cycles)
    assert verdict.kind == kind
    if kind == "periodic":
        assert (verdict.period, verdict.symmetric) == (1, False)


def test_a_motion_beside_an_unstable_mode_is_periodic_in_a_million_cycles_and_open_before():
    """Rounding may hold a motion that starts on the mode itself there for ever."""
    amplitude = rk.theory.symmetry_breaking_amplitude(1.721328, 0.8, 1) * (1 + 3e-5)
    modes = rk.theory.symmetric_modes(amplitude, 1.721328, 0.8, 1)
    mode = max(modes, key=lambda each: each.velocity)
    beside = rk.State(velocity=mode.velocity * (1 + 1e-11))
    assert rk.classify(mode.system, beside).kind == "undetermined"
    assert rk.classify(mode.system, beside, max_cycles=10**6).kind == "periodic"


@pytest.mark.long
def test_none_of_252_motions_above_symmetry_breakings_is_chaotic():
    """Above a symmetry breaking a motion near the symmetric mode comes to one of two mirror images, however slowly."""
    cases = list(beside_breakings())
    found, _, _ = verdicts(cases)
    assert len(cases) == 252
    assert CHAOTIC not in found.kind


def test_basins_beside_a_symmetry_breaking_list_no_chaotic_attractor():
    basins = rk.basin_map(
        SLOW,
        angle=np.linspace(-0.001, 0.001, 5),
        velocity=np.linspace(0.7, 0.703, 5),
        boundary_runs=0,
        max_cycles=CYCLES,
    )
    assert "chaotic" not in {str(each.verdict.kind) for each in basins.attractors}


@pytest.mark.long
def test_chaos_beside_2100_bifurcations_is_chaos_in_a_million_cycles():
    found, systems, starts = verdicts(beside_bifurcations())
    assert len(systems) == 2100
    said = np.flatnonzero(found.kind == CHAOTIC)
    print(Counter(verdict.Kind(kind).name for kind in found.kind.tolist()))
    assert 0 < len(said) < 100
    assert [k for k in said if not is_chaotic(systems[k], starts[k])] == []
