"""`rocking lyapunov`: output and files."""

import json
from pathlib import Path

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


def test_each_error_in_si_is_per_second_in_text_json_and_file(rocking, tmp_path):
    block = rk.Block(2.0, 0.5)
    spectrum = rk.lyapunov(block.system(acceleration=4.0, frequency_hz=1.2), cycles=300)
    values, errors = (per_tau / block.seconds(1.0) for per_tau in (spectrum.values, spectrum.errors))
    out = rocking(f"lyapunov {SI} --netcdf {tmp_path}/a.nc")[2]
    for name, value, error in zip(("λ₁", "λ₂"), values, errors, strict=True):
        row = next(line for line in out.splitlines() if line.startswith(f"{name} per cycle"))
        shown = row.removesuffix(" per s").split("   ")[-1]
        assert shown == plus_minus(value, error)
    physical = told(rocking, SI)["direction"]
    assert [each["exponent_per_s"] for each in physical] == pytest.approx(values)
    assert [each["exponent_error_per_s"] for each in physical] == pytest.approx(errors)
    data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    assert data["exponent"].values == pytest.approx(values)
    assert data["running_exponent_error"].values == pytest.approx(
        spectrum.history["errors"] / block.seconds(1.0)
    )
    assert data["exponent_error"].attrs == {"long_name": "error of the Lyapunov exponent", "units": "s-1"}


def test_full_block_is_measured(rocking):
    assert told(rocking, f"{SI} --model full")["critical_angle"] == pytest.approx(0.244979, abs=1e-6)


def test_exponents_of_a_block_that_rests_are_null(rocking):
    read = told(rocking, RESTS)
    assert [each["exponent"] for each in read["direction"]] == [None, None]
    assert (read["superstable"], read["kaplan_yorke"]) == (True, None)
    assert rocking(f"lyapunov {RESTS} --csv a.csv")[0] == 0
    assert Path("a.csv").read_text().splitlines()[1:] == ["200,1,-inf,0.0", "200,2,-inf,0.0"]


def test_plot_of_superstable_exponents_is_written_with_the_other_files(rocking, tmp_path):
    code, _, out = rocking(f"lyapunov {RESTS} --plot a.svg --csv a.csv")
    assert (code, out[-22:]) == (0, "wrote a.svg\nwrote a.csv\n"[-22:])
    assert "perturbations vanish" in (tmp_path / "a.svg").read_text()
