"""Margin of a motion under a base acceleration of finite length, and whether rounding may have decided."""

import math
from fractions import Fraction
from itertools import pairwise

import attrs
import numpy as np
import pytest
from scipy.integrate import quad

import rocking as rk
from rocking.kernels.arc.arc import NO_EXTREMES, UNIT_RATE, Next, nothing_more, with_dip, with_low
from rocking.kernels.arc.slender_samples import arc_at_place
from rocking.kernels.base.samples import SampledDrive
from rocking.kernels.event_kinds import IMPACT
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.finite_motion import ENDING_ROW, RUN_ROW, is_decided, is_no_graze, run_batch
from rocking.kernels.motion.march import DONE, OVERTURNED
from rocking.kernels.motion.rounding_errors import Covariance
from rocking.motion.march_loop import parameters

# At the end of this motion the block is on its way back, with enough energy to overturn on the other side.
TURNING = rk.PiecewiseLinear([2.0, 2.0, 2.0, -12.0], step=0.25)


def constant_after(motion, event):
    """K₊ = v − 1 − σR(τ) after an event, with R by quadrature of the base acceleration."""
    base, time = motion.system.forcing, float(event["time"])
    places = np.append(base.step * np.arange(base.values.size), np.inf)
    places = np.concatenate(([time], places[(places > time) & np.isfinite(places)]))
    later = sum(
        quad(lambda x: math.exp(time - x) * base.acceleration(x), low, high, epsabs=1e-13)[0]
        for low, high in pairwise(places)
    )
    side = np.sign(event["after"]) or np.sign(motion.at(time + 1e-6)[0])
    return abs(float(event["after"])) - 1.0 - side * later


def random_system(seed, scale):
    values = np.random.default_rng(seed).uniform(-1, 1, 20)
    return rk.System(rk.PiecewiseLinear(values, step=0.25, scale=scale), restitution=0.7)


@pytest.mark.parametrize("seed", range(6))
def test_margin_is_the_least_constant_over_lift_offs_and_impacts(seed):
    motion = rk.simulate(random_system(seed, 2.0))
    moving = motion.events[
        (motion.events["kind"] == "lift-off")
        | ((motion.events["kind"] == "impact") & (np.abs(motion.events["after"]) > 1e-4))
    ]
    found = [constant_after(motion, event) for event in moving]
    nearest = int(np.argmin(np.abs(found)))
    assert abs(motion.margin) <= abs(found[nearest]) + 1e-11
    if motion.margin_time in moving["time"]:
        assert motion.margin == pytest.approx(found[nearest], abs=1e-11)
        assert motion.margin_time == moving["time"][nearest]
    else:  # within chattering, below the speed that is looked at here
        assert abs(motion.margin) < abs(found[nearest])


def test_margin_changes_its_sign_where_the_outcome_changes():
    """A rectangular pulse: K₊ = A (1 − exp(−T)) − 1 at the lift-off."""
    for amplitude in (1.2, 1.5, 1.6, 3.0):
        motion = rk.simulate(rk.System(rk.Pulse("rectangular", amplitude=amplitude, duration=1.0), 0.9))
        assert motion.margin == pytest.approx(-amplitude * math.expm1(-1.0) - 1.0, abs=1e-14)
        assert (motion.margin > 0) == (motion.outcome == "overturned")
        assert motion.margin_time == 0.0


