"""`rocking map`: the numbers of the function, its overlays, its store and its study file."""

import csv
import json
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.cli.main import run
from rocking.model.verdict import Criterion
from surveyed import system_with

LINE = "map --amplitude 0:16:20 --period 0.2:3:18 --restitution 0.9 --max-cycles 100"
ASKED = {
    "system": system_with(restitution=0.9),
    "amplitude": np.linspace(0.0, 16.0, 20),
    "period": np.linspace(0.2, 3.0, 18),
    "max_cycles": 100,
}


@pytest.fixture(scope="module")
def found():
    return rk.parametric_map(**ASKED).dataset


def shares(found):
    return {str(kind): int((found.kind == number).sum()) for number, kind in enumerate(rk.Kind)}


def test_what_is_undetermined_says_why_in_plain_words(rocking):
    _, _, out = rocking("map --amplitude 5:6:2 --period 1:2:2 --restitution 0.01")
    (told,) = [line for line in out.splitlines() if "unresolved-reset" in line]
    assert told.endswith(f" 1 point: {Criterion.UNRESOLVED_RESET.why}")


def test_json_and_files_hold_the_numbers_of_the_function(rocking, found):
    read = json.loads(rocking(f"{LINE} --csv map.csv --netcdf map.nc --json")[2])
    assert {each["kind"]: each["points"] for each in read["kind"]} == shares(found)
    assert (read["period_range"], read["period_count"], read["amplitude_count"]) == ([0.2, 3.0], 18, 20)
    assert (read["restitution"], read["max_cycles"], read["max_period"]) == (0.9, 100, 64)
    with xr.open_dataset("map.nc", engine="h5netcdf") as kept:
        assert kept.load().equals(found)
        assert kept.attrs["restitution"] == 0.9
        assert kept.kind.attrs["flag_values"].dtype == np.uint8
    with Path("map.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 360
    row, at = rows[5 * 18 + 7], found.isel(amplitude=5, period=7)
    headings = ("amplitude [g theta_cr]", "period [1/alpha]", "peak [theta_cr]")
    assert [float(row[heading]) for heading in headings] == [at.amplitude, at.period, at.peak]
    assert row["kind"] == list(rk.Kind)[int(at.kind)]


def test_ends_of_an_axis_may_be_typed_in_any_order(rocking):
    line = "map --amplitude 1:3:4 --period 1:2:3 --restitution 0.9 --max-cycles 20 --json"
    assert rocking(line.replace("1:3", "3:1").replace("1:2", "2:1"))[2] == rocking(line)[2]


def test_store_is_gone_on_with(rocking, found):
    for _ in range(2):
        assert rocking(f"{LINE} --store map.zarr")[2].endswith("wrote map.zarr\n")
    assert xr.open_zarr("map.zarr", group="level-0", chunks=None, consolidated=False).load().equals(found)


STUDY = """
amplitude = "0:16:20"
period = { start = 0.2, stop = 3, count = 18 }
restitution = 0.9
max-cycles = 100
"""


def test_a_typed_zero_wins_too(rocking):
    Path("study.toml").write_text(STUDY + "phase = 1\n")
    assert json.loads(rocking("map --study study.toml --phase 0 --json")[2])["phase"] == 0


def test_curves_and_symbols_are_drawn_into_the_picture(rocking, monkeypatch):
    calls = []
    monkeypatch.setattr(rk.plot, "parametric_map", lambda *_, **how: calls.append(how))
    monkeypatch.setattr(rk.plot, "save", lambda *_: None)
    Path("study.toml").write_text(
        STUDY + 'curves = ["melnikov", "existence-1"]\nsymbols = "11"\nplot = "a.png"\n'
    )
    for line in (
        f"{LINE} --curves melnikov,existence-1 --symbols 11 --plot a.png",
        "map --study study.toml",
    ):
        assert rocking(line)[:2] == (0, "")
    assert calls == [{"block": None, "curves": ("melnikov", "existence-1"), "symbols": "11"}] * 2


@pytest.mark.parametrize(
    "options, message",
    [
        ("--curves melnikow --plot a.png", "--curves must be one of 'symmetry-breaking-1', "),
        ("--symbols 12 --plot a.png", "--symbols must be one of 'kinds', '10', '11', '13b'; got '12'"),
        ("--curves melnikov", "--curves needs a plot: give --plot FILE as well"),
        ("--symbols 11 --tiles map", "--symbols needs a plot: give --plot FILE as well"),
        (
            "--curves melnikov --plot a.png --brace-angle 0.3",
            "--curves must lie over a map of a block without braces; got 'brace_angle = 0.3'",
        ),
        ("--curves melnikov --plot a.png --period 1 --angle=-1:1", "--curves must lie over "),
    ],
)
def test_what_cannot_be_drawn_is_refused_before_the_map_is_computed(rocking, monkeypatch, options, message):
    monkeypatch.setattr("rocking.survey.parametric_map.parametric_map", None)
    code, told, _ = rocking(f"{LINE} --store a.zarr {options}")
    assert code == 2
    assert told.startswith(message)
    assert not Path("a.zarr").exists()


def test_axes_in_si_are_those_of_the_block(rocking):
    block = rk.Block(2.0, 0.5)
    line = "map --height 2 --width 0.5 --acceleration 1:8:4 --frequency-hz 0.5:3:5 --max-cycles 50 --netcdf map.nc"
    assert rocking(line)[:2] == (0, "")
    with xr.open_dataset("map.nc", engine="h5netcdf") as found:
        for i, acceleration in enumerate(np.linspace(1, 8, 4)):
            for j, hertz in enumerate(np.linspace(0.5, 3, 5)):
                system = block.system(acceleration=acceleration, frequency_hz=hertz)
                assert found.amplitude[i] == pytest.approx(acceleration, rel=1e-15, abs=0)
                assert found.frequency[j] == pytest.approx(hertz, rel=1e-15, abs=0)
                verdict = rk.classify(system, max_cycles=50)
                assert float(found.peak[i, j]) == pytest.approx(block.radians(verdict.peak), rel=1e-9, abs=0)
                assert list(rk.Kind)[int(found.kind[i, j])] is verdict.kind
        assert found.peak.attrs["units"] == "rad"
        assert found.attrs["restitution"] == block.restitution


def test_axis_may_be_a_list_in_a_study_file(rocking):
    Path("study.toml").write_text(
        "amplitude = [1, 2, 4.0]\nperiod = [1, 2]\nrestitution = 0.9\nmax_cycles = 20\n"
    )
    read = json.loads(rocking("map --study study.toml --json")[2])
    assert (read["amplitude_count"], read["period_count"]) == (3, 2)


def test_store_of_another_map_is_refused_by_the_names_of_options(rocking):
    rocking(f"{LINE} --store map.zarr")
    code, message, _ = rocking(f"{LINE} --store map.zarr --restitution 0.8 --max-cycles 50")
    assert (code, message) == (
        2,
        (
            "--store 'map.zarr' holds a different survey: --restitution is 0.9 there and 0.8 here; --max-cycles is 100 there "
            "and 50 here (give another folder, or the same values)"
        ),
    )


def test_store_of_another_block_is_refused_by_what_follows_from_the_block(rocking):
    line = "map --height 2 --acceleration 1:8:2 --frequency-hz 1:3:2 --max-cycles 5 --store map.zarr"
    rocking(f"{line} --width 0.6")
    told = "--store 'map.zarr' holds a different survey: restitution, which follows from the block, is 0.876147 there and "
    assert rocking(f"{line} --width 0.5")[:2] == (
        2,
        f"{told}0.911765 here (give another folder, or the same values)",
    )
    assert (
        "--restitution is 0.876147 there and 0.9 here" in rocking(f"{line} --width 0.5 --restitution 0.9")[1]
    )


def test_squat_block_with_a_restitution_is_mapped_in_its_units(rocking):
    line = (
        "map --height 0.6 --width 1.8 --acceleration 1:8:2 --frequency-hz 1:3:2 --max-cycles 5 --plot map.png"
    )
    for restitution in ("0.5", "0.5:0.6:2 --frequency-hz 1"):
        assert rocking(f"{line} --restitution {restitution}")[:2] == (0, "")


def test_who_interrupts_a_picture_is_told_that_the_store_is_complete(rocking, monkeypatch, capsys):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("rocking.cli.output.draw", interrupt)
    monkeypatch.setattr("sys.argv", ["rocking", *f"{LINE} --store map.zarr --plot map.png".split()])
    assert run()[0] == 130
    told = "rocking: --store 'map.zarr' is complete; repeat the command to write the remaining files\n"
    assert capsys.readouterr().err == told


def test_study_that_is_no_file_is_refused_before_it_is_read(rocking):
    os.mkfifo("pipe")
    for name in ("/dev/zero", "pipe"):
        told = f"--study must name a TOML file; got '{name}': not a regular file but a device, a pipe or a socket"
        assert rocking(f"map --study {name}")[:2] == (2, told)


def test_study_too_long_or_nested_too_deeply_is_refused(rocking):
    Path("long.toml").write_text("#" * 1_000_001)
    Path("deep.toml").write_text("a=" + "[" * 5000 + "]" * 5000)
    for name, why in (
        ("long", "the file has more than 1,000,000 bytes"),
        ("deep", "the file is nested too deeply"),
    ):
        told = f"--study must name a TOML file; got '{name}.toml': {why}"
        assert rocking(f"map --study {name}.toml")[:2] == (2, told)
    Path("long.toml").write_text((STUDY + "#" * 1_000_000)[:1_000_000])
    assert rocking("map --study long.toml")[0] == 0


def test_study_that_is_no_toml_is_refused(rocking):
    Path("study.toml").write_text("amplitude 1")
    code, message, _ = rocking("map --study study.toml")
    assert code == 2
    assert message.startswith("--study must name a TOML file; got 'study.toml': Expected '=' after a key")


def test_tiles_are_those_of_the_map_in_its_units(rocking, found, tmp_path):
    out = rocking(f"{LINE} --tiles look")[2]
    assert out.endswith("wrote look/index.html\n")
    rk.plot.tiles(found, "expected")
    for path in Path("expected").rglob("*.*"):
        assert path.read_bytes() == (tmp_path / "look" / path.relative_to("expected")).read_bytes()
    rocking(
        "map --height 2 --width 0.5 --acceleration 1:8:4 --frequency-hz 0.5:3:5 --max-cycles 20 --tiles si"
    )
    page = Path("si/index.html").read_text(encoding="utf-8")
    assert '"name": "frequency (Hz)"' in page
    assert "2 m × 0.5 m" in page


CABINET = "map --height 1.8 --width 0.6 --acceleration-g 0.3:0.6:20 --frequency-hz 1:2:3 --max-cycles 50"


def test_json_and_files_of_a_block_have_its_units(rocking):
    read = json.loads(rocking(f"{CABINET} --csv a.csv --netcdf a.nc --json")[2])
    assert (read["block_height_m"], read["block_width_m"]) == (1.8, 0.6)
    assert read["frequency_range_hz"] == pytest.approx([1.0, 2.0])
    slender, lifting = read["warnings"]
    assert "5.4%" in slender
    assert "1 of the 20 accelerations lie between" in lifting
    out = rocking(CABINET)[2]
    assert f"warning: {slender}\nwarning: {lifting}\n" in out
    assert " 2.942 to 5.884 m/s² = 0.3 to 0.6 g\n" in out
    block = rk.Block(1.8, 0.6)
    with Path("a.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {"amplitude", "frequency"}.isdisjoint(rows[0])
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=block.restitution),
        amplitude=np.linspace(*block.amplitude(np.array([0.3, 0.6]) * 9.80665), 20),
        frequency=np.linspace(*block.frequency(np.array([1.0, 2.0])), 3),
        max_cycles=50,
    ).dataset
    peaks = np.array([float(row["peak [rad]"]) for row in rows])
    np.testing.assert_allclose(peaks, block.radians(found.peak.values.ravel()), rtol=1e-9)
    accelerations = [float(row["acceleration [m/s^2]"]) for row in rows[::3]]
    assert accelerations == pytest.approx(np.linspace(0.3, 0.6, 20) * 9.80665)
    assert [float(row["frequency [Hz]"]) for row in rows[:3]] == pytest.approx([1.0, 1.5, 2.0])
    with xr.open_dataset("a.nc", engine="h5netcdf") as found:
        assert [found[name].attrs["units"] for name in ("amplitude", "frequency")] == ["m s-2", "Hz"]
        assert found.amplitude.values == pytest.approx(np.linspace(0.3, 0.6, 20) * 9.80665)
        assert found.frequency.values == pytest.approx([1.0, 1.5, 2.0])
        assert (found.attrs["block_height_m"], found.attrs["block_width_m"]) == (1.8, 0.6)
