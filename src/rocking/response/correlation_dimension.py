"""Correlation dimension of a set of points: counts of pairs, the scaling range, and an interval."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.result import Result, along, described
from rocking.model.validation import Refusal, Text, TooShort, WrongType, reals, refuse_if
from rocking.motion.motion import Motion

if TYPE_CHECKING:
    import xarray as xr


Array = NDArray[np.float64]
Places = NDArray[np.intp]

STEPS_PER_OCTAVE = 4
# Beyond the spread of the points, the pair count saturates.
MAX_RADIUS = 0.5
BLOCKS = 16
# With fewer close pairs in a block, the logarithm of their number is dominated by noise.
MIN_PAIRS = 64
REFERENCES = 2_000
# Largest number of pairs listed individually, at about 100 bytes each.
MAX_PAIRS = 3e6


def pairs_within(scaled: Array, theiler: int, same: float) -> tuple[Array, Array, Array]:
    """Count pairs within radii, for reference points in blocks that are consecutive in time.

    Pairs that follow each other by at most ``theiler`` points are excluded. Radii are larger than ``same``.

    Returns
    -------
    radii : ndarray, shape (n,)
        Radii in ascending order.
    counts, pairs : ndarray, shape (blocks, n)
        Number of pairs within each radius, and number of all pairs.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(scaled)
    nearest = np.sort(tree.query(scaled, k=2)[0][:, 1])
    smallest = max(float(nearest[MIN_PAIRS]), same)
    octaves = max(math.log2(MAX_RADIUS / smallest), 0.0)
    radii = MAX_RADIUS * 2.0 ** (-np.arange(int(octaves * STEPS_PER_OCTAVE), -1, -1) / STEPS_PER_OCTAVE)
    # Large radii need few reference points; small radii use all points.
    few = np.sort(np.random.default_rng(0).permutation(len(scaled))[:REFERENCES])
    counts, pairs = _counted(tree, few, theiler, radii)
    near = int(np.searchsorted(0.5 * counts.sum(axis=0) * len(scaled) / len(few), MAX_PAIRS))
    if near and len(few) < len(scaled):
        counts[:, :near], pairs[:, :near] = _listed(tree, theiler, radii[:near])
    scarce = np.flatnonzero(counts.min(axis=0) < MIN_PAIRS)
    first = int(scarce[-1]) + 1 if scarce.size else 0
    return radii[first:], counts[:, first:], pairs[:, first:]


def _counted(tree: Any, chosen: Places, theiler: int, radii: Array) -> tuple[Array, Array]:
    """Count pairs of selected reference points with all points, one tree per block."""
    from scipy.spatial import cKDTree

    counts = []
    for block in np.array_split(chosen, BLOCKS):
        close = np.zeros(len(radii))
        for lag in range(-theiler, theiler + 1):
            here = block[(block + lag >= 0) & (block + lag < tree.n)]
            close += _within(tree.data[here + lag] - tree.data[here], radii)
        counts.append(cKDTree(tree.data[block]).count_neighbors(tree, radii) - close)
    return np.array(counts), np.repeat(_admitted(chosen, tree.n, theiler), len(radii), axis=1)


def _listed(tree: Any, theiler: int, radii: Array) -> tuple[Array, Array]:
    """Count pairs of all points by listing them."""
    listed = tree.query_pairs(radii[-1], output_type="ndarray")
    listed = listed[np.abs(listed[:, 1] - listed[:, 0]) > theiler]
    distances = np.sqrt(((tree.data[listed[:, 0]] - tree.data[listed[:, 1]]) ** 2).sum(axis=1))
    bins = np.searchsorted(radii, distances)
    everyone = np.arange(tree.n)
    block_of = np.repeat(np.arange(BLOCKS), [len(block) for block in np.array_split(everyone, BLOCKS)])
    cells = sum(
        np.bincount(block_of[listed[:, end]] * len(radii) + bins, minlength=BLOCKS * len(radii))
        for end in (0, 1)
    )
    counts = np.cumsum(np.reshape(cells, (BLOCKS, len(radii))), axis=1).astype(float)
    return counts, np.repeat(_admitted(everyone, tree.n, theiler), len(radii), axis=1)


