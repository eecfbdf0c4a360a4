"""Comparison of two commits pair by pair: intervals, verdicts, and no files left behind."""

import math
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from benchmarks import against

ROOT = Path(__file__).parents[2]
CASE = "one block (1,1)"
COMPARE = """
import sys
from pathlib import Path
from rich.console import Console
from benchmarks import against
against.end_on_signals()
against.compare(Path(sys.argv[1]), "HEAD", [sys.argv[2]], 1, Console(file=sys.stderr))
"""


@pytest.mark.parametrize("count", range(8, 61))
def test_interval_is_the_shortest_pair_of_ranks_that_holds_the_median_in_95_of_100_samples(count):
    values = random.Random(count).sample(range(1, count + 1), count)
    low, high = against.interval_of_median(values)  # the values are their own ranks
    assert low + high == count + 1

    def confidence(rank):
        """Return the probability that the median lies between the values of this rank and of its mirror image."""
        return 1 - 2 * sum(math.comb(count, k) for k in range(rank)) / 2**count

    assert confidence(low) >= 0.95
    assert confidence(low + 1) < 0.95


@pytest.mark.parametrize(
    "interval, answer",
    [
        ((0.99, 1.01), "equal"),
        ((1.02, 1.06), "equal"),
        ((1.031, 1.05), "slower"),
        ((1.031, 1.2), "slower"),
        ((0.95, 0.96), "faster"),
        ((0.96, 0.98), "equal"),
        ((0.96, 1.03), "undecided"),
        ((0.8, 0.9), "undecided"),
    ],
)
def test_a_wide_interval_is_no_pass_and_one_wholly_above_the_bound_is_a_loss(interval, answer):
    assert against.judge(interval) == answer


def test_pairs_are_added_to_a_case_until_its_interval_is_narrow_or_the_cap_is_reached(monkeypatch):
    steady, noisy, settling = "lanes", "map, e = 1", CASE
    counts = dict.fromkeys((steady, noisy, settling), 0)

    def pair_of(name):
        counts[name] += 1
        wide = {steady: False, noisy: True, settling: counts[name] <= 15}[name]
        return 1.0, 1.0 + 0.2 * wide * (-1) ** counts[name]

    monkeypatch.setattr(against, "compile_kernels", lambda *_: None)
    monkeypatch.setattr(
        against, "measure_pairs", lambda _, names, __: {name: pair_of(name) for name in names}
    )
    pairs = against.compare(ROOT, "HEAD", list(counts), 1, Console(quiet=True))
    assert len(pairs[steady]) == against.MIN_PAIRS
    assert against.MIN_PAIRS < len(pairs[settling]) < against.MAX_PAIRS
    assert len(pairs[noisy]) == against.MAX_PAIRS
    answers = against.table_of(pairs)[1]
    assert answers == {steady: "equal", noisy: "undecided", settling: "equal"}


def test_what_names_no_commit_is_refused_in_one_line(capsys):
    with pytest.raises(SystemExit) as refused:
        against.main(["no-such-commit"])
    assert refused.value.code == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.endswith("REF must be a commit of this repository; got 'no-such-commit'")


PACKAGE = """
import os, time

def log(*_, **more):
    with open(os.environ["CALLS"], "a") as calls:
        print("SIDE", file=calls)

Braces = Harmonic = System = lambda *_, **more: None
simulate = parametric_map = log
"""
"""Stand-in for the package that reports which side runs and computes nothing."""


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository whose commit and whose working tree differ, and an empty folder for temporary files."""
    root, scratch = tmp_path / "repository", tmp_path / "scratch"
    package = root / "src/rocking/__init__.py"
    package.parent.mkdir(parents=True)
    scratch.mkdir()
    monkeypatch.setenv("CALLS", str(tmp_path / "calls"))
    monkeypatch.setenv("TMPDIR", str(scratch))
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    package.write_text(PACKAGE.replace("SIDE", "REF"))
    identity = ["-c", "user.name=nobody", "-c", "user.email=nobody@localhost"]
    for command in (["init", "--quiet"], ["add", "src"], [*identity, "commit", "--quiet", "-m", "all"]):
        subprocess.run(["git", *command], cwd=root, check=True)
    package.write_text(PACKAGE.replace("SIDE", "new"))
    return root


def left_behind(repository):
    """Return additional worktrees of the repository, and temporary files."""
    trees = against.git(repository, "worktree", "list", "--porcelain").count("worktree ") - 1
    return trees, [path.name for path in Path(tempfile.gettempdir()).iterdir()]


def test_each_side_runs_its_own_sources_in_pairs_of_random_order_after_one_run_that_is_not_timed(
    repository, tmp_path, monkeypatch
):
    monkeypatch.setattr(against, "MIN_PAIRS", 8)
    monkeypatch.setattr(against, "MAX_PAIRS", 8)
    pairs = against.compare(repository, "HEAD", [CASE], 7, Console(quiet=True))
    calls = (tmp_path / "calls").read_text().split()
    rounds = [tuple(calls[first : first + 8]) for first in range(4, len(calls), 8)]  # the first four compile
    assert len(rounds) == len(pairs[CASE]) == 8
    ref_first = ("REF", "REF", "new", "new", *("REF", "new") * 2)
    new_first = ("new", "new", "REF", "REF", *("new", "REF") * 2)
    assert set(rounds) == {ref_first, new_first}
    assert left_behind(repository) == (0, [])


COMPILER = """
import os, sys, time

