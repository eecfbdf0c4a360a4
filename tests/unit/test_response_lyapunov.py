"""Exponents and their errors: batch means of known sequences, and invalid input."""

import math
import re
import sys

import numpy as np
import pytest
from attrs import evolve

import rocking as rk
from rocking.response.batch_means import batch_mean

BRACED = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0, 1.0))


def system(amplitude, period, restitution, phase=0.0):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


def test_error_of_independent_terms_is_their_spread_over_the_root_of_their_number():
    terms = np.random.default_rng(1).normal(3.0, 2.0, 65_536)
    mean = batch_mean(terms)
    assert mean.value == pytest.approx(terms.mean(), rel=1e-13, abs=0)
    # five values, the noisiest with 15 degrees of freedom: the largest is up to a third too large, hardly too small
    assert 0.95 < mean.error / (2.0 / 256) < 1.35
    assert not mean.bounded


def autoregressive(random, length, kept):
    steps = random.normal(size=length)
    terms = np.empty(length)
    value = 0.0
    for k, step in enumerate(steps):
        terms[k] = value = kept * value + step
    return terms


def test_error_of_correlated_terms_is_that_of_their_sum():
    """x' = a x + noise of unit variance: the mean of n terms has the standard error 1/((1 − a)√n)."""
    random = np.random.default_rng(2)
    means = [batch_mean(autoregressive(random, 20_000, 0.97)) for _ in range(40)]
    exact = 1 / (0.03 * math.sqrt(20_000))
    assert np.mean([mean.error for mean in means]) / exact == pytest.approx(1.05, abs=0.15)
    assert not any(mean.bounded for mean in means)


@pytest.mark.parametrize("kept", [0.9995, 1.0])
def test_terms_that_hang_together_over_the_batches_support_no_error(kept):
    terms = autoregressive(np.random.default_rng(3), 20_000, kept)
    assert batch_mean(terms).error == math.inf


def test_bounded_sums_get_the_drift_of_the_running_mean_and_it_covers_the_truth():
    """Terms λ + b(k+1) − b(k) with a bounded b: the mean is off by (b(n) − b(0))/n, far less than any spread suggests."""
    b = np.sin(np.arange(20_001) * 1.2345)
    mean = batch_mean(-0.3 + np.diff(b))
    assert mean.bounded
    assert abs(mean.value + 0.3) <= mean.error < 10 / 20_000


@pytest.mark.parametrize("left_out", [0, 100, 1_000, 10_000])
def test_error_covers_the_distance_to_zero_where_neighbours_part_linearly(left_out):
    """A sum that grows as the logarithm of time has mean 0 in the end; the mean of n terms is still log n/n."""
    steps = np.arange(left_out, left_out + 10_241)
    mean = batch_mean(np.diff(np.log(1.0 + steps) + np.cos(2.0 * math.pi * 0.4096 * steps)))
    assert mean.bounded
    assert abs(mean.value) <= mean.error < 4 * math.log(10_240) / 10_240


def test_a_constant_sequence_has_no_spread_and_no_drift():
    mean = batch_mean(np.full(1_000, 0.5))
    assert (mean.value, mean.error, mean.bounded) == (0.5, 0.0, True)


def test_stretches_of_different_lengths_weigh_as_long_as_they_are():
    lengths = np.resize([1.0, 3.0], 320)
    assert batch_mean(0.25 * lengths, lengths).value == pytest.approx(0.25, rel=1e-15, abs=0)


@pytest.mark.parametrize("bad", [[], [math.nan, 1.0], [[1.0, 2.0]], [math.inf]])
def test_what_is_no_sequence_of_numbers_is_refused_in_one_line(bad):
    with pytest.raises(ValueError, match="^sums must be a sequence of at least one finite number; got .*$"):
        batch_mean(bad)
    with pytest.raises(ValueError, match="^lengths must be 3 positive numbers, one for each sum; got .*$"):
        batch_mean([1.0, 2.0, 3.0], [1.0, 0.0, 1.0])


def henon_growths(steps, a=1.4, b=0.3):
    """Logarithms of growth along the first difference of the Hénon map, step by step."""
    x, y, dx, dy = 0.1, 0.1, 1.0, 0.0
    growths = np.empty(steps)
    for k in range(-1_000, steps):
        x, y, dx, dy = 1.0 - a * x * x + y, b * x, -2.0 * a * x * dx + dy, b * dx
        size = math.hypot(dx, dy)
        dx, dy = dx / size, dy / size
        if k >= 0:
            growths[k] = math.log(size)
    return growths


