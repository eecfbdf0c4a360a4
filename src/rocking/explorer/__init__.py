"""The explorer: a page that shows a system from all sides, computed as one looks; `rocking explore` serves it."""

from rocking.explorer.application import serve

__all__ = ["serve"]
