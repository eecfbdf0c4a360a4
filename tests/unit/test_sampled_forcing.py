"""Motions under a base acceleration that is linear between samples."""

import inspect
import json
import math
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from oracles import sampled

CASES = json.loads((Path(__file__).parents[1] / "data" / "record_impacts.json").read_text())["synthetic"]
OUTCOMES = {"rest": "at-rest", "overturned": "overturned"}


def system_of(case, scale=1.0, **more):
    values = np.array(case["samples"]) * case["scale"]
    forcing = rk.PiecewiseLinear(values, step=case["step"], scale=scale)
    return rk.System(forcing, restitution=case["restitution"], **more)


def impacts_of(motion):
    """Times and speeds of the impacts faster than 1e-3."""
    events = motion.events[motion.events["kind"] == "impact"]
    events = events[np.abs(events["before"]) > 1e-3]
    return np.column_stack((events["time"], np.abs(events["before"])))


@pytest.mark.parametrize("case", CASES)
def test_impacts_are_those_of_fifty_digits(case):
    motion = rk.simulate(system_of(case))
    wanted = np.array([[float(number) for number in impact] for impact in case["impacts"]]).reshape(-1, 2)
    got, moved = (
        impacts_of(rk.simulate(system_of(case, scale)))[: len(wanted)] for scale in (1.0, 1.0 + 1e-9)
    )
    assert len(got) == len(wanted)
    assert motion.outcome == OUTCOMES[case["outcome"]]
    # The growth of an error is that of a small change of the scale, but for runs that such a change turns into another.
    if len(moved) == len(got) > 0:
        growth = np.maximum.accumulate(np.abs(moved - got).max(axis=1) / 1e-9)
        assert (np.abs(got - wanted).max(axis=1) <= 1e-12 * np.maximum(growth, 1.0)).all()


@pytest.mark.parametrize(
    ("duration", "edge"), [(0.3, 3.858295913510), (1.0, 1.581976706869), (4.0, 1.018657360364)]
)
def test_rectangular_pulse_overturns_beyond_its_threshold(duration, edge):
    """A > 1/(1 - exp(-T)), which is the condition of Housner (1963), eq. (9)."""
    assert edge == pytest.approx(-1.0 / math.expm1(-duration), abs=1e-12)
    for amplitude, outcome in ((edge - 1e-10, "at-rest"), (edge + 1e-10, "overturned")):
        base = rk.PiecewiseLinear([amplitude, amplitude], step=duration)
        assert rk.simulate(rk.System(base, restitution=0.9)).outcome == outcome


def test_scale_and_sign_are_those_of_the_samples():
    case = CASES[4]
    whole, half = rk.simulate(system_of(case)), rk.simulate(system_of(case, -1.0))
    assert (whole.impacts, whole.peak, whole.duration) == (half.impacts, half.peak, half.duration)
    assert (whole.events["before"] == -half.events["before"]).all()


@pytest.mark.parametrize("braces", [None, rk.Braces(angle=0.6, restitution=0.8)])
@pytest.mark.parametrize("seed", range(4))
def test_motion_is_that_of_the_equation_of_motion(seed, braces):
    """Against Taylor series of the equation of motion in 50 digits, from rest and from a tilt."""
    random = np.random.default_rng(seed)
    values = 2.5 * random.uniform(-1, 1, 12)
    angle, velocity = (0.0, 0.0) if seed % 2 else (0.3, -0.2)
    found = rk.simulate(
        rk.System(rk.PiecewiseLinear(values, step=0.2), restitution=0.8, braces=braces),
        rk.State(angle, velocity),
        duration=2.5,
    )
    brace = None if braces is None else (braces.angle, braces.restitution)
    wanted, _ = sampled.motion(
        values, 0.2, 0.8, angle=angle, velocity=velocity, brace=brace, until=sampled.mp.mpf(2.5)
    )
    wanted = [
        (float(time), float(speed), at_brace)
        for time, speed, at_brace in wanted
        if time < 2.5 and speed > 1e-3
    ]
    events = found.events[
        np.isin(found.events["kind"], ("impact", "brace")) & (np.abs(found.events["before"]) > 1e-3)
    ]
    assert len(events) == len(wanted)
    assert (events["kind"] == "brace").tolist() == [at_brace for *_, at_brace in wanted]
    times, speeds, _ = zip(*wanted, strict=True)
    assert events["time"] == pytest.approx(times, rel=0, abs=1e-11)
    assert np.abs(events["before"]) == pytest.approx(speeds, rel=0, abs=1e-11)


