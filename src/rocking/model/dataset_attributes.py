"""Attributes common to the datasets of results that have no store, by the CF conventions."""

from __future__ import annotations

from rocking.model.version import VERSION


def named(text: str) -> dict[str, str]:
    """Return the attributes of a normalised variable."""
    return {"long_name": text, "units": "1"}


def described(what: str) -> dict[str, object]:
    """Return the attributes of a dataset; ``what`` is the result, as a noun phrase."""
    return {
        "Conventions": "CF-1.11",
        "title": f"{what} of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "All quantities are normalised as in Yim & Lin (1991), Eqs. (1)-(4).",
    }
