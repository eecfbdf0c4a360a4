"""Compiled kernels of the package: functions of numbers and arrays, without Python objects.

All modules are imported here, by a walk over the package, so that each caches its machine code in the folder
of ``machine_code``. The first compilation, which takes most of a minute, is reported once in the log
``rocking``.
"""

import importlib
import logging
import pkgutil

from numba.core import event

from rocking.kernels.machine_code import FOLDER, kept_in_folder


class _Compiling(event.Listener):
    """Listener that reports the first compilation and then unregisters itself."""

    def on_start(self, _: event.Event) -> None:
        event.unregister("numba:compile", self)
        often = "once for this machine" if FOLDER else "at every start, because no cache folder is writable"
        logging.getLogger("rocking").info("compiling the kernels (%s): takes most of a minute", often)

    def on_end(self, _: event.Event) -> None:
        """Do nothing: only the start of a compilation is reported."""


def _tell_of_compiling() -> None:
    """Register the listener for compilations. Machine code loaded from the cache triggers no report."""
    event.register("numba:compile", _Compiling())


def _import_all() -> None:
    """Import every module of the package and of the packages in it."""
    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        importlib.import_module(module.name)


_tell_of_compiling()
with kept_in_folder():
    _import_all()
