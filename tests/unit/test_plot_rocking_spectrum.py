"""Figures of rocking spectra: one line per record and slenderness, crosses where the block overturns."""

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex

import rocking as rk
from drawn import artists, legend
from rocking.plot import style

RECORDS = rk.synthetic_ground_motions(3, seed=1, duration=8.0)
SIZES = np.linspace(0.2, 3.0, 25)


@pytest.fixture(scope="module")
def found():
    return rk.rocking_spectrum(RECORDS, size=SIZES, slenderness=[0.12, 0.2], model="slender").dataset


def overturned(found):
    return np.isinf(found.peak.values)


def test_each_record_and_slenderness_is_a_line_with_gaps_where_the_block_overturns(found):
    ax = rk.plot.rocking_spectrum(found)
    lines = artists(ax, "peak")
    assert len(lines) == 6
    wanted = np.where(overturned(found), np.nan, found.peak.values).transpose(0, 2, 1).reshape(6, -1)
    for line, peak in zip(lines, wanted, strict=True):
        np.testing.assert_array_equal(line.get_xdata(), SIZES)
        np.testing.assert_array_equal(line.get_ydata(), peak)
    assert (ax.get_xlabel(), ax.get_ylabel()) == (
        "half the diagonal, $R$ (m)",
        r"largest angle $|\theta|/\theta_\mathrm{cr}$",
    )
    names = legend(ax)
    assert names[:2] == [rf"synthetic 1, $\theta_\mathrm{{cr}}$ = {degrees}°" for degrees in ("6.88", "11.5")]
    assert len({line.get_color() for line in lines}) == 6


def test_crosses_stand_above_all_lines_in_a_row_of_each(found):
    ax = rk.plot.rocking_spectrum(found)
    rows = artists(ax, "overturned")
    fell = overturned(found).transpose(0, 2, 1).reshape(6, -1)
    assert fell.any()
    highest = found.peak.values[~overturned(found)].max()
    heights = []
    for marks, line, which in zip(rows, artists(ax, "peak"), fell, strict=True):
        np.testing.assert_array_equal(marks.get_xdata(), SIZES[which])
        assert marks.get_color() == line.get_color()
        assert (marks.get_ydata() > highest).all()
        assert (marks.get_ydata() < ax.get_ylim()[1]).all()
        heights += set(marks.get_ydata())
    assert len(heights) == len(set(heights)) == int(fell.any(axis=1).sum())


@pytest.mark.parametrize(
    ("across", "label", "turn"),
    [
        ("frequency-parameter", r"frequency parameter $\alpha$ (1/s)", lambda alpha: alpha),
        ("period", r"$2\pi/\alpha$ (s)", lambda alpha: math.tau / alpha),
    ],
)
def test_other_axes_stand_for_the_size_and_degrees_for_the_critical_angle(found, across, label, turn):
    one = found.isel(record=0)
    ax = rk.plot.rocking_spectrum(one, across=across, unit="degrees")
    assert (ax.get_xlabel(), ax.get_ylabel()) == (label, r"largest angle $|\theta|$ (°)")
    for line, slenderness, peak in zip(artists(ax, "peak"), (0.12, 0.2), one.peak.values.T, strict=True):
        np.testing.assert_allclose(line.get_xdata(), turn(np.sqrt(3 * 9.80665 / 4 / SIZES)), rtol=1e-15)
        stands = np.isfinite(peak)
        np.testing.assert_allclose(
            line.get_ydata()[stands], np.degrees(slenderness * peak[stands]), rtol=1e-15
        )


def test_degrees_of_a_slenderness_that_does_not_vary(found):
    one = rk.rocking_spectrum(RECORDS[0], size=SIZES, slenderness=0.2, model="slender").dataset
    (line,) = artists(rk.plot.rocking_spectrum(one, unit="degrees"), "peak")
    (same,) = artists(rk.plot.rocking_spectrum(found.isel(record=0, slenderness=[1]), unit="degrees"), "peak")
    np.testing.assert_array_equal(line.get_ydata(), same.get_ydata())


def test_slenderness_alone_is_an_axis_in_degrees():
    angles = np.linspace(0.1, 0.3, 9)
    ax = rk.plot.rocking_spectrum(
        rk.rocking_spectrum(RECORDS[0], size=1.0, slenderness=angles, model="slender")
    )
    np.testing.assert_array_equal(artists(ax, "peak")[0].get_xdata(), np.degrees(angles))
    assert ax.get_xlabel() == r"critical angle $\theta_\mathrm{cr}$ (°)"


