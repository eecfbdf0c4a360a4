"""`rocking lyapunov`: output and files."""

import csv
import json

import pytest
import xarray as xr

import rocking as rk
from rocking.model.text import plus_minus

CHAOS = "--amplitude 10.103037 --period 1.721328 --restitution 0.8 --cycles 3000"
RESTS = "--amplitude 1.1 --period 2 --restitution 0.5 --cycles 200"
SI = "--height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --cycles 300"


def spectrum_of_chaos():
    system = rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8)
    return rk.lyapunov(system, cycles=3000)


def told(rocking, line):
    code, message, out = rocking(f"lyapunov {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_the_first_line_is_that_of_the_result_and_rates_are_per_cycle(rocking):
    code, message, out = rocking(f"lyapunov {CHAOS}")
    spectrum = spectrum_of_chaos()
    assert (code, message) == (0, "")
    assert out.splitlines()[0] == str(spectrum)
    (value, _), (error, _) = spectrum.per_cycle
    row = next(line for line in out.splitlines() if line.startswith("λ₁ per cycle"))
    shown, _, wide = row.split()[3:6]
    assert float(shown) == pytest.approx(value, abs=error / 10)
    assert float(wide) == pytest.approx(error, rel=0.05)
    assert "Kaplan–Yorke dimension of the section" in out


def test_json_holds_the_numbers(rocking):
    read, spectrum = told(rocking, CHAOS), spectrum_of_chaos()
    assert read["exponents"] == spectrum.values.tolist()
    assert read["errors"] == spectrum.errors.tolist()
    assert tuple(read["kaplan_yorke"]) == spectrum.kaplan_yorke
    assert (read["amplitude"], read["cycles"]) == (10.103037, 3000)


def test_each_error_in_si_is_per_second_in_text_json_and_file(rocking, tmp_path):
    block = rk.Block(2.0, 0.5)
    spectrum = rk.lyapunov(block.system(acceleration=4.0, frequency_hz=1.2), cycles=300)
    values, errors = (per_tau / block.seconds(1.0) for per_tau in (spectrum.values, spectrum.errors))
    out = rocking(f"lyapunov {SI} --netcdf {tmp_path}/a.nc")[2]
    for name, value, error in zip(("λ₁", "λ₂"), values, errors, strict=True):
        row = next(line for line in out.splitlines() if line.startswith(f"{name} per cycle"))
        shown = row.removesuffix(" per s").split("   ")[-1]
        assert shown == plus_minus(value, error)
    physical = told(rocking, SI)["block"]
    assert physical["exponents_per_s"] == pytest.approx(values)
    assert physical["errors_per_s"] == pytest.approx(errors)
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    assert data["value_per_s"].values == pytest.approx(values)
    assert data["error_per_s"].values == pytest.approx(errors)
    assert data["running_error_per_s"].values == pytest.approx(
        data["running_error"].values / block.seconds(1.0)
    )
    assert data["error_per_s"].attrs == {
        "long_name": "error of the Lyapunov exponent per second",
        "units": "s-1",
    }


def test_full_block_is_measured(rocking):
    assert told(rocking, f"{SI} --model full")["critical_angle"] == pytest.approx(0.244979, abs=1e-6)


def test_exponents_of_a_block_that_rests_are_null(rocking):
    read = told(rocking, RESTS)
    assert (read["exponents"], read["superstable"], read["kaplan_yorke"]) == ([None, None], True, None)


def test_table_of_superstable_exponents_has_one_row(rocking, tmp_path):
    line = "--height 2 --width 0.5 --acceleration 2.5 --frequency-hz 0.8 --restitution 0.5 --cycles 200"
    assert told(rocking, f"{line} --csv a.csv")["superstable"]
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert row == {"cycles": "200"} | {
        f"{name}_{number} [{unit}]": value
        for unit in ("alpha", "1/s")
        for number in (1, 2)
        for name, value in (("value", "-inf"), ("error", "0.0"))
    }


def test_plot_of_superstable_exponents_is_written_with_the_other_files(rocking, tmp_path):
    code, _, out = rocking(f"lyapunov {RESTS} --plot a.svg --csv a.csv")
    assert (code, out[-22:]) == (0, "wrote a.svg\nwrote a.csv\n"[-22:])
    assert "perturbations vanish" in (tmp_path / "a.svg").read_text()


def test_csv_holds_the_running_estimates_in_both_units(rocking, tmp_path):
    block = rk.Block(2.0, 0.5)
    spectrum = rk.lyapunov(block.system(acceleration=4.0, frequency_hz=1.2), cycles=300)
    assert rocking(f"lyapunov {SI} --csv a.csv")[2].endswith("wrote a.csv\n")
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["cycles"]) for row in rows] == spectrum.history["cycles"].tolist()
    for number in (0, 1):
        for name in ("value", "error"):
            expected = spectrum.history[f"{name}s"][:, number]
            heading = f"{name}_{number + 1}"
            assert [float(row[f"{heading} [alpha]"]) for row in rows] == expected.tolist()
            assert [float(row[f"{heading} [1/s]"]) for row in rows] == pytest.approx(
                expected / block.seconds(1.0)
            )
