"""What figures and the explorer show of an unsymmetric block, and of one against a wall."""

import math
import re

import numpy as np
import pytest
from matplotlib.figure import Figure

import rocking as rk
from rocking.explorer import texts
from rocking.explorer.fields import Refused
from rocking.explorer.ground_block import block_motion
from rocking.explorer.ground_view import DEFAULT as GROUND
from rocking.explorer.ground_view import GroundView, ground_of
from rocking.explorer.harmonic_maps import curves
from rocking.explorer.harmonic_view import DEFAULT as HARMONIC
from rocking.explorer.harmonic_view import HarmonicView
from rocking.motion.motion import end_shown
from rocking.plot.film import Scene, corners, mass_centre

BLOCK = rk.Block(height=2.0, width=0.6, offset=0.05)
MOTION = rk.simulate(BLOCK.system(rk.synthetic_ground_motions(1, seed=1)[0].scaled(pga=5.3)))
ANGLES = np.degrees(BLOCK.critical_angles)


def test_both_critical_angles_and_lift_offs_are_drawn():
    above, below, _ = rk.plot.overview(MOTION).axes
    lines = {
        name: sorted(line.get_ydata()[0] for line in axes.lines if line.get_gid() == name)
        for axes, name in ((above, "critical angle"), (below, "lift-off from rest"))
    }
    assert lines["critical angle"] == pytest.approx([-ANGLES[1], ANGLES[0]], rel=1e-14)
    # a positive acceleration lifts the block off to the left, beyond g tan θcr₂
    right, left = 9.80665 * np.tan(BLOCK.critical_angles)
    assert lines["lift-off from rest"] == pytest.approx([-right, left], rel=1e-14)


@pytest.mark.parametrize("angle", [0.0, 0.2, -0.2])
def test_mass_centre_turns_with_the_block_about_its_corner(angle):
    upright, tilted = corners(2.0, 0.6, 0.0), corners(2.0, 0.6, angle)
    place = mass_centre(BLOCK, tilted)
    for corner in range(4):
        apart = np.linalg.norm(mass_centre(BLOCK, upright) - upright[corner])
        assert np.linalg.norm(place - tilted[corner]) == pytest.approx(apart, rel=1e-14)
    assert mass_centre(BLOCK, upright).tolist() == pytest.approx([0.05, 1.0], rel=1e-14)


def test_schematic_has_the_mass_centre_above_its_foot_and_both_radii():
    block = rk.Block(height=2.0, width=1.0, offset=0.15)
    ax = rk.plot.schematic(block=block, lean=1.0)
    labels = {text.get_text() for text in ax.texts}
    assert {"$R_1$", "$R_2$", r"$\theta_{\mathrm{cr},1}$", r"$\theta_{\mathrm{cr},2}$"} <= labels
    outline = next(patch for patch in ax.patches if patch.get_gid() == "block").get_xy()[:4]
    # leaning by its critical angle, the mass centre is above the corner
    assert mass_centre(block, outline)[0] == pytest.approx(outline[1][0], abs=1e-14)
    labels = {text.get_text() for text in rk.plot.schematic(block=rk.Block(2.0, 1.0)).texts}
    assert "$R$" in labels
    assert "$R_2$" not in labels


def test_animation_shows_the_mass_centre_of_an_unsymmetric_block_only():
    angles = np.array([0.0, 0.1])
    for block, shown in ((BLOCK, True), (rk.Block(2.0, 0.6), False)):
        scene = Scene(Figure().subplots(), block, angles, np.zeros(2))
        assert (scene.centre in scene.move(1)) is shown
    expected = mass_centre(BLOCK, corners(2.0, 0.6, 0.1))
    scene = Scene(Figure().subplots(), BLOCK, angles, np.zeros(2))
    scene.move(1)
    assert np.ravel(scene.centre.get_data()) == pytest.approx(expected, rel=1e-15)


