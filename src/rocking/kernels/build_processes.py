"""Start of the builders, processes that compile the entry points, and the wait for them.

At most two work for one folder, however many processes start them. A builder holds a lock as long as it works.
"""

import fcntl
import logging
import os
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from rocking.kernels import machine_code
from rocking.kernels.waiting import report

MAX_BUILDERS = 2
# Seconds of one core that the longest entry points took when measured, in the order in which they are compiled.
SECONDS = {
    "march.march_plain.HarmonicParameters": 12.0,
    "batch.classify_batch_scalar.HarmonicParameters": 16.0,
    "scheduler.classify_batch_lanes": 26.0,
    "march.march_plain.SampledParameters": 14.0,
    "finite_runs.run_to_end.SampledParameters": 12.0,
    "march.march_plain.PulseParameters": 18.0,
    "finite_runs.run_to_end.PulseParameters": 8.0,
    "attractor_anchor.anchor_each.HarmonicParameters": 2.7,
    "sweep.sweep.HarmonicParameters": 1.9,
    "newton_search.newton_from_starts.HarmonicParameters": 1.1,
    "continuation.follow": 9.0,
    "bifurcation_curve.follow_curve": 7.0,
    "march.march_plain.FullHarmonicParameters": 20.0,
    "march.march_plain.FullSampledParameters": 20.0,
    "finite_runs.run_to_end.FullSampledParameters": 9.0,
    "march.march_plain.FullPulseParameters": 14.0,
    "finite_runs.run_to_end.FullPulseParameters": 6.0,
    "batch.classify_batch_scalar.FullHarmonicParameters": 30.0,
    "attractor_anchor.anchor_each.FullHarmonicParameters": 2.9,
}
SECONDS_OF_OTHERS = 0.3
# Starts of the builders, in case that some are killed.
STARTS = 2
# Interval, in seconds, at which a waiting process looks for the machine code.
INTERVAL = 0.05
# Environment variable of a builder. It starts no builders of its own.
IS_BUILDER = "ROCKING_IS_BUILDER"
# Environment variable of a builder: the hash of the sources of the process that asks. A folder is named by it.
BUILDER_SOURCES = "ROCKING_BUILDER_SOURCES"


@contextmanager
def hold_lock(path: Path, kind: int = fcntl.LOCK_EX) -> Iterator[bool]:
    """Hold the lock of a file as long as the context lasts; False if another process holds it.

    OSError: if the file cannot be opened, or the file system has no locks.
    """
    with path.open("a") as file:
        try:
            fcntl.flock(file, kind | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        else:
            yield True


def lock_paths(folder: Path) -> list[Path]:
    """Return the lock files of a folder; each builder holds one."""
    return [folder / f"builder-{k}.lock" for k in range(MAX_BUILDERS)]


def are_running(folder: Path) -> bool:
    """Return whether any builder works for a folder."""
    for path in lock_paths(folder):
        with hold_lock(path, fcntl.LOCK_SH) as free:
            if not free:
                return True
    return False


def builder_environment(processors: str) -> dict[str, str]:
    """Return the environment of a builder for a class of processors; "native" stands for this processor alone.

    No other setting of the compiler is taken over, because everyone who uses the folder trusts the result.
    """
    environment = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    paths = str(machine_code.SOURCES.parents[1]), os.environ.get("PYTHONPATH", "")
    environment |= {"PYTHONPATH": os.pathsep.join(filter(None, paths)), IS_BUILDER: "1"}
    environment[BUILDER_SOURCES] = machine_code.hash_sources()
    if processors != "native":
        features = ",".join(f"+{feature}" for feature in machine_code.CLASSES[processors].split(","))
        # Else LLVM uses half of the width of the registers.
        features += ",-prefer-256-bit"
        environment |= {"NUMBA_CPU_NAME": processors, "NUMBA_CPU_FEATURES": features}
    return environment


def start(what: str, target: str, processors: str, output: int) -> "subprocess.Popen[bytes]":
    """Start a process of the module ``builder``. OSError: if there is no interpreter for it."""
    if not sys.executable or getattr(sys, "frozen", False) or os.environ.get(IS_BUILDER):
        raise OSError("no interpreter that could be a builder")
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "rocking.kernels.builder", what, target],
        env=builder_environment(processors),
        start_new_session=True,  # Ctrl-C does not reach it
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=subprocess.DEVNULL,
    )