@pytest.mark.parametrize(
    ("model", "offset", "sign"),
    [("slender", 0.0, 1), ("full", 0.0, -1), ("slender", 0.07, -1), ("full", 0.07, -1), ("full", 0.07, 1)],
)
def test_a_base_that_holds_the_acceleration_of_lift_off_is_undecided(model, offset, sign):
    """A rectangular pulse above g b/h that lasts overturns the block; one below leaves it at rest."""
    draws, close = np.random.default_rng(6), 0
    for _ in range(30):
        height, width = draws.uniform(1.0, 4.0), draws.uniform(0.4, 0.9)
        block = rk.Block(height, width, 0.8, offset=offset)
        lever = Fraction(width) + sign * 2 * Fraction(offset)
        level = Fraction(9.80665) * lever / Fraction(height)
        for relative in (0.0, 1e-16, 3e-16, 1e-14, 1e-12, 1e-6, 1e-3):
            for above in (1.0 + relative, 1.0 - relative):
                peak = float(level) * above
                pulse = rk.Pulse(
                    "rectangular", amplitude=sign * peak, duration=60.0 / block.frequency_parameter
                )
                motion = rk.simulate(block.system(pulse, model=model))
                expected = "overturned" if Fraction(peak) > level else "at-rest"
                assert motion.outcome == expected or not motion.certified
                assert motion.certified or relative < 1e-9
                close += not motion.certified
    assert close >= 60


@pytest.mark.parametrize(
    ("restitution", "braces", "duration"),
    [(1.0, None, None), (0.8, None, 0.3), (0.8, rk.Braces(0.5), None)],
    ids=["no loss", "in flight", "brace without loss"],
)
def test_a_lift_off_at_the_level_is_undecided_if_nothing_erases_it(restitution, braces, duration):
    """The pulse is below g b/h by 3e-17 of it, so that the block rests. Rounded, it is above."""
    block = rk.Block(3.5495968932856354, 0.6162474058275154, restitution)
    peak = 1.7025377258442675
    assert Fraction(peak) <= Fraction(9.80665) * Fraction(block.width) / Fraction(block.height)
    for factor, certified in ((1.0, False), (1.0 + 1e-9, True)):
        pulse = rk.Pulse("rectangular", amplitude=peak * factor, duration=2.0 / block.frequency_parameter)
        motion = rk.simulate(block.system(pulse, braces=braces, model="slender"), duration=duration)
        assert motion.outcome == "bounded"
        assert motion.certified is certified


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_record_that_holds_the_acceleration_of_lift_off_is_undecided(sign):
    for relative in (0.0, 2.0**-53, -(2.0**-53), 2.0**-52, -(2.0**-52), 2.0**-50, 1e-6, -1e-6):
        level = 1.0 + relative
        base = rk.PiecewiseLinear([0.0, 0.3, *[sign * level] * 100], step=0.6)
        motion = rk.simulate(rk.System(base, restitution=0.8))
        assert motion.outcome == ("overturned" if level > 1.0 else "at-rest") or not motion.certified
        assert motion.certified == (abs(relative) == 1e-6)


def test_a_crest_that_equals_lift_off_leaves_the_block_at_rest():
    """Such a level is usual: 0.3 g of a block of 2 m × 0.6 m."""
    block = rk.Block(2.0, 0.6)
    for ground in rk.synthetic_ground_motions(4, seed=1):
        for model in ("slender", "full"):
            motion = rk.simulate(block.system(ground.scaled(0.3 * 9.80665 / ground.pga), model=model))
            assert (motion.outcome, motion.certified) == ("at-rest", True)
    for level in (1.0 - 2.0**-53, 1.0):
        half_sine = rk.Pulse("half-sine", amplitude=level, duration=3.0)
        motion = rk.simulate(rk.System(half_sine, restitution=0.8))
        assert (motion.outcome, motion.certified) == ("at-rest", True)


def test_a_block_that_never_moves_has_no_margin():
    motion = rk.simulate(rk.System(rk.PiecewiseLinear([0.0, 0.9, -0.9, 0.0], step=0.3), 0.9))
    assert math.isnan(motion.margin)
    assert math.isnan(motion.margin_time)
    assert motion.certified
    assert "margin" not in str(motion)


def test_a_motion_on_the_threshold_is_undecided():
    amplitude = -1 / math.expm1(-1.0)
    motions = [
        rk.simulate(
            rk.System(rk.Pulse("rectangular", amplitude=amplitude * (1 + k * 2.0**-52), duration=1.0), 0.9)
        )
        for k in (-2, 0, 2)
    ]
    assert not any(motion.certified for motion in motions)
    assert all("(undecided in double precision)" in str(motion) for motion in motions)
    away = rk.simulate(
        rk.System(rk.Pulse("rectangular", amplitude=amplitude * (1 + 1e-12), duration=1.0), 0.9)
    )
    assert away.certified
    assert away.outcome == "overturned"


