"""All results in all formats: dataset, netCDF, JSON, tables, pandas, notebook, text and pickle; normalised and in SI."""

import base64
import csv
import html
import io
import json
import pickle

import numpy as np
import pytest
import xarray as xr
from attrs import evolve
from PIL import Image

import rocking as rk
from made_results import BLOCK, MADE, OF_BLOCK, RECORDS, SYSTEM, made
from rocking.model import survey_results
from rocking.model.quantity import QUANTITIES
from rocking.model.result import Result
from rocking.model.survey_results import RockingSpectrum
from rocking.model.tables_and_json import finite

WITHOUT_FIGURE = {
    "orbit",
    "proof",
    "horseshoe",
    "rotation number",
    "proved share",
    "sensitivity",
    "overturning rate",
    "assessment",
    "comparison of intensities",
}


OF_MANY_BLOCKS = "rocking spectrum"
"""Its angles are in units of the critical angle of each block."""


def in_units(name, units):
    """Return the arguments that select the units of a result."""
    return {} if name == OF_MANY_BLOCKS else {"units": units, "block": BLOCK}


def test_every_class_of_results_is_tested():
    def below(kind):
        return {each.__name__ for each in kind.__subclasses__()}.union(*map(below, kind.__subclasses__()))

    tested = {type(made(name)).__name__ for name in MADE}
    # modes are a result of the command line alone; surveys of a system, and diagrams, are base classes
    assert below(Result) - {"Modes", "SystemSurvey", "Diagram"} == tested


@pytest.mark.parametrize("units", ["si", "normalised"])
@pytest.mark.parametrize("name", MADE)
def test_dataset_describes_its_variables_and_comes_back_from_a_file(name, units, tmp_path):
    data = made(name).to_xarray(**in_units(name, units))
    for each, variable in data.variables.items():
        normalised = variable.attrs.get("units") == "1"
        assert variable.attrs.get("long_name") or each in ("record", "change", "sample"), each
        if each in QUANTITIES and name != OF_MANY_BLOCKS:
            assert not (units == "si" and normalised and QUANTITIES[each].si)
    assert data.attrs.get("block_height_m") == (None if name == OF_MANY_BLOCKS else 2.0)
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    read = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    xr.testing.assert_equal(read, data)
    assert read.attrs.keys() == data.attrs.keys()


@pytest.mark.parametrize("units", ["si", "normalised"])
@pytest.mark.parametrize("name", MADE)
def test_json_and_tables_hold_the_values_of_the_dataset(name, units):
    result = made(name)
    data = result.to_xarray(**in_units(name, units))
    tables = result.tables(**in_units(name, units))
    found = json.loads(json.dumps(result.to_dict(**in_units(name, units)), allow_nan=False))
    assert {"title", "source"} <= found.keys()
    for each, table in tables.items():
        columns = list(table.values())
        assert len({len(column) for column in columns}) == 1
        if each in found:
            assert len(found[each]) == len(columns[0])
            last = [list(row.values())[-1] for row in found[each]]
            assert last == json.loads(json.dumps(finite(columns[-1].tolist())))
    for each, variable in data.data_vars.items():
        if variable.dtype.kind == "f" and variable.dims:
            table = tables["_".join(variable.dims)]
            assert any(
                np.array_equal(column, variable.values.ravel(), equal_nan=True)
                for column in table.values()
                if column.dtype.kind == "f"
            ), each


@pytest.mark.parametrize("name", MADE)
def test_principal_table_comes_back_from_csv_and_pandas(name):
    result = made(name)
    principal = next(iter(result.tables()))
    frame = result.to_dataframe()
    assert list(frame) == list(result.tables()[principal])
    stream = io.StringIO(frame.to_csv(index=False))
    assert len(list(csv.DictReader(stream))) == len(frame) > 0


@pytest.mark.parametrize("name", MADE)
def test_notebook_shows_the_figure_above_the_text(name):
    shown = made(name)._repr_html_()
    if name in WITHOUT_FIGURE:
        assert shown is None
    else:
        assert html.escape(str(made(name))) in shown
        image = Image.open(io.BytesIO(base64.b64decode(shown.partition("base64,")[2].partition('"')[0])))
        assert image.format == "PNG"
        assert np.asarray(image.convert("L")).std() > 5


