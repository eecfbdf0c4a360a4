"""`rocking overturning-spectrum`: report, files and SI units."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk

BLOCK = rk.Block(2.0, 0.5)
PLANE = {"amplitude": np.linspace(1, 10, 19), "frequency": np.linspace(1, 8, 15)}
LINE = "--pulse one-sine --amplitude 1:10:19 --frequency 1:8:15 --restitution 0.9"
OVERTURNED = 2


@pytest.fixture(scope="module")
def found():
    return rk.overturning_spectrum(
        rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9), **PLANE
    ).dataset


def test_report_has_the_outcomes_and_the_modes(rocking, found):
    code, message, out = rocking(f"overturning-spectrum {LINE}")
    lines = [" ".join(line.split()) for line in out.splitlines()]
    fell = found.outcome.values == OVERTURNED
    impacts = found.impacts_since_rest.values[fell]
    assert (code, message) == (0, "")
    assert lines[0] == "overturning spectrum of one-sine pulses, 285 runs"
    assert lines[1:4] == ["amplitude 1 to 10 (19)", "frequency 1 to 8 (15)", "restitution 0.9"]
    for shown, count in (
        ("overturned", fell.sum()),
        ("no impact", (impacts == 0).sum()),
        ("1 impact", (impacts == 1).sum()),
    ):
        assert 0 < count < 285
        assert f"{shown} {100 * count / 285:.1f} % {count} runs" in lines
    assert f"lowest amplitude that overturns {PLANE['amplitude'][fell.any(axis=1)].min():.6g}" in lines


def test_files_hold_the_numbers_of_the_function(rocking, found, tmp_path):
    line = f"overturning-spectrum {LINE} --store s.zarr --csv a.csv --netcdf a.nc --json"
    code, message, out = rocking(line)
    said = json.loads(out, parse_constant=pytest.fail)
    assert (code, message) == (0, "")
    assert said["files"] == ["s.zarr", "a.csv", "a.nc"]
    assert (said["frequency_range"], said["frequency_count"]) == ([1.0, 8.0], 15)
    outcomes = {each["outcome"]: each["points"] for each in said["outcome"]}
    assert sum(said["modes"].values()) == outcomes["overturned"] == (found.outcome == OVERTURNED).sum()
    assert sum(outcomes.values()) == 285
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["peak [theta_cr]"]) for row in rows] == found.peak.values.ravel().tolist()
    assert [
        int(row["impacts_since_rest"]) for row in rows
    ] == found.impacts_since_rest.values.ravel().tolist()
    with xr.open_dataset("a.nc", engine="h5netcdf") as kept:
        assert kept.load().drop_attrs().equals(found.load().drop_attrs())


def test_units_of_the_block_are_converted(rocking, tmp_path):
    line = "--pulse half-sine --height 2 --width 0.5 --acceleration-g 0.3:2:9 --frequency-hz 0.5:2:7"
    said = json.loads(rocking(f"overturning-spectrum {line} --csv a.csv --netcdf a.nc --json")[2])
    lift_off = BLOCK.acceleration(1.0) / 9.80665
    found = rk.overturning_spectrum(
        rk.System(rk.Pulse("half-sine", amplitude=1.0, duration=1.0), BLOCK.restitution),
        amplitude=np.linspace(0.3 / lift_off, 2 / lift_off, 9),
        frequency=np.linspace(0.5 / BLOCK.hertz(1.0), 2 / BLOCK.hertz(1.0), 7),
    ).dataset
    assert {each["outcome"]: each["points"] for each in said["outcome"]} == {
        name: int((found.outcome == code).sum())
        for code, name in enumerate(("bounded", "at-rest", "overturned"))
    }
    assert said["frequency_range_hz"] == pytest.approx([0.5, 2.0])
    assert said["restitution"] == BLOCK.restitution
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["frequency [Hz]"]) == pytest.approx(2.0)
    with xr.open_dataset("a.nc", engine="h5netcdf") as kept:
        assert kept.attrs["block_height_m"] == 2.0
        assert kept.amplitude.values[-1] == pytest.approx(2 * 9.80665)


def test_restitution_may_vary(rocking):
    line = LINE.replace("--restitution 0.9", "--restitution 0.8:0.9:3")
    said = json.loads(rocking(f"overturning-spectrum {line} --json")[2])
    assert (said["restitution_range"], said["restitution_count"]) == ([0.8, 0.9], 3)
    assert sum(each["points"] for each in said["outcome"]) == 3 * 285
