"""Closed forms and statements of Yim & Lin (1991) that do not hold, each shown by a computation."""

import math
import runpy
from pathlib import Path

import attrs
import numpy as np
import pytest

import rocking as rk
from oracles import half_cycle

EXAMPLE = Path(__file__).parents[2] / "examples" / "melnikov_and_exact.py"


def undamped():
    """Faster undamped (1, n) modes, from t < V < 1/t."""
    for n in (1, 3, 5):
        for period in (0.2, 0.4, 1.0, 2.0, 3.0):
            ends = rk.theory.symmetry_breaking_amplitude(period, 1.0, n)
            for share in (0.001, 0.05, 0.3, 0.7, 0.999):
                if share * ends < 1000.0:
                    yield rk.theory.symmetric_modes(float(share * ends), period, 1.0, n)[0]


def test_without_losses_both_multipliers_lie_on_the_unit_circle():
    """The paper, under "Response of undamped systems": one infinite, the other one."""
    checked = 0
    for mode in undamped():
        t = math.tanh(mode.n * mode.period / 4)
        assert t < mode.velocity < 1 / t
        assert np.abs(np.abs(mode.half_multipliers) - 1.0).max() < 1e-10
        assert np.abs(np.abs(mode.multipliers) - 1.0).max() < 1e-10
        if mode.admissible:
            matrix = half_cycle.engine(mode)[2]
            # on the circle: determinant 1 and |trace| < 2, to what rounds the engine's tangent
            rounding = 1e-13 * np.abs(matrix).max() ** 2 + 1e-13
            assert abs(np.linalg.det(matrix) - 1.0) < rounding
            assert abs(np.trace(matrix)) < 2.0 + rounding
            checked += 1
    assert checked > 50


def test_without_losses_periodic_responses_exist_and_are_neutrally_stable():
    """Its conclusion 3 has none; figure 5 turns around one."""
    mode = rk.theory.symmetric_modes(4.0, 0.4, 1.0, 3)[0]
    assert mode.admissible
    assert mode.stability == "neutral"
    off = rk.State(velocity=1.01 * mode.velocity)
    near, far = (
        rk.simulate(mode.system, start, cycles=30_000, record="section") for start in (mode.start, off)
    )
    centre = near.section()[0]
    # exact to rounding at first; a start that is off goes round it and keeps its distance
    assert np.abs(near.section()[:3000:3] - centre).max() < 1e-9
    distances = np.hypot(*(far.section()[::3] - centre).T)
    assert distances.max() < 0.05


def test_stability_needs_the_trace_of_the_matrix_of_equation_10():
    """It prints A₁₁ + A₁₂; with A₁₁ + A₂₂ the formula gives the eigenvalues."""
    mode = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
    matrix = half_cycle.engine(mode)[2].astype(complex)
    ((a, b), (c, d)) = matrix
    root = np.sqrt((a - d) ** 2 + 4 * b * c)
    printed = [(a + b + sign * root) / 2 for sign in (1, -1)]
    right = [(a + d + sign * root) / 2 for sign in (1, -1)]
    for known in (np.linalg.eigvals(matrix), mode.half_multipliers):
        assert max(min(abs(value - other) for other in right) for value in known) < 1e-13
        assert max(min(abs(value - other) for other in known) for value in right) < 1e-13
    assert min(abs(value - other) for value in printed for other in right) > 0.1


def test_zeros_without_losses_are_at_odd_multiples_of_a_quarter_period():
    """Cos Ωτ₀ = 0 of (19b) holds at Ωτ₀ = (k + ½)π; at its τ₀ = 2nπ, read as Ωτ₀, the function is largest in size."""
    period = 1.3
    turns = 2 * np.pi * np.arange(4)
    at = lambda phase: rk.theory.melnikov_function(phase * period / (2 * np.pi), 2.0, period, 1.0)  # noqa: E731
    assert np.abs(at((np.arange(8) + 0.5) * np.pi)).max() < 1e-14
    most = 4.0 / (1 + (2 * np.pi / period) ** 2)
    np.testing.assert_allclose(np.abs(at(turns)), most, rtol=1e-12)


