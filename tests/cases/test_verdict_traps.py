"""Verdicts that were wrong, or never came, once: each is kept by the numbers at which it was met."""

import math
import subprocess
import sys

import pytest

import rocking as rk

PEAK = """
import math, sys
import numpy as np
from rocking.kernels import march
from rocking.kernels.parameters import harmonic_parameters
period = 1.5788944723618088
p = harmonic_parameters(13.266331658291458, 2 * math.pi / period, period, 2.3999632297286526, 0.925)
progress, _ = march.begin_march(p, -1.5810174541726596, -2.118118497481491)
nothing = np.empty((0, 2))
status, progress, _, _ = march.march(p, progress, 3, 0.0, nothing, np.empty((0, 8)), nothing, np.empty(0), True)
print(status == march.DONE, progress.cycle, progress.peak)
"""


def test_a_turn_that_rounding_meets_again_ends_the_search_for_the_peak():
    """The march to the peak stood still here: the turn at the arc's start was found again after itself, for ever."""
    done = subprocess.run(
        [sys.executable, "-c", PEAK], capture_output=True, text=True, timeout=120, check=True
    )
    finished, cycle, peak = done.stdout.split()
    assert (finished, cycle) == ("True", "3")
    system = rk.System(
        rk.Harmonic(13.266331658291458, period=1.5788944723618088, phase=2.3999632297286526), 0.925
    )
    motion = rk.simulate(system, rk.State(-1.5810174541726596, -2.118118497481491), cycles=3)
    times = [k * 3 * system.forcing.period / 300_000 for k in range(300_001)]
    assert float(peak) == pytest.approx(abs(motion.at(times)[0]).max(), rel=1e-8)


def test_a_release_at_the_end_of_a_leg_is_no_release_too_few():
    """e = 0: the block comes to rest at every impact and is released once a cycle, at the same phase each time."""
    found = rk.classify(rk.System(rk.Harmonic(2.0, period=1.0), 0.0))
    assert (found.kind, found.period, found.symmetric) == ("periodic", 1, False)
    events = rk.simulate(found.system, cycles=40).events
    releases = events[events["kind"] == "lift-off"]["time"]
    assert releases[-20:] - releases[-21:-1] == pytest.approx(1.0, abs=1e-12)


def test_growth_between_two_releases_is_not_forgotten_where_the_measuring_begins():
    """More than 1e8 of growth between two releases (brute force finds no return in 5·10⁶ cycles), whatever moment between them it is.

    The exponent is measured over the second half of the budget: each budget begins it elsewhere.
    """
    system = rk.System(rk.Harmonic(3.7602966, period=1.2117119), 0.05)
    found = {budget: rk.classify(system, max_cycles=budget) for budget in range(130, 1_000, 3)}
    assert {budget: str(verdict) for budget, verdict in found.items() if verdict.kind != "undetermined"} == {}


# A = 5.5, T = .5, e = .925; Θ, Θ', φ. By brute force (1e-11, after 20,000 cycles) all of period 21.
NEAR_A_THIRD = (
    (0.2718, 0.4436, 5.519),
    (-0.2748, 0.7477, 4.9235),
    (-0.1832, -0.1958, 6.1108),
    (0.2651, -0.4261, 1.4358),
    (-0.1597, -0.2256, 6.0843),
    (-0.306, 0.4228, 4.4215),
    (-0.0332, 0.1849, 1.7147),
    (0.1195, -0.9748, 2.1649),
)


@pytest.mark.parametrize(("angle", "velocity", "phase"), NEAR_A_THIRD)
def test_near_the_third_of_a_turn_the_orbit_of_21_cycles_is_not_taken_for_that_of_7(angle, velocity, phase):
    """The multipliers of the 7-orbit turn by nearly a third: a state of the 21-orbit returns once as if it came to the other."""
    found = rk.classify(
        rk.System(rk.Harmonic(5.5, period=0.5, phase=phase), 0.925), rk.State(angle, velocity)
    )
    assert (found.kind, found.period) == ("periodic", 21)


@pytest.mark.parametrize(
    ("amplitude", "period", "restitution", "start", "found"),
    [
        (4.20971051431227, 0.3, 0.6, (0.05, 0.0), 3),
        (1.7927406076353247, 0.007032280718753793, 0.01, (0.0, 0.1), 1),
    ],
)
def test_an_unsymmetric_orbit_is_not_hidden_by_the_symmetric_one_it_was_born_of(
    amplitude, period, restitution, start, found
):
    system = rk.System(rk.Harmonic(amplitude, period=period), restitution)
    verdict = rk.classify(system, rk.State(*start), max_cycles=3_000)
    assert (verdict.kind, verdict.period, verdict.symmetric) == ("periodic", found, False)


