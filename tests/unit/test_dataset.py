"""Motions as datasets: sizes, units, names, and a round trip through a file."""

import math

import numpy as np
import pytest
import xarray as xr

from rocking import Block, Braces, Harmonic, PiecewiseLinear, Pulse, State, System, __version__, simulate

BLOCK = Block(height=2.0, width=0.5)
BRACED = System(
    Harmonic(amplitude=15.0, period=2.0, phase=0.3),
    restitution=0.925,
    braces=Braces(angle=1.0, restitution=0.8),
)
START = State(angle=0.1, velocity=-0.2)


@pytest.fixture(scope="module")
def motion():
    return simulate(BRACED, START, cycles=5)


@pytest.fixture(scope="module")
def normalised(motion):
    return motion.to_xarray()


@pytest.fixture(scope="module")
def physical(motion):
    return motion.to_xarray(block=BLOCK)


def test_samples_are_the_motion_a_hundred_to_a_period(motion, normalised):
    assert normalised.sizes["time"] == 501
    np.testing.assert_allclose(normalised["time"], np.arange(501) * 0.02, rtol=1e-15)
    angle, velocity = motion.at(normalised["time"].values)
    np.testing.assert_array_equal(normalised["angle"], angle)
    np.testing.assert_array_equal(normalised["velocity"], velocity)
    np.testing.assert_allclose(
        normalised["base_acceleration"], 15 * np.cos(math.pi * normalised["time"] + 0.3), atol=15e-15 * 40
    )


def test_acceleration_is_the_equation_of_motion(normalised):
    side = np.sign(normalised["angle"])
    equation = normalised["angle"] - side - normalised["base_acceleration"]
    flying = np.abs(normalised["angle"]) > 1e-9
    np.testing.assert_allclose(normalised["acceleration"][flying], equation[flying], atol=1e-11)


def test_step_is_in_the_unit_of_time_and_ends_at_the_last_whole_step(motion):
    np.testing.assert_allclose(motion.to_xarray(step=3.0)["time"], [0, 3, 6, 9])
    seconds = motion.to_xarray(step=0.25, block=BLOCK)["time"]
    np.testing.assert_allclose(seconds, np.arange(seconds.size) * 0.25, rtol=1e-14)
    assert 0 <= BLOCK.seconds(10.0) - seconds[-1] < 0.25


def test_physical_values_are_the_block_s(motion, normalised, physical):
    for name, factor in (
        ("time", 1 / BLOCK.frequency_parameter),
        ("angle", BLOCK.critical_angle),
        ("velocity", BLOCK.critical_angle * BLOCK.frequency_parameter),
        ("acceleration", BLOCK.critical_angle * BLOCK.frequency_parameter**2),
        ("base_acceleration", 9.80665 * BLOCK.critical_angle),
        ("event_time", 1 / BLOCK.frequency_parameter),
        ("event_before", BLOCK.critical_angle * BLOCK.frequency_parameter),
    ):
        np.testing.assert_allclose(physical[name], factor * normalised[name], rtol=1e-14)
    np.testing.assert_allclose(physical["top_displacement"], 2.0 * np.sin(physical["angle"]), rtol=1e-14)
    assert "top_displacement" not in normalised


def test_every_variable_names_its_unit(normalised, physical):
    units = {
        "time": "s",
        "angle": "rad",
        "velocity": "rad s-1",
        "acceleration": "rad s-2",
        "top_displacement": "m",
    }
    units |= {"base_acceleration": "m s-2", "event_time": "s", "event_after": "rad s-1", "event_phase": "rad"}
    assert {name: physical[name].attrs["units"] for name in units} == units
    assert {normalised[name].attrs["units"] for name in units if name in normalised} == {"1", "rad"}
    for dataset in (normalised, physical):
        assert all(dataset[name].attrs["long_name"] for name in dataset.variables)


def test_events_are_those_of_the_motion(motion, normalised):
    assert normalised.sizes["event"] == motion.events.size > 10
    for name in motion.events.dtype.names:
        np.testing.assert_array_equal(normalised[f"event_{name}"], motion.events[name])


def test_phase_of_an_event_is_that_of_the_base_at_its_time(motion):
    forcing, events = motion.system.forcing, motion.events
    pushed = forcing.amplitude * np.cos(events["phase"])
    assert len(events) > 10
    np.testing.assert_allclose(pushed, forcing.acceleration(events["time"]), atol=1e-10)


