"""Notebook pictures: a room above hangs up how a kind of result is drawn, the results below ask; nobody imports upward."""

from __future__ import annotations

import html as markup
from base64 import b64encode
from collections.abc import Callable
from typing import Any

Draw = Callable[[Any], bytes]

_draws: dict[type | str, Draw] = {}
_fills: list[Callable[[], object]] = []


def register(kind: type | str, draw: Draw) -> None:
    """Let results of this `kind`, their type or the name that they are shown by, be shown by `draw`, which returns the bytes of a PNG."""
    _draws[kind] = draw


def fill_at_first_use(fill: Callable[[], object]) -> None:
    """Remember who hangs the pictures up: `fill` runs once, when the first result is shown."""
    _fills[:] = [fill]


def html(result: object, kind: str | None = None, line: str | None = None) -> str | None:
    """A result's picture over its one line, for `_repr_html_`; None where no picture hangs, then the line is shown.

    Results of a type that is not ours have a `kind` and a `line` of their own.
    """
    while _fills:
        _fills.pop()()
    draw = _draws.get(kind or type(result))
    if draw is None:
        return None
    picture = b64encode(draw(result)).decode()
    line = markup.escape(line or str(result))
    return f'<figure><img alt="{line}" src="data:image/png;base64,{picture}"><figcaption>{line}</figcaption></figure>'


class NotebookPicture:
    """Result that a notebook shows as a picture."""

    __slots__ = ()

    def _repr_html_(self) -> str | None:
        return html(self)
