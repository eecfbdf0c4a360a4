"""JSON and files of each command that computes: they are those of the result of the function, normalised or in SI units."""

import csv
import json

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.records.read import FILE as EXAMPLE

BLOCK = rk.Block(2.0, 0.5)
SIZE = "--height 2 --width 0.5"
SI = f"{SIZE} --acceleration 4 --frequency-hz 1.2"
SYSTEM = rk.System(rk.Harmonic(5.5, period=0.5), 0.925)
TYPED = "--amplitude 5.5 --period 0.5 --restitution 0.925"
IN_SI = BLOCK.system(acceleration=4.0, frequency_hz=1.2)
FULL = BLOCK.system(acceleration=4.0, frequency_hz=1.2, model="full")
RESTS = rk.System(rk.Harmonic(1.1, period=2.0), 0.5)
PULSE = BLOCK.system(rk.Pulse("one-sine", amplitude=0.5 * 9.80665, duration=1.0))
HERTZ = np.array([1.5, 2.0])
LEVELS = np.linspace(0.3, 1.5, 13)


def branch(system, ends, step=0.01):
    return rk.continue_orbit(rk.classify(system).orbit, "amplitude", ends, step)


def amplitudes(*accelerations):
    return tuple(BLOCK.amplitude(np.array(accelerations)).tolist())


CASES = {
    f"simulate {TYPED} --cycles 20": lambda: rk.simulate(SYSTEM, cycles=20),
    f"simulate {SI} --cycles 20": lambda: rk.simulate(IN_SI, cycles=20),
    f"simulate {SIZE} --pulse one-sine --acceleration-g 0.5 --frequency-hz 1": lambda: rk.simulate(PULSE),
    f"record example {SIZE}": lambda: rk.simulate(BLOCK.system(rk.example_ground_motion())),
    f"classify {TYPED} --velocity 0.15": lambda: rk.classify(SYSTEM, rk.State(velocity=0.15)),
    f"classify {SI}": lambda: rk.classify(IN_SI),
    f"classify {SI} --prove": lambda: rk.classify(IN_SI, prove=True),
    "classify --amplitude 1.1 --period 2 --restitution 0.5": lambda: rk.classify(RESTS),
    f"lyapunov {TYPED} --cycles 300": lambda: rk.lyapunov(SYSTEM, cycles=300),
    f"lyapunov {SI} --cycles 300": lambda: rk.lyapunov(IN_SI, cycles=300),
    f"lyapunov {SI} --cycles 100 --model full": lambda: rk.lyapunov(FULL, cycles=100),
    "lyapunov --amplitude 1.1 --period 2 --restitution 0.5 --cycles 200": lambda: rk.lyapunov(
        RESTS, cycles=200
    ),
    f"orbits {TYPED}": lambda: rk.find_orbits(SYSTEM, 3),
    f"orbits {SI} --max-period 1": lambda: rk.find_orbits(IN_SI, 1),
    f"orbits {SI} --model full --effort 0.02 --seed 5 --max-period 1": lambda: rk.find_orbits(
        FULL, 1, effort=0.02, seed=5
    ),
    "continue --amplitude 10:30 --at 15 --period 1 --restitution 0.9 --step 0.05": lambda: branch(
        rk.System(rk.Harmonic(15.0, period=1.0), 0.9), (10, 30), 0.05
    ),
    "continue --amplitude 1:1.5 --at 1.198 --period 5.08 --restitution 0.153": lambda: branch(
        rk.System(rk.Harmonic(1.198, period=5.08), 0.153), (1.0, 1.5)
    ),
    f"continue {SIZE} --acceleration 4:3.5 --frequency-hz 1.2 --step 0.1": lambda: branch(
        IN_SI, amplitudes(3.5, 4.0), 0.1
    ),
    "frequency-response --amplitude 2 --period 0.5:2.5:9 --restitution 0.925": lambda: rk.frequency_response(
        rk.System(rk.Harmonic(2.0, period=1.0), 0.925), period=np.linspace(0.5, 2.5, 9)
    ),
    f"frequency-response {SIZE} --acceleration 4 --frequency-hz 1:2:3 --modes 1": lambda: (
        rk.frequency_response(
            BLOCK.system(acceleration=4.0, frequency_hz=1.0),
            frequency=np.linspace(*BLOCK.frequency(np.array([1.0, 2.0])), 3),
            modes=(1,),
        )
    ),
    f"orbit-diagram {TYPED.replace('5.5', '5:6:3')} --transient 50 --cycles 4": lambda: rk.orbit_diagram(
        SYSTEM, amplitude=np.linspace(5, 6, 3), transient=50, cycles=4
    ),
    f"orbit-diagram {SIZE} --acceleration 2:9:3 --frequency-hz 1.2 --sweep rest --cycles 2": lambda: (
        rk.orbit_diagram(
            IN_SI, amplitude=np.linspace(*amplitudes(2.0, 9.0), 3), sweep="rest", transient=300, cycles=2
        )
    ),
    f"basins {SI} --angle=-1:1:5 --velocity=-0.5:0.5:3 --boundary-runs 0": lambda: rk.basin_map(
        IN_SI, angle=np.linspace(-1, 1, 5), velocity=np.linspace(-0.5, 0.5, 3), boundary_runs=0
    ),
    f"basins {TYPED} --samples 50 --seed 4 --boundary-runs 0": lambda: rk.basin_map(
        SYSTEM, angle=(-1, 1), velocity=(-1, 1), samples=50, seed=4, boundary_runs=0
    ),
    "safe-basin --amplitude 3:6:4 --period 1 --restitution 0.8 --samples 50 --velocity=-0.5:0.25 --seed 3": lambda: (
        rk.safe_basin(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8),
            amplitude=np.linspace(3, 6, 4),
            samples=50,
            velocity=(-0.5, 0.25),
            seed=3,
        )
    ),
    f"safe-basin {SIZE} --acceleration 2:10:5 --frequency-hz 1.2 --samples 50": lambda: rk.safe_basin(
        rk.System(rk.Harmonic(1.0, frequency=IN_SI.forcing.frequency), restitution=BLOCK.restitution),
        amplitude=np.linspace(*amplitudes(2.0, 10.0), 5),
        samples=50,
    ),
    "overturning --period 1.2:2.2:3 --restitution 0.8:0.9:2 --amplitude 1:6:21 --phases 2 --max-cycles 50": lambda: (
        rk.overturning_amplitude(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=1.0),
            period=np.linspace(1.2, 2.2, 3),
            restitution=[0.8, 0.9],
            amplitude=np.linspace(1, 6, 21),
            phases=2,
            max_cycles=50,
        )
    ),
    "overturning --period 1.2 --restitution 0.8 --amplitude 1:6:21 --phases 2 --max-cycles 50": lambda: (
        rk.overturning_amplitude(
            rk.System(rk.Harmonic(1.0, period=1.2), restitution=0.8),
            amplitude=np.linspace(1, 6, 21),
            phases=2,
            max_cycles=50,
        )
    ),
    # The first hits lie at a plain edge. In a fractal, the last digits of an amplitude would move them.
    f"overturning {SIZE} --frequency-hz 1.5:2:2 --acceleration-g 0.2:1:41 --phases 2 --max-cycles 100": lambda: (
        rk.overturning_amplitude(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=BLOCK.restitution),
            frequency=BLOCK.frequency(HERTZ),
            amplitude=BLOCK.amplitude(9.80665 * np.linspace(0.2, 1, 41)),
            phases=2,
            max_cycles=100,
        )
    ),
    f"fragility example {SIZE} --pga-g 0.3:1.5:13 --limit 0.5": lambda: rk.fragility(
        rk.read_record_set([EXAMPLE]), BLOCK, LEVELS, intensity="pga-g", limits=[0.5]
    ),
    f"sensitivity example {SIZE} --pga-g 0.3:1.5:13": lambda: rk.sensitivity(
        rk.read_record_set([EXAMPLE]), BLOCK, LEVELS, intensity="pga-g"
    ),
    f"overturning-set example {SIZE} --pga-g 0.3:1.5:13": lambda: rk.overturning_set(
        rk.read_record_set([EXAMPLE]), BLOCK, LEVELS, intensity="pga-g"
    ),
}


