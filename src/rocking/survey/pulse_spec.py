"""Survey of blocks under one pulse: amplitudes, frequencies and coefficients of restitution."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from attrs import field, frozen

from rocking.model.forcing import KINDS, SINES
from rocking.model.system import RANGES
from rocking.model.validation import WrongType, one_of
from rocking.survey.spec import SurveySpec, Values, is_axis, number_or_axis

QUANTITIES: dict[str, tuple[str, str]] = {
    "amplitude": ("A", "largest base acceleration in units of g theta_cr"),
    "frequency": ("Ω", "frequency of the pulse in radians per normalised time"),
    "restitution": ("e", "coefficient of restitution"),
    "critical_angle": ("θcr", "critical angle of the full equation of motion in rad"),
}
"""Symbol and description of each quantity, in the order of the dimensions."""


class Pulses(NamedTuple):
    """Pulses at n points, each an array (n,)."""

    kind: str
    amplitude: np.ndarray
    duration: np.ndarray
    restitution: np.ndarray
    critical_angle: np.ndarray  # rad
    full: bool  # whether the blocks follow the full equation of motion


def turns(kind: str) -> float:
    """Return the periods 2π/Ω in the duration of a pulse: a half for the half-sine, one for the others."""
    return SINES[kind].turns if kind in SINES else 1.0


@frozen(eq=False)
class PulseSpec(SurveySpec):
    """Survey of blocks at rest under one pulse of a kind."""

    comment = "A peak is in units of the critical angle; impacts of chattering sequences do not count."

    kind: str = field(kw_only=True)

    @property
    def full(self) -> bool:
        """Flag: the blocks follow the full equation of motion."""
        return "critical_angle" in self.axes or "critical_angle" in self.fixed

    def inputs(self, values: Values) -> Pulses:
        """Return the pulses at n points."""
        count = next(iter(values.values())).size
        given = {name: np.full(count, value) for name, value in self.fixed.items()} | dict(values)
        duration = turns(self.kind) * math.tau / given["frequency"]
        angle = given["critical_angle"] if self.full else np.zeros(count)
        return Pulses(self.kind, given["amplitude"], duration, given["restitution"], angle, self.full)

    def described(self) -> dict[str, Any]:
        """Return the kind of the pulse and the quantities that do not vary, by name."""
        return {"pulse": self.kind} | self.fixed

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        symbol, long_name = QUANTITIES[name]
        return {"long_name": long_name, "symbol": symbol, "units": "1"}


def pulse_question(
    kind: str, amplitude: Any, frequency: Any, restitution: Any, critical_angle: Any = None
) -> PulseSpec:
    """Check the quantities of a survey of pulses: arrays are axes. Restitution and critical angle may be numbers.

    Raises
    ------
    TypeError, ValueError
        If a quantity is of the wrong type or outside its range, or if amplitude or frequency is a number.
    """
    kind = one_of("kind", kind, KINDS)
    axes: dict[str, np.ndarray] = {}
    fixed: dict[str, float] = {}
    given = {"amplitude": amplitude, "frequency": frequency, "restitution": restitution}
    if critical_angle is not None:
        given["critical_angle"] = critical_angle
    for name, value in given.items():
        if name in ("amplitude", "frequency") and not is_axis(value):
            allowed = "be an ascending array, an axis of the spectrum"
            raise WrongType(name, allowed, value, "such as np.linspace(start, stop, count)")
        checked = number_or_axis(name, value, RANGES[name])
        if isinstance(checked, np.ndarray):
            axes[name] = checked
        else:
            fixed[name] = checked
    return PulseSpec(axes, fixed, kind=kind)
