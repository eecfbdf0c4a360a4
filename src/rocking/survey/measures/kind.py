"""Measurement of the kind of response alone, one byte per point, for surveys that only count."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rocking.kernels import batch
from rocking.model.share import Share
from rocking.response.classify import budget
from rocking.survey.harmonic_spec import Points
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.measures.response import VARIABLES
from rocking.survey.measures.verdicts import verdicts

KIND = VARIABLES[0]


def outcome(max_cycles: int, max_period: int, title: str) -> Measurement:
    """Return the measurement of the kind of response, as classified by `classify`."""
    return Measurement(title, judge, (KIND,), budget(max_cycles, max_period), batch.METHOD)


def judge(points: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Return the kind of response at points; None if another thread sets `stop`."""
    arrays = verdicts(points, options, stop)
    return None if arrays is None else {"kind": arrays.kind}


def interval_variables(
    name: str, shares: Sequence[Share], dimension: str, meaning: str
) -> dict[str, tuple[str, np.ndarray, dict[str, str]]]:
    """Return fractions along a dimension as three dataset variables: the fraction and both ends of its interval."""
    parts = {
        name: ([each.value for each in shares], meaning),
        f"{name}_low": ([each.low for each in shares], f"{meaning}, lower end of its 95 % interval"),
        f"{name}_high": ([each.high for each in shares], f"{meaning}, upper end of its 95 % interval"),
    }
    return {
        part: (dimension, np.array(values), {"long_name": long_name, "units": "1"})
        for part, (values, long_name) in parts.items()
    }
