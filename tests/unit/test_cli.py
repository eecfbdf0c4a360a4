"""The terminal, pipes, memory and Ctrl-C; `rocking paper`, and the server of `rocking explore`, whose page tests/browser tests."""

import errno
import logging
import os
import re
import resource
import signal
import socket
import stat
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from rocking.cli.main import NO_MEMORY, main, refused, run
from rocking.model.text import ordinal
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.report.paper import Paper

NORMALISED = "--amplitude 2 --period 1 --restitution 0.925"
SI = "--height 2 --width 0.5 --acceleration 2.9 --frequency-hz 1.8"
COMMAND = [sys.executable, "-m", "rocking"]


@pytest.mark.parametrize("number", [*range(1, 25), 101, 111, 112, 113, 122, 1003])
def test_ordinals_are_those_of_english(number):
    ends = {1: "st", 2: "nd", 3: "rd"} if number // 10 % 10 != 1 else {}
    assert ordinal(number) == f"{number}{ends.get(number % 10, 'th')}"


def test_report_is_written_to_the_folder_of_its_name(rocking, tmp_path):
    assert rocking("paper yim-lin-1991 1")[:2] == (0, "")
    folder = tmp_path / "results/yim-lin-1991"
    assert sorted(path.name for path in folder.iterdir()) == ["figure-01.png", "figure-01.svg"]


def three_claims():
    chapter = Chapter("of three")
    chapter.claim("first")(lambda: Finding(True, "1"))
    chapter.claim("second")(lambda: Finding(True, "2"))
    chapter.claim("third", error="3")(lambda: Finding(False, "3", explained=True))
    return (chapter,)


@pytest.mark.parametrize(
    "figures, last",
    [
        ("claims", "3 claims of the paper: confirmed (2), error in the paper (1)"),
        ("1", "wrote made/figure-01.svg"),
    ],
)
def test_paper_ends_with_how_its_claims_stand(rocking, monkeypatch, figures, last):
    monkeypatch.setattr(Paper, "chapters", three_claims())
    assert rocking(f"paper {figures} --output made")[2].splitlines()[-1] == last


def test_whole_paper_ends_with_the_page_to_open(rocking, monkeypatch):
    def nothing(paper, folder, figures, progress, summary):
        summary("3 claims of the paper: confirmed (3)")
        return [folder / "index.html"]

    monkeypatch.setattr("rocking.papers.report.reproduce.reproduce", nothing)
    told = ["wrote 1 file into made", "3 claims of the paper: confirmed (3); open made/index.html"]
    assert rocking("paper --output made")[2].splitlines() == told


@pytest.mark.parametrize(
    "error, why",
    [
        (MemoryError(), "no more memory can be allocated"),
        (MemoryError("Unable to allocate 8. TiB"), "Unable to allocate 8. TiB"),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), "[Errno 12] Cannot allocate memory"),
        (RuntimeError("can't start new thread"), "can't start new thread"),
    ],
)
def test_lack_of_memory_or_of_threads_is_one_line_with_the_remedy(rocking, tmp_path, monkeypatch, error, why):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("rocking.cli.output.write_csv", fail)
    code, message, out = rocking(f"simulate {NORMALISED} --csv a.csv")
    assert (code, out) == (2, "")
    assert message == (
        f"the memory or the threads that this process may use do not suffice: {why} (reduce the numbers of points, samples or "
        "cycles, or raise the limits, such as those of ulimit -v and ulimit -u)"
    )
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("limit", [1 << 30, resource.RLIM_INFINITY])
def test_library_that_fails_without_a_reason_lacks_memory_only_if_that_is_limited(monkeypatch, limit):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, limit))
    code, message = refused(SystemError("error return without exception set"))
    assert (code, message == NO_MEMORY) == ((1, False) if limit == resource.RLIM_INFINITY else (2, True))


