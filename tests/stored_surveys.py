"""Surveys that tests of stores disturb: responses to harmonic forcing, and rocking spectra of synthetic ground motions."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import rocking as rk
from surveyed import system_with


class StoredSurvey(NamedTuple):
    """Survey with more than one level and several tiles.

    `marker` is the variable that is written last, `other` another one.
    The first level of `uneven` has smaller tiles than the second; `limit` is a size in bytes between those of their largest files.
    """

    function: Callable[..., xr.Dataset]
    given: dict[str, Any]
    uneven: dict[str, Any]
    limit: int
    marker: str
    other: str

    def run(self, store, **changed):
        """Run the survey in a store, with some arguments changed or added."""
        return self.function(**(self.given | changed), store=store).dataset


MAP = {
    "system": rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=1.0),
    "amplitude": np.linspace(0.0, 16.0, 150),
    "period": np.linspace(0.2, 3.0, 150),
    "max_cycles": 100,
}
SPECTRUM = {
    "records": rk.synthetic_ground_motions(3, seed=3, duration=6.0),
    "size": np.linspace(0.2, 4.0, 150),
    "slenderness": [0.1, 0.2, 0.3],
    "levels": np.linspace(0.3, 0.5, 30),
    "intensity": "pga-g",
}
SURVEYS = {
    "map": StoredSurvey(
        rk.parametric_map,
        MAP,
        {"period": np.linspace(0.2, 3.0, 300)},
        15_000,
        "cycles",
        "brace_hits_per_period",
    ),
    "ground-motions": StoredSurvey(
        rk.rocking_spectrum,
        SPECTRUM,
        {"size": np.linspace(0.2, 4.0, 300)},
        100_000,
        "impacts",
        "margin",
    ),
}


RECORDS = rk.synthetic_ground_motions(2, seed=3, duration=4.0)
OF_RECORDS = {"records": RECORDS, "block": rk.Block(2.0, 0.5), "levels": np.linspace(1.0, 4.0, 40)}
TABLE = rk.Restitution.table([(0.1, 0.95), (0.8, 0.85)])
SCATTERED = OF_RECORDS | {"block": rk.Block(2.0, 0.5, TABLE.scattered(0.02, seed=1)), "model": "full"}
TWO_AXES = {"amplitude": np.linspace(0.0, 16.0, 44), "period": np.linspace(0.2, 3.0, 44)}
SYSTEM = system_with(restitution=0.9)
STARTS = {"angle": (-1.0, 1.0), "velocity": (-1.0, 1.0), "samples": 100, "max_cycles": 40}
PULSE = rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9)
EVERY = {
    "map": (rk.parametric_map, {"system": SYSTEM, "max_cycles": 40} | TWO_AXES),
    "repeatability": (
        rk.repeatability_map,
        {"system": SYSTEM, "samples": 2, "max_cycles": 20} | TWO_AXES,
    ),
    "basins": (
        rk.basin_map,
        {"system": system_with(restitution=0.9, amplitude=4.0), "boundary_runs": 0} | STARTS,
    ),
    "safe basin": (rk.safe_basin, {"system": SYSTEM, "amplitude": [4.0, 5.0]} | STARTS),
    "experiment": (rk.repeatability, {"system": SYSTEM, "samples": 100, "max_cycles": 40}),
    "chaos": (
        rk.chaos_share,
        {"system": SYSTEM, "restitution": [0.5, 0.9], "samples": 100, "max_cycles": 40},
    ),
    "overturning": (
        rk.overturning_amplitude,
        {"system": SYSTEM, "period": [1.0, 2.0], "amplitude": np.linspace(0.1, 16.0, 129), "phases": 2},
    ),
    "pulses": (
        rk.overturning_spectrum,
        {"system": PULSE, "amplitude": np.linspace(0.1, 16.0, 129), "frequency": [1.0, 2.0]},
    ),
    "spectrum": (
        rk.rocking_spectrum,
        {"records": RECORDS, "size": np.linspace(1.0, 2.0, 40), "slenderness": 0.2, "levels": 2.0},
    ),
    "dynamic analysis": (rk.incremental_dynamic_analysis, OF_RECORDS),
    "fragility": (rk.fragility, OF_RECORDS | {"samples": 2, "width_spread": 0.1, "replicates": 100}),
    "fragility with scatter": (rk.fragility, SCATTERED | {"samples": 3, "replicates": 100}),
    "overturning set with scatter": (rk.overturning_set, SCATTERED),
    "sensitivity": (rk.sensitivity, OF_RECORDS),
    "overturning set": (rk.overturning_set, OF_RECORDS),
    "orbits": (
        rk.find_orbits,
        {"system": system_with(amplitude=6.0, restitution=0.9), "max_period": 6, "effort": 0.5},
    ),
    "orbit diagram": (
        rk.orbit_diagram,
        {
            "system": system_with(restitution=0.9),
            "amplitude": np.linspace(2.0, 12.0, 8),
            "transient": 200_000,
            "cycles": 5,
        },
    ),
    "response diagram": (
        rk.response_diagram,
        {"system": system_with(restitution=0.9), "amplitude": np.linspace(1.0, 9.0, 150), "max_cycles": 2000},
    ),
    "frequency response": (
        rk.frequency_response,
        {
            "system": system_with(amplitude=2.0, restitution=0.9),
            "period": np.linspace(0.5, 2.5, 150),
            "modes": (1,),
            "max_cycles": 2000,
        },
    ),
}
"""Every function with a store: itself and its arguments, those of more than one tile."""
ALL = EVERY | {f"large {name}": (each.function, each.given) for name, each in SURVEYS.items()}


def files(folder):
    """Return the bytes of all files in a folder, by path."""
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def chunks(folder, level):
    """Return the bytes of the chunks of a level of a store, by path."""
    return {path: content for path, content in files(folder / level).items() if "c" in path.parts}
