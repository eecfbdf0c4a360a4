"""`rocking cite`."""

from __future__ import annotations


def cite() -> None:
    """Print BibTeX entries of the package and its sources."""
    import rocking as rk

    print(rk.cite(), end="")
