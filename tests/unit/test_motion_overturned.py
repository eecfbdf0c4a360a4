"""The run of an overturned motion ends at the proof; figures follow the fall to |Θ| = 3; all values are finite."""

import csv
import math
import re

import mpmath
import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.explorer import texts
from rocking.motion.motion import end_shown

SLOW = rk.System(rk.Harmonic(amplitude=2.0, period=1000.0), restitution=0.9)
"""Its cycle of overturning goes on far beyond e^709, the largest power that is a float."""
USUAL = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
CASES = {
    "slow": (SLOW, rk.State()),
    "usual": (USUAL, rk.State()),
    "slow, past return from the start": (SLOW, rk.State(angle=500.0)),
    "at once": (SLOW, rk.State(angle=2.0, velocity=3.0)),
}


@pytest.fixture(params=CASES)
def motion(request):
    system, start = CASES[request.param]
    return rk.simulate(system, start, cycles=50)


def test_run_ends_at_the_proof_and_its_end_and_peak_are_the_motions(motion):
    assert motion.duration == motion.overturning.time <= motion.cycles * motion.system.forcing.period
    end = motion.at(motion.duration)
    np.testing.assert_allclose(end, (motion.final.angle, motion.final.velocity), rtol=1e-11, atol=0)
    times = np.concatenate([np.linspace(0.0, motion.duration, 20_001), motion.peaks["time"]])
    largest = np.abs(motion.at(times)[0]).max()
    assert motion.peak == pytest.approx(largest, rel=1e-9, abs=0)


def test_all_values_of_the_run_are_finite(motion):
    times = np.linspace(0.0, motion.duration, 1001)
    for values in (*motion.at(times), motion.acceleration(times)):
        assert np.isfinite(values).all()
    for block in (None, rk.Block(2.0, 0.5)):
        for step in (None, 0.01):
            dataset = motion.to_xarray(step=step, block=block)
            assert dataset["time"][0] == 0.0
            assert all(np.isfinite(dataset[name]).all() for name in dataset if name != "event_kind")


def test_samples_end_at_the_last_step_before_the_block_has_fallen_to_three_critical_angles():
    for system in (SLOW, USUAL):
        motion = rk.simulate(system)
        samples = motion.to_xarray(step=0.01)
        last = float(samples["time"][-1])
        assert last > motion.overturning.time
        assert abs(motion.at(last)[0]) <= 3.0 < abs(motion.at(last + 0.01)[0])
        assert np.abs(samples["angle"]).max() <= 3.0
    beyond = rk.simulate(SLOW, rk.State(angle=500.0))
    assert float(beyond.to_xarray(step=0.01)["time"][-1]) == beyond.overturning.time // 0.01 * 0.01


def test_fall_after_the_proof_is_the_closed_form_while_it_is_a_float():
    motion = rk.simulate(SLOW)
    side, omega = -1, SLOW.forcing.frequency  # the base pushes it over to the left
    with mpmath.workdps(400):
        for time in (1.0, 10.0, 700.0):
            t, beta = mpmath.mpf(time), 2 / (1 + mpmath.mpf(omega) ** 2)
            exact = -side * (mpmath.cosh(t) - 1) + beta * (mpmath.cos(omega * t) - mpmath.cosh(t))
            assert float(motion.at(time)[0]) == pytest.approx(float(exact), rel=1e-12, abs=0)
    assert math.isfinite(motion.at(709.0)[0])
    told = r"^times must lie in the run, \[0, 0.881374\], or little later, while the angle is within the range of floats; got 900.0$"
    for ask in (motion.at, motion.acceleration):
        with pytest.raises(ValueError, match=told):
            ask([1.0, 900.0, 1000.0])


@pytest.mark.parametrize("time", [-1.0, math.inf, -math.inf, math.nan])
@pytest.mark.parametrize("system", [USUAL, rk.System(rk.Harmonic(amplitude=0.5, period=1.0), 0.9)])
def test_times_of_a_motion_that_goes_on_after_its_run_are_refused_in_plain_words(system, time):
    with pytest.raises(ValueError, match=rf"^times must be finite and at least 0; got {time}$"):
        rk.simulate(system).at([1.0, time])


def test_files_hold_the_run_and_no_infinity(rocking, tmp_path):
    for line in ("--period 1000", "--period 2 --amplitude 1.75 --restitution 0.95"):
        code, _, out = rocking(
            f"simulate --amplitude 2 --restitution 0.9 {line} --csv fall.csv --netcdf fall.nc --plot fall.png"
        )
        assert (code, "inf" in out) == (0, False)
        with (tmp_path / "fall.csv").open(encoding="utf-8") as file:
            values = np.array(list(csv.reader(file))[1:], float)
        assert np.isfinite(values).all()
        assert np.abs(values[:, 1]).max() <= 3.0 + 1e-12
        with xr.open_dataset(tmp_path / "fall.nc", engine="h5netcdf") as dataset:
            assert values[:, 0].tolist() == dataset["time"].values.tolist()
            assert values[:, 1].tolist() == dataset["angle"].values.tolist()
            assert all(np.isfinite(dataset[name]).all() for name in ("angle", "velocity", "acceleration"))


