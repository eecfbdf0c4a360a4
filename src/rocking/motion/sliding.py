"""Sliding of a block that does not rock, under any base acceleration, with every start and every stop of sliding.

Between two marks the base acceleration is smooth, is monotone, and does not cross ±μ. So the velocity of a sliding block is
monotone there, and has one zero at most: a stop is missed nowhere, because the velocity is known at all marks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.block_formulas import GRAVITY
from rocking.model.forcing import MAX_TIME, BaseMotion, Cosine, Forcing, PiecewiseLinear, Pulse
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.quantity import FRICTION
from rocking.model.result import Result, along, described
from rocking.model.text import counted
from rocking.model.validation import instance, reals, warn_of_value

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

MARKS_AT_ONCE = 64
"""Number of marks among which the end of a slide is first sought. It doubles until the end is found."""
SAMPLES_OF_PULSE = 200
"""Number of samples of the history during a pulse that is a piece of a cosine."""


class Base(Protocol):
    """Base acceleration in units of g, with its marks in order, in s, and its values there."""

    marks: Array
    values: Array

    def integrals(self, starts: Array, ends: Array) -> tuple[Array, Array]:
        """Return ∫a dt and ∫(end − t) a dt between times; no mark lies inside. The base rests after the last mark."""

    def stop(self, start: float, end: float, speed: float, direction: float, friction: float) -> float:
        """Return the time at which the speed |x'|/g of a slide vanishes, between a start and an end without a mark inside."""


class Lines:
    """Base acceleration that is linear between samples."""

    def __init__(self, forcing: PiecewiseLinear, friction: float) -> None:
        self.corners, self.samples = forcing.corners, forcing.scale * forcing.values
        first, second, times, values = self.samples[:-1], self.samples[1:], [self.corners], [self.samples]
        for level in (friction, -friction):
            crossed = np.flatnonzero((first < level) != (second < level))
            part = (level - first[crossed]) / (second[crossed] - first[crossed])
            low, high = self.corners[crossed], self.corners[crossed + 1]
            times.append(np.clip(low + part * (high - low), low, high))
            values.append(np.full(crossed.size, level))
        self.marks, self.values = in_order(np.concatenate(times), np.concatenate(values))

    def integrals(self, starts: Array, ends: Array) -> tuple[Array, Array]:
        """Return ∫a dt and ∫(end − t) a dt."""
        first, second = (np.interp(each, self.corners, self.samples) for each in (starts, ends))
        length = np.where(starts < self.corners[-1], ends - starts, 0.0)
        return (first + second) * (length / 2), (2 * first + second) * (length**2 / 6)

    def stop(self, start: float, end: float, speed: float, direction: float, friction: float) -> float:
        """Return the root of a polynomial of degree 2: (σa + μ)s + σa's²/2 = |x'|/g."""
        first, second = direction * np.interp([start, end], self.corners, self.samples) + friction
        slope = (second - first) / (end - start)
        root = 2 * speed / (first + math.sqrt(max(first**2 + 2 * slope * speed, 0.0)))
        return min(start + root, end)


class Wave:
    """Base acceleration A cos(ωt + φ) of a pulse."""

    def __init__(self, pulse: Pulse, form: Cosine, friction: float) -> None:
        self.amplitude, self.phase, self.end = pulse.amplitude, form.phase, pulse.duration
        self.rate = math.tau * form.turns / pulse.duration
        turns = math.pi * np.arange(-1, 4)
        angles, values = [turns], [self.amplitude * np.cos(turns)]
        for level in (friction, -friction):
            if abs(level) < abs(self.amplitude):
                angle = math.acos(level / self.amplitude)
                there = np.concatenate([turns[1::2] - angle, turns[1::2] + angle])
                angles.append(there)
                values.append(np.full(there.size, level))
        times = (np.concatenate(angles) - self.phase) / self.rate
        inside = (times > 0) & (times < self.end)
        ends = np.array([0.0, self.end])
        self.marks, self.values = in_order(
            np.concatenate([ends, times[inside]]),
            np.concatenate(
                [self.amplitude * np.cos(self.rate * ends + self.phase), np.concatenate(values)[inside]]
            ),
        )

    def integrals(self, starts: Array, ends: Array) -> tuple[Array, Array]:
        """Return ∫a dt and ∫(end − t) a dt."""
        ends = np.where(starts < self.end, ends, starts)
        first, half = self.rate * starts + self.phase, self.rate * (ends - starts) / 2
        once = 2 * self.amplitude / self.rate * np.cos(first + half) * np.sin(half)
        level = 2 * np.sin(first + half) * np.sin(half) - 2 * half * np.sin(first)
        return once, self.amplitude / self.rate**2 * level

    def stop(self, start: float, end: float, speed: float, direction: float, friction: float) -> float:
        """Return the only zero of a monotone function, by Brent's method."""
        from scipy.optimize import brentq

        begin = np.array([start])

        def left(time: float) -> float:
            once, _ = self.integrals(begin, np.array([time]))
            return speed - direction * float(once[0]) - friction * (time - start)

        return brentq(left, start, end, xtol=1e-300, rtol=4 * np.finfo(float).eps) if left(end) < 0 else end


