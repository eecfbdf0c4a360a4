"""Datasets of branches, bifurcation curves, cascades, sets of orbits and manifolds: every value comes back, also from a file."""

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from made_results import made
from rocking.model.system import quantities

SYSTEM = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)


@pytest.fixture(scope="module")
def orbits():
    return rk.find_orbits(rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925), 3)


def through_file(data, tmp_path):
    """Return a dataset as it comes back from a netCDF file."""
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    return xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")


def multipliers_of(data):
    parts = (data[f"multiplier_{k}_real"].values + 1j * data[f"multiplier_{k}_imag"].values for k in (1, 2))
    return np.stack(list(parts), axis=-1)


def test_every_dataset_states_the_quantities_that_do_not_vary(orbits):
    branch = made("branch")
    curve = made("curve")
    fixed = {"restitution": 0.9, "phase": 0.0}
    along_branch, along_curve = branch.to_xarray().attrs, curve.to_xarray().attrs
    assert (fixed | {"period": 1.0}).items() <= along_branch.items()
    assert fixed.items() <= along_curve.items()
    assert not {"amplitude", "frequency"} & (along_branch.keys() | along_curve.keys())
    assert "period" not in along_curve
    assert quantities(orbits.system).items() <= orbits.to_xarray().attrs.items()


def test_branch_comes_back_with_its_special_points(tmp_path):
    branch = made("branch")
    data = through_file(branch.to_xarray(), tmp_path)
    assert data.attrs["parameter"] == "amplitude"
    assert data["end_reason"].values.tolist() == list(branch.ends)
    for name, field in {
        "amplitude": "parameter",
        "event_phase": "phase",
        "event_velocity": "velocity",
    }.items():
        np.testing.assert_array_equal(data[name], branch.points[field])
    np.testing.assert_array_equal(data["peak"], branch.points["peak"])
    np.testing.assert_array_equal(data["stability"].values.astype(str), branch.points["stability"])
    np.testing.assert_array_equal(multipliers_of(data), branch.points["multipliers"])
    assert (
        data["special_kind"].values.tolist() == [one.kind for one in branch.special] == ["symmetry-breaking"]
    )
    assert data["special_amplitude"].values.tolist() == [one.parameter for one in branch.special]


def test_branch_without_special_points_has_an_empty_dimension(tmp_path):
    branch = rk.continue_orbit(rk.classify(SYSTEM).orbit, "amplitude", (14, 16), step=0.1)
    data = through_file(branch.to_xarray(), tmp_path)
    assert dict(data.sizes) == {"point": len(branch), "special": 0, "end": 2}


def test_branch_over_the_slenderness_of_a_full_block_has_radians():
    system = rk.System(rk.Harmonic(amplitude=3.0, period=1.0), 0.9, critical_angle=0.2)
    branch = rk.continue_orbit(rk.classify(system).orbit, "critical_angle", (0.19, 0.21), step=0.1)
    assert branch.to_xarray()["critical_angle"].attrs["units"] == "rad"


def test_curve_comes_back(tmp_path):
    curve = made("curve")
    data = through_file(curve.to_xarray(), tmp_path)
    for name, values in zip(curve.names, curve.points.T, strict=True):
        np.testing.assert_array_equal(data[name], values)
    assert data.attrs["kind"] == "symmetry-breaking"


@pytest.mark.parametrize(
    ("amplitude", "period", "restitution", "superstable"),
    [(10.103037, 1.721328, 0.8, False), (1.1, 2.0, 0.5, True)],
)
def test_exponents_come_back_with_their_history(amplitude, period, restitution, superstable, tmp_path):
    system = rk.System(rk.Harmonic(amplitude, period=period), restitution)
    spectrum = rk.lyapunov(system, cycles=2_000)
    assert spectrum.superstable is superstable
    data = through_file(spectrum.to_xarray(), tmp_path)
    np.testing.assert_array_equal(data["exponent"], spectrum.values)
    np.testing.assert_array_equal(data["exponent_error"], spectrum.errors)
    if superstable:
        assert (data["cycles"].values.tolist(), data["running_exponent"].values.tolist()) == (
            [2_000],
            [[-np.inf] * 2],
        )
    else:
        np.testing.assert_array_equal(data["cycles"], spectrum.history["cycles"])
        np.testing.assert_array_equal(data["running_exponent"], spectrum.history["values"])


