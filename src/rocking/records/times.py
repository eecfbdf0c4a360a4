"""Step of equidistant times as a file prints them, and samples at equidistant times where those of the file are not."""

from __future__ import annotations

from decimal import Decimal

import numpy as np
from attrs import frozen

from rocking.model.validation import RecordError
from rocking.records.text_file import MAX_SAMPLES, TextFile, with_exponent_e

ONE_COLUMN = "correct the times, or remove their column and give the step"
MAX_DIGITS = 17
DRIFT = 1e-2
"""Allowed deviation of a time, in steps, in addition to its rounding."""
MAX_DEVIATION = 0.2
"""Allowed deviation in steps, if the times are printed finely enough to show a larger one."""
MAX_DOUBT = 0.01
"""Allowed relative width of the range of steps that agree with coarsely printed times."""


@frozen(eq=False)
class PrintedTimes:
    """Times of the samples as a file prints them.

    Attributes
    ----------
    values : ndarray (n,)
        Times in s.
    step : float or None
        Step of all of them, in s; None if no step agrees with them, or many do.
    low, high : float
        Range of the steps that agree with the printed times, in s; empty if low > high.
    fault : str
        Sentence on times that have no step; empty for others.
    doubt : str
        Sentence on a step that follows from coarsely printed times; empty for others.
    """

    values: np.ndarray
    step: float | None
    low: float
    high: float
    fault: str = ""
    doubt: str = ""

    def sampled(
        self, place: str, samples: np.ndarray, given: float | None
    ) -> tuple[np.ndarray, float, str, str]:
        """Return samples at equidistant times, their step, what was done to them, and a doubt; errors begin with `place`.

        `given`, the argument `step`, decides among the steps that agree with the times. Uneven times are resampled at it.
        """
        if given is None:
            if self.step is None:
                raise RecordError(self.fault, "step")
            return samples, self.step, "", self.doubt
        if self.low <= given <= self.high or given == self.step:
            return samples, given, "", ""
        if self.step is not None:
            rule = "omit step, or correct the times"
            raise RecordError(f"{place}: the times give a step of {self.step:g} s; {rule}", "step")
        if not (np.diff(self.values) > 0).all():
            raise RecordError(
                f"{place}: the times must increase from line to line to be resampled; {ONE_COLUMN}"
            )
        count = int((self.values[-1] - self.values[0]) / given * (1 + 1e-12)) + 1
        if count > MAX_SAMPLES:
            raise RecordError(f"{place}: the step {given:g} s gives more than {MAX_SAMPLES:,} samples")
        resampled = np.interp(self.values[0] + given * np.arange(count), self.values, samples)
        return (
            resampled,
            given,
            f"resampled from uneven times to {given:g} s along straight lines",
            f"the times are uneven; the samples are those of straight lines between them, at a step of {given:g} s",
        )


def printed_times(file: TextFile, places: list[int], texts: list[str]) -> PrintedTimes:
    """Return the times of a column, with their step as the shortest decimal number that agrees with them."""
    if len(texts) < 2:
        raise file.error(places[-1], "at least two times expected")
    times = file.numbers(places, texts, "a time")
    rounding = _rounding(texts)
    count = len(times) - 1
    step = float(times[-1] - times[0]) / count
    if not step > 0:
        raise file.error(places[-1], "the times must increase")
    deviation = np.abs(times - times[0] - step * np.arange(count + 1))
    tolerance = 2 * rounding + DRIFT * step
    fine = np.minimum(tolerance, MAX_DEVIATION * step)
    places_from_first = np.arange(1, count + 1)
    reach = rounding[1:] + rounding[0]
    low = float(((times[1:] - times[0] - reach) / places_from_first).max())
    high = float(((times[1:] - times[0] + reach) / places_from_first).min())
    if (deviation <= fine).all():
        return PrintedTimes(times, _shortest(step, float(rounding.max()) / count), low, high)
    if (deviation <= tolerance).all() and low <= high:
        shortest = _shortest((low + high) / 2, (high - low) / 2)
        if high - low <= MAX_DOUBT * step:
            to = f"rounded to {2 * float(rounding.max()):g} s"
            doubt = f"the times are {to}; the step is taken as {shortest:g} s, which agrees with all of them"
            return PrintedTimes(times, shortest, low, high, doubt=doubt)
    else:
        low, high = np.inf, -np.inf
    agreeing = _shortest((low + high) / 2, (high - low) / 2) if low <= high else None
    fault = _uneven(file, places, texts, times, fine, agreeing)
    return PrintedTimes(times, None, low, high, fault)


def _shortest(step: float, allowed: float) -> float:
    """Return the shortest decimal number that differs from a step by no more than allowed; the step if there is none."""
    shorter = (float(f"{step:.{digits}g}") for digits in range(1, MAX_DIGITS))
    return next((value for value in shorter if abs(value - step) <= allowed), step)


def _uneven(
    file: TextFile,
    places: list[int],
    texts: list[str],
    times: np.ndarray,
    tolerance: np.ndarray,
    agreeing: float | None,
) -> str:
    """Return the sentence on times that are not equidistant, with the first that differs from most and the way out.

    A step suffices if the times are rounded ones of equidistant times, such as at the step `agreeing`, or if they increase.
    """
    steps = np.diff(times)
    most = float(np.median(steps))
    uneven = np.abs(steps - most) > 2 * tolerance[1:]
    if uneven.any():
        at = int(np.argmax(uneven)) + 1
        message = f"{texts[at]} s follows {texts[at - 1]} s, and most steps are {most:.6g} s"
    else:
        expected = times[0] + most * np.arange(len(times))
        at = int(np.argmax(np.abs(times - expected) > tolerance))
        message = f"{texts[at]} s where {expected[at]:.6g} s is expected, at a step of {most:.6g} s"
    example = most if most > 0 else float(times[-1] - times[0]) / (len(times) - 1)
    if agreeing is not None:
        example = agreeing
    if agreeing is not None or steps.min() > 0:
        way_out = f"to resample them along straight lines, or if they are rounded, give a step, for example step={example:.6g}"
    else:
        way_out = f"they do not increase from line to line: {ONE_COLUMN}, for example step={example:.3g}"
    return str(file.error(places[at], f"the times are not equidistant: {message}; {way_out}"))


def _rounding(texts: list[str]) -> np.ndarray:
    """Return half a unit of the last digit of each time.

    Programs leave out the last zeros of a decimal number, but not of one with an exponent.
    """
    plain = [
        len(text.partition(".")[2])
        for text in texts
        if text.isascii() and text.lstrip("+-").replace(".", "").isdigit()
    ]
    finest = 0.5 * 10.0 ** -max(plain, default=0)
    if len(plain) == len(texts):
        return np.full(len(texts), finest)
    exponents = [int(Decimal(with_exponent_e(text)).as_tuple().exponent) for text in texts]
    return np.array([0.5 * 10.0 ** min(exponent, 0) for exponent in exponents])
