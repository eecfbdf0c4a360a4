"""The page: assessments of one or several blocks as one HTML file without external addresses, which prints on A4."""

from __future__ import annotations

import os
import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path

from rocking.assessment.assess import Assessment
from rocking.assessment.drawing import block_to_scale, svg_of
from rocking.assessment.sentences import answers_of, methods, of_the_block
from rocking.assessment.shown import (
    LONG,
    Shown,
    band_table,
    block_table,
    fragility_table,
    rate_table,
    record_files,
    record_table,
    rule_table,
    sensitivity_table,
    symbol_of,
)
from rocking.model.files import check_writable, replacing
from rocking.model.package import VERSION
from rocking.model.validation import Refusal, members

BAD = ("overturns", "undecided", "slides", "no verdict")
"""Beginnings of cells that tell of harm or doubt, which are marked."""


def write_page(
    path: str | os.PathLike[str],
    assessments: Iterable[Assessment],
    *,
    title: str = "Rocking assessment",
    by: str = "",
    notes: Sequence[str] = (),
) -> Path:
    """Write assessments of blocks under the same records as one page, and return its path.

    Parameters
    ----------
    path : path-like
        Path of the page, which ends in .html.
    assessments : iterable of Assessment
        One assessment per block.
    title, by : str
        Heading, and the line below it, such as author and date.
    notes : sequence of str
        Sentences that the page states besides those of the assessments.

    Raises
    ------
    TypeError, ValueError, OSError
        If there is no assessment, or if the page cannot be written.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> result = rk.assess(rk.synthetic_ground_motions(3, seed=1), rk.Block(2.0, 0.5), [0.2, 0.4])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_page(f"{folder}/cabinet.html", [result]).name
    'cabinet.html'
    """
    parts = members("assessments", assessments, "hold assessments, one at least")
    if not parts:
        raise Refusal("assessments", "hold assessments, one at least", parts)
    path = check_writable("path", path, (".html",))
    text = page(list(parts), title, by, notes)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


def page(assessments: Sequence[Assessment], title: str, by: str, notes: Sequence[str] = ()) -> str:
    """Return the page as text."""
    first = assessments[0]
    body = [f"<h1>{escape(title)}</h1>"]
    if by:
        body.append(f'<p class="by">{escape(by)}</p>')
    body.append(answers(assessments))
    limits = dict.fromkeys([*notes, *(note for each in assessments for note in each.notes)])
    if limits:
        items = "".join(f"<li>{escape(limit)}</li>" for limit in limits)
        body.append(f'<div class="limits"><p>Limits of these results:</p><ul>{items}</ul></div>')
    for number, each in enumerate(assessments, 1):
        body += of_block(each, name_of(each, number, len(assessments)))
    body += ["<h2>Records</h2>", table(record_files(first))]
    body += ["<h2>Methods</h2>", '<div class="methods">', *map(paragraph, methods(first))]
    for number, each in enumerate(assessments, 1):
        body.append(paragraph(of_the_block(each, name_of(each, number, len(assessments)))))
    body.append("</div>")
    template = files("rocking.assessment").joinpath("page.html").read_text(encoding="utf-8")
    foot = re.sub(r'[\\"<>\n]', " ", " · ".join(filter(None, (title, by, f"rocking {VERSION}"))))
    values = {"version": VERSION, "title": escape(title), "foot": foot, "body": "\n".join(body)}
    return re.sub(r"{{ (\w+) }}", lambda found: values[found[1]], template)


def name_of(each: Assessment, number: int, count: int) -> str:
    """Return the name of a block on the page."""
    return each.name or ("Block" if count == 1 else f"Block {number}")


def table(shown: Shown) -> str:
    """Return a table as HTML; the first columns hold words, the others numbers."""

    def cell(tag: str, place: int, text: str) -> str:
        kinds = ["text"] * (place < shown.words) + ["bad"] * (
            shown.marks and tag == "td" and text.startswith(BAD)
        )
        kind = f' class="{" ".join(kinds)}"' if kinds else ""
        return f"<{tag}{kind}>{breakable(text) if place < shown.words else escape(text)}</{tag}>"

    def row(tag: str, cells: Sequence[str]) -> str:
        return f"<tr>{''.join(cell(tag, place, text) for place, text in enumerate(cells))}</tr>"

    caption = f'<p class="caption">{escape(shown.caption)}</p>\n' if shown.caption else ""
    rows = "\n".join(row("td", cells) for cells in shown.rows)
    head = f"<thead>{row('th', shown.heads)}</thead>" if shown.heads else ""
    kind = "table" if len(shown.rows) > LONG else "table short"
    body = f"<table>{head}\n<tbody>\n{rows}\n</tbody></table>"
    return f'<div class="{kind}">{caption}<div class="scroll">{body}</div></div>'