def _within(differences: Array, radii: Array) -> NDArray[np.intp]:
    distances = np.sort(np.sqrt((differences**2).sum(axis=1)))
    return np.searchsorted(distances, radii, side="right")


def _admitted(chosen: Places, points: int, theiler: int) -> Array:
    """Number of points outside the Theiler windows of the selected points, shape (blocks, 1)."""
    outside = np.maximum(chosen - theiler, 0) + np.maximum(points - 1 - chosen - theiler, 0)
    return np.array([[float(block.sum())] for block in np.array_split(outside, BLOCKS)])


DECADE = math.log(10.0)
MIN_LENGTH = 0.5 * DECADE
# Limits of the width of the interval. The first that some region of a decade meets is used.
WIDTHS = (0.08, 0.12, 0.2, 0.4)
# Overlapping halves of a region whose slopes are compared.
HALVES = 5
# Each pair is counted from both ends, in two blocks, so the blocks underestimate the variance by a factor of 2.
TWICE = math.sqrt(2.0)


@frozen
class Scaling:
    """Scaling region, with its slope and interval, and the data at every radius.

    Attributes
    ----------
    region : tuple of int
        Indices of the first and last radius.
    found : bool
        True if the region spans a decade within the widest interval allowed.
    slope : float
        Slope of ln C against ln r.
    interval : tuple of float
        Interval of the slope.
    sums, slopes, slope_errors : ndarray
        Correlation sums, local slopes and their standard errors.
    """

    region: tuple[int, int]
    found: bool
    slope: float
    interval: tuple[float, float]
    sums: Array
    slopes: Array
    slope_errors: Array


def scaling_region(radii: Array, counts: Array, pairs: Array) -> Scaling | None:
    """Find the longest range of radii over which ln C has one slope; None for less than half a decade of radii.

    Parameters
    ----------
    radii : ndarray, shape (n,)
        Radii in geometric progression.
    counts, pairs : ndarray, shape (blocks, n)
        Number of pairs within each radius, and number of all pairs, for reference points in blocks.
    """
    if len(radii) < 3 or math.log(radii[-1] / radii[0]) < MIN_LENGTH:
        return None
    x = np.log(radii)
    y = np.log(counts.sum(axis=0) / pairs.sum(axis=0))
    # jackknife: each row omits one block
    fits = _Fits(x, np.vstack([y, np.log((counts.sum(axis=0) - counts) / (pairs.sum(axis=0) - pairs))]))
    first, last, result = _longest(fits)
    low, high = fits.interval(first, last)
    local = [fits.slope(k, k + 1) for k in range(len(x) - 1)]
    return Scaling(
        region=(first, last),
        found=result,
        slope=fits.slope(first, last)[0],
        interval=(max(low, 0.0), high),
        sums=np.exp(y),
        slopes=np.array([pair[0] for pair in local]),
        slope_errors=np.array([pair[1] for pair in local]),
    )


class _Fits:
    """Straight-line fits to any range of the points, in constant time each."""

    def __init__(self, x: Array, rows: Array) -> None:
        self.x = x - x.mean()
        self.sums = [
            np.concatenate([np.zeros((len(rows), 1)), np.cumsum(terms, axis=1)], axis=1)
            for terms in (rows, rows * self.x)
        ]
        self.moments = [np.concatenate([[0.0], np.cumsum(self.x**power)]) for power in (1, 2)]

    def slope(self, first: int, last: int) -> tuple[float, float]:
        """Return the slope over a range, ends included, and its jackknife standard error."""
        count = last - first + 1
        sy, sxy = (terms[:, last + 1] - terms[:, first] for terms in self.sums)
        sx, sxx = (moment[last + 1] - moment[first] for moment in self.moments)
        slopes = (count * sxy - sx * sy) / (count * sxx - sx * sx)
        blocks = len(slopes) - 1
        spread = math.sqrt((blocks - 1) / blocks * ((slopes[1:] - slopes[1:].mean()) ** 2).sum())
        return float(slopes[0]), TWICE * spread

    def interval(self, first: int, last: int) -> tuple[float, float]:
        """Return the interval of the slope of a range.

        It spans the slopes of the whole range and of its halves. On both sides, the margin is the spread of these slopes
        plus two standard errors.
        """
        slope, error = self.slope(first, last)
        half = (last - first) // 2
        starts = first + np.round(np.linspace(0, last - first - half, HALVES)).astype(int)
        slopes = [slope, *(self.slope(start, start + half)[0] for start in starts.tolist())]
        margin = max(slopes) - min(slopes) + 2.0 * error
        return min(slopes) - margin, max(slopes) + margin


