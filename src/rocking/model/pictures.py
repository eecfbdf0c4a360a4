"""Notebook pictures: a room above hangs up how a kind of result is drawn, the results below ask; nobody imports upward."""

from __future__ import annotations

import html as markup
from base64 import b64encode
from collections.abc import Callable
from typing import Any

Draw = Callable[[Any], bytes]

_draws: dict[type, Draw] = {}
_fills: list[Callable[[], object]] = []


def hang(kind: type, draw: Draw) -> None:
    """Let results of this `kind` be shown by `draw`, which returns the bytes of a PNG."""
    _draws[kind] = draw


def fill_at_first_use(fill: Callable[[], object]) -> None:
    """Remember who hangs the pictures up: `fill` runs once, when the first result is shown."""
    _fills[:] = [fill]


def html(result: object) -> str | None:
    """A result's picture over its one line, for `_repr_html_`; None where no picture hangs, then the line is shown."""
    while _fills:
        _fills.pop()()
    draw = _draws.get(type(result))
    if draw is None:
        return None
    picture = b64encode(draw(result)).decode()
    line = markup.escape(str(result))
    return f'<figure><img alt="{line}" src="data:image/png;base64,{picture}"><figcaption>{line}</figcaption></figure>'