def test_functions_of_the_two_orbits_are_not_identical_but_half_a_period_apart():
    times = np.linspace(0, 1.0, 101)
    upper, lower = (rk.theory.melnikov_function(times, 4.0, 1.0, 0.8, orbit) for orbit in ("upper", "lower"))
    later = rk.theory.melnikov_function(times + 0.5, 4.0, 1.0, 0.8)
    assert np.abs(upper - lower).max() > 0.3
    np.testing.assert_allclose(lower, later, rtol=0, atol=1e-14)


def test_manifolds_can_cross_where_melnikovs_function_has_no_zero():
    """Between A* and A_M at T = .5, e = .5: its zeros are a condition to first order only, even for that."""
    period, e = 0.5, 0.5
    exact, first = rk.theory.heteroclinic_amplitude(period, e), rk.theory.melnikov_amplitude(period, e)
    amplitude, phases = (exact + first) / 2, np.linspace(0, 2 * np.pi, 10_001)
    assert exact < amplitude < first
    assert rk.theory.manifold_gap(phases, amplitude, period, e).max() > 0.1
    assert rk.theory.melnikov_function(phases * period / (2 * np.pi), amplitude, period, e).max() < -0.05


def test_amplitudes_beyond_melnikovs_threshold_need_not_give_chaos():
    """64 points of the map of figure 11 at and above A_M, from rest: periodic or overturned, every one."""
    points = [
        (float(amplitude), period)
        for period in np.linspace(0.4, 3.0, 8)
        for amplitude in np.geomspace(max(rk.theory.melnikov_amplitude(period, 0.925), 1.05), 16.0, 8)
    ]
    kinds = [rk.classify(rk.System(rk.Harmonic(a, period=period), 0.925)).kind for a, period in points]
    assert set(kinds) == {rk.Kind.PERIODIC, rk.Kind.OVERTURNED}
    assert kinds.count(rk.Kind.PERIODIC) > 10


def test_first_order_and_exact_thresholds_part_by_a_known_share():
    """A_M/A* = ¼(1+e)²√(1 + Ω²((1−e)/(1+e))²): ((1+e)/2)² for slow forcing, unbounded for fast."""
    periods, e = np.geomspace(0.01, 6000.0, 200)[:, None], np.linspace(0.05, 0.999, 60)
    omega = 2 * np.pi / periods
    share = rk.theory.melnikov_amplitude(periods, e) / rk.theory.heteroclinic_amplitude(periods, e)
    np.testing.assert_allclose(
        share, (1 + e) ** 2 / 4 * np.sqrt(1 + (omega * (1 - e) / (1 + e)) ** 2), rtol=1e-12
    )
    assert (share[-1] < 1).all()
    np.testing.assert_allclose(share[-1], ((1 + e) / 2) ** 2, rtol=1e-5)
    assert (share[0] > 0.999).all()


def test_example_finds_the_periods_at_which_both_thresholds_are_the_same(capsys):
    example = runpy.run_path(str(EXAMPLE))
    for e in (0.5, 0.8, 0.925):
        period = example["equal_at"](e)
        exact = rk.theory.heteroclinic_amplitude(period, e)
        assert rk.theory.melnikov_amplitude(period, e) == pytest.approx(exact, rel=1e-14, abs=0)
    example["table"]()
    assert "equal at T = 0.9643" in capsys.readouterr().out
    assert [len(ax.lines) for ax in example["draw"]().axes] == [2, 4]


def test_start_of_figure_2c_is_a_velocity():
    """As a velocity, .15 leads at φ = 1.8 to period 10 with four impacts, two rocking cycles; as an angle to a symmetric period 7."""
    system = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), 0.925)
    velocity, angle = (
        rk.classify(system, start) for start in (rk.State(velocity=0.15), rk.State(angle=0.15))
    )
    assert (velocity.period, velocity.impacts_per_period, velocity.symmetric) == (10, 4, False)
    assert (angle.period, angle.symmetric) == (7, True)


