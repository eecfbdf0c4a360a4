"""Recorded or synthetic ground acceleration in SI units, and the quantities by which engineers describe it.

With the file that it was read from, and sentences on a motion that is probably not what is meant.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from hashlib import sha256
from typing import Any

import attrs
import numpy as np
from attrs import field, frozen

from rocking.model import forcing
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.block_formulas import GRAVITY
from rocking.model.changed_motion import MAX_ACCELERATION, MAX_FACTOR, STEPS, ChangedMotion, checked_pair
from rocking.model.forcing import UNITS, BaseMotion, PiecewiseLinear, velocity_and_displacement
from rocking.model.intensity import (
    BRACKET,
    DAMPING,
    MAX_DAMPING,
    PERIODS,
    SIGNIFICANT,
    absolute_integral,
    bracketed_duration,
    cumulative_square,
    oscillation,
    pseudo_acceleration,
    rotated_peaks,
)
from rocking.model.text import listed
from rocking.model.validation import (
    Refusal,
    WrongType,
    finite,
    instance,
    members,
    one_of,
    reals,
    warn_of_value,
    within,
)

BASELINES = {"none": None, "mean": 0, "linear": 1, "quadratic": 2}
"""Degree of the polynomial that is fitted to the acceleration and subtracted."""


def checked_samples(values: Any) -> np.ndarray:
    """Return the samples, after checking."""
    return forcing.samples("acceleration", values, MAX_ACCELERATION)


def checked_step(value: float) -> float:
    """Return the time step in s, after checking."""
    return within("step", value, *STEPS, "s")


def checked_name(value: str) -> str:
    """Return the name, after checking."""
    return instance("name", value, str)


def checked_component(value: str) -> str:
    """Return the component, after checking."""
    return instance("component", value, str)


def checked_changes(values: Any) -> tuple[str, ...]:
    """Return the changes, after checking."""
    rule = "be sentences on what was done to the samples"
    if isinstance(values, str):
        raise WrongType("changes", rule, values)
    return tuple(instance("changes", each, str) for each in members("changes", values, rule))


def checked_factor(value: float) -> float:
    """Return the factor, after checking."""
    return finite("factor", value, MAX_FACTOR)


def checked_baseline(value: str) -> str:
    """Return the baseline, after checking."""
    return one_of("baseline", value, tuple(BASELINES))


MAX_END, MAX_MEAN, MAX_RATIO = 0.2, 0.5, 30.0
"""Largest |velocity| at the end over PGV, |mean velocity| over its root mean square, and PGA PGD/PGV² without drift."""
USUAL_PGA = (0.01, 50.0)
"""Peaks in m/s² without a warning: nobody feels a smaller one, and about 40 m/s² is the largest that was recorded."""
VERTICAL = {
    *("u", "up", "upward", "v", "ver", "vert", "vrt", "vertical", "verticale", "vertikal", "vertikale"),
    *("z", "ud", "updown", "updn", "down", "dn", "dwn", "zaxis", "upaxis"),
}
"""Letters of components that are vertical; so are az alone, and codes of channels such as HNZ."""


def is_vertical(component: str) -> bool:
    """Return whether the name of a component is vertical.

    Examples
    --------
    >>> is_vertical("U-D"), is_vertical("HNZ"), is_vertical("360°"), is_vertical("Comp. UP (station 7)")
    (True, True, False, True)
    """
    name = re.sub(r"\bcomp(?:onent)?\b", "", (re.split("[,(]", component)[0] or component).lower())
    letters = re.sub("[^a-z]", "", name)
    word = letters in VERTICAL or name.strip() == "az"
    return word or re.fullmatch("[a-z][ghlmn]z", letters) is not None


def drift_doubt(motion: GroundMotion) -> str:
    """Return the sentence of `GroundMotion.drift_doubt`."""
    pgv, velocity = motion.pgv, motion.velocity
    if pgv == 0.0:
        return ""
    end = abs(float(velocity[-1])) / pgv
    mean = abs(float(velocity.mean())) / math.sqrt(float((velocity**2).mean()))
    ratio = motion.pga * motion.pgd / pgv**2
    reasons = {
        f"the velocity at the end is {100 * end:.0f} % of the PGV": end / MAX_END,
        f"the mean velocity is {100 * mean:.0f} % of its root mean square": mean / MAX_MEAN,
        f"PGA PGD/PGV² is {ratio:.3g}, where 6 is usual": ratio / MAX_RATIO,
    }
    worst = max(reasons, key=reasons.__getitem__)
    if reasons[worst] <= 1.0:
        return ""
    treated = "no" if motion.baseline == "none" else f"a {motion.baseline}"
    better = {"linear": "quadratic", "quadratic": None}.get(motion.baseline, "linear")
    remedy = (
        f"use a corrected record, or for example baseline={better!r}" if better else "use a corrected record"
    )
    return (
        f"the PGV and PGD are those of a drift, because {treated} baseline is removed and {worst}: {remedy}"
    )


def pga_doubt(pga: float) -> str:
    """Return a sentence on a peak in m/s² that is probably in another unit; empty for any other."""
    low, high = USUAL_PGA
    if pga == 0.0 or low <= pga <= high:
        return ""
    return f"a PGA of {pga:.4g} m/s² is unusual: check the unit of the samples"


def vertical_sentence(names: Sequence[str]) -> str:
    """Return the warning that vertical components are used as horizontal ones."""
    which = "the component {} is" if len(names) == 1 else "the components {} are"
    return f"{which.format(listed(names))} vertical, and the base moves horizontally: choose a horizontal component"


RELATIVE_TOLERANCE = 0.01
"""Allowed relative difference between the two peaks: that of samples printed with three digits."""


@frozen
class RecordFile:
    """File that a ground motion was read from.

    Attributes
    ----------
    name : str
        Name of the file.
    sha256 : str
        SHA-256 digest of its bytes, hexadecimal.
    format : str
        Format of the file, such as "PEER AT2".
    channel : str
        Channel of the file, such as "channel 1 of 3, 90°"; empty if it has only one.
    station : str
        Name of the station or the record in the header; empty if it gives none.
    pga : float or None
        Peak ground acceleration of the samples as read, in m/s².
    header_pga : float or None
        Peak ground acceleration according to the header, in m/s², without its sign; None if the header gives none.
    header_rounding : float
        Half a unit of the last digit of `header_pga`, in m/s².

    Examples
    --------
    >>> file = RecordFile("a.v2", "0" * 64, "CSMIP V2", pga=2.0, header_pga=2.51, header_rounding=0.005)
    >>> round(file.pga_difference, 3), file.pga_agrees
    (-0.51, False)
    """

    name: str
    sha256: str
    format: str
    channel: str = ""
    pga: float | None = None
    header_pga: float | None = None
    header_rounding: float = 0.0
    station: str = ""

    @property
    def pga_difference(self) -> float | None:
        """PGA of the samples less PGA of the header, in m/s²; None if one is unknown."""
        return None if self.pga is None or self.header_pga is None else self.pga - self.header_pga

    @property
    def pga_agrees(self) -> bool | None:
        """Agreement of both PGA within 1 % and the rounding of the header; None if one is unknown."""
        difference = self.pga_difference
        if difference is None or self.header_pga is None:
            return None
        return abs(difference) <= self.header_rounding + RELATIVE_TOLERANCE * self.header_pga


def _oscillators(periods: Any, damping: float) -> tuple[np.ndarray, float]:
    """Return natural periods in s, of any shape, and the damping ratio, after checking."""
    values = np.asarray(reals("periods", periods), dtype=float)
    shortest, longest = PERIODS
    if not ((values >= shortest) & (values <= longest)).all():
        raise Refusal("periods", f"lie in [{shortest:g}, {longest:g}] s", periods)
    return values, within("damping", damping, 0, MAX_DAMPING)


def _shaped(rows: list[float], like: np.ndarray) -> Any:
    """Return numbers in the shape of an array, a float for a number."""
    return rows[0] if like.ndim == 0 else np.reshape(np.array(rows, dtype=float), like.shape)


@frozen(repr=False)
class GroundMotion(BaseMotion, ReadOnlyArrays, ChangedMotion):
    """Horizontal acceleration of the ground in SI units, linear between equidistant samples.

    Scaled and reversed motions share the samples. The last sample ends the motion: the acceleration is 0 before the first and
    after the last.

    Parameters
    ----------
    acceleration : array_like of float, shape (n,)
        Samples in m/s², n in [1, 10⁷].
    step : float
        Time between two samples in s, in [1e-6, 1000].
    name, component : str
        Name of the motion and of its component. Default: "".
    baseline : {"none", "mean", "linear", "quadratic"}
        Polynomial that is fitted to the samples by least squares and subtracted. Default: "none".
    factor : float
        Factor of all samples. Default: 1.
    file : RecordFile, optional
        File that the samples were read from. Default: None.
    changes : iterable of str
        What was done to the samples since they were read, one sentence per change. Default: nothing.

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type or lies outside its range.

    Warns
    -----
    InputWarning
        If the PGA is below 0.01 or above 50 m/s²: the unit is probably another. A scaled or changed motion may have any PGA.

    Examples
    --------
    >>> motion = GroundMotion([0.0, 3.0, -2.0, 0.0], step=0.1, name="example")
    >>> motion
    GroundMotion(example, 4 samples, step 0.1 s, PGA 3 m/s²)
    >>> motion.scaled(pga=6.0).acceleration.tolist(), motion.reversed().pga
    ([0.0, 6.0, -4.0, 0.0], 3.0)
    """

    _samples: np.ndarray = field(
        alias="acceleration",
        converter=checked_samples,
        eq=attrs.cmp_using(eq=np.array_equal),
        hash=False,
    )
    step: float = field(converter=checked_step, kw_only=True)
    name: str = field(default="", converter=checked_name, kw_only=True)
    component: str = field(default="", converter=checked_component, kw_only=True)
    baseline: str = field(default="none", converter=checked_baseline, kw_only=True)
    factor: float = field(default=1.0, converter=checked_factor, kw_only=True)
    file: RecordFile | None = field(default=None, kw_only=True)
    changes: tuple[str, ...] = field(default=(), converter=checked_changes, kw_only=True)
    _corrected: bool = field(default=False, kw_only=True, repr=False, eq=False)

    def __attrs_post_init__(self) -> None:
        if self.factor == 1.0 and not self.changes and (doubt := pga_doubt(self.pga)):
            warn_of_value(doubt)
        degree = BASELINES[self.baseline]
        if degree is None or self._corrected:
            return
        places = np.linspace(-1.0, 1.0, self._samples.size)
        fit = np.polynomial.Polynomial.fit(places, self._samples, min(degree, self._samples.size - 1))
        object.__setattr__(self, "_samples", read_only(self._samples - fit(places)))
        object.__setattr__(self, "_corrected", True)

    @property
    def vertical(self) -> bool:
        """True if `component` names the vertical direction, as "Up", "U-D", "DWN", "V" and "HNZ" do."""
        return is_vertical(self.component)

    @property
    def acceleration(self) -> np.ndarray:
        """Samples in m/s², shape (n,), after correction of the baseline and scaling."""
        return self._samples if self.factor == 1.0 else read_only(self.factor * self._samples)

    @property
    def times(self) -> np.ndarray:
        """Times of the samples in s, shape (n,)."""
        return self.step * np.arange(self._samples.size)

    @property
    def duration(self) -> float:
        """Time of the last sample, in s."""
        return (self._samples.size - 1) * self.step

    @property
    def pga(self) -> float:
        """Peak ground acceleration: largest |acceleration|, in m/s²."""
        return float(np.abs(self._samples).max()) * abs(self.factor)

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of the ground at the samples in m/s, from rest, by exact integration of the straight segments."""
        return velocity_and_displacement(self.acceleration, self.step)[0]

    @property
    def displacement(self) -> np.ndarray:
        """Displacement of the ground at the samples in m, from rest, by exact integration of the straight segments.

        Errors of the baseline grow quadratically in time: the displacement at the end is a measure of them. See `drift_doubt`.
        """
        return velocity_and_displacement(self.acceleration, self.step)[1]

    @property
    def pgv(self) -> float:
        """Peak ground velocity: largest |velocity| at the samples and where the acceleration vanishes between them, in m/s."""
        a, v = self.acceleration, self.velocity
        first, second = a[:-1], a[1:]
        crossing = first * second < 0
        part = first[crossing] / (first[crossing] - second[crossing]) * self.step
        between = v[:-1][crossing] + first[crossing] * part / 2
        return float(max(np.abs(v).max(), np.abs(between).max(initial=0.0)))

    @property
    def pgd(self) -> float:
        """Peak ground displacement: largest |displacement| at the samples, in m."""
        return float(np.abs(self.displacement).max())

    @property
    def drift_doubt(self) -> str:
        """Sentence on PGV and PGD that are those of a wrong baseline, with reason and remedy; empty for those of the ground.

        The ground is at rest after an earthquake. So one of these is too large: the velocity at the end, above 20 % of the PGV;
        |mean velocity|, above half its root mean square; PGA PGD/PGV², above 30. The last is about 6 in general (Newmark & Hall 1982).
        """
        return drift_doubt(self)

    @property
    def pgv_to_pga(self) -> float:
        """PGV/PGA in s, a time scale of the motion; NaN without motion."""
        pga = self.pga
        return self.pgv / pga if pga > 0.0 else math.nan

    @property
    def arias_intensity(self) -> float:
        """Arias intensity π/(2g) ∫a² dt in m/s, exact for the straight segments."""
        return float(cumulative_square(self.acceleration, self.step)[-1]) * math.pi / (2 * GRAVITY)

    @property
    def cav(self) -> float:
        """Cumulative absolute velocity ∫|a| dt in m/s, exact for the straight segments: EPRI NP-5930 (1988), without a threshold."""
        return absolute_integral(self.acceleration, self.step)

    @property
    def significant_duration(self) -> float:
        """Time between 5 % and 95 % of the Arias intensity, in s, linear between samples; 0 without motion."""
        energy = cumulative_square(self.acceleration, self.step)
        if energy[-1] == 0.0:
            return 0.0
        first, last = np.interp([share * energy[-1] for share in SIGNIFICANT], energy, self.times)
        return float(last - first)

    def bracketed_duration(self, threshold: float = BRACKET) -> float:
        """Return the time between the first and the last |acceleration| of at least a threshold.

        Parameters
        ----------
        threshold : float
            Acceleration in m/s², in [1e-9, 1e6]. Default: 0.05 g, as in Bolt (1973).

        Returns
        -------
        float
            Duration in s, exact for the straight segments; 0 if no sample reaches the threshold.

        Raises
        ------
        TypeError, ValueError
            If the threshold is not a real number or lies outside its range.

        References
        ----------
        Bolt, Duration of strong ground motion, Proc. 5th World Conf. Earthquake Eng., 1304–1313 (1973).

        Examples
        --------
        >>> GroundMotion([0.0, 2.0, 0.0, -2.0, 0.0], step=0.5).bracketed_duration(1.0)
        1.5
        """
        limit = within("threshold", threshold, 1e-9, MAX_ACCELERATION, "m/s²")
        return bracketed_duration(self.acceleration, self.step, limit)

    def response_spectrum(self, periods: Any, damping: float = DAMPING) -> Any:
        """Return the pseudo-acceleration Sa = ω² max|u| of linear oscillators.

        The recursion is exact for straight segments. The largest displacement is that during the motion, between the samples,
        too, where cubics take its place: they are accurate to 1e-4 for periods above a third of a step.

        Parameters
        ----------
        periods : float or array_like
            Natural periods in s, in [1e-4, 1e4].
        damping : float
            Damping ratio, in [0, 0.99]. Default: 0.05.

        Returns
        -------
        float or ndarray
            Pseudo-acceleration in m/s², in the shape of `periods`.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range.

        References
        ----------
        Nigam & Jennings, Bull. Seismol. Soc. Am. 59, 909–922 (1969).

        Examples
        --------
        >>> steady = GroundMotion([1.0] * 2001, step=0.01)  # a suddenly applied acceleration: twice the static response
        >>> round(steady.response_spectrum(1.0, damping=0.0), 4)
        2.0
        """
        values, damping = _oscillators(periods, damping)
        a = self.acceleration
        rows = [pseudo_acceleration(a, self.step, period, damping) for period in values.ravel().tolist()]
        return _shaped(rows, values)

    def average_spectrum(self, periods: Any, damping: float = DAMPING) -> float:
        """Return Sa_avg: the geometric mean of the pseudo-acceleration over periods.

        Parameters
        ----------
        periods : array_like
            Natural periods in s, in [1e-4, 1e4]; one at least.
        damping : float
            Damping ratio, in [0, 0.99]. Default: 0.05.

        Returns
        -------
        float
            exp(mean of ln Sa) in m/s²; 0 without motion.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range, or if there is no period.

        References
        ----------
        Eads, Miranda & Lignos, Earthquake Eng. Struct. Dyn. 44, 2057–2073 (2015).

        Examples
        --------
        >>> import rocking as rk
        >>> motion = rk.example_ground_motion()
        >>> average, ends = motion.average_spectrum([0.5, 1.0]), motion.response_spectrum([0.5, 1.0])
        >>> round(float(average**2 / (ends[0] * ends[1])), 12)
        1.0
        """
        values = np.atleast_1d(self.response_spectrum(periods, damping))
        if not values.size:
            raise Refusal("periods", "hold one period at least", periods)
        with np.errstate(divide="ignore"):
            return float(np.exp(np.log(values).mean()))

    def rotated_spectrum(
        self, other: GroundMotion, periods: Any, damping: float = DAMPING, *, percentile: float = 50.0
    ) -> Any:
        """Return RotD50, or another percentile over all directions of the response of two horizontal components.

        At each period, both components drive a linear oscillator. The largest |u₁ cos φ + u₂ sin φ| is computed for
        φ = 0, 1, …, 179°, and the percentile is that of these 180 numbers. RotD100 is their maximum. The direction
        differs from period to period, so no ground motion has this spectrum.

        Parameters
        ----------
        other : GroundMotion
            Other horizontal component of the same station, with the same step and number of samples.
        periods : float or array_like
            Natural periods in s, in [1e-4, 1e4].
        damping : float
            Damping ratio, in [0, 0.99]. Default: 0.05.
        percentile : float
            Percentile over the directions, in [0, 100], linear between two numbers. Default: 50.

        Returns
        -------
        float or ndarray
            Pseudo-acceleration in m/s², in the shape of `periods`.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range, or if step or number of samples differ.

        References
        ----------
        Boore, Bull. Seismol. Soc. Am. 100, 1830–1835 (2010).

        Examples
        --------
        >>> east, north = (GroundMotion([0.0, a, -a, 0.0], step=0.1) for a in (3.0, 4.0))
        >>> total = east.rotated_spectrum(north, 0.5, percentile=100)  # in one direction: a vector of 3 and 4
        >>> round(total / east.response_spectrum(0.5), 3)
        1.667
        """
        checked_pair(self, other)
        values, damping = _oscillators(periods, damping)
        share = within("percentile", percentile, 0.0, 100.0)
        first, second = self.acceleration, other.acceleration
        rows = []
        for period in values.ravel().tolist():
            both = (oscillation(a, self.step, period, damping) for a in (first, second))
            rows.append(float(np.percentile(rotated_peaks(*both), share)))
        return _shaped(rows, values)

    @property
    def fingerprint(self) -> str:
        """Digest of step and samples, the same for a motion, its scaled copies and its mirror image."""
        base = self.normalised(1.0, 1.0)
        values = np.asarray(base.values, dtype=float)
        moving = np.flatnonzero(values)
        sign = np.sign(values[moving[0]]) if moving.size else 1.0
        return sha256(
            np.float64(base.step).tobytes() + np.ascontiguousarray(sign * values + 0.0).tobytes()
        ).hexdigest()

    @property
    def number(self) -> int:
        """The first 64 bits of the fingerprint, which number what is drawn at random for the motion."""
        return int(self.fingerprint[:16], 16)

    def normalised(self, acceleration: float, frequency: float) -> PiecewiseLinear:
        """Return the normalised base acceleration, which shares the samples.

        Parameters
        ----------
        acceleration, frequency : float
            Unit of acceleration g θcr in m/s², and frequency parameter α in 1/s. Both lie in [1e-9, 1e9].

        Returns
        -------
        PiecewiseLinear

        Raises
        ------
        TypeError, ValueError
            If a unit is not a real number or lies outside its range. Also if the result lies outside its own.

        Examples
        --------
        >>> GroundMotion([0.0, 2.0], step=0.1).normalised(acceleration=4.0, frequency=2.0)
        PiecewiseLinear(2 samples, step=0.2, scale=0.25)
        """
        unit, rate = within("acceleration", acceleration, *UNITS), within("frequency", frequency, *UNITS)
        return PiecewiseLinear(self._samples, step=rate * self.step, scale=self.factor / unit)

    def __repr__(self) -> str:
        named = ", ".join(filter(None, (self.name, self.component, f"{self._samples.size} samples")))
        treated = "" if self.baseline == "none" else f", {self.baseline} baseline removed"
        changed = "".join(f", {each}" for each in self.changes)
        return f"GroundMotion({named}, step {self.step:g} s, PGA {self.pga:.4g} m/s²{treated}{changed})"
