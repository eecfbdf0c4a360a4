"""Files of the project: pinned versions, the build machine, the citation, and no path outside the repository."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import rocking
from rocking.kernels.library.processor import COMPILER

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
REQUIREMENTS = [
    requirement
    for group in (PROJECT["dependencies"], *PROJECT["optional-dependencies"].values())
    for requirement in map(Requirement, group)
    if requirement.name != PROJECT["name"]  # an extra may contain others
]
MODULES = sorted((ROOT / "src").rglob("*.py"))
MADE = {"results", "build", "dist", "__pycache__"}
TEXTS = {"", ".cff", ".json", ".md", ".py", ".sh", ".toml", ".txt"}
CONSTRAINTS = sorted((ROOT / "constraints").iterdir())


def own_texts(folder=ROOT):
    for path in sorted(folder.iterdir()):
        hidden = path.name.startswith(".") and path.name not in {".ci", ".gitignore"}
        if hidden or path.name in MADE or path.suffix == ".egg-info":
            continue
        if path.is_dir():
            yield from own_texts(path)
        elif path.suffix in TEXTS or path.name == ".gitignore":
            yield path


def named(path):
    return str(path.relative_to(ROOT))


def test_nothing_points_at_one_machine():
    machine = re.compile(r"(?<![\w.~:/])/(?:home|root|Users|work|tmp)/\w|\b[A-Z]:\\")
    found = [
        f"{named(path)}:{number}: {line.strip()}"
        for path in own_texts()
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if machine.search(line)
    ]
    assert found == []


def test_own_texts_reach_every_corner():
    reached = {named(path) for path in own_texts()}
    assert {
        ".ci/run",
        "Makefile",
        "README.md",
        "scripts/setup.sh",
        "tests/project/test_project.py",
    } <= reached
    assert not any(path.startswith((".venv", ".git/")) for path in reached)


@pytest.mark.parametrize("path", CONSTRAINTS, ids=named)
def test_constraints_pin_every_dependency_by_version_alone(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    assert [line for line in lines if not re.fullmatch(r"[\w.-]+==[\w.]+", line)] == []
    pinned = {canonicalize_name(name): version for name, version in (line.split("==") for line in lines)}
    assert [
        str(r) for r in REQUIREMENTS if pinned.get(canonicalize_name(r.name), "") not in r.specifier
    ] == []


def test_every_python_from_the_oldest_allowed_is_pinned():
    oldest = int(PROJECT["requires-python"].removeprefix(">=3."))
    minors = sorted(int(path.stem.removeprefix("python-3.")) for path in CONSTRAINTS)
    assert minors == list(range(oldest, oldest + len(minors)))


@pytest.mark.parametrize("target", ["lint", "test", "docs", "test-project", "test-long"])
def test_build_machine_runs_make(target):
    assert re.search(rf"^(?:exec )?make {target}\b", (ROOT / ".ci/run").read_text(), re.MULTILINE)


def test_build_machine_leaves_out_what_takes_hours():
    assert "exhaustive" not in (ROOT / ".ci/run").read_text()


def test_a_part_is_drawn_by_its_seed_or_evenly_spread_and_the_whole_is_the_whole(
    thin, pytestconfig, monkeypatch, capsys
):
    monkeypatch.setattr(pytestconfig.option, "exhaustive", False)
    drawn = thin(range(1_000), 30, seed=11)
    assert capsys.readouterr().out == "30 of 1000, seed 11\n"
    assert len(set(drawn)) == 30
    assert drawn == thin(range(1_000), 30, seed=11) != thin(range(1_000), 30, seed=12)
    assert list(thin(range(1_000), 4)) == [0, 250, 500, 750]
    assert list(thin("abc", 4)) == ["a", "b", "c"]
    monkeypatch.setattr(pytestconfig.option, "exhaustive", True)
    assert thin(range(1_000), 30, seed=11) == range(1_000)


def test_packages_whose_inner_parts_are_used_have_an_upper_bound():
    inner = re.compile(r"^\s*from (\w+)\.core\b", re.MULTILINE)
    used = {name for path in MODULES for name in inner.findall(path.read_text())}
    bounded = {
        requirement.name
        for requirement in REQUIREMENTS
        if any(bound.operator in ("<", "==") for bound in requirement.specifier)
    }
    # bokeh documents what is in its `core`
    assert {"numba", "zarr"} <= used - {"bokeh"} <= bounded


def test_citation_gives_the_version_of_the_package():
    assert f"\nversion: {rocking.__version__}\n" in (ROOT / "CITATION.cff").read_text()


def test_package_is_cited_by_the_authors_and_the_year_of_its_files():
    (author,) = re.findall(r"^authors:\n  - name: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    year, holder = re.search(r"Copyright \(c\) (\d{4}), (.+)", (ROOT / "LICENSE").read_text()).groups()
    package = rocking.cite().partition("\n\n")[0]
    assert author == holder
    assert f"author = {{{{{author}}}}}," in package
    assert f"year = {{{year}}}," in package


def test_extra_for_kernels_has_the_versions_of_the_sources():
    assert PROJECT["optional-dependencies"]["kernels"] == [
        f"{name}=={each}" for name, each in COMPILER.items()
    ]
