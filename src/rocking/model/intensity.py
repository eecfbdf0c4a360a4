"""Intensity measures: numbers that say how strong a ground motion is, and the factor that scales it to a given value."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from attrs import frozen

from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import RecordSet
from rocking.model.validation import one_of, refusal


def _for_any_block(frequency_parameter: Any, critical_angle: Any) -> Any:
    return 1.0


def _per_lift_off(frequency_parameter: Any, critical_angle: Any) -> Any:
    return 1.0 / (GRAVITY * np.tan(critical_angle))


def _per_lift_off_and_time(frequency_parameter: Any, critical_angle: Any) -> Any:
    return frequency_parameter * _per_lift_off(frequency_parameter, critical_angle)


@frozen
class Intensity:
    """Intensity measure.

    Attributes
    ----------
    name : str
        Name in arguments and options.
    symbol, unit, long_name : str
        Symbol, unit and description.
    power : int
        Power of the factor of the motion to which the value is proportional.
    per_block : callable
        (α, θcr) → factor of the value of the motion, for measures that compare the motion with a block.
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    power: int = 1
    per_block: Callable[[Any, Any], Any] = _for_any_block

    def factor(self, level: Any, value: Any, frequency_parameter: Any, critical_angle: Any) -> Any:
        """Return the factor that scales a motion from a `value` to a `level`, for blocks with α in 1/s and θcr in rad."""
        ratio = level / (value * self.per_block(frequency_parameter, critical_angle))
        return ratio if self.power == 1 else ratio ** (1.0 / self.power)

    def level(self, factor: Any, value: Any, frequency_parameter: Any, critical_angle: Any) -> Any:
        """Return the level of a motion times a factor: the inverse of `factor`."""
        return factor**self.power * value * self.per_block(frequency_parameter, critical_angle)


INTENSITIES: dict[str, tuple[Intensity, Callable[[GroundMotion], float]]] = {
    measure.name: (measure, value)
    for measure, value in (
        (Intensity("scale", "factor", "1", "factor of the ground motion"), lambda motion: 1.0),
        (Intensity("pga", "PGA", "m/s²", "peak ground acceleration"), lambda motion: motion.pga),
        (Intensity("pga-g", "PGA", "g", "peak ground acceleration"), lambda motion: motion.pga / GRAVITY),
        (Intensity("pgv", "PGV", "m/s", "peak ground velocity"), lambda motion: motion.pgv),
        (Intensity("pgd", "PGD", "m", "peak ground displacement"), lambda motion: motion.pgd),
        (Intensity("arias", "I_A", "m/s", "Arias intensity", 2), lambda motion: motion.arias_intensity),
        (
            Intensity(
                "pga-ratio",
                "PGA/(g tan θcr)",
                "1",
                "peak ground acceleration relative to lift-off",
                1,
                _per_lift_off,
            ),
            lambda motion: motion.pga,
        ),
        (
            Intensity(
                "pgv-ratio",
                "α PGV/(g tan θcr)",
                "1",
                "peak ground velocity relative to the block",
                1,
                _per_lift_off_and_time,
            ),
            lambda motion: motion.pgv,
        ),
    )
}
"""Measures by name, with their values for a motion, before `Intensity.per_block`."""


def intensity_of(name: str, records: RecordSet) -> tuple[Intensity, np.ndarray]:
    """Return an intensity measure and its values (n,) for the motions as they are, before `Intensity.per_block`.

    A column of the set is a measure, too. It is taken as proportional to the factor of the motion.

    Raises
    ------
    TypeError, ValueError
        If there is no such measure, or if a column has its name. Also if a motion has no positive value of it.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.model import RecordSet
    >>> measure, values = intensity_of("pga", RecordSet([rk.GroundMotion([0.0, 2.0], step=0.1)]))
    >>> measure.unit, values.tolist()
    ('m/s²', [2.0])
    """
    choices = (*INTENSITIES, *records.columns)
    one_of("intensity", name, choices)
    if name in records.columns and name in INTENSITIES:
        allowed = "name either a measure or a column of the records, not both"
        raise ValueError(refusal("intensity", allowed, name, "rename the column"))
    if name in records.columns:
        measure, values = Intensity(name, name, "", f"column {name!r} of the records"), records.columns[name]
    else:
        measure, value = INTENSITIES[name]
        values = np.array([value(motion) for motion in records])
    lacking = ~(np.isfinite(values) & (values > 0.0))
    if lacking.any():
        first = int(np.argmax(lacking))
        allowed = f"be positive for each record, unlike for {records.names[first]!r}"
        raise ValueError(refusal(f"intensity {name!r}", allowed, float(values[first])))
    return measure, values