def test_block_with_other_sides_cannot_perform_the_motion():
    for other in (rk.Block(2.0, 0.6), rk.Block(2.0, 0.6, offset=-0.05)):
        with pytest.raises(
            ValueError, match="block must have the sides of the block of the motion; got one with"
        ):
            MOTION.validity(other)
    larger = BLOCK.resized(4.0, 1.2)  # the same shape
    assert MOTION.validity(larger).friction == pytest.approx(MOTION.validity(BLOCK).friction, rel=1e-9)


@pytest.mark.parametrize("view", [GROUND, HARMONIC.changed({"height": "2", "width": "0.6"})])
def test_offset_is_part_of_a_link_and_must_lie_between_the_edges(view):
    offset = view.changed({"offset": "0.05"})
    assert type(view).from_address(offset.address) == (offset, {})
    assert "offset" not in view.address
    for wrong in ("0.3", "-1", "x", ""):
        with pytest.raises(Refused) as caught:
            view.changed({"offset": wrong})
        assert list(caught.value.fields) == ["offset"]
        assert caught.value.fields["offset"].startswith(("offset must", "give the offset"))


def test_page_of_ground_motions_follows_the_unsymmetric_block():
    view = GROUND.changed(
        {"source": "synthetic-1", "scale": "1.7", "height": "2", "width": "0.6", "offset": "0.05"}
    )
    figures, words = block_motion(view, ground_of(view, ()))
    motion = rk.simulate(view.block.system(ground_of(view, ()).scaled(view.scale), model=view.model))
    assert view.block == BLOCK
    assert np.abs(figures["history"]["line"]["angle"]).max() == pytest.approx(
        math.degrees(motion.peak * BLOCK.critical_angle), rel=1e-3
    )
    assert (figures["history"]["above"], figures["history"]["below"]) == pytest.approx(
        (ANGLES[0], -ANGLES[1])
    )
    facts = dict(words["facts"])
    assert facts["θcr"] == "14.04°, 19.29°"
    assert facts["e"] == "0.8587, 0.8948 (Housner)"
    # negative accelerations tip the block to θ > 0
    assert facts["lifts off at"] == "−0.25 g, 0.35 g"
    assert words["sentence"].endswith("The blocks of the map have no offset.")
    assert view.changed(view.at_point(1.0, 15.0)).offset == 0.0  # the blocks of the map are symmetric


def test_page_of_harmonic_motion_has_the_system_of_the_block():
    view = HARMONIC.changed({"height": "2", "width": "0.6"}).changed({"offset": "0.05"})
    assert view.block.left == BLOCK.left
    assert view.system.left == BLOCK.left
    assert {
        name: view.fixed[name] for name in ("angle_ratio", "frequency_ratio", "left_restitution")
    } == view.left
    assert "offset=0.05" in texts.python(view)
    assert texts.commands(view).count("--offset 0.05") == 3
    shown = dict(texts.verdict(rk.classify(view.system), view.block)["facts"])["block"]
    assert shown.endswith("θcr 14.04°, 19.29°, Housner’s e 0.8587, 0.8948")
    chosen = view.changed({"restitution": "0.9"})
    assert (chosen.block.restitution, chosen.block.left_restitution) == (0.9, 0.9)
    with pytest.raises(Refused, match="offset must be 0 with braces"):
        view.changed({"brace_angle": "5"})
    drawn = HarmonicView.from_address(f"{view.address}&curves=existence-1")[0]
    assert curves(drawn, drawn.map_axes) == {"xs": [], "ys": [], "dash": []}


@pytest.mark.parametrize(("velocity", "side"), [(3.0, 1), (-9.0, -1)])
def test_fall_of_a_slender_block_is_shown_far_beyond_both_critical_angles(velocity, side):
    left = rk.LeftSide(angle_ratio=4.0, frequency_ratio=1.0, restitution=0.9)
    system = rk.System(rk.Harmonic(0.0, period=1.0), 0.9, left=left)
    motion = rk.simulate(system, rk.State(velocity=velocity), cycles=50)
    assert motion.overturning is not None
    last = motion.at(end_shown(motion))[0]
    assert last == pytest.approx(side * 12.0, rel=1e-9)


