"""`rocking safe-basin`: output, files and SI input."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.model.block_formulas import GRAVITY

LINE = "--amplitude 3:6:4 --period 1 --restitution 0.8 --samples 200"
BLOCK = rk.Block(2.0, 0.5)
SI = "--height 2 --width 0.5 --acceleration 2:10:5 --frequency-hz 1.2 --samples 100"
KEY = "acceleration_m_per_s2"


def basin(**change):
    usual = {"amplitude": np.linspace(3, 6, 4), "period": 1.0, "restitution": 0.8, "samples": 200}
    return rk.safe_basin(**usual | change)


def basin_in_si():
    system = BLOCK.system(acceleration=2.0, frequency_hz=1.2)
    return rk.safe_basin(
        amplitude=np.linspace(1, 5, 5) * system.forcing.amplitude,
        frequency=system.forcing.frequency,
        restitution=system.restitution,
        samples=100,
    )


def told(rocking, line):
    code, message, out = rocking(f"safe-basin {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_first_line_is_that_of_the_result_and_each_amplitude_has_a_row(rocking):
    code, message, out = rocking(f"safe-basin {LINE}")
    found = basin()
    assert (code, message) == (0, "")
    first, heading, *rows = out.splitlines()
    assert first == str(found)
    assert heading.split("   ")[0] == "amplitude A"
    assert [row.split("   ")[0].strip() for row in rows] == ["3", "4", "5", "6"]
    assert all(str(share) in row for share, row in zip(found.shares, rows, strict=True))


def test_long_table_ends_with_the_number_of_rows_left_out(rocking):
    out = rocking(f"safe-basin {LINE.replace('3:6:4', '3:6:23').replace('200', '2')}")[2]
    assert len(out.splitlines()) == 23
    assert out.splitlines()[-1].startswith("and 3 more (all of them with --json, --csv")


def test_json_holds_the_numbers_of_the_function(rocking):
    read, found = told(rocking, f"{LINE} --velocity=-0.5:0.25 --seed 3"), basin(velocity=(-0.5, 0.25), seed=3)
    assert [row["amplitude"] for row in read["fractions"]] == found.dataset.amplitude.values.tolist()
    for row, share in zip(read["fractions"], found.shares, strict=True):
        assert row["safe"]["value"] == share.value
        assert (row["safe"]["count"], row["safe"]["of"]) == (share.count, 200)
    assert read["heteroclinic_amplitude"] == found.heteroclinic_amplitude
    assert read["melnikov_amplitude"] == found.melnikov_amplitude
    assert (read["angle"], read["velocity"], read["seed"]) == ([-1.0, 1.0], [-0.5, 0.25], 3)
    assert "block" not in read


def test_files_hold_every_fraction(rocking, tmp_path):
    assert rocking(f"safe-basin {LINE} --csv a.csv --netcdf a.nc")[0] == 0
    data = basin().dataset
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["amplitude [g theta_cr]"]) for row in rows] == data.amplitude.values.tolist()
    for name in ("safe", "safe_low", "safe_high", "undetermined"):
        assert [float(row[name]) for row in rows] == data[name].values.tolist()
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as read:
        assert read.safe.values.tolist() == data.safe.values.tolist()
        assert read.attrs["samples"] == 200


def test_block_has_its_accelerations_in_text_json_and_files(rocking, tmp_path):
    found, accelerations = basin_in_si(), np.linspace(2, 10, 5)
    out = rocking(f"safe-basin {SI} --csv a.csv --netcdf a.nc --plot a.svg")[2]
    tangency = float(BLOCK.acceleration(found.heteroclinic_amplitude))
    assert f"exact tangency A* = {tangency:.4g} m/s² = {tangency / GRAVITY:.4g} g" in out
    assert "m/s²" in out.splitlines()[1]
    read = told(rocking, SI)
    assert [row[KEY] for row in read["fractions"]] == pytest.approx(accelerations)
    assert [row["safe"]["value"] for row in read["fractions"]] == [share.value for share in found.shares]
    assert read[f"heteroclinic_{KEY}"] == pytest.approx(tangency)
    assert read["block"]["height_m"] == 2.0
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["acceleration [m/s^2]"]) for row in rows] == pytest.approx(accelerations)
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as data:
        assert data[KEY].values == pytest.approx(accelerations)
        assert data.attrs[f"heteroclinic_{KEY}"] == pytest.approx(tangency)
        assert data.attrs["block_height_m"] == 2.0
    assert "m/s²" in (tmp_path / "a.svg").read_text(encoding="utf-8")


def test_displacement_may_be_the_axis_of_a_block(rocking):
    ends = [BLOCK.system(displacement=x, frequency_hz=1.2).forcing.amplitude for x in (0.1, 0.2)]
    rows = told(rocking, SI.replace("--acceleration 2:10:5", "--displacement 0.1:0.2:3"))["fractions"]
    assert [rows[0]["amplitude"], rows[-1]["amplitude"]] == pytest.approx(ends)


def test_initial_angles_lie_between_narrower_braces(rocking):
    read = told(rocking, f"{LINE} --brace-angle 0.5 --brace-restitution 0.7")
    assert read["angle"] == [-0.5, 0.5]
    assert read["heteroclinic_amplitude"] is None
    assert (read["brace_angle"], read["brace_restitution"]) == (0.5, 0.7)
