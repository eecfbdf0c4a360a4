"""Rerun the mutations of ``mutations.toml``: break the code on purpose and expect a test to fail.

Each entry names a file, the text to replace, its replacement, and the test that must fail. The work is done in
copies of the checkout in a temporary folder. With a mutation of a kernel, each entry point that the test calls is
compiled alone, when it is called.
"""

import argparse
import os
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
LIST = Path(__file__).with_suffix(".toml")
KERNELS = "src/rocking/kernels/"
LOAD = KERNELS + "library/load.py"
# In a copy with a changed kernel this stands at the end of the module that opens the library.
COMPILED_ALONE = """

def function_of(symbol):
    import subprocess
    from rocking.kernels.library import build

    made = Path({folder!r}, symbol + ".so")
    with build.TemporaryDirectory() as folder:
        if not made.exists():
            build.Compilers(Path(folder), subprocess.DEVNULL).compile([symbol], [processor_class()])
            build.link(list(Path(folder).glob("*.o")), Path(folder, made.name))
            build.place(Path(folder, made.name), made)
    function = getattr(ctypes.CDLL(str(made)), symbol)
    function.argtypes, function.restype = (ctypes.c_int64,), None
    return function
"""
NOT_COPIED = shutil.ignore_patterns(".*", "__pycache__", "build", "results", "*.egg-info")
# Exit code of pytest for tests that ran and failed. After any other code no test has failed.
TESTS_FAILED = 1


@dataclass(frozen=True)
class Mutation:
    """Change of one file, and the test that must fail because of it."""

    file: str
    old: str
    new: str
    test: str

    def __str__(self):
        old, new = (" ".join(text.split()) for text in (self.old, self.new))
        return f"{self.file.removeprefix('src/rocking/')}: {old} → {new or '(nothing)'}"

    @property
    def changes_a_kernel(self):
        """Return whether the change is one of compiled code."""
        return self.file.startswith(KERNELS) and not self.file.startswith(KERNELS + "library/")

    def apply(self, source):
        """Return the changed source."""
        if source.count(self.old) != 1:
            raise ValueError(
                f"{self.file} must contain {self.old!r} once; got {source.count(self.old)} times"
            )
        return source.replace(self.old, self.new)


def read_mutations(path=LIST):
    """Read the list of mutations."""
    return [Mutation(**entry) for entry in tomllib.loads(path.read_text(encoding="utf-8"))["mutation"]]


