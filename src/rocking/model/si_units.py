"""SI counterparts of normalised quantities: names, units and conversions for files and printed results."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rocking.model.block import Block

MAX_ROUNDING = 4
"""Rounding errors by which a number differs at most that was normalised and converted back."""


class Physical(NamedTuple):
    """SI counterpart of a normalised quantity."""

    normalised: str  # unit of the normalised quantity
    name: str
    unit: str
    key: str  # name with unit, for JSON and CSV
    cf: str  # unit in the notation of the CF conventions
    turn: Callable[[Block, Any], Any]

    @property
    def heading(self) -> str:
        """Heading of a column."""
        return f"{self.name} [{self.unit}]"


def _as_given(turn: Callable[[Block, Any], Any]) -> Callable[[Block, Any], Any]:
    """Return a conversion of a quantity that may have been given in SI: rounding does not change 3 to 2.9999999999999996.

    A number is replaced by one with 15 digits if both agree to rounding.
    """

    def turned(block: Block, value: Any) -> Any:
        physical = np.asarray(turn(block, value))
        distinct, places = np.unique(physical, return_inverse=True)
        short = np.array([float(f"{each:.15g}") for each in distinct.tolist()])
        with np.errstate(invalid="ignore"):
            same = np.abs(short - distinct) <= MAX_ROUNDING * np.spacing(np.abs(distinct))
        found = np.where(same, short, distinct)[places].reshape(physical.shape)
        return found if found.ndim else float(found)

    return turned


def _per_second(block: Block, rate: Any) -> Any:
    """Convert a rate per τ to a rate per second."""
    return rate * block.frequency_parameter


PHYSICAL = {
    "amplitude": Physical(
        "g theta_cr",
        "acceleration",
        "m/s^2",
        "acceleration_m_per_s2",
        "m s-2",
        _as_given(Block.acceleration),
    ),
    "period": Physical("1/alpha", "period", "s", "period_s", "s", _as_given(Block.seconds)),
    "frequency": Physical("alpha", "frequency", "Hz", "frequency_hz", "Hz", _as_given(Block.hertz)),
    "time": Physical("1/alpha", "time", "s", "time_s", "s", Block.seconds),
    "angle": Physical("theta_cr", "angle", "rad", "angle_rad", "rad", Block.radians),
    "velocity": Physical(
        "alpha theta_cr", "velocity", "rad/s", "velocity_rad_per_s", "rad s-1", Block.radians_per_second
    ),
    "peak": Physical("theta_cr", "peak", "rad", "peak_rad", "rad", Block.radians),
    "exponent": Physical("alpha", "exponent", "1/s", "exponent_per_s", "s-1", _per_second),
    "exponent_error": Physical("alpha", "exponent_error", "1/s", "exponent_error_per_s", "s-1", _per_second),
}
for _name in ("brace_angle", "orbit_angle", "mean_angle", "mean_angle_error", "angle_low", "angle_high"):
    PHYSICAL[_name] = PHYSICAL["angle"]._replace(name=_name, key=f"{_name}_rad")
for _name in ("orbit_velocity", "margin", "velocity_low", "velocity_high"):
    PHYSICAL[_name] = PHYSICAL["velocity"]._replace(name=_name, key=f"{_name}_rad_per_s")
"""SI counterparts by the name of the normalised quantity. Dimensionless quantities are absent."""
SAME_IN_SI = {
    "phase": "rad",
    "forcing_phase": "rad",
    "lowest_phase": "rad",
    "critical_angle": "rad",
    "response_period": "cycles",
    "orbit_period": "cycles",
    "transient": "cycles",
}
"""Units of quantities that are the same for normalised and SI input."""


def block_attributes(block: Block) -> dict[str, float]:
    """Return the dimensions of a block as attributes of a file."""
    return {
        "block_height_m": block.height,
        "block_width_m": block.width,
        "block_inertia_ratio": block.inertia_ratio,
        "block_critical_angle_rad": block.critical_angle,
        "block_frequency_parameter_per_s": block.frequency_parameter,
    }
