"""Figure of an impact section: every impact on its side, with phase and speed."""

import math

import numpy as np

import rocking as rk

MODE = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)


def drawn(ax):
    return {line.get_label(): np.column_stack(line.get_data()) for line in ax.lines}


def test_impacts_of_either_side_are_drawn_at_phase_and_speed():
    impacts = rk.impact_section(MODE, cycles=300)
    ax = rk.plot.impact_section(impacts)
    up, down = impacts[impacts["after"] > 0], impacts[impacts["after"] < 0]
    np.testing.assert_array_equal(
        drawn(ax)[r"onto $\Theta > 0$"], np.column_stack([up["phase"], up["after"]])
    )
    np.testing.assert_array_equal(
        drawn(ax)[r"onto $\Theta < 0$"], np.column_stack([down["phase"], -down["after"]])
    )
    low, high = ax.get_ylim()
    assert low == 0 < impacts["after"].max() < high


def test_motion_and_its_impacts_give_the_same_picture_after_the_transient():
    motion = rk.simulate(MODE, cycles=300)
    of_motion, of_impacts = (
        drawn(rk.plot.impact_section(result, transient=200))
        for result in (motion, rk.impact_section(MODE, cycles=300))
    )
    for name, points in of_motion.items():
        np.testing.assert_array_equal(points, of_impacts[name])
    assert sum(map(len, of_motion.values())) == len(rk.impact_section(motion, transient=200))


def test_phase_axis_is_a_turn_with_its_quarters():
    ax = rk.plot.impact_section(rk.simulate(MODE, cycles=30))
    np.testing.assert_allclose(ax.get_xticks(), np.arange(5) * math.pi / 2)
    assert [tick.get_text() for tick in ax.get_xticklabels()][2] == r"$\pi$"


def test_many_impacts_are_an_image_inside_a_vector_file(tmp_path):
    chaotic = rk.System(rk.Harmonic(amplitude=2.0, period=0.4), restitution=1.0)
    ax = rk.plot.impact_section(rk.impact_section(chaotic, cycles=20_000))
    path = rk.plot.save(ax.figure, tmp_path / "impacts.svg")
    assert "<image" in path.read_text()
    assert path.stat().st_size < 1_000_000
