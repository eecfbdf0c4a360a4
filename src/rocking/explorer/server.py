"""HTTP server of the explorer: it listens on the loopback address and answers only its user, under local host names."""

from __future__ import annotations

import gc
import hashlib
import logging
import re
import secrets
import socket
import traceback
from base64 import b64encode
from collections.abc import Callable, Mapping
from functools import cache, partial
from importlib import import_module
from typing import Any
from urllib.parse import parse_qsl, urlencode

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from jinja2 import Environment, Template
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPHeaders, HTTPServerRequest, split_host_and_port
from tornado.ioloop import IOLoop
from tornado.routing import AnyMatches, HostMatches, Matcher, PathMatches, Router, Rule, RuleRouter
from tornado.web import Application as Pages
from tornado.web import ErrorHandler, OutputTransform, RequestHandler, stream_request_body

from rocking.explorer import ground_page, harmonic_page
from rocking.explorer.jobs import Workers
from rocking.explorer.page import text_of
from rocking.model.forcing import Harmonic
from rocking.model.system import System
from rocking.motion.simulate import simulate

PAGES = {"/": harmonic_page.PAGE, "/ground-motion": ground_page.PAGE}
"""Pages by their addresses."""
HOST = "127.0.0.1"
NAMES = ("localhost", HOST, "[::1]")
"""Allowed host names. The port may differ, because a tunnel can map it."""
LOGGERS = ("bokeh.server.protocol_handler", "bokeh.server.views.ws", "tornado.application")
"""Loggers of failed messages and connections."""
MAX_MESSAGE = 64_000_000
"""Maximum size of a message of a page, in bytes: larger than the largest file."""
LOADED_FIRST = ("scipy.signal", "scipy.spatial")
"""Modules that figures load when they are first drawn: two threads that load them at once can leave both broken."""
PATIENCE = 30.0
"""Time limit for the headers of a request, and for its body, s."""
UNUSED = 5_000
"""Lifetime of a session without a connection, ms; checked every two seconds."""
TOKEN = "token"
"""Name of the token in an address."""
TOKEN_BYTES = 24
POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; "  # Bokeh writes styles into the page
    "form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
}
INLINE = re.compile(rb"<script(?![^>]*\ssrc=)[^>]*>(.*?)</script>", re.DOTALL)


class LocalServer(BaseServer):
    """Server of the pages of one user. `link` is the address that opens them, with the token of the user."""

    link: str


def serve(port: int = 0) -> LocalServer:
    """Create the local server of the explorer; `run_until_shutdown` starts it, and `link` is the address that opens it.

    Parameters
    ----------
    port : int
        Port, in [0, 65535]. Default: 0, which selects a free port.

    Returns
    -------
    LocalServer
        Server, not yet started.

    Raises
    ------
    OSError
        If the port cannot be opened.
    ImportError
        If the compiled kernels cannot be used.
    """
    simulate(System(Harmonic(0.0, period=1.0), 0.0), cycles=1)  # opens the kernels before a page is shown
    for name in LOADED_FIRST:
        import_module(name)
    workers = Workers()
    open_page = {address: partial(page.open, workers=workers) for address, page in PAGES.items()}
    pages = {address: Application(FunctionHandler(opened)) for address, opened in open_page.items()}
    server = local_server(pages, port)
    gc.freeze()  # each closed session triggers a full collection; permanent objects need not be searched
    return server


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


# ---- entrance: the token of the user, the cookie that stands for it, and the headers of all answers


def new_token() -> str:
    """Return a random token."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def knows(request: HTTPServerRequest, token: str) -> bool:
    """Return whether a request has the cookie of the user."""
    cookie = request.cookies.get(_cookie(request))
    return cookie is not None and _same(cookie.value, token)


def _cookie(request: HTTPServerRequest) -> str:
    """Return the name of the cookie. It contains the port, because a browser sends cookies of one host to all its ports."""
    return f"rocking-{split_host_and_port(request.host)[1] or 80}"


def _same(value: str, token: str) -> bool:
    """Compare in a time that does not depend on the first difference."""
    return secrets.compare_digest(value.encode(), token.encode())


class Entrance(RequestHandler):
    """Exchange the token of an address for the cookie, and ask for the token where both are missing.

    The answer to a valid token is a page that opens the address without the token. A redirection would not do. If another
    page or a file leads here, the browser sends a cookie with `SameSite=Strict` only in requests that this page makes.
    """

    def initialize(self, token: str) -> None:
        """Take the token of the user."""
        self.token = token

    def get(self) -> None:
        """Answer any address."""
        query = parse_qsl(self.request.query, keep_blank_values=True)
        rest = [(name, value) for name, value in query if name != TOKEN]
        value = self.get_query_argument(TOKEN, "").rpartition(f"{TOKEN}=")[2]  # it may be the whole address
        opens = knows(self.request, self.token)
        if _same(value, self.token):
            self.set_cookie(_cookie(self.request), self.token, httponly=True, samesite="Strict")
            opens = True
        if not opens and self.request.headers.get("Sec-Fetch-Site") != "cross-site":
            self.set_status(403)
            self.finish(_form().render(rest=rest, wrong=bool(value)))
            return
        self.finish(_form().render(again=urlencode(rest, safe=":,/")))

    def set_default_headers(self) -> None:
        """Keep the answer, which depends on the cookie, out of caches."""
        self.set_header("Cache-Control", "no-store")


@cache
def _form() -> Template:
    return Environment(autoescape=True).from_string(text_of("entrance.html"))


class Guarded(OutputTransform):
    """Headers by which a browser loads and runs nothing but what this server has put into a page."""

    def __init__(self, request: HTTPServerRequest) -> None:
        self.messages = f"connect-src 'self' ws://{request.host}"

    def transform_first_chunk(
        self, status_code: int, headers: HTTPHeaders, chunk: bytes, finishing: bool
    ) -> tuple[int, HTTPHeaders, bytes]:
        """Add the headers; scripts within a page are allowed by their hashes."""
        page = headers.get("Content-Type", "").startswith("text/html")
        hashes = [hashlib.sha256(each).digest() for each in INLINE.findall(chunk if page else b"")]
        scripts = "".join(f" 'sha256-{b64encode(each).decode()}'" for each in hashes)
        headers.update(HEADERS)
        headers["Content-Security-Policy"] = f"{POLICY}; script-src 'self'{scripts}; {self.messages}"
        return status_code, headers, chunk
