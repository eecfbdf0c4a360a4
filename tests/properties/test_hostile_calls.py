"""Hostile calls: one or two arguments of a public function, class or method are replaced by values of every kind.

A call returns, or raises a documented error: in one short line that names an argument, and raised by a `raise` of the
package, not by a library or by an operation that failed. It writes nothing outside the working folder. All warnings are those of
unlikely input, and name the line of the call.
"""

import datetime as dt
import dis
import inspect
import itertools
import math
import os
import random
import re
import sys
import tempfile
import time
import warnings
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path

import attrs
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import rocking as rk
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.orbits.saddles import manifold_gap

SOURCE = str(Path(rk.__file__).parent)
SEED = 20_250_801
CALLS = 10_000
SAMPLE = 400
LONGEST_MESSAGE = 300
LONGEST_CALL = 60.0  # s; a call takes some ms
BLOCK = rk.Block(2.0, 0.5)
SYSTEM = rk.System(rk.Harmonic(amplitude=7.0, period=1.721328), restitution=0.8)
CHAOTIC = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(1.0))
MILD = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
SADDLE = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
FORCED = rk.System(rk.Harmonic(amplitude=6.0, period=2.0), restitution=0.925)
LOSSLESS = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
PULSED = rk.System(rk.Pulse("one-sine", amplitude=2.0, duration=1.0), restitution=0.9)
RESTRAINED = {
    "forcing": rk.PiecewiseLinear([0.0, 3.0, -3.0, 0.0], step=0.5), "restitution": 0.9, "critical_angle": 0.3, "stiffness_ratio": 0.5,
    "prestress_ratio": 0.3,
}  # fmt: skip
GROUND = rk.GroundMotion([0.0, 3.0, -3.0, 2.0, 0.0, 0.0], step=0.1)
RECORDS = rk.RecordSet([GROUND, rk.GroundMotion([0.0, 2.0, -4.0, 1.0, 0.0], step=0.1)])
SURVEY = {"records": RECORDS, "block": BLOCK}


@cache
def orbit():
    return rk.classify(SYSTEM).orbit


@cache
def special(kind):
    """Special point of the branch of this orbit, or of the pair that is born there."""
    bounds = (0.1, 11.5)
    branch = rk.continue_orbit(orbit(), "amplitude", bounds)
    if kind == "period-doubling":
        branch = rk.switch_branch(special("symmetry-breaking"), bounds)[0]
    return next(point for point in branch.special if point.kind == kind)


@cache
def of_six():
    return rk.overturning_set(rk.synthetic_ground_motions(6, seed=1), BLOCK, [3.0, 5.0, 8.0], intensity="pga")


@cache
def saddle():
    return next(each for each in rk.find_orbits(FORCED, 1) if each.impacts and each.stability == "unstable")


@cache
def fragility():
    return rk.fragility(
        rk.synthetic_ground_motions(8, seed=1), BLOCK, [3.0, 4.0, 5.0, 6.0], limits=(), model="slender"
    )


