"""`rocking spectrum`: sources, report, files and errors."""

import csv
import json
import re

import numpy as np
import pytest
import xarray as xr

import record_files as write
import rocking as rk
from rocking.records import EXAMPLE_FILE

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
    (tmp_path / "plain").mkdir()
    (tmp_path / "plain" / "c.csv").write_text("time (s), acceleration (g)\n0, 0\n1, 1\n", encoding="utf-8")
    (tmp_path / "list.csv").write_text("file\nplain/c.csv\n", encoding="utf-8")
    (tmp_path / "bare.txt").write_text("0\n4\n-4\n0\n", encoding="utf-8")


def told(rocking, line):
    code, message, out = rocking(f"spectrum {line}")
    assert (code, message) == (0, "")
    return out


def test_report_says_records_blocks_and_outcomes(rocking):
    found = rk.rocking_spectrum(rk.read_record_set("set"), size=SIZES, slenderness=ANGLE)
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
        ("set/a.AT2 set/b.AT2", ["set/a.AT2", "set/b.AT2"]),
        ("table.csv", "table.csv"),
        ("example", EXAMPLE_FILE),
        ("example set/a.AT2", [EXAMPLE_FILE, "set/a.AT2"]),
    ],
)
def test_each_source_gives_the_numbers_of_the_function(rocking, source, read):
    found = rk.rocking_spectrum(
        rk.read_record_set(read), size=SIZES, slenderness=ANGLE, scale=0.4, intensity="pga-g"
    )
    said = json.loads(
        told(rocking, f"{source} --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4 --netcdf out.nc --json")
    )
    with xr.open_dataset("out.nc", engine="h5netcdf") as kept:
        assert kept.load().drop_attrs().equals(found.drop_attrs())
        assert kept.attrs["records_sha256"] == found.attrs["records_sha256"]
    counts = np.bincount(found.outcome.values.ravel(), minlength=3).tolist()
    assert list(said["outcomes"].values()) == counts
    assert said["runs"] == found.outcome.size
    assert [each["name"] for each in said["records"]] == list(rk.read_record_set(read).names)
    assert said["scale"] == 0.4
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
    )
    assert [float(row["peak [theta_cr]"]) for row in rows] == found.peak.values.ravel().tolist()
    margins = [float(row["margin [alpha theta_cr]"]) for row in rows]
    np.testing.assert_array_equal(margins, found.margin.values.ravel())
    assert {row["name"] for row in rows} == {"a.AT2, 180", "b.AT2, 180"}
    degrees = found.peak.values * np.degrees(found.slenderness.values)
    assert [float(row["peak [deg]"]) for row in rows] == pytest.approx(degrees.ravel().tolist())
    assert np.isinf(degrees).any()
    told(rocking, "set --size 0.3:3:4 --slenderness-deg 8 --csv one.csv")
    one = list(csv.DictReader((tmp_path / "one.csv").read_text(encoding="utf-8").splitlines()))
    expected = [pytest.approx(8 * float(row["peak [theta_cr]"])) for row in one]
    assert [float(row["peak [deg]"]) for row in one] == expected


def test_wide_and_large_blocks_are_warned_of(rocking):
    text = told(rocking, "set --size 0.3:20:4 --slenderness-deg 8:20:2")
    assert f"warning: height {40 * np.cos(np.radians(8)):.4g} m is unusual: sizes are in metres" in text
    assert "warning: outside the slender range, θcr = 0.349 rad = 20° and |θ| up to 0.349 rad = 20°" in text
    full = json.loads(told(rocking, "set --size 0.3:3:4 --slenderness-deg 8:20:2 --model full --json"))
    assert (full["model"], full["warnings"]) == ("full", [])


def test_plot_and_store_are_written_and_a_study_states_options(rocking, tmp_path):
    (tmp_path / "study.toml").write_text(
        'size = "0.3:3:10"\nslenderness-deg = [8, 10]\nunits = "g"\nstep = 0.01\nbaseline = "mean"\n',
        encoding="utf-8",
    )
    (tmp_path / "plain.txt").write_text("\n".join(map(str, WAVE)), encoding="utf-8")
    said = json.loads(
        told(rocking, "plain.txt --study study.toml --plot out.png --store out.zarr --size 0.5:1:5 --json")
    )
    assert said["axes"]["size"] == {"start": 0.5, "stop": 1.0, "count": 5}
    assert said["axes"]["slenderness"]["count"] == 2
    assert said["files"] == ["out.zarr", "out.png"]
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    mean = rk.read_ground_motion("plain.txt", units="g", step=0.01, baseline="mean")
    assert said["records"][0]["pga_m_per_s2"] == mean.pga
    said = json.loads(told(rocking, "plain.txt --study study.toml --baseline none --json"))
    assert said["records"][0]["pga_m_per_s2"] == G * np.abs(WAVE).max()


