"""All executors give bit-identical results, with any number of workers, also if one of them is killed."""

import multiprocessing
import os
import signal
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest
from distributed import Client, LocalCluster

import rocking as rk

ASKED = {
    "amplitude": np.linspace(0.0, 16.0, 150),
    "period": np.linspace(0.2, 3.0, 150),
    "restitution": 1.0,
    "max_cycles": 100,
}


def files(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The store of threads on all cores."""
    folder = tmp_path_factory.mktemp("whole") / "map.zarr"
    rk.parametric_map(**ASKED, store=folder)
    return files(folder)


@pytest.fixture
def cluster():
    """Two workers that are processes of their own, reached over loopback."""
    with (
        LocalCluster(
            2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None
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
def test_any_number_of_threads_in_any_order_gives_the_same_bytes(make, tmp_path, whole):
    with make() as executor:
        rk.parametric_map(**ASKED, store=tmp_path / "map.zarr", executor=executor)
    assert files(tmp_path / "map.zarr") == whole


def test_processes_give_the_same_bytes(tmp_path, whole):
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as executor:
        rk.parametric_map(**ASKED, store=tmp_path / "map.zarr", executor=executor)
    assert files(tmp_path / "map.zarr") == whole


def test_cluster_gives_the_same_bytes_though_a_worker_is_killed(cluster, tmp_path, whole):
    folder = tmp_path / "map.zarr"
    first = min(worker["pid"] for worker in cluster.run(_pid).values())
    killed = []

    def kill():
        while not (folder / "level-0" / "cycles" / "c").exists():
            time.sleep(0.01)
        os.kill(first, signal.SIGKILL)
        killed.append(first)

    killer = threading.Thread(target=kill)
    killer.start()
    rk.parametric_map(**ASKED, store=folder, executor=cluster.get_executor())
    killer.join()
    assert killed == [first]
    assert files(folder) == whole


def _pid():
    return {"pid": os.getpid()}


def _die(*_):
    os.kill(os.getpid(), signal.SIGKILL)


def test_pool_that_lost_a_worker_ends_the_run_and_another_goes_on(tmp_path, whole, monkeypatch):
    folder = tmp_path / "map.zarr"
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
        executor.submit(_die)
        with pytest.raises(BrokenProcessPool):
            rk.parametric_map(**ASKED, store=folder, executor=executor)
    rk.parametric_map(**ASKED, store=folder)
    assert files(folder) == whole
