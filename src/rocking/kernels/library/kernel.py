"""Decorators of kernels: functions that numba compiles. It is imported only where something is compiled."""

import importlib
import pkgutil
from collections.abc import Callable
from functools import cached_property
from typing import Any

# Kernels borrow arrays. Reference counting at every call took a fifth of the time of a map, so it is off.
OPTIONS = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True, "_nrt": False}
# Modules without kernels, which import numba or compile.
NOT_KERNELS = ("__main__", "build", "compiler", "emit", "lower")
# Functions that have several bodies, by the function that stands for them in compiled code.
CONTRACTS: dict[Callable[..., Any], "Contract"] = {}


class Compiled:
    """What the compiler finds under the name of a function: the object that numba makes of it, when it is needed."""

    compiled: Any

    @property
    def _numba_type_(self) -> Any:
        """Type by which numba takes this object for the compiled one."""
        return self.compiled._numba_type_


class Kernel(Compiled):
    """Function for the compiler. ``inline`` puts it into the body of its callers.

    Kernels that are called ``seldom`` stay functions: in the body of a caller they would take registers from what runs always.
    """

    def __init__(self, function: Callable[..., Any], inline: bool, seldom: bool) -> None:
        self.py_func, self.seldom = function, seldom
        self.options = OPTIONS | {"forceinline": inline}
        self.__name__, self.__doc__ = function.__name__, function.__doc__

    @cached_property
    def compiled(self) -> Any:
        """The dispatcher for calls of other kernels; it has no wrapper for Python, which takes as long to compile as the kernel."""
        from rocking.kernels.library.compiler import dispatcher_of

        return dispatcher_of(self.py_func, self.options | {"no_cpython_wrapper": True}, self.seldom)

    @cached_property
    def _called(self) -> Any:
        from rocking.kernels.library.compiler import dispatcher_of

        import_all()
        return dispatcher_of(self.py_func, self.options, self.seldom)

    def __call__(self, *args: Any, **named: Any) -> Any:
        """Compile the kernel and call it: tests and benchmarks do."""
        return self._called(*args, **named)


class Intrinsic(Compiled):
    """An instruction of the processor; ``function`` gives its type and its code."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    @cached_property
    def compiled(self) -> Any:
        """The intrinsic of the compiler."""
        from numba.extending import intrinsic

        return intrinsic(self.function)

    @property
    def _numba_type_(self) -> Any:
        from rocking.kernels.library.compiler import type_of_global

        return type_of_global(self.compiled)


class Contract(Compiled):
    """A function that has several bodies. The system, the first argument, chooses by its block and its base.

    ``bodies`` holds them by the classes of both; None stands for any.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.bodies: dict[tuple[type | None, type | None], Kernel] = {}
        CONTRACTS[function] = self

    @cached_property
    def compiled(self) -> Any:
        """The function for which the compiler takes the body."""
        from rocking.kernels.library.compiler import ChosenByType

        import_all()
        return ChosenByType(self.function, self.bodies)


def contract(function: Callable[..., Any]) -> Contract:
    """Mark a function without a body as one that has bodies, by ``body``."""
    return Contract(function)


def body(
    stub: Contract, block: type | None, *bases: type, inline: bool = False
) -> Callable[[Callable[..., Any] | Kernel], Kernel]:
    """Mark a kernel as the body of a function for systems of a class, ``Slender`` or ``Full``, on these bases.

    The block None stands for either, and no base for any; a body for one pair comes before these. A block that is ``LIKE`` another one
    has the bodies of that where it has none of its own.
    """

    def mark(function: Callable[..., Any] | Kernel) -> Kernel:
        own = function if isinstance(function, Kernel) else Kernel(function, inline, seldom=False)
        for base in bases or (None,):
            stub.bodies[block, base] = own
        return own

    return mark


def kernel(function: Callable[..., Any] | None = None, *, inline: bool = False, seldom: bool = False) -> Any:
    """Mark a function as a kernel: ``@kernel`` or ``@kernel(inline=True)``."""
    if function is None:
        return lambda marked: Kernel(marked, inline, seldom)
    return Kernel(function, inline, seldom)


def intrinsic(function: Callable[..., Any]) -> Any:
    """Mark a function as an intrinsic, as ``numba.extending.intrinsic`` does."""
    return Intrinsic(function)


def import_all() -> None:
    """Import all modules with kernels, so that all bodies are provided."""
    package = importlib.import_module("rocking.kernels")
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        if module.name.rpartition(".")[2] not in NOT_KERNELS:
            importlib.import_module(module.name)
