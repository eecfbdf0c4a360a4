"""The page's server answers only to names of this machine; invalid messages are rejected without a traceback."""

import asyncio
import json
import logging
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager

import pytest
from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from rocking.explorer.server import is_ours, local_server

SECONDS = 60.0


def run(coroutine):
    """Run a coroutine in a new thread, because a browser leaves an event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, asyncio.wait_for(coroutine, SECONDS)).result()


@asynccontextmanager
async def served():
    """Serve an empty page on the loopback interface; return the port."""
    server = local_server(Application(FunctionHandler(lambda document: None)), 0)
    server.start()
    try:
        yield server.port
    finally:
        server.stop()


async def answer(port, path, host):
    """Return the HTTP status of a request that names this machine ``host``."""
    request = HTTPRequest(f"http://127.0.0.1:{port}{path}", headers={"Host": host})
    return (await AsyncHTTPClient().fetch(request, raise_error=False)).code


async def connected(port, host, origin):
    """Connect for a page from the server; return the connection, or the HTTP status if it is rejected."""
    page = await AsyncHTTPClient().fetch(f"http://localhost:{port}/")
    token = re.search(rb'"token":"([^"]+)"', page.body)[1].decode()
    request = HTTPRequest(f"ws://127.0.0.1:{port}/ws", headers={"Host": host, "Origin": origin})
    try:
        return await websocket_connect(request, subprotocols=["bokeh", token])
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
                for path in (*PATHS, "/autoload.js", "/ws", "/nothing"):
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
                connection = await websocket_connect(f"ws://localhost:{port}/ws", subprotocols=protocols)
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

    from rocking.model import within

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
