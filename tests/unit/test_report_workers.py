"""Steps of a report, in this process and in processes beside each other."""

import math
import operator
import os
import random
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rocking.model.progress import Bar
from rocking.papers.catalogue import PAPERS
from rocking.papers.report import workers
from rocking.papers.report.reproduce import steps_of
from rocking.papers.report.workers import Step, carry_out, shared

BOTH = pytest.mark.parametrize("cores", [1, 2], ids=["here", "two processes"])


@pytest.fixture
def limit(monkeypatch):
    """Set the number of cores; return the processes that are started."""
    started = []

    def use(cores):
        monkeypatch.setattr(workers, "cores", lambda: cores)
        start = subprocess.Popen
        monkeypatch.setattr(
            subprocess, "Popen", lambda *given, **how: started.append(start(*given, **how)) or started[-1]
        )
        return started

    return use


@BOTH
def test_results_have_the_order_of_the_steps(limit, cores):
    started = limit(cores)
    steps = [Step(f"root {number}", 1.0 + number % 3, math.sqrt, (number,)) for number in range(10)]
    with Bar(sum(step.cost for step in steps), in_seconds=True, shown=False) as bar:
        assert carry_out(steps, bar) == [math.sqrt(number) for number in range(10)]
        assert bar.state()[0].startswith("100 %")
    assert len(started) == (0 if cores == 1 else 2)
    assert [process.returncode for process in started] == [0] * len(started)


@pytest.mark.parametrize(
    "costs, cores, count",
    [((1.0, 1.0), 8, 0), ((100.0, 1.0), 8, 2), ((10.0,) * 9, 4, 4), ((5.0,), 8, 0), ((), 8, 0)],
)
def test_as_many_processes_start_as_pay_off(limit, costs, cores, count):
    started = limit(cores)
    with Bar(sum(costs), shown=False) as bar:
        carry_out([Step(str(number), cost, time.sleep, (0.05,)) for number, cost in enumerate(costs)], bar)
    assert len(started) == count


@BOTH
def test_error_has_its_type_and_names_the_step(limit, cores):
    started = limit(cores)
    steps = [Step("sum", 9.0, operator.add, (1, 1)), Step("share", 9.0, operator.truediv, (1, 0))]
    with Bar(18.0, shown=False) as bar, pytest.raises(ZeroDivisionError) as met:
        carry_out(steps, bar)
    assert met.value.__notes__ == ["in the step share of the report"]
    assert all(process.returncode is not None for process in started)


def test_end_of_a_process_is_an_error_of_its_step(limit):
    limit(2)
    steps = [Step("sum", 9.0, operator.add, (1, 1)), Step("gone", 9.0, os._exit, (7,))]
    with (
        Bar(18.0, shown=False) as bar,
        pytest.raises(RuntimeError, match="^a process ended with the code 7") as met,
    ):
        carry_out(steps, bar)
    assert met.value.__notes__ == ["in the step gone of the report"]


def test_error_that_cannot_be_sent_is_sent_as_its_text(limit):
    """UnicodeDecodeError takes five arguments, and a subclass without them cannot be rebuilt."""
    limit(2)
    code = "class Odd(Exception):\n    def __init__(self, a, b):\n        super().__init__('so odd')\nraise Odd(1, 2)"
    steps = [Step("sum", 9.0, operator.add, (1, 1)), Step("odd", 9.0, exec, (code, {}))]
    with Bar(18.0, shown=False) as bar, pytest.raises(RuntimeError, match="^Odd: so odd"):
        carry_out(steps, bar)


def test_interrupt_ends_the_processes(limit, monkeypatch):
    started = limit(2)

    def interrupt(*_, **__):
        while len(started) < 2:
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr(workers, "wait", interrupt)
    steps = [Step(str(number), 9.0, time.sleep, (600.0,)) for number in range(2)]
    with Bar(18.0, shown=False) as bar, pytest.raises(KeyboardInterrupt):
        carry_out(steps, bar)
    assert [process.returncode for process in started] == [0, 0]


@pytest.mark.long
def test_interrupted_report_ends_in_one_line_and_leaves_whole_files_only(interrupted, tmp_path):
    code, out, err = interrupted("paper --output made", 8.0)
    assert (code, out) == (130, b"")
    assert err.splitlines()[-1] == b"rocking: interrupted"
    assert b"Traceback" not in err
    assert not list(tmp_path.rglob(".*"))


def test_shared_result_is_computed_once_for_all_processes(tmp_path, monkeypatch):
    calls = []

    def compute(start, factor=1):
        calls.append(start)
        return factor * (start + random.random())

    monkeypatch.setattr(workers, "FOLDER", [tmp_path])
    found = shared(compute)(1, factor=2)
    assert shared(compute)(1, factor=2) == found  # as in another process, which has no cache yet
    assert shared(compute)(2) != found
    assert calls == [1, 2]
    assert len(list(tmp_path.iterdir())) == 2


def test_shared_result_that_failed_is_computed_again(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "FOLDER", [tmp_path])
    with pytest.raises(ZeroDivisionError):
        shared(operator.truediv)(1, 0)
    with pytest.raises(ZeroDivisionError):
        shared(operator.truediv)(1, 0)


def test_alone_a_process_keeps_no_shared_results():
    assert shared(math.sqrt)(4.0) == 2.0


@pytest.mark.parametrize("name", PAPERS)
def test_every_step_of_a_report_can_be_sent_and_the_costs_are_those_of_the_long_ones(name):
    paper = PAPERS[name]
    steps = [step for part in paper.names for step in steps_of(paper, part, Path("made"))]
    functions = [each for step in steps for each in (step.compute, *step.arguments) if callable(each)]
    assert all(getattr(sys.modules[each.__module__], each.__name__) is each for each in functions)
    costs = sorted(step.cost for step in steps)
    assert 0.0 < costs[0] < 0.1 < 1.0 < costs[-1]
