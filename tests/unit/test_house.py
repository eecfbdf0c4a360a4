"""Structure of the package: sizes, docstrings, imports, pinned versions, and no path outside the repository."""

import ast
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


def room_of(module):
    """`rocking.motion.simulate` → `motion`; None for the package itself and for others' packages."""
    package, _, rest = module.partition(".")
    return rest.partition(".")[0] or None if package == "rocking" else None


def imported_modules(path):
    here = path.relative_to(ROOT / "src").with_suffix("").parts
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = here[: -node.level] if node.level else ()
            yield ".".join([*above, *([node.module] if node.module else [])])


@pytest.mark.parametrize("path", MODULES, ids=named)
def test_module_says_what_it_is_and_stays_short(path):
    source = path.read_text()
    tree = ast.parse(source)
    assert ast.get_docstring(tree)
    assert len(source.splitlines()) <= 320
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    assert [f.name for f in functions if body_length(f) > 70] == []
    assert [f.name for f in functions if statements(f.body) > 45] == []


def body_length(function):
    """Lines of a function without its docstring."""
    documented = ast.get_docstring(function) is not None
    docstring = function.body[0].end_lineno - function.body[0].lineno + 1 if documented else 0
    return function.end_lineno - function.lineno + 1 - docstring


def statements(body):
    """Count statements, without docstrings and nested functions; an assignment to n names counts as n."""
    count = 0
    for node in body:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        targets = node.targets if isinstance(node, ast.Assign) else []
        count += max(sum(map(names, targets)), 1)
        if not isinstance(node, ast.FunctionDef | ast.ClassDef):
            parts = [getattr(node, part, []) for part in ("body", "orelse", "finalbody", "handlers", "cases")]
            count += sum(map(statements, parts))
    return count


def names(target):
    return sum(map(names, target.elts)) if isinstance(target, ast.Tuple | ast.List) else 1


def test_statements_are_counted_by_the_names_that_they_give():
    source = """
def f(x):
    'Say it.'
    a, (b, *c) = x
    for k in c:
        if k:
            return k
        else:
            pass
    try:
        a = b = 1
    except ValueError:
        pass
    def inner():
        d = e = 1
    return a
"""
    assert statements(ast.parse(source).body[0].body) == 3 + 1 + 3 + 1 + 2 + 2 + 1 + 1


@pytest.mark.parametrize("path", [path for path in MODULES if "kernels" in path.parts], ids=named)
def test_kernels_that_kernels_call_have_few_parameters(path):
    """Entry points may have more: Python gives them numbers and arrays one by one."""
    functions = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)]
    options = {f.name: " ".join(map(ast.unparse, f.decorator_list)) for f in functions}
    internal = [f for f in functions if "entry_point" not in options[f.name]]
    assert [f.name for f in internal if len(f.args.args) > 8] == []


@pytest.mark.parametrize("path", MODULES, ids=named)
def test_rooms_are_entered_by_their_front_door(path):
    """The modules of `kernels` and the parts of pictures lie a room deeper, and are named with that room."""
    own = path.relative_to(ROOT / "src").parts[1]
    others = [module for module in imported_modules(path) if room_of(module) not in (None, own)]
    assert [
        module for module in others if module.count(".") > 1 + (room_of(module) in {"kernels", "plot"})
    ] == []


def test_nothing_points_at_one_machine_or_is_left_to_do():
    machine = re.compile(r"(?<![\w.~:/])/(?:home|root|Users|work|tmp)/\w|\b[A-Z]:\\")
    undone = re.compile(r"\b(?:TO" + r"DO|FIX" + r"ME|X" + r"XX)\b")
    found = [
        f"{named(path)}:{number}: {line.strip()}"
        for path in own_texts()
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if machine.search(line) or undone.search(line)
    ]
    assert found == []


def test_own_texts_reach_every_corner():
    reached = {named(path) for path in own_texts()}
    assert {".ci/run", "Makefile", "README.md", "scripts/setup.sh", "tests/unit/test_house.py"} <= reached
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


@pytest.mark.parametrize("target", ["test", "docs"])
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
