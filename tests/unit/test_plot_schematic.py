"""The schematic shows a rigid block that stands on its corner, with readable names."""

import itertools
import math

import numpy as np
import pytest
from matplotlib.patches import Arc

import rocking as rk
from rocking.plot.film import corners

SHAPES = [rk.Block(height=2.0, width=1.0), rk.Block(height=3.0, width=0.75), rk.Block(height=0.2, width=0.15)]


@pytest.mark.parametrize("angle", [-1.5, -0.3, 0.0, 1e-3, 0.4, math.pi / 2])
def test_leaning_block_is_rigid_and_stands_on_the_right_corner(angle):
    foot_left, foot_right, top_right, top_left = corners(2.0, 0.5, angle)
    assert math.dist(foot_left, foot_right) == pytest.approx(0.5)
    assert math.dist(foot_right, top_right) == pytest.approx(2.0)
    assert math.dist(foot_left, top_left) == pytest.approx(2.0)
    assert math.dist(foot_right, top_left) == pytest.approx(math.hypot(2.0, 0.5))
    pivot = foot_right if angle >= 0 else foot_left
    np.testing.assert_allclose(pivot, (math.copysign(0.25, angle), 0.0), atol=1e-16)
    # clockwise from the vertical is positive
    side = top_right - foot_right
    assert math.atan2(side[0], side[1]) == pytest.approx(angle)
    assert min(foot_left[1], foot_right[1]) == pytest.approx(0.0, abs=1e-16)


@pytest.mark.parametrize("block", SHAPES, ids=repr)
def test_block_drawn_has_the_given_proportions_and_half_the_critical_angle(block):
    ax = rk.plot.schematic(block=block)
    (body,) = (patch for patch in ax.patches if patch.get_gid() == "block")
    expected = corners(block.height, block.width, 0.5 * math.atan2(block.width, block.height))
    np.testing.assert_allclose(body.get_xy()[:4], expected)


@pytest.mark.parametrize("lean", [0.3, 0.5, 0.8])
def test_arcs_span_the_angles_that_they_name(lean):
    ax = rk.plot.schematic(block=rk.Block(height=2.0, width=0.8), lean=lean)
    critical = math.degrees(math.atan2(0.8, 2.0))
    spans = sorted(arc.theta2 - arc.theta1 for arc in ax.patches if isinstance(arc, Arc))
    assert spans == pytest.approx([lean * critical, critical])


@pytest.mark.parametrize("block", SHAPES, ids=repr)
def test_every_symbol_of_figure_1_is_there_and_none_covers_another(block):
    ax = rk.plot.schematic(block=block)
    texts = [text for text in ax.texts if text.get_text()]
    names = {text.get_text() for text in texts}
    assert {"$H$", "$B$", "$R$", "$O$", "$O'$", r"$\theta$", r"$\theta_\mathrm{cr}$"} <= names
    assert any("a_g" in name for name in names)
    ax.figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in texts]
    assert not [
        (a.get_text(), b.get_text())
        for (a, one), (b, other) in itertools.combinations(zip(texts, boxes, strict=True), 2)
        if one.overlaps(other)
    ]
