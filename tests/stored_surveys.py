"""Surveys that tests of stores disturb: responses to harmonic forcing, and rocking spectra of synthetic ground motions."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import rocking as rk


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


def files(folder):
    """Return the bytes of all files in a folder, by path."""
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def chunks(folder, level):
    """Return the bytes of the chunks of a level of a store, by path."""
    return {path: content for path, content in files(folder / level).items() if "c" in path.parts}
