"""Names of records that are too long for a figure."""

from __future__ import annotations


def shortened(name: str, longest: int) -> str:
    """Return a name of at most `longest` characters, at least 3: its start and its end, where records of one event differ.

    Examples
    --------
    >>> shortened("RSN953_NORTHR_MUL279", 11)
    'RSN95…UL279'
    """
    if len(name) <= longest:
        return name
    end = (longest - 1) // 2
    return f"{name[: longest - 1 - end]}…{name[-end:]}"
