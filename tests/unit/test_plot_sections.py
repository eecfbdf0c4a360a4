"""Figures of sections: every point of a section, every impact on its side, and all curves of manifolds."""

import io
import math

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from drawn import legend

# Stroboscopic section.

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


# Impact section.


def of_sides(ax):
    return {line.get_label(): np.column_stack(line.get_data()) for line in ax.lines}


def test_impacts_of_either_side_are_drawn_at_phase_and_speed():
    impacts = rk.impact_section(THIRD, cycles=300)
    ax = rk.plot.impact_section(impacts)
    up, down = impacts[impacts["after"] > 0], impacts[impacts["after"] < 0]
    np.testing.assert_array_equal(
        of_sides(ax)[r"onto $\Theta > 0$"], np.column_stack([up["phase"], up["after"]])
    )
    np.testing.assert_array_equal(
        of_sides(ax)[r"onto $\Theta < 0$"], np.column_stack([down["phase"], -down["after"]])
    )
    low, high = ax.get_ylim()
    assert low == 0 < impacts["after"].max() < high


def test_motion_and_its_impacts_give_the_same_picture_after_the_transient():
    motion = rk.simulate(THIRD, cycles=300)
    of_motion, of_impacts = (
        of_sides(rk.plot.impact_section(result, transient=200))
        for result in (motion, rk.impact_section(THIRD, cycles=300))
    )
    for name, points in of_motion.items():
        np.testing.assert_array_equal(points, of_impacts[name])
    assert sum(map(len, of_motion.values())) == len(rk.impact_section(motion, transient=200))


def test_phase_axis_is_a_turn_with_its_quarters():
    ax = rk.plot.impact_section(rk.simulate(THIRD, cycles=30))
    np.testing.assert_allclose(ax.get_xticks(), np.arange(5) * math.pi / 2)
    assert [tick.get_text() for tick in ax.get_xticklabels()][2] == r"$\pi$"


def test_many_impacts_are_an_image_inside_a_vector_file(tmp_path):
    chaotic = rk.System(rk.Harmonic(amplitude=2.0, period=0.4), restitution=1.0)
    ax = rk.plot.impact_section(rk.impact_section(chaotic, cycles=20_000))
    path = rk.plot.save(ax.figure, tmp_path / "impacts.svg")
    assert "<image" in path.read_text()
    assert path.stat().st_size < 1_000_000


# Manifolds.

TANGLED = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
GROWN = rk.saddle_manifolds(TANGLED, phase=7.0, cycles=2)


def lines(ax):
    return {line.get_gid(): line for line in ax.lines}


def test_curves_and_saddles_are_those_of_the_result():
    shown = lines(rk.plot.manifolds(GROWN))
    for name, pair in (("stable", GROWN.stable), ("unstable", GROWN.unstable)):
        for one in pair:
            line = shown[f"{name} {one.side:+d}"]
            np.testing.assert_array_equal(np.column_stack(line.get_data()), one.points)
    np.testing.assert_array_equal(np.column_stack(shown["saddles"].get_data()), GROWN.saddles)


def test_stable_and_unstable_have_two_colours_and_the_sides_two_dashes():
    shown = lines(rk.plot.manifolds(GROWN))
    colours = {name: shown[name].get_color() for name in shown}
    assert colours["stable +1"] == colours["stable -1"] != colours["unstable +1"]
    assert colours["unstable +1"] == colours["unstable -1"]
    assert shown["stable +1"].get_linestyle() != shown["stable -1"].get_linestyle()


def test_phase_of_the_section_is_written_on_it():
    assert rk.plot.manifolds(GROWN).get_title(loc="right") == r"$\psi = 0.7168$ (mod $2\pi$)"


def test_frame_holds_the_saddles_and_what_lies_between():
    ax = rk.plot.manifolds(GROWN)
    assert ax.get_xlim()[0] < GROWN.saddles[:, 0].min()
    assert ax.get_xlim()[1] > GROWN.saddles[:, 0].max()
    assert ax.get_xlim()[1] < 1.5
    assert ax.get_ylim()[1] > 0.9


def test_legend_names_each_curve():
    texts = legend(rk.plot.manifolds(GROWN))
    assert texts == ["stable, Θ ≈ +1", "stable, Θ ≈ −1", "unstable, Θ ≈ +1", "unstable, Θ ≈ −1", "saddles"]
