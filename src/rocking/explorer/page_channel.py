"""Messages between the page and its server, each a line of JSON."""

from __future__ import annotations

import json
from itertools import count
from typing import Any

from bokeh.core.properties import Any as Anything
from bokeh.core.properties import String
from bokeh.model import DataModel

from rocking.explorer.field_readers import Refused

MAX_LENGTH = 4_000
STRANGE = "Unknown request. Please reload the page."


_numbers = count()


class Link(DataModel):
    """Shared model of page and server: the page writes `asked` and `file`, the server all other properties."""

    asked = String(default="")
    file = Anything()
    drawn = Anything()
    shown = String(default="")
    verdict = String(default="")
    legend = String(default="")
    progress = String(default="")
    basin = String(default="")
    saved = Anything()
    refused = String(default="")

    def send(self, name: str, message: dict[str, Any]) -> None:
        """Send a message to the page. Its serial number makes each message differ, because equal values are not sent."""
        setattr(self, name, json.dumps({"n": next(_numbers), **message}, ensure_ascii=False, allow_nan=False))

    def draw(self, **figures: dict[str, Any]) -> None:
        """Send new contents of figures, by figure name: columns by source name, and changed `ranges`, `label`, `here`.

        All changes go in one message, because the server visits all models and the browser repaints after each message.
        """
        self.drawn = {"n": next(_numbers), **figures}  # type: ignore[assignment]  # the type hint of the property lacks values


def message(text: str) -> dict[str, Any]:
    """Parse a message of the page: the request `what` and its `fields` as text. Raise Refused for anything else."""
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
