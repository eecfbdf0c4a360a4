"""Execution of every `python` and `sh` block when its page is built: output and pictures follow the block.

The blocks of a page among ``notebooks`` of the configuration are cells of a notebook: they show what a notebook shows.
The directive ``{script}`` shows a script: its docstring, its output, its picture and its source.
The directive ``{figures}`` shows all figures of a paper: the caption, the picture and the source of each.
"""

import ast
import inspect
import json
import re
import shutil
import subprocess
import sys
import textwrap
import time
from functools import cache
from pathlib import Path
from select import select
from subprocess import PIPE

import kernel
from docutils import nodes
from docutils.parsers.rst import Directive
from PIL import Image
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

from rocking.papers.catalogue import PAPERS
from rocking.papers.report.paper import Kind

ROOT = Path(__file__).parents[2]
RUNS = ROOT / "build" / "docs-runs"  # one folder per page, for the files that its blocks write
DOTS_PER_INCH, CSS_PIXELS_PER_INCH = 200, 96
LONG_LINE = 100  # a longer line is a sentence, not a row of a table
TABLE = re.compile(r"\S {3,}\S")  # two columns
PICTURE = """\
import rocking as rk
from {module} import {name}
rk.plot.save({name}(), "{file}")
"""
logger = logging.getLogger(__name__)


class Executed(SphinxTransform):
    """Run the blocks of a page and insert their output and pictures."""

    default_priority = 200

    def apply(self, **options):
        blocks = [node for node in self.document.findall(nodes.literal_block) if language_of(node)]
        if not blocks:
            return
        for source in (ROOT / "src").rglob("*.py"):  # the output depends on the package
            self.env.note_dependency(str(source))
        folder = new_folder(RUNS / self.env.docname)
        if self.env.docname in self.config.notebooks:
            shown = kernel.run(folder, [node.astext() for node in blocks], output, picture)
        else:
            results = run(folder, [(language_of(node), node.astext()) for node in blocks])
            shown = [
                [*map(output, filter(str.strip, [printed])), *(picture(folder / name) for name in pictures)]
                for printed, pictures in results
            ]
        for block, nodes_after in zip(blocks, shown, strict=True):
            after = block.parent.index(block) + 1
            block.parent[after:after] = nodes_after
            if block.get("from-script"):
                block.parent.remove(block)


def language_of(node):
    """Return `python` or `sh` if a block is to be run, otherwise None; the source of a script is not run."""
    language = node.get("language")
    return language if language in ("python", "sh") and "shown" not in node else None


def new_folder(path):
    """Make an empty folder."""
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path


@cache
def server():
    """Start the process that runs the pages."""
    command = [sys.executable, Path(__file__).with_name("run_page.py"), "--serve"]
    return subprocess.Popen(command, stdin=PIPE, stdout=PIPE, text=True)


def stop(app, failure):
    """End the process that runs the pages."""
    if server.cache_info().currsize:
        with server() as process:
            process.stdin.close()
        server.cache_clear()


def run(folder, blocks):
    """Return the output of each block and the names of the pictures that it wrote into the folder."""
    process, began = server(), time.monotonic()
    print(json.dumps([str(folder), blocks]), file=process.stdin, flush=True)
    while not select([process.stdout], [], [], 3)[0]:
        seconds = time.monotonic() - began
        logger.info("running the %d blocks of %s: %.0f s", len(blocks), folder.name, seconds)
    results, errors = json.loads(process.stdout.readline())
    if results is None:  # the other pages are built nevertheless
        logger.warning("a block of the page %s fails:\n%s", folder.name, errors)
        return [["", []]] * len(blocks)
    return results


def output(printed):
    """Return the node of an output, with a style that distinguishes it from code."""
    lines = printed.rstrip().splitlines()
    if any(TABLE.search(line) for line in lines):
        # Rows of a table must not wrap on a narrow page, so long sentences among them are wrapped here.
        lines, classes = (
            [
                line if TABLE.search(line) or len(line) <= LONG_LINE else textwrap.fill(line, LONG_LINE)
                for line in lines
            ],
            [],
        )
    else:
        classes = ["sentences"] if max(map(len, lines)) > LONG_LINE else []
    text = "\n".join(lines)
    return nodes.literal_block(text, text, language="none", classes=["printed", *classes])


def picture(path):
    """Return the node of a picture, at its size on paper."""
    with Image.open(path) as image:
        dots, _ = image.info.get("dpi", (DOTS_PER_INCH, DOTS_PER_INCH))
        width = round(image.width * CSS_PIXELS_PER_INCH / dots)
    return nodes.image(
        uri=f"/../{path.relative_to(ROOT).as_posix()}", width=f"{width}px", alt=path.stem.replace("-", " ")
    )


class Described(Directive):
    """Sections with a description, an output, pictures and a source."""

    required_arguments = 1

    def section(self, name, description, code, file, source):
        """Return the section of a piece of code that is run, with its source."""
        first, _, rest = inspect.cleandoc(description).partition("\n\n")
        section = nodes.section(ids=[nodes.make_id(name)], names=[name])
        section += nodes.title("", " ".join(first.split()).rstrip("."))
        self.state.nested_parse(rest.splitlines(), self.content_offset, section)
        section += nodes.literal_block(code, code, **{"language": "python", "from-script": True})
        section += nodes.raw("", f"<details><summary>{file}</summary>", format="html")
        section += nodes.literal_block(source, source, language="python", shown=True)
        section += nodes.raw("", "</details>", format="html")
        return section


class Script(Described):
    """Section with the docstring of a script, its output, its pictures and its source."""

    def run(self):
        path = ROOT / self.arguments[0]
        self.state.document.settings.env.note_dependency(str(path))
        source = path.read_text(encoding="utf-8")
        return [self.section(path.stem, ast.get_docstring(ast.parse(source)), source, path.name, source)]


class Figures(Described):
    """Sections with caption, picture and source of all figures of a paper."""

    def run(self):
        return [
            self.section(
                part.stem,
                part.compute.__doc__,
                PICTURE.format(
                    module=part.compute.__module__, name=part.compute.__name__, file=f"{part.stem}.png"
                ),
                f"{part.compute.__module__}.{part.compute.__name__}",
                inspect.getsource(part.compute),
            )
            for part in figures_of(self.arguments[0])
        ]


def figures_of(paper):
    """Return the figures of a paper, by the name of its report."""
    return PAPERS[paper].of(Kind.FIGURE)


def setup(app):
    app.add_config_value("notebooks", [], "env")
    app.connect("build-finished", stop)
    app.add_transform(Executed)
    app.add_directive("script", Script)
    app.add_directive("figures", Figures)
