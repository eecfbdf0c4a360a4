"""Lanes against one block: reference states, events, and maps."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from oracles import lanes as oracle
from rocking.kernels import batch
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.classify.verdict import empty_results
from rocking.kernels.lanes.state import LANES
from rocking.kernels.system import harmonic_parameters, parameters_of_row

pytestmark = pytest.mark.xdist_group("lanes")  # the kernels of the oracle are compiled once

TABLE = json.loads((Path(__file__).resolve().parents[1] / "data" / "states.json").read_text())
PLAIN = [
    case for case in TABLE if case["brace"] is None and case["A"] > 1 and case["e"] > 0 and not case["rests"]
]


def marched(system, event, cycles):
    """Return the later events and the final state of a motion from an impact to the end of ``cycles``, equal in all lanes."""
    forcing = system.forcing
    braces = () if system.braces is None else (system.braces.angle, system.braces.restitution)
    p = harmonic_parameters(
        forcing.amplitude, forcing.frequency, forcing.period, forcing.phase, system.restitution, *braces
    )
    first = int(event["cycle"])
    start = event["time"] - first * forcing.period
    s, noted, final = oracle.empty(), np.full((LANES, 4000, 4), np.nan), np.empty((LANES, 2))
    side = int(np.sign(event["after"]))
    for lane in range(LANES):
        oracle.sit_down(s, lane, p, side, start, abs(event["after"]), oracle.EYE, cycles - first)
    oracle.to_the_end(s, p, noted)
    oracle.states(s, p, final)
    assert np.ptp(final, axis=0).max() == 0.0
    noted[:, :, 0] += first
    return noted[0][np.isfinite(noted[0, :, 0])], final[0]


def simulated(case):
    system = rk.System(rk.Harmonic(amplitude=case["A"], period=case["T"], phase=case["phi"]), case["e"])
    return rk.simulate(system, rk.State(case["Theta0"], case["dTheta0"]), cycles=case["N"])


@pytest.mark.parametrize("case", PLAIN, ids=lambda case: f"A={case['A']}, T={case['T']}, e={case['e']}")
def test_final_state_to_1e12_times_the_growth_of_errors(case):
    """Against forty digits, from the motion's first impact on."""
    motion = simulated(case)
    impacts = motion.events[motion.events["kind"] == "impact"]
    if not len(impacts):
        assert case["impacts"] == 0
        return
    _, final = marched(motion.system, impacts[0], case["N"])
    error = np.abs(final - [float(case["Theta"]), float(case["dTheta"])])
    assert error.max() <= 1e-12 * max(1.0, case["growth"])


@pytest.mark.parametrize(
    "amplitude, period, restitution", [(2, 0.4, 1), (4, 0.4, 1), (6.5, 0.4, 0.925), (3, 0.6, 0.98)]
)
def test_the_same_events_in_the_same_order(amplitude, period, restitution):
    """Over 20 cycles, in which differences grow less than a hundredfold."""
    system = rk.System(rk.Harmonic(amplitude=amplitude, period=period), restitution)
    motion = rk.simulate(system, cycles=20)
    impacts = motion.events[motion.events["kind"] == "impact"]
    noted, _ = marched(system, impacts[0], 20)
    assert len(noted) == len(impacts) - 1
    assert noted[:, 0] * period + noted[:, 1] == pytest.approx(impacts["time"][1:], rel=0, abs=1e-11)
    assert noted[:, 2] * noted[:, 3] == pytest.approx(impacts["after"][1:], rel=0, abs=1e-11)


@pytest.mark.parametrize(
    "amplitude, period, restitution, brace, returned, cycles",
    [(10.0, 2.5, 0.925, 1.0, 1.0, 3), (6.0, 2.0, 0.8, 0.5, 0.6, 3), (12.0, 0.7, 0.95, 0.2, 0.9, 4)],
)
def test_the_same_events_between_braces_in_the_same_order(
    amplitude, period, restitution, brace, returned, cycles
):
    """Over cycles in which differences grow less than a millionfold."""
    system = rk.System(
        rk.Harmonic(amplitude=amplitude, period=period), restitution, rk.Braces(brace, returned)
    )
    motion = rk.simulate(system, cycles=cycles)
    met = motion.events[np.isin(motion.events["kind"], ["impact", "brace"])]
    first = met[np.flatnonzero(met["kind"] == "impact")[0]]
    noted, _ = marched(system, first, cycles)
    later = met[met["time"] > first["time"]]
    assert (later["kind"] == "brace").sum() >= 3
    assert len(noted) == len(later)
    assert noted[:, 0] * period + noted[:, 1] == pytest.approx(later["time"], rel=0, abs=1e-8)
    assert noted[:, 2] * noted[:, 3] == pytest.approx(later["after"], rel=0, abs=1e-7)


