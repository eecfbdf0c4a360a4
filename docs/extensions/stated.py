"""Check of the numbers in the text of pages: each is among those that the blocks of the page state or print, rounded as in the text.

Small integers, years and numbers of equations are not checked, nor are pages without blocks and the pages of names, whose text is that
of docstrings. A number that no block computes needs a source or a reason, in a comment of the page::

    % not computed: 4.669 (Feigenbaum 1978)
"""

import re
from pathlib import Path

NOT_COMPUTED = re.compile(r"<!-- not computed: (.*?) -->")
CONFIDENCE = 95.0  # level of all intervals, %
SMALL = 13  # integers below this count things in sight
EQUATIONS = re.compile(r"\b(?:Eqs?\.?|Figs?\.?) \(?\d+[a-z]?\)?(?:(?:–|, | and )\(?\d+[a-z]?\)?)*")
IN_TEXT = re.compile(r"(?<![\w.,/·^×-])\d+(?:,\d{3})*(?:\.\d+)?(?![\w⁻⁰-⁹¹²³]|[.,]\d)")
IN_BLOCKS = re.compile(r"\d+(?:[,_]\d{3})*(?:\.\d+)?(?:[eE][-+]?\d+)?")
NAMES = ("names/", "reference-")


def value(number):
    """Return the value of a number with separators of thousands."""
    return float(re.sub("[,_]", "", number))


def is_checked(number, percent):
    """Return whether a number in the text must be computed."""
    year = re.fullmatch(r"(?:19|20)\d\d", number)
    return (
        not year
        and (percent or "." in number or value(number) >= SMALL)
        and not (percent and value(number) == CONFIDENCE)
    )


def unbound(text, known):
    """Yield the numbers of a text that are not among the known ones, rounded to the digits of the text."""
    for match in IN_TEXT.finditer(EQUATIONS.sub("", text)):
        number, percent = match[0], match.string[match.end() :].lstrip().startswith("%")
        if is_checked(number, percent):
            half = 0.5000001 * 10.0 ** -len(number.partition(".")[2])
            factors = (1.0, 100.0) if percent else (1.0,)
            if not any(abs(each * factor - value(number)) <= half for each in known for factor in factors):
                yield number


def prose(document):
    """Yield the text of each paragraph and title, without code and formulas."""
    from docutils import nodes

    code = (nodes.literal, nodes.math)
    for part in document.findall(
        lambda node: isinstance(node, nodes.paragraph | nodes.title | nodes.caption)
    ):
        yield "".join(
            "`" if isinstance(text.parent, code) else text.astext() for text in part.findall(nodes.Text)
        )


def check(app, document):
    """Report each number of a page that no block computes as a warning, which makes `make docs` fail."""
    from docutils import nodes
    from sphinx.util.logging import getLogger

    page = app.env.docname
    blocks = [node.astext() for node in document.findall(nodes.literal_block)]
    if page.startswith(NAMES) or not blocks:
        return
    reasons = NOT_COMPUTED.findall(Path(app.env.doc2path(page)).read_text(encoding="utf-8"))
    known = [value(number) for text in blocks + reasons for number in IN_BLOCKS.findall(text)]
    for text in prose(document):
        for number in unbound(text, known):
            getLogger(__name__).warning(
                "%s states %s, which no block computes: %s", page, number, " ".join(text.split())[:100]
            )


def setup(app):
    app.connect("doctree-read", check)
