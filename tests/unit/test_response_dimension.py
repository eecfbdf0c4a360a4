"""Known dimensions of sets lie inside the reported interval, and the interval is narrow."""

import math
import subprocess
import sys

import numpy as np
import pytest
from scipy.spatial import cKDTree

import rocking as rk
from rocking.response import correlation_dimension
from rocking.response.correlation_dimension import CorrelationDimension

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
WIDEST = 0.12


def henon(count, x=0.1, y=0.1, a=1.4, b=0.3):
    points = np.empty((count, 2))
    for k in range(-100, count):
        x, y = 1.0 - a * x * x + y, b * x
        if k >= 0:
            points[k] = x, y
    return points


def circle(count):
    turns = 2.0 * math.pi * GOLDEN * np.arange(count)
    return np.column_stack([np.cos(turns), np.sin(turns)])


def square(count):
    return np.random.default_rng(4).random((count, 2))


def cantor(count):
    digits = 2 * np.random.default_rng(5).integers(0, 2, (count, 34))
    return (digits * 3.0 ** -np.arange(1, 35)).sum(axis=1)


KNOWN = {
    # Grassberger & Procaccia give 1.22 ± .01 for the Hénon attractor, later work 1.20 to 1.26: 1.22 ± .04
    "Hénon attractor": (henon, 1.22, 0.04),
    "circle": (circle, 1.0, 0.0),
    "filled square": (square, 2.0, 0.0),
    "Cantor set": (cantor, math.log(2.0) / math.log(3.0), 0.0),
}


@pytest.mark.parametrize("count", [10_000, pytest.param(30_000, marks=pytest.mark.long)])
@pytest.mark.parametrize("name", KNOWN)
def test_known_dimension_lies_in_a_narrow_interval(name, count):
    points, known, _ = KNOWN[name]
    found = rk.correlation_dimension(points(count))
    low, high = found.interval
    assert low <= known <= high
    assert low <= found.value <= high
    assert high - low <= WIDEST
    assert found.decades >= 1.0
    assert found.space == "section"
    assert found.flow == found.value + 1.0


@pytest.mark.parametrize("count", [10_000, pytest.param(100_000, marks=pytest.mark.long)])
def test_henon_value_is_the_known_one(count):
    found = rk.correlation_dimension(henon(count))
    assert abs(found.value - 1.22) <= 0.04
    assert found.interval[0] <= 1.22 <= found.interval[1]


def test_correlation_sum_is_the_share_of_pairs_by_brute_force():
    points = henon(1_500)
    found = rk.correlation_dimension(points)
    scaled = (points - points.mean(axis=0)) / points.std(axis=0)
    apart = np.hypot(*(scaled[:, None] - scaled[None]).transpose(2, 0, 1))
    lag = np.abs(np.subtract.outer(np.arange(1_500), np.arange(1_500)))
    expected = [(apart[lag > found.theiler] <= radius).mean() for radius in found.radii]
    np.testing.assert_allclose(found.sums, expected, rtol=1e-12)


@pytest.mark.parametrize("theiler", [0, 1, 24])
def test_listing_pairs_and_counting_them_by_trees_are_the_same(theiler):
    """Points along a line in time: most close pairs follow each other, so the window decides what is left."""
    points = np.cumsum(np.random.default_rng(8).normal(size=(3_000, 2)), axis=0)
    tree, radii = cKDTree(points), np.geomspace(0.3, 6.0, 9)
    listed, admitted = correlation_dimension._listed(tree, theiler, radii)
    counted, also_admitted = correlation_dimension._counted(tree, np.arange(3_000), theiler, radii)
    np.testing.assert_array_equal(listed, counted)
    np.testing.assert_array_equal(admitted, also_admitted)
    lag = np.abs(np.subtract.outer(np.arange(3_000), np.arange(3_000)))
    assert admitted[:, 0].sum() == (lag > theiler).sum()


def test_large_sets_are_counted_by_reference_points_within_their_errors():
    """Listed pairs of all points below, some reference points above: both estimate one sum."""
    points = square(20_000)
    found = rk.correlation_dimension(points)
    scaled = (points - points.mean(axis=0)) / points.std(axis=0)
    some = scaled[::40]
    apart = np.hypot(*(some[:, None] - scaled[None]).transpose(2, 0, 1))
    expected = np.array([(apart <= radius).sum() - len(some) for radius in found.radii]) / (
        len(some) * (len(scaled) - 1)
    )
    sure = expected > 1e-4
    np.testing.assert_allclose(found.sums[sure], expected[sure], rtol=0.1)


