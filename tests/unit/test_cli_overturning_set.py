"""`rocking overturning-set`: report, files and errors."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.records import EXAMPLE_FILE

BLOCK = rk.Block(2.0, 0.5)
SIZE = "--height 2 --width 0.5"
LEVELS = np.linspace(0.9, 1.3, 60)
AXIS = "--pga-g 0.9:1.3:60"


@pytest.fixture(autouse=True)
def push(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "push.csv").write_text(
        "time (s), acceleration (m/s²)\n0, 0\n0.5, 12\n1, 0\n", encoding="utf-8"
    )


@pytest.fixture(scope="module")
def found():
    return rk.overturning_set(rk.example_ground_motion(), BLOCK, LEVELS, intensity="pga-g")


def test_report_has_a_row_per_record(rocking, found):
    both = rk.overturning_set(
        [rk.example_ground_motion(), rk.read_ground_motion("push.csv")], BLOCK, LEVELS, intensity="pga-g"
    )
    code, message, out = rocking(f"overturning-set example push.csv {SIZE} {AXIS}")
    title, missed, heading, first, second, equation = out.splitlines()
    assert (code, message) == (0, "")
    assert [title, missed] == str(both).splitlines()
    assert missed == f"Intervals and gaps narrower than {np.diff(LEVELS).max():.3g} g may be missed"
    assert heading.split()[:3] == ["record", "lowest", "found,"]
    assert f"{found.lowest[0]:.6g}" in first
    assert f"   {len(found.intervals())}   " in first
    assert second.startswith("push")
    assert "0.9 to 1.3" in second
    small = "small angles; moments overestimated by up to 3.1 % (--model full avoids this)"
    assert equation == f"equation of motion: {small}"


def test_wide_and_large_blocks_are_warned_of(rocking):
    line = "push.csv --height 190 --width 70 --scale 0.5:3:4"
    text = rocking(f"overturning-set {line}")[2]
    assert "warning: height 190 m is unusual: sizes are in metres" in text
    assert "warning: outside the slender range, θcr = 0.353 rad" in text
    full = json.loads(rocking(f"overturning-set {line} --model full --json")[2])
    assert full["model"] == "full"
    assert "height 190 m is unusual: sizes are in metres" in full["warnings"]
    assert not any("slender" in each for each in full["warnings"])


def test_json_holds_intervals_and_switches(rocking, found):
    code, _, out = rocking(f"overturning-set example {SIZE} {AXIS} --json")
    told = json.loads(out)
    assert code == 0
    assert told["levels"] == {"start": 0.9, "stop": 1.3, "count": 60}
    assert told["block"]["restitution"] == BLOCK.restitution
    (one,) = told["records"]
    assert one["intervals"] == found.intervals().tolist()
    assert [each["level"] for each in one["switches"]] == found.switches["level"].tolist()
    assert one["lowest"] == found.lowest[0]
    assert told["spacing"] == found.spacing
    assert told["records_sha256"] == found.records.digest


def test_files_hold_the_switches(rocking, found, tmp_path):
    files = "--plot set.png --csv set.csv --netcdf set.nc"
    code, _, out = rocking(f"overturning-set example {SIZE} {AXIS} {files}")
    assert code == 0
    assert out.endswith("wrote set.png\nwrote set.csv\nwrote set.nc\n")
    assert (tmp_path / "set.png").stat().st_size > 5_000
    with (tmp_path / "set.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["level [g]"]) for row in rows] == found.switches["level"].tolist()
    with xr.open_dataset("set.nc", engine="h5netcdf") as data:
        assert data.switch_level.values.tolist() == found.switches["level"].tolist()
        assert data.attrs["block_height_m"] == 2.0


def test_direction_and_measure_are_those_of_the_options(rocking):
    reversed_ = rk.overturning_set(
        rk.read_ground_motion("push.csv"), BLOCK, np.linspace(0.1, 3, 50), polarity=-1, angle=0.2
    )
    line = f"overturning-set push.csv {SIZE} --scale 3:0.1:50 --polarity -1 --angle 0.2 --json"
    told = json.loads(rocking(line)[2])
    assert (told["polarity"], told["angle"], told["intensity"]) == (-1.0, 0.2, "scale")
    assert told["records"][0]["intervals"] == reversed_.intervals().tolist()


@pytest.fixture
def folder(tmp_path):
    """Two records in a folder, and a table of them with factors."""
    place = tmp_path / "set"
    place.mkdir()
    for name, peak in (("a", 12), ("b", -9)):
        (place / f"{name}.csv").write_text(
            f"time (s), acceleration (m/s²)\n0, 0\n0.5, {peak}\n1, 0\n", encoding="utf-8"
        )
    (tmp_path / "table.csv").write_text("file,scale\nset/a.csv,0.5\nset/b.csv,2\n", encoding="utf-8")
    return place


@pytest.mark.parametrize(
    ("source", "read"),
    [
        ("set", "set"),
        ("table.csv", "table.csv"),
        ("set/a.csv set/b.csv", ["set/a.csv", "set/b.csv"]),
        ("example set/b.csv", [EXAMPLE_FILE, "set/b.csv"]),
    ],
)
def test_each_source_gives_the_numbers_of_the_function(rocking, folder, source, read):
    records = rk.read_record_set(read)
    found = rk.overturning_set(records, BLOCK, np.linspace(0.1, 3, 40))
    said = json.loads(rocking(f"overturning-set {source} {SIZE} --scale 0.1:3:40 --json")[2])
    assert said["records_sha256"] == records.digest
    assert [each["name"] for each in said["records"]] == list(records.names)
    assert [each["intervals"] for each in said["records"]] == [
        found.intervals(number).tolist() for number in range(len(records))
    ]


STUDY = 'height = 2\nwidth = 0.5\npga-g = "0.9:1.3:60"\npolarity = -1\nangle = 0.1\nbaseline = "mean"\ncsv = "a.csv"\n'


def test_study_states_the_options(rocking, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    said = rocking("overturning-set push.csv --study study.toml --json")
    line = f"{SIZE} {AXIS} --polarity -1 --angle 0.1 --baseline mean --csv a.csv --json"
    assert said[:2] == (0, "")
    assert said == rocking(f"overturning-set push.csv {line}")
    assert json.loads(said[2])["polarity"] == -1


def test_options_take_precedence_over_a_study(rocking, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    line = "--pga-g 0.5:1:9 --polarity 1 --angle 0 --baseline none --restitution 0.8 --json"
    said = json.loads(rocking(f"overturning-set push.csv --study study.toml {line}")[2])
    assert said["levels"] == {"start": 0.5, "stop": 1.0, "count": 9}
    assert (said["polarity"], said["angle"], said["block"]["restitution"]) == (1.0, 0.0, 0.8)
    assert said["records_sha256"] == rk.read_record_set("push.csv").digest


@pytest.mark.parametrize(
    ("study", "message"),
    [
        ("pga_g = [0.5, 1]\npolarty = 1", "study 'study.toml': unknown 'polarty' (did you mean 'polarity'?)"),
        ("pga_g = [0.5, 1]\nangle = '0.1'", "study 'study.toml': angle must be a number; got '0.1'"),
        ("pga_g = [0.5, 'a']", "study 'study.toml': pga_g must be a real number or an array of real numbers"),
        ("pga_g = [0.5, 1]\nscale = [1, 2]", "give exactly one of --scale, --pga, --pga-g"),
        ("pga_g = 0.5", "--pga-g must be an axis, START:STOP:COUNT; got 0.5"),
        (
            "pga_g = [1, 0.5]",
            "--pga-g must hold two numbers or more in [1e-09, 1e+06], ascending; got 1.0 before 0.5",
        ),
        ("pga_g = [0.5, 1]\nnetcdf = 'a.txt'", "--netcdf must end in .nc; got 'a.txt'"),
        ("pga_g 1", "--study must name a TOML file; got 'study.toml': "),
    ],
)
def test_wrong_study_is_one_line(rocking, tmp_path, study, message):
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    code, told, out = rocking(f"overturning-set push.csv {SIZE} --study study.toml")
    assert (code, out) == (2, "")
    assert told.startswith(message)
    assert "\n" not in told.strip()


@pytest.mark.parametrize("source", ["set", "table.csv", "set/a.csv"])
def test_no_record_is_overwritten(rocking, folder, source, monkeypatch):
    monkeypatch.setattr("rocking.survey.overturning_set", None)
    code, message, out = rocking(f"overturning-set {source} {SIZE} --scale 0.1:3:40 --csv set/a.csv")
    assert (code, out) == (2, "")
    assert message == "--csv must not overwrite a record; got 'set/a.csv'"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("empty", "empty: the folder holds no record file; the formats are PEER AT2, COSMOS, "),
        ("push.csv push.csv", "push.csv occurs 2 times; name each file once"),
        ("bad.csv", "bad.csv, line 2: column 'scale' must hold numbers; got 'much'"),
        ("missing.csv", "missing.csv: cannot be read: No such file or directory; check the path"),
        (
            "bare.txt",
            "bare.txt: the file does not state the unit of its samples; give it, for example --units=",
        ),
        (
            "push.csv --units g",
            "push.csv: the header names m/s²; omit --units, or correct the header",
        ),
        ("push.csv --baseline cubic", "--baseline must be one of 'none', 'mean', 'linear', 'quadratic'; got"),
    ],
)
def test_sources_that_cannot_be_read_are_one_line(rocking, tmp_path, line, message):
    (tmp_path / "empty").mkdir()
    (tmp_path / "bare.txt").write_text("0\n4\n-4\n0\n", encoding="utf-8")
    (tmp_path / "bad.csv").write_text("file,scale\npush.csv,much\n", encoding="utf-8")
    code, told, out = rocking(f"overturning-set {line} {SIZE} --scale 0.1:3:40")
    assert (code, out) == (2, "")
    assert told.startswith(message)
    assert "\n" not in told.strip()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (f"example {SIZE}", "give exactly one of --scale, --pga, --pga-g"),
        (f"example {SIZE} --pga-g 0.1:1 --scale 1:2", "give exactly one of --scale, --pga, --pga-g"),
        (f"example {SIZE} --pga-g 0.5", "--pga-g must be an axis, START:STOP:COUNT; got 0.5"),
        (f"example {SIZE} --pga-g 0:1:20", "--pga-g must hold two numbers or more in"),
        (f"example {SIZE} --pga-g 0.1:1 --polarity 2", "--polarity must lie in [-1, 1]; got 2"),
        (f"example example {SIZE} --pga-g 0.1:1", "occurs 2 times; name each file once"),
        (f"missing.csv {SIZE} --pga-g 0.1:1", "missing.csv"),
        (f"push.csv {SIZE} --pga-g 0.1:1 --csv push.csv", "--csv must not overwrite a record"),
        ("example --height 2 --pga-g 0.1:1", "--width"),
    ],
)
def test_errors_name_the_options(rocking, line, message):
    code, told, out = rocking(f"overturning-set {line}")
    assert (code, out) == (2, "")
    assert message in told
    assert "\n" not in told.strip()


def test_switches_of_the_full_block_are_not_called_undecided(rocking):
    code, _, out = rocking(f"overturning-set example {SIZE} --pga-g 1:2:40 --model full")
    assert code == 0
    assert "undecided" not in out
