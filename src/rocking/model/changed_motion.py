"""Motions that are made of a ground motion: scaled, clipped, resampled, filtered, rotated, and those of a floor."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from attrs import evolve

from rocking.model.arrays import read_only
from rocking.model.forcing import MAX_SAMPLES
from rocking.model.intensity import DAMPING, MAX_DAMPING, PERIODS, floor_acceleration
from rocking.model.text import counted
from rocking.model.validation import Refusal, Text, exactly_one, finite, instance, real, whole, within

if TYPE_CHECKING:
    from rocking.model.ground_motion import GroundMotion

STEPS = (1e-6, 1e3)
MAX_ACCELERATION = MAX_FACTOR = 1e6
FULL_TURN = 2 * math.pi
NEAR = 1e-9
"""Distance from a sample, in steps, within which a time is that of the sample."""
MAX_ALIASED = 1e-3
"""Share of the energy above half the new sampling rate from which a coarser step is refused."""
ORDERS = (1, 10)
PAD = 1.5
"""Rest before and after the samples, in periods of the lowest corner times the order: Converse & Brady (1992)."""
TAIL = 0.01
"""Share of the peak to which the free vibration of a floor decays before its motion ends."""
BEARING = re.compile(r"([NS])(\d{1,2})([EW])|(\d{1,3})°?", re.IGNORECASE)
RIGHT_ANGLE = 5.0
"""Allowed deviation of two components from a right angle, in degrees."""
DIGITS_OF_DIGEST = 12


def azimuth(component: str) -> float | None:
    """Return the azimuth that the name of a component states, in degrees; None if it states none.

    Examples
    --------
    >>> azimuth("N28W"), azimuth("S62W"), azimuth("90°"), azimuth("HNE")
    (332.0, 242.0, 90.0, None)
    """
    match = BEARING.fullmatch(component.strip())
    if match is None:
        return None
    if match.group(4):
        return float(match.group(4)) % 360.0
    from_north = float(match.group(2)) * (1 if match.group(3).upper() == "E" else -1)
    return (from_north if match.group(1).upper() == "N" else 180.0 - from_north) % 360.0


def checked_pair(
    first: GroundMotion, other: Any, name: str = "other", own_name: str = "first component"
) -> None:
    """Refuse anything but two motions with the same step and the same number of samples; `name` is the argument of the other one."""
    instance(name, other, type(first))
    size, step = first.times.size, first.step
    if (other.step, other.times.size) != (step, size):
        own = f"{counted(size, 'sample')} with a step of {step:g} s"
        found = f"{counted(other.times.size, 'sample')} with a step of {other.step:g} s"
        clipped = f"take .clipped(end={min(first.duration, other.duration):g}) of both"
        remedy = clipped if other.step == step else f"take .resampled({step:g}) of it"
        raise Refusal(name, f"have {own}, as the {own_name}", Text(found), remedy)


def same_end(
    ground: GroundMotion, other: GroundMotion, sentences: list[str]
) -> tuple[GroundMotion, GroundMotion]:
    """Return two components with the same step that end with the shorter one; add a sentence on this if their lengths differ."""
    if ground.times.size == other.times.size:
        return ground, other
    shorter = min(ground.duration, other.duration)
    samples = f"{ground.times.size:,} and {other.times.size:,} samples"
    sentences.append(f"the two components have {samples}: both end at {shorter:g} s")
    return ground.clipped(end=shorter), other.clipped(end=shorter)


class ChangedMotion:
    """Methods of a ground motion that make another one. Its `file` stays, and `changes` states what was done to the samples."""

    __slots__ = ()

    @property
    def _motion(self) -> GroundMotion:
        """The motion itself: this class is a base of `GroundMotion` alone."""
        return cast("GroundMotion", self)

    def _evolved(self, **values: Any) -> GroundMotion:
        return evolve(self._motion, **values)

    def _changed(self, samples: np.ndarray, change: str, **values: Any) -> GroundMotion:
        """Return the motion with other samples, before the factor, and a sentence on how they were made."""
        return self._evolved(
            acceleration=read_only(samples), corrected=True, changes=(*self._motion.changes, change), **values
        )

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
        >>> import rocking as rk
        >>> rk.GroundMotion([0.0, 2.0], step=0.1).scaled(1.5).pga
        3.0
        """
        if exactly_one(factor=factor, pga=pga) == "factor":
            return self._evolved(factor=self._motion.factor * finite("factor", factor, MAX_FACTOR))  # type: ignore[arg-type]
        requested = within("pga", pga, 0, MAX_ACCELERATION, "m/s²")  # type: ignore[arg-type]
        if self._motion.pga == 0.0:
            raise Refusal("pga", "be 0 for a motion whose acceleration is 0 throughout", requested)
        return self._evolved(factor=self._motion.factor * (requested / self._motion.pga))

    def reversed(self) -> GroundMotion:
        """Return the motion in the opposite direction.

        Examples
        --------
        >>> import rocking as rk
        >>> rk.GroundMotion([0.0, 2.0], step=0.1).reversed().acceleration.tolist()
        [-0.0, -2.0]
        """
        return self._evolved(factor=-self._motion.factor)

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
        >>> import rocking as rk
        >>> rk.GroundMotion([0.0, 1.0, 2.0, 3.0], step=0.5).clipped(0.5, 1.2).acceleration.tolist()
        [1.0, 2.0]
        """
        first = within("start", start, 0, self._motion.duration, "s")
        last = within("end", self._motion.duration if end is None else end, 0, self._motion.duration, "s")
        chosen = slice(
            math.ceil(first / self._motion.step - 1e-9), math.floor(last / self._motion.step + 1e-9) + 1
        )
        kept = self._motion._samples[chosen]
        if not kept.size:
            raise Refusal("end", f"leave at least one sample after {{start}} = {first:g} s", end)
        if kept.size == self._motion._samples.size:
            return self._evolved()
        return self._changed(
            kept.copy(),
            f"clipped to {self._motion.step * chosen.start:g}–{self._motion.step * (chosen.stop - 1):g} s",
        )

    def resampled(self, step: float) -> GroundMotion:
        """Return the motion at another time step: its values on the straight lines between the samples.

        Samples whose times are those of the new grid are kept exactly. So a step that divides the old one gives the same
        motion. With other steps, straight lines between the new samples replace the corners between them. What
        remains of the motion after the last multiple of the step, less than one step, is left out.

        Parameters
        ----------
        step : float
            Time step in s, in [1e-6, 1000].

        Returns
        -------
        GroundMotion
            Motion whose `changes` state both steps.

        Raises
        ------
        TypeError, ValueError
            If the step is of the wrong type or outside its range. Also if it is coarser, and more than 0.1 % of the energy ∫a² dt
            lies above half the new sampling rate, from where it would appear at lower frequencies: filter the motion first.

        Examples
        --------
        >>> import rocking as rk
        >>> rk.GroundMotion([0.0, 2.0, 1.0], step=0.5).resampled(0.25).acceleration.tolist()
        [0.0, 1.0, 2.0, 1.5, 1.0]
        """
        new = within("step", step, *STEPS, "s")
        ratio = new / self._motion.step
        count = math.floor(self._motion.duration / new + NEAR) + 1
        if count > MAX_SAMPLES:
            raise Refusal("step", f"give at most {MAX_SAMPLES:,} samples", step)
        if ratio > 1 + NEAR and _share_above(self._motion._samples, 1 / ratio) > MAX_ALIASED:
            rule = f"keep 99.9 % of the energy below half the sampling rate, {0.5 / new:.4g} Hz"
            raise Refusal("step", rule, step, f"filter first: .filtered(high={0.25 / new:.4g})")
        places = ratio * np.arange(count)
        near = np.rint(places)
        places = np.where(np.abs(places - near) <= NEAR * np.maximum(near, 1.0), near, places)
        samples = np.interp(places, np.arange(self._motion._samples.size), self._motion._samples)
        return self._changed(
            samples, f"resampled from {self._motion.step:g} s to {new:g} s along straight lines", step=new
        )

    def filtered(
        self, low: float | None = None, high: float | None = None, *, order: int = 4
    ) -> GroundMotion:
        """Return the motion without its low or high frequencies: a Butterworth filter, forwards and backwards.

        The two passes of `scipy.signal.sosfiltfilt` leave no shift of phase. Together they multiply the amplitude at the
        frequency f by 1/(1 + (f/high)^(2 order)), and by 1/(1 + (low/f)^(2 order)): one half at a corner. The motion rests
        before and after the samples, for 1.5 `order` periods of the lowest corner. The response in these times is cut off.

        Parameters
        ----------
        low, high : float, optional
            Corners in Hz, between 0 and half the sampling rate. Give one at least. Default: none.
        order : int
            Order of each pass, in 1, …, 10. Default: 4.

        Returns
        -------
        GroundMotion
            Motion with the same step and number of samples, whose `changes` state the filter.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range, if no corner is given, or if low is not below high.

        References
        ----------
        Converse & Brady, U.S. Geol. Survey Open-File Report 92-296A (1992): the times of rest.

        Examples
        --------
        >>> import rocking as rk
        >>> motion = rk.example_ground_motion().filtered(low=0.1, high=25.0)
        >>> motion.changes
        ('bandpass 0.1–25 Hz, Butterworth of order 4, forwards and backwards',)
        """
        from scipy.signal import butter, sosfiltfilt

        half = 0.5 / self._motion.step
        order = whole("order", order, *ORDERS)
        corners = {}
        for name, value in (("low", low), ("high", high)):
            if value is not None:
                allowed = f"lie between 0 and half the sampling rate, {half:g} Hz"
                corners[name] = real(name, value, allowed)
                if not 0 < corners[name] < half:
                    raise Refusal(name, allowed, value)
        if not corners:
            raise Refusal("low", "be given, or high: the corners of the filter in Hz", low)
        if len(corners) == 2 and not corners["low"] < corners["high"]:
            raise Refusal("low", f"be below high, {corners['high']:g} Hz", low)
        lowest, step = min(corners.values()), self._motion.step
        if (least := PAD * order / step / MAX_SAMPLES) > lowest:
            raise Refusal(next(iter(corners)), f"be at least {least:.4g} Hz", lowest)
        rest = np.zeros(math.ceil(PAD * order / lowest / step))
        kind = "bandpass" if len(corners) == 2 else "highpass" if low is not None else "lowpass"
        edges = np.array(list(corners.values())).squeeze()
        sections = butter(order, edges, kind, output="sos", fs=1 / step)
        samples = sosfiltfilt(sections, np.concatenate((rest, self._motion._samples, rest)), padtype=None)
        band = "–".join(f"{corner:g}" for corner in corners.values())
        return self._changed(
            samples[rest.size : rest.size + self._motion._samples.size].copy(),
            f"{kind} {band} Hz, Butterworth of order {order}, forwards and backwards",
        )

    def rotated(self, other: GroundMotion, angle: float) -> GroundMotion:
        """Return the horizontal component between two perpendicular ones: a cos φ + b sin φ.

        Parameters
        ----------
        other : GroundMotion
            Other horizontal component b of the same station, with the same step and number of samples.
        angle : float
            Angle φ in rad from this component, a, towards the other one, in [-2π, 2π].

        Returns
        -------
        GroundMotion
            Motion with the file of this component. Its `changes` state the angle, and the other component with the first digits of
            its SHA-256. If the names of both components state azimuths, as 90° and N28W do, its own is the azimuth.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range, or if step or number of samples differ. Also if a component is
            vertical, or if the names state azimuths that are not perpendicular within 5°.

        Examples
        --------
        >>> import math, rocking as rk
        >>> east, north = (rk.GroundMotion([0.0, a, 0.0], step=0.1, component=n) for a, n in ((3.0, "90°"), (4.0, "0°")))
        >>> east.rotated(north, math.atan2(4, 3)).acceleration.round(12).tolist()
        [0.0, 5.0, 0.0]
        """
        checked_pair(self._motion, other)
        turn = within("angle", angle, -FULL_TURN, FULL_TURN, "rad")
        for name, each in (("this component", self._motion), ("other", other)):
            if each.vertical:
                raise Refusal(name, "be horizontal", each.component)
        component = self._between(other, math.degrees(turn))
        cos, sin = math.cos(turn), math.sin(turn)
        # The factor stays that of both if it is the same.
        same = self._motion.factor == other.factor
        first, second = (each._samples if same else each.acceleration for each in (self._motion, other))
        label = ", ".join(filter(None, (other.name, other.component))) or "the other component"
        scales = "" if same else f", factors {self._motion.factor:g} and {other.factor:g}"
        if other.file is not None:
            label += f", {other.file.name}, SHA-256 {other.file.sha256[:DIGITS_OF_DIGEST]}…"
        done = "".join(f", {each}" for each in other.changes)
        return self._changed(
            cos * first + sin * second,
            f"rotated by {math.degrees(turn):.6g}° towards {label}{done}{scales}",
            component=component,
            factor=self._motion.factor if same else 1.0,
        )

    def _between(self, other: GroundMotion, degrees: float) -> str:
        """Return the name of the component at an angle from this one towards another."""
        own, second = azimuth(self._motion.component), azimuth(other.component)
        if own is None or second is None:
            names = (self._motion.component or "the first component", other.component or "the second")
            return f"{degrees:.6g}° from {names[0]} towards {names[1]}"
        apart = (second - own + 180.0) % 360.0 - 180.0
        if abs(abs(apart) - 90.0) > RIGHT_ANGLE:
            raise Refusal("other", f"be perpendicular to {self._motion.component}", other.component)
        return f"{(own + math.copysign(degrees, apart * degrees)) % 360.0:.6g}°"

    def floor(self, period: float, damping: float = DAMPING) -> GroundMotion:
        """Return the acceleration of a floor: the absolute acceleration of a linear oscillator on this ground, from rest.

        With u'' + 2ζω u' + ω² u = −a, the floor accelerates by a + u'' = −(ω² u + 2ζω u'). Its values at the samples are exact for
        the straight lines of the ground. The motion that is returned is that of straight lines between these values, too:
        `resampled(…)` of the ground first makes them finer. The free vibration after the ground is followed until it is below 1 % of
        the peak, but no longer than the ground moves.

        Parameters
        ----------
        period : float
            Natural period 2π/ω in s, in [1e-4, 1e4].
        damping : float
            Damping ratio ζ, in [0, 0.99]. Default: 0.05.

        Returns
        -------
        GroundMotion
            Motion with the same step, whose name and `changes` state the oscillator.

        Raises
        ------
        TypeError, ValueError
            If a value is of the wrong type or lies outside its range.

        References
        ----------
        Nigam & Jennings, Bull. Seismol. Soc. Am. 59, 909–922 (1969).

        Examples
        --------
        >>> import rocking as rk
        >>> ground = rk.example_ground_motion()
        >>> floor = ground.floor(period=0.5)
        >>> floor.name, floor.pga > ground.pga
        ('San Francisco, 1295 Shafter, F, floor 0.5 s, damping 0.05', True)
        """
        period = within("period", period, *PERIODS, "s")
        damping = within("damping", damping, 0, MAX_DAMPING)
        size = self._motion._samples.size
        more = size - 1
        decay, lasts = FULL_TURN * damping * self._motion.step, -math.log(TAIL) * period
        if more * decay > lasts:
            more = math.ceil(lasts / decay)
        samples = floor_acceleration(
            self._motion._samples, self._motion.step, period, damping, min(more, MAX_SAMPLES - size)
        )
        loud = np.flatnonzero(np.abs(samples) >= TAIL * np.abs(samples).max())
        kept = max(size, int(loud[-1]) + 1 if loud.size else 0)
        what = f"floor {period:g} s, damping {damping:g}"
        return self._changed(
            samples[:kept].copy(),
            f"absolute acceleration of a linear oscillator, period {period:g} s, damping {damping:g}",
            name=", ".join(filter(None, (self._motion.name, what))),
        )


def _share_above(samples: np.ndarray, share: float) -> float:
    """Return the share of the energy above a share of half the sampling rate."""
    from scipy.fft import rfft

    power = np.abs(rfft(samples)) ** 2
    total = float(power.sum())
    return float(power[math.ceil(share * (power.size - 1)) :].sum()) / total if total else 0.0