def test_a_graze_of_the_base_is_undecided():
    """The base stops a block in the middle of its way, so that its angle has a minimum: near 0 rounding decides on an impact."""

    def found(second):
        base = rk.PiecewiseLinear([1.5, 1.5, -second, -second, 2.5, 2.5, 0.0], step=0.35)
        return rk.simulate(rk.System(base, 0.9))

    low, high = 0.0, 6.0  # no impact before the last push, and one
    first = [
        rk.simulate(
            rk.System(rk.PiecewiseLinear([1.5, 1.5, -s, -s, 2.5, 2.5, 0.0], step=0.35), 0.9), duration=1.8
        ).impacts
        for s in (low, high)
    ]
    assert first[0] == 0 < first[1]
    for _ in range(60):
        middle = (low + high) / 2
        base = rk.PiecewiseLinear([1.5, 1.5, -middle, -middle, 2.5, 2.5, 0.0], step=0.35)
        impacts = rk.simulate(rk.System(base, 0.9), duration=1.8).impacts
        low, high = (middle, high) if impacts == 0 else (low, middle)
    assert not found(low).certified
    assert found(low - 1e-3).certified


@kernel
def decided_with(p, low, variance_at_start, variance_at_event):
    arc = arc_at_place(p, 1, 0.0, 0.0, 2.0, SampledDrive(0, 0.0))
    extremes = with_low(NO_EXTREMES, low)
    at_start, at_event = Covariance(variance_at_start, 0.0, 0.0), Covariance(variance_at_event, 0.0, 0.0)
    coming = nothing_more(1, arc.drive)
    return is_decided(p, arc, coming, extremes, UNIT_RATE, at_start, at_event)


@kernel
def decided_with_dips(p, first, first_time, second, second_time, variance):
    arc = arc_at_place(p, 1, 0.0, 0.0, 2.0, SampledDrive(0, 0.0))
    extremes = with_dip(with_dip(NO_EXTREMES, first, first_time), second, second_time)
    covariance = Covariance(variance, 0.0, variance)
    return is_decided(p, arc, nothing_more(1, arc.drive), extremes, UNIT_RATE, covariance, covariance)


def test_each_minimum_of_an_arc_must_exceed_the_error_there():
    """Errors grow like e^t, so that a minimum that is not the least may be the one that is undecided."""
    p = parameters(rk.System(rk.PiecewiseLinear([0.0, 0.0], step=0.1), 0.9))
    least = 1e-6
    deviation = least / 64
    assert decided_with_dips(p, least, 0.0, least, 0.0, deviation**2)
    assert not decided_with_dips(p, least, 0.0, 2 * least, 3.0, deviation**2)
    assert not decided_with_dips(p, 2 * least, 3.0, least, 0.0, deviation**2)
    assert decided_with_dips(p, least, 0.0, 100 * least, 3.0, deviation**2)


@kernel
def surely_met(p, slender, side, speed, of_angle, of_velocity):
    arc = arc_at_place(slender, side, 0.0, 0.0, 2.0, SampledDrive(0, 0.0))
    coming = Next(0.05, IMPACT, side, 0.0, -speed, SampledDrive(0, 0.05), 0.0, 0.0)
    return is_no_graze(p, arc, coming, Covariance(of_angle**2, 0.0, of_velocity**2))


