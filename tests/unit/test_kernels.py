"""Compiled code: new machine code after every edit, no allocation per event, and resumed marches without a trace."""

import importlib
import json
import math
import os
import pkgutil
import shutil
import subprocess
import sys
from pathlib import Path

import mpmath
import numba
import numpy as np
import pytest
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher

from rocking import kernels
from rocking.kernels import event_kinds, parameters
from rocking.kernels.march import march as kernel
from rocking.kernels.march.event_rows import EVENT_ROW
from rocking.kernels.march.progress import Recording
from rocking.kernels.numerics import elementary
from rocking.kernels.numerics.replace_fields import replacing

SOURCES = Path(kernels.__file__).parents[2]
COPY = shutil.ignore_patterns("__pycache__", "*.egg-info")
PRINT_IMPACT_SPEED = (
    "from rocking.kernels import parameters; from rocking.kernels.march import march; "
    "p = parameters.harmonic_parameters(2.0, 6.28, 1.0, 0.0, 0.925); s, _ = march.begin_march(p, 0.1, 0.0);"
    "print(march.march(p, s, 3, march.Recording())[1].arc.velocity)"
)


def march(p, cycles, angle=0.0, velocity=0.0):
    progress, _ = kernel.begin_march(p, angle, velocity)
    status = kernel.PAUSED
    while status == kernel.PAUSED:
        found = kernel.march(p, progress, cycles, Recording())
        status, progress, _, _ = found
    return found


@pytest.mark.long
def test_an_edit_in_a_called_function_is_seen_at_the_next_start(tmp_path):
    shutil.copytree(SOURCES, tmp_path / "src", ignore=COPY)
    environment = {
        **os.environ,
        "PYTHONPATH": str(tmp_path / "src"),
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
    }

    def run():
        command = [sys.executable, "-c", PRINT_IMPACT_SPEED]
        return float(
            subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
        )

    before = run()
    callee = tmp_path / "src/rocking/kernels/march/impact_law.py"
    text = callee.read_text()
    edited = text.replace("speed = p.restitution * max", "speed = 0.5 * p.restitution * max")
    assert edited != text
    callee.write_text(edited)
    assert abs(run() - before) > 1e-3


PRINT_CACHE_PATHS = """
import importlib, json, pkgutil
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher
from rocking import kernels

modules = [importlib.import_module(found.name) for found in pkgutil.walk_packages(kernels.__path__, "rocking.kernels.")]
entries = {what for module in modules for what in vars(module).values() if isinstance(what, Dispatcher)}
paths = {f"{entry.py_func.__module__}.{entry.py_func.__name__}": entry._cache.cache_path
    for entry in entries if isinstance(entry._cache, FunctionCache)}
print(json.dumps(paths))
"""


ENTRY_SOURCE = """
from numba import njit
from rocking.kernels.compile_options import ENTRY_POINT

@njit(**ENTRY_POINT)
def entry():
    return 1
"""


def cache_paths(source, home):
    """Return the path of the cached machine code of each entry point, by name."""
    environment = {**os.environ, "PYTHONPATH": str(source), "NUMBA_CACHE_DIR": str(home)}
    command = [sys.executable, "-c", PRINT_CACHE_PATHS]
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
    return json.loads(told)


def test_an_edit_of_any_source_moves_the_machine_code_of_every_entry(tmp_path):
    """This holds for a subpackage too, and an entry point there has its code in the same folder."""
    source, home = tmp_path / "src", tmp_path / "cache"
    shutil.copytree(SOURCES, source, ignore=COPY)
    package = source / "rocking/kernels"
    inner = package / "inner"
    inner.mkdir()
    (inner / "__init__.py").write_text("")
    (inner / "callee.py").write_text("VALUE = 1")
    (inner / "entry.py").write_text(ENTRY_SOURCE)
    found = [cache_paths(source, home)]
    for callee in (package / "march/impact_law.py", inner / "callee.py"):
        callee.write_text(callee.read_text() + "\n")
        found.append(cache_paths(source, home))
    assert {
        "rocking.kernels.classify.attractor_anchor.anchor_each",
        "rocking.kernels.inner.entry.entry",
    } < found[0].keys()
    assert all(paths.keys() == found[0].keys() for paths in found)
    assert all(len({paths[name] for paths in found}) == len(found) for name in found[0])
    folders = {Path(path).relative_to(home).parts[:2] for paths in found for path in paths.values()}
    assert len(folders) == len(found)  # one a set of sources, and no entry keeps its code anywhere else


RUN_ENTRY = """
import logging, sys, tempfile
def nowhere():
    raise FileNotFoundError("no usable temporary directory found")
tempfile.gettempdir = nowhere
logging.basicConfig(level="INFO", format="%(message)s")
from rocking.kernels.entry import entry
print(entry())
"""


