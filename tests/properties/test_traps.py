"""Known faults of event-driven marches of this system, one test each."""

import math

import numpy as np
import pytest

import rocking as rk
from oracles.motion import simulate as brute_force
from rocking.kernels import event_kinds
from rocking.kernels.arc import first_zero_cosine
from rocking.kernels.arc.slender_cosine import arc_from
from rocking.kernels.block import rest
from rocking.kernels.system import harmonic_parameters


def _case(A, T, e, N, phi=0.0, start=(0.0, 0.0), brace=None, r=None):
    return {
        "A": A,
        "T": T,
        "e": e,
        "N": N,
        "phi": phi,
        "Theta0": start[0],
        "dTheta0": start[1],
        "brace": brace,
        "r": r,
    }


def _motion(case, record="all"):
    braces = None if case["brace"] is None else rk.Braces(case["brace"], case["r"])
    forcing = rk.Harmonic(amplitude=case["A"], period=case["T"], phase=case["phi"])
    start = rk.State(case["Theta0"], case["dTheta0"])
    return rk.simulate(rk.System(forcing, case["e"], braces), start, cycles=case["N"], record=record)


def _error(motion, exact):
    return max(
        abs(motion.final.angle - float(exact.angle)), abs(motion.final.velocity - float(exact.velocity))
    )


def test_a_second_dip_is_not_missed_after_a_first_that_clears_the_base():
    """From rest a dip comes close to the base, clears it, and the next one does not."""
    case = _case(10.412698412698411, 1.7111111111111108, 0.925, 20)
    motion, exact = _motion(case), brute_force(case)
    assert motion.impacts == exact.counts["impact"]
    assert _error(motion, exact) <= 1e-12 * exact.growth


def test_chatter_is_cut_by_proof_long_before_it_is_slow():
    """A = 1.016, where rest ends every half cycle: without events to keep, a few impacts a rest; followed on, hundreds."""
    case = _case(1.016, 1.0, 0.925, 50)
    bare, kept = _motion(case, "none"), _motion(case)
    rests = int(np.sum(kept.events["kind"] == "rest"))
    assert rests == 100
    assert kept.impacts > 200 * rests
    assert bare.impacts < 100 * rests
    assert (bare.final.angle, bare.final.velocity) == pytest.approx(
        (kept.final.angle, kept.final.velocity), abs=1e-15
    )


@pytest.mark.long
def test_chatter_cut_short_forgets_nothing_but_the_instant_of_rest():
    """With and without events to keep, the state after a rest is the same, to the last digits."""
    for amplitude in (1.02, 1.1, 1.3):
        case = _case(amplitude, 0.7, 0.6, 9, phi=0.2)
        exact = brute_force(case)
        for record in ("all", "section", "none"):
            assert _error(_motion(case, record), exact) <= 1e-14 * max(1.0, exact.growth)


@pytest.mark.parametrize(("phase", "start"), [(0.0, "at once"), (1.4, "after a wait"), (4.0, "after a wait")])
def test_lift_off_is_exact_not_a_nudge_of_the_clock(phase, start):
    """A nudge of 1e-9 to get off the base would show in the ninth digit."""
    case = _case(1.7, 1.1, 0.5, 1, phi=phase)
    exact = brute_force(case)
    assert (exact.counts["lift-off"] > 0) == (start == "after a wait")
    assert _error(_motion(case), exact) <= 1e-15 * max(1.0, exact.growth)


@pytest.mark.parametrize("amplitude", [2.5, 5.0, 20.0])
@pytest.mark.parametrize("ulps", range(-4, 5))
def test_rest_at_the_very_end_of_a_push_is_rest(amplitude, ulps):
    """From rest as f turns negative, to the last digits: a cut rounded to no time at all once let the block fall through the base."""
    end = -math.acos(-1.0 / amplitude)
    phase = end + ulps * math.ulp(end)
    motion = _motion(_case(amplitude, 1.0, 0.5, 1, phi=phase))
    later = _motion(_case(amplitude, 1.0, 0.5, 1, phi=end + 1e-9))
    assert abs(motion.final.angle - later.final.angle) < 1e-7
    assert abs(motion.final.velocity - later.final.velocity) < 1e-7


