"""Rotation numbers of undamped motion: many digits, locked and free distinguished, and errors if there is none."""

import math
import re

import numpy as np
import pytest

import rocking as rk
from rocking.response.rotation_number import average


def system(amplitude, period, restitution=1.0, phase=0.0, braces=None):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)


ISLANDS = system(4.0, 0.4)
CENTRE = (0.0403216219, 0.1926036397)


def test_weighted_average_of_a_quasi_periodic_signal_is_exact_where_the_plain_one_is_not():
    values = np.exp(np.cos(2 * math.pi * 0.381966011250105 * np.arange(20_000)))
    bessel = 1.2660658777520084  # I₀(1), the mean of exp(cos x)
    mean, digits = average(values)
    assert abs(mean - bessel) < 1e-13
    assert digits >= 12
    assert abs(values.mean() - bessel) > 1e-7


def test_weighted_average_of_noise_agrees_in_few_digits():
    mean, digits = average(np.random.default_rng(1).normal(1.0, 1.0, 20_000))
    assert abs(mean - 1.0) < 0.05
    assert digits <= 3


def test_islands_of_figure_5_are_locked_and_turn_by_the_known_number():
    """A = 4, T = .4, e = 1 from rest: 2 impacts in 3 cycles; .4744150886 about the centre, which is not reported."""
    turning = rk.rotation_number(ISLANDS)
    assert turning.locked == (2, 3)
    assert turning.period == 3
    assert abs(turning.free - 0.4744150886) < 1e-10
    assert abs(turning.per_cycle - 2 / 3) < 1e-12
    assert turning.digits >= 10
    assert "locked: 2 impacts in 3 cycles; free: 0.474415088" in str(turning)


@pytest.mark.parametrize("offset", [0.0015, 0.003, 0.005])
def test_free_rotation_is_that_of_the_stroboscopic_section(offset):
    """Angles about the centre every third cycle, an average over another section, with the same sense of turning."""
    start = rk.State(CENTRE[0] + offset, CENTRE[1])
    section = rk.simulate(ISLANDS, start, cycles=60_000, record="section").section()
    points = (section[::3] - CENTRE) / [0.03, 0.1]
    turns = np.mod(np.diff(np.arctan2(points[:, 1], points[:, 0])), 2 * math.pi) / (2 * math.pi)
    strobe, _ = average(turns)
    assert abs(rk.rotation_number(ISLANDS, start).free - strobe) < 1e-9


@pytest.mark.parametrize("offset", [0.01, 0.015])
def test_islands_within_islands_turn_about_their_own_centres(offset):
    """A rotation of one half is two smaller islands; about the centre of either, seen every sixth cycle, it is free."""
    start = rk.State(CENTRE[0] + offset, CENTRE[1])
    turning = rk.rotation_number(ISLANDS, start)
    assert (turning.locked, turning.period) == ((2, 3), 6)
    section = rk.simulate(ISLANDS, start, cycles=60_000, record="section").section()[::6]
    points = (section - section.mean(axis=0)) / np.abs(section - section.mean(axis=0)).max(axis=0)
    strobe, _ = average(np.mod(np.diff(np.arctan2(points[:, 1], points[:, 0])), 2 * math.pi) / (2 * math.pi))
    assert abs(turning.free - strobe) < 1e-8


def test_nothing_turns_about_the_centre_itself():
    turning = rk.rotation_number(ISLANDS, rk.State(*CENTRE))
    assert (turning.locked, turning.free) == ((2, 3), None)
    assert "no rotation about the island centre (periodic motion)" in str(turning)


def test_free_rocking_strikes_at_its_own_frequency():
    """A = 0 from Θ₀ = 1/2: a quarter period is arccosh(1/(1 − Θ₀)), an impact every two of them."""
    turning = rk.rotation_number(system(0.0, 1.0), rk.State(0.5), cycles=5_000)
    assert turning.locked is None
    assert turning.free == turning.per_cycle
    assert abs(turning.per_cycle - 1 / (2 * math.acosh(2.0))) < 1e-12


def mode_1_1(amplitude, period, restitution=1.0):
    """V = t + Ωβ, φ = −π/2 and the half-cycle's trace −2C + 2S/V (e = 1)."""
    frequency = 2 * math.pi / period
    half = math.pi / frequency
    speed = math.tanh(half / 2) + frequency * amplitude / (1 + frequency**2)
    return speed, -2 * math.cosh(half) + 2 * math.sinh(half) / speed