def breakable(text: str) -> str:
    """Return a text as HTML that may be broken after the marks that join the parts of a long name, and not within an interval.

    Examples
    --------
    >>> breakable("RSN1_A-B.csv"), breakable("up & down"), breakable("0.5–0.7")
    ('RSN1_<wbr>A-<wbr>B.csv', 'up &amp; down', '0.5–&NoBreak;0.7')
    """
    return re.sub(r"–(?=\d)", "–&NoBreak;", re.sub(r"([-_/])(?=\w)", r"\1<wbr>", escape(text)))


def figure(svg: str, caption: str, width: float | None = None) -> str:
    """Return a figure as HTML; with a width in mm it has this width on paper, and others the width of a column."""
    data = f"data:image/svg+xml;base64,{b64encode(svg.encode()).decode()}"
    size, kind = ("", ' class="column"') if width is None else (f' style="width: {width:.1f}mm"', "")
    text = escape(caption)
    return f'<figure{kind}><img alt="{text}" src="{data}"{size}><figcaption>{text}</figcaption></figure>'


def paragraph(text: str) -> str:
    """Return a text as a paragraph."""
    return f"<p>{escape(text)}</p>"


def answers(assessments: Sequence[Assessment]) -> str:
    """Return the first part of the page: what a client asks, as a list for each block."""
    parts = []
    for place, each in enumerate(assessments, 1):
        if len(assessments) > 1:
            parts.append(f'<p class="who">{escape(name_of(each, place, len(assessments)))}</p>')
        parts.append(f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in answers_of(each))}</ul>")
    return f'<div class="answers">{"".join(parts)}</div>'


def of_block(each: Assessment, name: str) -> list[str]:
    """Return the part of the page on one block."""
    from rocking import plot

    drawing = block_to_scale(each.block)
    picture = figure(drawing.svg, drawing.text, drawing.width)
    parts = [
        f"<h2>{escape(name)}</h2>",
        f'<div class="beside">{picture}{table(block_table(each.block))}</div>',
        f"<h3>Each record {escape(each.level_text)}</h3>",
        table(record_table(each)),
        "<h3>Fragility</h3>",
        '<div class="beside">',
        figure(
            svg_of(lambda: plot.fragility(each.fragility)),
            f"Fragility over {symbol_of(each)}, with 95 % intervals. Line: the fraction that rocks times a lognormal function.",
        ),
        table(fragility_table(each)),
        "</div>",
        "<h3>Levels that overturn the block</h3>",
        '<div class="beside">',
        figure(
            svg_of(lambda: plot.overturning_set(each.overturning_set)),
            f"Levels of {symbol_of(each)} at which each record overturns the block; at all other levels that were computed it stands.",
        ),
        table(band_table(each)),
        "</div>",
        "<h3>Sensitivity</h3>",
    ]
    parts.append(
        table(sensitivity_table(each)) if each.sensitivity else paragraph("Not computed: see the limits.")
    )
    if each.rate is not None:
        parts += [
            "<h3>Annual rate</h3>",
            table(rate_table(each, each.rate)),
        ]
    parts.append("<h3>Rules for comparison</h3>")
    return (
        [*parts, table(rule_table(each)), paragraph(RULES)]
        if each.block.left is None
        else [*parts, paragraph(NO_RULES)]
    )


NO_RULES = "The design rules take free-standing, symmetric blocks only."

RULES = (
    "FEMA 356 and Priestley replace the block by a linear oscillator; their error is not bounded. “no result”: the loop does not "
    "converge. Ishiyama's rule compares PGA and PGV with the levels above; its velocity is a fractile of records, not a bound. No rule "
    "replaces the computed motion."
)
