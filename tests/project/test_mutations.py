"""Entries of ``mutations.toml`` match the source and the tests, and the runner reports which of them are detected."""

import ast
import os
import signal
import subprocess
import sys
import time
from functools import cache

import pytest

import mutations
from mutations import ROOT, Mutation

ENTRIES = mutations.read_mutations()
CODE = "def double(x):\n    return 2 * x\n"
TEST = """
import time
from pathlib import Path
from code_under_test import double

def test_double():
    assert double(3) == 6

def test_zero():
    assert double(0) == 0

def test_slow():
    Path("started").touch()
    time.sleep(100)
"""


@cache
def functions_of(file):
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize("entry", ENTRIES, ids=str)
def test_entry_matches_its_file_once_and_names_a_test(entry):
    source = (ROOT / entry.file).read_text(encoding="utf-8")
    assert source.count(entry.old) == 1
    assert entry.apply(source) != source
    file, _, name = entry.test.partition("::")
    assert name.partition("[")[0] in functions_of(file)


def test_no_two_entries_are_the_same():
    assert len(set(ENTRIES)) == len(ENTRIES)


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A checkout with one function and its tests."""
    root = tmp_path / "checkout"
    (root / "src").mkdir(parents=True)
    (root / "src/code_under_test.py").write_text(CODE)
    (root / "test_code.py").write_text(TEST)
    monkeypatch.setattr(mutations, "ROOT", root)
    return root


def mutation(new, test):
    return Mutation("src/code_under_test.py", "2 * x", new, f"test_code.py::{test}")


def test_only_a_test_that_fails_detects_a_mutation(project, tmp_path):
    copies = mutations.Copies(tmp_path, workers=1, seconds=120)
    results = {
        "3 * x": (True, "assert 9 == 6"),
        "x + x": (False, "the test passes"),
        "2 * * x": (False, "no test ran"),
        "__import__('numba').njit(lambda y: y.a)(x)": (False, "numba.core.errors.TypingError"),
    }
    for new, (failed, reason) in results.items():
        found = copies.check(mutation(new, "test_double"))
        assert (found[0], found[1][: len(reason)]) == (failed, reason)
    assert copies.check(mutation("3 * x", "test_zero")) == (False, "the test passes")
    copies.seconds = 1
    assert copies.check(mutation("3 * x", "test_slow")) == (False, "no result within 1 s")
    assert (project / "src/code_under_test.py").read_text() == CODE
    assert (tmp_path / "checkout-0/src/code_under_test.py").read_text() == CODE


def test_an_entry_that_does_not_match_its_file_is_an_error(project, tmp_path):
    copies = mutations.Copies(tmp_path, workers=1, seconds=120)
    with pytest.raises(ValueError, match=r"must contain '4 \* x' once; got 0 times"):
        copies.check(Mutation("src/code_under_test.py", "4 * x", "x", "test_code.py::test_double"))


def test_an_interrupted_run_leaves_nothing(project, tmp_path):
    (tmp_path / "list.toml").write_text(
        "[[mutation]]\nfile = 'src/code_under_test.py'\nold = '2'\nnew = '3'\ntest = 'test_code.py::test_slow'\n"
    )
    (tmp_path / "temporary").mkdir()
    program = f"import mutations; from pathlib import Path; mutations.ROOT = Path({str(project)!r}); mutations.run()"
    with subprocess.Popen(
        [sys.executable, "-c", program, "--trust", "--list", str(tmp_path / "list.toml")],
        cwd=ROOT / "tests",
        env=os.environ | {"TMPDIR": str(tmp_path / "temporary")},
        start_new_session=True,
    ) as process:
        while not list(tmp_path.glob("temporary/*/checkout-0/started")):
            assert process.poll() is None
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 130
    assert list((tmp_path / "temporary").iterdir()) == []


@pytest.mark.parametrize(
    ("words", "kernels", "count"),
    [([], None, 3), (["plot/"], None, 1), ([], True, 1), ([], False, 2), (["motion", "plot/"], False, 1)],
)
def test_entries_are_selected_by_file(words, kernels, count):
    files = [
        "src/rocking/plot/sections.py",
        "src/rocking/kernels/motion/march.py",
        "src/rocking/model/block.py",
    ]
    assert len(mutations.select([Mutation(file, "", "", "") for file in files], words, kernels)) == count
