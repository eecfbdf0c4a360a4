"""`rocking frequency-response`: output and files."""

import csv
import json
import sys

import numpy as np
import pytest
import xarray as xr

import rocking as rk

LINE = "--amplitude 2 --period 0.5:2.5:9 --restitution 0.925"
SI = "--height 2 --width 0.5 --acceleration 4 --modes 1"


@pytest.fixture(scope="module")
def found():
    return rk.frequency_response(np.linspace(0.5, 2.5, 9), 2.0, 0.925)


def told(rocking, line):
    code, message, out = rocking(f"frequency-response {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_answer_comes_first_then_one_row_per_branch(rocking, found):
    code, message, out = rocking(f"frequency-response {LINE}")
    assert (code, message) == (0, "")
    assert out.splitlines()[0] == str(found)
    assert "--period 0.5 to 2.5 (9 values)" in out
    head, *rows = out.partition("\n\n")[2].splitlines()
    assert head.split()[:3] == ["branch", "orbits", "period"]
    for number, (row, branch) in enumerate(zip(rows, found.branches, strict=True)):
        symmetry = "symmetric" if branch.symmetric else "asymmetric"
        assert row.startswith(f"{number}        (1, {branch.period}), {symmetry} ")
        assert f" {branch.points['peak'].max():.6g} " in row
        assert all(f"{one.kind} at {one.parameter:.6g}" in row for one in branch.special)
    assert any(branch.special for branch in found.branches)


def test_json_holds_the_numbers(rocking, found):
    read = told(rocking, LINE)
    assert (read["parameter"], read["first"], read["last"], read["count"]) == ("period", 0.5, 2.5, 9)
    assert (read["amplitude"], read["restitution"], read["modes"]) == (2.0, 0.925, [1, 3])
    for each, branch in zip(read["branches"], found.branches, strict=True):
        assert (each["orbit_period"], each["symmetric"]) == (branch.period, branch.symmetric)
        assert each["peak"] == branch.points["peak"].max()
        assert [one["period"] for one in each["special"]] == [one.parameter for one in branch.special]
    kinds, counts = np.unique(found.rest["kind"], return_counts=True)
    assert read["from_rest"] == dict(zip(kinds.tolist(), counts.tolist(), strict=True))


def test_files_hold_branches_and_responses_from_rest(rocking, found, tmp_path):
    assert rocking(f"frequency-response {LINE} --csv a.csv --netcdf a.nc")[0] == 0
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for number, branch in enumerate(found.branches):
        own = [row for row in rows if row["branch"] == str(number)]
        for heading, field in (("period [1/alpha]", "parameter"), ("peak [theta_cr]", "peak")):
            np.testing.assert_array_equal([float(row[heading]) for row in own], branch.points[field])
        assert [row["stability"] for row in own] == branch.points["stability"].tolist()
    rest = [row for row in rows if row["branch"] == "from rest"]
    assert [row["response"] for row in rest] == found.rest["kind"].tolist()
    assert [float(row["period [1/alpha]"]) for row in rest] == found.values.tolist()
    periodic = found.rest["kind"] == "periodic"
    peaks = np.array([float(row["peak [theta_cr]"]) for row in rest])
    np.testing.assert_array_equal(peaks[periodic], found.rest["steady_peak"][periodic])
    np.testing.assert_array_equal(peaks[~periodic], found.rest["peak"][~periodic])
    assert 0 < periodic.sum() < len(periodic)
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    xr.testing.assert_identical(data.drop_attrs(), found.to_xarray().drop_attrs())


def test_modes_frequency_and_number_of_cycles_are_passed_on(rocking):
    line = "--amplitude 10.103037 --frequency 3.65:3.6:2 --restitution 0.8 --modes 5 --modes 1 --step 0.05"
    read = told(rocking, f"{line} --max-cycles 50")
    expected = rk.frequency_response(
        frequency=[3.6, 3.65], amplitude=10.103037, restitution=0.8, modes=(5, 1), step=0.05, max_cycles=50
    )
    assert (read["parameter"], read["modes"]) == ("frequency", [5, 1])
    assert [each["points"] for each in read["branches"]] == [len(branch) for branch in expected.branches]
    assert read["from_rest"] == {"undetermined": 2}
    assert sorted(told(rocking, line)["from_rest"]) != ["undetermined"]


@pytest.mark.parametrize(
    ("axis", "key"), [("--frequency-hz 0.5:3:6", "frequency_hz"), ("--period-s 0.5:1:6", "period_s")]
)
def test_block_in_si_has_its_units_beside(rocking, tmp_path, axis, key):
    block = rk.Block(2.0, 0.5)
    first, last = (float(each) for each in axis.split()[1].split(":")[:2])
    out = rocking(f"frequency-response {SI} {axis} --csv a.csv --netcdf a.nc")[2]
    assert f"{first:.4g} to {last:.4g} {'Hz' if key == 'frequency_hz' else 's'}" in out
    read = told(rocking, f"{SI} {axis}")
    assert read["amplitude"] == pytest.approx(block.amplitude(4.0))
    assert (read["block"][key]["start"], read["block"][key]["stop"]) == pytest.approx((first, last))
    assert read["block"]["acceleration_m_per_s2"] == pytest.approx(4.0)
    for branch in read["branches"]:
        assert branch["peak_deg"] == pytest.approx(block.degrees(branch["peak"]))
    for branch in read["branches"]:
        assert first <= branch["peak_at"][key] <= last
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["branch"] == "from rest"]
    unit = "frequency [Hz]" if key == "frequency_hz" else "period [s]"
    assert [float(row[unit]) for row in rows] == pytest.approx(np.linspace(first, last, 6))
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    assert data[key].values == pytest.approx(np.linspace(first, last, 6))
    assert data.attrs["block_width_m"] == 0.5


def test_no_branch_and_no_motion_is_a_result(rocking):
    line = "--amplitude 0.1 --period 1:2:3 --restitution 0.2 --modes 1"
    code, message, out = rocking(f"frequency-response {line} --plot a.png --csv a.csv --netcdf a.nc")
    assert (code, message) == (0, "")
    assert "(1, 1) none found; from rest 3 rest" in out
    assert told(rocking, line)["branches"] == []


def test_what_is_invalid_is_refused_before_orbits_are_followed(rocking, monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.orbits.frequency_response"], "continue_orbit", pytest.fail)
    code, said, _ = rocking(f"frequency-response {LINE} --max-cycles 0")
    assert code == 2
    assert said.startswith("--max-cycles must be a whole number in [1, ")