@pytest.mark.timeout(60)
@pytest.mark.parametrize("angle", [1.45, 1.5768959017160942, 1.7338105128882424])
def test_chattering_at_a_brace_beyond_the_base_motion_ends(angle):
    """Speeds at the brace fall by the factor of its restitution: a difference of energies would lose their digits."""
    braces = rk.Braces(angle=angle, restitution=0.8)
    system = rk.System(rk.PiecewiseLinear([0.0], step=0.1), restitution=0.9, braces=braces)
    motion = rk.simulate(system, rk.State(angle - 0.01, 0.5))
    assert motion.outcome == "at-rest"
    speeds = motion.events["before"][motion.events["kind"] == "brace"]
    assert len(speeds) > 100
    # Each arc keeps the energy v^2 - (u - 1)^2.
    assert speeds[1:] == pytest.approx(0.8 * speeds[:-1], rel=1e-9, abs=1e-14)


def test_states_between_events_and_peaks_belong_together():
    motion = rk.simulate(system_of(CASES[20]))
    times = np.linspace(0.0, motion.duration, 4001)
    angle, velocity = motion.at(times)
    assert motion.peak == pytest.approx(np.abs(motion.peaks["angle"]).max(), rel=1e-15)
    assert np.abs(angle).max() <= motion.peak
    assert np.abs(motion.at(motion.peaks["time"])[1]).max() < 1e-12
    base = motion.system.forcing.acceleration(times)
    turning = np.where(angle != 0.0, angle - np.sign(angle) - base, 0.0)
    moving = np.abs(angle) > 1e-9
    assert motion.acceleration(times)[moving] == pytest.approx(turning[moving], rel=0, abs=1e-11)
    assert velocity[angle == 0.0] == pytest.approx(0.0, abs=0.0)


def test_motion_without_losses_ends_with_the_base_motion():
    base = rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.0], step=0.4)
    motion = rk.simulate(rk.System(base, restitution=1.0))
    assert (str(motion.outcome), motion.duration) == ("bounded", pytest.approx(base.duration))


def test_duration_cuts_and_prolongs():
    system = rk.System(rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.0], step=0.4), restitution=0.9)
    whole = rk.simulate(system)
    short, long = rk.simulate(system, duration=1.0), rk.simulate(system, duration=100.0)
    assert (short.duration, long.duration) == (pytest.approx(1.0), pytest.approx(100.0))
    assert short.at(0.9) == pytest.approx(whole.at(0.9), abs=1e-15)
    assert (str(long.outcome), long.impacts) == ("at-rest", whole.impacts)


@pytest.mark.parametrize("values", [[3.0], [0.0] * 5, [0.0, 0.0, 40.0, 0.0, 0.0]])
def test_few_and_odd_samples_are_a_base_motion_too(values):
    outcome = rk.simulate(rk.System(rk.PiecewiseLinear(values, step=0.5), restitution=0.9)).outcome
    assert outcome == ("overturned" if max(values) > 10 else "at-rest")


SYSTEM = rk.System(rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.0], step=0.4), restitution=0.9)
OF_A_SYSTEM = sorted(
    name
    for name in rk.__all__
    if inspect.isfunction(getattr(rk, name))
    and next(iter(inspect.signature(getattr(rk, name)).parameters), "") == "system"
)
WITHOUT_A_PERIOD = {"simulate", "overturning_spectrum"}
MORE = {
    "bifurcation_set": {"max_period": 1, "period": (1.0, 2.0), "amplitude": (1.0, 2.0)},
    "basin_map": {"angle": [0.0, 0.1], "velocity": [0.0, 0.1]},
    "orbit_diagram": {"amplitude": [1.0, 2.0]},
    "response_diagram": {"amplitude": [1.0, 2.0]},
    "frequency_response": {"period": [1.0, 2.0]},
    "safe_basin": {"amplitude": [1.0, 2.0]},
    "find_orbit": {"guess": rk.State(), "period": 1},
    "find_orbits": {"max_period": 1},
}


@pytest.mark.parametrize("name", [name for name in OF_A_SYSTEM if name not in WITHOUT_A_PERIOD])
def test_what_needs_a_period_refuses_a_finite_base_motion_and_names_what_answers(name):
    with pytest.raises(
        TypeError, match=r"^system must have a periodic base motion.*rk\.simulate.*"
    ) as caught:
        getattr(rk, name)(SYSTEM, **MORE.get(name, {}))
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(("amplitude", "period", "restitution"), [(2.0, 1.0, 0.925), (4.0, 3.0, 0.8)])
def test_a_sampled_cosine_converges_to_the_harmonic_base_at_second_order(amplitude, period, restitution):
    """Largest error of times and of speeds of the first impacts, before chaos amplifies it."""
    harmonic = rk.System(rk.Harmonic(amplitude, period=period), restitution=restitution)
    wanted = impacts_of(rk.simulate(harmonic, cycles=6))[:5]
    errors = []
    for samples in (128, 256, 512):
        cosine = amplitude * np.cos(2.0 * math.pi * np.arange(6 * samples + 1) / samples)
        base = rk.PiecewiseLinear(cosine, step=period / samples)
        found = impacts_of(rk.simulate(rk.System(base, restitution=restitution)))[: len(wanted)]
        errors.append(np.abs(found - wanted).max(axis=0))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert len(wanted) >= 3
    assert rates == pytest.approx(2.0, rel=0, abs=0.1)