def test_command_without_memory_for_its_message_prints_one(rocking, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    monkeypatch.setattr("rocking.cli.output.write_csv", fail)
    monkeypatch.setattr("rocking.cli.main.lacking", fail)
    assert rocking(f"simulate {NORMALISED} --csv a.csv")[:2] == (2, NO_MEMORY)


@pytest.mark.parametrize("megabytes", [200])
def test_limit_of_memory_that_libraries_do_not_fit_in_is_one_line_with_the_remedy(megabytes, tmp_path):
    limited = f"""
import resource
from rocking.cli.main import main

resource.setrlimit(resource.RLIMIT_AS, ({megabytes << 20}, {megabytes << 20}))
main()
"""
    line = ["map", "--amplitude", "0:6:5", "--period", "1:2:5", "--restitution", "0.9", "--max-cycles", "10"]
    done = subprocess.run(
        [sys.executable, "-c", limited, *line], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(r"rocking: the memory or the threads [^\n]*ulimit -u\)\n", done.stderr), done.stderr


def test_piped_output_has_no_colours_and_no_greek_letters_in_ascii_and_errors_go_to_stderr():
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [*COMMAND, "simulate", *SI.split()], capture_output=True, env=environment, check=True
    )
    assert b"\x1b" not in done.stdout
    assert b"m/s?" in done.stdout
    assert done.stderr == b""
    done = subprocess.run(
        [*COMMAND, "simulate", "--amplitude", "2"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("rocking: missing --period and --restitution")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("terminal", [True, False])
def test_logged_error_is_one_line_with_its_exception_on_a_terminal(monkeypatch, capsys, terminal):
    log = logging.getLogger("rocking")
    monkeypatch.setattr(log, "handlers", [])
    monkeypatch.setattr(log, "level", logging.NOTSET)
    monkeypatch.setattr(sys, "argv", ["rocking", "--version"])
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    with pytest.raises(SystemExit):
        main()
    log.info("not shown")
    log.warning("the job %r is slow", "read")
    log.getChild("explorer").error("the job %r failed", "read", exc_info=ValueError("so\nsad"))
    told = "rocking: the job 'read' is slow\nrocking: the job 'read' failed: ValueError: so sad\n"
    assert capsys.readouterr().err == told * terminal


def test_reader_that_leaves_early_is_no_error_message():
    with subprocess.Popen([*COMMAND, "cite"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""


@pytest.mark.parametrize("closing", [">&-", "2>&-"])
def test_output_that_was_closed_before_is_no_error(closing):
    done = subprocess.run(
        ["/bin/sh", "-c", f'exec "$@" {closing}', "sh", *COMMAND, "cite"], capture_output=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert bool(done.stdout) == (closing == "2>&-")


def test_interrupted_run_says_so_and_leaves_no_file(tmp_path):
    line = f"simulate {NORMALISED} --cycles 100000 --csv motion.csv"
    process = subprocess.Popen(
        [*COMMAND, *line.split()], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    while process.poll() is None and not list(tmp_path.iterdir()):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out, err) == (130, b"", b"rocking: interrupted\n")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "line",
    [
        "classify --amplitude 10.103037 --period 1.721328 --restitution 0.8 --max-cycles 1e8",
        "orbit-diagram --amplitude 7:10:1000 --period 1 --restitution 0.9 --transient 1e6",
    ],
)
def test_interrupted_computation_says_so_and_leaves_no_file(interrupted, tmp_path, line):
    assert interrupted(f"{line} --plot a.png", 1.5) == (130, b"", b"rocking: interrupted\n")
    assert not list(tmp_path.iterdir())


def test_interrupt_while_a_library_evaluates_a_text_has_the_same_exit_code(tmp_path):
    program = """
import signal
from rocking.cli import main
def interrupted():
    try:
        eval("signal.raise_signal(signal.SIGINT)")
    except KeyboardInterrupt:
        return 130, ""
main.run = interrupted
main.main()
"""
    (tmp_path / "stopped.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "-m", "stopped"], cwd=tmp_path, capture_output=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (130, b"rocking: interrupted\n")


def test_who_interrupts_a_picture_is_told_that_the_store_is_complete(rocking, monkeypatch, capsys):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("rocking.cli.output.draw", interrupt)
    line = "map --amplitude 1:2:3 --period 1:2:3 --restitution 0.9 --max-cycles 20 --store map.zarr --plot map.png"
    monkeypatch.setattr("sys.argv", ["rocking", *line.split()])
    assert run()[0] == 130
    told = "rocking: --store 'map.zarr' is complete; repeat the command to write the remaining files\n"
    assert capsys.readouterr().err == told


def test_run_in_a_terminal_shows_a_bar_on_stderr(terminal, monkeypatch):
    line = "--amplitude 10.4:11.5:12 --period 1.721328 --restitution 0.8 --transient 50 --cycles 4"
    monkeypatch.setattr("sys.argv", ["rocking", "orbit-diagram", *line.split()])
    assert run() == (0, "")
    assert re.fullmatch(r"\[#{20}\] orbit diagram 100 % in 0:00:\d\d", terminal()[-1])


def test_port_in_use_is_told_with_the_way_out(rocking):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        code, message, _ = rocking(f"explore --no-browser --port={port}")
    assert code == 2
    assert message.startswith(f"cannot listen on --port {port}: ")
    assert message.endswith("(give another port, or --port 0 for a free one)")


def test_control_c_ends_what_is_served_quietly_and_is_no_failure():
    command = [*COMMAND, "explore", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().startswith("http://localhost:")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (0, "", "")


def test_browser_is_started_without_the_token_in_its_arguments_which_all_users_see(tmp_path):
    told, browser = tmp_path / "told", tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$@" > {told}.partial\nmv {told}.partial {told}\n')
    browser.chmod(0o700)
    command = [*COMMAND, "explore", "--port", "0"]
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
