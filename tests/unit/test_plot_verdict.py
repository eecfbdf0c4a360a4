"""Figure of a verdict: the response, its section with the orbit, and the complete evidence."""

from itertools import combinations

import numpy as np
import pytest
from attrs import evolve
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb

import rocking as rk
from drawn import artists
from rocking.plot.palette import COLOURS


def system(amplitude, period, restitution, phase=0.0, braces=None):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)


CASES = {
    "periodic": (system(2.0, 1.0, 0.925), None),
    "period 10": (system(5.5, 0.5, 0.925, phase=1.8), rk.State(velocity=0.15)),
    "quasi-periodic": (system(4.0, 0.4, 1.0), None),
    "chaotic": (system(15.0, 2.0, 0.925, braces=rk.Braces(1.0)), None),
    "chatter": (system(1.0111, 4.7531, 0.925), None),
    "leaves the braces": (system(4.0, 3.0, 0.5, braces=rk.Braces(0.2, 0.0)), None),
    "overturned": (system(1.75, 2.0, 0.95), None),
    "rest": (system(0.5, 1.0, 0.9), None),
    "decay": (system(0.0, 1.0, 0.9), rk.State(0.5)),
    "undetermined": (system(6.0, 1.0, 0.01), None),
}


def verdict_of(name):
    return rk.classify(*CASES[name])


def artists_of(figure, gid):
    return [each for ax in figure.axes for each in artists(ax, gid)]


@pytest.mark.parametrize("name", CASES)
def test_evidence_stands_above_in_full_and_nothing_overlaps(name):
    verdict = verdict_of(name)
    figure = rk.plot.verdict(verdict)
    FigureCanvasAgg(figure).draw()
    assert " ".join(figure.get_suptitle().split()) == str(verdict)
    boxes = [ax.get_tightbbox() for ax in figure.axes] + [figure._suptitle.get_window_extent()]
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert all(figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 + 1 for box in boxes)
    assert len(figure.axes) == (2 if verdict.kind in ("overturned", "rest") else 3)


def notes(figure):
    return [ax.get_title(loc=place) for ax in figure.axes for place in ("left", "right")]


@pytest.mark.parametrize(
    "name", ["periodic", "period 10", "chatter", "leaves the braces", "quasi-periodic", "chaotic"]
)
def test_run_that_is_drawn_agrees_with_the_verdict(name):
    assert "the run shown ends differently" not in notes(rk.plot.verdict(verdict_of(name)))


def test_a_note_says_where_the_run_that_is_drawn_contradicts_the_verdict():
    """As after a chaotic transient, which `simulate` and `classify` may leave in different cycles: other starts stand for that."""
    beside, chaotic = system(10.103037, 1.721328, 0.8), rk.State()
    periodic = rk.simulate(system(10.0, 1.721328, 0.8), cycles=1_000).final
    verdicts = {
        kind: rk.classify(beside, start, max_cycles=20_000)
        for kind, start in (("chaotic", chaotic), ("periodic", periodic))
    }
    assert [str(verdict.kind) for verdict in verdicts.values()] == ["chaotic", "periodic"]
    for kind, start in (("chaotic", periodic), ("periodic", chaotic)):
        drawn = rk.plot.verdict(evolve(verdicts[kind], start=start))
        assert notes(drawn).count("the run shown ends differently") == 1


@pytest.mark.parametrize("name", ["periodic", "period 10"])
def test_last_cycles_repeat_themselves_and_are_those_of_the_orbit(name):
    verdict = verdict_of(name)
    (history,) = (child for child in artists_of(rk.plot.verdict(verdict), "motion")[:1])
    time, angle = history.get_data()
    period = verdict.period * verdict.system.forcing.period
    first = np.interp(time[time < period], time, angle)
    again = np.interp(time[time < period] + period, time, angle)
    # what is left of the transient, and chords between samples
    assert abs(first - again).max() < 2e-3 * verdict.steady_peak
    assert abs(angle).max() == pytest.approx(verdict.steady_peak, abs=2e-4)


@pytest.mark.parametrize("name", ["periodic", "period 10", "chatter", "leaves the braces"])
def test_rings_mark_every_point_of_the_orbit_and_the_way_ends_there(name):
    verdict = verdict_of(name)
    figure = rk.plot.verdict(verdict)
    (rings,), (points,) = artists_of(figure, "orbit"), artists_of(figure, "section")
    rings, points = np.array(rings.get_data()).T, np.array(points.get_data()).T
    assert len(rings) == verdict.period
    nearest = np.hypot(*(rings[:, None] - points[-verdict.period :]).transpose(2, 0, 1)).min(axis=1)
    assert nearest.max() < 0.1 * max(np.ptp(points[:, 0]), 1e-9)


def test_section_of_what_has_no_orbit_is_that_of_the_response():
    figure = rk.plot.verdict(verdict_of("quasi-periodic"))
    assert not artists_of(figure, "orbit")
    (points,) = artists_of(figure, "section")
    assert len(points.get_xdata()) == 5_001


def test_block_gives_si_axes():
    figure = rk.plot.verdict(verdict_of("periodic"), rk.Block(height=2.0, width=0.5))
    history, *others = figure.axes
    assert history.get_xlabel().endswith("(s)")
    assert [ax.get_xlabel()[-4:] for ax in others] == [" (°)"] * 2


def test_motion_with_too_many_events_is_named_instead_of_drawn(monkeypatch):
    verdict = verdict_of("periodic")
    monkeypatch.setattr("rocking.motion.march_loop.MAX_RECORDED", 3)
    figure = rk.plot.verdict(verdict)
    assert [ax.texts[0].get_text() for ax in figure.axes[:2]] == ["too many events to draw"] * 2


def test_band_has_the_colour_of_the_kind():
    for name in ("periodic", "overturned"):
        verdict = verdict_of(name)
        (band,) = (artist for artist in rk.plot.verdict(verdict).get_children() if artist.get_gid() == "kind")
        assert band.get_facecolor()[:3] == to_rgb(COLOURS[verdict.kind])
