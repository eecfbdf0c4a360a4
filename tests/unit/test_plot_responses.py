"""Figures of responses: exponents, dimensions, spectra and verdicts, with their errors and their evidence."""

import itertools
import math
from itertools import combinations

import numpy as np
import pytest
from attrs import evolve
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb

import rocking as rk
from drawn import artist, artists, points
from rocking.plot.palette import COLOURS

# Convergence of an exponent.

BRACED = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0, 1.0))


@pytest.fixture(scope="module")
def exponents():
    return rk.lyapunov(BRACED, cycles=3_000)


@pytest.mark.parametrize("exponent", [1, 2])
def test_line_is_the_history_on_a_logarithmic_axis(exponents, exponent):
    ax = rk.plot.convergence(exponents, exponent=exponent)
    line = artist(ax, "running")
    np.testing.assert_array_equal(line.get_xdata(), exponents.history["cycles"])
    np.testing.assert_array_equal(line.get_ydata(), exponents.history["values"][:, exponent - 1])
    assert artist(ax, "final").get_ydata()[0] == exponents.values[exponent - 1]
    assert ax.get_xscale() == "log"
    assert ax.get_ylabel() == rf"exponent $\lambda_{exponent}$ per $\tau$"


def test_band_is_the_error_where_there_is_one(exponents):
    (path,) = artist(rk.plot.convergence(exponents), "error").get_paths()
    known = exponents.history[np.isfinite(exponents.history["errors"][:, 0])]
    corners = path.vertices[np.isfinite(path.vertices).all(axis=1)]
    assert corners[:, 0].min() == known["cycles"][0] > 300
    last = corners[corners[:, 0] == 3_000][:, 1]
    value, error = exponents.values[0], exponents.errors[0]
    assert (last.min(), last.max()) == pytest.approx((value - error, value + error), rel=1e-12, abs=0)


def test_title_gives_the_value_to_the_second_digit_of_its_error(exponents):
    value, error = exponents.values[0], exponents.errors[0]
    assert 0.01 < error < 0.1
    assert (
        rk.plot.convergence(exponents).get_title(loc="right") == rf"$\lambda_1$ = {value:.3f} ± {error:.3f}"
    )


def test_title_has_the_minus_sign_of_the_axis():
    periodic = rk.lyapunov(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), cycles=500)
    title = rk.plot.convergence(periodic).get_title(loc="right")
    assert title.startswith(r"$\lambda_1$ = −0.15")
    assert "-" not in title


def test_band_and_title_of_a_block_are_per_second(exponents):
    block = rk.Block(2.0, 0.5)
    normal, physical = (rk.plot.convergence(exponents, block=each) for each in (None, block))
    rate = block.frequency_parameter
    (path,), (scaled,) = (artist(ax, "error").get_paths() for ax in (normal, physical))
    np.testing.assert_allclose(scaled.vertices[:, 1], rate * path.vertices[:, 1], rtol=1e-14)
    value, error = rate * exponents.values[0], rate * exponents.errors[0]
    assert physical.get_title(loc="right") == rf"$\lambda_1$ = {value:.3f} ± {error:.3f}"


def test_zero_is_drawn_where_it_comes_into_view(exponents):
    far = {child.get_gid() for child in rk.plot.convergence(exponents).get_children()}
    assert "zero" not in far
    quasi_periodic = rk.lyapunov(rk.System(rk.Harmonic(4.0, period=0.4), 1.0), cycles=3_000)
    artist(rk.plot.convergence(quasi_periodic), "zero")


def test_estimate_without_an_error_is_drawn_and_says_so():
    ax = rk.plot.convergence(evolve(rk.lyapunov(BRACED, cycles=32), errors=np.full(2, np.inf)))
    assert "error unknown" in ax.get_title(loc="right")
    ax.figure.canvas.draw()


@pytest.mark.parametrize("exponent", [1, 2])
def test_exponent_of_minus_infinity_has_its_value_and_its_cause_but_no_line(exponent):
    resting = rk.lyapunov(rk.System(rk.Harmonic(1.05, period=3.0), 0.5), cycles=100)
    ax = rk.plot.convergence(resting, exponent=exponent)
    assert not ax.lines
    assert ax.get_title(loc="right") == rf"$\lambda_{exponent}$ = −∞"
    assert "perturbations vanish" in artist(ax, "cause").get_text()
    assert (ax.get_xlim(), ax.get_xscale()) == ((1.0, 100.0), "log")
    ax.figure.canvas.draw()


# Correlation dimension.


@pytest.fixture(scope="module")
def square():
    return rk.correlation_dimension(np.random.default_rng(1).random((6_000, 2)))


def slopes_axis(ax):
    (right,) = (other for other in ax.figure.axes if other is not ax)
    return right


def test_line_is_the_correlation_sum_on_logarithmic_axes(square):
    ax = rk.plot.correlation_dimension(square)
    line = artist(ax, "correlation-sum")
    np.testing.assert_array_equal(line.get_xdata(), square.radii)
    np.testing.assert_array_equal(line.get_ydata(), square.sums)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")


def test_marks_are_the_local_slopes_between_the_radii(square):
    right = slopes_axis(rk.plot.correlation_dimension(square))
    (marks,) = (line for line in right.lines if len(line.get_xdata()) == len(square.slopes))
    np.testing.assert_array_equal(marks.get_ydata(), square.slopes)
    assert (marks.get_xdata() > square.radii[:-1]).all()
    assert (marks.get_xdata() < square.radii[1:]).all()


