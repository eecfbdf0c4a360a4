"""Variables of the template of the page of ground motions, equal for all sessions."""

from __future__ import annotations

import json
from importlib.resources import files

from rocking.explorer.ground_motion.view import SOURCES, UNITS
from rocking.model.forcing import KINDS
from rocking.model.package import VERSION

NAMES = {
    "example": "Loma Prieta 1989 (example)",
    "synthetic-1": "Synthetic 1",
    "synthetic-2": "Synthetic 2",
    "synthetic-3": "Synthetic 3",
    "pulse": "Pulse",
    "file": "File …",
}


def page() -> dict[str, object]:
    """Return the template and its variables."""
    return {
        "template": _text("page.html"),
        "style": _text("page.css"),
        "script": _text("page.js"),
        "given": json.dumps({}),
        "sources": [(name, NAMES[name]) for name in SOURCES],
        "kinds": KINDS,
        "units": [unit for unit in UNITS if unit],
        "version": VERSION,
    }


def _text(name: str) -> str:
    return files("rocking.explorer.ground_motion").joinpath(name).read_text(encoding="utf-8")
