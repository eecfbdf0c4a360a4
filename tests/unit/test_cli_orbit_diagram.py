"""`rocking orbit-diagram`: one axis among the options, output and files."""

import json
import re

import pytest

import rocking as rk
from rocking.model.quantity import SYSTEM_QUANTITIES

LINE = "--amplitude 10.4:11.5:12 --period 1.721328 --restitution 0.8 --transient 50 --cycles 4"
SI = "--height 2 --width 0.5 --sweep rest --transient 20 --cycles 2 --json"


def told(rocking, line):
    code, message, out = rocking(f"orbit-diagram {line}")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


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
    assert (read["parameter"], len(read[f"sweep_{parameter}"])) == (parameter, 6)


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
    quantity = SYSTEM_QUANTITIES[parameter]
    forcings = [block.system(**fixed, **{name: value}).forcing for value in (first, last)]
    expected = [quantity.si.of(block, getattr(forcing, parameter)) for forcing in forcings]
    rows = read[f"sweep_{parameter}"]
    assert [rows[0][quantity.si.key], rows[-1][quantity.si.key]] == pytest.approx(expected)


def test_axis_may_run_down_and_leave_its_count_out(rocking):
    read = told(rocking, "--amplitude 3:2 --period 1 --restitution 0.9 --transient 1 --cycles 1 --json")
    values = [row["amplitude"] for row in read["sweep_amplitude"] if row["sweep"] == "up"]
    assert (values[0], values[-1], len(values)) == (2.0, 3.0, 200)


def test_start_and_section_are_passed_on(rocking):
    line = f"{LINE} --angle 0.1 --velocity -0.2 --section-phase 1.5 --sweep down --json"
    read = told(rocking, line)
    assert (read["start_angle"], read["start_velocity"]) == (0.1, -0.2)
    assert read["section_phase"] == 1.5
    assert {row["sweep"] for row in read["sweep_amplitude"]} == {"down"}


def test_all_overturned_has_no_peak(rocking):
    read = told(rocking, "--amplitude 40:50:3 --period 1.7 --restitution 0.8 --sweep rest --json")
    assert {(row["peak"], row["overturned"]) for row in read["sweep_amplitude"]} == {(None, True)}


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


def test_block_has_its_accelerations_in_the_answer_and_its_warnings(rocking):
    out = rocking(f"orbit-diagram {IN_SI}")[2]
    assert "2 to 6 m/s² = 0.2039 to 0.6118 g" in out
    assert told(rocking, f"{IN_SI} --json")["warnings"] == []
