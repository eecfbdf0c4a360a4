"""Entrance to the pages: the token of their user, the cookie that stands for it, and the headers of all answers."""

from __future__ import annotations

import hashlib
import re
import secrets
from base64 import b64encode
from functools import cache
from importlib.resources import files
from urllib.parse import parse_qsl, urlencode

from jinja2 import Environment, Template
from tornado.httputil import HTTPHeaders, HTTPServerRequest, split_host_and_port
from tornado.web import OutputTransform, RequestHandler

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


def _same(given: str, token: str) -> bool:
    """Compare in a time that does not depend on the first difference."""
    return secrets.compare_digest(given.encode(), token.encode())


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
        given = self.get_query_argument(TOKEN, "").rpartition(f"{TOKEN}=")[2]  # it may be the whole address
        opens = knows(self.request, self.token)
        if _same(given, self.token):
            self.set_cookie(_cookie(self.request), self.token, httponly=True, samesite="Strict")
            opens = True
        if not opens and self.request.headers.get("Sec-Fetch-Site") != "cross-site":
            self.set_status(403)
            self.finish(_form().render(rest=rest, wrong=bool(given)))
            return
        self.finish(_form().render(again=urlencode(rest, safe=":,/")))

    def set_default_headers(self) -> None:
        """Keep the answer, which depends on the cookie, out of caches."""
        self.set_header("Cache-Control", "no-store")


@cache
def _form() -> Template:
    text = files("rocking.explorer").joinpath("entrance.html").read_text(encoding="utf-8")
    return Environment(autoescape=True).from_string(text)


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
