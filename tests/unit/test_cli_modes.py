"""`rocking modes`: output and files."""

import csv
import json

import pytest

import rocking as rk

THIRD = "--amplitude 6.5 --period 0.4 --restitution 0.925 -n 3"
PAIR = "--amplitude 5.5 --period 0.5 --restitution 0.925 -n 7"
NONE = "--amplitude 0.2 --period 1 --restitution 0.8"
UNDAMPED = "--amplitude 2 --period 1 --restitution 1"
SI = "--height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"


def told(rocking, line):
    code, message, out = rocking(f"modes {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_modes_stand_side_by_side(rocking):
    fast, slow = rk.theory.symmetric_modes(5.5, 0.5, 0.925, 7)
    title, *rows = (" ".join(line.split()) for line in rocking(f"modes {PAIR}")[2].splitlines())
    assert title == "2 symmetric (1, 7) modes: 2 admissible, 1 of these stable"
    assert f"speed V after impact {fast.velocity:.6g} {slow.velocity:.6g}" in rows
    assert {"mode faster slower", "stability stable unstable", "admissible yes yes"} <= set(rows)


def test_where_there_is_no_mode_it_says_by_how_much(rocking):
    code, _, out = rocking(f"modes {NONE}")
    begins = rk.theory.existence_amplitude(1.0, 0.8, 1)
    first = out.splitlines()[0]
    below = f"A = 0.2 lies {begins - 0.2:.3g} below A_E = {begins:.6g}"
    assert (code, first) == (0, f"no symmetric (1, 1) mode: {below}, the lowest amplitude with such modes")
    assert told(rocking, NONE)["mode"] == []


def test_without_forcing_it_says_why_there_is_none(rocking):
    out = rocking("modes --amplitude 0 --period 1 --restitution 1")[2]
    assert out.startswith("no symmetric (1, 1) mode at A = 0: without forcing")


def test_without_losses_a_mode_is_neutrally_stable(rocking):
    out = rocking(f"modes {UNDAMPED}")[2]
    assert out.startswith("1 symmetric (1, 1) mode: 1 admissible, 1 of these neutral")


def test_json_agrees_with_the_closed_forms(rocking):
    read, (mode,) = told(rocking, THIRD), rk.theory.symmetric_modes(6.5, 0.4, 0.925, 3)
    (found,) = read["mode"]
    for name in ("velocity", "phase", "trace", "admissible", "peak", "stability"):
        assert found[name] == getattr(mode, name)
    for number, value in enumerate(mode.multipliers, 1):
        assert complex(found[f"multiplier_{number}_real"], found[f"multiplier_{number}_imag"]) == value
    assert (read["n"], read["heteroclinic_amplitude"]) == (3, rk.theory.heteroclinic_amplitude(0.4, 0.925))


def test_json_has_null_for_what_is_beyond_all_numbers(rocking):
    for mode in told(rocking, "--amplitude 8 --period 3000 --restitution 0.9")["mode"]:
        assert (mode["trace"], mode["multiplier_1_real"], mode["multiplier_1_imag"]) == (None, None, 0.0)


def test_picture_has_one_legend_for_both_panels(rocking, monkeypatch):
    figures = []
    monkeypatch.setattr(rk.plot, "save", lambda figure, path: figures.append(figure))
    assert rocking("modes --amplitude 2 --period 1 --restitution 0.925 --plot a.png")[0] == 0
    assert [ax.get_legend() is None for ax in figures[0].axes] == [True, False]


def test_csv_has_a_row_per_mode_in_si(rocking, tmp_path):
    read = told(rocking, f"{SI} --csv a.csv")
    assert read["warnings"] == []
    system = rk.Block(2.0, 0.5).system(acceleration=4.0, frequency_hz=1.2)
    (mode,) = rk.theory.symmetric_modes(
        system.forcing.amplitude, system.forcing.period, system.restitution, 1
    )
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    (found,) = read["mode"]
    assert (row["mode"], row["stability"], row["admissible"]) == ("faster", str(mode.stability), "True")
    assert float(row["velocity [rad/s]"]) == found["velocity_rad_per_s"]
    assert found["velocity_rad_per_s"] == pytest.approx(system.block.radians_per_second(mode.velocity))
    assert found["peak_rad"] == float(row["peak [rad]"]) == pytest.approx(system.block.radians(mode.peak))


def test_csv_without_modes_has_only_headings(rocking, tmp_path):
    assert rocking(f"modes {NONE} --csv a.csv")[0] == 0
    (line,) = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert line.startswith("mode,velocity [alpha theta_cr],phase [rad],")
