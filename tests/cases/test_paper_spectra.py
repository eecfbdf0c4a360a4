"""Figures 7 and 8 of Yim & Lin (1991): points of the sections and lines of the spectra."""

import numpy as np
import pytest

import rocking as rk
from rocking.papers.yim_lin_1991 import figures, surveys

ROTATION = 0.4744150886  # turns about the island's centre in 3 cycles, THEORY §8
PERIODIC = surveys.PERIODIC[1]


def density_of(case, transient, cycles, **how):
    motion = rk.simulate(case.system, case.start, cycles=transient + cycles)
    return rk.spectral_density(motion, transient=transient, **how)


@pytest.fixture(scope="module")
def subharmonic():
    return density_of(PERIODIC, 2_000, 8_190)


@pytest.fixture(scope="module")
def quasi_periodic():
    return density_of(surveys.QUASI_PERIODIC, 0, 8_192)


def test_lines_of_figure_8a_are_all_odd_multiples_of_a_third_and_nothing_else(subharmonic):
    assert (subharmonic.period, subharmonic.symmetric) == (3, True)
    assert not subharmonic.broad_band
    thirds = [3 * peak.forcing_multiple for peak in subharmonic.peaks]
    # up to 4 forcing frequencies, the highest at which lines are sought
    assert sorted(thirds) == list(range(1, 13, 2))
    assert [peak.name for peak in subharmonic.peaks[:4]] == ["f/3", "f", "5f/3", "7f/3"]
    for peak in subharmonic.peaks:
        # another line stands 1,820 resolutions off, 600 times as high at most
        assert abs(peak.offset) < 600 / 1_820**3 * subharmonic.resolution + 1e-13
        place = float(peak.forcing_multiple) / 0.4
        assert peak.frequency - place == pytest.approx(peak.offset, abs=1e-14)


def test_even_multiples_are_absent_from_figure_8a_to_twenty_digits(subharmonic):
    third = subharmonic.segment // 3
    density = subharmonic.density / subharmonic.density.max()
    assert (density[third : 24 * third : 2 * third] > 1e-8).all()
    assert (density[2 * third : 24 * third : 2 * third] < 1e-20).all()
    # nor is there anything between the lines, beyond the main lobes
    between = np.arange(len(density)) % third
    assert (density[(between > 5) & (between < third - 5)] < 1e-20).all()


@pytest.mark.parametrize("turns", [0, 1])
def test_ten_strongest_lines_of_figure_8b_are_combinations_with_the_known_rotation(turns):
    """Lines at (k + mρ)/3 of the forcing; k odd, because the torus is its own mirror image."""
    # another count of whole turns in 3 cycles is the same torus: k then changes by m for each
    rotation = (ROTATION + 2 * turns) / 3
    density = density_of(surveys.QUASI_PERIODIC, 0, 8_192, rotation=rotation)
    assert density.parts == 3
    named = [(3 * peak.forcing_multiple, peak.rotation_multiple) for peak in density.peaks]
    assert len(named) == 40
    assert all(k % 2 == 1 for k, m in named)
    for (k, m), peak in zip(named, density.peaks, strict=True):
        place = (float(k) + m * 3 * rotation) / 3 / 0.4
        assert abs(peak.frequency - place) < 1e-4 * density.resolution
    expected = [(1, 0), (1, -1), (3, 0), (1, 1), (1, -2), (-1, 3), (3, -1), (3, -5), (3, 1), (3, -2)]
    shifted = [(k - 2 * turns * m, m) for k, m in expected]
    assert {places(k, m, rotation) for k, m in named[:10]} == {places(k, m, rotation) for k, m in shifted}


def places(k, m, rotation):
    return round(abs(float(k) / 3 + m * rotation), 6)


def test_rotation_of_figure_8b_is_found_from_its_lines(quasi_periodic):
    """The strongest line that is no multiple of f/3 is f/3 less a third of the rotation about the centre."""
    assert not quasi_periodic.broad_band
    assert quasi_periodic.period is None
    assert quasi_periodic.parts == 3
    # the known number is given to ten digits
    assert quasi_periodic.rotation == pytest.approx((1 - ROTATION) / 3, abs=1e-10)
    assert [peak.name for peak in quasi_periodic.peaks[:5]] == [
        "f/3",
        "f_r",
        "f",
        "2f/3 − f_r",
        "−f/3 + 2f_r",
    ]
    for peak in quasi_periodic.peaks:
        assert peak.name
        assert abs(peak.offset) < quasi_periodic.resolution
        # mirror image: k + m odd in this count of the rotation
        assert (3 * peak.forcing_multiple + peak.rotation_multiple) % 2 == 1


