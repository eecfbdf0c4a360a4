"""What the page and its server tell each other: one line of JSON a matter."""

from __future__ import annotations

import json
from itertools import count
from typing import Any

from bokeh.core.properties import Any as Anything
from bokeh.core.properties import String
from bokeh.model import DataModel

from rocking.explorer.form_fields import Refused

MAX_LENGTH = 4_000
STRANGE = "the page asked for something that is not known here: load it again"


_numbers = count()


class Link(DataModel):
    """`asked` comes from the page, all others go to it."""

    asked = String(default="")
    drawn = Anything()
    shown = String(default="")
    verdict = String(default="")
    legend = String(default="")
    progress = String(default="")
    basin = String(default="")
    refused = String(default="")

    def send(self, name: str, message: dict[str, Any]) -> None:
        """Tell the page, which hears only of what differs: hence the number."""
        setattr(self, name, json.dumps({"n": next(_numbers), **message}, ensure_ascii=False, allow_nan=False))

    def draw(self, **figures: dict[str, Any]) -> None:
        """What is new in figures, by their names: columns by the names of their sources; `ranges`, `label` and `here` where these change.

        One matter, whatever it holds: the server goes through all models for each, and the browser paints after each.
        """
        self.drawn = {"n": next(_numbers), **figures}  # type: ignore[assignment]  # its hint knows of no value


def message(text: str) -> dict[str, Any]:
    """A message of the page: `what` it asks for, and `fields` as they are typed; anything else is refused."""
    try:
        asked = json.loads(text) if len(text) <= MAX_LENGTH else {}
        whole = isinstance(asked["what"], str) and all(
            isinstance(each, str) for each in asked["fields"].values()
        )
    except (ValueError, RecursionError, TypeError, KeyError, AttributeError):
        whole = False
    if not whole:
        raise Refused({"page": STRANGE})
    return asked
