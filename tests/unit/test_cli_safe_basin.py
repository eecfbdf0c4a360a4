"""`rocking safe-basin`: output, files and SI input."""

import json

import numpy as np
import pytest

import rocking as rk
from rocking.model.block_formulas import GRAVITY
from surveyed import system_with

LINE = "--amplitude 3:6:4 --period 1 --restitution 0.8 --samples 200"
BLOCK = rk.Block(2.0, 0.5)
SI = "--height 2 --width 0.5 --acceleration 2:10:5 --frequency-hz 1.2 --samples 100"
KEY = "acceleration_m_per_s2"


def basin(**change):
    usual = {"system": system_with(restitution=0.8), "amplitude": np.linspace(3, 6, 4), "samples": 200}
    return rk.safe_basin(**usual | change)


def basin_in_si():
    system = BLOCK.system(acceleration=2.0, frequency_hz=1.2)
    return rk.safe_basin(
        rk.System(rk.Harmonic(1.0, frequency=system.forcing.frequency), restitution=system.restitution),
        amplitude=np.linspace(1, 5, 5) * system.forcing.amplitude,
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


def test_block_has_its_accelerations_in_text_json_and_picture(rocking, tmp_path):
    found, accelerations = basin_in_si(), np.linspace(2, 10, 5)
    out = rocking(f"safe-basin {SI} --plot a.svg")[2]
    tangency = float(BLOCK.acceleration(found.heteroclinic_amplitude))
    assert f"exact tangency A* = {tangency:.4g} m/s² = {tangency / GRAVITY:.4g} g" in out
    assert "m/s²" in out.splitlines()[1]
    read = told(rocking, SI)
    assert [row[KEY] for row in read["amplitude"]] == pytest.approx(accelerations)
    assert [row["safe"] for row in read["amplitude"]] == [share.value for share in found.shares]
    assert read[f"heteroclinic_{KEY}"] == pytest.approx(tangency)
    assert "m/s²" in (tmp_path / "a.svg").read_text(encoding="utf-8")


def test_displacement_may_be_the_axis_of_a_block(rocking):
    rows = told(rocking, SI.replace("--acceleration 2:10:5", "--displacement 0.1:0.2:3"))["amplitude"]
    turning = (2 * np.pi * 1.2) ** 2
    assert [rows[0][KEY], rows[-1][KEY]] == pytest.approx([0.1 * turning, 0.2 * turning])


def test_initial_angles_lie_between_narrower_braces(rocking):
    read = told(rocking, f"{LINE} --brace-angle 0.5 --brace-restitution 0.7")
    assert read["angle_range"] == [-0.5, 0.5]
    assert read["heteroclinic_amplitude"] is None
    assert (read["brace_angle"], read["brace_restitution"]) == (0.5, 0.7)
