"""Periodic verdicts next to folds, doublings, symmetry breakings and grazings: no motion leaves the orbit of its verdict.

There an unstable orbit lies close to the stable one. A motion beyond it may come nearer for hundreds of cycles and leave
later. What a motion does is found by following it, by the engine and by brute force, which shares nothing with it.
"""

import math
from collections import Counter

import numpy as np
import pytest

import rocking as rk
from oracles import brute

# A, T, e, φ, Θ, Θ'. Each was taken for a motion on a stable orbit close by. It comes to rest, or to another orbit.
LEAVING = (
    (0.03729704240429467, 0.6634041870831806, 0.97, 4.1185964882150685, 0.011923362627312443, 0.05807564666551755),
    (0.06031602748447538, 1.741489330351635, 0.95, 4.105738357118826, 0.07645415517238809, 0.1476288462542428),
    (0.22092141286668945, 1.2057415650734655, 0.97, 4.092105765596087, 0.12213032731771861, 0.5616688651656919),
    (6.334506067945513, 0.9667255412415822, 0.9397367999012421, 1.0, 0.06771375824811719, -1.416122289780521),
)  # fmt: skip
CYCLES = 3_000
SAME = 1e-5


def shaken(amplitude, period, restitution, phase):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


def end_by_force(numbers, cycles):
    """Return the end of a motion by brute force, and its last states."""
    amplitude, period, restitution, phase, angle, velocity = numbers
    rows = np.empty((8, 2))
    return brute.march(amplitude, 2 * math.pi / period, restitution, cycles, rows, angle, velocity, phase)


@pytest.mark.parametrize("numbers", LEAVING)
def test_a_motion_beyond_the_unstable_orbit_is_not_taken_for_one_on_the_stable_orbit(numbers):
    verdict = rk.classify(shaken(*numbers[:4]), rk.State(*numbers[4:]))
    end, rows = end_by_force(numbers, CYCLES)
    assert (verdict.kind == "rest") == (end == brute.AT_REST)
    if end != brute.AT_REST:
        orbit = verdict.orbit
        moving = rk.simulate(shaken(*numbers[:3], orbit.phase), orbit.state, cycles=2 * orbit.period)
        on_orbit = moving.section(numbers[3])
        assert np.hypot(*(on_orbit - rows[-1]).T).min() < SAME


@pytest.mark.parametrize("below", [1e-13, 1e-12, 1e-11])
def test_below_a_fold_there_is_no_stable_orbit(below):
    """The residual of Newton's method is as small there as that of an orbit; the motion comes to rest after 10⁵ cycles and more."""
    system = rk.System(
        rk.Harmonic(float(rk.theory.existence_amplitude(1.0, 0.925, 1)) - below, period=1.0), 0.925
    )
    for beside in (0.0, 1e-7, 1e-6, 1e-5, 1e-4):
        start = rk.State(-0.0021942076827103523, -0.2259124224453484 - beside)
        assert rk.classify(system, start, max_cycles=20_000).kind != "periodic"


def displaced(rng, orbit):
    """Return the numbers of a motion that starts beside an orbit, at a random instant and in a random direction."""
    forcing = orbit.system.forcing
    time, turn, far = (
        rng.uniform(0.05, 0.95) * orbit.period * forcing.period,
        rng.uniform(0, math.tau),
        10 ** rng.uniform(-4, -0.3),
    )
    begun = shaken(forcing.amplitude, forcing.period, orbit.system.restitution, orbit.phase)
    angle, velocity = rk.simulate(begun, orbit.state, cycles=orbit.period + 1).at([time])
    phase = (orbit.phase + math.tau * time / forcing.period) % math.tau
    off = far * math.cos(turn), far * math.sin(turn)
    return (
        forcing.amplitude, forcing.period, orbit.system.restitution, phase, float(angle[0]) + off[0], float(velocity[0]) + off[1]
    )  # fmt: skip


def losses(rng):
    return 1 - 10 ** rng.uniform(math.log10(0.0005), math.log10(0.2))


