"""Symmetric modes: the closed forms against the engine, against many digits, against brute force, and at their limits."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles import half_cycle

BREAKING = {
    (1, 0.8): 19.070505362954,
    (1, 0.9): 23.185055482058,
    (1, 0.925): 23.857305918589,
    (1.5, 0.8): 9.495608799191,
    (1.5, 0.925): 10.593757901371,
    (2, 0.9): 5.789420040211,
    (2, 0.925): 5.833633484627,
}
PERIODS, RESTITUTIONS = np.geomspace(0.2, 3.0, 9), (0.3, 0.6, 0.8, 0.925, 0.99, 1.0)


def grid(cycles=(1, 3, 5)):
    """Every mode over periods, restitutions and amplitudes from the fold to beyond the breaking of symmetry, up to 60."""
    for n in cycles:
        for period in PERIODS:
            for e in RESTITUTIONS:
                begins = rk.theory.existence_amplitude(period, e, n)
                ends = rk.theory.symmetry_breaking_amplitude(period, e, n)
                for share in (0.01, 0.1, 0.3, 0.6, 0.95, 1.2):
                    amplitude = float(begins + share * (ends - begins))
                    if amplitude < 60.0:
                        yield from rk.theory.symmetric_modes(amplitude, period, e, n)


@pytest.mark.parametrize("case", BREAKING)
def test_symmetry_breaks_at_the_known_amplitudes(case):
    assert rk.theory.symmetry_breaking_amplitude(*case, 1) == pytest.approx(BREAKING[case], abs=6e-13)


@pytest.mark.parametrize(
    ("system", "velocity", "phase", "trace"),
    [
        ((2.0, 1.0, 0.925, 1), 0.5320172278868, -1.6779140886924, -0.3565676053839),
        ((6.5, 0.4, 0.925, 3), 0.6582529904285, -1.8716076665268, -0.6001401411695),
    ],
)
def test_modes_of_figure_2_have_the_known_speed_phase_and_trace(system, velocity, phase, trace):
    (mode,) = rk.theory.symmetric_modes(*system)
    assert [mode.velocity, mode.phase, mode.trace] == pytest.approx([velocity, phase, trace], abs=6e-14)
    assert mode.stable
    assert mode.admissible


def test_slow_modes_at_figure_2c_have_the_known_speeds():
    speeds = [rk.theory.symmetric_modes(5.5, 0.5, 0.925, n)[1].velocity for n in (5, 7)]
    assert speeds == pytest.approx([0.11621, 0.26891], abs=5e-6)


@pytest.mark.long
def test_trace_determinant_and_return_are_those_of_the_engine_wherever_a_mode_is_admissible():
    checked, unstable = 0, 0
    for mode in grid():
        if not mode.admissible:
            continue
        e, h = mode.restitution, mode.n * mode.period / 2
        wait, speed, matrix = half_cycle.engine(mode)
        allowed = 1e-10 * max(1.0, math.cosh(h))
        # what the engine starts from is rounded: 1 of 1,417 modes has a V so small (.006) that this alone moves its trace by more
        moved = np.trace(half_cycle.engine(mode, faster=1e-9)[2]) - np.trace(matrix)
        rounded = 4 * 2.0**-53 * (1 + abs(mode.velocity)) * abs(moved) / 1e-9
        assert abs(np.trace(matrix) - mode.trace) <= allowed + (rounded if mode.velocity < 0.01 else 0.0), (
            mode
        )
        assert abs(np.linalg.det(matrix) - e * e) <= allowed, mode
        assert abs(wait - h) <= allowed, mode
        assert abs(speed - mode.velocity) <= allowed, mode
        checked, unstable = checked + 1, unstable + (not mode.stable)
    assert checked > 1000
    assert unstable > 200


def test_multipliers_are_those_of_the_engine_away_from_folds_and_from_where_symmetry_breaks():
    checked = 0
    for mode in grid():
        e, h = mode.restitution, mode.n * mode.period / 2
        apart = abs(mode.trace * mode.trace - 4 * e * e)
        if not mode.admissible or abs(mode.trace) > 50.0 or apart < 0.05:
            continue
        found = np.linalg.eigvals(half_cycle.engine(mode)[2])
        expected = sorted(mode.half_multipliers, key=lambda value: (value.real, value.imag))
        # an eigenvalue moves by as much as the trace, over the distance of the two
        allowed = 1e-10 * max(1.0, math.cosh(h)) * (1.0 if apart > 1.0 else 1.0 / math.sqrt(apart))
        assert np.abs(np.sort_complex(found) - expected).max() <= allowed, mode
        squares = sorted((value**2 for value in mode.half_multipliers), key=lambda value: value.imag)
        whole = sorted(mode.multipliers, key=lambda value: value.imag)
        assert whole == pytest.approx(squares, rel=1e-12, abs=0), mode
        for larger, smaller in (mode.multipliers, mode.half_multipliers):
            assert larger.imag > 0.0 or larger.imag == 0.0 <= abs(larger) - abs(smaller), mode
        checked += 1
    assert checked > 500


DIGITS = [
    (2.0, 1.0, 0.925, 1),
    (6.5, 0.4, 0.925, 3),
    (5.5, 0.5, 0.925, 7),
    (0.3, 1.0, 0.8, 1),
    (3.0, 2.0, 0.05, 1),
    (2.0, 1.0, 1.0, 1),
    (2.0, 1.0, 1.0 - 1e-12, 1),
    (1e-6, 1.0, 1.0 - 1e-9, 1),
    (0.9, 30.0, 0.9, 1),
    (40.0, 0.2, 0.7, 5),
]


@pytest.mark.parametrize("system", DIGITS)
def test_speed_phase_trace_and_determinant_in_sixty_digits(system):
    with mp.workdps(60):
        modes = rk.theory.symmetric_modes(*system)
        assert modes
        for mode in modes:
            v, phi = half_cycle.solved(*system, mode.velocity, mode.phase)
            assert mode.velocity == pytest.approx(float(v), rel=1e-13, abs=1e-15)
            assert mode.phase == pytest.approx(float(phi), abs=1e-13)
            trace, determinant = half_cycle.trace_and_determinant(*system, v, phi)
            # the trace moves by sinh h/V² times what rounds V
            h = system[1] * system[3] / 2
            allowed = 1e-14 * (1 + math.sinh(h) / mode.velocity)
            assert abs(mode.trace - float(trace)) <= allowed
            product = mode.half_multipliers[0] * mode.half_multipliers[1]
            assert abs(product - float(determinant)) <= 1e-13 * max(1.0, abs(mode.trace))
            assert abs(sum(mode.half_multipliers) - mode.trace) <= 1e-14 * max(1.0, abs(mode.trace))


@pytest.mark.parametrize(
    ("period", "e", "n"), [(1.0, 0.8, 1), (0.4, 0.925, 3), (3.0, 0.3, 5), (2.0, 0.99999, 1)]
)
def test_two_modes_are_born_at_the_existence_amplitude(period, e, n):
    begins = rk.theory.existence_amplitude(period, e, n)
    assert rk.theory.symmetric_modes(begins * (1 - 1e-12), period, e, n) == []
    fast, slow = rk.theory.symmetric_modes(begins * (1 + 1e-12), period, e, n)
    assert fast.velocity == pytest.approx(slow.velocity, rel=1e-3)
    # they part like the square root of 2e-12, times sinh h
    near = 1e-5 * math.cosh(n * period / 2)
    assert [fast.trace, slow.trace] == pytest.approx([1 + e * e] * 2, abs=near)
    assert fast.trace < 1 + e * e < slow.trace
    assert fast.stable
    assert not slow.stable


@pytest.mark.parametrize("e", [0.3, 0.925, 1.0])
@pytest.mark.parametrize("n", [1, 3])
def test_there_are_two_modes_up_to_a_closed_form_and_one_above_it(e, n):
    omega = 2 * math.pi / 1.3
    second = math.tanh(n * 1.3 / 4) * (1 + omega**2) / omega
    counts = [len(rk.theory.symmetric_modes(second * share, 1.3, e, n)) for share in (0.999, 1.001, 30.0)]
    assert counts == [2, 1, 1]
    assert rk.theory.slower_mode_amplitude(1.3, n) == pytest.approx(second, rel=1e-15, abs=0)


def test_faster_mode_is_stable_just_between_existence_and_symmetry_breaking():
    for period in PERIODS:
        for e in RESTITUTIONS:
            begins = rk.theory.existence_amplitude(period, e, 1)
            ends = rk.theory.symmetry_breaking_amplitude(period, e, 1)
            inside = [begins + share * (ends - begins) for share in (1e-6, 0.3, 1 - 1e-9)]
            for amplitude, stable in [*((a, True) for a in inside), (ends * (1 + 1e-9), False)]:
                if amplitude < 1000.0:
                    mode = rk.theory.symmetric_modes(float(amplitude), period, e, 1)[0]
                    assert (mode.stability != "unstable") == stable, (period, e, amplitude)


def test_closed_forms_over_arrays_are_those_of_the_theory_in_thirty_digits():
    random = np.random.default_rng(1984)
    periods, e = 10 ** random.uniform(-2, 3.5, 200), random.uniform(0.01, 1.0, 200)
    n = 2 * random.integers(0, 6, 200) + 1
    begins, breaks = (
        rk.theory.existence_amplitude(periods, e, n),
        rk.theory.symmetry_breaking_amplitude(periods, e, n),
    )
    with mp.workdps(30):
        for k in range(200):
            omega, r, cycles = 2 * mp.pi / mp.mpf(periods[k]), mp.mpf(e[k]), int(n[k])
            h = cycles * mp.pi / omega
            t, s, c = mp.tanh(h / 2), mp.sinh(h), mp.cosh(h)
            less, more, square = (1 - r) / (2 * r), (1 + r) / (2 * r), 1 + omega**2
            fold = square * t**2 * (1 - r) / mp.sqrt((1 + r) ** 2 + omega**2 * t**2 * (1 - r) ** 2)
            v = r * (1 + r) * s / (2 * r * c - (1 + r**2) + s * t * (1 - r) ** 2 * square / 2)
            breaking = square * mp.sqrt((t * v * less) ** 2 + (t - v * more) ** 2 / omega**2)
            assert begins[k] == pytest.approx(float(fold), rel=4e-15, abs=0)
            assert breaks[k] == pytest.approx(float(breaking), rel=2e-14, abs=0)


def test_without_losses_modes_begin_at_nothing_and_break_at_one_over_t_less_t():
    omega = 2 * np.pi / PERIODS
    t = np.tanh(PERIODS / 4)
    np.testing.assert_array_equal(rk.theory.existence_amplitude(PERIODS, 1.0, 1), 0.0)
    np.testing.assert_allclose(
        rk.theory.symmetry_breaking_amplitude(PERIODS, 1.0, 1),
        (1 + omega**2) * (1 / t - t) / omega,
        rtol=1e-14,
    )


def test_long_responses_begin_at_the_heteroclinic_tangency():
    periods = np.geomspace(0.01, 6000.0, 400)[:, None]
    e = np.linspace(0.01, 0.999, 100)
    limit = rk.theory.existence_amplitude(periods, e, 9_999)
    np.testing.assert_allclose(limit, rk.theory.heteroclinic_amplitude(periods, e), rtol=1e-8)
    apart = rk.theory.existence_amplitude(periods, e, 1) / rk.theory.heteroclinic_amplitude(periods, e)
    assert apart.min() < 0.1


@pytest.mark.parametrize("period", [150.0, 1500.0, 6283.0])
@pytest.mark.parametrize("n", [1, 99])
def test_nothing_overflows_in_long_half_cycles(period, n):
    # the stable modes between lie within e^-h of each other
    breaks = rk.theory.symmetry_breaking_amplitude(period, 0.9, n)
    assert 0 < rk.theory.existence_amplitude(period, 0.9, n) <= breaks < 1
    for mode in rk.theory.symmetric_modes(0.5, period, 0.9, n):
        assert 0.0 < mode.velocity < 2.0
        assert not mode.stable
        assert abs(mode.multipliers[0]) > 1e30


def slow():
    """Return modes with long half cycles, during most of which the block stands on a corner."""
    for n in (1, 3):
        for period in (9.0, 25.0, 60.0, 300.0):
            for e in (0.5, 0.9, 1.0):
                for amplitude in (0.1, 0.5, 0.9, 1.05, 2.0, 8.0):
                    yield from rk.theory.symmetric_modes(amplitude, period, e, n)


def test_admissible_modes_are_those_whose_closed_form_stays_above_the_base():
    """By brute force over 20,001 instants, wherever those decide; so is the largest angle."""
    for modes, least_of_each in ((grid((1, 3, 7)), (1000, 50)), (slow(), (60, 60))):
        kinds = []
        for mode in modes:
            least, most = half_cycle.sampled(mode)
            if abs(least) < 1e-4:
                continue
            assert mode.admissible == (least > 0.0), mode
            kinds.append(mode.admissible)
            if mode.admissible:
                # between two instants an angle rises by no more than its acceleration makes it
                step = mode.n * mode.period / 2 / 20_000
                assert -1e-12 <= mode.peak - most <= (2 + mode.amplitude) * step * step, mode
        assert kinds.count(True) > least_of_each[0]
        assert kinds.count(False) > least_of_each[1]


def test_a_run_started_on_a_stable_mode_is_that_mode():
    for mode in grid():
        if mode.admissible and mode.stable and mode.restitution < 0.95 and abs(mode.multipliers[0]) < 0.9:
            motion = rk.simulate(mode.system, mode.start, cycles=20 * mode.n, record="none")
            assert abs(motion.impacts - 40) <= 1, mode
            assert motion.peak == pytest.approx(mode.peak, rel=1e-9), mode


@pytest.mark.parametrize(("system", "period"), [((2.0, 1.0, 0.925, 1), 1), ((6.5, 0.4, 0.925, 3), 3)])
def test_verdict_on_a_mode_has_its_multipliers(system, period):
    mode = rk.theory.symmetric_modes(*system)[0]
    verdict = rk.classify(mode.system, rk.State(velocity=0.9 * mode.velocity))
    assert (verdict.period, verdict.symmetric, verdict.impacts_per_period) == (period, True, 2)
    moduli = [abs(value) for value in verdict.multipliers]
    assert moduli == pytest.approx([abs(value) for value in mode.multipliers], abs=1e-9)
    assert verdict.steady_peak == pytest.approx(mode.peak, rel=1e-9)


def test_without_forcing_there_is_no_mode_and_without_return_no_amplitude():
    assert rk.theory.symmetric_modes(0.0, 1.0, 1.0, 1) == []
    assert math.isnan(rk.theory.existence_amplitude(1.0, 0.0, 1))
    assert math.isnan(rk.theory.symmetry_breaking_amplitude(1.0, 0.0, 1))
    assert np.isnan(rk.theory.symmetry_breaking_amplitude(1.0, [0.0, 0.5], 1)).tolist() == [True, False]


def test_numbers_give_numbers_and_arrays_broadcast():
    for function in (rk.theory.existence_amplitude, rk.theory.symmetry_breaking_amplitude):
        assert isinstance(function(1, 0.9, 1), float)
        assert function(np.ones((3, 1)), np.full(4, 0.9), 3).shape == (3, 4)
        assert function([1.0], 0.9, [1, 3, 5]).shape == (3,)


def test_mode_says_what_it_is_in_one_line():
    stable, neutral = (rk.theory.symmetric_modes(2.0, 1.0, e, 1)[0] for e in (0.925, 1.0))
    assert str(stable) == "(1, 1) mode: V = 0.532017, φ = -1.67791, stable, admissible"
    assert "neutral" in str(neutral)
    slow = rk.theory.symmetric_modes(1.2, 1.0, 0.925, 1)[1]
    assert str(slow).endswith("unstable, admissible")


@pytest.mark.parametrize("e", [1e-3, 1e-100, 1e-156, 1e-300])
def test_however_little_is_kept_the_modes_of_twice_the_fold_are_there(e):
    """As e goes to 0 speeds shrink like e, and phase and trace tend to limits."""
    modes = rk.theory.symmetric_modes(2 * rk.theory.existence_amplitude(1.0, e, 1), 1.0, e, 1)
    known = rk.theory.symmetric_modes(2 * rk.theory.existence_amplitude(1.0, 1e-9, 1), 1.0, 1e-9, 1)
    assert len(modes) == len(known) > 0
    for mode, limit in zip(modes, known, strict=True):
        assert mode.velocity / e == pytest.approx(limit.velocity / 1e-9, rel=10 * e + 1e-8)
        assert mode.phase == pytest.approx(limit.phase, abs=10 * e + 1e-8)
