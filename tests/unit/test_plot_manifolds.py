"""Figure of manifolds: two colours, all curves as computed, and markers at the saddles."""

import numpy as np

import rocking as rk
from drawn import legend

SYSTEM = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
GROWN = rk.saddle_manifolds(SYSTEM, phase=7.0, cycles=2)


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
