"""Sessions that are opened and dropped leave nothing behind, and invalid messages do not end the server."""

import asyncio
import json
import random
import re
import sys
from concurrent.futures import ThreadPoolExecutor

import psutil
import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from rocking.survey.engine import cores

VISITS = 200
FORGOTTEN = 8.0
"""Seconds after which the server has searched for sessions without a connection and dropped them."""
ALLOWED = 30e6
"""Bytes that the memory may have grown by, however many visits: one alone takes some 10⁷."""


def run(coroutine):
    """Run a coroutine in a new thread, because a browser leaves an event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, coroutine).result()


async def opened(running):
    """Load a page and open its connection; return the connection and the number of its `link`."""
    page = await AsyncHTTPClient().fetch(running.address, headers=running.cookie)
    token = re.search(rb'"token":"([^"]+)"', page.body)[1].decode()
    request = HTTPRequest(running.address.replace("http", "ws") + "ws", headers=running.cookie)
    connection = await websocket_connect(request, subprotocols=["bokeh", token], max_message_size=2**28)
    await frames(connection, 3)  # the greeting
    await send(connection, "PULL-DOC-REQ", {})
    link = None
    while link is None:
        frame = await connection.read_message()
        if isinstance(frame, str):
            link = re.search(r'"name":"rocking.explorer.session.Link","id":"(p\d+)"', frame)
    return connection, link[1]


async def frames(connection, count):
    for _ in range(count):
        await connection.read_message()


async def send(connection, kind, content):
    header = {"msgid": str(random.random()), "msgtype": kind}
    for part in (header, {}, content):
        await connection.write_message(json.dumps(part))


async def ask(connection, link, text):
    change = {"kind": "ModelChanged", "model": {"id": link}, "attr": "request", "new": text}
    await send(connection, "PATCH-DOC", {"events": [change]})


async def begun(running, number):
    """Open a session that computes its own map; return its connection."""
    connection, link = await opened(running)
    view = f"version=1&amplitude={2 + number % 9}&period=1&restitution=1"
    await ask(connection, link, json.dumps({"what": "open", "fields": {"address": view}}))
    return connection


async def drop_many(running, count):
    """Open ``count`` sessions and drop each immediately."""
    for number in range(count):
        (await begun(running, number)).close()
    await asyncio.sleep(FORGOTTEN)


async def watch_together(running, server):
    """Open more sessions than threads for maps and wait for all of them: every thread is used."""
    connections = [await begun(running, number) for number in range(2 * cores())]
    watching = [asyncio.create_task(frames(each, sys.maxsize)) for each in connections]
    rested = await comes_to_rest(server)
    for each in watching:
        each.cancel()
    for each in connections:
        each.close()
    await asyncio.sleep(FORGOTTEN)
    return rested


async def comes_to_rest(server):
    """Return whether the server ends its work within ten minutes. A slow, busy machine needs more than two."""
    for _ in range(600):
        before = server.cpu_times().user
        await asyncio.sleep(1.0)
        if server.cpu_times().user - before < 0.1:
            return True
    return False


@pytest.mark.long
def test_visits_opened_and_dropped_leave_nothing_behind(running):
    server = psutil.Process(running.process.pid)
    threads = server.num_threads() + 2 * cores() + 1  # both pools, and one that a diagram has for a moment
    # Every thread has the memory that it keeps: a map's working memory, of some 10⁷ bytes, stays with its thread.
    assert run(watch_together(running, server))
    run(drop_many(running, VISITS // 2))
    assert run(comes_to_rest(server))
    memory = server.memory_info().rss
    run(drop_many(running, VISITS))
    assert server.num_threads() <= threads
    assert run(comes_to_rest(server)), "the server goes on computing for nobody"
    # at rest, because a map under way uses additional memory
    assert server.memory_info().rss < memory + ALLOWED


STRANGE = [
    "", "{", "[]", "7", "null", "[" * 3000, "x" * 5000, "\\ud800",
    *(json.dumps(each) for each in (
        {"what": "open"}, {"what": 3, "fields": {}}, {"what": "fields", "fields": []}, {"what": "fields", "fields": {"amplitude": 3}},
        {"what": "fields", "fields": {"__class__": "3", "system": "x"}}, {"what": "case", "fields": {"name": "nothing"}},
        {"what": "case", "fields": {}}, {"what": "metres", "fields": {}}, {"what": "fields", "fields": {"height": "1e400", "width": "g"}},
        {"what": "open", "fields": {"address": "?version=99"}}, {"what": "open", "fields": {"address": "a=1&" * 600}},
        {"what": "fields", "fields": {"periods": "3:1"}}, {"what": "fields", "fields": {"periods": "1:1.0000000000000002"}},
        {"what": "fields", "fields": {"amplitudes": "-1:1e9"}}, {"what": "fields", "fields": {"cycles": "9" * 4000}},
        {"what": "fields", "fields": {"curves": "a,b"}}, {"what": "fields", "fields": {"vary": "__dict__"}},
        {"what": "fields", "fields": {"brace_angle": "0.5", "angle": "0.9"}},
    )),
]  # fmt: skip


@pytest.mark.long
def test_messages_of_a_stranger_are_refused_and_the_server_goes_on(running):
    async def talk():
        connection, link = await opened(running)
        for text in STRANGE:
            await ask(connection, link, text)
        noise = random.Random(5)
        for _ in range(100):
            text = "".join(
                chr(noise.choice([noise.randrange(32, 127), noise.randrange(0x2000)]))
                for _ in range(noise.randrange(60))
            )
            await ask(
                connection,
                link,
                json.dumps(
                    {"what": "fields", "fields": {noise.choice(["amplitude", "periods", "curves"]): text}}
                ),
            )
        await ask(
            connection,
            link,
            json.dumps(
                {
                    "what": "open",
                    "fields": {"address": "version=1&amplitude=6.5&period=0.4&restitution=0.925"},
                }
            ),
        )
        while "3 cycles, symmetric" not in str(await connection.read_message()):
            pass
        connection.close()

    run(asyncio.wait_for(talk(), 100))
    assert running.process.poll() is None


def test_another_origin_gets_no_connection_and_no_other_address_an_answer(running):
    async def intrude():
        page = await AsyncHTTPClient().fetch(running.address, headers=running.cookie)
        token = re.search(rb'"token":"([^"]+)"', page.body)[1].decode()
        request = HTTPRequest(
            running.address.replace("http", "ws") + "ws",
            headers=running.cookie | {"Origin": "http://example.org"},
        )
        with pytest.raises(HTTPClientError, match="403"):
            await websocket_connect(request, subprotocols=["bokeh", token])

    run(intrude())
    sockets = psutil.Process(running.process.pid).net_connections("tcp")
    assert {each.laddr.ip for each in sockets if each.status == psutil.CONN_LISTEN} == {"127.0.0.1"}
