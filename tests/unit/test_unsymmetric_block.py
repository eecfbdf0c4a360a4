"""An unsymmetric block: its formulas, the system that it makes, sections by their outline, and both polarities of a record."""

import json
import math

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.model.section import section_of
from rocking.model.system import quantities, system_of

GRAVITY = 9.80665
BLOCK = rk.Block(height=2.0, width=0.6, offset=0.05)
LEFT = rk.LeftSide(angle_ratio=1.4, frequency_ratio=0.99, restitution=0.9)
WAVE = rk.Harmonic(amplitude=2.0, period=1.0)


def test_block_with_an_offset_has_the_constants_of_the_reference():
    """H 2 m, B 0.6 m, offset 0.05 m, k² = 4.36/12 m², computed by another program."""
    degrees = [math.degrees(angle) for angle in BLOCK.critical_angles]
    assert degrees == pytest.approx([14.03624, 19.29005], abs=5e-6)
    assert BLOCK.frequency_parameters == pytest.approx((2.66261387, 2.6443679), abs=5e-8)
    assert BLOCK.housner_restitutions == pytest.approx((0.85866517, 0.89479836), abs=5e-9)
    assert BLOCK.radius_of_gyration**2 == pytest.approx(4.36 / 12, rel=1e-15)


def after_impact(block, side):
    """Return the ratio of the angular velocities after and before an impact, by the angular momentum about the corner hit."""
    h, k2 = block.centre_height, block.radius_of_gyration**2
    corners = {1: np.array([block.width / 2, 0.0]), -1: np.array([-block.width / 2, 0.0])}
    centre = np.array([block.offset, h])
    arm, new = centre - corners[side], centre - corners[-side]
    velocity = np.array([-arm[1], arm[0]])  # of the centre, for an angular velocity of 1 anticlockwise
    momentum = k2 + new[0] * velocity[1] - new[1] * velocity[0]
    return momentum / (k2 + new @ new)


@pytest.mark.parametrize("offset", [0.05, -0.12, 0.299])
@pytest.mark.parametrize("gyration", [None, 0.3])
@pytest.mark.parametrize("centre_height", [None, 1.2])
def test_sides_obey_statics_and_the_conservation_of_angular_momentum(offset, gyration, centre_height):
    block = rk.Block(2.0, 0.6, 0.5, offset=offset, radius_of_gyration=gyration, centre_height=centre_height)
    h, k2 = block.centre_height, block.radius_of_gyration**2
    for number, reach in enumerate((0.3 - offset, 0.3 + offset)):
        assert math.tan(block.critical_angles[number]) == pytest.approx(reach / h, rel=1e-14)
        inertia = k2 + h**2 + reach**2  # about the corner
        assert block.frequency_parameters[number] ** 2 == pytest.approx(
            GRAVITY * math.hypot(h, reach) / inertia, rel=1e-14
        )
    expected = [after_impact(block, side) for side in (1, -1)]
    assert block.housner_restitutions == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(
    ("left_out", "stated"),
    [
        ({}, {"offset": 0.0}),
        ({}, {"centre_height": 1.0}),
        ({}, {"inertia_ratio": 4 / 3}),
        ({"inertia_ratio": 1.5}, {"inertia_ratio": 1.5, "offset": -0.0}),
    ],
)
def test_block_that_states_a_default_is_the_same_to_the_last_bit(left_out, stated):
    one, other = rk.Block(2.0, 0.5, **left_out), rk.Block(2.0, 0.5, **stated)
    assert one == other
    assert hash(one) == hash(other)
    names = ("critical_angle", "frequency_parameter", "housner_restitution", "radius", "inertia_ratio")
    assert [getattr(one, name) for name in names] == [getattr(other, name) for name in names]
    assert other.left is None


@pytest.mark.parametrize("wall", [None, rk.Wall(0.5)])
@pytest.mark.parametrize(
    "given, differs", [({}, False), ({"offset": 0.05}, True), ({"left_restitution": 0.5}, True)]
)
def test_block_is_unsymmetric_with_two_sides_that_differ(given, differs, wall):
    block = rk.Block(2.0, 0.6, **given, wall=wall)
    assert block.is_unsymmetric == isinstance(block.left, rk.LeftSide) == (differs and wall is None)