@pytest.mark.parametrize("system", [(2.0, 1.0, 0.925, 1), (6.5, 0.4, 0.925, 3)])
def test_modes_the_paper_shows_come_alone_and_not_in_pairs(system):
    (mode,) = rk.theory.symmetric_modes(*system)
    assert mode.admissible
    # the quadratic's other root is a negative speed
    amplitude, period, e, n = system
    omega, t = 2 * math.pi / period, math.tanh(n * period / 4)
    beta = amplitude / (1 + omega**2)
    less, more = (1 - e) / (2 * e), (1 + e) / (2 * e)
    roots = np.roots([(omega * t * less) ** 2 + more**2, -2 * t * more, t * t - (omega * beta) ** 2])
    assert roots.max() == pytest.approx(mode.velocity, rel=1e-12, abs=0)
    assert roots.min() < 0
    if system[0] == 2.0:
        assert roots.min() == pytest.approx(-0.063, abs=5e-4)


def test_damping_must_oppose_the_velocity():
    """As (13) prints it, −½Θ'²(1 − e²)δ(Θ), its work along the lower orbit is a gain."""

    def work(orbit, force):
        times = np.linspace(-2e-3, 2e-3, 4001)
        angle, velocity = rk.theory.heteroclinic_orbit(times, orbit)
        return np.trapezoid(velocity * force(angle, velocity), times)

    printed = lambda angle, velocity: -np.abs(rk.theory.damping(angle, velocity, 0.8, 1e-3))  # noqa: E731
    opposed = lambda angle, velocity: rk.theory.damping(angle, velocity, 0.8, 1e-3)  # noqa: E731
    assert work("upper", printed) == pytest.approx(-0.18, rel=2e-3)
    assert work("lower", printed) == pytest.approx(+0.18, rel=2e-3)
    for orbit in ("upper", "lower"):
        assert work(orbit, opposed) == pytest.approx(-0.18, rel=2e-3)


def test_the_two_sections_of_the_orbit_meet_only_with_the_sign_of_the_logarithm_turned_in_the_second():
    """With the p of (16a), αt − ln θcr, (16b) starts at 1/θcr − θcr; with αt + ln θcr at 0, as (16a) does."""
    block = rk.Block(2.0, 0.5)
    critical, alpha = block.critical_angle, block.frequency_parameter
    printed, right = (math.exp(-sign * math.log(critical)) - critical for sign in (1, -1))
    assert printed > 3.0
    assert right == pytest.approx(0.0, abs=1e-16)
    # (17): V = v/(αθcr) is 1 at Θ = 0; v/θcr, as printed, would be α
    _, v = rk.theory.physical_heteroclinic_orbit(block, 0.0)
    assert v / (alpha * critical) == pytest.approx(1.0, rel=1e-15, abs=0)
    assert v / critical == pytest.approx(alpha, rel=1e-15, abs=0)


def test_zeros_with_losses_lie_where_the_cosine_is_negative():
    """The force enters (20a) with − and F with +, so that (21) is cos Ωτ₀ = −(1−e²)(1+Ω²)/4A."""
    amplitude, period, e = 4.0, 1.0, 0.8
    cosine = (1 - e * e) * (1 + (2 * math.pi) ** 2) / (4 * amplitude)
    times = [math.acos(value) / (2 * math.pi) for value in (-cosine, cosine)]
    right, printed = (rk.theory.melnikov_function(time, amplitude, period, e) for time in times)
    assert right == pytest.approx(0.0, abs=1e-14)
    assert printed == pytest.approx(-(1 - e * e), rel=1e-12, abs=0)