def test_attributes_say_what_the_motion_is(normalised, physical):
    given = {
        "source": f"rocking {__version__}",
        "amplitude": 15.0,
        "period": 2.0,
        "frequency": math.pi,
        "phase": 0.3,
        "restitution": 0.925,
        "brace_angle": 1.0,
        "brace_restitution": 0.8,
        "start_angle": 0.1,
        "start_velocity": -0.2,
        "cycles": 5,
        "outcome": "bounded",
    }
    assert given.items() <= normalised.attrs.items()
    in_si = {"block_height_m": 2.0, "block_width_m": 0.5, "start_angle_rad": BLOCK.radians(0.1)}
    in_si |= {"acceleration_m_per_s2": pytest.approx(BLOCK.acceleration(15.0)), "phase": 0.3}
    assert {name: physical.attrs[name] for name in in_si} == in_si
    assert not {"amplitude", "start_angle", "peak"} & physical.attrs.keys()


def test_overturned_motion_says_when():
    motion = simulate(System(Harmonic(amplitude=1.75, period=2.0), restitution=0.95), cycles=50)
    dataset = motion.to_xarray()
    assert dataset.attrs["outcome"] == "overturned"
    assert dataset.attrs["overturning_time"] == motion.overturning.time
    # counted as the events are: this cycle began at most a period before
    assert 0 <= motion.overturning.time - 2.0 * dataset.attrs["overturning_cycle"] < 2.0
    assert dataset["event_cycle"].max() <= dataset.attrs["overturning_cycle"]
    assert "counted from 0" in dataset.attrs["comment"]
    assert motion.duration < dataset["time"][-1]
    assert np.abs(dataset["angle"]).max() <= 3.0


def test_section_is_a_dataset_along_the_cycles(tmp_path):
    motion = simulate(BRACED, START, cycles=50, record="section")
    dataset = motion.to_xarray(block=BLOCK)
    assert dict(dataset.sizes) == {"cycle": 51}
    np.testing.assert_allclose(dataset["angle"], BLOCK.radians(motion.section()[:, 0]), rtol=1e-15)
    np.testing.assert_allclose(dataset["time"], BLOCK.seconds(2.0 * np.arange(51)), rtol=1e-14)
    dataset.to_netcdf(tmp_path / "section.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "section.nc") as read:
        xr.testing.assert_identical(read, dataset)


@pytest.mark.parametrize(
    ("step", "error", "message"),
    [
        (0.0, ValueError, r"step must lie in .*; got 0\.0"),
        (-1.0, ValueError, "got -1"),
        (math.nan, ValueError, "got nan"),
        (11.0, ValueError, r"10\]; got 11"),
        ("fine", TypeError, "step must be a real number"),
    ],
)
def test_bad_step_is_refused_in_one_line(motion, step, error, message):
    with pytest.raises(error, match=message) as refused:
        motion.to_xarray(step=step)
    assert len(str(refused.value).splitlines()) == 1


def test_what_was_not_recorded_is_refused():
    with pytest.raises(ValueError, match="step"):
        simulate(BRACED, START, cycles=3, record="section").to_xarray(step=0.1)
    with pytest.raises(ValueError, match="record"):
        simulate(BRACED, START, cycles=3, record="none").to_xarray()
    with pytest.raises(TypeError, match="block must be a Block"):
        simulate(BRACED, START, cycles=3).to_xarray(block=2.0)


def test_motion_under_a_record_has_a_row_per_sample_and_no_cycles():
    base = PiecewiseLinear([0.0, 1.5, -1.5, 0.9, 0.0], step=1 / 64)
    moved = simulate(System(base, restitution=0.9), START)
    data = moved.to_xarray()
    np.testing.assert_allclose(np.diff(data["time"].values), min(1 / 64, moved.duration / 100), atol=1e-12)
    assert not {name for name in (*data.variables, *data.attrs) if "cycle" in name or "phase" in name}
    assert {"event_time", "event_kind"} <= set(data.variables)
    assert (data.attrs["margin"], data.attrs["certified"]) == (pytest.approx(moved.margin), 1)
    assert (data.attrs["samples"], data.attrs["step"]) == (5, 1 / 64)
    assert "linear between samples" in data.attrs["comment"]


@pytest.mark.parametrize(
    ("kind", "stated"), [("one-sine", "a piece of a cosine"), ("triangular", "linear between samples")]
)
def test_base_motion_of_a_pulse_is_stated_as_it_is(kind, stated):
    moved = simulate(System(Pulse(kind, amplitude=2.0, duration=1.0), restitution=0.9))
    assert stated in moved.to_xarray().attrs["comment"]


def test_short_push_before_a_long_motion_does_not_fill_the_memory():
    push = System(PiecewiseLinear([0.0, 0.0], step=1e-8), restitution=0.9)
    moved = simulate(push, State(angle=0.5))
    assert moved.duration > 1.0
    assert moved.to_xarray().sizes["time"] == 1_000_001
