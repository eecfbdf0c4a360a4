"""Specification of a survey: axes of the varying quantities and values of the others."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, TypeVar

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.text import shown
from rocking.model.validation import Refusal, Text, WrongType, reals, within

Values = Mapping[str, np.ndarray]
Spec = TypeVar("Spec", bound="SurveySpec")


@frozen(eq=False)
class SurveySpec:
    """Axes of a survey by name, in the order of its dimensions, and the values of the other quantities: base class."""

    comment: ClassVar[str] = ""
    contiguous: ClassVar[bool] = False
    """Flag: the points of a batch are neighbours, because neighbours share some of the work."""

    axes: dict[str, np.ndarray]
    fixed: dict[str, float] = field(factory=dict)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def points(self) -> int:
        """Total number of points."""
        return math.prod(self.shape)

    def with_axes(self: Spec, axes: dict[str, np.ndarray]) -> Spec:
        """Return the survey over other axes of the same names, such as those of a tile."""
        return evolve(self, axes=axes)

    def inputs(self, values: Values) -> Any:
        """Return the inputs of a measurement at n points, from the values (n,) of the varying quantities."""
        raise NotImplementedError

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, in the order of the dataset attributes."""
        raise NotImplementedError

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        raise NotImplementedError


def axis(name: str, values: Any, span: tuple[float, float]) -> np.ndarray:
    """Check an axis: two or more finite numbers in range, ascending; raises TypeError or ValueError."""
    low, high = span
    allowed = f"hold two numbers or more in [{low:.6g}, {high:.6g}], ascending"
    try:
        array = np.asarray(reals(name, values))
    except TypeError:
        raise WrongType(name, allowed, values) from None
    if array.ndim != 1 or array.size < 2:
        got = "an empty array" if array.size == 0 else f"an array of shape {array.shape}"
        remedy = "give a number for a quantity that does not vary" if array.size == 1 else ""
        raise Refusal(name, allowed, Text(got), remedy)
    inside = (array >= low) & (array <= high)
    if not inside.all():
        where = int(np.argmin(inside))
        raise Refusal(name, allowed, Text(f"{shown(array[where])} at index {where}"))
    rising = np.diff(array) > 0
    if not rising.all():
        where = int(np.argmin(rising))
        got = f"{shown(array[where])} before {shown(array[where + 1])} at index {where + 1}"
        raise Refusal(name, allowed, Text(got))
    return array + 0.0  # no negative zeros


def number_or_axis(name: str, value: Any, span: tuple[float, float]) -> float | np.ndarray:
    """Check a number or an axis of one quantity, in a range; raises TypeError or ValueError."""
    if is_axis(value):
        return axis(name, value, span)
    if isinstance(value, str):
        low, high = span
        way_out = "an axis is an array, such as np.linspace(start, stop, count)"
        raise WrongType(name, f"be a real number in [{low:.6g}, {high:.6g}] or an array", value, way_out)
    return within(name, value, *span)


def is_axis(value: Any) -> bool:
    """Return whether a value is a sequence or an array, not a number."""
    return (isinstance(value, Sequence) and not isinstance(value, str | bytes)) or getattr(
        value, "ndim", 0
    ) > 0
