"""The page's server answers only its user, to names of this machine; invalid messages are rejected without a traceback."""

import asyncio
import base64
import json
import logging
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from urllib.parse import urlsplit

import pytest
from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from rocking.explorer import server
from rocking.explorer.ground_page import GroundSession
from rocking.explorer.harmonic_page import HarmonicSession
from rocking.explorer.jobs import Workers
from rocking.explorer.server import MAX_MESSAGE, is_ours, local_server

SECONDS = 60.0


def run(coroutine):
    """Run a coroutine in a new thread, because a browser leaves an event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, asyncio.wait_for(coroutine, SECONDS)).result()


TOKEN = "the-token-of-these-tests"


@pytest.fixture(autouse=True)
def known_token(monkeypatch):
    monkeypatch.setattr(server, "new_token", lambda: TOKEN)


@asynccontextmanager
async def served(page=lambda document: None):
    """Serve a page, an empty one by default, on the loopback interface; return the port."""
    made = local_server(Application(FunctionHandler(page)), 0)
    made.start()
    try:
        yield made.port
    finally:
        made.stop()


def cookie(host, token=TOKEN):
    """Return the header of the user's browser, which knows the server by a name and a port."""
    return {"Cookie": f"rocking-{urlsplit(f'//{host}').port or 80}={token}"}


async def asked(port, path, headers):
    """Return the answer to a request."""
    request = HTTPRequest(f"http://127.0.0.1:{port}{path}", headers=headers, follow_redirects=False)
    return await AsyncHTTPClient().fetch(request, raise_error=False)


async def answer(port, path, host):
    """Return the HTTP status of a request of the user that names this machine ``host``."""
    return (await asked(port, path, {"Host": host} | cookie(host))).code


async def session_token(port):
    """Return Bokeh's token of the session of a new page."""
    own = f"localhost:{port}"
    page = await asked(port, "/", {"Host": own} | cookie(own))
    return re.search(rb'"token":"([^"]+)"', page.body)[1].decode()


async def connected(port, host, origin, token=TOKEN):
    """Connect for a page from the server; return the connection, or the HTTP status if it is rejected."""
    session = await session_token(port)
    headers = {"Host": host, "Origin": origin} | cookie(host, token)
    request = HTTPRequest(f"ws://127.0.0.1:{port}/ws", headers=headers)
    try:
        return await websocket_connect(request, subprotocols=["bokeh", session])
    except HTTPClientError as error:
        return error.code


OWN = (
    "localhost", "localhost:{port}", "LocalHost:{port}", "127.0.0.1", "127.0.0.1:{port}", "localhost:80", "[::1]", "[::1]:{port}",
)  # fmt: skip
STRANGE = (
    "evil.com", "evil.com:{port}", "evil.com:5918", "localhost.evil.com:{port}", "127.0.0.1.evil.com", "127x0x0x1", "127.0.0.2",
    "notlocalhost", "0.0.0.0:{port}", "[::2]:{port}",
)  # fmt: skip
PATHS = ("/", "/metadata", "/static/js/bokeh.min.js")


def test_no_other_name_gets_a_page_a_file_or_a_connection():
    async def visit():
        async with served() as port:
            for name in STRANGE:
                host = name.format(port=port)
                for path in (*PATHS, "/ws", "/nothing"):
                    assert await answer(port, path, host) == 403, (host, path)
                # the request of a browser that takes this machine for the other host
                assert await connected(port, host, f"http://{host}") == 403, host

    run(visit())


def test_this_machines_own_names_get_them_at_any_port():
    async def visit():
        async with served() as port:
            for name in OWN:
                host = name.format(port=port)
                assert [await answer(port, path, host) for path in PATHS] == [200] * len(PATHS), host
            for host in (f"localhost:{port}", f"127.0.0.1:{port}", f"[::1]:{port}"):
                connection = await connected(port, host, f"http://{host}")
                assert "ACK" in await connection.read_message(), host
                connection.close()
            # another page of this machine, which has another port
            assert await connected(port, f"localhost:{port}", "http://localhost:1") == 403

    run(visit())


def test_nobody_else_gets_a_page_a_file_or_a_connection():
    """They get a form for the token. No answer tells it, and what leads pages of other servers here is not served."""

    async def visit():
        async with served() as port:
            host = f"localhost:{port}"
            others = ({}, cookie(host, ""), cookie(host, TOKEN[:-1]), cookie("localhost:1"))
            for headers in others:
                for path in (*PATHS, "/ws", "/nothing", "/?token=", f"/?token={TOKEN}x", "/?a=1&token=%E9"):
                    told = await asked(port, path, {"Host": host} | headers)
                    assert told.code == 403 or path.endswith("%E9"), (path, headers)
                    assert "Set-Cookie" not in told.headers
                    assert TOKEN.encode() not in told.body.replace(f"{TOKEN}x".encode(), b"")
            assert await connected(port, host, f"http://{host}", "wrong") == 403
            assert await answer(port, "/autoload.js?bokeh-autoload-element=a", host) == 404
            page = await asked(port, "/", {"Host": host} | cookie(host))
            parts = re.search(rb'"token":"([^"]+)"', page.body)[1].split(b".")
            payload = base64.urlsafe_b64decode(parts[0] + b"===")
            assert TOKEN.encode() not in page.body + payload, "where a script could read it"

    run(visit())