# Arguments of a cheap call of each public function, without those that have a default that is cheap.
USUAL = {
    "assess": lambda: SURVEY | {"levels": [0.5, 2.0]},
    "basin_map": lambda: {"system": SADDLE, "angle": [-0.5, 0.5], "velocity": [-0.5, 0.5], "max_cycles": 50, "boundary_runs": 0},
    "bifurcation_curve": lambda: {
        "special": special("symmetry-breaking"), "first": "amplitude", "second": "period", "bounds": ((7.0, 10.0), (1.6, 1.8)), "step": 0.1,
        "max_points": 5,
    },
    "bifurcation_set": lambda: {"system": SYSTEM, "max_period": 1, "grid": 2, "step": 0.1, "amplitude": (6.5, 7.5), "period": (1.7, 1.8)},
    "cascade": lambda: {"special": special("period-doubling"), "bounds": (10.3, 10.9), "doublings": 2},
    "chaos_share": lambda: {"system": SYSTEM, "samples": 3, "max_cycles": 50},
    "cite": dict,
    "classify": lambda: {"system": SYSTEM, "max_cycles": 500},
    "compare_intensities": lambda: {"overturning": of_six(), "measures": ["pga", "pgv"], "replicates": 100},
    "continue_orbit": lambda: {"orbit": orbit(), "parameter": "amplitude", "bounds": (6.9, 7.1), "max_points": 5},
    "correlation_dimension": lambda: {"points": np.random.default_rng(1).uniform(size=(20_000, 2))},
    "example_ground_motion": dict,
    "find_orbit": lambda: {"system": SYSTEM, "guess": rk.State(orbit().at(0.0).angle, orbit().at(0.0).velocity), "period": 1},
    "find_orbits": lambda: {"system": SYSTEM, "max_period": 1, "effort": 0.01},
    "fit_restitution": lambda: {"times": [0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02], "frequency_parameter": 2.7},
    "fragility": lambda: SURVEY | {"levels": [0.5, 5.0, 50.0], "limits": 0.5, "replicates": 100},
    "frequency_response": lambda: {"system": MILD, "period": [1.0, 1.1], "modes": (1,), "max_cycles": 50, "step": 0.01},
    "grazing_transition": lambda: {"special": special("grazing"), "distances": (1e-2, 1e-3, 1e-4, 1e-5), "max_cycles": 50},
    "horseshoe": lambda: {"system": SADDLE, "max_period": 1},
    "impact_section": lambda: {"source": SYSTEM, "cycles": 50},
    "incremental_dynamic_analysis": lambda: SURVEY | {"levels": [0.5, 2.0]},
    "lyapunov": lambda: {"system": CHAOTIC, "cycles": 1_000, "transient": 10},
    "orbit_diagram": lambda: {"system": SYSTEM, "amplitude": [7.0, 7.1], "transient": 5, "cycles": 5},
    "orbit_manifolds": lambda: {"orbit": saddle(), "length": 0.5},
    "overturning_amplitude": lambda: {
        "system": SYSTEM, "period": [1.0, 1.1], "amplitude": [1.0, 2.0], "phases": 1, "max_cycles": 20,
    },
    "overturning_rate": lambda: {"fragility": fragility(), "hazard": {1.0: 0.02, 3.0: 2e-3, 10.0: 1e-4}, "replicates": 100},
    "overturning_set": lambda: SURVEY | {"levels": [0.5, 2.0]},
    "overturning_spectrum": lambda: {"system": PULSED, "amplitude": [1.0, 3.0], "frequency": [1.0, 2.0]},
    "parametric_map": lambda: {"system": SYSTEM, "amplitude": [1.0, 3.0], "period": [1.0, 2.0], "max_cycles": 20},
    "prove": lambda: {"subject": orbit()},
    "proved_share": lambda: {"result": made("parametric_map"), "points": 3},
    "read_ground_motion": lambda: {"source": b"time,acceleration\n0,0\n0.1,1\n0.2,0\n", "units": "g"},
    "read_ground_motions": lambda: {"source": b"time,acceleration\n0,0\n0.1,1\n0.2,0\n", "units": "g"},
    "read_record_set": lambda: {"source": ["record.csv"], "units": "g"},
    "repeatability": lambda: {"system": SYSTEM, "samples": 3, "max_cycles": 50},
    "repeatability_map": lambda: {
        "system": SYSTEM, "amplitude": [1.0, 3.0], "period": [1.0, 2.0], "samples": 2, "max_cycles": 20,
    },
    "response_diagram": lambda: {"system": SYSTEM, "amplitude": [7.0, 7.1], "max_cycles": 50},
    "rocking_spectrum": lambda: {"records": RECORDS, "size": [1.0, 2.0], "slenderness": [0.15, 0.2]},
    "rotation_number": lambda: {"system": LOSSLESS},
    "saddle_manifolds": lambda: {"system": SADDLE, "cycles": 1, "spacing": 0.1},
    "safe_basin": lambda: {"system": SYSTEM, "amplitude": [3.0, 4.0], "samples": 5, "max_cycles": 20},
    "sensitivity": lambda: SURVEY | {"levels": [0.5, 2.0]},
    "simulate": lambda: {"system": SYSTEM, "cycles": 5},
    "slide": lambda: {"ground": GROUND, "friction": 0.2},
    "spectral_density": lambda: {"motion": rk.simulate(SYSTEM, cycles=70)},
    "switch_branch": lambda: {"special": special("symmetry-breaking"), "bounds": (7.0, 11.5), "step": 0.1, "max_points": 5},
    "synthetic_ground_motions": lambda: {"count": 1, "seed": 1, "duration": 2.0, "step": 0.01},
    "tangency_amplitude": lambda: {"system": SADDLE},
}  # fmt: skip
# Arguments by name, of the closed forms and of methods.
ALLOWED = {
    "acceleration": 2.0, "amplitude": 2.0, "angle": 0.5, "base_acceleration": 1.0, "block": BLOCK, "duration": 1.0, "fraction": 0.5,
    "friction": 0.3,
    "frequency": 2.0, "ground": GROUND, "height": 2.0, "hertz": 1.0, "impacts": 2, "index": 0, "kind": "one-sine", "level": 1.0,
    "levels": [0.5, 1.0], "mass_ratio": 1.0, "n": 1, "of": (0.5,), "orbit": "upper", "period": 1.0, "periods": [0.5, 1.0], "phase": 0.5,
    "radians": 0.1, "radians_per_second": 0.1, "record": 0, "restitution": 0.8, "rule": "fema-356", "seconds": 0.5, "start": 0.5,
    "threshold": 0.5, "step": 0.05, "time": 0.5, "times": [0.5, 1.0], "velocity": 0.5, "width": 0.5, "critical_angle": 0.2, "value": 7.0,
    "other": rk.Block(4.0, 1.0),
}  # fmt: skip
METHODS = {
    "Block.angle": {"degrees": 5.0},
    "Block.restrained": {"stiffness": 2e4, "mass": 600.0},
    "GroundMotion.rotated": {"other": GROUND, "angle": 0.5},
    "Block.system": {"acceleration": 3.0, "frequency_hz": 1.2},
    "Orbit.motion": {"cycles": 2},
}
OF_SEQUENCES = {"index", "count"}
RECORD = "time,acceleration\n0,0\n0.1,1\n0.2,0\n"


