"""Copies of named tuples with some fields replaced: compiled code lacks Python's ``_replace``."""

from rocking.kernels.library.kernel import kernel


def replacing(kind, *fields):
    """Make a kernel that returns a copy of a named tuple of type ``kind`` with new values of ``fields``.

    The kernel takes the tuple and the new values, in the order of ``fields``. ValueError: if the tuple lacks a field.
    """
    unknown = set(fields) - set(kind._fields)
    if unknown:
        raise ValueError(f"{kind.__name__} has no field {', '.join(sorted(unknown))}")
    values = ", ".join(field if field in fields else f"old.{field}" for field in kind._fields)
    scope = {"kind": kind, "__name__": __name__}
    exec(f"def replace(old, {', '.join(fields)}):\n    return kind({values})", scope)
    return kernel(scope["replace"], inline=True)
