"""Named tuples with some fields replaced: ``_replace`` of Python, which compiled code does not have."""

from numba import njit

from rocking.kernels.compile_options import INTERNAL_INLINE


def replacing(kind, *fields):
    """Make a kernel that takes a tuple of this kind and new values of ``fields``, in this order, and returns the new tuple."""
    unknown = set(fields) - set(kind._fields)
    if unknown:
        raise ValueError(f"{kind.__name__} has no field {', '.join(sorted(unknown))}")
    values = ", ".join(field if field in fields else f"old.{field}" for field in kind._fields)
    scope = {"kind": kind}
    exec(f"def replace(old, {', '.join(fields)}):\n    return kind({values})", scope)
    return njit(**INTERNAL_INLINE)(scope["replace"])
