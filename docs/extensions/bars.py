"""Vertical bars in docstrings: |Θ| is an absolute value, not a substitution of reStructuredText."""

from docutils import nodes
from sphinx.transforms import SphinxTransform


class Bars(SphinxTransform):
    """Restore bars that were parsed as a reference, before Sphinx resolves the reference."""

    default_priority = 205

    def apply(self, **options):
        for reference in list(self.document.findall(nodes.substitution_reference)):
            reference.replace_self(nodes.Text(f"|{reference.astext()}|"))


def setup(app):
    app.add_transform(Bars)
