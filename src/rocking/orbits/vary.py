"""One parameter of a system, by its name: what it is, and the same system with another value of it."""

from __future__ import annotations

from attrs import evolve

from rocking.model import Braces, Harmonic, System

PARAMETERS = (
    "amplitude",
    "period",
    "frequency",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
)


def with_value(system: System, parameter: str, value: float) -> System:
    """The same system with one parameter changed; a brace angle puts braces where there are none."""
    if parameter == "brace_restitution" and system.braces is None:
        raise ValueError(
            "brace_restitution needs a system with braces; got one without (give it braces=Braces(…))"
        )
    forcing = system.forcing
    if parameter in ("amplitude", "phase"):
        return evolve(system, forcing=evolve(forcing, **{parameter: value}))
    if parameter in ("period", "frequency"):
        return evolve(system, forcing=Harmonic(forcing.amplitude, phase=forcing.phase, **{parameter: value}))
    if parameter == "restitution":
        return evolve(system, restitution=value)
    braces = system.braces or Braces(angle=value)
    return evolve(system, braces=evolve(braces, **{parameter.removeprefix("brace_"): value}))
