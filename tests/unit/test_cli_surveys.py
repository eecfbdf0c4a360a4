"""`rocking basins` and `rocking overturning` as a stranger types them."""

import json

import numpy as np
import pytest

import rocking as rk

BASINS = "basins --amplitude 2 --period 1 --restitution 0.925 --angle=-1:1:21 --velocity=-1:1:21"
CURVE = "overturning --period 1.2:2.2:3 --restitution 0.925 --amplitude 1:6:21 --phases 2"


def test_basins_lists_the_attractors_with_their_shares(rocking, tmp_path):
    code, message, out = rocking(f"{BASINS} --boundary-runs 20000 --plot a.png --netcdf a.nc")
    assert (code, message) == (0, "")
    starts = np.linspace(-1, 1, 21)
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925)
    found = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=20000)
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert lines[0] == f"basins, 441 starts: {len(found.attractors)} responses to be told apart"
    for each, share in zip(found.attractors, found.fractions, strict=True):
        assert any(line.startswith(f"{each.name} {share}") for line in lines)
    assert any(f"uncertainty exponent {found.uncertainty_exponent}" in line for line in lines)
    assert (tmp_path / "a.png").stat().st_size > 10_000
    import xarray as xr

    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as kept:
        assert (kept.attractor.values == found.dataset.attractor.values).all()


def test_basins_for_a_program(rocking):
    code, message, out = rocking(
        "basins --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --samples 300 --boundary-runs 0 --json"
    )
    told = json.loads(out, parse_constant=pytest.fail)
    assert (code, message) == (0, "")
    assert sum(each["fraction"]["count"] for each in told["attractors"]) == told["starts"] == 300
    assert told["uncertainty_exponent"] is None
    assert told["block"]["height_m"] == 2


def test_overturning_lists_the_lowest_amplitudes(rocking, tmp_path):
    code, message, out = rocking(f"{CURVE} --plot b.pdf --json")
    told = json.loads(out, parse_constant=pytest.fail)
    found = rk.overturning_amplitude(
        period=np.linspace(1.2, 2.2, 3), restitution=0.925, amplitude=np.linspace(1, 6, 21), phases=2
    ).dataset
    assert (code, message) == (0, "")
    assert [row["lowest"] for row in told["curve"]] == found.lowest.values.tolist()
    assert told["files"] == ["b.pdf"]
    assert (tmp_path / "b.pdf").exists()
    shown = rocking(CURVE)[2].splitlines()
    assert shown[0].startswith("lowest overturning amplitude from rest")
    assert shown[1].split()[0] == "period"
    assert len(shown) == 5


@pytest.mark.parametrize(
    "line, message",
    [
        ("basins --amplitude 2 --period 1", "missing --restitution"),
        (f"{BASINS} --max-cycles 0", "--max-cycles must be a whole number"),
        (f"{BASINS} --plot a.txt", "--plot must"),
        ("basins --amplitude 2 --period 1 --restitution 0.9 --angle 1:2:x", "'--angle': must be a number or"),
        (
            "basins --amplitude 2 --period 1 --restitution 0.9 --samples 10 --angle 1",
            "--angle must be a pair",
        ),
        ("overturning --period 1", "missing --restitution"),
        ("overturning --restitution 0.9", "give exactly one of --period, --frequency"),
        (f"{CURVE} --phases 1.5", "--phases must be a whole number"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(rocking, line, message):
    code, told, out = rocking(line)
    assert (code, out) == (2, "")
    assert message in told
    assert "\n" not in told