@pytest.mark.parametrize("place", ["NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME", None])
def test_machine_code_is_kept_in_the_first_folder_that_can_be_written_and_else_not_at_all(tmp_path, place):
    shutil.copytree(SOURCES, tmp_path / "src", ignore=COPY)
    (tmp_path / "src/rocking/kernels/entry.py").write_text(ENTRY_SOURCE)
    nowhere = {"NUMBA_CACHE_DIR": "/dev/null/below", "XDG_CACHE_HOME": "/dev/null/below", "HOME": "/dev/null"}
    environment = os.environ | nowhere | {"PYTHONPATH": str(tmp_path / "src")}
    if place:
        environment[place] = str(tmp_path / "home")
    if place == "HOME":
        del environment["XDG_CACHE_HOME"]
    command = [sys.executable, "-c", RUN_ENTRY]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"
    kept = [path for path in tmp_path.rglob("*") if path.suffix in {".nbi", ".nbc"}]
    if place:
        assert len(kept) == 2
        assert all((tmp_path / "home") in path.parents for path in kept)
        assert "once for this machine" in done.stderr
    else:
        assert kept == []
        assert "at every start, because no cache folder is writable" in done.stderr


def test_nothing_compiled_calls_what_is_kept_on_disk():
    """Else its speed and its last digits would depend on what this machine compiled first."""
    rooms = pkgutil.walk_packages(kernels.__path__, "rocking.kernels.")
    found = [value for room in rooms for value in vars(importlib.import_module(room.name)).values()]
    compiled = {kernel.py_func: kernel for kernel in found if isinstance(kernel, Dispatcher)}
    kept = [kernel for kernel in compiled.values() if isinstance(kernel._cache, FunctionCache)]
    called = {id(python.__globals__.get(name)) for python in compiled for name in python.__code__.co_names}
    assert len(kept) >= 5
    assert [kernel.py_func.__name__ for kernel in kept if id(kernel) in called] == []


EVERY_KIND = """
import importlib, pkgutil
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher
from numba.core.types import BaseTuple, BaseNamedTuple
import rocking as rk
from rocking import kernels

def named(kind):
    parts = kind.types if isinstance(kind, BaseTuple) else ()
    return isinstance(kind, BaseNamedTuple) or any(named(part) for part in parts)

system = rk.System(rk.Harmonic(2.0, period=1.0), 0.925)
rk.simulate(system, cycles=3), rk.classify(system), rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)
rk.parametric_map(amplitude=[1.0, 2.0], period=[1.0, 2.0], restitution=1.0, max_cycles=200)
modules = [importlib.import_module(found.name) for found in pkgutil.walk_packages(kernels.__path__, "rocking.kernels.")]
met = {
    f"{what.py_func.__module__}.{what.py_func.__name__}": [named(sign.return_type) for sign in what.nopython_signatures]
    for module in modules for what in vars(module).values()
    if isinstance(what, Dispatcher) and isinstance(what._cache, FunctionCache) and what.nopython_signatures
}
print(len(met), [name for name, returns in met.items() if any(returns)])
"""


def test_nothing_compiled_hands_a_named_tuple_to_python():
    """It would be made by calling its class, and an interrupt that strikes there ends the process."""
    told = subprocess.run(
        [sys.executable, "-c", EVERY_KIND], capture_output=True, text=True, check=True
    ).stdout.split(maxsplit=1)
    assert int(told[0]) >= 8
    assert told[1].strip() == "[]"


CHAOS = """
import rocking as rk
braced = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0))
print(rk.simulate(braced, cycles=30_000, record="none").final)
"""
MODE = "import rocking as rk; assert rk.theory.symmetric_modes(2.0, 1.0, 0.9, 1)[0].admissible"


@pytest.mark.long
def test_a_chaotic_run_is_the_same_whatever_was_compiled_when(tmp_path):
    """It multiplies a last digit to the first."""
    found = set()
    for folder, code in (
        ("one", CHAOS),
        ("one", CHAOS),
        ("two", MODE),
        ("two", MODE + CHAOS),
        ("two", CHAOS),
    ):
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / folder)}
        command = [sys.executable, "-c", code]
        told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
        found |= {told} - {""}
    assert len(found) == 1


def test_other_compiled_code_of_the_process_keeps_its_own_cache_folder():
    assert "rocking" not in str(numba.config.CACHE_DIR)


COUNT_ALLOCATIONS = """
import numpy as np
from numba.core.runtime import rtsys
from rocking.kernels import parameters
from rocking.kernels.march import march

nothing = np.empty((0, 2))
for numbers in ((2.0, 6.283185307179586, 1.0, 0.0, 0.925), (15.0, 3.141592653589793, 2.0, 0.0, 0.925, 1.0, 0.9)):
    p = parameters.harmonic_parameters(*numbers)
    counts = []
    for cycles in (10, 10, 10_000):
        progress, _ = march.begin_march(p, 0.0, 0.0)
        before = rtsys.get_allocation_stats().alloc
        _, progress, _, _ = march.march(p, progress, cycles, march.Recording(peak=True))
        counts.append(rtsys.get_allocation_stats().alloc - before)
        assert progress.impacts > cycles
    print(counts[1], counts[2])
"""


