"""The pages: complete, without dead links, with an entry for every public name. `make docs` runs their blocks."""

import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

import rocking
from docs.extensions import command_options
from docs.extensions.entries import PAGES as REFERENCE
from docs.extensions.entries import sections
from rocking.cli.commands import COMMANDS
from rocking.papers.catalogue import PAPERS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))
FRONT = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
NEEDS_FILES = {"examples/shake_table.py", "examples/vertical.py"}
"""Examples that the gallery cannot run, because their files are not part of the package."""
FENCE = re.compile(r"^```(.*?)\n(.*?)^```", re.MULTILINE | re.DOTALL)


# Fenced blocks of which Sphinx makes a part of the page.
DIRECTIVES = {
    "{command-summary}",
    "{command}",
    "{eval-rst}",
    "{figures}",
    "{names}",
    "{report}",
    "{script}",
    "{shared-options}",
    "{thumbnails}",
    "{toctree}",
}


def name_of(path):
    return path.relative_to(ROOT).as_posix()


RUN = {name_of(script) for script in EXAMPLES} - NEEDS_FILES


def fences(path):
    """Return (language, content) of every fenced block of a page."""
    return [(kind.strip(), body) for kind, body in FENCE.findall(path.read_text(encoding="utf-8"))]


def prose(path):
    """A page without its blocks and its inline code."""
    return re.sub(r"`[^`\n]*`", "", FENCE.sub("", path.read_text(encoding="utf-8")))