def test_mirror_image_of_a_block_exchanges_its_sides():
    mirrored = rk.Block(2.0, 0.6, offset=-0.05)
    for name in ("critical_angles", "frequency_parameters", "housner_restitutions"):
        assert getattr(mirrored, name) == pytest.approx(getattr(BLOCK, name)[::-1], rel=1e-15)
    assert mirrored.left.angle_ratio * BLOCK.left.angle_ratio == pytest.approx(1.0, rel=1e-15)


def test_system_of_a_block_has_its_left_side_and_units_of_its_right_one():
    system = BLOCK.system(acceleration=3.0, period_s=0.8)
    assert system.left == BLOCK.left
    assert system.block is BLOCK
    assert system.forcing.amplitude == pytest.approx(3.0 / (GRAVITY * math.atan(0.25)), rel=1e-15)
    assert system.forcing.period == pytest.approx(0.8 * BLOCK.frequency_parameters[0], rel=1e-14)
    assert system.lift_off == 1.0  # the right side is the narrow one
    mirrored = rk.Block(2.0, 0.6, offset=-0.05).system(acceleration=3.0, period_s=0.8, model="full")
    assert mirrored.lift_off * mirrored.critical_angle == pytest.approx(0.25, rel=1e-14)


def test_left_side_that_equals_the_right_one_counts_as_none():
    assert rk.System(WAVE, 0.9, left=rk.LeftSide(1.0, 1.0, 0.9)) == rk.System(WAVE, 0.9)
    assert rk.System(WAVE, 0.9, left=rk.LeftSide(1.0, 1.0, 0.8)) != rk.System(WAVE, 0.9)


def test_block_follows_another_restitution_of_its_system_but_no_other_shape():
    system = BLOCK.system(acceleration=3.0, period_s=0.8)
    other = attrs.evolve(system, restitution=0.7)
    assert (other.block.restitution, other.block.left_restitution) == (0.7, BLOCK.left_restitution)
    assert other.block.critical_angles == BLOCK.critical_angles
    assert attrs.evolve(system, left=LEFT).block is None
    assert attrs.evolve(system, left=None).block is None


def test_quantities_of_a_system_make_the_same_system():
    system = rk.System(WAVE, 0.8, critical_angle=0.3, left=LEFT)
    values = quantities(system)
    assert list(values)[-3:] == ["angle_ratio", "frequency_ratio", "left_restitution"]
    assert system_of({"brace_angle": math.inf, "brace_restitution": 1.0} | values) == system
    assert (
        eval(
            repr(system), vars(rk) | {name: getattr(rk, name) for name in ("System", "Harmonic", "LeftSide")}
        )
        == system
    )


RIGHT_ANGLED = [(0, 0), (0.6, 0), (0, 1.8)]
L_SHAPE = [(0, 0), (0.6, 0), (0.6, 0.3), (0.2, 0.3), (0.2, 1.5), (0, 1.5)]
TABLE = [(0, 0), (0.1, 0), (0.1, 0.7), (0.9, 0.7), (0.9, 0), (1, 0), (1, 0.8), (0, 0.8)]


def of_rectangles(*parts):
    """Return area, centroid and polar second moment about it of rectangles (x, y, width, height), by Steiner's theorem."""
    area = sum(b * h for *_, b, h in parts)
    x, y = (
        sum(b * h * (place + size / 2) for place, size, b, h in each) / area
        for each in zip(*(((x, b, b, h), (y, h, b, h)) for x, y, b, h in parts), strict=True)
    )
    moment = sum(
        b * h * ((b**2 + h**2) / 12 + (px + b / 2 - x) ** 2 + (py + h / 2 - y) ** 2) for px, py, b, h in parts
    )
    return area, x, y, moment


