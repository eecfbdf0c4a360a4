"""Entry points: kernels that Python calls. Each has one set of types, and a function in the library."""

import ctypes
from collections.abc import Callable
from functools import cached_property, reduce
from operator import getitem
from typing import Any, get_type_hints

from rocking.kernels.library.kernel import OPTIONS, Compiled, Kernel
from rocking.kernels.library.load import function_of
from rocking.kernels.library.signature import Chosen, Signature, chosen_of, place_of_union

ENTRY_POINTS: dict[str, "EntryPoint"] = {}
"""All entry points of the modules that were imported, by name."""


class Exported(Compiled):
    """A function that Python calls; other kernels call it as the kernel that it is."""

    kernel: Kernel

    @property
    def compiled(self) -> Any:
        """What the compiler finds under its name."""
        return self.kernel.compiled


class EntryPoint(Exported):
    """A kernel that Python calls. Its function in the library is looked up at the first call."""

    def __init__(
        self,
        kernel: Kernel,
        long: bool,
        chosen: Chosen | None = None,
    ) -> None:
        self.kernel, self.chosen, self.runs_long = kernel, chosen, long
        self.function = function = kernel.py_func
        self.name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        if chosen is not None:
            self.name += f".{chosen.name}"
        self.__doc__ = function.__doc__
        self._run: Callable[[int], None] | None = None
        if self.name in ENTRY_POINTS:
            raise ValueError(f"two entry points have the name {self.name}")
        ENTRY_POINTS[self.name] = self

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

        return compile_entry(self.name, self.function, self.signature, OPTIONS)

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


class Choice(Exported):
    """Entry points of one function whose annotations have a union, one for each member; the arguments choose."""

    def __init__(self, kernel: Kernel, long: bool, place: tuple[int, ...], union: Any) -> None:
        self.kernel, self.__doc__ = kernel, kernel.__doc__
        self._place = place
        self._rows = {chosen.key: EntryPoint(kernel, long, chosen) for chosen in chosen_of(union)}
        self._by_base = any(isinstance(key, tuple) for key in self._rows)

    def __call__(self, *arguments: Any) -> Any:
        """Run the compiled function for the type of the arguments."""
        value = reduce(getitem, self._place, arguments)
        return self._rows[(type(value), type(value.forcing)) if self._by_base else type(value)](*arguments)

    def __getitem__(self, kind: Any) -> EntryPoint:
        """Return the entry point for one type, such as ``Slender[Cosine]``."""
        return self._rows[Chosen(kind, 0).key]


def entry_point(function: Kernel | Callable[..., Any] | None = None, *, long: bool = False) -> Any:
    """Mark a function, or a kernel with options of its own, as an entry point. All arguments and the result must be annotated.

    Other kernels may call it, too.

    Those that run ``long`` are optimised in a module of their own, where what they alone call becomes part of their body. The
    lanes need this: in the module of the other kernels their small functions are not inlined.

    Unions among the annotations, such as that of the parameters of all forcings, make one entry point for each member. The
    first union must be that of an argument, and tells by its type which is called.
    """
    if function is None:
        return lambda marked: entry_point(marked, long=long)
    kernel = function if isinstance(function, Kernel) else Kernel(function, False, False)
    hints = get_type_hints(kernel.py_func, include_extras=True)
    found = place_of_union(list(hints.values()))
    return Choice(kernel, long, *found) if found else EntryPoint(kernel, long)
