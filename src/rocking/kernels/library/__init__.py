"""The shared library of all entry points: compiled when the package is installed, opened when a kernel is first called."""

from rocking.kernels.library.load import KernelsUnusable
from rocking.kernels.library.processor import processor_class

__all__ = ["KernelsUnusable", "processor_class"]
