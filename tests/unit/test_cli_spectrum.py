"""`rocking spectrum`: sources, report and files."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import record_files as write
import rocking as rk
from rocking.records.read import FILE as EXAMPLE_FILE

G = 9.80665
WAVE = np.round(0.8 * np.sin(0.15 * np.arange(400)) * np.exp(-np.arange(400) / 150), 3)
SIZES = np.linspace(0.3, 3.0, 10)
ANGLE = np.radians(10)


@pytest.fixture(autouse=True)
def records(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "set"
    folder.mkdir()
    (folder / "a.AT2").write_text("\n".join(write.peer(WAVE)), encoding="utf-8")
    (folder / "b.AT2").write_text("\n".join(write.peer(-0.5 * WAVE)), encoding="utf-8")
    (tmp_path / "table.csv").write_text("file,scale\nset/a.AT2,0.5\nset/b.AT2,\n", encoding="utf-8")


def told(rocking, line):
    code, message, out = rocking(f"spectrum {line}")
    assert (code, message) == (0, "")
    return out


def test_report_says_records_blocks_and_outcomes(rocking):
    found = rk.rocking_spectrum(rk.read_record_set("set"), size=SIZES, slenderness=ANGLE).dataset
    out = told(rocking, "set --size 0.3:3:10 --slenderness-deg 10")
    text = " ".join(out.split())
    fell = int(np.isinf(found.peak).sum())
    assert out.splitlines()[0] == "rocking spectrum, 20 runs"
    stands = found.peak.values[np.isfinite(found.peak)].max()
    largest = SIZES[np.isinf(found.peak).any("record")].max()
    for shown in (
        "records 2: a.AT2, 180, b.AT2, 180",
        f"PGA {0.5 * G * np.abs(WAVE).max():.6g} to {G * np.abs(WAVE).max():.6g} (2) m/s², times 1",
        "size R 0.3 to 3 (10) m",
        "critical angle 10°",
        "equation of motion small angles; moments overestimated by up to 1.5 % (--model full avoids this)",
        "restitution Housner's for each slenderness",
        f"overturned {5 * fell:.1f} %, {fell} runs",
        f"largest |θ| of blocks that stand {10 * stands:.4g}°, {stands:.4g} θcr",
        f"largest R that overturns {largest:.6g} m",
    ):
        assert shown in text
    assert 0 < fell < 20


@pytest.mark.parametrize(
    ("source", "read"),
    [
        ("set", "set"),
        ("table.csv", "table.csv"),
        ("example set/a.AT2", [EXAMPLE_FILE, "set/a.AT2"]),
    ],
)
def test_each_source_gives_the_numbers_of_the_function(rocking, source, read):
    found = rk.rocking_spectrum(
        rk.read_record_set(read), size=SIZES, slenderness=ANGLE, levels=0.4, intensity="pga-g"
    ).dataset
    said = json.loads(
        told(rocking, f"{source} --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4 --netcdf out.nc --json")
    )
    with xr.open_dataset("out.nc", engine="h5netcdf") as kept:
        assert kept.load().drop_attrs().equals(found.drop_attrs())
        assert kept.attrs["records_sha256"] == found.attrs["records_sha256"]
    counts = np.bincount(found.outcome.values.ravel(), minlength=3).tolist()
    assert [each["points"] for each in said["outcome"]] == counts
    assert [each["name"] for each in said["records"]] == list(rk.read_record_set(read).names)
    assert said["level"] == 0.4
    assert said["files"] == ["out.nc"]


def test_height_and_width_state_shape_and_size(rocking):
    block = rk.Block(2.0, 0.5)
    told(rocking, "set --height 2 --width 0.5 --netcdf out.nc")
    with xr.open_dataset("out.nc", engine="h5netcdf") as kept:
        assert (kept.attrs["size"], kept.attrs["slenderness"]) == (block.radius, block.critical_angle)
    told(rocking, "set --height 2 --width 0.5 --size 1:2:3 --netcdf out.nc")
    with xr.open_dataset("out.nc", engine="h5netcdf") as kept:
        assert (kept["size"].values.tolist(), kept.attrs["slenderness"]) == (
            [1.0, 1.5, 2.0],
            block.critical_angle,
        )


def test_table_has_a_row_per_run_with_units(rocking, tmp_path):
    told(rocking, "set --size 0.3:3:4 --slenderness-deg 8:10:2 --csv out.csv")
    rows = list(csv.DictReader((tmp_path / "out.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 16
    assert list(rows[0])[:6] == ["record", "name", "size [m]", "slenderness [rad]", "outcome", "certified"]
    found = rk.rocking_spectrum(
        rk.read_record_set("set"),
        size=np.linspace(0.3, 3.0, 4),
        slenderness=np.radians(np.linspace(8, 10, 2)),
    ).dataset
    assert [float(row["peak [theta_cr]"]) for row in rows] == found.peak.values.ravel().tolist()
    margins = [float(row["margin [alpha theta_cr]"]) for row in rows]
    np.testing.assert_array_equal(margins, found.margin.values.ravel())
    assert {row["name"] for row in rows} == {"a.AT2, 180", "b.AT2, 180"}
    radians = found.peak.values * found.slenderness.values
    assert [float(row["peak [rad]"]) for row in rows] == radians.ravel().tolist()
    assert np.isinf(radians).any()
    told(rocking, "set --size 0.3:3:4 --slenderness-deg 8 --csv one.csv")
    one = list(csv.DictReader((tmp_path / "one.csv").read_text(encoding="utf-8").splitlines()))
    expected = [pytest.approx(np.radians(8) * float(row["peak [theta_cr]"])) for row in one]
    assert [float(row["peak [rad]"]) for row in one] == expected


def test_wide_and_large_blocks_are_warned_of(rocking):
    text = told(rocking, "set --size 0.3:20:4 --slenderness-deg 8:20:2")
    assert f"warning: height {40 * np.cos(np.radians(8)):.4g} m is unusual: sizes are in metres" in text
    assert "warning: outside the slender range, θcr = 0.349 rad = 20° and |θ| up to 0.349 rad = 20°" in text
    full = json.loads(told(rocking, "set --size 0.3:3:4 --slenderness-deg 8:20:2 --model full --json"))
    assert (full["model"], full["warnings"]) == ("full", [])


def test_options_of_reading_are_those_of_the_reader_and_a_store_is_written(rocking, tmp_path):
    (tmp_path / "plain.txt").write_text("\n".join(map(str, WAVE)), encoding="utf-8")
    line = "plain.txt --units g --step 0.01 --size 0.5:1:5 --slenderness-deg 8:10:2 --store out.zarr --json"
    for baseline in ("mean", "none"):
        said = json.loads(told(rocking, f"{line.replace('out', baseline)} --baseline {baseline}"))
        motion = rk.read_ground_motion("plain.txt", units="g", step=0.01, baseline=baseline)
        assert said["records"][0]["pga_m_per_s2"] == motion.pga
        assert said["files"] == [f"{baseline}.zarr"]


def test_warning_of_the_reader_is_reported(rocking, tmp_path):
    lines = write.smc([100.0, -200.0, 50.0])
    text = "\n".join(lines).replace("2.0000000E+02", "9.0000000E+02")
    (tmp_path / "a.smc").write_text(text, encoding="utf-8")
    said = json.loads(told(rocking, "a.smc --size 0.3:3:4 --slenderness-deg 10 --json"))
    assert said["warnings"] == ["a.smc: the samples have a PGA of 2 m/s², the header states 9 m/s²"]
