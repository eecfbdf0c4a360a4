"""`rocking explore`: errors before the server starts, and its end. tests/browser tests the page."""

import signal
import socket
import subprocess
import sys

import pytest


@pytest.mark.parametrize("port", ["65536", "-1", "1.5", "abc"])
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
    assert message.startswith(f"cannot listen on --port {port}: ")
    assert message.endswith("(give another port, or --port 0 for a free one)")


def test_control_c_ends_what_is_served_quietly_and_is_no_failure():
    command = [sys.executable, "-m", "rocking", "explore", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().startswith("http://localhost:")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (0, "", "")
