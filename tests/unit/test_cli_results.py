"""JSON and files of each command that computes: they are those of the function, with the arguments that the options state."""

import csv
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.records.read import FILE as EXAMPLE

G = 9.80665
BLOCK = rk.Block(2.0, 0.5)
SIZE = "--height 2 --width 0.5"
UNEQUAL = rk.Block(2.0, 0.6, offset=0.05)
UNEQUAL_SIDES = "--height 2 --width 0.6 --offset 0.05"
PULSES = "--pulse one-sine --acceleration-g 0.3:1:8 --frequency-hz 1:2:3"
TABLE = rk.Restitution.table([(0.1, 0.95), (0.8, 0.9)])
WITH_TABLE = rk.Block(2.0, 0.5, TABLE)
SI = f"{SIZE} --acceleration 4 --frequency-hz 1.2"
SYSTEM = rk.System(rk.Harmonic(5.5, period=0.5), 0.925)
TYPED = "--amplitude 5.5 --period 0.5 --restitution 0.925"
PHASED = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), 0.925)
IN_SI_UNITS = BLOCK.system(acceleration=4.0, frequency_hz=1.2)
FULL = BLOCK.system(acceleration=4.0, frequency_hz=1.2, model="full")
RESTS = rk.System(rk.Harmonic(1.1, period=2.0), 0.5)
PULSE = BLOCK.system(rk.Pulse("one-sine", amplitude=0.5 * G, duration=1.0))
HERTZ = np.array([1.5, 2.0])
LEVELS = np.linspace(0.3, 1.5, 13)
SIZES = np.linspace(0.3, 3.0, 10)
pytestmark = [
    pytest.mark.usefixtures("records"),
    pytest.mark.filterwarnings("ignore:.*each copy counts"),
]


def branch(system, ends, step=0.01):
    return rk.continue_orbit(rk.classify(system).orbit, "amplitude", ends, step)


def amplitudes(*accelerations):
    return tuple(BLOCK.amplitude(np.array(accelerations)).tolist())


def of_record(scale=1.0, start=None, block=BLOCK, model="full", **reading):
    ground = rk.read_ground_motion("pulse.csv", **reading)
    return rk.simulate(block.system(ground.scaled(scale), model=model), start)


def spectrum(source="set", **change):
    usual = {"size": SIZES, "slenderness": math.radians(10), "levels": 0.4, "intensity": "pga-g"}
    return rk.rocking_spectrum(rk.read_record_set(source), **usual | change)


def fragility(source="set", levels=LEVELS, intensity="pga-g", **how):
    return rk.fragility(
        rk.read_record_set(source),
        BLOCK,
        levels,
        intensity=intensity,
        **{"limits": ()} | how,
    )


def of_pulses(block, model="full"):
    system = block.system(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), model=model)
    levels = system.block.amplitude(G * np.linspace(0.3, 1, 8))
    return rk.overturning_spectrum(system, amplitude=levels, frequency=block.frequency([1.0, 1.5, 2.0]))


