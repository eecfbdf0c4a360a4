"""`rocking modes`: output, files and error messages."""

import csv
import json
import math

import pytest

import rocking as rk
from rocking.cli.output.motion_files import write_modes

THIRD = "--amplitude 6.5 --period 0.4 --restitution 0.925 -n 3"
PAIR = "--amplitude 5.5 --period 0.5 --restitution 0.925 -n 7"
NONE = "--amplitude 0.2 --period 1 --restitution 0.8"
UNDAMPED = "--amplitude 2 --period 1 --restitution 1"
SI = "--height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"


def told(rocking, line):
    code, message, out = rocking(f"modes {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def words(out):
    return [" ".join(line.split()) for line in out.splitlines()]


def test_modes_stand_side_by_side_under_the_amplitudes_that_bound_them(rocking):
    code, message, out = rocking(f"modes {PAIR}")
    fast, slow = rk.theory.symmetric_modes(5.5, 0.5, 0.925, 7)
    lines = words(out)
    assert (code, message) == (0, "")
    assert lines[0] == "2 symmetric (1, 7) modes: 2 admissible, 1 of these stable"
    assert f"modes exist from A_E A = {rk.theory.existence_amplitude(0.5, 0.925, 7):.6g}" in lines
    assert f"stable up to A_SB A = {rk.theory.symmetry_breaking_amplitude(0.5, 0.925, 7):.6g}" in lines
    assert f"speed V after impact {fast.velocity:.6g} {slow.velocity:.6g}" in lines
    assert f"phase φ at impact {fast.phase:.6g} rad {slow.phase:.6g} rad" in lines
    assert f"trace of the half-cycle map {fast.trace:.6g} {slow.trace:.6g}" in lines
    assert "stability stable unstable" in lines
    assert "admissible yes yes" in lines


def test_where_there_is_no_mode_it_says_by_how_much(rocking, tmp_path):
    code, _, out = rocking(f"modes {NONE} --plot a.png")
    begins = rk.theory.existence_amplitude(1.0, 0.8, 1)
    first = out.splitlines()[0]
    below = f"A = 0.2 lies {begins - 0.2:.3g} below A_E = {begins:.6g}"
    assert (code, first) == (0, f"no symmetric (1, 1) mode: {below}, the lowest amplitude with such modes")
    assert (tmp_path / "a.png").stat().st_size > 20_000
    assert told(rocking, NONE)["modes"] == []


def test_without_forcing_it_says_why_there_is_none(rocking):
    out = rocking("modes --amplitude 0 --period 1 --restitution 1")[2]
    assert out.startswith("no symmetric (1, 1) mode at A = 0: without forcing")


def test_without_losses_a_mode_is_neutrally_stable(rocking):
    out = rocking(f"modes {UNDAMPED}")[2]
    assert out.startswith("1 symmetric (1, 1) mode: 1 admissible, 1 of these neutral")


def test_json_agrees_with_the_closed_forms(rocking):
    read, (mode,) = told(rocking, THIRD), rk.theory.symmetric_modes(6.5, 0.4, 0.925, 3)
    (found,) = read["modes"]
    for name in ("velocity", "phase", "trace", "stable", "admissible", "peak", "stability"):
        assert found[name] == getattr(mode, name)
    assert found["multipliers"] == [[value.real, value.imag] for value in mode.multipliers]
    assert (read["n"], read["heteroclinic_amplitude"]) == (3, rk.theory.heteroclinic_amplitude(0.4, 0.925))


def test_json_has_null_for_what_is_beyond_all_numbers(rocking):
    for mode in told(rocking, "--amplitude 8 --period 3000 --restitution 0.9")["modes"]:
        assert (mode["trace"], mode["multipliers"][0]) == (None, [None, 0.0])


def test_block_gives_si(rocking):
    block = rk.Block(2.0, 0.5)
    forcing = block.system(acceleration=4.0, frequency_hz=1.2).forcing
    (mode,) = rk.theory.symmetric_modes(forcing.amplitude, forcing.period, block.restitution, 1)
    lines = words(rocking(f"modes {SI}")[2])
    speed = math.degrees(block.radians_per_second(mode.velocity))
    assert f"speed V after impact {mode.velocity:.6g} = {speed:.4g}°/s" in lines
    top = block.top_displacement(mode.peak)
    assert f"largest |Θ| {mode.peak:.6g} = {block.degrees(mode.peak):.4g}°, top {top:.4g} m" in lines
    begins = rk.theory.existence_amplitude(forcing.period, block.restitution, 1)
    acceleration = block.acceleration(begins)
    assert (
        f"modes exist from A_E A = {begins:.6g} {acceleration:.4g} m/s² = {acceleration / 9.80665:.4g} g"
        in lines
    )
    assert told(rocking, SI)["block"]["height_m"] == 2.0


@pytest.mark.parametrize("line", [THIRD, PAIR, UNDAMPED, SI])
@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_picture_is_written_and_named(rocking, tmp_path, line, suffix):
    code, _, out = rocking(f"modes {line} --plot a.{suffix}")
    assert (code, out.splitlines()[-1]) == (0, f"wrote a.{suffix}")
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{suffix}"]


EVEN = "no mode with even n is symmetric: half a response later the forcing is unchanged, not reversed"
REFUSED = {
    "--amplitude 2": "missing --period and --restitution: give --amplitude, --period (or --frequency) and --restitution",
    "--amplitude 2 --period 1 --restitution 0.9 -n 2": f"-n must be an odd whole number in [1, 9999]; got 2 ({EVEN})",
    "--amplitude 2 --period 1 --restitution 0.9 -n some": "-n must be a number without a unit, "
    "such as 0.6; got 'some'",
    "--amplitude 2 --period 1 --restitution 0": "--restitution must lie in (0, 1] for symmetric modes; got 0.0 "
    "(an impact that stops the block leaves no mode)",
    "--amplitude 2 --period 0 --restitution 0.9": "--period must lie in [0.00628319, 6283.19]; got 0",
    "--amplitude 2 --period 1 --restitution 0.9 --plot a.gif": "--plot must end in .png, .svg, .pdf; got 'a.gif'",
}


@pytest.mark.parametrize("line", REFUSED)
def test_what_has_no_modes_is_refused_in_one_line(rocking, tmp_path, line):
    assert rocking(f"modes {line}") == (2, REFUSED[line], "")
    assert list(tmp_path.iterdir()) == []


def test_picture_has_one_legend_for_both_panels(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(rk.plot, "save", lambda figure, path: figures.append(figure))
    write_modes(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), 1, None, tmp_path / "a.png")
    assert [ax.get_legend() is None for ax in figures[0].axes] == [True, False]


def test_block_out_of_the_slender_range_is_warned_of(rocking):
    line = "--height 2 --width 2 --acceleration 12 --frequency-hz 1.5"
    assert "\nwarning: outside the slender range" in rocking(f"modes {line}")[2]
    assert "41.4%" in told(rocking, line)["warnings"][0]
    assert told(rocking, SI)["warnings"] == []


def test_csv_has_a_row_per_mode_in_both_units(rocking, tmp_path):
    block = rk.Block(2.0, 0.5)
    read = told(rocking, f"{SI} --csv a.csv --plot a.png")
    assert read["files"] == ["a.png", "a.csv"]
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["mode"] for row in rows] == ["faster", "slower"][: len(read["modes"])]
    for row, mode in zip(rows, read["modes"], strict=True):
        assert float(row["velocity [alpha theta_cr]"]) == mode["velocity"]
        assert float(row["velocity [rad/s]"]) == pytest.approx(block.radians_per_second(mode["velocity"]))
        assert float(row["phase [rad]"]) == mode["phase"]
        assert float(row["peak [rad]"]) == pytest.approx(block.radians(mode["peak"]))
        assert [float(row["multiplier_2_real"]), float(row["multiplier_2_imag"])] == mode["multipliers"][1]
        assert (row["stability"], row["admissible"]) == (mode["stability"], str(mode["admissible"]))


def test_csv_without_modes_has_only_headings(rocking, tmp_path):
    assert rocking(f"modes {NONE} --csv a.csv")[0] == 0
    (line,) = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert line.startswith("mode,velocity [alpha theta_cr],phase [rad],")
