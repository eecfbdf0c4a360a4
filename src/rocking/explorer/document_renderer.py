"""Jobs and requests that change the document of one session, in the event loop of the server."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, TypeVar

from bokeh.document import Document

from rocking.explorer.page_channel import Link
from rocking.explorer.worker_pools import Jobs, Workers

Value = TypeVar("Value")
BREATH = 0.2
"""Pause between two steps of a refinement, s, so that the page can repaint."""


class DocumentRenderer:
    """Document of a session, and the jobs that change it."""

    def __init__(self, document: Document, link: Link, workers: Workers) -> None:
        self.document, self.link, self.workers = document, link, workers
        self.jobs = Jobs()

    def in_turn(self, act: Callable[[Value], None]) -> Callable[[Value], None]:
        """Return a function that calls `act` later, in the event loop, with the lock of the document held."""

        def later(given: Value) -> None:
            async def acting() -> None:
                act(given)

            self._await(acting)

        return later

    def _await(self, act: Any) -> None:  # the type hints of Bokeh 3.9 lack coroutines
        """Await the coroutine `act()` in the event loop, with the lock of the document held.

        From version 3.10 on, Bokeh calls plain functions on threads of its own, which must not start jobs.
        """
        self.document.add_next_tick_callback(act)

    async def _draw(self, change: Callable[[], None]) -> None:
        """Change the document in the event loop, with its lock held."""
        done = asyncio.get_running_loop().create_future()

        async def act() -> None:
            if self._alone():
                self.jobs.end_all()
            if done.cancelled():
                return
            try:
                change()
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