def test_henon_map_has_its_known_exponent_within_the_error():
    """.41922 per step (a = 1.4, b = .3)."""
    mean = batch_mean(henon_growths(400_000))
    assert 0.0 < mean.error < 0.002
    assert abs(mean.value - 0.41922) < 4 * mean.error


def test_per_cycle_is_per_unit_of_time_times_the_period():
    spectrum = rk.lyapunov(BRACED, cycles=2_000)
    values, errors = spectrum.per_cycle
    np.testing.assert_array_equal(values, spectrum.values * 2.0)
    np.testing.assert_array_equal(errors, spectrum.errors * 2.0)


def test_history_ends_with_the_values_themselves():
    spectrum = rk.lyapunov(BRACED, cycles=5_000)
    history = spectrum.history
    assert len(history) == 256
    assert history["cycles"][-1] == 5_000
    np.testing.assert_allclose(history["values"][-1], spectrum.values, rtol=1e-14)
    np.testing.assert_allclose(history["errors"][-1], spectrum.errors, rtol=1e-12)
    assert np.isinf(history["errors"][:31]).all()
    assert np.isfinite(history["errors"][200:]).all()


def test_motion_is_the_simulated_one():
    """Over cycles so few that rounding at the batches' ends, e^(0.13 a cycle) larger later, changes no count."""
    chaos = system(10.103037, 1.721328, 0.8)
    spectrum = rk.lyapunov(chaos, rk.State(1e-3), cycles=64, transient=36)
    early = rk.simulate(chaos, rk.State(1e-3), cycles=36, record="none")
    whole = rk.simulate(chaos, rk.State(1e-3), cycles=100, record="none")
    assert spectrum.impacts == whole.impacts - early.impacts > 50


TURNED = rk.theory.symmetric_modes(4.0, 0.4, 1.0, 3)[0]


@pytest.mark.parametrize(
    "system, start",
    [
        # complex multipliers, so that both are equal; a torus, on which both are 0
        (rk.System(rk.Harmonic(2.0, period=1.0), 0.8), rk.State()),
        (TURNED.system, rk.State(velocity=TURNED.velocity + 1e-3)),
        (rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8), rk.State()),
    ],
)
def test_exponents_descend_with_their_errors_and_growths(system, start):
    found = rk.lyapunov(system, start)
    assert found.values[0] >= found.values[1]
    np.testing.assert_allclose(
        found.growths.sum(axis=0) / (10_000 * system.forcing.period), found.values, rtol=1e-12
    )
    assert (found.history["errors"][-1] <= found.errors).all()
    # λ₁ + λ₂ is what the impacts take, whichever comes first
    taken = 2.0 * math.log(system.restitution) * found.impacts / (10_000 * system.forcing.period)
    assert found.values.sum() == pytest.approx(taken, abs=1e-12)


def test_exponents_do_not_depend_on_the_batches():
    """One product of derivatives by finite differences against the sum over 256 batches."""
    cycles, damped = 32, system(2.0, 1.0, 0.97)
    spectrum = rk.lyapunov(damped, rk.State(0.3, 0.2), cycles=cycles, transient=0)
    step = 1e-7

    def final(angle, velocity):
        state = rk.simulate(damped, rk.State(angle, velocity), cycles=cycles, record="none").final
        return np.array([state.angle, state.velocity])

    first = (final(0.3 + step, 0.2) - final(0.3 - step, 0.2)) / (2 * step)
    assert spectrum.values[0] * cycles == pytest.approx(math.log(np.hypot(*first)), abs=1e-4)


@pytest.mark.parametrize(
    "forgetting",
    [system(0.5, 1.0, 0.9), system(1.0111, 4.7531, 0.925), system(0.5, 1.0, 1.0)],
    ids=["at rest", "chatter", "at rest, e = 1"],
)
def test_rest_is_superstable_and_said_so(forgetting):
    spectrum = rk.lyapunov(forgetting, cycles=1_000)
    assert spectrum.superstable
    assert spectrum.values.tolist() == [-math.inf, -math.inf]
    assert spectrum.errors.tolist() == [0.0, 0.0]
    assert spectrum.sum_rule_error == 0.0
    assert len(spectrum.history) == 0
    assert "superstable" in str(spectrum)
    with pytest.raises(ValueError, match="^a superstable motion has no Kaplan–Yorke dimension"):
        spectrum.kaplan_yorke  # noqa: B018


def test_leaning_is_superstable():
    leaning = rk.System(rk.Harmonic(9.0, frequency=1.5, phase=2.0), 0.925, rk.Braces(0.3, 0.2))
    assert rk.lyapunov(leaning, rk.State(0.1, 0.4), cycles=500).superstable