def test_undecided_outcomes_are_circled_and_in_the_legend(found):
    doubtful = found.copy(deep=True)
    doubtful.certified[0, 3, 1] = 0
    circles = artists(rk.plot.rocking_spectrum(doubtful), "undecided")
    assert [each.get_xdata().tolist() for each in circles] == [[], [SIZES[3]], [], [], [], []]
    shown = legend(rk.plot.rocking_spectrum(doubtful))
    assert shown[-1] == "undecided by rounding"
    certain = found.assign(certified=found.certified * 0 + 1)
    assert "undecided by rounding" not in [
        text.get_text() for text in rk.plot.rocking_spectrum(certain).get_legend().get_texts()
    ]


@pytest.fixture(scope="module")
def of_many():
    records = rk.synthetic_ground_motions(12, seed=2, duration=8.0)
    return rk.rocking_spectrum(
        records,
        size=SIZES,
        slenderness=[0.15, 0.25],
        levels=0.5,
        intensity="pga-g",
        model="slender",
    ).dataset


def test_many_records_share_the_colour_of_their_slenderness(of_many):
    ax = rk.plot.rocking_spectrum(of_many)
    colours = [to_hex(line.get_color()) for line in artists(ax, "peak")]
    assert colours == 12 * [style.MOTION.lower(), style.IMPACT.lower()]
    names = legend(ax)
    assert names[0] == "one record"
    assert names[1:3] == [rf"median, $\theta_\mathrm{{cr}}$ = {angle}°" for angle in ("8.59", "14.3")]


def test_median_ends_where_more_than_half_of_the_records_overturn_the_block(of_many):
    ax = rk.plot.rocking_spectrum(of_many)
    ended = 0
    for number, line in enumerate(artists(ax, "median")):
        for peaks, shown in zip(of_many.peak.values[..., number].T, line.get_ydata(), strict=True):
            middle = sorted(peaks.tolist())[5]
            ended += math.isinf(middle)
            assert (math.isnan(shown) and math.isinf(middle)) or shown == middle
    assert 0 < ended < 2 * SIZES.size


def test_heading_states_what_does_not_vary(found, of_many):
    ax = rk.plot.rocking_spectrum(of_many)
    assert (ax.get_title("left"), ax.get_title("right")) == ("12 records", "PGA = 0.5 g")
    ax = rk.plot.rocking_spectrum(
        rk.rocking_spectrum(RECORDS[0], size=SIZES, slenderness=0.2, levels=2.0, model="slender")
    )
    heading = r"$\theta_\mathrm{cr}$ = 11.5°, factor = 2"
    assert (ax.get_title("left"), ax.get_title("right")) == ("synthetic 1", heading)
    two = rk.rocking_spectrum(
        RECORDS[0],
        size=SIZES,
        slenderness=0.2,
        levels=[0.3, 0.5],
        intensity="pga-g",
        model="slender",
    ).dataset
    selected = rk.plot.rocking_spectrum(two.isel(level=1)).get_title("right")
    assert selected == r"$\theta_\mathrm{cr}$ = 11.5°, PGA = 0.5 g"
    many = rk.rocking_spectrum(
        RECORDS[0],
        size=SIZES,
        slenderness=np.linspace(0.1, 0.3, 8),
        levels=2.0,
        model="slender",
    ).dataset
    ax = rk.plot.rocking_spectrum(many)
    assert (ax.get_title("left"), ax.get_title("right")) == ("synthetic 1", "factor = 2")


def test_axis_of_the_angle_ends_below_the_strip_of_overturned_blocks(found):
    ax = rk.plot.rocking_spectrum(found)
    (strip,) = (each for each in ax.patches if each.get_gid() == "strip")
    bottom = strip.get_extents().transformed(ax.transData.inverted()).y0
    assert (
        max(ax.get_yticks()) <= bottom < min(y for row in artists(ax, "overturned") for y in row.get_ydata())
    )


def test_many_slendernesses_are_a_map_with_overturned_blocks_in_grey():
    angles = np.linspace(0.08, 0.3, 9)
    found = rk.rocking_spectrum(
        RECORDS[0], size=SIZES, slenderness=angles, model="slender", normalised_by="angle"
    ).dataset
    ax = rk.plot.rocking_spectrum(found, across="period", unit="degrees")
    fallen, image = artists(ax, "overturned")[0], artists(ax, "peak")[0]
    fell = overturned(found).T
    assert fell.any()
    np.testing.assert_array_equal(
        np.ma.filled(image.get_array(), np.nan).reshape(fell.shape),
        np.where(fell, np.nan, found.peak.values.T * np.degrees(angles)[:, None]),
    )
    np.testing.assert_array_equal(~np.ma.getmaskarray(fallen.get_array()).reshape(fell.shape), fell)
    assert ax.get_ylabel() == r"critical angle $\theta_\mathrm{cr}$ (°)"
