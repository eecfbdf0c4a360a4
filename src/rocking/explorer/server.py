"""HTTP server of the explorer: it listens on the loopback address and answers only its user, under local host names."""

from __future__ import annotations

import logging
import re
import socket
import traceback
from collections.abc import Callable, Mapping
from typing import Any

from bokeh.application import Application
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPServerRequest
from tornado.ioloop import IOLoop
from tornado.routing import AnyMatches, HostMatches, Matcher, PathMatches, Router, Rule, RuleRouter
from tornado.web import Application as Pages
from tornado.web import ErrorHandler, RequestHandler, stream_request_body

from rocking.explorer.entrance import TOKEN, Entrance, Guarded, knows, new_token

HOST = "127.0.0.1"
NAMES = ("localhost", HOST, "[::1]")
"""Allowed host names. The port may differ, because a tunnel can map it."""
LOGGERS = ("bokeh.server.protocol_handler", "bokeh.server.views.ws", "tornado.application")
"""Loggers of failed messages and connections."""
MAX_MESSAGE = 64_000_000
"""Maximum size of a message of a page, in bytes: larger than the largest file."""
PATIENCE = 30.0
"""Time limit for the headers of a request, and for its body, s."""
UNUSED = 5_000
"""Lifetime of a session without a connection, ms; checked every two seconds."""


class LocalServer(BaseServer):
    """Server of the pages of one user. `link` is the address that opens them, with the token of the user."""

    link: str


def local_server(application: Application | Mapping[str, Application], port: int) -> LocalServer:
    """Create a local server of one or more applications, with one document per session.

    Parameters
    ----------
    application : Application or mapping of str to Application
        Application at the address /, or applications by their addresses.
    port : int
        Port, in [0, 65535]; 0 selects a free port.

    Returns
    -------
    LocalServer
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
        include_headers=[],  # what is included stands in the page, where scripts could read the cookie
        include_cookies=[],
        transforms=[Guarded],
        log_function=_keep_silent,
    )
    for name in LOGGERS:
        logging.getLogger(name).addFilter(is_ours)
    token = new_token()
    http = HTTPServer(
        only_local(pages, token),
        idle_connection_timeout=PATIENCE,
        body_timeout=PATIENCE,
        max_body_size=0,  # the pages send no body
        max_buffer_size=MAX_MESSAGE + 2**20,  # with what follows a message
    )
    http.add_socket(listening)
    server = LocalServer(IOLoop.current(), pages, http)
    server.link = f"http://localhost:{port}/?{TOKEN}={token}"
    return server


def only_local(pages: Router, token: str) -> Router:
    """Route requests of the user for the allowed host names, and reject all others before any handler.

    A page of another host can make the browser resolve that host name to this machine (DNS rebinding). The headers Origin
    and Host of its requests then agree, so that a list of allowed origins does not reject them. Other users of this machine
    can connect, too, but do not know the token.
    """
    names = "|".join(map(re.escape, NAMES))
    entrance = Pages([(".*", Entrance, {"token": token})], transforms=[Guarded], log_function=_keep_silent)
    local = RuleRouter(
        [
            Rule(_Where(lambda request: TOKEN in request.query_arguments), entrance),
            Rule(_Where(lambda request: knows(request, token)), pages),
            Rule(AnyMatches(), entrance),
        ]
    )
    return RuleRouter(
        [
            Rule(_Where(lambda request: request.method != "GET"), _refusing(405)),
            Rule(PathMatches(r".*%00.*"), _refusing(400)),  # no file has such a name
            Rule(PathMatches(r".*/autoload\.js"), _refusing(404)),  # for pages of other servers
            Rule(HostMatches(f"(?i:{names})$"), local),
            Rule(AnyMatches(), _refusing(403)),
        ]
    )


def is_ours(record: logging.LogRecord) -> bool:
    """Return whether to keep a log record: without an exception, or with code of `rocking` in its traceback."""
    if not record.exc_info:
        return True
    frames = (frame for frame, _ in traceback.walk_tb(record.exc_info[2]))
    return any(frame.f_globals.get("__name__", "").startswith("rocking.") for frame in frames)


class _Where(Matcher):
    """Rule for requests of which a statement is true."""

    def __init__(self, holds: Callable[[HTTPServerRequest], bool]) -> None:
        self.holds = holds

    def match(self, request: HTTPServerRequest) -> dict[str, Any] | None:
        """Return no arguments of a handler, or None for another request."""
        return {} if self.holds(request) else None


@stream_request_body
class _Refusal(ErrorHandler):
    """Answer with an error before the body of the request is read."""

    def data_received(self, chunk: bytes) -> None:
        """Drop a part of the body that has come already."""


def _refusing(status: int) -> Pages:
    return Pages([(".*", _Refusal, {"status_code": status})], log_function=_keep_silent)


def _keep_silent(handler: RequestHandler) -> None:
    """Suppress the log line of a request."""