@pytest.mark.parametrize("turned", [False, True], ids=["anticlockwise", "clockwise"])
@pytest.mark.parametrize(
    ("outline", "width", "parts"),
    [
        ([(0, 0), (0.5, 0), (0.5, 2), (0, 2)], 0.5, [(0, 0, 0.5, 2)]),
        (L_SHAPE, 0.6, [(0, 0, 0.6, 0.3), (0, 0.3, 0.2, 1.2)]),
        (TABLE, 1.0, [(0, 0, 0.1, 0.7), (0.9, 0, 0.1, 0.7), (0, 0.7, 1, 0.1)]),
    ],
)
def test_section_has_the_moments_of_its_rectangles(outline, width, parts, turned):
    area, x, y, moment = of_rectangles(*parts)
    moved = np.array(outline[::-1] if turned else outline) + np.array([3.0, -2.0])
    section = section_of(moved)
    assert section.width == pytest.approx(width, rel=1e-13)
    assert section.offset == pytest.approx(x - width / 2, abs=1e-13)
    assert section.centre_height == pytest.approx(y, rel=1e-12)
    assert section.radius_of_gyration == pytest.approx(math.sqrt(moment / area), rel=1e-12)


def test_triangle_has_the_moments_of_its_closed_form():
    block = rk.Block.from_outline(RIGHT_ANGLED)
    assert (block.offset, block.centre_height) == pytest.approx((0.2 - 0.3, 0.6), rel=1e-14)
    assert block.radius_of_gyration == pytest.approx(math.sqrt((0.6**2 + 1.8**2) / 18), rel=1e-14)


def test_outline_of_a_rectangle_is_the_block_of_its_size():
    block = rk.Block.from_outline([(0, 0), (0.5, 0), (0.5, 2), (0, 2), (0, 0)])
    assert block.left is None
    assert block.critical_angle == rk.Block(2.0, 0.5).critical_angle
    assert block.inertia_ratio == 4 / 3
    for height, width in ((2.0, 0.5), (1.7, 0.61), (0.3, 0.1)):
        outline = [(0, 0), (width, 0), (width, height), (0, height)]
        assert rk.Block.from_outline(outline) == rk.Block(height, width)
    # as high as wide at its foot and its middle, but not a rectangle
    other = rk.Block.from_outline([(0, 0), (0.5, 0), (0.6, 1), (0.5, 2), (0, 2), (-0.1, 1)])
    assert other != rk.Block(2.0, 0.5)


