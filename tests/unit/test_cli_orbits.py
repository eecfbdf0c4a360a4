"""`rocking orbits`: output and files."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk

LINE = "--amplitude 5.5 --period 0.5 --restitution 0.925"
SYSTEM = rk.System(rk.Harmonic(5.5, period=0.5), 0.925)
SI = "--height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --max-period 1"


@pytest.fixture(scope="module")
def found():
    return rk.find_orbits(SYSTEM, 3)


def told(rocking, line):
    code, message, out = rocking(f"orbits {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def table(out):
    """Return the cells of the lines below the empty one: columns are three spaces or more apart."""
    lines = out.partition("\n\n")[2].splitlines()
    return [[cell.strip() for cell in line.split("   ") if cell.strip()] for line in lines]


def test_one_row_per_orbit_below_the_summary(rocking, found):
    code, message, out = rocking(f"orbits {LINE}")
    assert (code, message) == (0, "")
    assert out.splitlines()[0] == str(found)
    head, *rows = table(out)
    assert head[:4] == ["period", "symmetric", "impacts", "stability"]
    assert [row[:4] for row in rows] == [
        [str(one.period), "yes" if one.symmetric else "no", str(one.impacts), str(one.stability)]
        for one in found
    ]
    assert {row[0] for row in rows} == {"1", "3"}


def test_state_of_a_row_repeats_after_its_period(rocking):
    """The states printed are those at τ = 0, from which `rocking simulate` starts."""
    for each in told(rocking, LINE)["orbits"]:
        motion = rk.simulate(SYSTEM, rk.State(**each["start"]), cycles=each["period"])
        ends = motion.final.angle - each["start"]["angle"], motion.final.velocity - each["start"]["velocity"]
        assert np.hypot(*ends) < 1e-8


def test_json_holds_the_numbers(rocking, found):
    read = told(rocking, LINE)
    assert (read["amplitude"], read["max_period"], read["starts"], read["settled"]) == (
        5.5,
        3,
        found.starts,
        True,
    )
    assert [each["hits"] for each in read["orbits"]] == list(found.hits)
    for each, orbit in zip(read["orbits"], found, strict=True):
        assert [complex(*pair) for pair in each["multipliers"]] == list(orbit.multipliers)
        assert each["section"] == {
            "phase": orbit.phase,
            "angle": orbit.state.angle,
            "velocity": orbit.state.velocity,
        }
        assert each["proof"] is None


def test_files_hold_every_orbit(rocking, found, tmp_path):
    assert rocking(f"orbits {LINE} --csv a.csv --netcdf a.nc")[0] == 0
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    multipliers = [
        [complex(float(row[f"multiplier_{n}_real"]), float(row[f"multiplier_{n}_imag"])) for n in (1, 2)]
        for row in rows
    ]
    assert multipliers == [list(orbit.multipliers) for orbit in found]
    assert any(pair[0].imag > 0.0 for pair in multipliers)
    assert [float(row["angle [theta_cr]"]) for row in rows] == [orbit.start.angle for orbit in found]
    assert [int(row["period [cycles]"]) for row in rows] == [orbit.period for orbit in found]
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    assert data["hits"].values.tolist() == list(found.hits)
    assert (data.attrs["amplitude"], data.attrs["restitution"]) == (5.5, 0.925)


def test_chattering_orbit_has_infinitely_many_impacts(rocking, tmp_path):
    line = "--amplitude 1.2 --period 1 --restitution 0.1 --max-period 1"
    out = rocking(f"orbits {line} --csv a.csv")[2]
    (row,) = (row for row in table(out) if "infinitely many" in row)
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        assert "inf" in [row["impacts"] for row in csv.DictReader(file)]
    (each,) = (each for each in told(rocking, line)["orbits"] if each["impacts"] is None)
    assert row[3] == each["stability"] == "stable"


def test_block_in_si_has_states_in_degrees(rocking, tmp_path):
    block = rk.Block(2.0, 0.5)
    out = rocking(f"orbits {SI} --csv a.csv --netcdf a.nc")[2]
    read = told(rocking, SI)
    assert read["block"]["height_m"] == 2.0
    for row, each in zip(table(out)[1:], read["orbits"], strict=False):
        assert row[-1].startswith(f"{block.degrees(each['start']['angle']):.4g}°, ")
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        radians = [float(row["angle [rad]"]) for row in csv.DictReader(file)]
    assert radians == pytest.approx([block.radians(each["start"]["angle"]) for each in read["orbits"]])
    assert xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf").attrs["block_width_m"] == 0.5


def test_full_block_is_searched(rocking):
    line = f"{SI} --effort 0.02 --seed 5"
    system = rk.Block(2.0, 0.5).system(acceleration=4.0, frequency_hz=1.2, model="full")
    expected = rk.find_orbits(system, 1, effort=0.02, seed=5)
    assert [each["start"]["angle"] for each in told(rocking, f"{line} --model full")["orbits"]] == [
        orbit.start.angle for orbit in expected
    ]


def test_impacts_on_braces_have_a_column(rocking):
    head = table(rocking(f"orbits {LINE} --brace-angle 0.1 --max-period 1")[2])[0]
    assert head[2:4] == ["impacts", "brace impacts"]


def test_proofs_are_shown(rocking):
    pytest.importorskip("flint")
    line = f"{LINE} --max-period 1 --prove"
    head, *rows = table(rocking(f"orbits {line}")[2])
    assert head[-1] == "proof"
    bits = [each["proof"]["bits"] for each in told(rocking, line)["orbits"]]
    assert [row[-1] for row in rows] == [f"{each} bits" for each in bits]


def test_long_list_is_cut_in_the_text_alone(rocking, monkeypatch, found):
    monkeypatch.setattr("rocking.cli.reports_orbits.MAX_ROWS", 2)
    out = rocking(f"orbits {LINE}")[2]
    assert f"and {len(found) - 2} more (all of them with --json, --csv or --netcdf)" in out
    assert len(table(out)) == 1 + 2 + 1
    assert len(told(rocking, LINE)["orbits"]) == len(found)


def test_numbers_of_the_size_of_rounding_errors_are_shown_as_zero(rocking):
    """The saddle orbits have Θ' = 0 at the phase 0; rounding leaves some 1e-16."""
    out = rocking("orbits --amplitude 2 --period 1 --restitution 0.9 --max-period 1 --effort 0.05")[2]
    assert out.count("Θ' = 0\n") == 2
    assert "e-1" not in out


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("--amplitude 60 --period 4", "1 orbit of period ≤ 1, 0 of them stable"),
        (
            "--amplitude 1000 --period 30",
            "no orbit of period ≤ 1 was found from 408 initial guesses; completeness",
        ),
    ],
)
def test_summary_counts_one_orbit_and_none(rocking, line, told):
    assert rocking(f"orbits {line} --restitution 0.9 --max-period 1 --effort 0.05")[2].startswith(told)