def test_scaling_region_and_interval_are_marked(square):
    ax = rk.plot.correlation_dimension(square)
    region = artist(ax, "scaling-region").get_extents().transformed(ax.transData.inverted())
    assert (region.x0, region.x1) == pytest.approx(square.scaling_region, rel=1e-9)
    band = artist(slopes_axis(ax), "interval").get_paths()[0].vertices
    assert (band[:, 1].min(), band[:, 1].max()) == pytest.approx(square.interval, rel=1e-9)
    assert ax.get_title(loc="right").startswith(f"dimension {square.value:.2f}, in [")


def test_radii_have_ticks_that_can_be_read(square):
    ax = rk.plot.correlation_dimension(square)
    ax.figure.canvas.draw()
    low, high = ax.get_xlim()
    shown = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert 2 <= len(shown) <= 6
    assert "standard deviation" in ax.get_xlabel()


def test_axes_given_show_the_dimension(square):
    _, (left, _) = rk.plot.panels(columns=2)
    assert rk.plot.correlation_dimension(square, left) is left


# Power spectral density.


@pytest.fixture(scope="module")
def periodic():
    system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    return rk.spectral_density(rk.simulate(system, cycles=1_560), transient=600)


@pytest.fixture(scope="module")
def quasi_periodic():
    system = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    return rk.spectral_density(rk.simulate(system, cycles=4_096))


def boxes(ax):
    ax.figure.draw_without_rendering()
    return [text.get_window_extent() for text in ax.texts]


def test_density_is_drawn_to_the_multiple_asked_for(periodic):
    frequency, density = points(rk.plot.spectrum(periodic, highest=2.0), "spectrum").T
    last = np.searchsorted(periodic.forcing_multiples, 2.0 * (1 + 1e-9), side="right")
    np.testing.assert_array_equal(frequency, periodic.frequency[1:last])
    np.testing.assert_array_equal(density, periodic.density[1:last])


def test_axis_of_the_density_has_ten_decades(periodic):
    ax = rk.plot.spectrum(periodic)
    assert ax.get_yscale() == "log"
    low, high = ax.get_ylim()
    assert math.isclose(low, periodic.density.max() * 1e-10, rel_tol=1e-9)
    assert high > periodic.density.max()


def test_names_stand_at_their_lines(periodic):
    ax = rk.plot.spectrum(periodic)
    peaks = {f"${peak.name}$": peak for peak in periodic.peaks}
    assert [text.get_text() for text in ax.texts] == ["$f/3$", "$f$", "$5f/3$", "$7f/3$", "$3f$"]
    for text in ax.texts:
        assert text.xy == (peaks[text.get_text()].frequency, peaks[text.get_text()].height)


@pytest.mark.parametrize("highest", [0.5, 1.0, 3.0, 8.0])
def test_no_name_lies_over_another_or_leaves_the_axes(quasi_periodic, highest):
    ax = rk.plot.spectrum(quasi_periodic, highest=highest, names=40)
    rk.plot.title(ax, "a title that takes room")
    found = boxes(ax)
    assert len(found) >= 3
    assert not any(one.overlaps(other) for one, other in itertools.combinations(found, 2))
    frame = ax.get_window_extent()
    for box in found:
        assert frame.x0 <= box.x0
        assert box.x1 <= ax.figure.bbox.x1
        assert box.y1 <= frame.y1


@pytest.mark.parametrize("highest", [1.0, 2.0, 3.0, 4.0, 6.0])
def test_no_name_lies_over_a_stronger_line(quasi_periodic, highest):
    ax = rk.plot.spectrum(quasi_periodic, highest=highest, names=40)
    found = boxes(ax)
    places = ax.transData.transform([(peak.frequency, peak.height) for peak in quasi_periodic.peaks])
    for box in found:
        over = [place for place in places if box.x0 < place[0] < box.x1 and place[1] > box.y0]
        assert over == []


def test_strongest_are_named_first_and_no_more_than_asked(quasi_periodic):
    ax = rk.plot.spectrum(quasi_periodic, names=2)
    assert [text.get_text() for text in ax.texts] == [f"${peak.name}$" for peak in quasi_periodic.peaks[:2]]
    assert not rk.plot.spectrum(quasi_periodic, names=0).texts


def test_multiples_of_the_forcing_are_marked(periodic):
    ax = rk.plot.spectrum(periodic, highest=3.0)
    marks = [line.get_xdata()[0] for line in ax.lines if line.get_gid() != "spectrum"]
    np.testing.assert_allclose(marks, [2.5, 5.0, 7.5], rtol=1e-15)


def test_block_gives_hertz_and_keeps_the_power(periodic):
    block = rk.Block(height=2.0, width=0.5)
    ax = rk.plot.spectrum(periodic, block=block, highest=8.0)
    hertz, density = points(ax, "spectrum").T
    seconds = block.seconds(0.4)
    assert math.isclose(hertz[density.argmax()], 1 / (3 * seconds), rel_tol=1e-9)
    degrees = block.degrees(math.sqrt(periodic.variance))
    assert math.isclose(density.sum() * (hertz[1] - hertz[0]), degrees**2, rel_tol=1e-6)


# Verdict.


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