def _longest(fits: _Fits) -> tuple[int, int, bool]:
    """Return the longest region of a decade or more within the first possible width.

    Returns
    -------
    tuple of (int, int, bool)
        Indices of the first and last radius; True. If there is none, the region with the narrowest interval; False.
    """
    x = fits.x
    regions = []
    for first in range(len(x)):
        for last in range(int(np.searchsorted(x, x[first] + MIN_LENGTH - 1e-9)), len(x)):
            low, high = fits.interval(first, last)
            regions.append((first, last, float(x[last] - x[first]), high - low))
    for widest in WIDTHS:
        fair = [region for region in regions if region[3] <= widest and region[2] >= DECADE - 1e-9]
        if fair:
            best = max(fair, key=lambda region: (round(region[2], 6), -region[3]))
            return best[0], best[1], True
    best = min(regions, key=lambda region: region[3])
    return best[0], best[1], False


MIN_POINTS = 1_000
MAX_POINTS = 10_000_000
# Points closer than this fraction of the spread are identical: converged orbits repeat to rounding.
SAME = 1e-9
# A coordinate of magnitude 1 with a smaller spread is constant.
ROUNDING = 1e-12


@frozen(eq=False, slots=False)
class CorrelationDimension(ReadOnlyArrays, Result):
    """Correlation dimension of a set of points, with an interval; returned by `correlation_dimension`.

    Attributes
    ----------
    value : float
        Slope of ln C against ln r over the scaling region.
    interval : tuple of float
        Lower and upper end. The interval spans the slopes of the region and of five overlapping halves of it. It is
        widened on both sides by the range of these slopes plus two standard errors.
    space : str
        "section": the dimension refers to the given points. The dimension of the flow is one more, see `flow`.
    points : int
        Number of points.
    theiler : int
        Theiler window: pairs that follow each other by at most this number of points are excluded.
    scaling_region : tuple of float
        Smallest and largest radius.
    radii : ndarray, shape (n,)
        Radii r, in standard deviations of each coordinate.
    sums : ndarray, shape (n,)
        Correlation sum C(r): fraction of pairs within r.
    slopes, slope_errors : ndarray, shape (n - 1,)
        Local slopes between neighbouring radii, and their standard errors.
    isolated : int or None
        Number of distinct points, if they are too few for pairs to scale. The dimension is then exactly 0.

    Notes
    -----
    In the dataset, `correlation_sum` is over `radius`; `slope` and `slope_error` are along `interval`, between neighbouring radii.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> motion = rk.simulate(system, cycles=3000, record="section")
    >>> print(rk.correlation_dimension(motion.section()[1000:]))
    dimension 0 of the section: 3 isolated points, repeated over 2001 points
    """

    PLOT = "correlation_dimension"

    value: float
    interval: tuple[float, float]
    points: int
    theiler: int
    scaling_region: tuple[float, float]
    radii: Array = field(repr=False, converter=read_only)
    sums: Array = field(repr=False, converter=read_only)
    slopes: Array = field(repr=False, converter=read_only)
    slope_errors: Array = field(repr=False, converter=read_only)
    isolated: int | None = None
    space: str = "section"

    @property
    def flow(self) -> float:
        """Correlation dimension of the flow: that of the section plus 1."""
        return self.value + 1.0

    @property
    def decades(self) -> float:
        """Width of the scaling region, in decades of r."""
        return 0.0 if self.isolated else math.log10(self.scaling_region[1] / self.scaling_region[0])

    def _data(self) -> xr.Dataset:
        import xarray as xr

        sums = {"correlation_sum": (self.sums, "fraction of pairs within the radius")}
        slopes = {
            "slope": (self.slopes, "slope of ln C against ln r between neighbouring radii"),
            "slope_error": (self.slope_errors, "standard error of the slope"),
        }
        radius = {"radius": (self.radii, "radius in standard deviations of each coordinate")}
        attributes = described("Correlation dimension of the motion") | {
            "value": self.value,
            "interval_ends": list(self.interval),
            "scaling_region": list(self.scaling_region),
            "points": self.points,
            "theiler": self.theiler,
            "decades": self.decades,
            "isolated": self.isolated or 0,
        }
        variables = along("radius", sums) | along("interval", slopes)
        return xr.Dataset(variables, along("radius", radius), attributes)

    def _repr_html_(self) -> str | None:
        return None if self.isolated else super()._repr_html_()

    def __str__(self) -> str:
        if self.isolated:
            what = "one point" if self.isolated == 1 else f"{self.isolated} isolated points"
            return f"dimension 0 of the section: {what}, repeated over {self.points} points"
        return f"dimension {_interval(self)}, over {self.decades:.1f} decades of r from {self.points} points"


