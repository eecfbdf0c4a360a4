"""Declaration of a page: its title, its template with style and script, and the session behind it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property
from importlib.resources import files
from typing import Any

from attrs import define, field
from bokeh.document import Document

from rocking.explorer.jobs import Workers
from rocking.explorer.session import Session
from rocking.plot import palette

COLOURS = {
    "motion-light": palette.MOTION,
    "motion-dark": palette.DARK_MOTION,
    "block": palette.BLOCK,
    "edge": palette.INK,
}
"""Colours of the pages that figures have, too, by their names in the style."""


def text_of(name: str) -> str:
    """Return the text of a file of this room."""
    return files("rocking.explorer").joinpath(name).read_text(encoding="utf-8")


@define(eq=False, slots=False)
class Page:
    """Page of the explorer.

    Attributes
    ----------
    name : str
        Name of its template, after the common one, and of its script.
    title : str
        Title of the document.
    session : type
        Session, which declares fields, figures and jobs.
    styles : tuple of str
        Files of its style.
    constants : dict
        Constants of its script.
    variables : dict
        Variables of its template.
    """

    name: str
    title: str
    session: type[Session]
    styles: tuple[str, ...] = ("common.css",)
    constants: Mapping[str, Any] = field(factory=dict)
    variables: Mapping[str, Any] = field(factory=dict)

    @cached_property
    def template(self) -> str:
        """Template of the document."""
        return text_of("common.html") + text_of(f"{self.name}.html")

    @cached_property
    def content(self) -> dict[str, Any]:
        """Variables of the template, equal for all sessions."""
        rules = " ".join(f"--{name}: {colour};" for name, colour in COLOURS.items())
        return {
            "style": f":root {{ {rules} }}\n{''.join(map(text_of, self.styles))}",
            "script": text_of("common.js") + text_of(f"{self.name}.js"),
            "constants": json.dumps(self.constants, ensure_ascii=False).replace("<", "\\u003c"),
            **self.variables,
        }

    def open(self, document: Document, workers: Workers) -> None:
        """Open the page in a new document."""
        document.title = self.title
        document.template = self.template  # type: ignore[assignment]  # the type hint lacks the text that the setter accepts
        document.template_variables.update(self.content)
        self.session(document, workers)