def test_who_comes_back_to_a_brace_before_the_clock_has_moved_waits_for_the_next_release():
    """It left at the very end of a release. If it left again at once, impact and departure would alternate at one instant."""
    period, phase, found = 2.8376377022183688, -5.648354866652905, 0
    for amplitude in 0.5000000004857583 + 1e-12 * np.arange(-20, 20):
        p = harmonic_parameters(amplitude, 2.0 * math.pi / period, period, phase, 0.5, 1.5, 0.0)
        last, beyond = 2.55095190, 2.55095391
        assert not rest.stays_leaning(p, arc_from(p, 1, last, 1.5, 0.0))
        assert rest.stays_leaning(p, arc_from(p, 1, beyond, 1.5, 0.0))
        while beyond - last > math.ulp(last):
            start = 0.5 * (last + beyond)
            stays = rest.stays_leaning(p, arc_from(p, 1, start, 1.5, 0.0))
            last, beyond = (last, start) if stays else (start, beyond)
        arc = arc_from(p, 1, last, 1.5, 0.0)
        coming = first_zero_cosine.any_event(p, event_kinds.FLIGHT, arc)
        assert coming.event == event_kinds.BRACE
        if last + coming.wait == last:
            found += 1
            assert first_zero_cosine.any_event(p, event_kinds.LEAN, arc).wait > 0.99 * period
    assert found > 0


@pytest.mark.parametrize("amplitude", [0.0, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("record", ["all", "section", "none"])
def test_a_block_shaken_too_weakly_to_lift_can_still_overturn(amplitude, record):
    """A ≤ 1 has no stretch boundary: without a test for it the state would run to infinity unnoticed."""
    motion = _motion(_case(amplitude, 1.0, 0.9, 2000, start=(0.2, 2.0)), record)
    assert motion.outcome is rk.Outcome.OVERTURNED
    assert motion.cycles <= 3
    assert math.isfinite(motion.final.angle)
    assert math.isfinite(motion.final.velocity)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("turning", ["inward", "outward"])
@pytest.mark.parametrize("velocity", [1e-12, 1e-9, 1e-5])
def test_hops_from_a_stretch_boundary_keep_the_order_of_events(side, turning, velocity):
    """Starts at 1 + σA cos φ = 0: one impact after another comes from the other side, with e times the speed."""
    for shift in range(-3, 4):
        phase = math.acos(-side / 3.0) * (side if turning == "outward" else -side)
        events = _motion(
            _case(3.0, 1.0, 0.9, 3, phi=phase + shift * math.ulp(phase), start=(0.0, side * velocity))
        ).events
        assert (np.diff(events["time"]) >= 0).all()
        impact = events["kind"] == "impact"
        going_on = impact[:-1] & impact[1:]
        hops = events[:-1][going_on]
        assert len(hops) > 0
        assert (np.sign(hops["after"]) == -np.sign(events["before"][1:][going_on])).all()
        np.testing.assert_allclose(hops["after"], 0.9 * hops["before"], rtol=1e-15)


def test_fast_shaking_over_long_flights():
    """Hundreds of forcing cycles within one flight, and the impact at its end."""
    case = _case(30.0, 0.04, 0.8, 150, start=(0.7, 0.3))
    motion, exact = _motion(case), brute_force(case)
    assert motion.impacts == exact.counts["impact"]
    assert _error(motion, exact) <= 1e-12 * exact.growth


def test_overturning_is_proved_where_brute_force_sees_it_and_nowhere_else():
    """Thirty systems from rest, about half of which overturn: the same outcome after the same impacts."""
    rng = np.random.default_rng(4)
    overturned = 0
    for _ in range(30):
        period = round(float(rng.uniform(0.3, 3.0)), 3)
        amplitude = round(float(rng.uniform(0.3, 0.9) * (1 + (2 * math.pi / period) ** 2)), 3)
        case = _case(amplitude, period, float(rng.choice([0.5, 0.8, 0.925])), 15)
        # the brute-force run lets an overturning block go far before it says so
        motion, exact = _motion(case, "none"), brute_force(case | {"N": 15 + math.ceil(12 / period)})
        if not exact.overturned:
            assert motion.outcome is not rk.Outcome.OVERTURNED, case
        elif motion.outcome is rk.Outcome.OVERTURNED:
            assert motion.impacts == exact.counts["impact"], case
            overturned += 1
        else:
            assert exact.counts["impact"] >= motion.impacts, case  # it happens after the last cycle requested
    assert overturned >= 8
