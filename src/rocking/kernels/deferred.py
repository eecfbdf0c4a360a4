"""Kernels that are not compiled yet: numba is imported only where something has to be compiled."""

import importlib
import pkgutil
import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any

# Names of modules that define or call kernels and still hold them uncompiled.
UNBOUND: set[str] = set()
# Modules without kernels, which import numba or compile.
NOT_KERNELS = ("__main__", "build", "compiler", "emit", "lower")


# Functions that have several bodies, by the function that stands for them in compiled code.
CONTRACTS: dict[Callable[..., Any], "Contract"] = {}


class Kernel:
    """A function for the compiler, with its options; ``bind_compiled`` puts the compiled function in its place."""

    def __init__(self, py_func: Callable[..., Any], options: dict[str, Any]) -> None:
        self.py_func = py_func
        self.options = options
        UNBOUND.add(py_func.__module__)

    @cached_property
    def compiled(self) -> Any:
        """The dispatcher of the compiler."""
        from rocking.kernels.library.compiler import dispatcher_of

        return dispatcher_of(self.py_func, self.options)

    def __call__(self, *args: Any, **named: Any) -> Any:
        """Compile the kernel and call it: tests and benchmarks do."""
        bind_compiled()
        return self.compiled(*args, **named)


class Intrinsic:
    """An instruction of the processor; ``function`` gives its type and its code."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    @cached_property
    def compiled(self) -> Any:
        """The intrinsic of the compiler."""
        from numba.extending import intrinsic

        return intrinsic(self.function)


class Contract:
    """A function of which each type of the first argument has a body of its own, chosen by the compiler."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.bodies: dict[type, Kernel] = {}
        UNBOUND.add(function.__module__)
        CONTRACTS[function] = self

    @cached_property
    def compiled(self) -> Any:
        """The function for which the compiler takes the body."""
        from rocking.kernels.library.compiler import ChosenByType

        return ChosenByType(self.function, self.bodies)


def contract(function: Callable[..., Any]) -> Contract:
    """Mark a function without a body as one that ``provide`` gives bodies."""
    return Contract(function)


def provide(kind: type, bodies: dict[Contract, Kernel]) -> None:
    """Give functions their bodies for a first argument of a type."""
    for stub, body in bodies.items():
        stub.bodies[kind] = body


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Mark a function as a kernel, as ``numba.njit`` does."""
    return lambda function: Kernel(function, options)


def intrinsic(function: Callable[..., Any]) -> Any:
    """Mark a function as an intrinsic, as ``numba.extending.intrinsic`` does."""
    return Intrinsic(function)


def import_all() -> None:
    """Import all modules with kernels."""
    package = importlib.import_module(__package__)
    for module in pkgutil.walk_packages(package.__path__, f"{__package__}."):
        if module.name.rpartition(".")[2] not in NOT_KERNELS:
            importlib.import_module(module.name)


def bind_compiled() -> None:
    """Import all kernels, and bind each name of a kernel to the dispatcher of the compiler."""
    if not UNBOUND:
        return
    import_all()
    while UNBOUND:
        module = sys.modules[UNBOUND.pop()]
        for own, value in list(vars(module).items()):
            if isinstance(value, Kernel | Intrinsic | Contract):
                setattr(module, own, value.compiled)