def test_warning_of_the_reader_is_reported(rocking, tmp_path):
    lines = write.smc([100.0, -200.0, 50.0])
    text = "\n".join(lines).replace("2.0000000E+02", "9.0000000E+02")
    (tmp_path / "a.smc").write_text(text, encoding="utf-8")
    said = json.loads(told(rocking, "a.smc --size 0.3:3:4 --slenderness-deg 10 --json"))
    assert said["warnings"] == ["a.smc: the samples have a PGA of 2 m/s², the header states 9 m/s²"]


BLOCK = "--size 0.3:3:4 --slenderness-deg 10"
REFUSED = {
    "no source": (BLOCK, "Missing argument 'SOURCE'."),
    "no block": (
        "set",
        "missing --size and --slenderness-deg: give --size and --slenderness-deg, or --height and --width",
    ),
    "height alone": ("set --height 2", "missing --size and --slenderness-deg: give"),
    "both shapes": (
        f"set {BLOCK} --width 1",
        "give --slenderness-deg or --width, not both: height and width state",
    ),
    "both levels": (f"set {BLOCK} --scale 1 --pga-g 1", "give --scale or --pga-g, not both"),
    "no file": (f"nowhere.at2 {BLOCK}", "nowhere.at2: cannot be read: No such file or directory"),
    "no unit": (
        f"bare.txt {BLOCK}",
        "bare.txt: the file does not state the unit of its samples; give it, for example --units='m/s²'",
    ),
    "unit stated twice": (
        f"set {BLOCK} --units g",
        "a.AT2: the file states the unit of its samples, g; do not give --units",
    ),
    "unit": (
        f"bare.txt {BLOCK} --units feet",
        "--units must be one of 'm/s²', 'cm/s²', 'mm/s²', 'g', 'gal'; got 'feet'",
    ),
    "size": (
        "set --size -1:2:3 --slenderness-deg 10",
        "--size must hold two numbers or more in [0.001, 1000], ascending",
    ),
    "descending": (
        "set --size 2:1:3 --slenderness-deg 10",
        "--size must hold two numbers or more in [0.001, 1000], asc",
    ),
    "slenderness": (
        "set --size 1:2:3 --slenderness-deg 100",
        "--slenderness-deg must lie in [0.00572958, 89.9544]; got 100",
    ),
    "descending slenderness": (
        "set --size 1:2:3 --slenderness-deg 10:5:3",
        "--slenderness-deg must hold two numbers or more in [0.00572958, 89.9544], ascending; got 10.0 before 7.5",
    ),
    "squat": (
        "set --size 1:2:3 --slenderness-deg 60",
        "--slenderness-deg, in rad, must be a critical angle in rad for which",
    ),
    "scale 0": (f"set {BLOCK} --scale 0", "--scale must lie in [1e-09, 1e+06]; got 0"),
    "pga 0": (f"set {BLOCK} --pga-g 0", "--pga-g must lie in [1e-09, 1e+06]; got 0"),
    "single run": (
        "example --size 1 --slenderness-deg 10",
        "--size must be an axis, START:STOP:COUNT, if nothing else varies and there is one record; got 1.0 (rocking record",
    ),
    "plot of levels": (
        f"set {BLOCK} --pga-g 0.1:1:3 --plot a.png",
        "--plot needs one value of --pga-g; got an axis",
    ),
    "plot of a point": (
        "set --size 1 --slenderness-deg 10 --plot a.png",
        "--plot needs an axis: give --size or --slend",
    ),
    "plot of maps": (
        "set --size 1:2:3 --slenderness-deg 5:10:7 --plot a.png",
        "--plot draws one record, or at most 6 values of --slenderness-deg; got 2 records",
    ),
    "record as output": (
        f"table.csv {BLOCK} --csv table.csv",
        "--csv must not overwrite a record; got 'table.csv'",
    ),
    "record of a table as output": (
        f"list.csv {BLOCK} --csv plain/c.csv",
        "--csv must not overwrite a record; got 'plain/c.csv'",
    ),
    "output in the way": (
        f"set {BLOCK} --csv a.csv --netcdf a.csv",
        "--csv and --netcdf must differ; got 'a.csv' for",
    ),
    "kind of file": (f"set {BLOCK} --csv a.txt", "--csv must "),
}


@pytest.mark.parametrize("case", REFUSED)
def test_wrong_input_is_one_line_and_computes_nothing(rocking, tmp_path, case, monkeypatch):
    if case not in ("size", "descending", "squat", "scale 0", "pga 0", "single run"):
        monkeypatch.setattr("rocking.survey.rocking_spectrum", None)
    line, message = REFUSED[case]
    code, found, out = rocking(f"spectrum {line}")
    assert (code, out) == (2, "")
    assert re.search(re.escape(message), found)
    assert "\n" not in found.strip()