@cache
def made(name):
    """The result of a function."""
    return getattr(rk, name)(**USUAL[name]())


def values():
    """One value of each class that has methods or a constructor with checks."""
    yield from (
        BLOCK,
        SYSTEM,
        SYSTEM.forcing,
        GROUND,
        RECORDS,
        rk.State(0.1),
        rk.Braces(1.0),
        orbit(),
        special("fold"),
        rk.Share(1, 3),
    )
    yield rk.Pulse("one-sine", amplitude=1.0, duration=1.0)
    yield rk.PiecewiseLinear([0.0, 1.0, 0.0], step=0.1)
    yield rk.continue_orbit(orbit(), "amplitude", (0.1, 11.5))
    yield made("fragility").fits[0]
    for name in USUAL:
        found = made(name)
        if attrs.has(type(found)):
            yield found
        elif isinstance(found, tuple):
            yield found[0]


def named(value):
    """Arguments that make a value again, by name."""
    if isinstance(value, rk.Share):
        return {"count": value.count, "of": value.of, "unknown": value.unknown}
    return {each.alias: getattr(value, each.name) for each in attrs.fields(type(value)) if each.init}


@cache
def targets():
    """All calls: name, callable, and the arguments of a cheap call."""
    found = {name: (getattr(rk, name), usual()) for name, usual in USUAL.items()}
    found["manifold_gap"] = manifold_gap, {"system": SADDLE}
    found["restrained"] = rk.System, RESTRAINED
    for name in rk.theory.__all__:
        function = getattr(rk.theory, name)
        required = [
            each for each, how in inspect.signature(function).parameters.items() if how.default is how.empty
        ]
        found[f"theory.{name}"] = function, {each: ALLOWED[each] for each in required}
    for name in rk.plot.__all__:
        found[f"plot.{name}"] = getattr(rk.plot, name), drawn(name)
    for value in values():
        kind = type(value).__name__
        found[kind] = type(value), named(value)
        for name, _ in inspect.getmembers(type(value), inspect.isfunction):
            # `plot` passes all to a function that is a target itself.
            if name.startswith("_") or name in (*OF_SEQUENCES, "plot") or f"{kind}.{name}" in found:
                continue
            method = getattr(value, name)
            required = [
                each for each, how in inspect.signature(method).parameters.items() if how.default is how.empty
            ]
            found[f"{kind}.{name}"] = (
                method,
                METHODS.get(f"{kind}.{name}") or {each: ALLOWED[each] for each in required},
            )
    return {name: call for name, call in found.items() if inspect.signature(call[0]).parameters}