CASES = {
    f"simulate {TYPED} --cycles 20": lambda: rk.simulate(SYSTEM, cycles=20),
    f"simulate {SI} --cycles 20": lambda: rk.simulate(IN_SI_UNITS, cycles=20),
    f"simulate {SIZE} --pulse one-sine --acceleration-g 0.5 --frequency-hz 1": lambda: rk.simulate(PULSE),
    f"record example {SIZE}": lambda: rk.simulate(BLOCK.system(rk.example_ground_motion())),
    f"record example {SIZE} --model slender --normalised-by angle": lambda: rk.simulate(
        BLOCK.system(rk.example_ground_motion(), model="slender", normalised_by="angle")
    ),
    f"classify {TYPED} --velocity 0.15": lambda: rk.classify(SYSTEM, rk.State(velocity=0.15)),
    f"classify {SI}": lambda: rk.classify(IN_SI_UNITS),
    f"classify {SI} --prove": lambda: rk.classify(IN_SI_UNITS, prove=True),
    "classify --amplitude 1.1 --period 2 --restitution 0.5": lambda: rk.classify(RESTS),
    f"lyapunov {TYPED} --cycles 300": lambda: rk.lyapunov(SYSTEM, cycles=300),
    f"lyapunov {SI} --cycles 300": lambda: rk.lyapunov(IN_SI_UNITS, cycles=300),
    f"lyapunov {SI} --cycles 100 --model full": lambda: rk.lyapunov(FULL, cycles=100),
    "lyapunov --amplitude 1.1 --period 2 --restitution 0.5 --cycles 200": lambda: rk.lyapunov(
        RESTS, cycles=200
    ),
    f"orbits {TYPED}": lambda: rk.find_orbits(SYSTEM, 3),
    f"orbits {SI} --max-period 1": lambda: rk.find_orbits(IN_SI_UNITS, 1),
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
        IN_SI_UNITS, amplitudes(3.5, 4.0), 0.1
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
            IN_SI_UNITS,
            amplitude=np.linspace(*amplitudes(2.0, 9.0), 3),
            sweep="rest",
            transient=300,
            cycles=2,
        )
    ),
    f"basins {SI} --angle=-1:1:5 --velocity=-0.5:0.5:3 --boundary-runs 0": lambda: rk.basin_map(
        IN_SI_UNITS, angle=np.linspace(-1, 1, 5), velocity=np.linspace(-0.5, 0.5, 3), boundary_runs=0
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
        rk.System(rk.Harmonic(1.0, frequency=IN_SI_UNITS.forcing.frequency), restitution=BLOCK.restitution),
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
    f"ida example {SIZE} --pga-g 0.3:1.5:13": lambda: rk.incremental_dynamic_analysis(
        rk.read_record_set([EXAMPLE]), BLOCK, LEVELS, intensity="pga-g"
    ),
    f"overturning-set example {SIZE} --pga-g 0.3:1.5:13": lambda: rk.overturning_set(
        rk.read_record_set([EXAMPLE]), BLOCK, LEVELS, intensity="pga-g"
    ),
    "simulate --amplitude 2 --frequency 6 --restitution 0.925 --cycles 5": lambda: rk.simulate(
        rk.System(rk.Harmonic(2.0, frequency=6.0), 0.925), cycles=5
    ),
    # the period of a pulse is that of the whole wave
    "simulate --pulse half-sine --amplitude 1.5 --period 2 --restitution 0.9": lambda: rk.simulate(
        rk.System(rk.Pulse("half-sine", amplitude=1.5, duration=1.0), 0.9)
    ),
    "simulate --pulse one-cosine --amplitude 1.5 --period 2 --restitution 0.9": lambda: rk.simulate(
        rk.System(rk.Pulse("one-cosine", amplitude=1.5, duration=2.0), 0.9)
    ),
    f"record pulse.csv {SIZE} --scale 1.5": lambda: of_record(1.5),
    f"record pulse.csv {SIZE} --scale=-1.5": lambda: of_record(-1.5),
    f"record pulse.csv {SIZE} --pga-g 0.7": lambda: of_record(0.7 * G / 5),
    f"record pulse.csv {SIZE} --restitution 0.5": lambda: of_record(block=rk.Block(2.0, 0.5, 0.5)),
    f"record pulse.csv {SIZE} --inertia-ratio 1.5": lambda: of_record(
        block=rk.Block(2.0, 0.5, inertia_ratio=1.5)
    ),
    f"record pulse.csv {SIZE} --angle 0.2 --velocity=-0.1": lambda: of_record(start=rk.State(0.2, -0.1)),
    f"record pulse.csv {SIZE} --baseline mean --model full": lambda: of_record(baseline="mean", model="full"),
    f"classify {TYPED} --phase 1.8 --velocity 0.15 --max-period 9 --max-cycles 1000": lambda: rk.classify(
        PHASED, rk.State(velocity=0.15), max_period=9, max_cycles=1000
    ),
    f"classify {TYPED} --phase 1.8 --velocity 0.15 --max-period 10 --max-cycles 1000": lambda: rk.classify(
        PHASED, rk.State(velocity=0.15), max_period=10, max_cycles=1000
    ),
    f"orbits {TYPED} --max-period 1 --prove": lambda: rk.find_orbits(SYSTEM, 1, prove=True),
    f"continue {SIZE} --acceleration 4:3.9 --frequency-hz 1.2 --step 0.1 --model full": lambda: branch(
        FULL, tuple(BLOCK.system(acceleration=a, frequency_hz=1.2).forcing.amplitude for a in (3.9, 4.0)), 0.1
    ),
    "frequency-response --amplitude 10.103037 --frequency 3.65:3.6:2 --restitution 0.8 --modes 5 --modes 1 --step 0.05 "
    "--max-cycles 50": lambda: rk.frequency_response(
        rk.System(rk.Harmonic(10.103037, frequency=3.6), 0.8),
        frequency=[3.6, 3.65],
        modes=(5, 1),
        step=0.05,
        max_cycles=50,
    ),
    "orbit-diagram --amplitude 3:2 --period 1 --restitution 0.9 --transient 1 --cycles 1": lambda: (
        rk.orbit_diagram(
            rk.System(rk.Harmonic(2.0, period=1.0), 0.9),
            amplitude=np.linspace(3, 2, 200),
            transient=1,
            cycles=1,
        )
    ),
    f"orbit-diagram {TYPED.replace('5.5', '5:6:3')} --transient 50 --cycles 4 --angle 0.1 --velocity -0.2 --section-phase 1.5 "
    "--sweep down": lambda: rk.orbit_diagram(
        SYSTEM,
        rk.State(0.1, -0.2),
        amplitude=np.linspace(5, 6, 3),
        transient=50,
        cycles=4,
        section_phase=1.5,
        sweep="down",
    ),
    f"safe-basin {SIZE} --displacement 0.1:0.2:3 --frequency-hz 1.2 --samples 20": lambda: rk.safe_basin(
        IN_SI_UNITS,
        amplitude=np.linspace(*amplitudes(*(np.array([0.1, 0.2]) * (2 * np.pi * 1.2) ** 2)), 3),
        samples=20,
    ),
    f"overturning {SIZE} --period-s 0.5 --phases 2 --max-cycles 100": lambda: rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=BLOCK.time(0.5)), BLOCK.restitution), phases=2, max_cycles=100
    ),
    "map --amplitude 6:0:5 --period 3:0.2:4 --restitution 0.9 --phase 0.5 --max-cycles 100": lambda: (
        rk.parametric_map(
            rk.System(rk.Harmonic(1.0, period=1.0, phase=0.5), 0.9),
            amplitude=np.linspace(0, 6, 5),
            period=np.linspace(0.2, 3, 4),
            max_cycles=100,
        )
    ),
    f"map {SIZE} --acceleration 1:8:4 --frequency-hz 0.5:3:5 --max-cycles 50": lambda: rk.parametric_map(
        IN_SI_UNITS,
        amplitude=BLOCK.amplitude(np.linspace(1, 8, 4)),
        frequency=BLOCK.frequency(np.linspace(0.5, 3, 5)),
        max_cycles=50,
    ),
    "overturning-spectrum --pulse one-sine --amplitude 1:10:9 --frequency 1:8:7 --restitution 0.8:0.9:3": lambda: (
        rk.overturning_spectrum(
            rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9),
            amplitude=np.linspace(1, 10, 9),
            frequency=np.linspace(1, 8, 7),
            restitution=np.linspace(0.8, 0.9, 3),
        )
    ),
    f"overturning-spectrum --pulse half-sine {SIZE} --acceleration-g 0.3:2:9 --frequency-hz 0.5:2:7 --model slender": lambda: (
        rk.overturning_spectrum(
            BLOCK.system(rk.Pulse("half-sine", amplitude=1.0, duration=1.0), model="slender"),
            amplitude=np.linspace(0.3, 2, 9) / (BLOCK.width / BLOCK.height),
            frequency=BLOCK.frequency(np.linspace(0.5, 2, 7)),
        )
    ),
    **{
        f"overturning-spectrum {UNEQUAL_SIDES} {PULSES} --model {model}": lambda model=model: of_pulses(
            UNEQUAL, model=model
        )
        for model in ("slender", "full")
    },
    f"overturning-spectrum {SIZE} {PULSES} --restitution-table 0.1:0.95,0.8:0.9 "
    "--restitution-scatter 0.02:uniform:3": lambda: of_pulses(
        rk.Block(2.0, 0.5, TABLE.scattered(0.02, "uniform", 3))
    ),
    f"map {SIZE} --acceleration 2:5:4 --frequency-hz 1:2:3 --max-cycles 50 --model full --restitution-table 0.1:0.95,0.8:0.9": lambda: (
        rk.parametric_map(
            WITH_TABLE.system(acceleration=4.0, frequency_hz=1.2, model="full"),
            amplitude=BLOCK.amplitude(np.linspace(2, 5, 4)),
            frequency=BLOCK.frequency(np.linspace(1, 2, 3)),
            max_cycles=50,
        )
    ),
    f"classify {SI} --model full --restitution-table 0.1:0.95,0.8:0.9": lambda: rk.classify(
        WITH_TABLE.system(acceleration=4.0, frequency_hz=1.2, model="full")
    ),
    f"spectrum set {UNEQUAL_SIDES} --size 1:2:3 --pga-g 0.4 --restitution 0.88": lambda: rk.rocking_spectrum(
        rk.read_record_set("set"),
        rk.Block(2.0, 0.6, 0.88, offset=0.05),
        size=[1.0, 1.5, 2.0],
        levels=0.4,
        intensity="pga-g",
    ),
    f"fragility set {SIZE} --pga-g 0.3:1.5:13 --samples 3 --width-spread 0.1 --height-spread 0.05 --restitution-spread 0.02 "
    "--seed 4 --replicates 200": lambda: fragility(
        samples=3, width_spread=0.1, height_spread=0.05, restitution_spread=0.02, seed=4, replicates=200
    ),
    f"fragility set/a.AT2 example {SIZE} --pga-g 0.3:1.5:13 --limit 0.1 --limit 0.5": lambda: fragility(
        ["set/a.AT2", EXAMPLE], limits=[0.1, 0.5]
    ),
    f"fragility table.csv {SIZE} --scale 1": lambda: fragility("table.csv", [1.0], "scale"),
    f"fragility set {SIZE} --pgv 0.1:1:4": lambda: fragility(levels=np.linspace(0.1, 1, 4), intensity="pgv"),
    f"sensitivity table.csv {SIZE} --scale 0.5:3:20 --seed 3": lambda: rk.sensitivity(
        rk.read_record_set("table.csv"), BLOCK, np.linspace(0.5, 3, 20), seed=3
    ),
    f"overturning-set push.csv {SIZE} --scale 3:0.1:50 --polarity -1 --angle 0.2": lambda: rk.overturning_set(
        rk.read_record_set(["push.csv"]), BLOCK, np.linspace(0.1, 3, 50), polarity=-1, angle=0.2
    ),
    "spectrum set --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4": spectrum,
    "spectrum table.csv --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4": lambda: spectrum("table.csv"),
    "spectrum example set/a.AT2 --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4": lambda: spectrum(
        [EXAMPLE, "set/a.AT2"]
    ),
    f"spectrum set {SIZE} --scale 0.4": lambda: spectrum(
        size=BLOCK.radius, slenderness=BLOCK.critical_angle, intensity="scale"
    ),
    f"spectrum set {SIZE} --size 1:2:3 --pga-g 0.4": lambda: spectrum(
        size=[1.0, 1.5, 2.0], slenderness=BLOCK.critical_angle
    ),
    "spectrum wave.txt --units g --step 0.01 --baseline mean --size 0.3:3:10 --slenderness-deg 10 --pga-g 0.4": lambda: (
        rk.rocking_spectrum(
            rk.read_ground_motion("wave.txt", units="g", step=0.01, baseline="mean"),
            size=SIZES,
            slenderness=math.radians(10),
            levels=0.4,
            intensity="pga-g",
        )
    ),
}
CONVERTED = ("-hz", "-s ", "record")
"""Parts of command lines whose quantities are converted from SI and back."""


