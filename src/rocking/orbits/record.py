"""Orbit diagrams and frequency responses as xarray datasets that name their parameters and the package that made them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model import VERSION, Kind

if TYPE_CHECKING:
    import xarray as xr

    from rocking.orbits.diagram import OrbitDiagram
    from rocking.orbits.frequency_response import FrequencyResponse

LONG_NAMES = {
    "amplitude": "amplitude of the base's acceleration, A",
    "period": "period of the base, T",
    "frequency": "frequency of the base, Omega",
    "phase": "phase of the base at the start, phi",
    "restitution": "restitution at an impact, e",
    "brace_angle": "angle of the braces, Theta_b",
    "brace_restitution": "restitution at a brace, r",
}


def diagram_dataset(diagram: OrbitDiagram) -> xr.Dataset:
    """`angle` and `velocity` along sweep, parameter and cycle; `overturned` and `peak` along sweep and parameter."""
    import xarray as xr

    name = diagram.parameter
    each, all_cycles = ("sweep", name), ("sweep", name, "cycle")
    variables = {
        "angle": (all_cycles, diagram.points[..., 0], _named("angle at the section")),
        "velocity": (all_cycles, diagram.points[..., 1], _named("angular velocity at the section")),
        "peak": (each, diagram.peak, _named("largest size of the angle after the transient")),
        "overturned": (
            each,
            diagram.overturned.astype(np.int8),
            {"long_name": "whether it was proved that the block does not return", "flag_values": [0, 1]}
            | {"flag_meanings": "bounded overturned"},
        ),
    }
    unit = "rad" if name == "phase" else "1"
    coordinates = {
        "sweep": ("sweep", np.array(diagram.sweeps), {"long_name": "order of the values"}),
        name: (name, diagram.values, {"long_name": LONG_NAMES[name], "units": unit}),
        "cycle": ("cycle", np.arange(diagram.cycles), {"long_name": "forcing cycles since the transient"}),
    }
    return xr.Dataset(variables, coordinates, _attributes(diagram))


def _named(text: str) -> dict[str, str]:
    return {"long_name": text, "units": "1"}


def _attributes(diagram: OrbitDiagram) -> dict[str, Any]:
    """Everything that was not varied."""
    return {
        "Conventions": "CF-1.11",
        "title": "Orbit diagram of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "Everything is normalised as in Yim and Lin (1991), eqs. 1-4.",
        "start_angle": diagram.start.angle,
        "start_velocity": diagram.start.velocity,
        "transient": diagram.transient,
        "section_phase": diagram.section_phase,
        **diagram.fixed,
    }


def frequency_response_dataset(response: FrequencyResponse) -> xr.Dataset:
    """`rest_kind`, `rest_period`, `rest_peak`, `rest_steady_peak` along the parameter; the branches' points along `point`."""
    import xarray as xr

    name, rest = response.parameter, response.rest
    kinds = [kind.value for kind in Kind]
    flags = {"flag_values": list(range(len(kinds))), "flag_meanings": " ".join(kinds)}
    codes = np.array([kinds.index(kind) for kind in rest["kind"]], np.uint8)
    variables = {
        "rest_kind": (name, codes, {"long_name": "what a start from rest does"} | flags),
        "rest_period": (name, rest["period"], _named("forcing cycles of the response; 0 where it has none")),
        "rest_peak": (name, rest["peak"], _named("largest size of the angle from the start on")),
        "rest_steady_peak": (name, rest["steady_peak"], _named("largest size of the angle of the response")),
    }
    counts = [len(branch) for branch in response.branches]
    for column, text in (
        ("parameter", LONG_NAMES[name]),
        ("stable", "whether the orbit is stable"),
        ("peak", "largest size of the angle of the orbit"),
    ):
        points = [branch.points[column] for branch in response.branches]
        together = np.concatenate(points) if points else np.empty(0)
        variables[f"branch_{column}"] = (
            "point",
            together.astype(np.int8 if column == "stable" else float),
            _named(text),
        )
    for column, each, text in (
        ("number", range(len(counts)), "number of the branch"),
        ("mode", [branch.period for branch in response.branches], "n of the (1, n) orbits"),
        ("symmetric", [int(branch.symmetric) for branch in response.branches], "whether they are symmetric"),
    ):
        variables[f"branch_{column}"] = (
            "point",
            np.repeat(np.array(each, np.int64), counts),
            {"long_name": text},
        )
    attributes = {
        "Conventions": "CF-1.11",
        "title": "Frequency response of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "Everything is normalised as in Yim and Lin (1991), eqs. 1-4.",
        "amplitude": response.amplitude,
        "restitution": response.restitution,
        "phase": 0.0,
        "modes": list(response.modes),
    }
    coordinate = {name: (name, response.values, {"long_name": LONG_NAMES[name], "units": "1"})}
    return xr.Dataset(variables, coordinate, attributes)
