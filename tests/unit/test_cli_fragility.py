"""`rocking fragility`: the numbers of the function, in text, JSON and files."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.records.read import FILE as EXAMPLE_FILE

BLOCK = rk.Block(2.0, 0.5)
LEVELS = np.linspace(0.2, 1.4, 7)
LINE = "--height 2 --width 0.5 --pga-g 0.2:1.4:7"


@pytest.fixture(autouse=True)
def records(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    motions = rk.synthetic_ground_motions(10, seed=5, duration=10.0)
    for number, motion in enumerate(motions):
        rows = "".join(
            f"{t!r}, {a!r}\n"
            for t, a in zip(motion.times.tolist(), motion.acceleration.tolist(), strict=True)
        )
        (tmp_path / f"r{number}.csv").write_text("time (s), acceleration (m/s²)\n" + rows, encoding="utf-8")
    return motions


NAMES = " ".join(f"r{number}.csv" for number in range(10))


def read():
    return [rk.read_ground_motion(f"r{number}.csv") for number in range(10)]


def test_report_has_the_numbers_of_the_function(rocking):
    code, message, out = rocking(f"fragility {NAMES} {LINE} --limit 0.5")
    assert (code, message) == (0, "")
    found = rk.fragility(read(), BLOCK, LEVELS, intensity="pga-g", limits=0.5)
    lines = out.splitlines()
    assert lines[0] == str(found)
    assert lines[1].split("   ")[0] == "PGA (g)"
    assert "|θ| > 7.02° = 0.5 θcr" in lines[1]
    fit = found.fit()
    assert f"{fit.median:.3g} ({fit.median_low:.3g}–{fit.median_high:.3g})" in lines[-3]
    assert lines[-2].startswith("dispersion")
    assert "equation of motion" in lines[-1]


def test_files_hold_the_probabilities(rocking, tmp_path):
    line = f"fragility {NAMES} example {LINE} --limit 0.1 --limit 0.5 --csv f.csv --netcdf f.nc --json"
    code, message, out = rocking(line)
    assert (code, message) == (0, "")
    found = rk.fragility(
        [*read(), rk.read_ground_motion(EXAMPLE_FILE)], BLOCK, LEVELS, intensity="pga-g", limits=[0.1, 0.5]
    )
    data = found.dataset
    told = json.loads(out)
    assert told["record"][-1]["name"] == rk.read_record_set([EXAMPLE_FILE]).names[0]
    assert [each["fraction"] for each in told["limit_level"]] == data.fraction.values.ravel().tolist()
    assert [each["limit_rad"] for each in told["limit"]] == [BLOCK.radians(0.1), BLOCK.radians(0.5), None]
    assert told["limit"][2]["median"] == found.fit().median
    assert told["files"] == ["f.csv", "f.nc"]
    with (tmp_path / "f.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 21
    assert [float(row["fraction_high"]) for row in rows] == data.fraction_high.values.ravel().tolist()
    limits = {float(row["limit [rad]"]) for row in rows}
    assert limits == {BLOCK.radians(0.1), BLOCK.radians(0.5), np.inf}
    with xr.open_dataset("f.nc", engine="h5netcdf") as kept:
        assert np.array_equal(kept.peak, BLOCK.radians(data.peak.values))
        assert kept.attrs["records_sha256"] == data.attrs["records_sha256"]


def test_an_uncertain_block_is_that_of_the_function(rocking):
    spread = "--samples 3 --width-spread 0.1 --height-spread 0.05 --restitution-spread 0.02 --seed 4 --replicates 200"
    code, _, out = rocking(f"fragility {NAMES} {LINE} {spread}")
    assert code == 0
    found = rk.fragility(
        read(),
        BLOCK,
        LEVELS,
        intensity="pga-g",
        limits=(),
        samples=3,
        width_spread=0.1,
        height_spread=0.05,
        restitution_spread=0.02,
        seed=4,
        replicates=200,
    )
    assert out.splitlines()[0] == str(found)


def test_a_folder_is_the_set_of_its_files(rocking, tmp_path):
    code, message, out = rocking(f"fragility {tmp_path} {LINE}")
    assert (code, message) == (0, "")
    found = rk.fragility(rk.read_record_set(tmp_path), BLOCK, LEVELS, intensity="pga-g")
    assert out.splitlines()[0] == str(found)


def test_levels_of_a_study_may_be_a_list(rocking, tmp_path):
    (tmp_path / "study.toml").write_text("pga-g = [0.2, 0.5, 1.4]\nlimit = 0.5\n", encoding="utf-8")
    said = json.loads(rocking(f"fragility {NAMES} --height 2 --width 0.5 --study study.toml --json")[2])
    assert [each["level"] for each in said["level"]] == [0.2, 0.5, 1.4]


def test_one_level_gives_the_probability_under_the_records_as_they_are(rocking):
    code, _, out = rocking(f"fragility {NAMES} --height 2 --width 0.5 --scale 1")
    assert code == 0
    found = rk.fragility(read(), BLOCK, [1.0], intensity="scale", limits=())
    fell = [rk.simulate(BLOCK.system(motion)).outcome == "overturned" for motion in read()]
    assert float(found.dataset.fraction[0, 0]) == np.mean(fell)
    assert f"{100 * np.mean(fell):g} % (" in out
    with pytest.raises(rk.TooShort, match="give two levels or more"):
        found.fit()


def test_levels_are_those_of_any_measure(rocking):
    said = json.loads(rocking(f"fragility {NAMES} --height 2 --width 0.5 --pgv 0.1:1:4 --json")[2])
    found = rk.fragility(read(), BLOCK, np.linspace(0.1, 1, 4), intensity="pgv", limits=())
    assert (said["intensity"], said["unit"]) == ("pgv", "m/s")
    assert [each["fraction"] for each in said["limit_level"]] == found.dataset.fraction.values[0].tolist()


def test_one_record_is_warned_of(rocking):
    code, _, out = rocking(f"fragility example {LINE}")
    assert code == 0
    assert "warning: 1 record can hardly say how much records differ: use 10 or more" in out


def test_levels_of_the_peak_velocity_warn_of_records_that_drift(rocking, tmp_path):
    path = tmp_path / "push.csv"
    path.write_text("time (s), acceleration (m/s²)\n0, 0\n0.5, 12\n1, 0\n", encoding="utf-8")
    drift = "the PGV and PGD are those of a drift, because "
    for level, ends in (
        ("pgv 0.1:1:4", ["or for example --baseline='linear'"]),
        ("pgv 0.1:1:4 --baseline linear", ["or for example --baseline='quadratic'"]),
        ("pga 1:5:4", []),
    ):
        code, _, out = rocking(f"fragility {path} --height 2 --width 0.5 --{level} --json")
        assert code == 0
        told = [each for each in json.loads(out)["warnings"] if drift in each]
        assert [each.startswith(f"push.csv: {drift}") for each in told] == [True] * len(ends)
        assert [each.partition(": use a corrected record, ")[2] for each in told] == ends
