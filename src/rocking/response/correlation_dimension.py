"""Correlation dimension of a set of points: pairs within r, the range over which they scale, and an interval."""

from __future__ import annotations

import math

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.model import ReadOnlyArrays, TooShort, read_only, reals, refusal
from rocking.motion import Motion
from rocking.response.pair_counts import pairs_within
from rocking.response.scaling_region import Scaling, scaling_region

Array = NDArray[np.float64]

MIN_POINTS = 1_000
MAX_POINTS = 10_000_000
# Points closer than this share of the whole spread are one: converged orbits repeat to rounding.
SAME = 1e-9
# A coordinate of size 1 that spreads by no more is constant.
ROUNDING = 1e-12


@frozen(eq=False, slots=False)
class CorrelationDimension(ReadOnlyArrays):
    """The correlation dimension of a set of points, as an interval; made by `correlation_dimension`.

    Attributes
    ----------
    value : float
        Slope of ln C against ln r over the scaling region.
    interval : tuple of float
        Low and high: the slopes of the region and of five overlapping halves of it, and beyond them as much again as
        these differ by and two standard errors.
    space : str
        "section": the dimension of the points given. The flow that they are a section of has one more, `flow`.
    points : int
        How many there were.
    theiler : int
        Pairs that follow each other by no more than this are left out.
    scaling_region : tuple of float
        Low and high radius.
    radii, sums : ndarray, shape (n,)
        r, in standard deviations of each coordinate, and the correlation sum C(r): the share of pairs within r.
    slopes, slope_errors : ndarray, shape (n - 1,)
        Local slopes between neighbouring radii and their standard errors.
    isolated : int or None
        How many points there are, where they are so few that pairs do not scale: the dimension is then 0, exactly.
    """

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
        """The dimension of the flow that the points are a section of: one more."""
        return self.value + 1.0

    @property
    def decades(self) -> float:
        """How far the scaling region reaches, in decades of r."""
        return 0.0 if self.isolated else math.log10(self.scaling_region[1] / self.scaling_region[0])

    def __str__(self) -> str:
        if self.isolated:
            what = "one point" if self.isolated == 1 else f"{self.isolated} isolated points"
            return f"dimension 0 of the section: {what}, met {self.points} times"
        return f"dimension {_interval(self)}, over {self.decades:.1f} decades of r from {self.points} points"


def correlation_dimension(points: ArrayLike) -> CorrelationDimension:
    """Estimate the correlation dimension of points on a section, after Grassberger & Procaccia, as an interval.

    The correlation sum C(r), the share of pairs closer than r, is counted with k-d trees; coordinates are first divided
    by their standard deviations, which changes no dimension. Pairs close in time are left out (Theiler): up to the
    first lag at which the autocorrelation of every coordinate is below 1/e. The scaling region is found, not chosen:
    the longest range of r, a decade at least, whose interval is narrower than 0.08, or else 0.12, 0.2, 0.4.

    Parameters
    ----------
    points : array_like, shape (n,) or (n, d)
        In the order of time; 1,000 at least. 10⁴ resolve a dimension of 1 to 2 in the plane, 10⁵ to a few
        hundredths.

    Returns
    -------
    CorrelationDimension

    Raises
    ------
    TypeError, ValueError
        In one line, for what holds no points, or points that are not finite; for fewer than 1,000 points, or points
        correlated over a tenth of their number.
    TooShort
        Where no decade of r has a slope known to 0.4; its `estimate` is what the most even half decade gives.

    See Also
    --------
    lyapunov : Lyapunov exponents.
    rocking.plot.dimension : Plot the correlation sum and its slopes.

    Notes
    -----
    A set of few points met again and again, as the section of a periodic motion is, has dimension 0 exactly
    (`isolated`); points count as one where they agree to 1e-9 of the spread.

    Not guaranteed: that the region found is the one that goes on to r → 0. A set can scale with one exponent over the
    radii that the points resolve, and with another below. With fewer than some 5,000 points the radii that hold enough
    pairs are so large that boundaries lower the slope by more than the interval owns to.

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
            f"{len(cloud)} points are too few for a dimension: there are close pairs over less than half a decade of r "
            "(take more points)"
        )
    dimension = _dimension(len(cloud), theiler, radii, scaling)
    if not scaling.found:
        raise TooShort(
            f"{len(cloud)} points do not scale over a decade of r; the most even range of radii gives "
            f"{_interval(dimension)} (take more points, or from motion that has settled)",
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
                f"the block must stay up for a dimension; it overturned in cycle {points.overturning.cycle}"
            )
        raise TypeError(refusal("points", allowed, points, "take those of its section, motion.section()"))
    try:
        cloud = np.asarray(reals("points", points))
    except TypeError:
        raise TypeError(refusal("points", allowed, points)) from None
    if cloud.ndim == 1:
        cloud = cloud[:, None]
    if cloud.ndim != 2 or cloud.shape[1] == 0:
        raise ValueError(refusal("points", allowed, points))
    if len(cloud) < MIN_POINTS or len(cloud) > MAX_POINTS:
        raise ValueError(
            f"points must be {MIN_POINTS:,} at least and {MAX_POINTS:,} at most; got {len(cloud):,} "
            "(a section has one a cycle, as long as the block stays up)"
        )
    if not np.isfinite(cloud).all():
        raise ValueError(
            f"points must be finite; row {int(np.argmin(np.isfinite(cloud).all(axis=1)))} is not"
        )
    # of size 1: no square leaves the range of doubles
    size = np.abs(cloud).max(axis=0)
    return cloud / np.where(size > 0.0, size, 1.0)


def _distinct(cloud: Array) -> int:
    """How many points there are when those within 1e-9 of the spread, or 1e-12 of their own size, count as one."""
    same = np.maximum(SAME * np.ptp(cloud, axis=0), ROUNDING)
    cells = np.floor((cloud - cloud.min(axis=0)) / same + 0.5)
    return len(np.unique(cells, axis=0))


def _scaled(cloud: Array) -> Array:
    """The points about their mean, in standard deviations; 0 where a coordinate is constant."""
    constant = np.ptp(cloud, axis=0) <= ROUNDING
    about = np.where(constant, 0.0, cloud - cloud.mean(axis=0))
    return about / np.where(constant, 1.0, about.std(axis=0))


def _theiler(scaled: Array) -> int:
    """The first lag at which every coordinate's autocorrelation is below 1/e."""
    longest = len(scaled) // 10
    size = 2 ** math.ceil(math.log2(len(scaled) + longest))
    power = np.abs(np.fft.rfft(scaled, size, axis=0)) ** 2
    correlation = np.fft.irfft(power, axis=0)[:longest]
    decayed = (correlation < correlation[0] / math.e) | (correlation[0] == 0.0)
    if not decayed.any(axis=0).all():
        raise ValueError(
            f"{len(scaled)} points are too few for a dimension: they stay correlated over a tenth of their number "
            "(take more of them, or farther apart in time)"
        )
    return int(np.argmax(decayed, axis=0).max())
