"""`rocking orbit-diagram`: one axis among the options, output and files."""

import csv
import json
import re

import numpy as np
import pytest

import rocking as rk

LINE = "--amplitude 10.4:11.5:12 --period 1.721328 --restitution 0.8 --transient 50 --cycles 4"
SYSTEM = rk.System(rk.Harmonic(amplitude=10.4, period=1.721328), restitution=0.8)
DIAGRAM = rk.orbit_diagram(SYSTEM, "amplitude", np.linspace(10.4, 11.5, 12), transient=50, cycles=4)
SI = "--height 2 --width 0.5 --sweep rest --transient 20 --cycles 2 --json"


def told(rocking, line):
    code, message, out = rocking(f"orbit-diagram {line}")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_json_agrees_with_the_diagram(rocking):
    read = told(rocking, f"{LINE} --json")
    assert (read["parameter"], read["first"], read["last"], read["count"]) == ("amplitude", 10.4, 11.5, 12)
    assert (read["period"], read["restitution"]) == (1.721328, 0.8)
    assert "amplitude" not in read
    for row, sweep in enumerate(read["sweeps"]):
        assert sweep["way"] == DIAGRAM.sweeps[row]
        assert sweep["overturned_at"] == DIAGRAM.values[DIAGRAM.overturned[row]].tolist()
        assert sweep["overturned"] == DIAGRAM.overturned[row].sum() > 0
        assert sweep["peak"] == np.nanmax(DIAGRAM.peak[row])


def test_files_hold_every_point(rocking, tmp_path):
    import xarray as xr

    assert rocking(f"orbit-diagram {LINE} --csv a.csv --netcdf a.nc")[0] == 0
    with (tmp_path / "a.csv").open() as file:
        head, *rows = csv.reader(file)
    angle, velocity = "angle [theta_cr]", "velocity [alpha theta_cr]"
    fixed = ["period [1/alpha]", "restitution", "phase [rad]"]
    assert head == ["sweep", "amplitude [g theta_cr]", "cycle", *fixed, angle, velocity]
    gone = [row for row in rows if row[2] == "overturned"]
    assert len(gone) == DIAGRAM.overturned.sum()
    kept = np.array([row[6:] for row in rows if row[2] != "overturned"], float)
    np.testing.assert_array_equal(kept, DIAGRAM.points[~DIAGRAM.overturned].reshape(-1, 2))
    with xr.open_dataset(tmp_path / "a.nc") as read:
        np.testing.assert_array_equal(read["angle"], DIAGRAM.points[..., 0])


@pytest.mark.parametrize(
    "line, parameter",
    [
        ("--amplitude 5 --period 0.4:0.6:3 --restitution 0.925", "period"),
        ("--amplitude 5 --frequency 12:14:3 --restitution 0.925", "frequency"),
        ("--amplitude 5 --period 0.5 --restitution 0.9:1:3", "restitution"),
        ("--amplitude 5 --period 0.5 --restitution 0.9 --phase -1:1:3", "phase"),
        ("--amplitude 5 --period 0.5 --restitution 0.9 --brace-angle 1:2:3", "brace_angle"),
        (
            "--amplitude 5 --period 0.5 --restitution 0.9 --brace-angle 1 --brace-restitution 0:1:3",
            "brace_restitution",
        ),
    ],
)
def test_every_parameter_can_be_the_axis(rocking, line, parameter):
    read = told(rocking, f"{line} --transient 10 --cycles 2 --json")
    assert (read["parameter"], read["count"]) == (parameter, 3)