def asked(count, phase, brace, restitution):
    """Return systems over the periods and amplitudes of the paper's maps, at rest."""
    period, amplitude = (
        axis.ravel() for axis in np.meshgrid(np.linspace(0.2, 3.0, count), np.linspace(0.0, 16.0, count))
    )
    one = np.ones(period.size)
    systems = np.column_stack(
        [amplitude, math.tau / period, period, phase * one, restitution * one, brace * one, one, 0.0 * one]
    )
    return systems, np.zeros((period.size, 2))


def one_by_one(systems, starts, cycles):
    """Return the kind of each point, classified alone."""
    answers, go_on = empty_results(len(systems)), np.zeros(1, np.int64)
    kind, memory = parameters_of_row(systems[0]), make_workspace(cycles, 64)
    assert batch.classify_batch_scalar(kind, systems, starts, cycles, 64, memory, answers, go_on)
    return answers.kind


def together(systems, starts, cycles):
    return batch.classify_batch(systems, starts, cycles, 64, np.zeros(1, np.int64))


def stands_firm(system, kind, count, cycles, random):
    """Return whether one block has the same result for ``count`` changes of 1e-13 in amplitude and phase, from rest."""
    changed = np.repeat(system[None], count, 0)
    changed[:, [0, 3]] += 1e-13 * random.uniform(-1, 1, (count, 2))
    return np.all(one_by_one(changed, np.zeros((count, 2)), cycles) == kind)


def differing(count, cycles, brace, restitution):
    """Count points, those with another result in lanes, and those with another result of one block 2e-16 later in phase."""
    systems, starts = asked(count, 0.0, brace, restitution)
    alone = one_by_one(systems, starts, cycles)
    other = np.flatnonzero(together(systems, starts, cycles).kind != alone)
    flips = one_by_one(*asked(count, 2e-16, brace, restitution), cycles) != alone
    # One block has another result for each of them too, after some change of 1e-13. In most cases one of the first 16 changes
    # suffices. More are needed if nearly all neighbours overturn in time: all but one in 300, at two of 90,000 points, and all
    # but one in 7,000 at a third, in lanes and alone.
    random, stands = np.random.default_rng(11), other
    for changes in (16, 256, 4096, 65_536):
        stands = [k for k in stands if stands_firm(systems[k], alone[k], changes, cycles, random)]
    assert not stands, systems[stands]
    return systems.shape[0], other.size, int(flips.sum())


@pytest.mark.parametrize(
    ("cycles", "brace", "restitution"),
    [(1000, math.inf, 1.0), (300, 1.0, 0.925), (1000, math.inf, 0.925)],
    ids=["undamped", "braces", "damped"],
)
def test_lanes_tell_what_one_block_tells_unless_the_last_digits_tell(cycles, brace, restitution):
    """The shares of both are small numbers here: of their difference the chance is one in a thousand."""
    _, lanes, one = differing(40, cycles, brace, restitution)
    assert lanes <= 2 * one + 3.0 * math.sqrt(2 * one + 1)


