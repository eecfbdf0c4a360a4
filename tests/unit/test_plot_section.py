"""The section shows every point, few or many."""

import io

import numpy as np
import pytest
from PIL import Image

import rocking as rk

THIRD = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)


def points(ax):
    (line,) = ax.lines
    return np.column_stack([line.get_xdata(), line.get_ydata()])


def ink(ax):
    """Return the blue fraction of the figure. The blue of a motion exceeds its red by 75."""
    stream = io.BytesIO()
    ax.figure.savefig(stream, dpi=150)
    red, _, blue = np.asarray(Image.open(stream).convert("RGB"), dtype=int).transpose(2, 0, 1)
    return (blue - red > 25).mean()


def test_points_are_those_of_the_section():
    motion = rk.simulate(THIRD, cycles=300)
    np.testing.assert_array_equal(points(rk.plot.section(motion)), motion.section())


def test_transient_is_left_out_and_three_points_stay():
    motion = rk.simulate(THIRD, cycles=900, record="section")
    ax = rk.plot.section(motion, transient=600)
    np.testing.assert_array_equal(points(ax), motion.section()[600:])
    assert len(np.unique(points(ax).round(9), axis=0)) == 3


def test_other_phase_gives_another_section_and_is_written_on_it():
    motion = rk.simulate(THIRD, cycles=50)
    ax = rk.plot.section(motion, phase=1.5)
    np.testing.assert_array_equal(points(ax), motion.section(1.5))
    assert ax.get_title(loc="right") == r"$\psi = 1.5$ (mod $2\pi$)"


def test_phase_of_the_forcing_is_written_where_none_is_asked_for():
    forcing = rk.Harmonic(amplitude=5.5, period=0.5, phase=1.8)
    motion = rk.simulate(rk.System(forcing, restitution=0.925), cycles=20)
    assert rk.plot.section(motion).get_title(loc="right") == r"$\psi = 1.8$ (mod $2\pi$)"


def test_plain_points_are_drawn_without_a_word_on_their_phase():
    given = np.array([[0.1, 0.2], [0.3, -0.4]])
    ax = rk.plot.section(given)
    np.testing.assert_array_equal(points(ax), given)
    assert ax.get_title(loc="right") == ""


def test_ten_points_are_seen_one_by_one_and_a_million_do_not_flood():
    random = np.random.default_rng(1)
    few, many = random.random((10, 2)), random.random((1_000_000, 2))
    # a mark of 5 pt at 150 dpi has an area of 85 pixels, of 525 x 435
    assert ink(rk.plot.section(few)) == pytest.approx(10 * 85 / (525 * 435), rel=0.15)
    spread = ink(rk.plot.section(many))
    gathered = ink(rk.plot.section(np.vstack([0.3 + 0.1 * many, [[0, 0], [1, 1]]])))
    assert gathered < 0.05 * spread


def test_marks_shrink_as_points_grow_in_number():
    random = np.random.default_rng(2)
    sizes = [rk.plot.section(random.random((n, 2))).lines[0].get_markersize() for n in (10, 1000, 10**5)]
    assert sizes[0] > sizes[1] > sizes[2] > 0.1


def test_many_points_are_an_image_inside_a_vector_file(tmp_path):
    cloud = np.random.default_rng(3).random((100_000, 2))
    drawn = rk.plot.save(rk.plot.section(cloud).figure, tmp_path / "cloud.svg")
    assert "<image" in drawn.read_text()
    assert drawn.stat().st_size < 500_000
    sparse = rk.plot.save(rk.plot.section(cloud[:100]).figure, tmp_path / "sparse.svg")
    assert "<image" not in sparse.read_text()


def test_plain_lists_are_points():
    np.testing.assert_array_equal(points(rk.plot.section([[0, 1], [2, 3]], transient=1)), [[2, 3]])


@pytest.mark.parametrize("drawn", [rk.plot.section, rk.plot.impact_section])
@pytest.mark.parametrize(("amplitude", "period"), [(6.5, 0.4), (2.0, 1.0)])
def test_few_points_met_again_and_again_are_as_large_as_few(drawn, amplitude, period):
    """Modes (1, 3) and (1, 1): three states or one, and two impacts, of 20,000 cycles differ by rounding."""
    system = rk.System(rk.Harmonic(amplitude, period=period), 0.925)
    motion = rk.simulate(system, cycles=20_000)
    line = drawn(motion, transient=1_000).lines[0]
    assert line.get_markersize() == 5.0
