"""Figure of a map: each point in the colour of its type, period and symmetry, upright, with fractions of all points."""

import io
import math
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from PIL import Image

import rocking as rk
from drawn import legend
from rocking.plot.palette import LOOKS
from surveyed import system_with

NUMBERS = {kind: number for number, kind in enumerate(rk.Kind)}
KINDS = {look.name: look for look in LOOKS}
COUNT = 7
# What a response is, and by which name it is drawn.
SEEN = {
    ("rest", 0, 2): "rest",
    ("periodic", 1, 1): "period 1",
    ("periodic", 1, 0): "period 1, asymmetric",
    ("periodic", 3, 1): "period 3",
    ("periodic", 3, 0): "period 3, asymmetric",
    ("periodic", 5, 1): "period 5, 7, …",
    ("periodic", 63, 0): "5, 7, …, asymmetric",
    ("periodic", 2, 0): "even period",
    ("periodic", 64, 0): "even period",
    ("quasi-periodic", 0, 2): "quasi-periodic",
    ("chaotic", 0, 2): "chaotic",
    ("overturned", 0, 2): "overturned",
    ("undetermined", 0, 2): "undetermined",
}


def a_map(rows, **told):
    """A map whose rows, from the lowest amplitude up, are (kind, period, symmetric), or None: not computed."""
    fields = [(255, -1, 255) if row is None else (NUMBERS[row[0]], *row[1:]) for row in rows]
    axes = {"amplitude": np.arange(1.0, len(rows) + 1), "period": np.linspace(1.0, 2.0, COUNT)}
    names, dtypes = ("kind", "response_period", "symmetric"), (np.uint8, np.int32, np.uint8)
    values = {
        name: (("amplitude", "period"), np.repeat(np.array(column, dtype)[:, None], COUNT, axis=1))
        for name, column, dtype in zip(names, zip(*fields, strict=True), dtypes, strict=True)
    }
    return xr.Dataset(values, axes, {"restitution": 0.9} | told)


def picture(ax):
    stream = io.BytesIO()
    ax.figure.savefig(stream, dpi=150)
    return np.asarray(Image.open(stream).convert("RGB")) / 255


def colours_around(ax, x, y, reach=0.3):
    """The colours of a square about a point, reach cells each way."""
    image = picture(ax)
    places = [ax.transData.transform((x + at * reach / (COUNT - 1), y + at * reach)) for at in (-1, 1)]
    (left, low), (right, high) = (np.array(places) * 150 / ax.figure.dpi).astype(int)
    part = image[image.shape[0] - high : image.shape[0] - low, left:right].reshape(-1, 3)
    return {tuple(colour) for colour in np.unique(np.round(part, 2), axis=0)}


def colour(name):
    return tuple(round(part, 2) for part in to_rgb(name))


@pytest.mark.parametrize("row, name", SEEN.items(), ids=str)
def test_each_point_has_its_colour_and_hatch(row, name):
    other = ("rest", 0, 2) if row[0] != "rest" else ("chaotic", 0, 2)
    ax = rk.plot.parametric_map(a_map([other, row, other]))
    expected = {colour(KINDS[name].colour)}
    if KINDS[name].hatch is not None:
        expected.add(colour(KINDS[name].hatch))
    assert colours_around(ax, 1.5, 2.0) == expected
    assert colours_around(ax, 1.5, 3.0) == {colour(KINDS[SEEN[other]].colour)}
    assert f"{name} (33.3 %)" in legend(ax)


def test_only_undetermined_responses_are_hatched():
    assert {name for name, look in KINDS.items() if look.hatch} == {"undetermined"}


@pytest.mark.parametrize("name", ["period 1", "period 3", "5, 7, …"])
def test_asymmetric_responses_have_a_lighter_tint_than_symmetric_ones(name):
    """Lightness of an equal mean of red, green and blue."""
    symmetric = KINDS["period 5, 7, …" if name == "5, 7, …" else name]
    assert np.mean(to_rgb(KINDS[f"{name}, asymmetric"].colour)) > 0.2 + np.mean(to_rgb(symmetric.colour))


@pytest.mark.parametrize("size, named", [(9_999, True), (10_001, False)])
def test_category_below_a_hundredth_of_a_percent_has_no_row_in_the_legend(size, named):
    found = a_map([("rest", 0, 2)] * size)
    found["kind"][-1] = NUMBERS["chaotic"]
    texts = legend(rk.plot.parametric_map(found))
    assert any(text.startswith("chaotic") for text in texts) == named


def test_what_is_not_computed_is_white_and_told():
    ax = rk.plot.parametric_map(a_map([("rest", 0, 2), None, ("periodic", 1, 1), ("chaotic", 0, 2)]))
    assert colours_around(ax, 1.5, 2.0) == {(1.0, 1.0, 1.0)}
    assert legend(ax) == ["rest (25.0 %)", "period 1 (25.0 %)", "chaotic (25.0 %)", "not computed (25.0 %)"]