def drawn(name):
    """Arguments of a plot function."""
    if name in ("melnikov", "modes"):
        return {each: ALLOWED[each] for each in ("amplitude", "period", "restitution")}
    special_ones = {
        "panels": dict,
        "heteroclinic": dict,
        "schematic": dict,
        "save": lambda: {"figure": Figure(), "path": "figure.png", "dpi": 20.0},
        "title": lambda: {"ax": Figure().subplots(), "text": "title"},
        "thresholds": lambda: {"periods": [1.0, 2.0], "curves": {"x": [1.0, 2.0]}},
        "tiles": lambda: {"result": made("parametric_map"), "folder": "tiles"},
        "animation": lambda: {
            "result": rk.simulate(SYSTEM, cycles=1),
            "path": "motion.gif",
            "seconds": 0.2,
            "fps": 5.0,
        },
        "restitution_fit": lambda: {"result": made("fit_restitution")},
        "branch": lambda: {"result": rk.continue_orbit(orbit(), "amplitude", (6.5, 7.5))},
        "orbits": lambda: {"result": made("find_orbits")},
        "basins": lambda: {"result": made("basin_map")},
        "convergence": lambda: {"result": made("lyapunov")},
        "slip": lambda: {"result": made("slide")},
        "first_motion": lambda: {"block": BLOCK},
        "manifolds": lambda: {"result": made("saddle_manifolds")},
        "overturning": lambda: {"result": made("overturning_amplitude")},
        "spectrum": lambda: {"result": made("spectral_density")},
        "verdict": lambda: {"result": made("classify")},
        "section": lambda: {"result": made("simulate")},
        "impact_section": lambda: {"result": made("simulate")},
    }
    if name in special_ones:
        return special_ones[name]()
    return {"result": made("simulate" if name in ("overview", "phase_portrait", "time_history") else name)}


class Evil:
    """Object whose text and number fail."""

    def __repr__(self):
        raise RuntimeError("no text")

    def __float__(self):
        raise RuntimeError("no number")

    __str__, __int__, __index__ = __repr__, __float__, __float__


ROUND = [1.0]
ROUND.append(ROUND)
NASTY = {
    "None": lambda: None, "True": lambda: True, "False": lambda: False, "nan": lambda: math.nan, "inf": lambda: math.inf,
    "-inf": lambda: -math.inf, "-1": lambda: -1, "0": lambda: 0, "0.0": lambda: 0.0, "-0.5": lambda: -0.5, "0.5": lambda: 0.5,
    "1": lambda: 1, "2": lambda: 2, "1e308": lambda: 1e308, "-1e308": lambda: -1e308, "5e-324": lambda: 5e-324, "10**18": lambda: 10**18,
    "10**400": lambda: 10**400, "10**5000": lambda: 10**5_000, "complex": lambda: 1j, "Decimal": lambda: Decimal("0.5"),
    "Fraction": lambda: Fraction(1, 3), "empty text": str, "text": lambda: "x", "number as text": lambda: "1.0",
    "long text": lambda: "a" * 5_000, "line ends": lambda: "a\nb\0c", "bytes": lambda: b"x", "long bytes": lambda: b"\xff" * 5_000,
    "empty list": list, "empty tuple": tuple, "list of None": lambda: [None], "list of texts": lambda: ["a", "b"],
    "ragged list": lambda: [[1.0], [1.0, 2.0]], "long list": lambda: [1.0] * 5_000, "long list of texts": lambda: ["a" * 50] * 500,
    "round list": lambda: ROUND, "list with nan": lambda: [1.0, math.nan], "list of huge": lambda: [10**400, 1],
    "pair": lambda: (1.0, 2.0), "reversed pair": lambda: (2.0, 1.0), "equal pair": lambda: [1.0, 1.0],
    "infinite pair": lambda: (-math.inf, math.inf),
    "empty dict": dict, "dict": lambda: {"a": 1}, "dict of numbers": lambda: {1: 2.0}, "long dict": lambda: {"a" * 5_000: "b" * 5_000},
    "object": object, "function": lambda: abs, "class": lambda: int, "date": lambda: dt.datetime(2000, 1, 1),
    "set": lambda: {1.0, 2.0}, "generator": lambda: iter((1.0, 2.0)), "range": lambda: range(3), "slice": lambda: slice(None),
    "ellipsis": lambda: ..., "evil": Evil, "evil list": lambda: [Evil()], "empty array": lambda: np.ones(0), "array": lambda: np.ones(3),
    "2-d array": lambda: np.ones((2, 3)), "5-d array": lambda: np.ones((1, 1, 1, 1, 1)), "0-d array": lambda: np.array(0.5),
    "0-d text": lambda: np.array("a"), "array of texts": lambda: np.array(["a", "b"]), "array of objects": lambda: np.array([None, 1]),
    "complex array": lambda: np.ones(3, complex), "array with nan": lambda: np.array([1.0, math.nan]),
    "bools": lambda: np.array([True, False]),
    "timedelta": lambda: np.timedelta64(5, "s"), "datetimes": lambda: np.array(["2000-01-01"], "M8[D]"), "masked": lambda: np.ma.masked,
    "masked array": lambda: np.ma.array([1.0, 2.0], mask=[True, False]), "structure": lambda: np.zeros(2, [("a", float)]),
    "DataArray": lambda: xr.DataArray([1.0, 2.0]), "0-d DataArray": lambda: xr.DataArray(0.5), "Dataset": xr.Dataset,
    "missing path": lambda: Path("missing") / "x.png", "folder": Path, "null path": lambda: "a\0b.png",
    "long name": lambda: "a" * 5_000 + ".png", "long path": lambda: Path("a/" * 5_000 + "x.png"),
    "Block": lambda: BLOCK, "System": lambda: SYSTEM, "State": lambda: rk.State(0.5), "GroundMotion": lambda: GROUND, "Orbit": orbit,
    "Harmonic": lambda: SYSTEM.forcing, "Motion": lambda: made("simulate"), "Verdict": lambda: made("classify"),
    "map": lambda: made("parametric_map"),
}  # fmt: skip

