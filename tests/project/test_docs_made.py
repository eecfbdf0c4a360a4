"""Build of the pages: blocks run as for a reader, and the result is searched for dead links and for other hosts."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from docs.extensions.checked import faults
from docs.extensions.command_options import options
from docs.extensions.drawn import draw, results
from docs.extensions.entries import listed, sections_of
from docs.extensions.stated import unbound

ROOT = Path(__file__).parents[2]
BUILT = ROOT / "build" / "docs"
RUN_PAGE = ROOT / "docs" / "extensions" / "run_page.py"


def run_page(blocks, folder):
    return subprocess.run(
        [sys.executable, RUN_PAGE],
        cwd=folder,
        input=json.dumps(blocks),
        capture_output=True,
        text=True,
        check=False,
    )


def test_blocks_build_on_each_other_and_show_what_they_print_and_draw(tmp_path):
    blocks = [
        ["python", "import rocking as rk\nax = rk.plot.schematic()\nprint('drawn')"],
        ["python", "rk.plot.save(ax, 'block.png')"],
        ["sh", "rocking --version"],
        ["python", "rk.plot.save(ax, 'block.png')\nrk.plot.save(ax, 'again.png')"],
    ]
    done = run_page(blocks, tmp_path)
    printed, pictures = zip(*json.loads(done.stdout), strict=True)
    assert printed[0] == "drawn\n"
    assert printed[2].startswith("rocking ")
    assert list(pictures) == [[], ["block.png"], [], ["block.png", "again.png"]]


@pytest.mark.parametrize("block", [["python", "1 / 0"], ["sh", "rocking simulate --amplitude x"]])
def test_a_block_that_fails_fails_the_page(block, tmp_path):
    done = run_page([block], tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    assert "ZeroDivisionError" in done.stderr or "--amplitude" in done.stderr


def test_sound_pages_have_no_faults(tmp_path):
    (tmp_path / "a.html").write_text(
        '<h1 id="top">A</h1><a href="b.html#here">b</a><a href="#top">up</a><img src="data:image/png;base64,AA==">'
        '<a href="https://example.org">elsewhere, if the reader wants</a><link rel="stylesheet" href="a.css">'
    )
    (tmp_path / "b.html").write_text('<p id="here">B</p><a href="a.html">a</a>')
    (tmp_path / "a.css").write_text("p { background: url(data:image/png;base64,AA==) }")
    assert list(faults(tmp_path)) == []


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('<a href="none.html">', "a.html points at none.html, which is not there"),
        ('<img src="none.png">', "a.html points at none.png, which is not there"),
        ('<a href="#none">', "a.html points at #none, and there is no such place on that page"),
        (
            '<a href="https://doi.org/doi:10.1061/x">',
            "a.html points at https://doi.org/doi:10.1061/x, which is no address",
        ),
        ('<a href="http://example">', "a.html points at http://example, which is no address"),
        (
            '<script src="https://example.org/x.js"></script>',
            "a.html asks another host for https://example.org/x.js",
        ),
        (
            '<link rel="stylesheet" href="//example.org/x.css">',
            "a.html asks another host for //example.org/x.css",
        ),
        (
            "<style>@import 'https://example.org/f';</style>",
            "a.html asks another host for https://example.org/f",
        ),
    ],
)
def test_each_fault_is_said(tmp_path, text, fault):
    (tmp_path / "a.html").write_text(text)
    assert list(faults(tmp_path)) == [fault]


@pytest.mark.skipif(not (BUILT / "index.html").exists(), reason="`make docs` has not built the pages")
def test_the_built_pages_have_no_faults():
    assert list(faults(BUILT)) == []


def test_a_font_of_another_host_is_seen_in_a_style(tmp_path):
    (tmp_path / "a.css").write_text('@font-face { src: url("https://example.org/font.woff2") }')
    assert list(faults(tmp_path)) == ["a.css asks another host for https://example.org/font.woff2"]


def serve(requests):
    done = subprocess.run(
        [sys.executable, RUN_PAGE, "--serve"],
        input="".join(f"{json.dumps(request)}\n" for request in requests),
        capture_output=True,
        text=True,
        check=True,
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_served_pages_have_their_own_names_folders_and_errors(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    drawn = "import rocking as rk\nrk.plot.save(rk.plot.schematic(), 'block.png')\nprint(rk.__name__)"
    (first, _), (second, errors), (third, _) = serve(
        [
            [str(tmp_path / "a"), [["python", drawn]]],
            [str(tmp_path / "b"), [["python", "rk"]]],
            [str(tmp_path / "b"), [["python", "print(1)"], ["python", "print(2)"]]],
        ]
    )
    assert first == [["rocking\n", ["block.png"]]]
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["block.png"]
    assert second is None
    assert "NameError" in errors
    assert third == [["1\n", []], ["2\n", []]]


@pytest.mark.parametrize(
    ("text", "known", "missing"),
    [
        ("It repeats after 2.35 s.", [2.3512], []),
        ("It repeats after 2.36 s.", [2.3512], ["2.36"]),
        ("59 % of 2,000 runs", [0.5912, 2000.0], []),
        ("59 % of 2,000 runs", [0.5812, 2001.0], ["59", "2,000"]),
        ("in 2 of 12 cycles, see Eq. (15) of Yim & Lin (1991)", [], []),
        ("intervals of 95 %, of x86-64, 10⁻¹³ and 2 · 10⁵", [], []),
        ("at 12.5", [125.0], ["12.5"]),
    ],
)
def test_a_number_in_the_text_is_one_of_a_block_rounded(text, known, missing):
    assert list(unbound(text, known)) == missing


def test_an_option_is_described_with_its_default():
    described = {one.typed: one for one in options("simulate")}
    assert described["--cycles"].text.endswith(" Default: 200.")
    assert described["--phase"].text.endswith(" Default: 0.")
    assert "Default" not in described["--json"].text
    assert described["--cycles"].signature == "--cycles NUMBER"
    assert next(one for one in options("map") if one.typed == "--period").signature == "--period NUMBER"
    assert options("paper")[0].typed == "FIGURE"


def test_the_picture_of_an_example_shows_the_last_result_of_its_calls(tmp_path):
    assert [type(each).__name__ for each in results("rocking.classify")] == ["Verdict"]
    assert [type(each).__name__ for each in results("rocking.repeatability")][-1] == "Repeatability"
    draw("rocking.classify", tmp_path / "verdict.png")
    draw("rocking.theory.free_quarter_period", tmp_path / "none.png")
    assert [path.name for path in tmp_path.iterdir()] == ["verdict.png"]


REFERENCE = """\
# Title

## Nothing

```python
# no heading
```

## Two

An introduction.

```{names} rocking
System
rocking.model.orbit.Mode
```

```{names} rocking.plot
save
```

A figure:

```python
# the code
```

```{names} rocking
Block
```

## After
"""


def test_the_text_after_a_list_of_names_is_about_the_last_name():
    (section,) = sections_of(REFERENCE)
    assert section.title == "Two"
    assert section.entries == [
        ("rocking.System", ""),
        ("rocking.model.orbit.Mode", ""),
        ("rocking.plot.save", "A figure:\n\n```python\n# the code\n```"),
        ("rocking.Block", ""),
    ]


def test_a_page_of_the_reference_has_one_table_for_each_section_and_keeps_the_other_text():
    before, _, _ = REFERENCE.partition("```{names}")
    names = "   rocking.System\n   rocking.model.orbit.Mode\n   rocking.plot.save\n   rocking.Block"
    assert listed(REFERENCE) == f"{before}```{{eval-rst}}\n.. names::\n\n{names}\n```\n\n## After\n"
    assert listed("# No names\n") == "# No names\n"