def start_builders(folder: Path, processors: str) -> None:
    """Start the builders of a folder, which outlive this process. Those that are not needed end at once."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    count = min(MAX_BUILDERS, cores)
    for process in [start("folder", str(folder), processors, subprocess.DEVNULL) for _ in range(count)]:
        process.wait()  # for the lock, not for the work


@cache
def say_once() -> None:
    """Log that this process waits for the compiler."""
    kept = machine_code.find_folder() is not None
    often = "once for this machine" if kept else "at every start, because no cache folder is writable"
    logging.getLogger("rocking").info("compiling the kernels (%s)", often)


def request_code(name: str) -> bytes | None:
    """Have a builder compile an entry point, and return its object file; None if it fails."""
    say_once()
    folder = machine_code.find_folder()
    code = await_code(name, folder) if folder else None
    if code is None:
        code = await_piped_code(name)
    report(name, 1.0)
    return code


def await_code(name: str, folder: Path) -> bytes | None:
    """Have the builders of a folder compile an entry point before others; None if they fail."""
    wanted = folder / f"{name}.wanted"
    with suppress(OSError):
        if not wanted.exists():  # else a process that waits longer would fall behind
            wanted.touch()
        for _ in range(STARTS):
            start_builders(folder, machine_code.processor_class())
            running = True
            while running:
                # First whether they run: one that ends has written its last file before.
                running = are_running(folder)
                if (code := machine_code.read(name)) is not None:
                    wanted.unlink(missing_ok=True)
                    return code
                report(name, progress_of(name, folder))
                time.sleep(INTERVAL)
    return None


def await_piped_code(name: str) -> bytes | None:
    """Have a builder compile an entry point without a folder; None if it fails."""
    with suppress(OSError), start("entry", name, machine_code.processor_class(), subprocess.PIPE) as process:
        try:
            code, _ = process.communicate()
        except BaseException:
            process.kill()
            raise
        return code if process.returncode == 0 else None
    return None


def progress_of(name: str, folder: Path) -> float:
    """Return the fraction of the work for an entry point that a builder has noted."""
    try:
        return float((folder / f"{name}.progress").read_text())
    except (OSError, ValueError):
        return 0.0


def fraction_done(names: Iterable[str]) -> float:
    """Return the fraction of the work for some entry points that is done, by measured seconds."""
    folder, done, whole = machine_code.find_folder(), 0.0, 0.0
    for name in names:
        seconds = SECONDS.get(name, SECONDS_OF_OTHERS)
        whole += seconds
        if machine_code.is_stored(name):
            done += seconds
        elif folder:
            done += seconds * progress_of(name, folder)
    return done / whole if whole else 1.0


def build_all(names: Iterable[str], folder: Path, processors: str) -> None:
    """Have builders compile all that is missing in a folder for a class of processors, and wait for them.

    RuntimeError: if one of the entry points ``names`` could not be compiled. OSError: if no builder can be started.
    """
    folder.mkdir(parents=True, exist_ok=True)
    start_builders(folder, processors)
    while are_running(folder):
        time.sleep(INTERVAL)
    failed = sorted(name for name in names if not (folder / f"{name}.o").exists())
    if failed:
        reasons = [
            path.read_text()
            for path in map(folder.joinpath, (f"{name}.error" for name in failed))
            if path.exists()
        ]
        raise RuntimeError(f"not compiled: {', '.join(failed)}\n{''.join(reasons[:1])}")
