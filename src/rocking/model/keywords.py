"""Messages for keywords that a public function or class does not have, with the most similar one that it has."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Iterable, MutableMapping
from functools import wraps
from typing import Any, TypeVar, cast

from rocking.model.short_texts import shown

Call = TypeVar("Call", bound=Callable[..., Any])
MAX_LISTED = 180


def similar(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most similar to an unknown one: the shortest that begins with it, or a near one, or None.

    Examples
    --------
    >>> similar("restituion", ["forcing", "restitution"]), similar("h", ["height", "width"]), similar("t_end", ["cycles"])
    ('restitution', 'height', None)
    """
    known = sorted(known, key=len)
    begun = [each for each in known if each.startswith(name)]
    return next(iter(begun + difflib.get_close_matches(name, known, 1, cutoff=0.8)), None)


def explain(namespace: MutableMapping[str, Any], names: Iterable[str]) -> None:
    """Let the public functions and classes in a namespace explain a keyword that they do not have.

    A function is replaced in this namespace, and pickled by its name there. A class gets another constructor. Signatures and
    docstrings stay the same.
    """
    for name in names:
        value = namespace[name]
        if inspect.isfunction(value):
            namespace[name] = explained(value)
            namespace[name].__module__ = namespace["__name__"]
        elif inspect.isclass(value) and "__init__" in vars(value):
            value.__init__ = explained(value.__init__)  # type: ignore[method-assign]


def explained(function: Call) -> Call:
    """Return the function with a message for an unknown keyword that names the function and the nearest keyword."""
    if hasattr(function, "__wrapped__"):
        return function

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            known = inspect.signature(function).parameters
            wrong = [key for key in kwargs if key not in known]
            if error.__traceback__.tb_next is not None or not wrong:  # type: ignore[union-attr]
                raise  # the call itself was right
            name = function.__qualname__.removesuffix(".__init__").rpartition(".")[-1]
            raise TypeError(_unknown(name, wrong[0], [key for key in known if key != "self"])) from None

    return cast(Call, call)


def _unknown(name: str, wrong: str, known: list[str]) -> str:
    """Return the message for an unknown keyword of a function."""
    near, all_of_them = similar(wrong, known), ", ".join(known)
    if len(all_of_them) > MAX_LISTED:
        all_of_them = all_of_them[:MAX_LISTED].rpartition(", ")[0] + ", …"
    way = f"did you mean {near!r}?" if near else f"it has: {all_of_them}" if known else "it has none"
    return f"{name}() has no argument {shown(wrong)} ({way})"
