"""`rocking explore`: errors before the server starts, and its end. tests/browser tests the page."""

import os
import re
import signal
import socket
import stat
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit


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


def test_browser_is_started_without_the_token_in_its_arguments_which_all_users_see(tmp_path):
    told, browser = tmp_path / "told", tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$@" > {told}.partial\nmv {told}.partial {told}\n')
    browser.chmod(0o700)
    command = [sys.executable, "-m", "rocking", "explore", "--port", "0"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env=os.environ | {"BROWSER": f"{browser} %s"}
    ) as process:
        link = re.match(r"http://localhost:\d+/\?token=[\w-]{32} ", process.stdout.readline())[0].strip()
        while not told.exists():
            time.sleep(0.05)
        page = Path(urlsplit(told.read_text().strip()).path)
        assert f'url={link}"' in page.read_text()
        assert stat.S_IMODE(page.parent.stat().st_mode) == 0o700
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 0
    assert not page.parent.exists()