def test_rest_in_the_transient_is_forgotten():
    """From rest at φ = π/2 the block waits for lift-off; what follows is the same chaos as from anywhere."""
    waiting = rk.System(rk.Harmonic(15.0, period=2.0, phase=0.5 * math.pi), 0.925, rk.Braces(1.0, 1.0))
    assert rk.simulate(waiting, cycles=1).events["kind"][0] == "lift-off"
    assert rk.lyapunov(waiting, cycles=1_000, transient=0).superstable
    assert rk.lyapunov(waiting, cycles=1_000, transient=1).values[0] > 0.4


def test_without_restitution_only_one_direction_is_lost():
    lost = rk.System(rk.Harmonic(4.0, period=1.0), 0.0, rk.Braces(0.5, 1.0))
    spectrum = rk.lyapunov(lost, cycles=1_000)
    assert spectrum.values[1] == -math.inf
    assert not np.isnan(spectrum.values).any()


@pytest.mark.parametrize("cycles, transient", [(1_000, 0), (100, 0), (50, 3), (50, 100)])
def test_overturning_is_refused_with_its_cycle_whenever_it_comes(cycles, transient):
    message = (
        r"^the block must stay upright for an exponent; overturning is certain in cycle 5, counted from 0 "
        r"\(reduce the forcing, change the initial state, or add braces\)$"
    )
    with pytest.raises(ValueError, match=message):
        rk.lyapunov(system(1.75, 2.0, 0.95), cycles=cycles, transient=transient)


def test_too_few_cycles_are_refused_before_the_transient(monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.response.lyapunov"], "march_on", None)  # nothing may be computed
    with pytest.raises(ValueError, match=r"^cycles must be a whole number in \[32, 1000000000\]; got 20$"):
        rk.lyapunov(system(2.0, 1.0, 0.925), cycles=20, transient=10**9)


def test_a_run_that_is_half_transient_supports_no_error():
    """e = .99, T = .33, A = 4.86: chaos for 32,400 cycles on average, then period 3; how many hangs on the last digit."""
    refused = []
    for amplitude in (4.86 * (1 + k * 1e-10) for k in range(8)):
        try:
            rk.lyapunov(system(amplitude, 0.33, 0.99), cycles=60_000, transient=0)
        except rk.TooShort as short:
            refused.append(short)
    assert len(refused) >= 4  # 15 of 16; the others had next to no chaos, or nothing else
    for short in refused:
        assert re.search(r"still correlated \(λ₁ = .*; increase cycles or transient\)$", str(short))
        assert np.isinf(short.estimate.errors).any()
        assert "error unknown" in str(short.estimate)


def test_kaplan_yorke_is_one_plus_the_ratio_and_needs_contraction():
    spectrum = rk.lyapunov(BRACED, cycles=20_000)
    dimension, error = spectrum.kaplan_yorke
    assert dimension == 1.0 + spectrum.values[0] / abs(spectrum.values[1])
    assert abs(dimension - (1 + 0.531 / 0.751)) < 3 * error < 0.1
    assert rk.lyapunov(system(2.0, 1.0, 0.925)).kaplan_yorke == (0.0, 0.0)
    with pytest.raises(
        ValueError, match=r"requires contraction, .* \(an undamped motion has no attractor\)$"
    ):
        rk.lyapunov(system(4.0, 0.4, 1.0)).kaplan_yorke  # noqa: B018


def test_kaplan_yorke_is_refused_where_the_sign_of_the_exponent_is_open():
    vague = evolve(rk.lyapunov(BRACED, cycles=1_000), errors=np.array([0.4, 0.4]))
    with pytest.raises(
        rk.TooShort, match="^the sign of λ₁ = .* ± 0.4, and therefore the dimension, is undecided"
    ):
        vague.kaplan_yorke  # noqa: B018


def test_arrays_are_read_only():
    spectrum = rk.lyapunov(BRACED, cycles=100)
    for array in (spectrum.values, spectrum.errors, spectrum.history):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize("cycles, transient", [(500, 500), (5_000, 500), (5_000, 5_000)])
def test_exponents_of_a_stable_orbit_have_rounding_as_their_error(cycles, transient):
    """Batches that differ by rounding alone are not correlated."""
    system = rk.System(rk.Harmonic(7.0, period=1.721328), 0.8)
    exact = [math.log(abs(each)) / 1.721328 for each in rk.classify(system).multipliers]
    spectrum = rk.lyapunov(system, cycles=cycles, transient=transient)
    assert np.abs(spectrum.values - exact).max() < 1e-12
    assert (spectrum.errors < 1e-14).all()
    assert spectrum.bounded
    assert np.isfinite(spectrum.history["errors"][-1]).all()
