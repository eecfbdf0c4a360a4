"""Kernels give the same bits on every class of processors: calls recorded here are repeated by the libraries of all classes.

Only the sign of an undefined number (NaN) differs: processors choose it, and nothing reads it.
"""

import ctypes
import io
import math
import os
import shutil
import struct
import subprocess
from collections import Counter
from pathlib import Path
from threading import Lock
from time import thread_time
from typing import NamedTuple

import numpy as np
import pytest

import rocking as rk
from benchmarks.recorded_calls import arrays_in, workload
from rocking.kernels import batch
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.classify.verdict import empty_results
from rocking.kernels.lanes.scheduler import classify_batch_lanes
from rocking.kernels.lanes.state import make_lane_workspace
from rocking.kernels.library import build, export, load
from rocking.kernels.library.kernel import import_all
from rocking.kernels.library.processor import CLASSES, classes_here
from rocking.kernels.library.signature import Array, Fields
from rocking.kernels.motion.march import Recording, begin_march, march
from rocking.kernels.motion.observers import EVENT_ROW
from rocking.kernels.motion.tangent import TangentState
from rocking.motion.march_loop import parameters

REPLAY = Path(__file__).parents[1] / "oracles/replay.c"
HEAD, PLACE = struct.Struct("112sqq"), struct.Struct("qq")
MOST_CALLS, MOST_SECONDS = 5, 0.3
"""Calls kept of each entry point of the workload, and the longest of them, s: other classes take many times as long."""
MOTIONS, VERDICTS, FULL_VERDICTS = 10_000, 1_000, 40
# With it glibc computes fused products as on processors that lack them: in software, at hundreds of times the cost of a march.
SOFTWARE = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-FMA_Usable,-FMA4_Usable"}
FEW_CALLS, FEW_SECONDS = 20, 0.001
"""Calls of each entry point that are repeated in this way, and the longest of them, s."""
EMULATED = {"aarch64": ("aarch64-linux-gnu-gcc", "qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")}
"""C compiler and emulator for a class of processors of other machines."""


def words_of(kind):
    """Return the types of the words of a type: for an array itself, for its address, and those of its lengths."""
    if isinstance(kind, Fields):
        return [word for part in kind.types for word in words_of(part)]
    return [kind, *[int] * kind.dimensions] if isinstance(kind, Array) else [kind]


def written(entry, block, arrays):
    """Return the bytes of a call for the program ``replay``."""
    words = np.frombuffer(block, np.int64).copy()
    places = [k for k, kind in enumerate(words_of(entry.signature.arguments)) if isinstance(kind, Array)]
    words[places] = 0
    parts = [HEAD.pack(entry.symbol.encode(), len(words), len(places)), words.tobytes()]
    for place, array in zip(places, arrays, strict=True):
        parts += PLACE.pack(place, array.nbytes), array.tobytes()
    return b"".join(parts)


class Call(NamedTuple):
    """A call of an entry point, before and after."""

    name: str
    seconds: float
    before: bytes
    after: bytes


def results(call):
    """Return the bytes of a call, with one sign of all undefined numbers."""
    return call.replace(np.float64(-np.nan).tobytes(), np.float64(np.nan).tobytes())


def random_system(rng):
    """A slender or a full block, with or without braces, on a cosine, a record or a pulse."""
    restitution = 1.0 if rng.random() < 0.1 else rng.uniform(0.5, 1.0)
    braces = rk.Braces(rng.uniform(0.1, 1.5), rng.uniform(0.3, 1.0)) if rng.random() < 0.3 else None
    kind = rng.choice(["cosine", "record", "pulse"], p=[0.9, 0.05, 0.05])
    if kind == "cosine":
        base = rk.Harmonic(
            10.0 ** rng.uniform(-0.5, 1.5), period=10.0 ** rng.uniform(-1, 1), phase=rng.uniform(0.0, 6.0)
        )
    elif kind == "record":
        base = rk.PiecewiseLinear(rng.normal(0.0, 2.0, 60), step=rng.uniform(0.02, 0.3))
    else:
        base = rk.Pulse("one-sine", amplitude=rng.uniform(-9.0, 9.0), duration=rng.uniform(0.5, 5.0))
    critical_angle = rng.uniform(0.05, 0.5) if rng.random() < 0.1 else None
    return rk.System(base, restitution, braces, critical_angle=critical_angle)


def motions():
    """March random motions, with sections, some events, and tangent vectors of every second one."""
    rng = np.random.default_rng(76)
    for k in range(MOTIONS):
        p = parameters(random_system(rng))
        brace = p.block.brace_angle
        progress, _ = begin_march(p, min(0.9, brace) * rng.uniform(-1.0, 1.0), rng.uniform(-0.5, 0.5))
        section = np.zeros((100, 2))
        recording = Recording(0.0, section, np.zeros(32 * (k % 4 == 0), EVENT_ROW), True)
        tangent = TangentState(np.eye(2)[: 2 * (k % 2)], np.zeros(2 * (k % 2)))
        march(p, progress, 99, recording, tangent)


