"""HTTP server of the explorer: it listens on the loopback address and answers only requests for local host names."""

from __future__ import annotations

import logging
import re
import socket
import traceback
from collections.abc import Mapping

from bokeh.application import Application
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.routing import AnyMatches, HostMatches, PathMatches, Router, Rule, RuleRouter
from tornado.web import Application as Pages
from tornado.web import ErrorHandler, RequestHandler

HOST = "127.0.0.1"
NAMES = ("localhost", HOST, "[::1]")
"""Allowed host names. The port may differ, because a tunnel can map it."""
LOGGERS = ("bokeh.server.protocol_handler", "bokeh.server.views.ws", "tornado.application")
"""Loggers of failed messages and connections."""
MAX_MESSAGE = 64_000_000
"""Maximum size of a message of a page, in bytes: more than that of the largest file."""
UNUSED = 5_000
"""Lifetime of a session without a connection, ms; checked every two seconds."""


def local_server(application: Application | Mapping[str, Application], port: int) -> BaseServer:
    """Create a local server of one or more applications, with one document per session.

    Parameters
    ----------
    application : Application or mapping of str to Application
        Application at the address /, or applications by their addresses.
    port : int
        Port, in [0, 65535]; 0 selects a free port.

    Returns
    -------
    BaseServer
        Server, not yet started.

    Raises
    ------
    OSError
        If the port cannot be opened.
    """
    listening = socket.create_server((HOST, port))
    listening.setblocking(False)
    port = listening.getsockname()[1]
    pages = BokehTornado(
        dict(application) if isinstance(application, Mapping) else application,
        extra_websocket_origins=[f"{name}:{port}" for name in NAMES],
        unused_session_lifetime_milliseconds=UNUSED,
        check_unused_sessions_milliseconds=2_000,
        session_token_expiration=3_600,
        keep_alive_milliseconds=0,
        websocket_max_message_size_bytes=MAX_MESSAGE,
        log_function=_keep_silent,
    )
    for name in LOGGERS:
        logging.getLogger(name).addFilter(is_ours)
    server = HTTPServer(only_local(pages))
    server.add_socket(listening)
    return BaseServer(IOLoop.current(), pages, server)


def only_local(pages: Router) -> Router:
    """Route requests for the allowed host names, and reject all others before any handler.

    A page of another host can make the browser resolve that host name to this machine (DNS rebinding). The headers Origin
    and Host of its requests then agree, so that a list of allowed origins does not reject them.
    """
    names = "|".join(map(re.escape, NAMES))
    return RuleRouter(
        [
            Rule(PathMatches(r".*%00.*"), _refusing(400)),  # no file has such a name
            Rule(HostMatches(f"(?i:{names})$"), pages),
            Rule(AnyMatches(), _refusing(403)),
        ]
    )


def is_ours(record: logging.LogRecord) -> bool:
    """Return whether to keep a log record: without an exception, or with code of `rocking` in its traceback."""
    if not record.exc_info:
        return True
    frames = (frame for frame, _ in traceback.walk_tb(record.exc_info[2]))
    return any(frame.f_globals.get("__name__", "").startswith("rocking.") for frame in frames)


def _refusing(status: int) -> Pages:
    return Pages([(".*", ErrorHandler, {"status_code": status})], log_function=_keep_silent)


def _keep_silent(handler: RequestHandler) -> None:
    """Suppress the log line of a request."""
