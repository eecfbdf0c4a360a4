"""The compiled physics: numbers in, numbers out.

All modules are imported here, by a walk over the package, so that each keeps its machine code where ``machine_code``
says. That a kernel is compiled, which takes most of a minute, is told once to the log ``rocking``.
"""

import importlib
import logging
import pkgutil

from numba.core import event

from rocking.kernels.machine_code import FOLDER, kept_in_folder


class _Compiling(event.Listener):
    """Hears the compiler start, tells it, and hears no more."""

    def on_start(self, _: event.Event) -> None:
        event.unregister("numba:compile", self)
        often = "once for this machine" if FOLDER else "at every start, for no cache folder can be written"
        logging.getLogger("rocking").info("compiling, %s: most of a minute", often)

    def on_end(self, _: event.Event) -> None:
        """Nothing: one start is enough."""


def _tell_of_compiling() -> None:
    """What comes from the cache is not compiled, and not told."""
    event.register("numba:compile", _Compiling())


def _import_all() -> None:
    """Import every module of the package and of the packages in it."""
    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        importlib.import_module(module.name)


_tell_of_compiling()
with kept_in_folder():
    _import_all()
