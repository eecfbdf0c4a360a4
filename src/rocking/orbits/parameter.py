"""One parameter of a system, by its name: the range in which it is followed, and the same system with another value of it."""

from __future__ import annotations

from attrs import evolve

from rocking.model import RANGES, Braces, Harmonic, System, pair, quantities, refuse_if, within

PARAMETERS = ("amplitude", "period", "frequency", "phase", "restitution", "brace_angle", "brace_restitution")
# A model's own ranges; towards 0 nothing is left of a restitution to follow.
ALLOWED = RANGES | dict.fromkeys(("restitution", "brace_restitution"), (1e-3, 1.0))


def value_of(system: System, parameter: str) -> float:
    """The value of a parameter of a system."""
    found = quantities(system)
    if parameter not in found:
        raise ValueError(
            f"{parameter} needs a system with braces; got one without (give it braces=Braces(…))"
        )
    return found[parameter]


def with_value(system: System, parameter: str, value: float) -> System:
    """The same system with one parameter changed; a brace angle puts braces where there are none."""
    if parameter == "brace_restitution":
        value_of(system, parameter)
    forcing = system.forcing
    if parameter in ("amplitude", "phase"):
        return evolve(system, forcing=evolve(forcing, **{parameter: value}))
    if parameter in ("period", "frequency"):
        return evolve(system, forcing=Harmonic(forcing.amplitude, phase=forcing.phase, **{parameter: value}))
    if parameter == "restitution":
        return evolve(system, restitution=value)
    braces = system.braces or Braces(angle=value)
    return evolve(system, braces=evolve(braces, **{parameter.removeprefix("brace_"): value}))


def checked_range(parameter: str, bounds: tuple[float, float]) -> tuple[float, float]:
    """The range of a parameter, ordered, not empty, and within what a system may have."""
    allowed = "be (lowest, highest), the one below the other"
    ends = pair("bounds", bounds, allowed)
    low, high = (within(f"bounds of {parameter}", value, *ALLOWED[parameter]) for value in ends)
    refuse_if(not low < high, "bounds", allowed, bounds)
    return low, high