def anchors(path):
    """Return the names of a page's headings in links."""
    headings = re.findall(r"^#+ (.*)$", FENCE.sub("", path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def listed(page):
    """Return the pages in the tables of contents of a page."""
    return [
        page.parent / f"{line}.md"
        for kind, body in fences(page)
        if kind == "{toctree}"
        for line in body.split("\n")
        if line and not line.startswith(":")
    ]


def test_every_page_is_in_a_table_of_contents_once():
    found, left = [DOCS / "index.md"], [DOCS / "index.md"]
    while left:
        below = listed(left.pop())
        found += below
        left += below
    assert sorted(found) == PAGES


@pytest.mark.parametrize("page", PAGES + FRONT, ids=name_of)
def test_no_link_is_dead(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        file, _, anchor = target.partition("#")
        there = (page.parent / file).resolve() if file else page
        assert there.exists(), target
        assert not anchor or anchor in anchors(there), target


@pytest.mark.parametrize("page", PAGES + FRONT, ids=name_of)
def test_no_page_names_another_host_than_that_of_dois(page):
    other_hosts = r"https?://(?!doi\.org/)|(?<!https:)//[\w-]+\."
    assert re.findall(other_hosts, page.read_text(encoding="utf-8")) == []


def test_nothing_is_installed_by_a_name_that_an_index_may_give_to_another_package():
    """The package is on no index: only its own files install it."""
    texts = [*PAGES, *FRONT, *(ROOT / "src").rglob("*.py"), *(ROOT / "src").rglob("*.html")]
    lines = [
        line for path in texts for line in re.findall(r"pip install.*", path.read_text(encoding="utf-8"))
    ]
    assert len(lines) >= 2
    own = r"pip install (-v |--force-reinstall --no-deps )?[\"']?\.(\[|/dist/|`| in a copy | --config-settings )"
    assert [line for line in lines if not re.match(own, line)] == []


def test_the_same_bits_of_surveys_are_said_of_one_class_of_processors_only():
    said = [
        paragraph
        for path in [*PAGES, *FRONT]
        for paragraph in path.read_text(encoding="utf-8").split("\n\n")
        if "bit-identical" in paragraph
    ]
    assert len(said) >= 3
    one = r"same\s+(machine|\[?class\s+of\s+processors)"
    assert [paragraph for paragraph in said if not re.search(one, paragraph)] == []


def test_readme_says_of_what_kind_the_base_motion_is():
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    assert "The base motion is harmonic, or a record" in text
    assert "need a harmonic one" in text


PUBLIC = {
    *(f"rocking.{name}" for name in set(rocking.__all__) - {"__version__", "plot", "theory"}),
    *(f"{module}.{name}" for module, names in rocking._MOVED.items() for name in names.split()),
    *(f"rocking.plot.{name}" for name in rocking.plot.__all__),
    *(f"rocking.theory.{name}" for name in rocking.theory.__all__),
}


def entries():
    """The names that the reference documents, in full."""
    return [name for page in sorted(DOCS.glob(REFERENCE)) for part in sections(page) for name in part.names]


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_every_public_name_has_one_entry_in_the_reference(name):
    assert entries().count(name) == 1


def test_every_command_has_its_entry():
    commands = [command.name for command in COMMANDS]
    page = (DOCS / "reference-commands.md").read_text(encoding="utf-8")
    assert re.findall(r"^## rocking (\S+)\n\n```{command} \1\n```$", page, re.MULTILINE) == commands
    assert page.count("```{command-summary}\n") == page.count("```{shared-options}\n") == 1


def test_every_option_is_documented_once_for_each_command():
    """It stands among the shared options, or among those of the command alone, whose text no other command has."""
    shared = command_options.shared()
    spellings = [signature.split()[0] for signature, _ in shared]
    assert len(spellings) == len(set(spellings))
    assert {"--amplitude", "--height", "--restitution", "--angle", "--json"} <= set(spellings)
    for command in command_options.commands():
        meanings = [one.meaning for one in command_options.options(command)]
        assert len(meanings) == len(set(meanings))
        assert all(text.endswith(".") for _, text in meanings)
        assert all((command in users) == (meaning in meanings) for meaning, users in shared.items())
    assert all(len(users) > 1 for users in shared.values())


def test_every_plot_function_has_a_picture_and_its_code():
    """The text about a function is a block that calls it, and that writes a picture or a folder called like it."""
    texts = {
        each.name.removeprefix("rocking.plot."): each.text
        for section in sections(DOCS / "reference-plot.md")
        for each in section.entries
    }
    assert sorted(texts) == sorted(rocking.plot.__all__)
    for name, text in texts.items():
        code = re.fullmatch(r"[A-Z][^\n]*:\n\n```python\n(.*)^```", text, re.MULTILINE | re.DOTALL)[1]
        called = name.replace("_", "-")
        assert f"rk.plot.{name}(" in code
        assert re.search(rf'"{called}(?:\.(?:png|gif|\{{suffix\}}))?"', code), name


def test_the_gallery_shows_every_plot_example_and_figure():
    shown = [kind for kind, _ in fences(DOCS / "gallery.md") if kind.startswith("{thumbnails}")]
    galleries = ("examples", "yim-lin-1991", "pulses-and-earthquakes")
    pages = ("reference-plot", *(f"gallery-{name}" for name in galleries))
    assert shown == [f"{{thumbnails}} {page}" for page in pages]
    pages = {
        kind.split()[1]: page.stem
        for page in PAGES
        for kind, _ in fences(page)
        if kind.startswith("{script}")
    }
    assert {pages[script] for script in RUN} == {"gallery-examples"}
    for paper in PAPERS:
        assert f"{{figures}} {paper}" in [kind for kind, _ in fences(DOCS / f"gallery-{paper}.md")]


def test_every_public_function_names_related_functions():
    lone = {"rocking.cite"}
    for name in PUBLIC - lone:
        module, _, short = name.rpartition(".")
        found = getattr(import_module(module), short)
        if not inspect.isfunction(found):
            continue
        _, _, related = inspect.getdoc(found).partition("\nSee Also\n--------\n")
        assert related, name
        for target in re.findall(r"^([\w.]+) : [A-Z`].*\.$", related.partition("\n\n")[0], re.MULTILINE):
            assert (target if "." in target else f"{module}.{target}") in PUBLIC - {name}, (name, target)


def test_every_example_is_in_the_gallery_once():
    shown = [kind.split()[1] for page in PAGES for kind, _ in fences(page) if kind.startswith("{script}")]
    assert sorted(shown) == sorted(RUN)


@pytest.mark.parametrize("page", [*PAGES, ROOT / "README.md"], ids=name_of)
def test_every_block_of_code_is_run(page):
    """There are no blocks but those that `make docs` runs and those of which Sphinx makes pages."""
    others = {kind.partition(" ")[0] for kind, _ in fences(page)} - {"python", "sh"}
    assert others <= ({""} if page in FRONT else DIRECTIVES)


def test_no_two_pages_write_to_one_store():
    """A reader who tries the pages in one folder, one after another, gets no error."""
    texts = {name_of(page): page.read_text(encoding="utf-8") for page in [*PAGES, ROOT / "README.md"]}
    texts |= {f"help of {command.name}": command.examples for command in COMMANDS}
    stores = [
        (store, where) for where, text in texts.items() for store in set(re.findall(r"[\w-]+\.zarr", text))
    ]
    assert len(dict(stores)) == len(stores) > 5, sorted(stores)


def test_readme_shows_what_is_printed(tmp_path, monkeypatch, capsys):
    """But for broken lines, and for numbers that rounding decides: a residual, and those of a chaotic response."""
    blocks = fences(ROOT / "README.md")
    (number,) = [number for number, (kind, _) in enumerate(blocks) if kind == "python"]
    monkeypatch.chdir(tmp_path)
    exec(blocks[number][1], {})
    rounded = r"(?<=≤ )[\de-]+|(?<=exponent )\d\.\d+ ± \d\.\d+|\d+(?= standard)"
    texts = (" ".join(text.split()) for text in (blocks[number + 1][1], capsys.readouterr().out))
    shown, printed = (re.sub(rounded, "#", text) for text in texts)
    assert shown == printed
    assert [path.name for path in tmp_path.iterdir()] == ["earthquake.png"]