@pytest.mark.long
@pytest.mark.parametrize(
    ("cycles", "brace", "restitution", "between"),
    [(10_000, math.inf, 1.0, 0.02), (1000, 1.0, 0.925, 0.05), (10_000, math.inf, 0.925, 0.002)],
    ids=["undamped", "braces", "damped"],
)
def test_of_the_whole_map_lanes_tell_otherwise_at_most_twice_as_often_as_the_last_digit(
    cycles, brace, restitution, between
):
    """The fraction of points that lie between two results is at most ``between``."""
    points, lanes, one = differing(300, cycles, brace, restitution)
    print(f"of {points} points lanes tell {lanes} otherwise, one block {one}")
    assert lanes <= 2 * one
    assert lanes <= between * points


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.8, 0.925, 0.98])
def test_damped_motions_from_any_start_end_in_lanes_as_they_do_alone(restitution):
    """Unless a change of 1e-13 in amplitude and phase gives the other result too."""
    random, count, cycles = np.random.default_rng(1991), 400, 600
    one, period = np.ones(count), 10.0 ** random.uniform(-1.0, 0.7, count)
    systems = np.column_stack(
        [
            random.uniform(1.0, 12.0, count),
            math.tau / period,
            period,
            random.uniform(-3.0, 3.0, count),
            restitution * one,
            math.inf * one,
            one,
            0.0 * one,
        ]
    )
    starts = random.uniform(-0.5, 0.5, (count, 2)) * random.integers(0, 2, (count, 2))

    def told(changed):
        answers, go_on = empty_results(count), np.zeros(1, np.int64)
        kind, memory = parameters_of_row(changed[0]), make_workspace(cycles, 64)
        batch.classify_batch_scalar(kind, changed, starts, cycles, 64, memory, answers, go_on)
        return np.stack([answers.kind, answers.period, answers.symmetric, answers.impacts, answers.transient])

    alone, found = told(systems), together(systems, starts, cycles)
    other = np.stack([found.kind, found.period, found.symmetric, found.impacts, found.transient])
    differs = np.any(other != alone, axis=0)
    for _ in range(64):
        if not differs.any():
            break
        changed = systems.copy()
        changed[:, [0, 3]] += 1e-13 * random.uniform(-1, 1, (count, 2))
        differs &= ~np.any(told(changed) != alone, axis=0)
    assert not differs.any(), systems[differs]


@pytest.mark.parametrize(
    ("amplitude", "period", "restitution", "brace"),
    [(2.0, 0.4, 1.0, math.inf), (12.0, 2.5, 0.925, 1.0)],
    ids=["no braces", "braces"],
)
def test_differences_grow_in_lanes_as_they_do_alone(amplitude, period, restitution, brace):
    """The exponents of a chaotic sea, from rest, over 10⁴ cycles; of two runs of it no more can be said."""
    systems = np.array(
        [
            [
                amplitude,
                math.tau / period,
                period,
                phase,
                restitution,
                brace,
                0.9 if brace < math.inf else 1.0,
                0.0,
            ]
            for phase in 1e-9 * np.arange(8)
        ]
    )
    starts, alone = np.zeros((8, 2)), empty_results(8)
    found = together(systems, starts, 10_000)
    kind, memory = parameters_of_row(systems[0]), make_workspace(10_000, 64)
    batch.classify_batch_scalar(kind, systems, starts, 10_000, 64, memory, alone, np.zeros(1, np.int64))
    spread = np.hypot(found.exponent.std(), alone.exponent.std()) / math.sqrt(7)
    assert np.all(found.exponent > 0)
    assert abs(found.exponent.mean() - alone.exponent.mean()) <= 5 * spread


@pytest.mark.parametrize(
    ("cycles", "brace", "restitution"),
    [(600, math.inf, 1.0), (150, 1.0, 0.925), (600, math.inf, 0.925)],
    ids=["undamped", "braces", "damped"],
)
def test_answers_hang_on_no_neighbour(cycles, brace, restitution):
    """To the last bit, in any order, and in any part of the points."""
    systems, starts = asked(16, 0.0, brace, restitution)
    whole = together(systems, starts, cycles)
    order = np.random.default_rng(7).permutation(len(systems))
    for part in (order, order[:37], order[:1]):
        for name, found in zip(whole._fields, together(systems[part], starts[part], cycles), strict=True):
            assert np.array_equal(found, getattr(whole, name)[part], equal_nan=True), name


# A, T, φ, e, Θb, r, cycles, the longest period: motions that settle, rest or stay in contact, or repeat too late to be detected
BETWEEN = [
    (6.022018400548217, 1.9750950957845779, 0.29689638055990913, 0.925, 1.019706035213965, 0.0, 300, 16),
    (11.878404776566112, 3.106661053765255, 5.027015349696704, 0.0, 2.0974020582417823, 0.5, 300, 16),
    (8.864972439615363, 1.048110040198151, 1.0585106915763935, 0.0, 1.5447596165716047, 0.5, 300, 16),
    (12.99709910694312, 2.7609999463791652, 5.131536056243492, 0.0, 0.1956577024688689, 0.9, 100, 8),
    (11.671392852155254, 0.27002929228725797, 1.5428964528312439, 1.0, 0.15097622797314594, 0.0, 300, 16),
    (15.516832141844997, 0.23866310407682245, 5.799713591443896, 0.3, 2.8126752941286064, 0.5, 300, 16),
    (5.0, 0.2, 0.16, 0.925, 0.5, 1.0, 6000, 1),
]