B = {"height": 2.0, "width": 0.6}
REFUSED = {
    "offset beyond the edge": (
        lambda: rk.Block(**B, offset=0.3),
        "offset must lie between -0.3 and 0.3 m, so that the mass centre is above the base; got 0.3",
    ),
    "offset of another type": (
        lambda: rk.Block(**B, offset="5 cm"),
        "offset must be a finite real number of size up to 1000; got '5 cm'",
    ),
    "centre above the top": (
        lambda: rk.Block(**B, centre_height=2.5),
        "centre_height must be at most the height, 2 m; got 2.5",
    ),
    "centre in the ground": (
        lambda: rk.Block(**B, centre_height=0.0),
        "centre_height must lie in [0.001, 1000] m; got 0.0",
    ),
    "inertia twice": (
        lambda: rk.Block(**B, inertia_ratio=1.5, radius_of_gyration=0.6),
        "inertia_ratio must be omitted with radius_of_gyration; got 1.5 (both state the inertia)",
    ),
    "inertia about which corner": (
        lambda: rk.Block(**B, inertia_ratio=1.5, offset=0.1),
        "inertia_ratio must be omitted with offset; got 1.5 (give radius_of_gyration: the corners differ)",
    ),
    "radius of gyration too large": (
        lambda: rk.Block(**B, radius_of_gyration=4.0),
        "radius_of_gyration must be at most 3.13209 m, three times the distance of a corner from the mass centre; got 4.0",
    ),
    "left restitution": (
        lambda: rk.Block(**B, left_restitution=1.2),
        "left_restitution must lie in [0, 1]; got 1.2",
    ),
    "squat on one side": (
        lambda: rk.Block(1.0, 2.0, offset=0.1),
        (
            "restitution must lie in [0, 1]; got -0.219 by Housner's formula for a block 1 m high and 2 m wide (are height and "
            "width swapped, or in another unit? If not, give restitution)"
        ),
    ),
    "too squat for the full equation": (
        lambda: rk.Block(0.5, 1.5, 0.5, offset=0.1).system(acceleration=1.0, period_s=1.0, model="full"),
        (
            "width must give a critical angle atan(width/height) in [0.001, 1.2] with the full equation; got 1.5 "
            "(the slender model takes any angle)"
        ),
    ),
    "outline of text": (
        lambda: rk.Block.from_outline("abc"),
        "outline must be a real number or an array of real numbers; got 'abc'",
    ),
    "outline of two corners": (
        lambda: rk.Block.from_outline([(0, 0), (1, 1)]),
        "outline must be 3 to 1,000 corners (x, y), an array of shape (n, 2); got an array of shape (2, 2)",
    ),
    "outline that crosses itself": (
        lambda: rk.Block.from_outline([(0, 0), (1, 0), (0, 1), (1, 1)]),
        "outline must not cross or touch itself; got a polygon that does",
    ),
    "outline with a spike": (
        lambda: rk.Block.from_outline([(0, 0), (1, 0), (2, 0), (1, 0), (1, 1), (0, 1)]),
        "outline must not cross or touch itself; got a polygon that does",
    ),
    "outline on its tip": (
        lambda: rk.Block.from_outline([(0, 1), (0.5, 0), (1, 1)]),
        "outline must have a flat base, two lowest corners or more; got one lowest corner",
    ),
    "outline that leans too far": (
        lambda: rk.Block.from_outline([(0, 0), (0.2, 0), (1.2, 2), (1.0, 2)]),
        "outline must have its centroid above the base; got a centroid 0.5 m from the middle of a base 0.2 m wide",
    ),
    "outline in millimetres": (
        lambda: rk.Block.from_outline([(0, 0), (600, 0), (600, 2000), (0, 2000)]),
        "outline must be 0.001 to 1000 m high and wide; got 2000 m by 600 m",
    ),
    "left of another type": (
        lambda: rk.System(WAVE, 0.9, left=0.9),
        "left must be a LeftSide; got 0.9 (make one: rk.LeftSide(angle_ratio=1.4, frequency_ratio=0.99, restitution=0.9))",
    ),
    "angle ratio": (
        lambda: rk.LeftSide(0.0, 1.0, 0.9),
        "angle_ratio must lie in [0.01, 100]; got 0.0",
    ),
    "frequency ratio": (
        lambda: rk.LeftSide(1.0, 11.0, 0.9),
        "frequency_ratio must lie in [0.1, 10]; got 11.0",
    ),
    "left side of a full block that is too squat": (
        lambda: rk.System(WAVE, 0.9, critical_angle=1.0, left=LEFT),
        "angle_ratio must lie in [0.001, 1.2]; got 1.4",
    ),
    "unequal sides with braces": (
        lambda: BLOCK.system(acceleration=3.0, period_s=1.0, braces=rk.Braces(1.0)),
        "braces must be omitted for a block with unequal sides; got braces at 1 (or omit offset)",
    ),
    "left side with braces": (
        lambda: rk.System(WAVE, 0.9, rk.Braces(1.0), left=LEFT),
        "left must be omitted with braces; got both (braces are for a symmetric block)",
    ),
    "braces as an axis": (
        lambda: rk.parametric_map(rk.System(WAVE, 0.9, left=LEFT), amplitude=[1, 2], brace_angle=[0.5, 1]),
        "brace_angle must be omitted for an unsymmetric block; got an axis",
    ),
    "braces as the axis of a diagram": (
        lambda: rk.orbit_diagram(rk.System(WAVE, 0.9, left=LEFT), brace_angle=[0.5, 1]),
        "brace_angle must be omitted for an unsymmetric block; got 0.5",
    ),
    "left side as an axis": (
        lambda: rk.parametric_map(
            rk.System(WAVE, 0.9, left=LEFT), amplitude=[1, 2], left_restitution=[0.8, 0.9]
        ),
        (
            "parametric_map() has no argument 'left_restitution' (it is a quantity of the left side, System(…, left=rk.LeftSide(…)), and "
            "is no axis here)"
        ),
    ),
    "left side with a table": (
        lambda: rk.System(WAVE, 0.9, critical_angle=0.3, restitution_table=[(1.0, 0.8)], left=LEFT),
        "left must be omitted with restitution_table; got both (a table is for a symmetric block)",
    ),
    "polarity": (
        lambda: rk.rocking_spectrum(rk.example_ground_motion(), BLOCK, [1.0, 2.0], polarity="up"),
        'polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got \'up\'',
    ),
    "energy of an unsymmetric block": (
        lambda: rk.theory.physical_energy(BLOCK, 0.1, 0.0),
        "block must be symmetric; got one with offset 0.05 m (the formula holds for equal sides)",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusal_is_one_sentence(case):
    call, sentence = REFUSED[case]
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert str(caught.value) == sentence


RECORDS = rk.synthetic_ground_motions(3, seed=2)
LEVELS = np.linspace(1.0, 8.0, 8)


def peaks(polarity, angle=0.3):
    block = rk.Block(2.0, 0.5)
    return rk.rocking_spectrum(
        RECORDS, block, LEVELS, intensity="pga", angle=angle, polarity=polarity, model="full"
    ).dataset


def test_worse_polarity_is_at_each_level_that_of_the_larger_peak():
    plus, minus, worse = (peaks(each) for each in ("+", "-", "worse"))
    assert (plus.peak.values != minus.peak.values).any()  # the block starts at an angle
    np.testing.assert_array_equal(worse.peak, np.maximum(plus.peak, minus.peak))
    taken = minus.peak > plus.peak
    assert (taken & np.isfinite(minus.peak)).any()
    np.testing.assert_array_equal(worse.margin, np.where(taken, minus.margin, plus.margin))
    assert worse.attrs["polarity"] == "worse"


def test_both_polarities_are_an_axis_or_pairs_of_records():
    plus, minus, both = (peaks(each) for each in ("+", "-", "both"))
    np.testing.assert_array_equal(both.peak.sel(polarity=1), plus.peak)
    np.testing.assert_array_equal(both.peak.sel(polarity=-1), minus.peak)
    block = rk.Block(2.0, 0.5)
    ida = rk.incremental_dynamic_analysis(
        RECORDS, block, LEVELS, intensity="pga", angle=0.3, polarity="both", model="full"
    )
    np.testing.assert_array_equal(ida.dataset.peak[::2], plus.peak)
    np.testing.assert_array_equal(ida.dataset.peak[1::2], minus.peak)
    assert ida.dataset.name.values[1] == f"{ida.dataset.name.values[0]} reversed"


def test_symmetric_block_at_rest_does_not_distinguish_polarities():
    plus, minus, worse = (peaks(each, angle=0.0) for each in ("+", "-", "worse"))
    for name in plus:
        np.testing.assert_array_equal(plus[name], minus[name])
        np.testing.assert_array_equal(plus[name], worse[name])


def test_fragility_with_both_polarities_counts_each_record_once():
    block = rk.Block(2.0, 0.5)
    one, both = (
        rk.fragility(RECORDS, block, LEVELS, limits=(), replicates=200, polarity=each)
        for each in ("+", "both")
    )
    np.testing.assert_array_equal(one.dataset.fraction, both.dataset.fraction)
    np.testing.assert_array_equal(one.dataset.effective_records, both.dataset.effective_records)
    assert both.dataset.peak.size == 2 * one.dataset.peak.size
    json.dumps(both.to_dict())


def test_margin_of_unequal_sides_stays_normalised_where_other_results_are_in_si():
    ground = RECORDS[0].scaled(pga=4.0)
    motion = rk.simulate(BLOCK.system(ground, model="slender"))
    data = motion.to_dict()
    assert data["margin"] == motion.margin
    assert data["peak_rad"] == pytest.approx(motion.peak * BLOCK.critical_angles[0], rel=1e-15)
    assert "margin_rad_per_s" in rk.simulate(rk.Block(2.0, 0.6).system(ground, model="slender")).to_dict()
