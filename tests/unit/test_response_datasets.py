"""Responses as datasets and as pictures in a notebook."""

import numpy as np
import pytest
import xarray as xr

import rocking as rk

PERIOD_3 = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
RESTS = rk.System(rk.Harmonic(amplitude=1.1, period=2.0), restitution=0.5)


@pytest.fixture(scope="module")
def density():
    return rk.spectral_density(rk.simulate(PERIOD_3, cycles=1200), transient=600)


@pytest.fixture(scope="module")
def dimension():
    return rk.correlation_dimension(np.random.default_rng(1).random((6_000, 2)))


def read_back(result, folder):
    """The dataset of a result, written to netCDF and read again."""
    result.to_xarray().to_netcdf(folder / "result.nc")
    with xr.open_dataset(folder / "result.nc") as data:
        return data.load()


def test_file_of_a_spectral_density_holds_the_density_and_its_lines(density, tmp_path):
    data = read_back(density, tmp_path)
    np.testing.assert_array_equal(data.density, density.density)
    np.testing.assert_array_equal(data.cyclic_frequency, density.frequency)
    assert data.line_name.values.tolist() == [peak.name for peak in density.peaks]
    assert data.line_amplitude.values.tolist() == [peak.amplitude for peak in density.peaks]
    assert float(data.density.integrate("cyclic_frequency")) == pytest.approx(
        data.attrs["variance"], rel=1e-3
    )


def test_file_of_a_correlation_dimension_gives_the_slopes(dimension, tmp_path):
    data = read_back(dimension, tmp_path)
    slopes = np.diff(np.log(data.correlation_sum)) / np.diff(np.log(data.radius))
    np.testing.assert_allclose(data.slope, slopes, rtol=1e-9)
    assert data.attrs["value"] == dimension.value
    assert data.attrs["isolated"] == 0


def test_without_a_picture_a_notebook_shows_the_line_alone():
    points = rk.simulate(PERIOD_3, cycles=3000, record="section").section()[1000:]
    assert rk.correlation_dimension(points)._repr_html_() is None


def test_multipliers_along_a_branch_pass_1_at_its_special_points():
    system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    ax = rk.plot.branch(branch, quantity="multiplier")
    (breaking,) = (line for line in ax.lines if line.get_gid() == "symmetry-breaking")
    np.testing.assert_allclose(breaking.get_ydata(), 1.0, rtol=1e-6)
    lines = {line.get_gid(): line.get_xydata() for line in ax.lines}
    assert np.nanmax(lines["symmetric, stable"][:, 1]) <= 1.0 + 1e-3
    unstable = lines["symmetric, unstable"]
    drawn = unstable[~np.isnan(unstable[:, 1])]
    assert drawn[-1, 1] == pytest.approx(max(abs(value) for value in branch.points["multipliers"][-1]))
    assert ax.get_yscale() == "log"


def test_points_of_each_orbit_are_on_its_section():
    found = rk.find_orbits(rk.System(rk.Harmonic(amplitude=8.0, period=2.0), restitution=0.925), 2)
    ax = rk.plot.orbits(found, phase=0.7)
    drawn = {line.get_gid(): line.get_xydata() for line in ax.lines}
    for orbit in found:
        begun = rk.simulate(
            rk.System(rk.Harmonic(8.0, period=2.0, phase=orbit.phase), 0.925),
            orbit.state,
            cycles=orbit.period,
        )
        for state in begun.section(0.7):
            assert np.hypot(*(drawn[str(orbit.stability)] - state).T).min() < 1e-6
    assert sum(map(len, drawn.values())) == sum(orbit.period for orbit in found)


def test_a_diagram_of_orbits_has_no_multipliers():
    with pytest.raises(ValueError, match="quantity must be"):
        rk.plot.orbit_diagram(
            rk.orbit_diagram(PERIOD_3, amplitude=[6.4, 6.5], cycles=5, transient=5), quantity="multiplier"
        )


def test_dataset_states_the_system_and_the_cycles(density, tmp_path):
    spectrum = rk.lyapunov(PERIOD_3, rk.State(0.01, 0.02), cycles=200)
    for found in (density, spectrum):
        attributes = read_back(found, tmp_path).attrs
        given = {"amplitude": 6.5, "period": 0.4, "phase": 0.0, "restitution": 0.925}
        assert given.items() <= attributes.items()
        assert attributes["transient"] == found.transient
    assert read_back(density, tmp_path).attrs["cycles"] == density.cycles
    assert (attributes["start_angle"], attributes["start_velocity"]) == (0.01, 0.02)