def test_token_is_exchanged_for_a_cookie_that_no_script_reads_and_leaves_the_address():
    async def visit():
        async with served() as port:
            host = {"Host": f"localhost:{port}"}
            for path, rest in (
                (f"/?version=1&token={TOKEN}&periods=1:2", "version=1&amp;periods=1:2"),
                (f"/?token=http://localhost:1/%3Ftoken%3D{TOKEN}", ""),
                (f"//evil.com/?token={TOKEN}&a=%22%3E%3Cb", "a=%22%3E%3Cb"),
            ):
                told = await asked(port, path, host)
                assert told.headers["Set-Cookie"] == (
                    f"rocking-{port}={TOKEN}; HttpOnly; Path=/; SameSite=Strict"
                )
                assert f'content="0; url=?{rest}"'.encode() in told.body
                assert TOKEN.encode() not in told.body
            again = await asked(port, "/?a=1", host | {"Sec-Fetch-Site": "cross-site"})
            assert (again.code, "Set-Cookie" in again.headers) == (200, False)
            assert b'content="0; url=?a=1"' in again.body, "its own request has the cookie"
            form = await asked(port, "/?a=%22%3E%3Cb", host)
            assert b'name="a" value="&#34;&gt;&lt;b"' in form.body

    run(visit())


def test_every_answer_tells_the_browser_to_run_nothing_else():
    async def visit():
        async with served() as port:
            host = f"localhost:{port}"
            for path, headers in (("/", cookie(host)), ("/static/js/bokeh.min.js", cookie(host)), ("/", {})):
                told = await asked(port, path, {"Host": host} | headers)
                policy = dict(
                    each.split(maxsplit=1) for each in told.headers["Content-Security-Policy"].split("; ")
                )
                assert policy["default-src"] == policy["frame-ancestors"] == policy["base-uri"] == "'none'"
                assert policy["connect-src"] == f"'self' ws://{host}"
                scripts = policy["script-src"].split()
                assert scripts[0] == "'self'"
                assert all(each.startswith("'sha256-") for each in scripts[1:]), "tests/browser runs them"
                assert told.headers["X-Content-Type-Options"] == "nosniff"
                assert told.headers["Referrer-Policy"] == "no-referrer"
                assert told.headers["Cross-Origin-Resource-Policy"] == "same-origin"

    run(visit())