def in_order(times: Array, values: Array) -> tuple[Array, Array]:
    """Return marks and their values in the order of time."""
    order = np.argsort(times, kind="stable")
    return times[order], values[order]


def base_of(forcing: Forcing, friction: float) -> Base:
    """Return a base acceleration in units of g and s with its marks for a coefficient of friction."""
    if isinstance(forcing, Pulse) and forcing.cosine is not None:
        return Wave(forcing, forcing.cosine, friction)
    return Lines(forcing.samples if isinstance(forcing, Pulse) else forcing, friction)  # type: ignore[arg-type]


class Slide(NamedTuple):
    """Slide from a start to a stop: its marks, and x'/g and x/g there; the direction is −1 or 1."""

    direction: float
    times: Array
    speeds: Array
    moved: Array


def slides(base: Base, friction: float) -> Iterator[Slide]:
    """Yield the slides in the order of time, each from x = 0.

    A block at rest on the base starts to slide where |a| exceeds μ, against the base acceleration. Where its velocity vanishes
    it rests, or slides on in the other direction if |a| > μ.
    """
    ends = np.abs(base.values)
    over = np.flatnonzero(np.maximum(ends[:-1], ends[1:]) > friction)
    place, time = 0, -math.inf
    while (which := np.searchsorted(over, place)) < over.size:
        place = int(over[which])
        time = max(time, float(base.marks[place]))
        direction = -math.copysign(1.0, base.values[place] + base.values[place + 1])
        slide, place = _slide(base, friction, time, place, direction)
        time = float(slide.times[-1])
        if time > slide.times[0]:
            yield slide


def _slide(base: Base, friction: float, start: float, place: int, direction: float) -> tuple[Slide, int]:
    """Return the slide from a start after the mark `place`, where |a| > μ, and the mark from which the next one is sought."""
    times, speeds, moved = [np.array([start])], [np.zeros(1)], [np.zeros(1)]

    def follow(further: Array) -> int:
        """Append times, x'/g and x/g up to the first time at which the block has stopped; return the number of those before."""
        edges = np.append(times[-1][-1], further)
        length = np.diff(edges)
        once, twice = base.integrals(edges[:-1], edges[1:])
        speed = np.cumsum(np.append(speeds[-1][-1], -(once + direction * friction * length)))
        steps = speed[:-1] * length - (twice + direction * friction * length**2 / 2)
        stopped = np.flatnonzero(direction * speed[1:] <= 0)
        count = int(stopped[0]) if stopped.size else further.size
        if count:
            times.append(further[:count])
            speeds.append(speed[1 : count + 1])
            moved.append(np.cumsum(np.append(moved[-1][-1], steps[:count]))[1:])
        return count

    def ended(stop: float) -> Slide:
        edges = np.array([times[-1][-1]]), np.array([stop])
        length = stop - edges[0]
        _, twice = base.integrals(*edges)
        step = speeds[-1][-1] * length - (twice + direction * friction * length**2 / 2)
        columns = [*times, edges[1]], [*speeds, np.zeros(1)], [*moved, moved[-1][-1] + step]
        return Slide(direction, *map(np.concatenate, columns))

    first, count = place + 1, MARKS_AT_ONCE
    while first < base.marks.size:
        further = base.marks[first : first + count]
        before = follow(further)
        first, count = first + before, 2 * count
        if before == further.size:
            continue
        # a block that has just begun to slide is faster at the next mark, unless rounding hides it: it has stopped there
        last, mark, speed = float(times[-1][-1]), float(base.marks[first]), direction * float(speeds[-1][-1])
        stop = base.stop(last, mark, speed, direction, friction) if speed > 0 and mark > last else mark
        return ended(stop), first if stop == mark else first - 1
    return ended(float(times[-1][-1] + abs(speeds[-1][-1]) / friction)), base.marks.size


COLUMNS = {
    "time_s": ("time in s", "s"),
    "slip_m": ("displacement of the block on the base in m", "m"),
    "slip_velocity_m_per_s": ("velocity of the block relative to the base in m/s", "m s-1"),
    "base_acceleration_m_per_s2": ("horizontal acceleration of the base in m/s^2", "m s-2"),
}
SLIDE_COLUMNS = {
    "slide_start_s": ("time at which the block starts to slide, in s", "s"),
    "slide_end_s": ("time at which it stops, in s", "s"),
    "slide_slip_m": ("displacement on the base from start to stop, in m", "m"),
}