def test_an_orbit_approached_slowly_is_not_hidden_by_another_far_away():
    """Once in 17 cycles, while the motion creeps to an orbit of 3, it comes a ten-thousandth nearer to one of 17 that lies .26 away."""
    system = rk.System(rk.Harmonic(5.957957957957958, period=0.9819819819819819), 0.925)
    found = rk.classify(system, max_cycles=5_000)
    assert (found.kind, found.period) == ("periodic", 3)


@pytest.mark.parametrize(
    ("amplitude", "period", "phase", "restitution"),
    [
        (2.9499414956730723, 0.8864588758644505, -2.648926547334762, 0.11225874316205248),
        (2.3423222753479234, 2.242424584963357, 0.19148373857964085, 0.04487258954540446),
    ],
)
def test_a_motion_as_near_to_its_orbit_as_newtons_method_gets_has_arrived(
    amplitude, period, phase, restitution
):
    """Its last return is off by no more than the orbit itself, 10⁻¹², but by much of what is left: it was open after 14 to 17 cycles."""
    system = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)
    found = [rk.classify(system, max_cycles=budget) for budget in range(10, 30)]
    assert [(verdict.kind, verdict.period) for verdict in found] == [("periodic", 1)] * 20


@pytest.mark.parametrize(("amplitude", "period"), [(1.0, 1.0), (3.0, 0.8), (2.0, 2.0)])
def test_a_start_on_a_neutral_mode_without_loss_is_periodic(amplitude, period):
    """e = 1: the mode (1, 1) has V = tanh(π/2Ω) ± Ωβ at a phase of ∓π/2, on the unit circle for t < V < 1/t, eqs. (8)–(10)."""
    frequency = 2 * math.pi / period
    t, beta = math.tanh(math.pi / frequency / 2), amplitude / (1 + frequency**2)
    speed = t + frequency * beta
    assert t < speed < 1 / t
    found = rk.classify(
        rk.System(rk.Harmonic(amplitude, period=period, phase=-math.pi / 2), 1.0), rk.State(0.0, speed)
    )
    seen = (found.kind, found.period, found.impacts_per_period, found.symmetric, found.evidence.level)
    assert seen == ("periodic", 1, 2, True, "verified")
    assert abs(found.multipliers[0]) == pytest.approx(1.0, abs=1e-6)
    beside = rk.classify(found.system, rk.State(0.0, speed * (1 + 1e-4)))
    assert beside.kind == "quasi-periodic"


# e = 1; A, T and how many cycles are watched, from rest: each sticks to a torus for long, and for once its averages over both halves
# agree well enough. The first two overturn after 922 and 3,870 cycles at the latest (41 amplitudes 1e-13 apart); of 41 beside the
# third 27 overturn within 10⁵ cycles, the exponent of the fourth is .0145 ± .0022 over 10⁶, the fifth overturned after 1.8·10⁶.
STICKY = (
    (10.915254237288135, 1.2440677966101694, 600),
    (3.0338983050847457, 0.8169491525423729, 3_000),
    (3.288135593220339, 0.38983050847457623, 3_000),
    (12.1864406779661, 0.2, 3_000),
    (12.1864406779661, 0.29491525423728815, 12_000),
)


@pytest.mark.parametrize(("amplitude", "period", "watched"), STICKY)
def test_motion_that_sticks_to_a_torus_is_not_taken_for_quasi_periodic(amplitude, period, watched):
    system = rk.System(rk.Harmonic(amplitude, period=period), 1.0)
    assert rk.classify(system, max_cycles=watched).kind == "undetermined"


@pytest.mark.parametrize(("amplitude", "period", "watched"), STICKY[:2])
def test_what_stuck_to_a_torus_overturns_in_the_end(amplitude, period, watched):
    motion = rk.simulate(rk.System(rk.Harmonic(amplitude, period=period), 1.0), cycles=10_000, record="none")
    assert motion.outcome == "overturned"
    assert motion.cycles > watched


def test_a_torus_whose_averages_agree_late_is_found_when_it_is_watched_for_long():
    """At the rim of an island: after 37,000 cycles they agree to nine digits, and more are not asked for however long the run is."""
    system = rk.System(rk.Harmonic(2.0, period=0.4), 1.0)
    found = {
        cycles: str(rk.classify(system, rk.State(0.018, 0.168), max_cycles=cycles).kind)
        for cycles in (9_000, 60_000)
    }
    assert found == {9_000: "undetermined", 60_000: "quasi-periodic"}
