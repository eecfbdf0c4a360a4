"""Interactive explorer in the browser, served by `rocking explore`."""

from rocking.explorer.application import serve

__all__ = ["serve"]