@pytest.mark.parametrize("name", MADE)
def test_copy_in_another_process_has_the_same_text_and_data(name):
    result = made(name)
    copy = pickle.loads(pickle.dumps(result))
    assert str(copy) == str(result)
    assert copy.to_dict() == result.to_dict()
    assert copy.block == result.block


def test_result_of_a_block_is_in_si_by_default():
    motion = made("motion of a block")
    assert motion.to_xarray()["angle"].attrs["units"] == "rad"
    assert motion.to_xarray(units="normalised")["angle"].attrs["units"] == "1"
    found = motion.to_dict()
    assert found["peak_rad"] == BLOCK.radians(motion.peak)
    assert found["acceleration_m_per_s2"] == 4.0
    assert found["frequency_hz"] == pytest.approx(1.2, rel=1e-15)
    assert not {"peak", "amplitude", "frequency"} & found.keys()
    assert motion.to_dict(units="normalised")["peak"] == motion.peak


def test_text_and_figure_of_a_block_are_in_si():
    motion = made("motion of a block")
    assert f"peak |θ| {BLOCK.degrees(motion.peak):.4g}°" in str(motion)
    assert "peak |Θ| " in str(made("motion"))
    low, high = BLOCK.acceleration(np.array([1.4, 1.7]))
    assert f"acceleration {low:.6g} to {high:.6g} m/s²" in str(made("branch of a block"))
    assert " per s over " in str(made("exponents of a block"))
    labels = [made("branch of a block").plot(**given).get_xlabel() for given in ({}, {"units": "normalised"})]
    assert ["m/s²" in label for label in labels] == [True, False]
    assert rk.plot.branch(made("branch of a block"), block=None).get_xlabel() == labels[1]
    assert "m/s²" in made("branch").plot(block=BLOCK).get_xlabel()


def test_system_keeps_its_block_where_it_is_right():
    assert (OF_BLOCK.block, SYSTEM.block) == (BLOCK, None)
    assert evolve(OF_BLOCK, forcing=SYSTEM.forcing).block == BLOCK
    assert evolve(OF_BLOCK, restitution=0.5).block == rk.Block(2.0, 0.5, 0.5)
    assert evolve(OF_BLOCK, critical_angle=BLOCK.critical_angle).block == BLOCK
    assert evolve(OF_BLOCK, critical_angle=0.3).block is None
    without = evolve(OF_BLOCK, block=None)
    assert (without, hash(without), repr(without)) == (OF_BLOCK, hash(OF_BLOCK), repr(OF_BLOCK))
    with pytest.raises(TypeError, match="block must be a Block"):
        rk.System(SYSTEM.forcing, 0.9, block=2.0)


@pytest.mark.parametrize("method", ["to_xarray", "to_dict", "tables", "to_dataframe"])
def test_si_without_a_block_and_unknown_units_are_refused_in_a_sentence(method):
    motion = made("motion")
    with pytest.raises(
        ValueError, match=r"units must be 'normalised' for a system without a block; got 'si' \("
    ):
        getattr(motion, method)(units="si")
    with pytest.raises(ValueError, match="units must be one of 'si', 'normalised'; got 'm'"):
        getattr(motion, method)(units="m")
    with pytest.raises(TypeError, match="block must be a Block"):
        getattr(motion, method)(block=2.0)


@pytest.mark.parametrize("units", [{"units": "si"}, {"block": BLOCK}])
def test_blocks_of_many_sizes_have_no_common_units(units):
    message = "must be omitted: the angles are in units of the critical angle of each block; got"
    with pytest.raises(ValueError, match=f"^{next(iter(units))} {message}"):
        made(OF_MANY_BLOCKS).to_xarray(**units)


@pytest.mark.parametrize("kept", [True, False])
def test_rocking_spectrum_of_version_0_1_is_refused_in_a_sentence(kept):
    """Its levels, a dimension or an attribute, were named `scale`."""
    data = made(OF_MANY_BLOCKS).dataset.drop_attrs(deep=False)
    old = data.expand_dims(scale=[1.0, 2.0]) if kept else data.assign_attrs(scale=1.0)
    message = r"^(dataset|result) must name its levels `level`; got `scale`, their name in version 0.1 \(compute it again\)$"
    for read in (RockingSpectrum, rk.plot.rocking_spectrum):
        with pytest.raises(ValueError, match=message):
            read(old)


