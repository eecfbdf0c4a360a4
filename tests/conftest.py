"""Common to all tests: the report on the paper, made once, samples that --exhaustive replaces, and times per test."""

import os
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

import numpy as np
import psutil
import pytest

TIMES = Path(__file__).parents[1] / "build" / "test-times.tsv"
REPORTED = threading.Event()


class Reproduced(NamedTuple):
    """Report as `make reproduce` writes it: folder and files written."""

    folder: Path
    paths: Sequence[Path]


@pytest.fixture(scope="session")
def reproduced(tmp_path_factory):
    from rocking.papers.catalogue import YIM_LIN_1991
    from rocking.papers.report.reproduce import reproduce

    folder = tmp_path_factory.mktemp("figures") / "made" / "here"
    return Reproduced(folder, reproduce(YIM_LIN_1991, folder))


def pytest_addoption(parser):
    what = "run only the tests that check a sample, and let them check the whole"
    parser.addoption("--exhaustive", action="store_true", help=what)
    what = "run only the tests of a part of the files: K/N, with K from 0 to N - 1"
    parser.addoption("--part", default="0/1", metavar="K/N", help=what)


@pytest.fixture
def thin(request):
    """Take ``count`` of some items, evenly spread, or at random with a printed seed; with --exhaustive all."""

    def take(items, count, seed=None):
        if request.config.getoption("exhaustive"):
            print(f"all {len(items)}")
            return items
        if seed is None:
            return items[:: max(len(items) // count, 1)]
        print(f"{count} of {len(items)}, seed {seed}")
        return [items[k] for k in np.random.default_rng(seed).choice(len(items), count, replace=False)]

    return take


@pytest.hookimpl(tryfirst=True)  # before items are selected and grouped by their marks
def pytest_collection_modifyitems(config, items):
    """Mark the tests of the whole report as long. Let one worker run the tests of a file. Select those of --part and of --exhaustive."""
    for item in items:
        if "reproduced" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group("reproduced"))
            item.add_marker(pytest.mark.long)
            item.add_marker(pytest.mark.timeout(1200))
        elif not item.get_closest_marker("xdist_group"):  # what the tests of a file share is made once
            item.add_marker(pytest.mark.xdist_group(item.path.name))
    part, parts = map(int, config.getoption("part").split("/"))
    # With this number before the names, the four quarters of the long tests take about the same time.
    chosen = [item for item in items if crc32(f"470{item.path.name}".encode()) % parts == part]
    if config.getoption("exhaustive"):
        chosen = [item for item in chosen if "thin" in getattr(item, "fixturenames", ())]
    kept = set(chosen)
    config.hook.pytest_deselected(items=[item for item in items if item not in kept])
    items[:] = chosen


def pytest_sessionstart(session):
    """Begin the file of times, to which the worker processes append, and show that tests are collected."""
    if not hasattr(session.config, "workerinput"):
        TIMES.parent.mkdir(exist_ok=True)
        TIMES.write_text("wall/s\tprocessor/s\ttest\n", encoding="utf-8")
        threading.Thread(target=show_collection, args=[time.monotonic()], daemon=True).start()


def show_collection(start):
    """Print a line every three seconds until the first test has ended."""
    while not REPORTED.wait(3.0):
        print(f"collecting the tests: {time.monotonic() - start:.0f} s", file=sys.__stderr__, flush=True)


def pytest_runtest_logreport():
    REPORTED.set()


def pytest_sessionfinish():
    REPORTED.set()


def pytest_keyboard_interrupt():
    """End the worker processes, and all processes that tests have started: servers and browsers would stay."""
    for process in psutil.Process().children(recursive=True):
        with suppress(psutil.NoSuchProcess):
            process.kill()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Write the wall time and the processor time of a test, its fixtures and its processes included."""
    wall, processor = time.perf_counter(), sum(os.times()[:4])
    result = yield
    wall, processor = time.perf_counter() - wall, sum(os.times()[:4]) - processor
    line = f"{wall:.3f}\t{processor:.3f}\t{item.nodeid}\n"
    with TIMES.open("a", encoding="utf-8") as times:
        times.write(line)  # in one piece: lines of several processes do not mix
    return result
