"""Grids of thumbnails: ``{thumbnails} PAGE`` shows each picture of another page, small, with a link to its place there.

The pictures are those that the blocks and scripts of the other page wrote when it was built. The picture of a function
``time_history`` of a reference page is called ``time-history.png`` or ``time-history.gif``, and its page writes it. A function that
writes a folder is shown by the largest picture in it.
"""

import ast
import inspect
import re
from pathlib import Path
from typing import NamedTuple

from docutils import nodes
from docutils.parsers.rst import Directive
from entries import sections
from executed import ROOT, RUNS, figures_of
from names import document, found
from PIL import Image
from sphinx.errors import ExtensionError

MADE = ROOT / "build" / "docs-thumbnails"
SIZE = (440, 330)  # pixels, at twice the density of a screen
SUFFIXES = (".png", ".gif")


class Card(NamedTuple):
    """Thumbnail with its title, its text and its target."""

    picture: Path
    title: str
    text: str
    target: str


def cards_of_entries(page):
    """List (title of a section, cards) of a reference page."""
    for section in sections(page):
        cards = []
        for name in section.names:
            short = name.rpartition(".")[2]
            text = inspect.getdoc(found(name)).partition("\n")[0]
            picture = picture_called(RUNS / document(name), short.replace("_", "-"))
            cards.append(Card(picture, short, text.replace("`", ""), f"{document(name)}.html"))
        yield section.title, cards


def cards_of_scripts(page):
    """List the one group of cards of a page of scripts or of figures of a paper, under no title."""
    text = page.read_text(encoding="utf-8")
    descriptions = {
        part.stem: part.compute.__doc__ for name in named("figures", text) for part in figures_of(name)
    }
    for script in named("script", text):
        source = (ROOT / script).read_text(encoding="utf-8")
        descriptions[Path(script).stem] = ast.get_docstring(ast.parse(source))
    cards = []
    for name, description in descriptions.items():
        title = " ".join(inspect.cleandoc(description).partition("\n\n")[0].split()).rstrip(".")
        picture = picture_called(RUNS / page.stem, name.replace("_", "-"))
        cards.append(Card(picture, title, "", f"{page.stem}.html#{nodes.make_id(name)}"))
    return [("", cards)]


def named(directive, text):
    """List the arguments of a directive in a page."""
    return re.findall(rf"^```\{{{directive}\}} (\S+)$", text, re.MULTILINE)


def picture_called(folder, stem):
    """Return the picture of that name, which a block of the page must have written."""
    for suffix in SUFFIXES:
        if (folder / f"{stem}{suffix}").exists():
            return folder / f"{stem}{suffix}"
    inside = sorted((folder / stem).rglob("*.png"), key=lambda path: (path.stat().st_size, path))
    if inside:
        return inside[-1]
    raise ExtensionError(f"no block of the page {folder.name} writes the picture {stem}.png")


def made_small(path):
    """Write a small copy of a picture, of an animation its frame in the middle, and return its path."""
    small = MADE / ("-".join(path.relative_to(RUNS).with_suffix("").parts) + ".png")
    small.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(path) as image:
        image.seek(getattr(image, "n_frames", 1) // 2)
        copy = image.convert("RGB")
    copy.thumbnail(SIZE, Image.Resampling.LANCZOS)
    copy.save(small)
    return small


class Thumbnails(Directive):
    """Grid with a card for each picture of a page."""

    required_arguments = 1

    def run(self):
        environment = self.state.document.settings.env
        (docname,) = self.arguments
        page = Path(environment.doc2path(docname))
        environment.note_dependency(str(page))
        groups = list(cards_of_entries(page)) or cards_of_scripts(page)
        made = []
        for title, cards in groups:
            made += [nodes.rubric("", title)] if title else []
            made.append(nodes.bullet_list("", *map(self.item, cards), classes=["thumbnails"]))
        return made

    def item(self, card):
        """Make one card: picture and title are the link."""
        small = made_small(card.picture).relative_to(ROOT).as_posix()
        link = nodes.reference("", "", internal=True, refuri=card.target)
        link += nodes.image(uri=f"/../{small}", alt="")
        link += nodes.inline("", card.title, classes=["name"] if card.text else [])
        return nodes.list_item("", nodes.paragraph("", "", link, nodes.inline("", card.text)))


def read_last(app, environment, docnames):
    """Read pages of thumbnails after all others, and again whenever a page is read: its pictures may be new."""
    showing = [
        name
        for name in sorted(environment.found_docs)
        if "```{thumbnails}" in Path(environment.doc2path(name)).read_text(encoding="utf-8")
    ]
    if docnames:
        docnames[:] = [*(name for name in docnames if name not in showing), *showing]


def setup(app):
    app.add_directive("thumbnails", Thumbnails)
    app.connect("env-before-read-docs", read_last)