def test_cascade_comes_back_with_its_orbits(tmp_path):
    cascade = made("cascade")
    data = through_file(cascade.to_xarray(), tmp_path)
    np.testing.assert_array_equal(data["amplitude"], cascade.values)
    np.testing.assert_array_equal(data["orbit_period"], [1, 2, 4, 8])
    np.testing.assert_array_equal(data["ratio"][1:-1], cascade.ratios)
    assert np.isnan(data["ratio"].values[[0, -1]]).all()
    assert (
        data.attrs["accumulation_amplitude"],
        data.attrs["accumulation_amplitude_error"],
    ) == cascade.accumulation
    assert (data.attrs["parameter"], data.attrs["end"]) == ("amplitude", cascade.end)
    assert (data.attrs["restitution"], data.attrs["period"]) == (0.8, 1.721328)
    assert "amplitude" not in data.attrs
    for k, special in enumerate(cascade.special):
        here, orbit = data.isel(doubling=k), special.orbit
        assert (here["section_angle"], here["section_velocity"]) == (orbit.state.angle, orbit.state.velocity)
        assert here["section_phase"] == orbit.phase
        assert tuple(multipliers_of(here)) == orbit.multipliers


def test_manifolds_come_back_half_by_half(tmp_path):
    manifolds = made("orbit manifolds")
    data = through_file(manifolds.to_xarray(), tmp_path)
    halves = (*manifolds.unstable, *manifolds.stable)
    assert data.sizes["curve"] == len(halves) == 12
    for k, half in enumerate(halves):
        here = data.isel(point=data["curve_number"].values == k)
        np.testing.assert_array_equal(np.column_stack([here["angle"], here["velocity"]]), half.points)
        np.testing.assert_array_equal(here["time"], half.times)
        told = data.isel(curve=k)
        assert told["curve_stable"] == half.stable
        assert told["curve_resolved"] == half.resolved
        assert told["curve_side"] == half.side
        start = data.isel(orbit_point=int(told["curve_orbit_point"]))
        assert (start["orbit_angle"], start["orbit_velocity"]) == tuple(half.points[0])
    assert data.attrs["section_phase"] == manifolds.phase
    assert (data.attrs["orbit_period"], data.attrs["wanted_length"]) == (3, 0.5)
    assert (data.attrs["amplitude"], data.attrs["restitution"]) == (6.5, 0.925)


def test_orbits_come_back_and_pandas_writes_a_table(orbits, tmp_path):
    data = through_file(orbits.to_xarray(), tmp_path)
    assert data.sizes["orbit"] == len(orbits)
    for k, orbit in enumerate(orbits):
        here = data.isel(orbit=k)
        assert here["orbit_period"] == orbit.period
        assert here["impacts_per_period"] == orbit.impacts
        assert here["section_angle"] == orbit.state.angle
        assert here["start_velocity"] == orbit.start.velocity
        assert str(here["stability"].values) == str(orbit.stability)
        assert tuple(multipliers_of(here)) == orbit.multipliers
    assert len(orbits.to_dataframe()) == len(orbits)


def test_infinitely_many_impacts_are_minus_one():
    resting = rk.find_orbits(rk.System(rk.Harmonic(amplitude=1.1, period=2.0), restitution=0.5), 1)
    counts = resting.to_xarray()["impacts_per_period"].values.tolist()
    assert -1 in counts
    assert np.inf in resting.to_dataframe()["impacts_per_period"].tolist()
    assert counts == [-1 if orbit.impacts is None else orbit.impacts for orbit in resting]