def beside_a_mode(number):
    """Return a motion beside a symmetric mode just above the fold in which it is born."""
    rng = np.random.default_rng([1, number])
    while True:
        order = int(rng.choice([1, 3]))
        period, restitution = rng.uniform(0.4, 4 if order == 1 else 2), losses(rng)
        amplitude = float(rk.theory.existence_amplitude(period, restitution, order)) * (
            1 + 10 ** rng.uniform(-8, -2)
        )
        for mode in rk.theory.symmetric_modes(amplitude, period, restitution, order):
            if mode.stable and mode.admissible:
                start = rk.State(0.0, mode.velocity)
                system = shaken(amplitude, period, restitution, mode.phase % math.tau)
                return displaced(rng, rk.find_orbit(system, start, order))


def beside_a_bifurcation(kind, number):
    """Return a motion beside an orbit that was found, just before or after a bifurcation of its branch."""
    rng = np.random.default_rng([2, number])
    while True:
        amplitude = rng.uniform(0.1, 12) if rng.random() < 0.7 else 10 ** rng.uniform(-2, 0)
        system = shaken(amplitude, rng.uniform(0.4, 4), losses(rng), 0.0)
        start = rk.State(*rng.uniform(-0.5, 0.5, 2))
        verdict = rk.classify(system, start, max_cycles=3_000, max_period=12)
        if verdict.orbit is None or verdict.orbit.impacts is None or verdict.orbit.impacts > 24:
            continue
        branch = rk.continue_orbit(verdict.orbit, "amplitude", (0.6 * amplitude, 1.6 * amplitude))
        found = [point.orbit for point in branch.special if point.kind == kind and point.orbit is not None]
        if found:
            numbers = displaced(rng, found[rng.integers(len(found))])
            return numbers[0] * (1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-8, -2)), *numbers[1:]


def distances(rows, orbit):
    """Return the distances of the states of a section from the nearest state of an orbit, one per period."""
    away = np.hypot(rows[:, 0] - orbit.state.angle, rows[:, 1] - orbit.state.velocity)
    periods = away[: len(away) // orbit.period * orbit.period].reshape(-1, orbit.period)
    return periods[:, np.argmin(periods[-1])]


def fate(numbers, verdict, cycles):
    """Follow a motion with a periodic verdict: "right", "wrong", or "undecided" where the distance changes too slowly."""
    motion = rk.simulate(shaken(*numbers[:4]), rk.State(*numbers[4:]), cycles=cycles, record="section")
    if motion.outcome != "bounded":
        return "wrong"
    away = distances(motion.section(verdict.orbit.phase), verdict.orbit)
    half, last = away[len(away) // 2], away[-1]
    if last < 1e-8 or last <= 0.5 * half:
        return "right"
    return "wrong" if last >= 2 * half else "undecided"


PLACES = {
    "mode": (beside_a_mode, 5_000),
    **{
        kind: (lambda number, kind=kind: beside_a_bifurcation(kind, number), 1_000)
        for kind in ("fold", "period-doubling", "symmetry-breaking", "grazing")
    },
}


def classified(numbers):
    return rk.classify(shaken(*numbers[:4]), rk.State(*numbers[4:]), max_cycles=20_000)


def is_settled(numbers, verdict):
    """Return whether rounding leaves the verdict as it is. After a chaotic transient another motion is followed."""
    angle, velocity = numbers[4:]
    beside = classified((*numbers[:4], angle * (1 + 1e-13), velocity * (1 - 1e-13)))
    return beside.kind == verdict.kind and beside.cycles == verdict.cycles


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("place", PLACES)
def test_no_motion_leaves_the_orbit_of_its_verdict(place, thin):
    draw, count = PLACES[place]
    seen, wrong = Counter(), []
    for number in thin(range(count), count // 10):
        numbers = draw(number)
        verdict = classified(numbers)
        if verdict.kind != "periodic" or verdict.orbit.impacts is None:
            continue
        found = fate(numbers, verdict, 100_000) if is_settled(numbers, verdict) else "hangs on rounding"
        seen[found] += 1
        if found == "wrong":
            wrong.append(numbers)
    print(place, dict(seen))
    assert wrong == []
    assert seen["right"] > seen["undecided"] + seen["hangs on rounding"]
