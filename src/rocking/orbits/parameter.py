"""Parameters of a system by name: ranges, replacement of values, and variables of a dataset."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from attrs import evolve
from numpy.typing import ArrayLike, NDArray

from rocking.model.forcing import Harmonic
from rocking.model.quantity import LEFT_QUANTITIES, SYSTEM_QUANTITIES
from rocking.model.system import Braces, LeftSide, System, quantities
from rocking.model.validation import Refusal, Text, WrongType, exactly_one, pair, reals, refuse_if, within
from rocking.model.verdict import Kind

# System that has a value of a parameter, and the argument that makes it.
NEEDED = dict.fromkeys(
    ("brace_angle", "brace_restitution"), ("a braced system", "braces=rk.Braces(angle=1.0)")
) | {"critical_angle": ("a system with a critical angle", "critical_angle=0.25")}
NEEDED |= dict.fromkeys(LEFT_QUANTITIES, ("an unsymmetric block", "left=rk.LeftSide(1.2, 1.0, 0.9)"))
# Ranges of the model. Towards a coefficient of restitution of 0, an orbit cannot be continued.
ALLOWED = {name: each.range for name, each in SYSTEM_QUANTITIES.items()} | dict.fromkeys(
    ("restitution", "brace_restitution", "left_restitution"), (1e-3, 1.0)
)
# Range of the largest step along a branch or a curve, in units of the ranges and of one radian of phase.
STEPS = 1e-6, 0.1


def value_of(system: System, parameter: str) -> float:
    """Return the value of a parameter of a system."""
    result = quantities(system)
    if parameter not in result:
        needed, argument = NEEDED[parameter]
        raise WrongType(parameter, f"be used with {needed}", remedy=f"give it {argument}")
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
    if parameter in LEFT_QUANTITIES:
        value_of(system, parameter)
        assert isinstance(system.left, LeftSide)
        return evolve(system, left=evolve(system.left, **{parameter.removeprefix("left_"): value}))
    refuse_if(system.left is not None, parameter, "be omitted for an unsymmetric block", value)
    braces = system.braces or Braces(angle=value)
    return evolve(system, braces=evolve(braces, **{parameter.removeprefix("brace_"): value}))


def varied_parameter(values: Mapping[str, ArrayLike | None], most: int) -> tuple[str, NDArray[np.float64]]:
    """Return the only parameter that is not None, and its different values, ascending: one at least, at most `most`."""
    name = exactly_one(**values)
    return name, different_values(name, values[name], 1, most)


def different_values(name: str, values: Any, fewest: int, most: int) -> NDArray[np.float64]:
    """Return the different values of a parameter, ascending; TypeError or ValueError if they are no finite numbers in a row."""
    array = np.asarray(reals(name, values))
    if array.ndim > 1:
        allowed = "be an array (n,)" if fewest > 1 else "be a number or an array (n,)"
        raise Refusal(name, allowed, Text(f"an array of shape {array.shape}"))
    refuse_if(not np.isfinite(array).all(), name, "hold finite numbers", values)
    ordered = np.unique(array)
    if len(ordered) < fewest:
        least = "one number" if fewest == 1 else f"{fewest} different numbers"
        raise Refusal(name, f"hold {least} or more", values)
    if len(ordered) > most:
        raise Refusal(name, f"hold {most:,} different numbers at most", Text(f"{len(ordered):,}"))
    return ordered


def fixed_quantities(system: System, *varied: str) -> dict[str, float]:
    """Return the parameters of a system that do not vary, by name. A varied brace angle adds braces if there are none."""
    if "brace_angle" in varied:
        system = with_value(system, "brace_angle", 1.0)
    result, left_out = quantities(system), {"frequency", *varied}
    if "frequency" in varied:
        left_out.add("period")
    return {name: value for name, value in result.items() if name not in left_out}


def identity_of(system: System, *varied: str) -> dict[str, Any]:
    """Return what a store states of a system: the parameters that do not vary, and the table of its restitution, by name."""
    law = system.restitution_table
    return fixed_quantities(system, *varied) | (
        {"restitution_table": [list(row) for row in law]} if law else {}
    )


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


def plane(names: tuple[str, str], points: np.ndarray) -> dict[str, Any]:
    """Return the values of two parameters, shape (n, 2), as coordinates along `point`."""
    return {name: coordinate_of("point", name, values) for name, values in zip(names, points.T, strict=True)}


def column_of(name: str, values: Any) -> tuple[np.ndarray, dict[str, str]]:
    """Return values of a parameter of a system as a column."""
    return np.array(values, float), SYSTEM_QUANTITIES[name].attributes
