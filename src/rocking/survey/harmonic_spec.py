"""Survey of blocks on a harmonic base: the quantities that vary, the values of the others, and the systems at points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from attrs import frozen

from rocking.kernels.forcing import parameters as numbers
from rocking.model.system import NO_BRACES, RANGES, check_below_flat, check_between
from rocking.model.validation import Incomplete, Text, WrongType, exactly_one
from rocking.survey.spec import SurveySpec, Values, is_axis, number_or_axis

SYMBOLS = {
    "amplitude": ("A", "amplitude of the base acceleration in units of g theta_cr"),
    "velocity": ("Θ'", "initial angular velocity in units of alpha theta_cr"),
    "restitution": ("e", "coefficient of restitution"),
    "brace_angle": ("Θb", "angle of the braces in units of theta_cr"),
    "brace_restitution": ("r", "coefficient of restitution of the braces"),
    "phase": ("φ", "phase of the base acceleration"),
    "angle": ("Θ", "initial angle in units of theta_cr"),
    "frequency": ("Ω", "forcing frequency in radians per normalised time"),
    "period": ("T", "forcing period in normalised time"),
    "critical_angle": ("θcr", "critical angle"),
}


SYSTEM = (
    "amplitude",
    "frequency",
    "period",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
)
START = ("angle", "velocity")


class Points(NamedTuple):
    """Systems and initial states of points, as arrays for the kernels."""

    systems: np.ndarray  # (n, 8), SYSTEM, as `kernels.forcing.parameters.parameters_of_row` takes it
    starts: np.ndarray  # (n, 2), START

    @property
    def lossless(self) -> np.ndarray:
        """Mask of the undamped points (e = 1)."""
        return np.asarray(self.systems[:, SYSTEM.index("restitution")] == 1.0)


@frozen(eq=False)
class HarmonicSpec(SurveySpec):
    """Survey of systems with a harmonic base motion.

    `brace_angle` and `brace_restitution` are absent without braces; either `period` or `frequency` is present.
    """

    comment = (
        "Attributes and coordinates are normalised as in Yim & Lin (1991), Eqs. (1)-(4); "
        "the base acceleration is amplitude cos(frequency time + phase)."
    )

    @property
    def full(self) -> bool:
        """True if the blocks follow the full equation of motion."""
        return "critical_angle" in self.axes or "critical_angle" in self.fixed

    def inputs(self, values: Values) -> Points:
        """Return the systems and initial states of n points."""
        return points(values, self.fixed)

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, in the order of the dataset attributes."""
        return {name: self.fixed[name] for name in RANGES if name in self.fixed}

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        return coordinate(name)


def coordinate(name: str) -> dict[str, str]:
    """Return the attributes of a coordinate."""
    symbol, long_name = SYMBOLS[name]
    return {
        "long_name": long_name,
        "symbol": symbol,
        "units": "rad" if name in ("phase", "critical_angle") else "1",
    }


def question(asked: Mapping[str, Any], count: int, what: str) -> HarmonicSpec:
    """Check the quantities of a survey: `count` of them are arrays, the axes, and the others are numbers or None.

    `what` names the survey in messages.

    Raises
    ------
    TypeError
        If a quantity is missing or has the wrong type, or if the number of axes is not `count`.
    ValueError
        If a value lies outside its range.
    """
    exactly_one(period=asked.get("period"), frequency=asked.get("frequency"))
    given = {name: asked[name] for name in RANGES if asked.get(name) is not None}
    missing = [name for name in ("amplitude", "restitution") if name not in given]
    if missing:
        raise Incomplete(what, " and ".join(f"{{{name}}}" for name in missing), Text("none"))
    rebound = 1.0 if "brace_angle" in given else given.pop("brace_restitution", 1.0)
    if is_axis(rebound) or rebound != 1.0:
        raise WrongType("brace_restitution", "be used with {brace_angle}", rebound)
    checked = {name: check_quantity(name, value) for name, value in given.items()}
    axes = {name: value for name, value in checked.items() if isinstance(value, np.ndarray)}
    fixed = {name: value for name, value in checked.items() if not isinstance(value, np.ndarray)}
    if len(axes) != count:
        names, more = [f"{{{name}}}" for name in axes or given], len(axes) - count
        got = " and ".join(names) if axes else f"none of {', '.join(names)}"
        remedy = f"give {'one' if more == 1 else more} of them as a number" if more > 0 else ""
        raise Incomplete(what, _counted(count), Text(got), remedy)
    asked_for = HarmonicSpec(axes, fixed)
    _check_braces(asked_for)
    return asked_for


def check_quantity(name: str, value: Any) -> float | np.ndarray:
    """Check a number or an axis of one quantity."""
    return number_or_axis(name, value, RANGES[name])


def _counted(count: int) -> str:
    words = {1: "one quantity as an array", 2: "two quantities as arrays"}
    return words.get(count, f"{count} quantities as arrays")


def _check_braces(asked: HarmonicSpec) -> None:
    """Raise ValueError for initial angles beyond the braces, or for braces at which a block lies flat."""
    if "brace_angle" not in asked.axes and "brace_angle" not in asked.fixed:
        return
    if asked.full:
        check_below_flat(max(_values(asked, "brace_angle")), max(_values(asked, "critical_angle")))
    check_between(max(_values(asked, "angle"), key=abs), min(_values(asked, "brace_angle")))


def _values(asked: HarmonicSpec, name: str) -> list[float]:
    return asked.axes[name].tolist() if name in asked.axes else [asked.fixed.get(name, 0.0)]


def points(values: Values, fixed: Mapping[str, float]) -> Points:
    """Return the systems and initial states of n points, with the same rounding as `System` and `State`.

    Each of the `values` has the shape (n,).
    """
    count = next(iter(values.values())).size
    usual = {"phase": 0.0, **NO_BRACES, "critical_angle": 0.0, "angle": 0.0, "velocity": 0.0}
    constants = usual | dict(fixed)
    given = {name: np.broadcast_to(value, count) for name, value in constants.items()} | dict(values)
    if "frequency" in given:
        given["period"] = math.tau / given["frequency"]
    else:
        given["frequency"] = math.tau / given["period"]
    given["phase"] = _within_a_turn(given["phase"])
    return Points(
        np.stack([given[name] for name in SYSTEM], axis=1), np.stack([given[name] for name in START], axis=1)
    )


def _within_a_turn(phases: np.ndarray) -> np.ndarray:
    if np.abs(phases).max(initial=0.0) <= math.pi:
        return phases
    distinct, places = np.unique(phases, return_inverse=True)
    return np.array([numbers.within_a_turn(phase) for phase in distinct.tolist()])[places]
