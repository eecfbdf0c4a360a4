"""Fractions: of chaotic responses among random systems, and of periodic responses of a map that can be proved."""

from __future__ import annotations

import os
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.kernels.classify import verdict as kernel
from rocking.model.proof import ProvedShare
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.restitution import check_uniform
from rocking.model.share import Share, interval_variables, shares_of
from rocking.model.survey_results import ChaosShare, ParametricMap, check_survey
from rocking.model.system import NO_BRACES, State, System, system_of
from rocking.model.validation import Refusal, whole
from rocking.model.verdict import Kind
from rocking.proof.prove import check_provable
from rocking.response.classify import KINDS, classify
from rocking.survey.engine import Engine
from rocking.survey.measurement import Measurement
from rocking.survey.memory import attributes
from rocking.survey.random_points import MAX_SAMPLES, RandomSpec, generator, span
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import HarmonicSpec, coordinate, quantity_axis, system_quantities
from rocking.survey.verdict_measures import outcome

if TYPE_CHECKING:
    from xarray import Dataset


TITLE = "Share of chaotic responses of a free-standing block on a shaking base"


def chaos_share(
    system: System,
    *,
    restitution: Any = None,
    period: Any = (0.2, 3.0),
    amplitude: Any = (0.0, 16.0),
    samples: int = 3_000,
    seed: int = 0,
    max_cycles: int = 20_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> ChaosShare:
    """Estimate the fraction of chaotic responses from rest over the restitution, for random periods and amplitudes.

    Parameters
    ----------
    system : System
        Block on a harmonic base, of any amplitude and period.
    restitution : array (n,), optional
        Coefficients of restitution e in [0, 1], ascending. Default: that of the system.
    period, amplitude : pair
        Ranges (low, high) of the forcing period T and the amplitude A, which are uniformly distributed.
        Default: (0.2, 3) and (0, 16).
    samples : int
        Number of responses at each restitution, in [1, 10⁷], with independent samples. Default: 3,000.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.
    max_cycles, max_period : int
        As in `classify`. A response is classified as chaotic after 10⁴ cycles at the earliest (with braces 10⁵).
        Default: 20,000 and 64.
    store, executor, progress, repair
        As in `parametric_map`. Larger restitutions extend a store. It cannot be refined.

    Returns
    -------
    ChaosShare
        `.dataset` and `.shares`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    classify : Classify one response.
    parametric_map : Classify every point of a grid.
    rocking.plot.chaos_share : Plot the fractions.

    Notes
    -----
    The intervals are Wilson's at 95 %. Their upper ends assume that all undetermined responses are chaotic.
    Not guaranteed: that a chaotic response is an attractor. A longer run may show a chaotic transient.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.9)
    >>> result = rk.chaos_share(system, restitution=[0.5, 0.9], samples=20)
    >>> result.dataset.share.dims
    ('restitution', 'response')
    """
    measure = outcome(max_cycles, max_period, TITLE)
    quantities = system_quantities(system)
    spans = {"period": span("period", period), "amplitude": span("amplitude", amplitude)}
    fixed = {
        name: value for name, value in quantities.items() if name not in (*spans, "frequency", "restitution")
    }
    if restitution is None:
        values = np.array([system.restitution])
    else:
        check_uniform(system.restitution_table, "an axis of a share")
        values = quantity_axis("restitution", restitution, "the system")
    count = whole("samples", samples, 1, MAX_SAMPLES)
    random = generator(seed)
    drawn = [[random.uniform(*ends, count) for ends in spans.values()] for _ in values]
    spec = RandomSpec(
        {"restitution": values, "sample": np.arange(float(count))},
        fixed,
        drawn=dict(zip(spans, np.stack(drawn, axis=1), strict=True)),
        stated={"samples": count, "seed": seed}
        | {f"{name}_range": list(ends) for name, ends in spans.items()},
    )
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair)
    return ChaosShare(*_summed_up(data.kind.values, spec, measure), system=system)


def _summed_up(
    kinds: np.ndarray, spec: RandomSpec, measure: Measurement
) -> tuple[Dataset, tuple[Share, ...]]:
    import xarray as xr

    of = kinds.shape[1]
    counts = np.stack([np.count_nonzero(kinds == number, axis=1) for number in range(len(KINDS))], axis=1)
    chaotic = shares_of(counts[:, kernel.CHAOTIC], of, counts[:, kernel.UNDETERMINED])
    variables: dict[str, Any] = interval_variables(
        "restitution", chaotic, "chaotic", "fraction of chaotic responses"
    )
    variables["share"] = (
        ("restitution", "response"),
        counts / of,
        {"long_name": "fraction of the responses of each kind", "units": "1"},
    )
    coordinates = {
        "restitution": ("restitution", spec.axes["restitution"], coordinate("restitution")),
        "response": ("response", [str(kind) for kind in KINDS], {"long_name": "kind of response"}),
    }
    metadata = attributes(HarmonicSpec({}, spec.fixed), measure) | spec.stated
    return xr.Dataset(variables, coordinates, metadata), chaotic


MAX_POINTS = 100_000


def proved_share(result: ParametricMap | Dataset, points: int = 300, seed: int = 0) -> ProvedShare:
    """Prove a random sample of the periodic responses of a map in ball arithmetic.

    Each response of the sample is classified again, with the proof of its orbit and of its initial state (`classify`).

    Parameters
    ----------
    result : ParametricMap or xarray.Dataset
        Map of slender blocks, or its dataset.
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
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.parametric_map(system, amplitude=np.linspace(2, 6, 5), period=[0.5, 1.0])
    >>> shares = rk.proved_share(result)
    >>> shares.orbits.count == shares.orbits.of
    True
    """
    points = whole("points", points, 1, MAX_POINTS)
    random = generator(seed)
    data = result.dataset if isinstance(result, ParametricMap) else result
    check_survey("result", data, "be a map of responses", ParametricMap.VARIABLES)
    periodic = data["kind"] == Kind.PERIODIC.code
    places = np.argwhere(periodic.values)
    if not len(places):
        raise Refusal("result", "have periodic responses; the map has none")
    chosen = places[np.sort(random.choice(len(places), min(points, len(places)), replace=False))]
    orbits, starts, reasons = 0, 0, Counter[str]()
    for place in chosen:
        system, start = _point(data, dict(zip(periodic.dims, place, strict=True)))
        check_provable(system)
        verdict = classify(
            system, start, int(data.attrs["max_cycles"]), int(data.attrs["max_period"]), prove=True
        )
        proof = None if verdict.orbit is None else verdict.orbit.proof
        orbits += proof is not None and proof.proved
        starts += proof is not None and bool(proof.starts)
        if proof is None:
            reasons[f"the response is {verdict.kind} when it is classified again"] += 1
        elif not proof.starts:
            reasons[proof.claim.rpartition(": ")[2]] += 1
    return ProvedShare(Share(orbits, len(chosen)), Share(starts, len(chosen)), dict(reasons.most_common()))


def _point(data: Dataset, place: dict[Any, int]) -> tuple[System, State]:
    """Return the system and the initial state at a point of a map."""
    here = data.isel(place)
    values: dict[str, float] = {"phase": 0.0, "angle": 0.0, "velocity": 0.0, **NO_BRACES}
    for name in SYSTEM_QUANTITIES:
        if name in here.coords:
            values[name] = float(here.coords[name])
        elif name in data.attrs:
            values[name] = float(data.attrs[name])
    return system_of(values), State(values["angle"], values["velocity"])