@pytest.mark.parametrize(
    "line, parameter, ends",
    [
        ("--acceleration 2:4:3 --frequency-hz 1.2", "amplitude", dict(acceleration=(2.0, 4.0))),
        ("--acceleration-g 0.2:0.4:3 --frequency-hz 1.2", "amplitude", dict(acceleration_g=(0.2, 0.4))),
        ("--displacement 0.03:0.05:3 --frequency-hz 1.2", "amplitude", dict(displacement=(0.03, 0.05))),
        ("--acceleration 3 --frequency-hz 1:2:3", "frequency", dict(frequency_hz=(1.0, 2.0))),
        ("--acceleration 3 --period-s 0.5:1:3", "period", dict(period_s=(0.5, 1.0))),
    ],
)
def test_axes_in_si_vary_what_they_are_proportional_to(rocking, line, parameter, ends):
    read = told(rocking, f"{SI} {line}")
    ((name, (first, last)),) = ends.items()
    fixed = {"frequency_hz": 1.2} if parameter == "amplitude" else {"acceleration": 3.0}
    block = rk.Block(2.0, 0.5)
    forcings = [block.system(**fixed, **{name: value}).forcing for value in (first, last)]
    assert read["parameter"] == parameter
    assert [read["first"], read["last"]] == pytest.approx([getattr(f, parameter) for f in forcings])
    assert read["block"]["height_m"] == 2.0


def test_axis_may_run_down_and_leave_its_count_out(rocking):
    read = told(rocking, "--amplitude 3:2 --period 1 --restitution 0.9 --transient 1 --cycles 1 --json")
    assert (read["first"], read["last"], read["count"]) == (2.0, 3.0, 200)


def test_start_and_section_are_passed_on(rocking):
    line = f"{LINE} --angle 0.1 --velocity -0.2 --section-phase 1.5 --sweep down --json"
    read = told(rocking, line)
    assert read["start"] == {"angle": 0.1, "velocity": -0.2}
    assert read["section_phase"] == 1.5
    assert [sweep["way"] for sweep in read["sweeps"]] == ["down"]


def test_all_overturned_has_no_peak(rocking):
    read = told(rocking, "--amplitude 40:50:3 --period 1.7 --restitution 0.8 --sweep rest --json")
    assert read["sweeps"][0]["peak"] is None


def test_run_in_a_terminal_shows_a_bar_on_stderr(terminal, monkeypatch):
    monkeypatch.setattr("sys.argv", ["rocking", "orbit-diagram", *LINE.split()])
    from rocking.cli.main import run

    assert run() == (0, "")
    assert re.fullmatch(r"\[#{20}\] orbit diagram 100 % in 0:00:\d\d", terminal()[-1])


def test_interrupted_diagram_says_so_and_leaves_no_file(interrupted, tmp_path):
    line = "orbit-diagram --amplitude 7:10:1000 --period 1 --restitution 0.9 --transient 1e6 --plot a.png"
    assert interrupted(line, 1.5) == (130, b"", b"rocking: interrupted\n")
    assert not list(tmp_path.iterdir())


IN_SI = "--height 2 --width 0.5 --acceleration 2:6:5 --frequency-hz 1.2"


def test_block_has_its_accelerations_in_the_answer_and_in_the_files(rocking, tmp_path):
    import xarray as xr

    block, asked = rk.Block(2.0, 0.5), np.linspace(2, 6, 5)
    out = rocking(f"orbit-diagram {IN_SI} --csv a.csv --netcdf a.nc")[2]
    assert "2 to 6 m/s² = 0.2039 to 0.6118 g" in out
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert sorted({float(row["acceleration [m/s^2]"]) for row in rows}) == pytest.approx(asked)
    moving = [row for row in rows if row["angle [theta_cr]"]]
    assert len(moving) < len(rows)
    for row in moving[::50]:
        assert float(row["angle [rad]"]) == pytest.approx(block.radians(float(row["angle [theta_cr]"])))
    with xr.open_dataset(tmp_path / "a.nc") as read:
        assert read.acceleration_m_per_s2.values == pytest.approx(asked)
        assert (read.attrs["block_height_m"], read.attrs["block_width_m"]) == (2.0, 0.5)


def test_block_has_its_accelerations_in_json_and_its_warnings(rocking):
    read = told(rocking, f"{IN_SI} --json")
    ends = read["block"]["acceleration_m_per_s2"]
    assert (ends["start"], ends["stop"], ends["count"]) == (2.0, pytest.approx(6.0), 5)
    up = read["sweeps"][0]
    block = rk.Block(2.0, 0.5)
    expected = block.acceleration(np.array(up["overturned_at"]))
    assert up["overturned_at_acceleration_m_per_s2"] == pytest.approx(expected)
    assert up["peak_deg"] == pytest.approx(block.degrees(up["peak"]))
    assert read["warnings"] == []