def close(found, expected):
    """Return whether values of JSON agree; numbers may differ by the rounding of a conversion from SI and back."""
    if isinstance(expected, dict):
        return found.keys() == expected.keys() and all(close(found[key], expected[key]) for key in expected)
    if isinstance(expected, list):
        return len(found) == len(expected) and all(map(close, found, expected))
    return found == (pytest.approx(expected, rel=1e-9) if isinstance(expected, float) else expected)


@pytest.mark.parametrize("line", CASES)
def test_json_and_files_are_those_of_the_result(rocking, tmp_path, line):
    block = BLOCK if "--height" in line else None
    files = {"csv": "a.csv", "netcdf": "a.nc"} if not line.startswith("classify") else {}
    code, message, out = rocking(
        f"{line} --json {' '.join(f'--{name} {path}' for name, path in files.items())}"
    )
    assert (code, message) == (0, "")
    read, result = json.loads(out, parse_constant=pytest.fail), CASES[line]()
    assert read["files"] == list(files.values())
    for key, value in json.loads(json.dumps(result.to_dict(block=block), allow_nan=False)).items():
        assert close(read[key], value), key
    if files:
        expected = result.to_xarray(block=block)
        data = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
        xr.testing.assert_allclose(data, expected, rtol=1e-9)
        assert data.attrs.keys() == expected.attrs.keys()
        with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
            heading, *rows = csv.reader(file)
        tables = result.tables(block=block)
        table = tables["cycles_direction" if line.startswith("lyapunov") else next(iter(tables))]
        if "time" not in tables:
            assert heading == list(table)
            for name, column in zip(heading, zip(*rows, strict=True), strict=True):
                expected = table[name]
                if expected.dtype.kind == "f":
                    np.testing.assert_allclose(np.array(column, float), expected, rtol=1e-9)
                else:
                    assert list(column) == [str(each) for each in expected.tolist()]
