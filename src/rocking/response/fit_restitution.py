"""Coefficient of restitution from the times of the impacts of a free rocking test."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.block import Block, symmetric_block
from rocking.model.quantity import CRITICAL_ANGLE
from rocking.model.restitution import Restitution
from rocking.model.result import Result, along, described
from rocking.model.system import MODELS
from rocking.model.text import counted
from rocking.model.validation import (
    Refusal,
    Text,
    finite,
    one_of,
    reals,
    refuse_if,
    whole,
    within,
)

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

CONFIDENCE = 0.95
FREQUENCY_PARAMETERS = (1e-3, 1e4)
LOWEST, HIGHEST = 1e-3, 1.5
"""Range of the coefficient of restitution in the fit. A value of 1 or more is then refused."""
FASTEST = 1.0 - 1e-12
"""Largest speed of an arc, as a fraction of that which overturns."""
MAX_TIME = 1e9
COLUMNS = {
    "impact_time_s": "time of the impact in s",
    "impact_residual_s": "time of the impact less that of the fit, in s",
    "impact_speed": "angular speed before the impact in units of alpha theta_cr",
    "impact_restitution": "coefficient of restitution of the impact, from the times between it and its neighbours",
}


class Rocking(NamedTuple):
    """Free rocking of a block: the time from leaving the base to the return, as a function of the speed, and its inverse."""

    critical_angle: float  # rad; 0 for the slender block

    @property
    def fastest(self) -> float:
        """Normalised speed at the base that just overturns the block: 2 sin(α/2)/α, 1 for the slender block."""
        half = 0.5 * self.critical_angle
        return math.sin(half) / half if half else 1.0

    def half_period(self, speed: Any) -> Any:
        """Return the normalised time of an arc that leaves the base with a normalised speed.

        It is 2 artanh(v) for the slender block (Housner 1963). For the full equation it is 2 F(χ, m), with the elliptic integral
        of the first kind, m = 1 − s², s² = sin²(α/2) − (αv/2)², and tan χ = (αv/2)/(s cos(α/2)).
        """
        if not self.critical_angle:
            return 2.0 * np.arctanh(speed)
        from scipy.special import ellipkinc

        half = 0.5 * self.critical_angle
        kick = half * np.asarray(speed)
        least = np.sqrt((math.sin(half) - kick) * (math.sin(half) + kick))
        return 2.0 * ellipkinc(np.arctan2(kick, least * math.cos(half)), 1.0 - least * least)

    def speed_of_angle(self, angle: float) -> float:
        """Return the normalised speed at the base of a block that is released at a normalised angle in (0, 1)."""
        if not self.critical_angle:
            return math.sqrt(angle * (2.0 - angle))
        half, low = 0.5 * self.critical_angle, 0.5 * self.critical_angle * (1.0 - angle)
        return math.sqrt(math.sin(half) ** 2 - math.sin(low) ** 2) / half

    def angle_of_speed(self, speed: float) -> float:
        """Return the normalised angle to which a normalised speed at the base carries the block."""
        if not self.critical_angle:
            return speed * speed / (1.0 + math.sqrt(max(1.0 - speed * speed, 0.0)))
        half = 0.5 * self.critical_angle
        least = math.sqrt(max(math.sin(half) ** 2 - (half * speed) ** 2, 0.0))
        return 1.0 - math.asin(least) / half

    def speed_of(self, time: Array) -> Array:
        """Return the normalised speeds of arcs that last normalised times, by bisection."""
        low, high = np.zeros_like(time), np.full_like(time, self.fastest * FASTEST)
        for _ in range(60):
            middle = 0.5 * (low + high)
            longer = self.half_period(middle) > time
            low, high = np.where(longer, low, middle), np.where(longer, middle, high)
        return 0.5 * (low + high)


@frozen(eq=False)
class RestitutionFit(Result):
    """Fit of the coefficient of restitution to the times of impacts; returned by `fit_restitution`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over `impact`: `impact_time_s`, `impact_residual_s`, and, for the impacts whose neighbours are known, `impact_speed` before
        the impact and `impact_restitution`; NaN for the others.
    restitution, restitution_low, restitution_high : float
        Coefficient of restitution e, and the ends of its 95 % interval.
    frequency_parameter, frequency_parameter_low, frequency_parameter_high : float
        Frequency parameter in 1/s, and the ends of its interval; both equal to it if it was given.
    angle, angle_low, angle_high : float
        Largest angle Θ before the first impact, and the ends of its interval; both equal to it if it was given.
    deviation : float
        Standard deviation of the times about the fit, s.
    freedom : int
        Number of times less that of fitted values.
    model : {"slender", "full"}
        Equation of motion.

    Examples
    --------
    >>> import rocking as rk
    >>> times = [0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02]
    >>> print(rk.fit_restitution(times, frequency_parameter=2.7))
    e = 0.9... (0.9...–0.9...) from 7 impacts, times within ... ms of the fit
    """

    PLOT: ClassVar[str] = "restitution_fit"

    dataset: xr.Dataset = field(repr=False)
    restitution: float
    restitution_low: float
    restitution_high: float
    frequency_parameter: float
    frequency_parameter_low: float
    frequency_parameter_high: float
    angle: float
    angle_low: float
    angle_high: float
    deviation: float
    freedom: int
    model: str
    block: Block | None = None

    def law(self, rows: int = 3) -> Restitution:
        """Return the coefficient of restitution over the speed, as a table.

        Parameters
        ----------
        rows : int
            Number of rows. The impacts, in the order of their speeds, are divided into as many groups of about equal size. A row is
            the mean speed and the mean coefficient of a group, which is cut off at 1.

        Returns
        -------
        Restitution
            Law for a block in SI units.

        Raises
        ------
        ValueError
            If the fit has no block, by which speeds are in rad/s, or if there are fewer impacts than rows.

        Examples
        --------
        >>> import rocking as rk
        >>> times = [0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02]
        >>> law = rk.fit_restitution(times, rk.Block(height=2.0, width=0.5)).law(rows=2)
        >>> [round(e, 3) for _, e in law.rows]
        [0.932, 0.929]
        """
        refuse_if(
            self.block is None,
            "block",
            "be given to the fit for a law",
            Text("none"),
            "speeds are then in rad/s",
        )
        data = self.dataset[["impact_speed", "impact_restitution"]].dropna("impact")
        count = whole("rows", rows, 1, 1000)
        there = data.sizes["impact"]
        allowed = f"be at most {there}, the number of impacts whose coefficient is known"
        refuse_if(count > there, "rows", allowed, count)
        order = np.argsort(data.impact_speed.values)
        groups = np.array_split(order, count)
        speed, kept = (data[name].values for name in ("impact_speed", "impact_restitution"))
        unit = float(self.block.radians_per_second(1.0))  # type: ignore[union-attr]
        means = [(float(speed[each].mean()) * unit, min(float(kept[each].mean()), 1.0)) for each in groups]
        return Restitution.table(means)

    def __str__(self) -> str:
        known = f"{self.restitution_low:.4g}–{self.restitution_high:.4g}"
        count = self.dataset.sizes["impact"]
        return (
            f"e = {self.restitution:.4g} ({known}) from {count} impacts, "
            f"times within {1000.0 * self.deviation:.2g} ms of the fit"
        )


class Unknowns(NamedTuple):
    """What is fitted besides the time of the first impact and e: the speed before the first impact, and the frequency parameter."""

    rocking: Rocking
    frequency_parameter: float | None
    speed: float | None
    released: bool  # whether the first time is that of the release

    @property
    def number(self) -> int:
        """Number of fitted values."""
        return 2 + (self.frequency_parameter is None) + (self.speed is None)

    def read(self, values: Array) -> tuple[float, float, float, float]:
        """Return first time, e, speed before the first impact and frequency parameter."""
        further = iter(values[2:].tolist())
        speed = next(further) if self.speed is None else self.speed
        rate = next(further) if self.frequency_parameter is None else self.frequency_parameter
        return float(values[0]), float(values[1]), speed, rate

    def times(self, values: Array, count: int) -> Array:
        """Return the times: of the release if it is known, and of the impacts."""
        first, e, speed, rate = self.read(values)
        speeds = speed * e ** np.arange(1.0, count)
        if self.released:
            speeds = speed * e ** np.arange(count - 1.0)
        waits = self.rocking.half_period(np.minimum(speeds, self.rocking.fastest * FASTEST)) / rate
        if self.released:
            waits[0] *= 0.5
        return first + np.concatenate([[0.0], np.cumsum(waits)])


def fit_restitution(
    times: Any,
    block: Block | None = None,
    *,
    frequency_parameter: float | None = None,
    critical_angle: float | None = None,
    angle: float | None = None,
    release: float | None = None,
    model: str | None = None,
) -> RestitutionFit:
    """Fit the coefficient of restitution to the times of the impacts of a free rocking test.

    The base is at rest. The block is released at an angle, or left to itself after a push, and rocks until it rests. Between two
    impacts the speed at the base is the same at both ends of the arc, and an impact multiplies it by e. So the n-th arc leaves with
    eⁿ times the speed before the first impact, and lasts 2 artanh(v)/p for a slender block (Housner 1963). For the full equation it
    is an elliptic integral.

    Parameters
    ----------
    times : array (n,)
        Times of successive impacts in s, ascending, at least two more than the number of fitted values.
    block : Block, optional
        Block in SI units, which gives the frequency parameter and the critical angle; its restitution does not count. Default: none.
    frequency_parameter : float, optional
        Frequency parameter p in 1/s, in [1e-3, 1e4]. Default: that of the block; without one, it is fitted too.
    critical_angle : float, optional
        Critical angle θcr of the full equation, rad. Default: that of the block.
    angle : float, optional
        Largest angle Θ before the first impact, in units of θcr, in (0, 1), such as that of the release. Default: it is fitted.
    release : float, optional
        Time of the release from rest in s, before the first impact. Default: not known.
    model : {"slender", "full"}, optional
        Equation of motion. Default: "full" with a block or a critical angle, else "slender".

    Returns
    -------
    RestitutionFit
        Coefficient of restitution with its interval, residuals, and the coefficient of each impact; `print` shows one line.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If times are too few or not ascending, if the motion does not decay, or if an argument lies outside its range.

    See Also
    --------
    Restitution : Laws of restitution of a block.
    rocking.theory.free_quarter_period : Time from the release to the first impact.
    rocking.plot.restitution_fit : Plot the times between impacts.

    Notes
    -----
    The sum of the squares of the residuals of the times is least. The intervals at 95 % are those of linear least squares:
    Student's t with n less the number of fitted values, times the standard error. They hold if the errors of the times are
    independent, normal and equal, and small compared with the times between impacts. A coefficient that depends on the speed shows
    in the residuals, and in `impact_restitution`.

    The frequency parameter follows from the times only if some peaks are large: in the limit of small angles, it and the angle
    count through one number.

    References
    ----------
    Housner, Bull. Seismol. Soc. Am. 53, 403–417 (1963).

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.5, restitution=0.9)
    >>> still = rk.GroundMotion([0.0, 0.0], step=0.01)
    >>> motion = rk.simulate(block.system(still, model="full"), rk.State(angle=0.6))
    >>> impacts = motion.events["time"][motion.events["kind"] == "impact"]
    >>> fit = rk.fit_restitution(block.seconds(impacts[:10]), block)
    >>> abs(fit.restitution - 0.9) < 1e-8
    True
    """
    measured = _checked(times, release)
    rocking, rate, model = _block_of(block, frequency_parameter, critical_angle, model)
    if angle is not None:
        angle = within("angle", angle, 0.0, 1.0)
        refuse_if(not 0.0 < angle < 1.0, "angle", "lie between 0 and 1, exclusive", angle)
    speed = None if angle is None else rocking.speed_of_angle(angle)
    unknowns = Unknowns(rocking, rate, speed, release is not None)
    given, least = len(measured) - unknowns.released, unknowns.number + 2 - unknowns.released
    allowed = f"be of {least} impacts or more, as {unknowns.number} values are fitted"
    refuse_if(given < least, "times", allowed, Text(counted(given, "impact")))
    values, covariance = _least_squares(unknowns, measured)
    residuals = measured - unknowns.times(values, len(measured))
    freedom = len(measured) - unknowns.number
    variance = float(residuals @ residuals) / freedom
    reach = _student(freedom) * np.sqrt(np.diag(covariance) * variance)
    return _result(
        unknowns, measured, values, reach, residuals, (math.sqrt(variance), freedom, model, block, angle)
    )


def _checked(times: Any, release: float | None) -> Array:
    """Return the times, that of the release first if it is known."""
    allowed = "be ascending times in s of the impacts of a free rocking test"
    array = np.asarray(reals("times", times))
    refuse_if(array.ndim != 1, "times", allowed, Text(f"an array of shape {array.shape}"))
    refuse_if(
        not np.isfinite(array).all() or np.abs(array).max(initial=0.0) > MAX_TIME, "times", allowed, times
    )
    if release is not None:
        release = finite("release", release, MAX_TIME)
        refuse_if(
            array.size and not release < array[0], "release", "come before the first of {times}", release
        )
        array = np.concatenate([[release], array])
    unordered = np.flatnonzero(np.diff(array) <= 0.0)
    if unordered.size:
        where = int(unordered[0])
        raise Refusal("times", allowed, Text(f"{array[where]:.6g} before {array[where + 1]:.6g}"))
    return array


def _block_of(
    block: Block | None, frequency_parameter: float | None, critical_angle: float | None, model: str | None
) -> tuple[Rocking, float | None, str]:
    """Return the free rocking, the frequency parameter if it is known, and the model."""
    if block is not None:
        symmetric_block(block)
        given = {"frequency_parameter": frequency_parameter, "critical_angle": critical_angle}
        for name, value in given.items():
            refuse_if(value is not None, name, "be omitted with {block}, which has one", value)
        frequency_parameter, critical_angle = block.frequency_parameter, block.critical_angle
    if frequency_parameter is not None:
        frequency_parameter = within("frequency_parameter", frequency_parameter, *FREQUENCY_PARAMETERS)
    if model is None:
        model = "slender" if critical_angle is None else "full"
    if one_of("model", model, MODELS) == "slender":
        return Rocking(0.0), frequency_parameter, model
    refuse_if(critical_angle is None, "model", "be 'slender' without a critical angle", model, "give {block}")
    return Rocking(CRITICAL_ANGLE.checked(critical_angle)), frequency_parameter, model


def _least_squares(unknowns: Unknowns, measured: Array) -> tuple[Array, Array]:
    """Return the fitted values, and their covariance for times of unit variance."""
    from scipy.optimize import least_squares

    waits = np.diff(measured)[unknowns.released :]
    third = max(len(waits) // 3, 1)
    refuse_if(
        waits[-third:].mean() >= waits[:third].mean(),
        "times",
        "be those of a motion that decays",
        Text(
            f"{waits[:third].mean():.4g} s between the first impacts and {waits[-third:].mean():.4g} s between the last"
        ),
    )
    fastest = unknowns.rocking.fastest * FASTEST
    low, high = [-np.inf, LOWEST], [np.inf, HIGHEST]
    guess = [float(measured[0]), min(float((waits[-1] / waits[0]) ** (1.0 / max(len(waits) - 1, 1))), 0.999)]
    rate = unknowns.frequency_parameter
    if unknowns.speed is None:
        early = waits[0] * (1.0 if rate is None else rate)
        start = float(unknowns.rocking.speed_of(np.array([early]))[0]) if rate is not None else 0.8 * fastest
        guess.append(min(start / guess[1], 0.999 * fastest))
        low.append(1e-9)
        high.append(fastest)
    if rate is None:
        own = unknowns.speed if unknowns.speed is not None else guess[-1]
        guess.append(float(unknowns.rocking.half_period(min(own * guess[1], fastest)) / waits[0]))
        low.append(FREQUENCY_PARAMETERS[0])
        high.append(FREQUENCY_PARAMETERS[1])
    scale = float(waits.mean())

    def misfit(values: Array) -> Array:
        return (unknowns.times(values, len(measured)) - measured) / scale

    first = np.clip(guess, np.array(low) + 1e-12, np.array(high) - 1e-12)
    found = least_squares(
        misfit, first, bounds=(low, high), x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15
    )
    refuse_if(
        found.x[1] >= 1.0,
        "times",
        "be those of a motion that decays",
        Text(f"times that fit a coefficient of restitution of {found.x[1]:.4g}"),
    )
    slope = _derivative(misfit, found.x) * scale
    values = np.asarray(found.x, float)
    return values, np.asarray(np.linalg.pinv(slope.T @ slope), float)


def _derivative(function: Callable[[Array], Array], at: Array) -> Array:
    """Return the derivative of a function by central differences, one column for each of its arguments."""
    columns = []
    for k, value in enumerate(at.tolist()):
        step = np.zeros_like(at)
        step[k] = 1e-6 * max(abs(value), 1e-3)
        columns.append((function(at + step) - function(at - step)) / (2.0 * step[k]))
    return np.stack(columns, axis=1)


def _student(freedom: int) -> float:
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE))


def _result(
    unknowns: Unknowns, measured: Array, values: Array, reach: Array, residuals: Array, known: tuple[Any, ...]
) -> RestitutionFit:
    import xarray as xr

    deviation, freedom, model, block, angle = known
    _, e, speed, rate = unknowns.read(values)
    rocking, ends = unknowns.rocking, {}
    at = 2
    peaks: tuple[Any, ...] = (angle, angle, angle)
    if unknowns.speed is None:
        fastest = rocking.fastest
        speeds = (speed, max(speed - reach[at], 0.0), min(speed + reach[at], fastest))
        peaks = tuple(rocking.angle_of_speed(float(each)) for each in speeds)
        at += 1
    rates = (rate, rate, rate)
    if unknowns.frequency_parameter is None:
        rates = (rate, max(rate - float(reach[at]), 0.0), rate + float(reach[at]))
    ends = {
        "restitution": (e, max(e - float(reach[1]), 0.0), e + float(reach[1])),
        "frequency_parameter": rates,
        "angle": peaks,
    }
    named = {
        f"{name}{end}": float(value)
        for name, three in ends.items()
        for end, value in zip(("", "_low", "_high"), three, strict=True)
    }
    before, kept = _of_each(unknowns, measured, speed, rate)
    released = int(unknowns.released)
    columns = measured[released:], residuals[released:], before, kept
    units = {"impact_time_s": "s", "impact_residual_s": "s"}
    variables = {
        name: (column, text, units.get(name, "1"))
        for (name, text), column in zip(COLUMNS.items(), columns, strict=True)
    }
    attributes = described("Coefficient of restitution") | {
        "comment": "A speed is normalised as in Yim & Lin (1991), Eqs. (1)-(4). Intervals are at 95 %.",
        **{f"{name}{'_per_s' * name.startswith('frequency')}": each for name, each in named.items()},
        "deviation_s": deviation,
        "degrees_of_freedom": freedom,
        "model": model,
    }
    number = "impact", np.arange(len(measured) - released), {"long_name": "number of the impact, from 0"}
    data = xr.Dataset(along("impact", variables), {"impact": number}, attributes)
    return RestitutionFit(data, **named, deviation=deviation, freedom=freedom, model=model, block=block)


def _of_each(unknowns: Unknowns, measured: Array, speed: float, rate: float) -> tuple[Array, Array]:
    """Return the speed before each impact, and its coefficient of restitution, from the durations of the arcs; NaN if not known."""
    waits = np.diff(measured) * rate
    if unknowns.released:
        waits[0] *= 2.0
    speeds = unknowns.rocking.speed_of(waits)
    first = speeds[:1] if unknowns.released else np.array([np.nan if unknowns.speed is None else speed])
    arcs = speeds if unknowns.released else np.concatenate([first, speeds])
    after = np.append(arcs[1:], np.nan)
    unknown = np.isnan(arcs) | np.isnan(after)
    return np.where(unknown, np.nan, arcs), after / arcs
