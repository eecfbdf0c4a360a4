"""Measurements of maps: the type of response at a point, its evidence and the associated numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from attrs import evolve

from rocking.kernels import batch
from rocking.kernels.classify import verdict as kernel
from rocking.model.system import State, System, system_of
from rocking.model.verdict import Criterion, Kind
from rocking.motion.simulate import simulate
from rocking.response.classify import budget, transient_of
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.spec import SYSTEM, Points, points


def verdicts(points: Points, options: Mapping[str, int], stop: np.ndarray) -> kernel.ResultArrays | None:
    """Return the verdicts at points, with the conventions of `classify`; None if another thread sets `stop`."""
    counts = options["max_cycles"], options["max_period"]
    result: kernel.ResultArrays | None = batch.classify_batch(
        points.systems, points.starts, *counts, stop, points.law
    )
    return result


def anchors(points: Points, judged: kernel.ResultArrays) -> np.ndarray:
    """Return a representative state (n, 2) of the orbit at each point; NaN if there is none."""
    return np.asarray(batch.anchors_of(points.systems, points.starts, judged, points.law))


MAX_FOLLOWED = 20_000
"""Maximum number of cycles; the second half is averaged."""
BATCHES = 20
MAX_NUDGES, NUDGE = 100, 1e-15
"""Number and size of perturbations of an initial state that overturns in a second run because of rounding."""
APART = 10.0
"""Standard errors between the means of different attractors."""


def averages(points: Points, chaotic: np.ndarray, cycles: int, stop: np.ndarray) -> np.ndarray:
    """Compute the mean angle of chaotic points on the section, with its standard error from long batches.

    The computation ends early if another thread sets `stop[0]`.

    Returns
    -------
    array (n, 2)
        Mean Θ and its standard error; NaN for points that are not chaotic.
    """
    values = np.full((len(points.systems), 2), math.nan)
    count = min(cycles, MAX_FOLLOWED)
    for k in np.flatnonzero(chaotic):
        if stop[0]:
            break
        system = system_of(dict(zip(SYSTEM, points.systems[k].tolist(), strict=True)))
        if len(points.law):
            first, *rows = points.law.tolist()
            system = evolve(system, restitution=first[1], restitution_table=rows)
        late = _late_angles(system, State(*points.starts[k]), count)
        means = late[: late.size // BATCHES * BATCHES].reshape(BATCHES, -1).mean(axis=1)
        values[k] = means.mean(), means.std(ddof=1) / math.sqrt(BATCHES)
    return values


def _late_angles(system: System, start: State, cycles: int) -> np.ndarray:
    """Return Θ on the section in the second half of the cycles; NaN if the run and all perturbed runs overturn."""
    for nudge in range(MAX_NUDGES):
        beside = State(start.angle, start.velocity + nudge * NUDGE)
        motion = simulate(system, beside, cycles=cycles, record="section")
        if motion.outcome == "bounded":
            return np.asarray(motion.section()[cycles // 2 :, 0])
    return np.full(BATCHES, math.nan)


def grouped(means: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return a group number for each mean; groups are `APART` standard errors apart. NaN has the number 0."""
    groups = np.zeros(means.size, int)
    known = np.flatnonzero(~np.isnan(means))
    if known.size == 0:
        return groups
    order = known[np.argsort(means[known])]
    wide = APART * np.maximum(errors[order][1:], errors[order][:-1])
    groups[order] = 1 + np.concatenate([[0], np.cumsum(np.diff(means[order]) > wide)])
    return groups


def meanings(enum: type[Kind] | type[Criterion]) -> dict[str, object]:
    """Return the CF attributes of a variable whose values are the codes of an enum's members."""
    return {"flag_values": np.arange(len(enum), dtype=np.uint8), "flag_meanings": " ".join(map(str, enum))}


SYMMETRY = {
    "flag_values": np.arange(3, dtype=np.uint8),
    "flag_meanings": "asymmetric symmetric not-periodic",
}
NOT_PERIODIC = 2

