"""Parameters of a system by name: their ranges, and replacement of their values."""

from __future__ import annotations

from attrs import evolve

from rocking.model import RANGES, Braces, Harmonic, System, pair, quantities, refuse_if, within

PARAMETERS = (
    "amplitude",
    "period",
    "frequency",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
)
# Argument of a system without which a parameter has no value.
MISSING = dict.fromkeys(("brace_angle", "brace_restitution"), "braces=Braces(…)") | {
    "critical_angle": "critical_angle=…"
}
# Ranges of the model. Towards a coefficient of restitution of 0, an orbit cannot be continued.
ALLOWED = RANGES | dict.fromkeys(("restitution", "brace_restitution"), (1e-3, 1.0))


def value_of(system: System, parameter: str) -> float:
    """Return the value of a parameter of a system."""
    found = quantities(system)
    if parameter not in found:
        needs = "a critical angle" if parameter == "critical_angle" else "braces"
        raise ValueError(
            f"{parameter} needs a system with {needs}; got one without (give {MISSING[parameter]})"
        )
    return found[parameter]


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


def checked_range(parameter: str, bounds: tuple[float, float]) -> tuple[float, float]:
    """Return the bounds of a parameter, after checking that they are ordered and within its range."""
    allowed = "be (lowest, highest), the one below the other"
    ends = pair("bounds", bounds, allowed)
    low, high = (within(f"bounds of {parameter}", value, *ALLOWED[parameter]) for value in ends)
    refuse_if(not low < high, "bounds", allowed, bounds)
    return low, high