def close(found, expected, rel):
    """Return whether values of JSON agree; numbers may differ by the rounding of a conversion from SI and back."""
    if isinstance(expected, dict):
        return found.keys() == expected.keys() and all(
            close(found[key], expected[key], rel) for key in expected
        )
    if isinstance(expected, list):
        return len(found) == len(expected) and all(
            close(*each, rel) for each in zip(found, expected, strict=True)
        )
    return found == (
        pytest.approx(expected, rel=rel, abs=1e-3 * rel) if isinstance(expected, float) else expected
    )


@pytest.mark.parametrize("line", CASES)
def test_json_and_files_are_those_of_the_result(rocking, line):
    block = None if line.startswith("spectrum") or "--height" not in line else BLOCK
    rel = 1e-9 if any(part in line for part in CONVERTED) else 0.0
    files = {"csv": "a.csv", "netcdf": "a.nc"} if not line.startswith("classify") else {}
    code, message, out = rocking(
        f"{line} --json {' '.join(f'--{name} {path}' for name, path in files.items())}"
    )
    assert (code, message) == (0, "")
    read, result = json.loads(out, parse_constant=pytest.fail), CASES[line]()
    own = line.startswith("record") or "--offset" in line or "--restitution-" in line
    block = result.block if own else block
    assert read["files"] == list(files.values())
    for key, value in json.loads(json.dumps(result.to_dict(block=block), allow_nan=False)).items():
        assert close(read[key], value, rel), key
    if "peak_top_displacement_m" in read:
        assert read["peak_top_displacement_m"] == pytest.approx(2.0 * math.sin(read["peak_rad"]), rel=1e-15)
    if files:
        expected = result.to_xarray(block=block)
        data = xr.load_dataset("a.nc", engine="h5netcdf")
        xr.testing.assert_allclose(data, expected, rtol=rel, atol=0)
        assert data.attrs.keys() == expected.attrs.keys()
        assert {name: each.attrs.keys() for name, each in data.variables.items()} == {
            name: each.attrs.keys() for name, each in expected.variables.items()
        }
        with Path("a.csv").open(encoding="utf-8", newline="") as file:
            heading, *rows = csv.reader(file)
        tables = result.tables(block=block)
        table = tables["cycles_direction" if line.startswith("lyapunov") else next(iter(tables))]
        if "time" not in tables and not line.startswith("spectrum"):
            assert heading == list(table)
            for name, column in zip(heading, zip(*rows, strict=True), strict=True):
                expected = table[name]
                if expected.dtype.kind == "f":
                    # files state levels without the rounding of their axis
                    rtol = 4 * np.finfo(float).eps if name.startswith("level") else rel
                    np.testing.assert_allclose(np.array(column, float), expected, rtol=rtol)
                else:
                    assert list(column) == [str(each) for each in expected.tolist()]


