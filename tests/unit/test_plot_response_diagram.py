"""Figure of a response diagram: bands of the types, marks with their errors, SI axes."""

import numpy as np
import pytest

import rocking as rk
from rocking.plot.palette import COLOURS

CASCADE = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
VALUES = [10.103037, 10.45, 10.5, 10.6, 10.9, 11.0]
FOUND = rk.response_diagram(CASCADE, amplitude=VALUES)


def colour_of(artist):
    return tuple(np.round(np.atleast_2d(artist.get_facecolor())[0][:3], 6))


def bands(figure):
    """Intervals of each category: name to a list of (low, high)."""
    return {
        band.get_gid(): [(path.vertices[:, 0].min(), path.vertices[:, 0].max()) for path in band.get_paths()]
        for band in figure.axes[0].collections
    }


def marks(ax):
    """Values and heights of all marks, by category."""
    return {line.get_gid(): line.get_xydata() for line in ax.lines if line.get_gid() != "zero"}


def test_bands_cover_the_range_once_and_end_half_way():
    drawn = bands(rk.plot.response_diagram(FOUND))
    assert set(drawn) == {"chaotic", "period 1, asymmetric", "even period", "overturned"}
    assert drawn["even period"] == [(pytest.approx(10.475), pytest.approx(10.75))]
    assert drawn["overturned"] == [(pytest.approx(10.75), 11.0)]
    assert sum(high - low for each in drawn.values() for low, high in each) == pytest.approx(11.0 - 10.103037)


def test_colours_are_those_of_the_types():
    figure = rk.plot.response_diagram(FOUND)
    shown = {band.get_gid(): band for band in figure.axes[0].collections}
    for name, kind in (("chaotic", rk.Kind.CHAOTIC), ("overturned", rk.Kind.OVERTURNED)):
        hexed = "#" + "".join(f"{round(255 * part):02X}" for part in colour_of(shown[name]))
        assert hexed == COLOURS[kind]
    named = [text.get_text() for text in figure.axes[2].get_legend().get_texts()]
    assert named == ["period 1, asymmetric", "even period", "chaotic", "overturned"]


def test_marks_lie_at_the_exponents_and_rotation_numbers_with_bars_of_the_errors():
    _, exponents, rotation = rk.plot.response_diagram(FOUND).axes
    for ax, heights in ((exponents, FOUND.exponent), (rotation, FOUND.rotation)):
        points = np.concatenate(list(marks(ax).values()))
        known = np.isfinite(heights)
        np.testing.assert_array_equal(
            points[np.argsort(points[:, 0])], np.column_stack([VALUES, heights])[known]
        )
    (bar,) = (bar for bar in exponents.containers if len(bar[2][0].get_segments()))
    (ends,) = bar[2][0].get_segments()
    error = FOUND.exponent_error[0]
    np.testing.assert_allclose(ends, [[VALUES[0], FOUND.exponent[0] + sign * error] for sign in (-1, 1)])
    (zero,) = (line for line in exponents.lines if line.get_gid() == "zero")
    assert list(zero.get_ydata()) == [0.0, 0.0]


def test_value_without_an_error_is_hollow():
    undamped = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    _, exponents, rotation = rk.plot.response_diagram(
        rk.response_diagram(undamped, amplitude=[3.9, 4.0])
    ).axes
    faces = [
        next(line for line in ax.lines if line.get_gid() == "quasi-periodic").get_markerfacecolor()
        for ax in (exponents, rotation)
    ]
    assert faces == ["white", COLOURS[rk.Kind.QUASI_PERIODIC]]


def test_exponent_of_minus_infinity_is_a_triangle_at_the_bottom():
    system = rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.5)
    ax = rk.plot.response_diagram(rk.response_diagram(system, amplitude=[0.9, 1.05, 1.3])).axes[1]
    (line,) = (line for line in ax.lines if line.get_gid() == "superstable")
    assert list(line.get_xdata()) == [0.9, 1.05]
    assert np.isfinite(ax.get_ylim()).all()


def test_a_diagram_of_overturned_or_single_responses_has_a_picture():
    for values in ([30.0, 31.0], [10.45]):
        figure = rk.plot.response_diagram(rk.response_diagram(CASCADE, amplitude=values))
        figure.canvas.draw()
        assert len(bands(figure)) == 1
