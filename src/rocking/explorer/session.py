"""Engine of all pages: the session of one page in a browser, its view, its requests and its jobs."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Awaitable, Callable, Mapping
from itertools import count
from typing import Any, ClassVar, TypeVar

import numpy as np
from attrs import frozen
from bokeh.core.properties import Any as Anything
from bokeh.core.properties import String
from bokeh.document import Document
from bokeh.events import Tap
from bokeh.model import DataModel

from rocking.explorer.fields import Refused, View
from rocking.explorer.jobs import Jobs, Workers
from rocking.explorer.refinement import Picture, Refinement

Value = TypeVar("Value")
MAX_LENGTH = 4_000
STRANGE = "Unknown request. Please reload the page."

_numbers = count()


class Link(DataModel):
    """Shared model of page and server: the page writes `request` and `file`, the server all other properties.

    Each message is a line of JSON.
    """

    request = String(default="")
    file = Anything()
    drawn = Anything()
    view = String(default="")
    verdict = String(default="")
    legend = String(default="")
    progress = String(default="")
    basin = String(default="")
    gallery = String(default="")
    saved = Anything()
    refused = String(default="")

    def send(self, name: str, message: Mapping[str, Any]) -> None:
        """Send a message to the page. Its serial number makes each message differ, because equal values are not sent."""
        setattr(self, name, json.dumps({"n": next(_numbers), **message}, ensure_ascii=False, allow_nan=False))

    def refuse(self, **fields: str) -> None:
        """Send error messages by field, `page` for none; without any, the page removes those that it has."""
        self.send("refused", {"fields": fields})

    def draw(self, **figures: dict[str, Any]) -> None:
        """Send new contents of figures, by figure name: columns by source name, and changed `ranges`, `label`, `here`.

        All changes go in one message, because the server visits all models and the browser repaints after each message.
        """
        self.drawn = {"n": next(_numbers), **figures}  # type: ignore[assignment]  # the type hint of the property lacks values

    def save(self, data: bytes) -> None:
        """Send a file, which the page saves."""
        self.saved = {"n": next(_numbers), "data": data}  # type: ignore[assignment]  # as above


def message(text: str) -> dict[str, Any]:
    """Parse a message of the page: the request `what` and its `fields` as text. Raise Refused for anything else."""
    try:
        request = json.loads(text) if len(text) <= MAX_LENGTH else {}
        whole = isinstance(request["what"], str) and all(
            isinstance(each, str) for each in request["fields"].values()
        )
    except (ValueError, RecursionError, TypeError, KeyError, AttributeError):
        whole = False
    if not whole:
        raise Refused({"page": STRANGE})
    return request


@frozen
class Job:
    """Job of a page, which starts again when an attribute of the view that it needs has changed.

    Attributes
    ----------
    name : str
        Name of the job. Another job of this name is cancelled.
    work : callable
        Coroutine function of the session, the view and `stop`, which is set if the job is cancelled.
    needs : tuple of str
        Attributes of the view.
    renews : tuple of str
        Figures whose results are void as soon as the job starts, and "verdict".
    ends : tuple of str
        Jobs that continue this one, which are cancelled with it.
    within : str
        Job that does this work, too, if it starts.
    """

    name: str
    work: Callable[[Any, Any, np.ndarray], Awaitable[None]]
    needs: tuple[str, ...]
    renews: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
    within: str = ""


class Session:
    """Bokeh document with its current view. A page is a subclass that declares its view and jobs, and makes its figures."""

    VIEW: ClassVar[type[View]]
    JOBS: ClassVar[tuple[Job, ...]]

    def __init__(self, document: Document, workers: Workers) -> None:
        self.document, self.workers = document, workers
        self.link, self.jobs = Link(name="link"), Jobs()
        self.view: Any = self.VIEW()
        self.opened = False
        hear = self.in_turn(self.hear)
        self.link.on_change("request", lambda _name, _before, text: hear(text))
        figures = self.figures()  # with handlers of events, or the document ignores the events
        with document.models.freeze():  # otherwise the document visits all models once per root
            for root in (*figures, self.link):
                document.add_root(root)
        document.on_session_destroyed(lambda _context: self.jobs.end_all())

    # what a page declares

    def figures(self) -> tuple[Any, ...]:
        """Make the figures of the page."""
        raise NotImplementedError

    def place(self, changed: Callable[..., bool]) -> None:
        """Set axes and marks for the view; `changed(*names)` tells whether an attribute differs from the view before."""
        raise NotImplementedError

    def description(self) -> dict[str, Any]:
        """Return what the page needs to know of the view, besides its fields."""
        raise NotImplementedError

    def answer(self, what: str, typed: dict[str, str]) -> tuple[Any, dict[str, str]]:
        """Return the requested view, or None if there is none.

        Returns
        -------
        tuple of (View or None, dict of str)
            View, and an error message for each invalid parameter of a link.

        Raises
        ------
        Refused
            If the request is unknown or a field is invalid.
        """
        if what == "open":
            return self.VIEW.from_address(typed.get("address", ""))
        if what == "fields":
            return self.view.changed(typed), {}
        raise Refused({"page": STRANGE})

    # requests

    def hear(self, text: str) -> None:
        """Carry out a message of the page. An invalid one returns one sentence per field and leaves the view unchanged."""
        try:
            request = message(text)
        except Refused as refusal:
            self.link.refuse(**refusal.fields)
        else:
            self.request(request["what"], request["fields"], push=request.get("push") == "yes")

    def request(self, what: str, typed: dict[str, str], *, push: bool) -> None:
        """Carry out a request."""
        try:
            new, refused = self.answer(what, typed)
        except Refused as refusal:
            self.link.refuse(**refusal.fields)
            return
        self.link.refuse(**refused)
        if new is not None:
            self.show(new, push=push)

    def select(self, figure: Any, fields: Callable[[float, float], dict[str, str]]) -> None:
        """Let a click on a figure change fields, which are given for its coordinates."""

        def tapped(event: Tap) -> None:
            try:
                at = float(event.x), float(event.y)  # type: ignore[arg-type]  # they may be anything
            except (TypeError, ValueError, OverflowError):
                at = math.nan, math.nan
            if all(map(math.isfinite, at)):  # otherwise not a message of this page
                self.request("fields", fields(*at), push=True)

        figure.on_event(Tap, self.in_turn(tapped))

    def show(self, new: Any, *, push: bool) -> None:
        """Change the view, and start the jobs that need what has changed."""
        old, first = self.view, not self.opened
        self.view, self.opened = new, True

        def changed(*names: str) -> bool:
            return first or any(getattr(old, name) != getattr(new, name) for name in names)

        self.place(changed)
        due = {job.name: job for job in self.JOBS if changed(*job.needs)}
        started = [job for job in due.values() if job.within not in due]
        renewed = {name for job in started for name in job.renews}
        parts = {"address": new.address, "fields": new.shown, "push": push}
        void = {"moved": "verdict" in renewed, "renewed": sorted(renewed - {"verdict"})}
        self.link.send("view", parts | void | self.description())
        for job in started:
            self.jobs.end(*job.ends)
            self.jobs.start(job.name, job.work, self, new)

    # the document

    def in_turn(self, act: Callable[[Value], None]) -> Callable[[Value], None]:
        """Return a function that calls `act` later, in the event loop, with the lock of the document held."""

        def later(value: Value) -> None:
            async def acting() -> None:
                act(value)

            self._await(acting)

        return later

    def _await(self, act: Any) -> None:  # the type hints of Bokeh 3.9 lack coroutines
        """Await the coroutine `act()` in the event loop, with the lock of the document held.

        From version 3.10 on, Bokeh calls plain functions on threads of its own, which must not start jobs.
        """
        self.document.add_next_tick_callback(act)

    async def change(self, change: Callable[..., None], *arguments: Any) -> None:
        """Change the document in the event loop, with its lock held."""
        done = asyncio.get_running_loop().create_future()

        async def act() -> None:
            if self._alone():
                self.jobs.end_all()
            if done.cancelled():
                return
            try:
                change(*arguments)
            except Exception as error:  # noqa: BLE001 (raised again in the awaiting task)
                done.set_exception(error)
            else:
                done.set_result(None)

        self._await(act)
        await done

    def _alone(self) -> bool:
        """Return whether the connection is closed. The session is kept for a while, so that the browser can reconnect."""
        session = getattr(self.document.session_context, "session", None)
        return session is not None and session.connection_count == 0

    async def refine(self, refinement: Refinement, draw: Callable[[Picture], None]) -> None:
        """Compute and draw a map, from coarse to fine."""
        await self.change(draw, await self.workers.soon(refinement.coarse))
        async for picture in refinement.finer():
            await self.change(draw, picture)
