"""Parameters of a system by name: ranges, replacement of values, and variables of a dataset."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from attrs import evolve
from numpy.typing import ArrayLike, NDArray

from rocking.model.forcing import Harmonic
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.system import Braces, System, quantities
from rocking.model.validation import Refusal, exactly_one, pair, reals, refuse_if, within
from rocking.model.verdict import Kind

# Argument of a system without which a parameter has no value.
MISSING = dict.fromkeys(("brace_angle", "brace_restitution"), "braces=Braces(…)") | {
    "critical_angle": "critical_angle=…"
}
# Ranges of the model. Towards a coefficient of restitution of 0, an orbit cannot be continued.
ALLOWED = {name: each.range for name, each in SYSTEM_QUANTITIES.items()} | dict.fromkeys(
    ("restitution", "brace_restitution"), (1e-3, 1.0)
)
# Range of the largest step along a branch or a curve, in units of the ranges and of one radian of phase.
STEPS = 1e-6, 0.1


def value_of(system: System, parameter: str) -> float:
    """Return the value of a parameter of a system."""
    result = quantities(system)
    if parameter not in result:
        needs = "a critical angle" if parameter == "critical_angle" else "braces"
        raise ValueError(
            f"{parameter} needs a system with {needs}; got one without (give {MISSING[parameter]})"
        )
    return result[parameter]


def with_value(system: System, parameter: str, value: float) -> System:
    """Return the system with one parameter changed; a brace angle adds braces if there are none."""
    if parameter == "brace_restitution":
        value_of(system, parameter)
    forcing = system.periodic
    if parameter in ("amplitude", "phase"):
        return evolve(system, forcing=evolve(forcing, **{parameter: value}))
    if parameter in ("period", "frequency"):
        return evolve(system, forcing=Harmonic(forcing.amplitude, phase=forcing.phase, **{parameter: value}))
    if parameter == "restitution":
        return evolve(system, restitution=value)
    if parameter == "critical_angle":
        return evolve(system, critical_angle=value)
    braces = system.braces or Braces(angle=value)
    return evolve(system, braces=evolve(braces, **{parameter.removeprefix("brace_"): value}))


def varied_parameter(values: Mapping[str, ArrayLike | None], most: int) -> tuple[str, NDArray[np.float64]]:
    """Return the only parameter that is not None, and its different values, ascending: finite numbers, at most `most`."""
    name = exactly_one(**values)
    ordered = np.unique(reals(name, values[name]))
    if not 0 < len(ordered) <= most or not np.isfinite(ordered).all():
        raise Refusal(name, f"be 1 to {most:,} finite numbers", values[name])
    return name, ordered


def fixed_quantities(system: System, *varied: str) -> dict[str, float]:
    """Return the parameters of a system that do not vary, by name. A varied brace angle adds braces if there are none."""
    if "brace_angle" in varied:
        system = with_value(system, "brace_angle", 1.0)
    result, left_out = quantities(system), {"frequency", *varied}
    if "frequency" in varied:
        left_out.add("period")
    return {name: value for name, value in result.items() if name not in left_out}


def check_range(parameter: str, bounds: tuple[float, float], argument: str = "bounds") -> tuple[float, float]:
    """Return the bounds of a parameter, after checking that they are ordered and within its range."""
    allowed = "be (lowest, highest), the one below the other"
    ends = pair(argument, bounds, allowed)
    label = f"bounds of {parameter}" if argument == "bounds" else argument
    low, high = (within(label, value, *ALLOWED[parameter]) for value in ends)
    refuse_if(not low < high, argument, allowed, bounds)
    return low, high


def check_step(step: float) -> float:
    """Return the largest step along a branch or a curve, after checking its range."""
    return within("step", step, *STEPS)


def coordinate_of(along: str, name: str, values: Any) -> tuple[str, Any, dict[str, str]]:
    """Return the values of a parameter as a variable."""
    return along, values, SYSTEM_QUANTITIES[name].attributes


def kinds_of(along: str, kinds: Iterable[str], text: str) -> tuple[str, Any, dict[str, Any]]:
    """Return types of response as a variable of codes, which its attributes explain."""
    names = [kind.value for kind in Kind]
    flags = {"flag_values": list(range(len(names))), "flag_meanings": " ".join(names)}
    return along, np.array([names.index(kind) for kind in kinds], np.uint8), {"long_name": text} | flags