def test_what_is_summed_up_says_the_same_end(rocking):
    out = rocking("simulate --amplitude 1.75 --period 2 --restitution 0.95")[2]
    motion = rk.simulate(USUAL)
    assert re.search(rf"^simulated +6 cycles, τ = {motion.overturning.time:.6g}$", out, re.MULTILINE)
    assert f"(proved at τ = {motion.overturning.time:.6g}, in the 6th cycle)" in out


def test_largest_angle_is_said_only_of_a_block_that_stands(rocking):
    """An overturned block has passed every angle; the largest one before overturning was certain reads as if it had not."""
    block, verdict = rk.Block(2.0, 0.5), rk.classify(USUAL)
    told = (
        block.system(acceleration=4.5, frequency_hz=0.5),
        "--height 2 --width 0.5 --acceleration 4.5 --frequency-hz 0.5",
    )
    for system, options in ((USUAL, "--amplitude 1.75 --period 2 --restitution 0.95"), told):
        motion = rk.simulate(system)
        facts = [name for name, _ in texts.verdict(verdict, block)["facts"]]
        commands = [rocking(f"{name} {options}")[2] for name in ("simulate", "classify")]
        for text in (str(motion), str(motion.validity(block)), *commands):
            at = f"t = {block.seconds(motion.overturning.time):.4g} s"
            assert f"τ = {motion.overturning.time:.6g}" in text or (system.block and at in text)
            assert not re.search("largest|peak", text)
        assert not any("largest" in name for name in facts)
    stands = rk.simulate(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925))
    assert "peak |Θ|" in str(stands)
    assert "largest angle" in str(stands.validity(block))


def test_a_fall_within_the_first_cycle_has_a_hundred_samples():
    """The forcing's period may be a thousand times as long as the fall."""
    times = rk.simulate(SLOW).to_xarray().time.values
    assert len(times) == 101
    assert abs(rk.simulate(SLOW).at(times[-1])[0]) == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize("amplitude, period", [(12.0, 1.5), (6.0, 3.0)])
def test_full_block_is_shown_until_it_lies_flat_also_if_that_is_certain_only_later(amplitude, period):
    system = rk.System(rk.Harmonic(amplitude, period=period, phase=3.0), 0.9, critical_angle=0.9)
    motion = rk.simulate(system)
    assert motion.outcome == "overturned"
    assert abs(motion.final.angle) * 0.9 > 0.5 * math.pi
    end = end_shown(motion)
    angles = np.abs(motion.at(np.linspace(0.0, end, 500))[0]) * 0.9
    assert angles[-1] == pytest.approx(0.5 * math.pi, abs=1e-9)
    assert angles.max() <= 0.5 * math.pi + 1e-9


@pytest.mark.parametrize(
    "model, pga, expected",
    [
        ("slender", 1.0, "stands still"),
        ("slender", 9.81, "comes to rest"),
        ("slender", 1.2 * 9.80665, r"overturns, drawn to 3 $\theta_\mathrm{cr}$"),
        ("full", 13.0, "overturns, lies flat at the end"),
    ],
)
def test_figure_of_a_record_states_the_outcome(model, pga, expected):
    block, record = rk.Block(2.0, 0.5), rk.example_ground_motion()
    motion = rk.simulate(block.system(record.scaled(pga=pga), model=model, normalised_by="angle"))
    assert rk.plot.time_history(motion, block=block).get_title("right") == expected


def test_figure_of_a_restrained_block_is_drawn_in_units_of_its_balance():
    block = rk.Block(2.0, 0.4).restrained(9e4, 1200.0, mass=600.0)
    motion = rk.simulate(block.system(rk.example_ground_motion().scaled(pga=20.0), model="slender"))
    said = rk.plot.time_history(motion, block=block).get_title("right")
    assert said == r"overturns, drawn to 3 $\theta_\mathrm{u}$"
    labels = [ax.get_xlabel() + ax.get_ylabel() for ax in rk.plot.overview(motion, block=None).axes]
    assert all(r"\theta/\theta_\mathrm{u}" in label for label in labels[::2])
    assert r"\tau = \alpha\sqrt{1 - \kappa}\,t" in labels[1]
    assert r"$(1 + \rho)\,g\,\tan\theta_\mathrm{cr}$" in labels[1]
    (last,) = rk.plot.overview(rk.simulate(motion.system, record="none"), block=None).axes
    assert r"\theta/\theta_\mathrm{u}" in last.get_xlabel()
