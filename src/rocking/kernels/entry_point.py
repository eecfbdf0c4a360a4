"""Entry points: kernels that Python calls. Each has one set of types, and a function in the library."""

import ctypes
from collections.abc import Callable
from functools import cached_property, reduce
from operator import getitem
from typing import Any, get_args, get_type_hints

from rocking.kernels.deferred import UNBOUND, bind_compiled
from rocking.kernels.library.load import function_of
from rocking.kernels.signature import Signature, place_of_union

ENTRY_POINTS: dict[str, "EntryPoint"] = {}
"""All entry points of the modules that were imported, by name."""


class EntryPoint:
    """A kernel that Python calls. Its function in the library is looked up at the first call."""

    def __init__(
        self,
        function: Callable[..., Any],
        options: dict[str, Any],
        chosen: int | None = None,
        kind: type | None = None,
    ) -> None:
        self.function, self.chosen, self.kind = function, chosen, kind
        self.options = {name: value for name, value in options.items() if name != "long"}
        self.runs_long = bool(options.get("long"))
        self.name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        if kind is not None:
            self.name += f".{kind.__name__}"
        self.__doc__ = function.__doc__
        self._run: Callable[[int], None] | None = None
        if self.name in ENTRY_POINTS:
            raise ValueError(f"two entry points have the name {self.name}")
        ENTRY_POINTS[self.name] = self
        UNBOUND.add(function.__module__)

    @cached_property
    def signature(self) -> Signature:
        """Types of its arguments and of its result."""
        return Signature(self.function, self.chosen)

    @cached_property
    def symbol(self) -> str:
        """Name of its function in the library. Code for words of another meaning has another name, so it is never called."""
        return f"rocking_{self.name.replace('.', '_')}_{self.signature.digest}"

    def lower(self) -> Any:
        """Return its code before optimisation, by the compiler."""
        from rocking.kernels.library.compiler import compile_entry

        bind_compiled()
        return compile_entry(self.name, self.function, self.signature, self.options)

    def load(self) -> Callable[[int], None]:
        """Return the compiled function, from the library."""
        if self._run is None:
            self._run = function_of(self.symbol)
        return self._run

    def __call__(self, *arguments: Any) -> Any:
        """Run the compiled function."""
        block = self.signature.pack(arguments)
        (self._run or self.load())(ctypes.addressof(ctypes.c_char.from_buffer(block)))
        return self.signature.unpack(block)


class Choice:
    """Entry points of one function whose annotations have a union, one for each member; the arguments choose."""

    def __init__(
        self, function: Callable[..., Any], options: dict[str, Any], place: tuple[int, ...], union: Any
    ) -> None:
        self.__doc__ = function.__doc__
        self._place = place
        self._rows = {
            kind: EntryPoint(function, options, chosen, kind) for chosen, kind in enumerate(get_args(union))
        }

    def __call__(self, *arguments: Any) -> Any:
        """Run the compiled function for the type of the arguments."""
        return self._rows[type(reduce(getitem, self._place, arguments))](*arguments)

    def __getitem__(self, kind: type) -> EntryPoint:
        """Return the entry point for one type."""
        return self._rows[kind]


def entry_point(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Mark a function as an entry point. All its arguments and its result must be annotated.

    Unions among the annotations, such as that of the parameters of all forcings, make one entry point for each member. The
    first union must be that of an argument, and tells by its type which is called.
    """

    def mark(function: Callable[..., Any]) -> Any:
        hints = get_type_hints(function, include_extras=True)
        found = place_of_union(list(hints.values()))
        return Choice(function, options, *found) if found else EntryPoint(function, options)

    return mark
