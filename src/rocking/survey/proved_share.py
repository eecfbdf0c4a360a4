"""Fraction of the periodic responses of a map that can be proved."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.forcing import Harmonic
from rocking.model.proof import ProvedShare
from rocking.model.share import Share
from rocking.model.system import NO_BRACES, Braces, State, System
from rocking.model.validation import Refusal, WrongType, whole
from rocking.model.verdict import Kind
from rocking.proof.prove import check_provable
from rocking.response.classify import classify
from rocking.survey.sampling.random_points import generator

if TYPE_CHECKING:
    from xarray import Dataset

MAX_POINTS = 100_000
QUANTITIES = (
    "amplitude",
    "period",
    "frequency",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
    "angle",
    "velocity",
)
"""Quantities of a map, as attributes or as coordinates."""


def proved_share(found: Dataset, points: int = 300, seed: int = 0) -> ProvedShare:
    """Prove a random sample of the periodic responses of a map in ball arithmetic.

    Each response of the sample is classified again, with the proof of its orbit and of its initial state (`classify`).

    Parameters
    ----------
    found : xarray.Dataset
        Map of slender blocks, from `parametric_map`.
    points : int
        Number of periodic responses of the sample, in [1, 100,000]; all of them if there are fewer. A proof takes some
        milliseconds to seconds. Default: 300.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.

    Returns
    -------
    ProvedShare
        Fractions of proved orbits and of proved initial states, with the reasons of all refusals.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    TypeError, ValueError
        If an argument is of the wrong type or outside its range, or if no response is periodic. Also if the blocks are not
        slender.

    See Also
    --------
    prove : Prove one orbit.
    parametric_map : Classify every point of a grid.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.parametric_map(amplitude=np.linspace(2, 6, 5), period=[0.5, 1.0], restitution=0.925)
    >>> shares = rk.proved_share(found)
    >>> shares.orbits.count == shares.orbits.of
    True
    """
    from xarray import Dataset

    points = whole("points", points, 1, MAX_POINTS)
    random = generator(seed)
    if not isinstance(found, Dataset) or "kind" not in found:
        raise WrongType("found", "be a map of responses", found)
    periodic = found["kind"] == Kind.PERIODIC.code
    places = np.argwhere(periodic.values)
    if not len(places):
        raise Refusal("found", "have periodic responses; the map has none")
    chosen = places[np.sort(random.choice(len(places), min(points, len(places)), replace=False))]
    orbits, starts, reasons = 0, 0, Counter[str]()
    for place in chosen:
        system, start = _point(found, dict(zip(periodic.dims, place, strict=True)))
        check_provable(system)
        verdict = classify(
            system, start, int(found.attrs["max_cycles"]), int(found.attrs["max_period"]), prove=True
        )
        proof = None if verdict.orbit is None else verdict.orbit.proof
        orbits += proof is not None and proof.proved
        starts += proof is not None and bool(proof.starts)
        if proof is None:
            reasons[f"the response is {verdict.kind} when it is classified again"] += 1
        elif not proof.starts:
            reasons[proof.claim.rpartition(": ")[2]] += 1
    return ProvedShare(Share(orbits, len(chosen)), Share(starts, len(chosen)), dict(reasons.most_common()))


def _point(found: Dataset, place: dict[Any, int]) -> tuple[System, State]:
    """Return the system and the initial state at a point of a map."""
    here = found.isel(place)
    given: dict[str, float] = {"phase": 0.0, "angle": 0.0, "velocity": 0.0, **NO_BRACES}
    for name in QUANTITIES:
        if name in here.coords:
            given[name] = float(here.coords[name])
        elif name in found.attrs:
            given[name] = float(found.attrs[name])
    clock = {name: given[name] for name in ("period", "frequency") if name in given}
    forcing = Harmonic(given["amplitude"], phase=given["phase"], **clock)
    braces = (
        Braces(given["brace_angle"], given["brace_restitution"])
        if np.isfinite(given["brace_angle"])
        else None
    )
    system = System(forcing, given["restitution"], braces, given.get("critical_angle", 0.0) or None)
    return system, State(given["angle"], given["velocity"])