def correlation_dimension(points: ArrayLike) -> CorrelationDimension:
    """Estimate the correlation dimension of points on a section (Grassberger & Procaccia), with an interval.

    The correlation sum C(r) is the fraction of pairs closer than r. Pairs are counted with k-d trees, after division of each
    coordinate by its standard deviation, which does not change the dimension. Pairs close in time are excluded (Theiler), up
    to the first lag at which the autocorrelation of every coordinate is below 1/e. The scaling region is determined
    automatically. It is the longest range of r of at least a decade with an interval narrower than 0.08. If there is none,
    the limits 0.12, 0.2 and 0.4 are tried.

    Parameters
    ----------
    points : array_like, shape (n,) or (n, d)
        At least 1,000 points in the order of time. 10⁴ points resolve a dimension of 1 to 2 in the plane, and 10⁵ resolve it
        to a few hundredths.

    Returns
    -------
    CorrelationDimension
        Dimension, interval, scaling region and correlation sums.

    Raises
    ------
    TypeError
        If `points` does not hold points.
    ValueError
        If points are not finite, fewer than 1,000, or correlated over a tenth of their number.
    TooShort
        If no decade of r has a slope with an interval narrower than 0.4. Its `estimate` is the result of the half decade
        with the most uniform slope.

    See Also
    --------
    lyapunov : Lyapunov exponents.
    rocking.plot.correlation_dimension : Plot the correlation sum and its slopes.

    Notes
    -----
    A set of few points that repeat, such as the section of a periodic motion, has dimension 0 exactly (`isolated`). Points
    count as identical if they agree to 1e-9 of the spread.

    Limits: the scaling region need not extend to r → 0. A set can scale with one exponent over the radii that the points
    resolve, and with another below. With fewer than about 5,000 points, only large radii hold enough pairs. Boundaries then
    lower the slope by more than the interval includes.

    References
    ----------
    Grassberger & Procaccia, Physica D 9, 189–208 (1983); Theiler, Physical Review A 34, 2427–2432 (1986).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> turns = 2 * np.pi * np.arange(5_000) * 0.5 * (5**0.5 - 1)
    >>> dimension = rk.correlation_dimension(np.column_stack([np.cos(turns), np.sin(turns)]))
    >>> dimension.interval[0] <= 1 <= dimension.interval[1], round(dimension.flow, 1)
    (True, 2.0)
    """
    cloud = _cloud(points)
    distinct = _distinct(cloud)
    if 10 * distinct <= len(cloud):
        return _finite(len(cloud), distinct)
    scaled = _scaled(cloud)
    theiler = _theiler(scaled)
    radii, counts, pairs = pairs_within(scaled, theiler, SAME)
    scaling = scaling_region(radii, counts, pairs)
    if scaling is None:
        raise ValueError(
            f"{len(cloud)} points are too few for a dimension: close pairs span less than half a decade of r "
            "(use more points)"
        )
    dimension = _dimension(len(cloud), theiler, radii, scaling)
    if not scaling.found:
        raise TooShort(
            f"{len(cloud)} points do not scale over a decade of r; the range of radii with the most uniform slope gives "
            f"{_interval(dimension)} (use more points, or discard a longer transient)",
            dimension,
        )
    return dimension