@pytest.mark.parametrize(
    ("same", "as_acceleration"),
    [
        ("--acceleration-g 0.3 --period-s 0.8", 0.3 * G),
        ("--displacement 0.05 --frequency-hz 1.25", 0.05 * (2 * np.pi * 1.25) ** 2),
    ],
)
def test_base_motion_may_be_given_in_other_units(rocking, same, as_acceleration):
    read = json.loads(rocking(f"simulate {SIZE} {same} --cycles 3 --json")[2])
    assert read["acceleration_m_per_s2"] == pytest.approx(as_acceleration, rel=1e-14, abs=0)
    assert read["period_s"] == pytest.approx(0.8, rel=1e-14, abs=0)


BRACED = "--amplitude 2 --period 1 --restitution 0.9 --brace-angle 0.5 --boundary-runs 0 --velocity=-1:1:3"


@pytest.mark.parametrize(
    "line, other",
    [
        (f"simulate {TYPED}", f"simulate {TYPED.replace('--period 0.5', f'--frequency {4 * np.pi}')}"),
        (f"basins {BRACED}", f"basins {BRACED} --angle=-0.5:0.5:200"),
    ],
)
def test_other_options_that_state_the_same_give_the_same(rocking, line, other):
    assert rocking(f"{line} --json") == rocking(f"{other} --json")