@pytest.mark.parametrize(("side", "left"), [(1, None), (-1, rk.LeftSide(4.0, 0.75, 0.9))])
def test_impact_that_only_touches_the_base_is_undecided(side, left):
    """The ground pushes the block off with u'' = 2, so that it would have sunk by v^2/4, both in the units of its side."""
    slender = parameters(rk.System(rk.PiecewiseLinear([-3.0, -3.0], step=0.1), 0.9))
    p = slender
    if left is not None:
        p = parameters(rk.System(rk.PiecewiseLinear([12.0, 12.0], step=0.1), 0.9, left=left))
    speed, unit = 1e-3, 1.0 if left is None else left.angle_ratio * left.frequency_ratio
    depth = speed**2 / 4
    for error, sure in ((1 / 32.03, True), (1 / 31.97, False)):
        assert surely_met(p, slender, side, speed * unit, depth * error, 0.0) is sure
        assert surely_met(p, slender, side, speed * unit, 0.0, speed * error) is sure
    falling = parameters(rk.System(rk.PiecewiseLinear([0.0, 0.0], step=0.1), 0.9, left=left))
    assert surely_met(falling, slender, side, speed * unit, depth, speed)


def test_angle_that_rounding_may_have_taken_below_the_base_is_undecided():
    p = parameters(rk.System(rk.PiecewiseLinear([0.0, 0.0], step=0.1), 0.9))
    far, near = (1e-3 / (32 * factor) for factor in (1.001, 0.999))
    assert decided_with(p, 1e-3, far**2, far**2)
    assert not decided_with(p, 1e-3, near**2, far**2)
    assert not decided_with(p, 1e-3, far**2, near**2)
    assert decided_with(p, math.inf, near**2, near**2)


def test_without_losses_the_energy_after_the_base_motion_decides():
    for amplitude, outcome in ((1.5, "bounded"), (1.7, "overturned")):
        system = rk.System(rk.Pulse("rectangular", amplitude=amplitude, duration=1.0), 1.0)
        motion = rk.simulate(system)
        assert motion.outcome == outcome
        assert motion.certified
    assert rk.simulate(rk.System(TURNING, 1.0)).outcome == "overturned"


@pytest.mark.parametrize("want_peak", [False, True])
def test_in_a_batch_without_losses_the_energy_decides(want_peak):
    assert batch(TURNING, [0.8, 1.0], 1.0, want_peak)["status"].tolist() == [DONE, OVERTURNED]
    assert rk.simulate(rk.System(attrs.evolve(TURNING, scale=0.8), 1.0)).outcome == "bounded"


def batch(base, scales, restitution, want_peak=True):
    """Return the ``Ending`` of each scale of a base motion, as a row."""
    rows, runs = np.empty(len(scales), ENDING_ROW), np.zeros(len(scales), RUN_ROW)
    runs["scale"], runs["restitution"] = scales, restitution
    run_batch(parameters(rk.System(base, restitution)), runs, want_peak, rows, np.zeros(1, np.int64))
    return rows


@pytest.mark.parametrize("restitution", [0.7, 1.0])
def test_a_batch_of_scales_ends_like_single_motions(restitution):
    values = np.random.default_rng(8).uniform(-1, 1, 20)
    base = rk.PiecewiseLinear(values, step=0.25)
    scales = np.linspace(1.02, 8.0, 60) / np.abs(values).max()
    fallen = same = 0
    for scale, row in zip(scales, batch(base, scales, restitution), strict=True):
        motion = rk.simulate(rk.System(attrs.evolve(base, scale=float(scale)), restitution))
        assert (row["status"] == OVERTURNED) == (motion.outcome == "overturned")
        assert bool(row["decided"]) == motion.certified
        # the impacts that are cut short do not count for the margin
        assert abs(row["margin"]) >= abs(motion.margin) * (1.0 - 1e-9)
        same += row["margin_time"] == pytest.approx(motion.margin_time, rel=1e-9)
        if motion.outcome == "at-rest":
            assert row["peak"] == pytest.approx(motion.peak, rel=1e-12)
        fallen += motion.outcome == "overturned"
    assert 0 < fallen < len(scales)
    assert same > 0.8 * len(scales)


def test_duration_limits_the_margin():
    system = random_system(3, 2.0)
    whole = rk.simulate(system)
    part = rk.simulate(system, duration=0.5 * whole.margin_time)
    assert not part.margin_time > part.duration
    assert not abs(part.margin) < abs(whole.margin)