def verdicts():
    """Classify random systems in a batch: slender blocks one by one and in lanes, with and without braces, and full blocks."""
    rng = np.random.default_rng(77)
    stop = np.zeros(1, np.int64)
    for count, full in ((VERDICTS, False), (FULL_VERDICTS, True)):
        period = rng.uniform(0.3, 4.0, count)
        rows = np.column_stack([rng.uniform(1.0, 16.0, count), 2.0 * math.pi / period, period])
        rows = np.column_stack([rows, rng.uniform(0.0, 6.0, count), rng.uniform(0.6, 1.0, count)])
        braced = np.column_stack([rows, rng.uniform(0.2, 1.5, count), rng.uniform(0.5, 1.0, count)])
        free = np.column_stack([rows, np.full(count, math.inf), np.ones(count)])
        starts = rng.uniform(-0.15, 0.15, (count, 2))
        for rows in (free, braced):
            arguments = np.column_stack([rows, np.full(count, 0.3 * full)]), starts, 1_000, 32
            batch.classify_one_by_one(*arguments, make_workspace(1_000, 32), empty_results(count), stop)
            if not full:
                classify_batch_lanes(*arguments, make_lane_workspace(1_000, 32), empty_results(count), stop)


def tools(processor):
    """Return a C compiler and the command that runs its programs, for a class of processors; None if this machine has none."""
    compiler, *emulator = EMULATED.get(processor, [""])
    if processor in classes_here():
        compiler, emulator = "cc", []
    found = map(shutil.which, [compiler, *emulator[:1]])
    return (compiler, emulator) if all(found) else None


@pytest.fixture(scope="module")
def calls():
    """Calls of every entry point."""
    import_all()
    recorded, counts, lock = [], Counter(), Lock()
    most, longest = MOST_CALLS, MOST_SECONDS

    def run(entry, *arguments):
        block, arrays = entry.signature.pack(arguments), list(arrays_in(arguments))
        with lock:
            before, begun = written(entry, block, arrays), thread_time()
            entry.load()(ctypes.addressof(ctypes.c_char.from_buffer(block)))
            seconds = thread_time() - begun
            if seconds < longest and counts[entry.name] < most:
                counts[entry.name] += 1
                recorded.append(Call(entry.name, seconds, before, written(entry, block, arrays)))
        return entry.signature.unpack(block)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(export.EntryPoint, "__call__", run)
        workload()
        most = longest = math.inf
        motions()
        verdicts()
    assert set(counts) == set(export.ENTRY_POINTS)
    return recorded


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    """The folder of the object files of all classes of processors that can be run here, but of that of the package's library."""
    folder = tmp_path_factory.mktemp("objects")
    classes = [each for each in CLASSES if tools(each) and each != load.library_class()]
    build.Compilers(folder).compile(build.GROUPS, classes)
    return folder


@pytest.mark.long
@pytest.mark.parametrize("processor", [*CLASSES, "x86-64 without fused products"])
def test_each_class_of_processors_gives_the_same_bits(processor, calls, objects, tmp_path):
    setting = {}
    if processor not in CLASSES:
        processor, _, _ = processor.partition(" ")
        setting, counts = SOFTWARE, Counter()
        short = [call for call in calls if call.seconds < FEW_SECONDS]
        calls = [call for call in short if not counts.update([call.name]) and counts[call.name] <= FEW_CALLS]
    if not tools(processor):
        needed = " and ".join(EMULATED.get(processor, ["an emulator"])[:2])
        pytest.skip(f"this processor is not of the class {processor}, which would need {needed}")
    compiler, emulator = tools(processor)
    program, library = tmp_path / "replay", load.path_of(processor)
    subprocess.run([compiler, "-O1", REPLAY, "-ldl", "-o", program], check=True)
    if processor != load.library_class():
        library, made = tmp_path / "kernels.so", sorted(objects.glob(f"*-{processor}.o"))
        subprocess.run([compiler, "-shared", "-nostdlib", *made, "-lm", "-lc", "-o", library], check=True)
    given = b"".join(call.before for call in calls)
    command = [*emulator, program, library]
    run = subprocess.run(command, input=given, stdout=subprocess.PIPE, env=os.environ | setting, check=True)
    found = io.BytesIO(run.stdout)
    others = Counter(
        call.name for call in calls if results(found.read(len(call.after))) != results(call.after)
    )
    assert others == Counter()
    assert not found.read()