def test_survey_of_blocks_of_several_angles_is_normalised():
    assert made("map of a block").block == BLOCK
    several = rk.parametric_map(OF_BLOCK, amplitude=[0.5, 1.0], critical_angle=[0.1, 0.2])
    assert several.block is None
    assert several.to_xarray()["amplitude"].attrs["units"] == "1"


def test_unknown_table_is_refused():
    with pytest.raises(ValueError, match="table must be one of 'time', 'event'"):
        made("motion").to_dataframe("events")


SURVEYED = {
    "parametric map": lambda: rk.parametric_map(OF_BLOCK, amplitude=[2.0, 4.0], period=[1.0, 2.0]),
    "overturning spectrum": lambda: rk.overturning_spectrum(
        BLOCK.system(rk.Pulse("one-sine", amplitude=5.0, duration=1.0), model="slender"),
        amplitude=[3.0, 7.0],
        frequency=[4.0, 5.0],
    ),
}


@pytest.mark.parametrize("name", SURVEYED)
def test_dataset_in_si_is_not_taken_for_a_normalised_one(name):
    result = SURVEYED[name]()
    kind = type(result)
    uses = [kind, rk.plot.tiles if kind.PLOT == "parametric_map" else kind, getattr(rk.plot, kind.PLOT)]
    if kind.PLOT == "parametric_map":
        uses.append(rk.proved_share)
    for use in uses:
        with pytest.raises(ValueError, match=r"^(dataset|result) must be normalised; got one in SI units"):
            use(result.to_xarray(), *(["tiles"] if use is rk.plot.tiles else []))
    assert kind(result.to_xarray(units="normalised")).to_xarray().equals(result.dataset)


@pytest.mark.parametrize("name", ["ParametricMap", "OverturningSpectrum", "RockingSpectrum"])
@pytest.mark.parametrize("wrong", [3, xr.Dataset()])
def test_what_is_no_dataset_of_the_class_is_refused(name, wrong):
    with pytest.raises(TypeError, match="^dataset must be"):
        getattr(survey_results, name)(wrong)


def test_figure_has_the_units_of_the_result_however_it_is_passed():
    motion, normalised = made("motion of a block"), made("motion")
    labels = {
        rk.plot.phase_portrait(*arguments, **named).get_xlabel()
        for arguments, named in [((motion,), {}), ((), {"result": motion}), ((normalised,), {"block": BLOCK})]
    }
    assert len(labels) == 1
    orbit = rk.classify(BLOCK.system(acceleration=4.0, frequency_hz=1.2)).orbit
    one = rk.continue_orbit(orbit, "restitution", (0.8, 0.95))
    assert rk.plot.branch([one, one]).get_ylabel() == rk.plot.branch(one).get_ylabel()
    with pytest.raises(TypeError, match=r"^phase_portrait\(\) (got|has)"):
        rk.plot.phase_portrait(motion, wrong=3)


@pytest.mark.parametrize("name", MADE)
def test_figure_in_chosen_units(name):
    result = made(name)
    if result.PLOT:
        assert result.plot(units="normalised") is not None


def test_notebook_shows_the_text_of_a_result_that_has_no_figure():
    spectrum = rk.rocking_spectrum(RECORDS, BLOCK, model="slender")
    with pytest.raises(ValueError, match="^result must vary over size or slenderness"):
        spectrum.plot()
    assert spectrum._repr_html_() is None


def test_blocks_of_several_critical_angles_have_no_common_units():
    result = rk.parametric_map(OF_BLOCK, amplitude=[1.0, 2.0], critical_angle=[0.2, 0.3])
    with pytest.raises(ValueError, match="^block must be omitted: the critical angle varies"):
        result.to_xarray(block=BLOCK)


def test_variable_of_a_new_name_has_the_unit_in_its_description():
    basin = rk.safe_basin(OF_BLOCK, amplitude=[0.2, 0.5], samples=100)
    peaks = "amplitude", [0.1, 0.2], {"long_name": "mean peak in units of theta_cr"}
    changed = evolve(basin, dataset=basin.dataset.assign(mean_peak=peaks))
    in_si = changed.to_xarray().mean_peak
    assert in_si.values == pytest.approx(BLOCK.radians(np.array([0.1, 0.2])))
    assert in_si.attrs == {"long_name": "mean peak", "units": "rad"}
    assert changed.to_dataframe()["mean_peak [rad]"].tolist() == in_si.values.tolist()
    assert [row["mean_peak_rad"] for row in changed.to_dict()["amplitude"]] == in_si.values.tolist()