# A, T, φ, e: damped motions whose orbit is found from a return over many cycles, after another candidate has failed
FROM_RETURNS = [
    (11.346743889590396, 0.11275616135145128, -3.8974021592157464, 0.3188374294602877),
    (11.866474132467523, 0.14144822552017083, 0.8653709939449468, 0.2677883320522687),
    (15.733317501002032, 0.3758802594041618, 0.8601874326419239, 0.3495756321323046),
    (5.898976697956789, 0.31380780761136057, 0.46792033946449063, 0.17736141842016417),
    (13.162741777750012, 0.3445478999625934, -0.5429599437704056, 0.9610143520543379),
    (2.193001782008698, 0.1587383263938781, -1.0338364789169492, 0.8589490040377348),
]


@pytest.mark.parametrize("case", FROM_RETURNS, ids=lambda case: f"A={case[0]:.3g}, e={case[3]:.3g}")
def test_orbit_is_found_from_distant_returns_in_lanes_as_alone(case):
    """The states of the section are evaluated only if they are needed; all of these are."""
    amplitude, period, phase, restitution = case
    systems = np.array([[amplitude, math.tau / period, period, phase, restitution, math.inf, 1.0, 0.0]])
    starts, go_on = np.zeros((1, 2)), np.zeros(1, np.int64)
    alone, found = empty_results(1), batch.classify_batch(systems, starts, 450, 64, go_on)
    kind, memory = parameters_of_row(systems[0]), make_workspace(450, 64)
    batch.classify_batch_scalar(kind, systems, starts, 450, 64, memory, alone, go_on)
    for name in ("kind", "ground", "period", "symmetric", "impacts", "transient", "cycles"):
        assert getattr(found, name) == getattr(alone, name), name


@pytest.mark.parametrize("case", BETWEEN, ids=lambda case: f"A={case[0]:.3g}, e={case[3]}, r={case[5]}")
def test_what_differences_forget_is_told_alike_between_braces(case):
    """Also when, after how many events of which kind, and how fast differences shrink.

    The rate and the peak differ by no more than those of amplitudes within six units in the last place.
    """
    amplitude, period, phase, restitution, brace, returned, cycles, longest = case
    systems = np.tile(
        [amplitude, math.tau / period, period, phase, restitution, brace, returned, 0.0], (13, 1)
    )
    systems[:, 0] += np.spacing(amplitude) * np.array([0, *range(-6, 0), *range(1, 7)])
    starts, go_on = np.zeros((13, 2)), np.zeros(1, np.int64)
    alone, found = empty_results(13), batch.classify_batch(systems[:1], starts[:1], cycles, longest, go_on)
    kind, memory = parameters_of_row(systems[0]), make_workspace(cycles, longest)
    batch.classify_batch_scalar(kind, systems, starts, cycles, longest, memory, alone, go_on)
    for name in ("kind", "ground", "period", "symmetric", "impacts", "brace_hits", "transient", "cycles"):
        assert getattr(found, name) == getattr(alone, name)[0], name
    for name in ("exponent", "peak"):
        values = getattr(alone, name)
        width = np.ptp(values) if np.isfinite(values).all() else 0.0
        assert getattr(found, name) == pytest.approx(values[0], rel=1e-9, abs=width), name


@pytest.mark.parametrize(
    ("amplitude", "period", "restitution", "brace", "returned"),
    [(1.5, 2.5, 0.5, math.inf, 1.0), (10.5, 2.5, 0.5, 0.06, 0.2)],
)
def test_chattering_is_cut_short_in_lanes_as_alone(amplitude, period, restitution, brace, returned):
    """The states are the same to rounding if each impact is computed, so the number of events is compared."""
    systems = np.array([[amplitude, math.tau / period, period, 0.5, restitution, brace, returned, 0.0]])
    starts, go_on = np.zeros((1, 2)), np.zeros(1, np.int64)
    alone, found = empty_results(1), batch.classify_batch(systems, starts, 200, 16, go_on)
    kind, memory = parameters_of_row(systems[0]), make_workspace(200, 16)
    batch.classify_batch_scalar(kind, systems, starts, 200, 16, memory, alone, go_on)
    assert found.work == alone.work