VARIABLES = (
    Variable("kind", "uint8", 255, {"long_name": "kind of response", **meanings(Kind)}),
    Variable(
        "evidence", "uint8", 255, {"long_name": "evidence for the kind of response", **meanings(Criterion)}
    ),
    Variable(
        "response_period",
        "int32",
        -1,
        {"long_name": "period of the response in forcing cycles", "comment": "0: not periodic"},
    ),
    Variable(
        "impacts_per_period",
        "int32",
        -2,
        {
            "long_name": "impacts per period of the response",
            "comment": "-1: not periodic, or infinitely many before rest or sustained contact with a brace",
        },
    ),
    Variable(
        "brace_hits_per_period",
        "int32",
        -2,
        {
            "long_name": "brace impacts per period of the response",
            "comment": "-1: not periodic, or infinitely many before rest or sustained contact with a brace",
        },
    ),
    Variable("symmetric", "uint8", 255, {"long_name": "symmetry of the response", **SYMMETRY}),
    Variable(
        "exponent",
        "float64",
        math.inf,
        {
            "long_name": "largest Lyapunov exponent per normalised time",
            "units": "1",
            "comment": "-inf: superstable; NaN: none, or not evaluated",
        },
    ),
    Variable(
        "exponent_error",
        "float64",
        math.inf,
        {
            "long_name": "standard error of the exponent",
            "units": "1",
            "comment": "0: from the multipliers; NaN: none",
        },
    ),
    Variable(
        "peak",
        "float64",
        -1.0,
        {"long_name": "largest absolute angle of the run in units of theta_cr", "units": "1"},
    ),
    Variable(
        "transient",
        "int32",
        -2,
        {
            "long_name": "upper bound of the forcing cycles before the response was reached",
            "comment": "-1: unknown",
        },
    ),
    Variable("cycles", "int32", -1, {"long_name": "forcing cycles simulated"}),
)


def response(max_cycles: int, max_period: int, title: str) -> Measurement:
    """Return the measurement of the verdict of `classify` at each point."""
    return Measurement(title, responses_at, VARIABLES, budget(max_cycles, max_period), batch.METHOD)


def responses_at(points: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Return the verdicts at points, with the conventions of `classify`; None if another thread sets `stop`."""
    arrays = verdicts(points, options, stop)
    return None if arrays is None else variables_of(arrays)


def classify_points(
    values: Mapping[str, np.ndarray],
    fixed: Mapping[str, float],
    max_cycles: int,
    max_period: int,
    stop: np.ndarray,
) -> Arrays | None:
    """Return the variables of a map at n points; None if another thread sets `stop` (1,).

    `values` (n,) and `fixed` hold the quantities by name. They are not checked.
    """
    return responses_at(points(values, fixed), {"max_cycles": max_cycles, "max_period": max_period}, stop)


def variables_of(arrays: kernel.ResultArrays) -> Arrays:
    """Return the results of the classification by the names of the variables."""
    open_ = np.flatnonzero(arrays.kind == kernel.UNDETERMINED)
    unweighed = open_[~np.isin(arrays.ground[open_], kernel.WEIGHED)]
    exponent, error = arrays.exponent.copy(), arrays.error.copy()
    exponent[unweighed], error[unweighed] = math.nan, math.nan
    periodic = arrays.kind == kernel.PERIODIC
    return {
        "kind": arrays.kind,
        "evidence": arrays.ground,
        "response_period": arrays.period,
        "impacts_per_period": arrays.impacts,
        "brace_hits_per_period": arrays.brace_hits,
        "symmetric": np.where(periodic, arrays.symmetric, NOT_PERIODIC).astype(np.uint8),
        "exponent": exponent,
        "exponent_error": error,
        "peak": arrays.peak,
        "transient": transient_of(arrays).astype(np.int32),
        "cycles": arrays.cycles,
    }


KIND = VARIABLES[0]


def outcome(max_cycles: int, max_period: int, title: str) -> Measurement:
    """Return the measurement of the kind of response, as classified by `classify`."""
    return Measurement(title, kinds_at, (KIND,), budget(max_cycles, max_period), batch.METHOD)


def kinds_at(points: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Return the kind of response at points; None if another thread sets `stop`."""
    arrays = verdicts(points, options, stop)
    return None if arrays is None else {"kind": arrays.kind}
