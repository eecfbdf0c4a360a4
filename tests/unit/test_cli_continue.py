"""`rocking continue`: one range among the options, output and files."""

import csv
import json

import pytest
import xarray as xr

import rocking as rk

LINE = "--amplitude 7:0.1 --period 1.721328 --restitution 0.8"
SYSTEM = rk.System(rk.Harmonic(7.0, period=1.721328), 0.8)
SI = "--height 2 --width 0.5 --step 0.05"


@pytest.fixture(scope="module")
def branch():
    return rk.continue_orbit(rk.classify(SYSTEM).orbit, "amplitude", (0.1, 7.0))


def told(rocking, line):
    code, message, out = rocking(f"continue {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def rows_of(out):
    return dict(line.split("   ", 1) for line in out.splitlines()[1:] if "   " in line)


def test_branch_comes_first_then_special_points_and_ends(rocking, branch):
    code, message, out = rocking(f"continue {LINE}")
    assert (code, message) == (0, "")
    assert out.splitlines()[0] == str(branch)
    rows = {name: value.strip() for name, value in rows_of(out).items()}
    assert rows["varied"] == "--amplitude 7 to 0.1"
    assert rows["orbit followed"] == f"stable {branch.orbit(len(branch) - 1)}"
    assert rows["first end"] == f"amplitude {branch.points['parameter'][0]:.6g}: grazing"
    assert rows["last end"] == "amplitude 7: end of the range"
    assert rows["largest |Θ|"] == f"{branch.points['peak'].max():.6g}"


def test_an_orbit_that_rests_is_followed(rocking):
    given = told(rocking, "--amplitude 1:1.5 --at 1.198 --period 5.08 --restitution 0.153")
    system = rk.System(rk.Harmonic(1.198, period=5.08), 0.153)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (1.0, 1.5))
    assert given["points"] == len(branch)
    assert given["orbit"]["impacts_per_period"] is None
    assert [one["kind"] for one in given["special"]] == ["grazing"]


def test_fold_lies_at_the_existence_amplitude(rocking):
    fold = rows_of(rocking(f"continue {LINE}")[2])["fold"].split()[-1]
    assert float(fold) == pytest.approx(rk.theory.existence_amplitude(1.721328, 0.8, 1), abs=1e-9)


def test_orbit_is_found_where_asked_and_followed_both_ways(rocking):
    read = told(rocking, "--amplitude 10:30 --at 15 --period 1 --restitution 0.9 --step 0.05")
    assert (read["orbit"]["amplitude"], read["period"]) == (15.0, 1.0)
    assert [each["amplitude"] for each in read["end"]] == [10.0, 30.0]
    (special,) = read["special"]
    closed_form = rk.theory.symmetry_breaking_amplitude(1.0, 0.9, 1)
    assert (special["kind"], special["amplitude"]) == (
        "symmetry-breaking",
        pytest.approx(closed_form, abs=1e-9),
    )


def test_response_period_finds_an_unstable_orbit_near_the_initial_state(rocking):
    line = "--amplitude 5:6.5 --at 5.5 --period 0.5 --restitution 0.925 --angle 0.064 --velocity 0.054"
    read = told(rocking, f"{line} --response-period 3 --step 0.05")
    system = rk.System(rk.Harmonic(5.5, period=0.5), 0.925)
    orbit = rk.find_orbit(system, rk.State(0.064, 0.054), 3)
    assert read["orbit"] == json.loads(json.dumps(orbit.to_dict()))
    assert (read["orbit_period"], read["orbit"]["stability"]) == (3, "unstable")
    assert told(rocking, f"{line} --step 0.05")["orbit"]["stability"] == "stable"


@pytest.mark.parametrize(
    ("line", "parameter", "ends"),
    [
        ("--amplitude 5 --period 0.4:0.6 --restitution 0.925", "period", (0.4, 0.6)),
        ("--amplitude 5 --frequency 14:12 --restitution 0.925", "frequency", (12.0, 14.0)),
        ("--amplitude 5 --period 0.5 --restitution 0.8:0.9", "restitution", (0.8, 0.9)),
        ("--amplitude 3 --period 1 --restitution 0.9 --brace-angle 0.05:0.1", "brace_angle", (0.05, 0.1)),
        (
            "--amplitude 3 --period 1 --restitution 0.9 --brace-angle 0.05 --brace-restitution 1:0.9",
            "brace_restitution",
            (0.9, 1.0),
        ),
        (
            "--amplitude 3 --period 1 --restitution 0.9 --critical-angle 0.2:0.3 --step 0.1",
            "critical_angle",
            (0.2, 0.3),
        ),
    ],
)
def test_every_parameter_can_be_the_range(rocking, line, parameter, ends):
    read = told(rocking, f"{line} --step 0.1")
    assert read["parameter"] == parameter
    assert [each[parameter] for each in read["end"]] == pytest.approx(ends)


@pytest.mark.parametrize(
    ("line", "key", "ends"),
    [
        ("--acceleration 4:2 --frequency-hz 1.2", "acceleration_m_per_s2", (2.0, 4.0)),
        ("--displacement 0.05:0.08 --frequency-hz 1.2", None, (0.05, 0.08)),
        ("--acceleration 4 --frequency-hz 1.8:1.2", "frequency_hz", (1.2, 1.8)),
        ("--acceleration 4 --period-s 0.6:0.8 --at 0.7", "period_s", (0.6, 0.8)),
    ],
)
def test_ranges_in_si_vary_what_they_are_proportional_to(rocking, tmp_path, line, key, ends):
    read = told(rocking, f"{SI} {line} --csv a.csv --netcdf a.nc")
    block = rk.Block(2.0, 0.5)
    if key is None:
        key = "acceleration_m_per_s2"
        ends = [
            block.acceleration(block.system(displacement=each, frequency_hz=1.2).forcing.amplitude)
            for each in ends
        ]
    assert [each[key] for each in read["end"]] == pytest.approx(ends)
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    assert data[read["parameter"]].values[[0, -1]] == pytest.approx(ends)
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    heading = {"acceleration_m_per_s2": "acceleration [m/s^2]", "period_s": "period [s]"}.get(
        key, "frequency [Hz]"
    )
    assert float(rows[-1][heading]) == pytest.approx(ends[1])
    peaks = [float(row["peak [rad]"]) for row in rows]
    assert max(peaks) == read["peak_rad"]


def test_full_block_is_followed(rocking):
    line = "--height 2 --width 1 --step 0.1 --acceleration 6:6.5 --frequency-hz 1.2"
    read = told(rocking, f"{line} --model full")
    block = rk.Block(2.0, 1.0)
    ends = [
        block.system(acceleration=each, frequency_hz=1.2, model="full").forcing.amplitude
        for each in (6.0, 6.5)
    ]
    system = block.system(acceleration=6.0, frequency_hz=1.2, model="full")
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", tuple(ends), step=0.1)
    assert read["peak_rad"] == block.radians(branch.points["peak"].max())
    assert read["warnings"] == []
    assert "outside the slender range" in rocking(f"continue {line}")[2]
