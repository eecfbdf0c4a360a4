"""Tables of several systems (`--csv`): headings state units, and each row states the system that it belongs to."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from rocking.model.quantity import IN_SI

BLOCK = rk.Block(2.0, 0.5)
TYPED = "--restitution 0.8 --phase 0.5"
PHASE = "phase [rad]"
FAMILIES = {
    "map": f"--amplitude 2:3:2 --period 1:1.2:2 --angle 0.1 --max-cycles 50 {TYPED}",
    "safe-basin": f"--amplitude 2:3:2 --period 1 --samples 5 --max-cycles 50 {TYPED}",
    "orbit-diagram": f"--amplitude 2:3:2 --period 1 --transient 5 --cycles 2 --sweep up {TYPED}",
    "continue": f"--amplitude 2:2.1 --period 1 --step 0.1 {TYPED}",
    "frequency-response": "--amplitude 2 --period 1:1.1:2 --modes 1 --step 0.1 --restitution 0.8",
}


def rows_of(rocking, line):
    assert rocking(f"{line} --csv a.csv")[:2] == (0, "")
    with Path("a.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("command", FAMILIES)
def test_each_row_states_its_system(rocking, command):
    for row in rows_of(rocking, f"{command} {FAMILIES[command]}"):
        assert float(row["restitution"]) == 0.8
        assert 2.0 <= float(row["amplitude [g theta_cr]"]) <= 3.0
        assert 1.0 <= float(row["period [1/alpha]"]) <= 1.2
        assert float(row[PHASE]) == (0.5 if "--phase" in FAMILIES[command] else 0.0) or command == "continue"
        assert float(row.get("angle [theta_cr]", 0.1)) == 0.1 or command == "orbit-diagram"


def test_row_of_a_branch_has_the_phases_of_the_base_and_of_the_first_event(rocking):
    rows = rows_of(rocking, f"continue {FAMILIES['continue']}")
    assert {float(row[PHASE]) for row in rows} == {0.5}
    assert len({float(row["event_phase [rad]"]) for row in rows}) == len(rows)


@pytest.mark.parametrize("fixed", ["--frequency 3", f"--period {2 * math.pi / 3!r}"])
def test_each_row_of_overturning_over_restitution_states_the_base_motion(rocking, fixed):
    line = f"overturning {fixed} --restitution 0.8:0.9:2 --amplitude 1:3:5 --phases 1 --max-cycles 20"
    name, unit, value = (
        ("frequency", "alpha", 3.0) if "freq" in fixed else ("period", "1/alpha", 2 * math.pi / 3)
    )
    rows = rows_of(rocking, line)
    assert [float(row[f"{name} [{unit}]"]) for row in rows] == [value, value]
    assert [float(row["restitution"]) for row in rows] == [0.8, 0.9]
    assert PHASE not in rows[0]
    assert {
        (float(row["amplitude_low [g theta_cr]"]), float(row["amplitude_high [g theta_cr]"])) for row in rows
    } == {(1.0, 3.0)}


def test_each_row_of_overturning_in_si_states_block_and_base_motion(rocking):
    line = "overturning --height 2 --width 0.5 --model full --restitution 0.8:0.9:2 --frequency-hz 1.5"
    for row in rows_of(rocking, f"{line} --acceleration-g 0.2:0.6:3 --phases 1 --max-cycles 20"):
        assert float(row["frequency [Hz]"]) == pytest.approx(1.5, rel=1e-14)
        assert float(row["critical_angle [rad]"]) == pytest.approx(math.atan(0.25), rel=1e-14)


def test_each_row_of_an_overturning_spectrum_states_the_restitution(rocking):
    line = "overturning-spectrum --pulse ricker --amplitude 2:4:3 --frequency 1:2:2 --restitution 0.9"
    assert {row["restitution"] for row in rows_of(rocking, line)} == {"0.9"}


def test_each_row_of_a_safe_basin_states_the_initial_states(rocking):
    line = "safe-basin --height 2 --width 0.5 --acceleration 3:4:2 --frequency-hz 3 --max-cycles 20"
    for row in rows_of(rocking, f"{line} --angle=-0.5:0.25 --samples 7 --seed 3"):
        assert (row["samples"], row["seed"]) == ("7", "3")
        assert float(row["angle_low [rad]"]) == pytest.approx(BLOCK.radians(-0.5), rel=1e-15)
        assert float(row["angle_high [rad]"]) == pytest.approx(BLOCK.radians(0.25), rel=1e-15)
        assert float(row["velocity_low [rad/s]"]) == pytest.approx(-BLOCK.radians_per_second(1), rel=1e-15)
        assert float(row["velocity_high [rad/s]"]) == pytest.approx(BLOCK.radians_per_second(1), rel=1e-15)


def test_absent_counts_are_nan_and_infinitely_many_are_inf(rocking):
    """The dataset has integers there: 0 for no period, -1 for no number of impacts or infinitely many."""
    rows = rows_of(rocking, "map --amplitude 0.5:1.05:2 --period 3:6:2 --restitution 0.5 --max-cycles 300")
    assert [row["kind"] for row in rows] == ["rest", "rest", "periodic", "periodic"]
    counts = [(row["response_period [cycles]"], row["impacts_per_period"]) for row in rows]
    assert counts == [("nan", "nan"), ("nan", "nan"), ("1", "inf"), ("1", "inf")]
    starts = "--angle=-1:1:3 --velocity=-1:1:3 --boundary-runs 0"
    rows = rows_of(rocking, f"basins --amplitude 2 --period 1 --restitution 0.9 {starts}")
    names = ("response_period [cycles]", "impacts_per_period", "brace_hits_per_period")
    assert {row[name] for row in rows if row["kind"] == "overturned" for name in names} == {"nan"}


def test_headings_of_a_map_have_units(rocking):
    row = rows_of(rocking, f"map {FAMILIES['map']}")[0]
    assert list(row) == [
        "amplitude [g theta_cr]",
        "period [1/alpha]",
        "restitution",
        PHASE,
        "angle [theta_cr]",
        "velocity [alpha theta_cr]",
        "kind",
        "evidence",
        "response_period [cycles]",
        "impacts_per_period",
        "brace_hits_per_period",
        "symmetric",
        "exponent [alpha]",
        "exponent_error [alpha]",
        "peak [theta_cr]",
        "transient [cycles]",
        "cycles",
    ]


def test_quantities_given_in_si_are_written_as_they_were_given(rocking):
    """Normalised and converted back, 3 m/s² is 2.9999999999999996, and 2 Hz is 1.9999999999999998."""
    given = "--height 2 --width 0.5 --acceleration 1:6:11 --frequency-hz 1:3:9 --max-cycles 20"
    rows = rows_of(rocking, f"map {given}")
    assert list(dict.fromkeys(row["acceleration [m/s^2]"] for row in rows)) == [
        str(value) for value in np.linspace(1, 6, 11).tolist()
    ]
    assert list(dict.fromkeys(row["frequency [Hz]"] for row in rows)) == [
        str(value) for value in np.linspace(1, 3, 9).tolist()
    ]
    read = json.loads(
        rocking("simulate --height 2 --width 0.5 --acceleration 3 --period-s 0.7 --cycles 2 --json")[2]
    )
    assert (read["acceleration_m_per_s2"], read["period_s"]) == (3.0, 0.7)


def test_conversion_to_si_changes_no_number_by_more_than_rounding():
    amplitudes = np.append(np.random.default_rng(5).uniform(0, 20, 2_000), [np.nan, np.inf, 0.0])
    found, plain = IN_SI["amplitude"].of(BLOCK, amplitudes), BLOCK.acceleration(amplitudes)
    np.testing.assert_allclose(found, plain, rtol=1e-15)
    assert 1_000 < (found == plain).sum() < 2_000
    assert isinstance(IN_SI["amplitude"].of(BLOCK, 1.5), float)
    assert IN_SI["period"].of(BLOCK, np.empty((0, 2))).shape == (0, 2)
