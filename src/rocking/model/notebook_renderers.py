"""Registry of functions that draw a result in a notebook, filled by `plot`, because `model` may not import it."""

from __future__ import annotations

import html as markup
from base64 import b64encode
from collections.abc import Callable
from typing import Any

Draw = Callable[[Any], bytes]

_draws: dict[type | str, Draw] = {}
_fills: list[Callable[[], object]] = []


def register(kind: type | str, draw: Draw) -> None:
    """Register the function that draws results of this kind as PNG.

    Parameters
    ----------
    kind : type or str
        Type of the results, or the name passed to `html` as `kind`.
    draw : callable
        Function of a result that returns the bytes of a PNG file.
    """
    _draws[kind] = draw


def fill_at_first_use(fill: Callable[[], object]) -> None:
    """Set the function that registers all renderers; it runs once, when the first result is shown."""
    _fills[:] = [fill]


def html(result: object, kind: str | None = None, line: str | None = None) -> str | None:
    """Return the figure of a result above its one-line text, for `_repr_html_`.

    Parameters
    ----------
    result : object
        Result to show.
    kind, line : str, optional
        Registered name and text of a result whose type is defined elsewhere, such as an `xarray.Dataset`.
        Default: the type and the string of `result`.

    Returns
    -------
    str or None
        HTML; None if no renderer is registered, so that the notebook prints the text.
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
    """Base class of results that a notebook shows as a figure."""

    __slots__ = ()

    def _repr_html_(self) -> str | None:
        return html(self)
