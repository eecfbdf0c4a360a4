"""Measurement of maps: the response at a point, its evidence and the associated numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rocking.kernels import batch
from rocking.kernels.classify import results
from rocking.kernels.classify import verdict_record as kernel
from rocking.model.verdict import Criterion, Kind
from rocking.response.classify import budget, transient_of
from rocking.survey.harmonic_spec import Points, points
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.measures.verdicts import verdicts


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
    return Measurement(title, judge, VARIABLES, budget(max_cycles, max_period), batch.METHOD)


def judge(points: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
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
    return judge(points(values, fixed), {"max_cycles": max_cycles, "max_period": max_period}, stop)


def variables_of(arrays: results.ResultArrays) -> Arrays:
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