def test_requests_are_refused_before_their_body_is_read_and_closed_where_they_stop(monkeypatch):
    monkeypatch.setattr(server, "PATIENCE", 0.2)

    async def visit():
        async with served() as port:
            for sent, status in (
                (b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 90000000\r\n\r\n", b"405"),
                (b"POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n", b"405"),
                (b"PUT /static/js/bokeh.js HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\n\r\n", b"405"),
                (b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 90000000\r\n\r\n", b"400"),
                (b"GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n", b""),
                (b"GET / HTTP/1.1\r\nHost: loc", b""),
                (b"", b""),
            ):
                reader, writer = await asyncio.open_connection("127.0.0.1", port)
                writer.write(sent)
                told = await reader.read()  # to the end: the server closes the connection
                assert told[9:12] == status, (sent, told)
                writer.close()

    run(visit())


def test_message_longer_than_the_largest_file_is_refused_by_its_length():
    async def visit():
        async with served() as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            host = f"localhost:{port}"
            session = await session_token(port)
            lines = {
                "Host": host,
                "Upgrade": "websocket",
                "Connection": "Upgrade",
                "Sec-WebSocket-Version": "13",
            }
            lines |= {"Sec-WebSocket-Key": "x" * 22 + "==", "Sec-WebSocket-Protocol": f"bokeh, {session}"}
            lines |= cookie(host)
            text = "".join(f"{name}: {value}\r\n" for name, value in lines.items())
            writer.write(f"GET /ws HTTP/1.1\r\n{text}\r\n".encode())
            await reader.readuntil(b"\r\n\r\n")
            writer.write(
                b"\x82\xff" + (MAX_MESSAGE + 1).to_bytes(8, "big") + bytes(4)
            )  # a masked binary frame
            told = await reader.read()
            assert b"\x88" in told, "it closes"
            assert (1009).to_bytes(2, "big") in told, "because the message is too big"
            writer.close()

    run(visit())


@pytest.mark.parametrize("kind", [HarmonicSession, GroundSession])
def test_request_is_heard_in_the_event_loop_whichever_thread_brings_it(kind):
    """Bokeh brings it on a thread of its own from version 3.10 on, where no job can start."""

    async def visit():
        visits, workers = [], Workers()
        made = local_server(
            Application(FunctionHandler(lambda page: visits.append(kind(page, workers)))),
            0,
        )
        made.start()
        connection = await connected(made.port, f"localhost:{made.port}", f"http://localhost:{made.port}")
        await connection.read_message()
        [visit], [session] = visits, made.get_sessions("/")
        jobs = visit.jobs
        text = json.dumps({"what": "open", "fields": {"address": "version=1"}})
        await session.with_document_locked(lambda: asyncio.to_thread(setattr, visit.link, "request", text))
        while not jobs.busy:
            await asyncio.sleep(0.01)
        jobs.end_all()
        await session.with_document_locked(lambda: None)  # all is sent
        workers.close()
        connection.close()
        made.stop()

    run(visit())


def test_path_that_no_file_has_is_no_failure_of_the_server(caplog):
    async def visit():
        async with served() as port:
            paths = ("/static/%00", "/static/extensions/%00", "/%00", "/static/%ff", f"/static/{'a' * 5000}")
            assert [await answer(port, path, "localhost") for path in paths] == [400, 400, 400, 400, 404]

    run(visit())
    assert not [record for record in caplog.records if record.exc_info]


def header(kind):
    return json.dumps({"msgid": "1", "msgtype": kind})


MESSAGES = (
    ["x"], [b"\xff\xfe"], ["{}", "{}", "{}"], ["7", "7", "7"], ["null", "null", "null"], [header("NONE"), "{}", "{}"],
    [header("PATCH-DOC"), "{}", "[]"], [header("PATCH-DOC"), "{}", '{"events": 7}'],
    [header("PATCH-DOC"), "{}", '{"events": [{"kind": "x"}]}'],
    [header("PUSH-DOC"), "{}", "{}"], [header("OK"), "{}", "{}"],
)  # fmt: skip


def test_messages_that_make_no_sense_leave_no_traceback_and_the_server_goes_on(caplog):
    async def visit():
        async with served() as port:
            for fragments in MESSAGES:
                connection = await connected(port, f"localhost:{port}", f"http://localhost:{port}")
                await connection.read_message()  # the greeting
                for fragment in fragments:
                    await connection.write_message(fragment, binary=isinstance(fragment, bytes))
                connection.close()
            for protocols in (None, ["bokeh", "zz"], ["other", "zz"]):
                request = HTTPRequest(f"ws://localhost:{port}/ws", headers=cookie(f"localhost:{port}"))
                connection = await websocket_connect(request, subprotocols=protocols)
                assert await connection.read_message() is None
                connection.close()
            assert await answer(port, "/", "localhost") == 200
            await asyncio.sleep(0.5)  # what was sent before is handled

    run(visit())
    assert not [record for record in caplog.records if record.exc_info]


def test_errors_of_our_own_code_are_still_told():
    def failed(call):
        try:
            call()
        except ValueError:
            return logging.LogRecord("bokeh", logging.ERROR, "", 0, "failed", (), sys.exc_info())

    from rocking.model.validation import within

    assert is_ours(failed(lambda: within("angle", 3, 0, 1)))
    assert not is_ours(failed(lambda: int("x")))
    assert is_ours(logging.LogRecord("bokeh", logging.ERROR, "", 0, "failed", (), None))


def test_port_zero_is_any_that_is_free_and_one_in_use_is_refused():
    async def visit():
        async with served() as one, served() as other:
            assert 0 < one != other > 0
            with pytest.raises(OSError, match="in use"):
                local_server(Application(FunctionHandler(lambda document: None)), one)

    run(visit())


FIGURES = """
import sys
import numpy as np
from rocking.explorer import harmonic_motion as motion
from rocking.explorer.harmonic_maps import Attractors
from rocking.explorer.harmonic_view import DEFAULT as view
from rocking.explorer.jobs import Workers
from rocking.explorer.refinement import Refinement
from rocking.explorer.server import serve

serve(0)
before = set(sys.modules)
stop, section = np.zeros(1, np.int64), motion.Section(view)
section.grow(300)
motion.verdict(view), motion.traces(view), motion.spectrum(view), motion.diagram(view, stop), section.drawn(1)
fixed = {"restitution": view.restitution, "phase": 0.0, "amplitude": view.amplitude, "period": view.period}
Refinement(Attractors(view.angles, view.velocities, fixed, 17), Workers(), stop).coarse()
print(*sorted(name for name in set(sys.modules) - before if not name.startswith("rocking.")))
"""


def test_threads_load_no_package_that_another_thread_may_load_at_once():
    """A package that two threads load at once can remain half loaded, so that no spectrum is drawn any more."""
    done = subprocess.run([sys.executable, "-c", FIGURES], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
