"""The page's server: it listens on this machine's own address, and answers requests for this machine's own names alone."""

from __future__ import annotations

import logging
import re
import socket
import traceback

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
"""What this machine is called where it asks itself, at any port: that of a tunnel may be another."""
LOGGERS = ("bokeh.server.protocol_handler", "bokeh.server.views.ws", "tornado.application")
"""Who tells of messages and connections that fail."""
UNUSED = 5_000
"""Milliseconds after which a visit is dropped that nobody looks at; looked for every two seconds."""


def local_server(application: Application, port: int) -> BaseServer:
    """A server of an application, a document a visitor; port 0: any that is free. OSError where it cannot listen."""
    listening = socket.create_server((HOST, port))
    listening.setblocking(False)
    port = listening.getsockname()[1]
    pages = BokehTornado(
        application,
        extra_websocket_origins=[f"{name}:{port}" for name in NAMES],
        unused_session_lifetime_milliseconds=UNUSED,
        check_unused_sessions_milliseconds=2_000,
        session_token_expiration=3_600,
        keep_alive_milliseconds=0,
        log_function=_keep_silent,
    )
    for name in LOGGERS:
        logging.getLogger(name).addFilter(is_ours)
    server = HTTPServer(only_local(pages))
    server.add_socket(listening)
    return BaseServer(IOLoop.current(), pages, server)


def only_local(pages: Router) -> Router:
    """Pass on what is asked of this machine by one of its own names, and refuse the rest before any handler sees it.

    A page of another host can make the browser take this machine for that host (DNS rebinding). Its requests then have
    matching headers Origin and Host, so that a list of allowed origins does not see them.
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
    """Whether a record tells of no error, or of one that our code took part in: not of messages that Bokeh refused."""
    if not record.exc_info:
        return True
    frames = (frame for frame, _ in traceback.walk_tb(record.exc_info[2]))
    return any(frame.f_globals.get("__name__", "").startswith("rocking.") for frame in frames)


def _refusing(status: int) -> Pages:
    return Pages([(".*", ErrorHandler, {"status_code": status})], log_function=_keep_silent)


def _keep_silent(handler: RequestHandler) -> None:
    """Say nothing of a request in the terminal."""
