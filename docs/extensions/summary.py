"""Summary tables of the reference: ``.. summary::`` lists the entries of its page with the first line of each docstring.

The tables are those of ``sphinx.ext.autosummary``. The names are read from the page, so that each stands there once.
"""

import inspect

from docutils import nodes
from docutils.statemachine import StringList
from entries import sections
from sphinx.ext.autosummary import Autosummary, import_by_name


class Summary(Autosummary):
    """Tables of the page's entries, one table for each section."""

    has_content = False

    def run(self):
        made = []
        for title, names in sections(self.env.doc2path(self.env.docname)):
            self.options = {"nosignatures": None}
            self.content = StringList([f"~{name}" for name in names], source="summary")
            made += [nodes.rubric("", title, classes=["summary-title"]), *super().run()]
        return made

    def get_items(self, names):
        """Return the rows of a table with whole first lines: autosummary would end them at the point of "Eq. (1)"."""
        self.env.ref_context.pop("py:module", None)  # autosummary warns of full names within a module
        rows = [
            (shown, signature, inspect.getdoc(import_by_name(name)[1]).partition("\n")[0], name)
            for shown, signature, _, name in super().get_items(names)
        ]
        self.env.ref_context["py:module"] = (
            names[0].lstrip("~").rpartition(".")[0]
        )  # for links in the first lines
        return rows


def setup(app):
    app.setup_extension("sphinx.ext.autosummary")
    app.add_directive("summary", Summary)
