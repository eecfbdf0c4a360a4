"""Copies of arrays, without an array between: compiled assignments of rows may make one."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit


@njit(**INTERNAL_INLINE)
def copy_into(target, source):
    """Write the numbers of one array into another of the same length."""
    for k in range(source.shape[0]):
        target[k] = source[k]
