"""Pages of the public names, made from the reference: each has the signature, the docstring, and a picture with its code.

A page of the reference lists names, see `entries`. Before the pages are read, a page is written for each name into the folder
``docs/names``, which is not part of the repository. In the reference the fence becomes a table of links with the first
line of each docstring. The directive ``{drawn}`` shows what `drawn` draws.
"""

import inspect
import re
from enum import Enum
from importlib import import_module
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from entries import PAGES, listed, sections
from sphinx.ext.autosummary import Autosummary

import rocking

FOLDER = "names"
IMPORTS = {"np": "import numpy as np\n", "rk": "import rocking as rk\n\n"}
EXAMPLE = """\
from drawn import draw
draw({name!r}, {file!r})
"""


def found(name):
    """Return the object of a full name."""
    module, _, short = name.rpartition(".")
    return getattr(import_module(module), short)


def document(name):
    """Return the name of the page of a public name."""
    return f"{FOLDER}/{name}"


def entry(name):
    """Return the directive of autodoc for a public name; classes that only the package makes have no signature."""
    value, made_by_users = found(name), name.removeprefix("rocking.") in rocking.__all__
    if not isinstance(value, type):
        return f".. autofunction:: {name}"
    if issubclass(value, Exception):
        return f".. autoexception:: {name}()\n   :members:"
    if issubclass(value, Enum):
        return f".. autoclass:: {name}()\n   :members:\n   :undoc-members:"
    if made_by_users:
        return f".. autoclass:: {name}\n   :members:\n   :exclude-members: __init__"
    return f".. autoclass:: {name}()\n   :members:"


def page(name, text):
    """Return the page of a public name; the text about it contains a picture, otherwise its example is drawn."""
    module, _, short = name.rpartition(".")
    imports = "".join(line for word, line in IMPORTS.items() if f"{word}." in text)
    picture = text.replace("```python\n", f"```python\n{imports}", 1) or f"```{{drawn}} {name}\n```"
    signature = f"```{{eval-rst}}\n.. currentmodule:: {module}\n\n{entry(name)}\n```"
    return f"# {short}\n\n{signature}\n\n{picture}\n"


def write(app):
    """Write the pages of all names, unless they are there, and remove others."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(exist_ok=True)
    pages = {
        folder / f"{each.name}.md": page(*each)
        for reference in sorted(Path(app.srcdir).glob(PAGES))
        for section in sections(reference)
        for each in section.entries
    }
    for path in set(folder.iterdir()) - set(pages):
        path.unlink()
    for path, text in pages.items():
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def shorten(app, docname, source):
    """Leave only the lists of names in the pages of the reference."""
    source[0] = listed(source[0])


class Names(Autosummary):
    """Table of public names with links to their pages; each row has the full name as its anchor."""

    def run(self):
        names = [line.strip() for line in self.content]
        self.options = {"nosignatures": None, "toctree": FOLDER}
        self.content = StringList([f"~{name}" for name in names], source="names")
        made = super().run()
        rows = [row for part in made for row in part.findall(nodes.row)]
        for row, name in zip(rows, names, strict=True):
            row["ids"].append(name)
        return made

    def get_items(self, names):
        """Return the rows of a table with whole first lines: autosummary would end them at the point of "Eq. (1)"."""
        self.env.ref_context.pop("py:module", None)  # autosummary warns of full names within a module
        rows = [
            (shown, signature, inspect.getdoc(found(name)).partition("\n")[0], name)
            for shown, signature, _, name in super().get_items(names)
        ]
        # for links in the first lines
        self.env.ref_context["py:module"] = names[0].lstrip("~").rpartition(".")[0]
        return rows


class Drawn(Directive):
    """Picture of the result of the example in a docstring; nothing if it has none that can be drawn."""

    required_arguments = 1

    def run(self):
        (name,) = self.arguments
        file = name.rpartition(".")[2].replace("_", "-") + ".png"
        code = EXAMPLE.format(name=name, file=file)
        return [nodes.literal_block(code, code, **{"language": "python", "from-script": True})]


def source_module(app, module, attribute):
    """Return the module whose source defines a public name, for links to the source."""
    value = import_module(module)
    for part in attribute.split("."):
        value = getattr(value, part, None)
    return getattr(inspect.unwrap(value), "__module__", None) if callable(value) else None


def back_to_pages(app, page, template, context, tree):
    """Let sources link back to pages of names, not to places in them: viewcode takes all names of a module to be of one module."""
    if page.startswith("_modules/") and "body" in context:
        context["body"] = re.sub(r'(class="viewcode-back" href="[^"#]*)#[^"]*', r"\1", context["body"])


def setup(app):
    app.setup_extension("sphinx.ext.autosummary")
    app.add_directive("names", Names)
    app.add_directive("drawn", Drawn)
    app.connect("builder-inited", write)
    app.connect("source-read", shorten)
    app.connect("html-page-context", back_to_pages)
    app.connect("viewcode-follow-imported", source_module)
