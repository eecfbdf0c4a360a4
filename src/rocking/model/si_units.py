"""What a block makes of normalised quantities: under which names and in which units they stand in files and answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from rocking.model.block import Block


class Physical(NamedTuple):
    """A quantity in SI, and the unit of the normalised one."""

    normalised: str  # unit of the normalised quantity
    name: str
    unit: str
    key: str  # its name with its unit, for a program
    cf: str  # its unit as in the CF conventions
    turn: Callable[[Block, Any], Any]

    @property
    def heading(self) -> str:
        """Of a column."""
        return f"{self.name} [{self.unit}]"


PHYSICAL = {
    "amplitude": Physical(
        "g theta_cr", "acceleration", "m/s^2", "acceleration_m_per_s2", "m s-2", Block.acceleration
    ),
    "period": Physical("1/alpha", "period", "s", "period_s", "s", Block.seconds),
    "frequency": Physical("alpha", "frequency", "Hz", "frequency_hz", "Hz", Block.hertz),
    "time": Physical("1/alpha", "time", "s", "time_s", "s", Block.seconds),
    "angle": Physical("theta_cr", "angle", "rad", "angle_rad", "rad", Block.radians),
    "velocity": Physical(
        "alpha theta_cr", "velocity", "rad/s", "velocity_rad_per_s", "rad s-1", Block.radians_per_second
    ),
    "peak": Physical("theta_cr", "peak", "rad", "peak_rad", "rad", Block.radians),
    "brace_angle": Physical("theta_cr", "brace_angle", "rad", "brace_angle_rad", "rad", Block.radians),
}
"""By the name of the normalised quantity; what has no unit is not there."""


def block_attributes(block: Block) -> dict[str, float]:
    """The block, as the attributes of a file have it."""
    return {
        "block_height_m": block.height,
        "block_width_m": block.width,
        "block_inertia_ratio": block.inertia_ratio,
        "block_critical_angle_rad": block.critical_angle,
        "block_frequency_parameter_per_s": block.frequency_parameter,
    }
