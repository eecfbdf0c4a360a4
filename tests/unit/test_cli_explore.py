"""`rocking explore`: what is refused before a server begins. What it serves, tests/browser looks at."""

import socket

import pytest


@pytest.mark.parametrize("port", ["65536", "-1", "1.5"])
def test_port_that_is_none_is_refused(rocking, port):
    assert rocking(f"explore --no-browser --port={port}")[:2] == (
        2,
        f"--port must be a whole number in [0, 65535]; got {port}",
    )


def test_port_in_use_is_told_with_the_way_out(rocking):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        code, message, _ = rocking(f"explore --no-browser --port={port}")
    assert code == 2
    assert message.startswith(f"--port {port} cannot be listened at: ")
    assert message.endswith("(give another, or 0)")
