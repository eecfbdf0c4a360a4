"""Surveys that are killed, interrupted, run twice at once or out of disk space keep all stored results."""

import os
import shutil
import signal
import subprocess
import sys
import time
import warnings
from collections import deque
from concurrent.futures import Future
from pathlib import Path
from threading import Timer
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from rocking.survey.run_survey import Pending, _settle
from rocking.survey.store_access import defer_interrupt
from stored_surveys import ALL, SURVEYS, chunks, files

# No thread begins here: then every run may be a fork of this process.
BEGIN = f"""
import os, random, resource, signal, sys, time

sys.path.insert(0, {str(Path(__file__).parents[1])!r})
import xarray, zarr
from stored_surveys import SURVEYS

survey, folder = SURVEYS[sys.argv[1]], sys.argv[2]
"""
KILLED = f"""
import os, random, shutil, signal, sys, time

sys.path.insert(0, {str(Path(__file__).parents[1])!r})
from stored_surveys import ALL

(survey, arguments), folder, takes = ALL[sys.argv[1]], sys.argv[2], float(sys.argv[3])
moment, killed = random.Random(1991), 0
while killed < 5:
    child = os.fork()
    if child == 0:
        survey(**arguments, store=folder)
        os._exit(0)
    time.sleep(moment.uniform(0.0, takes))
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    killed += os.WIFSIGNALED(status)
    if not os.WIFSIGNALED(status):
        shutil.rmtree(folder)  # it was quicker than its death: begin again
print(killed)
"""
FULL = (
    BEGIN
    + """
resource.setrlimit(resource.RLIMIT_FSIZE, (survey.limit, survey.limit))
try:
    survey.run(folder, **survey.uneven)
except OSError as error:
    print(error)
"""
)
RUN = (
    BEGIN
    + """
print("running", flush=True)
survey.run(folder, max_cycles=20_000)
"""
)


def ran(script, name, folder, *more):
    return subprocess.run(
        [sys.executable, "-c", script, name, folder, *more],
        capture_output=True,
        text=True,
        timeout=200,
        check=False,
    )


@pytest.fixture(scope="module", params=["map", pytest.param("ground-motions", marks=pytest.mark.long)])
def name(request):
    return request.param


@pytest.fixture(scope="module")
def whole(name, tmp_path_factory):
    """The store of a run that nothing disturbed."""
    folder = tmp_path_factory.mktemp("whole") / "survey.zarr"
    SURVEYS[name].run(folder)
    return folder


@pytest.mark.long
@pytest.mark.parametrize("each", ALL)
def test_every_survey_killed_five_times_gives_the_result_and_the_bytes_of_an_undisturbed_run(each, tmp_path):
    survey, arguments = ALL[each]
    begun = time.perf_counter()
    undisturbed = survey(**arguments, store=tmp_path / "undisturbed").to_xarray().load()
    done = ran(KILLED, each, tmp_path / "killed", str(0.8 * (time.perf_counter() - begun)))
    assert (done.stdout, done.stderr) == ("5\n", "")
    assert survey(**arguments, store=tmp_path / "killed").to_xarray().load().identical(undisturbed)
    assert files(tmp_path / "killed") == files(tmp_path / "undisturbed")


def test_run_killed_between_a_folder_and_its_first_file_is_gone_on_with_in_silence(name, tmp_path, whole):
    folder, survey = tmp_path / "survey.zarr", SURVEYS[name]
    shutil.copytree(whole, folder)
    for level in folder.glob("level-*"):
        shutil.rmtree(level / survey.other)
        (level / survey.other).mkdir()
        (level / survey.other / f"zarr.{'0123' * 8}.partial").touch()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        survey.run(folder, repair=True)
    assert files(folder) == files(whole)


def test_full_disk_is_said_and_what_was_written_stays_good(name, tmp_path):
    folder, undisturbed, survey = tmp_path / "survey.zarr", tmp_path / "undisturbed.zarr", SURVEYS[name]
    done = ran(FULL, name, folder)
    assert done.stdout == (
        f"store {str(folder)!r} cannot be written: File too large; "
        "existing data are unchanged (free some space, or give another path)\n"
    )
    written = chunks(folder, "level-0")
    survey.run(undisturbed, **survey.uneven)
    assert written == chunks(undisturbed, "level-0")
    survey.run(folder, **survey.uneven)
    assert files(folder) == files(undisturbed)


@pytest.fixture
def running(tmp_path):
    """A long run on a store, some of which is done."""
    folder = tmp_path / "map.zarr"
    with subprocess.Popen(
        [sys.executable, "-c", RUN, "map", folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "running\n"
        while not (folder / "level-0" / "cycles" / "c" / "0" / "0").exists():
            assert process.poll() is None
            time.sleep(0.02)
        yield folder, process
        process.kill()


def test_second_run_on_a_store_is_refused_until_the_first_is_gone(running):
    folder, process = running
    with pytest.raises(OSError, match="is in use by another run; wait until that run ends, or stop it$"):
        SURVEYS["map"].run(folder)
    assert process.poll() is None
    process.kill()
    process.wait()
    with pytest.raises(ValueError, match="max_cycles is 20000 there and 100 here"):
        SURVEYS["map"].run(folder)


def test_ctrl_c_waits_for_the_end_of_what_is_done_with_a_store():
    done = []

    @defer_interrupt()
    def write():
        signal.raise_signal(signal.SIGINT)
        done.append("all of it")

    with pytest.raises(KeyboardInterrupt):
        write()
    assert done == ["all of it"]
    with pytest.raises(KeyboardInterrupt):  # and does so no longer
        signal.raise_signal(signal.SIGINT)


def test_ctrl_c_is_heard_while_a_slow_batch_is_waited_for_beside_one_that_failed():
    slow, failed = Future(), Future()
    failed.set_exception(ValueError("failed"))
    tile = SimpleNamespace(shape=(2,), shared=lambda: None)
    pending = deque([Pending(tile, np.zeros(2, bool), [np.array([0]), np.array([1])], [slow, failed])])
    results = SimpleNamespace(measure=SimpleNamespace(blank=lambda _: {}))
    timers = [
        Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)),
        Timer(2.0, slow.set_exception, (ValueError("slow"),)),
    ]
    for timer in timers:
        timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            _settle(pending, results, None)
    finally:
        for timer in timers:
            timer.join()


def test_interrupted_run_ends_soon_and_says_how_to_go_on(running):
    folder, process = running
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=20)
    assert error.splitlines()[-2:] == [
        "KeyboardInterrupt",
        f"The survey was interrupted; completed tiles are in {str(folder)!r}; run it again to resume.",
    ]
    assert process.returncode == -signal.SIGINT
    kept = xr.open_zarr(folder, group="level-0", chunks=None, consolidated=False)
    assert (kept.cycles >= 0).all()


def test_interrupted_command_says_how_to_go_on_and_goes_on(tmp_path):
    line = [
        "map",
        "--amplitude",
        "0:16:150",
        "--period",
        "0.2:3:150",
        "--restitution",
        "1",
        "--store",
        "map.zarr",
        "--max-cycles",
    ]
    command = [sys.executable, "-m", "rocking", *line]
    with subprocess.Popen([*command, "20000"], cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        while not (tmp_path / "map.zarr" / "level-0" / "cycles" / "c" / "0" / "0").exists():
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=20)
    assert (process.returncode, error.splitlines()) == (
        130,
        [
            "rocking: The survey was interrupted; completed tiles are in 'map.zarr'; run it again to resume.",
            "rocking: interrupted",
        ],
    )
    done = subprocess.run([*command, "100"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "--max-cycles is 20000 there and 100 here" in done.stderr
