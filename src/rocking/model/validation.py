"""One-line refusals, shared by every room: the argument, its value, what is allowed, and the way out where there is one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from typing import Any, TypeVar

import numpy as np

Value = TypeVar("Value")

MAX_SHOWN_LENGTH = 60
WAYS = {
    "State": "make one: rk.State(angle=0.1, velocity=0.0)",
    "Harmonic": "make one: rk.Harmonic(amplitude=2.0, period=1.0)",
    "Braces": "make one: rk.Braces(angle=1.0)",
    "Block": "make one: rk.Block(height=2.0, width=0.5)",
    "System": "make one: rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), or by rk.Block",
    "Orbit": "rk.classify finds one only where the response is periodic; rk.find_orbits looks for all",
}
"""How one comes by a value of a kind."""


class TooManyEvents(ValueError):
    """The run met more events than it may keep; the message says how to ask for less."""


class TooShort(ValueError):
    """What was given is too short for a number with its error; `estimate` carries what it does support."""

    def __init__(self, message: str, estimate: Any) -> None:
        super().__init__(message)
        self.estimate = estimate

    def __reduce__(self) -> tuple[Any, ...]:
        # by itself an exception is made again of its message alone
        return type(self), (str(self), self.estimate), self.__dict__


class NoOrbit(ValueError):
    """No periodic orbit was found; `state` is what was reached, at the forcing phase `phase`, `residual` its miss a period later."""

    def __init__(self, message: str, phase: float, state: Any, residual: float) -> None:
        super().__init__(message)
        self.phase = phase
        self.state = state
        self.residual = residual

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.phase, self.state, self.residual), self.__dict__


def shown(value: object) -> str:
    """Show a value in one short line, NumPy's numbers as plain ones."""
    if isinstance(value, np.generic):
        value = value.item()
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # a whole number of more digits than Python writes
        text = "a number of too many digits"
    return text if len(text) <= MAX_SHOWN_LENGTH else text[: MAX_SHOWN_LENGTH - 1] + "…"


def refusal(name: str, allowed: str, value: object, remedy: str = "") -> str:
    """The one sentence in which every room refuses a value."""
    return f"{name} must {allowed}; got {shown(value)}" + (f" ({remedy})" if remedy else "")


def refuse_if(wrong: object, name: str, allowed: str, value: object, remedy: str = "") -> None:
    """Refuse the value of an argument with a sentence, where something is wrong with it."""
    if wrong:
        raise ValueError(refusal(name, allowed, value, remedy))


def within(name: str, value: float, low: float, high: float, unit: str = "", if_below: str = "") -> float:
    """Return `value` as a float that lies in [low, high]; NaN, infinities and whatever is no real number are refused.

    `if_below` is the way out for a value that is too small.

    Raises
    ------
    TypeError
        `value` is no real number (a bool, a string, a complex number, an array, None).
    ValueError
        `value` lies outside the range.

    Examples
    --------
    >>> within("restitution", 1, 0, 1)
    1.0
    >>> within("restitution", 1.2, 0, 1)
    Traceback (most recent call last):
    ValueError: restitution must lie in [0, 1]; got 1.2
    """
    interval = f"[{low:.6g}, {high:.6g}]" + (f" {unit}" if unit else "")
    number = _real(name, value, f"be a real number in {interval}")
    if not low <= number <= high:
        raise ValueError(refusal(name, f"lie in {interval}", value, if_below if number < low else ""))
    return number


def finite(name: str, value: float, largest: float) -> float:
    """Return `value` as a float of size up to `largest`, which no sensible value comes near; errors as `within` has them."""
    allowed = f"be a finite real number of size up to {largest:g}"
    number = _real(name, value, allowed)
    if not abs(number) <= largest:
        raise ValueError(refusal(name, allowed, value))
    return number


def _real(name: str, value: float, allowed: str) -> float:
    """A real number as a float, infinite beyond the range of floats; TypeError for anything else."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(refusal(name, allowed, value))
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def whole(name: str, value: int, low: int, high: int) -> int:
    """Return `value` as an int in [low, high]; a float is taken where it is whole (1e6), a fraction never.

    Raises TypeError and ValueError as `within` does.
    """
    allowed = f"be a whole number in [{low}, {high}]"
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(refusal(name, allowed, value))
    if not low <= value <= high or value != int(value):
        raise ValueError(refusal(name, allowed, value))
    return int(value)


def reals(name: str, values: Any) -> Any:
    """Return a real number as a float, anything array-like as an array of floats.

    Raises TypeError where `values` holds something else than real numbers, ValueError for a number beyond all floats and
    where values are masked.
    """
    if isinstance(values, Real) and not isinstance(values, bool):
        try:
            return float(values)
        except OverflowError:
            largest = np.finfo(float).max
            raise ValueError(refusal(name, f"be a real number of size up to {largest:.6g}", values)) from None
    if _is_masked(values):
        raise ValueError(refusal(name, "hold no masked values", values, "leave them out, or fill them"))
    try:
        array = np.asarray(values)
    except ValueError:
        array = np.asarray(None)
    if array.dtype.kind not in "fiu":
        raise TypeError(refusal(name, "be a real number or an array of real numbers", values))
    return array.astype(float)


def _is_masked(values: Any) -> bool:
    """Return whether a value is masked in an array, or in a list of arrays however deep."""
    if isinstance(values, list | tuple):
        return any(map(_is_masked, values))
    return isinstance(values, np.ma.MaskedArray) and bool(np.ma.is_masked(values))


def members(name: str, values: Any, allowed: str) -> tuple[Any, ...]:
    """Return what a sequence holds; TypeError, which says what is `allowed`, for a text, a mapping and what holds nothing."""
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable):
        raise TypeError(refusal(name, allowed, values))
    try:
        return tuple(values)
    except TypeError:  # an array without dimensions
        raise TypeError(refusal(name, allowed, values)) from None


def pair(name: str, values: Any, allowed: str) -> tuple[Any, Any]:
    """Return both members of a pair; TypeError or ValueError, which says what is `allowed`, otherwise."""
    found = members(name, values, allowed)
    if len(found) != 2:
        raise ValueError(refusal(name, allowed, values))
    return found[0], found[1]


def instance(name: str, value: Value, kind: type) -> Value:
    """Return `value` if it is a `kind`; TypeError otherwise, which says how to come by one."""
    if not isinstance(value, kind):
        article = "an" if kind.__name__[0] in "AEIO" else "a"
        raise TypeError(refusal(name, f"be {article} {kind.__name__}", value, WAYS.get(kind.__name__, "")))
    return value


def one_of(name: str, value: str, allowed: Sequence[str]) -> str:
    """Return `value` if it is among the `allowed` words; TypeError or ValueError otherwise."""
    choices = f"be one of {', '.join(map(repr, allowed))}"
    if not isinstance(value, str):
        raise TypeError(refusal(name, choices, value))
    if value not in allowed:
        raise ValueError(refusal(name, choices, value))
    return value


def exactly_one(**values: object) -> str:
    """Return the name of the only one of `values` that is not None; TypeError otherwise.

    Examples
    --------
    >>> exactly_one(period=1.0, frequency=None)
    'period'
    >>> exactly_one(period=None, frequency=None)
    Traceback (most recent call last):
    TypeError: give exactly one of period, frequency; got none
    """
    given = {name: value for name, value in values.items() if value is not None}
    if len(given) != 1:
        got = " and ".join(f"{name}={shown(value)}" for name, value in given.items()) or "none"
        raise TypeError(f"give exactly one of {', '.join(values)}; got {got}")
    return next(iter(given))
