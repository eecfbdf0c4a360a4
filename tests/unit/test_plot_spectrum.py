"""Figure of a spectrum: the density, and names of its lines that do not overlap."""

import itertools
import math

import numpy as np
import pytest

import rocking as rk
from drawn import points


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
