"""Reports during a survey: predicted cost and progress."""

import re
import threading
from concurrent.futures import Future

import numpy as np
import pytest

import rocking as rk
from rocking.model.progress import Bar
from rocking.model.text import percent
from rocking.survey import run_survey
from rocking.survey.run_survey import count_when_done
from surveyed import system_with

ASKED = {
    "system": system_with(restitution=0.9),
    "amplitude": np.linspace(0.0, 16.0, 80),
    "period": np.linspace(0.2, 3.0, 80),
    "max_cycles": 40,
}


def test_bar_says_the_cost_and_ends_with_the_shares(terminal, tmp_path):
    found = rk.parametric_map(**ASKED, progress=True, store=tmp_path / "map.zarr").dataset
    title, last = terminal()
    assert re.fullmatch(r"6,400 points in 13 tiles, (about|more than) [\d.]+ s on \d+ cores?", title)
    assert re.match(r"\[#{20}\] 100 % in 0:00:\d\d, [\d,]+ points/s: ", last)
    shares = [float((found.kind == number).mean()) for number in range(6)]
    for kind, share in zip(rk.Kind, shares, strict=True):
        assert (f"{kind} {percent(share)}" in last) == (share > 0)


def test_what_an_earlier_run_did_counts_as_done(terminal, tmp_path):
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr", progress=True)
    title, last = terminal()
    assert "6,400 points in 13 tiles, 6,400 of them computed before, about 0 s on" in title
    assert re.match(r"\[#{20}\] 100 % in 0:00:\d\d: .*periodic", last)


def test_nothing_is_said_unless_asked_for(capsys):
    rk.parametric_map(**ASKED)
    assert capsys.readouterr() == ("", "")


def test_log_holds_nothing_about_a_short_survey(capsys):
    rk.parametric_map(**ASKED | {"amplitude": [1.0, 2.0]}, progress=True)
    assert capsys.readouterr() == ("", "")


def test_sample_that_takes_too_long_gives_a_lower_bound(terminal, monkeypatch):
    monkeypatch.setattr(run_survey, "MAX_SECONDS", 0.0)
    asked = ASKED | {"system": system_with(restitution=1.0), "max_cycles": 10_000}
    rk.parametric_map(**asked, progress=True)
    title, _ = terminal()
    assert ", more than " in title


def test_points_count_when_their_batch_ends():
    bar = Bar(30, shown=False)
    done, failed, cancelled = Future(), Future(), Future()
    with bar:
        for batch in (done, failed, cancelled):
            count_when_done(bar, batch, 10)
        assert bar.estimate.done == 0
        failed.set_exception(ValueError())
        cancelled.cancel()
        done.set_result({})
    assert bar.estimate.done == 10


def test_bifurcation_set_shows_its_curves(terminal):
    system = rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9)
    rk.bifurcation_set(system, 1, grid=2, period=(1.5, 2.5), amplitude=(3.0, 12.0), progress=True)
    (last,) = terminal()
    assert re.fullmatch(r"\[#{20}\] bifurcation set 100 % in 0:00:\d\d: 2 curves", last)


def test_thread_of_a_bar_ends_with_the_work(terminal):
    rk.parametric_map(**ASKED, progress=True)
    assert "progress" not in {thread.name for thread in threading.enumerate()}


RECORDS = rk.synthetic_ground_motions(3, seed=1, duration=5.0)
SYSTEM = system_with(amplitude=0.5, restitution=0.9)


@pytest.mark.parametrize(
    "what, survey",
    [
        ("5 points in 1 tile, ", lambda shown: rk.chaos_share(SYSTEM, samples=5, progress=shown)),
        ("5 points in 1 tile, ", lambda shown: rk.repeatability(SYSTEM, samples=5, progress=shown)),
        (
            "6 points in 1 tile, ",
            lambda shown: rk.overturning_set(
                RECORDS, rk.Block(2.0, 0.5), [1.0, 2.0], progress=shown, model="slender"
            ),
        ),
        (
            "36 points in 1 tile, ",
            lambda shown: rk.sensitivity(
                RECORDS, rk.Block(2.0, 0.5), [1.0, 2.0], progress=shown, model="slender"
            ),
        ),
        (
            "2 points in 1 tile, ",
            lambda shown: rk.response_diagram(SYSTEM, amplitude=[0.4, 0.5], progress=shown),
        ),
        ("orbit diagram", lambda shown: rk.orbit_diagram(SYSTEM, amplitude=[0.4, 0.5], progress=shown)),
    ],
)
def test_every_survey_shows_its_progress_if_requested(terminal, what, survey):
    survey(False)
    assert terminal() == [""]
    survey(True)
    *title, last = terminal()
    assert what in (title or [last])[0]
    assert " 100 % in " in last
    with pytest.raises(TypeError, match="^progress must be a bool; got 1"):
        survey(1)