@frozen(eq=False)
class Slip(Result):
    """Motion of a block that slides and does not rock; returned by `slide`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over `instant`, at the samples of the base motion and at all starts and stops: `time_s`, `slip_m`, `slip_velocity_m_per_s` and
        `base_acceleration_m_per_s2`. Over `slide`: `slide_start_s`, `slide_end_s` and `slide_slip_m`.
    friction : float
        Coefficient of friction μ.
    largest : float
        Largest |slip| of the motion, in m.
    largest_time : float
        Time at which it is reached, in s; 0 without sliding.
    residual : float
        Slip at the end, in m, with its sign.
    path : float
        Sum of the |slip| of all slides, in m.

    Examples
    --------
    >>> import rocking as rk
    >>> result = rk.slide(rk.Pulse("rectangular", amplitude=0.6 * 9.80665, duration=0.5), friction=0.3)
    >>> print(result)
    slides 1 time, for 1 s in all; largest slip 0.7355 m, residual slip -0.7355 m
    >>> result.intervals.round(6).tolist()
    [[0.0, 1.0]]
    """

    PLOT: ClassVar[str] = "slip"
    LONG: ClassVar[tuple[str, ...]] = ("instant",)

    dataset: xr.Dataset = field(repr=False)
    friction: float
    largest: float
    largest_time: float
    residual: float
    path: float
    _base: Base = field(repr=False)
    _knots: tuple[Array, ...] = field(repr=False)

    @property
    def intervals(self) -> Array:
        """Starts and stops of the slides in s, shape (n, 2)."""
        return np.stack([self.dataset.slide_start_s.values, self.dataset.slide_end_s.values], axis=1)

    def at(self, times: Any) -> tuple[Array, Array]:
        """Return slip and slip velocity at given times, exact between the samples too.

        Parameters
        ----------
        times : float or array
            Times in s. Before 0 the block rests; after the last stop it stays.

        Returns
        -------
        tuple of (ndarray, ndarray)
            Slip in m and velocity in m/s, in the shape of `times`.

        Raises
        ------
        TypeError, ValueError
            If `times` holds anything but finite real numbers.

        Examples
        --------
        >>> import rocking as rk
        >>> result = rk.slide(rk.Pulse("rectangular", amplitude=0.6 * 9.80665, duration=0.5), friction=0.3)
        >>> slip, velocity = result.at([0.5, 2.0])
        >>> slip.round(6).tolist(), velocity.round(6).tolist()
        ([-0.367749, -0.735499], [-1.470998, 0.0])
        """
        return path_at(self._base, self.friction, self._knots, np.asarray(reals("times", times, MAX_TIME)))

    def __str__(self) -> str:
        if not self.dataset.sizes["slide"]:
            return "does not slide"
        intervals = self.intervals
        total = float((intervals[:, 1] - intervals[:, 0]).sum())
        return (
            f"slides {counted(len(intervals), 'time')}, for {total:.4g} s in all; largest slip {self.largest:.4g} m, "
            f"residual slip {self.residual:.4g} m"
        )


def path_at(base: Base, friction: float, knots: tuple[Array, ...], times: Array) -> tuple[Array, Array]:
    """Return slip in m and its velocity in m/s at times, from the marks of the slides."""
    begins, directions, speeds, places = knots
    flat = np.atleast_1d(times).ravel()
    k = np.maximum(np.searchsorted(begins, flat, side="right") - 1, 0)
    length = np.where(directions[k] != 0, flat - begins[k], 0.0)
    once, twice = base.integrals(begins[k], begins[k] + length)
    speed = speeds[k] - (once + directions[k] * friction * length)
    place = places[k] + speeds[k] * length - (twice + directions[k] * friction * length**2 / 2)
    zero = 0.0  # added to −0
    return GRAVITY * place.reshape(times.shape) + zero, GRAVITY * speed.reshape(times.shape) + zero


