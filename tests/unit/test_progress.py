"""Progress by cost: what a log, a terminal and a notebook show, with a clock that the tests move."""

import io
import sys
from types import SimpleNamespace

import pytest

from rocking.model import progress
from rocking.model.progress import Bar


class Named:
    """Step with the name of another one."""

    def __init__(self, name):
        self.name = name

    def __str__(self):
        return self.name


class Clock:
    """Clock that stands until it is moved."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    """Return a clock; the thread of a bar never looks at it, so that a test decides when."""
    monkeypatch.setattr(progress, "LOOK", 1e6)
    return Clock()


def run(bar, clock, seconds, step=0.25):
    """Move the clock and let the bar look at it, as its thread does."""
    for _ in range(round(seconds / step)):
        clock.now += step
        bar.tick()


def in_log(capsys, bar, clock, seconds):
    """Return the times at which lines are written to a log, and the lines."""
    found = []
    for _ in range(round(seconds / 0.25)):
        run(bar, clock, 0.25)
        found += [(clock.now - 100.0, line) for line in capsys.readouterr().err.splitlines()]
    return found


def test_log_of_steps_has_a_line_at_least_every_three_seconds(capsys, clock):
    with Bar(600.0, title="report", in_seconds=True, clock=clock) as bar:
        assert capsys.readouterr().err == "report\n"
        bar.begin("long", 500.0)
        times, lines = zip(*in_log(capsys, bar, clock, 300.0), strict=True)
    assert max(b - a for a, b in zip((0.0, *times), (*times, 300.0), strict=True)) <= 3.0
    assert len(lines) <= 120
    assert all(line.endswith(": long") for line in lines)


def test_log_of_points_has_fewer_lines_after_a_minute(capsys, clock):
    with Bar(1e6, unit="points", clock=clock) as bar:
        times = [time for time, _ in in_log(capsys, bar, clock, 300.0)]
    gaps = [b - a for a, b in zip((0.0, *times), times, strict=False)]
    assert max(gaps[:20]) <= 3.0
    assert set(gaps[24:]) == {10.0}


def test_log_has_no_line_about_short_work_and_the_title_stands_above_the_first(capsys, clock):
    for seconds, written in ((2.0, []), (4.0, ["title", "0 %", "100 % in 0:00:04"])):
        with Bar(10, title="title", clock=clock) as bar:
            run(bar, clock, seconds)
            bar.advance(10)
        assert capsys.readouterr().err.splitlines() == written


def test_percent_follows_cost_not_number(capsys, clock):
    with Bar(100.0, in_seconds=True, clock=clock) as bar:
        for number in range(10):
            bar.begin(number, 1.0)
            clock.now += 1.0
            bar.end(number)
        assert bar.state()[0] == "10 %, 0:01:30 left"
        bar.begin("last", 90.0)
        clock.now += 45.0
        assert bar.state()[0] == "55 %, 0:00:45 left: last"


def test_steps_beside_each_other_count_and_are_named(clock):
    with Bar(80.0, in_seconds=True, shown=False, clock=clock) as bar:
        bar.begin("figure 8", 40.0)
        bar.begin("Conclusion 3", 40.0)
        clock.now += 20.0
        assert bar.state() == ("50 %, 0:00:20 left: figure 8, Conclusion 3", 0.5)
        clock.now += 20.0
        bar.end("figure 8")
        assert bar.state()[0] == "95 %, 0:00:02 left: Conclusion 3"


def test_slow_machine_lowers_the_speed_and_no_step_counts_as_done_before_its_end(clock):
    with Bar(40.0, in_seconds=True, shown=False, clock=clock) as bar:
        bar.begin("first", 20.0)
        parts = []
        for _ in range(100):
            clock.now += 1.0
            parts.append(bar.state()[1])
        assert parts == sorted(parts)
        assert 0.4 < parts[-1] < 0.5
        bar.end("first")
        bar.begin("second", 20.0)
        assert bar.state()[0].startswith("50 %, 0:01:40 left")
        clock.now += 40.0
        assert 0.6 < bar.state()[1] < 0.75


def test_end_of_a_late_step_does_not_send_the_bar_back_and_equal_names_stand_once(clock):
    with Bar(100.0, in_seconds=True, shown=False, clock=clock) as bar:
        bar.begin("claims", 30.0)
        bar.begin(Named("claims"), 10.0)
        late = next(step for step in bar.estimate.running if step != "claims")
        clock.now += 40.0
        text, before = bar.state()
        bar.end(late)
        assert bar.state()[1] >= before > 0.3
        assert text.endswith("left: claims")


def test_part_does_not_stand_near_the_end_if_the_last_points_cost_most(clock):
    with Bar(100, shown=False, clock=clock) as bar:
        for _ in range(98):
            clock.now += 0.1
            bar.advance(1)
        assert bar.state()[0] == "98 %, 0:00:00 left"
        clock.now += 100.0
        assert 0.6 < bar.state()[1] < 0.75
        bar.advance(2)
        assert bar.state() == ("100 % in 0:01:50", 1.0)


def test_rate_is_that_of_points_of_this_run_and_steps_have_none(clock):
    with Bar(1_000, unit="points", shown=False, clock=clock) as bar:
        bar.advance(600, before=True)
        assert bar.state()[0] == "60 %"
        clock.now += 10.0
        bar.advance(200)
        assert bar.state()[0] == "80 %, 0:00:10 left, 20 points/s"
    with Bar(10.0, in_seconds=True, shown=False, clock=clock) as bar:
        bar.begin("step", 5.0)
        clock.now += 1.0
        bar.end("step")
        assert "/s" not in bar.state()[0]


def test_terminal_shows_one_line_that_is_replaced(terminal, capsys, clock):
    with Bar(4, "work", title="title", clock=clock) as bar:
        clock.now += 1.0
        bar.advance(1)
        bar.tick()
        assert capsys.readouterr().err == ("title\n\r\x1b[K[#####               ] work 25 %, 0:00:03 left")
        bar.advance(3)
    assert terminal() == ["[####################] work 100 % in 0:00:01"]


def test_line_is_no_longer_than_the_terminal_is_wide(terminal, monkeypatch, clock):
    monkeypatch.setenv("COLUMNS", "30")
    with Bar(4, "work", clock=clock) as bar:
        bar.advance(4)
        bar.text = "periodic 90 %, overturned 10 %"
    assert terminal() == ["[####################] work 1"]


def test_computation_of_unknown_length_shows_its_time_and_leaves_nothing_in_a_terminal(
    terminal, capsys, clock
):
    with Bar(what="computing", clock=clock) as bar:
        run(bar, clock, 2.0)
        assert capsys.readouterr().err == ""
        run(bar, clock, 2.0)
        assert "computing 0:00:03" in capsys.readouterr().err
    assert capsys.readouterr().err == "\r\x1b[K"


def test_inner_bar_is_shown_instead_of_the_outer_one(capsys, clock):
    with Bar(what="outer", clock=clock) as outer:
        with Bar(2, "inner", clock=clock) as inner:
            run(outer, clock, 4.0)
            inner.tick()
        run(outer, clock, 4.0)
    assert [line.split()[0] for line in capsys.readouterr().err.splitlines()] == [
        "inner",
        "inner",
        "outer",
        "outer",
    ]


def test_failure_leaves_the_last_progress_in_a_terminal_and_nothing_in_a_log(capsys, monkeypatch, clock):
    def fail():
        with Bar(4, "work", clock=clock) as bar:
            bar.advance(1)
            raise ValueError

    with pytest.raises(ValueError, match="^$"):
        fail()
    assert capsys.readouterr().err == ""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with pytest.raises(ValueError, match="^$"):
        fail()
    assert capsys.readouterr().err.endswith("work 25 %, 0:00:00 left\n")


def test_terminal_without_cursor_control_gets_lines(terminal, capsys, monkeypatch, clock):
    monkeypatch.setenv("TERM", "dumb")
    with Bar(4, "work", clock=clock) as bar:
        run(bar, clock, 3.0)
    assert "\x1b" not in capsys.readouterr().err


def test_notebook_gets_one_output_that_changes(monkeypatch, capsys, clock):
    shown = []
    handle = SimpleNamespace(update=lambda text, raw: shown.append((text, raw)))

    def display(text, raw, display_id):
        shown.append((text, raw))
        return handle if display_id else None

    shell = SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display))
    with Bar(4, title="title", clock=clock) as bar:
        clock.now += 1.0
        bar.advance(2)
        bar.tick()
        bar.advance(2)
    assert shown == [
        ({"text/plain": "title\n[##########          ] 50 %, 0:00:01 left"}, True),
        ({"text/plain": "title\n[####################] 100 % in 0:00:01"}, True),
    ]
    assert capsys.readouterr() == ("", "")


def test_ipython_in_a_terminal_is_a_terminal(terminal, monkeypatch, clock):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=SimpleNamespace))
    with Bar(4, clock=clock) as bar:
        bar.advance(4)
    assert terminal() == ["[####################] 100 % in 0:00:00"]


def test_work_goes_on_without_stderr_and_with_one_that_nobody_reads(monkeypatch, clock):
    closed = io.StringIO()
    closed.close()
    for stream in (None, closed):
        monkeypatch.setattr(sys, "stderr", stream)
        with Bar(4, clock=clock) as bar:
            run(bar, clock, 4.0)
            bar.advance(4)
        assert bar.estimate.done == 4


def test_characters_that_a_log_lacks_become_question_marks(monkeypatch, clock):
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(written, "ascii"))
    with Bar(4, title="Θ", in_seconds=True, clock=clock):
        pass
    assert written.getvalue() == b"?\n"