def test_less_than_the_critical_energy_does_not_hold_a_block_beyond_its_critical_angle():
    """Θ = 1.5 at rest has 3/8 < 1/2, and overturns; every start with |Θ| < 1 and less than 1/2 comes back without forcing."""
    free = rk.System(rk.Harmonic(0.0, period=1.0), 0.925)
    assert rk.theory.energy(1.5, 0.0) == 0.375
    assert rk.simulate(free, rk.State(angle=1.5)).outcome is rk.Outcome.OVERTURNED
    for angle in np.linspace(-0.99, 0.99, 9):
        for velocity in np.linspace(-0.99, 0.99, 9):
            bounded = rk.simulate(free, rk.State(angle, velocity)).outcome is not rk.Outcome.OVERTURNED
            if rk.theory.energy(angle, velocity) < 0.5:
                assert bounded


def test_upper_bound_of_the_1_3_mode_is_not_where_it_ends_below_a_period_of_0_8():
    """At T = .5, e = .925 the closed form keeps its stability to A_SB = 23, but its motion has left its side long before."""
    period, e = 0.5, 0.925
    ends = rk.theory.symmetry_breaking_amplitude(period, e, 3)
    at = [rk.theory.symmetric_modes(float(share * ends), period, e, 3)[0] for share in (0.3, 0.95)]
    assert [mode.admissible for mode in at] == [True, False]
    assert [mode.stable for mode in at] == [True, True]
    # by brute force, and by the engine: the first impact comes much too early
    assert half_cycle.sampled(at[1])[0] < 0
    wait, _, _ = half_cycle.engine(at[1])
    assert wait < 0.9 * 3 * period / 2
    moved = rk.simulate(attrs.evolve(at[1].system), at[1].start, cycles=30)
    assert moved.impacts != 20


def test_unsymmetric_modes_branch_from_the_symmetric_ones_and_can_be_followed():
    """Born at A_SB, known in closed form; their phases part from the symmetric mode's as √(A − A_SB)."""
    period, e = 1.5, 0.925
    breaks = rk.theory.symmetry_breaking_amplitude(period, e, 1)
    start = rk.theory.symmetric_modes(0.8 * breaks, period, e, 1)[0]
    orbit = rk.find_orbit(start.system, start.start, 1)
    symmetric = rk.continue_orbit(orbit, "amplitude", (0.5 * breaks, 1.3 * breaks))
    (born_at,) = (point for point in symmetric.special if point.kind == "symmetry-breaking")
    assert born_at.parameter == pytest.approx(breaks, abs=1e-8)
    born = rk.switch_branch(born_at, (0.5 * breaks, 1.3 * breaks))[0]
    assert not born.symmetric
    beyond, phases = born.points["parameter"] - breaks, born.points["phase"]
    near = (beyond > 1e-6) & (beyond < 1e-4)
    apart = np.abs(phases[near] - phases[0])
    assert near.sum() >= 3
    assert np.polyfit(np.log(beyond[near]), np.log(apart), 1)[0] == pytest.approx(0.5, abs=0.02)
    # predicted, and there: a start next to it stays
    stable = born.at(breaks * 1.02)[0]
    assert stable.stable
    there = attrs.evolve(stable.system, forcing=attrs.evolve(stable.system.forcing, phase=stable.phase))
    verdict = rk.classify(there, rk.State(stable.state.angle + 1e-3, stable.state.velocity))
    assert (verdict.period, verdict.symmetric) == (1, False)
    np.testing.assert_allclose(verdict.multipliers, stable.multipliers, rtol=1e-8)


def test_unsymmetric_modes_are_also_born_at_folds_of_their_own():
    """That of figure 2c: of period 10, from a fold where a stable and an unstable one meet, connected with no symmetric one."""
    system = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), 0.925)
    orbit = rk.classify(system, rk.State(velocity=0.15)).orbit
    branch = rk.continue_orbit(orbit, "amplitude", (1.0, 20.0))
    kinds = [point.kind for point in branch.special]
    assert kinds.count("fold") == 1
    assert "symmetry-breaking" not in kinds
    (fold,) = (point.parameter for point in branch.special if point.kind == "fold")
    pair = branch.at(1.0001 * fold)
    assert sorted(orbit.stable for orbit in pair) == [False, True]
    assert branch.points["parameter"].min() >= fold
