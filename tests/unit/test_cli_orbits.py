"""`rocking orbits`: output and files."""

import csv
import json

import numpy as np
import pytest

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
    for each in told(rocking, LINE)["orbit"]:
        start = rk.State(each["start_angle"], each["start_velocity"])
        motion = rk.simulate(SYSTEM, start, cycles=each["period"])
        assert np.hypot(motion.final.angle - start.angle, motion.final.velocity - start.velocity) < 1e-8


def test_chattering_orbit_has_infinitely_many_impacts(rocking, tmp_path):
    line = "--amplitude 1.2 --period 1 --restitution 0.1 --max-period 1"
    out = rocking(f"orbits {line} --csv a.csv")[2]
    (row,) = (row for row in table(out) if "infinitely many" in row)
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        assert "inf" in [row["impacts_per_period"] for row in csv.DictReader(file)]
    (each,) = (each for each in told(rocking, line)["orbit"] if each["impacts_per_period"] is None)
    assert row[3] == each["stability"] == "stable"


def test_block_in_si_has_states_in_degrees(rocking):
    for row, each in zip(table(rocking(f"orbits {SI}")[2])[1:], told(rocking, SI)["orbit"], strict=False):
        assert row[-1].startswith(f"{np.degrees(each['start_angle_rad']):.4g}°, ")


def test_impacts_on_braces_have_a_column(rocking):
    head = table(rocking(f"orbits {LINE} --brace-angle 0.1 --max-period 1")[2])[0]
    assert head[2:4] == ["impacts", "brace impacts"]


def test_proofs_are_shown(rocking):
    pytest.importorskip("flint")
    line = f"{LINE} --max-period 1 --prove"
    head, *rows = table(rocking(f"orbits {line}")[2])
    assert head[-1] == "proof"
    proofs = [orbit.proof for orbit in rk.find_orbits(SYSTEM, 1, prove=True)]
    assert [row[-1] for row in rows] == [f"{proof.bits} bits" for proof in proofs]
    assert [each["proved"] for each in told(rocking, line)["orbit"]] == [proof.proved for proof in proofs]


def test_long_list_is_cut_in_the_text_alone(rocking, monkeypatch, found):
    monkeypatch.setattr("rocking.cli.reports_orbits.MAX_ROWS", 2)
    out = rocking(f"orbits {LINE}")[2]
    assert f"and {len(found) - 2} more (all of them with --json, --csv or --netcdf)" in out
    assert len(table(out)) == 1 + 2 + 1
    assert len(told(rocking, LINE)["orbit"]) == len(found)


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