recording = []
"""Paths that a call opened for writing, made, renamed or removed, while it is watched."""


def watch(event, arguments):
    if recording and event in (
        "open",
        "os.mkdir",
        "os.rename",
        "os.remove",
        "os.rmdir",
        "os.symlink",
        "os.link",
        "os.truncate",
        "shutil.rmtree",
    ):
        if event == "open" and (
            isinstance(arguments[0], int) or not (arguments[2] or 0) & (os.O_WRONLY | os.O_RDWR)
        ):
            return
        recording.append(
            os.path.realpath(os.fsdecode(arguments[0])) if not isinstance(arguments[0], int) else ""
        )


sys.addaudithook(watch)


def raised_by_the_package(error):
    """Return whether a `raise` of the package raised an error, and no library or failed operation."""
    frame = error.__traceback__
    while frame.tb_next is not None:
        frame = frame.tb_next
    code = frame.tb_frame.f_code
    at = next((each for each in dis.get_instructions(code) if each.offset == frame.tb_lasti), None)
    return code.co_filename.startswith(SOURCE) and at is not None and at.opname == "RAISE_VARARGS"


def documented(call, error):
    """Return whether the docstring of a callable, or of its class, names the type of an error or one above it."""
    texts = [inspect.getdoc(call) or "", inspect.getdoc(type(getattr(call, "__self__", None))) or ""]
    raises = " ".join(
        re.split(r"\n\w[\w ]*\n-{3,}", text.partition("Raises\n------")[2])[0] for text in texts
    )
    if inspect.isclass(call) and not raises.strip():
        return isinstance(error, TypeError)  # a result, which functions return
    return any(re.search(rf"\b{each.__name__}\b", raises) for each in type(error).__mro__[:-3])


def names_of(call, usual):
    """Names that a message may name: arguments, the quantities chosen by them, and the attributes of the owner of a method."""
    owner = getattr(call, "__self__", None)
    own = [each.alias for each in attrs.fields(type(owner))] if attrs.has(type(owner)) else []
    return [
        *inspect.signature(call).parameters,
        *usual,
        *own,
        *(each for each in usual.values() if isinstance(each, str)),
        *SYSTEM_QUANTITIES,  # quantities of a system that is an argument
    ]