@pytest.mark.parametrize(("amplitude", "period"), [(1.0, 1.0), (3.0, 0.8), (2.0, 2.0)])
def test_small_islands_turn_by_the_angle_of_the_multipliers(amplitude, period):
    """Half-cycle multipliers exp(±iχ), 2 cos χ = trace: a cycle turns by 2χ one way or the other, as the island shrinks."""
    speed, trace = mode_1_1(amplitude, period)
    shaken = system(amplitude, period, phase=-math.pi / 2)
    turning = rk.rotation_number(shaken, rk.State(velocity=speed * (1 + 1e-4)))
    assert turning.locked == (2, 1)
    turn = 2 * math.acos(trace / 2) / (2 * math.pi) % 1.0
    assert min(abs(turning.free - turn), abs(turning.free - (1 - turn))) < 1e-6
    assert rk.rotation_number(shaken, rk.State(velocity=speed)).free is None


def test_bouncing_on_a_lossless_brace_turns_without_an_impact():
    turning = rk.rotation_number(system(0.1, 1.0, 0.9, braces=rk.Braces(1.5, 1.0)), rk.State(1.3))
    assert (turning.section, turning.locked) == ("brace hits", (1, 2))
    assert 0.0 < turning.free < 1.0


def test_chaos_is_refused_with_what_was_found():
    """Most phases that differ by rounding: a run may stay near an island for long, where it turns almost evenly."""
    message = re.compile(
        r"both halves of 20000 cycles agree to [0-5] digits, but a rotation number requires 9 "
        r"\(the motion is chaotic, or cycles too few\)"
    )
    refused = 0
    for phase in np.linspace(0.0, 1e-7, 9):
        with pytest.raises(rk.TooShort) as caught:
            rk.rotation_number(system(2.0, 0.4, phase=phase))
        refused += bool(message.fullmatch(str(caught.value))) and caught.value.estimate.digits < 6
    assert refused >= 5


def test_short_runs_are_refused_with_what_was_found():
    with pytest.raises(
        rk.TooShort, match=r"^both halves of 1500 cycles agree to [678] digits, .* \(increase cycles\)$"
    ) as caught:
        rk.rotation_number(ISLANDS, cycles=1_500)
    assert abs(caught.value.estimate.free - 0.4744150886) < 1e-5
    with pytest.raises(ValueError, match="^too few impacts for a rotation number: 3 in 4 cycles"):
        rk.rotation_number(ISLANDS, cycles=4)


@pytest.mark.parametrize("cycles", [20_000, 100_000])
def test_curve_bent_around_its_mean_is_no_matter_of_the_length_of_the_run(cycles):
    told = re.escape(
        "start must lie on a curve that surrounds its own mean; every 2nd of the impacts, 2 in 1 cycle, does not "
        "(the motion is chaotic, or its curve is strongly bent: change start)"
    )
    with pytest.raises(ValueError, match=f"^{told}$") as caught:
        rk.rotation_number(system(0.3, 2.0), rk.State(velocity=0.55), cycles=cycles)
    assert not isinstance(caught.value, rk.TooShort)


REFUSED = {
    "impacts that lose": (
        system(2.0, 1.0, 0.925),
        None,
        r"^restitution must be 1 for a rotation number \(no dissipation\); got 0\.925$",
    ),
    "braces that lose": (
        system(15.0, 2.0, braces=rk.Braces(1.0, 0.9)),
        None,
        r"^(braces\.restitution must be 1|a rotation number requires a motion without dissipation)",
    ),
    "overturning": (
        system(1.75, 2.0),
        None,
        "^the block must stay upright for a rotation number; it overturns",
    ),
    "rest": (
        system(0.5, 1.0),
        None,
        "^a rotation number requires a motion without dissipation; the block comes to rest$",
    ),
    "balance": (
        system(0.0, 1.0),
        rk.State(1.0),
        r"^too few impacts for a rotation number: 0 in 1,000 cycles \(increase cycles\)$",
    ),
}


@pytest.mark.parametrize("label", REFUSED)
def test_motion_that_loses_or_ends_is_refused_in_one_line(label):
    refused, start, message = REFUSED[label]
    with pytest.raises(ValueError, match=message):
        rk.rotation_number(refused, start, cycles=1_000)


def test_one_brace_hit_is_told_in_the_singular():
    braced = rk.System(rk.Harmonic(0.1, period=1.0), 0.9, rk.Braces(1.5))
    told = str(rk.rotation_number(braced, rk.State(1.3), cycles=5_000))
    assert told.startswith("locked: 1 brace hit in 2 cycles; free: ")
