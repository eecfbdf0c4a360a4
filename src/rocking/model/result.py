"""What all results share: read-only arrays, attributes of their datasets, and pictures in notebooks."""

from __future__ import annotations

import html as markup
from base64 import b64encode
from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any, ClassVar

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


def html(draw: Callable[[], Any], line: str) -> str:
    """Return a figure above a line of text, for `_repr_html_`; `draw` makes the figure."""
    png: bytes = import_module("rocking.plot.figures").picture(draw)
    line = markup.escape(line)
    picture = b64encode(png).decode()
    return f'<figure><img alt="{line}" src="data:image/png;base64,{picture}"><figcaption>{line}</figcaption></figure>'


class Result:
    """Base class of results: a figure, which a notebook shows above the text of the result."""

    __slots__ = ()

    PLOT: ClassVar[str]
    """Name of the function of `rocking.plot` that draws results of the class."""

    def plot(self, *arguments: Any, **options: Any) -> Any:
        """Draw the result by its function of `rocking.plot`, with its further arguments; return what this returns.

        Examples
        --------
        >>> import rocking as rk
        >>> motion = rk.simulate(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), cycles=3)
        >>> len(motion.plot().axes)
        2
        """
        return getattr(import_module("rocking.plot"), self.PLOT)(self, *arguments, **options)

    def _figure(self) -> Any:
        """Return the figure, or its axes, that a notebook shows."""
        return self.plot()

    def _repr_html_(self) -> str | None:
        return html(self._figure, str(self))