def test_lines_of_figure_8b_carry_the_variance(quasi_periodic):
    """To what the two strongest, 1,295 resolutions apart, beat with each other in the record: a₁a₂/(π 1,295) at most."""
    first, second = (peak.amplitude for peak in quasi_periodic.peaks[:2])
    beat = first * second / (3.1416 * 1_295) / quasi_periodic.variance
    carried = sum(peak.amplitude**2 / 2 for peak in quasi_periodic.peaks) / quasi_periodic.variance
    assert abs(1 - carried) < beat < 3e-4


def test_half_the_record_gives_the_same_lines_to_its_own_resolution(quasi_periodic):
    half = density_of(surveys.QUASI_PERIODIC, 0, 4_096)
    assert half.resolution == pytest.approx(2 * quasi_periodic.resolution)
    for peak, other in zip(half.peaks[:10], quasi_periodic.peaks[:10], strict=True):
        assert peak.name == other.name
        assert peak.forcing_multiple == other.forcing_multiple
        assert abs(peak.frequency - other.frequency) < 1e-3 * half.resolution
        assert peak.amplitude == pytest.approx(other.amplitude, rel=1e-3)


def test_figure_8c_is_a_broad_band_with_the_line_of_the_forcing():
    """From phases as good as the same; where a motion clings to an island for long, at f/2, that has a line too."""
    strongest, shares, broad = [], [], 0
    for system in surveys.sea_systems(9):
        density = rk.spectral_density(rk.simulate(system, cycles=8_192))
        strongest.append(density.peaks[0].name)
        shares.append(density.line_share)
        assert density.rotation is None
        assert "f" in [peak.name for peak in density.peaks[:2]]
        # no gap between 0 and f: the least of it stands above the median of figure 8b, 1e-13 there
        below = density.density[(density.forcing_multiples > 0.01) & (density.forcing_multiples < 0.99)]
        assert below.min() > 1e-11
        only_the_forcing = {peak.forcing_multiple.denominator for peak in density.peaks if peak.name} == {1}
        broad += density.broad_band and only_the_forcing
    assert broad >= 5
    assert strongest.count("f") >= 5
    assert np.median(shares) < 0.3


@pytest.mark.parametrize(
    ("case", "transient", "cycles"), [(PERIODIC, 600, 8_190), (surveys.QUASI_PERIODIC, 0, 8_192)]
)
def test_power_is_the_variance_of_exact_samples(case, transient, cycles):
    """Parseval: the window weighs the cycles, so that what beats with the segments may differ by a thousandth."""
    density = density_of(case, transient, cycles)
    motion = rk.simulate(case.system, case.start, cycles=transient + cycles)
    # instants that no sample falls on
    times = (transient + np.random.default_rng(3).random(400_000) * cycles) * 0.4
    power = density.density.sum() * density.frequency[1]
    # 4e5 random instants: the standard error of a mean square is its spread/632
    assert power == pytest.approx(motion.at(np.sort(times))[0].var(), rel=5 / 632)
    assert power == pytest.approx(density.variance, rel=1e-3)


def test_figure_7_has_three_points_three_curves_and_a_sea():
    points = [np.column_stack(ax.lines[0].get_data()) for ax in figures.figure_7().axes]
    assert [len(shown) for shown in points] == [12, 30_000, 100_000]
    assert len(np.unique(points[0].round(9), axis=0)) == 3

    def boxes(shown, count=100):
        low, high = shown.min(axis=0), shown.max(axis=0)
        return len(np.unique(np.floor((shown - low) / (high - low) * count), axis=0))

    # finer boxes: a curve meets them in proportion to their number along a side, an area to its square
    assert boxes(points[1], 200) / boxes(points[1], 50) == pytest.approx(4, rel=0.1)
    assert boxes(points[2], 200) / boxes(points[2], 50) > 7


@pytest.mark.long
def test_figure_8_names_the_lines_that_the_page_shows():
    names = [{text.get_text() for text in ax.texts} for ax in figures.figure_8().axes]
    assert names[0] == {"$f/3$", "$f$", "$5f/3$", "$7f/3$", "$3f$"}
    assert {"$f/3$", "$f$", "$f_r$", "$2f/3 − f_r$"} <= names[1]
    assert "$f$" in names[2]
