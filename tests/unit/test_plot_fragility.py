"""Pictures of incremental dynamic analyses and of fragilities: what is drawn is what was computed."""

import numpy as np
import pytest

import rocking as rk
from drawn import artists, legend
from rocking.plot.record_surveys import flat_ended

BLOCK = rk.Block(2.0, 0.5)


@pytest.fixture(scope="module")
def records():
    return rk.synthetic_ground_motions(12, seed=1)


@pytest.fixture(scope="module")
def analysis(records):
    return rk.incremental_dynamic_analysis(
        records, BLOCK, np.linspace(1.0, 8.0, 15), intensity="pga", model="slender"
    )


@pytest.fixture(scope="module")
def fragility(records):
    return rk.fragility(records, BLOCK, np.linspace(0.2, 1.0, 9), intensity="pga-g", model="slender")


def test_a_curve_is_flat_where_the_block_overturns():
    inf = np.inf
    across, up = flat_ended(np.array([0.0, 2.0, inf, inf, 5.0, 6.0]), np.arange(1.0, 7.0), 20.0)
    assert across.tolist() == pytest.approx([0.0, 2.0, 20.0, np.nan, 20.0, 5.0, 6.0], nan_ok=True)
    assert up.tolist() == pytest.approx([1.0, 2.0, 2.0, np.nan, 5.0, 5.0, 6.0], nan_ok=True)
    assert flat_ended(np.array([inf, inf]), np.array([1.0, 2.0]), 9.0)[0].size == 0


def test_peaks_of_each_record_are_drawn_in_degrees(analysis):
    ax = rk.plot.incremental_dynamic_analysis(analysis)
    lines = artists(ax, "record")
    peaks = BLOCK.degrees(analysis.dataset.peak.values)
    assert len(lines) == 12
    edge = ax.get_xlim()[1]
    for line, each in zip(lines, peaks, strict=True):
        across = line.get_xdata()
        standing = across[np.isfinite(across) & (across < edge)]
        assert standing.tolist() == each[np.isfinite(each)].tolist()
        assert (across == edge).any() == np.isinf(each).any()
    assert [line.get_label() for line in artists(ax, "fractile")] == [
        "16 % fractile",
        "50 % fractile",
        "84 % fractile",
    ]
    assert (ax.get_xlabel(), ax.get_ylabel()) == (
        r"largest angle $|\theta|$ (°)",
        "peak ground acceleration PGA (m/s²)",
    )
    assert (ax.get_title(loc="left"), ax.get_title(loc="right")) == ("block 2 m × 0.5 m", "12 records")


def test_fractions_fits_and_intervals_are_drawn(fragility):
    ax = rk.plot.fragility(fragility)
    data = fragility.dataset
    points = np.concatenate([line.get_ydata() for line in artists(ax, "fraction")])
    assert sorted(points) == pytest.approx(sorted(100 * data.fraction.values.ravel()))
    fitted = [limit for limit in range(3) if np.isfinite(data.fit.values[limit]).all()]
    assert len(fitted) >= 2
    for line, limit in zip(artists(ax, "fit"), fitted, strict=True):
        assert line.get_xdata().size >= 200
        at = np.searchsorted(line.get_xdata(), data.level.values)
        assert line.get_xdata()[at].tolist() == data.level.values.tolist()
        assert line.get_ydata()[at] == pytest.approx(100 * data.fit.values[limit])
        assert (np.diff(line.get_ydata()) >= 0.0).all()
    for band, limit in zip(artists(ax, "band"), fitted, strict=True):
        corners = band.get_paths()[0].vertices[:, 1]
        ends = 100 * np.concatenate([data.fit_low.values[limit], data.fit_high.values[limit]])
        assert np.abs(corners[:, None] - ends).min(axis=0).max() < 1e-9
    ends = [segment[:, 1] for each in ax.containers for bars in each[2] for segment in bars.get_segments()]
    expected = 100 * np.stack([data.fraction_low.values, data.fraction_high.values], axis=-1).reshape(-1, 2)
    assert np.array(ends) == pytest.approx(expected)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("peak ground acceleration PGA (g)", "probability (%)")
    texts = legend(ax)
    assert texts[2:] == [
        "overturning",
        "95 % interval",
        "lognormal fit",
        "95 % band of the fit",
        "0 or 100 % of the runs",
    ]
    assert texts[0].startswith(r"$|\theta| > 1.4°$")


def test_number_of_blocks_is_stated_and_levels_of_a_block_have_their_symbol(records):
    found = rk.fragility(
        records,
        BLOCK,
        [1.0, 2.0, 3.0],
        intensity="pga-ratio",
        limits=(),
        samples=2,
        width_spread=0.1,
        model="slender",
    )
    ax = rk.plot.fragility(found)
    assert ax.get_title(loc="right") == "12 records × 2 blocks"
    assert ax.get_xlabel() == r"PGA$/(g\,\tan\theta_\mathrm{cr})$"


def test_a_fragility_without_a_fit_is_drawn_without_a_curve(records):
    ax = rk.plot.fragility(rk.fragility(records, BLOCK, [0.5, 1.0], limits=(), model="slender"))
    assert artists(ax, "fit") == artists(ax, "band") == []
    texts = legend(ax)
    assert texts == ["overturning", "95 % interval", "0 or 100 % of the runs"]
    assert np.concatenate([line.get_ydata() for line in artists(ax, "fraction")]).tolist() == [0.0, 0.0]