class Copies:
    """Copies of the checkout, one for each worker, and the tests that run in them."""

    def __init__(self, folder, workers, seconds):
        self.folder, self.seconds = Path(folder), seconds
        self.running, self.stopped = set(), threading.Event()
        self.free = queue.Queue()
        for worker in range(workers):
            copy = self.folder / f"checkout-{worker}"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(ROOT, copy, ignore=NOT_COPIED, symlinks=True)
            self.free.put(copy)

    def check(self, mutation):
        """Apply a mutation in a copy and run its test.

        Returns
        -------
        tuple of (bool, str)
            Whether the test failed, and the reason in one line.
        """
        copy = self.free.get()
        files = {mutation.file, LOAD} if mutation.changes_a_kernel else {mutation.file}
        before = {file: (copy / file).read_bytes() for file in files}
        try:
            with tempfile.TemporaryDirectory(dir=self.folder, ignore_cleanup_errors=True) as folder:
                (copy / mutation.file).write_text(
                    mutation.apply(before[mutation.file].decode()), encoding="utf-8"
                )
                if mutation.changes_a_kernel:
                    text = before[LOAD].decode() + COMPILED_ALONE.format(folder=folder)
                    (copy / LOAD).write_text(text, encoding="utf-8")
                return self.detect(mutation, copy)
        finally:
            for file, content in before.items():
                (copy / file).write_bytes(content)
            self.free.put(copy)

    def detect(self, mutation, copy):
        """Run the test of a mutation that is applied in a copy. Returns as `check`."""
        code, output = self.pytest(copy, [mutation.test], self.seconds)
        if code is None:
            return False, f"no result within {self.seconds:g} s"
        reason = describe(code, output) or "the test passes"
        compiles = "numba.core.errors" not in reason  # else the change was not tested
        return code == TESTS_FAILED and compiles, reason

    def check_unchanged(self, tests):
        """Run tests in an unchanged copy. Returns None if they pass, else the reason in one line."""
        copy = self.free.get()
        try:
            return describe(*self.pytest(copy, tests, seconds=None))
        finally:
            self.free.put(copy)

    def pytest(self, copy, tests, seconds):
        """Run tests in a copy. Returns the exit code, None after the time limit, and the output."""
        options = ["-q", "-x", "--tb=short", "--timeout=0", "-p", "no:cacheprovider"]
        command = [sys.executable, "-m", "pytest", *options, "-m", "long or not long", *tests]
        environment = os.environ | {
            "PYTHONPATH": str(copy / "src"),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        with subprocess.Popen(
            command,
            cwd=copy,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        ) as process:
            self.running.add(process)
            if self.stopped.is_set():
                kill(process)
            try:
                output = process.communicate(timeout=seconds)[0]
                return process.returncode, output
            except subprocess.TimeoutExpired:
                return None, ""
            finally:
                kill(process)
                self.running.discard(process)

    def stop(self):
        """End all tests."""
        self.stopped.set()
        for process in list(self.running):
            kill(process)


def describe(code, output):
    """Describe the end of pytest in one line; None if all tests passed."""
    lines = output.strip().splitlines()
    if code == 0:
        return None
    if code != TESTS_FAILED:
        return f"no test ran: {lines[-1] if lines else f'exit code {code}'}"
    return next((line[1:].strip() for line in lines if line.startswith("E ")), "failed")


def kill(process):
    """End a process and all processes that it started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def select(mutations, words, kernels):
    """Return the mutations of the files whose paths contain one of `words`, all without words."""
    chosen = [m for m in mutations if not words or any(word in m.file for word in words)]
    return [m for m in chosen if kernels is None or m.file.startswith(KERNELS) == kernels]


def rerun(mutations, copies, workers):
    """Rerun mutations and print two lines for each. Returns those whose tests did not fail."""
    missed = []

    def check(mutation):
        begun = time.monotonic()
        return *copies.check(mutation), time.monotonic() - begun

    with ThreadPoolExecutor(workers) as pool:
        try:
            tasks = {pool.submit(check, mutation): mutation for mutation in mutations}
            for task in as_completed(tasks):
                mutation, (failed, reason, seconds) = tasks[task], task.result()
                print(f"{'caught' if failed else 'MISSED'} {seconds:4.0f} s  {mutation}")
                print(f"{'':15}{mutation.test}: {reason}", flush=True)
                if not failed:
                    missed.append(mutation)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            copies.stop()
            raise
    return missed


def main():
    parser = argparse.ArgumentParser(description="Break the code on purpose and expect a test to fail.")
    parser.add_argument(
        "words", nargs="*", metavar="FILE", help="part of a path, such as plot/; default: all"
    )
    parser.add_argument("--workers", type=int, default=1, help="number of mutations at a time; default: 1")
    kinds = parser.add_mutually_exclusive_group()
    kinds.add_argument("--kernels", action="store_true", default=None, help="only mutations of kernels")
    kinds.add_argument("--no-kernels", dest="kernels", action="store_false", help="no mutations of kernels")
    parser.add_argument("--seconds", type=float, default=1800, help="time limit per mutation; default: 1800")
    parser.add_argument(
        "--trust", action="store_true", help="do not run the tests on the unchanged code first"
    )
    parser.add_argument("--folder", type=Path, help="working folder, which is kept; default: a temporary one")
    parser.add_argument(
        "--list", type=Path, default=LIST, help="list of mutations; default: tests/mutations.toml"
    )
    given = parser.parse_args()
    mutations = select(read_mutations(given.list), given.words, given.kernels)
    if not mutations:
        parser.error("no mutation is selected")
    with tempfile.TemporaryDirectory(prefix="rocking-mutations-") as temporary:
        copies = Copies(given.folder or temporary, given.workers, given.seconds)
        if not given.trust:
            reason = copies.check_unchanged(sorted({mutation.test for mutation in mutations}))
            if reason is not None:
                raise SystemExit(f"the selected tests must pass on the unchanged code: {reason}")
        missed = rerun(mutations, copies, given.workers)
    print(f"{len(mutations)} mutations, {len(mutations) - len(missed)} caught, {len(missed)} missed")
    return 1 if missed else 0


def run():
    """Run the command line and exit; Ctrl-C ends all tests and removes all copies."""
    # A shell lets commands in the background ignore Ctrl-C.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    run()