print("compile SIDE", *sys.argv[1:], file=open(os.environ["CALLS"], "a"))
"""
"""Stand-in for the compiler of the kernels of a side."""


@pytest.fixture
def compiled_sides(repository):
    """REF, an older commit, and the working tree with a library of kernels; both report what compiles them."""
    sides = [against.Side(repository / name, dict(os.environ)) for name in ("older", "src")]
    for side, name in zip(sides, ("REF", "new"), strict=True):
        package = side.source / "rocking"
        (package / "kernels/library").mkdir(parents=True)
        (package / "__init__.py").write_text(PACKAGE.replace("SIDE", name))
        (package / "kernels/__init__.py").touch()
        (package / "kernels/__main__.py").write_text(COMPILER.replace("SIDE", name))
    (sides[1].source / "rocking/kernels/library/build.py").touch()
    return sides


def test_an_older_commit_compiles_what_its_cases_call_and_a_library_is_compiled_without_them(
    compiled_sides, tmp_path
):
    against.compile_kernels(compiled_sides, [CASE])
    lines = (tmp_path / "calls").read_text().splitlines()
    assert lines == ["REF", "REF", "compile REF", "compile new"]  # a case runs twice, and only once is timed


def test_kernels_that_do_not_compile_end_the_comparison(compiled_sides):
    main = compiled_sides[1].source / "rocking/kernels/__main__.py"
    main.write_text("raise SystemExit(1)")
    with pytest.raises(ChildProcessError, match="were not compiled"):
        against.compile_kernels(compiled_sides[1:], [CASE])


def test_an_interrupted_compilation_ends_in_order(compiled_sides, tmp_path, monkeypatch):
    main = compiled_sides[1].source / "rocking/kernels/__main__.py"
    waits = "try:\n    time.sleep(600)\nfinally:\n    time.sleep(0.5)\n    open(os.environ['CALLS'] + '-end', 'w')\n"
    main.write_text(COMPILER + waits)
    program = (
        "import sys; from pathlib import Path; from benchmarks import against; against.end_on_signals();"
        "import os; against.compile_kernels([against.Side(Path(sys.argv[1]), dict(os.environ))], [])"
    )
    command = [sys.executable, "-c", program, compiled_sides[1].source]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.DEVNULL) as process:
        while not (tmp_path / "calls").exists():
            assert process.poll() is None
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=60)
    assert process.returncode != 0
    assert (tmp_path / "calls-end").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_comparison_that_is_ended_leaves_no_worktree_and_no_file_behind(repository, tmp_path, number):
    package = repository / "src/rocking/__init__.py"
    package.write_text(package.read_text() + "simulate = lambda *_, **more: time.sleep(600)")
    command = [sys.executable, "-c", COMPARE, repository, CASE]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.DEVNULL) as process:
        while not (tmp_path / "calls").exists():  # the other side is at work
            assert process.poll() is None
            time.sleep(0.05)
        assert left_behind(repository) != (0, [])
        process.send_signal(number)
        process.wait(timeout=60)
    assert process.returncode != 0
    assert left_behind(repository) == (0, [])


def test_a_process_that_would_run_other_sources_ends_and_says_so(repository, monkeypatch):
    monkeypatch.setattr(against, "ROOT", repository)
    elsewhere = against.Side(repository / "lib", {"PYTHONPATH": str(ROOT / "src")})
    with against.Worker(elsewhere) as worker, pytest.raises(ChildProcessError, match="has ended early"):
        worker.measure(CASE)


@pytest.mark.long
def test_every_case_runs_on_the_package_as_it_is(monkeypatch):
    monkeypatch.setattr(against, "MIN_PAIRS", 2)
    monkeypatch.setattr(against, "MAX_PAIRS", 2)
    monkeypatch.setattr(against, "interval_of_median", lambda ratios: (min(ratios), max(ratios)))
    pairs = against.compare(ROOT, "HEAD", list(against.CASES), 1, Console(quiet=True))
    assert pairs.keys() == against.CASES.keys()
    assert all(len(found) == 2 and np.all(np.array(found) > 0) for found in pairs.values())