@pytest.mark.long
def test_errors_of_slopes_are_the_spread_over_sets():
    """24 squares of random points, 17 radii: the ratio of spread and printed error, as a mean square, is known to 4 %."""
    random = np.random.default_rng(6)
    runs = [rk.correlation_dimension(random.random((3_000, 2))) for _ in range(24)]
    radii = [radius for radius in runs[0].radii if all(radius in run.radii for run in runs)][:-1]
    rows = [np.searchsorted(run.radii, radii) for run in runs]
    slopes = np.array([run.slopes[row] for run, row in zip(runs, rows, strict=True)])
    printed = np.array([run.slope_errors[row] for run, row in zip(runs, rows, strict=True)])
    ratio = np.sqrt((slopes.var(axis=0, ddof=1) / (printed**2).mean(axis=0)).mean())
    assert 0.85 < ratio < 1.2


def test_pairs_close_in_time_are_left_out():
    """A circle sampled 125 times a turn: neighbours in time stay near for a fifth of a turn, where cos falls to 1/e."""
    angles = 0.05 * np.arange(8_000)
    found = rk.correlation_dimension(np.column_stack([np.cos(angles), np.sin(angles)]))
    assert found.theiler == math.ceil(math.acos(1 / math.e) / 0.05)
    assert found.interval[0] <= 1.0 <= found.interval[1]
    assert rk.correlation_dimension(henon(3_000)).theiler == 1


def test_units_do_not_matter():
    points = henon(5_000)
    plain, scaled = (rk.correlation_dimension(p) for p in (points, points * [1e-6, 1e4] + [3.0, -7e4]))
    assert scaled.value == pytest.approx(plain.value, abs=1e-4)


def test_same_points_give_the_same_bytes():
    one, two = (rk.correlation_dimension(henon(5_000)) for _ in range(2))
    assert (one.value, one.interval) == (two.value, two.interval)
    np.testing.assert_array_equal(one.sums, two.sums)


def section(amplitude, period, restitution, cycles, transient=0):
    system = rk.System(rk.Harmonic(amplitude, period=period), restitution)
    return rk.simulate(system, cycles=cycles + transient - 1, record="section").section()[transient:]


@pytest.mark.parametrize(("case", "count"), [((2.0, 1.0, 0.925), 1), ((6.5, 0.4, 0.925), 3)])
def test_periodic_motion_is_isolated_points_of_dimension_zero(case, count):
    found = rk.correlation_dimension(section(*case, cycles=1_000, transient=1_000))
    assert (found.value, found.interval, found.isolated) == (0.0, (0.0, 0.0), count)
    assert found.flow == 1.0
    assert ("one point" if count == 1 else "3 isolated points") in str(found)


@pytest.mark.parametrize("value", [0.0, 0.1, 0.3])  # the mean of many 0.1 is not 0.1
def test_equal_points_are_one_point(value):
    found = rk.correlation_dimension(np.full((1_000, 2), value))
    assert (found.value, found.isolated) == (0.0, 1)
    assert str(found) == "dimension 0 of the section: one point, repeated over 1000 points"


def test_islands_of_figure_5_are_curves():
    """A = 4, T = .4, e = 1: three closed curves, dimension 1 of the section and 2 of the flow."""
    found = rk.correlation_dimension(section(4.0, 0.4, 1.0, cycles=20_000))
    assert found.interval[0] <= 1.0 <= found.interval[1]
    assert found.interval[1] - found.interval[0] < WIDEST


@pytest.mark.long
def test_lossy_chaos_has_no_more_dimension_than_its_exponents_give():
    """A = 10.103037, T = 1.721328, e = .8: a curve and more, and Kaplan–Yorke an upper bound for D₂."""
    found = rk.correlation_dimension(section(10.103037, 1.721328, 0.8, cycles=30_000, transient=1_000))
    spectrum = rk.lyapunov(rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8), cycles=100_000)
    value, error = spectrum.kaplan_yorke
    assert found.interval[0] < value + 2 * error
    assert found.interval[1] > 0.95


def test_points_that_do_not_scale_are_refused_with_what_was_found():
    """Small clouds strewn thinly: area within a cloud, single points between, and no decade of radii in either."""
    random = np.random.default_rng(1991)
    clouds = np.repeat(random.random((2_000, 2)), 5, axis=0)
    points = random.permutation(clouds + 1e-3 * random.normal(size=clouds.shape))
    with pytest.raises(
        rk.TooShort, match="^10000 points do not scale over a decade of r; .* of the section, between"
    ) as caught:
        rk.correlation_dimension(points)
    assert isinstance(caught.value.estimate, CorrelationDimension)


