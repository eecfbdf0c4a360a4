"""What all results share: read-only arrays, attributes of their datasets, and pictures in notebooks."""

from __future__ import annotations

import html as markup
from base64 import b64encode
from collections.abc import Callable
from functools import partial
from typing import Any

import attrs
import numpy as np

from rocking.model.package import VERSION
from rocking.model.validation import WrongType


def read_only(array: np.ndarray) -> np.ndarray:
    """Make an array read-only and return it; TypeError for anything else."""
    if not isinstance(array, np.ndarray):
        raise WrongType("an array of a result", "be a NumPy array", array)
    array.flags.writeable = False
    return array


class ReadOnlyArrays:
    """Base class of frozen values whose arrays stay `read_only` in copies and in other processes."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        # A copied or unpickled NumPy array is writeable. Only the constructor makes it read-only again.
        fields = attrs.fields(type(self))  # type: ignore[arg-type]  # every subclass is an attrs class
        return partial(type(self), **{each.alias: getattr(self, each.name) for each in fields}), ()


def named(text: str) -> dict[str, str]:
    """Return the attributes of a normalised variable."""
    return {"long_name": text, "units": "1"}


def described(what: str) -> dict[str, object]:
    """Return the attributes of a dataset; ``what`` is the result, as a noun phrase."""
    return {
        "Conventions": "CF-1.11",
        "title": f"{what} of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "All quantities are normalised as in Yim & Lin (1991), Eqs. (1)-(4).",
    }


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