@pytest.mark.parametrize("model", ["slender", "full"])
@pytest.mark.parametrize("offset", [0.05, -0.05])
def test_margin_is_shown_in_the_unit_of_the_side_on_which_it_arises(model, offset):
    block = rk.Block(height=2.0, width=0.6, offset=offset)
    for ground in rk.synthetic_ground_motions(4, seed=1):
        motion = rk.simulate(block.system(ground.scaled(pga=4.5), model=model))
        side = 0 if motion.at(motion.margin_time + 1e-6)[0] > 0 else 1
        unit = math.degrees(block.critical_angles[side] * block.frequency_parameters[side])
        shown = float(re.search(r"margin (\S+)°/s", str(motion))[1])
        assert shown == pytest.approx(motion.margin * unit, rel=1e-3)
    assert "αθcr of its side" in str(rk.simulate(motion.system, record="none"))


@pytest.mark.parametrize(
    ("kept", "sides"), [((0.86, 0.9), []), ((0.86, 0.88), ["θ < 0"]), ((0.85, 0.88), ["θ > 0", "θ < 0"])]
)
def test_restitution_of_each_side_is_compared_with_its_own_housner_value(kept, sides):
    block = rk.Block(2.0, 0.6, kept[0], offset=0.05, left_restitution=kept[1])  # Housner's: 0.8587, 0.8948
    motion = rk.simulate(block.system(rk.synthetic_ground_motions(1, seed=1)[0].scaled(pga=4.0)))
    said = [text for text in motion.validity(block).warnings if "Housner's" in text]
    assert [re.search("after (θ . 0)", text)[1] for text in said] == sides


def test_friction_of_scattered_impacts_is_that_of_the_speeds_after_them():
    """The impulse changes the velocity of the mass centre, which turns about one corner before it and about the other after it."""
    law = rk.Restitution.constant(0.9).scattered(0.05, seed=2)
    block = rk.Block(2.0, 0.6, law, offset=0.05)
    motion = rk.simulate(block.system(rk.synthetic_ground_motions(1, seed=1)[0].scaled(pga=4.0)))
    validity = motion.validity(block)
    assert validity.friction_source == "impact"
    hits = motion.events[(motion.events["kind"] == "impact") & (motion.events["after"] != 0.0)]
    height, (first, second) = block.centre_height, block.edges
    old = np.where(hits["before"] > 0.0, second, first)
    new = first + second - old
    before, after = np.abs(hits["before"]), np.abs(hits["after"])
    # velocity of the mass centre turning about a corner: (height, distance to the corner) × angular velocity
    needed = height * (before - after) / (old * before + new * after)
    assert validity.friction == pytest.approx(needed.max(), rel=1e-12)


def test_figures_show_the_wall_at_the_left_face_of_the_block():
    block = rk.Block(height=2.0, width=0.6, wall=rk.Wall(0.5))
    ax = rk.plot.schematic(block=block)
    scene = Scene(Figure().subplots(), block, np.array([0.0, 0.1]), np.zeros(2))
    for parts in (ax.patches, scene.parts):
        (wall,) = (part for part in parts if part.get_gid() == "wall")
        assert wall.get_x() + wall.get_width() == pytest.approx(-0.3, rel=1e-14)
        assert wall.get_height() > 2.0
    assert scene.centre not in scene.parts
    with pytest.raises(ValueError, match="lean must be 0 or more for a block against a wall; got -0.5"):
        rk.plot.schematic(block=block, lean=-0.5)


def test_page_of_ground_motions_follows_the_block_against_a_wall():
    view = GROUND.changed(
        {"source": "synthetic-1", "scale": "1.7", "height": "2", "width": "0.6", "wall": "0.5"}
    )
    assert GroundView.from_address(view.address) == (view, {})
    assert "wall" not in GROUND.address
    figures, words = block_motion(view, ground_of(view, ()))
    assert figures["history"]["line"]["angle"].min() == 0.0
    facts = dict(words["facts"])
    assert (facts["e"], facts["lifts off at"]) == ("0.5 (wall)", "−0.3 g")
    assert words["sentence"].endswith("The blocks of the map have no wall.")
    assert view.changed(view.at_point(1.0, 15.0)).wall is None
    with pytest.raises(Refused, match="wall"):
        view.changed({"wall": "1.5"})