BAD = {
    "words": ("abc", TypeError, r"^points must be points of shape \(n,\) or \(n, d\); got 'abc'$"),
    "ragged": ([[1, 2], [3]], TypeError, r"^points must be points of shape \(n,\) or \(n, d\); got .*$"),
    "a number": (3.0, ValueError, r"^points must be points of shape \(n,\) or \(n, d\); got 3\.0$"),
    "too few": (
        np.ones((10, 2)),
        ValueError,
        r"^points must be 1,000 to 10,000,000 in number; got 10 \(a section has one point per cycle .*\)$",
    ),
    "a cube": (
        np.ones((20, 20, 20)),
        ValueError,
        r"^points must be points of shape \(n,\) or \(n, d\); got .*$",
    ),
    "one NaN": (np.append(np.ones(2_000), math.nan), ValueError, "^points must be finite; row 2000 is not$"),
    "far too few for their number of coordinates": (
        np.random.default_rng(1).random((1_000, 50)),
        ValueError,
        "^1000 points are too few for a dimension: close pairs span less than half a decade of r",
    ),
    "a motion": (
        rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), cycles=2),
        TypeError,
        r"^points must be points of .*; got Motion.* \(pass the points of its section, motion\.section\(\)\)$",
    ),
    "an overturned motion": (
        rk.simulate(rk.System(rk.Harmonic(1.75, period=2.0), 0.95), cycles=2_000),
        ValueError,
        "^the block must stay upright for a dimension; it overturned in cycle 5$",
    ),
    "what is left of an overturned motion": (
        rk.simulate(rk.System(rk.Harmonic(1.75, period=2.0), 0.95), cycles=2_000).section(),
        ValueError,
        r"^points must be 1,000 to .*; got 6 \(.* until the block overturns\)$",
    ),
    "NaN": (np.full((2_000, 2), math.nan), ValueError, "^points must be finite; row 0 is not$"),
    "infinite": (
        np.append(np.arange(2_000.0), math.inf),
        ValueError,
        "^points must be finite; row 2000 is not$",
    ),
    "a trend": (np.linspace(0, 1, 5_000), ValueError, "^5000 points are too few .* correlated over a tenth"),
}


@pytest.mark.parametrize("label", BAD)
def test_what_has_no_dimension_is_refused_in_one_line(label):
    points, kind, message = BAD[label]
    with pytest.raises(kind, match=message):
        rk.correlation_dimension(points)


LINE = np.random.default_rng(1).random(5_000)


@pytest.fixture(scope="module")
def alone():
    """The dimension of one coordinate."""
    return rk.correlation_dimension(LINE)


@pytest.mark.parametrize("beside", [0.0, 0.1, 1e300])
def test_a_coordinate_that_never_changes_adds_nothing(beside, alone):
    together = rk.correlation_dimension(np.column_stack([LINE, LINE * 0 + beside]))
    assert together.interval == pytest.approx(alone.interval, rel=1e-9)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("scale", [1e-310, 1e-200, 1e200, 1e299])
def test_no_size_of_a_coordinate_overflows(scale):
    points = np.random.default_rng(1).random((2_000, 2))
    found, known = rk.correlation_dimension(points * scale), rk.correlation_dimension(points)
    # numbers below 1e-308 keep fewer digits
    assert found.interval == pytest.approx(known.interval, rel=1e-6)


@pytest.mark.parametrize(
    ("count", "most"), [(20_000, 0.5e9), pytest.param(100_000, 1e9, marks=pytest.mark.long)]
)
def test_many_points_fit_in_a_gigabyte(count, most):
    """All distances between 20,000 points would take 3.2 GB."""
    code = """
import numpy as np, pathlib, resource, rocking as rk, sys
points = np.random.default_rng(1).random((int(sys.argv[1]), 2))
rk.correlation_dimension(points)
# what getrusage tells on Linux begins with the memory of the process that started this one
status = pathlib.Path("/proc/self/status")
most = [line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM")] if status.exists() else []
print(most[0] if most else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
    done = subprocess.run(
        [sys.executable, "-c", code, str(count)], capture_output=True, text=True, check=True
    )
    unit = 1 if sys.platform == "darwin" else 1024
    assert int(done.stdout) * unit < most
