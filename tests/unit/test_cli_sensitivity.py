"""`rocking sensitivity`: the numbers of the function, sources and files."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk

BLOCK = rk.Block(2.0, 0.5)
LEVELS = np.linspace(0.3, 1.5, 13)
LINE = "--height 2 --width 0.5 --pga-g 0.3:1.5:13"
COUNT = 10


@pytest.fixture(autouse=True)
def records(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "set"
    folder.mkdir()
    for number, motion in enumerate(rk.synthetic_ground_motions(COUNT, seed=5, duration=10.0)):
        rows = "".join(
            f"{t!r}, {a!r}\n"
            for t, a in zip(motion.times.tolist(), motion.acceleration.tolist(), strict=True)
        )
        (folder / f"r{number}.csv").write_text("time (s), acceleration (m/s²)\n" + rows, encoding="utf-8")
    (tmp_path / "table.csv").write_text("file,scale\nset/r0.csv,0.5\nset/r1.csv,\n", encoding="utf-8")


def test_report_has_the_numbers_of_the_function(rocking):
    code, message, out = rocking(f"sensitivity set {LINE}")
    found = rk.sensitivity(rk.read_record_set("set"), BLOCK, LEVELS, intensity="pga-g").dataset
    lines = out.splitlines()
    assert (code, message) == (0, "")
    assert lines[0] == "verdicts that small changes reverse, of 130 runs of 10 records"
    assert [line.split("   ")[0] for line in lines[2:7]] == found.change.values.tolist()
    assert [int(line.split()[-1]) for line in lines[2:7]] == found.flipped.values.tolist()
    for line, share in zip(lines[2:7], found.share.values.tolist(), strict=True):
        assert f"{100 * share:.1f} % (" in line or f"{100 * share:.2g} % (" in line
    assert found.flipped.values.sum() > 0
    assert lines[7].startswith("equation of motion: small angles; moments overestimated by up to 3.1 %")


@pytest.mark.parametrize(
    ("source", "read"), [("table.csv", "table.csv"), ("set/r0.csv set/r3.csv", ["set/r0.csv", "set/r3.csv"])]
)
def test_files_and_json_hold_the_numbers_of_the_function(rocking, tmp_path, source, read):
    line = f"sensitivity {source} --height 2 --width 0.5 --scale 0.5:3:20 --seed 3"
    code, message, out = rocking(f"{line} --csv a.csv --netcdf a.nc --json")
    chosen = rk.read_record_set(read)
    found = rk.sensitivity(chosen, BLOCK, np.linspace(0.5, 3, 20), seed=3).dataset
    said = json.loads(out, parse_constant=pytest.fail)
    assert (code, message) == (0, "")
    assert said["records_sha256"] == chosen.digest
    assert said["levels"] == np.linspace(0.5, 3, 20).tolist()
    assert said["overturned"] == int(found.overturned.sum())
    assert [each["share_high"] for each in said["change"]] == found.share_high.values.tolist()
    assert said["warnings"][0] == "2 records can hardly say how much records differ: use 10 or more"
    assert said["files"] == ["a.csv", "a.nc"]
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["share_low"]) for row in rows] == found.share_low.values.tolist()
    assert [row["change"] for row in rows] == found.change.values.tolist()
    with xr.open_dataset("a.nc", engine="h5netcdf") as kept:
        assert np.array_equal(kept.differs, found.differs)
        assert kept.attrs["block_width_m"] == 0.5
