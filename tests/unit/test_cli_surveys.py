"""`rocking basins` and `rocking overturning`: output and files."""

import json
from pathlib import Path

import numpy as np
import pytest

import rocking as rk

BASINS = "basins --amplitude 2 --period 1 --restitution 0.925 --angle=-1:1:21 --velocity=-1:1:21"
CURVE = "overturning --period 1.2:2.2:3 --restitution 0.925 --amplitude 1:6:21 --phases 2"


def test_basins_lists_the_attractors_with_their_shares(rocking, tmp_path):
    code, message, out = rocking(f"{BASINS} --boundary-runs 4000 --netcdf a.nc")
    assert (code, message) == (0, "")
    starts = np.linspace(-1, 1, 21)
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925)
    found = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=4000)
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert lines[0] == f"basins of 441 initial states: {len(found.attractors)} attractors"
    for each, share in zip(found.attractors, found.fractions, strict=True):
        assert any(line.startswith(f"{each.name} {share}") for line in lines)
    assert any(f"uncertainty exponent {found.uncertainty_exponent}" in line for line in lines)
    import xarray as xr

    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as kept:
        assert (kept.attractor.values == found.dataset.attractor.values).all()


def test_basins_above_the_tangency_are_not_called_smooth(rocking):
    """A = 3.7 lies above A* = 3.6878, from which on the boundary of overturning is fractal, exactly."""
    code, _, out = rocking(
        "basins --amplitude 3.7 --period 1 --restitution 0.8 --angle=-1:1:40 --velocity=-1:1:40 --boundary-runs 20000"
    )
    assert code == 0
    (told,) = (line for line in out.splitlines() if line.strip().startswith("boundary of overturning"))
    assert "smooth" not in told
    assert "undecided: 0.72–1.13 contains 1" in told
    assert "fractal above A* = 3.68781" in out
    _, _, below = rocking(
        "basins --amplitude 3.6 --period 1 --restitution 0.8 --angle=-1:1:5 --velocity=-1:1:5 --boundary-runs 0"
    )
    assert "theoretical boundary" not in below


def test_basins_for_a_program(rocking):
    code, message, out = rocking(
        "basins --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --samples 300 --boundary-runs 0 --json"
    )
    told = json.loads(out, parse_constant=pytest.fail)
    assert (code, message) == (0, "")
    assert sum(each["count"] for each in told["basin"]) == told["basin"][0]["of"] == 300
    assert told["uncertainty_exponent"] is None
    assert told["block_height_m"] == 2


def test_overturning_lists_the_lowest_amplitudes(rocking):
    code, message, out = rocking(f"{CURVE} --json")
    told = json.loads(out, parse_constant=pytest.fail)
    found = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        period=np.linspace(1.2, 2.2, 3),
        amplitude=np.linspace(1, 6, 21),
        phases=2,
    ).dataset
    assert (code, message) == (0, "")
    assert [row["lowest"] for row in told["period"]] == found.lowest.values.tolist()
    shown = rocking(CURVE)[2].splitlines()
    assert shown[0].startswith("lowest overturning amplitude from rest")
    assert shown[1].split()[0] == "period"
    columns = ("period", "lowest", "resolution", "survived_up_to")
    for row, line in zip(told["period"], shown[2:], strict=True):
        assert [float(word) for word in line.split()[:4]] == pytest.approx(
            [row[name] for name in columns], rel=1e-5
        )


BASINS_STUDY = """
height = 2
width = 0.5
acceleration = 4
frequency-hz = 1.2
angle = "-1:1:7"
velocity = [-0.5, 0, 0.5]
boundary-runs = 0
netcdf = "a.nc"
"""


def test_list_in_a_study_file_is_an_axis_of_basins(rocking):
    Path("study.toml").write_text(BASINS_STUDY)
    line = "basins --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --angle=-1:1:7 --velocity=-0.5:0.5:3"
    told = rocking("basins --study study.toml --json")
    assert told == rocking(f"{line} --boundary-runs 0 --netcdf a.nc --json")


def test_basins_draws_random_starts_between_the_ends_of_a_study_files_axes(rocking):
    Path("study.toml").write_text(BASINS_STUDY.replace("[-0.5, 0, 0.5]", "[-0.5, 0.5]") + "samples = 50\n")
    told = json.loads(rocking("basins --study study.toml --seed 3 --json")[2])
    system = rk.Block(2, 0.5).system(acceleration=4, frequency_hz=1.2)
    found = rk.basin_map(system, angle=(-1, 1), velocity=(-0.5, 0.5), samples=50, seed=3, boundary_runs=0)
    assert [each["name"] for each in told["basin"]] == [each.name for each in found.attractors]
    assert told["basin"][0]["of"] == 50


def test_random_starts_are_said_to_be_random_whatever_the_count_of_their_range(rocking):
    title = rocking(f"{BASINS} --samples 50 --boundary-runs 0")[2].splitlines()[0]
    assert title.startswith("basins of 50 initial states, random within both ranges: ")


def test_basins_of_a_braced_block_begin_between_its_braces(rocking):
    line = "basins --amplitude 2 --period 1 --restitution 0.9 --brace-angle 0.5 --boundary-runs 0 --velocity=-1:1:3"
    told = json.loads(rocking(f"{line} --json")[2])
    assert told["basin"][0]["of"] == 200 * 3
    assert rocking(f"{line} --angle=-0.5:0.5:200 --json") == rocking(f"{line} --json")


def test_what_a_study_file_says_twice_is_refused(rocking):
    Path("study.toml").write_text("max-cycles = 5\nmax_cycles = 6\n")
    told = "study 'study.toml': 'max-cycles' occurs twice, with hyphens and with underscores (remove one)"
    assert rocking("basins --study study.toml")[:2] == (2, told)