def test_budget_below_what_chaos_needs_shows_undetermined_and_never_chaotic():
    where = {"amplitude": np.linspace(14.0, 15.0, 3), "period": np.linspace(1.9, 2.1, 3)}
    found = rk.parametric_map(
        system_with(restitution=0.925, brace_angle=1.0), **where, max_cycles=300
    ).dataset
    told = legend(rk.plot.parametric_map(found))
    assert any(text.startswith("undetermined") for text in told)
    assert not any(text.startswith("chaotic") for text in told)


@pytest.mark.parametrize("size, shown", [(2, 2), (2000, 2000), (2001, 1001), (5001, 1667)])
def test_large_map_is_thinned_evenly_and_its_shares_are_those_of_all_points(size, shown):
    found = a_map([("rest", 0, 2)] * size)
    found["kind"][-1] = NUMBERS["chaotic"]
    ax = rk.plot.parametric_map(found)
    assert ax.images[0].get_array().shape == (shown, COUNT)
    share = 100 / size
    assert float(re.search(r"\(([\d.]+) %\)", legend(ax)[-1])[1]) == pytest.approx(
        share, abs=0.05 if share >= 1 else 0.005
    )


def test_rows_thinned_are_every_nth_of_the_map_however_it_is_read(monkeypatch):
    monkeypatch.setattr("rocking.plot.maps.AT_ONCE", 40 * COUNT)
    found = a_map([("rest", 0, 2)] * 5001)
    found["kind"][::3] = NUMBERS["chaotic"]
    drawn = rk.plot.parametric_map(found).images[0].get_array()
    assert (np.asarray(drawn) == list(KINDS).index("chaotic")).all()


def test_unevenly_spaced_values_have_cells_that_end_half_way():
    found = a_map([("rest", 0, 2), ("chaotic", 0, 2), ("overturned", 0, 2)])
    found = found.assign_coords(amplitude=[1.0, 2.0, 10.0])
    ax = rk.plot.parametric_map(found)
    assert colours_around(ax, 1.5, 5.0, reach=0.2) == {colour(KINDS["chaotic"].colour)}
    assert colours_around(ax, 1.5, 7.0, reach=0.2) == {colour(KINDS["overturned"].colour)}
    assert ax.get_ylim() == (0.5, 14.0)


def test_levels_fill_what_the_finest_has_not_yet():
    fine = a_map([("rest", 0, 2), None, None, None, ("chaotic", 0, 2)])
    coarse = a_map([("rest", 0, 2), ("overturned", 0, 2), ("chaotic", 0, 2)])
    coarse = coarse.assign_coords(amplitude=[1.0, 3.0, 5.0])
    ax = rk.plot.parametric_map([coarse, fine])
    assert colours_around(ax, 1.5, 3.0) == {colour(KINDS["overturned"].colour)}
    assert not any(text.startswith("not computed") for text in legend(ax))


def test_store_that_was_stopped_is_drawn_as_far_as_it_is(tmp_path):
    """Its finest level is taken away: what is left is the coarser one."""
    where = {"amplitude": np.linspace(0.0, 9.0, 129), "period": np.linspace(0.3, 2.0, 4)}
    whole = rk.parametric_map(
        system_with(restitution=0.9), **where, max_cycles=50, store=tmp_path / "map.zarr"
    ).dataset
    kinds = whole.kind.values.copy()
    for name in whole.data_vars:
        for chunk in (tmp_path / "map.zarr" / "level-2" / name).rglob("c/*/*"):
            chunk.unlink()
    drawn = rk.plot.parametric_map(tmp_path / "map.zarr").images[0].get_array()
    nearest = np.round(np.arange(129) / 2 - 0.01).astype(int) * 2
    fallen = list(KINDS).index("overturned")
    assert ((drawn == fallen) == (kinds[nearest] == NUMBERS["overturned"])).all()


CURVES = {
    "symmetry-breaking-1": lambda T, e: rk.theory.symmetry_breaking_amplitude(T, e, 1),
    "symmetry-breaking-3": lambda T, e: rk.theory.symmetry_breaking_amplitude(T, e, 3),
    "existence-1": lambda T, e: rk.theory.existence_amplitude(T, e, 1),
    "existence-3": lambda T, e: rk.theory.existence_amplitude(T, e, 3),
    "melnikov": rk.theory.melnikov_amplitude,
    "heteroclinic": rk.theory.heteroclinic_amplitude,
}


def lines_of(ax):
    """Points on the curves, those left out aside."""
    points = np.concatenate([line.get_xydata() for line in ax.lines])
    return points[np.isfinite(points[:, 1])]


@pytest.mark.parametrize("name", CURVES)
def test_curves_are_theorys(name):
    found = a_map([("rest", 0, 2)] * 17)
    x, y = lines_of(rk.plot.parametric_map(found, curves=[name])).T
    assert len(x) > 100 or name.startswith(("existence", "melnikov", "heteroclinic"))
    np.testing.assert_allclose(y, CURVES[name](x, 0.9), rtol=1e-12)


