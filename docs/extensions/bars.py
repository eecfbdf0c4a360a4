"""|Θ| is a size here: bars in a docstring name no substitution."""

from docutils import nodes
from sphinx.transforms import SphinxTransform


class Bars(SphinxTransform):
    """Puts back the bars that were read as a reference, before it is looked for."""

    default_priority = 205

    def apply(self, **options):
        for reference in list(self.document.findall(nodes.substitution_reference)):
            reference.replace_self(nodes.Text(f"|{reference.astext()}|"))


def setup(app):
    app.add_transform(Bars)
