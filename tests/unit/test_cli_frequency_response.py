"""`rocking frequency-response`: output and files."""

import json
import sys

import numpy as np
import pytest

import rocking as rk
from surveyed import system_with

LINE = "--amplitude 2 --period 0.5:2.5:9 --restitution 0.925"
SI = "--height 2 --width 0.5 --acceleration 4 --modes 1"


@pytest.fixture(scope="module")
def found():
    return rk.frequency_response(
        system_with(amplitude=2.0, restitution=0.925), period=np.linspace(0.5, 2.5, 9)
    )


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


def test_modes_frequency_and_number_of_cycles_are_passed_on(rocking):
    line = "--amplitude 10.103037 --frequency 3.65:3.6:2 --restitution 0.8 --modes 5 --modes 1 --step 0.05"
    read = told(rocking, f"{line} --max-cycles 50")
    expected = rk.frequency_response(
        system_with(amplitude=10.103037, restitution=0.8),
        frequency=[3.6, 3.65],
        modes=(5, 1),
        step=0.05,
        max_cycles=50,
    )
    assert (read["parameter"], read["modes"]) == ("frequency", [5, 1])
    assert [each["points"] for each in read["branch"]] == [len(branch) for branch in expected.branches]
    assert read["rest"] == [{"rest": "undetermined", "count": 2}]
    assert told(rocking, line)["rest"] != read["rest"]


@pytest.mark.parametrize(
    ("axis", "key"), [("--frequency-hz 0.5:3:6", "frequency_hz"), ("--period-s 0.5:1:6", "period_s")]
)
def test_block_in_si_has_its_units(rocking, axis, key):
    first, last = (float(each) for each in axis.split()[1].split(":")[:2])
    out = rocking(f"frequency-response {SI} {axis}")[2]
    assert f"{first:.4g} to {last:.4g} {'Hz' if key == 'frequency_hz' else 's'}" in out
    read = told(rocking, f"{SI} {axis}")
    assert read["acceleration_m_per_s2"] == pytest.approx(4.0)
    name, _, unit = key.partition("_")
    assert read[f"{name}_range_{unit}"] == pytest.approx([first, last])
    for branch in read["branch"]:
        assert first <= branch[key] <= last


def test_no_branch_and_no_motion_is_a_result(rocking):
    line = "--amplitude 0.1 --period 1:2:3 --restitution 0.2 --modes 1"
    code, message, out = rocking(f"frequency-response {line} --plot a.png --csv a.csv --netcdf a.nc")
    assert (code, message) == (0, "")
    assert "(1, 1) none found; from rest 3 rest" in out
    assert told(rocking, line)["branch"] == []


def test_what_is_invalid_is_refused_before_orbits_are_followed(rocking, monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.orbits.frequency_response"], "continue_orbit", pytest.fail)
    code, said, _ = rocking(f"frequency-response {LINE} --max-cycles 0")
    assert code == 2
    assert said.startswith("--max-cycles must be a whole number in [1, ")
