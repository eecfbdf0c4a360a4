"""All executors give bit-identical results, with any number of workers, also if one of them is killed."""

import multiprocessing
import os
import signal
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import pytest
from distributed import Client, LocalCluster

from stored_surveys import EVERY, SURVEYS, files


@pytest.fixture(scope="module", params=SURVEYS)
def survey(request):
    return SURVEYS[request.param]


@pytest.fixture(scope="module")
def whole(survey, tmp_path_factory):
    """The store of threads on all cores."""
    folder = tmp_path_factory.mktemp("whole") / "survey.zarr"
    survey.run(folder)
    return files(folder)


@pytest.fixture
def cluster():
    """Two workers that are processes of their own, reached over loopback."""
    with (
        LocalCluster(
            2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0"
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client


class Backwards(Executor):
    """Begins with what was submitted last: the order of the answers is not that of the questions."""

    def __init__(self):
        self.waiting = []

    def submit(self, function, /, *args):
        future = Future()
        self.waiting.append((future, function, args))
        threading.Timer(0.3, self.work).start()
        return future

    def work(self):
        while self.waiting:
            future, function, args = self.waiting.pop()
            future.set_result(function(*args))


@pytest.mark.parametrize("make", [lambda: ThreadPoolExecutor(1), lambda: ThreadPoolExecutor(5), Backwards])
def test_any_number_of_threads_in_any_order_gives_the_same_bytes(make, survey, tmp_path, whole):
    with make() as executor:
        survey.run(tmp_path / "survey.zarr", executor=executor)
    assert files(tmp_path / "survey.zarr") == whole


def test_processes_give_the_same_bytes(survey, tmp_path, whole):
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as executor:
        survey.run(tmp_path / "survey.zarr", executor=executor)
    assert files(tmp_path / "survey.zarr") == whole


@pytest.fixture(scope="module")
def processes():
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as executor:
        yield executor


@pytest.mark.parametrize("name", EVERY)
def test_processes_give_the_result_of_threads(name, processes):
    survey, arguments = EVERY[name]
    result = survey(**arguments, executor=processes).to_xarray()
    assert result.identical(survey(**arguments).to_xarray())


@pytest.mark.long
@pytest.mark.parametrize("name", EVERY)
def test_cluster_gives_every_survey_the_bytes_of_threads_though_a_worker_is_killed(name, cluster, tmp_path):
    survey, arguments = EVERY[name]
    plain = survey(**arguments, store=tmp_path / "threads").to_xarray().load()
    first = min(worker["pid"] for worker in cluster.run(_pid).values())
    killer = threading.Timer(0.1, os.kill, (first, signal.SIGKILL))
    killer.start()
    result = survey(**arguments, store=tmp_path / "cluster", executor=cluster)
    killer.join()
    assert result.to_xarray().load().identical(plain)
    assert files(tmp_path / "cluster") == files(tmp_path / "threads")


@pytest.mark.long
def test_cluster_gives_the_same_bytes_though_a_worker_is_killed(cluster, survey, tmp_path, whole):
    folder = tmp_path / "survey.zarr"
    first = min(worker["pid"] for worker in cluster.run(_pid).values())
    killed = []

    def kill():
        while not (folder / "level-0" / survey.marker / "c").exists():
            time.sleep(0.01)
        os.kill(first, signal.SIGKILL)
        killed.append(first)

    killer = threading.Thread(target=kill)
    killer.start()
    survey.run(folder, executor=cluster)
    killer.join()
    assert killed == [first]
    assert files(folder) == whole


def _pid():
    return {"pid": os.getpid()}


def _die(*_):
    os.kill(os.getpid(), signal.SIGKILL)


def test_pool_that_lost_a_worker_ends_the_run_and_another_goes_on(survey, tmp_path, whole):
    folder = tmp_path / "survey.zarr"
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
        executor.submit(_die)
        with pytest.raises(BrokenProcessPool):
            survey.run(folder, executor=executor)
    survey.run(folder)
    assert files(folder) == whole