def test_curves_follow_the_frequency_the_restitution_and_si_axes():
    found = a_map([("rest", 0, 2)] * 30).drop_attrs()
    by_frequency = found.rename(period="frequency").assign_coords(frequency=np.linspace(2.0, 9.0, COUNT))
    ax = rk.plot.parametric_map(by_frequency.assign_attrs(restitution=0.8), curves="heteroclinic")
    x, y = lines_of(ax).T
    np.testing.assert_allclose(y, rk.theory.heteroclinic_amplitude(math.tau / x, 0.8), rtol=1e-12)
    by_loss = found.rename(period="restitution").assign_coords(restitution=np.linspace(0.1, 1.0, COUNT))
    x, y = lines_of(rk.plot.parametric_map(by_loss.assign_attrs(period=1.0), curves=["melnikov"])).T
    np.testing.assert_allclose(y, rk.theory.melnikov_amplitude(1.0, x), rtol=1e-12, atol=1e-12)
    block = rk.Block(2.0, 0.5)
    ax = rk.plot.parametric_map(
        found.assign_attrs(restitution=0.9), block=block, curves=["symmetry-breaking-1"]
    )
    x, y = lines_of(ax).T
    expected = rk.theory.symmetry_breaking_amplitude(block.time(x), 0.9, 1)
    np.testing.assert_allclose(block.amplitude(y), expected, rtol=1e-12)


@pytest.mark.parametrize("name", [name for name in CURVES if name.startswith(("symmetry", "existence"))])
def test_curve_ends_where_theory_knows_no_amplitude(name):
    """A block that stays down has none of these modes."""
    found = a_map([("rest", 0, 2)] * 30).drop_attrs().rename(period="restitution")
    found = found.assign_coords(restitution=np.linspace(0.0, 1.0, COUNT)).assign_attrs(period=1.0)
    ax = rk.plot.parametric_map(found, curves=[name])
    x, y = lines_of(ax).T
    assert x.size > 20
    assert x.min() > 0.0
    np.testing.assert_allclose(y, CURVES[name](1.0, x), rtol=1e-12)


def test_legend_says_of_a_curve_that_it_is_not_here():
    found = a_map([("rest", 0, 2)] * 5, restitution=0.9)
    high = found.assign_coords(amplitude=found.amplitude + 900.0)
    for each, label in ((found, "$A_M$ (Melnikov)"), (high, "$A_M$ (Melnikov) (outside)")):
        assert label in legend(rk.plot.parametric_map(each, curves=["melnikov"]))


def test_curve_of_a_mode_is_dotted_where_the_mode_is_not_admissible():
    """The (1, 3) mode at e = .925 is not admissible at A_SB below about T = .8."""
    found = a_map([("rest", 0, 2)] * 16, restitution=0.925)
    found = found.assign_coords(period=np.linspace(0.3, 2.0, COUNT))
    dashed, dotted = rk.plot.parametric_map(found, curves=["symmetry-breaking-3"]).lines
    assert dashed.get_linestyle() == "--"
    ends = [
        np.nanmax(np.where(np.isfinite(line.get_ydata()), line.get_xdata(), np.nan))
        for line in (dotted, dashed)
    ]
    assert 0.7 < ends[0] < 0.9 < ends[1]


@pytest.mark.parametrize("figure", ["10", "11", "13b"])
def test_papers_symbols_are_those_of_its_captions(figure):
    marks = {
        "10": {"quasi-periodic": "o", "chaotic": "+", "rest": "*", "overturned": "x"},
        "11": {"period 1": "o", "period 3": "+", "rest": "*", "overturned": "x"},
        "13b": {"chaotic": "+", "period 1": "*", "period 3": ">", "even period": "s"},
    }[figure]
    rows = list(SEEN)
    ax = rk.plot.parametric_map(a_map(rows), symbols=figure)
    assert not ax.images
    for height, row in enumerate(rows, 1):
        (mark,) = {line.get_marker() for line in ax.lines if height in line.get_ydata()}
        expected = marks.get(SEEN[row])
        assert mark == expected or (expected is None and mark in (".", *marks.values()))


def test_marks_of_the_kinds_are_all_different_and_every_point_has_one():
    ax = rk.plot.parametric_map(a_map(list(SEEN)), symbols="kinds")
    looks = [(line.get_marker(), line.get_markerfacecolor(), line.get_color()) for line in ax.lines]
    marks = {(line.get_marker(), line.get_markerfacecolor() == "white") for line in ax.lines}
    assert len(set(looks)) == len(marks) == len(LOOKS)
    assert sum(len(line.get_xdata()) for line in ax.lines) == COUNT * len(SEEN)


def test_the_longest_name_fits_the_vertical_axis():
    found = rk.parametric_map(
        rk.System(rk.Harmonic(4.0, period=1.0), restitution=0.8, braces=rk.Braces(0.3)),
        brace_restitution=[0.5, 0.7],
        period=[1.0, 1.1],
        max_cycles=200,
    ).dataset
    ax = rk.plot.parametric_map(found)
    ax.figure.draw_without_rendering()
    extent = ax.yaxis.label.get_window_extent()
    assert 0.0 <= extent.y0 < extent.y1 <= ax.figure.bbox.y1
