"""Recorded or synthetic ground acceleration in SI units, and the quantities by which engineers describe it.

With the file that it was read from, and sentences on a motion that is probably not what is meant.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import evolve, field, frozen

from rocking.model import forcing
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.block_formulas import GRAVITY
from rocking.model.forcing import UNITS, BaseMotion, PiecewiseLinear, velocity_and_displacement
from rocking.model.text import listed
from rocking.model.validation import (
    Refusal,
    exactly_one,
    finite,
    instance,
    one_of,
    reals,
    warn_of_value,
    within,
)

STEPS = (1e-6, 1e3)
MAX_ACCELERATION = MAX_FACTOR = 1e6
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
VERTICAL = {"u", "up", "v", "ver", "vert", "vertical", "z", "ud", "updown", "down", "dn", "dwn"}
"""Letters of components that are vertical; so is each code of three letters that ends with z."""


def is_vertical(component: str) -> bool:
    """Return whether the name of a component is vertical.

    Examples
    --------
    >>> is_vertical("U-D"), is_vertical("HNZ"), is_vertical("360°")
    (True, True, False)
    """
    letters = re.sub("[^a-z]", "", component.partition(",")[0].lower())
    return letters in VERTICAL or (len(letters) == 3 and letters.endswith("z"))


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


SMALL = 1.0
TERMS = 24


def pseudo_acceleration(acceleration: np.ndarray, step: float, period: float, damping: float) -> float:
    """Return ω² max|u| at the samples, with u'' + 2ζω u' + ω² u = −a from rest.

    The time is s = ωt, x is ω² u, and λ = −ζ + i√(1−ζ²) is a root of the oscillator. Then q = x' − λ*x obeys q' = λq − a,
    one recursion of first order, and x = Im q / Im λ.

    Examples
    --------
    >>> round(pseudo_acceleration(np.ones(101), step=0.01, period=1.0, damping=0.0), 9)
    2.0
    """
    from scipy.signal import lfilter

    turn = 2 * math.pi * step / period
    root = complex(-damping, math.sqrt(1 - damping**2))
    growth, start, end = _exact_step(root * turn)
    a = np.concatenate(([0.0], acceleration))
    # The 0 in front stands for rest at the first sample, from which no interval leads back.
    drive = start * turn * a[:-1] + end * turn * a[1:]
    drive[0] = 0.0
    q = lfilter([1.0], [1.0, -growth], drive)
    return float(np.abs(q.imag).max()) / root.imag


def _exact_step(z: complex) -> tuple[complex, complex, complex]:
    """Return e^z, and the weights of both ends of a linear function in ∫₀¹ e^(z(1−s)) f(s) ds."""
    if abs(z) < SMALL:
        second = sum(z**k / math.factorial(k + 2) for k in range(TERMS))
        first = 1 + z * second
        return 1 + z * first, first - second, second
    growth = np.exp(z)
    first = (growth - 1) / z
    second = (first - 1) / z
    return growth, first - second, second


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


PERIODS = (1e-4, 1e4)
MAX_DAMPING = 0.99
SIGNIFICANT = (0.05, 0.95)
"""Shares of the Arias intensity at the ends of the significant duration."""


@frozen(repr=False)
class GroundMotion(BaseMotion, ReadOnlyArrays):
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

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type or lies outside its range.

    Warns
    -----
    InputWarning
        If the PGA is below 0.01 or above 50 m/s²: the unit is probably another. A scaled motion may have any PGA.

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
    _corrected: bool = field(default=False, kw_only=True, repr=False, eq=False)

    def __attrs_post_init__(self) -> None:
        if self.factor == 1.0 and (doubt := pga_doubt(self.pga)):
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
    def arias_intensity(self) -> float:
        """Arias intensity π/(2g) ∫a² dt in m/s, exact for the straight segments."""
        return float(self._energy()[-1]) * math.pi / (2 * GRAVITY)

    @property
    def significant_duration(self) -> float:
        """Time between 5 % and 95 % of the Arias intensity, in s, linear between samples; 0 without motion."""
        energy = self._energy()
        if energy[-1] == 0.0:
            return 0.0
        first, last = np.interp([share * energy[-1] for share in SIGNIFICANT], energy, self.times)
        return float(last - first)

    def _energy(self) -> np.ndarray:
        a = self.acceleration
        parts = (a[:-1] ** 2 + a[:-1] * a[1:] + a[1:] ** 2) * (self.step / 3)
        return np.concatenate(([0.0], np.cumsum(parts)))

    def response_spectrum(self, periods: Any, damping: float = 0.05) -> Any:
        """Return the pseudo-acceleration ω² max|u| of linear oscillators.

        The recursion is exact for straight segments. The largest displacement is taken at the samples, during the motion only.

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
        values = np.asarray(reals("periods", periods), dtype=float)
        shortest, longest = PERIODS
        if not ((values >= shortest) & (values <= longest)).all():
            raise Refusal("periods", f"lie in [{shortest:g}, {longest:g}] s", periods)
        damping = within("damping", damping, 0, MAX_DAMPING)
        a = self.acceleration
        rows = [pseudo_acceleration(a, self.step, period, damping) for period in values.ravel().tolist()]
        return rows[0] if values.ndim == 0 else np.reshape(np.array(rows, dtype=float), values.shape)

    def scaled(self, factor: float | None = None, *, pga: float | None = None) -> GroundMotion:
        """Return the motion times a factor, or scaled to a peak ground acceleration.

        Parameters
        ----------
        factor : float
            Factor. Give exactly one of the two.
        pga : float
            Peak ground acceleration, in m/s².

        Returns
        -------
        GroundMotion
            Motion that shares the samples.

        Raises
        ------
        TypeError, ValueError
            If not exactly one is given, or if it is of the wrong type or outside its range. Also if a motion of zeros is
            scaled to a peak.

        Examples
        --------
        >>> GroundMotion([0.0, 2.0], step=0.1).scaled(1.5).pga
        3.0
        """
        if exactly_one(factor=factor, pga=pga) == "factor":
            return evolve(self, factor=self.factor * finite("factor", factor, MAX_FACTOR))  # type: ignore[arg-type]
        requested = within("pga", pga, 0, MAX_ACCELERATION, "m/s²")  # type: ignore[arg-type]
        if self.pga == 0.0:
            raise Refusal("pga", "be 0 for a motion whose acceleration is 0 throughout", requested)
        return evolve(self, factor=self.factor * (requested / self.pga))

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

    def reversed(self) -> GroundMotion:
        """Return the motion in the opposite direction.

        Examples
        --------
        >>> GroundMotion([0.0, 2.0], step=0.1).reversed().acceleration.tolist()
        [-0.0, -2.0]
        """
        return evolve(self, factor=-self.factor)

    def clipped(self, start: float = 0.0, end: float | None = None) -> GroundMotion:
        """Return the samples between two times, both included; no sample is made.

        Parameters
        ----------
        start, end : float
            Times in s, in [0, `duration`]. Default: the whole motion.

        Returns
        -------
        GroundMotion
            Motion that begins with the first sample kept.

        Raises
        ------
        TypeError, ValueError
            If a time is of the wrong type or outside the motion, or if no sample lies between them.

        Examples
        --------
        >>> GroundMotion([0.0, 1.0, 2.0, 3.0], step=0.5).clipped(0.5, 1.2).acceleration.tolist()
        [1.0, 2.0]
        """
        first = within("start", start, 0, self.duration, "s")
        last = within("end", self.duration if end is None else end, 0, self.duration, "s")
        chosen = slice(math.ceil(first / self.step - 1e-9), math.floor(last / self.step + 1e-9) + 1)
        kept = self._samples[chosen]
        if not kept.size:
            raise Refusal("end", f"leave at least one sample after {{start}} = {first:g} s", end)
        return evolve(self, acceleration=read_only(kept.copy()), corrected=True)

    def __repr__(self) -> str:
        named = ", ".join(filter(None, (self.name, self.component, f"{self._samples.size} samples")))
        treated = "" if self.baseline == "none" else f", {self.baseline} baseline removed"
        return f"GroundMotion({named}, step {self.step:g} s, PGA {self.pga:.4g} m/s²{treated})"