@pytest.mark.parametrize("command", ["map", "overturning"])
def test_a_block_of_many_sizes_is_refused(rocking, command):
    Path("study.toml").write_text(
        'height = "1:2:3"\nwidth = 0.5\nfrequency-hz = "1:2:3"\nacceleration = "2:4:3"\n'
    )
    code, told, _ = rocking(f"{command} --study study.toml")
    assert (code, told) == (2, "study 'study.toml': height must be a number; got '1:2:3'")


def test_a_path_is_told_as_it_was_typed(rocking):
    line = "map --amplitude 1:2:3 --period 1:2:3 --restitution 0.9 --max-cycles 20 --store phase/period.zarr"
    assert rocking(line)[0] == 0
    code, told, _ = rocking(line.replace("0.9", "0.8"))
    assert code == 2
    assert "'phase/period.zarr'" in told
    chunk = Path("phase/period.zarr/level-0/cycles/c/0/0")
    chunk.write_bytes(chunk.read_bytes()[:-1])
    code, told, _ = rocking(line)
    assert code == 2
    assert f"is damaged at '{chunk}' (recompute these tiles with --repair)" in told


OF_THE_RECORD = "example --height 2 --width 0.5 --pga-g 0.5:1.5:30"
STORED = {
    "basins": "--amplitude 5.5 --period 1 --restitution 0.8 --samples 50 --boundary-runs 0 --max-cycles 40",
    "safe-basin": "--amplitude 2:9:5 --period 1 --restitution 0.8 --samples 50 --max-cycles 40",
    "fragility": OF_THE_RECORD,
    "sensitivity": OF_THE_RECORD,
    "overturning-set": OF_THE_RECORD,
}


@pytest.mark.parametrize("command", STORED)
def test_a_command_with_a_store_reads_and_repairs_its_results(rocking, command):
    line = f"{command} {STORED[command]}"
    plain = rocking(line)[2]
    stored = f"{plain}wrote kept.zarr\n"
    assert rocking(f"{line} --store kept.zarr") == (0, "", stored)
    digests = next(path for path in Path("kept.zarr").glob("level-0/*/digests/**/*") if path.is_file())
    Path(str(digests).replace("digests", "c")).write_bytes(b"")
    assert "(recompute these tiles with --repair)" in rocking(f"{line} --store kept.zarr")[1]
    assert rocking(f"{line} --store kept.zarr --repair")[2] == stored


def test_a_study_that_begins_with_a_mark_of_its_byte_order_is_read(rocking):
    line = "map --amplitude 1:2:3 --period 1:2:3 --max-cycles 20"
    Path("study.toml").write_text("restitution = 0.9\n", encoding="utf-8-sig")
    assert rocking(f"{line} --study study.toml") == rocking(f"{line} --restitution 0.9")


CABINET = "--height 2 --width 0.5 --phases 2 --max-cycles 100"


def test_overturning_of_a_block_has_its_units_in_the_text(rocking):
    # where the first hits lie at a plain edge: in a fractal, as at 1 Hz, the last digits of an amplitude move them by 10⁻⁵
    hertz, line = (
        np.array([1.5, 2.0]),
        f"overturning {CABINET} --frequency-hz 1.5:2:2 --acceleration-g 0.2:1:41",
    )
    read = json.loads(rocking(f"{line} --json")[2], parse_constant=pytest.fail)
    lowest = np.array([row["lowest_acceleration_m_per_s2"] for row in read["frequency"]])
    assert [row["frequency_hz"] for row in read["frequency"]] == pytest.approx(hertz)
    title, _, *table = rocking(line)[2].splitlines()
    least, g = lowest.min(), lowest.min() / 9.80665
    at = hertz[lowest.argmin()]
    assert title.startswith(
        f"a block of 2 m × 0.5 m overturns from rest at {least:.4g} m/s² = {g:.4g} g and {at:g} Hz; normalised: "
    )
    for row, level, frequency in zip(table, lowest, hertz, strict=True):
        assert [float(word) for word in row.split()[-5:-2]] == pytest.approx(
            [frequency, level, level / 9.80665], rel=1e-3
        )


def test_overturning_of_a_block_scans_the_usual_amplitudes_and_says_where_nothing_falls(rocking):
    told = json.loads(rocking(f"overturning {CABINET} --period-s 0.5 --json")[2])
    unit = rk.Block(2.0, 0.5).acceleration(1.0)
    assert told["acceleration_range_m_per_s2"] == pytest.approx([unit, 16 * unit])
    assert told["amplitudes"] == 301
    title = rocking(f"overturning {CABINET} --period-s 0.5 --acceleration 1:2:5")[2].splitlines()[0]
    assert title.startswith("no overturning from rest")
    assert title.endswith("1 to 2 m/s² = 0.102 to 0.2039 g")


def test_basins_of_a_block_have_its_warnings(rocking):
    line = "basins --height 2 --width 1 --acceleration 6 --frequency-hz 1.2 --angle=-1:1:5 --velocity=-1:1:5"
    assert "warning: outside the slender range" in rocking(f"{line} --boundary-runs 0")[2]


def test_a_picture_of_two_lists_in_a_study_file_is_refused_before_the_scan(rocking, monkeypatch):
    monkeypatch.setattr("rocking.survey.overturning_amplitude.overturning_amplitude", None)
    Path("study.toml").write_text("period = [1, 2]\nrestitution = [0.8, 0.9]\nplot = 'b.png'\n")
    code, message, _ = rocking("overturning --study study.toml")
    wrong = "--plot needs a single axis; got --period and --restitution (give one of them as a number)"
    assert (code, message) == (2, f"{wrong} (study 'study.toml' gives period, restitution, plot)")