def slide(ground: BaseMotion, friction: float) -> Slip:
    """Follow a block that slides on a shaking base and does not rock: x'' = −g(a + μ sgn x').

    a is the base acceleration in units of g, and x the displacement relative to the base. The block rests on the base while |a| ≤ μ.
    Between two samples x is a polynomial of degree 3. Starts and stops of sliding are roots of polynomials of degree 1 and 2, in
    closed form. So the slip is exact to rounding. Under a pulse that is a piece of a cosine, the stop is the zero of a monotone
    function.

    Parameters
    ----------
    ground : GroundMotion or Pulse
        Base motion in SI units. The base has no acceleration before and after it.
    friction : float
        Coefficient of friction μ, in [0.001, 10], the same at rest and in motion.

    Returns
    -------
    Slip
        History, largest and residual slip, and intervals of sliding.

    Raises
    ------
    TypeError
        If `ground` is not a base motion in SI units, or `friction` is not a real number.
    ValueError
        If `friction` lies outside its range.

    Warns
    -----
    InputWarning
        If `ground` is a vertical component: the base moves horizontally.

    See Also
    --------
    rocking.theory.first_motion : Whether a block slides or rocks.
    rocking.simulate : A block that rocks; `Motion.validity` has the friction that it needs.

    Notes
    -----
    A rectangular pulse A g of duration T > 0 with A > μ moves the block by (A g T)²/(2g) (1/μ − 1/A): by g(A − μ)T²/2 during the
    pulse, and by (g(A − μ)T)²/(2gμ) after it.

    References
    ----------
    Newmark (1965).

    Examples
    --------
    >>> import rocking as rk
    >>> ground = rk.example_ground_motion().scaled(pga=5.0)
    >>> print(rk.slide(ground, friction=0.3))
    slides ... times, for ... s in all; largest slip ... m, residual slip ... m
    """
    base_motion = instance("ground", ground, BaseMotion)
    mu = FRICTION.checked(friction)
    if isinstance(base_motion, GroundMotion) and base_motion.vertical:
        warn_of_value(vertical_sentence([base_motion.component]))
    forcing = base_motion.normalised(GRAVITY, 1.0)
    base = base_of(forcing, mu)
    found = list(slides(base, mu))
    knots = knots_of(found)
    return _result(forcing, base, mu, found, knots)


def knots_of(found: list[Slide]) -> tuple[Array, ...]:
    """Return all marks of the slides: times, the direction after each (0 at rest), x'/g and x/g."""
    ends = np.cumsum([0.0, *(each.moved[-1] for each in found)])
    still = np.zeros(1)
    return (
        np.concatenate([np.array([-MAX_TIME]), *(each.times for each in found)]),
        np.concatenate(
            [still, *(np.append(np.full(each.times.size - 1, each.direction), 0.0) for each in found)]
        ),
        np.concatenate([still, *(each.speeds for each in found)]),
        np.concatenate([still, *(end + each.moved for end, each in zip(ends, found, strict=False))]),
    )


def _result(forcing: Forcing, base: Base, mu: float, found: list[Slide], knots: tuple[Array, ...]) -> Slip:
    import xarray as xr

    starts, stops, moved = (
        np.array([(each.times[0], each.times[-1], each.moved[-1]) for each in found]).reshape(-1, 3).T
    )
    times = np.linspace(0.0, forcing.span, SAMPLES_OF_PULSE + 1) if isinstance(base, Wave) else base.corners  # type: ignore[attr-defined]
    times = np.unique(np.concatenate([times, starts, stops]))
    if times[-1] > forcing.span:  # the block slides on when the base rests
        times = np.unique(np.append(times, np.linspace(forcing.span, times[-1], SAMPLES_OF_PULSE + 1)))
    slip, velocity = path_at(base, mu, knots, times)
    acceleration = np.where(times <= base.marks[-1], np.interp(times, base.marks, base.values), 0.0)
    if isinstance(base, Wave):
        acceleration = np.asarray(forcing.acceleration(times))
    history = zip(COLUMNS.items(), (times, slip, velocity, GRAVITY * acceleration + 0.0), strict=True)
    each = zip(SLIDE_COLUMNS.items(), (starts, stops, GRAVITY * moved), strict=True)
    ends = GRAVITY * np.cumsum(moved)
    highest = int(np.argmax(np.abs(ends))) if found else 0
    numbers = {
        "largest": float(abs(ends[highest])) if found else 0.0,
        "largest_time": float(stops[highest]) if found else 0.0,
        "residual": float(ends[-1]) if found else 0.0,
        "path": GRAVITY * float(np.abs(moved).sum()),
    }
    attributes = described("Sliding motion") | {
        "comment": "Slip is the displacement relative to the base. All quantities are in SI units.",
        "friction": mu,
        **{f"{name}{'_s' if name.endswith('time') else '_m'}": value for name, value in numbers.items()},
        "slides": len(found),
        "sliding_time_s": float((stops - starts).sum()),
    }
    variables = along("instant", {name: (values, text, unit) for (name, (text, unit)), values in history})
    variables |= along("slide", {name: (values, text, unit) for (name, (text, unit)), values in each})
    return Slip(xr.Dataset(variables, attrs=attributes), friction=mu, **numbers, base=base, knots=knots)
