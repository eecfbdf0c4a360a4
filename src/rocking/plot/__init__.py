"""Plot functions: each takes a result and an Axes, and returns the Axes.

Units, labels, colours and sizes are set in this package only. The user's matplotlib settings stay unchanged.

A function is imported on first use. The names stand in `__init__.pyi`.

Without an Axes, a function makes a figure, which a notebook shows. In a script that has imported `matplotlib.pyplot`, the figure
belongs to pyplot: `plt.show` shows it, and it stays open until `plt.close`.

A function with the argument `block` takes that of the result, if it has one: the figure is in SI units. ``block=None`` gives a
normalised figure.
"""

from contextlib import suppress
from functools import wraps
from inspect import isfunction, signature
from typing import Any

from rocking.model.public_names import lazy

_get, __dir__, __all__ = lazy(__name__)


def __getattr__(name: str) -> Any:
    value = _get(name)
    if isfunction(value) and "block" in signature(value).parameters:
        value = globals()[name] = _in_units_of_the_result(value)
    return value


def _in_units_of_the_result(draw: Any) -> Any:
    """Return a plot function whose default for `block` is that of the result."""
    parameters = signature(draw)

    @wraps(draw)
    def drawn(*args: Any, **kwargs: Any) -> Any:
        with suppress(TypeError):  # the function itself refuses wrong arguments
            bound = parameters.bind(*args, **kwargs)
            arguments = bound.arguments
            own = _block(next(iter(arguments.values()), None))
            if "block" not in arguments and own is not None:
                kwargs["block"] = own
            elif own is not None and isinstance(arguments.get("block"), type(own)):
                from rocking.model.block_formulas import with_unit

                arguments["block"] = with_unit(arguments["block"], own.normalised_by)
                args, kwargs = bound.args, bound.kwargs
        return draw(*args, **kwargs)

    return drawn


def _block(result: Any) -> Any:
    """Return the block of a result, or the one of all results of a list; None if there is none."""
    if not isinstance(result, list | tuple):
        return getattr(result, "block", None)
    blocks = [getattr(each, "block", None) for each in result]
    return blocks[0] if blocks and all(each == blocks[0] for each in blocks) else None
