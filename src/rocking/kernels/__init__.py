"""The compiled physics: numbers in, numbers out."""

try:
    import ctypes  # noqa: F401
except ImportError:
    raise ImportError(
        "this Python lacks ctypes, which opens the compiled kernels; build Python with libffi"
    ) from None