def test_marching_allocates_nothing_per_event():
    environment = {**os.environ, "NUMBA_NRT_STATS": "1", "PYTHONPATH": str(SOURCES)}
    done = subprocess.run(
        [sys.executable, "-c", COUNT_ALLOCATIONS], env=environment, capture_output=True, text=True, check=True
    )
    counts = [line.split() for line in done.stdout.splitlines()]
    assert len(counts) == 2
    assert all(few == many for few, many in counts)


def test_marching_in_pieces_is_marching_in_one_go():
    # a regular motion: what an arc renewed at the end of a piece changes is rounding
    p = parameters.harmonic_parameters(6.5, 5.0 * math.pi, 0.4, 0.0, 0.925)
    whole = march(p, 300)[1]
    pieces, _ = kernel.begin_march(p, 0.0, 0.0)
    for until in range(7, 300, 7):
        pieces = kernel.march(p, pieces, until, Recording())[1]
    pieces = kernel.march(p, pieces, 300, Recording())[1]
    assert (pieces.cycle, pieces.impacts) == (whole.cycle, whole.impacts)
    assert abs(pieces.arc.angle - whole.arc.angle) < 1e-14
    assert abs(pieces.arc.velocity - whole.arc.velocity) < 1e-14


def test_a_full_buffer_of_events_loses_none():
    p = parameters.harmonic_parameters(15.0, math.pi, 2.0, 0.0, 0.925, 1.0, 1.0)

    def times(room):
        progress, _ = kernel.begin_march(p, 0.0, 0.0)
        found, status = [], kernel.PAUSED
        while status == kernel.PAUSED:
            rows = np.empty(room, EVENT_ROW)
            status, progress, _, written = kernel.march(p, progress, 40, Recording(events=rows))
            found.append(rows[:written])
        return np.concatenate(found)

    np.testing.assert_array_equal(times(3), times(10_000))


def test_ten_million_cycles_lose_no_phase():
    # The stable (1,1) orbit is the same after 10**7 cycles as after 10**4, impact by impact.
    p = parameters.harmonic_parameters(2.0, 2.0 * math.pi, 1.0, 0.0, 0.925)
    early, late = march(p, 10_000)[1], march(p, 10_000_000)[1]
    assert late.impacts - early.impacts == 2 * (10_000_000 - 10_000)
    assert abs(late.arc.angle - early.arc.angle) < 1e-14
    assert abs(late.arc.velocity - early.arc.velocity) < 1e-14


@pytest.mark.parametrize("name", ["hyperbolic", "circular"])
def test_elementary_functions_keep_their_relative_accuracy_from_the_shortest_arc_on(name):
    random = np.random.default_rng(7)
    worst = np.zeros(4)
    with mpmath.workdps(80):
        for _ in range(4000):
            t, rate = 10.0 ** random.uniform(-12, 1.5), 10.0 ** random.uniform(-1.3, 2.3)
            if name == "hyperbolic":
                found, z = elementary.hyperbolic(t), mpmath.mpf(t)
                exact = (
                    mpmath.sinh(z),
                    mpmath.cosh(z) - 1,
                    mpmath.sinh(z) - z,
                    mpmath.cosh(z) - 1 - z * z / 2,
                )
            else:
                found, z = elementary.circular(rate, t), mpmath.mpf(rate) * mpmath.mpf(t)
                exact = (mpmath.sin(z), 1 - mpmath.cos(z), z - mpmath.sin(z), z * z / 2 - 1 + mpmath.cos(z))
                if rate * t >= elementary.SHORT:  # the last is for short arguments only
                    found, exact = (*found[:3], 1.0), (*exact[:3], 1.0)
            # of 1 - cos x far from 0 what counts is its error against 1
            scales = exact if name == "hyperbolic" or z < 1 else (exact[0], max(exact[1], 1), *exact[2:])
            worst = np.maximum(
                worst, [abs(float((f - e) / s)) for f, e, s in zip(found, exact, scales, strict=True)]
            )
    assert np.all(worst <= 8 * 2.0**-53)


def test_modes_and_events_are_told_by_name():
    assert [mode.name for mode in event_kinds.MotionMode] == ["FLIGHT", "REST", "LEAN"]
    assert event_kinds.Event(event_kinds.LIFT_OFF).name == "LIFT_OFF"


def test_compiling_is_told_once(caplog):
    def compile_one():
        numba.njit(lambda x: x + 1)(1.0)

    compile_one()  # any listener that is left has reported it
    kernels._tell_of_compiling()
    with caplog.at_level("INFO", "rocking"):
        compile_one()
        compile_one()
    assert [record.name for record in caplog.records] == ["rocking"]


def test_a_field_that_a_tuple_does_not_have_cannot_be_replaced():
    with pytest.raises(ValueError, match="Recording has no field peek"):
        replacing(Recording, "peak", "peek")