SHORT = {"continue": "--step 0.1", "orbit-diagram": "--transient 10 --cycles 2 --sweep rest"}
VARIED = {
    "--amplitude 5 --period 0.4:0.6 --restitution 0.925": ("period", (0.4, 0.6)),
    "--amplitude 5 --frequency 14:12 --restitution 0.925": ("frequency", (12.0, 14.0)),
    "--amplitude 5 --period 0.5 --restitution 0.8:0.9": ("restitution", (0.8, 0.9)),
    "--amplitude 3 --period 1 --restitution 0.9 --brace-angle 0.05:0.1": ("brace_angle", (0.05, 0.1)),
    "--amplitude 3 --period 1 --restitution 0.9 --brace-angle 0.05 --brace-restitution 1:0.9": (
        "brace_restitution",
        (0.9, 1.0),
    ),
    "--amplitude 3 --period 1 --restitution 0.9 --critical-angle 0.2:0.3": ("critical_angle", (0.2, 0.3)),
    f"{SIZE} --acceleration 4:2 --frequency-hz 1.2": ("amplitude", (2.0, 4.0)),
    f"{SIZE} --acceleration-g 0.4:0.2 --frequency-hz 1.2": ("amplitude", (0.2 * G, 0.4 * G)),
    f"{SIZE} --displacement 0.05:0.08 --frequency-hz 1.2": (
        "amplitude",
        (0.05 * (2 * np.pi * 1.2) ** 2, 0.08 * (2 * np.pi * 1.2) ** 2),
    ),
    f"{SIZE} --acceleration 4 --frequency-hz 1.8:1.2": ("frequency", (1.2, 1.8)),
    f"{SIZE} --acceleration 4 --period-s 0.8:0.6": ("period", (0.6, 0.8)),
}


@pytest.mark.parametrize(
    "command, line",
    [*((command, line) for command in SHORT for line in VARIED), ("orbit-diagram", "--phase -1:1")],
)
def test_every_quantity_can_vary_between_the_ends_that_are_typed(rocking, command, line):
    parameter, ends = VARIED.get(line, ("phase", (-1.0, 1.0)))
    typed = f"{TYPED} {line}" if line not in VARIED else line
    if command == "orbit-diagram":
        typed = re.sub(r"(\S+:\S+)", r"\1:3", typed)
    read = json.loads(rocking(f"{command} {typed} {SHORT[command]} --json")[2], parse_constant=pytest.fail)
    rows = read["end" if command == "continue" else f"sweep_{parameter}"]
    key = SYSTEM_QUANTITIES[parameter].si.key if "--height" in line else parameter
    assert read["parameter"] == parameter
    assert [rows[0][key], rows[-1][key]] == pytest.approx(ends, rel=1e-12)