def problems(name, changed):
    """Call with changed arguments; yield what is wrong with the outcome."""
    call, usual = targets()[name]
    recording[:] = [str(Path.cwd().resolve())]
    before = time.process_time()
    try:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            call(**usual | {key: NASTY[value]() for key, value in changed.items()})
    except Exception as error:  # noqa: BLE001
        text = str(error)
        if not raised_by_the_package(error):
            yield f"inner {type(error).__name__}: {text[:150]}"
        elif not documented(call, error):
            yield f"undocumented {type(error).__name__}: {text[:150]}"
        elif (
            type(error).__module__ == "builtins"
            and "of a result" not in text
            and not any(
                re.search(rf"(?<![^\W_]){re.escape(key)}(?![^\W_])", text) for key in names_of(call, usual)
            )
        ):
            yield f"names no argument: {text[:150]}"
        # A message on several files numbers its sentences, one for each.
        longest = max(map(len, re.split(r" \(\d+\) ", text)))
        if longest > LONGEST_MESSAGE or len(text.splitlines()) != 1:
            yield f"message of {len(text)} characters, {len(text.splitlines())} lines: {text[:100]}"
    wrote = [
        path
        for path in recording[1:]
        if not path.startswith(recording[0]) and not path.startswith(tempfile.gettempdir())
    ]
    recording.clear()
    if wrote:
        yield f"wrote {wrote[0]}"
    for each in warned:
        if (each.category, each.filename) != (rk.InputWarning, __file__):
            yield f"warning {each.category.__name__}: {each.message}"[:150]
    if time.process_time() - before > LONGEST_CALL:
        yield f"took {time.process_time() - before:.1f} s"


def attacks(count, seed=SEED):
    """Draw hostile calls: the name of a callable, and one or two of its arguments with the names of their values."""
    rng = random.Random(seed)
    names = list(targets())
    for _ in range(count):
        name = rng.choice(names)
        arguments = [
            each
            for each, how in inspect.signature(targets()[name][0]).parameters.items()
            if how.kind is not how.VAR_KEYWORD
        ]
        changed = rng.sample(arguments, min(rng.choice((1, 1, 2)), len(arguments)))
        yield name, {each: rng.choice(list(NASTY)) for each in changed}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Empty working folder with one record."""
    monkeypatch.chdir(tmp_path)
    Path("record.csv").write_text(RECORD)


def faults(calls):
    """List what is wrong with hostile calls."""
    return [f"{name}({changed}): {each}" for name, changed in calls for each in problems(name, changed)]


def test_calls_are_right_before_they_are_changed(folder):
    assert len(targets()) > 200
    assert faults((name, {}) for name in targets()) == []


@pytest.mark.parametrize("name", [*rk.__all__, *(f"plot.{each}" for each in rk.plot.__all__)])
def test_every_public_function_is_attacked(name, folder):
    value = getattr(rk, name) if "." not in name else getattr(rk.plot, name.removeprefix("plot."))
    if inspect.isfunction(value) and inspect.signature(value).parameters:
        assert name in targets()


def test_sample_of_hostile_calls_raises_documented_errors_only(folder, capsys):
    assert faults(attacks(SAMPLE)) == []


@pytest.mark.long
@pytest.mark.parametrize("part", range(4))
def test_hostile_calls_raise_documented_errors_only(folder, part, capsys):
    assert faults(itertools.islice(attacks(CALLS), part, None, 4)) == []


@pytest.mark.long
@pytest.mark.parametrize("part", range(4))
def test_each_argument_takes_no_hostile_value_wrongly(folder, part, capsys):
    every = [
        (name, {argument: value})
        for name, (call, _) in targets().items()
        for argument, how in inspect.signature(call).parameters.items()
        if how.kind is not how.VAR_KEYWORD
        for value in NASTY
    ]
    assert faults(every[part::4]) == []


def lost(value):
    """Stand for a function without checks."""
    return 1.0 / value


def test_errors_of_operations_and_of_libraries_are_recognised():
    for wrong, raised in (
        (lambda: lost(0), False),
        (lambda: np.zeros(2).reshape(3), False),
        (lambda: rk.Block("2", 1), True),
    ):
        with pytest.raises((ArithmeticError, TypeError, ValueError)) as caught:
            wrong()
        assert raised_by_the_package(caught.value) is raised