def _interval(dimension: CorrelationDimension) -> str:
    low, high = dimension.interval
    return f"{dimension.value:.3f} of the section, between {low:.3f} and {high:.3f}"


def _dimension(points: int, theiler: int, radii: Array, scaling: Scaling) -> CorrelationDimension:
    low, high = scaling.region
    return CorrelationDimension(
        value=scaling.slope,
        interval=scaling.interval,
        points=points,
        theiler=theiler,
        scaling_region=(float(radii[low]), float(radii[high])),
        radii=radii,
        sums=scaling.sums,
        slopes=scaling.slopes,
        slope_errors=scaling.slope_errors,
    )


def _finite(points: int, distinct: int) -> CorrelationDimension:
    nothing = np.empty(0)
    return CorrelationDimension(
        0.0,
        (0.0, 0.0),
        points,
        0,
        (0.0, 0.0),
        nothing,
        nothing.copy(),
        nothing.copy(),
        nothing.copy(),
        distinct,
    )


def _cloud(points: ArrayLike) -> Array:
    allowed = "be points of shape (n,) or (n, d)"
    if isinstance(points, Motion):
        if points.overturning is not None:
            raise ValueError(
                f"the block must stay upright for a dimension; it overturned in cycle {points.overturning.cycle}"
            )
        raise WrongType("points", allowed, points, "pass the points of its section, motion.section()")
    try:
        cloud = np.asarray(reals("points", points))
    except TypeError:
        raise WrongType("points", allowed, points) from None
    if cloud.ndim == 1:
        cloud = cloud[:, None]
    refuse_if(cloud.ndim != 2 or cloud.shape[1] == 0, "points", allowed, points)
    if len(cloud) < MIN_POINTS or len(cloud) > MAX_POINTS:
        raise Refusal(
            "points",
            f"be {MIN_POINTS:,} to {MAX_POINTS:,} in number",
            Text(f"{len(cloud):,}"),
            "a section has one point per cycle until the block overturns",
        )
    if not np.isfinite(cloud).all():
        raise ValueError(
            f"points must be finite; row {int(np.argmin(np.isfinite(cloud).all(axis=1)))} is not"
        )
    # scaled to magnitude 1, so that squares neither overflow nor underflow
    size = np.abs(cloud).max(axis=0)
    return cloud / np.where(size > 0.0, size, 1.0)


def _distinct(cloud: Array) -> int:
    """Number of distinct points; those within 1e-9 of the spread, or 1e-12 of their own magnitude, count as one."""
    same = np.maximum(SAME * np.ptp(cloud, axis=0), ROUNDING)
    cells = np.floor((cloud - cloud.min(axis=0)) / same + 0.5)
    return len(np.unique(cells, axis=0))


def _scaled(cloud: Array) -> Array:
    """Return the points relative to their mean, in standard deviations; 0 for a constant coordinate."""
    constant = np.ptp(cloud, axis=0) <= ROUNDING
    about = np.where(constant, 0.0, cloud - cloud.mean(axis=0))
    return about / np.where(constant, 1.0, about.std(axis=0))


def _theiler(scaled: Array) -> int:
    """Return the first lag at which the autocorrelation of every coordinate is below 1/e."""
    longest = len(scaled) // 10
    size = 2 ** math.ceil(math.log2(len(scaled) + longest))
    power = np.abs(np.fft.rfft(scaled, size, axis=0)) ** 2
    correlation = np.fft.irfft(power, axis=0)[:longest]
    decayed = (correlation < correlation[0] / math.e) | (correlation[0] == 0.0)
    if not decayed.any(axis=0).all():
        raise ValueError(
            f"{len(scaled)} points are too few for a dimension: they are correlated over a tenth of their number "
            "(use more points, or points farther apart in time)"
        )
    return int(np.argmax(decayed, axis=0).max())
